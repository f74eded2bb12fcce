#include "cam/line/passes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "cam/line/smooth.h"
#include "geometry/base/angle.h"
#include "geometry/base/golden_section.h"
#include "geometry/base/work_share.h"

namespace toothpath::line {
namespace {

constexpr double kBeyond = 2.6;  // modules: stations beyond the ends of the ring
constexpr double kFull = 0.85;   // share of the height from which a station counts as full
constexpr double kEndSlopes[] = {
    0.7, 0.3, 1.0, 1.4};            // shares of the slope at the last full station with which angles go on beyond it
constexpr double kShortest = 1e-3;  // of a module: shortest block
constexpr double kMostTurn =
    radians(20);  // of the axis about the gear's: near that pole a rotary turns far in short blocks
constexpr double kGougeCounts =
    4;                            // times as much as what is left: a block may sink by a quarter of the chord tolerance
constexpr double kCorner = 1e-5;  // mm: place of the records at which the ring begins and ends
constexpr double kEndBends[] = {radians(0.01), radians(0.03),
                                radians(0.1)};  // or are bent, from station to station 0.1 m apart
constexpr double kEpsBend = 0.05;               // as much of that in eps
constexpr double kLeastCovered = 0.1;           // share of the height below which a station has no say
constexpr double kStiffness[] = {1e4, 1e2, 1, 0};
constexpr double kStationsWorth = 0.6;            // of a pass: the best poses of its stations
constexpr double kWorse = 1.02, kWorseMm = 2e-5;  // by which a stiffer pass may be worse than the best one

/// Best poses of all stations, and which of them lie over (nearly) the whole height.
struct Stations {
  std::vector<std::optional<StationPose>> poses;
  std::size_t first = 0, last = 0;  ///< of the full ones
  bool enough = false;              ///< four at least, none missing between
};

/// Everything about one pass that its steps share.
/// What would give a blocked pose its room.
const char* remedy(const Blocked& blocked) {
  switch (blocked.need) {
    case Blocked::Need::touch:
      return ": the space between the flanks, or the groove, is too narrow for this mill; a smaller diameter or "
             "half_angle";
    case Blocked::Need::stock:
      return ", the stock that stands there: it would rub; a smaller allowance, diameter or half_angle";
    case Blocked::Need::clearance: break;
  }
  return blocked.body == "holder" ? " clearance; a thinner holder, a larger stick_out, or another half_angle"
                                  : " clearance; a larger flute_length, a thinner shank, or another half_angle";
}

class PassPlanner {
 public:
  PassPlanner(const LineFit& fit, const PassOptions& o, double law_end)
      : fit_(fit), o_(o), law_end_(law_end), m_(fit.flank().module_mm) {
    const auto& f = fit.flank();
    step_ = o.station * m_;
    const double middle = 0.5 * (f.s_from + f.s_to);
    const int half = int(std::ceil((0.5 * (f.s_to - f.s_from) + kBeyond * m_) / step_));
    start_ = middle - half * step_;
    count_ = std::size_t(2 * half + 1);
    lift_.assign(count_, 0.0);
    pass_.zone = f.zone;
    pass_.side = f.side;
  }

  Result<LinePass> run() {
    if (auto s = stations(); !s) return s.error();
    if (pass_.best_mm > o_.enough_mm) {
      pass_.misfit_mm = pass_.best_mm;
      return std::move(pass_);
    }
    if (auto s = smooth(); !s) return s.error();
    if (auto s = extent(); !s) return s.error();
    lifts();
    if (auto s = room(); !s) return s.error();
    if (auto s = corners(); !s) return s.error();
    if (auto s = records(); !s) return s.error();
    figures();
    return std::move(pass_);
  }

 private:
  [[nodiscard]] double station(std::size_t k) const { return start_ + double(k) * step_; }
  [[nodiscard]] std::size_t middle() const { return count_ / 2; }

