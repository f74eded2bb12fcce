#include "geometry/loaded/contact_line.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/contact/touch_search.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/limits.h"
#include "geometry/loaded/line_of_tooth.h"

namespace toothpath::loaded {
namespace {

constexpr double kShortest = 0.2;  // mm: shorter lines carry nothing that counts
constexpr int kChords = 160;       // of a line, for its length
constexpr int kReach = 12;         // pitches about the middle of the mesh: lines run over a few
constexpr int kAbout = 4;          // pitches about the middle of the mesh: edges of these teeth may touch alone

Segment segment_at(const LineOfTooth& line, double B) {
  LinePlace p = line.at(B);
  line.bend(p);
  return segment_of(line, p);
}

/// Segments of equal length from one end of the line outwards, as long as material is near. True: not so far, since the
/// surface ends before.
bool add_beyond(const LineOfTooth& line, double end_B, double step_B, const LineOptions& options, ContactLine& out) {
  double B = end_B;
  Vec3 here = line.at(B).point;
  for (int n = 0; n < 40; ++n) {
    // The middle and the far end of the next segment, by its length; the line is nearly straight over so little.
    double rate = (line.at(B + step_B).point - here).norm() / std::abs(step_B);
    if (!(rate > 0)) return false;
    const double forward = step_B > 0 ? 1 : -1;
    const double middle = B + forward * options.segment_mm / 2 / rate, far = B + forward * options.segment_mm / rate;
    const LinePlace m = line.at(middle), e = line.at(far);
    if (!m.regular || !e.regular) return true;
    Segment s = segment_at(line, middle);
    if (s.beyond > std::sqrt(2 * options.approach_mm / s.curvature) + options.half_width_mm) return false;
    s.length = (e.point - here).norm();
    s.along = (e.point - here) / s.length;
    out.segments.push_back(s);
    B = far, here = e.point;
  }
  return false;
}

/// The edges of a tooth: for every B the place of least gap of both flanks. Gaps are exact, along the normal of the
/// flank that the edge stands over.
class Edges {
 public:
  Edges(const LineOfTooth& line, const ContactBounds& bounds, const LineOptions& options)
      : line_(line),
        options_(options),
        least_B_(bounds.least_B),
        step_((bounds.most_B - bounds.least_B) / kStations),
        theta_(std::max(1.1 * bounds.least_theta, 0.1)) {}

  /// Where the flanks come nearest, and the pieces about there.
  void add_nearest(ContactLine& out) {
    std::vector<double> gaps;
    for (int k = 0; k <= kStations; ++k) gaps.push_back(gap(least_B_ + step_ * k));
    const auto best = std::min_element(gaps.begin(), gaps.end());
    if (!std::isfinite(*best)) return;
    const auto k = best - gaps.begin();
    const double B = least_B_ + step_ * double(k);
    // Gaps bend upwards: the least lies within the difference to a neighbour below the best station.
    double rise = -1;
    if (k > 0 && std::isfinite(*(best - 1))) rise = *(best - 1) - *best;
    if (k < kStations && std::isfinite(*(best + 1))) rise = std::max(rise, *(best + 1) - *best);
    if (rise >= 0 && *best - rise > options_.edges.gap_mm) return;
    const double middle = contact::highest_place([&](double at) { return -gap(at); }, end_from(B, -1), end_from(B, 1));
    out.from_B = out.to_B = middle;
    out.least_gap = gap(middle);
    if (out.least_gap > options_.edges.gap_mm) return;
    add_from(middle, -1, out), add_from(middle, 1, out);
  }
  /// Pieces from a place outwards, towards smaller or larger B, up to the gap that is asked for.
  void add_from(double B, int way, ContactLine& out) {
    const auto first = place(B);
    if (!first) return;
    const auto near = [&](double at) {
      const double here = gap(at);
      return std::isfinite(here) && here <= options_.edges.gap_mm ? 1.0 : -1.0;
    };
    double last = B, next = B + way * step_;
    while (near(next) > 0) last = next, next += way * step_;
    const double end = contact::last_inside(near, last, next, kEdgeKnown);
    double length = 0;
    Vec3 before = first->point;
    for (int k = 1; k <= kChordsOfEdge; ++k) {
      const auto here = place(B + (end - B) * k / kChordsOfEdge);
      if (!here) return;
      length += (here->point - before).norm();
      before = here->point;
    }
    if (!(length > kShortestEdge)) return;  // it ends in the place where it begins
    // The gap grows from that place on, mostly by a slope: the first piece is that place, those after it are longer and
    // longer.
    auto from = segment(B);
    const double longest = options_.segment_mm / length;
    for (double at = 0, share = std::min(kFirst, longest); at < 1; share = std::min(2 * share, longest)) {
      const double until = at + 1.5 * share > 1 ? 1 : at + share;
      auto s = segment(B + (end - B) * (at + until) / 2);
      auto to = segment(B + (end - B) * until);
      if (!from || !s || !to) return;
      s->length = (to->point - from->point).norm();
      s->along = (to->point - from->point) / s->length;
      s->gap = at == 0 ? from->gap : (from->gap + 4 * s->gap + to->gap) / 6;
      out.segments.push_back(*s);
      from = std::move(to), at = until;
    }
  }

