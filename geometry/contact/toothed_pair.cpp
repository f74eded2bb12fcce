#include "geometry/contact/toothed_pair.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/contact/rolling.h"
#include "geometry/tooth_space/limits.h"

namespace toothpath::contact {
namespace {

using tooth_space::ToothSpace;

const double kNoPlace = std::numeric_limits<double>::quiet_NaN();

/// u where a flank ends at its fillet.
double end_of_flank(const ToothSpace& space, tooth_space::Piece piece) {
  const tooth_space::Borders b = space.active(piece);
  return std::isfinite(b.from) ? b.from : b.to;
}

/// Does column 0, at the end of the teeth nearer to the axis, lie at s_from? On a cylinder that is the lower end.
bool begins_at_from(const ToothSpace& space) {
  const tooth_space::Outline& ring = space.outline();
  const double wider =
      ring.chart.r(ring.s_to, space.tip(ring.s_to)) - ring.chart.r(ring.s_from, space.tip(ring.s_from));
  return std::abs(wider) > 1e-6 * (ring.s_to - ring.s_from) ? wider > 0 : ring.sign > 0;
}

}  // namespace

bool SpaceFlank::exact() const {
  return std::all_of(deviation_mm.begin(), deviation_mm.end(), [](double d) { return d == 0; });
}

tooth_space::PatchPoint SpaceFlank::at(double u, double v) const {
  if (const auto found = space->point(piece, u, v)) return *found;
  tooth_space::PatchPoint none;
  none.p.setConstant(kNoPlace);
  return none;
}

Vec2 SpaceFlank::meridian(const Vec3& p) const {
  const tooth_space::Outline& ring = space->outline();
  return {ring.sign * ring.chart.along(p), ring.chart.up(p)};
}

double SpaceFlank::low(double station) const {
  const double x = std::clamp(column_share(station), 0.0, 1.0) * (columns - 1);
  const auto c = static_cast<std::size_t>(std::min(int(x), columns - 2));
  return low_mm[c] + (x - double(c)) * (low_mm[c + 1] - low_mm[c]);
}

double SpaceFlank::column_share(double station) const {
  const tooth_space::Outline& ring = space->outline();
  const double share = (station - ring.s_from) / (ring.s_to - ring.s_from);
  return begins_at_from(*space) ? share : 1 - share;
}

Vec2 SpaceFlank::shares(double s, double h) const {
  const double station = space->outline().station(s, h), end = low(station);
  return {column_share(station), (h - end) / (space->tip(s) - end)};
}

double SpaceFlank::inside_by(double s, double h) const {
  const tooth_space::Outline& ring = space->outline();
  const double station = ring.station(s, h), ends = std::min(station - ring.s_from, ring.s_to - station);
  if (!(ends >= 0)) return std::isnan(ends) ? -1 : ends;
  return std::min({ends, space->tip(s) - h, h - low(station)});
}

std::optional<tooth_space::PiecePlace> SpaceFlank::place(double s, double h) const {
  const Vec2 share = shares(s, h);
  const double x = std::clamp(share.x(), 0.0, 1.0) * (columns - 1), y = std::clamp(share.y(), 0.0, 1.0) * (rows - 1);
  const int c = std::min(int(x), columns - 2), r = std::min(int(y), rows - 2);
  const auto between = [&](const std::vector<double>& f) {
    const double low = f[index(r, c)] + (x - c) * (f[index(r, c + 1)] - f[index(r, c)]),
                 high = f[index(r + 1, c)] + (x - c) * (f[index(r + 1, c + 1)] - f[index(r + 1, c)]);
    return low + (y - r) * (high - low);
  };
  return tooth_space::search_place(*space, piece, s, h, {between(us), between(vs)});
}

Result<SpaceFlank> space_flank(const ToothSpace& space, int zone, int side, int rows, int columns) {
  if (rows < 3 || columns < 3) return fail("a flank needs at least 3 x 3 places, not {} x {}", rows, columns);
  SpaceFlank flank;
  flank.space = &space;
  flank.piece = tooth_space::flank_of(side);
  flank.zone = zone, flank.side = side, flank.rows = rows, flank.columns = columns;
  const auto size = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  for (auto* list : {&flank.us, &flank.vs, &flank.deviation_mm}) list->assign(size, 0);
  flank.points.resize(size), flank.normals.resize(size);
  const tooth_space::Outline& ring = space.outline();
  const double end = end_of_flank(space, flank.piece);
  for (int c = 0; c < columns; ++c) {
    const double share = double(begins_at_from(space) ? c : columns - 1 - c) / (columns - 1),
                 station = ring.s_from + (ring.s_to - ring.s_from) * share, s_tip = space.tip_s(station);
    const auto tip = space.tip_edge(side, s_tip);
    const auto low_v = tooth_space::v_at_station(space, flank.piece, end, station);
    const auto low = low_v ? space.at(flank.piece, end, *low_v) : std::nullopt;
    if (!tip || !low)
      return fail("flank {:+} does not reach from its tip to its fillet at {} {:.4f} mm", side, ring.along,
                  ring.sign * station);
    const double h_low = ring.chart.up(low->p), h_tip = space.tip(s_tip);
    flank.low_mm.push_back(h_low);
    Vec2 start(end, *low_v);
    for (int r = 0; r < rows; ++r) {
      const double up = double(r) / (rows - 1), h = h_low + (h_tip - h_low) * up, s = ring.s_at(station, h);
      const auto found = tooth_space::search_place(space, flank.piece, s, h, start);
      if (!found)
        return fail("flank {:+} has no place at {} {:.4f} mm, {:.0f} % of its height", side, ring.along, ring.sign * s,
                    100 * up);
      start = Vec2(found->u, found->v) + (Vec2(tip->u, tip->v) - Vec2(found->u, found->v)) / std::max(1, rows - 1 - r);
      const std::size_t k = flank.index(r, c);
      flank.us[k] = found->u, flank.vs[k] = found->v;
      flank.points[k] = found->at.p, flank.normals[k] = found->at.n;
    }
  }
  return flank;
}

Result<SpaceFlank> measured_flank(const SpaceFlank& exact, int rows, int columns, const std::vector<Vec3>& nominal,
                                  const std::vector<double>& deviation_mm) {
  const auto size = static_cast<std::size_t>(std::max(0, rows)) * static_cast<std::size_t>(std::max(0, columns));
  if (rows < 3 || columns < 3) return fail("a flank needs at least 3 x 3 places, not {} x {}", rows, columns);
  if (nominal.size() != size || deviation_mm.size() != size)
    return fail("{} x {} places, but {} points and {} deviations", rows, columns, nominal.size(), deviation_mm.size());
  SpaceFlank flank = exact;
  flank.rows = rows, flank.columns = columns;
  flank.low_mm.clear();
  for (auto* list : {&flank.us, &flank.vs, &flank.deviation_mm}) list->resize(size);
  flank.points.resize(size), flank.normals.resize(size);
  const Vec2 first = exact.meridian(nominal.front()), right = exact.meridian(nominal[std::size_t(columns - 1)]),
             over = exact.meridian(nominal[std::size_t(columns) * std::size_t(rows - 1)]);
  const bool flip_rows = first.y() > over.y(), flip_columns = first.x() > right.x();
  const tooth_space::Chart& chart = exact.space->outline().chart;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const auto from = flank.index(flip_rows ? rows - 1 - r : r, flip_columns ? columns - 1 - c : c),
                 k = flank.index(r, c);
      const auto found = exact.place(chart.along(nominal[from]), chart.up(nominal[from]));
      if (!found) return fail("row {}, column {} is not on flank {:+}", r, c, exact.side);
      flank.us[k] = found->u, flank.vs[k] = found->v;
      flank.points[k] = found->at.p, flank.normals[k] = found->at.n;
      flank.deviation_mm[k] = deviation_mm[from];
    }
  return flank;
}

