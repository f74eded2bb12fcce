#include "app/process/under_load/loaded_contact.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/base/units.h"
#include "app/process/under_load/asked_besides.h"
#include "geometry/base/angle.h"

namespace toothpath::under_load {
namespace {

using loaded::LoadedPosition;

constexpr double kLinear = 0.05;                  // mm: a larger approach is beyond linear theory
constexpr double kYield = 1.6 * 850;              // MPa: crests of hardened steel flatten
constexpr double kSteelLow = 8, kSteelHigh = 25;  // N/(mm um) of line
constexpr double kNoForce = 1e-6;                 // N

/// On cells an edge has no pressure of its own.
double largest_pressure(const LoadedPosition& p) { return p.cells ? p.pressure : std::max(p.pressure, p.end_pressure); }
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
                    side.name, p, X * app::kUm));
  const auto per_line = each([](const LoadedPosition& x) { return x.stiffness / x.line_mm / app::kUm; });
  if (steel && !on_cells(side.cycle) && (per_line.least < kSteelLow || per_line.most > kSteelHigh))
    notes.push_back(
        fmt::format("{}: stiffness {:.1f} to {:.1f} N/(mm um) of line; steel gears with all lines "
                    "bearing have 13 to 16",
                    side.name, per_line.least, per_line.most));
  for (const auto& position : side.cycle.positions)
    if (position.pressure == 0) {
      notes.push_back(
          fmt::format("{}: the load stands on the ends of lines only at some positions: the pressure "
                      "there is that of the {}, {:.0f} N/mm at most",
                      side.name, on_cells(side.cycle) ? "cells" : "segments",
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

double outer_share(const LoadedPosition& p) {
  double sum = 0;
  for (const double f : p.ring_force) sum += f;
  return p.ring_force.back() / sum;
}
double axial_of(const LoadedPosition& p) { return std::abs(p.axial_n) < kNoForce ? 0.0 : p.axial_n; }
double gear_axial_of(const LoadedPosition& p) { return std::abs(p.gear_axial_n) < kNoForce ? 0.0 : p.gear_axial_n; }
bool on_cells(const loaded::LoadedCycle& cycle) { return cycle.positions.front().cells; }

double harmonic(const loaded::LoadedCycle& cycle, int n) {
  double c = 0, s = 0;
  const auto count = static_cast<double>(cycle.positions.size());
  for (std::size_t k = 0; k < cycle.positions.size(); ++k) {
    const double angle = 2 * kPi * n * static_cast<double>(k) / count;
    c += cycle.positions[k].error_rad * std::cos(angle), s += cycle.positions[k].error_rad * std::sin(angle);
  }
  return std::hypot(c, s) * 2 / count;
}
int harmonics_of(const loaded::LoadedCycle& cycle) {
  return std::min(3, (static_cast<int>(cycle.positions.size()) - 1) / 2);
}

const char* word_of_axial(const LoadedContact& found) {
  return found.floating ? "floating" : found.settings.pinion_axial == job::PinionHold::spring ? "spring" : "held";
}

loaded::Load load_of(const LoadedContact& found, double torque_Nm) {
  const job::ContactLoad& load = found.settings;
  return {torque_Nm * 1000,
          found.floating                                 ? loaded::PinionAxial::floating
          : load.pinion_axial == job::PinionHold::spring ? loaded::PinionAxial::spring
                                                         : loaded::PinionAxial::held,
          load.axial_stiffness_N_mm, load.positions};
}

std::array<loaded::BodyPlan, 2> body_plans(const job::ContactLoad& load, double rim_mm) {
  std::array<loaded::BodyPlan, 2> plans;
  for (std::size_t k = 0; k < 2; ++k) {
    plans[k].E = load.youngs_modulus_N_mm2[k];
    plans[k].nu = load.poisson[k];
    plans[k].teeth = load.row_teeth;
    plans[k].bricks.rim_mm = load.rim_mm.value_or(rim_mm);
  }
  return plans;
}

bool is_steel(const job::ContactLoad& load) {
  return std::abs(load.youngs_modulus_N_mm2[0] - 210e3) < 15e3 && std::abs(load.youngs_modulus_N_mm2[1] - 210e3) < 15e3;
}

void add_side(LoadedContact& found, LoadedSide side, bool steel) {
  found.sides.push_back(std::move(side));
  remark(found.sides.back(), steel, found.notes);
}

std::string loaded_csv(const LoadedContact& found) {
  std::string out =
      "surface,flank,position,phi_1_deg,approach_um,error_urad,stiffness_N_um,tangent_N_um,line_mm,pairs,outer_share,"
      "axial_N,"
      "pressure_MPa,end_pressure_MPa,end_line_load_N_mm,shift_um,gear_axial_N,edge_pressure_MPa,"
      "gear_torque_Nm,pinion_torque_Nm";
  out += found.settings.friction ? ",friction_axial_N,friction_torque_percent\n" : "\n";
  for (const auto& side : found.sides)
    for (std::size_t k = 0; k < side.cycle.positions.size(); ++k) {
      const LoadedPosition& p = side.cycle.positions[k];
      out += fmt::format(
          "{},{},{},{:.6f},{:.6f},{:.6f},{:.4f},{:.4f},{:.4f},{},{:.6f},{:.4f},{:.3f},{:.3f},{:.3f},{:.6f},{:.4f},{:."
          "3f},{:.6f},{:.6f}",
          surface_of(side), side.side, k, degrees(p.phi), p.approach_mm * app::kUm, p.error_rad * app::kMicro,
          p.stiffness / app::kUm, p.tangent / app::kUm, p.line_mm, p.pairs, outer_share(p), p.axial_n, p.pressure,
          p.end_pressure, p.end_line_load, p.shift_mm * app::kUm, p.gear_axial_n, p.edge_pressure,
          p.gear_torque_nmm / 1000, p.pinion_torque_nmm / 1000);
      if (!side.friction.empty())
        out += fmt::format(",{:.4f},{:.5f}", side.friction[k].axial_n, 100 * side.friction[k].torque_part);
      out += "\n";
    }
  return out;
}

std::string pressure_csv(const LoadedContact& found) {
  std::string out = fmt::format(
      "surface,flank,position,ring,tooth,{},length,force_N,pressure_MPa,half_width,radius_of_curvature,place\n",
      found.words.columns);
  for (const auto& side : found.sides)
    for (std::size_t k = 0; k < side.cycle.positions.size(); ++k)
      for (const auto& s : side.cycle.positions[k].segments)
        out += fmt::format("{},{},{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.3f},{:.5f},{:.3f},{}\n", surface_of(side),
                           side.side, k, s.place.ring, s.place.tooth, s.place.r, s.place.z, s.place.length, s.force,
                           s.pressure, s.half_width, 1 / s.place.curvature,
                           s.place.beyond > 0 ? "beyond"
                           : s.place.at_end   ? "end"
                                              : "inner");
  return out;
}

nlohmann::ordered_json loaded_json(const LoadedContact& found) {
  nlohmann::ordered_json json;
  json["torque_gear_Nm"] = found.torque_gear_Nm;
  json["pinion_axial"] = word_of_axial(found);
  if (found.segment_mm > 0) json["segment_mm"] = found.segment_mm;
  json["rim_mm"] = found.rim_mm;
  if (found.pinion_rim_mm > 0) json["pinion_rim_mm"] = found.pinion_rim_mm;
  if (found.settings.edge_radius_mm > 0) json["edge_radius_mm"] = found.settings.edge_radius_mm;
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
         {"name", side.name},
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
         {"gear_axial_N", range(gear_axial_of)},
         {"gear_torque_Nm", range([](const LoadedPosition& p) { return p.gear_torque_nmm / 1000; })},
         {"pinion_torque_Nm", range([](const LoadedPosition& p) { return p.pinion_torque_nmm / 1000; })},
         {"single_helix_axial_N", side.cycle.single_axial_n},
         {"outer_share_change_per_um", range([](const LoadedPosition& p) { return p.share_per_mm / app::kUm; })},
         {"pressure_MPa", range([](const LoadedPosition& p) { return p.pressure; })},
         {"end_pressure_MPa", range([](const LoadedPosition& p) { return p.end_pressure; })},
         {"end_line_load_N_mm", range([](const LoadedPosition& p) { return p.end_line_load; })}});
    if (found.settings.edge_radius_mm > 0)
      json["flanks"].back()["edge_pressure_MPa"] = range([](const LoadedPosition& p) { return p.edge_pressure; });
    add_besides(json["flanks"].back(), found, side);
  }
  json["notes"] = found.notes;
  return json;
}

}  // namespace toothpath::under_load
