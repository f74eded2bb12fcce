#include "cam/ball/tool_orientation.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>

#include "cam/ball/orientation_way.h"
#include "cam/path/asked_stock.h"
#include "geometry/base/angle.h"
#include "geometry/base/work_share.h"

namespace toothpath::ball {
namespace {

std::atomic<std::size_t> runs{0};

constexpr double kGapResolution = 0.01;  // mm, of gaps
constexpr double kStation = 0.7;         // mm between stations, at most
constexpr double kWidestTurn = 0.5;      // rad: of squares that are asked as one
constexpr double kShortestWay = 0.004;   // mm: a motion is halved to this
constexpr int kCloser = 8;               // pieces of a step where directions do not join
constexpr int kLooks = 3;                // at such steps of a pass
constexpr int kArcPlaces = 8;            // of a turn between two stations, where its distance to the pole is asked
constexpr int kSweeps = 16;              // of the relaxation
constexpr double kSettled = 0.002;       // tangent: the relaxation ends when no direction moves by more
constexpr int kRounds = 9;               // searches for a pass that is not clear between its stations
constexpr int kRoundsOfStations = 3;     // of them, until the stations are halved
constexpr double kFarthestGap = 2.0;     // mm: gaps beyond are not measured
constexpr double kFluteSag = 1e-4;       // mm: how deep an edge between two heights of the flute may stand in it

/// The flute at a height above the ball centre: its radius, and the distance of its axis to the part. mm
struct FluteHeight {
  double above = 0, radius = 0, distance = 0;
  /// Square of the half chord about this height in which nothing of the part can stand; negative: the flute cuts.
  [[nodiscard]] double spare() const { return distance * distance - radius * radius; }
};

/// Between two heights at which it cuts nothing. The square of a distance less that of the way is concave along a line,
/// whatever the part (cam/README.md): where the half chords of both heights meet, nothing stands between them.
template <class Measured>
bool flute_is_free_between(const FluteHeight& a, const FluteHeight& b, const Measured& measured) {
  const double way = b.above - a.above, wider = b.radius - a.radius;
  if (std::sqrt(a.spare()) + std::sqrt(b.spare()) >= std::sqrt(std::max(0.0, way * way - wider * wider))) return true;
  if (way * way < 8 * a.radius * kFluteSag) return true;
  const FluteHeight middle = measured(0.5 * (a.above + b.above));
  return middle.spare() >= 0 && flute_is_free_between(a, middle, measured) &&
         flute_is_free_between(middle, b, measured);
}

class Orienter {
 public:
  Orienter(const analytic::GearDistance& part, const analytic::BodyTree& tree, int zone, const tool::ToolAssembly& tool,
           const OrientationOptions& o, std::vector<BallPass>& passes)
      : tree_(tree),
        tool_(tool),
        o_(o),
        passes_(passes),
        whole_(passes),
        part_(part),
        zone_(zone),
        check_(part, tree, zone, tool, o),
        words_(part, tree, zone, tool, o),
        grid_(std::tan(o.widest_lean_rad)),
        fine_(std::tan(o.widest_lean_rad), 0.5 * grid_.step),
        narrow_(std::tan(o.widest_lean_rad), 0.25 * grid_.step),
        wide_(std::tan(o.farthest_lean_rad), 0.25 * grid_.step),
        finest_(std::tan(o.widest_lean_rad), 0.125 * grid_.step) {}

  Expected<Orientation, OrientationRefusal> run() {
    for (const auto& pass : passes_) {
      tracks_.emplace_back(pass);
      ways_.push_back(make_way(tracks_.back(), kStation));
    }
    find_neighbours();
    const WorkShare all(3);
    if (!search_all()) return *refusal_;
    relax();
    if (!make_all_axes()) return *refusal_;
    return take_axes(std::move(made_), check_, tree_, tool_, passes_);
  }

 private:
  bool search_all() {
    WorkShare share{double(ways_.size())};
    for (std::size_t p = 0; p < ways_.size(); ++p) {
      share.add();
      if (search(p)) continue;
      const std::size_t before = ways_.size();
      if (!search_tight(p)) return false;
      p += ways_.size() - before;  // strokes of it
    }
    return true;
  }
  bool make_all_axes() {
    WorkShare share{double(ways_.size())};
    for (std::size_t p = 0; p < ways_.size(); ++p) {
      if (!make_axes(p)) return false;
      share.add();
    }
    return true;
  }

