#include "app/report/page/sections.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/base/units.h"
#include "app/report/page/data.h"
#include "app/report/svg/html_text.h"
#include "app/report/svg/plot.h"
#include "geometry/base/angle.h"
#include "machines/assumed.h"

namespace toothpath::page {
namespace {

std::string section(std::string_view id, std::string_view title, std::string_view body) {
  if (body.empty()) return {};
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", id, title, body);
}

std::string figure(std::string_view title, std::string_view svg, std::string_view note = {}) {
  if (svg.empty()) return {};
  std::string out = fmt::format("<figure><figcaption>{}</figcaption>{}", svg::html_escape(title), svg);
  if (!note.empty()) out += fmt::format("<p class=\"note\">{}</p>", svg::html_escape(note));
  return out + "</figure>\n";
}

std::string figures(std::string_view inside) {
  return inside.empty() ? "" : fmt::format("<div class=\"plots\">\n{}</div>\n", inside);
}

/// Digits with the usual signs around them, or a dash: set right-aligned.
bool reads_as_number(std::string_view cell) {
  return cell == "\u2013" ||
         (!cell.empty() && cell.find_first_of("0123456789") != std::string_view::npos &&
          cell.find_first_not_of("0123456789+-.,eE%/< \xE2\x88\x92\x93\xC2\xB0") == std::string_view::npos);
}

std::string table(const PageTable& t) {
  std::vector<bool> numeric(t.columns.size(), !t.rows.empty());
  for (const auto& row : t.rows)
    for (std::size_t c = 0; c < std::min(row.size(), numeric.size()); ++c)
      if (!row[c].empty() && !reads_as_number(row[c])) numeric[c] = false;
  std::string out = "<div class=\"table\"><table>";
  if (!t.title.empty()) out += fmt::format("<caption>{}</caption>", svg::html_escape(t.title));
  out += "<thead><tr>";
  for (std::size_t c = 0; c < t.columns.size(); ++c)
    out += fmt::format("<th scope=\"col\"{}>{}</th>", numeric[c] ? " class=\"n\"" : "", svg::html_escape(t.columns[c]));
  out += "</tr></thead><tbody>\n";
  for (const auto& row : t.rows) {
    out += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c) {
      const char* css_class = c < numeric.size() && numeric[c] ? " class=\"n\"" : "";
      if (svg::has_long_word(row[c])) css_class = " class=\"w\"";
      out += fmt::format("<td{}>{}</td>", css_class, svg::html_escape(row[c]));
    }
    out += "</tr>\n";
  }
  out += "</tbody></table></div>\n";
  if (!t.note.empty()) out += fmt::format("<p class=\"note\">{}</p>\n", svg::html_escape(t.note));
  return out;
}

std::string list(std::string_view title, const std::vector<std::string>& items, std::string_view css_class) {
  if (items.empty()) return {};
  std::string out = fmt::format("<div class=\"{}\"><h3>{}</h3><ul>", css_class, title);
  for (const std::string& item : items) out += fmt::format("<li>{}</li>", svg::html_escape(item));
  return out + "</ul></div>\n";
}

/// A number with a real minus sign.
std::string decimal(double value, int decimals) {
  const std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool zero = text.find_first_not_of("0.") == std::string::npos;
  return value < 0 && !zero ? "\u2212" + text : text;
}

std::string um_text(double mm) { return decimal(mm * app::kUm, 2); }

std::string worst_row(const proof::WorstPlace& place, std::size_t k, const ReportPage& page) {
  const bool listed = std::any_of(page.listing.begin(), page.listing.end(), [&](const NcExcerpt& e) {
    return place.line >= e.first_line && place.line < e.first_line + static_cast<int>(e.lines.size());
  });
  const std::string line = place.line <= 0 ? "\u2013"
                           : listed        ? fmt::format("<a href=\"#L{0}\" data-gouge=\"{1}\">{0}</a>", place.line, k)
                                           : fmt::format("<a href=\"#space\" data-gouge=\"{}\">{}</a>", k, place.line);
  return fmt::format(
      "<tr data-row=\"{0}\"><td><a class=\"pin\" href=\"#space\" data-gouge=\"{0}\">{1}</a></td><td "
      "class=\"n\">{2}</td><td>{3}</td><td>{4}</td><td>{5}</td><td class=\"n\">{6}</td><td class=\"n\">{7}</td><td "
      "class=\"n\">{8}</td><td class=\"n\">{9}</td><td class=\"n\">{10}</td></tr>\n",
      k, k + 1, um_text(place.depth_mm), to_string(place.body), svg::html_escape(place.patch),
      svg::html_escape(operation_name(page, place.operation)), place.tooth, place.zone, decimal(place.radius_mm, 3),
      decimal(place.height_mm, 3), line);
}

std::string listing(const ReportPage& page) {
  if (page.listing.empty()) return {};
  std::string out =
      fmt::format("<figure class=\"listing-box\"><figcaption>{}</figcaption><div class=\"listing\" tabindex=\"0\">",
                  svg::html_escape(page.nc_file.empty() ? "NC program" : page.nc_file));
  bool first = true;
  for (const NcExcerpt& excerpt : page.listing) {
    if (!first) out += "<div class=\"gap\">\u22ee</div>";
    first = false;
    int number = excerpt.first_line;
    for (const std::string& line : excerpt.lines) {
      out += fmt::format("<div id=\"L{0}\"><a href=\"#L{0}\" data-line=\"{0}\">{0}</a><code>{1}</code></div>", number,
                         svg::html_escape(line));
      ++number;
    }
  }
  return out + "</div></figure>\n";
}

constexpr std::size_t kMostAssumed = 200, kAssumedWidth = 110;
constexpr std::size_t kLongValue = 12;  // a figure of more letters is no number to be read from afar

std::string key_figures(const ReportPage& page) {
  if (page.figures.empty()) return {};
  std::string out = "<dl class=\"figures\">\n";
  for (const KeyFigure& f : page.figures) {
    const char* state = f.state == KeyFigure::State::good  ? " class=\"good\""
                        : f.state == KeyFigure::State::bad ? " class=\"bad\""
                                                           : "";
    out += fmt::format("<div{}><dt>{}</dt><dd{}>{}{}</dd>{}</div>\n", state, svg::html_escape(f.name),
                       f.value.size() > kLongValue ? " class=\"long\"" : "", svg::html_escape(f.value),
                       f.unit.empty() ? "" : fmt::format(" <span>{}</span>", svg::html_escape(f.unit)),
                       f.note.empty() ? "" : fmt::format("<dd class=\"sub\">{}</dd>", svg::html_escape(f.note)));
  }
  return out + "</dl>\n";
}

}  // namespace