  [[nodiscard]] Stations best_of_all() const {
    Stations out;
    out.poses.resize(count_);
    WorkShare share(double(count_), kStationsWorth);
    tbb::parallel_for(std::size_t{0}, count_, [&](std::size_t k) {
      out.poses[k] = fit_.best(station(k), condition_);
      share.add();
    });
    const auto full = [&](std::size_t k) { return out.poses[k] && out.poses[k]->covered >= kFull; };
    // Outwards from the middle: what lies beyond a missing station is another piece of flank.
    out.first = out.last = middle();
    while (out.first > 0 && full(out.first - 1)) --out.first;
    while (out.last + 1 < count_ && full(out.last + 1)) ++out.last;
    out.enough = full(middle()) && out.last >= out.first + 3;
    return out;
  }

  /// Best poses of all stations, and the condition on the axis that makes the worst of them least.
  Status stations() {
    best_ = best_of_all();
    if (o_.rotaries != Rotaries::both && best_.enough && worst_best() <= o_.enough_mm) {
      condition_ = best_condition();
      best_ = best_of_all();
    }
    const auto& f = fit_.flank();
    if (!best_.enough)
      return fail(
          "zone {}: flank {:+d} has no four stations {:.3f} mm apart about {} with a line over its whole height",
          f.zone, f.side, step_, told(station(middle())));
    for (std::size_t k = best_.first; k <= best_.last; ++k)
      if (auto s = not_too_tilted(*best_.poses[k]); !s) return s.error();
    if (auto s = reached(highest()); !s) return s.error();
    pass_.best_mm = worst_best();
    return Ok{};
  }
  /// A place along the ring in words: "radius 62.500 mm".
  [[nodiscard]] std::string told(double s, int digits = 3) const {
    const auto& outline = fit_.flank().space->outline();
    return fmt::format("{} {:.{}f} mm", outline.along, outline.sign * s, digits);
  }
  [[nodiscard]] const char* end_name(int sense) const {
    const auto& outline = fit_.flank().space->outline();
    return sense > 0 ? outline.to : outline.from;
  }
  [[nodiscard]] Status not_too_tilted(const StationPose& p) const {
    if (p.from_upright() <= kMostTilt) return Ok{};
    return fail(
        "zone {}: flank {:+d} at {} asks for a tool tilted by {:.2f} deg from {}; at most {:.0f} deg are planned: a "
        "ring that begins farther from the undercut limit, or a smaller helix angle",
        fit_.flank().zone, fit_.flank().side, told(p.s), degrees(p.from_upright()),
        fit_.flank().chart().sine == 0 ? "the gear axis" : "the height of the teeth", degrees(kMostTilt));
  }
  /// The full station that touches highest on the tool.
  [[nodiscard]] const StationPose& highest() const {
    std::size_t at = best_.first;
    for (std::size_t k = best_.first; k <= best_.last; ++k)
      if (best_.poses[k]->gap.t_to > best_.poses[at]->gap.t_to) at = k;
    return *best_.poses[at];
  }
  /// Height above the tip at which the ball at t touches the side.
  [[nodiscard]] double touches(double t) const {
    const auto& law = fit_.law();
    return law.r_0 + t - law.rho(t) * law.slope(t);
  }
  /// Do the teeth end above the highest contact, and does a measured meridian?
  [[nodiscard]] Status reached(const StationPose& p) const {
    if (p.gap.nodes.empty() || p.gap.t_to <= law_end_) return Ok{};
    const auto& f = fit_.flank();
    const auto& error = fit_.law().error;
    if (error && !(law_end_ < error->t.back()))
      return fail(
          "zone {}: flank {:+d} at {} is touched up to t = {:.3f} mm above the centre of the ball end, the measured "
          "meridian ends at t = {:.3f} mm: it must be measured up to there",
          f.zone, f.side, told(p.s), p.gap.t_to, law_end_);
    return fail(
        "zone {}: flank {:+d} at {} is touched up to {:.3f} mm above the tip, the teeth end at {:.3f} mm: flute_length "
        "must be {:.3f} mm at least",
        f.zone, f.side, told(p.s), touches(p.gap.t_to), touches(law_end_), std::ceil(1e3 * touches(p.gap.t_to)) / 1e3);
  }
  /// Worst misfit of the poses alone, over the full stations.
  [[nodiscard]] double worst_best() const {
    double worst = 0;
    for (std::size_t k = best_.first; k <= best_.last; ++k) worst = std::max(worst, best_.poses[k]->gap.misfit());
    return worst;
  }

