#include "postproc/joints/pole.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "postproc/numbers/pole_geometry.h"

namespace toothpath::joints {
namespace {

constexpr double kPoleTurn = radians(30);     // of the azimuth in one block, or in one way through the cone
constexpr double kPoleRatio = 4;              // and more than this multiple of the turn of the tool
constexpr double kAzimuthStep = radians(20);  // of the blocks that are made
constexpr double kLeastTilt = 1e-7;           // rad from the pole: keeps the azimuth determined
constexpr double kTurnLength = 20;            // mm per rad: how turns count in the length along the path
constexpr double kReachable = 1e-9;           // rad: the second rotary takes the tool to the pole
constexpr double kFlat = 0.3;                 // cosine between tool and gear axis below which a retract leaves sideways
constexpr int kBisections = 60;

/// A stretch of one pass inside the cone; s counts records, with the fraction of the step.
struct Stretch {
  double s_in = 0, s_out = 0, nearest_s = 0, least = 0;
  double turned = 0, greatest_step = 0;
  bool steep = false, open_in = false, open_out = false;
};

class Handler {
 public:
  Handler(const path::ClPath& path, const Vec3& pole, const PoleRules& rules)
      : path_(path), f_(pole), rules_(rules), cone_(rules.change_rad / 2) {}

  /// Appends the records [first, last) of one pass to `out`.
  std::optional<Diagnostic> pass(std::size_t first, std::size_t last, PolePath& out) {
    first_ = first;
    last_ = last;
    find();
    if (auto bad = judge()) return bad;
    write(out);
    return std::nullopt;
  }

 private:
  const path::ClRecord& rec(std::size_t i) const { return path_.records[i]; }
  std::size_t step_of(double s) const { return std::min(static_cast<std::size_t>(s), last_ - 2); }
  Vec3 axis_at(double s) const {
    if (last_ - first_ < 2) return rec(first_).axis;
    const std::size_t i = step_of(s);
    return numbers::blend_axes(rec(i).axis, rec(i + 1).axis, s - static_cast<double>(i));
  }
  Vec3 tip_at(double s) const {
    if (last_ - first_ < 2) return rec(first_).tip;
    const std::size_t i = step_of(s);
    const double t = s - static_cast<double>(i);
    return (1 - t) * rec(i).tip + t * rec(i + 1).tip;
  }

  /// Where the arc of step i crosses the cone between two of its parameters, one inside and one outside.
  double crossing(std::size_t i, double inside, double outside) const {
    for (int k = 0; k < kBisections; ++k) {
      const double middle = 0.5 * (inside + outside);
      (f_.theta(numbers::blend_axes(rec(i).axis, rec(i + 1).axis, middle)) <= cone_ ? inside : outside) = middle;
    }
    return inside;
  }

  static bool steep(const numbers::PoleArc& a) {
    return std::abs(a.azimuth) > kPoleTurn && std::abs(a.azimuth) > kPoleRatio * a.turn;
  }

  void find() {
    arcs_.clear();
    stretches_.clear();
    for (std::size_t i = first_; i + 1 < last_; ++i) {
      const numbers::PoleArc a = numbers::pole_arc(f_, rec(i).axis, rec(i + 1).axis);
      arcs_.push_back(a);
      if (a.least > cone_) continue;
      const double base = static_cast<double>(i);
      const double in = f_.theta(rec(i).axis) <= cone_ ? 0 : crossing(i, a.at, 0),
                   out = f_.theta(rec(i + 1).axis) <= cone_ ? 1 : crossing(i, a.at, 1);
      if (stretches_.empty() || in > 0 || stretches_.back().s_out < base) {
        stretches_.push_back({});
        stretches_.back().s_in = base + in;
        stretches_.back().least = 1e9;
        stretches_.back().open_in = i == first_ && in == 0;
      }
      Stretch& s = stretches_.back();
      s.s_out = base + out;
      s.open_out = i + 2 == last_ && out == 1;
      s.steep = s.steep || steep(a);
      s.turned += std::abs(a.azimuth);
      s.greatest_step = std::max(s.greatest_step, std::abs(a.azimuth));
      if (a.least < s.least) {
        s.least = a.least;
        s.nearest_s = base + a.at;
      }
    }
    for (auto& s : stretches_) {
      const double across =
          s.open_in || s.open_out ? 0 : std::abs(wrapped(f_.phi(axis_at(s.s_out)) - f_.phi(axis_at(s.s_in))));
      s.turned = std::max(s.turned, across);
    }
    // Ways through the cone that need nothing are left as they are.
    std::erase_if(stretches_, [](const Stretch& s) { return !s.steep && s.turned <= kPoleTurn; });
  }

