#include "cam/analytic/cut_surface.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "cam/analytic/swept_path.h"
#include "cam/analytic/swept_tool.h"

namespace toothpath::analytic {
namespace {

// A point counts as reached when a ball that touches it comes no closer than this to anything else, mm.
constexpr double kReachTolerance = 1e-4;
constexpr double kSamePlace = 1e-6;  // a foot this near to a place of the grid is that place, mm
constexpr int kHistogramBins = 40;
constexpr double kSharpEnd = 0.02;  // mm: diameter of the ball that stands for the corner of a flat cutter

struct Sample {
  Vec3 p, n;
};

/// Places on the sheet of one zone at contact radius r.
class ZonePlaces {
 public:
  ZonePlaces(const GearDistance& part, int zone)
      : space_(part.space(zone)),
        sheet_(space_, 0.0, space_.ring().zone.inner_radius_mm, space_.ring().zone.outer_radius_mm, 49) {}

  [[nodiscard]] double radius(double share) const {
    const auto& z = space_.ring().zone;
    return std::clamp(z.inner_radius_mm + share * (z.outer_radius_mm - z.inner_radius_mm), sheet_.r_from(), sheet_.r_to());
  }
  [[nodiscard]] std::optional<Sample> at(double sigma, double r) const {
    const auto s = sheet_.raw(sigma, r);
    if (!s) return {};
    return Sample{s->contact.p, s->contact.n};
  }
  /// sigma where the flank leaves through the tip surface.
  [[nodiscard]] double tip_sigma(bool plus, double r) const {
    const double z_tip = space_.surface().z_tip(r);
    double out = plus ? 0.0 : 5.0, in = plus ? 1.0 : 4.0;
    const auto above = [&](double sigma) {
      const auto s = at(sigma, r);
      return !s || s->p.z() > z_tip;
    };
    if (!above(out)) return out;
    for (int k = 0; k < 40; ++k) {
      const double m = 0.5 * (out + in);
      (above(m) ? out : in) = m;
    }
    return in;
  }
  [[nodiscard]] std::pair<double, double> range(face_gear::SpacePiece piece, double r) const {
    switch (piece) {
      case face_gear::SpacePiece::flank_plus: return {tip_sigma(true, r), 1.0};
      case face_gear::SpacePiece::fillet_plus: return {1.0, 2.0};
      case face_gear::SpacePiece::root: return {2.0, 3.0};
      case face_gear::SpacePiece::fillet_minus: return {3.0, 4.0};
      case face_gear::SpacePiece::flank_minus: return {4.0, tip_sigma(false, r)};
    }
    return {0, 0};
  }

 private:
  const face_gear::SpaceSheet& space_;
  face_gear::OffsetSheet sheet_;
};

class Meter {
 public:
  Meter(const GearDistance& part, const std::vector<path::ToolMotion>& motions, const std::vector<path::MillingOperation>& operations,
        const std::vector<tool::ToolAssembly>& tools, const CutSurfaceOptions& options)
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
  Meter(const GearDistance& part, const std::vector<path::ToolMotion>& motions, const std::vector<path::MillingOperation>& operations,
        const std::vector<tool::ToolAssembly>& tools, const std::vector<tool::ProofTool>& bodies, const CutSurfaceOptions& options)
      : Meter(part, {}, operations, tools, options) {
    paths_.clear();
    for (std::size_t n = 0; n < operations.size(); ++n) {
      std::vector<path::ToolMotion> cuts;
      for (const auto& m : motions)
        if (m.operation == int(n) && m.tooth == 0 && !m.rapid) cuts.push_back(m);
      paths_.push_back(std::make_unique<Removed>(std::move(cuts), bodies[std::size_t(operations[n].tool)], part.gear().blank_top()));
    }
    for (std::size_t n = 0; n + 1 < operations.size(); ++n)
      if (operations[n].allowance_mm == operations.back().allowance_mm && operations[n].type != path::OperationType::roughing) paths_.back()->also(paths_[n].get());
  }

