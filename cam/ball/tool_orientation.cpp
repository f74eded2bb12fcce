#include "cam/ball/tool_orientation.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "cam/ball/orientation_way.h"
#include "geometry/base/angle.h"

namespace toothpath::ball {
namespace {

std::atomic<std::size_t> runs{0};

constexpr double kGapResolution = 0.01;  // mm, of gaps
constexpr double kStation = 0.7;         // mm between stations, at most
constexpr double kTightStation = 0.35;   // mm: where there is little room
constexpr double kPlace = 0.3;           // mm between the places of the records that are looked at
constexpr int kArcPlaces = 8;            // of a turn between two stations, where its distance to the pole is asked
constexpr int kSweeps = 16;              // of the relaxation
constexpr double kSettled = 0.002;       // tangent: the relaxation ends when no direction moves by more
constexpr int kRounds = 9;               // searches for a pass that is not clear between its stations
constexpr int kRoundsOfStations = 3;     // of them, until the stations are halved
constexpr double kFarthestGap = 2.0;     // mm: gaps beyond are not measured
constexpr double kDeepest = 3.0;         // mm: how far a body that cuts in is followed
constexpr double kLongestStickOut = 60;  // mm: how much longer a tool is looked for, when a job is refused

class Orienter {
 public:
  Orienter(const analytic::GearDistance& part, const analytic::BodyTree& tree, int zone, const tool::ToolAssembly& tool,
           const OrientationOptions& o, std::vector<BallPass>& passes)
      : tree_(tree),
        tool_(tool),
        o_(o),
        passes_(passes),
        check_(part, tree, zone, tool, o),
        grid_(std::tan(o.widest_lean_rad)),
        fine_(std::tan(o.widest_lean_rad), 0.5 * grid_.step) {}

  Expected<Orientation, OrientationRefusal> run() {
    for (const auto& pass : passes_) {
      tracks_.emplace_back(pass);
      ways_.push_back(make_way(tracks_.back(), kStation));
    }
    find_neighbours();
    for (std::size_t p = 0; p < ways_.size(); ++p) {
      if (search(p)) continue;
      if (!search_tight(p)) return *refusal_;
      if (strokes_.empty()) continue;
      const std::size_t strokes = strokes_.size();
      split(p);
      p += strokes - 1;
    }
    relax();
    for (std::size_t p = 0; p < ways_.size(); ++p)
      if (!make_axes(p)) return *refusal_;
    return take_axes(std::move(made_), check_, tree_, tool_, passes_);
  }

 private:
  OrientationWay make_way(const PassTrack& track, double spacing) const {
    OrientationWay way;
    const double length = track.at().back();
    const int count = std::max(2, int(std::ceil(length / spacing)));
    for (int k = 0; k <= count; ++k) {
      way.s.push_back(length * k / count);
      way.points.push_back(track.point(way.s.back()));
      way.r.push_back(radius(way.points.back().centre));
      way.lean.emplace_back(0, 0);
    }
    return way;
  }

  /// The passes nearest to each, at most four; by the middle of their ways.
  void find_neighbours() {
    const auto middle = [&](std::size_t p) { return ways_[p].points[ways_[p].points.size() / 2].centre; };
    for (std::size_t p = 0; p < ways_.size(); ++p) {
      ways_[p].near.clear();
      std::vector<std::pair<double, std::size_t>> list;
      for (std::size_t q = 0; q < ways_.size(); ++q)
        if (q != p) list.emplace_back((middle(p) - middle(q)).norm(), q);
      std::sort(list.begin(), list.end());
      for (std::size_t k = 0; k < std::min<std::size_t>(list.size(), 4); ++k) ways_[p].near.push_back(list[k].second);
    }
  }

