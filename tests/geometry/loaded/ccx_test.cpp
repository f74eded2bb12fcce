// CalculiX as judge, on the same bricks: displacements and stress of one body.
#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "geometry/decks/rows_deck.h"
#include "geometry/elastic/brick_stress.h"
#include "geometry/loaded_bevel/bevel_body.h"
#include "tests/geometry/loaded/ccx.h"
#include "tests/geometry/loaded/trial_gear.h"
#include "tests/geometry/loaded_bevel/bevel_pairs.h"

namespace toothpath::test {
namespace {

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

}  // namespace
}  // namespace toothpath::test
