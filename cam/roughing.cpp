#include "cam/roughing.h"

#include <algorithm>
#include <cmath>

namespace toothpath {
namespace {

double radius(const Vec3& p) { return std::hypot(p.x(), p.y()); }

/// Directions on the lower half of a ball: where it cuts.
std::vector<Vec3> lower_directions() {
  std::vector<Vec3> out{Vec3(0, 0, -1)};
  for (int ring = 1; ring <= 4; ++ring) {
    const double polar = ring * 0.39;
    for (int k = 0; k < 6 * ring; ++k) {
      const double a = 1.0471975511965976 * k / ring;
      out.push_back({std::sin(polar) * std::cos(a), std::sin(polar) * std::sin(a), -std::cos(polar)});
    }
  }
  return out;
}

class Planner {
 public:
  Planner(const OffsetSheet& sheet, const RoughingOptions& o, const std::vector<const SweptPath*>& cleared)
      : sheet_(sheet), o_(o), cleared_(cleared) {}

  Result<RoughingPasses> run() {
    const auto& ring = sheet_.space().ring().zone;
    if (sheet_.empty())
      return fail("a ball of {:.4f} mm with {:.4f} mm allowance finds no surface between the radii {:.4f} and {:.4f}",
                  2 * o_.ball_radius_mm, o_.allowance_mm, ring.inner_radius_mm, ring.outer_radius_mm);
    from_ = std::max(sheet_.r_from(), ring.inner_radius_mm - o_.overrun_mm);
    to_ = std::min(sheet_.r_to(), ring.outer_radius_mm + o_.overrun_mm);
    const double r_mid = 0.5 * (from_ + to_);
    const double top = o_.blank_top_mm + o_.ball_radius_mm, root = root_height(r_mid);
    // Heights of the ball centre above the offset root; the last layer lies on it.
    std::vector<double> layers;
    for (double z = top - o_.step_down_mm; z > root + 1e-6; z -= o_.step_down_mm) layers.push_back(z - root);
    layers.push_back(0.0);
    for (const auto& s : sheet_.stations())
      for (const auto& g : s.gaps)
        if (g.from < 2.5 && g.to > 2.5) out_.reaches_root = false;
    double lowest_free = INFINITY, highest_bottom = -INFINITY;
    for (int k = 0; k <= 16; ++k) {
      const double r = from_ + (to_ - from_) * k / 16;
      const auto bottom = sheet_.raw(sheet_.bottom_sigma(r), r);
      if (!bottom) continue;
      lowest_free = std::min(lowest_free, bottom->centre.z() - root_height(r));
      highest_bottom = std::max(highest_bottom, bottom->centre.z() - root_height(r));
    }
    bool bottom_done = false;
    for (double height : layers) {
      if (bottom_done) break;
      // Below the highest bottom the passes run along it; one such layer at the end is enough when all is bottom.
      if (height <= lowest_free + 1e-9) bottom_done = true;
      if (auto ok = add_layer(height); !ok) return ok.error();
      ++out_.layers;
    }
    return std::move(out_);
  }

 private:
  /// z of a centre that touches the root surface at radius r (whether or not the walls let it).
  [[nodiscard]] double root_height(double r) const {
    const auto s = sheet_.raw(2.5, r);
    return s ? s->centre.z() : NAN;
  }

  struct Width {
    double plus = 0, minus = 0, z = 0;  // azimuths of the extreme centres and their height
  };
  [[nodiscard]] std::optional<Width> width(double height, double r) const {
    const double z = root_height(r) + height;
    const auto bottom = sheet_.raw(sheet_.bottom_sigma(r), r);
    const auto top_plus = sheet_.at(0.0, r), top_minus = sheet_.at(5.0, r);
    if (!bottom || !top_plus || !top_minus) return {};
    const auto azimuth = [](const Vec3& c) { return std::atan2(c.y(), c.x()); };
    Width w;
    w.z = std::max(z, bottom->centre.z());
    if (z <= bottom->centre.z() && !reaches_root_at(r)) {
      w.plus = w.minus = azimuth(bottom->centre);
      return w;
    }
    const auto a = sheet_.wall(true, w.z, r), b = sheet_.wall(false, w.z, r);
    w.plus = a ? azimuth(a->centre) : azimuth(top_plus->centre);
    w.minus = b ? azimuth(b->centre) : azimuth(top_minus->centre);
    // On the root land itself both walls are its two ends.
    if (height <= 1e-9 && reaches_root_at(r)) {
      const auto left = sheet_.at(2.0, r), right = sheet_.at(3.0, r);
      if (!left || !right) return {};
      w.plus = azimuth(left->centre);
      w.minus = azimuth(right->centre);
    }
    w.minus = w.plus + std::remainder(w.minus - w.plus, 6.283185307179586);
    return w;
  }