MatePlace outside_place(const OutsideShafts& shafts, const Misalignment& moved) {
  const Vec3 across = shafts.angle_rad == 0 || shafts.skew ? Vec3::UnitX() : Vec3::UnitY();
  MatePlace out;
  // Half a turn about its own axis brings azimuth 0 of the mate to azimuth 0 of the gear.
  out.axes = Eigen::AngleAxisd(shafts.angle_rad + moved.angle_rad, across).toRotationMatrix() *
             Eigen::AngleAxisd(kPi, Vec3::UnitZ()).toRotationMatrix();
  out.origin = across * (shafts.distance_mm + moved.offset_mm) +
               out.axes.col(2) * (shafts.mate_axial_mm + moved.axial_mm) -
               Vec3::UnitZ() * (shafts.gear_axial_mm + moved.gear_axial_mm);
  return out;
}

MatePlace pinion_place(const face_gear::FaceGearSurface<double>& gear, int pinion_teeth, const Misalignment& moved) {
  const Pinion<double> pinion = make_pinion(gear, pinion_teeth, moved);
  MatePlace out;
  out.axes << pinion.d, pinion.b, pinion.a;
  out.origin = pinion.foot + pinion.a * pinion.L0;
  out.sense = 1;
  return out;
}

double ToothedMember::near_turn(std::size_t k) const {
  const Vec3& middle = flank.points[flank.index(flank.rows / 2, flank.columns / 2)];
  return mesh_rad + wrapped(azimuth(middle) - azimuth(flank.points[k]));
}

