#include "cam/ball/sheet_pass.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/base/angle.h"

namespace toothpath::ball {
namespace {

constexpr double kLookOfWay = 0.2;      // of the ball's radius: steps in which the ways of a pass are looked at
constexpr double kLongestRunOut = 1.5;  // way of a run-out along the sheet, of the straight line between its ends

/// Not to and fro: its way is that of a curve, not many times the straight line between its ends.
bool keeps_on(const std::vector<BallPass::Point>& points) {
  double way = 0;
  for (std::size_t k = 1; k < points.size(); ++k) way += (points[k].centre - points[k - 1].centre).norm();
  return way <= kLongestRunOut * (points.back().centre - points.front().centre).norm();
}

/// Of every pass its own place, all at once; then the first that has one.
template <typename DeepOf>
std::optional<DeepPlace> first_of_passes(const std::vector<BallPass>& passes, const DeepOf& deep_of) {
  std::vector<std::optional<DeepPlace>> found(passes.size());
  tbb::parallel_for(std::size_t(0), passes.size(), [&](std::size_t n) { found[n] = deep_of(passes[n].points); });
  const auto first = std::find_if(found.begin(), found.end(), [](const auto& f) { return f.has_value(); });
  return first == found.end() ? std::nullopt : *first;
}

class PassMaker {
 public:
  PassMaker(const tooth_space::OffsetSheet& sheet, const FinishingOptions& options, const SheetPassAsked& asked)
      : sheet_(sheet), o_(options), asked_(asked) {}

  [[nodiscard]] Result<SheetPass> run() const {
    const auto& ring = sheet_.space().outline();
    double from = station_of_contact(asked_.sigma, ring.s_from), to = station_of_contact(asked_.sigma, ring.s_to);
    if (asked_.other) {
      from = std::min(from, station_of_contact(asked_.other, ring.s_from));
      to = std::max(to, station_of_contact(asked_.other, ring.s_to));
    }
    if (std::isnan(from) || std::isnan(to)) return ends_inside(ring, std::isnan(from));
    const double begin = std::max(from, asked_.r_low), end = std::min(to, asked_.r_high);
    if (!(end > begin)) return SheetPass{};
    const auto curve = sample_curve([this](double r) { return on_sheet(r); }, begin, end, o_.chord_mm, longest());
    if (!curve) {
      const auto [low, high] = ring.told(from, to);
      return fail("the ball-centre surface cannot be followed between {} {:.4f} and {:.4f} mm", ring.along, low, high);
    }
    SheetPass out{{curve->points, asked_.plus == o_.climb}, curve->worst_chord_mm};
    add_run_outs(out.pass, from, to, begin == from, end == to);
    if (!out.pass.outward) std::reverse(out.pass.points.begin(), out.pass.points.end());
    return out;
  }

 private:
  [[nodiscard]] double longest() const { return 4.0 * o_.ball_radius_mm; }

  [[nodiscard]] Diagnostic ends_inside(const tooth_space::Outline& ring, bool at_inner_end) const {
    const double least = contact_at(asked_.sigma(sheet_.r_from()), sheet_.r_from()),
                 most = contact_at(asked_.sigma(sheet_.r_to()), sheet_.r_to());
    const auto [low, high] = ring.told(least, most);
    const auto [from, to] = ring.told(ring.s_from, ring.s_to);
    return fail(
        "the flank ends inside the ring (undercut): a ball of radius {:.4f} mm touches it at {} {:.4f} to "
        "{:.4f} mm, the ring is {:.4f} to {:.4f} mm; {:.3g} mm are missing at its {} end",
        o_.ball_radius_mm, ring.along, low, high, from, to, at_inner_end ? least - ring.s_from : ring.s_to - most,
        at_inner_end ? ring.from : ring.to);
  }

  [[nodiscard]] double along(const Vec3& p) const { return sheet_.space().outline().chart.along(p); }
  [[nodiscard]] double contact_at(double sigma, double r) const {
    const auto s = sheet_.at(sigma, r);
    return s ? along(s->contact.p) : NAN;
  }

