// Our chains against LinuxCNC's own kinematics modules: the machine files that ship and random offsets, forward and
// inverse. The golden poses of the same modules, which need no package, are in tests/machines/kinematic_chain_test.cpp.
#include "tests/postproc/joints/linuxcnc_kinematics.h"

#include <gtest/gtest.h>

#include <random>

#include "machines/machine_file.h"

namespace toothpath {
namespace {

using test::LinuxcncModule;

constexpr double kLengthBound = 1e-9;  // mm
constexpr double kAngleBound = 1e-12;  // rad

struct Trunnion {
  const char* module;
  const char* file;
  char tilt;
};

machines::KinematicChain chain_of(const Trunnion& t) {
  const auto reading = machines::read_machine_file(std::string(TOOTHPATH_SOURCE_DIR) + "/machines/data/" + t.file);
  EXPECT_TRUE(reading.machine) << to_text(reading.errors);
  return reading.machine ? reading.machine->chain : machines::KinematicChain{};
}

/// Writes the chain's geometry into the module's pins: the rotation point is on C, the offsets lead from there to the
/// tilt axis.
Status set_pins(LinuxcncModule& module, const machines::KinematicChain& chain, char tilt, double rot_point_z,
                double tool_offset) {
  const Vec3 &c = chain.table[0].point_mm, &q = chain.table[1].point_mm;
  const std::pair<const char*, double> pins[] = {
      {"x-rot-point", c.x()},
      {"y-rot-point", c.y()},
      {"z-rot-point", rot_point_z},
      {tilt == 'A' ? "y-offset" : "x-offset", tilt == 'A' ? q.y() - c.y() : q.x() - c.x()},
      {"z-offset", q.z() - rot_point_z},
      {"tool-offset", tool_offset}};
  for (const auto& [pin, value] : pins)
    if (const Status s = module.set(pin, value); !s) return s;
  return Ok{};
}

class LinuxcncModules : public testing::TestWithParam<Trunnion> {
 protected:
  void SetUp() override {
    auto loaded = LinuxcncModule::load(GetParam().module);
    if (!loaded) FAIL() << loaded.error().message;
    module = std::move(*loaded);
    chain = chain_of(GetParam());
    ASSERT_EQ(chain.table.size(), 2u);
    ASSERT_EQ(chain.table[1].letter, GetParam().tilt);
  }
  std::unique_ptr<LinuxcncModule> module;
  machines::KinematicChain chain;
};
INSTANTIATE_TEST_SUITE_P(Trunnions, LinuxcncModules,
                         testing::Values(Trunnion{"xyzac-trt-kins", "xyzac_trt.toml", 'A'},
                                         Trunnion{"xyzbc-trt-kins", "xyzbc_trt.toml", 'B'}),
                         [](const auto& place) { return std::string(place.param.tilt == 'A' ? "xyzac" : "xyzbc"); });

/// Largest differences over a set of poses.
struct Worst {
  double forward_mm = 0, inverse_mm = 0, angle_rad = 0, round_trip_mm = 0;
};

Worst compare(const LinuxcncModule& module, const machines::KinematicChain& chain, double tool_mm, std::mt19937_64& rng,
              int poses) {
  Worst worst;
  std::uniform_real_distribution<double> mm(-500, 500), tilt(-3.1, 3.1), turns(-30, 30), small(-12, -1);
  for (int i = 0; i < poses; ++i) {
    // Every fourth pose is next to the pole: tilts from 1e-12 to 0.1 rad.
    const LinuxcncModule::Values joints{
        {mm(rng), mm(rng), mm(rng)}, i % 4 ? tilt(rng) : std::pow(10.0, small(rng)), turns(rng)};
    const auto theirs = module.forward(joints);
    EXPECT_TRUE(theirs);
    if (!theirs) return worst;
    const machines::Joints start{joints.xyz, {joints.c_rad, joints.tilt_rad}};
    const machines::TablePose ours = chain.forward(start, tool_mm);
    worst.forward_mm = std::max(worst.forward_mm, (ours.tip_mm + Vec3(0, 0, tool_mm) - theirs->xyz).norm());

    // Their inverse takes the angles; the positions are ours at these angles.
    const auto back = module.inverse(*theirs);
    EXPECT_TRUE(back);
    if (!back) return worst;
    worst.round_trip_mm = std::max(worst.round_trip_mm, (back->xyz - joints.xyz).norm());
    const machines::Joints placed = chain.linear_for(theirs->xyz - Vec3(0, 0, tool_mm), start.rotary_rad, tool_mm);
    worst.inverse_mm = std::max(worst.inverse_mm, (placed.linear_mm - back->xyz).norm());

    // Our full inverse knows tip and axis alone. Each of its solutions, given to their forward, is the pose that we
    // asked for.
    const auto solutions = chain.inverse(ours, tool_mm);
    EXPECT_TRUE(solutions);
    if (!solutions) return worst;
    for (const machines::JointSolution& s : *solutions) {
      const auto reached = module.forward({s.joints.linear_mm, s.joints.rotary_rad[1], s.joints.rotary_rad[0]});
      EXPECT_TRUE(reached);
      if (!reached) return worst;
      worst.inverse_mm = std::max(worst.inverse_mm, (reached->xyz - Vec3(0, 0, tool_mm) - ours.tip_mm).norm());
      worst.angle_rad = std::max(worst.angle_rad, (chain.forward(s.joints, tool_mm).axis - ours.axis).norm());
    }
  }
  return worst;
}

void expect_equal(const Worst& worst) {
  EXPECT_LE(worst.forward_mm, kLengthBound);
  EXPECT_LE(worst.inverse_mm, kLengthBound);
  EXPECT_LE(worst.round_trip_mm, kLengthBound);
  EXPECT_LE(worst.angle_rad, kAngleBound);
}

// The machine as its file describes it.
TEST_P(LinuxcncModules, AgreeWithTheShippedMachine) {
  std::mt19937_64 rng(41);
  ASSERT_TRUE(set_pins(*module, chain, GetParam().tilt, 0.0, 101.2)) << module->pins();
  const Worst worst = compare(*module, chain, 101.2, rng, 100000);
  expect_equal(worst);
  fmt::print("{}: 100000 poses, largest difference forward {:.1e} mm, inverse {:.1e} mm, tool axis {:.1e} rad\n",
             GetParam().module, worst.forward_mm, worst.inverse_mm, worst.angle_rad);
}

// 200 machines of the same class with other rotation points, offsets and tools, 500 poses each.
TEST_P(LinuxcncModules, AgreeWithRandomOffsets) {
  std::mt19937_64 rng(42);
  std::uniform_real_distribution<double> mm(-300, 300), tool(1, 300);
  for (int k = 0; k < 200; ++k) {
    chain.table[0].point_mm = Vec3(mm(rng), mm(rng), mm(rng));  // a height along C means nothing
    chain.table[1].point_mm = chain.table[0].point_mm;
    chain.table[1].point_mm[GetParam().tilt == 'A' ? 1 : 0] += mm(rng) / 5;
    chain.table[1].point_mm.z() = mm(rng);
    const double length = tool(rng);
    ASSERT_TRUE(set_pins(*module, chain, GetParam().tilt, mm(rng), length));
    expect_equal(compare(*module, chain, length, rng, 500));
    ASSERT_FALSE(HasFailure()) << "machine " << k;
  }
}

// The golden poses of the specification come out of the binary that is loaded, so both tests speak of the same module.
TEST_P(LinuxcncModules, GiveTheGoldenPoses) {
  const bool ac = GetParam().tilt == 'A';
  chain.table[0].point_mm = Vec3(1.5, -2.5, -40);
  chain.table[1].point_mm = chain.table[0].point_mm + (ac ? Vec3(0, 3.25, -7.5) : Vec3(3.25, 0, -7.5));
  ASSERT_TRUE(set_pins(*module, chain, GetParam().tilt, -40, 101.2));
  const auto first = module->forward({{10, 20, 30}, radians(25.0), radians(-40.0)});
  const auto second = module->forward({{-120.5, 33.25, -80}, radians(-95.0), radians(370.0)});
  ASSERT_TRUE(first && second);
  const Vec3 want_first = ac ? Vec3(1.1461669155887146, 11.145334377839344, 24.085103908722928)
                             : Vec3(0.84459304518711775, 26.321712275921751, 34.439251321370065);
  const Vec3 want_second = ac ? Vec3(-95.445643889080969, 150.263931264246, 97.729050493343635)
                              : Vec3(-109.50879519600169, 53.37534706391066, 190.12610874135305);
  EXPECT_LE((first->xyz - want_first).norm(), 1e-12 * 100);
  EXPECT_LE((second->xyz - want_second).norm(), 1e-12 * 200);
}

// A wrong sense of one axis, a pivot 1 um off or a tool 1 um longer does not pass.
TEST_P(LinuxcncModules, FindPlantedFaults) {
  const auto error_with = [&](const auto& spoil, double tool_mm) {
    machines::KinematicChain wrong = chain;
    spoil(wrong);
    std::mt19937_64 rng(43);
    const Worst w = compare(*module, wrong, tool_mm, rng, 200);
    return std::max(w.forward_mm, w.inverse_mm);
  };
  ASSERT_TRUE(set_pins(*module, chain, GetParam().tilt, 0.0, 101.2));
  EXPECT_LE(error_with([](machines::KinematicChain&) {}, 101.2), kLengthBound);
  for (const std::size_t axis : {0u, 1u})
    EXPECT_GT(error_with([axis](machines::KinematicChain& c) { c.table[axis].sign = 1; }, 101.2), 1.0);
  for (const std::size_t axis : {0u, 1u})
    for (const Eigen::Index i : {0, 1, 2}) {
      // Along its own direction an axis may be moved.
      if (std::abs(chain.table[axis].direction[i]) == 1) continue;
      EXPECT_GT(error_with([axis, i](machines::KinematicChain& c) { c.table[axis].point_mm[i] += 1e-3; }, 101.2), 5e-4)
          << axis << i;
    }
  EXPECT_GT(error_with([](machines::KinematicChain&) {}, 101.201), 5e-4);
}

TEST(LinuxcncModule, SaysWhatIsMissing) {
  const auto none = LinuxcncModule::load("no-such-kins");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("/no-such-kins.so is missing: run tools/get_rs274.sh"), std::string::npos)
      << none.error().message;
  auto module = LinuxcncModule::load("xyzac-trt-kins");
  ASSERT_TRUE(module) << module.error().message;
  EXPECT_EQ((*module)->set("no-pin", 1).error().message,
            "xyzac-trt-kins has no pin no-pin; it has tool-offset, x-offset, x-rot-point, y-offset, y-rot-point, "
            "z-offset, z-rot-point");
}

}  // namespace
}  // namespace toothpath
