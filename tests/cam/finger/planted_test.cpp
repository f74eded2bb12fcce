// Gouges of 2 um planted with every body of a finger mill assembly: flank, fillet and tip of the cutter, shank, holder;
// at records, between records, at the ends of the face and at the edges of the groove, in one tooth space only. Depth
// and place are known from sampled points (tests/cam/finger/brute.h).
#include <map>
#include <random>

#include "tests/cam/finger/brute.h"
#include "tests/cam/finger/jobs.h"

namespace toothpath {
namespace {

using namespace bevel_test;

constexpr double kDepth = 0.002, kWithin = 2e-4, kAway = 0.1;

const finger::FingerCheckOptions kPlantedQuick{.columns = 3, .rows = 3, .ridge_columns = 2, .ridge_rows = 3};

class FingerPlanted : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    clean_ = new Milled(mill_all(w3(), 0.9));
    brute_ = new BruteFinger(clean_->gear);
    check_ = new finger::FingerGougeCheck(clean_->gear, clean_->tools, clean_->ops, limits(), kPlantedQuick);
  }
  static void TearDownTestSuite() {
    delete check_;
    delete brute_;
    delete clean_;
  }
  static proof::ProofLimits limits() {
    proof::ProofLimits t;
    t.gouge_mm = 0.0015;
    return t;
  }
  static const bevel_gear::BevelGear& gear() { return clean_->gear; }
  double uniform(double a, double b) { return a + (b - a) * double(random_()) / 4294967295.0; }

