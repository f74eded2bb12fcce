#include "app/process/face/loaded_contact.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/base/units.h"
#include "app/job/file.h"
#include "geometry/base/angle.h"
#include "geometry/loaded/ccx_deck.h"

namespace toothpath::face {
namespace {

using loaded::LoadedPosition;

constexpr double kPinionFillet = 0.24;            // of the module
constexpr double kLinear = 0.05;                  // mm: a larger approach is beyond linear theory
constexpr double kYield = 1.6 * 850;              // MPa: crests of hardened steel flatten
constexpr double kSteelLow = 8, kSteelHigh = 25;  // N/(mm um) of line

double outer_share(const LoadedPosition& p) {
  double sum = 0;
  for (const double f : p.ring_force) sum += f;
  return p.ring_force.back() / sum;
}
/// Rounding of a balance is no force.
double axial_of(const LoadedPosition& p) { return std::abs(p.axial_n) < 1e-6 ? 0.0 : p.axial_n; }
bool on_cells(const loaded::LoadedCycle& cycle) { return cycle.positions.front().cells; }

/// Amplitude of the n-th harmonic of the transmission error over a pitch, rad.
double harmonic(const loaded::LoadedCycle& cycle, int n) {
  double c = 0, s = 0;
  const auto count = static_cast<double>(cycle.positions.size());
  for (std::size_t k = 0; k < cycle.positions.size(); ++k) {
    const double angle = 2 * kPi * n * static_cast<double>(k) / count;
    c += cycle.positions[k].error_rad * std::cos(angle), s += cycle.positions[k].error_rad * std::sin(angle);
  }
  return std::hypot(c, s) * 2 / count;
}
/// As many as the positions resolve, three at most.
int harmonics_of(const loaded::LoadedCycle& cycle) {
  return std::min(3, (static_cast<int>(cycle.positions.size()) - 1) / 2);
}
/// On cells an edge has no pressure of its own.
double largest_pressure(const LoadedPosition& p) { return p.cells ? p.pressure : std::max(p.pressure, p.end_pressure); }

/// Deviation of a cut flank at radius r and height z, bilinear on its grid; beyond it that of its rim.
double deviation_at(const contact::ContactFlank& f, double r, double z) {
  const auto place = [](double x, int n, const auto& value) {  // index and share, values rising or falling
    const bool rises = value(n - 1) > value(0);
    int low = 0, high = n - 1;
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      ((value(middle) > x) == rises ? high : low) = middle;
    }
    const double share = (x - value(low)) / (value(high) - value(low));
    return std::pair(low, std::clamp(share, 0.0, 1.0));
  };
  const auto [c, across] = place(r, f.columns, [&](int k) { return radius(f.points[f.index(f.rows / 2, k)]); });
  double sum = 0;
  for (int k = 0; k < 2; ++k) {
    const int column = c + k;
    const auto [row, up] = place(z, f.rows, [&](int n) { return f.points[f.index(n, column)].z(); });
    sum += (k == 0 ? 1 - across : across) *
           ((1 - up) * f.deviation_mm[f.index(row, column)] + up * f.deviation_mm[f.index(row + 1, column)]);
  }
  return sum;
}

/// Material that is left closes the gap: mean over the piece of a line.
double gap_of_cut(const std::vector<const contact::ContactFlank*>& flanks, const loaded::Segment& s) {
  for (const auto* flank : flanks) {
    if (flank->zone != s.ring) continue;
    constexpr int kPlaces = 9;
    double sum = 0;
    for (int k = 0; k < kPlaces; ++k) {
      const Vec3 p = s.nearest + s.along * (s.length * ((k + 0.5) / kPlaces - 0.5));
      sum += deviation_at(*flank, radius(p), p.z()) / kPlaces;
    }
    return -sum;
  }
  return 0;
}

/// What modifications take off gear and pinion opens the gap: mean over the piece of a line.
double gap_of_modifications(const std::vector<const contact::ContactMember*>& members, const loaded::Segment& s) {
  double sum = 0;
  for (const auto* one : members) {
    const contact::ContactMember& member = *one;
    if (member.flank.zone != s.ring) continue;
    constexpr int kPlaces = 9;
    for (int k = 0; k < kPlaces; ++k) {
      const Vec3 p = s.nearest + s.along * (s.length * ((k + 0.5) / kPlaces - 0.5));
      if (member.flank.modified)
        if (const auto* drawn = member.flank.modified->field(member.flank.side).drawn)
          sum += drawn->removal(face_gear::FlankField::depth<double>(member.flank.surface, p, radius(p)), radius(p)) /
                 kPlaces;
      if (!member.on_pinion) continue;
      const auto place = member.pinion.place(p);
      sum += member.on_pinion->removal(member.pinion.r_a - place.radius, place.Z) / kPlaces;
    }
  }
  return sum;
}

std::string name_of(const LoadedSide& side) {
  return fmt::format("flank {:+}, {}", side.side, side.as_cut ? "as cut" : "exact");
}
const char* surface_of(const LoadedSide& side) { return side.as_cut ? "cut" : "exact"; }

/// What is worth a word about one flank.
void remark(const LoadedSide& side, bool steel, std::vector<std::string>& notes) {
  const auto each = [&](const auto& of) { return range_of(side.cycle, of); };
  const double p = each([](const LoadedPosition&x) { return largest_pressure(x); }).most,
               X = each([](const LoadedPosition&x) { return x.approach_mm; }).most;
  if (p > kYield || X > kLinear)
    notes.push_back(
        fmt::format("{}: pressure {:.0f} MPa, approach {:.1f} um: beyond linear theory, flanks flatten "
                    "plastically",
                    name_of(side), p, X * app::kUm));
  const auto per_line = each([](const LoadedPosition& x) { return x.stiffness / x.line_mm / app::kUm; });
  if (steel && !on_cells(side.cycle) && (per_line.least < kSteelLow || per_line.most > kSteelHigh))
    notes.push_back(
        fmt::format("{}: stiffness {:.1f} to {:.1f} N/(mm um) of line; steel gears with all lines "
                    "bearing have 13 to 16",
                    name_of(side), per_line.least, per_line.most));
  for (const auto& position : side.cycle.positions)
    if (position.pressure == 0) {
      notes.push_back(
          fmt::format("{}: the load stands on the ends of lines only at some positions: the pressure "
                      "there is that of the {}, {:.0f} N/mm at most",
                      name_of(side), on_cells(side.cycle) ? "cells" : "segments",
                      each([](const LoadedPosition& x) { return x.end_line_load; }).most));
      break;
    }
}

nlohmann::ordered_json range_json(const LoadedRange& r) {
  return {{"least", r.least}, {"most", r.most}, {"mean", r.mean}};
}

}  // namespace

