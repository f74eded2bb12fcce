// A sector for tests of bricks: a tooth with straight flanks and no fillet.
#pragma once

#include <cmath>
#include <stdexcept>

#include "geometry/elastic/sector.h"

namespace toothpath::test {

/// A tooth with straight flanks on a ring of radius 40, axis z, 24 teeth.
inline elastic::Sector plain_sector(const elastic::SectorPlan& plan, bool high) {
  std::vector<elastic::ToothSection> sections;
  const int levels = 2 * (plan.flank + plan.fillet);
  const double pitch = 2 * M_PI / 24;
  for (int w = 0; w <= 2 * plan.face; ++w) {
    elastic::ToothSection s;
    for (int k = 0; k <= levels; ++k) {
      const double half = pitch * (0.12 + 0.2 * k / levels), height = 44.0 - 4.0 * k / levels;
      s.low.emplace_back(-half, height);
      s.high.emplace_back(half, height);
    }
    s.angle_low = -pitch / 2, s.angle_high = pitch / 2, s.root = 40;
    sections.push_back(s);
  }
  auto made = elastic::make_sector(plan, sections, high, pitch, Vec3::UnitZ(), [](int w, const Vec2& at) {
    const double turn = at.x() + 0.004 * w;
    return Vec3(at.y() * std::cos(turn), at.y() * std::sin(turn), 1.5 * w);
  });
  if (!made) throw std::invalid_argument(made.error().message);
  return std::move(made).value();
}

}  // namespace toothpath::test
