#include "cam/cut/cut_surface.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "cam/cut/measured_places.h"
#include "cam/cut/swept_path.h"
#include "cam/cut/swept_tool.h"
#include "cam/cut/unreached.h"
#include "cam/proof/limits.h"
#include "geometry/base/golden_section.h"
#include "geometry/base/work_share.h"

namespace toothpath::cut {
namespace {

constexpr int kHistogramBins = 40;
constexpr int kCrestSteps = 10;  // of a golden section: a hundredth of what the samples leave

/// A line across the tooth space: the excess above the allowance from tip to tip.
struct LinePoint {
  tooth_space::Piece piece = tooth_space::Piece::root;
  double sigma = 0, left = 0;
};

constexpr std::size_t kLinePlaces = 32;  // that are asked for one after the other

/// Pieces of a space that the fine lines of a zone take as long as, and that finding all places does.
constexpr double kLinesWorth = 5, kPlacesWorth = 20;

class Meter {
 public:
  Meter(const analytic::GearDistance& part, const std::vector<path::ToolMotion>& motions,
        const std::vector<path::MillingOperation>& operations, const std::vector<tool::ProofTool>& tools,
        const CutSurfaceOptions& options, const RegionJudges& judges, const MeasuredPlaces& measured)
      : part_(part), operations_(operations), o_(options), judges_(judges), measured_(measured) {
    if (o_.cap_mm <= 0) o_.cap_mm = part.part().module_mm();
    for (std::size_t n = 0; n < operations.size(); ++n) {
      std::vector<path::ToolMotion> cuts;
      for (const auto& m : motions)
        if (m.operation == int(n) && m.tooth == 0) cuts.push_back(m);
      const tool::ProofTool& tool = tools[std::size_t(operations[n].tool)];
      paths_.push_back(std::make_unique<Removed>(std::move(cuts), tool, part.part().highest_z()));
    }
    for (std::size_t n = 0; n + 1 < operations.size(); ++n)
      if (operations[n].allowance_mm == operations.back().allowance_mm &&
          operations[n].type != path::OperationType::roughing)
        paths_.back()->also(paths_[n].get());
  }

  CutSurface run() {
    for (std::size_t zone = 0; zone < measured_.zones().size(); ++zone) {
      const MeasuredPlaces::Zone& places = measured_.zones()[zone];
      for (const PatchPlaces& patch : places.patches) grid(patch, int(zone));
      fine_lines(places, int(zone));
    }
    summarise();
    return std::move(out_);
  }

 private:
  /// @param answered  the motion of every path that was nearest at a place beside it
  [[nodiscard]] std::vector<float> excess_of(const Vec3& p, std::vector<std::size_t>& answered) const {
    std::vector<float> e;
    double least = o_.cap_mm;
    for (std::size_t n = 0; n < paths_.size(); ++n) {
      least = std::min(least, paths_[n]->excess(p, least, &answered[n]));
      e.push_back(float(least * 1000));
    }
    return e;
  }
  /// The operation that a region is judged by: the one that finishes it, else the last one.
  [[nodiscard]] const path::MillingOperation& last_in(path::Region region) const { return judges_.last_in(region); }
  [[nodiscard]] double ball_in(path::Region region) const { return judges_.ball_in(region); }
  [[nodiscard]] bool by_side(path::Region region) const { return judges_.by_side(region); }

