// Planted faults: whatever a program does wrong is found and named, on walls, root, ends, corner, in the wrong tooth,
// and with shank and holder against hub and shaft.
#include <random>
#include <regex>

#include "cam/finger/obstacles.h"
#include "cam/finger/teeth.h"
#include "tests/cam/finger/jobs.h"

namespace toothpath {
namespace {

using namespace bevel_test;

const finger::FingerCheckOptions kFaultsQuick{.columns = 5, .rows = 5, .ridge_columns = 4, .ridge_rows = 9};

class FingerFaults : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    clean_ = new Milled(mill_all(w3(), 0.9));
    check_ = new finger::FingerGougeCheck(clean_->gear, clean_->tools, clean_->ops, proof::ProofLimits{}, kFaultsQuick);
  }
  static void TearDownTestSuite() {
    delete check_;
    delete clean_;
  }
  static const Milled& clean() { return *clean_; }
  static const finger::FingerGougeCheck& check() { return *check_; }

  static Milled* clean_;
  static finger::FingerGougeCheck* check_;
};
Milled* FingerFaults::clean_ = nullptr;
finger::FingerGougeCheck* FingerFaults::check_ = nullptr;

/// The record turned about the gear axis and moved along the tool axis.
path::ClRecord moved(path::ClRecord r, double turn, double up) {
  r.tip = Eigen::AngleAxisd(turn, Vec3::UnitZ()) * r.tip;
  r.axis = Eigen::AngleAxisd(turn, Vec3::UnitZ()) * r.axis;
  r.tip += up * r.axis;
  return r;
}

// Random records of both operations, moved 4 to 60 um towards the nearer wall or into the root.
TEST_F(FingerFaults, RandomPlacesOnWallsRootEndsAndCorner) {
  std::mt19937 random(20260);
  int on_wall = 0, in_root = 0, at_ends = 0, in_corner = 0;
  const finger::WallReference L(clean().gear, 1), U(clean().gear, -1);
  for (int n = 0; n < 160; ++n) {
    const std::size_t op = random() % 2;
    path::ClPath path = clean().plans[op].path;
    const std::size_t at = random() % path.records.size();
    auto& record = path.records[at];
    if (record.kind != path::MoveKind::feed) continue;
    const finger::ConePose pose = finger::cone_pose(clean().gear, record.tip, record.axis, 0);
    if (pose.R_c > clean().gear.R_e()) continue;  // run-out: nothing to gouge
    const double depth = 0.004 + 0.056 * static_cast<double>(random() % 1000) / 1000;
    const double side_L = L.offset(pose.R_c, pose.theta), side_U = U.offset(pose.R_c, pose.theta);
    std::string expected;
    if (random() % 3 == 0) {
      if (pose.R_c < clean().gear.R_i()) continue;  // the tip is beside the blank
      record = moved(record, 0, -depth);
      expected = "";
      ++in_root;
    } else {
      const bool at_L = side_L < side_U;
      // Beyond the end of the face only the edge can be touched.
      if (pose.R_c < clean().gear.R_i() + 0.5) continue;
      const double lateral = std::min(side_L, side_U) + depth;
      record =
          moved(record, (at_L ? -1 : 1) * lateral / (pose.R_c * clean().gear.sin_delta() * std::cos(radians(45))), 0);
      expected = at_L ? "wall L" : "wall U";
      ++on_wall;
      at_ends += pose.R_c < clean().gear.R_i() + 3 || pose.R_c > clean().gear.R_e() - 3;
      in_corner += std::abs(pose.R_c - clean().gear.R_ref()) < 3.5;
    }
    const auto verdict = check().approve(path);
    ASSERT_FALSE(verdict) << "operation " << op << " record " << at << " depth " << depth;
    if (!expected.empty()) {
      EXPECT_NE(verdict.error().message.find(expected), std::string::npos) << verdict.error().message;
    }
  }
  EXPECT_GE(on_wall, 30);
  EXPECT_GE(in_root, 20);
  EXPECT_GE(at_ends, 3);
  EXPECT_GE(in_corner, 3);
}

TEST_F(FingerFaults, CleanPathsPass) {
  for (const auto& plan : clean().plans) {
    const auto verdict = check().approve(plan.path);
    EXPECT_TRUE(verdict) << verdict.error().message;
  }
}

