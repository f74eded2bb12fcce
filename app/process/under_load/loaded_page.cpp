#include "app/process/under_load/loaded_page.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/base/units.h"
#include "app/process/under_load/asked_besides.h"
#include "geometry/base/angle.h"

namespace toothpath::under_load {
namespace {

using loaded::LoadedPosition;

/// What edges carry, and under which pressure as far as their radius is known.
std::string edge_words(const LoadedContact& found, const LoadedSide& side) {
  if (!(found.settings.edge_radius_mm > 0)) return "edge contact: pressure undefined without edge_radius";
  const double p = range_of(side.cycle, [](const LoadedPosition& x) { return x.edge_pressure; }).most;
  return fmt::format("edges rounded by {:g} mm press with {:.0f} MPa at most", found.settings.edge_radius_mm, p);
}

using Cells = std::vector<std::pair<std::string, std::string>>;  // heading, value

/// A row of the table; what no side of this pair has is left out.
Cells row_of(const LoadedContact& found, const LoadedSide& side) {
  const auto of = [&](double (*what)(const LoadedPosition&), const char* format = "{:.1f} to {:.1f}") {
    const auto r = range_of(side.cycle, what);
    return fmt::format(fmt::runtime(format), r.least, r.most);
  };
  const auto error = range_of(side.cycle, [](const LoadedPosition& p) { return p.error_rad * app::kMicro; });
  std::string harmonics;
  for (int n = 1; n <= harmonics_of(side.cycle); ++n)
    harmonics += fmt::format("{}{:.4f}", n == 1 ? "" : " ", harmonic(side.cycle, n) * app::kMicro);
  Cells row = {
      {"flank", side.name},
      {"approach um", of([](const LoadedPosition& p) { return p.approach_mm * app::kUm; }, "{:.3f} to {:.3f}")},
      {"error p-p urad", fmt::format("{:.4f}", error.most - error.least)},
      {"harmonics urad", harmonics},
      {"stiffness N/um", of([](const LoadedPosition& p) { return p.stiffness / app::kUm; })}};
  if (found.segment_mm > 0) row.emplace_back("line mm", of([](const LoadedPosition& p) { return p.line_mm; }));
  row.emplace_back("pairs", of([](const LoadedPosition& p) { return double(p.pairs); }, "{:g} to {:g}"));
  if (found.rings > 1)
    row.emplace_back(fmt::format("outer {} %", found.words.ring),
                     of([](const LoadedPosition& p) { return outer_share(p) * 100; }));
  row.emplace_back("axial N", of(axial_of));
  row.emplace_back(fmt::format("axial, {} N", found.words.gear), of(gear_axial_of));
  row.emplace_back("pressure MPa", of([](const LoadedPosition& p) { return p.pressure; }, "{:.0f} to {:.0f}"));
  row.emplace_back("at line ends MPa", of([](const LoadedPosition& p) { return p.end_pressure; }, "{:.0f} to {:.0f}"));
  row.emplace_back("edge N/mm", of([](const LoadedPosition& p) { return p.end_line_load; }, "{:.0f} to {:.0f}"));
  if (found.settings.edge_radius_mm > 0)
    row.emplace_back("edge MPa", of([](const LoadedPosition& p) { return p.edge_pressure; }, "{:.0f} to {:.0f}"));
  return row;
}

}  // namespace

std::string loaded_summary(const LoadedContact& found) {
  std::string out = fmt::format("  under {:g} N m on the {}, pinion {} along its axis, rim {:g} mm, row of {} teeth:\n",
                                found.torque_gear_Nm, found.words.gear, found.floating ? "floating" : "held",
                                found.rim_mm, found.settings.row_teeth);
  for (const auto& side : found.sides) {
    const auto of = [&](double (*what)(const LoadedPosition&)) { return range_of(side.cycle, what); };
    const auto error = of([](const LoadedPosition&p) { return p.error_rad * app::kMicro; }),
               K = of([](const LoadedPosition&p) { return p.stiffness / app::kUm; }),
               X = of([](const LoadedPosition&p) { return p.approach_mm * app::kUm; }),
               p = of([](const LoadedPosition&x) { return x.pressure; }),
               end = of([](const LoadedPosition&x) { return x.end_pressure; }),
               pairs = of([](const LoadedPosition&x) { return double(x.pairs); }), share = of(outer_share),
               axial = of(axial_of), gear_axial = of(gear_axial_of);
    out += fmt::format("  {}: approach {:.3f} to {:.3f} um, transmission error {:.4g} urad peak to peak\n", side.name,
                       X.least, X.most, error.most - error.least);
    for (int n = 1; n <= harmonics_of(side.cycle); ++n)
      out += fmt::format("{}{:.4g}{}", n == 1 ? "    its harmonics of the tooth mesh " : ", ",
                         harmonic(side.cycle, n) * app::kMicro, n == harmonics_of(side.cycle) ? " urad\n" : "");
    out += fmt::format("    stiffness {:.1f} to {:.1f} N/um along the normals, {:g} to {:g} pairs carry\n", K.least,
                       K.most, pairs.least, pairs.most);
    const double edge = of([](const LoadedPosition& x) { return x.end_line_load; }).most;
    if (!on_cells(side.cycle))
      out += fmt::format("    pressure {:.0f} MPa at most, {:.0f} on the ends of lines\n", p.most, end.most);
    else if (edge == 0) out += fmt::format("    pressure {:.0f} MPa at most, no edge carries\n", p.most);
    else
      out += fmt::format(
          "    pressure {:.0f} MPa at most, {:.0f} N/mm along edges, whose pressure is that of their radius\n", p.most,
          edge);
    if (edge > 0) out += "    " + edge_words(found, side) + "\n";
    if (found.rings > 1)
      out += fmt::format(
          "    outer {} {:.1f} to {:.1f} % of the load, axial force {:.1f} to {:.1f} N (one helix {:.1f})\n",
          found.words.ring, share.least * 100, share.most * 100, axial.least, axial.most, side.cycle.single_axial_n);
    else out += fmt::format("    axial force {:.1f} to {:.1f} N\n", axial.least, axial.most);
    out += fmt::format("    axial force on the {} {:.1f} to {:.1f} N\n", found.words.gear, gear_axial.least,
                       gear_axial.most);
    out += besides_summary(found, side);
  }
  for (const auto& note : found.notes) out += "  note: " + note + "\n";
  return out;
}

namespace {

page::PageTable loaded_table(const LoadedContact& found) {
  page::PageTable t{"Under load", {}, {}, ""};
  t.note = fmt::format(
      "{:g} N m on the {}. Approach: along the normals. Harmonics: of the transmission error over a pitch. {} {} The "
      "back of the rim ({:g} mm) and the ends of a row of {} teeth are clamped: what holds them moves the stiffness "
      "more "
      "than anything else. No friction.",
      found.torque_gear_Nm, found.words.gear,
      on_cells(found.sides.front().cycle)
          ? "Pressure: on cells; that of cells beside an edge depends on the cell, as an ideal edge has no finite "
            "pressure."
          : fmt::format("Pressure: of the line contact of Hertz; that of the first and last piece of a line ({:g} mm) "
                        "depends on the piece, as an ideal edge has no finite pressure.",
                        found.segment_mm),
      found.settings.edge_radius_mm > 0
          ? fmt::format("Edge: its line load, and the pressure of its radius, {:g} mm.", found.settings.edge_radius_mm)
          : "Edge: its line load; without edge_radius its pressure is undefined.",
      found.rim_mm, found.settings.row_teeth);
  for (const auto& side : found.sides) {
    const Cells row = row_of(found, side);
    const bool first = t.rows.empty();
    t.rows.emplace_back();
    for (const auto& [heading, value] : row) {
      if (first) t.columns.push_back(heading);
      t.rows.back().push_back(value);
    }
  }
  return t;
}

}  // namespace

std::vector<page::PageTable> loaded_tables(const LoadedContact& found) {
  std::vector<page::PageTable> tables = {loaded_table(found)};
  for (auto& table : besides_tables(found)) tables.push_back(std::move(table));
  return tables;
}

std::vector<svg::LineChart> loaded_charts(const LoadedContact& found) {
  const auto over_pitch = [&](std::string title, std::string y, double (*of)(const LoadedPosition&), std::string note) {
    svg::LineChart c;
    c.title = std::move(title), c.x_label = "pinion turn [pitches]", c.y_label = std::move(y), c.note = std::move(note);
    for (const auto& side : found.sides) {
      svg::ChartSeries s{side.name, {}, {}};
      for (std::size_t k = 0; k < side.cycle.positions.size(); ++k) {
        s.x.push_back(double(k) / double(side.cycle.positions.size()));
        s.y.push_back(of(side.cycle.positions[k]));
      }
      c.series.push_back(std::move(s));
    }
    return c;
  };
  std::vector<svg::LineChart> charts = {
      over_pitch(
          "Loaded transmission error", fmt::format("{} lags [\u00b5rad]", found.words.gear),
          [](const LoadedPosition& p) { return p.error_rad * app::kMicro; }, "Elastic teeth; shaft and body rigid."),
      over_pitch(
          "Mesh stiffness", "F/X [N/\u00b5m]", [](const LoadedPosition& p) { return p.stiffness / app::kUm; },
          "Secant, along the contact normals.")};
  if (found.rings > 1) {
    charts.push_back(over_pitch(
        fmt::format("Share of the outer {}", found.words.ring), "share [%]",
        [](const LoadedPosition& p) { return std::round(outer_share(p) * 1e8) * 1e-6; }, ""));
    charts.push_back(over_pitch("Axial force on the pinion", "force [N]", axial_of,
                                fmt::format("Away from the {}'s axis when positive.", found.words.gear)));
  }
  for (const auto& side : found.sides) {
    svg::LineChart c;
    c.title = "Pressure along the lines, " + side.name;
    c.x_label = found.words.along, c.y_label = "pressure [MPa]";
    c.note = on_cells(side.cycle)
                 ? "At the first position; one curve a tooth: the largest pressure of every row of cells."
                 : "At the first position; one curve a line. The ends belong to edges.";
    int ring = -1, tooth = 0;
    for (const auto& s : side.cycle.positions.front().segments) {
      if (s.place.beyond > 0) continue;
      if (s.place.ring != ring || s.place.tooth != tooth) {
        ring = s.place.ring, tooth = s.place.tooth;
        c.series.push_back({fmt::format("{} {}, tooth {}", found.words.ring, ring, tooth), {}, {}});
      }
      c.series.back().x.push_back(s.place.r);
      c.series.back().y.push_back(s.pressure);
    }
    charts.push_back(std::move(c));
  }
  return charts;
}

void add_to_page(page::StudyPage& page, const LoadedContact& found) {
  page.introduction.push_back(fmt::format(
      "Under load both members are elastic: {:g} N m on the {}, the pinion {} along its axis. All teeth and {} share "
      "it; "
      "the first touch of the unloaded flanks is the zero of approach and transmission error.",
      found.torque_gear_Nm, found.words.gear, found.floating ? "floats" : "is held", found.words.rings));
  for (const auto& note : found.notes) page.introduction.push_back(note);
  for (auto& table : loaded_tables(found)) page.tables.push_back(std::move(table));
  for (auto& chart : loaded_charts(found)) page.charts.push_back(std::move(chart));
}

void add_files(process::NamedFiles& files, const LoadedContact& found) {
  files.emplace_back("loaded.csv", loaded_csv(found));
  files.emplace_back("pressure.csv", pressure_csv(found));
  if (found.settings.root_stress) files.emplace_back("root_stress.csv", root_csv(found));
}

}  // namespace toothpath::under_load