  void grid(const PatchPlaces& patch, int zone) {
    proof::SurfaceGrid g;
    g.zone = zone;
    g.patch = patch.piece;
    g.rows = patch.rows;
    g.columns = patch.columns;
    const std::size_t count = patch.at.size();
    WorkShare share(g.columns);
    g.points.resize(count);
    g.normals.resize(count);
    g.reachable.assign(patch.reachable.begin(), patch.reachable.end());
    std::vector<std::vector<float>> excess(count);
    tbb::parallel_for(0, g.columns, [&](int column) {
      std::vector<std::size_t> answered(paths_.size(), SIZE_MAX);
      for (int row = 0; row < g.rows; ++row) {
        const std::size_t k = std::size_t(row) * std::size_t(g.columns) + std::size_t(column);
        if (!patch.at[k]) continue;
        g.points[k] = patch.at[k]->contact.p;
        g.normals[k] = patch.at[k]->contact.n;
        excess[k] = excess_of(g.points[k], answered);
      }
      share.add();
    });
    g.excess_um.assign(paths_.size(), std::vector<float>(count));
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t n = 0; n < excess[k].size(); ++n) g.excess_um[n][k] = excess[k][n];
    for (std::size_t k = 0; k < count && !paths_.empty(); ++k) {
      if (!patch.at[k]) continue;
      const double left = double(g.excess_um.back()[k]) / 1000;
      watch(g.points[k], path::region_of(patch.piece), left);
      if (!patch.reachable[k]) note_unreached(*patch.at[k], zone, left);
    }
    out_.grids.push_back(std::move(g));
  }

  /// Fine lines across the space, the ends of the ring among them: the greatest excess that a ball could have reached,
  /// what it could not reach, and the cusps between neighbouring passes.
  void fine_lines(const MeasuredPlaces::Zone& of, int zone) {
    WorkShare share(double(of.lines.size()), kLinesWorth);
    for (const LinePlaces& line : of.lines) {
      const auto points = line_across(line);
      if (!line.end) count_cusps(of.places, line.r, points);
      for (const auto& q : points) {
        const double x = q.left + operations_.back().allowance_mm;
        const path::Region region = path::region_of(q.piece);
        if (nearly(region, x))
          if (const auto s = of.places.at(q.sigma, line.r)) watch(s->contact.p, region, x);
        if (x <= std::min(line_max_[region], unreached_limit(region))) continue;
        const auto s = of.places.at(q.sigma, line.r);
        if (!s) continue;
        if (measured_.reachable(s->contact, region)) line_max_[region] = std::max(line_max_[region], x);
        else note_unreached(*s, zone, x);
      }
      share.add();
    }
  }

  [[nodiscard]] std::vector<LinePoint> line_across(const LinePlaces& line) const {
    std::vector<LinePoint> points(line.places.size());
    using Range = tbb::blocked_range<std::size_t>;
    tbb::parallel_for(Range(0, points.size(), kLinePlaces), [&](const Range& range) {
      std::size_t answered = SIZE_MAX;
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        const LinePlaces::Place& place = line.places[k];
        points[k] = {place.piece, place.sigma, left_on(place.p, &answered)};
      }
    });
    return points;
  }
  /// Material of the last operation above its allowance; 0 where there is no surface.
  [[nodiscard]] double left_at(const ZonePlaces& places, double sigma, double r) const {
    const auto s = places.at(sigma, r);
    return left_on(s ? std::optional(s->contact.p) : std::nullopt);
  }
  [[nodiscard]] double left_on(const std::optional<Vec3>& p, std::size_t* answered = nullptr) const {
    return p ? paths_.back()->excess(*p, o_.cap_mm, answered) - operations_.back().allowance_mm : 0;
  }

  void count_cusps(const ZonePlaces& places, double r, const std::vector<LinePoint>& line) {
    // Valleys are where the ball touched; a cusp is the highest place between two neighbouring valleys.
    std::vector<std::size_t> valleys;
    for (std::size_t k = 1; k + 1 < line.size(); ++k)
      if (line[k].left <= line[k - 1].left && line[k].left < line[k + 1].left) valleys.push_back(k);
    for (std::size_t v = 1; v < valleys.size(); ++v) {
      const LinePoint &a = line[valleys[v - 1]], &b = line[valleys[v]];
      const auto first = line.begin() + long(valleys[v - 1]);
      const auto top = std::max_element(first, line.begin() + long(valleys[v]),
                                        [](const auto& p, const auto& q) { return p.left < q.left; });
      const double valley = 0.5 * (a.left + b.left);
      const path::Region region = path::region_of(top->piece);
      if (by_side(region)) continue;
      const double wanted = last_in(region).scallop_in(region);
      if (top->left - valley < 0.02 * wanted) continue;  // two samples of one valley
      const auto [sigma, height] = crest(places, r, *(top - 1), *(top + 1));
      const auto s = places.at(sigma, r);
      if (!s || !measured_.reachable(s->contact, region)) continue;  // a corner that was left
      line_max_[region] = std::max(line_max_[region], height + operations_.back().allowance_mm);
      watch_crest(places, r, *(top - 1), *(top + 1), region, height + operations_.back().allowance_mm);
      const bool on_flank = is_flank(a.piece) && a.piece == b.piece;
      if (on_flank || by_side(path::Region::flank)) cusps_.push_back({height - valley, wanted});
      if (!on_flank) fillet_cusp_ = std::max(fillet_cusp_, height - valley);
    }
  }