// What is reported names line, tooth and half.
TEST_F(FingerFaults, TheWorstPlaceIsNamed) {
  std::vector<path::ToolMotion> motions = clean().motions;
  std::vector<std::size_t> inner;
  for (std::size_t i = 0; i + 1 < motions.size(); ++i) {
    const finger::ConePose pose = finger::cone_pose(clean().gear, motions[i].tip_to, motions[i].axis_to, 0);
    if (motions[i].operation == 1 && !motions[i].rapid && pose.lift < 0.01 && pose.R_c > 90 && pose.R_c < 98)
      inner.push_back(i);
  }
  ASSERT_GT(inner.size(), 4u);
  const std::size_t at = inner[inner.size() / 2];
  motions[at].tip_to -= 0.012 * motions[at].axis_to;
  motions[at + 1].tip_from = motions[at].tip_to;
  for (auto& m : motions) {  // the same in tooth 3
    m.tooth = 3;
    const Mat3 R = Eigen::AngleAxisd(3 * clean().gear.pitch(), Vec3::UnitZ()).toRotationMatrix();
    m.tip_from = R * m.tip_from, m.tip_to = R * m.tip_to, m.axis_from = R * m.axis_from, m.axis_to = R * m.axis_to;
  }
  const auto v = check().verify(motions);
  EXPECT_NEAR(v.gouge.bound_mm, 0.012, 0.004);
  EXPECT_NEAR(v.gouge.measured_mm, 0.012, 0.002);
  ASSERT_FALSE(v.gouge.worst.empty());
  const proof::WorstPlace& w = v.gouge.worst.front();
  EXPECT_TRUE(w.line == motions[at].line || w.line == motions[at + 1].line) << w.line;
  EXPECT_EQ(w.operation, 1);
  EXPECT_EQ(w.tooth, 3);
  EXPECT_EQ(w.zone, 0);
  EXPECT_EQ(w.body, tool::Body::flute);
}

TEST_F(FingerFaults, WrongToothIsFound) {
  for (const double teeth : {0.5, 1.0, 0.01}) {
    path::ClPath path = clean().plans[1].path;
    for (auto& record : path.records) record = moved(record, teeth * clean().gear.pitch(), 0);
    EXPECT_FALSE(check().approve(path)) << teeth;
  }
}

TEST_F(FingerFaults, MissingPassIsLeftMaterial) {
  for (int skip = 0; skip < 3; ++skip) {
    std::vector<path::ToolMotion> motions = path::motions_of(clean().plans[0].path);
    int pass = -1;
    const auto& records = clean().plans[1].path.records;
    const auto all = path::motions_of(clean().plans[1].path);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (records[i + 1].kind == path::MoveKind::engage) ++pass;
      if (pass != skip) motions.push_back(all[i]);
    }
    EXPECT_GT(check().verify(motions).finished.max_mm, 0.02) << "pass " << skip;
  }
}

