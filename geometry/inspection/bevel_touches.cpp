#include "geometry/inspection/bevel_touches.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/angle.h"

namespace toothpath::inspection {

TouchedBevelGear::TouchedBevelGear(std::shared_ptr<const bevel_gear::BevelPart> part)
    : TouchedTeeth(drawn_solid(*part)), part_(std::move(part)), gear_(part_->gear()) {}

Vec3 TouchedBevelGear::place(double ell, double height, double azimuth) const {
  return bevel_gear::blank_point(ell, height, azimuth, gear_.sin_delta(), gear_.cos_delta());
}

PartReach TouchedBevelGear::reach() const {
  const auto& p = gear_.parameters();
  const Vec3 inner_root = place(gear_.R_i(), -p.dedendum_mm, 0), inner_tip = place(gear_.R_i(), p.addendum_mm, 0);
  const Vec3 outer_root = place(gear_.R_e(), -p.dedendum_mm, 0), outer_tip = place(gear_.R_e(), p.addendum_mm, 0);
  return {std::min(inner_tip.z(), inner_root.z() - p.shaft_length_mm), outer_root.z() + p.hub_length_mm,
          std::max({outer_tip.x(), 0.5 * p.hub_diameter_mm, 0.5 * p.shaft_diameter_mm})};
}

Result<std::vector<Touch>> TouchedBevelGear::flank_places(int spaces) const {
  const double height = 0.5 * (gear_.cutter().x_C + gear_.parameters().addendum_mm);
  std::vector<Touch> out;
  for (int k = 0; k < spaces; ++k)
    for (int zone = 0; zone < int(gear_.halves().size()); ++zone) {
      const auto& half = gear_.halves()[std::size_t(zone)];
      const std::vector<double> shares =
          gear_.herringbone() ? std::vector<double>{0.5} : std::vector<double>{0.25, 0.75};
      for (const double share : shares)
        for (const int sigma : {1, -1}) {
          const double ell = half.ell_from + share * (half.ell_to - half.ell_from);
          const auto& wall = half.wall(sigma);
          const auto there = bevel_inverse(wall, ell, height);
          if (!there)
            return fail(
                "half {}, wall {}: the mill forms no wall at cone distance {:.3f} mm, {:.3f} mm above the pitch "
                "cone",
                zone, sigma > 0 ? 'L' : 'U', ell, height);
          const auto f = wall.point(there->beta, there->p);
          Touch touch;
          touch.zone = zone;
          touch.side = sigma;
          touch.space = int(std::lround(double(k) * teeth() / spaces));
          touch.remark = fmt::format("HALF {} SPACE {} WALL {}", zone, touch.space % teeth(), sigma > 0 ? 'L' : 'U');
          const double turn = touch.space * gear_.pitch();
          touch.surface = turned(f.p, turn);
          touch.normal = turned(f.n, turn);
          touch.up = gear_.axis(f.centre.e + turn);
          out.push_back(std::move(touch));
        }
    }
  return out;
}

Result<std::vector<Touch>> TouchedBevelGear::blank_places(int spaces) const {
  std::vector<Touch> out;
  const double height = gear_.parameters().addendum_mm;
  for (int k = 0; k < spaces; ++k)
    for (const double share : {0.25, 0.75}) {
      const double ell = gear_.R_i() + share * (gear_.R_e() - gear_.R_i()), azimuth = kTwoPi * k / spaces;
      Touch touch;
      touch.what = Touched::top;
      touch.remark = "FACE CONE OF THE BLANK";
      touch.up = touch.normal = gear_.axis(azimuth);
      touch.surface = place(ell, height, azimuth);
      out.push_back(std::move(touch));
    }
  return out;
}

double TouchedBevelGear::above_root(const Touch& touch, const Vec3& x) const {
  return TouchedTeeth::above_root(touch, x) - gear_.cutter().r_t;
}

}  // namespace toothpath::inspection