LoadedRange range_of(const loaded::LoadedCycle& cycle, double (*of)(const LoadedPosition&)) {
  LoadedRange r{1e300, -1e300, 0};
  for (const auto& p : cycle.positions) {
    const double value = of(p);
    r.least = std::min(r.least, value);
    r.most = std::max(r.most, value);
    r.mean += value / static_cast<double>(cycle.positions.size());
  }
  return r;
}

Result<loaded::PairOptions> pair_options(const job::ContactLoad& load, const face_gear::FaceGear& gear,
                                         const contact::Misalignment& moved) {
  const double m = gear.parameters().module_mm;
  loaded::PairOptions options;
  const double rim = load.rim_mm.value_or(5 * m);
  if (!(rim >= 0.5 * m) || !(rim < gear.inner_radius()))
    return fail("rim = {:g} mm is not between half the module, {:g} mm, and the inner radius, {:g} mm", rim, 0.5 * m,
                gear.inner_radius());
  for (auto* body : {&options.gear, &options.pinion}) {
    const std::size_t k = body == &options.gear ? 0 : 1;
    body->E = load.youngs_modulus_N_mm2[k];
    body->nu = load.poisson[k];
    body->teeth = load.row_teeth;
    body->bricks.rim_mm = rim;
  }
  options.segment_mm = load.segment_mm.value_or(0.3 * m);
  options.pinion_fillet_mm = kPinionFillet * m;
  options.moved = moved;
  return options;
}

