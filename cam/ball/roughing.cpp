#include "cam/ball/roughing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "cam/ball/small_cusps.h"
#include "geometry/base/refusals.h"

namespace toothpath::ball {
namespace {

constexpr std::size_t kMostHeld = 1'000'000;  // whatever was estimated
constexpr int kLayersCounted = 256, kLayersSampled = 5;
constexpr double kStepUp = 1.05;  // from one step that is tried to the next

// Of the ball's radius: where a pass has nothing to cut for longer, it is left and taken up again behind.
constexpr double kShortestIdle = 6;

/// Directions on the lower half of a ball, -z down: where it cuts.
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

/// The walls of the trimmed offset at one station, as tables from the tip down to the bottom. Heights are above the
/// offset root surface.
struct Walls {
  std::vector<double> plus_height, plus_azimuth, minus_height, minus_azimuth;  // heights descending
  double root = 0;  // height of the centre of a ball that touches the root surface, whether or not the walls let it
  double bottom_height = 0;  // lowest centre that the walls allow
};

double at_height(const std::vector<double>& height, const std::vector<double>& azimuth, double h) {
  if (h >= height.front()) return azimuth.front();
  for (std::size_t k = 1; k < height.size(); ++k)
    if (h >= height[k]) {
      const double span = height[k - 1] - height[k];
      const double t = span > 0 ? (height[k - 1] - h) / span : 1.0;
      return azimuth[k - 1] + t * (azimuth[k] - azimuth[k - 1]);
    }
  return azimuth.back();
}

Walls walls_of(const tooth_space::OffsetSheet& sheet, const tooth_space::OffsetSheet::Station& station) {
  Walls w;
  const tooth_space::Chart& chart = sheet.space().outline().chart;
  const tooth_space::SheetGap* across = nullptr;
  for (const auto& g : station.gaps)
    if (tooth_space::corner_of(g) == tooth_space::SheetCorner::both) across = &g;
  for (const auto& node : station.nodes)
    if (node.sigma == 2.5) w.root = chart.up(node.at.centre);
  struct Place {
    double sigma, height, azimuth;
  };
  std::vector<Place> places;
  for (const auto& node : station.nodes) {
    const auto inside = [&](const tooth_space::SheetGap& g) { return node.sigma > g.from && node.sigma < g.to; };
    if (std::none_of(station.gaps.begin(), station.gaps.end(), inside))
      places.push_back({node.sigma, chart.up(node.at.centre) - w.root, node.azimuth});
  }
  // The corners themselves, where the ball touches both of their walls: between the nodes beside them a blend would cut
  // in.
  for (const auto& g : station.gaps)
    for (const double sigma : {g.from, g.to})
      if (const auto s = sheet.raw(sigma, station.r)) {
        const double reference = station.nodes[station.nodes.size() / 2].azimuth;
        const double azimuth =
            reference + std::remainder(std::atan2(s->centre.y(), s->centre.x()) - reference, 6.283185307179586);
        places.push_back({sigma, chart.up(s->centre) - w.root, azimuth});
      }
  std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.sigma < b.sigma; });
  for (const auto& p : places) {
    const bool plus = across ? p.sigma <= across->from : p.sigma <= 2.0;
    const bool minus = across ? p.sigma >= across->to : p.sigma >= 3.0;
    if (plus) {
      w.plus_height.push_back(p.height);
      w.plus_azimuth.push_back(p.azimuth);
    }
    if (minus) {
      w.minus_height.insert(w.minus_height.begin(), p.height);
      w.minus_azimuth.insert(w.minus_azimuth.begin(), p.azimuth);
    }
  }
  w.bottom_height = across ? std::max(w.plus_height.back(), w.minus_height.back()) : 0.0;
  return w;
}

class RoughingPlanner {
 public:
  RoughingPlanner(const tooth_space::OffsetSheet& sheet, const RoughingOptions& o,
                  const std::vector<const cut::Removed*>& cleared)
      : sheet_(sheet), o_(o), cleared_(cleared) {}