// Teeth that go nearly as the first one are proven as before, motion by motion, and looked at only where they are the
// least proven: bounds are the same, what is found is away by no more than the teeth are.
TEST_F(FingerFaults, TeethThatAreAlikeAreLookedAtOnce) {
  std::mt19937 random(60);
  std::uniform_real_distribution<double> off(-0.0004, 0.0004);
  std::vector<path::ToolMotion> motions;
  std::vector<proof::LikeMotion> likes;
  const auto first = path::motions_of(clean().plans[1].path);
  const std::uint32_t count = std::uint32_t(first.size());
  for (int tooth = 0; tooth < 6; ++tooth) {
    const Mat3 R = Eigen::AngleAxisd(tooth * clean().gear.pitch(), Vec3::UnitZ()).toRotationMatrix();
    Vec3 shift = Vec3::Zero();  // of the end of the motion before
    for (std::uint32_t k = 0; k < count; ++k) {
      path::ToolMotion m = first[k];
      m.tooth = tooth;
      m.tip_from = R * m.tip_from + shift;
      if (tooth > 0) shift = Vec3(off(random), off(random), off(random));
      m.tip_to = R * m.tip_to + shift;
      m.axis_from = R * m.axis_from;
      m.axis_to = R * m.axis_to;
      if (tooth > 0) likes.push_back({std::uint32_t(motions.size()), k, k + 1, 0.0007F, 0});
      motions.push_back(m);
    }
  }
  const double away = 0.0007;
  const auto whole = finger::verify_teeth(check(), motions), shared = finger::verify_teeth(check(), motions, likes);
  EXPECT_EQ(shared.gouge.bound_mm, whole.gouge.bound_mm);
  EXPECT_EQ(shared.gouge.bound_line, whole.gouge.bound_line);
  EXPECT_EQ(shared.gouge.clearance_mm, whole.gouge.clearance_mm);
  EXPECT_EQ(shared.gouge.motions, whole.gouge.motions);
  EXPECT_EQ(shared.wall_excess_bound_mm, whole.wall_excess_bound_mm);
  EXPECT_EQ(shared.finished.bound_mm, whole.finished.bound_mm);
  EXPECT_LE(shared.gouge.measured_mm, whole.gouge.measured_mm);
  EXPECT_GE(shared.gouge.measured_mm, whole.gouge.measured_mm - away);
  EXPECT_GE(shared.gouge.clearance_measured_mm, whole.gouge.clearance_measured_mm);
  EXPECT_LE(shared.gouge.clearance_measured_mm, whole.gouge.clearance_measured_mm + away);
  EXPECT_LT(shared.gouge.distance_queries, whole.gouge.distance_queries + 1);

  // A motion that is like no other puts its tooth among those that are looked at.
  const std::size_t at = 3 * count + count / 2;
  motions[at].tip_to -= 0.012 * motions[at].axis_to;
  motions[at + 1].tip_from = motions[at].tip_to;
  std::erase_if(likes, [&](const proof::LikeMotion& l) { return l.motion == at || l.motion == at + 1; });
  const auto found = finger::verify_teeth(check(), motions, likes), all = finger::verify_teeth(check(), motions);
  EXPECT_GT(all.gouge.bound_mm, 0.002);
  EXPECT_EQ(found.gouge.bound_mm, all.gouge.bound_mm);
  EXPECT_EQ(found.gouge.measured_mm, all.gouge.measured_mm);
  ASSERT_FALSE(found.gouge.worst.empty());
  EXPECT_EQ(found.gouge.worst.front().tooth, 3);
}

TEST_F(FingerFaults, HubAndShaftStandInTheWay) {
  // A hub as wide as the blank is cut by the run-out at the large end, one below the root is not; a thin shaft is
  // clear, a thick one meets the cutter at the small end.
  struct Case {
    double hub, shaft;
    bool clear;
    const char* name;
  };
  const double sd = clean().gear.sin_delta(), cd = clean().gear.cos_delta();
  int cuts_told = 0;
  const double root_e = clean().gear.R_e() * sd - 5.1 * cd, root_i = clean().gear.R_i() * sd - 5.1 * cd;
  for (const Case& c : {Case{2 * root_e + 8, 0, false, "hub"}, Case{2 * root_e - 12, 0, true, ""},
                        Case{0, 2 * root_i + 8, false, "shaft"}, Case{0, 2 * root_i - 20, true, ""}}) {
    bevel_gear::BevelGearParameters p = w3();
    p.hub_diameter_mm = c.hub;
    p.hub_length_mm = c.hub > 0 ? 30 : 0;
    p.shaft_diameter_mm = c.shaft;
    p.shaft_length_mm = c.shaft > 0 ? 30 : 0;
    const bevel_gear::BevelGear gear = made(p, pinion_mill());
    const finger::FingerGougeCheck with_bodies(gear, clean().tools, clean().ops, proof::ProofLimits{}, kFaultsQuick);
    bool clear = true;
    std::string message;
    for (const auto& plan : clean().plans)
      if (const auto verdict = with_bodies.approve(plan.path); !verdict) {
        clear = false, message = verdict.error().message;
        // Of a cut the worst record is told, not the first.
        const auto depth = std::regex(" record ([0-9]+): the cutter goes ([0-9.]+) mm into ");
        std::smatch match;
        if (!std::regex_search(message, match, depth)) continue;
        const auto motions = path::motions_of(plan.path);
        EXPECT_NEAR(std::stod(match[2]), with_bodies.verify(motions).gouge.bound_mm, 6e-5) << message;
        for (const auto& m : motions)
          if (std::to_string(m.line) == match[1]) {
            EXPECT_NEAR(std::stod(match[2]), with_bodies.verify({&m, 1}).gouge.bound_mm, 6e-5) << message;
            ++cuts_told;
          }
      }
    EXPECT_EQ(clear, c.clear) << "hub " << c.hub << " shaft " << c.shaft << ": " << message;
    if (!c.clear) { EXPECT_NE(message.find(c.name), std::string::npos) << message; }
  }
  EXPECT_GT(cuts_told, 0);
}

