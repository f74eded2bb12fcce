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