process::ValueOrErrors<LoadedContact> analyse_loaded(const job::Job& job, const face_gear::FaceGear& gear,
                                                     const job::ContactSettings& settings, int pinion_teeth,
                                                     const std::vector<const contact::ContactMember*>& exact,
                                                     const std::vector<const contact::ContactFlank*>& cut) {
  LoadedContact found;
  found.settings = settings.load.value();
  const job::ContactLoad& load = found.settings;
  const face_gear::FaceGearParameters& p = gear.parameters();
  found.rings = static_cast<int>(p.zones.size());
  found.pinion_teeth = pinion_teeth;
  found.torque_gear_Nm = load.on_pinion ? load.torque_Nm * p.teeth / pinion_teeth : load.torque_Nm;
  const bool opposite = p.zones.size() == 2 && p.zones[0].helix_angle_rad * p.zones[1].helix_angle_rad < 0;
  if (load.pinion_axial == job::PinionHold::floating && !opposite)
    return std::vector{
        process::located(job, "contact.load.pinion_axial",
                         fail("pinion_axial = \"floating\" needs two rings of opposite hand: nothing else "
                              "keeps the pinion in its place"))};
  found.floating =
      load.pinion_axial == job::PinionHold::floating || (load.pinion_axial == job::PinionHold::automatic && opposite);
  found.pitch_radius_mm = gear.rings().front().surface.L_p;
  const auto options = pair_options(load, gear, settings.moved);
  if (!options) return std::vector{process::located(job, "contact.load.rim", options.error())};
  found.segment_mm = options->segment_mm;
  found.rim_mm = options->gear.bricks.rim_mm;
  const char* teeth_key = settings.pinion_teeth > 0 ? "contact.pinion_teeth" : "gear.mate_teeth";
  const bool steel =
      std::abs(load.youngs_modulus_N_mm2[0] - 210e3) < 15e3 && std::abs(load.youngs_modulus_N_mm2[1] - 210e3) < 15e3;
  for (const int side : {1, -1}) {
    auto pair = loaded::make_loaded_pair(gear, side, pinion_teeth, *options);
    if (!pair) return std::vector{process::located(job, teeth_key, pair.error())};
    std::vector<const contact::ContactMember*> modified;
    for (const auto* member : exact)
      if (member->flank.side == side && member->modified()) modified.push_back(member);
    if (!modified.empty())
      pair->options.gap = [&modified](const loaded::Segment& s) { return gap_of_modifications(modified, s); };
    const loaded::Load carried{found.torque_gear_Nm * 1000,
                               found.floating                                 ? loaded::PinionAxial::floating
                               : load.pinion_axial == job::PinionHold::spring ? loaded::PinionAxial::spring
                                                                              : loaded::PinionAxial::held,
                               load.axial_stiffness_N_mm, load.positions};
    auto cycle = loaded::loaded_cycle(*pair, carried);
    if (!cycle) return std::vector{process::located(job, "contact.load", cycle.error())};
    found.sides.push_back({side, false, std::move(*cycle)});
    remark(found.sides.back(), steel, found.notes);
    std::vector<const contact::ContactFlank*> of_side;
    for (const auto* flank : cut)
      if (flank->side == side) of_side.push_back(flank);
    if (of_side.empty()) continue;
    loaded::LoadedPair rough = *pair;
    rough.options.gap = [&](const loaded::Segment& s) {
      return gap_of_cut(of_side, s) + gap_of_modifications(modified, s);
    };
    auto worn = loaded::loaded_cycle(rough, carried);
    if (!worn) return std::vector{process::located(job, "contact.load", worn.error())};
    found.sides.push_back({side, true, std::move(*worn)});
    remark(found.sides.back(), false, found.notes);
  }
  return found;
}