  /// Are the same passes planned with another tool?
  [[nodiscard]] RefusalWords::Plans plans() const {
    return [this](const tool::ToolAssembly& tool) {
      std::vector<BallPass> passes = whole_;
      OrientationOptions silent = o_;
      silent.trial = true;
      Orienter other(part_, tree_, zone_, tool, silent, passes);
      return !other.run().refused();
    };
  }

  OrientationWay make_way(const PassTrack& track, double spacing) const {
    const double length = track.at().back();
    const int count = std::max(2, int(std::ceil(length / spacing)));
    std::vector<double> at;
    for (int k = 0; k <= count; ++k) at.push_back(length * k / count);
    return make_way(track, at);
  }
  [[nodiscard]] OrientationWay make_way(const PassTrack& track, const std::vector<double>& at) const {
    OrientationWay way;
    for (const double s : at) {
      way.s.push_back(s);
      way.points.push_back(track.point(way.s.back()));
      way.r.push_back(part_.part().chart().along(way.points.back().centre));
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
  /// Is a place of a pass, told by its length, asked with a station?
  [[nodiscard]] static bool asked_with(const OrientationWay& way, std::size_t station, double at) {
    const double before = 0.5 * way.step(station), after = 0.5 * way.step(std::min(station + 1, way.s.size() - 1));
    const double off = at - way.s[station];
    return -off <= before + 1e-9 && off <= after + 1e-9;
  }
  /// At a station and at the places that are asked with it.
  [[nodiscard]] bool clear_about(const OrientationWay& way, std::size_t station, const Vec2& lean, bool turning) const {
    return clear_at(way, way.points[station], lean, turning) &&
           std::all_of(way.also.begin(), way.also.end(), [&](const auto& place) {
             return !asked_with(way, station, place.first) || clear_at(way, place.second, lean, turning);
           });
  }
  /// Of a square of leans at a place. Two leans are no farther apart as axes than as tangents.
  [[nodiscard]] Leans leans_about(const OrientationWay& way, const BallPass::Point& point, const Vec2& centre,
                                  double half) const {
    const double margin = way.tight ? kTightMargin : o_.margin_mm;
    return check_.about(point, check_.frame().axis(centre.x(), centre.y()), half * std::numbers::sqrt2,
                        o_.clearance_mm + margin, way.tight ? kTightResolution : kGapResolution);
  }
  /// At a station of a way that turns: with the places that are asked with it, and the pole.
  [[nodiscard]] Leans leans_at(const OrientationWay& way, std::size_t station, const Vec2& centre, double half) const {
    Leans all = leans_about(way, way.points[station], centre, half);
    for (const auto& place : way.also) {
      if (all == Leans::none_clear) return all;
      if (!asked_with(way, station, place.first)) continue;
      const Leans there = leans_about(way, place.second, centre, half);
      if (there != Leans::all_clear) all = there;
    }
    const double off = off_pole(check_.frame().axis(centre.x(), centre.y())) - half * std::numbers::sqrt2;
    return all == Leans::all_clear && off < o_.least_tilt_rad ? Leans::mixed : all;
  }
  /// Half-way between two stations, and the whole turn away from the pole.
  [[nodiscard]] bool clear_between(const OrientationWay& way, std::size_t station, std::size_t next, const Vec2& a,
                                   const Vec2& b) const {
    for (int k = 1; k < kArcPlaces; ++k) {
      const Vec2 q = a + double(k) / kArcPlaces * (b - a);
      if (!check_.away_from_pole(check_.frame().axis(q.x(), q.y()))) return false;
    }
    if (way.tight)
      return !check_.not_kept({0, way.points[station], check_.frame().axis(a.x(), a.y())},
                              {1, way.points[next], check_.frame().axis(b.x(), b.y())}, o_.clearance_mm + kProofRoom);
    return clear_at(way, blend_points(way.points[station], way.points[next], 0.5), 0.5 * (a + b), true, 0.5);
  }

  /// What a search asks of one way. A start for it is the nearest pass that has its way already.
  struct Questions {
    LeanReference reference;
    LeanIsClear clear, clear_turning;
    HalfWayIsClear between;
    LeansInSquare square;
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
    ask.square = [this, &way](std::size_t station, const Vec2& centre, double half) {
      return leans_at(way, station, centre, half);
    };
    return ask;
  }

  /// One way over the whole pass. A narrow one may slip through a grid of 2 deg.
  bool search(std::size_t p) {
    OrientationWay& way = ways_[p];
    const Questions ask = questions(way);
    for (const LeanGrid* grid : {&grid_, &fine_}) {
      if (find_constant(way, *grid, ask.reference, ask.clear)) return true;
      const LeansInSquare square = grid == &grid_ ? LeansInSquare() : ask.square;
      if (find_way(way, *grid, ask.reference, ask.clear_turning, ask.between, square).found) return true;
    }
    return false;
  }

  /// Where that finds nothing: closer stations and the least margin, more than one stroke, finer grids.
  bool search_tight(std::size_t p) {
    std::size_t blocked_at = 0;
    if (o_.trial) return refuse_trial();
    if (!all_asked_ && any_blocked()) return refuse_place();
    for (const double spacing : {kTightStation, kTightStation / 2}) {
      renew(p, spacing, true);
      if (first_blocked(ways_[p])) return refuse_place();
      if (spacing == kTightStation && search(p)) return true;
      if (search_strokes(p, blocked_at)) return true;
    }
    for (int look = 0; look < kLooks && blocked_at > 0; ++look) {
      look_closer(p, blocked_at);
      if (first_blocked(ways_[p])) return refuse_place();
      if (in_strokes(p, finest_, blocked_at)) return true;
    }
    refusal_ = words_.parted(ways_[p], blocked_at, plans());
    return false;
  }
  bool refuse_place() {
    refusal_ = words_.blocked(whole_, plans());
    return false;
  }
  bool refuse_trial() {
    refusal_ = OrientationRefusal{};
    return false;
  }
  bool search_strokes(std::size_t p, std::size_t& blocked_at) {
    return std::any_of(kGrids.begin(), kGrids.end(), [&](auto grid) { return in_strokes(p, this->*grid, blocked_at); });
  }
  /// As few strokes as do, one if possible; splits the pass where it is more.
  bool in_strokes(std::size_t p, const LeanGrid& grid, std::size_t& blocked_at) {
    OrientationWay& way = ways_[p];
    const Questions ask = questions(way);
    auto strokes = find_strokes(way, grid, ask.reference, ask.clear_turning, ask.between, blocked_at, ask.square);
    if (strokes.empty()) return false;
    if (strokes.size() > 1) {
      split(p, strokes);
    } else {
      way.lean = std::move(strokes.front().lean);
      way.constant = false;
      way.solved = true;
    }
    return true;
  }
  /// Is there a place on any pass at which no lean is clear? Asked once, before anything that takes long.
  bool any_blocked() {
    all_asked_ = true;
    return std::any_of(tracks_.begin(), tracks_.end(), [&](const PassTrack& track) {
      OrientationWay way = make_way(track, kTightStation);
      way.tight = true;
      return first_blocked(way).has_value();
    });
  }
  /// A station at which no lean is clear.
  [[nodiscard]] std::optional<std::size_t> first_blocked(const OrientationWay& way) const {
    std::vector<char> none(way.s.size());
    tbb::parallel_for(std::size_t(0), none.size(), [&](std::size_t k) {
      none[k] = !find_clear_lean(
          std::tan(o_.farthest_lean_rad), kFinestLean, Vec2(0, 0),
          [&](const Vec2& centre, double half) { return leans_about(way, way.points[k], centre, half); },
          [&](const Vec2& lean) { return clear_at(way, way.points[k], lean, false); });
    });
    const auto first = std::find(none.begin(), none.end(), 1);
    if (first == none.end()) return {};
    return std::size_t(first - none.begin());
  }

  /// Other stations for a way.
  void renew(std::size_t p, double spacing, bool tight) { take(p, make_way(tracks_[p], spacing), tight); }
  /// More of them between a station and the one before it.
  void look_closer(std::size_t p, std::size_t station) {
    std::vector<double> at = ways_[p].s;
    const double from = at[station - 1], to = at[station];
    for (int k = kCloser - 1; k > 0; --k) at.insert(at.begin() + long(station), from + (to - from) * k / kCloser);
    take(p, make_way(tracks_[p], at), true);
  }
  void take(std::size_t p, OrientationWay way, bool tight) {
    way.near = ways_[p].near;
    way.also = ways_[p].also;
    way.tight = tight;
    ways_[p] = std::move(way);
  }

  /// Makes a pass of every stroke. The stations stay; one lean for the whole stroke is preferred.
  void split(std::size_t p, const std::vector<WayStroke>& strokes) {
    const OrientationWay whole = ways_[p];
    std::vector<BallPass> parts;
    std::vector<OrientationWay> ways;
    for (const WayStroke& stroke : strokes) {
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
      for (const auto& [at, point] : whole.also)
        if (at >= whole.s[stroke.from] && at <= whole.s[stroke.to])
          way.also.emplace_back(at - whole.s[stroke.from], point);
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
    WorkShare share(kSweeps);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      share.add();
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
      add_neighbours(way, k, all, way.step(k), sum, weight);
      for (const std::size_t j : {k - 1, k + 1})
        if (j < n) {
          const double turn = kTurnWeight / way.step(std::max(j, k));
          sum += turn * way.lean[j];
          weight += turn;
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
        if (tight && o_.trial) return refuse_trial();
        renew(p, spacing, tight);
        std::size_t blocked_at = 0;
        found = search(p) || (tight && search_strokes(p, blocked_at));
      }
      if (found) continue;
      refusal_ = o_.trial ? OrientationRefusal{} : words_.no_way_about(bad->point, bad->axis, plans());
      return false;
    }
  }

  struct AxisPlace {
    double s = 0;
    BallPass::Point point;
    Vec3 axis = Vec3::UnitZ();
  };
  /// Among the records and every moment between them: room for the proof. At the records the flute is free, and where
  /// the axis turns it keeps away from the pole; between them the ball leaves its pass by the chord.
  [[nodiscard]] std::optional<AxisPlace> first_not_clear(const AxisRecords& records, bool constant) const {
    const std::vector<BallPass::Point>& points = records.points;
    const std::vector<Vec3>& axes = records.axes;
    std::vector<std::optional<AxisPlace>> bad(points.size());
    std::vector<double> s(points.size(), 0);
    for (std::size_t k = 1; k < s.size(); ++k) s[k] = s[k - 1] + (points[k].centre - points[k - 1].centre).norm();
    tbb::parallel_for(std::size_t(0), bad.size(), [&](std::size_t k) {
      if (!(constant || check_.away_from_pole(axes[k])) || !check_.cutting(points[k], axes[k]))
        bad[k] = {s[k], points[k], axes[k]};
      if (k == 0 || bad[k]) return;
      const auto moment = check_.not_kept({s[k - 1], points[k - 1], axes[k - 1]}, {s[k], points[k], axes[k]},
                                          o_.clearance_mm + kProofRoom);
      if (moment) bad[k] = {moment->at, moment->point, moment->axis};
    });
    const auto first = std::find_if(bad.begin(), bad.end(), [](const auto& place) { return place.has_value(); });
    return first == bad.end() ? std::nullopt : *first;
  }

  [[nodiscard]] AxisRecords records_of(std::size_t p, bool smooth) const {
    const OrientationWay& way = ways_[p];
    const auto axis = [&](double s) {
      const Vec2 q = way.lean_along(s, smooth);
      return check_.frame().axis(q.x(), q.y());
    };
    return records_with_axes(tracks_[p], axis, o_.chord_mm, tool_.radius_mm());
  }

  const analytic::BodyTree& tree_;
  const tool::ToolAssembly& tool_;
  const OrientationOptions& o_;
  std::vector<BallPass>& passes_;
  const std::vector<BallPass> whole_;  ///< as they were given: in one stroke each
  const analytic::GearDistance& part_;
  const int zone_;
  OrientationCheck check_;
  RefusalWords words_;
  LeanGrid grid_;
  LeanGrid fine_;                    ///< asked when the coarse one does not do
  LeanGrid narrow_, wide_, finest_;  ///< asked in the end, square by square: a narrow way through, a far lean
  static constexpr std::array kGrids = {&Orienter::grid_, &Orienter::fine_, &Orienter::narrow_, &Orienter::wide_};
  std::vector<PassTrack> tracks_;
  std::vector<OrientationWay> ways_;
  std::vector<AxisRecords> made_;
  std::optional<OrientationRefusal> refusal_;
  bool all_asked_ = false;
};

}  // namespace

double off_pole(const Vec3& axis) { return std::atan2(std::hypot(axis.x(), axis.y()), axis.z()); }

OrientationCheck::OrientationCheck(const analytic::GearDistance& part, const analytic::BodyTree& tree, int zone,
                                   const tool::ToolAssembly& tool, const OrientationOptions& options)
    : part_(part),
      tree_(tree),
      tool_(tool),
      o_(options),
      frame_(pitch_frame(part, zone)),
      bodies_(tool::shank_and_holder(tool)) {}

void OrientationCheck::slim(double by_mm) {
  for (auto& f : bodies_) {
    f.from += by_mm;
    f.radius_from = std::max(f.radius_from - by_mm, 0.0);
    f.radius_to = std::max(f.radius_to - by_mm, 0.0);
  }
  std::erase_if(bodies_, [](const tool::Frustum& f) { return f.from >= f.to; });
}

bool OrientationCheck::cutting(const BallPass::Point& point, const Vec3& axis) const {
  return stands_right(point, axis) && flute_is_free(point, axis);
}

bool OrientationCheck::away_from_pole(const Vec3& axis) const { return off_pole(axis) >= o_.least_tilt_rad; }

bool OrientationCheck::stands_right(const BallPass::Point& point, const Vec3& axis, double angle_rad) const {
  const Vec3 normal = point.centre - point.contact;
  return !point.touching || normal.norm() <= 0.1 * tool_.radius_mm() ||
         normal.normalized().dot(axis) - angle_rad >= o_.least_draft;
}

double OrientationCheck::flute_radius(double above) const {
  return tool_.radius_mm() + above * std::sin(tool_.half_angle_rad) + path::kPlannedStock * o_.allowance_mm;
}

double OrientationCheck::flute_cut(const BallPass::Point& point, const Vec3& axis, double above) const {
  const double R = flute_radius(above);
  return R - part_.nearest(point.centre + above * axis, R + 0.01).distance;
}

bool OrientationCheck::flute_is_free(const BallPass::Point& point, const Vec3& axis, double angle_rad) const {
  const double R = tool_.radius_mm(), top = tool_.flute_length_mm - R;
  const tooth_space::Chart& chart = part_.part().chart();
  const auto measured = [&](double above) {
    const double radius = flute_radius(above) + above * angle_rad;
    return FluteHeight{above, radius, part_.nearest(point.centre + above * axis, std::hypot(radius, 0.5 * R)).distance};
  };
  std::vector<FluteHeight> heights;
  for (double h = std::min(0.4 * R, top); h > 0; h = h < top ? std::min(h + R, top) : -1) {
    // Above the part, and rising from there on.
    const Vec3 at = point.centre + h * axis;
    if (chart.up(at) - h * angle_rad - R > part_.part().blank_top() &&
        (chart.sine == 0 || chart.up(at, axis) >= angle_rad))
      break;
    heights.push_back(measured(h));
    if (heights.back().spare() < 0) return false;
  }
  // The ball touches what it cuts: nothing to spare at its centre.
  FluteHeight below{0, flute_radius(0), flute_radius(0)};
  for (const FluteHeight& above : heights) {
    if (!flute_is_free_between(below, above, measured)) return false;
    below = above;
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

Leans OrientationCheck::about(const BallPass::Point& point, const Vec3& axis, double angle_rad, double clearance_mm,
                              double resolution_mm) const {
  if (angle_rad >= kWidestTurn) return Leans::mixed;
  if (!stands_right(point, axis, -angle_rad)) return Leans::none_clear;
  const double R = tool_.radius_mm(), told = std::max(0.0, clearance_mm - resolution_mm - part_.cell_sag_mm());
  const Vec3 tip = point.centre - R * axis;
  for (const auto& body : bodies_)
    if (const auto core = tool::turned_core(body, R, angle_rad))
      if (!tree_.keeps(*core, tip, axis, told, resolution_mm)) return Leans::none_clear;
  const bool all =
      stands_right(point, axis, angle_rad) &&
      std::all_of(bodies_.begin(), bodies_.end(),
                  [&](const tool::Frustum& body) {
                    return tree_.keeps(tool::turned_hull(body, R, angle_rad), tip, axis, clearance_mm, resolution_mm);
                  }) &&
      flute_is_free(point, axis, angle_rad);
  return all ? Leans::all_clear : Leans::mixed;
}

std::optional<OrientationCheck::Moment> OrientationCheck::not_kept(const Moment& from, const Moment& to,
                                                                   double clearance_mm) const {
  const double R = tool_.radius_mm(), way = (to.point.centre - from.point.centre).norm(),
               turn = angle_between(from.axis, to.axis);
  const Moment middle{0.5 * (from.at + to.at), blend_points(from.point, to.point, 0.5),
                      (from.axis + to.axis).normalized()};
  const Vec3 tip = middle.point.centre - R * middle.axis;
  // Every moment lies within half the way and half the turn of the middle; the centre leaves its line by `centre_sag`.
  const double off = 0.5 * way + 2 * centre_sag(R, turn);
  const bool kept = std::all_of(bodies_.begin(), bodies_.end(), [&](const tool::Frustum& body) {
    return tree_.keeps(tool::turned_hull(body, R, 0.5 * turn), tip, middle.axis, clearance_mm + off, kTightResolution);
  });
  if (kept) return {};
  if (!tree_.clear(bodies_, tip, middle.axis, clearance_mm, kTightResolution)) return middle;
  if (way + turn * tool_.stick_out_mm < kShortestWay) return {};
  if (const auto first = not_kept(from, middle, clearance_mm)) return first;
  return not_kept(middle, to, clearance_mm);
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