  /// Blocks of the finishing operation whose start lies between two cone distances.
  static std::vector<std::size_t> blocks(double from, double to) {
    std::vector<std::size_t> out;
    const auto& r = clean_->plans[1].path.records;
    for (std::size_t k = 1; k + 1 < r.size(); ++k)
      if (r[k].kind == path::MoveKind::feed && r[k + 1].kind == path::MoveKind::feed) {
        const double R = finger::cone_pose(gear(), r[k].tip, r[k].axis, 0).R_c;
        if (R > from && R < to) out.push_back(k);
      }
    return out;
  }
  /// Away from the ends of the face and from the groove.
  static std::vector<std::size_t> on_flanks() {
    auto out = blocks(gear().R_i() + 3, gear().R_ref() - 6);
    const auto outer = blocks(gear().R_ref() + 6, gear().R_e() - 3);
    out.insert(out.end(), outer.begin(), outer.end());
    return out;
  }
  /// Both blocks at a record, which is turned about the gear axis and moved along its own axis.
  static std::vector<path::ToolMotion> planted(std::size_t k, double turn, double up) {
    const auto& records = clean_->plans[1].path.records;
    const Eigen::AngleAxisd by(turn, Vec3::UnitZ());
    const Vec3 axis = by * records[k].axis, tip = by * records[k].tip + up * axis;
    std::vector<path::ToolMotion> out;
    for (const bool before : {true, false}) {
      path::ToolMotion m;
      const auto& other = records[before ? k - 1 : k + 1];
      m.tip_from = before ? other.tip : tip, m.tip_to = before ? tip : other.tip;
      m.axis_from = before ? other.axis : axis, m.axis_to = before ? axis : other.axis;
      m.operation = 1;
      m.line = int(before ? k : k + 1);
      out.push_back(m);
    }
    return out;
  }
  /// Which way the wall lies that the tool finishes at a record: +1 towards growing azimuth.
  static double towards_wall(std::size_t k) {
    const finger::WallReference L(gear(), 1), U(gear(), -1);
    const auto& r = clean_->plans[1].path.records[k];
    const auto pose = finger::cone_pose(gear(), r.tip, r.axis, 0);
    return std::abs(L.offset(pose.R_c, pose.theta)) < std::abs(U.offset(pose.R_c, pose.theta)) ? -1 : 1;
  }
  /// What the check says of some motions against the truth.
  static void expect_found(const std::vector<path::ToolMotion>& motions, BruteDepth truth,
                           const path::ToolMotion& deepest, const std::string& what) {
    SCOPED_TRACE(fmt::format("{}: true depth {:.6f} at {:.4f} {:.4f} {:.4f}", what, truth.depth, truth.place.x(),
                             truth.place.y(), truth.place.z()));
    const auto v = check_->verify(motions);
    EXPECT_GT(v.gouge.bound_mm, limits().gouge_mm) << "found";
    EXPECT_GE(v.gouge.bound_mm, v.gouge.measured_mm);
    EXPECT_GE(v.gouge.bound_mm, truth.depth - 1e-7);
    ASSERT_FALSE(v.gouge.worst.empty());
    const proof::WorstPlace& w = v.gouge.worst.front();
    // Where the check names a deeper place than the samples showed, that place is judged: on the finished wall, and as
    // deep as it says.
    const bool on_wall =
        w.patch != "root" && brute_->on_face(w.point, 1e-6) && std::abs(brute_->material(w.point)) < 2e-5;
    const double below_root = -gear().parameters().dedendum_mm -
                              bevel_gear::cone_point(w.point, gear().sin_delta(), gear().cos_delta()).height;
    const double there = on_wall ? brute_->inside(w.point, deepest, 400) : w.patch == "root" ? below_root : -1;
    if (there > truth.depth) truth = {there, w.point, 0};
    EXPECT_NEAR(v.gouge.measured_mm, truth.depth, kWithin);
    EXPECT_NEAR(w.depth_mm, truth.depth, kWithin);
    EXPECT_TRUE(w.line == motions.front().line || w.line == motions.back().line) << w.line;
    // Along a line of contact many places are as deep: then the one that is named must be among them.
    EXPECT_TRUE((w.point - truth.place).norm() <= kAway || there >= truth.depth - kWithin)
        << w.patch << " " << w.point.transpose();
  }
  /// Plants a wall gouge at a record: as deep as asked by one correction of the first guess.
  void plant_in_wall(std::size_t k, double share_down, const std::string& what, int& found) {
    const auto& r = clean_->plans[1].path.records[k];
    const double per_mm = towards_wall(k) / std::hypot(r.tip.x(), r.tip.y());
    double size = kDepth;
    BruteDepth truth;
    for (int round = 0; round < 2; ++round) {
      const auto motions = planted(k, size * std::sqrt(1 - share_down * share_down) * per_mm * 1.3, -size * share_down);
      truth = brute_->in_walls(pose_at(motions[0], 1));
      if (!(truth.depth > 2e-4)) return;  // beside the face, or above all walls
      if (round == 0) size *= kDepth / truth.depth;
    }
    const auto motions = planted(k, size * std::sqrt(1 - share_down * share_down) * per_mm * 1.3, -size * share_down);
    if (size > 0.02 || size * share_down > truth.depth) return;  // only grazes the wall; the root is what is cut
    expect_found(motions, truth, motions[0], fmt::format("{} record {}", what, k));
    ++found;
  }
  std::size_t pick(const std::vector<std::size_t>& from) { return from[random_() % from.size()]; }

  std::mt19937 random_{2026};
  static Milled* clean_;
  static BruteFinger* brute_;
  static finger::FingerGougeCheck* check_;
};
Milled* FingerPlanted::clean_ = nullptr;
BruteFinger* FingerPlanted::brute_ = nullptr;
finger::FingerGougeCheck* FingerPlanted::check_ = nullptr;

TEST_F(FingerPlanted, BruteForceAgreesWithTheCleanProgram) {
  for (int n = 0; n < 4; ++n) {
    const auto& r = clean_->plans[1].path.records[pick(on_flanks())];
    EXPECT_LT(std::abs(brute_->in_walls({r.tip, r.axis}).depth), 1e-6) << "a record of the path touches";
  }
}

TEST_F(FingerPlanted, ProfileOnTheWalls) {
  int found = 0;
  const auto all = on_flanks();
  for (int n = 0; n < 4; ++n) plant_in_wall(pick(all), 0, "wall", found);
  EXPECT_GE(found, 3);
}

TEST_F(FingerPlanted, FilletByTheCornerOfTheTip) {
  int found = 0;
  const auto all = on_flanks();
  for (int n = 0; n < 3; ++n) plant_in_wall(pick(all), uniform(0.4, 0.75), "fillet", found);
  EXPECT_GE(found, 2);
}

