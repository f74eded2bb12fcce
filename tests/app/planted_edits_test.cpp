// Cuts that somebody moved by hand, in every control with loops, TCP, vectors and teeth written out: `check` measures
// a gouge that is larger by what the words move the tip into the flank, and the tolerance decides. The contact with the
// flank is found by brute force, the motion of the tip by a reader of the tests' own (nc_walk, plain_machine).
#include "tests/app/planted.h"

namespace toothpath::test {
namespace {

class PlantedEdits : public testing::TestWithParam<OutputForm> {};
INSTANTIATE_TEST_SUITE_P(Forms, PlantedEdits, testing::ValuesIn(planted_forms()), [](const auto& form) {
  std::string name = form.param.name();
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

// Into the flank and off it: what is measured changes by what the words change, and the tolerance decides.
TEST_P(PlantedEdits, CutsThatAreMoved) {
  Random random(77);
  const Planted p(GetParam(), random);
  ASSERT_TRUE(p.made());
  const auto as_made = p.check_alone(p.lines());
  ASSERT_EQ(as_made.kind, "harmless") << as_made.text;
  EXPECT_NEAR(as_made.gouge_um, p.gouge_um(), 1e-6);
  for (const double um : {2.0, 5.0, 20.0, -2.0, -5.0, -20.0}) {
    double moved = 0;
    const auto found = p.check(p.moved_cut(um == 5.0 ? 5.0 + 2 * kSlack_um - p.depth_um() : um, moved));
    EXPECT_NEAR(moved, um, 3) << "the words have coarser digits";
    std::printf("%-20s %+5.1f um asked, %+6.2f um moved: %.2f -> %.2f um, %s %s\n", GetParam().name().c_str(), um,
                moved, p.depth_um(), found.gouge_um, found.kind.c_str(), found.text.substr(0, 120).c_str());
    if (um > 0) {
      EXPECT_NEAR(found.gouge_um, std::max(p.gouge_um(), p.depth_um() + moved), kSlack_um + 0.02 * um);
    } else {
      EXPECT_LE(found.gouge_um, p.gouge_um() + kSlack_um);
    }
    if (p.depth_um() + moved > kTolerance_um + kSlack_um) {
      EXPECT_EQ(found.kind, "gouge") << found.text;
    } else if (um == 2.0) {
      EXPECT_EQ(found.kind, "harmless") << found.text;
    }
  }
}

}  // namespace
}  // namespace toothpath::test
