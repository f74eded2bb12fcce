// The bodies of a machine against each other over executed moves: brute force, and collisions that were planted.
#include "postproc/bodies/moves.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "geometry/base/angle.h"
#include "tests/machines/chains.h"

namespace toothpath::bodies {
namespace {

using machines::Joints;
using readback::ExecutedMove;

Solid box(const Vec3& low, const Vec3& high) {
  return Solid(std::vector<Convex>{Box{(low + high) / 2, (high - low) / 2}});
}
Solid rod(const Vec3& from, const Vec3& axis, double length, double radius) {
  return Solid(std::vector<Convex>{Cone{from, axis, length, radius, radius}});
}

machines::Machine machine_with(machines::KinematicChain chain) {
  machines::Machine m;
  for (auto& axis : chain.linear) axis = {-600, 600, 10000};
  m.chain = std::move(chain);
  return m;
}

ExecutedMove move_to(const Joints& j, int line, bool rapid = false) {
  ExecutedMove m;
  m.joints = {j.linear_mm.x(), j.linear_mm.y(), j.linear_mm.z(), degrees(j.rotary_rad[0]), degrees(j.rotary_rad[1])};
  m.line = line;
  m.operation = 0;
  m.tool = 1;
  m.known = true;
  m.rapid = rapid;
  return m;
}

TEST(Links, PlaceTheToolAsTheChainDoes) {
  std::mt19937_64 rng(3);
  std::uniform_real_distribution<double> mm(-300, 300), angle(-3, 3);
  for (int i = 0; i < 200; ++i) {
    machines::KinematicChain chain = test::random_chain_kinds(rng, i);
    if (i % 2 == 1) {  // the same machine whose Y and X carry the work
      std::string order;
      for (const auto& axis : chain.table) order += axis.letter;
      order += "XY-Z";
      for (const auto& axis : chain.head) order += axis.letter;
      chain.order = order;
    }
    const machines::Links links(chain);
    const Joints q{Vec3(mm(rng), mm(rng), mm(rng)), {angle(rng), angle(rng)}};
    const auto places = links.places(q);
    EXPECT_EQ(places[links.bed()].shift.norm(), 0);
    const double length = 120;
    const Vec3 tip = places.back().of(Vec3(0, 0, -length));
    const Vec3 axis = places.back().turn * Vec3::UnitZ();
    const machines::TablePose pose = chain.forward(q, length);
    const Vec3 in_table = places.front().turn.transpose() * (tip - places.front().shift);
    EXPECT_LT((in_table - pose.tip_mm).norm(), 1e-9) << i;
    EXPECT_LT((places.front().turn.transpose() * axis - pose.axis).norm(), 1e-12) << i;
  }
}

/// Joints on the way of a move: line, or the tip straight.
Joints on_way(const machines::Machine& machine, const ExecutedMove& a, const ExecutedMove& b, double length, double t) {
  const auto at = [](const ExecutedMove& m) {
    return Joints{Vec3(m.joints[0], m.joints[1], m.joints[2]), {radians(m.joints[3]), radians(m.joints[4])}};
  };
  const Joints p = at(a), q = at(b);
  Joints out{(1 - t) * p.linear_mm + t * q.linear_mm, {}};
  for (std::size_t k = 0; k < 2; ++k) out.rotary_rad[k] = (1 - t) * p.rotary_rad[k] + t * q.rotary_rad[k];
  if (!b.tcp) return out;
  const Vec3 tip = (1 - t) * machine.chain.forward(p, length).tip_mm + t * machine.chain.forward(q, length).tip_mm;
  return machine.chain.linear_for(tip, out.rotary_rad, length);
}

struct Trial {
  machines::Machine machine;
  std::vector<Body> bodies;
  std::vector<ExecutedMove> moves;
};

constexpr double kLength = 120;

Trial random_trial(std::mt19937_64& rng, int i) {
  std::uniform_real_distribution<double> mm(-250, 250), size(5, 60), angle(-1.5, 1.5), small(-20, 20);
  Trial trial;
  trial.machine = machine_with(test::random_chain_kinds(rng, i));
  const machines::Links links(trial.machine.chain);
  for (int k = 0; k < 5; ++k) {
    Body body{"body " + std::to_string(k), std::size_t(k) % links.count(), Kind::work,
              rod(Vec3::Zero(), Vec3::UnitZ(), 1, 1)};
    if (k % 2 == 0) {
      const Vec3 low(mm(rng), mm(rng), mm(rng));
      body.solid = box(low, low + Vec3(size(rng), size(rng), size(rng)));
    } else {
      const bool about = body.link < trial.machine.chain.table.size();  // turns about its own axis
      const Vec3 axis = about ? trial.machine.chain.table[body.link].direction : test::random_axis(rng);
      const Vec3 from =
          about ? Vec3(trial.machine.chain.table[body.link].point_mm + 30 * axis) : Vec3(mm(rng), mm(rng), mm(rng));
      body.solid = rod(from, axis, size(rng), size(rng));
    }
    trial.bodies.push_back(std::move(body));
  }
  Joints q{Vec3(mm(rng), mm(rng), mm(rng)), {angle(rng), angle(rng)}};
  trial.moves.push_back(move_to(q, 1));
  for (int k = 2; k < 40; ++k) {
    const bool tcp = k % 3 == 0;
    if (k % 5 == 0) q.linear_mm = Vec3(mm(rng), mm(rng), mm(rng));
    q.linear_mm += Vec3(small(rng), small(rng), small(rng));
    for (std::size_t a = 0; a < trial.machine.chain.rotary_count(); ++a)
      q.rotary_rad[a] += (k % 7 == 0 ? 1.0 : 0.1) * angle(rng);
    trial.moves.push_back(move_to(q, k, k % 4 == 0 && !tcp));
    if (tcp) {
      trial.moves.back().tcp = true;
      trial.moves.back().tip = trial.machine.chain.forward(q, kLength).tip_mm;
    }
  }
  return trial;
}

struct Counts {
  int judged = 0, collided = 0;
};

/// Every pair against brute force: nothing is nearer than proven, and what meets is told where it meets first.
/// @param lines_rise  those of the moves do, so that they say which is first
void expect_proven(const Trial& trial, int i, Counts& counts, bool lines_rise = true) {
  std::mt19937_64 rng(std::uint64_t(i) + 11);
  std::uniform_real_distribution<double> share(0, 1);
  const MovesOptions options{.required_mm = 0, .look_mm = 1e4};
  MovesJudge judge(trial.machine, trial.bodies, {{1, kLength}}, options);
  for (const auto& m : trial.moves) judge.add(m);
  const MovesFound found = judge.finish();
  EXPECT_EQ(found.moves, trial.moves.size());
  const Scene scene(trial.machine.chain, trial.bodies);
  for (const Pair& pair : scene.pairs()) {
    const auto same = [&](const Meeting& m) {
      return m.first == scene.bodies()[pair.first].name && m.second == scene.bodies()[pair.second].name;
    };
    const auto near = std::find_if(found.nearest.begin(), found.nearest.end(), same);
    const auto failed = std::find_if(found.failed.begin(), found.failed.end(), same);
    ASSERT_NE(near == found.nearest.end(), failed == found.failed.end());
    double least = 1e9;
    int first = 0;
    for (std::size_t k = 1; k < trial.moves.size(); ++k) {
      const ExecutedMove &a = trial.moves[k - 1], &b = trial.moves[k];
      for (int n = 0; n <= 200; ++n) {
        Joints q = on_way(trial.machine, a, b, kLength, n / 200.0);
        if (b.rapid && n % 2 == 1) {  // the axes may arrive one after the other
          for (int c = 0; c < 3; ++c)
            q.linear_mm[c] += (share(rng) < 0.5 ? 0 : 1) * (b.joints[std::size_t(c)] - q.linear_mm[c]);
        }
        const double gap = scene.gap_of(pair, q, 1e9).measured;
        if (gap <= 0 && first == 0) first = b.line;
        least = std::min(least, gap);
      }
    }
    if (near != found.nearest.end()) {
      ++counts.judged;
      EXPECT_GE(least, near->proven_mm - 1e-6) << i << " " << near->first << " " << near->second;
      EXPECT_GE(near->proven_mm, options.share * near->measured_mm - options.apart_mm - 1e-9);
      EXPECT_GT(least, 0);
    } else {
      ++counts.collided;
      if (first > 0 && lines_rise) { EXPECT_LE(failed->line, first) << i; }
      EXPECT_TRUE(first > 0 || failed->measured_mm < 0.5) << i << " " << failed->measured_mm << " " << least;
    }
  }
}

TEST(Moves, NothingIsNearerThanProven) {
  std::mt19937_64 rng(11);
  Counts counts;
  for (int i = 0; i < 60; ++i) expect_proven(random_trial(rng, i), i, counts);
  EXPECT_GT(counts.judged, 200);
  EXPECT_GT(counts.collided, 5);
}

/// The moves of a trial as five teeth, turned by the joint next to the work; the fourth one goes another way.
/// @param loop  they are turns of a loop, not named
Trial in_teeth(Trial trial, bool loop) {
  const machines::Links links(trial.machine.chain);
  const machines::Joint& turn = links.joints().front();
  std::vector<ExecutedMove> one = std::move(trial.moves);
  trial.moves.clear();
  int line = 0;
  for (int tooth = 0; tooth < 5; ++tooth)
    for (ExecutedMove m : one) {
      if (!loop) m.line = ++line;
      m.tooth = std::int16_t(loop ? -1 : tooth);
      if (turn.rotary && links.bed() > 0) m.joints[3 + turn.axis] += 40.0 * tooth;
      if (tooth == 3) m.joints[2] -= 15;
      const Joints q{Vec3(m.joints[0], m.joints[1], m.joints[2]), {radians(m.joints[3]), radians(m.joints[4])}};
      if (m.tcp) m.tip = trial.machine.chain.forward(q, kLength).tip_mm;
      trial.moves.push_back(m);
    }
  return trial;
}

TEST(Moves, NothingIsNearerThanProvenOnTeethThatRepeat) {
  for (const bool loop : {false, true}) {
    std::mt19937_64 rng(12);
    Counts counts;
    for (int i = 0; i < 10; ++i) expect_proven(in_teeth(random_trial(rng, i), loop), i, counts, !loop);
    EXPECT_GT(counts.judged, 30);
    EXPECT_GT(counts.collided, 2);
  }
}

// Ten teeth alike. A tool that goes deeper in the seventh one; a post on the table that comes under it with the fifth.
// Written out and named, or turns of a loop.
TEST(Moves, OneToothOfManyIsFound) {
  const machines::Machine machine = machine_with(test::ac_table());
  const Vec3 at = machine.chain.table.front().point_mm;
  std::vector<Body> bodies = {
      {"plate", 0, Kind::machine, rod(at, Vec3::UnitZ(), 20, 80)},
      {"nose", machines::Links(machine.chain).count() - 1, Kind::machine, rod(Vec3::Zero(), Vec3::UnitZ(), 50, 10)}};
  bool loop = false;
  const auto failure = [&](bool deeper, bool post) {
    std::vector<Body> all = bodies;
    const double fifth = radians(36.0 * 5);
    if (post)  // under the nose once the table has turned by five teeth
      all.push_back({"post", 0, Kind::machine,
                     rod(at + machine.chain.table.front().rotation(fifth) * Vec3(60, 0, 20), Vec3::UnitZ(), 40, 4)});
    MovesJudge judge(machine, all, {{1, kLength}}, {});
    for (int tooth = 0; tooth < 10; ++tooth)
      for (int k = 0; k < 4; ++k) {
        const double z = at.z() + (deeper && tooth == 7 && k == 2 ? 15 : k % 2 == 0 ? 40 : 90);
        ExecutedMove m = move_to({Vec3(at.x() + 60, at.y(), z), {radians(36.0 * tooth), 0}},
                                 100 + (loop ? 0 : 10 * tooth) + k, k % 2 == 1);
        m.tooth = std::int16_t(loop ? -1 : tooth);
        judge.add(m);
      }
    const MovesFound found = judge.finish();
    // The first move of the first tooth comes from nowhere, that of the others from above; the post stands beside all.
    if (!post) { EXPECT_EQ(found.repeated, deeper ? 4 * 7 : 4 * 8) << loop; }
    return found.clear() ? std::pair(0, 0.0)
                         : std::pair(found.failed.front().line, degrees(found.failed.front().joints.rotary_rad[0]));
  };
  EXPECT_EQ(failure(false, false).first, 0);
  EXPECT_EQ(failure(true, false).first, 172);
  const int line = failure(false, true).first;
  EXPECT_GE(line, 140);  // the turn to it, from above, or its first cut
  EXPECT_LE(line, 152);
  loop = true;
  EXPECT_EQ(failure(false, false).first, 0);
  EXPECT_EQ(failure(true, false), std::pair(102, 36.0 * 7));
  EXPECT_NEAR(failure(false, true).second, 36.0 * 5, 36.0);
}

/// A cradle machine: C on A, a table, a cradle, a column and a spindle nose.
std::vector<Body> bodies_of(const machines::KinematicChain& chain) {
  const machines::Links links(chain);
  std::vector<Body> bodies;
  bodies.push_back({"table", *links.find("table"), Kind::machine, rod(Vec3(0, 0, -20), Vec3::UnitZ(), 20, 100)});
  bodies.push_back({"column", links.bed(), Kind::machine, box(Vec3(-200, 250, -400), Vec3(200, 400, 600))});
  bodies.push_back({"nose", *links.find("spindle"), Kind::machine, rod(Vec3::Zero(), Vec3::UnitZ(), 100, 40)});
  bodies.push_back({"T1", *links.find("spindle"), Kind::tool, rod(Vec3(0, 0, -kLength), Vec3::UnitZ(), kLength, 5), 1});
  bodies.push_back({"part", *links.find("table"), Kind::work, rod(Vec3::Zero(), Vec3::UnitZ(), 40, 80)});
  return bodies;
}

MovesFound judged(const machines::Machine& machine, const std::vector<Body>& bodies, const std::vector<Joints>& way) {
  MovesJudge judge(machine, bodies, {{1, kLength}}, {.required_mm = 0.1, .look_mm = 500});
  int line = 10;
  for (const Joints& q : way) judge.add(move_to(q, line++));
  return judge.finish();
}

// The tip beside the part, a little more than the clearance above the table: that is kept, and told so.
TEST(Moves, AGapThatIsALittleLargerThanAskedIsProven) {
  const machines::Machine machine = machine_with(test::ac_table());
  const std::vector<Body> bodies = bodies_of(machine.chain);
  const auto along = [&](double gap) {
    const double z = kLength + gap;
    return judged(machine, bodies, {{Vec3(90, 0, z), {}}, {Vec3(91, 0, z), {}}});
  };
  EXPECT_TRUE(along(0.1008).clear());
  EXPECT_FALSE(along(0.0998).clear());
}

TEST(Moves, PlantedCollisionsAreFoundAtTheirLine) {
  const Vec3 up(0, 0, 200);
  struct Case {
    const char* what;
    machines::KinematicChain chain;
    std::vector<Joints> way;
    int line;  ///< 0: clear
    const char *first, *second;
  };
  const std::vector<Case> cases = {
      {"table-table, the spindle goes into the table beside the part",
       test::ac_table(),
       {{up, {}}, {Vec3(90, 0, 200), {}}, {Vec3(90, 0, 130), {}}, {Vec3(90, 0, 110), {}}, {Vec3(90, 0, 200), {}}},
       13,
       "table",
       "T1"},
      {"table-table, the table swings into the column",
       test::ac_table(),
       {{Vec3(-300, -300, 300), {}}, {Vec3(-300, -300, 300), {3.0, 0}}, {Vec3(-300, -300, 300), {3.0, 0.5}}},
       0,
       "",
       ""},
      {"head-head, the nose leans into the part",
       test::head_head('B'),
       {{Vec3(0, 0, 170), {}},
        {Vec3(0, 0, 170), {0.5, 0.0}},
        {Vec3(0, 0, 170), {0.5, 1.2}},
        {Vec3(-60, 0, 70), {0.5, 1.2}}},
       13,
       "nose",
       "part"},
      {"head-table, the nose goes into the column",
       test::head_table('B'),
       {{up, {}}, {Vec3(0, 150, 200), {2.0, 0.3}}, {Vec3(0, 215, 200), {}}},
       12,
       "column",
       "nose"},
      {"head-table, clear", test::head_table('A'), {{up, {}}, {Vec3(0, 150, 200), {2.0, 0.3}}}, 0, "", ""},
  };
  for (const Case& c : cases) {
    const machines::Machine machine = machine_with(c.chain);
    const MovesFound found = judged(machine, bodies_of(machine.chain), c.way);
    if (c.line == 0) {
      EXPECT_TRUE(found.clear()) << c.what << ": " << (found.failed.empty() ? "" : found.failed.front().second);
      continue;
    }
    ASSERT_FALSE(found.clear()) << c.what;
    const Meeting& m = found.failed.front();
    EXPECT_EQ(m.line, c.line) << c.what;
    const std::set<std::string> names = {m.first, m.second}, wanted = {c.first, c.second};
    EXPECT_EQ(names, wanted) << c.what;
  }
}

TEST(Moves, DepthAndJointsOfACollision) {
  const machines::Machine machine = machine_with(test::ac_table());
  const MovesFound found = judged(machine, bodies_of(machine.chain), {{Vec3(90, 0, 200), {}}, {Vec3(90, 0, 110), {}}});
  ASSERT_EQ(found.failed.size(), 1u);
  const Meeting& m = found.failed.front();
  EXPECT_LE(m.joints.linear_mm.z(), 120.1);
  EXPECT_NEAR(m.joints.linear_mm.x(), 90, 1e-9);
  EXPECT_LE(m.measured_mm, 0.1);
}

/// The height that is offered is enough, and is needed: moves of a part that stands so much higher, or 3 mm less.
TEST(Moves, AHigherPartKeepsClear) {
  for (const auto& chain : {test::ac_table(), test::head_table('B')}) {
    const machines::Machine machine = machine_with(chain);
    const auto way = [&](double higher) {
      std::vector<Joints> joints;
      for (const Vec3& at : {Vec3(90, 0, 200), Vec3(90, 0, 110), Vec3(70, 0, 105), Vec3(70, 0, 200)})
        joints.push_back({at + Vec3(0, 0, at.z() < 200 ? higher : 0), {}});
      return joints;
    };
    const MovesFound found = judged(machine, bodies_of(machine.chain), way(0));
    ASSERT_FALSE(found.clear());
    double higher = 0;
    for (const Meeting& m : found.failed) {
      ASSERT_TRUE(m.higher_mm) << m.first << " and " << m.second;
      higher = std::max(higher, *m.higher_mm);
    }
    EXPECT_TRUE(judged(machine, bodies_of(machine.chain), way(higher)).clear()) << higher;
    EXPECT_FALSE(judged(machine, bodies_of(machine.chain), way(higher - 3)).clear()) << higher;
  }
}

TEST(Moves, WhatBearsIsNotLookedAt) {
  machines::Machine machine = machine_with(test::ac_table());
  auto bodies = bodies_of(machine.chain);
  bodies.push_back({"cradle", 1, Kind::machine, box(Vec3(-150, -50, -60), Vec3(150, 50, -20))});  // under the table
  const MovesFound found = judged(machine, bodies, {{Vec3(0, 0, 300), {}}, {Vec3(0, 0, 300), {1.0, 0}}});
  EXPECT_EQ(found.bearing, std::vector<std::string>{"table, cradle"});
  EXPECT_TRUE(found.clear());
  // The same a link farther is a collision, unless it is said to be none.
  bodies.back().link = 2;
  EXPECT_FALSE(judged(machine, bodies, {{Vec3(0, 0, 300), {}}, {Vec3(0, 0, 300), {1.0, 0}}}).clear());
  bodies.back().touches = {"table"};
  EXPECT_TRUE(judged(machine, bodies, {{Vec3(0, 0, 300), {}}, {Vec3(0, 0, 300), {1.0, 0}}}).clear());
}

TEST(Moves, ALinearAxisOnTheSideOfTheWorkMovesTheTable) {
  machines::Machine machine = machine_with(test::ac_table());
  const std::vector<Joints> way = {{Vec3(0, -100, 300), {}}, {Vec3(0, -200, 300), {}}};  // the table goes to +Y
  EXPECT_TRUE(judged(machine, bodies_of(machine.chain), way).clear());
  machine.chain.order = "CAY-XZ";
  const MovesFound found = judged(machine, bodies_of(machine.chain), way);
  ASSERT_FALSE(found.clear());
  EXPECT_EQ(found.failed.front().line, 11);
}

TEST(Moves, MovesFromNowhereAreCounted) {
  const machines::Machine machine = machine_with(test::ac_table());
  MovesJudge judge(machine, bodies_of(machine.chain), {{1, kLength}}, {});
  ExecutedMove first = move_to({Vec3(0, 0, 300), {}}, 1);
  first.known = false;
  judge.add(first);
  judge.add(move_to({Vec3(0, 0, 290), {}}, 2));
  const MovesFound found = judge.finish();
  EXPECT_EQ(found.moves, 2u);
  EXPECT_EQ(found.unjudged, 1u);
  EXPECT_TRUE(found.clear());
}

}  // namespace
}  // namespace toothpath::bodies