  /// Clear with a share of the margin that the way keeps, in a way that turns also away from the pole.
  [[nodiscard]] bool clear_at(const OrientationWay& way, const BallPass::Point& point, const Vec2& lean, bool turning,
                              double share = 1) const {
    const Vec3 axis = check_.frame().axis(lean.x(), lean.y());
    if (turning && !check_.away_from_pole(axis)) return false;
    const double margin = way.tight ? kTightMargin : share * o_.margin_mm;
    return check_.clear(point, axis, o_.clearance_mm + margin, way.tight ? kTightResolution : kGapResolution);
  }
  /// At a station and at the places that are asked with it.
  [[nodiscard]] bool clear_about(const OrientationWay& way, std::size_t station, const Vec2& lean, bool turning) const {
    const double half = 0.5 * (way.s[1] - way.s[0]);
    return clear_at(way, way.points[station], lean, turning) &&
           std::all_of(way.also.begin(), way.also.end(), [&](const auto& place) {
             return std::abs(place.first - way.s[station]) > half + 1e-9 || clear_at(way, place.second, lean, turning);
           });
  }
  /// Half-way between two stations, and the whole turn away from the pole.
  [[nodiscard]] bool clear_between(const OrientationWay& way, std::size_t station, std::size_t next, const Vec2& a,
                                   const Vec2& b) const {
    for (int k = 1; k < kArcPlaces; ++k) {
      const Vec2 q = a + double(k) / kArcPlaces * (b - a);
      if (!check_.away_from_pole(check_.frame().axis(q.x(), q.y()))) return false;
    }
    return clear_at(way, blend_points(way.points[station], way.points[next], 0.5), 0.5 * (a + b), true, 0.5);
  }

  /// What a search asks of one way. A start for it is the nearest pass that has its way already.
  struct Questions {
    LeanReference reference;
    LeanIsClear clear, clear_turning;
    HalfWayIsClear between;
  };
  [[nodiscard]] Questions questions(const OrientationWay& way) const {
    const OrientationWay* like = nullptr;
    for (const auto q : way.near)
      if (like == nullptr && ways_[q].solved) like = &ways_[q];
    Questions ask;
    ask.reference = [&way, like](std::size_t station) {
      return like != nullptr ? like->lean_at(way.r[station]) : Vec2(0, 0);
    };
    ask.clear = [this, &way](std::size_t station, const Vec2& lean) { return clear_about(way, station, lean, false); };
    ask.clear_turning = [this, &way](std::size_t station, const Vec2& lean) {
      return clear_about(way, station, lean, true);
    };
    ask.between = [this, &way](std::size_t station, const Vec2& a, const Vec2& b) {
      return clear_between(way, station, station + 1, a, b);
    };
    return ask;
  }

  /// One way over the whole pass. A narrow one may slip through a grid of 2 deg.
  bool search(std::size_t p) {
    OrientationWay& way = ways_[p];
    const Questions ask = questions(way);
    for (const LeanGrid* grid : {&grid_, &fine_}) {
      if (find_constant(way, *grid, ask.reference, ask.clear)) return true;
      if (find_way(way, *grid, ask.reference, ask.clear_turning, ask.between).found) return true;
    }
    return false;
  }

  /// Where that finds nothing: closer stations and the least margin, and at last more than one stroke.
  bool search_tight(std::size_t p) {
    strokes_.clear();
    std::size_t blocked_at = 0;
    for (const double spacing : {kTightStation, kTightStation / 2}) {
      renew(p, spacing, true);
      const OrientationWay& way = ways_[p];
      const Questions ask = questions(way);
      if (const auto none = first_blocked(way, ask)) {
        refusal_ = blocked(way, *none);
        return false;
      }
      if (spacing == kTightStation && search(p)) return true;
      strokes_ = find_strokes(way, grid_, ask.reference, ask.clear_turning, ask.between, blocked_at);
      if (strokes_.empty())
        strokes_ = find_strokes(way, fine_, ask.reference, ask.clear_turning, ask.between, blocked_at);
      if (!strokes_.empty()) return true;
    }
    refusal_ = parted(ways_[p], blocked_at);
    return false;
  }
  /// A station at which no lean is clear.
  [[nodiscard]] std::optional<std::size_t> first_blocked(const OrientationWay& way, const Questions& ask) const {
    std::vector<char> none(way.s.size());
    tbb::parallel_for(std::size_t(0), none.size(), [&](std::size_t k) {
      none[k] = std::none_of(fine_.leans.begin(), fine_.leans.end(), [&](const Vec2& q) { return ask.clear(k, q); });
    });
    const auto first = std::find(none.begin(), none.end(), 1);
    if (first == none.end()) return {};
    return std::size_t(first - none.begin());
  }