  /// Is it missing little to what may stand?
  [[nodiscard]] bool nearly(path::Region region, double height) const {
    const double limit = unreached_limit(region);
    return o_.watch_mm > 0 && height <= limit && height + o_.watch_mm > limit;
  }
  void watch(const Vec3& p, path::Region region, double height) {
    if (nearly(region, height)) out_.watched.push_back({p, unreached_limit(region)});
  }
  /// On another tooth the crest is somewhere else between the same two places.
  void watch_crest(const ZonePlaces& places, double r, const LinePoint& before, const LinePoint& after,
                   path::Region region, double height) {
    for (int k = 0; k <= 2 * kCrestSteps && nearly(region, height); ++k)
      if (const auto s = places.at(before.sigma + (after.sigma - before.sigma) * k / (2 * kCrestSteps), r))
        watch(s->contact.p, region, height);
  }

  /// Place and height of the one crest between two neighbours of the highest sample: two arcs meet there, and a sample
  /// beside it lies up to 7 % of the cusp lower.
  [[nodiscard]] std::pair<double, double> crest(const ZonePlaces& places, double r, const LinePoint& before,
                                                const LinePoint& after) const {
    auto search = golden_section<std::greater<>>(before.sigma, after.sigma,
                                                 [&](double sigma) { return left_at(places, sigma, r); });
    for (int k = 0; k < kCrestSteps; ++k) search.step();
    return search.best();
  }

  /// Excess above which a place that the ball does not reach was left; no place is where the last operation does not
  /// finish.
  [[nodiscard]] double unreached_limit(path::Region region) const {
    if (operations_.empty() || !last_in(region).finishes()) return INFINITY;
    return proof::most_left_mm(last_in(region), region);
  }

  void note_unreached(const tooth_space::SheetPoint& s, int zone, double height) {
    if (height <= unreached_limit(path::region_of(s.piece))) return;
    auto& u = out_.unreached;
    u.height_mm = std::max(u.height_mm, height);
    if (!is_flank(s.piece) || !part_.space(zone).active(s.piece).hold(s.u, 0)) return;
    if (!u.active || height > u.active->height_mm)
      u.active = {height, zone, s.piece, std::hypot(s.contact.p.x(), s.contact.p.y()), s.contact.p.z()};
  }

  static void finish(proof::ExcessResult& r, const std::vector<float>& values_um) {
    r.points = values_um.size();
    if (values_um.empty()) return;
    double sum = 0;
    float low = values_um.front(), high = low;
    for (const float v : values_um) {
      sum += double(v) * double(v);
      low = std::min(low, v);
      high = std::max(high, v);
    }
    r.max_mm = double(high) / 1000;
    r.min_mm = double(low) / 1000;
    r.rms_mm = std::sqrt(sum / double(values_um.size())) / 1000;
    r.histogram_from_mm = r.min_mm;
    r.histogram_step_mm = std::max(r.max_mm - r.min_mm, 1e-9) / kHistogramBins;
    r.histogram.assign(kHistogramBins, 0);
    for (const float v : values_um) {
      const auto bin = std::size_t((double(v) / 1000 - r.histogram_from_mm) / r.histogram_step_mm);
      ++r.histogram[std::min(bin, std::size_t(kHistogramBins - 1))];
    }
  }

