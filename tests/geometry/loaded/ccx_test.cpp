// CalculiX as judge, on the same bricks: displacements of one body, and the contact of one ring.
#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

#include "geometry/decks/bevel_deck.h"
#include "geometry/decks/rows_deck.h"
#include "geometry/elastic/brick_stress.h"
#include "geometry/loaded_bevel/bevel_body.h"
#include "tests/geometry/loaded/trial_gear.h"
#include "tests/geometry/loaded_bevel/bevel_pairs.h"

namespace toothpath::test {
namespace {

bool ccx_is_there() { return std::system("command -v ccx > /dev/null 2>&1") == 0; }

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What CalculiX writes: printed numbers, and fields at nodes.
struct CcxResults {
  std::string dat, frd;
};

/// Runs a deck in a directory of its own.
CcxResults run_deck(const std::string& deck, const std::string& name) {
  const auto dir = std::filesystem::temp_directory_path() / ("toothpath_ccx_" + name + std::to_string(::getpid()));
  std::filesystem::create_directories(dir);
  std::ofstream(dir / "deck.inp") << deck;
  const std::string command = "cd '" + dir.string() + "' && OMP_NUM_THREADS=1 ccx -i deck > ccx.log 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << "see " << dir;
  CcxResults out{text_of(dir / "deck.dat"), text_of(dir / "deck.frd")};
  std::filesystem::remove_all(dir);
  return out;
}

/// The numbers of the .dat file that stand a node and three values a line.
std::vector<std::pair<int, Vec3>> vectors_at_nodes(const std::string& dat) {
  std::istringstream in(dat);
  std::vector<std::pair<int, Vec3>> out;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    int node = 0;
    Vec3 v;
    if (words >> node >> v.x() >> v.y() >> v.z() && (words >> std::ws).eof()) out.emplace_back(node, v);
  }
  return out;
}

/// Stress at integration points, in their order, of every brick: xx, yy, zz, xy, xz, yz in the .dat file.
std::vector<std::vector<elastic::Stress>> stress_at_points(const std::string& dat) {
  std::vector<std::vector<elastic::Stress>> out;
  std::istringstream in(dat);
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::size_t brick = 0, point = 0;
    elastic::Stress s;
    if (!(words >> brick >> point >> s(0) >> s(1) >> s(2) >> s(3) >> s(5) >> s(4))) continue;
    if (out.size() < brick) out.resize(brick);
    out[brick - 1].push_back(s);
  }
  return out;
}

/// Stress at nodes of the .frd file, six fields of twelve characters: xx, yy, zz, xy, yz, zx.
std::vector<elastic::Stress> stress_at_nodes(const std::string& frd, std::size_t nodes) {
  std::vector<elastic::Stress> out(nodes, elastic::Stress::Zero());
  std::istringstream in(frd.substr(frd.find("STRESS")));
  std::string line;
  while (std::getline(in, line) && line.compare(0, 3, " -3") != 0) {
    if (line.compare(0, 3, " -1") != 0) continue;
    const auto node = static_cast<std::size_t>(std::stoi(line.substr(3, 10)));
    for (std::size_t k = 0; k < 6; ++k)
      out.at(node - 1)(static_cast<Eigen::Index>(k)) = std::stod(line.substr(13 + 12 * k, 12));
  }
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

/// Largest difference of the displacements of the flank of the middle tooth along its normals, part of the largest.
double worst_at_stations(const elastic::Sector& s, int station, const std::vector<std::pair<int, Vec3>>& moved) {
  const auto C = elastic::tooth_compliance(s, 0.3, 3);
  const auto row = elastic::sector_row(s, 3);
  if (!C || moved.size() != row.nodes.size()) return INFINITY;
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < s.stations.size(); ++i) {
    const auto node = static_cast<std::size_t>(row.node_of[1][static_cast<std::size_t>(s.stations[i])]);
    const double theirs = -(s.pitch * s.normals[i]).dot(moved[node].second),
                 ours = C->at_offset[1](static_cast<Eigen::Index>(i), station);
    worst = std::max(worst, std::abs(theirs - ours)), largest = std::max(largest, std::abs(ours));
  }
  return worst / largest;
}

/// A stress in the frame of the row, seen from its tooth.
elastic::Stress turned_back(const elastic::Stress& x, const Mat3& turn) {
  Mat3 m;
  m << x(0), x(3), x(5), x(3), x(1), x(4), x(5), x(4), x(2);
  m = turn.transpose() * m * turn;
  return (elastic::Stress() << m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(1, 2), m(2, 0)).finished();
}

