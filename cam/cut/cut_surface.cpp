#include "cam/cut/cut_surface.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "cam/cut/swept_path.h"
#include "cam/cut/swept_tool.h"
#include "cam/cut/unreached.h"
#include "cam/cut/zone_places.h"
#include "cam/proof/limits.h"
#include "geometry/face_gear/shaper.h"

namespace toothpath::cut {
namespace {

// A point counts as reached when a ball that touches it comes no closer than this to anything else, mm.
constexpr double kReachTolerance = 1e-4;
constexpr double kSamePlace = 1e-6;  // a foot this near to a place of the grid is that place, mm
constexpr int kHistogramBins = 40;
constexpr int kCrestSteps = 10;     // of a golden section: a hundredth of what the samples leave
constexpr double kSharpEnd = 0.02;  // mm: diameter of the ball that stands for the corner of a flat cutter

/// A line across the tooth space: the excess above the allowance from tip to tip.
struct LinePoint {
  face_gear::SpacePiece piece = face_gear::SpacePiece::root;
  double sigma = 0, left = 0;
};

bool is_flank(face_gear::SpacePiece piece) {
  return piece == face_gear::SpacePiece::flank_plus || piece == face_gear::SpacePiece::flank_minus;
}

proof::Patch patch_of(face_gear::SpacePiece piece) {
  switch (piece) {
    case face_gear::SpacePiece::flank_plus: return proof::Patch::flank_plus;
    case face_gear::SpacePiece::fillet_plus: return proof::Patch::fillet_plus;
    case face_gear::SpacePiece::root: return proof::Patch::root;
    case face_gear::SpacePiece::fillet_minus: return proof::Patch::fillet_minus;
    case face_gear::SpacePiece::flank_minus: return proof::Patch::flank_minus;
  }
  return proof::Patch::root;
}

class Meter {
 public:
  Meter(const analytic::GearDistance& part, const std::vector<path::ToolMotion>& motions,
        const std::vector<path::MillingOperation>& operations, const std::vector<tool::ToolAssembly>& tools,
        const CutSurfaceOptions& options)
      : part_(part), operations_(operations), tools_(tools), o_(options) {
    if (o_.cap_mm <= 0) o_.cap_mm = part.gear().parameters().module_mm;
    for (std::size_t n = 0; n < operations.size(); ++n) {
      const double R = tools[std::size_t(operations[n].tool)].radius_mm();
      std::vector<BallMove> moves;
      for (const auto& m : motions)
        if (m.operation == int(n) && m.tooth == 0 && !m.rapid)
          moves.push_back({m.tip_from + R * m.axis_from, m.tip_to + R * m.axis_to});
      paths_.push_back(std::make_unique<Removed>(std::move(moves), R));
    }
  }
  /// @param bodies  of the same tools
  Meter(const analytic::GearDistance& part, const std::vector<path::ToolMotion>& motions,
        const std::vector<path::MillingOperation>& operations, const std::vector<tool::ToolAssembly>& tools,
        const std::vector<tool::ProofTool>& bodies, const CutSurfaceOptions& options)
      : Meter(part, {}, operations, tools, options) {
    paths_.clear();
    for (std::size_t n = 0; n < operations.size(); ++n) {
      std::vector<path::ToolMotion> cuts;
      for (const auto& m : motions)
        if (m.operation == int(n) && m.tooth == 0 && !m.rapid) cuts.push_back(m);
      paths_.push_back(
          std::make_unique<Removed>(std::move(cuts), bodies[std::size_t(operations[n].tool)], part.gear().blank_top()));
    }
    for (std::size_t n = 0; n + 1 < operations.size(); ++n)
      if (operations[n].allowance_mm == operations.back().allowance_mm &&
          operations[n].type != path::OperationType::roughing)
        paths_.back()->also(paths_[n].get());
  }