  /// Steep arcs on the way into the cone or out of it belong to the way through.
  bool leads_to_cone(std::size_t k) const {
    for (std::size_t i = k; i < arcs_.size() && steep(arcs_[i]); ++i)
      if (arcs_[i].least <= cone_) return true;
    for (std::size_t i = k + 1; i-- > 0 && steep(arcs_[i]);)
      if (arcs_[i].least <= cone_) return true;
    return false;
  }

  Diagnostic passes(std::size_t i, double least, double turned, const std::string& advice) const {
    return fail(
        "operation {} record {}: the tool axis passes the pole at {:.4f} deg, {} turns by {:.3f} deg in one block, "
        "limit {:.0f}: {}",
        path_.operation, i, degrees(least), rules_.letter, degrees(turned), degrees(kPoleTurn), advice);
  }

  /// What helps where `tilt` cannot: the plan is not its own.
  const char* instead_of_tilt() const {
    return rules_.ball
               ? "directions that are fixed or prescribed by tool_axis are not moved; change them or lower "
                 "post.pole_angle, or take \"slow\", \"hold\", \"through\" or \"retract\", or mount the part inclined"
               : "the axis of a finger mill follows from its flank and is not moved; \"slow\" (follows it exactly, at "
                 "the speed of the rotary) and \"retract\" (turns outside the part) serve finger mills, or mount the "
                 "part inclined";
  }

  std::optional<Diagnostic> judge() const {
    if (rules_.option == machines::PoleOption::tilt) {
      std::size_t worst = arcs_.size();
      for (std::size_t k = 0; k < arcs_.size(); ++k)
        if (arcs_[k].turn > 1e-9 && arcs_[k].least < rules_.keep_rad - 1e-6 &&
            (worst == arcs_.size() || arcs_[k].least < arcs_[worst].least))
          worst = k;
      if (worst < arcs_.size())
        return fail(
            "operation {} record {}: the tool axis comes to {:.4f} deg of the pole of {}, post.pole = \"tilt\" keeps "
            "{:.4f}: {}",
            path_.operation, first_ + worst + 1, degrees(arcs_[worst].least), rules_.letter, degrees(rules_.keep_rad),
            instead_of_tilt());
    }
    const bool changes = rules_.option == machines::PoleOption::hold ||
                         rules_.option == machines::PoleOption::through ||
                         rules_.option == machines::PoleOption::retract;
    const bool refuses = rules_.option == machines::PoleOption::error || rules_.option == machines::PoleOption::tilt;
    const std::string ways =
        rules_.ball
            ? "post.pole = \"slow\", \"hold\", \"through\" or \"retract\" goes past it, or mount the part inclined"
            : "post.pole = \"slow\" or \"retract\" goes past it with a finger mill, or mount the part inclined";
    for (const auto& s : stretches_) {
      const auto i = static_cast<std::size_t>(std::ceil(s.nearest_s));
      if (refuses) return passes(std::max(i, first_ + 1), s.least, std::max(s.greatest_step, s.turned), ways);
      if ((rules_.option == machines::PoleOption::hold || rules_.option == machines::PoleOption::through) &&
          !rules_.ball)
        return passes(i, s.least, s.greatest_step,
                      "\"hold\" and \"through\" move the axis of ball tools only; \"slow\" and \"retract\" serve any");
    }
    for (std::size_t k = 0; k < arcs_.size(); ++k) {
      if (!steep(arcs_[k]) || leads_to_cone(k)) continue;
      if (refuses) return passes(first_ + k + 1, arcs_[k].least, std::abs(arcs_[k].azimuth), ways);
      if (changes)
        return passes(first_ + k + 1, arcs_[k].least, std::abs(arcs_[k].azimuth),
                      fmt::format("post.pole_angle = {:.4f} deg moves the axis from a path within {:.4f} deg of the "
                                  "pole only; \"slow\" follows it exactly",
                                  degrees(rules_.change_rad), degrees(cone_)));
    }
    return std::nullopt;
  }