  /// The worst misfit falls towards one value of the standing angle and rises after it: golden section to a hundredth
  /// of a degree.
  [[nodiscard]] AxisCondition best_condition() const {
    const bool tilt = o_.rotaries == Rotaries::tilt_stands;
    const auto condition = [&](double x) { return tilt ? tilt_stands(x) : azimuth_stands(x); };
    const Vec3 a_0 = best_.poses[middle()]->axis.a;
    const double about = std::atan2(a_0.y(), a_0.x());
    std::vector<double> angle;
    for (std::size_t k = best_.first; k <= best_.last; ++k) {
      const auto& a = best_.poses[k]->axis.a;
      angle.push_back(tilt ? std::acos(a.z()) : about + std::remainder(std::atan2(a.y(), a.x()) - about, 2 * kPi));
    }
    const auto worst = [&](double x) {
      std::vector<double> misfit(angle.size(), 0);
      tbb::parallel_for(std::size_t{0}, misfit.size(), [&](std::size_t k) {
        if (k % 3 != 0 && k + 1 != misfit.size()) return;
        const auto pose = fit_.best(station(best_.first + k), condition(x));
        misfit[k] = pose && pose->gap.in_ring() ? pose->gap.misfit() : INFINITY;
      });
      return *std::max_element(misfit.begin(), misfit.end());
    };
    const auto [from, to] = std::minmax_element(angle.begin(), angle.end());
    auto search = golden_section<std::less_equal<>>(*from, *to, worst);
    while (search.width() > radians(0.01)) search.step();
    return condition(search.middle());
  }

  /// How psi(s) and eps(s) are made from the best poses.
  struct Choice {
    double stiffness = 0;
    std::array<double, 2> slopes = {kEndSlopes[0],
                                    kEndSlopes[0]};  ///< beyond the full stations where s begins, where it ends
    std::array<double, 2> bends = {0,
                                   0};  ///< or: bent there towards the best, by so much a station (rad); 0: straight on
    double worst = INFINITY;            ///< misfit
  };

  /// Values on all stations from those of the full ones, beyond them straight on.
  [[nodiscard]] std::vector<double> values(const Choice& c, double PoseAngles<double>::*angle) const {
    std::vector<double> full;
    for (std::size_t k = best_.first; k <= best_.last; ++k) full.push_back(best_.poses[k]->angles.*angle);
    full = smoothed(full, c.stiffness);
    const std::size_t n = full.size(), reach = std::min<std::size_t>(n - 1, 4);
    const double low = c.slopes[0] * (full[reach] - full[0]) / double(reach),
                 high = c.slopes[1] * (full[n - 1] - full[n - 1 - reach]) / double(reach);
    std::vector<double> y(count_);
    for (std::size_t k = 0; k < count_; ++k)
      y[k] = k < best_.first  ? full[0] - low * double(best_.first - k)
             : k > best_.last ? full[n - 1] + high * double(k - best_.last)
                              : full[k - best_.first];
    return y;
  }
  /// From a full station outwards: each next station is the best one near where the two before it point.
  void bend(std::size_t full, int sense, double most, std::vector<double>& psi, std::vector<double>& eps) const {
    for (std::ptrdiff_t k = std::ptrdiff_t(full) + sense; k >= 0 && k < std::ptrdiff_t(count_); k += sense) {
      const auto at = std::size_t(k), one = std::size_t(k - sense), two = std::size_t(k - 2 * sense);
      const Neighbourhood about{2 * psi[one] - psi[two], 2 * eps[one] - eps[two], most, kEpsBend * most};
      const auto p = fit_.best(station(at), condition_, about);
      const bool counts = p && p->gap.in_ring() && p->covered > kLeastCovered;
      psi[at] = counts ? p->angles.psi : about.psi;
      eps[at] = counts ? p->angles.eps : about.eps;
    }
  }
  void take(const Choice& c) {
    auto psi = values(c, &PoseAngles<double>::psi), eps = values(c, &PoseAngles<double>::eps);
    if (c.bends[0] > 0) bend(best_.first, -1, c.bends[0], psi, eps);
    if (c.bends[1] > 0) bend(best_.last, 1, c.bends[1], psi, eps);
    psi_ = StationCurve(start_, step_, std::move(psi));
    eps_ = StationCurve(start_, step_, std::move(eps));
  }
  /// The same choice with its worst misfit measured on the stations from .. to.
  [[nodiscard]] Choice tried(Choice c, std::size_t from, std::size_t to) {
    take(c);
    c.worst = worst_misfit(from, to);
    return c;
  }

