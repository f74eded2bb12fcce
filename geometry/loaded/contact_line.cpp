#include "geometry/loaded/contact_line.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/limits.h"

namespace toothpath::loaded {
namespace {

constexpr double kShortest = 0.2;  // mm: shorter lines carry nothing that counts
constexpr int kSamples = 600;      // of B over the flank
constexpr int kChords = 160;       // of a line, for its length

struct LinePlace {
  double theta = 0, B = 0, r = 0, R = 0, Z = 0;
  Vec3 point = Vec3::Zero(), nearest = Vec3::Zero();
  double inside = 0;  ///< mm to the nearest end, negative beyond it; off the regular sheet far below zero
  double beyond = 0;  ///< distance along the flank to the nearest material
  bool regular = false;
  Vec3 normal = Vec3::Zero();
  double gap = 0, curvature = 0, roundness = 0;  ///< of the unloaded flanks; across the line; along it, to across
};

class LineOfTooth {
 public:
  LineOfTooth(const face_gear::FaceGearSurface<double>& f, int side, double phi, const ContactBounds& bounds,
              const contact::Pinion<double>* pinion)
      : f_(f), side_(side), phi_(phi), bounds_(bounds), pinion_(pinion) {}

  [[nodiscard]] LinePlace at(double B) const {
    LinePlace p;
    p.B = B;
    p.theta = line_theta(f_, side_, B, phi_);
    if (pinion_ != nullptr) p.theta = valley(B, p.theta);
    const face_gear::FaceGearSurface<double>::FlankPlace place(f_, side_, p.theta, B);
    p.point = place.housing();
    p.normal = side_ * (f_.t(B) * f_.shaper.cos_bb - f_.a() * f_.shaper.sin_bb);
    const auto& w = f_.shaper;
    double theta_1 = p.theta, r_b1 = w.r_b, r_a1 = w.r_p + w.h_a;
    p.Z = place.Z();
    p.R = w.r_b * std::sqrt(1 + p.theta * p.theta);
    if (pinion_ != nullptr) {
      const double turn = f_.i * (phi_ - place.phi());
      p.point = turned(p.point, turn);
      p.normal = turned(p.normal, turn);
      const auto on_pinion = pinion_->place(p.point);
      p.R = on_pinion.radius, p.Z = on_pinion.Z;
      r_b1 = pinion_->r_b, r_a1 = pinion_->r_a;
      theta_1 = std::sqrt(std::max(0.0, (p.R - r_b1) * (p.R + r_b1))) / r_b1;
      p.gap = gap(p.theta, B);
    }
    p.r = radius(p.point);
    p.regular = theta_1 > bounds_.least_theta && p.theta > 0 && place.curvature().J > 0;
    const double z_tip = f_.z_tip(p.r);
    const double in_theta = std::min(theta_1 - bounds_.least_theta, p.theta) * r_b1, in_tip = z_tip - p.point.z(),
                 in_pinion = r_a1 - p.R, in_face = std::min(p.r - bounds_.inner_mm, bounds_.outer_mm - p.r);
    p.inside = p.regular ? std::min({in_theta, in_tip, in_pinion, in_face}) : std::min(in_theta, -1.0);
    // Along the flank, by the slopes of the edges in it.
    const double roll = w.cos_bb * w.cos_bb * theta_1 * theta_1 / (1 + theta_1 * theta_1);
    const Vec3& n = p.normal;
    const double n_r = (n.x() * p.point.x() + n.y() * p.point.y()) / p.r;
    const double off_pinion = -in_pinion / std::sqrt(std::max(1e-6, 1 - roll)),
                 off_tip = -in_tip / std::sqrt(std::max(1e-6, 1 - n.z() * n.z())),
                 off_face = -in_face / std::sqrt(std::max(1e-6, 1 - n_r * n_r));
    p.beyond = std::max({0.0, off_pinion, off_tip, off_face});
    p.nearest = p.point;
    if (p.beyond > 0) {
      Vec3 out = Vec3::UnitZ();
      if (p.beyond == off_pinion) out = from_axis(p.point);
      else if (p.beyond == off_face) out = Vec3(p.point.x(), p.point.y(), 0) * (p.r < bounds_.inner_mm ? -1 : 1);
      p.nearest -= (out - n * n.dot(out)).normalized() * p.beyond;
    }
    return p;
  }
  /// From the pinion's axis, at the section of the point.
  [[nodiscard]] Vec3 from_axis(const Vec3& point) const {
    const Vec3 foot = pinion_ != nullptr ? pinion_->foot : Vec3(f_.b() * f_.E), axis = axis_of_pinion(),
               v = point - foot;
    return v - axis * v.dot(axis);
  }
  [[nodiscard]] double section(const Vec3& point) const {
    return (point - (pinion_ != nullptr ? pinion_->foot : Vec3(f_.b() * f_.E))).dot(axis_of_pinion());
  }
  /// Fills in the relative curvatures of a place.
  void bend(LinePlace& p) const {
    auto H = f_.flank_shape(side_, p.theta, p.B);
    if (pinion_ == nullptr) {
      p.curvature = H.ee + H.ll + f_.shaper.cos_bb / (f_.shaper.r_b * p.theta);
      return;
    }
    const double turn = f_.i * phi_;  // from the gear's frame into the housing
    const auto basis = f_.flank_basis(side_, p.theta, p.B);
    const auto on_pinion = pinion_->place(p.point);
    const double theta_1 =
        std::sqrt((on_pinion.radius - pinion_->r_b) * (on_pinion.radius + pinion_->r_b)) / pinion_->r_b;
    const Vec3 e_1 = pinion_->e(std::atan2(on_pinion.y, on_pinion.x) + side_ * std::atan(theta_1));
    const double e = turned(basis.e, turn).dot(e_1), l = turned(basis.l, turn).dot(e_1),
                 k = pinion_->cos_bb / (pinion_->r_b * theta_1);
    H.ee += k * e * e, H.el += k * e * l, H.ll += k * l * l;
    p.curvature = H.k1();
    p.roundness = H.k2() / H.k1();
  }

