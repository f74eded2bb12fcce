#include "geometry/decks/bevel_deck.h"

#include "geometry/base/angle.h"
#include "geometry/decks/rows_deck.h"
#include "geometry/loaded_bevel/bevel_body.h"
#include "geometry/loaded_bevel/bevel_flanks.h"

namespace toothpath::decks {

Result<std::string> bevel_deck(const loaded_bevel::LoadedBevelPair& pair, int half, const BevelDeckOptions& o) {
  const contact::BevelPair& rolled = pair.pair;
  const auto on_wheel = loaded_bevel::bevel_bricks(rolled.wheel(), half, pair.sigma, o.wheel);
  if (!on_wheel) return on_wheel.error();
  const auto on_pinion = loaded_bevel::bevel_bricks(rolled.pinion(), half, pair.sigma, o.pinion);
  if (!on_pinion) return on_pinion.error();
  const loaded_bevel::BevelFlanks flanks(pair, o.phi_1);
  if (flanks.sites().empty()) return fail("no pair touches while the pinion stands at {:.4f} deg", degrees(o.phi_1));
  const auto about_z = [](double angle) { return Mat3(Eigen::AngleAxisd(angle, Vec3::UnitZ())); };
  const double tau_1 = rolled.pinion().pitch(), tau_2 = rolled.wheel().pitch();
  Mat3 wheel_frame;
  for (int k = 0; k < 3; ++k) wheel_frame.col(k) = rolled.turned_to_pinion(Vec3::Unit(k), 0);
  DeckRows rows;
  rows.head = fmt::format("bevel pair, half {}, wall {:+}, pinion at {:.6f} deg, approach {:g} mm at {:.9f} mm", half,
                          pair.sigma, degrees(o.phi_1), o.approach_mm, pair.wheel_lever);
  rows.gear = &on_wheel->sector, rows.pinion = &on_pinion->sector;
  // The sector's tooth has wall L of space 0 and wall U of space -1.
  const double to_wall = pair.sigma > 0 ? 0 : tau_2;
  rows.gear_turn = wheel_frame * about_z(-o.phi_1 / rolled.ratio() + o.tooth * tau_2 + to_wall);
  rows.gear_at = rolled.wheel_apex(), rows.axis = rolled.wheel_axis();
  rows.pinion_turn = about_z(o.phi_1 + pair.sigma * flanks.first_turn() + tau_1 / 2 - o.tooth * tau_1);
  rows.pinion_next = -1;
  rows.turn = pair.sigma * o.approach_mm / pair.wheel_lever;
  rows.teeth = o.teeth, rows.E = pair.options.wheel.E, rows.nu = pair.options.wheel.nu;
  return rows_deck(rows);
}

}  // namespace toothpath::decks