  void summarise() {
    out_.solve_residual_mm = measured_.solve_residual_mm();
    for (std::size_t n = 0; n < paths_.size(); ++n) {
      proof::ExcessResult r;
      r.operation = int(n);
      std::vector<float> values;
      path::ByRegion<double> most{{-INFINITY, -INFINITY, -INFINITY}}, least{{INFINITY, INFINITY, INFINITY}};
      for (const auto& g : out_.grids) {
        values.insert(values.end(), g.excess_um[n].begin(), g.excess_um[n].end());
        const path::Region region = path::region_of(g.patch);
        for (const float e : g.excess_um[n]) {
          most[region] = std::max(most[region], double(e) / 1000);
          least[region] = std::min(least[region], double(e) / 1000);
        }
      }
      finish(r, values);
      r.bound_mm = r.max_mm + operations_[n].scallop_mm + operations_[n].chord_tolerance_mm;
      out_.operations.push_back(r);
      out_.most_in_mm.push_back(most);
      out_.least_in_mm.push_back(least);
    }
    if (paths_.empty()) return;
    summarise_finished();
    judge_unreached();
    summarise_cusps();
  }

  void summarise_finished() {
    std::vector<float> values;
    out_.finished_in_mm = line_max_;
    for (const auto& g : out_.grids)
      for (std::size_t k = 0; k < g.points.size(); ++k) {
        const float e = g.excess_um.back()[k];
        if (g.reachable[k]) {
          values.push_back(e);
          double& most = out_.finished_in_mm[path::region_of(g.patch)];
          most = std::max(most, double(e) / 1000);
        } else if (g.normals[k] != Vec3::Zero()) {
          ++out_.unreached.points;
          out_.unreached.max_height_mm = std::max(out_.unreached.max_height_mm, double(e) / 1000);
        }
      }
    out_.finished.operation = int(paths_.size()) - 1;
    finish(out_.finished, values);
    for (const path::Region region : path::kRegions) {
      out_.finished.max_mm = std::max(out_.finished.max_mm, line_max_[region]);
      // Along a line the excess rises no faster than the slope at a cusp's foot, sqrt(2 h / R).
      const auto& op = last_in(region);
      const double rise = by_side(region) ? 0 : std::sqrt(2 * std::max(op.scallop_in(region), 0.0) / ball_in(region));
      slack_ = std::max(slack_, 0.5 * measured_.line_step_mm() * rise + op.chord_tolerance_mm);
    }
    out_.finished.bound_mm = out_.finished.max_mm + slack_;
    for (const path::Region region : path::kRegions)
      if (!by_side(region))
        out_.finished.bound_mm =
            std::max(out_.finished.bound_mm, along_normal(out_.finished_in_mm[region] + slack_, ball_in(region)));
  }

  /// What stands along the normal where no more than `e` stands towards the nearest ball: the two are apart at a crest,
  /// where the ball that touched the surface at the distance s left e = sqrt(R^2 + s^2) - R and stands R - sqrt(R^2 -
  /// s^2) above. Balls that do not meet above the crest leave whatever there was.
  [[nodiscard]] double along_normal(double e, double R) const {
    const double square = R * R - 2 * R * e - e * e;
    if (!(e > 0)) return e;
    return square > 0 ? R - std::sqrt(square) : std::max(e, o_.cap_mm);
  }

  void summarise_cusps() {
    out_.scallop.fillet_max_mm = fillet_cusp_;
    if (cusps_.empty()) return;
    auto& s = out_.scallop;
    const auto lower = [](const Cusp& a, const Cusp& b) { return a.height < b.height; };
    const path::Region region = by_side(path::Region::flank) ? path::Region::fillet : path::Region::flank;
    s.requested_mm = last_in(region).scallop_in(region);
    s.reached_min_mm = std::min_element(cusps_.begin(), cusps_.end(), lower)->height;
    s.reached_max_mm = std::max_element(cusps_.begin(), cusps_.end(), lower)->height;
    std::size_t within = 0;
    for (const auto& c : cusps_) within += c.height >= 0.85 * c.wanted && c.height <= 1.05 * c.wanted;
    s.share_within = double(within) / double(cusps_.size());
  }

