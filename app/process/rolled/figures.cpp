#include "app/process/rolled/figures.h"

#include <algorithm>
#include <cmath>

#include "app/base/units.h"
#include "app/process/under_load/loaded_page.h"
#include "app/report/svg/contact_pattern.h"
#include "app/report/svg/html_text.h"
#include "app/report/svg/plot.h"
#include "geometry/base/angle.h"

namespace toothpath::rolled {
namespace {

constexpr int kLinesAPitch = 4;

std::string pattern_note(const RolledPair& a, const RolledSide& side, const contact::FlankPattern& p) {
  std::string note = fmt::format("{:.1f} % of the flank carries compound of {:g} um. ", p.marked_share * 100,
                                 a.settings.compound_mm * app::kUm);
  if (p.marked_share > 0 && p.marked_share < 0.95 && p.length_mm >= 1.3 * p.width_mm)
    note += fmt::format("Long axis {:.1f} mm, inclined {:.1f} deg to the direction of the tooth; {:.1f} mm across. ",
                        p.length_mm, degrees(p.inclination_rad), p.width_mm);
  if (side.kind == "line") note += fmt::format("Lines of contact, {} a pitch of the {}. ", kLinesAPitch, a.other);
  if (side.kind == "edge") note += "The path of contact misses the flank: it bears on an edge. ";
  return note;
}

/// Every n-th row of a fine grid: the eye does not see more.
int stride_of(int rows) { return std::max(1, (rows - 1) / 240); }

/// Every place touches at one turn of the pinion: the lines of equal turns, some a pitch.
void add_lines(const RolledPair& a, const RolledFlank& f, int stride, svg::PatternDrawing& d) {
  const double step = 2 * kPi / a.pinion_teeth / kLinesAPitch;
  for (int r = 0; r < f.rows; r += stride)
    for (int c = 0; c < f.columns; ++c) d.moment.push_back(f.turn_rad[f.index(r, c)] / step);
  const auto [low, high] = std::minmax_element(d.moment.begin(), d.moment.end());
  for (double level = std::ceil(*low); level < *high; ++level) d.lines.push_back(level);
}

svg::PatternDrawing drawing(const RolledPair& a, const RolledFlank& f, const contact::FlankPattern& p, bool on_pinion) {
  svg::PatternDrawing d;
  d.compound_um = a.settings.compound_mm * app::kUm;
  d.columns = f.columns;
  d.outline = !on_pinion;
  const int stride = stride_of(f.rows);
  for (int r = 0; r < f.rows; r += stride) {
    ++d.rows;
    for (int c = 0; c < f.columns; ++c) {
      const auto k = f.index(r, c);
      d.x.push_back(on_pinion ? p.pinion_Z_mm[k] : f.x[k]);
      d.y.push_back(on_pinion ? p.pinion_radius_mm[k] : f.y[k]);
      d.gap_um.push_back(p.gap_mm[k] * app::kUm);
    }
  }
  d.x_label = on_pinion ? fmt::format("along the {}'s axis [mm]", a.other) : a.words->x_label;
  d.y_label = on_pinion ? "radius [mm]" : a.words->y_label;
  if (on_pinion) return d;
  if (!f.turn_rad.empty()) add_lines(a, f, stride, d);
  else
    for (const auto& place : p.path) d.path.emplace_back(place.radius_mm, place.height_mm);
  return d;
}

}  // namespace

std::string name_of(const RolledPair& a, const RolledSide& side) {
  return fmt::format("flank {:+}, {}", side.side, side.as_cut ? a.route : "exact");
}

std::vector<ContactFigure> contact_patterns(const RolledPair& a) {
  std::vector<ContactFigure> figures;
  for (const auto& side : a.sides)
    for (std::size_t m = 0; m < side.flanks.size(); ++m) {
      const std::string zone = side.flanks.size() > 1 ? fmt::format(", ring {}", side.flanks[m].zone) : "";
      const contact::FlankPattern& p = side.roll.patterns[m];
      for (const bool on_pinion : {false, true}) {
        svg::PatternDrawing d = drawing(a, side.flanks[m], p, on_pinion);
        d.title =
            fmt::format("contact pattern on the {}, {}{}", on_pinion ? a.other : a.carrier, name_of(a, side), zone);
        figures.push_back(
            {fmt::format("{}: {}{}", svg::sentence(on_pinion ? a.other : a.carrier), name_of(a, side), zone),
             svg::svg_contact_pattern(d),
             on_pinion ? fmt::format("The places of the {}'s grid at the moment of their least gap, on the {}'s flank.",
                                     a.carrier, a.other)
                       : pattern_note(a, side, p)});
      }
    }
  return figures;
}

namespace {

/// Curves of single pairs; empty where the ratio is constant.
svg::LineChart motion_chart(const RolledPair& a) {
  std::vector<ease_off::MotionCurve> curves;
  for (const auto& side : a.sides)
    if (!side.as_cut && side.roll.error_range_rad >= kNoError) curves.push_back(motion_of(side));
  return ease_off::motion_chart(curves);
}

}  // namespace

std::vector<svg::LineChart> contact_charts(const RolledPair& a) {
  svg::LineChart error, pairs;
  error.title = "Transmission error over one pitch";
  error.x_label = a.carrier + " turn [pitches]";
  error.y_label = "error less its mean [\u00b5rad]";
  error.note = fmt::format("The {}'s turn beyond that of the gear ratio, phi_2 - phi_1 N_1/N_2. Rigid bodies, no load.",
                           a.carrier);
  if (a.involute_pinion && !is_modified(a))
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

page::PageTable contact_table(const RolledPair& a) {
  page::PageTable table{"Contact",
                        {"flank", "surface", "ring", "contact", "error range urad", "error range um", "error mean urad",
                         "contact ratio", "pairs", "within compound", "pattern %", std::string(a.words->x_text) + " mm",
                         std::string(a.words->y_text) + " mm"},
                        {},
                        ""};
  table.note = fmt::format("Micrometres at the {} {:.3f} mm. Ratio: mean number of pairs that touch.", a.words->lever,
                           a.pitch_radius_mm);
  for (const auto& side : a.sides)
    for (std::size_t m = 0; m < side.flanks.size(); ++m) {
      const contact::RollResult& r = side.roll;
      const contact::FlankPattern& p = r.patterns[m];
      table.rows.push_back(
          {fmt::format("{:+}", side.side), side.as_cut ? a.route : "exact", std::to_string(side.flanks[m].zone),
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

std::string contact_page(const RolledPair& a, const std::string& about) {
  page::StudyPage page;
  page.title = a.job_name + ": contact";
  page.subtitle = fmt::format("{} of {} teeth, {} of {} teeth, compound {:g} um", a.other, a.pinion_teeth, a.carrier,
                              a.gear_teeth, a.settings.compound_mm * app::kUm);
  if (!a.mate.empty()) page.subtitle += "; mate: " + a.mate;
  const contact::Misalignment& moved = a.settings.moved;
  if (!moved.none()) page.subtitle += "; " + words_of(moved);
  Verdict verdict = verdict_of(a);
  page.good = verdict.inside, page.verdict = std::move(verdict.words);
  page.introduction = {
      "Both members turn as rigid bodies without load, as on a rolling tester. The compound marks every place where "
      "the flanks come closer than its thickness at any moment of the mesh; the orange line is the path of contact, "
      "orange lines are lines of contact.",
      about};
  for (const auto& note : a.notes) page.introduction.push_back(note);
  page.charts = contact_charts(a);
  for (auto& f : contact_patterns(a))
    page.figures.push_back({std::move(f.caption), std::move(f.svg), std::move(f.note)});
  for (const auto& side : a.sides)
    for (auto& figure : ease_off::map_figures(ease_off_of(a, side), name_of(a, side)))
      page.figures.push_back(std::move(figure));
  page.tables = {contact_table(a)};
  ease_off::add_to_page(page, a.misaligned);
  if (a.loaded) under_load::add_to_page(page, *a.loaded);
  return study_page_html(page);
}

process::NamedFiles contact_files(const RolledPair& a, const std::string& about) {
  std::vector<ease_off::SideMap> maps;
  for (const auto& side : a.sides) maps.push_back(ease_off_of(a, side));
  return {{"contact.csv", contact_csv(a)},
          {"ease_off.csv", ease_off::map_csv(maps)},
          {"transmission.csv", transmission_csv(a)},
          {"contact.json", contact_json(a)},
          {"contact.html", contact_page(a, about)}};
}

std::string contact_section_body(const RolledPair& a) {
  std::string out =
      fmt::format("<p>Rolled with a {} of {} teeth as rigid bodies without load, marking compound of {:g} um.</p>\n",
                  a.other, a.pinion_teeth, a.settings.compound_mm * app::kUm);
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
    for (const auto& column : t.columns) out += fmt::format("<th scope=\"col\">{}</th>", svg::html_escape(column));
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

}  // namespace toothpath::rolled