/// Largest difference at the integration points of the middle tooth's bricks, part of the largest stress.
double worst_at_points(const elastic::Sector& s, const Eigen::VectorXd& u,
                       const std::vector<std::vector<elastic::Stress>>& theirs) {
  const auto& rule = elastic::gauss_rule(3);
  double worst = 0, largest = 0;
  for (std::size_t b = 0; b < s.bricks.size(); ++b) {
    elastic::BrickNodes x;
    Eigen::VectorXd of_brick(60);
    for (std::size_t n = 0; n < elastic::kBrickNodes; ++n) {
      x.col(static_cast<Eigen::Index>(n)) = s.nodes[static_cast<std::size_t>(s.bricks[b][n])];
      of_brick.segment<3>(static_cast<Eigen::Index>(3 * n)) = u.segment<3>(3 * s.bricks[b][n]);
    }
    const auto& of_tooth = theirs.at(s.bricks.size() + b);
    EXPECT_EQ(of_tooth.size(), 27u);
    for (std::size_t k = 0; k < of_tooth.size(); ++k) {
      const elastic::Stress ours =
          elastic::brick_stress(x, 0.3, rule.x[k % 3], rule.x[k / 3 % 3], rule.x[k / 9]) * of_brick;
      worst = std::max(worst, (ours - turned_back(of_tooth[k], s.pitch)).cwiseAbs().maxCoeff());
      largest = std::max(largest, ours.cwiseAbs().maxCoeff());
    }
  }
  return worst / largest;
}

/// The same bricks, the same hat: displacements of the flank, stress at the integration points, and at the nodes of the
/// fillet.
TEST(CalculiX, AgreesOnBodiesAndTheirStress) {
  ASSERT_TRUE(ccx_is_there()) << "calculix-ccx is not installed; tools/packages.sh names it";
  const auto gear = trial_gear();
  const auto& ring = gear.rings()[1];
  elastic::SectorPlan plan;
  plan.across = 4, plan.flank = 3, plan.fillet = 6, plan.face = 4, plan.rim = 2, plan.grading = 2;
  const auto pinion = contact::make_pinion(ring.surface, 30);
  const auto profile = loaded::pinion_profile(pinion, ring.surface.shaper.h_f, 1.2);
  const auto on_gear = loaded::gear_bricks(ring.surface, 1, ring.zone.inner_radius_mm, ring.zone.outer_radius_mm, plan);
  const auto on_pinion = loaded::pinion_bricks(pinion, profile, 1, 551, 584, plan);
  plan.rim_mm = 20;
  plan.across = 6, plan.fillet = 10, plan.face = 8;  // the corner arcs of the mills are small beside the tooth
  const auto on_wheel = loaded_bevel::bevel_bricks(herringbone_gears().second, 1, 1, plan),
             on_bevel_pinion = loaded_bevel::bevel_bricks(herringbone_gears().first, 0, -1, plan);
  for (const auto* body : {&on_gear, &on_pinion, &on_wheel, &on_bevel_pinion}) {
    ASSERT_TRUE(*body) << body->error().message;
    const elastic::Sector& s = (*body)->sector;
    const auto fields = elastic::tooth_fields(s, 0.3, 3);
    ASSERT_TRUE(fields);
    const int station = s.columns + 1;
    const auto row = elastic::sector_row(s, 3);
    const auto found = run_deck(std::regex_replace(decks::hat_deck(s, 0.3, 3, station), std::regex("\\*END STEP"),
                                                   "*EL PRINT, ELSET=BODY\nS\n*EL FILE\nS\n*END STEP"),
                                "stress");
    EXPECT_LT(worst_at_stations(s, station, vectors_at_nodes(found.dat)), 1e-6);
    const auto at_points = stress_at_points(found.dat);
    ASSERT_EQ(at_points.size(), row.bricks.size());
    EXPECT_LT(worst_at_points(s, fields->at_offset[1].col(station), at_points), 1e-5) << "printed with seven digits";
    // At nodes both extrapolate, from 2^3 points and from 3^3.
    const auto nodes = elastic::fillet_nodes(s);
    const auto stress = elastic::hat_stress(s, 0.3, *fields, nodes);
    const auto theirs = stress_at_nodes(found.frd, row.nodes.size());
    double most_ours = 0, most_theirs = 0;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      most_ours = std::max(most_ours, elastic::largest_principal(
                                          stress.at_offset[1].block<6, 1>(static_cast<Eigen::Index>(6 * n), station)));
      most_theirs = std::max(most_theirs,
                             elastic::largest_principal(
                                 theirs[static_cast<std::size_t>(row.node_of[1][static_cast<std::size_t>(nodes[n])])]));
    }
    EXPECT_NEAR(most_ours, most_theirs, 0.05 * most_theirs);
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
  decks::DeckOptions deck;
  deck.approach_mm = kApproach;
  const auto text = decks::contact_deck(gear, 1, 1, deck);
  ASSERT_TRUE(text) << text.error().message;
  const auto reactions = vectors_at_nodes(run_deck(*text, "contact").dat);
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
  decks::BevelDeckOptions deck;
  deck.wheel.rim_mm = deck.pinion.rim_mm = 20;
  deck.phi_1 = phi, deck.approach_mm = kApproach;
  const auto text = decks::bevel_deck(pair, 0, deck);
  ASSERT_TRUE(text) << text.error().message;
  const auto reactions = vectors_at_nodes(run_deck(*text, "bevel").dat);
  ASSERT_FALSE(reactions.empty());
  const double theirs = std::abs(moment_of(*text, reactions, pair.pair.wheel_apex(), pair.pair.wheel_axis()));
  EXPECT_NEAR(ours, theirs, 0.1 * theirs);
}

}  // namespace
}  // namespace toothpath::test
