// Machines that ship in two forms, zero on the plate and homed at the top: the same machine, seen from another zero.
#include <gtest/gtest.h>

#include <random>

#include "machines/links.h"
#include "machines/machine_file.h"

namespace toothpath::machines {
namespace {

constexpr double kClose = 1e-9;  // mm, of coordinates below 2 m

Machine shipped(const std::string& name) {
  const MachineReading reading = read_machine_file(TOOTHPATH_SOURCE_DIR "/machines/data/" + name + ".toml");
  EXPECT_TRUE(reading.machine) << name;
  return reading.machine.value_or(Machine{});
}

/// Two points that say where a body is and how large; a radius is one more number.
struct Measures {
  Vec3 a, b, radii = Vec3::Zero();
};

Measures measures(const MachineBody& body) {
  if (const auto* box = std::get_if<BoxShape>(&body.shape)) return {box->low, box->high};
  const auto& cone = std::get<ConeShape>(body.shape);
  return {cone.from, cone.to, {cone.radius_from, cone.radius_to, 0}};
}

class Homed : public ::testing::TestWithParam<const char*> {};

TEST_P(Homed, IsTheSameMachineWithItsZeroAtTheTop) {
  const Machine plain = shipped(GetParam()), homed = shipped(std::string(GetParam()) + "_top");
  EXPECT_EQ(homed.name, plain.name + ", homed at the top");
  EXPECT_EQ(homed.dialect, plain.dialect);
  EXPECT_EQ(homed.tcp, plain.tcp);
  EXPECT_EQ(homed.max_simultaneous_axes, plain.max_simultaneous_axes);
  EXPECT_EQ(homed.max_spindle_speed, plain.max_spindle_speed);
  EXPECT_EQ(homed.max_cutting_feed, plain.max_cutting_feed);
  EXPECT_EQ(homed.table_diameter_mm, plain.table_diameter_mm);
  EXPECT_EQ(homed.min_block_ms, plain.min_block_ms);
  EXPECT_EQ(homed.post.linear_decimals, plain.post.linear_decimals);
  EXPECT_EQ(homed.post.rotary_decimals, plain.post.rotary_decimals);
  EXPECT_EQ(homed.chain.linear[2].max_mm, 0);
  EXPECT_EQ(homed.table_face_mm, homed.chain.rotary(0).point_mm.z());
  for (const LinearAxis& axis : homed.chain.linear) EXPECT_LT(axis.min_mm, 0);

  const Vec3 zero = homed.chain.rotary(0).point_mm;  // of the plain machine, seen from the other zero
  for (Eigen::Index i = 0; i < 3; ++i) {
    const LinearAxis &a = plain.chain.linear[static_cast<std::size_t>(i)],
                     &b = homed.chain.linear[static_cast<std::size_t>(i)];
    EXPECT_NEAR(b.min_mm, a.min_mm + zero[i], kClose);
    EXPECT_NEAR(b.max_mm, a.max_mm + zero[i], kClose);
    EXPECT_EQ(b.max_speed, a.max_speed);
  }
  ASSERT_EQ(homed.bodies.size(), plain.bodies.size());
  const Links links(plain.chain), homed_links(homed.chain);
  std::mt19937 random(7);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  for (int n = 0; n < 20; ++n) {
    Joints joints;
    for (Eigen::Index i = 0; i < 3; ++i) joints.linear_mm[i] = between(-300, 300);
    joints.rotary_rad = {between(-3, 3), between(-1, 1)};
    Joints moved = joints;
    moved.linear_mm += zero;
    EXPECT_LE((homed.chain.forward(moved, 80).tip_mm - zero - plain.chain.forward(joints, 80).tip_mm).norm(), kClose);
    const auto places = links.places(joints), homed_places = homed_links.places(moved);
    for (std::size_t k = 0; k < plain.bodies.size(); ++k) {
      const MachineBody &a = plain.bodies[k], &b = homed.bodies[k];
      EXPECT_EQ(b.name, a.name);
      ASSERT_EQ(b.link, a.link);
      const Measures m = measures(a), h = measures(b);
      EXPECT_LE((h.radii - m.radii).norm(), kClose) << a.name;
      for (const auto& [p, q] : {std::pair{m.a, h.a}, {m.b, h.b}})
        EXPECT_LE((homed_places[b.link].of(q) - zero - places[a.link].of(p)).norm(), kClose) << a.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, Homed,
                         ::testing::Values("fanuc_ac", "haas_ac", "heidenhain_ac", "m80_ac", "siemens_ac"));

}  // namespace
}  // namespace toothpath::machines