  // Writing.
  void add(PolePath& out, const path::ClRecord& r, std::size_t source, bool cone, bool switches = false) const {
    out.path.records.push_back(r);
    out.source.push_back(static_cast<std::int32_t>(source));
    out.in_cone.push_back(cone ? 1 : 0);
    out.switches.push_back(switches ? 1 : 0);
  }
  path::ClRecord at(double s, const Vec3& axis) const {
    path::ClRecord r = rec(static_cast<std::size_t>(std::ceil(s - 1e-12)));
    r.tip = tip_at(s) + rules_.ball_radius_mm * (axis_at(s) - axis);
    r.axis = axis;
    return r;
  }

  /// Exact points between two parameters (both left out) of a steep step, so that the azimuth turns by no more than
  /// kAzimuthStep in one.
  void write_between(double s0, double s1, PolePath& out) const {
    const std::size_t i = step_of(s0);
    if (!steep(arcs_[i - first_])) return;
    const double phi0 = f_.phi(axis_at(s0)), across = wrapped(f_.phi(axis_at(s1)) - phi0);
    const int n = static_cast<int>(std::ceil(std::abs(across) / kAzimuthStep));
    for (int j = 1; j < n; ++j) {
      double low = s0, high = s1;
      for (int k = 0; k < kBisections; ++k) {
        const double middle = 0.5 * (low + high);
        (std::abs(wrapped(f_.phi(axis_at(middle)) - phi0)) < std::abs(across) * j / n ? low : high) = middle;
      }
      add(out, at(low, axis_at(low)), i + 1, false);
    }
  }

  struct Node {
    double s = 0, f = 0;  // f: share of the way through the cone
  };
  std::vector<Node> nodes_of(const Stretch& st, double extra_share) const {
    std::vector<Node> nodes{{st.s_in, 0}};
    for (double s = std::floor(st.s_in) + 1; s < st.s_out; s += 1) nodes.push_back({s, 0});
    nodes.push_back({st.s_out, 0});
    double length = 0;
    for (std::size_t k = 1; k < nodes.size(); ++k) {
      length += (tip_at(nodes[k].s) - tip_at(nodes[k - 1].s)).norm() +
                kTurnLength * numbers::angle_between_axes(axis_at(nodes[k].s), axis_at(nodes[k - 1].s)) + 1e-12;
      nodes[k].f = length;
    }
    for (auto& n : nodes) n.f /= length;
    if (extra_share > 0)
      for (std::size_t k = 1; k < nodes.size(); ++k)
        if (nodes[k - 1].f < extra_share && nodes[k].f > extra_share) {
          const double t = (extra_share - nodes[k - 1].f) / (nodes[k].f - nodes[k - 1].f);
          nodes.insert(nodes.begin() + static_cast<std::ptrdiff_t>(k),
                       Node{(1 - t) * nodes[k - 1].s + t * nodes[k].s, extra_share});
          break;
        }
    return nodes;
  }
  /// Nodes between two neighbours so that an azimuth that turns by `across` over the stretch goes in steps.
  static void refine(std::vector<Node>& nodes, double across) {
    std::vector<Node> fine{nodes.front()};
    for (std::size_t k = 1; k < nodes.size(); ++k) {
      const int n =
          std::max(1, static_cast<int>(std::ceil(std::abs(across) * (nodes[k].f - nodes[k - 1].f) / kAzimuthStep)));
      for (int j = 1; j <= n; ++j) {
        const double t = static_cast<double>(j) / n;
        fine.push_back({(1 - t) * nodes[k - 1].s + t * nodes[k].s, (1 - t) * nodes[k - 1].f + t * nodes[k].f});
      }
    }
    nodes = std::move(fine);
  }
  /// The axis at s on the meridian phi: the nearest to the planned one on its side of the pole.
  Vec3 on_meridian(double s, double phi) const {
    const Vec3 u = axis_at(s);
    const double theta = f_.theta(u);
    const double along = theta > numbers::kNoAzimuth ? theta * std::cos(f_.phi(u) - phi) : 0;
    return f_.axis(std::clamp(along, kLeastTilt, std::max(cone_, kLeastTilt)), phi);
  }