  /// The stretch of B on the flank; false: the line misses it.
  bool find(double& from, double& to) const {
    const double step = (bounds_.most_B - bounds_.least_B) / kSamples;
    int best_from = -1, best_to = -2, start = -1, peak = 0;
    double highest = -1e300;
    for (int k = 0; k <= kSamples; ++k) {
      const double inside = at(bounds_.least_B + step * k).inside;
      if (inside > highest) highest = inside, peak = k;
      if (inside >= 0 && start < 0) start = k;
      if (start >= 0 && (inside < 0 || k == kSamples)) {
        const int last = inside < 0 ? k - 1 : k;
        if (last - start > best_to - best_from) best_from = start, best_to = last;
        start = -1;
      }
    }
    double in_from = 0, in_to = 0;
    if (best_from >= 0) in_from = bounds_.least_B + step * best_from, in_to = bounds_.least_B + step * best_to;
    else {  // a line shorter than a step: the highest place between the samples
      double low = bounds_.least_B + step * (peak - 1), high = low + 2 * step;
      for (int k = 0; k < 60; ++k) {
        const double a = low + (high - low) * 0.382, b = low + (high - low) * 0.618;
        (at(a).inside < at(b).inside ? low : high) = at(a).inside < at(b).inside ? a : b;
      }
      if (at((low + high) / 2).inside < 0) return false;
      in_from = in_to = (low + high) / 2;
    }
    from = end(in_from, in_from - step);
    to = end(in_to, in_to + step);
    return true;
  }

 private:
  [[nodiscard]] Vec3 axis_of_pinion() const { return pinion_ != nullptr ? pinion_->a : f_.a(); }

