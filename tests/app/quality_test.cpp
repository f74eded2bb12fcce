// The tolerances of a job that follow from the quality of the flanks.
#include "app/proposal/quality.h"

#include <gtest/gtest.h>

#include <cmath>

namespace toothpath::test {
namespace {

using namespace proposal;

/// A class is sqrt(2) times as wide as the one before it; class 5 is the formula itself.
TEST(Quality, ClassesOfIso1328) {
  EXPECT_NEAR(profile_form_tolerance_um(5, 2), 6.1, 1e-12);
  EXPECT_NEAR(profile_form_tolerance_um(5, 8), 9.4, 1e-12);
  for (int iso_class = 1; iso_class < 11; ++iso_class)
    EXPECT_NEAR(profile_form_tolerance_um(iso_class + 1, 3) / profile_form_tolerance_um(iso_class, 3), std::sqrt(2),
                1e-12);
}

TEST(Quality, SharesAreWholeTenthsOfAMicrometreAndLeaveRoom) {
  EXPECT_LT(kGougeShare + kScallopShare + kChordShare, 0.8);
  EXPECT_LT(kGougeShare + kLeftShare + kChordShare, 0.8);
  for (const double um : {2.0, 3.3, 10.0, 12.2, 97.0})
    for (const double share : {kGougeShare, kScallopShare, kLeftShare, kChordShare}) {
      const double mm = share_mm(share, um / 1000), tenths = 1e4 * mm;
      EXPECT_NEAR(tenths, std::round(tenths), 1e-9);
      EXPECT_TRUE(mm <= share * um / 1000 + 1e-12 || mm == 1e-4) << share << " of " << um;
      EXPECT_GT(mm, share * um / 1000 - 1e-4) << share << " of " << um;
    }
  EXPECT_DOUBLE_EQ(share_mm(kGougeShare, tolerance_mm({}, 2)), 0.002) << "10 um, where nobody asks";
}

TEST(Quality, TheDerivationNamesClassModuleStandardAndShares) {
  const std::pair<const char*, double> taken[] = {{"gouge_tolerance", kGougeShare}, {"left", kLeftShare}};
  const std::string face = derivation({7, {}}, 2, false, taken), spur = derivation({7, {}}, 2, true, taken);
  EXPECT_NE(face.find("T = 12.20 um, ISO 1328-1 class 7: f_f_alpha = (0.55 m + 5) sqrt(2)^(7 - 5) with m = 2 mm, the "
                      "standard of cylindrical gears"),
            std::string::npos)
      << face;
  EXPECT_NE(face.find("# The program takes of it gouge_tolerance 0.2 T, left 0.5 T;\n"), std::string::npos) << face;
  EXPECT_EQ(spur.find("the standard of"), std::string::npos) << spur;
  EXPECT_NE(derivation({{}, 12.0}, 2, false, taken).find("T = 12.00 um, as asked for."), std::string::npos);
  EXPECT_NE(derivation({}, 2, false, taken).find("T = 10.00 um, where new is given no --class"), std::string::npos);
}

}  // namespace
}  // namespace toothpath::test
