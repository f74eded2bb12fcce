#include "geometry/decks/rows_deck.h"

#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::decks {
namespace {

void add_ids(std::string& out, const std::vector<int>& ids, int offset) {
  int column = 0;
  for (const int id : ids) out += fmt::format("{}{}", id + offset + 1, ++column % 12 == 0 ? "\n" : ", ");
  if (column % 12 != 0) out += "\n";
}

void add_body(std::string& out, const elastic::SectorRow& row, const std::string& name, int node_offset,
              int brick_offset) {
  out += fmt::format("*NODE, NSET={}_NODES\n", name);
  for (std::size_t n = 0; n < row.nodes.size(); ++n)
    out += fmt::format("{}, {:.12g}, {:.12g}, {:.12g}\n", n + 1 + static_cast<std::size_t>(node_offset),
                       row.nodes[n].x(), row.nodes[n].y(), row.nodes[n].z());
  out += fmt::format("*ELEMENT, TYPE=C3D20, ELSET={}\n", name);
  for (std::size_t e = 0; e < row.bricks.size(); ++e) {
    out += fmt::format("{},", e + 1 + static_cast<std::size_t>(brick_offset));
    for (std::size_t n = 0; n < elastic::kBrickNodes; ++n)
      out += fmt::format(" {}{}", row.bricks[e][n] + 1 + node_offset, n == 9 ? ",\n" : n == 19 ? "\n" : ",");
  }
  out += fmt::format("*NSET, NSET={}_HELD\n", name);
  add_ids(out, row.held, node_offset);
}

/// The loaded flanks, a surface a tooth.
void add_flanks(std::string& out, const elastic::Sector& sector, const std::string& name, int teeth, int brick_offset) {
  for (int t = 0; t < teeth; ++t) {
    out += fmt::format("*SURFACE, NAME={}_{}, TYPE=ELEMENT\n", name, t);
    for (const int brick : sector.face_bricks)
      out += fmt::format("{}, {}\n", brick + 1 + brick_offset + t * static_cast<int>(sector.bricks.size()),
                         sector.flank_face > 0 ? "S4" : "S6");
  }
}

void move(elastic::SectorRow& row, const Mat3& turn, const Vec3& shift) {
  for (Vec3& p : row.nodes) p = turn * p + shift;
}

}  // namespace

Result<std::string> contact_deck(const face_gear::FaceGear& gear, int ring, int side, const DeckOptions& o) {
  const auto& of_ring = gear.rings().at(static_cast<std::size_t>(ring));
  const auto& f = of_ring.surface;
  const auto pinion = contact::make_pinion(f, f.shaper.teeth);
  const loaded::PinionProfile profile = loaded::pinion_profile(pinion, f.shaper.h_f, o.pinion_fillet_mm);
  const auto bounds =
      loaded::contact_bounds(f, side, of_ring.zone.inner_radius_mm, of_ring.zone.outer_radius_mm, profile.least_theta);
  if (!bounds) return bounds.error();
  const auto on_gear =
      loaded::gear_bricks(f, side, of_ring.zone.inner_radius_mm, of_ring.zone.outer_radius_mm, o.bricks);
  if (!on_gear) return on_gear.error();
  const auto on_pinion = loaded::pinion_bricks(pinion, profile, side, bounds->least_Z, bounds->most_Z, o.bricks);
  if (!on_pinion) return on_pinion.error();
  const auto about_z = [](double angle) { return Mat3(Eigen::AngleAxisd(angle, Vec3::UnitZ())); };
  Mat3 frame;
  frame << pinion.d, pinion.b, pinion.a;
  DeckRows rows;
  rows.head = fmt::format(
      "face gear and pinion, ring {}, flank {:+}, pinion at {:.6f} deg, approach {:g} mm\n"
      "** normal force = moment of the reactions of GEAR_HELD about z / {:.9f} mm",
      ring, side, degrees(o.phi), o.approach_mm, f.M2);
  rows.gear = &on_gear->sector, rows.pinion = &on_pinion->sector;
  rows.gear_turn = about_z(f.i * o.phi);
  rows.pinion_turn = frame * about_z(o.phi + side * kPi / pinion.teeth);
  rows.pinion_at = pinion.foot;
  rows.turn = side * o.approach_mm / f.M2;
  rows.teeth = o.teeth, rows.E = o.E, rows.nu = o.nu;
  return rows_deck(rows);
}