double ToothedMember::inside_by(const Vec3& point) const {
  const tooth_space::Chart& chart = mate->space->outline().chart;
  const Vec3 p = place.to_mate(point);
  return mate->inside_by(chart.along(p), chart.up(p));
}

double ToothedMember::asked_turn(const Vec3& point, double phi_2) const {
  const tooth_space::Chart& chart = mate->space->outline().chart;
  const Vec3 p = place.to_mate(point);
  const double s = chart.along(p), h = chart.up(p);
  if (!(mate->inside_by(s, h) >= 0)) return kNever;
  const auto found = mate->place(s, h);
  if (!found) return kNever;
  const double nominal = phi_2 / ratio(),
               turn = place.sense * (azimuth(p) - azimuth(found->at.p)) - turned_rad - nominal;
  return flank.side * (nominal + std::remainder(turn, kTwoPi));
}

double ToothedMember::lever_mm(const Vec3& point, const Vec3& normal) const {
  return std::abs(place.axes.col(2).cross(point - place.origin).dot(normal));
}

Vec2 ToothedMember::on_mate(const Vec3& point) const {
  const Vec3 p = place.to_mate(point);
  return {radius(p), p.z()};
}

std::optional<ToPinion> ToothedMember::approach(const Vec3& point, const Vec3& normal, double phi_2) const {
  const double asked = asked_turn(point, phi_2);
  if (asked == kNever) return std::nullopt;
  const Vec2 at = on_mate(point);
  return ToPinion{(flank.side * phi_2 / ratio() - asked) * lever_mm(point, normal), at.x(), at.y()};
}

namespace {

/// For how many of the gear's turns, out of those that are tried, a place lies on the mate's flank: the longest run of
/// them, and its middle.
struct Reach {
  int turns = 0;
  double middle = 0;
};
Reach reach_of(const ToothedMember& member, const Vec3& point) {
  const int count = 16 * member.gear_teeth;
  std::vector<bool> inside;
  for (int k = 0; k < count; ++k) inside.push_back(member.inside_by(Turn(kTwoPi * k / count)(point)) >= 0);
  Reach best;
  int run = 0;
  for (int k = 0; k < 2 * count && run < count; ++k) {
    run = inside[std::size_t(k % count)] ? run + 1 : 0;
    if (run > best.turns) best = {run, wrapped(kTwoPi * (k - 0.5 * (run - 1)) / count)};
  }
  return best;
}

/// Finds the mesh: where the place that is longest in reach of the mate is nearest to it. False: none is in reach.
bool find_mesh(ToothedMember& member) {
  const SpaceFlank& flank = member.flank;
  Reach best;
  std::size_t at = 0;
  for (const int r : {2, 1, 3})
    for (const int c : {2, 1, 3}) {
      const std::size_t k = flank.index(r * (flank.rows - 1) / 4, c * (flank.columns - 1) / 4);
      const Reach reach = reach_of(member, flank.points[k]);
      if (reach.turns > best.turns) best = reach, at = k;
    }
  if (best.turns == 0) return false;
  const auto asked = [&](double phi_2) { return member.asked_turn(Turn(phi_2)(flank.points[at]), phi_2); };
  const auto beyond = [&](double phi_2) {
    const double turn = asked(phi_2);
    return turn == kNever ? kNever : turn - flank.side * phi_2 / member.ratio();
  };
  const double first = beyond(best.middle);
  if (first == kNever) return false;
  member.turned_rad = flank.side * first;  // turns wrap about it
  const double step = member.pitch() / kStepsAPitch;
  const double mesh = highest_turn(beyond, best.middle, step).value_or(best.middle);
  member.turned_rad += flank.side * beyond(mesh);
  member.mesh_rad =
      mesh + wrapped(azimuth(flank.points[at]) - azimuth(flank.points[flank.index(flank.rows / 2, flank.columns / 2)]));
  return true;
}

}  // namespace