  CutSurface run() {
    const auto& gear = part_.gear().parameters();
    for (const auto& ring : part_.gear().rings())
      active_end_.push_back(face_gear::active_roll_parameter(gear, ring.zone.helix_angle_rad));
    for (int zone = 0; zone < part_.zones(); ++zone) {
      const ZonePlaces places(part_, zone);
      for (int piece = 0; piece < face_gear::kSpacePieces; ++piece) grid(places, zone, face_gear::SpacePiece(piece));
      if (!operations_.empty() && operations_.back().scallop_mm > 0) fine_lines(places, zone);
    }
    summarise();
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::vector<float> excess_of(const Vec3& p) const {
    std::vector<float> e;
    double least = o_.cap_mm;
    for (const auto& path : paths_) {
      least = std::min(least, path->excess(p, least));
      e.push_back(float(least * 1000));
    }
    return e;
  }
  [[nodiscard]] bool reachable(const face_gear::PatchPoint& s, double* residual = nullptr) const {
    if (operations_.empty()) return true;
    const double R = tools_[std::size_t(operations_.back().tool)].radius_mm();
    const auto q = part_.nearest(s.p + R * s.n, R + 0.01);
    // Where the foot is the place itself, the two solvers must agree.
    if (residual && q.exact && (q.foot - s.p).norm() < kSamePlace) *residual = std::abs(q.distance - R);
    return q.distance >= R - kReachTolerance;
  }

  void grid(const ZonePlaces& places, int zone, face_gear::SpacePiece piece) {
    proof::SurfaceGrid g;
    g.zone = zone;
    g.patch = patch_of(piece);
    const bool flank = is_flank(piece);
    g.rows = flank ? o_.flank_rows : piece == face_gear::SpacePiece::root ? o_.root_rows : o_.fillet_rows;
    g.columns = o_.columns;
    const std::size_t count = std::size_t(g.rows) * std::size_t(g.columns);
    g.points.resize(count);
    g.normals.resize(count);
    g.reachable.resize(count);
    std::vector<std::vector<float>> excess(count);
    std::vector<double> residual(count, 0.0);
    std::vector<std::optional<face_gear::SheetPoint>> left(count);
    tbb::parallel_for(0, g.columns, [&](int column) {
      const double r = places.radius(double(column) / (g.columns - 1));
      const auto [from, to] = places.range(piece, r);
      for (int row = 0; row < g.rows; ++row) {
        const std::size_t k = std::size_t(row) * std::size_t(g.columns) + std::size_t(column);
        const auto s = places.at(from + (to - from) * row / (g.rows - 1), r);
        if (!s) continue;
        g.points[k] = s->contact.p;
        g.normals[k] = s->contact.n;
        excess[k] = excess_of(s->contact.p);
        g.reachable[k] = reachable(s->contact, &residual[k]);
        if (!g.reachable[k]) left[k] = s;
      }
    });
    g.excess_um.assign(paths_.size(), std::vector<float>(count));
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t n = 0; n < excess[k].size(); ++n) g.excess_um[n][k] = excess[k][n];
    for (std::size_t k = 0; k < count; ++k)
      if (left[k]) note_unreached(*left[k], zone, double(g.excess_um.back()[k]) / 1000);
    out_.solve_residual_mm = std::max(out_.solve_residual_mm, *std::max_element(residual.begin(), residual.end()));
    out_.grids.push_back(std::move(g));
  }

  /// Fine lines across the space, the ends of the ring among them: the greatest excess that a ball could have reached,
  /// what it could not reach, and the cusps between neighbouring passes.
  void fine_lines(const ZonePlaces& places, int zone) {
    for (int line = 0; line <= o_.scallop_lines + 1; ++line) {
      const bool end = line == 0 || line == o_.scallop_lines + 1;
      const double r = places.radius(end ? double(line > 0) : (line - 0.5) / o_.scallop_lines);
      const auto points = line_across(places, r);
      if (!end) count_cusps(places, r, points);
      for (const auto& q : points) {
        const double x = q.left + operations_.back().allowance_mm;
        if (x <= std::min(line_max_, unreached_limit())) continue;
        const auto s = places.at(q.sigma, r);
        if (!s) continue;
        if (reachable(s->contact)) line_max_ = std::max(line_max_, x);
        else note_unreached(*s, zone, x);
      }
    }
  }