  [[nodiscard]] std::optional<StationPose> pose(double s) const { return pose(s, o_.bias_mm); }
  [[nodiscard]] std::optional<StationPose> pose(double s, std::optional<double> bias) const {
    const double psi = psi_.at(s), delta = s < station(middle()) ? delta_from_ : delta_to_;
    double eps = 0;
    if (condition_) {
      const auto under = fit_.eps_under(s, psi, best_.poses[middle()]->angles.t_m, *condition_);
      if (!under) return {};
      eps = *under;
    } else {
      eps = eps_.at(s);
    }
    return fit_.place(s, psi, eps, delta, lift_at(s), bias);
  }

  /// Largest misfit over the stations from .. to that have a foot in the ring; infinite where a full one has no pose.
  /// Which delta a pose has does not matter to it, but for the cosine between the normals of the line.
  [[nodiscard]] double worst_misfit(std::size_t from, std::size_t to) const {
    std::vector<double> misfit(to + 1 - from, 0);
    tbb::parallel_for(from, to + 1, [&](std::size_t k) {
      const auto p = pose(station(k), {});
      if (p && p->gap.in_ring()) misfit[k - from] = p->gap.misfit();
      if (!p && inside_full(k)) misfit[k - from] = INFINITY;
    });
    return *std::max_element(misfit.begin(), misfit.end());
  }

  /// psi(s) and eps(s): the stiffest whose worst misfit over the full stations is hardly above the least. Then each end
  /// goes on in the way that is best for it.
  Status smooth() {
    delta_from_ = best_.poses[best_.first]->angles.delta;
    delta_to_ = best_.poses[best_.last]->angles.delta;
    std::vector<Choice> choices;
    for (const double stiffness : kStiffness) {
      Choice c;
      c.stiffness = stiffness;
      choices.push_back(tried(c, best_.first, best_.last));
    }
    double least = INFINITY;
    for (const auto& c : choices) least = std::min(least, c.worst);
    if (!(least < INFINITY))
      return fail("zone {}: flank {:+d}: no pose along the whole pass while {}", fit_.flank().zone, fit_.flank().side,
                  to_string(o_.rotaries));
    Choice taken = *std::find_if(choices.begin(), choices.end(),
                                 [&](const Choice& c) { return c.worst <= kWorse * least + kWorseMm; });
    for (const std::size_t end : {0, 1}) {
      const std::size_t from = end == 0 ? 0 : best_.last, to = end == 0 ? best_.first : count_ - 1;
      taken.worst = INFINITY;
      std::vector<Choice> ways;
      for (const double slope : kEndSlopes) ways.emplace_back(taken).slopes[end] = slope;
      for (const double most : kEndBends) ways.emplace_back(taken).bends[end] = most * o_.station / 0.1;
      for (const auto& way : ways)
        if (const auto c = tried(way, from, to); c.worst < taken.worst - kWorseMm) taken = c;
    }
    take(taken);
    return Ok{};
  }

