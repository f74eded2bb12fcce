// The offset face gear of the gear-shaping paper and a shaper to cut it, for the tests.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "geometry/base/angle.h"
#include "postproc/shaper/control.h"
#include "postproc/shaper/setup.h"
#include "tests/support/sample_gears.h"
#include "tests/support/shaper_program_reader.h"

namespace toothpath::test {

inline machines::ShaperMachine shaper_machine(const std::string& sign_a = "1", const std::string& sign_c = "1") {
  const std::string text =
      "schema = 1\nname = \"test shaper\"\nkind = \"gear_shaper\"\ndialect = \"linuxcnc\"\nassumed = [\"stroke\"]\n"
      "[stroke]\nsteps = [125, 179, 253, 359]\nmax_length = 125.0\nrelief = 0.5\n"
      "[index]\nconstant = [12, 5]\n[feed]\nconstant = [750, 1]\n"
      "[gears]\nteeth = [20, 24, 25, 30, 32, 36, 40, 44, 45, 47, 50, 55, 60, 65, 70, 75, 80, 89, 97]\nmesh_margin = "
      "15\n"
      "[axes.X]\nmin = -5.0\nmax = 200.0\nmax_speed = 20000\n"
      "[axes.Y]\nmin = -100.0\nmax = 100.0\nmax_speed = 5000\n"
      "[axes.Z]\nmin = -500.0\nmax = 500.0\nmax_speed = 120000\n"
      "[axes.A]\nsign = " +
      sign_a +
      "\nmin = -360000.0\nmax = 360000.0\nmax_speed = 7200\n"
      "[axes.C]\nsign = " +
      sign_c + "\nmin = -36000.0\nmax = 36000.0\nmax_speed = 7200\n";
  auto reading = shaper::read_shaper_machine_of_text(text, "test_shaper.toml");
  EXPECT_TRUE(reading.machine) << to_text(reading.errors);
  return *reading.machine;
}

inline shaper::ShaperWork shaper_work() {
  shaper::ShaperWork work;
  work.job_name = "offset-shaped";
  work.machine_file = "test_shaper.toml";
  work.gear = spur_parameters();
  work.gear.offset_mm = 15;
  auto& s = work.shaping;
  s.cutting_speed_m_min = 20;
  s.circular_feed_mm = 0.1;
  s.radial_feed_mm = 0.02;
  s.over_run_mm = 2.5;
  return work;
}

inline shaper::ShaperSetup shaper_setup(const shaper::ShaperWork& work, const machines::ShaperMachine& machine) {
  auto planned = shaper::plan_shaper_setup(work, machine);
  if (const auto* refusals = planned.refused()) {
    for (const auto& r : *refusals) ADD_FAILURE() << r.key << ": " << r.diagnostic.message;
    return {};
  }
  return std::move(planned).value();
}

/// The first refusal with this key; fails the test if there is none.
inline std::string refusal(const shaper::ShaperWork& work, const machines::ShaperMachine& machine,
                           const std::string& key) {
  const auto planned = shaper::plan_shaper_setup(work, machine);
  if (planned.has_value()) {
    ADD_FAILURE() << "accepted, expected a refusal of " << key;
    return "";
  }
  for (const auto& r : planned.error())
    if (r.key == key) return r.diagnostic.message;
  for (const auto& r : planned.error()) ADD_FAILURE() << "refused instead: " << r.key << ": " << r.diagnostic.message;
  return "";
}

/// What the program must do, worked out from the job's numbers alone.
inline ShaperFacts facts_of(const shaper::ShaperWork& w, double relief, double strokes_per_minute, int sense) {
  ShaperFacts f;
  const double m = w.gear.module_mm, E = w.gear.offset_mm;
  f.depth = (2 * w.gear.addendum_coefficient + w.gear.clearance_coefficient) * m;
  f.relief = relief;
  f.slide = E;
  const auto along = [&](double R) { return std::sqrt(R * R - E * E); };
  f.start = along(w.gear.zones[0].outer_radius_mm) + w.shaping.over_run_mm;
  f.end = along(w.gear.zones[0].inner_radius_mm) - w.shaping.over_run_mm;
  f.strokes_per_minute = strokes_per_minute;
  f.cutter_teeth = w.gear.shaper_teeth;
  f.work_teeth = w.gear.teeth;
  f.strokes_infeed = static_cast<int>(std::ceil(f.depth / w.shaping.radial_feed_mm - 1e-9));
  f.strokes_turn = static_cast<int>(std::ceil(kPi * m * w.gear.teeth / w.shaping.circular_feed_mm));
  f.sense = sense;
  return f;
}

/// Lines as one text.
inline std::string joined(const std::vector<std::string>& lines) {
  std::string out;
  for (const auto& l : lines) out += l + "\n";
  return out;
}

}  // namespace toothpath::test
