#include "geometry/inspection/flank_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/base/angle.h"
#include "geometry/inspection/grid.h"

namespace toothpath::inspection {
namespace {

using tooth_space::ToothSpace;

/// A normal in a file and that of the flank: at least this cosine between them.
constexpr double kSameNormal = 0.5;
/// A second flank is another answer where it is not this much farther.
constexpr double kTwiceAsFar = 2, kAlike = 0.002;
constexpr std::size_t kHintPoints = 200;

/// A flank of one side of one ring in space 0, and where searches on it begin.
struct Sheet {
  int zone, side;
  const ToothSpace* space;
  struct Start {
    Vec3 p;
    double s, h, u, v;
  };
  std::vector<Start> starts;
};

/// What a point is to one sheet.
struct Candidate {
  FlankPoint point;
  double beyond = 0;  ///< by which the foot lies beyond the ends of the flank, mm; <= 0: on it
  std::string end;
  Vec3 n = Vec3::Zero();  ///< at the foot, on its tooth
};

class Placing {
 public:
  Placing(const tooth_space::ToothedSolid& gear, const std::vector<InspectionPoint>& grid, double ball_radius)
      : gear_(gear), ball_(ball_radius) {
    for (const auto& ring : gear.rings)
      for (const int side : {1, -1}) {
        Sheet sheet{ring.zone, side, ring.space, {}};
        for (const auto& p : grid) {
          if (p.zone != ring.zone || p.side != side) continue;
          const auto q = ring.space->point(tooth_space::flank_of(side), p.theta, p.B);
          if (!q) continue;
          const Vec3 x = q->p + ball_radius * q->n;
          sheet.starts.push_back({x, gear.chart().along(x), gear.chart().up(x), p.theta, p.B});
        }
        sheets_.push_back(std::move(sheet));
      }
  }

  /// Against every sheet that it can be measured from.
  [[nodiscard]] std::vector<Candidate> candidates(const Vec3& x, const std::optional<Vec3>& n) const {
    std::vector<Candidate> out;
    for (const Sheet& sheet : sheets_)
      if (const auto c = against(sheet, x); c && (!n || n->dot(c->n) >= kSameNormal)) out.push_back(*c);
    std::stable_sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) {
      return std::abs(a.point.deviation_mm) < std::abs(b.point.deviation_mm);
    });
    return out;
  }

  [[nodiscard]] static bool fits(const Candidate& c) {
    return c.beyond <= kBeyondFlank && std::abs(c.point.deviation_mm) <= kFarthestFromFlank;
  }

 private:
  [[nodiscard]] std::optional<Candidate> against(const Sheet& sheet, const Vec3& x) const {
    const auto& chart = gear_.chart();
    const double s = chart.along(x), h = chart.up(x), pitch = gear_.pitch();
    const Sheet::Start* start = nullptr;
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& q : sheet.starts)
      if (const double off = std::hypot(q.s - s, q.h - h); off < nearest) {
        nearest = off;
        start = &q;
      }
    const auto& outline = sheet.space->outline();
    if (!start || nearest > 0.5 * (outline.s_to - outline.s_from) + 2 * gear_.module_mm) return {};
    const double spaces = std::round((azimuth(x) - azimuth(start->p)) / pitch);
    const auto foot =
        sheet.space->foot(tooth_space::flank_of(sheet.side), turned(x, -spaces * pitch), start->u, start->v);
    if (!foot) return {};
    Candidate c;
    const int tooth = int(spaces) + (sheet.side > 0 ? 0 : 1);
    c.point = {sheet.zone,
               sheet.side,
               (tooth % gear_.teeth + gear_.teeth) % gear_.teeth,
               foot->u,
               foot->v,
               foot->at.p,
               foot->distance - ball_};
    c.n = turned(foot->at.n, spaces * pitch);
    note_ends(sheet, *foot, c);
    return c;
  }

  /// Which end of the flank the foot lies nearest to, or beyond.
  void note_ends(const Sheet& sheet, const tooth_space::PatchFoot& foot, Candidate& c) const {
    const auto& outline = sheet.space->outline();
    const double s = outline.chart.along(foot.at.p), station = outline.station(foot.at.p), mm_per_u = foot.at.pu.norm();
    const auto borders = sheet.space->borders(tooth_space::flank_of(sheet.side));
    const double fillet = sheet.side > 0 ? borders.to : borders.from, tip = sheet.side > 0 ? borders.from : borders.to;
    c.beyond = -std::numeric_limits<double>::infinity();
    const auto end = [&](double beyond, std::string name) {
      if (beyond > c.beyond) {
        c.beyond = beyond;
        c.end = std::move(name);
      }
    };
    end(outline.s_from - station, fmt::format("the {} end of the teeth", outline.from));
    end(station - outline.s_to, fmt::format("the {} end of the teeth", outline.to));
    end(outline.chart.up(foot.at.p) - sheet.space->tip(s), "the tip");
    const double down = tip > fillet ? -1 : 1;  // sense of u towards the fillet
    end(down * (foot.u - fillet) * mm_per_u, "the line where the fillet begins");
    if (gear_.flanks_begin) end(down * (*gear_.flanks_begin - foot.u) * mm_per_u, "the start of the flank");
  }

  const tooth_space::ToothedSolid& gear_;
  double ball_;
  std::vector<Sheet> sheets_;
};

