// The flanks that roll: exact or measured, and how much of a path of contact lies on them.
#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/contact/nearest_turn.h"
#include "geometry/contact/tooth_contact.h"
#include "geometry/face_gear/inverse.h"

namespace toothpath::contact {

Status check_pinion(const face_gear::FaceGearParameters& gear, int pinion_teeth) {
  if (pinion_teeth < 5) return fail("pinion_teeth = {} is below 5", pinion_teeth);
  if (pinion_teeth > gear.shaper_teeth)
    return fail("pinion_teeth = {} exceeds the shaper's {}: such a pinion bears on the ends of the face", pinion_teeth,
                gear.shaper_teeth);
  return Ok{};
}

bool ContactFlank::exact() const {
  return std::all_of(deviation_mm.begin(), deviation_mm.end(), [](double d) { return d == 0; });
}

modification::Rectangle rectangle_of(const Pinion<double>& pinion, const face_gear::FaceGearRing& ring) {
  const auto& f = ring.surface;
  const auto section = [&](double r) { return (std::sqrt(r * r - f.E * f.E) + f.shaper.r_p * f.Cg) / f.Sg; };
  return {2 * (pinion.r_a - pinion.r_p), section(ring.zone.inner_radius_mm), section(ring.zone.outer_radius_mm)};
}

ContactMember make_member(const face_gear::FaceGear& gear, ContactFlank flank, int pinion_teeth,
                          const Misalignment& moved, const std::vector<modification::Modification>& on_pinion) {
  const auto& ring = gear.rings().at(static_cast<std::size_t>(flank.zone));
  const auto pinion = make_pinion(ring.surface, pinion_teeth, moved);
  modification::Field field(on_pinion, flank.side, flank.zone, rectangle_of(pinion, ring));
  auto kept = field.empty() ? nullptr : std::make_shared<const modification::Field>(std::move(field));
  return {std::move(flank), pinion, std::move(kept)};
}

namespace {

/// The normal of the parallel flank through a place, in the pinion's own directions (d, b, a); out of the gear.
struct OwnNormal {
  double x, y, Z;
};
OwnNormal normal_through(const Pinion<double>& pinion, int side, const Pinion<double>::Place& place) {
  const double theta = std::sqrt((place.radius - pinion.r_b) * (place.radius + pinion.r_b)) / pinion.r_b,
               B = std::atan2(place.y, place.x) + side * std::atan(theta);
  return {-side * pinion.cos_bb * std::sin(B), side * pinion.cos_bb * std::cos(B), -side * pinion.sin_bb};
}

}  // namespace

double set_back(const Pinion<double>& pinion, const modification::Field& field, int side,
                const Pinion<double>::Place& place) {
  const OwnNormal n = normal_through(pinion, side, place);
  double back = 0;
  for (int k = 0; k < 30; ++k) {  // the foot on the plain flank; amounts change by hundredths along it
    const double x = place.x - back * n.x, y = place.y - back * n.y,
                 next = field.removal(pinion.r_a - std::sqrt(x * x + y * y), place.Z - back * n.Z);
    if (std::abs(next - back) < 1e-14) return next;
    back = next;
  }
  return back;
}

std::optional<ToPinion> to_pinion(const Pinion<double>& pinion, const modification::Field* field, int side,
                                  const Pinion<double>::Place& place, double phi) {
  if (!(place.radius >= pinion.r_b)) return std::nullopt;
  const double plain = pinion.gap(side, place, phi);
  const OwnNormal n = normal_through(pinion, side, place);
  ToPinion found{plain, std::hypot(place.x + plain * n.x, place.y + plain * n.y), place.Z + plain * n.Z};
  if (!(found.radius_mm >= pinion.r_b) || !(found.radius_mm <= pinion.r_a)) return std::nullopt;
  if (field != nullptr) found.distance_mm += field->removal(pinion.r_a - found.radius_mm, found.Z_mm);
  return found;
}

double ContactMember::asked_turn(const Vec3& point, double /*phi_2*/) const {
  const auto place = pinion.place(point);
  if (!(place.radius >= pinion.r_b) || !(place.radius <= pinion.r_a)) return kNever;
  const double plain = flank.side * pinion.turn_at(flank.side, place);
  // Parallel involute helicoids are turned copies.
  return on_pinion == nullptr ? plain
                              : plain - set_back(pinion, *on_pinion, flank.side, place) / (pinion.r_b * pinion.cos_bb);
}

std::optional<ToPinion> ContactMember::approach(const Vec3& point, const Vec3&, double phi_2) const {
  return to_pinion(pinion, on_pinion.get(), flank.side, pinion.place(point), phi_2 / pinion.ratio);
}

namespace {

/// The sheet of a modified ring, for flanks that may outlive the gear.
std::shared_ptr<const face_gear::SpaceSheet> modified_sheet(const face_gear::FaceGear& gear, int zone) {
  if (!gear.rings().at(static_cast<std::size_t>(zone)).modification) return nullptr;
  return std::make_shared<const face_gear::SpaceSheet>(gear.drawn(static_cast<std::size_t>(zone)));
}

/// Where a modified flank ends at radius r; the plain one ends at height `plain`.
std::optional<double> modified_fillet_line(const face_gear::SpaceSheet& sheet, int side, double r, double plain) {
  const auto near = face_gear::invert_flank(sheet.surface(), side, r, plain);
  const double theta_t = sheet.surface().shaper.theta_t;
  const auto B = near ? sheet.B_at_radius(side, theta_t, r, near->B) : std::nullopt;
  if (!B) return {};
  return sheet.flank(side, theta_t, *B).p.z();
}

}  // namespace

Result<ContactFlank> exact_flank(const face_gear::FaceGear& gear, int zone, int side, int rows, int columns) {
  if (rows < 3 || columns < 3) return fail("a flank needs at least 3 x 3 places, not {} x {}", rows, columns);
  const face_gear::FaceGearRing& ring = gear.rings().at(static_cast<std::size_t>(zone));
  ContactFlank flank;
  flank.surface = ring.surface;
  flank.modified = modified_sheet(gear, zone);
  const face_gear::SpaceSheet& sheet = gear.drawn(static_cast<std::size_t>(zone));
  flank.zone = zone;
  flank.side = side;
  flank.rows = rows;
  flank.columns = columns;
  const auto size = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  flank.theta.resize(size);
  flank.B.resize(size);
  flank.points.resize(size);
  flank.normals.resize(size);
  flank.deviation_mm.assign(size, 0.0);
  std::optional<face_gear::FlankCoordinates> near;
  for (int c = 0; c < columns; ++c) {
    const double r =
        ring.zone.inner_radius_mm + (ring.zone.outer_radius_mm - ring.zone.inner_radius_mm) * c / (columns - 1);
    auto low = face_gear::fillet_line_height(ring.surface, side, r);
    auto top = low ? sheet.invert(side, r, ring.surface.z_tip(r), near) : std::nullopt;
    if (low && flank.modified) low = modified_fillet_line(sheet, side, r, *low);
    if (!low || !top)
      return fail("the flank of side {:+} does not reach from tip to fillet at radius {:.4f} mm", side, r);
    double z_top = ring.surface.z_tip(r);
    if (top->theta < 0) {  // the tip lies inside the base circle: the involute starts lower
      const auto B = sheet.B_at_radius(side, 0, r, top->B);
      if (!B) return fail("no start of the involute of side {:+} at radius {:.4f} mm", side, r);
      top->theta = 0;
      top->B = *B;
      z_top = flank.modified ? sheet.flank(side, 0, *B).p.z() : ring.surface.flank_housing(side, 0.0, *B).z();
    }
    near = top;
    for (int k = 0; k < rows; ++k) {
      const int row = rows - 1 - k;
      const double z = z_top + (*low - z_top) * k / (rows - 1);
      const auto at = k == 0 ? top : sheet.invert(side, r, z, near);
      if (!at) return fail("no point of the flank of side {:+} at radius {:.4f} mm, height {:.4f} mm", side, r, z);
      if (k > 0) near = at;
      const std::size_t n = flank.index(row, c);
      flank.theta[n] = at->theta;
      flank.B[n] = at->B;
      const auto p = flank.at(at->theta, at->B);
      flank.points[n] = p.p;
      flank.normals[n] = p.n;
    }
    near = top;
  }
  return flank;
}

Result<ContactFlank> measured_flank(const face_gear::FaceGear& gear, int zone, int side, int rows, int columns,
                                    const std::vector<Vec3>& nominal, const std::vector<double>& deviation_mm) {
  const auto size = static_cast<std::size_t>(std::max(0, rows)) * static_cast<std::size_t>(std::max(0, columns));
  if (rows < 3 || columns < 3) return fail("a flank needs at least 3 x 3 places, not {} x {}", rows, columns);
  if (nominal.size() != size || deviation_mm.size() != size)
    return fail("{} x {} places, but {} points and {} deviations", rows, columns, nominal.size(), deviation_mm.size());
  ContactFlank flank;
  flank.surface = gear.rings().at(static_cast<std::size_t>(zone)).surface;
  flank.modified = modified_sheet(gear, zone);
  flank.zone = zone;
  flank.side = side;
  flank.rows = rows;
  flank.columns = columns;
  flank.theta.resize(size);
  flank.B.resize(size);
  flank.points.resize(size);
  flank.normals.resize(size);
  flank.deviation_mm.resize(size);
  const auto last = static_cast<std::size_t>((rows - 1) * columns);
  const bool flip_rows = nominal[0].z() > nominal[last].z();
  const auto radius = [](const Vec3& p) { return std::hypot(p.x(), p.y()); };
  const bool flip_columns = radius(nominal[0]) > radius(nominal[static_cast<std::size_t>(columns - 1)]);
  std::optional<face_gear::FlankCoordinates> near;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const auto from =
          static_cast<std::size_t>((flip_rows ? rows - 1 - r : r) * columns + (flip_columns ? columns - 1 - c : c));
      const Vec3& p = nominal[from];
      const auto at = gear.drawn(static_cast<std::size_t>(zone)).invert(side, radius(p), p.z(), near);
      if (!at)
        return fail("the point at radius {:.4f} mm, height {:.4f} mm is not on the flank of side {:+}", radius(p),
                    p.z(), side);
      near = at;
      const std::size_t n = flank.index(r, c);
      flank.theta[n] = at->theta;
      flank.B[n] = at->B;
      const auto exact = flank.at(at->theta, at->B);
      flank.points[n] = exact.p;
      flank.normals[n] = exact.n;
      flank.deviation_mm[n] = deviation_mm[from];
      if (c == columns - 1) near.reset();
    }
  return flank;
}

