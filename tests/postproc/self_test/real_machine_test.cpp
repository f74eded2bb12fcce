// The dry run on a machine that is not the one of its file: the text is executed, and the bar is followed with
// kinematics of the test's own. What the three dials show must be what the sheet says they show.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "machines/machine_file.h"
#include "postproc/controls/of_machine.h"
#include "postproc/readback/reader.h"
#include "postproc/self_test/dials.h"
#include "postproc/self_test/self_test.h"
#include "tests/postproc/self_test/dry_run_text.h"

namespace toothpath {
namespace {

constexpr double kRounding = 0.003;  // mm: words of three decimals

struct Case {
  const char* file;
  machines::TcpMode tcp;
};
using machines::TcpMode;
const Case kCases[] = {{"xyzac_trt.toml", TcpMode::angles},      {"xyzbc_trt.toml", TcpMode::angles},
                       {"head_table_bc.toml", TcpMode::none},    {"fanuc_ac.toml", TcpMode::angles},
                       {"haas_ac.toml", TcpMode::none},          {"m80_ac.toml", TcpMode::none},
                       {"siemens_ac.toml", TcpMode::angles},     {"siemens_ac.toml", TcpMode::vectors},
                       {"nutating_table.toml", TcpMode::none},   {"heidenhain_ac.toml", TcpMode::angles},
                       {"heidenhain_ac.toml", TcpMode::vectors}, {"head_head_ca.toml", TcpMode::angles},
                       {"heidenhain_ac.toml", TcpMode::none}};

void PrintTo(const Case& c, std::ostream* out) { *out << c.file << " " << static_cast<int>(c.tcp); }

machines::Machine machine_of(const Case& c) {
  machines::Machine m = *machines::read_machine_file(machines::find_machine_file(c.file, ".").value()).machine;
  m.tcp = c.tcp;
  return m;
}

/// The machine as it stands there: its axes one by one, as the maker's drawing would give them.
struct RealMachine {
  struct Axis {
    Vec3 direction, point;
    double sense, zero_deg;
  };
  std::vector<Axis> table, head;
  double bar_mm = 0;

  RealMachine(const machines::KinematicChain& file, double bar) : bar_mm(bar) {
    const auto copy = [](const machines::RotaryAxis& a) {
      return Axis{a.direction, a.point_mm, double(a.sign), degrees(a.zero_rad)};
    };
    for (const auto& a : file.table) table.push_back(copy(a));
    for (const auto& a : file.head) head.push_back(copy(a));
  }
  Axis& axis(std::size_t k) { return k < table.size() ? table[k] : head[k - table.size()]; }

