#include "cam/gouge_check.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "cam/tool_body.h"

namespace toothpath {
namespace {

constexpr double kLook = 0.12;      // mm beyond the ball within which distances are wanted exactly
constexpr double kFirstLevel = 0.3; // height of the first flute level above the ball centre, in ball radii
constexpr int kDepth = 24;

/// Least distance on a straight move of length L between places with distances d0 and d1 (lower bounds).
double between(double d0, double d1, double L) {
  if (d0 <= 0 || d1 <= 0) return std::min(d0, d1);
  const double g0 = d0 * d0, g1 = d1 * d1;
  // g(s) = g0 + (g1 - g0) s/L - s (L - s), a parabola that opens upwards.
  const double s = std::clamp(0.5 * (L - (g1 - g0) / std::max(L, 1e-300)), 0.0, L);
  const double g = g0 + (L > 0 ? (g1 - g0) * s / L : 0) - s * (L - s);
  return g > 0 ? std::sqrt(g) : 0;
}

struct Slot {
  double measured = -INFINITY, bound = -INFINITY, clearance = INFINITY;
  bool rapid_clear = true;
  std::size_t queries = 0;
  NearestPlace deepest;
  const char* body = "ball";
  WorstPlace body_place;
};

/// One motion against the part.
class MotionCheck {
 public:
  MotionCheck(const GearDistance& part, const ToolAssembly& tool, const GougeCheckOptions& options, const ToolMotion& m)
      : part_(part), tool_(tool), o_(options), m_(m), R_(tool.radius_mm()), within_(R_ + kLook) {}

  Slot run() {
    const double turn = (m_.axis_to - m_.axis_from).norm();
    slack_ = m_.deviation_mm + R_ * (m_.axis_deviation + turn * turn / 8);
    if (m_.rapid) check_rapid();
    bodies();
    const Vec3 a = centre(0), b = centre(1);
    const auto qa = query(a), qb = query(b);
    ball(0, 1, qa, qb, kDepth);
    flute();
    return slot_;
  }

 private:
  [[nodiscard]] Vec3 axis(double t) const { return ((1 - t) * m_.axis_from + t * m_.axis_to).normalized(); }
  [[nodiscard]] Vec3 tip(double t) const { return (1 - t) * m_.tip_from + t * m_.tip_to; }
  [[nodiscard]] Vec3 centre(double t) const { return tip(t) + R_ * axis(t); }

  NearestPlace query(const Vec3& c) {
    ++slot_.queries;
    return part_.nearest(c, within_);
  }
  void note(const NearestPlace& q, const char* body) {
    const double depth = R_ - q.distance;
    if (depth > slot_.measured) {
      slot_.measured = depth;
      slot_.deepest = q;
      slot_.body = body;
    }
  }

  /// A wreck need not be measured to a fraction of a micrometre: how far its bound may lie above what was seen.
  [[nodiscard]] double leeway(double seen) const { return seen > 50 * o_.gouge_tolerance_mm ? 0.25 * seen : 0; }

  /// Is a proven least distance good enough? Yes where it is free, or where it is close to what was seen in contact.
  [[nodiscard]] bool settled(double least, double corner, double seen) const {
    if (R_ - least + slack_ <= 0) return true;
    return R_ - least <= seen + o_.proof_mm + leeway(seen) && corner < R_ + slack_ + 2 * o_.proof_mm;
  }

  void ball(double t0, double t1, const NearestPlace& q0, const NearestPlace& q1, int depth) {
    note(q0, "ball");
    note(q1, "ball");
    const double L = (centre(t1) - centre(t0)).norm() + 2 * slack_;
    const double least = between(q0.distance, q1.distance, L);
    const double seen = std::max(R_ - std::min(q0.distance, q1.distance), 0.0);
    if (settled(least, std::min(q0.distance, q1.distance), seen) || depth == 0 || L < 1e-6) {
      slot_.bound = std::max(slot_.bound, R_ - least + slack_);
      near_flute(t0, t1, q0, q1);
      return;
    }
    const double t = 0.5 * (t0 + t1);
    const auto q = query(centre(t));
    ball(t0, t, q0, q, depth - 1);
    ball(t, t1, q, q1, depth - 1);
  }