  /// Share of the area that was left, and the ball that would not leave it. Told of the ball that finishes the fillets.
  void judge_unreached() {
    auto& u = out_.unreached;
    if (unreached_limit(path::Region::fillet) == INFINITY) return;
    const double R = ball_in(path::Region::fillet);
    u.ball_mm = 2 * R;
    u.limit_mm = unreached_limit(path::Region::fillet);
    double left = 0, all = 0;
    for (const auto& g : out_.grids) {
      const double limit = unreached_limit(path::region_of(g.patch));
      const auto columns = std::size_t(g.columns);
      for (std::size_t row = 0; row + 1 < std::size_t(g.rows); ++row)
        for (std::size_t column = 0; column + 1 < columns; ++column) {
          const std::size_t k = row * columns + column;
          const std::size_t corner[4] = {k, k + 1, k + columns + 1, k + columns};
          if (std::any_of(std::begin(corner), std::end(corner),
                          [&](std::size_t c) { return g.normals[c] == Vec3::Zero(); }))
            continue;
          const double area =
              0.5 * (g.points[corner[2]] - g.points[corner[0]]).cross(g.points[corner[3]] - g.points[corner[1]]).norm();
          all += area;
          for (const std::size_t c : corner)
            if (!g.reachable[c] && double(g.excess_um.back()[c]) / 1000 > limit) left += 0.25 * area;
        }
    }
    u.share = all > 0 ? left / all : 0;
    if (u.left()) u.largest_ball_mm = 2 * largest_reaching_ball(part_, R).radius_mm;
  }

  const analytic::GearDistance& part_;
  const std::vector<path::MillingOperation>& operations_;
  CutSurfaceOptions o_;
  std::vector<std::unique_ptr<Removed>> paths_;
  const RegionJudges& judges_;
  const MeasuredPlaces& measured_;
  struct Cusp {
    double height = 0, wanted = 0;
  };
  std::vector<Cusp> cusps_;
  path::ByRegion<double> line_max_;
  double fillet_cusp_ = 0, slack_ = 0;
  CutSurface out_;
};

}  // namespace

CutSurface measure_cut_surface(const analytic::GearDistance& part, const std::vector<path::ToolMotion>& motions,
                               const std::vector<path::MillingOperation>& operations,
                               const std::vector<tool::ToolAssembly>& tools, const CutSurfaceOptions& options) {
  return measure_cut_surface(part, motions, operations, tool::proof_tools(tools), options);
}

CutSurface measure_cut_surface(const analytic::GearDistance& part, const std::vector<path::ToolMotion>& motions,
                               const std::vector<path::MillingOperation>& operations,
                               const std::vector<tool::ProofTool>& tools, const CutSurfaceOptions& options) {
  return SurfaceMeter(part, operations, tools, options).measure(motions, options.watch_mm);
}

SurfaceMeter::SurfaceMeter(const analytic::GearDistance& part, const std::vector<path::MillingOperation>& operations,
                           const std::vector<tool::ProofTool>& tools, const CutSurfaceOptions& options)
    : part_(part), operations_(operations), tools_(tools), options_(options) {}

SurfaceMeter::~SurfaceMeter() = default;

CutSurface SurfaceMeter::measure(const std::vector<path::ToolMotion>& motions, double watch_mm) {
  WorkShare share(part_.zones() * (tooth_space::kPieces + kLinesWorth) + (places_ ? 0 : kPlacesWorth));
  if (!places_) {
    const WorkShare finding(1, kPlacesWorth);
    judges_ = std::make_unique<RegionJudges>(operations_, tools_);
    places_ = std::make_unique<MeasuredPlaces>(part_, *judges_, options_);
  }
  CutSurfaceOptions options = options_;
  options.watch_mm = watch_mm;
  return Meter(part_, motions, operations_, tools_, options, *judges_, *places_).run();
}

}  // namespace toothpath::cut