std::string page_header(const ReportPage& page) {
  const bool part = page.verified && page.verdict != "verified";
  std::string out =
      fmt::format("<header>\n<div class=\"name\"><h1>{}</h1>{}</div>\n<p class=\"verdict {}\">{}</p>\n</header>\n",
                  svg::html_escape(page.title),
                  page.subtitle.empty() ? "" : fmt::format("<p>{}</p>", svg::html_escape(page.subtitle)),
                  part            ? "part"
                  : page.verified ? "good"
                                  : "bad",
                  svg::html_escape(svg::sentence(page.verdict)));
  if (!page.unfinished.empty()) out += list("Not finished", {page.unfinished}, "reasons warn");
  if (!page.reasons.empty())
    out += list(page.verified ? "Verdict" : "Why it is not verified", page.reasons,
                page.verified ? "reasons" : "reasons bad");
  return out;
}

std::string overview_section(const ReportPage& page) {
  const std::string out = key_figures(page) + list("Warnings", page.warnings, "reasons warn");
  return out.empty() ? out : fmt::format("<section id=\"overview\">\n{}</section>\n", out);
}

std::string job_section(const ReportPage& page) {
  std::string columns;
  if (!page.summary.empty()) {
    columns += "<table class=\"pairs\"><tbody>\n";
    for (const auto& [name, value] : page.summary)
      columns += fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", svg::html_escape(name), svg::html_escape(value));
    columns += "</tbody></table>\n";
  }
  columns += list(fmt::format("Assumed values ({})", page.assumed.size()),
                  machines::grouped_keys(page.assumed, kMostAssumed, kAssumedWidth), "assumed");
  return section("job", "Job", columns.empty() ? columns : fmt::format("<div class=\"columns\">{}</div>\n", columns));
}