  /// From the middle outwards until no foot is near the ring any more.
  Status extent() {
    placed_.assign(count_, {});
    tbb::parallel_for(std::size_t{0}, count_, [&](std::size_t k) { placed_[k] = pose(station(k)); });
    if (auto s = extent(-1, delta_from_, from_, s_from_); !s) return s;
    return extent(1, delta_to_, to_, s_to_);
  }
  /// @param end  last station that the pass reaches
  Status extent(int sense, double& delta, std::size_t& end, double& s_end) {
    for (std::size_t k = middle();; k = std::size_t(std::ptrdiff_t(k) + sense)) {
      const auto& p = placed_[k];
      if (!p && (k == 0 || k + 1 == count_)) {
        pass_.shortened_mm += step_;
        return Ok{};
      }
      if (!p)
        return fail(
            "zone {}: flank {:+d} ends for the anchors at {}, before its corner at the {} end is reached; rotaries = "
            "\"both\", more strips or a mill with a smaller half_angle may follow it, a finishing operation with "
            "regions = [\"flank\"] needs no anchors",
            fit_.flank().zone, fit_.flank().side, told(station(k)), end_name(sense));
      if (p->gap.in_ring()) delta = p->angles.delta;
      end = k;
      s_end = station(k);
      if (p->gap.beyond_ring >= o_.overrun * m_) return Ok{};
      if (k == 0 || k + 1 == count_)
        return fail("zone {}: flank {:+d}: a foot is still within the ring {:.3f} mm beyond its {} end",
                    fit_.flank().zone, fit_.flank().side, kBeyond * m_, end_name(sense));
    }
  }
  /// The full stations must have their room; beyond them the pass ends where its lifted tool has none.
  Status room() {
    if (!o_.room) return Ok{};
    std::vector<std::optional<Blocked>> blocked(best_.last + 1 - best_.first);
    tbb::parallel_for(std::size_t{0}, blocked.size(), [&](std::size_t k) {
      if (const auto p = pose(station(best_.first + k))) blocked[k] = o_.room(p->axis);
    });
    for (std::size_t k = 0; k < blocked.size(); ++k)
      if (const auto& b = blocked[k])
        return fail("zone {}: flank {:+d} at {}: the {} has a gap of {:.4f} mm to the {}, {:.4f} mm is the least{}",
                    fit_.flank().zone, fit_.flank().side, told(station(best_.first + k)), b->body, b->gap_mm, b->patch,
                    b->least_mm, remedy(*b));
    room(-1, best_.first, from_, s_from_);
    room(1, best_.last, to_, s_to_);
    return Ok{};
  }
  /// @param sense  +1: towards rising s
  void room(int sense, std::size_t full, std::size_t& end, double& s_end) {
    for (std::size_t k = full; k != end;) {
      const std::size_t next = std::size_t(std::ptrdiff_t(k) + sense);
      if (!clear(station(next))) {
        const std::size_t asked = end;
        end = k;
        s_end = last_clear(station(k), station(next));
        const auto last = pose(s_end);
        if (!last || last->gap.in_ring()) pass_.shortened_mm += std::abs(station(asked) - s_end);
        if (const auto p = pose(station(next))) pass_.shortened_by = o_.room(p->axis);
        return;
      }
      k = next;
    }
  }
  [[nodiscard]] bool clear(double s) const {
    const auto p = pose(s);
    return p && !o_.room(p->axis);
  }
  /// Last station on the way from a clear pose to one that is not, to a 32nd of a station.
  [[nodiscard]] double last_clear(double in, double out) const {
    for (int k = 0; k < 5; ++k) {
      const double s = 0.5 * (in + out);
      (clear(s) ? in : out) = s;
    }
    return in;
  }
  [[nodiscard]] bool inside_full(std::size_t k) const { return k >= best_.first && k <= best_.last; }