  /// Place of the bar's tip as somebody on the table sees it; rotaries in deg.
  [[nodiscard]] Vec3 seen_from_table(const std::array<double, 5>& joints) const {
    const auto about = [&](const Axis& a, double command, double way) {
      const double angle = way * a.sense * (command - a.zero_deg) * kPi / 180;
      return Eigen::Affine3d(Eigen::Translation3d(a.point) * Eigen::AngleAxisd(angle, a.direction) *
                             Eigen::Translation3d(-a.point));
    };
    Eigen::Affine3d table_to_machine = Eigen::Affine3d::Identity(), spindle = Eigen::Affine3d::Identity();
    for (std::size_t k = 0; k < table.size(); ++k)
      table_to_machine = about(table[k], joints[3 + k], -1) * table_to_machine;
    for (std::size_t k = 0; k < head.size(); ++k) spindle = spindle * about(head[k], joints[3 + table.size() + k], 1);
    const Vec3 tip = Vec3(joints[0], joints[1], joints[2]) + spindle * Vec3(0, 0, -bar_mm);
    return table_to_machine.inverse() * tip;
  }
};

self_test::SelfTest planned(const machines::Machine& m) {
  auto test = self_test::plan_self_test(m);
  EXPECT_TRUE(test) << test.error().message;
  return test ? *test : self_test::SelfTest();
}

/// Joints in which the control stands at every station. @param control_data its own kinematics, for TCP
std::vector<std::array<double, 5>> stations_of(const std::string& text, const self_test::SelfTest& test,
                                               machines::Machine m, const machines::KinematicChain& control_data) {
  m.chain = control_data;
  tool::ToolAssembly bar;
  bar.number = 1;
  bar.length_mm = test.tool_length_mm;
  joints::Setup setup;
  setup.work_offset_at_mm = test.point_mm;
  auto control = controls::control_of(m, setup, std::span(&bar, 1));
  EXPECT_TRUE(control) << control.error().message;
  control->dry_run = true;
  std::vector<std::array<double, 5>> out;
  const auto status = readback::execute_nc(text, "t", *control, [&](const readback::ExecutedMove& move) {
    if (move.rapid || out.size() == test.stations.size()) return;
    const auto& wanted = test.stations[out.size()].rotary_rad;
    for (std::size_t k = 0; k < m.chain.rotary_count(); ++k) {
      double off = move.joints[3 + k] - degrees(wanted[k]);
      if (m.chain.rotary(k).rollover) off = std::remainder(off, 360);
      if (std::abs(off) > 0.001) return;
    }
    out.push_back(move.joints);
  });
  EXPECT_TRUE(status) << status.error().text();
  EXPECT_EQ(out.size(), test.stations.size());
  return out;
}

/// What the dials show, set to zero at the first station.
std::vector<Vec3> readings(const std::vector<std::array<double, 5>>& stations, const RealMachine& real) {
  std::vector<Vec3> out;
  for (const auto& joints : stations)
    out.emplace_back(real.seen_from_table(joints) - real.seen_from_table(stations.front()));
  return out;
}
double shown(const Vec3& reading) { return reading.cwiseAbs().maxCoeff(); }

class RealMachineTest : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Machines, RealMachineTest, testing::ValuesIn(kCases));

TEST_P(RealMachineTest, TheDialsStandStillOnTheMachineOfTheFile) {
  const machines::Machine m = self_test::without_tcp(machine_of(GetParam()));
  const auto test = planned(m);
  const auto joints = stations_of(test::dry_run_text(test, m), test, m, m.chain);
  for (const Vec3& r : readings(joints, RealMachine(m.chain, test.tool_length_mm))) EXPECT_LE(shown(r), kRounding);
  const auto proof = self_test::prove_self_test(test::dry_run_text(test, m), "t", test, m);
  ASSERT_TRUE(proof) << proof.error().text();
  ASSERT_EQ(proof->readings_mm.size(), test.stations.size());
  for (const Vec3& r : proof->readings_mm) EXPECT_LE(shown(r), kRounding);
}

TEST_P(RealMachineTest, AReversedSenseShowsWhatTheSheetSays) {
  const machines::Machine m = self_test::without_tcp(machine_of(GetParam()));
  const auto test = planned(m);
  const auto joints = stations_of(test::dry_run_text(test, m), test, m, m.chain);
  int senses = 0;
  for (const auto& sight : self_test::dial_sights(test, m.chain)) {
    if (sight.kind != self_test::DialSight::Kind::sense) continue;
    ++senses;
    RealMachine real(m.chain, test.tool_length_mm);
    real.axis(sight.rotary).sense *= -1;
    const auto seen = readings(joints, real);
    double most = 0;
    for (std::size_t s = 0; s < seen.size(); ++s) {
      EXPECT_NEAR(shown(seen[s]), sight.at[s], 2 * kRounding) << sight.what << " station " << s + 1;
      most = std::max(most, shown(seen[s]));
    }
    EXPECT_GT(most, 1.0) << sight.what;
  }
  EXPECT_EQ(senses, int(m.chain.rotary_count()));
}

// An axis that stands 33 mm or 0.05 mm beside its place in the file, in whatever direction across itself.
TEST_P(RealMachineTest, AnAxisBesideItsPlaceIsSeen) {
  const machines::Machine m = self_test::without_tcp(machine_of(GetParam()));
  const auto test = planned(m);
  const auto joints = stations_of(test::dry_run_text(test, m), test, m, m.chain);
  std::mt19937 random(18);
  std::uniform_real_distribution<double> angle(0, 2 * kPi);
  for (const auto& sight : self_test::dial_sights(test, m.chain)) {
    if (sight.kind != self_test::DialSight::Kind::axis) continue;
    const Vec3 d = m.chain.rotary(sight.rotary).direction;
    const Vec3 e = d.unitOrthogonal(), f = d.cross(e);
    // A head axis along the spindle has no height: what lies along the machine's Z does not move it.
    for (const double size : {33.0, 0.05}) {
      for (int n = 0; n < 12; ++n) {
        const double phi = angle(random);
        RealMachine real(m.chain, test.tool_length_mm);
        real.axis(sight.rotary).point += size * (std::cos(phi) * e + std::sin(phi) * f);
        const auto seen = readings(joints, real);
        double most = 0;
        for (std::size_t s = 0; s < seen.size(); ++s) {
          most = std::max(most, shown(seen[s]));
          if (sight.at[s] <= size) {
            EXPECT_GT(shown(seen[s]), self_test::kDialStep_mm - kRounding) << sight.what << " station " << s + 1;
          }
        }
        EXPECT_GT(most, self_test::kDialStep_mm) << sight.what << " by " << size;
      }
    }
    EXPECT_LE(*std::min_element(sight.at.begin(), sight.at.end()), 0.05) << sight.what;
  }
}

// The least error that a station is said to show is shown there, and half of it need not be.
TEST_P(RealMachineTest, TheLeastErrorOfAStationIsShownThere) {
  const machines::Machine m = self_test::without_tcp(machine_of(GetParam()));
  const auto test = planned(m);
  const auto joints = stations_of(test::dry_run_text(test, m), test, m, m.chain);
  std::size_t looked = 0;
  for (const auto& sight : self_test::dial_sights(test, m.chain)) {
    using Kind = self_test::DialSight::Kind;
    for (std::size_t s = 0; s < sight.at.size() && sight.kind != Kind::sense; ++s) {
      if (!std::isfinite(sight.at[s]) || sight.at[s] > 5) continue;
      double least = 1e9;
      for (int n = 0; n < (sight.kind == Kind::axis ? 48 : 2); ++n) {
        RealMachine real(m.chain, test.tool_length_mm);
        const double size = 1.01 * sight.at[s];
        if (sight.kind == Kind::axis) {
          const Vec3 d = m.chain.rotary(sight.rotary).direction;
          const Vec3 e = d.unitOrthogonal();
          real.axis(sight.rotary).point += size * (Eigen::AngleAxisd(n * kPi / 24, d) * e);
        } else if (sight.kind == Kind::zero) {
          real.axis(sight.rotary).zero_deg += n == 0 ? size : -size;
        } else {
          real.bar_mm += n == 0 ? size : -size;
        }
        const double now = shown(readings(joints, real)[s]);
        EXPECT_GT(now, self_test::kDialStep_mm - kRounding) << sight.what << " station " << s + 1 << " size " << size;
        least = std::min(least, now);
        ++looked;
      }
      EXPECT_LT(least, 2 * self_test::kDialStep_mm)
          << sight.what << " station " << s + 1 << ": more is shown than said";
    }
  }
  EXPECT_GT(looked, 20U);
}

// Under TCP the control holds the tip by what it knows itself: a wrong machine file shows nothing, wrong data of the
// control do. So one part of the dry run moves the joints.
TEST_P(RealMachineTest, TcpProvesTheDataOfTheControlAlone) {
  const machines::Machine m = machine_of(GetParam());
  if (m.tcp == TcpMode::none) return;
  const auto test = planned(m);
  machines::Machine wrong = m;  // as the file says: the sense of the tilt reversed and its pivot 33 mm off
  const std::size_t tilt = wrong.chain.rotary_count() - 1;
  machines::RotaryAxis& axis = wrong.chain.head.empty() ? wrong.chain.table[tilt] : wrong.chain.head.back();
  axis.sign *= -1;
  axis.point_mm += 33 * axis.direction.unitOrthogonal();
  const RealMachine real(m.chain, test.tool_length_mm);
  const auto of_wrong_file = planned(wrong);
  const auto joints = stations_of(test::dry_run_text(of_wrong_file, wrong), of_wrong_file, wrong, m.chain);
  for (const Vec3& r : readings(joints, real)) EXPECT_LE(shown(r), kRounding);
  double most = 0;
  for (const Vec3& r : readings(stations_of(test::dry_run_text(test, m), test, m, wrong.chain), real))
    most = std::max(most, shown(r));
  EXPECT_GT(most, 1.0);
  // The part with the joints does see it.
  const machines::Machine joint_file = self_test::without_tcp(wrong);
  const auto joint_test = planned(joint_file);
  most = 0;
  for (const Vec3& r : readings(
           stations_of(test::dry_run_text(joint_test, joint_file), joint_test, joint_file, joint_file.chain), real))
    most = std::max(most, shown(r));
  EXPECT_GT(most, 1.0);
}

}  // namespace
}  // namespace toothpath