  Result<RoughingPasses> run() {
    const auto& ring = sheet_.space().outline();
    if (sheet_.empty()) {
      const auto [from, to] = ring.told(ring.s_from, ring.s_to);
      return fail("a ball of {:.4f} mm with {:.4f} mm allowance finds no surface between {} {:.4f} and {:.4f} mm",
                  2 * o_.ball_radius_mm, o_.allowance_mm, ring.along, from, to);
    }
    stand();
    for (double height = top_ - o_.step_down_mm;; height -= o_.step_down_mm) {
      // The last layer follows the bottom: the root land, or the corner between both walls where the ball is too wide.
      const bool last = height <= lowest_ + 1e-6;
      if (auto ok = add_layer(last ? 0.0 : height); !ok) return ok.error();
      ++out_.layers;
      if (last) break;
    }
    return std::move(out_);
  }

  [[nodiscard]] std::optional<Refusal> too_small() {
    if (sheet_.empty()) return {};
    stand();
    const auto points = points_of_a_pass();
    if (!points) return {};
    const auto many = [&](double down, double over) { return *points * passes(down, over) > double(kMostPlaces); };
    const double down = o_.step_down_mm, over = o_.step_over_mm, most = 2 * o_.ball_radius_mm;
    if (!many(down, over)) return {};
    const bool lower = down <= over;
    const double alone = lower ? told_that_does(down, kStepUp, most, [&](double step) { return !many(step, over); })
                               : told_that_does(over, kStepUp, most, [&](double step) { return !many(down, step); });
    const double both =
        told_that_does(std::max(down, over), kStepUp, most, [&](double step) { return !many(step, step); });
    std::string help = both < most ? fmt::format("{:g} mm for both does", both) : "a larger ball may";
    if (alone < most)
      help = fmt::format("{} = {:g} mm or more does{}", lower ? "step_down" : "step_over", alone,
                         both < alone ? ", or " + help : "");
    return Refusal{lower ? "step_down" : "step_over",
                   fail("step_down = {:g} mm and step_over = {:g} mm make about {:.2g} places of one tooth space, more "
                        "than {}: minutes of planning; {}",
                        down, over, *points * passes(down, over), kMostPlaces, help)};
  }

