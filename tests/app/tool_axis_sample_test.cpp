// The sample of prescribed tool axes: the tool leans as the keys of the job say, at every record of its finishing
// passes.
#include <nlohmann/json.hpp>

#include <cmath>
#include <sstream>

#include "geometry/base/angle.h"
#include "tests/app/program.h"

namespace toothpath::test {
namespace {

struct Record {
  int operation = 0;
  std::string kind;
  double x = 0, y = 0, z = 0, i = 0, j = 0, k = 0;
};
std::vector<Record> records_of(const std::string& csv) {
  std::vector<Record> out;
  std::istringstream in(csv);
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "op,tooth,zone,pass,x,y,z,i,j,k,feed,kind");
  while (std::getline(in, line)) {
    std::vector<std::string> w;
    std::istringstream words(line);
    for (std::string word; std::getline(words, word, ',');) w.push_back(word);
    const auto n = [&](std::size_t at) { return std::stod(w.at(at)); };
    out.push_back({std::stoi(w.at(0)), w.at(11), n(4), n(5), n(6), n(7), n(8), n(9)});
  }
  return out;
}

TEST(ToolAxisSample, LeansAsItsKeysSay) {
  const TestDir dir;
  const Finished run = run_program({"run", kSamples + "/tool_axis.toml", "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  EXPECT_EQ(nlohmann::json::parse(file_text(dir / "out/report.json")).at("tilt").at("mode"), "simultaneous");

  // The space of tooth 0 has its middle half a pitch from azimuth 0; flank +1 is the one at the smaller azimuth.
  const double half_pitch = kPi / 60, c = std::cos(half_pitch), s = std::sin(half_pitch), ball = 0.5;
  int inner = 0, outer = 0, between = 0, plus = 0, minus = 0;
  double side_plus = 0, side_minus = 0;
  for (const Record& r : records_of(file_text(dir / "out/cl.csv"))) {
    if (r.kind != "feed") continue;
    if (r.operation == 0) {
      EXPECT_EQ(r.k, 1) << "roughing stays upright";
      continue;
    }
    const double outwards = (c * r.i + s * r.j) / r.k, aside = (c * r.j - s * r.i) / r.k;
    const double radius = std::hypot(r.x + ball * r.i, r.y + ball * r.j),
                 across = c * (r.y + ball * r.j) - s * (r.x + ball * r.i);
    EXPECT_NEAR(std::abs(aside), std::tan(2 * kDegree), 2e-8);
    (aside > 0 ? plus : minus) += 1;
    (aside > 0 ? side_plus : side_minus) += across;
    // tan of the lean between two keys: the cubic with level ends.
    const double t = std::clamp((radius - 60.5) / 2.0, 0.0, 1.0), a = std::tan(6 * kDegree), b = std::tan(9 * kDegree);
    EXPECT_NEAR(outwards, a + (b - a) * t * t * (3 - 2 * t), 2e-8) << "radius " << radius;
    (t == 0 ? inner : t == 1 ? outer : between) += 1;
  }
  for (const int count : {inner, outer, between, plus, minus}) EXPECT_GT(count, 50);
  EXPECT_LT(side_plus / plus, side_minus / minus - 0.2) << "each flank has its own keys";
}

}  // namespace
}  // namespace toothpath::test