  /// s of the ball centre where the contact of a curve lies at `target`; not a number where it never does.
  [[nodiscard]] double station_of_contact(const std::function<double(double)>& curve, double target) const {
    double a = sheet_.r_from(), b = sheet_.r_to();
    if (contact_at(curve(a), a) > target || contact_at(curve(b), b) < target) return NAN;
    for (int k = 0; k < 60 && b - a > 1e-9; ++k) {
      const double m = 0.5 * (a + b);
      (contact_at(curve(m), m) < target ? a : b) = m;
    }
    return 0.5 * (a + b);
  }

  [[nodiscard]] std::optional<BallPass::Point> on_sheet(double r) const {
    const auto s = sheet_.at(asked_.sigma(r), r);
    if (!s) return {};
    return BallPass::Point{s->centre, s->contact.p, true};
  }

  /// Points beyond `end`, outwards (sense 1) or inwards (-1): along the sheet where that is there and smooth, else
  /// straight on. Out there the ball may come to a corner that the ring does not have, and the sheet jumps from one
  /// wall of it to the other.
  [[nodiscard]] std::vector<BallPass::Point> run_out(double end, double sense) const {
    const double target = std::clamp(end + sense * o_.run_out_mm, sheet_.r_from(), sheet_.r_to());
    std::vector<BallPass::Point> out;
    if (std::abs(target - end) > 0.3 * o_.run_out_mm)
      if (const auto line = sample_curve([this](double r) { return on_sheet(r); }, end, target, o_.chord_mm, longest());
          line && keeps_on(line->points)) {
        out.assign(line->points.begin() + 1, line->points.end());
        for (auto& p : out) p.touching = false;
        return out;
      }
    const auto a = on_sheet(end), b = on_sheet(end - sense * 1e-4);
    if (!a || !b) return out;
    const Vec3 tangent = (a->centre - b->centre).normalized();
    const double rate = std::abs(along(a->centre + tangent * 1e-3) - along(a->centre)) / 1e-3;
    out.push_back({a->centre + tangent * (o_.run_out_mm / std::max(rate, 0.2)), a->contact, false});
    return out;
  }

  void add_run_outs(BallPass& pass, double from, double to, bool inside, bool outside) const {
    if (inside) {
      const auto points = run_out(from, -1);
      pass.points.insert(pass.points.begin(), points.rbegin(), points.rend());
    }
    if (outside) {
      const auto points = run_out(to, 1);
      pass.points.insert(pass.points.end(), points.begin(), points.end());
    }
  }

  const tooth_space::OffsetSheet& sheet_;
  const FinishingOptions& o_;
  const SheetPassAsked& asked_;
};

}  // namespace

Result<SheetPass> make_sheet_pass(const tooth_space::OffsetSheet& sheet, const FinishingOptions& options,
                                  const SheetPassAsked& asked) {
  return PassMaker(sheet, options, asked).run();
}

std::optional<DeepPlace> first_deep_place(const std::vector<BallPass>& passes, double ball_radius_mm, double limit_mm,
                                          const DistanceToPart& distance) {
  return first_of_passes(passes, [&](const std::vector<BallPass::Point>& points) -> std::optional<DeepPlace> {
    for (const auto& p : points) {
      if (!p.touching) continue;
      const double cut = ball_radius_mm - distance(p.centre);
      if (cut > limit_mm) return DeepPlace{p.centre, cut};
    }
    return {};
  });
}

std::optional<DeepPlace> first_deep_way(const std::vector<BallPass>& passes, double ball_radius_mm, double limit_mm,
                                        const DistanceToPart& distance) {
  return first_of_passes(passes, [&](const std::vector<BallPass::Point>& points) -> std::optional<DeepPlace> {
    std::optional<DeepPlace> deepest;
    for (std::size_t k = 1; k < points.size() && !deepest; ++k) {
      const Vec3 from = points[k - 1].centre, way = points[k].centre - from;
      const int parts = int(std::ceil(way.norm() / (kLookOfWay * ball_radius_mm)));
      for (int i = 1; i < parts; ++i) {
        const Vec3 centre = from + double(i) / parts * way;
        const double cut = ball_radius_mm - distance(centre);
        if (cut > limit_mm && (!deepest || cut > deepest->cut_mm)) deepest = {centre, cut};
      }
    }
    return deepest;
  });
}

}  // namespace toothpath::ball