process::ValueOrErrors<process::NamedFiles> loaded_decks(const job::Job& job, const face_gear::FaceGear& gear,
                                                         const LoadedContact& found) {
  if (found.pinion_teeth != gear.parameters().shaper_teeth)
    return std::vector{fail_at(job.where("gear.shaper_teeth"),
                               "--ccx is for a pinion of as many teeth as the shaper, {}, not {}",
                               gear.parameters().shaper_teeth, found.pinion_teeth)};
  process::NamedFiles files;
  for (int ring = 0; ring < found.rings; ++ring)
    for (const auto& side : found.sides) {
      if (side.as_cut) continue;
      loaded::DeckOptions options;
      options.bricks.rim_mm = found.rim_mm;
      options.teeth = found.settings.row_teeth;
      options.E = found.settings.youngs_modulus_N_mm2[0], options.nu = found.settings.poisson[0];
      options.pinion_fillet_mm = kPinionFillet * gear.parameters().module_mm;
      options.approach_mm = range_of(side.cycle, [](const LoadedPosition& p) { return p.approach_mm; }).mean;
      auto deck = loaded::contact_deck(gear, ring, side.side, options);
      if (!deck) return std::vector{process::located(job, fmt::format("gear.zone[{}]", ring), deck.error())};
      files.emplace_back(fmt::format("ring_{}_flank_{}.inp", ring, side.side > 0 ? "plus" : "minus"), std::move(*deck));
    }
  return files;
}

std::string loaded_csv(const LoadedContact& found) {
  std::string out =
      "surface,flank,position,phi_1_deg,approach_um,error_urad,stiffness_N_um,tangent_N_um,line_mm,pairs,outer_share,"
      "axial_N,"
      "pressure_MPa,end_pressure_MPa,end_line_load_N_mm,shift_um\n";
  for (const auto& side : found.sides)
    for (std::size_t k = 0; k < side.cycle.positions.size(); ++k) {
      const LoadedPosition& p = side.cycle.positions[k];
      out += fmt::format(
          "{},{},{},{:.6f},{:.6f},{:.6f},{:.4f},{:.4f},{:.4f},{},{:.6f},{:.4f},{:.3f},{:.3f},{:.3f},{:.6f}\n",
          surface_of(side), side.side, k, degrees(p.phi), p.approach_mm * app::kUm, p.error_rad * app::kMicro,
          p.stiffness / app::kUm, p.tangent / app::kUm, p.line_mm, p.pairs, outer_share(p), p.axial_n, p.pressure,
          p.end_pressure, p.end_line_load, p.shift_mm * app::kUm);
    }
  return out;
}

std::string pressure_csv(const LoadedContact& found) {
  std::string out =
      "surface,flank,position,ring,tooth,r,z,length,force_N,pressure_MPa,half_width,radius_of_curvature,place\n";
  for (const auto& side : found.sides)
    for (std::size_t k = 0; k < side.cycle.positions.size(); ++k)
      for (const auto& s : side.cycle.positions[k].segments)
        out += fmt::format("{},{},{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.3f},{:.5f},{:.3f},{}\n", surface_of(side),
                           side.side, k, s.place.ring, s.place.tooth, s.place.r, s.place.nearest.z(), s.place.length,
                           s.force, s.pressure, s.half_width, 1 / s.place.curvature,
                           s.place.beyond > 0 ? "beyond"
                           : s.place.at_end   ? "end"
                                              : "inner");
  return out;
}

