#include "geometry/loaded/loaded_pair.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "geometry/base/angle.h"
#include "geometry/loaded/carriers.h"
#include "geometry/loaded/cell_position.h"
#include "geometry/loaded/face_flanks.h"
#include "geometry/loaded/half_space.h"

namespace toothpath::loaded {
namespace {

constexpr int kWidthRounds = 8;
constexpr double kWidthTolerance = 1e-6;
constexpr double kFirstLook = 0.1;  // mm: teeth so far off are looked at on cells, then as far as the approach is
constexpr int kListRounds = 6;
constexpr double kListMargin = 1e-3;  // of the approach: places so much farther off are listed when it grew

/// All places of one position, with their compliance.
class PositionProblem {
 public:
  PositionProblem(const LoadedPair& pair, const Load& load, double phi) : pair_(pair), load_(load), phi_(phi) {}

  /// Lists the places: those on the flanks, then those beyond the ends of lines and on edges. @param approach_mm  of
  /// the loaded flanks, at most; 0: those on the flanks only, infinite: those on edges only
  void list(double approach_mm, double half_width) {
    const double zero = places_.empty() ? 0 : zero_;
    places_.clear(), line_of_.clear();
    line_mm_ = edge_mm_ = 0;
    int line_number = 0;
    double least = 1e300;
    for (const PairRing& ring : pair_.rings) {
      LineOptions options;
      options.segment_mm = pair_.options.segment_mm;
      options.half_width_mm = half_width;
      if (std::isfinite(approach_mm)) options.approach_mm = approach_mm;
      if (approach_mm > 0) options.edges = {zero + approach_mm, &ring.moved, &pair_.options.gap};
      if (ring.removal) options.pinion = &ring.moved, options.removal = &ring.removal;
      auto lines = contact_lines(ring.surface, ring.ring, pair_.side, phi_, ring.bounds, options);
      if (options.edges.pinion != nullptr) {
        auto edges = edges_near(ring.surface, ring.ring, pair_.side, phi_, ring.bounds, options, lines);
        std::move(edges.begin(), edges.end(), std::back_inserter(lines));
      }
      for (auto& line : lines) {
        line_mm_ += line.length;
        // The first touch may lie between the middles of pieces.
        if ((ring.removal || line.length == 0) && !pair_.options.gap) least = std::min(least, line.least_gap);
        for (Segment& s : line.segments) {
          s.gap += unloaded_gap(ring, s);
          if (s.on_edge) edge_mm_ += s.length;
          places_.push_back(s);
          line_of_.push_back(line_number);
        }
        ++line_number;
      }
    }
    for (const auto& s : places_) least = std::min(least, s.gap);
    for (auto& s : places_) s.gap -= least;  // the first touch is the zero of the approach
    zero_ = least;
    smooth_ = smooth_part();
  }
  [[nodiscard]] bool empty() const { return places_.empty(); }
  [[nodiscard]] const std::vector<Segment>& places() const { return places_; }
  [[nodiscard]] double line_mm() const { return line_mm_; }
  /// What the load is spread over, about, mm.
  [[nodiscard]] double spread_mm() const { return line_mm_ > 0 ? line_mm_ : edge_mm_; }
  [[nodiscard]] double normal_force() const { return load_.torque_nmm / pair_.lever; }