  CutSurface run() {
    for (int zone = 0; zone < part_.zones(); ++zone) {
      const ZonePlaces places(part_, zone);
      for (int piece = 0; piece < face_gear::kSpacePieces; ++piece) grid(places, zone, face_gear::SpacePiece(piece));
      if (!operations_.empty() && operations_.back().scallop_mm > 0) fine_lines(places);
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
  [[nodiscard]] bool reachable(const Sample& s, double* residual = nullptr) const {
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
    g.patch = to_string(piece);
    const bool flank = piece == face_gear::SpacePiece::flank_plus || piece == face_gear::SpacePiece::flank_minus;
    g.rows = flank ? o_.flank_rows : piece == face_gear::SpacePiece::root ? o_.root_rows : o_.fillet_rows;
    g.columns = o_.columns;
    const std::size_t count = std::size_t(g.rows) * std::size_t(g.columns);
    g.points.resize(count);
    g.normals.resize(count);
    g.reachable.resize(count);
    std::vector<std::vector<float>> excess(count);
    std::vector<double> residual(count, 0.0);
    tbb::parallel_for(0, g.columns, [&](int column) {
      const double r = places.radius(double(column) / (g.columns - 1));
      const auto [from, to] = places.range(piece, r);
      for (int row = 0; row < g.rows; ++row) {
        const std::size_t k = std::size_t(row) * std::size_t(g.columns) + std::size_t(column);
        const auto s = places.at(from + (to - from) * row / (g.rows - 1), r);
        if (!s) continue;
        g.points[k] = s->p;
        g.normals[k] = s->n;
        excess[k] = excess_of(s->p);
        g.reachable[k] = reachable(*s, &residual[k]);
      }
    });
    g.excess_um.assign(paths_.size(), std::vector<float>(count));
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t n = 0; n < excess[k].size(); ++n) g.excess_um[n][k] = excess[k][n];
    out_.solve_residual_mm = std::max(out_.solve_residual_mm, *std::max_element(residual.begin(), residual.end()));
    out_.grids.push_back(std::move(g));
  }

  /// Fine lines across the space, the ends of the ring among them: the greatest excess that a ball could have reached, and on the
  /// flanks the cusps between neighbouring passes.
  void fine_lines(const ZonePlaces& places) {
    const auto& op = operations_.back();
    const double R = tools_[std::size_t(op.tool)].radius_mm();
    const double step = std::sqrt(8 * R * op.scallop_mm) / 24;
    for (int line = 0; line <= o_.scallop_lines + 1; ++line) {
      const bool end = line == 0 || line == o_.scallop_lines + 1;
      const double r = places.radius(end ? double(line > 0) : (line - 0.5) / o_.scallop_lines);
      for (int piece = 0; piece < face_gear::kSpacePieces; ++piece) {
        const auto [from, to] = places.range(face_gear::SpacePiece(piece), r);
        const auto a = places.at(from, r), b = places.at(to, r);
        if (!a || !b) continue;
        const int n = std::max(16, int(1.2 * (b->p - a->p).norm() / step));
        std::vector<double> e(std::size_t(n) + 1, 0.0);
        tbb::parallel_for(0, n + 1, [&](int k) {
          const auto s = places.at(from + (to - from) * k / n, r);
          if (s) e[std::size_t(k)] = paths_.back()->excess(s->p, o_.cap_mm) - op.allowance_mm;
        });
        const bool flank = piece == 0 || piece == face_gear::kSpacePieces - 1;
        if (flank && !end) count_cusps(e, op.scallop_mm);
        line_step_ = std::max(line_step_, (b->p - a->p).norm() / n);
        for (int k = 0; k <= n; ++k) {
          const double x = e[std::size_t(k)] + op.allowance_mm;
          if (x <= line_max_) continue;
          const auto s = places.at(from + (to - from) * k / n, r);
          if (s && reachable(*s)) line_max_ = x;
        }
      }
    }
  }

  void count_cusps(const std::vector<double>& e, double wanted) {
    // Valleys are where the ball touched; a cusp is the highest place between two neighbouring valleys.
    std::vector<std::size_t> valleys;
    for (std::size_t k = 1; k + 1 < e.size(); ++k)
      if (e[k] <= e[k - 1] && e[k] < e[k + 1]) valleys.push_back(k);
    for (std::size_t v = 1; v < valleys.size(); ++v) {
      const double top = *std::max_element(e.begin() + long(valleys[v - 1]), e.begin() + long(valleys[v]));
      const double height = top - 0.5 * (e[valleys[v - 1]] + e[valleys[v]]);
      if (height < 0.02 * wanted) continue;  // two samples of one valley
      cusps_.push_back(height);
    }
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
        } else {
          ++out_.unreached.points;
          out_.unreached.max_height_mm = std::max(out_.unreached.max_height_mm, double(e) / 1000);
        }
      }
    const auto& op = operations_.back();
    const double R = tools_[std::size_t(op.tool)].radius_mm();
    out_.finished.operation = int(paths_.size()) - 1;
    finish(out_.finished, values);
    // Along a line the excess rises no faster than the slope at a cusp's foot, sqrt(2 h / R).
    out_.finished.max_mm = std::max(out_.finished.max_mm, line_max_);
    out_.finished.bound_mm = out_.finished.max_mm + 0.5 * line_step_ * std::sqrt(2 * std::max(op.scallop_mm, 0.0) / R) +
                             op.chord_tolerance_mm;
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

  const GearDistance& part_;
  const std::vector<path::MillingOperation>& operations_;
  const std::vector<tool::ToolAssembly>& tools_;
  CutSurfaceOptions o_;
  std::vector<std::unique_ptr<Removed>> paths_;
  std::vector<double> cusps_;
  double line_step_ = 0, line_max_ = 0;
  CutSurface out_;
};

}  // namespace

CutSurface measure_cut_surface(const GearDistance& part, const std::vector<path::ToolMotion>& motions,
                               const std::vector<path::MillingOperation>& operations, const std::vector<tool::ToolAssembly>& tools,
                               const CutSurfaceOptions& options) {
  return Meter(part, motions, operations, tools, options).run();
}

CutSurface measure_cut_surface(const GearDistance& part, const std::vector<path::ToolMotion>& motions, const std::vector<path::MillingOperation>& operations,
                               const std::vector<tool::ProofTool>& tools, const CutSurfaceOptions& options) {
  std::vector<tool::ToolAssembly> balls;
  for (const auto& t : tools) {
    balls.push_back(t.ball_mill.value_or(tool::ToolAssembly{}));
    if (!t.ball_mill) balls.back().diameter_mm = std::max(kSharpEnd, t.cutting.empty() ? 0.0 : 2 * t.cutting.front().round);
  }
  return Meter(part, motions, operations, balls, tools, options).run();
}

}  // namespace toothpath::analytic
