#include "app/process/face/contact_figures.h"

#include <algorithm>
#include <cmath>

#include "app/base/units.h"
#include "app/process/under_load/loaded_page.h"
#include "app/report/svg/contact_pattern.h"
#include "app/report/svg/html_text.h"
#include "app/report/svg/plot.h"
#include "geometry/base/angle.h"

namespace toothpath::face {
namespace {

constexpr int kLinesAPitch = 4;

std::string pattern_note(const ContactAnalysis& a, const ContactOfSide& side, const contact::FlankPattern& p) {
  std::string note = fmt::format("{:.1f} % of the flank carries compound of {:g} um. ", p.marked_share * 100,
                                 a.settings.compound_mm * app::kUm);
  if (p.marked_share > 0 && p.marked_share < 0.95 && p.length_mm >= 1.3 * p.width_mm)
    note += fmt::format("Long axis {:.1f} mm, inclined {:.1f} deg to the direction of the tooth; {:.1f} mm across. ",
                        p.length_mm, degrees(p.inclination_rad), p.width_mm);
  if (side.kind == "line") note += fmt::format("Lines of contact, {} a pitch of the pinion. ", kLinesAPitch);
  if (side.kind == "edge") note += "The path of contact misses the flank: it bears on an edge. ";
  return note;
}

/// Every n-th row of a fine grid: the eye does not see more.
int stride_of(int rows) { return std::max(1, (rows - 1) / 240); }

/// Every place touches at one turn of the pinion: the lines of equal turns, some a pitch.
void add_lines(const ContactAnalysis& a, const contact::ContactFlank& f, int stride, svg::PatternDrawing& d) {
  const double step = 2 * kPi / a.pinion_teeth / kLinesAPitch;
  for (int r = 0; r < f.rows; r += stride)
    for (int c = 0; c < f.columns; ++c) {
      const auto k = f.index(r, c);
      d.moment.push_back(f.surface.flank_phi(f.side, f.theta[k], f.B[k]) / step);
    }
  const auto [low, high] = std::minmax_element(d.moment.begin(), d.moment.end());
  for (double level = std::ceil(*low); level < *high; ++level) d.lines.push_back(level);
}

svg::PatternDrawing drawing(const ContactAnalysis& a, const contact::ContactMember& member,
                            const contact::FlankPattern& p, bool on_pinion, bool line) {
  const contact::ContactFlank& f = member.flank;
  svg::PatternDrawing d;
  d.compound_um = a.settings.compound_mm * app::kUm;
  d.columns = f.columns;
  d.outline = !on_pinion;
  const int stride = stride_of(f.rows);
  for (int r = 0; r < f.rows; r += stride) {
    ++d.rows;
    for (int c = 0; c < f.columns; ++c) {
      const auto k = f.index(r, c);
      d.x.push_back(on_pinion ? p.pinion_Z_mm[k] : std::hypot(f.points[k].x(), f.points[k].y()));
      d.y.push_back(on_pinion ? p.pinion_radius_mm[k] : f.points[k].z());
      d.gap_um.push_back(p.gap_mm[k] * app::kUm);
    }
  }
  d.x_label = on_pinion ? "along the pinion's axis [mm]" : "radius from the gear's axis [mm]";
  d.y_label = on_pinion ? "radius [mm]" : "height z [mm]";
  if (!on_pinion && !line)
    for (const auto& place : p.path) d.path.emplace_back(place.radius_mm, place.height_mm);
  if (!on_pinion && line) add_lines(a, f, stride, d);
  return d;
}

}  // namespace

std::string name_of(const ContactAnalysis& a, const ContactOfSide& side) {
  return fmt::format("flank {:+}, {}", side.side, side.as_cut ? a.route : "exact");
}

std::vector<ContactFigure> contact_patterns(const ContactAnalysis& a) {
  std::vector<ContactFigure> figures;
  for (const auto& side : a.sides)
    for (std::size_t m = 0; m < side.members.size(); ++m) {
      const std::string zone = side.members.size() > 1 ? fmt::format(", ring {}", side.members[m].flank.zone) : "";
      const contact::FlankPattern& p = side.roll.patterns[m];
      for (const bool on_pinion : {false, true}) {
        svg::PatternDrawing d = drawing(a, side.members[m], p, on_pinion, side.kind == "line");
        d.title = fmt::format("contact pattern on the {}, {}{}", on_pinion ? "pinion" : "gear", name_of(a, side), zone);
        figures.push_back(
            {fmt::format("{}: {}{}", on_pinion ? "Pinion" : "Gear", name_of(a, side), zone),
             svg::svg_contact_pattern(d),
             on_pinion ? "The places of the gear's grid at the moment of their least gap, on the pinion's flank."
                       : pattern_note(a, side, p)});
      }
    }
  return figures;
}

namespace {

/// Curves of single pairs; empty where the ratio is constant.
svg::LineChart motion_chart(const ContactAnalysis& a) {
  std::vector<ease_off::MotionCurve> curves;
  for (const auto& side : a.sides)
    if (!side.as_cut && side.roll.error_range_rad >= kNoError) curves.push_back(motion_of(side));
  return ease_off::motion_chart(curves);
}

}  // namespace

std::vector<svg::LineChart> contact_charts(const ContactAnalysis& a) {
  svg::LineChart error, pairs;
  error.title = "Transmission error over one pitch";
  error.x_label = "gear turn [pitches]";
  error.y_label = "error less its mean [\u00b5rad]";
  error.note = "The gear's turn beyond that of the gear ratio, phi_2 - phi_1 N_p/N_2. Rigid bodies, no load.";
  if (!is_modified(a))
    error.note += " On the exact flank the error is a constant wherever contact is inside the flank, also misaligned.";
  pairs.title = "Pairs in contact over one pitch";
  pairs.x_label = "gear turn [pitches]";
  pairs.y_label = "pairs";
  pairs.note =
      "Touching: gap below a nanometre. Within the compound: gap below its thickness; elastic flanks under load share "
      "it among about as many.";
  for (const auto& side : a.sides) {
    svg::ChartSeries e{name_of(a, side), {}, {}},
        t{name_of(a, side) + (side.as_cut ? ", compound" : ", touching"), {}, {}};
    const double pitch = 2 * kPi / a.gear_teeth, start = side.roll.cycle.front().phi_2;
    for (const auto& p : side.roll.cycle) {
      const double x = (p.phi_2 - start) / pitch;
      // Rounding would look like a curve of its own.
      const double value = (p.error_rad - side.roll.error_mean_rad) * app::kMicro;
      e.x.push_back(x), e.y.push_back(std::abs(value) < kNoError * app::kMicro ? 0 : value);
      t.x.push_back(x), t.y.push_back(side.as_cut ? p.marking : p.touching);
    }
    error.series.push_back(std::move(e));
    pairs.series.push_back(std::move(t));
  }
  const auto flat = [](const svg::LineChart& c) {
    for (const auto& s : c.series)
      for (const double y : s.y)
        if (y != 0) return false;
    return true;
  };
  std::vector<svg::LineChart> charts;
  if (!flat(error)) charts.push_back(std::move(error));
  if (auto motion = motion_chart(a); !motion.series.empty()) charts.push_back(std::move(motion));
  charts.push_back(std::move(pairs));
  return charts;
}

page::PageTable contact_table(const ContactAnalysis& a) {
  page::PageTable table{"Contact",
                        {"flank", "surface", "ring", "contact", "error range urad", "error range um", "error mean urad",
                         "contact ratio", "pairs", "within compound", "pattern %", "r mm", "z mm"},
                        {},
                        ""};
  table.note = fmt::format("Micrometres at the pitch radius {:.3f} mm. Ratio: mean number of pairs that touch.",
                           a.pitch_radius_mm);
  for (const auto& side : a.sides)
    for (std::size_t m = 0; m < side.members.size(); ++m) {
      const contact::RollResult& r = side.roll;
      const contact::FlankPattern& p = r.patterns[m];
      table.rows.push_back(
          {fmt::format("{:+}", side.side), side.as_cut ? a.route : "exact", std::to_string(side.members[m].flank.zone),
           side.kind, svg::short_number(r.error_range_rad < kNoError ? 0 : r.error_range_rad * app::kMicro, 4),
           svg::short_number(r.error_range_rad < kNoError ? 0 : r.error_range_rad * a.pitch_radius_mm * app::kUm, 4),
           fmt::format("{:.4f}", std::abs(r.error_mean_rad) < kNoError ? 0 : r.error_mean_rad * app::kMicro),
           fmt::format("{:.3f}", r.contact_ratio), fmt::format("{} to {}", r.least_touching, r.most_touching),
           fmt::format("{} to {}", r.least_marking, r.most_marking), fmt::format("{:.1f}", p.marked_share * 100),
           fmt::format("{:.2f} to {:.2f}", p.inner_mm, p.outer_mm),
           fmt::format("{:.2f} to {:.2f}", p.low_mm, p.high_mm)});
    }
  return table;
}

std::string contact_section_body(const ContactAnalysis& a) {
  std::string out = fmt::format(
      "<p>Rolled with a pinion of {} teeth as rigid bodies without load, marking compound of {:g} um.</p>\n",
      a.pinion_teeth, a.settings.compound_mm * app::kUm);
  for (const auto& note : a.notes) out += "<p class=\"note\">" + svg::html_escape(note) + "</p>\n";
  std::vector<page::PageTable> tables = {contact_table(a)};
  std::vector<svg::LineChart> charts = contact_charts(a);
  if (a.loaded) {
    for (const auto& note : a.loaded->notes) out += "<p class=\"note\">" + svg::html_escape(note) + "</p>\n";
    for (auto& table : under_load::loaded_tables(*a.loaded)) tables.push_back(std::move(table));
    for (auto& chart : under_load::loaded_charts(*a.loaded)) charts.push_back(std::move(chart));
  }
  for (const auto& t : tables) {
    out += "<div class=\"table\"><table><thead><tr>";
    for (const auto& column : t.columns) out += fmt::format("<th>{}</th>", svg::html_escape(column));
    out += "</tr></thead><tbody>\n";
    for (const auto& row : t.rows) {
      out += "<tr>";
      for (const auto& cell : row) out += fmt::format("<td>{}</td>", svg::html_escape(cell));
      out += "</tr>\n";
    }
    out += fmt::format("</tbody></table></div>\n<p class=\"note\">{}</p>\n", svg::html_escape(t.note));
  }
  out += "<div class=\"plots two\">\n";
  for (const auto& chart : charts)
    out += fmt::format("<figure><figcaption>{}</figcaption>{}<p class=\"note\">{}</p></figure>\n",
                       svg::html_escape(chart.title), svg::svg_line_chart(chart), svg::html_escape(chart.note));
  for (const auto& f : contact_patterns(a))
    out += fmt::format("<figure><figcaption>{}</figcaption>{}<p class=\"note\">{}</p></figure>\n",
                       svg::html_escape(f.caption), f.svg, svg::html_escape(f.note));
  return out + "</div>\n";
}

}  // namespace toothpath::face