nlohmann::ordered_json loaded_json(const LoadedContact& found) {
  nlohmann::ordered_json json;
  json["torque_gear_Nm"] = found.torque_gear_Nm;
  json["pinion_axial"] = found.floating                                           ? "floating"
                         : found.settings.pinion_axial == job::PinionHold::spring ? "spring"
                                                                                  : "held";
  json["segment_mm"] = found.segment_mm;
  json["rim_mm"] = found.rim_mm;
  json["row_teeth"] = found.settings.row_teeth;
  json["flanks"] = nlohmann::ordered_json::array();
  for (const auto& side : found.sides) {
    const auto range = [&](double (*of)(const LoadedPosition&)) { return range_json(range_of(side.cycle, of)); };
    const auto error = range_of(side.cycle, [](const LoadedPosition& p) { return p.error_rad * app::kMicro; });
    nlohmann::ordered_json harmonics = nlohmann::ordered_json::array();
    for (int n = 1; n <= harmonics_of(side.cycle); ++n) harmonics.push_back(harmonic(side.cycle, n) * app::kMicro);
    json["flanks"].push_back(
        {{"model", on_cells(side.cycle) ? "cells" : "strips"},
         {"surface", surface_of(side)},
         {"side", side.side},
         {"normal_N", side.cycle.normal_n},
         {"approach_um", range([](const LoadedPosition& p) { return p.approach_mm * app::kUm; })},
         {"transmission_error_urad",
          {{"range", error.most - error.least}, {"mean", error.mean}, {"harmonics", harmonics}}},
         {"stiffness_N_um", range([](const LoadedPosition& p) { return p.stiffness / app::kUm; })},
         {"tangent_stiffness_N_um", range([](const LoadedPosition& p) { return p.tangent / app::kUm; })},
         {"line_mm", range([](const LoadedPosition& p) { return p.line_mm; })},
         {"pairs", range([](const LoadedPosition& p) { return double(p.pairs); })},
         {"outer_share", range(outer_share)},
         {"axial_N", range(axial_of)},
         {"single_helix_axial_N", side.cycle.single_axial_n},
         {"outer_share_change_per_um", range([](const LoadedPosition& p) { return p.share_per_mm / app::kUm; })},
         {"pressure_MPa", range([](const LoadedPosition& p) { return p.pressure; })},
         {"end_pressure_MPa", range([](const LoadedPosition& p) { return p.end_pressure; })},
         {"end_line_load_N_mm", range([](const LoadedPosition& p) { return p.end_line_load; })}});
  }
  json["notes"] = found.notes;
  return json;
}

std::string loaded_summary(const LoadedContact& found) {
  std::string out =
      fmt::format("  under {:g} N m on the gear, pinion {} along its axis, rim {:g} mm, row of {} teeth:\n",
                  found.torque_gear_Nm, found.floating ? "floating" : "held", found.rim_mm, found.settings.row_teeth);
  for (const auto& side : found.sides) {
    const auto of = [&](double (*what)(const LoadedPosition&)) { return range_of(side.cycle, what); };
    const auto error = of([](const LoadedPosition&p) { return p.error_rad * app::kMicro; }),
               K = of([](const LoadedPosition&p) { return p.stiffness / app::kUm; }),
               X = of([](const LoadedPosition&p) { return p.approach_mm * app::kUm; }),
               p = of([](const LoadedPosition&x) { return x.pressure; }),
               end = of([](const LoadedPosition&x) { return x.end_pressure; }),
               pairs = of([](const LoadedPosition&x) { return double(x.pairs); }), share = of(outer_share),
               axial = of(axial_of);
    out += fmt::format("  {}: approach {:.3f} to {:.3f} um, transmission error {:.4g} urad peak to peak\n",
                       name_of(side), X.least, X.most, error.most - error.least);
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
    if (found.rings > 1)
      out += fmt::format(
          "    outer ring {:.1f} to {:.1f} % of the load, axial force {:.1f} to {:.1f} N (one helix {:.1f})\n",
          share.least * 100, share.most * 100, axial.least, axial.most, side.cycle.single_axial_n);
    else out += fmt::format("    axial force {:.1f} to {:.1f} N\n", axial.least, axial.most);
  }
  for (const auto& note : found.notes) out += "  note: " + note + "\n";
  return out;
}