std::vector<const FilePoint*> some_of(const PointFile& measured) {
  std::vector<const FilePoint*> out;
  const std::size_t step = measured.points.size() / kHintPoints + 1;
  for (std::size_t k = 0; k < measured.points.size(); k += step) out.push_back(&measured.points[k]);
  return out;
}

/// What would put all points onto flanks: another unit, centres of a ball.
std::string hint(const Placing& placing, const PointFile& measured) {
  const auto some = some_of(measured);
  struct Unit {
    double factor;
    const char* name;
  };
  for (const Unit unit : {Unit{25.4, "in inch"}, Unit{1 / 25.4, "multiplied by 25.4 once too often"},
                          Unit{1e-3, "in um"}, Unit{1000, "in m"}})
    if (std::all_of(some.begin(), some.end(), [&](const FilePoint* p) {
          const auto c = placing.candidates(unit.factor * p->p, p->n);
          return !c.empty() && Placing::fits(c.front());
        }))
      return fmt::format("; all places are {}: mm are needed", unit.name);
  constexpr double kSameOff = 0.1;
  for (const Candidate& first : placing.candidates(some.front()->p, some.front()->n)) {
    const double off = first.point.deviation_mm;
    if (off < 2 * kSameOff) continue;
    if (std::all_of(some.begin(), some.end(), [&](const FilePoint* p) {
          const auto all = placing.candidates(p->p, p->n);
          return std::any_of(all.begin(), all.end(),
                             [&](const Candidate& c) { return std::abs(c.point.deviation_mm - off) < kSameOff; });
        }))
      return fmt::format(
          "; all points stand about {:.2f} mm off their flanks: are they the centres of a ball of that "
          "radius?",
          off);
  }
  return {};
}

Diagnostic off_every_flank(const Placing& placing, const PointFile& measured, const FilePoint& p,
                           const std::vector<Candidate>& candidates) {
  std::string where = "lies where no flank of the gear can be measured";
  if (!candidates.empty()) {
    const Candidate* best = &candidates.front();
    for (const Candidate& c : candidates)
      if (std::max(c.beyond - kBeyondFlank, 0.0) + std::abs(c.point.deviation_mm) <
          std::max(best->beyond - kBeyondFlank, 0.0) + std::abs(best->point.deviation_mm))
        best = &c;
    const auto& q = best->point;
    const std::string flank = fmt::format("zone {}, tooth {}, flank {:+}", q.zone, q.tooth, q.side);
    where =
        std::abs(q.deviation_mm) > kFarthestFromFlank
            ? fmt::format("lies {:.4f} mm off the nearest flank ({}), at most {} mm", std::abs(q.deviation_mm), flank,
                          kFarthestFromFlank)
            : fmt::format("lies {:.4f} mm beyond {} ({}), at most {} mm", best->beyond, best->end, flank, kBeyondFlank);
  }
  std::string why = hint(placing, measured);
  if (why.empty()) why = ": a point of another surface, or of another job, gear frame or unit";
  return fail_at(p.at, "{}({:.4f}, {:.4f}, {:.4f}) {}{}", p.label.empty() ? "" : p.label + " ", p.p.x(), p.p.y(),
                 p.p.z(), where, why);
}

}  // namespace

Result<std::vector<FlankPoint>> place_on_flanks(const tooth_space::ToothedSolid& gear, const PointFile& measured,
                                                double ball_radius_mm) {
  const auto grid = inspection_grid(gear);
  if (!grid) return grid.error();
  const Placing placing(gear, *grid, ball_radius_mm);
  std::vector<FlankPoint> out;
  out.reserve(measured.points.size());
  for (const FilePoint& p : measured.points) {
    const auto candidates = placing.candidates(p.p, p.n);
    const Candidate *best = nullptr, *second = nullptr;
    for (const Candidate& c : candidates)
      if (Placing::fits(c) && !second) (best ? second : best) = &c;
    if (!best) return off_every_flank(placing, measured, p, candidates);
    const double off = std::abs(best->point.deviation_mm);
    if (second && std::abs(second->point.deviation_mm) < kTwiceAsFar * off + kAlike)
      return fail_at(p.at,
                     "{}({:.4f}, {:.4f}, {:.4f}) may lie on zone {}, tooth {}, flank {:+} ({:.4f} mm off) or on zone "
                     "{}, tooth {}, flank {:+} ({:.4f} mm off): state the normals i j k",
                     p.label.empty() ? "" : p.label + " ", p.p.x(), p.p.y(), p.p.z(), best->point.zone,
                     best->point.tooth, best->point.side, off, second->point.zone, second->point.tooth,
                     second->point.side, std::abs(second->point.deviation_mm));
    out.push_back(best->point);
  }
  return out;
}

}  // namespace toothpath::inspection
