// Tables and lists of a printed sheet as HTML.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/report/svg/html_text.h"
#include "geometry/base/result.h"

namespace toothpath::sheet {

/// Three decimals, no minus before zero.
[[nodiscard]] inline std::string millimetres(double mm) { return fmt::format("{:.3f}", mm == 0 ? 0.0 : mm); }

/// Of all sheets that are tables on A4 paper.
inline constexpr std::string_view kSheetStyle = R"(@page{size:A4;margin:11mm 14mm}
body{font:9pt/1.25 sans-serif;color:#111;background:#fff;max-width:182mm;margin:6mm auto}
h1{font-size:14pt;margin:0 0 1mm}h2{font-size:10.5pt;margin:2.5mm 0 .8mm;border-bottom:.3mm solid #888;break-after:avoid}
table{border-collapse:collapse;width:100%}th,td{border:.2mm solid #999;padding:.4mm 1.3mm;text-align:left;vertical-align:top}
th{background:#eee;font-weight:600}td.n{text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums}td.w{overflow-wrap:anywhere}tr,svg{break-inside:avoid}
.no{border:.8mm solid #b00;padding:2mm;color:#b00;font-weight:700}.yes{border:.4mm solid #070;padding:1.5mm}.part{border:.6mm solid #a60;padding:1.5mm;font-weight:600}
.part ul{font-weight:400}.assumed{border:.5mm dashed #a60;padding:1.5mm}@media print,(min-width:700px){.assumed ul{columns:2}}@media print{body{margin:0}}ul{margin:1mm 0;padding-left:5mm}svg{max-width:100%}
.small{font-size:8pt;margin:.8mm 0}.tools{display:flex;flex-wrap:wrap;gap:1mm 3mm;align-items:flex-end}.tools svg{max-width:100%}.pairs{columns:6 26mm;column-gap:4mm;font-size:8.5pt;font-variant-numeric:tabular-nums}.pairs span{display:block}
.wide{overflow-x:auto}@media screen{body{font-size:10.5pt;line-height:1.35}.small{font-size:9pt}}@media screen and (max-width:700px){body{margin:3mm}td,th{padding:.6mm 1mm}.wide table{min-width:640px}.wide td:first-child{white-space:nowrap}}
@media print{.wide{overflow:visible}h2{break-after:avoid}thead{display:table-header-group}.appendix{break-before:page}}
)";

class Sheet {
 public:
  void heading(std::string_view text) { out_ += fmt::format("<h2>{}</h2>\n", svg::html_escape(text)); }
  /// A table of more than three columns may be shifted sideways where the screen is narrow.
  void begin_table(const std::vector<std::string>& columns) {
    out_ += columns.size() > 3 ? "<div class=wide><table><thead><tr>" : "<div><table><thead><tr>";
    for (const auto& column : columns) out_ += fmt::format("<th scope=col>{}</th>", svg::html_escape(column));
    out_ += "</tr></thead><tbody>\n";
  }
  /// Cells that begin with a digit or a minus sign are set to the right; long words (paths of files) may break.
  void row(const std::vector<std::string>& cells) {
    out_ += "<tr>";
    for (const auto& cell : cells) {
      const bool number = !cell.empty() && (cell[0] == '-' || (cell[0] >= '0' && cell[0] <= '9'));
      const char* css_class = svg::has_long_word(cell) ? " class=w" : number ? " class=n" : "";
      out_ += fmt::format("<td{}>{}</td>", css_class, svg::html_escape(cell));
    }
    out_ += "</tr>\n";
  }
  void end_table() { out_ += "</tbody></table></div>\n"; }
  void list(const std::vector<std::string>& items, std::string_view css_class) {
    out_ += fmt::format("<div class={}><ul>", css_class);
    for (const auto& item : items) out_ += fmt::format("<li>{}</li>", svg::html_escape(item));
    out_ += "</ul></div>\n";
  }
  void raw(std::string_view html) { out_ += html; }
  [[nodiscard]] std::string finish() && { return std::move(out_) + "</body></html>\n"; }

 private:
  std::string out_;
};

}  // namespace toothpath::sheet