page::PageTable loaded_table(const LoadedContact& found) {
  page::PageTable t{"Under load",
                    {"flank", "approach um", "error p-p urad", "harmonics urad", "stiffness N/um", "line mm", "pairs",
                     "outer ring %", "axial N", "pressure MPa", "at line ends MPa"},
                    {},
                    ""};
  t.note = fmt::format(
      "{:g} N m on the gear. Approach: along the normals. Harmonics: of the transmission error over a pitch. {} The "
      "back "
      "of the rim ({:g} mm) and the ends of a row of {} teeth are clamped: what holds them moves the stiffness more "
      "than "
      "anything else. No friction.",
      found.torque_gear_Nm,
      on_cells(found.sides.front().cycle)
          ? "Pressure: on cells; that of cells beside an edge depends on the cell, as an ideal edge has no finite "
            "pressure."
          : fmt::format("Pressure: of the line contact of Hertz; that of the first and last piece of a line ({:g} mm) "
                        "depends on the piece, as an ideal edge has no finite pressure.",
                        found.segment_mm),
      found.rim_mm, found.settings.row_teeth);
  for (const auto& side : found.sides) {
    const auto of = [&](double (*what)(const LoadedPosition&), const char* format = "{:.1f} to {:.1f}") {
      const auto r = range_of(side.cycle, what);
      return fmt::format(fmt::runtime(format), r.least, r.most);
    };
    const auto error = range_of(side.cycle, [](const LoadedPosition& p) { return p.error_rad * app::kMicro; });
    std::string harmonics;
    for (int n = 1; n <= harmonics_of(side.cycle); ++n)
      harmonics += fmt::format("{}{:.4f}", n == 1 ? "" : " ", harmonic(side.cycle, n) * app::kMicro);
    t.rows.push_back({name_of(side),
                      of([](const LoadedPosition& p) { return p.approach_mm * app::kUm; }, "{:.3f} to {:.3f}"),
                      fmt::format("{:.4f}", error.most - error.least), harmonics,
                      of([](const LoadedPosition& p) { return p.stiffness / app::kUm; }),
                      of([](const LoadedPosition& p) { return p.line_mm; }),
                      of([](const LoadedPosition& p) { return double(p.pairs); }, "{:g} to {:g}"),
                      of([](const LoadedPosition& p) { return outer_share(p) * 100; }), of(axial_of),
                      of([](const LoadedPosition& p) { return p.pressure; }, "{:.0f} to {:.0f}"),
                      of([](const LoadedPosition& p) { return p.end_pressure; }, "{:.0f} to {:.0f}")});
  }
  return t;
}

std::vector<svg::LineChart> loaded_charts(const LoadedContact& found) {
  const auto over_pitch = [&](std::string title, std::string y, double (*of)(const LoadedPosition&), std::string note) {
    svg::LineChart c;
    c.title = std::move(title), c.x_label = "pinion turn [pitches]", c.y_label = std::move(y), c.note = std::move(note);
    for (const auto& side : found.sides) {
      svg::ChartSeries s{name_of(side), {}, {}};
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
          "Loaded transmission error", "gear lags [\u00b5rad]",
          [](const LoadedPosition& p) { return p.error_rad * app::kMicro; }, "Elastic teeth; shaft and body rigid."),
      over_pitch(
          "Mesh stiffness", "F/X [N/\u00b5m]", [](const LoadedPosition& p) { return p.stiffness / app::kUm; },
          "Secant, along the contact normals.")};
  if (found.rings > 1) {
    charts.push_back(over_pitch(
        "Share of the outer ring", "share [%]",
        [](const LoadedPosition& p) { return std::round(outer_share(p) * 1e8) * 1e-6; }, ""));
    charts.push_back(
        over_pitch("Axial force on the pinion", "force [N]", axial_of, "Away from the gear's axis when positive."));
  }
  for (const auto& side : found.sides) {
    svg::LineChart c;
    c.title = "Pressure along the lines, " + name_of(side);
    c.x_label = "radius from the gear's axis [mm]", c.y_label = "pressure [MPa]";
    c.note = on_cells(side.cycle)
                 ? "At the first position; one curve a tooth: the largest pressure of every row of cells."
                 : "At the first position; one curve a line. The ends belong to edges.";
    int ring = -1, tooth = 0;
    for (const auto& s : side.cycle.positions.front().segments) {
      if (s.place.beyond > 0) continue;
      if (s.place.ring != ring || s.place.tooth != tooth) {
        ring = s.place.ring, tooth = s.place.tooth;
        c.series.push_back({fmt::format("ring {}, tooth {}", ring, tooth), {}, {}});
      }
      c.series.back().x.push_back(s.place.r);
      c.series.back().y.push_back(s.pressure);
    }
    charts.push_back(std::move(c));
  }
  return charts;
}

}  // namespace toothpath::face