  /// Other stations for a way.
  void renew(std::size_t p, double spacing, bool tight) {
    OrientationWay way = make_way(tracks_[p], spacing);
    way.near = ways_[p].near;
    way.also = ways_[p].also;
    way.tight = tight;
    ways_[p] = std::move(way);
  }

  /// Makes a pass of every stroke. The stations stay; one lean for the whole stroke is preferred.
  void split(std::size_t p) {
    const OrientationWay whole = ways_[p];
    std::vector<BallPass> parts;
    std::vector<OrientationWay> ways;
    for (const WayStroke& stroke : strokes_) {
      parts.push_back(part_of(p, whole.s[stroke.from], whole.s[stroke.to]));
      OrientationWay way;
      way.near = whole.near;
      way.tight = way.solved = true;
      way.lean = stroke.lean;
      for (std::size_t k = stroke.from; k <= stroke.to; ++k) {
        way.s.push_back(whole.s[k] - whole.s[stroke.from]);
        way.points.push_back(whole.points[k]);
        way.r.push_back(whole.r[k]);
      }
      ways.push_back(std::move(way));
    }
    for (auto& way : ways) {
      const Questions ask = questions(way);
      OrientationWay steady = way;
      if (find_constant(steady, grid_, ask.reference, ask.clear)) way = std::move(steady);
    }
    passes_.erase(passes_.begin() + long(p));
    passes_.insert(passes_.begin() + long(p), parts.begin(), parts.end());
    ways_.erase(ways_.begin() + long(p));
    ways_.insert(ways_.begin() + long(p), ways.begin(), ways.end());
    tracks_.clear();
    for (const auto& pass : passes_) tracks_.emplace_back(pass);
    find_neighbours();
  }

  /// The points of a pass from s to s along the centre.
  [[nodiscard]] BallPass part_of(std::size_t p, double from, double to) const {
    const PassTrack& track = tracks_[p];
    BallPass part;
    part.outward = passes_[p].outward;
    part.points.push_back(track.point(from));
    for (std::size_t k = 0; k < track.at().size(); ++k)
      if (track.at()[k] > from + 1e-9 && track.at()[k] < to - 1e-9) part.points.push_back(track.points()[k]);
    part.points.push_back(track.point(to));
    return part;
  }

  /// Takes the steps of the grid out: every direction towards the mean of its neighbours along and across the passes
  /// and of upright, as long as it stays clear. Passes are moved at once, each against the state before the sweep.
  void relax() {
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      const std::vector<OrientationWay> before = ways_;
      std::vector<double> moved(ways_.size(), 0);
      tbb::parallel_for(std::size_t(0), ways_.size(), [&](std::size_t p) { moved[p] = relax_one(ways_[p], before); });
      if (*std::max_element(moved.begin(), moved.end()) < kSettled) break;
    }
  }

  [[nodiscard]] double relax_one(OrientationWay& way, const std::vector<OrientationWay>& all) const {
    const std::size_t n = way.s.size();
    if (way.constant) {
      Vec2 sum(0, 0);
      double weight = 0;
      for (std::size_t k = 0; k < n; ++k) add_neighbours(way, k, all, 1, sum, weight);
      const Vec2 from = way.lean.front(), to = sum / weight;
      for (const double step : {1.0, 0.5, 0.25}) {
        const Vec2 lean = from + step * (to - from);
        bool good = true;
        for (std::size_t k = 0; k < n && good; ++k) good = clear_about(way, k, lean, false);
        if (!good) continue;
        std::fill(way.lean.begin(), way.lean.end(), lean);
        return (lean - from).norm();
      }
      return 0;
    }
    double most = 0;
    for (std::size_t k = 0; k < n; ++k) {
      Vec2 sum(0, 0);
      double weight = 0;
      const double ds = way.s[1] - way.s[0];
      add_neighbours(way, k, all, ds, sum, weight);
      for (const std::size_t j : {k - 1, k + 1})
        if (j < n) {
          sum += kTurnWeight / ds * way.lean[j];
          weight += kTurnWeight / ds;
        }
      const Vec2 from = way.lean[k], to = sum / weight;
      for (const double step : {1.0, 0.5, 0.25}) {
        const Vec2 lean = from + step * (to - from);
        if (!clear_about(way, k, lean, true)) continue;
        bool good = true;
        for (const std::size_t j : {k - 1, k + 1})
          if (j < n && good) good = clear_between(way, k, j, lean, way.lean[j]);
        if (!good) continue;
        way.lean[k] = lean;
        most = std::max(most, (lean - from).norm());
        break;
      }
    }
    return most;
  }