  [[nodiscard]] std::vector<LinePoint> line_across(const ZonePlaces& places, double r) {
    const auto& op = operations_.back();
    const double step = std::sqrt(8 * tools_[std::size_t(op.tool)].radius_mm() * op.scallop_mm) / 24;
    std::vector<LinePoint> points;
    for (int piece = 0; piece < face_gear::kSpacePieces; ++piece) {
      const auto [from, to] = places.range(face_gear::SpacePiece(piece), r);
      const auto a = places.at(from, r), b = places.at(to, r);
      if (!a || !b) continue;
      const double length = (b->contact.p - a->contact.p).norm();
      const int n = std::max(16, int(1.2 * length / step));
      line_step_ = std::max(line_step_, length / n);
      // Where two pieces join one point is enough.
      for (int k = points.empty() ? 0 : 1; k <= n; ++k)
        points.push_back({face_gear::SpacePiece(piece), from + (to - from) * k / n, 0});
    }
    tbb::parallel_for(std::size_t(0), points.size(),
                      [&](std::size_t k) { points[k].left = left_at(places, points[k].sigma, r); });
    return points;
  }
  /// Material of the last operation above its allowance; 0 where there is no surface.
  [[nodiscard]] double left_at(const ZonePlaces& places, double sigma, double r) const {
    const auto s = places.at(sigma, r);
    return s ? paths_.back()->excess(s->contact.p, o_.cap_mm) - operations_.back().allowance_mm : 0;
  }

  void count_cusps(const ZonePlaces& places, double r, const std::vector<LinePoint>& line) {
    const double wanted = operations_.back().scallop_mm;
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
      if (top->left - valley < 0.02 * wanted) continue;  // two samples of one valley
      const auto [sigma, height] = crest(places, r, *(top - 1), *(top + 1));
      const auto s = places.at(sigma, r);
      if (!s || !reachable(s->contact)) continue;  // a corner that was left
      line_max_ = std::max(line_max_, height + operations_.back().allowance_mm);
      if (is_flank(a.piece) && a.piece == b.piece) cusps_.push_back(height - valley);
      else fillet_cusp_ = std::max(fillet_cusp_, height - valley);
    }
  }

  /// Place and height of the one crest between two neighbours of the highest sample: two arcs meet there, and a sample
  /// beside it lies up to 7 % of the cusp lower.
  [[nodiscard]] std::pair<double, double> crest(const ZonePlaces& places, double r, const LinePoint& before,
                                                const LinePoint& after) const {
    constexpr double kGolden = 0.6180339887498949;
    double a = before.sigma, b = after.sigma;
    double x = b - kGolden * (b - a), y = a + kGolden * (b - a), f = left_at(places, x, r), g = left_at(places, y, r);
    for (int k = 0; k < kCrestSteps; ++k) {
      if (f > g) {
        b = y;
        y = x;
        g = f;
        x = b - kGolden * (b - a);
        f = left_at(places, x, r);
      } else {
        a = x;
        x = y;
        f = g;
        y = a + kGolden * (b - a);
        g = left_at(places, y, r);
      }
    }
    return f > g ? std::pair{x, f} : std::pair{y, g};
  }

  /// Excess above which a place that the ball does not reach was left; no place is where the last operation does not
  /// finish.
  [[nodiscard]] double unreached_limit() const {
    if (operations_.empty() || operations_.back().type != path::OperationType::finishing) return INFINITY;
    return proof::most_left_mm(operations_.back());
  }