  /// Of the unloaded flanks at a place of the gear while both stand where the ratio puts them.
  [[nodiscard]] double gap(double theta, double B) const {
    const face_gear::FaceGearSurface<double>::FlankPlace place(f_, side_, theta, B);
    auto on_pinion = pinion_->place(turned(place.housing(), f_.i * (phi_ - place.phi())));
    on_pinion.radius = std::max(on_pinion.radius, pinion_->r_b);
    const double phi_1 = phi_ * f_.i / pinion_->ratio;
    double turn = pinion_->turn_at(side_, on_pinion);
    turn += 2 * kPi * std::round((phi_1 - turn) / (2 * kPi));
    return side_ * pinion_->r_b * pinion_->cos_bb * (phi_1 - turn);
  }
  /// theta of the least gap at this B, by Newton; the gap is nearly a parabola.
  [[nodiscard]] double valley(double B, double start) const {
    constexpr double h = 1e-4;
    double theta = std::max(start, 1e-3);
    for (int k = 0; k < 12; ++k) {
      const double here = gap(theta, B), up = gap(theta + h, B), down = gap(theta - h, B);
      const double slope = (up - down) / (2 * h), bend = (up - 2 * here + down) / (h * h);
      if (!(bend > 0)) break;
      const double step = std::clamp(-slope / bend, -0.1, 0.1);
      theta += step;
      if (std::abs(step) < 1e-9) break;
    }
    return theta;
  }
  [[nodiscard]] double end(double in, double out) const {
    if (at(out).inside >= 0) return out;
    for (int k = 0; k < 60; ++k) {
      const double middle = (in + out) / 2;
      (at(middle).inside >= 0 ? in : out) = middle;
    }
    return in;
  }

