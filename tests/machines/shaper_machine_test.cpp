// The gear shaper file: what ships is exactly solvable for the sample gear, and what is wrong is refused with its
// place.
#include "machines/shaper_machine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "geometry/base/angle.h"
#include "tests/machines/example_files.h"

namespace toothpath {
namespace {

using test::replaced;

const std::vector<machines::ShaperDialect> kDialects = {{"fanuc", machines::ShaperGears::pulses},
                                                        {"linuxcnc", machines::ShaperGears::change_gears},
                                                        {"siemens", machines::ShaperGears::named_axes}};
const std::string kFile = TOOTHPATH_SOURCE_DIR "/machines/data/y514.toml";

std::string text_of_y514() { return test::file_text(kFile); }

machines::ShaperMachine y514() {
  const auto reading = machines::read_shaper_machine_file(kFile, kDialects);
  EXPECT_TRUE(reading.machine) << to_text(reading.errors);
  return reading.machine.value_or(machines::ShaperMachine{});
}

TEST(ShaperMachine, Y514IsWhatItsFileSays) {
  const machines::ShaperMachine m = y514();
  EXPECT_EQ(m.stroke_steps, (std::vector<double>{125, 179, 253, 359}));
  EXPECT_EQ(m.index_constant.numerator, 12);
  EXPECT_EQ(m.index_constant.denominator, 5);
  EXPECT_EQ(m.feed_constant.value(), 750);
  EXPECT_EQ(m.mesh_margin, 15);
  EXPECT_EQ(m.axes.size(), 5u);
  EXPECT_NEAR(degrees(m.axes.at('C').max_speed), 7200, 1e-9);
  EXPECT_EQ(m.axes.at('Z').max, 500);
  EXPECT_EQ(m.axes.at('A').sign, 1);
  EXPECT_TRUE(std::is_sorted(m.gears.begin(), m.gears.end()));
  EXPECT_EQ(std::adjacent_find(m.gears.begin(), m.gears.end()), m.gears.end());
}

// 12/5 * 25/88 = 15/22 must be met exactly by four wheels that mesh, each used once.
TEST(ShaperMachine, Y514IndexesTheSampleGearExactly) {
  const machines::ShaperMachine m = y514();
  const std::int64_t top = m.index_constant.numerator * 25, bottom = m.index_constant.denominator * 88;
  int exact = 0;
  bool textbook = false;
  for (const int a : m.gears)
    for (const int b : m.gears)
      for (const int c : m.gears)
        for (const int d : m.gears) {
          if (a == b || a == c || a == d || b == c || b == d || c == d) continue;
          if (a + b < c + m.mesh_margin || c + d < b + m.mesh_margin) continue;
          if (std::int64_t{a} * c * bottom != std::int64_t{b} * d * top) continue;
          ++exact;
          textbook = textbook || (a == 25 && b == 55 && c == 60 && d == 40);
        }
  EXPECT_GT(exact, 100);
  EXPECT_TRUE(textbook);
}

// The sample: strokes along the cutter axis between sqrt(R^2 - E^2) -+ over-run, at the deepest and at full retract.
TEST(ShaperMachine, Y514HoldsTheSampleGear) {
  const machines::ShaperMachine m = y514();
  const double E = 15, over_run = 2.5, depth = 2.25 * 3;
  const double start = std::sqrt(147.0 * 147 - E * E) + over_run, end = std::sqrt(130.5 * 130.5 - E * E) - over_run;
  EXPECT_LE(start - end, m.max_stroke_mm);
  EXPECT_GT(end, m.axes.at('Z').min);
  EXPECT_LT(start, m.axes.at('Z').max);
  EXPECT_GT(m.axes.at('X').max, depth + m.relief_mm);
  EXPECT_LE(m.axes.at('X').min, 0);
  EXPECT_LT(E, m.axes.at('Y').max);
  EXPECT_GT(m.axes.at('A').max, 2 * 2 * kPi * 88 / 25);  // two work turns of the cutter, unwound
  EXPECT_GT(m.axes.at('C').max, 2 * 2 * kPi);
}

// The report must be able to name what is assumed: every table of numbers.
TEST(ShaperMachine, Y514NamesItsAssumptions) {
  EXPECT_TRUE(y514().assumed);
  EXPECT_EQ(y514().assumed_keys, (std::vector<std::string>{"stroke", "index", "feed", "gears", "axes"}));
}

TEST(ShaperMachine, BadFilesAreRefusedWithTheirPlace) {
  const std::string good = text_of_y514();
  const auto message = [&good](const std::string& from, const std::string& to) {
    return to_text(machines::read_shaper_machine_text(replaced(good, from, to), "s.toml", kDialects).errors);
  };
  EXPECT_EQ(message("[125, 179", "[179, 125"),
            "s.toml:12:9: error: stroke.steps[1] = 125 must exceed the step before it, 179\n");
  EXPECT_EQ(message("[125, 179, 253, 359]", "[]"),
            "s.toml:12:9: error: stroke.steps is empty, must have at least 1 step\n");
  EXPECT_EQ(message("[125, 179", "[0, 179"), "s.toml:12:10: error: stroke.steps[0] = 0 must be above 0 1/min\n");
  EXPECT_EQ(message("[12, 5]", "[12, 0]"), "s.toml:17:17: error: index.constant[1] = 0 is outside 1 to 1000000\n");
  EXPECT_EQ(message("[12, 5]", "[12.5, 5]"),
            "s.toml:17:13: error: index.constant[0] must be a whole number, is a number\n");
  EXPECT_EQ(message("[12, 5]", "[12]"), "s.toml:17:12: error: index.constant has 1 numbers, must have 2\n");
  EXPECT_EQ(message("[750, 1]", "2.4"), "s.toml:20:12: error: feed.constant must be a list, is a number\n");
  EXPECT_EQ(message("[20, 24,", "[20, 20,"),
            "s.toml:23:14: error: gears.teeth lists 20 twice; each wheel is there once\n");
  EXPECT_EQ(message("max_length = 125.0", "max_length = nan"),
            "s.toml:13:14: error: stroke.max_length = nan must be finite\n");
  EXPECT_EQ(message("relief = 0.5", "releif = 0.5"),
            "s.toml:11:1: error: stroke.relief is missing\ns.toml:14:1: error: unknown key stroke.releif; did you mean "
            "relief?\n");
  EXPECT_EQ(message("min = -5.0\nmax = 200.0", "min = 200.0\nmax = -5.0"),
            "s.toml:29:7: error: axes.X.max = -5 must exceed axes.X.min = 200\n");
  EXPECT_EQ(message("min = -5.0\nmax = 200.0", "min = 200.0\nmax = 200.0"),
            "s.toml:29:7: error: axes.X.max = 200 must exceed axes.X.min = 200\n");
  EXPECT_EQ(message("sign = 1", "sign = 0"), "s.toml:43:8: error: axes.A.sign = 0 must be 1 or -1\n");
  EXPECT_EQ(message("max_speed = 5000", "max_speed = 5000\nsign = 1"), "s.toml:36:1: error: unknown key axes.Y.sign\n");
  EXPECT_EQ(message("\"feed\", ", "\"fed\", "),
            "s.toml:9:31: error: assumed names \"fed\", which this file does not have\n");
}

}  // namespace
}  // namespace toothpath