 private:
  /// Between which ends, over which bottom.
  void stand() {
    const auto& ring = sheet_.space().outline();
    from_ = std::max(sheet_.r_from(), ring.s_from - o_.overrun_mm);
    to_ = std::min(sheet_.r_to(), ring.s_to + o_.overrun_mm);
    for (const auto& s : sheet_.stations()) {
      walls_.push_back(walls_of(sheet_, s));
      lowest_ = std::min(lowest_, walls_.back().bottom_height);
      out_.reaches_root = out_.reaches_root && walls_.back().bottom_height == 0;
    }
    top_ = o_.blank_top_mm + o_.end_centre_mm - deepest_root();
  }
  /// Passes of all layers, of many layers by some of them.
  [[nodiscard]] double passes(double step_down, double step_over) const {
    const double deep = std::max(0.0, top_ - lowest_), layers = std::max(1.0, std::ceil(deep / step_down));
    const int counted = int(std::min(layers, double(kLayersCounted)));
    double sum = 0;
    for (int k = 1; k <= counted; ++k) sum += double(count_of(widest(top_ - deep * k / counted), step_over));
    return sum * layers / counted;
  }
  /// Of the middle passes of some layers. Nothing: one cannot be followed.
  [[nodiscard]] std::optional<double> points_of_a_pass() const {
    double sum = 0;
    for (int k = 1; k <= kLayersSampled; ++k) {
      const auto line = sampled(top_ - (top_ - lowest_) * k / kLayersSampled, 0.5);
      if (!line) return {};
      sum += double(line->points.size());
    }
    return sum / kLayersSampled;
  }
  [[nodiscard]] double widest(double height) const {
    double widest = 0;
    for (int k = 0; k <= 8; ++k) {
      const double r = from_ + (to_ - from_) * k / 8;
      const auto w = width(height, r);
      widest = std::max(widest, chart().r(r, w.height) * (w.minus - w.plus));
    }
    return widest;
  }
  [[nodiscard]] static std::size_t count_of(double widest, double step_over) {
    return widest < 1e-6 ? 1 : 1 + std::max<std::size_t>(1, std::size_t(std::ceil(widest / step_over)));
  }
  [[nodiscard]] std::optional<SampledCurve> sampled(double height, double share) const {
    const auto curve = [&](double r) -> std::optional<BallPass::Point> {
      const auto w = width(height, r);
      const double azimuth = w.plus + share * (w.minus - w.plus);
      BallPass::Point p;
      p.centre = chart().place(r, azimuth, w.height);
      p.contact = p.centre;
      return p;
    };
    return sample_curve(curve, from_, to_, o_.chord_mm, 2.0 * o_.ball_radius_mm);
  }
  [[nodiscard]] const tooth_space::Chart& chart() const { return sheet_.space().outline().chart; }
  /// Layers keep their heights above the root, and of teeth that taper the first one is thickest where the root lies
  /// deepest below the tips: its height there, were all tips as high as the highest; no higher than in the middle.
  [[nodiscard]] double deepest_root() const {
    const tooth_space::ToothSpace& space = sheet_.space();
    const auto& ring = space.outline();
    const double highest = space.highest_tip();
    double root = walls_[walls_.size() / 2].root;
    for (std::size_t k = 0; k < walls_.size(); ++k)
      if (const double s = sheet_.stations()[k].r; s >= ring.s_from && s <= ring.s_to)
        root = std::min(root, walls_[k].root + (highest - space.tip(s)));
    return root;
  }
  struct Width {
    double plus = 0, minus = 0, height = 0;  // azimuths of the extreme centres and their height
  };
  /// Between two stations everything is blended: the sheet of a roughing pass is made with a pad for that.
  [[nodiscard]] Width width(double height, double r) const {
    const double t =
        std::clamp((r - sheet_.r_from()) / (sheet_.r_to() - sheet_.r_from()), 0.0, 1.0) * double(walls_.size() - 1);
    const auto j = std::min(std::size_t(t), walls_.size() - 2);
    const double x = t - double(j);
    Width w;
    for (const std::size_t k : {j, j + 1}) {
      const auto& s = walls_[k];
      const double share = k == j ? 1 - x : x, h = std::max(height, s.bottom_height);
      w.plus += share * at_height(s.plus_height, s.plus_azimuth, h);
      w.minus += share * at_height(s.minus_height, s.minus_azimuth, h);
      w.height += share * (s.root + h);
    }
    if (w.minus < w.plus) w.plus = w.minus = 0.5 * (w.plus + w.minus);
    return w;
  }

  Status add_layer(double height) {
    const std::size_t count = count_of(widest(height), o_.step_over_mm);
    std::vector<double> shares;
    for (std::size_t k = 0; k < count; ++k) shares.push_back(count == 1 ? 0.5 : double(k) / double(count - 1));
    // From the middle to the walls, in turn, so that both walls are cut climbing.
    std::stable_sort(shares.begin(), shares.end(), [](double a, double b) {
      const double da = std::abs(a - 0.5), db = std::abs(b - 0.5);
      return da != db ? da < db - 1e-12 : a < b;
    });
    struct Line {
      std::optional<SampledCurve> curve;
      std::vector<std::pair<std::size_t, std::size_t>> stretches;
    };
    std::vector<Line> lines(shares.size());
    tbb::parallel_for(std::size_t(0), shares.size(), [&](std::size_t n) {
      lines[n].curve = sampled(height, shares[n]);
      if (lines[n].curve) lines[n].stretches = cutting_stretches(lines[n].curve->points);
    });
    bool opens = true;
    for (std::size_t n = 0; n < lines.size(); ++n) {
      const auto& [line, stretches] = lines[n];
      if (!line) return fail("the layer {:.4f} mm above the root cannot be followed", height);
      if (stretches.empty()) ++out_.skipped;
      for (const auto& [from, to] : stretches) {
        BallPass pass;
        pass.opens_layer = opens;
        pass.points.assign(line->points.begin() + long(from), line->points.begin() + long(to) + 1);
        pass.outward = (shares[n] <= 0.5) == o_.climb;
        if (!pass.outward) std::reverse(pass.points.begin(), pass.points.end());
        places_ += pass.points.size();
        if (places_ > kMostHeld) return too_many();
        out_.passes.push_back(std::move(pass));
      }
      opens = opens && stretches.empty();
    }
    return Ok{};
  }

