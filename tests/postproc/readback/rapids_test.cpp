// Rapids that turn the rotaries: proven clear just above the height at which dense sampling sees them strike, refused
// just below.
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "postproc/readback/reader.h"
#include "tests/postproc/readback/nc_case.h"

namespace toothpath {
namespace {

using namespace test;

/// A rapid that turns both rotaries while the linear axes stand: the part swings towards the tool. How low the tool may
/// stand is known from dense sampling of the machine's own forward kinematics.
TEST(TurningRapid, IsClearJustAboveAndRefusedJustBelow) {
  const machines::Machine machine = trunnion();
  const auto setup = standing();
  tool::ToolAssembly stubby = tools()[0];
  stubby.flute_length_mm = 10;
  stubby.shank_diameter_mm = 4;
  stubby.stick_out_mm = 18;
  stubby.holder = {{40, 50, 25}};
  struct Ring {
    double height, radius;
  };
  const std::vector<std::pair<std::vector<tool::ToolAssembly>, std::vector<Ring>>> cases{
      {{}, {{0, 0}}}, {{stubby}, {{0, 0}, {18, 20}, {43, 25}}}};
  const auto control = controls::control_of(machine, setup, tools());
  for (const auto& [described, rings] : cases)
    for (const double tilt : {-35.0, 25.0}) {
      const double X = 20, Y = 14;  // the whole tool stays over the part
      const double ball = described.empty() ? 0 : stubby.radius_mm();
      const auto inside = [&](double Z) {
        for (int s = 0; s <= 600; ++s) {
          const auto pose = trunnion_forward(kTrunnion, X, Y, Z, tilt * s / 600, 20.0 * s / 600, stubby.length_mm);
          const Vec3 u = pose.axis.unitOrthogonal(), v = pose.axis.cross(u), tip = pose.tip - setup.origin_mm;
          const Vec3 centre = tip + ball * pose.axis;
          if (centre.head<2>().norm() < kBody.radius_mm && centre.z() - ball < kBody.z_max_mm) return true;
          for (const Ring& ring : rings)
            for (int j = 0; j < (ring.radius > 0 ? 90 : 1); ++j) {
              const double a = j * kPi / 45;
              const Vec3 p = tip + ring.height * pose.axis + ring.radius * (std::cos(a) * u + std::sin(a) * v);
              if (p.head<2>().norm() < kBody.radius_mm && p.z() < kBody.z_max_mm && p.z() > kBody.z_min_mm) return true;
            }
        }
        return false;
      };
      double clear = 600, hit = 600;
      while (!inside(hit)) hit -= 2;
      clear = hit + 2;
      while (clear - hit > 1e-3) (inside(0.5 * (clear + hit)) ? hit : clear) = 0.5 * (clear + hit);
      // Rapids are followed with 0.05 mm of deviation, and 0.25 mm by turns at the far end of the tool: that must be
      // left free.
      const double free = 0.2 + 0.3;
      EXPECT_FALSE(inside(clear + free));
      for (const double above : {free, -0.2}) {
        readback::OperationTrace trace;
        trace.tool = 1;
        readback::ExecutedMove move;
        move.joints = {X, Y, clear + above, 0, 0};
        move.line = 1;
        move.operation = 0;
        move.tool = 1;
        move.rapid = move.known = true;
        trace.moves.push_back(move);
        move.joints[3] = 20;
        move.joints[4] = tilt;
        move.line = 2;
        trace.moves.push_back(move);
        const auto proof = readback::check_rapids(trace, *control, machine, setup, kBody, described);
        if (above > 0) {
          EXPECT_TRUE(proof) << proof.error().message;
        } else {
          ASSERT_FALSE(proof) << "tilt " << tilt << " at " << clear + above;
          EXPECT_NE(proof.error().message.find("line 2: a rapid passes through the part"), std::string::npos)
              << proof.error().message;
        }
      }
    }
}

}  // namespace
}  // namespace toothpath