  /// The flute from the ball centre up to its first level, on a leaf of the ball's proof.
  void near_flute(double t0, double t1, const NearestPlace& q0, const NearestPlace& q1) {
    const double level = std::min(kFirstLevel * R_, tool_.flute_length_mm - R_);
    if (level <= 0) return;
    const auto p0 = query(centre(t0) + level * axis(t0)), p1 = query(centre(t1) + level * axis(t1));
    note(p0, "flute");
    note(p1, "flute");
    patch(t0, t1, 0, level, q0.distance, q1.distance, p0.distance, p1.distance, kDepth);
  }
  /// A rectangle of points on the tool axis, t0..t1 along the move and h0..h1 above the ball centre; corner distances d_th.
  /// d^2 - |x|^2 is concave on it too: d^2 >= (blend of the corners) - L^2/4 - h (H - h).
  void patch(double t0, double t1, double h0, double h1, double d00, double d10, double d01, double d11, int depth) {
    const double L = (centre(t1) - centre(t0)).norm() + 2 * slack_, H = h1 - h0;
    const double low = std::min(d00, d10), high = std::min(d01, d11);
    const double upward = std::max(between(low, high, H), 0.0), g = upward * upward - L * L / 4;
    const double least = g > 0 ? std::sqrt(g) : 0;
    const double seen = std::max(R_ - std::min(low, high), 0.0);
    if (settled(least, std::min(low, high), seen) || depth == 0 || std::max(L, H) < 1e-6) {
      slot_.bound = std::max(slot_.bound, R_ - least + slack_);
      return;
    }
    if (H >= L) {
      const double h = 0.5 * (h0 + h1);
      const double a = at(t0, h), b = at(t1, h);
      patch(t0, t1, h0, h, d00, d10, a, b, depth - 1);
      patch(t0, t1, h, h1, a, b, d01, d11, depth - 1);
    } else {
      const double t = 0.5 * (t0 + t1);
      const double a = at(t, h0), b = at(t, h1);
      patch(t0, t, h0, h1, d00, a, d01, b, depth - 1);
      patch(t, t1, h0, h1, a, d10, b, d11, depth - 1);
    }
  }
  double at(double t, double h) {
    const auto q = query(centre(t) + h * axis(t));
    note(q, h > 0 ? "flute" : "ball");
    return q.distance;
  }

  /// The flute above its first level, in slabs: there is room, so that most need no more than their corners.
  void flute() {
    const double level = std::min(kFirstLevel * R_, tool_.flute_length_mm - R_), top = tool_.flute_length_mm - R_;
    if (top <= level) return;
    const double L = (centre(1) - centre(0)).norm() + 2 * slack_;
    double h = level, low_0 = at(0, h), low_1 = at(1, h);
    while (h < top) {
      const Vec3 a = centre(0) + h * axis(0);
      if (a.z() - R_ > part_.gear().blank_top() + L && axis(0).z() > 0.5) break;  // above the part from here on
      const double next = std::min(h + 0.5 * R_, top);
      const double high_0 = at(0, next), high_1 = at(1, next);
      patch(0, 1, h, next, low_0, low_1, high_0, high_1, kDepth);
      h = next;
      low_0 = high_0;
      low_1 = high_1;
    }
  }
  void bodies() {
    for (const auto& body : shank_and_holder(tool_)) body_interval(body, 0, 1, 14);
  }
  void body_interval(const Frustum& body, double t0, double t1, int depth) {
    const double t = 0.5 * (t0 + t1);
    const double reach = 0.5 * (tip(t1) - tip(t0)).norm() + (axis(t1) - axis(t0)).norm() * body.to + m_.deviation_mm +
                         m_.axis_deviation * body.to;
    const double enough = o_.clearance_mm + reach + 0.5;
    const auto gap = body_gap(part_, body, tip(t), axis(t), enough, 0.02);
    if (gap.gap - reach < o_.clearance_mm && reach > 0.005 && depth > 0 && gap.gap > 0) {
      body_interval(body, t0, t, depth - 1);
      body_interval(body, t, t1, depth - 1);
      return;
    }
    if (gap.gap - reach < slot_.clearance) {
      slot_.clearance = gap.gap - reach;
      slot_.body_place.body = body.name;
      slot_.body_place.depth_mm = -slot_.clearance;
      slot_.body_place.zone = gap.zone;
      slot_.body_place.point = gap.place;
      slot_.body_place.patch = "tooth";
    }
  }

