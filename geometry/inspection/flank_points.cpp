#include "geometry/inspection/flank_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/base/angle.h"
#include "geometry/face_gear/flank_foot.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/part.h"
#include "geometry/inspection/grid.h"

namespace toothpath::inspection {
namespace {

using Parameters = face_gear::FlankParameters<double>;

/// A normal in a file and that of the flank: at least this cosine between them.
constexpr double kSameNormal = 0.5;
/// A second flank is another answer where it is not this much farther.
constexpr double kTwiceAsFar = 2, kAlike = 0.002;
constexpr std::size_t kHintPoints = 200;

/// A flank of one side of one ring, and where searches on it begin.
struct Sheet {
  int zone, side;
  const face_gear::FaceGearRing* ring;
  struct Start {
    double r, z;
    Parameters at;
  };
  std::vector<Start> starts;
};

/// What a point is to one sheet.
struct Candidate {
  FlankPoint point;
  double beyond = 0;  ///< by which the foot lies beyond the ends of the flank, mm; <= 0: on it
  const char* end = "";
  Vec3 n = Vec3::Zero();  ///< at the foot, on its tooth
};

class Placing {
 public:
  Placing(const face_gear::FaceGear& gear, const std::vector<InspectionPoint>& grid, double ball_radius)
      : gear_(gear), ball_(ball_radius) {
    for (std::size_t zone = 0; zone < gear.rings().size(); ++zone)
      for (const int side : {1, -1}) {
        Sheet sheet{int(zone), side, &gear.rings()[zone], {}};
        const auto& shaper = sheet.ring->surface.shaper;
        for (const auto& p : grid) {
          if (p.zone != int(zone) || p.side != side) continue;
          const Vec3 q = p.p + ball_radius * p.n;
          sheet.starts.push_back({radius(q), q.z(), {p.theta - ball_radius * shaper.cos_bb / shaper.r_b, p.B}});
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
    const auto& f = sheet.ring->surface;
    const double r = radius(x);
    const Sheet::Start* start = nullptr;
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& s : sheet.starts)
      if (const double off = std::hypot(s.r - r, s.z - x.z()); off < nearest) {
        nearest = off;
        start = &s;
      }
    if (!start || nearest > 0.5 * (gear_.outer_radius() - gear_.inner_radius()) + 2 * f.shaper.m_t) return {};
    const auto foot = face_gear::flank_foot<double>(f, sheet.side, x, start->at);
    if (!foot) return {};
    const double teeth = std::round(foot->turn / f.pitch), turn = foot->turn - teeth * f.pitch;
    const int count = gear_.parameters().teeth;
    const double distance = sheet.side * f.M2 * turn;
    Candidate c;
    c.point = {sheet.zone,
               sheet.side,
               ((int(teeth) % count) + count) % count,
               foot->at.theta + distance * f.shaper.cos_bb / f.shaper.r_b,
               foot->at.B,
               0,
               distance - ball_};
    c.n = foot->n;
    const Vec3 p = f.flank_housing(sheet.side, c.point.theta, c.point.B);
    c.point.radius_mm = radius(p);
    if (!(f.flank_J(sheet.side, c.point.theta, c.point.B) > 0)) return {};
    note_ends(*sheet.ring, p, c);
    return c;
  }

  /// Which end of the flank the foot lies nearest to, or beyond.
  void note_ends(const face_gear::FaceGearRing& ring, const Vec3& p, Candidate& c) const {
    const auto& f = ring.surface;
    const double r = c.point.radius_mm, arc = f.shaper.r_b * f.shaper.theta_t;  // of the involute where it ends
    c.beyond = -std::numeric_limits<double>::infinity();
    const auto end = [&](double beyond, const char* name) {
      if (beyond > c.beyond) {
        c.beyond = beyond;
        c.end = name;
      }
    };
    end(ring.zone.inner_radius_mm - r, "the inner end of the teeth");
    end(r - ring.zone.outer_radius_mm, "the outer end of the teeth");
    if (r > std::abs(f.E)) end(p.z() - f.z_tip(r), "the tip");
    end((c.point.theta - f.shaper.theta_t) * arc, "the line where the fillet begins");
    end(-c.point.theta * arc, "the start of the involute");
  }

  const face_gear::FaceGear& gear_;
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

Result<std::vector<FlankPoint>> place_on_flanks(const face_gear::FaceGear& gear, const PointFile& measured,
                                                double ball_radius_mm) {
  const auto grid = inspection_grid(drawn_solid(gear));
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