  /// The ball end is lifted out of what lies beyond an end: as far as its foot asks for one station nearer to the
  /// middle (so that the lift begins when the corner is passed for certain), and no faster than the slope allows.
  void lifts() {
    const auto& f = fit_.flank();
    const auto raise = [&](int sense, double s_most) {
      double had = 0, asked = 0;
      for (std::ptrdiff_t k = std::ptrdiff_t(middle()) + sense; k >= 0 && k < std::ptrdiff_t(count_); k += sense) {
        const auto &p = placed_[std::size_t(k)], &before = placed_[std::size_t(k - sense)];
        if (p && before) {
          had = std::min(asked, had + o_.lift_slope * (p->anchor - before->anchor).norm());
          asked = fit_.lift_to(*p, s_most, sense);
        }
        lift_[std::size_t(k)] = had;
      }
    };
    if (o_.lift_from) raise(-1, f.s_from - o_.lift_margin * m_);
    if (o_.lift_to) raise(1, f.s_to + o_.lift_margin * m_);
  }
  /// Straight between stations: it never overshoots.
  [[nodiscard]] double lift_at(double s) const {
    const double u = std::clamp((s - start_) / step_, 0.0, double(count_ - 1));
    const std::size_t k = std::min(std::size_t(u), count_ - 2);
    return o_.base_lift + lift_[k] + (u - double(k)) * (lift_[k + 1] - lift_[k]);
  }

  /// Where exactly the first and the last foot of the pass lie in the ring. There the gap is held by the corner alone;
  /// beyond it delta stays.
  Status corners() {
    const auto in_ring = [&](double s) {
      const auto p = pose(s);
      return p && p->gap.in_ring();
    };
    const auto find = [&](double in, double out, double& delta) {
      for (int k = 0; k < 60 && std::abs(out - in) > kCorner; ++k) {
        const double s = 0.5 * (in + out);
        (in_ring(s) ? in : out) = s;
      }
      if (const auto p = pose(in)) delta = p->angles.delta;
      return in;
    };
    std::size_t inner = from_, outer = to_;
    while (inner < to_ && !in_ring(station(inner))) ++inner;
    while (outer > from_ && !in_ring(station(outer))) --outer;
    if (inner >= outer) return lost(station(inner));
    const double before = inner > from_ ? station(inner - 1) : s_from_,
                 after = outer < to_ ? station(outer + 1) : s_to_;
    if (before < station(inner) && !in_ring(before)) stops_.push_back(find(station(inner), before, delta_from_));
    if (after > station(outer) && !in_ring(after)) stops_.push_back(find(station(outer), after, delta_to_));
    if (stops_.empty() || s_to_ > stops_.back()) stops_.push_back(s_to_);
    return Ok{};
  }

  /// How far the blend of two poses strays from what its neighbourhood leaves, over its whole domain.
  [[nodiscard]] double stray(const StationPose& a, const StationPose& b, double w) const {
    const double r_0 = fit_.law().r_0;
    const Vec3 tip = (1 - w) * (a.axis.c_0 - r_0 * a.axis.a) + w * (b.axis.c_0 - r_0 * b.axis.a);
    AxisLine<double> blend;
    blend.a = ((1 - w) * a.axis.a + w * b.axis.a).normalized();
    blend.c_0 = tip + r_0 * blend.a;
    const double t = std::max(0.0, (1 - w) * a.angles.t_m + w * b.angles.t_m);
    const auto gap = fit_.gap_along(blend, t, between(a.at, b.at, w));
    if (!gap) return INFINITY;
    if (!gap->in_ring()) return 0;
    const double most = std::max({a.gap.most, b.gap.most, o_.bias_mm});
    return std::max(kGougeCounts * (o_.bias_mm - gap->least), gap->most - most);
  }

