#include "geometry/contact/ease_off.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/contact/touch_search.h"

namespace toothpath::contact {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kStepsAPitch = 16, kWidestPitches = 6;

/// One place of the gear's tooth 0 with its pinion, at the exact ratio.
class Approach {
 public:
  Approach(const ContactMember& member, const Vec3& point)
      : pinion_(member.pinion), field_(member.on_pinion.get()), side_(member.flank.side), point_(point) {}

  [[nodiscard]] std::optional<ToPinion> at(double phi_2) const {
    return to_pinion(pinion_, field_, side_, pinion_.place(GearTurn(phi_2)(point_)), phi_2 / pinion_.ratio);
  }
  /// How near the pinion is, mm: greatest where it is nearest; never where its involute does not come.
  [[nodiscard]] double operator()(double phi_2) const {
    const auto found = at(phi_2);
    return found ? -found->distance_mm : kNever;
  }

 private:
  const Pinion<double>& pinion_;
  const modification::Field* field_;
  int side_;
  const Vec3& point_;
};

/// The lattice turn with the highest value, climbed to from `from`; nothing where the pinion never comes.
std::optional<double> highest(const Approach& f, double from, double step) {
  constexpr int kWidest = kWidestPitches * kStepsAPitch;
  double at = from, value = f(at);
  for (int k = 1; value == kNever && k <= 2 * kStepsAPitch; ++k)
    for (const double turn : {from + k * step, from - k * step})
      if (value == kNever && f(turn) > kNever) at = turn, value = f(turn);
  if (value == kNever) return std::nullopt;
  for (const double way : {step, -step})
    for (int k = 0; k < kWidest; ++k) {
      const double next = f(at + way);
      if (!(next > value)) break;
      at += way, value = next;
    }
  return at;
}

struct Nearest {
  double phi_2, bend;
};

/// The top between the lattice turns by parabolas that close in; nothing at the end of the pinion's involute.
std::optional<Nearest> top_near(const Approach& f, double at, double step) {
  double value = f(at), bend = 0;
  const double last = step / 400;
  for (const double h : {step, step / 20, last}) {
    bool inside = false;
    for (int k = 0; k < 50 && !inside; ++k) {
      const double below = f(at - h), above = f(at + h), fall = 2 * value - below - above;
      // Beside the end of the involute a wide parabola does not fit; where the narrowest does not there is no top.
      if (below == kNever || above == kNever || !(fall > 0)) break;
      if (h > last) bend = fall / (h * h);
      const double way = std::clamp(0.5 * h * (above - below) / fall, -h, h);
      inside = std::abs(way) < h;
      if (const double there = f(at + way); there > value) at += way, value = there;
      else inside = true;
    }
    if (h == last && !inside) return std::nullopt;
  }
  return Nearest{at, bend};
}

EaseOffMap map_of(const ContactMember& member) {
  const ContactFlank& flank = member.flank;
  const double step = flank.surface.pitch / kStepsAPitch;
  const std::size_t size = flank.points.size();
  EaseOffMap map;
  for (auto* list : {&map.gap_mm, &map.phi_2, &map.bend_mm, &map.pinion_radius_mm, &map.pinion_Z_mm})
    list->assign(size, kNone);
  for (std::size_t k = 0; k < size; ++k) {
    const Vec3 point = flank.points[k] + flank.deviation_mm[k] * flank.normals[k];
    const Approach approach(member, point);
    const double cut_at = flank.surface.i * flank.surface.flank_phi(flank.side, flank.theta[k], flank.B[k]);
    const auto near = highest(approach, cut_at, step);
    const auto top = near ? top_near(approach, *near, step) : std::nullopt;
    if (!top) continue;
    const ToPinion nearest = approach.at(top->phi_2).value();
    map.gap_mm[k] = nearest.distance_mm;
    map.phi_2[k] = top->phi_2;
    map.bend_mm[k] = top->bend;
    map.pinion_radius_mm[k] = nearest.radius_mm;
    map.pinion_Z_mm[k] = nearest.Z_mm;
  }
  return map;
}

}  // namespace

Result<EaseOff> ease_off(const std::vector<ContactMember>& members) {
  EaseOff found;
  for (const auto& member : members) found.maps.push_back(map_of(member));
  for (std::size_t m = 0; m < found.maps.size(); ++m)
    for (std::size_t k = 0; k < found.maps[m].gap_mm.size(); ++k) {
      const double gap = found.maps[m].gap_mm[k];
      if (std::isnan(gap)) continue;
      if (found.places == 0 || gap < found.least.gap_mm) found.least = {m, k, gap};
      if (found.places == 0 || gap > found.greatest.gap_mm) found.greatest = {m, k, gap};
      ++found.places;
    }
  if (found.places == 0) return fail("no place of the flank has a common normal with its pinion");
  found.shift_mm = found.least.gap_mm;
  found.least.gap_mm = 0;
  found.greatest.gap_mm -= found.shift_mm;
  for (auto& map : found.maps)
    for (double& gap : map.gap_mm) gap -= found.shift_mm;
  return found;
}

}  // namespace toothpath::contact