  void note_unreached(const face_gear::SheetPoint& s, int zone, double height) {
    if (height <= unreached_limit()) return;
    auto& u = out_.unreached;
    u.height_mm = std::max(u.height_mm, height);
    if (!is_flank(s.piece) || s.u > active_end_[std::size_t(zone)]) return;
    if (!u.active || height > u.active->height_mm)
      u.active = {height, zone, patch_of(s.piece), std::hypot(s.contact.p.x(), s.contact.p.y()), s.contact.p.z()};
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
    for (std::size_t n = 0; n < paths_.size(); ++n) {
      proof::ExcessResult r;
      r.operation = int(n);
      std::vector<float> values;
      for (const auto& g : out_.grids) values.insert(values.end(), g.excess_um[n].begin(), g.excess_um[n].end());
      finish(r, values);
      r.bound_mm = r.max_mm + operations_[n].scallop_mm + operations_[n].chord_tolerance_mm;
      out_.operations.push_back(r);
    }
    if (paths_.empty()) return;
    std::vector<float> values;
    for (const auto& g : out_.grids)
      for (std::size_t k = 0; k < g.points.size(); ++k) {
        const float e = g.excess_um.back()[k];
        if (g.reachable[k]) {
          values.push_back(e);
        } else if (g.normals[k] != Vec3::Zero()) {
          ++out_.unreached.points;
          out_.unreached.max_height_mm = std::max(out_.unreached.max_height_mm, double(e) / 1000);
        }
      }
    judge_unreached();
    const auto& op = operations_.back();
    const double R = tools_[std::size_t(op.tool)].radius_mm();
    out_.finished.operation = int(paths_.size()) - 1;
    finish(out_.finished, values);
    // Along a line the excess rises no faster than the slope at a cusp's foot, sqrt(2 h / R).
    out_.finished.max_mm = std::max(out_.finished.max_mm, line_max_);
    out_.finished.bound_mm = out_.finished.max_mm + 0.5 * line_step_ * std::sqrt(2 * std::max(op.scallop_mm, 0.0) / R) +
                             op.chord_tolerance_mm;
    out_.scallop.fillet_max_mm = fillet_cusp_;
    if (!cusps_.empty()) {
      auto& s = out_.scallop;
      s.requested_mm = op.scallop_mm;
      s.reached_min_mm = *std::min_element(cusps_.begin(), cusps_.end());
      s.reached_max_mm = *std::max_element(cusps_.begin(), cusps_.end());
      std::size_t within = 0;
      for (const double c : cusps_) within += c >= 0.85 * op.scallop_mm && c <= 1.05 * op.scallop_mm;
      s.share_within = double(within) / double(cusps_.size());
    }
  }

  /// Share of the area that was left, and the ball that would not leave it.
  void judge_unreached() {
    auto& u = out_.unreached;
    if (unreached_limit() == INFINITY) return;
    const double R = tools_[std::size_t(operations_.back().tool)].radius_mm();
    u.ball_mm = 2 * R;
    u.limit_mm = unreached_limit();
    double left = 0, all = 0;
    for (const auto& g : out_.grids) {
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
            if (!g.reachable[c] && double(g.excess_um.back()[c]) / 1000 > u.limit_mm) left += 0.25 * area;
        }
    }
    u.share = all > 0 ? left / all : 0;
    if (u.left()) u.largest_ball_mm = 2 * largest_reaching_ball(part_, R).radius_mm;
  }

  const analytic::GearDistance& part_;
  const std::vector<path::MillingOperation>& operations_;
  const std::vector<tool::ToolAssembly>& tools_;
  CutSurfaceOptions o_;
  std::vector<std::unique_ptr<Removed>> paths_;
  std::vector<double> cusps_;
  std::vector<double> active_end_;  ///< roll parameter at the end of the active flank, a zone each
  double line_step_ = 0, line_max_ = 0, fillet_cusp_ = 0;
  CutSurface out_;
};

}  // namespace

CutSurface measure_cut_surface(const analytic::GearDistance& part, const std::vector<path::ToolMotion>& motions,
                               const std::vector<path::MillingOperation>& operations,
                               const std::vector<tool::ToolAssembly>& tools, const CutSurfaceOptions& options) {
  return Meter(part, motions, operations, tools, options).run();
}

CutSurface measure_cut_surface(const analytic::GearDistance& part, const std::vector<path::ToolMotion>& motions,
                               const std::vector<path::MillingOperation>& operations,
                               const std::vector<tool::ProofTool>& tools, const CutSurfaceOptions& options) {
  std::vector<tool::ToolAssembly> balls;
  for (const auto& t : tools) {
    balls.push_back(t.ball_mill.value_or(tool::ToolAssembly{}));
    if (!t.ball_mill)
      balls.back().diameter_mm = std::max(kSharpEnd, t.cutting.empty() ? 0.0 : 2 * t.cutting.front().round);
  }
  return Meter(part, motions, operations, balls, tools, options).run();
}

}  // namespace toothpath::cut
