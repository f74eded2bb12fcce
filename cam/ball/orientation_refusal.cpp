#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "cam/ball/tool_orientation.h"
#include "geometry/base/angle.h"

namespace toothpath::ball {
namespace {

constexpr double kDeepest = 3.0;         // mm: how far a body that cuts in is followed
constexpr double kSlimmerStep = 0.01;    // mm: to which that is told
constexpr double kLongestStickOut = 60;  // mm: how much longer a tool is looked for
constexpr double kSlimmestNeck = 0.5;    // of the ball's diameter
constexpr double kChange = 0.05;         // mm: to which a length or diameter is told, on the safe side
/// Of a change, and as many mm, beyond what the places want: for the ways. Where little more than that is given, a plan
/// costs many times what one with room costs: trials look for plans that are found soon.
constexpr std::array kMore = {0.1, 0.3, 1.0};
constexpr double kFirstShare = 0.05;  // of a length or diameter, where no place tells what it wants

std::string place(const BallPass::Point& point) {
  return fmt::format("no five-axis motion either: with the ball at radius {:.3f}, height {:.3f}",
                     std::hypot(point.centre.x(), point.centre.y()), point.centre.z());
}

}  // namespace

struct RefusalWords::Spot {
  BallPass::Point point;
  Vec2 lean = Vec2(0, 0);  ///< the best one, where it was looked for
  double slimmer = 0;      ///< by how much shank and holder would have to be slimmer and begin higher, mm
};

RefusalWords::RefusalWords(const analytic::GearDistance& part, const analytic::BodyTree& tree, int zone,
                           const tool::ToolAssembly& tool, const OrientationOptions& options)
    : part_(part), tree_(tree), zone_(zone), tool_(tool), o_(options), check_(part, tree, zone, tool, options) {}

std::optional<Vec2> RefusalWords::clear_lean(const OrientationCheck& check, const BallPass::Point& point,
                                             const Vec2& near) const {
  return find_clear_lean(
      std::tan(o_.farthest_lean_rad), kFinestLean, near,
      [&](const Vec2& centre, double half) {
        return check.about(point, check.frame().axis(centre.x(), centre.y()), half * std::sqrt(2.0), needed(),
                           kTightResolution);
      },
      [&](const Vec2& lean) {
        return check.clear(point, check.frame().axis(lean.x(), lean.y()), needed(), kTightResolution);
      });
}

std::vector<RefusalWords::Spot> RefusalWords::blocked_spots(const std::vector<BallPass>& passes) const {
  std::vector<Spot> spots;
  for (const BallPass& pass : passes) {
    const PassTrack track(pass);
    const int count = std::max(2, int(std::ceil(track.at().back() / kTightStation)));
    for (int k = 0; k <= count; ++k) spots.push_back({track.point(track.at().back() * k / count), Vec2(0, 0), 0});
  }
  std::vector<char> open(spots.size());
  tbb::parallel_for(std::size_t(0), spots.size(),
                    [&](std::size_t k) { open[k] = !clear_lean(check_, spots[k].point, Vec2(0, 0)); });
  std::size_t count = 0;
  for (std::size_t k = 0; k < spots.size(); ++k)
    if (open[k]) spots[count++] = spots[k];
  spots.resize(count);
  return spots;
}

/// The one that wants the slimmest tool: most of the others are only asked whether that does for them.
RefusalWords::Spot RefusalWords::worst_of(std::vector<Spot> spots) const {
  Spot worst;
  std::vector<char> open(spots.size(), 1);
  while (true) {
    OrientationCheck slim = check_;
    slim.slim(worst.slimmer);
    tbb::parallel_for(std::size_t(0), spots.size(), [&](std::size_t k) {
      if (open[k]) open[k] = !clear_lean(slim, spots[k].point, Vec2(0, 0));
    });
    std::vector<std::size_t> left;
    for (std::size_t k = 0; k < open.size(); ++k)
      if (open[k]) left.push_back(k);
    if (left.empty()) return worst;
    const double from = worst.slimmer;
    worst = spots[left[left.size() / 2]];  // neighbours are alike: from the first one on it would take many rounds
    double low = from, high = kDeepest;
    while (high - low > kSlimmerStep) {
      const double middle = 0.5 * (low + high);
      OrientationCheck trial = check_;
      trial.slim(middle);
      const auto lean = clear_lean(trial, worst.point, worst.lean);
      if (lean) worst.lean = *lean;
      (lean ? high : low) = middle;
    }
    worst.slimmer = high;
    if (high >= kDeepest) return worst;
  }
}

std::pair<tool::Body, double> RefusalWords::nearest_body(const BallPass::Point& point, const Vec3& axis) const {
  double gap = needed();
  tool::Body worst = tool::Body::none;
  const Vec3 tip = point.centre - tool_.radius_mm() * axis;
  for (const auto& f : check_.bodies()) {
    double g = tree_.gap(f, tip, axis, gap, kTightResolution);
    if (g < 0) g = -tree_.depth(f, {&tip, 1}, axis, kDeepest, kTightResolution);
    if (g < gap) gap = g, worst = f.body;
  }
  return {worst, gap};
}

std::string RefusalWords::keeps(tool::Body body, double gap) const {
  const std::string does = gap < 0 ? fmt::format("cuts in by {}{:.3f} mm", gap <= -kDeepest ? "more than " : "", -gap)
                                   : fmt::format("keeps {:.4f} mm", gap);
  return fmt::format(
      "its {} {}, it must keep {:.3f} mm (the clearance is {:.3f} mm, and {:.3f} mm is for the proof and the rounding "
      "of the words)",
      body, does, needed(), o_.clearance_mm, kTightMargin);
}

std::optional<std::string> RefusalWords::flute_words(const BallPass::Point& point) const {
  double shallowest = INFINITY, lean = 0;
  const LeanGrid grid(std::tan(o_.farthest_lean_rad));
  for (const auto& q : grid.leans) {
    const Vec3 axis = check_.frame().axis(q.x(), q.y());
    const double depth = check_.flute_depth(point, axis);
    if (depth < shallowest) shallowest = depth, lean = angle_between(axis, check_.frame().up);
  }
  if (shallowest <= 0) return {};
  return fmt::format(
      "its flute would cut in every direction, least where it leans {:.1f} deg: by {:.4f} mm; a ball of "
      "less diameter is needed",
      degrees(lean), shallowest);
}

OrientationRefusal RefusalWords::blocked(const std::vector<BallPass>& passes, const Plans& plans) const {
  const std::vector<Spot> spots = blocked_spots(passes);
  const Spot worst = worst_of(spots);
  const Vec3 axis = check_.frame().axis(worst.lean.x(), worst.lean.y());
  const auto [body, gap] = nearest_body(worst.point, axis);
  if (worst.slimmer >= kDeepest || body == tool::Body::none) {
    if (const auto words = flute_words(worst.point)) return {fmt::format("{} {}", place(worst.point), *words)};
    if (body == tool::Body::none)
      return {
          fmt::format("{} its flute would cut in some directions, in the others shank or holder do not keep {:.3f} "
                      "mm; a ball of less diameter, or a slimmer tool",
                      place(worst.point), needed())};
    return {
        fmt::format("{} no direction within {:.0f} deg of the normal of the pitch surface is clear, nor would be "
                    "with a tool that is {:g} mm slimmer: upright {}",
                    place(worst.point), degrees(o_.farthest_lean_rad), kDeepest, keeps(body, gap))};
  }
  const std::string more =
      spots.size() > 1 ? fmt::format(" (nor at {} more places, this is the worst)", spots.size() - 1) : "";
  return with_trials(
      fmt::format("{} no direction within {:.0f} deg of the normal of the pitch surface is clear{}: the best leans "
                  "{:.1f} deg and {}",
                  place(worst.point), degrees(o_.farthest_lean_rad), more,
                  degrees(angle_between(axis, check_.frame().up)), keeps(body, gap)),
      spots, plans);
}

OrientationRefusal RefusalWords::parted(const OrientationWay& way, std::size_t station, const Plans& plans) const {
  const std::size_t before = station > 0 ? station - 1 : 0;
  const auto from = clear_lean(check_, way.points[before], Vec2(0, 0)),
             to = clear_lean(check_, way.points[station], from.value_or(Vec2(0, 0)));
  const auto& point = way.points[station];
  const Vec3 a = check_.frame().axis(from.value_or(Vec2(0, 0)).x(), from.value_or(Vec2(0, 0)).y()),
             b = check_.frame().axis(to.value_or(Vec2(0, 0)).x(), to.value_or(Vec2(0, 0)).y());
  const auto [body, gap] = nearest_body(blend_points(way.points[before], point, 0.5), (a + b).normalized());
  const std::string what =
      body == tool::Body::none ? "and a rotary that carries the work has its pole between them" : keeps(body, gap);
  return with_trials(
      fmt::format("{} directions are clear, but those before it do not join them, not in {} strokes either: over "
                  "{:.3f} mm the axis would turn by {:.1f} deg, and half-way {}",
                  place(point), kMostStrokes, way.s[station] - way.s[before], degrees(angle_between(a, b)), what),
      {}, plans);
}

OrientationRefusal RefusalWords::no_way_about(const BallPass::Point& point, const Vec3& axis,
                                              const Plans& plans) const {
  const double lean = degrees(angle_between(axis, check_.frame().up));
  const auto [body, gap] = nearest_body(point, axis);
  if (body != tool::Body::none)
    return with_trials(
        fmt::format("{} and the axis leaning {:.2f} deg {}, and no way through other directions was found",
                    place(point), lean, keeps(body, gap)),
        {}, plans);
  if (!check_.away_from_pole(axis))
    return {
        fmt::format("{} the axis turns at {:.2f} deg of the gear axis, it must keep {:.2f} deg there, the pole of a "
                    "rotary that carries the work; program.pole = \"slow\", \"hold\", \"through\" or \"retract\" "
                    "goes past it",
                    place(point), degrees(off_pole(axis)), degrees(o_.least_tilt_rad))};
  return {fmt::format("{} and the axis leaning {:.2f} deg its flute would cut, by {:.4f} mm", place(point), lean,
                      check_.flute_depth(point, axis))};
}

tool::ToolAssembly RefusalWords::changed(Part part, double by) const {
  tool::ToolAssembly t = tool_;
  if (part == Part::shank) {
    t.shank_diameter_mm = std::floor((tool_.shank_diameter_mm - by) / kChange + 1e-9) * kChange;
    return t;
  }
  double& told = part == Part::flute ? t.flute_length_mm : t.stick_out_mm;
  const double before = told;
  told = std::ceil((before + by) / kChange - 1e-9) * kChange;
  t.length_mm += told - before;
  if (part == Part::flute) t.stick_out_mm += told - before;
  return t;
}

double RefusalWords::most(Part part) const {
  return part == Part::shank ? tool_.shank_diameter_mm - kSlimmestNeck * tool_.diameter_mm : kLongestStickOut;
}

/// The least change of the part with which every spot has a clear direction, to kChange.
std::optional<double> RefusalWords::enough(Part part, std::vector<Spot>& spots) const {
  const auto fits = [&](double by) {
    const tool::ToolAssembly t = changed(part, by);
    const OrientationCheck check(part_, tree_, zone_, t, o_);
    std::atomic<bool> all{true};
    tbb::parallel_for(std::size_t(0), spots.size(), [&](std::size_t k) {
      if (!all) return;
      const auto lean = clear_lean(check, spots[k].point, spots[k].lean);
      if (lean) spots[k].lean = *lean;  // where the next search begins: what it finds does not depend on that
      else all = false;
    });
    return bool(all);
  };
  double low = 0, high = most(part);
  if (high <= 0 || !fits(high)) return {};
  while (high - low > kChange) {
    const double middle = 0.5 * (low + high);
    (fits(middle) ? high : low) = middle;
  }
  return high;
}

OrientationRefusal RefusalWords::with_trials(std::string reason, std::vector<Spot> spots, const Plans& plans) const {
  OrientationRefusal refusal{std::move(reason), {}};
  bool holder_alone = false;
  for (const Part part : {Part::stick_out, Part::flute, Part::shank}) {
    if (part == Part::flute && holder_alone) continue;
    const double own = part == Part::shank       ? tool_.shank_diameter_mm
                       : part == Part::stick_out ? tool_.stick_out_mm
                                                 : tool_.flute_length_mm;
    const auto least = spots.empty() ? std::optional(kFirstShare * own) : enough(part, spots);
    if (!least) continue;
    for (const double more : kMore) {
      const double by = (1 + more) * *least + more;
      const tool::ToolAssembly t = changed(part, by);
      if (by > most(part) || !plans(t)) continue;
      refusal.trials.push_back({t, change_words(tool_, t)});
      holder_alone = holder_alone || part == Part::stick_out;
      break;
    }
  }
  if (refusal.trials.empty()) {
    refusal.reason += "; another shank, flute or stick-out that would do was not found";
    return refusal;
  }
  for (const ToolTrial& trial : refusal.trials)
    refusal.reason += fmt::format(
        "{}{}", &trial == &refusal.trials.front() ? "; would do, planned as a trial: " : ", or ", trial.words);
  return refusal;
}

std::string change_words(const tool::ToolAssembly& now, const tool::ToolAssembly& other) {
  if (other.flute_length_mm != now.flute_length_mm)
    return fmt::format("a flute of {:.2f} mm (now {:.2f}) with as much more stick-out", other.flute_length_mm,
                       now.flute_length_mm);
  if (other.shank_diameter_mm != now.shank_diameter_mm)
    return fmt::format("a shank of {:.2f} mm (now {:.2f})", other.shank_diameter_mm, now.shank_diameter_mm);
  return fmt::format("a stick-out of {:.2f} mm (now {:.2f})", other.stick_out_mm, now.stick_out_mm);
}

}  // namespace toothpath::ball
