#include "geometry/loaded_bevel/bevel_body.h"

#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::loaded_bevel {
namespace {

using bevel_gear::BevelGear;
using bevel_gear::BevelWall;
using elastic::SectorPlan;
using elastic::ToothSection;

constexpr int kMostFilletBricks = 6;

/// One wall at a cone distance, from the tip to the root: (azimuth, height).
Result<std::vector<Vec2>> wall_boundary(const BevelWall<double>& wall, double ell, double top, const SectorPlan& plan) {
  const auto& c = wall.cutter;
  const auto place = [&](double p) -> std::optional<Vec2> {  // of a point of the mill's profile
    const auto beta = bevel_gear::bevel_beta_at(wall, ell, p);
    if (!beta) return std::nullopt;
    const Vec3 at = wall.point(*beta, p).p;
    return Vec2(azimuth(at), wall.generatrix(*beta, p)[1]);
  };
  const auto end = place(c.p_B);
  if (!end) return fail("the corner arc of the mill does not reach cone distance {:.4f} mm", ell);
  std::vector<Vec2> out;
  std::optional<bevel_gear::BevelInverse> near;
  for (int k = 0; k < 2 * plan.flank; ++k) {
    const double height = top + (end->y() - top) * k / (2 * plan.flank);
    auto at = near ? bevel_gear::bevel_inverse(wall, ell, height, *near) : std::nullopt;
    if (!at) at = bevel_gear::bevel_inverse(wall, ell, height);
    if (!at) return fail("no place of the wall at cone distance {:.4f} mm, height {:.4f} mm", ell, height);
    near = at;
    out.emplace_back(at->azimuth, height);
  }
  const auto follow = [&](const Vec2& at) {
    out.emplace_back(out.back().x() + wrapped(at.x() - out.back().x()), at.y());
  };
  follow(*end);
  for (int k = 1; k <= 2 * plan.fillet; ++k) {
    const auto at = place(c.p_B + (c.p_A - c.p_B) * k / (2 * plan.fillet));
    if (!at) return fail("the corner arc of the mill does not reach cone distance {:.4f} mm", ell);
    follow(*at);
  }
  return out;
}

Result<std::vector<ToothSection>> sections_of(const BevelGear& gear, const bevel_gear::BevelHalf& half,
                                              const SectorPlan& plan) {
  std::vector<ToothSection> sections;
  const double pitch = gear.pitch(), top = gear.parameters().addendum_mm;
  for (int w = 0; w <= 2 * plan.face; ++w) {
    const double ell = half.ell_from + (half.ell_to - half.ell_from) * w / (2 * plan.face);
    auto low = wall_boundary(half.wall(-1), ell, top, plan), high = wall_boundary(half.wall(1), ell, top, plan);
    if (!low) return low.error();
    if (!high) return high.error();
    for (Vec2& p : *low) p.x() -= pitch;  // wall U of space -1
    ToothSection s;
    s.low = std::move(*low), s.high = std::move(*high);
    if (!(s.high.front().x() > s.low.front().x()))
      return fail("the tooth is pointed at cone distance {:.4f} mm: its tip is {:.4f} mm wide", ell,
                  (s.high.front().x() - s.low.front().x()) * ell * gear.sin_delta());
    if (!(s.high.back().x() - s.low.back().x() < pitch))
      return fail("the fillets of a space meet at cone distance {:.4f} mm", ell);
    const double middle = (s.low.back().x() + s.high.back().x()) / 2;
    s.angle_low = middle - pitch / 2, s.angle_high = middle + pitch / 2;
    s.root = -gear.parameters().dedendum_mm;
    sections.push_back(std::move(s));
  }
  return sections;
}

}  // namespace

double thickest_rim(const BevelGear& gear) {
  const double dedendum = gear.parameters().dedendum_mm,
               root = gear.halves().front().ell_from * gear.sin_delta() / gear.cos_delta() - dedendum;
  return 0.75 * root;
}

Result<loaded::ToothBody> bevel_bricks(const BevelGear& gear, int half, int sigma, const SectorPlan& plan) {
  const bevel_gear::BevelHalf& own = gear.halves().at(static_cast<std::size_t>(half));
  if (!(plan.rim_mm > 0) || !(plan.rim_mm <= thickest_rim(gear)))
    return fail(
        "rim = {:g} mm is not between 0 and {:.4g} mm, three quarters of what is below the root at the small "
        "end of the gear with {} teeth",
        plan.rim_mm, thickest_rim(gear), gear.parameters().teeth);
  loaded::ToothBody body;
  body.ends = {loaded::FreeEnds::Kind::cones,
               {own.ell_from, own.ell_to},
               Vec3::Zero(),
               Vec3::UnitZ(),
               gear.sin_delta(),
               gear.cos_delta()};
  body.face_from = own.ell_from, body.face_to = own.ell_to;
  SectorPlan bricks = plan;
  for (;; ++bricks.fillet) {
    const auto sections = sections_of(gear, own, bricks);
    if (!sections) return sections.error();
    auto made =
        elastic::make_sector(bricks, *sections, sigma > 0, gear.pitch(), Vec3::UnitZ(), [&](int w, const Vec2& at) {
          const double ell = own.ell_from + (own.ell_to - own.ell_from) * w / (2 * bricks.face);
          return bevel_gear::blank_point(ell, at.y(), at.x(), gear.sin_delta(), gear.cos_delta());
        });
    if (!made && bricks.fillet < kMostFilletBricks) continue;
    if (!made) return made.error();
    body.sector = std::move(*made);
    for (int c = 0; c <= bricks.face; ++c) {
      const auto& s = (*sections)[static_cast<std::size_t>(2 * c)];
      const auto& boundary = sigma > 0 ? s.high : s.low;
      body.top.push_back(boundary.front().y());
      body.foot.push_back(boundary[static_cast<std::size_t>(2 * bricks.flank)].y());
    }
    break;
  }
  body.fillet_bricks = bricks.fillet;
  return body;
}

Result<loaded::ToothBody> bevel_body(const BevelGear& gear, int half, int sigma, const loaded::BodyPlan& plan) {
  auto body = bevel_bricks(gear, half, sigma, plan.bricks);
  if (!body) return body;
  if (const auto done = loaded::add_remainder(*body, plan); !done) return done.error();
  return body;
}

}  // namespace toothpath::loaded_bevel