// The holder alone against a long shaft: flute and shank are clear.
TEST_F(FingerFaults, HolderAgainstShaft) {
  bevel_gear::BevelGearParameters p = w3();
  p.shaft_diameter_mm = 20;
  p.shaft_length_mm = 200;
  const bevel_gear::BevelGear gear = made(p, pinion_mill());
  auto tools = clean().tools;
  tools[0].holder = {{320, 320, 40}};
  const finger::FingerGougeCheck with_shaft(gear, tools, clean().ops, proof::ProofLimits{}, kFaultsQuick);
  const auto v = with_shaft.verify(clean().motions);
  EXPECT_LT(v.gouge.clearance_mm, 0.05);
  ASSERT_FALSE(v.gouge.worst.empty());
  EXPECT_EQ(v.gouge.worst.front().body, tool::Body::holder);
  EXPECT_EQ(v.gouge.worst.front().patch, "shaft");
  EXPECT_LE(v.gouge.bound_mm, 2e-3) << "no cut";
}

// The gap is never above the distance of sampled points of both bodies, and comes close to it where the axes share a
// plane.
TEST(FingerObstacles, GapAgainstSampledPoints) {
  std::mt19937 random(77);
  const auto uniform = [&](double a, double b) { return a + (b - a) * static_cast<double>(random()) / 4294967295.0; };
  for (int n = 0; n < 24; ++n) {
    const finger::ToolHull tool{tool::Body::holder, {Vec2(10, uniform(3, 9)), Vec2(30, uniform(3, 15))}};
    const finger::CoaxialBody body{"hub", {Vec2(uniform(5, 20), 0), Vec2(uniform(5, 20), 25)}};
    path::ToolMotion m;
    const double lean = uniform(-1.2, 1.2);
    const bool coplanar = n % 2 == 0;
    m.tip_from = m.tip_to = Vec3(uniform(25, 50), coplanar ? 0 : uniform(-5, 5), uniform(-10, 30));
    m.axis_from = m.axis_to = Vec3(std::cos(lean), 0, std::sin(lean));
    const double gap = finger::body_gap(tool, body, m);
    const Vec3 u = m.axis_from, v(0, 1, 0), w = u.cross(v);
    double nearest = 1e9;
    for (int i = 0; i <= 20; ++i)
      for (int a = 0; a < 48; ++a)
        for (int s = 1; s <= 3; s += 2) {
          const double t = i / 20.0, r = (tool.rims[0].y() + t * (tool.rims[1].y() - tool.rims[0].y())) * s / 3,
                       phi = a * kPi / 24;
          const Vec3 q = m.tip_from + (10 + 20 * t) * u + r * (std::cos(phi) * v + std::sin(phi) * w);
          // Exact distance to the frustum about z, from outside: over its generatrix and discs in the meridian plane.
          const double rho = std::hypot(q.x(), q.y());
          double d = 1e9;
          for (int k = 0; k <= 50; ++k) {
            const double z = 25.0 * k / 50, R = body.rims[0].x() + (body.rims[1].x() - body.rims[0].x()) * k / 50;
            d = std::min(d, rho <= R ? std::abs(q.z() - z) : std::hypot(rho - R, q.z() - z));
          }
          nearest = std::min(nearest, d);
        }
    EXPECT_LE(gap, nearest + 0.15) << n;
    if (coplanar && nearest > 1) { EXPECT_GE(gap, nearest - 0.8) << n; }
  }
}

}  // namespace
}  // namespace toothpath
