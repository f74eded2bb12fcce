// CalculiX as judge, on the same bricks: displacements of one body, and the contact of one ring.
#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "geometry/loaded/ccx_deck.h"
#include "geometry/loaded_bevel/bevel_body.h"
#include "geometry/loaded_bevel/bevel_deck.h"
#include "tests/geometry/loaded/trial_gear.h"
#include "tests/geometry/loaded_bevel/bevel_pairs.h"

namespace toothpath::test {
namespace {

bool ccx_is_there() { return std::system("command -v ccx > /dev/null 2>&1") == 0; }

/// Runs a deck in a directory of its own; the numbers of the .dat file, a node and three values a line.
std::vector<std::pair<int, Vec3>> run_ccx(const std::string& deck, const std::string& name) {
  const auto dir = std::filesystem::temp_directory_path() / ("toothpath_ccx_" + name + std::to_string(::getpid()));
  std::filesystem::create_directories(dir);
  std::ofstream(dir / "deck.inp") << deck;
  const std::string command = "cd '" + dir.string() + "' && OMP_NUM_THREADS=1 ccx -i deck > ccx.log 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << "see " << dir;
  std::ifstream in(dir / "deck.dat");
  std::vector<std::pair<int, Vec3>> out;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    int node = 0;
    Vec3 v;
    if (words >> node >> v.x() >> v.y() >> v.z()) out.emplace_back(node, v);
  }
  std::filesystem::remove_all(dir);
  return out;
}

/// Of reactions about an axis: the nodes stand in the deck.
double moment_of(const std::string& deck, const std::vector<std::pair<int, Vec3>>& reactions, const Vec3& origin,
                 const Vec3& axis) {
  std::istringstream in(deck);
  std::string line;
  std::vector<Vec3> nodes;
  while (std::getline(in, line) && line.find("*ELEMENT") == std::string::npos) {
    int id = 0;
    Vec3 p;
    if (std::sscanf(line.c_str(), "%d, %lf, %lf, %lf", &id, &p.x(), &p.y(), &p.z()) == 4) nodes.push_back(p);
  }
  double moment = 0;
  for (const auto& [node, f] : reactions)
    moment += (nodes.at(static_cast<std::size_t>(node - 1)) - origin).cross(f).dot(axis);
  return moment;
}

TEST(CalculiX, AgreesOnTheBodies) {
  ASSERT_TRUE(ccx_is_there()) << "calculix-ccx is not installed; tools/packages.sh names it";
  const auto gear = trial_gear();
  const auto& ring = gear.rings()[1];
  elastic::SectorPlan plan;
  plan.across = 2, plan.flank = 2, plan.fillet = 2, plan.face = 3, plan.rim = 2;
  const auto pinion = contact::make_pinion(ring.surface, 30);
  const auto profile = loaded::pinion_profile(pinion, ring.surface.shaper.h_f, 1.2);
  const auto on_gear = loaded::gear_bricks(ring.surface, 1, ring.zone.inner_radius_mm, ring.zone.outer_radius_mm, plan);
  const auto on_pinion = loaded::pinion_bricks(pinion, profile, 1, 551, 584, plan);
  plan.rim_mm = 20;
  const auto on_wheel = loaded_bevel::bevel_bricks(herringbone_gears().second, 1, 1, plan),
             on_bevel_pinion = loaded_bevel::bevel_bricks(herringbone_gears().first, 0, -1, plan);
  for (const auto* body : {&on_gear, &on_pinion, &on_wheel, &on_bevel_pinion}) {
    ASSERT_TRUE(*body);
    const elastic::Sector& s = (*body)->sector;
    const auto C = elastic::tooth_compliance(s, 0.3, 3);
    ASSERT_TRUE(C);
    const int station = s.columns + 1;
    const auto moved = run_ccx(loaded::hat_deck(s, 0.3, 3, station), "hat");
    const auto row = elastic::sector_row(s, 3);
    ASSERT_EQ(moved.size(), row.nodes.size());
    double worst = 0, largest = 0;
    Mat3 turn = s.pitch;
    for (std::size_t i = 0; i < s.stations.size(); ++i) {
      const auto node = static_cast<std::size_t>(row.node_of[1][static_cast<std::size_t>(s.stations[i])]);
      const double theirs = -(turn * s.normals[i]).dot(moved[node].second),
                   ours = C->at_offset[1](static_cast<Eigen::Index>(i), station);
      worst = std::max(worst, std::abs(theirs - ours)), largest = std::max(largest, std::abs(ours));
    }
    EXPECT_LT(worst, 1e-6 * largest);
  }
}

/// Outer ring of trial 4, three teeth clamped, phase 0, 20 um: docs/loaded_contact.md.
TEST(CalculiX, AgreesOnTheContact) {
  ASSERT_TRUE(ccx_is_there()) << "calculix-ccx is not installed; tools/packages.sh names it";
  constexpr double kApproach = 0.02;
  const auto gear = trial_gear();
  loaded::PairOptions options;
  options.gear.teeth = options.pinion.teeth = 3;
  auto pair = loaded::make_loaded_pair(gear, 1, 30, options);
  ASSERT_TRUE(pair);
  pair->rings.erase(pair->rings.begin());
  double force = 15000, ours[2] = {0, 0};
  for (int round = 0; round < 6; ++round) {
    loaded::Load load;
    load.torque_nmm = force * pair->lever;
    const auto p = loaded::loaded_position(*pair, load, 0);
    ASSERT_TRUE(p) << p.error().message;
    ours[0] = ours[1] = 0;
    for (const auto& s : p->segments) ours[s.place.tooth + 1] += s.force;
    force += (kApproach - p->approach_mm) * p->tangent;
  }
  loaded::DeckOptions deck;
  deck.approach_mm = kApproach;
  const auto text = loaded::contact_deck(gear, 1, 1, deck);
  ASSERT_TRUE(text) << text.error().message;
  const auto reactions = run_ccx(*text, "contact");
  ASSERT_FALSE(reactions.empty());
  const double moment = moment_of(*text, reactions, Vec3::Zero(), Vec3::UnitZ());
  const double theirs = std::abs(moment) / pair->lever, total = ours[0] + ours[1];
  EXPECT_NEAR(total, theirs, 0.05 * theirs) << ours[0] << " + " << ours[1];
}

/// W1 with W2, wall U, three teeth clamped, the wheel turned by 40 um: docs/loaded_contact.md 8.
TEST(CalculiX, AgreesOnTheContactOfABevelPair) {
  ASSERT_TRUE(ccx_is_there()) << "calculix-ccx is not installed; tools/packages.sh names it";
  constexpr double kApproach = 0.04;
  auto options = coarse_bodies();
  for (auto* body : {&options.wheel, &options.pinion}) body->bricks = {4, 6, 3, 1, 3, 8, 20, 1};
  const auto pair = single_pair(-1, options);
  const double phi = 0.3 * pair.pair.pinion().pitch();
  loaded::Load load;
  load.torque_nmm = 1.5e6;
  double ours = 0;
  for (int round = 0; round < 5; ++round) {
    const auto p = loaded_bevel::loaded_position(pair, load, phi);
    ASSERT_TRUE(p) << p.error().message;
    ours = load.torque_nmm;
    load.torque_nmm += (kApproach - p->approach_mm) * p->tangent * pair.lever;
  }
  loaded_bevel::BevelDeckOptions deck;
  deck.wheel.rim_mm = deck.pinion.rim_mm = 20;
  deck.phi_1 = phi, deck.approach_mm = kApproach;
  const auto text = loaded_bevel::bevel_deck(pair, 0, deck);
  ASSERT_TRUE(text) << text.error().message;
  const auto reactions = run_ccx(*text, "bevel");
  ASSERT_FALSE(reactions.empty());
  const double theirs = std::abs(moment_of(*text, reactions, pair.pair.wheel_apex(), pair.pair.wheel_axis()));
  EXPECT_NEAR(ours, theirs, 0.1 * theirs);
}

}  // namespace
}  // namespace toothpath::test
