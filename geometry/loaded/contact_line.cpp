#include "geometry/loaded/contact_line.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/limits.h"
#include "geometry/loaded/line_of_tooth.h"

namespace toothpath::loaded {
namespace {

constexpr double kShortest = 0.2;  // mm: shorter lines carry nothing that counts
constexpr int kChords = 160;       // of a line, for its length

Segment segment_at(const LineOfTooth& line, double B) {
  LinePlace p = line.at(B);
  line.bend(p);
  return segment_of(line, p);
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
    Segment s = segment_at(line, middle);
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
    const LineOfTooth line(f, side, phi + j * pitch, bounds, options.pinion, {options.removal, options.half_width_mm});
    if (options.pinion != nullptr && !line.find(out.from_B, out.to_B)) continue;
    std::vector<double> length(1, 0.0);
    LinePlace before = line.at(out.from_B);
    out.least_gap = before.gap;
    for (int k = 1; k <= kChords; ++k) {
      LinePlace here = line.at(out.from_B + (out.to_B - out.from_B) * k / kChords);
      length.push_back(length.back() + (here.point - before.point).norm());
      out.least_gap = std::min(out.least_gap, here.gap);
      before = std::move(here);
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
      Segment s = segment_at(line, B_at(step * (k + 0.5)));
      s.gap -= s.curvature * s.beyond * s.beyond / 2;
      s.beyond = 0;
      s.length = step;
      const LinePlace from = line.at(B_at(step * k)), to = line.at(B_at(step * (k + 1)));
      s.along = (to.point - from.point).normalized();
      s.gap = (from.gap + 4 * s.gap + to.gap) / 6;  // mean over the piece, Simpson
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
