// The judge judged: one motion read in every form of output is one motion; walls against numbers that were worked out
// by brute force before there was a program (docs/bevel_gear.md); what is not understood is said.
#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/base/angle.h"
#include "tests/app/judged.h"
#include "tests/support/brute_force_bevel_gear.h"

namespace toothpath::test {
namespace {

struct Posts {
  const char* reference;
  std::vector<const char*> others;
};

/// Places of the tool at the ends of the cuts of a golden program (tests/golden/posts).
std::vector<ToolPlace> places_of(const std::string& file) {
  const std::string text = file_text(std::string(TOOTHPATH_SOURCE_DIR) + "/tests/golden/posts/" + file);
  const auto from = file.find_first_of("._");
  std::string control = file.substr(0, from == std::string::npos ? from : file.find(file[from]));
  if (control == "cutter") control = "apt";
  if (control == "mitsubishi") control = "mitsubishi_m80";
  std::string machine = file_text(TOOTHPATH_SOURCE_DIR "/machines/data/xyzac_large.toml");
  if (control == "apt") machine = file_text(TOOTHPATH_SOURCE_DIR "/machines/data/apt_free.toml");
  else replace_once(machine, "\"linuxcnc\"", fmt::format("\"{}\"", control));
  const JudgedPath path(text, machine, {Vec3(3, -2, 150), false, {{3, -2, 0}, {0, 95}}});
  for (const auto& fault : path.faults()) ADD_FAILURE() << file << ": " << fault;
  std::vector<ToolPlace> out;
  for (const auto& move : path.moves())
    if (!move.rapid) out.push_back(path.at(move, 1));
  return out;
}

TEST(JudgeOfText, OneMotionIsTheSameInEveryForm) {
  const Posts all[] = {{"cutter_location.apt",
                        {"linuxcnc_joints.ngc", "linuxcnc_tcp.ngc", "fanuc_tcp.nc", "fanuc_tcp_called.nc", "haas.nc",
                         "haas_called.nc", "siemens_joints.mpf", "siemens_tcp.mpf", "siemens_vectors.mpf",
                         "heidenhain_tcp_moving.h.txt", "heidenhain_vectors.h.txt"}},
                       {"heidenhain_joints.h.txt", {"fanuc_joints.nc", "mitsubishi_m80.nc", "heidenhain_tcp.h.txt"}},
                       {"siemens_spread.mpf", {"linuxcnc_spread.ngc"}},
                       {"heidenhain_spread.h.txt", {"fanuc_spread.nc"}}};
  for (const Posts& posts : all) {
    const auto reference = places_of(posts.reference);
    ASSERT_GE(reference.size(), 12u) << posts.reference;
    for (const char* file : posts.others) {
      const auto other = places_of(file);
      ASSERT_GE(other.size(), reference.size()) << file;
      for (const ToolPlace& p : reference) {
        const bool there = std::any_of(other.begin(), other.end(), [&](const ToolPlace& q) {
          return (q.tip - p.tip).norm() < 2e-3 && (q.axis - p.axis).norm() < 3e-5;
        });
        EXPECT_TRUE(there) << file << ": nothing at " << p.tip.transpose() << ", axis " << p.axis.transpose();
      }
    }
  }
}

TEST(JudgeOfText, SaysWhatItDoesNotUnderstand) {
  const std::string start = "G21 G17 G90 G94 G40 G49 G80\nG54\nT1 M6\nG43 H1\nG0 X0 Y0 Z10 A0 C0\n";
  EXPECT_TRUE(walk_nc(start + "G1 X1 F100\nM2\n", "linuxcnc").faults.empty());
  for (const char* wrong : {"G2 X1 Y1 I1", "G20", "G1 X[#7]", "G1 X1..2", "M98 P1", "G91", "o7 call"})
    EXPECT_FALSE(walk_nc(start + wrong + "\nM2\n", "linuxcnc").faults.empty()) << wrong;
  EXPECT_FALSE(walk_nc("G90\nG1 X1\nM2\n", "linuxcnc").faults.empty()) << "no units";
  EXPECT_FALSE(walk_nc(start, "linuxcnc").ended);
  EXPECT_FALSE(walk_nc("0 BEGIN PGM A MM\n1 CC X+0\n", "heidenhain").faults.empty());
  EXPECT_FALSE(walk_nc("G710\nG2 X1\n", "siemens").faults.empty());
  EXPECT_FALSE(walk_nc("UNITS/MM\nGOTO/1,2,3\n", "apt").faults.empty());
  NcWalk without_length = walk_nc("G21 G90\nT1 M6\nG0 X0 Y0 Z10 A0 C0\nG1 X1 F100\nM2\n", "linuxcnc");
  const PlainMachine machine(file_text(TOOTHPATH_SOURCE_DIR "/machines/data/xyzac_large.toml"));
  (void)moves_on(machine, without_length, {Vec3::Zero(), {0, 95}});
  EXPECT_FALSE(without_length.faults.empty());
}

/// 18 and 37 teeth, module 6.
bevel_gear::BevelGearParameters pinion(bevel_gear::BevelForm form) {
  bevel_gear::BevelGearParameters p;
  p.teeth = 18;
  p.mate_teeth = 37;
  p.outer_transverse_module_mm = 6;
  p.pressure_angle_rad = radians(20);
  p.outer_spiral_angle_rad = radians(30);
  p.face_width_mm = 36;
  p.form = form;
  p.apex_cone_distance_mm = form == bevel_gear::BevelForm::herringbone ? 104 : 0;
  p.addendum_mm = 4.1;
  p.dedendum_mm = 5.1;
  return p;
}

TEST(JudgeOfBevelGears, HasTheWallsThatWereWorkedOut) {
  const FingerMill mill{3.0, 0.9, 4.1, 4.8};
  const BruteForceBevelGear one(pinion(bevel_gear::BevelForm::single), mill),
      two(pinion(bevel_gear::BevelForm::herringbone), mill);
  struct Wall {
    double ell, height, L, U;
  };
  for (const Wall& w : {Wall{90, 0, -0.387677384, -0.213136826}, Wall{105, 0, -0.094410531, 0.080126649},
                        Wall{120, 0, 0.113866983, 0.288402248}, Wall{90, 3, -0.430477615, -0.170801832},
                        Wall{105, -3, -0.069783655, 0.055207385}}) {
    EXPECT_NEAR(one.wall(1, w.ell, w.height), w.L, 2e-9);
    EXPECT_NEAR(one.wall(-1, w.ell, w.height), w.U, 2e-9);
  }
  for (const Wall& w : {Wall{95, 0, -0.254793407, -0.080254207}, Wall{112, 0, -0.209998415, -0.035462257}}) {
    EXPECT_NEAR(two.wall(1, w.ell, w.height), w.L, 2e-9);
    EXPECT_NEAR(two.wall(-1, w.ell, w.height), w.U, 2e-9);
  }
  EXPECT_NEAR(one.mill().largest_radius(), 4.776878583, 2e-9);
  EXPECT_NEAR(one.mill().largest_tip_radii()[0], 1.153, 5e-4);
  EXPECT_NEAR(one.mill().largest_tip_radii()[1], 2.32, 5e-3);
  EXPECT_NEAR(one.normal_module(one.inner()), 3.098, 5e-4);
  EXPECT_NEAR(two.corner_reach(), 2.94, 5e-3);
}

}  // namespace
}  // namespace toothpath::test