 private:
  static constexpr int kStations = 24, kChordsOfEdge = 8;
  static constexpr double kFirst = 1.0 / 256;    // of an edge: its first piece
  static constexpr double kEdgeKnown = 1e-9;     // rad
  static constexpr double kShortestEdge = 1e-6;  // mm

  [[nodiscard]] std::optional<LinePlace> place(double B) { return line_.nearest(B, theta_); }
  [[nodiscard]] Segment segment_at(LinePlace& p) const {
    line_.bend(p);
    Segment s = segment_of(line_, p);
    s.on_edge = s.at_end = true;
    s.normal = line_.normal_over_edge(p);
    s.gap = p.gap, s.beyond = 0;
    s.nearest = s.point;
    return s;
  }
  [[nodiscard]] std::optional<Segment> segment(double B) {
    auto p = place(B);
    if (!p) return std::nullopt;
    return segment_at(*p);
  }
  /// Infinite where the flanks have no place.
  [[nodiscard]] double gap(double B) {
    auto p = place(B);
    if (!p) return std::numeric_limits<double>::infinity();
    const auto* more = options_.edges.more;
    return p->gap + (more != nullptr && *more ? (*more)(segment_at(*p)) : 0);
  }
  /// A station on from B, or where the flanks end before.
  [[nodiscard]] double end_from(double B, int way) {
    const double next = B + way * step_;
    if (std::isfinite(gap(next))) return next;
    return contact::last_inside([&](double at) { return std::isfinite(gap(at)) ? 1 : -1; }, B, next, kEdgeKnown);
  }

  const LineOfTooth& line_;
  const LineOptions& options_;
  double least_B_, step_, theta_;
};

/// The tooth that stands in the middle of the mesh, about.
int middle_tooth(const face_gear::FaceGearSurface<double>& f, int side, double phi, const ContactBounds& bounds) {
  const double B = (bounds.least_B + bounds.most_B) / 2;
  return static_cast<int>(
      std::lround((f.flank_phi(side, std::tan(f.shaper.alpha_t), B) - phi) * f.shaper.teeth / (2 * kPi)));
}

void number(int ring, int tooth, ContactLine& line) {
  line.tooth = tooth;
  for (auto& s : line.segments) s.ring = ring, s.tooth = tooth;
}

/// The segments of a line on the flank, and those beyond its ends. False: it is too short.
bool add_line(const LineOfTooth& line, Edges& edges, const LineOptions& options, ContactLine& out) {
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
  if (out.length < kShortest) return false;
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
  if (!(options.approach_mm > 0)) return true;
  const double step = (out.to_B - out.from_B) / out.length * std::min(options.segment_mm, out.length) / 4;
  for (const int way : {-1, 1}) {
    const double end = way < 0 ? out.from_B : out.to_B;
    if (add_beyond(line, end, way * step, options, out) && options.edges.pinion != nullptr)
      edges.add_from(end, way, out);
  }
  return true;
}

}  // namespace

std::vector<ContactLine> contact_lines(const face_gear::FaceGearSurface<double>& f, int ring, int side, double phi,
                                       const ContactBounds& bounds, const LineOptions& options) {
  std::vector<ContactLine> lines;
  const int around = middle_tooth(f, side, phi, bounds);
  for (int j = around - kReach; j <= around + kReach; ++j) {
    ContactLine out;
    const double at = phi + j * 2 * kPi / f.shaper.teeth;
    if (!LineOfTooth(f, side, at, bounds, nullptr).find(out.from_B, out.to_B)) continue;
    const BentBy bent_by{options.removal, options.half_width_mm};
    const LineOfTooth line(f, side, at, bounds, options.pinion, bent_by);
    if (options.pinion != nullptr && !line.find(out.from_B, out.to_B)) continue;
    const LineOfTooth over_edges(f, side, at, bounds, options.edges.pinion, bent_by);
    Edges edges(over_edges, bounds, options);
    if (!add_line(line, edges, options, out)) continue;
    number(ring, j, out);
    lines.push_back(std::move(out));
  }
  return lines;
}

std::vector<ContactLine> edges_near(const face_gear::FaceGearSurface<double>& f, int ring, int side, double phi,
                                    const ContactBounds& bounds, const LineOptions& options,
                                    const std::vector<ContactLine>& lines) {
  std::vector<ContactLine> found;
  const auto look_at = [&](int j) {
    const LineOfTooth line(f, side, phi + j * 2 * kPi / f.shaper.teeth, bounds, options.edges.pinion,
                           {options.removal, options.half_width_mm});
    ContactLine out;
    Edges(line, bounds, options).add_nearest(out);
    if (out.segments.empty()) return false;
    number(ring, j, out);
    found.push_back(std::move(out));
    return true;
  };
  const int around = middle_tooth(f, side, phi, bounds);
  const int first = lines.empty() ? around : lines.front().tooth, last = lines.empty() ? around : lines.back().tooth;
  for (int j = first; j <= last; ++j)
    if (std::none_of(lines.begin(), lines.end(), [&](const auto& l) { return l.tooth == j; })) look_at(j);
  // Outwards as long as one comes near; without lines it is not known about which tooth.
  for (const int way : {-1, 1})
    for (int n = 1; n <= kReach; ++n)
      if (!look_at((way < 0 ? first : last) + way * n) && !(lines.empty() && n < kAbout)) break;
  return found;
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