  /// Shares the load; half widths of the strips and forces are found together. @param shift  of the pinion, mm
  Result<ContactForces> share(std::vector<double>& half_widths, double shift = 0) const {
    const auto n = static_cast<Eigen::Index>(places_.size());
    ContactProblem p;
    const bool moves = load_.axial != PinionAxial::held;
    p.approach = Eigen::MatrixXd::Zero(n, moves ? 2 : 1);
    p.support = Eigen::MatrixXd::Zero(p.approach.cols(), p.approach.cols());
    p.load = Eigen::VectorXd::Zero(p.approach.cols());
    p.load(0) = normal_force();
    p.gap.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Segment& s = places_[static_cast<std::size_t>(i)];
      p.gap(i) = s.gap - axial_share(s) * shift;
      p.approach(i, 0) = lever_share(s);
      if (moves) p.approach(i, 1) = axial_share(s);
    }
    if (load_.axial == PinionAxial::spring) p.support(1, 1) = load_.spring_n_mm;
    std::vector<int> touching;
    Result<ContactForces> shared = fail("no round");
    for (int round = 0; round < kWidthRounds; ++round) {
      p.compliance = smooth_ + strips(half_widths);
      p.compliance = Eigen::MatrixXd((p.compliance + p.compliance.transpose()) / 2);
      shared = share_load(p, touching);
      if (!shared) return shared;
      touching.clear();
      double change = 0;
      for (Eigen::Index i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (shared->force(i) > 0) touching.push_back(static_cast<int>(i));
        const double w = std::max(shared->force(i) / places_[k].length, 1e-6 * normal_force() / spread_mm());
        const double b = hertz_line(w, pair_.modulus, places_[k].curvature).half_width;
        if (shared->force(i) > 0) change = std::max(change, std::abs(b - half_widths[k]) / b);
        half_widths[k] = b;
      }
      if (change < kWidthTolerance) break;
    }
    const Eigen::VectorXd open = p.compliance * shared->force + p.gap - p.approach * shared->motion;
    residual_ = std::abs(p.approach.col(0).dot(shared->force) - p.load(0)) / p.load(0);
    for (Eigen::Index i = 0; i < n; ++i)
      residual_ = std::max(residual_, (shared->force(i) > 0 ? std::abs(open(i)) : -open(i)) / shared->motion(0));
    return shared;
  }
  [[nodiscard]] double residual() const { return residual_; }
  /// So large may the gap of a place be that presses.
  [[nodiscard]] static double reach(const ContactForces& forces) {
    return forces.motion(0) + (forces.motion.size() > 1 ? std::abs(forces.motion(1)) : 0);
  }

  /// Half widths to begin with: the load evenly over the lines.
  [[nodiscard]] std::vector<double> even_widths() const {
    std::vector<double> b;
    for (const auto& s : places_)
      b.push_back(hertz_line(normal_force() / spread_mm(), pair_.modulus, s.curvature).half_width);
    return b;
  }
  /// By how much a place nears when the pinion moves by 1 along its axis: -n.a.
  [[nodiscard]] double axial_share(const Segment& s) const { return -s.normal.dot(ring_of(s).surface.a()); }
  /// Lever of a place about the gear's axis, part of that of the gear's normals.
  [[nodiscard]] double lever_share(const Segment& s) const {
    return s.on_edge ? std::abs(s.point.cross(s.normal).z()) / pair_.lever : 1.0;
  }

 private:
  [[nodiscard]] const PairRing& ring_of(const Segment& s) const {
    return *std::find_if(pair_.rings.begin(), pair_.rings.end(), [&](const auto& r) { return r.ring == s.ring; });
  }

  [[nodiscard]] double unloaded_gap(const PairRing& ring, const Segment& s) const {
    double gap = pair_.options.gap ? pair_.options.gap(s) : 0;
    // The valley of modified flanks knows its own, edges too.
    if (pair_.options.moved.none() || ring.removal || s.on_edge) return gap;
    const double phi = phi_ + s.tooth * 2 * kPi / pair_.pinion_teeth;
    const auto place = ring.moved.place(s.nearest);
    if (!(place.radius > ring.moved.r_b)) return gap;
    double turn = ring.moved.turn_at(pair_.side, place);
    turn += 2 * kPi * std::round((phi - turn) / (2 * kPi));
    return gap + pair_.side * ring.moved.r_b * ring.moved.cos_bb * (phi - turn);
  }

  [[nodiscard]] Eigen::MatrixXd smooth_part() const {
    const auto n = static_cast<Eigen::Index>(places_.size());
    std::vector<ToothBody::Weights> on_gear, on_pinion;
    for (const auto& s : places_) {
      const PairRing& ring = ring_of(s);
      on_gear.push_back(ring.gear.weights(s.r, s.nearest.z()));
      on_pinion.push_back(ring.pinion.weights(s.Z, s.R));
    }
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index k = 0; k <= i; ++k) {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(k);
        if (places_[a].ring != places_[b].ring) continue;
        const PairRing& ring = ring_of(places_[a]);
        const int offset = places_[a].tooth - places_[b].tooth;
        C(i, k) = ring.gear.remainder_at(on_gear[a], on_gear[b], offset) +
                  ring.pinion.remainder_at(on_pinion[a], on_pinion[b], offset);
        C(k, i) = C(i, k);
      }
    return C;
  }