  static void add_neighbours(const OrientationWay& way, std::size_t k, const std::vector<OrientationWay>& all,
                             double ds, Vec2& sum, double& weight) {
    weight += kLeanWeight * ds;
    for (const auto q : way.near) {
      sum += kNearWeight * ds / double(way.near.size()) * all[q].lean_at(way.r[k]);
      weight += kNearWeight * ds / double(way.near.size());
    }
  }

  /// Records of one pass: its points, and more where the axis turns. Each is looked at again with the axis it got, and
  /// so are places between them; one that is not clear is asked in another search.
  bool make_axes(std::size_t p) {
    for (int round = 0;; ++round) {
      std::optional<AxisPlace> bad;
      for (const bool smooth : {true, false}) {
        AxisRecords records = records_of(p, smooth);
        bad = first_not_clear(records, ways_[p].constant);
        if (bad) continue;
        made_.push_back(std::move(records));
        return true;
      }
      ways_[p].also.emplace_back(bad->s, bad->point);
      // Something narrow lies between the stations: look closer at this pass.
      bool found = false;
      const double spacing = kStation / double(1 << (1 + round / kRoundsOfStations));
      for (const bool tight : {false, true}) {
        if (found || round == kRounds || (ways_[p].tight && !tight)) continue;
        renew(p, spacing, tight);
        found = search(p);
      }
      if (found) continue;
      refusal_ = {
          fmt::format("{}; other directions of this pass are not clear elsewhere", stands(bad->point, bad->axis))};
      return false;
    }
  }

  struct AxisPlace {
    double s = 0;
    BallPass::Point point;
    Vec3 axis = Vec3::UnitZ();
    bool record = false;
  };
  /// Among the records and places at most kPlace apart between them: room for the proof, and where the axis turns away
  /// from the pole. The flute is asked at the records: between them the ball leaves its pass by the chord.
  [[nodiscard]] std::optional<AxisPlace> first_not_clear(const AxisRecords& records, bool constant) const {
    std::vector<AxisPlace> places{{0, records.points.front(), records.axes.front(), true}};
    for (std::size_t k = 1; k < records.points.size(); ++k) {
      const auto &a = records.points[k - 1], &b = records.points[k];
      const double from = places.back().s, way = (b.centre - a.centre).norm();
      const int pieces = std::max(1, int(std::ceil(way / kPlace)));
      for (int j = 1; j < pieces; ++j) {
        const double t = double(j) / pieces;
        places.push_back({from + t * way, blend_points(a, b, t),
                          ((1 - t) * records.axes[k - 1] + t * records.axes[k]).normalized(), false});
      }
      places.push_back({from + way, b, records.axes[k], true});
    }
    std::vector<char> good(places.size());
    tbb::parallel_for(std::size_t(0), good.size(), [&](std::size_t k) { good[k] = stands_clear(places[k], constant); });
    const auto bad = std::find(good.begin(), good.end(), 0);
    if (bad == good.end()) return {};
    return places[std::size_t(bad - good.begin())];
  }
  [[nodiscard]] bool stands_clear(const AxisPlace& at, bool constant) const {
    const double room = o_.clearance_mm + kProofRoom;
    const Vec3 tip = at.point.centre - tool_.radius_mm() * at.axis;
    return (constant || check_.away_from_pole(at.axis)) && (!at.record || check_.cutting(at.point, at.axis)) &&
           (tree_.clear(check_.bodies(), tip, at.axis, room, kGapResolution) ||
            tree_.clear(check_.bodies(), tip, at.axis, room, kTightResolution));
  }

  [[nodiscard]] AxisRecords records_of(std::size_t p, bool smooth) const {
    const OrientationWay& way = ways_[p];
    const auto axis = [&](double s) {
      const Vec2 q = way.lean_along(s, smooth);
      return check_.frame().axis(q.x(), q.y());
    };
    return records_with_axes(tracks_[p], axis, o_.chord_mm, tool_.radius_mm());
  }