  [[nodiscard]] bool reaches_root_at(double r) const { return sheet_.bottom_sigma(r) == 2.5; }

  Status add_layer(double height) {
    double widest = 0;
    for (int k = 0; k <= 8; ++k) {
      const double r = from_ + (to_ - from_) * k / 8;
      const auto w = width(height, r);
      if (!w) return fail("the layer {:.4f} mm above the root cannot be bounded at radius {:.4f}", height, r);
      widest = std::max(widest, r * (w->minus - w->plus));
    }
    const int count = widest < 1e-6 ? 1 : 1 + std::max(1, int(std::ceil(widest / o_.step_over_mm)));
    std::vector<double> shares;
    for (int k = 0; k < count; ++k) shares.push_back(count == 1 ? 0.5 : double(k) / (count - 1));
    // From the middle to the walls, in turn, so that both walls are cut climbing.
    std::stable_sort(shares.begin(), shares.end(), [](double a, double b) {
      const double da = std::abs(a - 0.5), db = std::abs(b - 0.5);
      return da != db ? da < db - 1e-12 : a < b;
    });
    for (double share : shares) {
      const auto curve = [&](double r) -> std::optional<BallPass::Point> {
        const auto w = width(height, r);
        if (!w) return {};
        const double azimuth = w->plus + share * (w->minus - w->plus);
        BallPass::Point p;
        p.centre = {r * std::cos(azimuth), r * std::sin(azimuth), w->z};
        p.contact = p.centre;
        return p;
      };
      const auto line = sample_curve(curve, from_, to_, o_.chord_mm, 2.0 * o_.ball_radius_mm);
      if (!line) return fail("the layer {:.4f} mm above the root cannot be followed", height);
      if (!cuts(line->points)) {
        ++out_.skipped;
        continue;
      }
      BallPass pass;
      pass.points = line->points;
      pass.outward = (share <= 0.5) == o_.climb;
      if (!pass.outward) std::reverse(pass.points.begin(), pass.points.end());
      out_.passes.push_back(std::move(pass));
    }
    return Ok{};
  }

  /// Would a ball along these centres remove anything that the earlier operations left?
  [[nodiscard]] bool cuts(const std::vector<BallPass::Point>& points) const {
    if (cleared_.empty()) return true;
    static const std::vector<Vec3> directions = lower_directions();
    const auto& ring = sheet_.space().ring().zone;
    constexpr double kWorthCutting = 0.01;  // mm: a thinner skin is not worth a roughing pass
    for (const auto& point : points) {
      for (const auto& direction : directions) {
        const Vec3 q = point.centre + o_.ball_radius_mm * direction;
        const double r = radius(q);
        if (r < ring.inner_radius_mm || r > ring.outer_radius_mm || q.z() > o_.blank_top_mm) continue;
        bool left = true;
        for (const auto* path : cleared_)
          if (path->excess(q, kWorthCutting) < kWorthCutting) {
            left = false;
            break;
          }
        if (left) return true;
      }
    }
    return false;
  }

  const OffsetSheet& sheet_;
  RoughingOptions o_;
  const std::vector<const SweptPath*>& cleared_;
  double from_ = 0, to_ = 0;
  RoughingPasses out_;
};

}  // namespace

Result<RoughingPasses> plan_roughing(const OffsetSheet& sheet, const RoughingOptions& options,
                                     const std::vector<const SweptPath*>& cleared) {
  return Planner(sheet, options, cleared).run();
}

}  // namespace toothpath