std::string gouge_section(const ReportPage& page) {
  if (!page.gouge) return {};
  const proof::GougeResult& g = *page.gouge;
  const proof::WorstPlace& d = g.deepest;
  const std::string where = d.patch.empty() ? std::string()
                                            : fmt::format(" ({}, {}, tooth {}{})", d.body, d.patch, d.tooth,
                                                          d.line > 0 ? fmt::format(", NC line {}", d.line) : "");
  std::string out = "<p>";
  out += svg::html_escape(
      g.measured_mm >= 0
          ? fmt::format("Deepest penetration into the finished surface {} \u00b5m{}, proven bound {} \u00b5m, "
                        "tolerance {} \u00b5m.",
                        um_text(g.measured_mm), where, um_text(g.bound_mm), um_text(page.gouge_tolerance_mm))
          : fmt::format("The cutter stays at least {} \u00b5m away from the finished surface{}; proven bound {} "
                        "\u00b5m, tolerance {} \u00b5m.",
                        um_text(-g.measured_mm), where, um_text(g.bound_mm), um_text(page.gouge_tolerance_mm)));
  out += svg::html_escape(fmt::format(" Shank and holder keep {} mm, {:.3f} mm asked for. Rapids {} the blank.",
                                      app::least_text(g.clearance_mm, g.clearance_at_least()), g.required_clearance_mm,
                                      g.rapids_clear ? "stay outside" : "enter"));
  out += fmt::format(" {} motions checked.</p>\n", g.motions);
  if (g.worst.empty()) {
    out += "<p class=\"none\">No place is beyond the tolerance or the clearance.</p>\n";
  } else {
    out +=
        "<div class=\"table\"><table class=\"worst\"><caption>Worst places, deepest "
        "first</caption><thead><tr><th>Place</th><th class=\"n\">Depth "
        "[\u00b5m]</th><th>Body</th><th>Patch</th><th>Operation</th><th class=\"n\">Tooth</th><th "
        "class=\"n\">Zone</th><th class=\"n\">r [mm]</th><th class=\"n\">z [mm]</th><th class=\"n\">NC "
        "line</th></tr></thead><tbody>\n";
    for (std::size_t k = 0; k < g.worst.size(); ++k) out += worst_row(g.worst[k], k, page);
    out += "</tbody></table></div>\n";
  }
  return section("gouge", "Gouge and clearance", out + listing(page));
}

std::string deviation_section(const ReportPage& page) {
  std::string plots;
  PageTable t{
      "Material left (+) or missing (\u2212) along the normal",
      {"After operation", "Max [\u00b5m]", "Min [\u00b5m]", "RMS [\u00b5m]", "Proven below [\u00b5m]", "Points"},
      {},
      "Of an operation: the points of its grid, and what may stand between them. The finished surface: what the "
      "tools reach of the last grid, with the cusps between its points; these are the numbers at the top of the "
      "page."};
  for (const proof::ExcessResult& e : page.excess) {
    const std::string name = operation_name(page, e.operation);
    t.rows.push_back(
        {name, um_text(e.max_mm), um_text(e.min_mm), um_text(e.rms_mm), um_text(e.bound_mm), std::to_string(e.points)});
    svg::HistogramChart chart{"After operation " + name,      "deviation [\u00b5m]", e.histogram_from_mm * app::kUm,
                              e.histogram_step_mm * app::kUm, e.histogram,           {}};
    plots += figure(chart.title, svg::svg_histogram(chart));
  }
  if (page.excess.empty()) return {};
  if (page.finished) {
    const proof::ExcessResult& f = *page.finished;
    t.rows.push_back({"finished surface", um_text(f.max_mm), um_text(f.min_mm), um_text(f.rms_mm), um_text(f.bound_mm),
                      std::to_string(f.points)});
  }
  return section("deviation", "Deviation of the cut surface", figures(plots) + table(t));
}