TEST_F(FingerPlanted, EndsOfTheFaceAndEdgesOfTheGroove) {
  int ends = 0, edges = 0;
  const auto small = blocks(gear().R_i() - 3, gear().R_i() + 1.5), large = blocks(gear().R_e() - 2, gear().R_e() + 2);
  const auto groove = blocks(gear().R_ref() - 4.5, gear().R_ref() + 4.5);
  for (int n = 0; n < 12 && ends < 4; ++n)
    plant_in_wall(pick(n % 2 == 0 ? small : large), 0, n % 2 == 0 ? "small end" : "large end", ends);
  for (int n = 0; n < 12 && edges < 3; ++n) plant_in_wall(pick(groove), 0, "groove", edges);
  EXPECT_EQ(ends, 4);
  EXPECT_EQ(edges, 3);
}

TEST_F(FingerPlanted, RootByTheTip) {
  const auto all = on_flanks();
  for (int n = 0; n < 6; ++n) {
    const std::size_t k = pick(all);
    const auto motions = planted(k, 0, -kDepth);
    const auto truth = brute_->in_root(pose_at(motions[0], 1));
    ASSERT_NEAR(truth.depth, kDepth, 1e-6);
    const auto v = check_->verify(motions);
    EXPECT_GE(v.gouge.bound_mm, truth.depth);
    EXPECT_NEAR(v.gouge.measured_mm, truth.depth, kWithin);
    ASSERT_FALSE(v.gouge.worst.empty());
    const proof::WorstPlace& w = v.gouge.worst.front();
    EXPECT_NEAR(w.depth_mm, truth.depth, kWithin);
    EXPECT_EQ(w.patch, "root");
    // The flat touches along a line: the place is under it, as deep as any.
    EXPECT_LE((w.point - pose_at(motions[0], 1).tip).norm(), gear().cutter().rho_o + kAway);
    EXPECT_GE(brute_->inside(w.point + truth.depth * pose_at(motions[0], 1).axis, motions[0], 50),
              truth.depth - kWithin);
  }
}

// One straight block in the place of several, both ends on the path: it cuts the wall in its middle.
TEST_F(FingerPlanted, BetweenTwoRecords) {
  const auto& records = clean_->plans[1].path.records;
  int found = 0, tried = 0;
  const auto all = on_flanks();
  while (found < 2 && tried++ < 40) {
    const std::size_t k = pick(all);
    const auto block = [&](std::size_t to) {
      path::ToolMotion m;
      m.tip_from = records[k].tip, m.tip_to = records[to].tip;
      m.axis_from = records[k].axis, m.axis_to = records[to].axis;
      m.operation = 1;
      m.line = int(to);
      return m;
    };
    for (std::size_t to = k + 2; to < std::min(k + 6, records.size()); ++to) {
      if (records[to].kind != path::MoveKind::feed) break;
      BruteDepth truth;
      const path::ToolMotion m = block(to);
      const auto deepest_at = [&](double t) {
        const auto wall = brute_->in_walls(pose_at(m, t)), root = brute_->in_root(pose_at(m, t));
        if (std::max(wall.depth, root.depth) > truth.depth) truth = wall.depth > root.depth ? wall : root, truth.t = t;
      };
      for (const double t : {0.35, 0.5, 0.65}) deepest_at(t);
      if (truth.depth < 0.0017) continue;
      if (truth.depth > 0.006) break;
      for (const double by : {0.07, 0.03, 0.015}) {
        const double t = truth.t;
        for (const double side : {-1, 1}) deepest_at(t + side * by);
      }
      expect_found({m}, truth, m, fmt::format("between records {} and {}", k, to));
      ++found;
      break;
    }
  }
  EXPECT_EQ(found, 2);
}