  void check_rapid() {
    // Every body stays above the blank, or wholly inside the inner or outside the outer radius.
    const auto clear_at = [&](double t) {
      const Vec3 p = tip(t), u = axis(t);
      double low = p.z() - m_.deviation_mm;
      double widest = R_, top = tool_.flute_length_mm;
      for (const auto& body : shank_and_holder(tool_)) {
        low = std::min(low, lowest_z(body, p, u));
        widest = std::max({widest, body.radius_from, body.radius_to});
        top = std::max(top, body.to);
      }
      low = std::min(low, (p + R_ * u).z() - R_);
      if (low >= o_.rapid_height_mm - 1e-6) return true;
      const Vec3 q = p + u * top;
      const double r0 = std::hypot(p.x(), p.y()), r1 = std::hypot(q.x(), q.y());
      const double outer = part_.gear().outer_radius(), inner = part_.gear().inner_radius();
      if (std::max(r0, r1) + widest < inner) return true;
      // Outside: the whole axis must be, not only its ends.
      const double along = u.head<2>().norm() > 1e-12 ? -p.head<2>().dot(u.head<2>()) / u.head<2>().squaredNorm() : 0.0;
      const Vec3 nearest = p + u * std::clamp(along, 0.0, top);
      return std::hypot(nearest.x(), nearest.y()) - widest > outer;
    };
    const double length = (m_.tip_to - m_.tip_from).norm() + 100 * (m_.axis_to - m_.axis_from).norm();
    const int steps = std::clamp(int(std::ceil(length / 0.5)), 1, 4000);
    for (int k = 0; k <= steps; ++k)
      if (!clear_at(double(k) / steps)) {
        slot_.rapid_clear = false;
        return;
      }
  }