  // Refusals. What a place needs is the same in all of them: the clearance and the least margin.
  [[nodiscard]] double needed() const { return o_.clearance_mm + kTightMargin; }
  [[nodiscard]] static std::string place(const BallPass::Point& point) {
    return fmt::format("no five-axis motion either: with the ball at radius {:.3f}, height {:.3f}",
                       radius(point.centre), point.centre.z());
  }
  /// The body that keeps least and what it keeps, up to what is needed; `none` where all keep that.
  [[nodiscard]] std::pair<tool::Body, double> nearest_body(const BallPass::Point& point, const Vec3& axis) const {
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
  [[nodiscard]] std::string keeps(tool::Body body, double gap) const {
    return gap < 0 ? fmt::format("its {} cuts in by {}{:.3f} mm, it must keep {:.3f} mm", body,
                                 gap <= -kDeepest ? "more than " : "", -gap, needed())
                   : fmt::format("its {} keeps {:.4f} mm, it must keep {:.3f} mm", body, gap, needed());
  }
  [[nodiscard]] std::string margin_words() const {
    return fmt::format(
        " (the clearance is {:.3f} mm, and {:.3f} mm is for what lies between the places that are looked at)",
        o_.clearance_mm, kTightMargin);
  }
  /// What is wrong with one axis at one place.
  [[nodiscard]] std::string stands(const BallPass::Point& point, const Vec3& axis) const {
    const double lean = degrees(angle_between(axis, check_.frame().up));
    const auto [body, gap] = nearest_body(point, axis);
    if (body != tool::Body::none)
      return fmt::format("{} and the axis leaning {:.2f} deg {}{}; more stick-out or a slimmer {} would help",
                         place(point), lean, keeps(body, gap), margin_words(), body);
    if (!check_.away_from_pole(axis))
      return fmt::format(
          "{} the axis turns at {:.2f} deg of the gear axis, it must keep {:.2f} deg there, the pole of a "
          "rotary that carries the work; program.pole = \"slow\", \"hold\", \"through\" or \"retract\" "
          "goes past it",
          place(point), degrees(std::atan2(std::hypot(axis.x(), axis.y()), axis.z())), degrees(o_.least_tilt_rad));
    return fmt::format("{} and the axis leaning {:.2f} deg its flute would cut, by {:.4f} mm", place(point), lean,
                       check_.flute_depth(point, axis));
  }

  /// Clear directions on both sides that no stroke joins: the pair that comes nearest, and what is in the way between.
  [[nodiscard]] OrientationRefusal parted(const OrientationWay& way, std::size_t station) const {
    const std::size_t before = station > 0 ? station - 1 : 0;
    std::vector<Vec2> from, to;
    for (const auto& q : fine_.leans) {
      if (clear_at(way, way.points[before], q, true)) from.push_back(q);
      if (clear_at(way, way.points[station], q, true)) to.push_back(q);
    }
    const auto& point = way.points[station];
    if (from.empty() || to.empty())
      return {
          fmt::format("{} every direction that is clear lies within {:.1f} deg of the gear axis, the pole of a rotary "
                      "that carries the work, where no axis may turn; program.pole = \"slow\", \"hold\", \"through\" "
                      "or \"retract\" goes past it",
                      place(point), degrees(o_.least_tilt_rad))};
    Vec2 a = from.front(), b = to.front();
    for (const auto& p : from)
      for (const auto& q : to)
        if ((q - p).norm() < (b - a).norm()) a = p, b = q;
    const auto axis_of = [&](const Vec2& q) { return check_.frame().axis(q.x(), q.y()); };
    const double turn = angle_between(axis_of(a), axis_of(b)), way_mm = way.s[station] - way.s[before];
    const auto half = blend_points(way.points[before], point, 0.5);
    const auto [body, gap] = nearest_body(half, axis_of(0.5 * (a + b)));
    const std::string what = body != tool::Body::none ? keeps(body, gap) + " half-way" + margin_words()
                                                      : std::string("that is more than a stroke may turn there");
    return {
        fmt::format("{} the clear directions do not join those before it, not in {} strokes either: the nearest two "
                    "are {:.1f} deg apart over {:.2f} mm, and {}; more stick-out or a slimmer shank would help",
                    place(point), kMostStrokes, degrees(turn), way_mm, what)};
  }

  /// A place where no direction is clear: the body in the way in the best one, and what more reach would do.
  [[nodiscard]] OrientationRefusal blocked(const OrientationWay& way, std::size_t station) const {
    const auto& point = way.points[station];
    std::vector<Vec3> usable;  // directions in which the ball cuts, whatever stands above it
    double shallowest = INFINITY, shallowest_lean = 0, best = -INFINITY, lean = 0;
    tool::Body body = tool::Body::none;
    for (const auto& q : grid_.leans) {
      const Vec3 axis = check_.frame().axis(q.x(), q.y());
      const double of = angle_between(axis, check_.frame().up);
      if (!check_.cutting(point, axis)) {
        const double depth = check_.flute_depth(point, axis);
        if (depth < shallowest) shallowest = depth, shallowest_lean = of;
        continue;
      }
      usable.push_back(axis);
      const auto [worst, gap] = nearest_body(point, axis);
      if (gap > best) best = gap, lean = of, body = worst;
    }
    if (usable.empty())
      return {
          fmt::format("{} its flute would cut in every direction, least where it leans {:.1f} deg: by {:.4f} mm; a "
                      "ball of less diameter is needed",
                      place(point), degrees(shallowest_lean), shallowest)};
    return {fmt::format("{} the best of {} directions leans {:.1f} deg and {}{}; {}", place(point), usable.size(),
                        degrees(lean), keeps(body, best), margin_words(), advice(point, usable))};
  }

  [[nodiscard]] std::string advice(const BallPass::Point& point, const std::vector<Vec3>& usable) const {
    const auto helps = [&](double by, bool flute) {
      tool::ToolAssembly longer = tool_;
      longer.stick_out_mm += by;
      longer.length_mm += by;
      if (flute) longer.flute_length_mm += by;
      const auto bodies = tool::shank_and_holder(longer);
      return std::any_of(usable.begin(), usable.end(), [&](const Vec3& axis) {
        return tree_.clear(bodies, point.centre - tool_.radius_mm() * axis, axis, needed(), kTightResolution);
      });
    };
    for (const bool flute : {false, true}) {
      if (!helps(kLongestStickOut, flute)) continue;
      double short_by = 0, enough = kLongestStickOut;
      while (enough - short_by > 0.05) {
        const double middle = 0.5 * (short_by + enough);
        (helps(middle, flute) ? enough : short_by) = middle;
      }
      return flute ? fmt::format("a flute of {:.1f} mm (now {:.1f}) with as much more stick-out would clear this place",
                                 tool_.flute_length_mm + enough, tool_.flute_length_mm)
                   : fmt::format("a stick-out of {:.1f} mm (now {:.1f}) would clear this place",
                                 tool_.stick_out_mm + enough, tool_.stick_out_mm);
    }
    return "a slimmer shank is needed";
  }

  const analytic::BodyTree& tree_;
  const tool::ToolAssembly& tool_;
  const OrientationOptions& o_;
  std::vector<BallPass>& passes_;
  OrientationCheck check_;
  LeanGrid grid_;
  LeanGrid fine_;  ///< asked when the coarse one does not do
  std::vector<PassTrack> tracks_;
  std::vector<OrientationWay> ways_;
  std::vector<WayStroke> strokes_;  ///< of the pass that was searched last; empty: one stroke
  std::vector<AxisRecords> made_;
  std::optional<OrientationRefusal> refusal_;
};

}  // namespace

OrientationCheck::OrientationCheck(const analytic::GearDistance& part, const analytic::BodyTree& tree, int zone,
                                   const tool::ToolAssembly& tool, const OrientationOptions& options)
    : part_(part),
      tree_(tree),
      tool_(tool),
      o_(options),
      frame_(pitch_frame(part, zone)),
      bodies_(tool::shank_and_holder(tool)) {}

bool OrientationCheck::cutting(const BallPass::Point& point, const Vec3& axis) const {
  return stands_right(point, axis) && flute_is_free(point, axis);
}

bool OrientationCheck::away_from_pole(const Vec3& axis) const {
  return std::atan2(std::hypot(axis.x(), axis.y()), axis.z()) >= o_.least_tilt_rad;
}

bool OrientationCheck::stands_right(const BallPass::Point& point, const Vec3& axis) const {
  const Vec3 normal = point.centre - point.contact;
  return !point.touching || normal.norm() <= 0.1 * tool_.radius_mm() || normal.normalized().dot(axis) >= o_.least_draft;
}

double OrientationCheck::flute_cut(const BallPass::Point& point, const Vec3& axis, double above) const {
  const double R = tool_.radius_mm() + above * std::sin(tool_.half_angle_rad);
  return R - part_.nearest(point.centre + above * axis, R + 0.01).distance;
}

bool OrientationCheck::flute_is_free(const BallPass::Point& point, const Vec3& axis) const {
  const double R = tool_.radius_mm(), top = tool_.flute_length_mm - R;
  for (double h = std::min(0.4 * R, top); h > 0; h = h < top ? std::min(h + R, top) : -1) {
    if (point.centre.z() + h * axis.z() - R > part_.gear().blank_top()) break;
    if (flute_cut(point, axis, h) > 0) return false;
  }
  return true;
}

double OrientationCheck::flute_depth(const BallPass::Point& point, const Vec3& axis) const {
  const double R = tool_.radius_mm();
  const Vec3 normal = point.centre - point.contact;
  double deepest = 0;
  if (point.touching && normal.norm() > 0.1 * R)
    deepest = std::max(0.0, R * (o_.least_draft - normal.normalized().dot(axis)));
  for (double h = 0.4 * R; h <= tool_.flute_length_mm - R; h += 0.25 * R)
    deepest = std::max(deepest, flute_cut(point, axis, h));
  return deepest;
}

bool OrientationCheck::clear(const BallPass::Point& point, const Vec3& axis, double clearance_mm,
                             double resolution_mm) const {
  return stands_right(point, axis) &&
         tree_.clear(bodies_, point.centre - tool_.radius_mm() * axis, axis, clearance_mm, resolution_mm) &&
         flute_is_free(point, axis);
}

Orientation take_axes(std::vector<AxisRecords> made, const OrientationCheck& check, const analytic::BodyTree& tree,
                      const tool::ToolAssembly& tool, std::vector<BallPass>& passes) {
  Orientation out;
  out.least_lean_rad = INFINITY;
  out.clearance_mm = kFarthestGap;
  for (std::size_t p = 0; p < made.size(); ++p) {
    auto& points = made[p].points;
    auto& axes = made[p].axes;
    std::vector<double> gaps(points.size(), kFarthestGap);
    tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t k) {
      for (const auto& body : check.bodies())
        gaps[k] = std::min(
            gaps[k], tree.gap(body, points[k].centre - tool.radius_mm() * axes[k], axes[k], gaps[k], kGapResolution));
    });
    double turned = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      out.clearance_mm = std::min(out.clearance_mm, gaps[k]);
      const double lean = angle_between(axes[k], check.frame().up);
      out.least_lean_rad = std::min(out.least_lean_rad, lean);
      out.greatest_lean_rad = std::max(out.greatest_lean_rad, lean);
      if (k == 0) continue;
      const double step = angle_between(axes[k - 1], axes[k]), way = (points[k].centre - points[k - 1].centre).norm();
      turned += step;
      out.greatest_step_rad = std::max(out.greatest_step_rad, step);
      if (way > 1e-6) out.greatest_turn_rad_per_mm = std::max(out.greatest_turn_rad_per_mm, step / way);
    }
    if (turned > 1e-6) ++out.turning_passes;
    passes[p].points = std::move(points);
    out.axes.push_back(std::move(axes));
  }
  out.clearance_at_least = out.clearance_mm >= kFarthestGap;
  return out;
}

Expected<Orientation, OrientationRefusal> orient_passes(const analytic::GearDistance& part,
                                                        const analytic::BodyTree& tree, int zone,
                                                        const tool::ToolAssembly& tool,
                                                        const OrientationOptions& options,
                                                        std::vector<BallPass>& passes) {
  ++runs;
  passes.erase(std::remove_if(passes.begin(), passes.end(), [](const BallPass& p) { return p.points.empty(); }),
               passes.end());
  return Orienter(part, tree, zone, tool, options, passes).run();
}

std::size_t orientation_runs() { return runs; }

}  // namespace toothpath::ball