std::string ledger_section(const ReportPage& page) {
  if (page.ledger.empty()) return {};
  svg::PairedBarChart chart;
  chart.title = "Predicted bound and measured value";
  chart.x_label = "error [\u00b5m], logarithmic";
  PageTable t{"", {"Source", "Predicted [\u00b5m]", "Measured [\u00b5m]", "Measured / predicted"}, {}, {}};
  double predicted = 0, measured = 0;
  const auto share = [](double m, double p) {
    return p > 0 && m > 0 && m < 0.005 * p ? std::string("< 0.01")
           : p > 0                         ? fmt::format("{:.2f}", m / p)
                                           : std::string("\u2013");
  };
  for (const proof::LedgerEntry& e : page.ledger) {
    if (!e.counted) {
      t.rows.push_back({to_string(e.source), "\u2013", "\u2013", "\u2013"});
      t.note += fmt::format("{}{}: {}.", t.note.empty() ? "" : " ", to_string(e.source), e.note);
      continue;
    }
    if (!e.measured_um) {  // a model: no part of the chart, nor of the sum
      t.rows.push_back({to_string(e.source), svg::short_number(e.predicted_um), "\u2013", "\u2013"});
      t.note += fmt::format("{}{}: {}.", t.note.empty() ? "" : " ", to_string(e.source), e.note);
      continue;
    }
    chart.rows.push_back({to_string(e.source), e.predicted_um, *e.measured_um});
    t.rows.push_back({to_string(e.source), svg::short_number(e.predicted_um), svg::short_number(*e.measured_um),
                      share(*e.measured_um, e.predicted_um)});
    predicted += e.predicted_um;
    measured += *e.measured_um;
  }
  t.rows.push_back({"sum", svg::short_number(predicted), svg::short_number(measured), share(measured, predicted)});
  return section("ledger", "Error ledger",
                 fmt::format("<div class=\"plots\">\n{}<div>{}</div></div>\n",
                             figure(chart.title, svg::svg_paired_bars(chart)), table(t)));
}

std::string direction_section(const ReportPage& page) {
  if (page.directions.empty()) return {};
  std::string plots;
  PageTable t{"", {"Operation", "Zone", "Tilt", "Lean [\u00b0]", "Least gap [mm]", "Why"}, {}, {}};
  for (const proof::DirectionChoice& c : page.directions) {
    t.rows.push_back({operation_name(page, c.operation), std::to_string(c.zone), c.fixed ? "fixed" : "simultaneous",
                      fmt::format("{:.2f}", c.lean_rad / kDegree),
                      (c.clearance_at_least ? "at least " : "") + decimal(c.clearance_mm, 3), c.explanation});
    if (!c.candidates.empty())
      plots += figure(fmt::format("Operation {}, zone {}", operation_name(page, c.operation), c.zone),
                      svg::svg_direction_map(c));
  }
  std::string out = table(t) + figures(plots);
  if (!plots.empty())
    out +=
        "<p class=\"note\">Maps: lean of the tool axis against the gear axis outwards, azimuth about the gear axis "
        "around.</p>\n";
  return section("direction", "Tool direction", out);
}

std::string motion_section(const ReportPage& page) {
  std::string plots;
  for (const svg::LineChart& chart : page.motion) plots += figure(chart.title, svg::svg_line_chart(chart), chart.note);
  if (page.block_times && !page.block_times->counts.empty())
    plots += figure(page.block_times->title, svg::svg_histogram(*page.block_times));
  return section("motion", "Axes over time",
                 plots.empty() ? plots : fmt::format("<div class=\"plots two\">\n{}</div>\n", plots));
}

std::string limits_section(const ReportPage& page) {
  std::string plots;
  for (const svg::LineChart& chart : page.gear_limits)
    plots += figure(chart.title, svg::svg_line_chart(chart), chart.note);
  return section("limits", "Limits of the flanks", figures(plots));
}

std::string work_precision_section(const ReportPage& page) {
  std::string plots;
  for (const svg::LineChart& chart : page.work_precision)
    plots += figure(chart.title, svg::svg_line_chart(chart), chart.note);
  return section("work-precision", "Error against run time", figures(plots));
}

std::string contact_section(const ReportPage& page) {
  return section("contact", "Contact with the pinion", page.contact);
}

std::string section_of_the_report(const report::Section& s) {
  std::string plots;
  for (const svg::LineChart& chart : s.charts) plots += figure(chart.title, svg::svg_line_chart(chart));
  return section(s.id, svg::html_escape(s.title), figures(plots) + table({"", s.columns, s.rows, s.note}));
}

std::string stages_section(const ReportPage& page) {
  if (page.stage_seconds.empty()) return {};
  double total = 0;
  std::vector<std::pair<std::string, double>> rounded;  // to ms
  for (const auto& [name, seconds] : page.stage_seconds) {
    total += seconds;
    rounded.emplace_back(name, std::round(seconds * 1e3) / 1e3);
  }
  return section("stages", "Computing time",
                 figures(figure(fmt::format("Stages, {} s together", svg::short_number(total, 3)),
                                svg::svg_bars(rounded, "time [s]"))));
}

std::string tables_section(const ReportPage& page) {
  std::string out;
  for (const PageTable& t : page.tables) out += table(t);
  return section("tables", "Tables", out);
}

}  // namespace toothpath::page