  void write_stretch(const Stretch& st, PolePath& out) const {
    ++out.passages;
    double phi_in = st.open_in ? 0 : f_.phi(axis_at(st.s_in)), phi_out = st.open_out ? 0 : f_.phi(axis_at(st.s_out));
    if (st.open_in && st.open_out) phi_in = phi_out = f_.phi(axis_at(farthest(st)));
    else if (st.open_in) phi_in = phi_out;
    else if (st.open_out) phi_out = phi_in;
    const bool closed = !st.open_in && !st.open_out;
    if (closed && rules_.option == machines::PoleOption::through) return write_through(st, phi_in, phi_out, out);
    if (closed && rules_.option == machines::PoleOption::retract) return write_retract(st, phi_in, phi_out, out);
    const double across = wrapped(phi_out - phi_in);
    auto nodes = nodes_of(st, 0);
    refine(nodes, across);
    for (std::size_t k = 0; k < nodes.size(); ++k)
      add_node(out, nodes[k].s, on_meridian(nodes[k].s, phi_in + nodes[k].f * across), k > 0);
  }
  void add_node(PolePath& out, double s, const Vec3& axis, bool cone, bool switches = false) const {
    add(out, at(s, axis), static_cast<std::size_t>(std::ceil(s - 1e-12)), cone, switches);
  }
  double farthest(const Stretch& st) const {
    double best = st.s_in;
    for (double s = std::ceil(st.s_in); s <= st.s_out; s += 1)
      if (f_.theta(axis_at(s)) > f_.theta(axis_at(best))) best = s;
    return best;
  }

  void write_through(const Stretch& st, double phi_in, double phi_out, PolePath& out) const {
    const double across = wrapped(phi_out + kPi - phi_in);
    auto nodes = nodes_of(st, 0.5);
    refine(nodes,
           2 * across);  // on the pole itself C keeps the angle of the record before: the step behind it has both turns
    const double theta = f_.theta(axis_at(st.s_in));
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const double side = theta * (1 - 2 * nodes[k].f), phi = phi_in + nodes[k].f * across;
      const bool on_pole = std::abs(nodes[k].f - 0.5) < 1e-12;
      add_node(out, nodes[k].s, on_pole ? f_.pole : f_.axis(std::abs(side), side >= 0 ? phi : phi + kPi), k > 0,
               on_pole);
    }
  }

  void write_retract(const Stretch& st, double phi_in, double phi_out, PolePath& out) const {
    auto nodes = nodes_of(st, 0);
    const double s_m = std::clamp(st.nearest_s, st.s_in, st.s_out);
    for (std::size_t k = 0; k < nodes.size() && nodes[k].s < s_m - 1e-9; ++k)
      add_node(out, nodes[k].s, on_meridian(nodes[k].s, phi_in), k > 0);
    const Vec3 before = on_meridian(s_m, phi_in), after = on_meridian(s_m, phi_out);
    add_node(out, s_m, before, true);
    const auto outside = [&](const Vec3& axis, path::MoveKind kind) {
      path::ClRecord r = at(s_m, axis);
      r.tip += way_out(r.tip, axis) * axis;
      r.kind = kind;
      if (kind == path::MoveKind::rapid) r.feed_mm_min = 0;
      add(out, r, static_cast<std::size_t>(std::ceil(s_m - 1e-12)), false);
    };
    outside(before, path::MoveKind::retract);
    outside(after, path::MoveKind::rapid);
    add_node(out, s_m, after, false);
    out.path.records.back().kind = path::MoveKind::engage;
    for (const auto& n : nodes)
      if (n.s > s_m + 1e-9) add_node(out, n.s, on_meridian(n.s, phi_out), true);
  }
  /// Length along the axis until the tip is outside the clearance body and its margin.
  double way_out(const Vec3& tip, const Vec3& axis) const {
    const double margin = rules_.margin_mm + rules_.ball_radius_mm;
    double length = 1;
    if (std::abs(axis.z()) >= kFlat) {
      const double top = axis.z() > 0 ? rules_.body.z_max_mm + margin : rules_.body.z_min_mm - margin;
      return std::max(length, (top - tip.z()) / axis.z());
    }
    const double r = rules_.body.radius_mm + margin, flat = axis.head<2>().squaredNorm(),
                 b = tip.head<2>().dot(axis.head<2>());
    const double c = tip.head<2>().squaredNorm() - r * r;
    return c < 0 ? std::max(length, (-b + std::sqrt(b * b - flat * c)) / flat) : length;
  }