  /// Influence of strip k and its images on place i, both bodies.
  [[nodiscard]] double strip(const PairRing& ring, const Segment& i, const Segment& k, double b, bool own) const {
    const auto influence = [&](const Vec3& centre, const Vec3& along, bool self) {
      const Vec3 v = i.point - centre;
      const double l = v.dot(along), h = std::sqrt(std::max(0.0, v.squaredNorm() - l * l));
      return strip_influence(l, self ? 0.0 : h, k.length, b, self);
    };
    const double direct = influence(k.point, k.along, own);
    const BodyPlan &gear = pair_.options.gear, &pinion = pair_.options.pinion;
    double sum = (half_space_compliance(gear.E, gear.nu) + half_space_compliance(pinion.E, pinion.nu)) * direct;
    if (k.beyond > 0) return sum / k.length;  // what lies off the face has no image
    for (const bool on_gear : {true, false}) {
      const FreeEnds& ends = on_gear ? ring.gear_ends : ring.pinion_ends;
      const double c = on_gear ? half_space_compliance(gear.E, gear.nu) : half_space_compliance(pinion.E, pinion.nu);
      for (std::size_t end = 0; end < 2; ++end) {
        const Vec3 reach = k.along * (k.length / 2),
                   along = ends.mirrored(k.point + reach, end) - ends.mirrored(k.point - reach, end);
        sum += c * influence(ends.mirrored(k.point, end), along.normalized(), false);
      }
    }
    return sum / k.length;
  }

  [[nodiscard]] Eigen::MatrixXd strips(const std::vector<double>& half_widths) const {
    const auto n = static_cast<Eigen::Index>(places_.size());
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto b = static_cast<std::size_t>(k);
      const PairRing& ring = ring_of(places_[b]);
      for (Eigen::Index i = 0; i < n; ++i) {
        const auto a = static_cast<std::size_t>(i);
        if (line_of_[a] == line_of_[b]) C(i, k) = strip(ring, places_[a], places_[b], half_widths[b], a == b);
      }
    }
    return C;
  }

  const LoadedPair& pair_;
  const Load& load_;
  double phi_, line_mm_ = 0, edge_mm_ = 0, zero_ = 0;
  mutable double residual_ = 0;
  std::vector<Segment> places_;
  std::vector<int> line_of_;
  Eigen::MatrixXd smooth_;
};