  const GearDistance& part_;
  const ToolAssembly& tool_;
  const GougeCheckOptions& o_;
  const ToolMotion& m_;
  double R_, within_, slack_ = 0;
  Slot slot_;
};

WorstPlace place_of(const NearestPlace& q, const ToolMotion& m, double depth, const char* body) {
  WorstPlace w;
  w.depth_mm = depth;
  w.body = body;
  w.patch = q.patch;
  w.operation = m.operation;
  w.tooth = m.tooth;
  w.zone = q.zone;
  w.line = m.line;
  w.radius_mm = std::hypot(q.foot.x(), q.foot.y());
  w.height_mm = q.foot.z();
  w.point = q.foot;
  return w;
}

}  // namespace

GougeCheck::GougeCheck(const GearDistance& part, std::vector<ToolAssembly> tools, GougeCheckOptions options)
    : part_(part), tools_(std::move(tools)), options_(options) {}

GougeResult GougeCheck::check(const std::vector<ToolMotion>& motions, const std::vector<int>& tool_of_operation) const {
  std::vector<Slot> slots(motions.size());
  tbb::parallel_for(std::size_t(0), motions.size(), [&](std::size_t k) {
    const auto& m = motions[k];
    const auto& tool = tools_[std::size_t(tool_of_operation[std::size_t(m.operation)])];
    slots[k] = MotionCheck(part_, tool, options_, m).run();
  });
  GougeResult out;
  out.measured_mm = out.bound_mm = -INFINITY;
  out.clearance_mm = INFINITY;
  out.required_clearance_mm = options_.clearance_mm;
  out.motions = motions.size();
  for (std::size_t k = 0; k < slots.size(); ++k) {
    const auto& s = slots[k];
    const auto& m = motions[k];
    out.distance_queries += s.queries;
    if (s.measured > out.measured_mm) {
      out.measured_mm = s.measured;
      out.deepest = place_of(s.deepest, m, s.measured, s.body);
    }
    if (s.bound > out.bound_mm) {
      out.bound_mm = s.bound;
      out.bound_line = m.line;
    }
    if (std::max(s.measured, s.bound) > options_.gouge_tolerance_mm)
      out.worst.push_back(place_of(s.deepest, m, std::max(s.measured, s.bound), s.body));
    const auto body = [&](const char* name) {
      WorstPlace w = s.body_place;
      w.operation = m.operation;
      w.tooth = m.tooth;
      w.line = m.line;
      w.radius_mm = std::hypot(w.point.x(), w.point.y());
      w.height_mm = w.point.z();
      if (*name) w.body = name;
      return w;
    };
    if (s.clearance < out.clearance_mm) out.clearance_mm = s.clearance;
    if (s.clearance < options_.clearance_mm) out.worst.push_back(body(""));
    if (!s.rapid_clear) {
      out.rapids_clear = false;
      WorstPlace w = place_of(s.deepest, m, 0, "rapid");
      w.patch = "blank";
      out.worst.push_back(w);
    }
  }
  std::stable_sort(out.worst.begin(), out.worst.end(),
                   [](const WorstPlace& a, const WorstPlace& b) { return a.depth_mm > b.depth_mm; });
  if (out.worst.size() > 20) out.worst.resize(20);
  return out;
}

bool GougeCheck::passes(const GougeResult& r) const {
  return r.bound_mm <= options_.gouge_tolerance_mm && r.measured_mm <= options_.gouge_tolerance_mm &&
         r.clearance_mm >= options_.clearance_mm && r.rapids_clear;
}

std::vector<ToolMotion> GougeCheck::motions_of(const ClPath& path) {
  std::vector<ToolMotion> out;
  for (std::size_t k = 1; k < path.records.size(); ++k) {
    const auto &a = path.records[k - 1], &b = path.records[k];
    ToolMotion m;
    m.tip_from = a.tip;
    m.tip_to = b.tip;
    m.axis_from = a.axis;
    m.axis_to = b.axis;
    m.rapid = b.kind == MoveKind::rapid;
    m.minutes = m.rapid || b.feed_mm_min <= 0 ? 0 : (b.tip - a.tip).norm() / b.feed_mm_min;
    m.operation = path.operation;
    m.line = int(k);
    out.push_back(m);
  }
  return out;
}

Result<CheckedClPath> GougeCheck::check_path(ClPath path) const {
  std::vector<int> tool_of_operation(std::size_t(path.operation) + 1, path.tool);
  const auto r = check(motions_of(path), tool_of_operation);
  if (passes(r)) return CheckedClPath(std::move(path));
  if (!r.worst.empty()) {
    const auto& w = r.worst.front();
    if (w.body == "rapid")
      return fail_as(DiagnosticKind::verification, "operation {} ({}): the rapid to CL record {} runs through the blank",
                     path.operation, path.operation_type, w.line);
    if (w.body == "shank" || w.body == "holder")
      return fail_as(DiagnosticKind::verification,
                     "operation {} ({}), CL record {}: the {} of tool {} comes within {:.4f} mm of the teeth at radius {:.3f}, "
                     "height {:.3f}; the clearance is {:.4f}",
                     path.operation, path.operation_type, w.line, w.body, tools_[std::size_t(path.tool)].number, -w.depth_mm,
                     w.radius_mm, w.height_mm, options_.clearance_mm);
    return fail_as(DiagnosticKind::verification,
                   "operation {} ({}), CL record {}: the {} cuts {:.4f} mm (bound) into {} of zone {} at radius {:.3f}, height "
                   "{:.3f}; the gouge tolerance is {:.4f}",
                   path.operation, path.operation_type, w.line, w.body, w.depth_mm, w.patch, w.zone, w.radius_mm, w.height_mm,
                   options_.gouge_tolerance_mm);
  }
  return fail_as(DiagnosticKind::verification, "operation {} ({}) is not proven free of gouges", path.operation,
                 path.operation_type);
}

}  // namespace toothpath