  const face_gear::FaceGearSurface<double>& f_;
  int side_;
  double phi_;
  const ContactBounds& bounds_;
  const contact::Pinion<double>* pinion_;
};

Segment segment_at(const LineOfTooth& line, double B, double& roundness) {
  LinePlace p = line.at(B);
  line.bend(p);
  roundness = std::max(roundness, p.roundness);
  Segment s;
  s.theta = p.theta, s.B = B, s.point = p.point, s.normal = p.normal;
  s.nearest = p.nearest;
  s.r = radius(p.nearest);
  s.Z = line.section(p.nearest);
  s.R = line.from_axis(p.nearest).norm();
  s.curvature = p.curvature;
  s.beyond = p.beyond;
  s.gap = p.gap + s.curvature * p.beyond * p.beyond / 2;
  return s;
}

/// Segments of equal length from one end of the line outwards, as long as material is near.
void add_beyond(const LineOfTooth& line, double end_B, double step_B, const LineOptions& options, ContactLine& out) {
  double B = end_B;
  Vec3 here = line.at(B).point;
  for (int n = 0; n < 40; ++n) {
    // The middle and the far end of the next segment, by its length; the line is nearly straight over so little.
    double rate = (line.at(B + step_B).point - here).norm() / std::abs(step_B);
    if (!(rate > 0)) return;
    const double forward = step_B > 0 ? 1 : -1;
    const double middle = B + forward * options.segment_mm / 2 / rate, far = B + forward * options.segment_mm / rate;
    const LinePlace m = line.at(middle), e = line.at(far);
    if (!m.regular || !e.regular) return;
    double round = 0;
    Segment s = segment_at(line, middle, round);
    if (s.beyond > std::sqrt(2 * options.approach_mm / s.curvature) + options.half_width_mm) return;
    s.length = (e.point - here).norm();
    s.along = (e.point - here) / s.length;
    out.segments.push_back(s);
    B = far, here = e.point;
  }
}

}  // namespace

std::vector<ContactLine> contact_lines(const face_gear::FaceGearSurface<double>& f, int ring, int side, double phi,
                                       const ContactBounds& bounds, const LineOptions& options) {
  std::vector<ContactLine> lines;
  const double pitch = 2 * kPi / f.shaper.teeth;
  // phi runs over a stretch of a few pitches on the flank; teeth from where no line is left on either side.
  const double B_mid = (bounds.least_B + bounds.most_B) / 2;
  const double centre = (f.flank_phi(side, std::tan(f.shaper.alpha_t), B_mid) - phi) / pitch;
  const int around = static_cast<int>(std::lround(centre));
  constexpr int kReach = 12;
  for (int j = around - kReach; j <= around + kReach; ++j) {
    ContactLine out;
    out.tooth = j;
    if (!LineOfTooth(f, side, phi + j * pitch, bounds, nullptr).find(out.from_B, out.to_B)) continue;
    const LineOfTooth line(f, side, phi + j * pitch, bounds, options.pinion);
    if (options.pinion != nullptr && !line.find(out.from_B, out.to_B)) continue;
    std::vector<double> length(1, 0.0);
    std::vector<Vec3> points(1, line.at(out.from_B).point);
    for (int k = 1; k <= kChords; ++k) {
      points.push_back(line.at(out.from_B + (out.to_B - out.from_B) * k / kChords).point);
      length.push_back(length.back() + (points.back() - points[points.size() - 2]).norm());
    }
    out.length = length.back();
    if (out.length < kShortest) continue;
    const auto B_at = [&](double l) {
      const auto k = static_cast<std::size_t>(
          std::clamp<std::ptrdiff_t>(std::upper_bound(length.begin(), length.end(), l) - length.begin(), 1, kChords));
      const double share = (l - length[k - 1]) / (length[k] - length[k - 1]);
      return out.from_B + (out.to_B - out.from_B) * (double(k) - 1 + share) / kChords;
    };
    const int count = std::max(2, static_cast<int>(std::lround(out.length / options.segment_mm)));
    for (int k = 0; k < count; ++k) {
      const double step = out.length / count;
      Segment s = segment_at(line, B_at(step * (k + 0.5)), out.roundness);
      s.gap -= s.curvature * s.beyond * s.beyond / 2;
      s.beyond = 0;
      s.length = step;
      s.along = (line.at(B_at(step * (k + 1))).point - line.at(B_at(step * k)).point).normalized();
      s.at_end = k == 0 || k == count - 1;
      out.segments.push_back(s);
    }
    if (options.approach_mm > 0) {
      const double step = (out.to_B - out.from_B) / out.length * std::min(options.segment_mm, out.length) / 4;
      add_beyond(line, out.from_B, -step, options, out);
      add_beyond(line, out.to_B, step, options, out);
    }
    for (auto& s : out.segments) s.ring = ring, s.tooth = j;
    lines.push_back(std::move(out));
  }
  return lines;
}

Result<ContactBounds> contact_bounds(const face_gear::FaceGearSurface<double>& f, int side, double inner_mm,
                                     double outer_mm, double least_theta) {
  ContactBounds b{inner_mm, outer_mm, std::max(least_theta, 1e-6), 1e300, -1e300, 1e300, -1e300};
  std::optional<face_gear::FlankCoordinates> near;
  constexpr int kStations = 16, kLevels = 8;
  for (int k = 0; k <= kStations; ++k) {
    const double r = inner_mm + (outer_mm - inner_mm) * k / kStations;
    const auto low = face_gear::fillet_line_height(f, side, r);
    if (!low) return fail("the flank of side {:+} is undercut at radius {:.4f} mm", side, r);
    for (int level = 0; level <= kLevels; ++level) {
      const double z = f.z_tip(r) + (*low - f.z_tip(r)) * level / kLevels;
      const auto at = face_gear::invert_flank(f, side, r, z, near);
      if (!at) return fail("no point of the flank of side {:+} at radius {:.4f} mm, height {:.4f} mm", side, r, z);
      near = at;
      b.least_B = std::min(b.least_B, at->B);
      b.most_B = std::max(b.most_B, at->B);
      const auto& w = f.shaper;
      if (w.r_b * std::sqrt(1 + at->theta * at->theta) > w.r_p + w.h_a) continue;  // below the pinion's tip
      const double Z = f.flank_Z(side, at->theta, at->B);
      b.least_Z = std::min(b.least_Z, Z);
      b.most_Z = std::max(b.most_Z, Z);
    }
  }
  const double margin = 0.1 * (b.most_B - b.least_B) + 0.01;
  b.least_B -= margin, b.most_B += margin;
  return b;
}

}  // namespace toothpath::loaded