// All tooth spaces but one are clean.
TEST_F(FingerPlanted, InOneSpaceOnly) {
  const auto all = on_flanks();
  const int z = gear().parameters().teeth;
  for (const int space : {5, z - 1}) {
    const std::size_t k = pick(all);
    const auto& records = clean_->plans[1].path.records;
    const auto fault =
        planted(k, kDepth * 1.25 * towards_wall(k) / std::hypot(records[k].tip.x(), records[k].tip.y()) * 1.3, 0);
    const auto truth = brute_->in_walls(pose_at(fault[0], 1));
    std::vector<path::ToolMotion> motions;
    for (int tooth = 0; tooth < z; ++tooth) {
      const Eigen::AngleAxisd by(tooth * gear().pitch(), Vec3::UnitZ());
      for (std::size_t n = k - 3; n < k + 3; ++n) {  // the blocks about the fault
        path::ToolMotion m;
        m.tip_from = records[n].tip, m.tip_to = records[n + 1].tip, m.axis_from = records[n].axis,
        m.axis_to = records[n + 1].axis;
        if (tooth == space && n + 1 == k) m = fault[0];
        if (tooth == space && n == k) m = fault[1];
        m.operation = 1, m.tooth = tooth, m.line = 1000 * tooth + int(n) + 1;
        m.tip_from = by * m.tip_from, m.tip_to = by * m.tip_to, m.axis_from = by * m.axis_from,
        m.axis_to = by * m.axis_to;
        motions.push_back(m);
      }
    }
    const auto v = check_->verify(motions);
    EXPECT_NEAR(v.gouge.measured_mm, truth.depth, kWithin);
    ASSERT_FALSE(v.gouge.worst.empty());
    for (const auto& w : v.gouge.worst) {
      EXPECT_EQ(w.tooth, space);
      EXPECT_TRUE(w.line == 1000 * space + int(k) || w.line == 1000 * space + int(k) + 1) << w.line;
    }
  }
}

TEST_F(FingerPlanted, CleanProgramsShowNone) {
  for (const Designed& d :
       {Designed{w3(), pinion_mill()}, Designed{w4(), wheel_mill()}, design(20, 30, 2, 30, 0.25, -1)}) {
    const Milled job = mill_all(d);
    const finger::FingerGougeCheck check(job.gear, job.tools, job.ops, limits(), kPlantedQuick);
    const auto v = check.verify(job.motions);
    EXPECT_LE(v.gouge.bound_mm, limits().gouge_mm);
    EXPECT_GE(v.gouge.bound_mm, v.gouge.measured_mm);
    EXPECT_TRUE(v.gouge.worst.empty()) << to_string(v.gouge.worst.front().body) << " "
                                       << v.gouge.worst.front().depth_mm;
    EXPECT_TRUE(v.gouge.rapids_clear);
  }
}

/// Blank, hub or shaft that a body of the tool is pushed into.
struct Standing {
  std::string body, patch;
  std::vector<Vec2> tool, part;  ///< rims
};

/// How far a point is outside of a truncated cone.
double outside(const std::vector<Vec2>& rims, const BrutePose& pose, const Vec3& p) {
  const double h = (p - pose.tip).dot(pose.axis), rho = (p - pose.tip - h * pose.axis).norm();
  const Vec2 a = rims.front(), b = rims.back(), d = b - a, q = Vec2(h, rho) - a;
  const double above = h - b.x(), below = a.x() - h, beside = (q.y() * d.x() - q.x() * d.y()) / d.norm();
  return std::max({above, below, beside, 0.0});
}

