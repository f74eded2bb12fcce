// The DMIS program read statement by statement, and its moves against the teeth.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <regex>
#include <sstream>

#include "geometry/base/angle.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/part.h"
#include "geometry/inspection/dmis.h"
#include "tests/support/sample_gears.h"

namespace toothpath {
namespace {

face_gear::FaceGear sample_gear() { return test::made(test::quarter_dhfg()); }

/// Statements with their continuations joined; comments left out.
std::vector<std::string> statements(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  std::string line, whole;
  while (std::getline(in, line)) {
    EXPECT_LE(line.size(), 80u) << line;
    for (const char c : line) EXPECT_TRUE(c >= ' ' && c <= '~');
    if (line.rfind("$$", 0) == 0) continue;
    if (!line.empty() && line.back() == '$') {
      whole += line.substr(0, line.size() - 1);
      continue;
    }
    out.push_back(whole + line);
    whole.clear();
  }
  EXPECT_TRUE(whole.empty());
  return out;
}

std::vector<double> numbers_after(const std::string& s, const std::string& mark) {
  std::vector<double> out;
  std::istringstream in(s.substr(s.find(mark) + mark.size()));
  for (std::string word; std::getline(in, word, ',');) out.push_back(std::stod(word));
  return out;
}

TEST(InspectionDmis, EveryPointIsNamedAndMeasuredOnceAtItsPlace) {
  const auto gear = sample_gear();
  const auto grid = *inspection::inspection_grid(drawn_solid(gear));
  const auto all = statements(inspection::inspection_dmis(gear, grid, "it's a/job, $5"));
  ASSERT_GT(all.size(), 6u);
  EXPECT_EQ(all.front(), "DMISMN/'toothpath it_s a_job_ _5',05.2");
  EXPECT_EQ(all[1], "UNITS/MM,ANGDEC");
  EXPECT_EQ(all.back(), "ENDFIL");
  const std::regex feature(R"(F\((Z\d[PM]_R\d+C\d+)\)=FEAT/POINT,CART(,-?\d+\.\d{6}){3}(,-?\d\.\d{8}){3})");
  const std::regex other(
      R"(MODE/PROG,MAN|WKPLAN/XYPLAN|SNSET/(APPRCH|RETRCT|SEARCH),\d+\.\d{3}|GOTO/CART(,-?\d+\.\d{4}){3})");
  std::map<std::string, std::vector<double>> nominal;
  std::map<std::string, int> measured;
  std::size_t next = 0;
  for (std::size_t k = 2; k + 1 < all.size(); ++k) {
    std::smatch m;
    if (std::regex_match(all[k], m, feature)) {
      EXPECT_TRUE(measured.empty());  // all features are defined before the first measurement
      const auto v = numbers_after(all[k], "CART,");
      const auto& p = grid[next++];
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(v[std::size_t(c)], p.p[c], 6e-7);
        EXPECT_NEAR(v[std::size_t(c) + 3], p.n[c], 6e-9);
      }
      EXPECT_TRUE(nominal.emplace(m[1], v).second) << all[k];
    } else if (all[k].rfind("MEAS/POINT,F(", 0) == 0) {
      const std::string label = all[k].substr(13, all[k].find(')') - 13);
      EXPECT_EQ(all[k], "MEAS/POINT,F(" + label + "),1");
      ASSERT_TRUE(nominal.count(label));
      EXPECT_EQ(all[k + 1].rfind("PTMEAS/CART,", 0), 0u);
      EXPECT_EQ(numbers_after(all[k + 1], "CART,"), nominal[label]);
      EXPECT_EQ(all[k + 2], "ENDMES");
      ++measured[label];
      k += 2;
    } else {
      EXPECT_TRUE(std::regex_match(all[k], other)) << all[k];
    }
  }
  EXPECT_EQ(nominal.size(), grid.size());
  EXPECT_EQ(measured.size(), grid.size());
  for (const auto& [label, times] : measured) EXPECT_EQ(times, 1) << label;
}

/// Moves go down in the space beside the flank: from above, over a place that no tooth occupies, and never across a
/// tooth.
TEST(InspectionDmis, MovesStayInTheSpaceBesideTheFlank) {
  const auto gear = sample_gear();
  const auto grid = *inspection::inspection_grid(drawn_solid(gear));
  Vec3 over = Vec3::Zero();
  std::map<std::string, const inspection::InspectionPoint*> point_at;
  for (const auto& s : statements(inspection::inspection_dmis(gear, grid, "job"))) {
    if (s.rfind("GOTO/", 0) == 0) {
      const auto v = numbers_after(s, "CART,");
      over = {v[0], v[1], v[2]};
      EXPECT_GT(over.z(), gear.blank_top() + 4.9);
    }
    if (s.rfind("PTMEAS/", 0) != 0) continue;
    const auto v = numbers_after(s, "CART,");
    const Vec3 p(v[0], v[1], v[2]), n(v[3], v[4], v[5]);
    const auto ring = std::hypot(p.x(), p.y()) < 118 ? 0u : 1u;
    const auto& f = gear.rings()[ring].surface;
    // From the point above to the approach point: outside both flanks of the space all the way below the tip surface.
    const int side =
        face_gear::flank_distance(f, 1, p) && std::abs(face_gear::flank_distance(f, 1, p)->distance) < 1e-4 ? 1 : -1;
    const Vec3 start = p + 0.25 * 1.25 * n;
    for (int k = 0; k <= 20; ++k) {
      const Vec3 at = over + (start - over) * (k / 20.0);
      if (at.z() > f.z_tip(std::hypot(at.x(), at.y()))) continue;
      const auto near = face_gear::flank_distance(f, side, at);
      const auto far = face_gear::flank_distance(f, -side, turned(at, -side * gear.pitch()));
      ASSERT_TRUE(near && far);
      EXPECT_GT(near->distance, 0) << s;
      EXPECT_GT(far->distance, 0) << s;
    }
  }
}

}  // namespace
}  // namespace toothpath