  void write(PolePath& out) const {
    const double end = static_cast<double>(last_) - 1;
    double done = static_cast<double>(first_) - 1;  // everything up to here is written
    for (const auto& st : stretches_) {
      write_plain(done, st.s_in, false, out);
      write_stretch(st, out);
      done = st.s_out;
    }
    if (done < end) write_plain(done, end, true, out);
  }
  /// The given records behind s0 and before s1, and points of steep steps between them.
  void write_plain(double s0, double s1, bool with_end, PolePath& out) const {
    double s = s0;
    while (s < s1) {
      const double next = std::floor(s) + 1, to = std::min(next, s1);
      if (s >= static_cast<double>(first_)) write_between(s, to, out);
      if (next < s1 || (next == s1 && with_end))
        add(out, rec(static_cast<std::size_t>(next)), static_cast<std::size_t>(next), false);
      s = to;
    }
  }

  const path::ClPath& path_;
  numbers::PoleFrame f_;
  const PoleRules& rules_;
  double cone_;
  std::size_t first_ = 0, last_ = 0;
  std::vector<numbers::PoleArc> arcs_;
  std::vector<Stretch> stretches_;
};

/// The pole that a pass comes nearest to: one pass comes to one pole, they lie 180 deg apart.
Vec3 nearest_pole(const path::ClPath& path, std::size_t first, std::size_t last, std::span<const Vec3> poles) {
  Vec3 best = poles.front();
  double least = 1e9;
  for (const Vec3& p : poles)
    for (std::size_t i = first; i < last; ++i)
      if (const double a = numbers::angle_between_axes(path.records[i].axis, p); a < least) {
        least = a;
        best = p;
      }
  return best;
}

}  // namespace

std::vector<Vec3> poles_of(const machines::KinematicChain& chain) {
  std::vector<Vec3> poles;
  if (chain.rotary_count() != 2) return poles;
  const Vec3 &d1 = chain.rotary(0).direction, &d2 = chain.rotary(1).direction;
  const double cone = numbers::angle_between_axes(Vec3::UnitZ(), d2);
  for (const Vec3& p : {d1, Vec3(-d1)})
    if (std::abs(numbers::angle_between_axes(p, d2) - cone) <= kReachable) poles.push_back(p);
  return poles;
}

Result<std::optional<PolePath>> handle_poles(const path::ClPath& path, std::span<const Vec3> poles,
                                             const PoleRules& rules) {
  if (poles.empty() || path.records.empty()) return std::optional<PolePath>{};
  PolePath out;
  out.path = path;
  out.path.records.clear();
  std::size_t first = 0;
  for (std::size_t i = 1; i <= path.records.size(); ++i) {
    if (i < path.records.size() && path.records[i].kind != path::MoveKind::rapid) continue;
    Handler handler(path, nearest_pole(path, first, i, poles), rules);
    if (auto bad = handler.pass(first, i, out)) return *bad;
    first = i;
  }
  if (out.path.records.size() == path.records.size() && out.passages == 0) return std::optional<PolePath>{};
  return std::optional<PolePath>(std::move(out));
}

}  // namespace toothpath::joints