// Shank and holder lean until they are 2 um deep in the blank, the hub or the shaft: no other body counts.
TEST_F(FingerPlanted, ShankAndHolderInBlankHubAndShaft) {
  bevel_gear::BevelGearParameters p = w3();
  p.hub_diameter_mm = 80, p.hub_length_mm = 30, p.shaft_diameter_mm = 24, p.shaft_length_mm = 120;
  const bevel_gear::BevelGear g = made(p, pinion_mill());
  const double sd = g.sin_delta(), cd = g.cos_delta();
  const auto at = [&](double ell, double height) { return Vec2(ell * sd + height * cd, ell * cd - height * sd); };
  const double back = at(g.R_e(), -5.1).y(), front = at(g.R_i(), -5.1).y(), low = -5.1 - 2 * 6;
  const std::vector<Vec2> blank = {at(g.R_i(), 4.1), at(g.R_e(), 4.1), at(g.R_i(), low), at(g.R_e(), low)};
  std::map<std::string, int> found;
  for (int n = 0; n < 40; ++n) {
    auto tools = clean_->tools;
    tool::ToolAssembly& tool = tools[0];
    tool.flute_length_mm = uniform(9.5, 14), tool.stick_out_mm = tool.flute_length_mm + uniform(1, 10),
    tool.shank_diameter_mm = uniform(6, 10);
    tool.holder = {{uniform(14, 30), uniform(30, 40), uniform(10, 40)}};
    const double s = tool.stick_out_mm;
    const std::vector<Vec2> shank = {{tool.flute_length_mm, tool.shank_diameter_mm / 2},
                                     {s, tool.shank_diameter_mm / 2}};
    const std::vector<Vec2> holder = {{s, tool.holder[0].lower_diameter_mm / 2},
                                      {s + tool.holder[0].height_mm, tool.holder[0].upper_diameter_mm / 2}};
    const std::vector<Standing> pairs = {{"shank", "blank", shank, blank},
                                         {"holder", "blank", holder, blank},
                                         {"holder", "hub", holder, {Vec2(40, back), Vec2(40, back + 30)}},
                                         {"shank", "hub", shank, {Vec2(40, back), Vec2(40, back + 30)}},
                                         {"holder", "shaft", holder, {Vec2(12, front - 120), Vec2(12, front)}}};
    const Standing& pair = pairs[std::size_t(n) % pairs.size()];
    // A tool that leans any way beside the gear, drawn towards it along a line until the overlap is what is asked.
    const double e = uniform(-0.4, 0.4), R = pair.patch == "shaft" ? g.R_i() - uniform(5, 30)
                                             : pair.patch == "hub" ? g.R_e() + uniform(2, 12)
                                                                   : uniform(g.R_i(), g.R_e());
    Vec3 axis = g.axis(e);
    axis =
        Eigen::AngleAxisd(uniform(-0.5, 0.5), Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized()) * axis;
    BrutePose pose{g.tip(R, e, uniform(20, 40)), axis};
    // Newton along the direction of the overlap: it moves the depth one to one.
    Vec3 start = pair.patch == "blank" ? g.axis(e) : Vec3(std::cos(e), std::sin(e), 0);
    BruteOverlap truth = overlap_of(pair.tool, pose, pair.part, start);
    for (int k = 0; k < 3; ++k) {
      pose.tip += (truth.depth - kDepth) * truth.direction;
      truth = overlap_of(pair.tool, pose, pair.part, truth.direction);
    }
    if (std::abs(truth.depth - kDepth) > 3e-5) continue;  // no single touch here
    path::ToolMotion m;
    m.tip_from = pose.tip, m.axis_from = m.axis_to = pose.axis;
    m.tip_to = pose.tip + 0.5 * truth.direction;  // away from the part
    m.operation = 1, m.line = 1;
    const finger::FingerGougeCheck check(g, tools, clean_->ops, limits(),
                                         {.columns = 2, .rows = 2, .ridge_columns = 2, .ridge_rows = 3});
    const auto v = check.verify(std::span(&m, 1));
    SCOPED_TRACE(fmt::format("{} in {}, case {}, true {:.6f}", pair.body, pair.patch, n, truth.depth));
    const auto named = std::find_if(v.gouge.worst.begin(), v.gouge.worst.end(), [&](const proof::WorstPlace& w) {
      return to_string(w.body) == pair.body && w.patch == pair.patch;
    });
    if (named == v.gouge.worst.end()) {
      ADD_FAILURE() << "not reported";
      continue;
    }
    EXPECT_GE(named->depth_mm, truth.depth - 5e-5) << "sampled circles and directions are that coarse";
    EXPECT_LE(named->depth_mm, truth.depth + kWithin);
    EXPECT_GE(-v.gouge.clearance_mm, truth.depth - 5e-5);
    // A generatrix of the part may touch as a line that the tool meets in one point: the place is on that line and in
    // the tool.
    EXPECT_GE(truth.direction.dot(named->point - truth.on_part), -kWithin);
    EXPECT_LE(outside(pair.tool, pose, named->point), kWithin)
        << named->point.transpose() << " for " << truth.on_part.transpose();
    ++found[pair.body + " " + pair.patch];
  }
  for (const char* what : {"shank blank", "holder blank", "holder hub", "shank hub", "holder shaft"})
    EXPECT_GE(found[what], 3) << what;
}

}  // namespace
}  // namespace toothpath