std::string rows_deck(const DeckRows& o) {
  elastic::SectorRow gear = elastic::sector_row(*o.gear, o.teeth), pinion = elastic::sector_row(*o.pinion, o.teeth);
  const int middle = o.teeth / 2;
  const auto back = [&](const elastic::Sector& s) {  // from the first tooth of a row to its middle one
    Mat3 turn = Mat3::Identity();
    for (int t = 0; t < middle; ++t) turn = s.pitch.transpose() * turn;
    return turn;
  };
  move(gear, o.gear_turn * back(*o.gear), o.gear_at);
  move(pinion, o.pinion_turn * back(*o.pinion), o.pinion_at);
  std::string out = "** " + o.head + "\n";
  const int nodes = static_cast<int>(gear.nodes.size()), bricks = static_cast<int>(gear.bricks.size());
  add_body(out, gear, "GEAR", 0, 0);
  add_body(out, pinion, "PINION", nodes, bricks);
  add_flanks(out, *o.gear, "GEAR", o.teeth, 0);
  add_flanks(out, *o.pinion, "PINION", o.teeth, bricks);
  out += fmt::format("*MATERIAL, NAME=BODY\n*ELASTIC\n{:g}, {:g}\n", o.E, o.nu);
  out += "*SOLID SECTION, ELSET=GEAR, MATERIAL=BODY\n*SOLID SECTION, ELSET=PINION, MATERIAL=BODY\n";
  out += "*SURFACE INTERACTION, NAME=FLANKS\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n2.E7\n";
  for (int t = 0; t < o.teeth; ++t)
    out += fmt::format("*CONTACT PAIR, INTERACTION=FLANKS, TYPE=SURFACE TO SURFACE\nGEAR_{}, PINION_{}\n", t,
                       o.pinion_next > 0 ? t : o.teeth - 1 - t);
  out += "*BOUNDARY\nPINION_HELD, 1, 3\n*STEP, INC=50\n*STATIC\n1., 1.\n*BOUNDARY\n";
  for (const int n : gear.held) {
    const Vec3 u = o.turn * o.axis.cross(Vec3(gear.nodes[static_cast<std::size_t>(n)] - o.gear_at));
    out += fmt::format("{0}, 1, 1, {1:.12g}\n{0}, 2, 2, {2:.12g}\n{0}, 3, 3, {3:.12g}\n", n + 1, u.x(), u.y(), u.z());
  }
  out += "*NODE PRINT, NSET=GEAR_HELD\nRF\n*END STEP\n";
  return out;
}

std::string hat_deck(const elastic::Sector& sector, double nu, int teeth, int station) {
  const elastic::SectorRow row = elastic::sector_row(sector, teeth);
  const Eigen::MatrixXd loads = elastic::hat_loads(sector);
  std::string out = "** one body under a hat of force 1\n";
  add_body(out, row, "BODY", 0, 0);
  out += fmt::format("*MATERIAL, NAME=BODY\n*ELASTIC\n1., {:g}\n*SOLID SECTION, ELSET=BODY, MATERIAL=BODY\n", nu);
  out += "*BOUNDARY\nBODY_HELD, 1, 3\n*STEP\n*STATIC\n*CLOAD\n";
  const int middle = teeth / 2;
  Mat3 turn = Mat3::Identity();
  for (int t = 0; t < middle; ++t) turn = sector.pitch * turn;
  for (std::size_t n = 0; n < sector.nodes.size(); ++n) {
    const Vec3 force = turn * loads.block<3, 1>(static_cast<Eigen::Index>(3 * n), station);
    for (int k = 0; k < 3; ++k)
      if (force(k) != 0)
        out += fmt::format("{}, {}, {:.12g}\n", row.node_of[static_cast<std::size_t>(middle)][n] + 1, k + 1, force(k));
  }
  out += "*NODE PRINT, NSET=BODY_NODES\nU\n*END STEP\n";
  return out;
}

}  // namespace toothpath::decks