void describe(const LoadedPair& pair, const PositionProblem& problem, const ContactForces& forces,
              const std::vector<double>& half_widths, LoadedPosition& out) {
  const double F = problem.normal_force();
  out.approach_mm = forces.motion(0);
  out.error_rad = out.approach_mm / pair.lever;
  out.shift_mm = forces.motion.size() > 1 ? forces.motion(1) : 0;
  out.stiffness = F / out.approach_mm;
  out.tangent = 1 / forces.yield(0, 0);
  out.line_mm = problem.line_mm();
  out.residual = problem.residual();
  std::vector<int> rings;
  for (const PairRing& ring : pair.rings) rings.push_back(ring.ring);
  Carriers carriers(rings, out);
  // An edge of a tooth counts as a whole: the load of its first piece, a corner without size, is a property of the
  // piece.
  struct Carried {
    double force = 0, length = 0;
  };
  std::map<std::pair<int, int>, Carried> edges;
  const auto force_of = [&](std::size_t k) { return forces.force(static_cast<Eigen::Index>(k)); };
  for (std::size_t k = 0; k < problem.places().size(); ++k)
    if (const Segment& s = problem.places()[k]; s.on_edge && force_of(k) > 0) {
      Carried& edge = edges[{s.ring, s.tooth}];
      edge.force += force_of(k), edge.length += s.length;
    }
  for (std::size_t k = 0; k < problem.places().size(); ++k) {
    const Segment& s = problem.places()[k];
    const double f = force_of(k);
    double w = f / s.length;
    if (f > 0 && s.on_edge) {
      const Carried& edge = edges[{s.ring, s.tooth}];
      w = edge.force / edge.length;
    }
    out.segments.push_back(
        {s, f, f > 0 ? half_widths[k] : 0, f > 0 ? hertz_line(w, pair.modulus, s.curvature).pressure : 0});
    if (!(f > 0)) continue;
    carriers.add(s.ring, s.tooth, f, s.on_edge ? 0 : s.curvature);
    out.axial_n -= f * problem.axial_share(s);
    out.gear_axial_n += f * s.normal.z();
    out.gear_torque_nmm += f * s.point.cross(s.normal).z();
    const contact::Pinion<double>& pinion = pair.rings.front().moved;
    out.pinion_torque_nmm += f * (s.point - pinion.foot).cross(s.normal).dot(pinion.a);
    const double p = out.segments.back().pressure;
    if (s.at_end || s.beyond > 0) {
      if (!s.on_edge)
        out.end_pressure = std::max(out.end_pressure, p);  // an edge has a line load and, rounded, its own
      out.end_line_load = std::max(out.end_line_load, w);
      const double radius = pair.options.edge_radius_mm;
      if (radius > 0)
        out.edge_pressure =
            std::max(out.edge_pressure, s.on_edge ? pressure_along_edge(w, pair.modulus, radius, s.curvature)
                                                  : pressure_across_edge(f, pair.modulus, radius, s.curvature));
    } else {
      out.pressure = std::max(out.pressure, p);
    }
  }
  carriers.finish(F);
  out.gear_torque_nmm = std::abs(out.gear_torque_nmm), out.pinion_torque_nmm = std::abs(out.pinion_torque_nmm);
}

}  // namespace

Result<LoadedPair> make_loaded_pair(const face_gear::FaceGear& gear, int side, int pinion_teeth,
                                    const PairOptions& options) {
  LoadedPair pair;
  pair.side = side;
  pair.teeth = gear.parameters().teeth;
  pair.pinion_teeth = pinion_teeth;
  pair.options = options;
  pair.modulus = contact_modulus(options.gear.E, options.gear.nu, options.pinion.E, options.pinion.nu);
  pair.shaper_teeth = gear.parameters().shaper_teeth;
  if (const auto fits = contact::check_pinion(gear.parameters(), pinion_teeth); !fits) return fits.error();
  pair.lever = gear.rings().front().surface.M2;
  pair.rings.resize(gear.rings().size());
  std::vector<Status> done(2 * gear.rings().size(), Status(Ok{}));
  for (std::size_t r = 0; r < gear.rings().size(); ++r) {
    const auto& ring = gear.rings()[r];
    PairRing& out = pair.rings[r];
    out.ring = static_cast<int>(r);
    out.surface = ring.surface;
    out.moved = contact::make_pinion(ring.surface, pinion_teeth, options.moved);
  }
  tbb::parallel_for(std::size_t(0), done.size(), [&](std::size_t n) {
    const auto& ring = gear.rings()[n / 2];
    PairRing& out = pair.rings[n / 2];
    const auto pinion = contact::make_pinion(ring.surface, pinion_teeth);
    const PinionProfile profile = pinion_profile(pinion, ring.surface.shaper.h_f, options.pinion_fillet_mm);
    auto bounds =
        contact_bounds(ring.surface, side, ring.zone.inner_radius_mm, ring.zone.outer_radius_mm, profile.least_theta);
    if (!bounds) {
      done[n] = bounds.error();
      return;
    }
    auto body = n % 2 == 0
                    ? gear_body(ring.surface, side, ring.zone.inner_radius_mm, ring.zone.outer_radius_mm, options.gear)
                    : pinion_body(pinion, profile, side, bounds->least_Z, bounds->most_Z, options.pinion);
    if (!body) {
      done[n] = body.error();
      return;
    }
    if (n % 2 == 0) {
      out.bounds = *bounds;
      out.gear = std::move(*body);
      out.gear_ends = out.gear.ends;
    } else {
      out.pinion = std::move(*body);
      out.pinion_ends = out.pinion.ends;
      out.pinion_ends.origin = pinion.foot;
      out.pinion_ends.axis = pinion.a;
    }
  });
  for (const auto& status : done)
    if (!status) return status.error();
  return pair;
}