Result<std::vector<ToothedMember>> toothed_members(const ToothedPair& pair, int side, const PairGrid& grid) {
  std::vector<std::shared_ptr<const SpaceFlank>> mates;
  for (int zone = 0; zone < pair.mate->zones(); ++zone) {
    auto flank = space_flank(pair.mate->space(zone), zone, -pair.place.sense * side, grid.mate_rows, grid.mate_columns);
    if (!flank) return fail("the mate: {}", flank.error().message);
    mates.push_back(std::make_shared<const SpaceFlank>(std::move(*flank)));
  }
  std::vector<ToothedMember> members;
  for (int zone = 0; zone < pair.gear->zones(); ++zone) {
    auto flank = space_flank(pair.gear->space(zone), zone, side, grid.rows, grid.columns);
    if (!flank) return flank.error();
    std::optional<ToothedMember> best;
    int most = 0;
    for (const auto& mate : mates) {
      ToothedMember member{*flank, mate, pair.place, pair.gear->teeth(), pair.mate->teeth()};
      const int turns = reach_of(member, flank->points[flank->index(grid.rows / 2, grid.columns / 2)]).turns;
      if (best && turns <= most) continue;
      if (find_mesh(member)) best = std::move(member), most = turns;
    }
    if (!best) continue;
    if (!members.empty()) {  // turns of one mate: counted from one place, whole pitches apart
      const double mate_pitch = kTwoPi / best->mate_teeth, from = members.front().turned_rad;
      best->turned_rad = from + mate_pitch * std::round((best->turned_rad - from) / mate_pitch);
    }
    members.push_back(std::move(*best));
  }
  if (members.empty())
    return fail("flank {:+} and the mate's come to each other in no turn: their distance, angle or mounting is wrong",
                side);
  return members;
}

Result<RollResult> roll(const std::vector<ToothedMember>& members, const RollOptions& options) {
  return rolling::rolled(members, options);
}
Result<EaseOff> ease_off(const std::vector<ToothedMember>& members) { return rolling::ease_off_of(members); }

namespace {

/// At a place of the gear's grid, of the edges of both flanks.
BeyondMargins beyond_margins(const ToothedMember& member, const EaseOffMap& map, int row, int column, double margin,
                             const Vec2& nearest) {
  const SpaceFlank& flank = member.flank;
  const tooth_space::Chart& chart = member.mate->space->outline().chart;
  BeyondMargins out = beyond_own_margins(flank.rows, flank.columns, row, column, margin);
  const auto of = [&](Edge edge) -> double& { return out[static_cast<std::size_t>(edge)]; };
  const std::size_t k = flank.index(row, column);
  const bool met = !std::isnan(map.gap_mm[k]);
  const Vec3 on_mate =
      met ? Vec3(map.pinion_across_mm[k], 0, map.pinion_along_mm[k]) : Vec3(nearest.x(), 0, nearest.y());
  const Vec2 share = member.mate->shares(chart.along(on_mate), chart.up(on_mate));
  const Edge end = share.y() > 0.5 ? Edge::pinion_tip : Edge::pinion_root;
  if (!met) {
    // Beyond an end of the mate's face it is the face that ends.
    if (share.x() < 0 || share.x() > 1) of(column * 2 < flank.columns ? Edge::inner_end : Edge::outer_end) = 0;
    else of(end) = 0;
    return out;
  }
  of(Edge::pinion_tip) = 1 - share.y() - margin;
  of(Edge::pinion_root) = share.y() - margin;
  if (beside_the_end(map, flank.rows, flank.columns, row, column)) of(end) = std::min(of(end), 0.0);
  return out;
}

}  // namespace

PatternPlace pattern_place(const ToothedMember& member, const EaseOffMap& map, const FlankPattern& pattern,
                           double compound_mm, double margin) {
  const SpaceFlank& f = member.flank;
  RolledGrid rolled{f.rows, f.columns, f.points, pattern.gap_mm, {}};
  for (int r = 0; r < f.rows; ++r)
    for (int c = 0; c < f.columns; ++c) {
      const std::size_t k = f.index(r, c);
      rolled.margins.push_back(
          beyond_margins(member, map, r, c, margin, {pattern.pinion_radius_mm[k], pattern.pinion_Z_mm[k]}));
    }
  return pattern_place(rolled, compound_mm);
}

}  // namespace toothpath::contact