  Status records() {
    auto here = pose(s_from_);
    const double longest = o_.longest * m_;
    double step = longest;
    if (!here) return lost(s_from_);
    if (auto s = add(*here); !s) return s;
    for (std::size_t stop = 0; stop < stops_.size();) {
      const double end = stops_[stop];
      const double pieces = std::ceil((end - here->s) / step - 1e-9);  // even ones up to the stop
      const double s = pieces <= 1 ? end : here->s + (end - here->s) / pieces;
      const auto next = pose(s);
      if (!next) return lost(s);
      const double worst = std::max({stray(*here, *next, 0.25), stray(*here, *next, 0.5), stray(*here, *next, 0.75)});
      const double turn = std::abs(std::remainder(azimuth(next->axis.a) - azimuth(here->axis.a), 2 * kPi));
      if ((worst > o_.chord_mm || turn > kMostTurn) && step > kShortest * m_) {
        step *= 0.5;
        continue;
      }
      if (worst > o_.chord_mm)
        return fail(
            "zone {}: flank {:+d} at {}: blocks of {:.4f} mm still stray by {:.3f} um, more than the chord tolerance "
            "{:.3f} um",
            fit_.flank().zone, fit_.flank().side, told(s, 4), step, 1e3 * worst, 1e3 * o_.chord_mm);
      pass_.chord_mm = std::max(pass_.chord_mm, worst);
      here = next;
      if (auto added = add(*here); !added) return added;
      if (s == end) ++stop;
      step = std::min(longest, 2 * step);
    }
    return Ok{};
  }
  [[nodiscard]] Diagnostic lost(double s) const {
    return fail("zone {}: flank {:+d}: no pose at {}", fit_.flank().zone, fit_.flank().side, told(s, 4));
  }
  Status add(const StationPose& p) {
    if (auto s = reached(p); !s) return s;
    if (auto s = not_too_tilted(p); !s) return s;
    if (p.gap.in_ring()) pass_.misfit_mm = std::max(pass_.misfit_mm, p.gap.misfit());
    LineRecord record{p.s, p.axis, p.anchor, p.at, p.gap.most, p.lift, 1};
    const double r_0 = fit_.law().r_0;
    if (!pass_.records.empty()) {
      const auto& before = pass_.records.back();
      const double way = (p.anchor - before.anchor).norm();
      record.contact_ratio = (p.axis.c_0 - r_0 * p.axis.a - before.axis.c_0 + r_0 * before.axis.a).norm() / way;
      pass_.contact_mm += way;
    }
    if (p.gap.in_ring()) pass_.contact_top_mm = std::max(pass_.contact_top_mm, r_0 + p.gap.ring_to);
    pass_.records.push_back(record);
    return Ok{};
  }

  void figures() {
    for (std::size_t k = from_; k <= to_; ++k) {
      const auto p = pose(station(k));
      if (!p || !p->gap.in_ring()) continue;
      pass_.stations.push_back({fit_.flank().space->outline().sign * p->s, p->angles.psi, p->angles.eps, p->tilt(),
                                p->covered, best_.poses[k] ? best_.poses[k]->gap.misfit() : 0, p->gap.misfit()});
      pass_.misfit_mm = std::max(pass_.misfit_mm, p->gap.misfit());
      pass_.contact_top_mm = std::max(pass_.contact_top_mm, fit_.law().r_0 + p->gap.ring_to);
    }
  }

  const LineFit& fit_;
  const PassOptions& o_;
  double law_end_, m_, step_ = 0, start_ = 0;
  std::size_t count_ = 0, from_ = 0, to_ = 0;
  double s_from_ = 0, s_to_ = 0;  ///< where the pass begins and ends
  Stations best_;
  std::vector<std::optional<StationPose>> placed_;
  std::optional<AxisCondition> condition_;
  StationCurve psi_, eps_;
  std::vector<double> lift_;
  double delta_from_ = 0, delta_to_ = 0;
  std::vector<double> stops_;  ///< stations that have a record: the ring's ends as the pass meets them, and the last
  LinePass pass_;
};

}  // namespace

const char* to_string(Rotaries rotaries) {
  switch (rotaries) {
    case Rotaries::both: return "both";
    case Rotaries::tilt_stands: return "the tilt stands";
    case Rotaries::azimuth_stands: return "the azimuth stands";
  }
  return "";
}

Result<LinePass> plan_pass(const LineFit& fit, const PassOptions& options, double law_end) {
  return PassPlanner(fit, options, law_end).run();
}

}  // namespace toothpath::line