namespace {

/// On cells, with all teeth that come inside the approach.
Result<LoadedPosition> on_cells(const LoadedPair& pair, const Load& load, double phi) {
  for (double looked = kFirstLook;;) {
    auto found = cell_position(FaceFlanks(pair, load.torque_nmm / pair.lever, phi, looked), load, phi);
    if (!found) return found;
    const double reach = found->approach_mm + std::abs(found->shift_mm);
    if (reach <= looked) return found;
    looked = 1.5 * reach;
  }
}

}  // namespace

Result<LoadedPosition> loaded_position(const LoadedPair& pair, const Load& load, double phi) {
  if (!(load.torque_nmm > 0) || !std::isfinite(load.torque_nmm))
    return fail("torque = {:g} N m on the gear is not above 0", load.torque_nmm / 1000);
  if (pair.options.cells || pair.pinion_teeth != pair.shaper_teeth) return on_cells(pair, load, phi);
  PositionProblem problem(pair, load, phi);
  LoadedPosition out;
  out.phi = phi;
  problem.list(0, 0);
  if (problem.empty()) problem.list(std::numeric_limits<double>::infinity(), 0);  // no line: edges alone touch
  if (problem.empty()) return fail("no pair touches while the pinion stands at {:.4f} deg", degrees(phi));
  auto widths = problem.even_widths();
  auto forces = problem.share(widths);
  if (!forces) return forces.error();
  // Then with every place that lies inside the approach, also beyond the ends of lines and on edges: with more places
  // the approach only becomes less, but for what a finer list changes.
  double looked = 0;
  for (int round = 0; problem.reach(*forces) > looked; ++round) {
    if (round == kListRounds)
      return fail(
          "the places that press at {:.4f} deg do not settle within {} lists: the approach is {:.3g} mm, those "
          "within {:.3g} mm are listed",
          degrees(phi), kListRounds, problem.reach(*forces), looked);
    looked = (round == 0 ? 1 : 1 + kListMargin) * problem.reach(*forces);
    problem.list(looked, *std::max_element(widths.begin(), widths.end()));
    widths = problem.even_widths();
    forces = problem.share(widths);
    if (!forces) return forces.error();
  }
  describe(pair, problem, *forces, widths, out);
  if (load.axial == PinionAxial::held && pair.rings.size() > 1) {
    constexpr double step = 1e-6;  // mm
    auto same = widths;
    if (const auto shifted = problem.share(same, step)) {
      double outer = 0;
      for (std::size_t k = 0; k < problem.places().size(); ++k)
        if (problem.places()[k].ring == pair.rings.back().ring) outer += shifted->force(static_cast<Eigen::Index>(k));
      out.share_per_mm = (outer - out.ring_force.back()) / problem.normal_force() / step;
    }
  }
  return out;
}

Result<std::vector<LoadedPosition>> positions_over(int positions, double pitch,
                                                   const std::function<Result<LoadedPosition>(double phi)>& position) {
  std::vector<std::optional<Result<LoadedPosition>>> found(static_cast<std::size_t>(positions));
  tbb::parallel_for(std::size_t(0), found.size(),
                    [&](std::size_t k) { found[k] = position(pitch * double(k) / positions); });
  std::vector<LoadedPosition> out;
  for (auto& one : found) {
    if (!*one) return one->error();
    out.push_back(std::move(**one));
  }
  return out;
}

Result<LoadedCycle> loaded_cycle(const LoadedPair& pair, const Load& load) {
  LoadedCycle cycle;
  cycle.normal_n = load.torque_nmm / pair.lever;
  cycle.single_axial_n = cycle.normal_n * std::abs(pair.rings.back().surface.shaper.sin_bb);
  auto found = positions_over(load.positions, 2 * kPi / pair.shaper_teeth,
                              [&](double phi) { return loaded_position(pair, load, phi); });
  if (!found) return found.error();
  cycle.positions = std::move(*found);
  return cycle;
}

}  // namespace toothpath::loaded