  [[nodiscard]] Diagnostic too_many() const {
    return fail(
        "step_down = {:g} mm and step_over = {:g} mm: {} layers of one tooth space have more than {} places, "
        "and that is not all of them; larger steps have fewer",
        o_.step_down_mm, o_.step_over_mm, out_.layers + 1, kMostHeld);
  }

  /// First and last points of the stretches in which a ball along these centres removes what earlier operations left:
  /// all of it where there were none.
  [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> cutting_stretches(
      const std::vector<BallPass::Point>& points) const {
    if (cleared_.empty()) return {{0, points.size() - 1}};
    std::vector<std::pair<std::size_t, std::size_t>> out;
    std::vector<std::size_t> answered;
    double idle = INFINITY;  // way since the last stretch
    for (std::size_t k = 1; k < points.size(); ++k) {
      const double way = (points[k].centre - points[k - 1].centre).norm();
      if (!cuts(points[k - 1].centre, points[k].centre, way, answered)) {
        idle += way;
        continue;
      }
      if (idle > kShortestIdle * o_.ball_radius_mm) out.emplace_back(k - 1, k);
      out.back().second = k;
      idle = 0;
    }
    return out;
  }

  /// @param answered  of every direction of a ball and every operation before: the motion that removed there last
  [[nodiscard]] bool cuts(const Vec3& from, const Vec3& to, double way, std::vector<std::size_t>& answered) const {
    static const std::vector<Vec3> directions = lower_directions();
    answered.resize(directions.size() * cleared_.size(), SIZE_MAX);
    const auto& ring = sheet_.space().outline();
    const double worth = path::kSkinShare * 2 * o_.ball_radius_mm;
    const int places = std::max(1, int(std::ceil(way / (0.4 * o_.ball_radius_mm))));
    for (int k = 0; k <= places; ++k) {
      const Vec3 centre = from + (to - from) * (double(k) / places);
      Mat3 down = Mat3::Identity();  // where the teeth stand upright
      if (chart().sine > 0) {
        const double at = azimuth(centre);
        down << chart().along_at(at), Vec3(-std::sin(at), std::cos(at), 0), chart().up_at(at);
      }
      for (std::size_t d = 0; d < directions.size(); ++d) {
        const Vec3 q = centre + o_.ball_radius_mm * (down * directions[d]);
        const double s = chart().along(q);
        if (s < ring.s_from || s > ring.s_to || chart().up(q) > o_.blank_top_mm) continue;
        std::size_t* last = &answered[d * cleared_.size()];
        if (std::none_of(cleared_.begin(), cleared_.end(),
                         [&](const cut::Removed* removed) { return removed->comes_within(q, worth, last++); }))
          return true;
      }
    }
    return false;
  }

  const tooth_space::OffsetSheet& sheet_;
  RoughingOptions o_;
  const std::vector<const cut::Removed*>& cleared_;
  double from_ = 0, to_ = 0;            ///< ends of the passes
  double top_ = 0, lowest_ = INFINITY;  ///< heights of centres: above all layers, and of the deepest
  std::vector<Walls> walls_;            ///< one a station
  std::size_t places_ = 0;              ///< of all passes
  RoughingPasses out_;
};

}  // namespace

std::optional<Refusal> steps_too_small(const tooth_space::OffsetSheet& sheet, const RoughingOptions& options) {
  const std::vector<const cut::Removed*> none;
  return RoughingPlanner(sheet, options, none).too_small();
}

Result<RoughingPasses> plan_roughing(const tooth_space::OffsetSheet& sheet, const RoughingOptions& options,
                                     const std::vector<const cut::Removed*>& cleared) {
  return RoughingPlanner(sheet, options, cleared).run();
}

}  // namespace toothpath::ball