std::optional<PathRange> path_on_flanks(const ContactPath<double>& path, const ContactMember& member) {
  const auto& f = member.flank;
  const Pinion<double>& pinion = member.pinion;
  const auto first = static_cast<std::size_t>(f.columns - 1);
  const double r_in = std::hypot(f.points[0].x(), f.points[0].y()),
               r_out = std::hypot(f.points[first].x(), f.points[first].y());
  const auto inside = [&](double theta_1) {
    const double theta = path.theta(theta_1);
    if (theta < 0 || theta > f.surface.shaper.theta_t) return false;
    const Vec3 p = path.point(theta_1);
    const double r = std::hypot(p.x(), p.y());
    return r >= r_in && r <= r_out && p.z() <= f.surface.z_tip(r) && f.surface.flank_J(f.side, theta, path.B) > 0;
  };
  const int n = 400;
  double from = -1, to = -1;
  for (int k = 0; k <= n; ++k) {
    const double x = pinion.theta_a * k / n;
    if (!inside(x)) {
      if (from >= 0) break;
      continue;
    }
    if (from < 0) from = x;
    to = x;
  }
  if (from < 0) return std::nullopt;
  const auto end = [&](double in, double out) {
    for (int k = 0; k < 60; ++k) {
      const double middle = (in + out) / 2;
      (inside(middle) ? in : out) = middle;
    }
    return in;
  };
  PathRange range;
  range.theta_1_from = from > 0 ? end(from, from - pinion.theta_a / n) : 0;
  range.theta_1_to = to < pinion.theta_a ? end(to, std::min(pinion.theta_a, to + pinion.theta_a / n)) : to;
  range.ratio = (range.theta_1_to - range.theta_1_from) * std::abs(path.per_theta) * pinion.teeth / (2 * kPi);
  return range;
}

}  // namespace toothpath::contact
