#include "geometry/spiral_bevel/gear.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "geometry/base/angle.h"
#include "geometry/base/refusals.h"
#include "geometry/spiral_bevel/set_up.h"
#include "geometry/tooth_space/limits.h"

template class toothpath::tooth_space::KernelSpace<toothpath::spiral_bevel::CutterKernel>;

namespace toothpath::spiral_bevel {
namespace {

using tooth_space::Piece;

constexpr int kLeastTeeth = 5, kMostTeeth = 2000, kStations = 9, kHeights = 13;
constexpr double kSameLine = 0.005;                // mm over the face: what may differ of what is stated twice
constexpr double kLeastRoll = 0.5, kMostRoll = 2;  // ratio of roll times the sine of the pitch angle
constexpr double kWrongHand = -5 * kDegree;
constexpr std::size_t kMostModified = 7;
constexpr double kMostTip = 20 * kDegree, kMostPressure = 45 * kDegree;  // tried: above the one asked, in all
constexpr int kRises = 64;                                               // of a flank, from its fillet to the face cone

double told(double x) { return std::floor(1e4 * x) / 1e4; }
const char* blade_of(std::size_t flank) { return flank == 0 ? "outside" : "inside"; }
int side_of(const CutterKernel& k, std::size_t flank) { return (flank == 0 ? 1 : -1) * k.hand; }

double station(const CutterKernel& k, int n) { return -k.R_e + (k.R_e - k.R_i) * n / (kStations - 1); }

/// Lowest place of the root at s.
double lowest(const CutterSpace& space, double s) {
  constexpr int kAcross = 8;
  double least = INFINITY;
  for (int n = 0; n <= kAcross; ++n)
    if (const auto q = tooth_space::place_at(space, Piece::root, double(n) / kAcross, s))
      least = std::min(least, space.outline().chart.up(q->p));
  return least;
}

tooth_space::BevelBody body_of(const SpiralBevelParameters& p, const CutterSpace& space) {
  tooth_space::BevelBody body;
  body.teeth = p.teeth;
  body.module_mm = 2 * p.outer_cone_distance_mm * std::sin(p.pitch_angle_rad) / p.teeth;
  body.root_back = lowest(space, space.outline().s_from);
  body.root_front = lowest(space, space.outline().s_to);
  body.lowest_root = std::min(body.root_back, body.root_front);
  if (space.kernel().root != RootForm::cone)
    for (int n = 0; n < kStations; ++n)
      body.lowest_root = std::min(body.lowest_root, lowest(space, station(space.kernel(), n)));
  body.bore_mm = p.bore_diameter_mm;
  body.hub_mm = p.hub_diameter_mm;
  body.hub_length_mm = p.hub_length_mm;
  return body;
}

class Inspection : public Refusals {
 public:
  explicit Inspection(const SpiralBevelParameters& gear) : gear_(gear) {}

  void numbers() {
    integer_range("teeth", gear_.teeth, kLeastTeeth, kMostTeeth);
    range("pitch_angle", degrees(gear_.pitch_angle_rad), 1, 90, " deg");
    range("tip_angle", degrees(gear_.tip_angle_rad), degrees(gear_.pitch_angle_rad) - 45,
          degrees(gear_.pitch_angle_rad) + 45, " deg");
    range("outer_cone_distance", gear_.outer_cone_distance_mm, 0.1, 1e5, " mm");
    range("face_width", gear_.face_width_mm, 0.001, 0.9 * gear_.outer_cone_distance_mm, " mm");
    range("mean_space_width", gear_.mean_space_width_mm.value_or(1), 1e-3, 1e4, " mm");
    for (const auto& [name, value] :
         {std::pair{"bore_diameter", gear_.bore_diameter_mm}, std::pair{"hub_diameter", gear_.hub_diameter_mm},
          std::pair{"hub_length", gear_.hub_length_mm}, std::pair{"backlash", gear_.backlash_mm.value_or(0)}})
      range(name, value, 0, 1e5, " mm");
  }

  /// What the cuts are, before anything is computed from them.
  void cuts() {
    const std::size_t count = gear_.cuts.size();
    const bool one = count == 1 && gear_.cuts[0].flank == Cuts::both;
    const bool two = count == 2 && gear_.cuts[0].flank != Cuts::both && gear_.cuts[1].flank != Cuts::both &&
                     gear_.cuts[0].flank != gear_.cuts[1].flank;
    if (!one && !two) {
      refuse(count == 0 ? "cut" : fmt::format("cut[{}].flank", count - 1),
             "the cuts do not make each flank once: one with flank = \"both\", or one with \"concave\" and one with "
             "\"convex\"");
      return;
    }
    for (std::size_t i = 0; i < 2; ++i) blade(i);
    for (std::size_t c = 0; c < count; ++c) settings(c);
    if (!refusals.empty()) return;
    widths(one);
    if (one) rounding(gear_.cuts[0]);
    else if (gear_.cuts[0].generated != gear_.cuts[1].generated)
      refuse("cut[1].generated", "generated = {}: the other flank has {}; both flanks are cut in one way",
             gear_.cuts[1].generated, gear_.cuts[0].generated);
    roots();
  }

  /// The surfaces over the whole face.
  void surfaces(const CutterSpace& space) {
    const CutterKernel& k = space.kernel();
    for (std::size_t i = 0; i < 2 && refusals.empty(); ++i)
      for (int n = 0; n < kStations && refusals.empty(); ++n) flank(space, i, station(k, n));
    if (refusals.empty()) hand(space);
    for (int n = 0; n < kStations && refusals.empty(); ++n) across(space, station(k, n));
  }

 private:
  void blade(std::size_t flank) {
    const Blade& b = gear_.cuts[cut_of(gear_, flank)].blades[flank];
    const auto key = [&](const char* name) { return cut_key(gear_, flank, name); };
    range(key("blade_point_radius"), b.point_radius_mm, 0.1, 1e5, " mm");
    range(key("blade_pressure_angle"), degrees(b.pressure_angle_rad), 1, 45, " deg");
    range(key("tool_edge_radius"), b.edge_radius_mm, 1e-3, 100, " mm");
  }

  void settings(std::size_t c) {
    const Cut& cut = gear_.cuts[c];
    const auto key = [&](const char* name) { return fmt::format("cut[{}].{}", c, name); };
    range(key("radial_distance"), cut.radial_distance_mm, 0, 1e5, " mm");
    range(key("machine_root_angle"), degrees(cut.root_angle_rad), 0.5, 90, " deg");
    range(key("center_roll_position"), degrees(cut.cradle_angle_rad), -180, 180, " deg");
    range(key("cutter_tilt"), degrees(cut.tilt_rad), -45, 45, " deg");
    if (cut.modified.size() > kMostModified)
      refuse(key("modified_roll_coefficients"), "modified_roll_coefficients: {} of them, the limit is {}",
             cut.modified.size(), kMostModified);
    if (!cut.generated) return;
    const double slip = cut.ratio_of_roll * std::sin(gear_.pitch_angle_rad);
    if (!(slip >= kLeastRoll && slip <= kMostRoll))
      refuse(
          key("ratio_of_roll"),
          "ratio_of_roll = {:.6g} is outside [{:.6g}, {:.6g}] about 1 / sin(pitch_angle): work per cradle, not cradle "
          "per work",
          cut.ratio_of_roll, kLeastRoll / std::sin(gear_.pitch_angle_rad), kMostRoll / std::sin(gear_.pitch_angle_rad));
  }

  void widths(bool one) {
    if (one && gear_.mean_space_width_mm)
      refuse("mean_space_width",
             "mean_space_width contradicts flank = \"both\": the settings of one cut fix the width");
    if (one && gear_.backlash_mm)
      refuse("backlash", "backlash contradicts flank = \"both\": the settings of one cut fix the width of the space");
    if (gear_.mean_space_width_mm && gear_.backlash_mm)
      refuse("backlash", "backlash contradicts mean_space_width: give one of the two");
    const double pitch = kTwoPi * gear_.mean_cone_distance() * std::sin(gear_.pitch_angle_rad) / gear_.teeth;
    if (!one && !(asked_space_width(gear_) < pitch))
      refuse(
          width_key(),
          "{} = {:.4f} mm: a space of {:.4f} mm is not below {:.4f} mm, the pitch at the mean cone distance; {:.4f} mm "
          "or less leaves a tooth",
          width_key(), gear_.backlash_mm.value_or(asked_space_width(gear_)), asked_space_width(gear_), pitch,
          told(stated_width(pitch)));
  }

  /// What states the width of the space of two cuts, and the number that it has there for a width.
  [[nodiscard]] const char* width_key() const { return gear_.backlash_mm ? "backlash" : "mean_space_width"; }
  [[nodiscard]] double stated_width(double width_mm) const {
    if (!gear_.backlash_mm) return width_mm;
    const double R_m = gear_.mean_cone_distance();
    return 2 * (width_mm - kPi * R_m * std::sin(gear_.pitch_angle_rad) / gear_.teeth) * gear_.outer_cone_distance_mm /
           R_m;
  }

  void rounding(const Cut& cut) {
    const auto share = [](const Blade& b) {
      return (1 - std::sin(b.pressure_angle_rad)) / std::cos(b.pressure_angle_rad);
    };
    const Blade &out = cut.blades[0], &in = cut.blades[1];
    const double width = out.point_radius_mm - in.point_radius_mm;
    if (!(width > 0))
      refuse("cut[0].blade_point_radius",
             "blade_point_radius = [{:.4f}, {:.4f}] mm: the blades cross, outside must be above inside",
             out.point_radius_mm, in.point_radius_mm);
    else if (!(share(out) * out.edge_radius_mm + share(in) * in.edge_radius_mm <= width))
      refuse("cut[0].tool_edge_radius",
             "tool_edge_radius = [{:.4f}, {:.4f}] mm does not fit between the blades, {:.4f} mm apart; {:.4f} or less "
             "would do",
             out.edge_radius_mm, in.edge_radius_mm, width, told(width / (share(out) + share(in))));
  }

  /// Root cones as they are stated and as the cuts make them.
  void roots() {
    const Cut& first = gear_.cuts.front();
    if (gear_.root_angle_rad &&
        gear_.face_width_mm * std::abs(std::sin(*gear_.root_angle_rad - first.root_angle_rad)) > kSameLine)
      refuse("root_angle",
             "root_angle = {:.6f} deg differs from machine_root_angle of the cut, {:.6f} deg, by {:.4f} mm over the "
             "face, limit {:g} mm; without the key it is that of the cut",
             degrees(*gear_.root_angle_rad), degrees(first.root_angle_rad),
             gear_.face_width_mm * std::abs(std::sin(*gear_.root_angle_rad - first.root_angle_rad)), kSameLine);
    const double apex = -root_apex_z(first);
    const double deeper = gear_.root_apex_mm.value_or(apex) - apex,
                 beside = std::abs(deeper) * std::sin(first.root_angle_rad);
    if (beside > kSameLine)
      refuse(
          "root_apex",
          "root_apex = {:.6f} mm: machine_center_to_crossing_point + sliding_base / sin(machine_root_angle) of "
          "the cut is {:.6f} mm; the root cones lie {:.4f} mm apart, limit {:g} mm; without the key it is that of the "
          "cut",
          *gear_.root_apex_mm, apex, beside, kSameLine);
    if (gear_.cuts.size() < 2) return;
    for (const double R : {gear_.outer_cone_distance_mm, gear_.outer_cone_distance_mm - gear_.face_width_mm}) {
      const auto h = [&](const Cut& c) { return cone_height(gear_, c.root_angle_rad, root_apex_z(c), -R); };
      const double apart = h(gear_.cuts[1]) - h(first);
      if (std::abs(apart) <= kSameLine) continue;
      const Cut& second = gear_.cuts[1];
      const bool angle =
          std::abs(std::sin(second.root_angle_rad - first.root_angle_rad)) * gear_.face_width_mm > kSameLine;
      const double sliding = (apex - second.machine_center_mm) * std::sin(first.root_angle_rad);
      refuse(
          angle ? "cut[1].machine_root_angle" : "cut[1].sliding_base",
          "{} = {:.6f} {}: the root cones of the two cuts lie {:.4f} mm apart at cone distance {:.4f} mm, limit {:g} "
          "mm; {}a sliding_base of {:.6f} mm would do here, or another machine_center_to_crossing_point",
          angle ? "machine_root_angle" : "sliding_base",
          angle ? degrees(second.root_angle_rad) : second.sliding_base_mm, angle ? "deg" : "mm", std::abs(apart), R,
          kSameLine, angle ? fmt::format("{:.6f} deg with ", degrees(first.root_angle_rad)) : std::string(), sliding);
      return;
    }
  }

  /// One flank with its fillet at one station.
  void flank(const CutterSpace& space, std::size_t i, double s) {
    const CutterKernel& k = space.kernel();
    const CutFlank& f = k.flanks[i];
    const int side = side_of(k, i);
    const auto& chart = space.outline().chart;
    const auto tip = space.tip_edge(side, s);
    const auto low = tooth_space::place_at(space, tooth_space::fillet_of(side), kPi / 2, s),
               join = tooth_space::place_at(space, tooth_space::fillet_of(side), f.alpha, s);
    if (low && !(space.tip(s) > chart.up(low->p)))
      return refuse("tip_angle",
                    "tip_angle = {:.4f} deg: the face cone lies {:.4f} mm below the root at cone distance {:.4f} mm",
                    degrees(gear_.tip_angle_rad), chart.up(low->p) - space.tip(s), -s);
    if (!low || !join) return no_root(space, i, s);
    if (!tip) return ends_early(space, i, s);
    const auto middle = space.at(tooth_space::flank_of(side), k.middle[i].x(), k.middle[i].y());
    // Along the fillet's angle the surface goes down, along the blade up.
    const auto sound = [&](Piece piece, double u) {
      const auto turns = [](const tooth_space::PatchPoint& q) { return q.n.dot(q.pu.cross(q.pv)); };
      const auto q = tooth_space::place_at(space, piece, u, s);
      if (q && middle && turns(*q) * turns(*middle) * (is_fillet(piece) ? -1 : 1) > 0) return true;
      refuse(cut_key(gear_, i, "blade_pressure_angle"),
             "blade_pressure_angle = {:.4f} deg: the cutter undercuts the {} flank at cone distance {:.4f} mm{}; more "
             "pressure angle or less depth is needed",
             degrees(f.alpha), i == 0 ? "concave" : "convex", -s,
             q ? fmt::format(", {:.4f} mm above the root", chart.up(q->p) - chart.up(low->p)) : std::string());
      return false;
    };
    for (int n = 0; n <= kHeights; ++n)
      if (!sound(tooth_space::fillet_of(side), f.alpha + (kPi / 2 - f.alpha) * n / kHeights)) return;
    if (!tooth_space::place_at(space, tooth_space::flank_of(side), f.u_F, s)) return ends_early(space, i, s);
    if (!sound(tooth_space::flank_of(side), f.u_F)) return;
    if (!(tip->u > f.u_F))
      return refuse("tip_angle",
                    "tip_angle = {:.4f} deg: the face cone lies {:.4f} mm below the end of the fillet at cone distance "
                    "{:.4f} mm",
                    degrees(gear_.tip_angle_rad), chart.up(join->p) - space.tip(s), -s);
    for (int n = 1; n <= kHeights; ++n) {
      const double u = f.u_F + (tip->u - f.u_F) * n / kHeights;
      if (!tooth_space::place_at(space, tooth_space::flank_of(side), u, s)) return ends_early(space, i, s);
      if (!sound(tooth_space::flank_of(side), u)) return;
    }
    for (const double v : {k.v_at(tooth_space::flank_of(side), tip->u, s), s})
      if (f.generated && !f.by_circle && !(f.work(f.parameter(v)).ratio > 0))
        return add(stands_still(gear_, i, f, f.parameter(v), -s));
  }

  void no_root(const CutterSpace& space, std::size_t i, double s) {
    refuse(cut_key(gear_, i, "radial_distance"),
           "radial_distance = {:.4f} mm: the {} blade makes no root at cone distance {:.4f} mm",
           space.kernel().flanks[i].S, blade_of(i), -s);
  }

  /// Up a flank from its fillet to the face cone at s, as far as it goes with its outside outwards; no end where there
  /// is no fillet.
  struct Climb {
    double end = 0, azimuth = 0;
    bool arrived = false;
    Vec2 at = Vec2::Zero();  ///< where it ends
  };
  static Climb climb(const CutterSpace& space, std::size_t i, double s) {
    const CutterKernel& k = space.kernel();
    const Piece piece = tooth_space::flank_of(side_of(k, i));
    const auto turns = [&](const Vec2& at) {
      const auto q = space.at(piece, at.x(), at.y());
      return q ? q->n.dot(q->pu.cross(q->pv)) : 0;
    };
    const double sense = turns(k.middle[i]), tip = space.tip(s);
    const auto join = tooth_space::place_at(space, tooth_space::fillet_of(side_of(k, i)), k.flanks[i].alpha, s);
    if (!join) return {-INFINITY};
    Climb out{space.outline().chart.up(join->p)};
    const double from = out.end;
    Vec2 at(k.flanks[i].u_F, s);
    for (int n = 0; n <= kRises; ++n) {
      const double h = from + (tip - from) * n / kRises;
      const auto next = k.solve(piece, s, h, at);
      if (!next || !(turns(*next) * sense > 0)) return out;
      at = *next;
      out.end = h;
    }
    out.at = at;
    const auto q = space.at(piece, at.x(), at.y());
    out.azimuth = q ? azimuth(q->p) : 0;
    out.arrived = q.has_value();
    return out;
  }

  /// A flank that the tooth does not have up to the face cone: by how much it ends below it, or where both meet.
  void ends_early(const CutterSpace& space, std::size_t i, double s) {
    const Climb own = climb(space, i, s), other = climb(space, 1 - i, s);
    const auto& outline = space.outline();
    if (own.arrived && other.arrived) {
      const double turn = side_of(space.kernel(), i) > 0 ? own.azimuth - other.azimuth : other.azimuth - own.azimuth,
                   land = outline.chart.r(s, space.tip(s)) * wrapped(turn + outline.pitch);
      return land > 0 ? edge_is_lost(space, i, s, own.at) : pointed(s, land);
    }
    const std::size_t ends = own.arrived ? 1 - i : i;
    const double end = (own.arrived ? other : own).end;
    if (!std::isfinite(end)) return no_root(space, ends, s);
    refuse("tip_angle",
           "tip_angle = {:.4f} deg: the {} flank ends {:.4f} mm below the face cone at cone distance {:.4f} mm",
           degrees(gear_.tip_angle_rad), ends == 0 ? "concave" : "convex", space.tip(s) - end, -s);
  }
  /// Both flanks are there at s and leave a land, but the edge of one cannot be followed over the whole face.
  void edge_is_lost(const CutterSpace& space, std::size_t i, double s, const Vec2& edge) {
    constexpr int kSteps = 256, kHalvings = 30;
    constexpr double kSteep = 100;  // times as fast as the cone distance grows
    const CutterKernel& k = space.kernel();
    const Piece piece = tooth_space::flank_of(side_of(k, i));
    double last = s;
    Vec2 at = edge;
    for (const double end : {-k.R_e, -k.R_i}) {
      last = s;
      at = edge;
      double step = (end - s) / kSteps;
      for (int halvings = 0; halvings < kHalvings && std::abs(end - last) > 1e-9;) {
        const auto next = k.solve(piece, last + step, space.tip(last + step), at);
        if (!next) {
          step *= 0.5;
          ++halvings;
          continue;
        }
        at = *next;
        last += step;
      }
      if (std::abs(end - last) > 1e-9) break;
    }
    const auto q = space.at(piece, at.x(), at.y());
    const bool turns = !q || std::abs(space.outline().chart.along(q->p, q->pv)) > kSteep;
    refuse(
        "tip_angle",
        "tip_angle = {:.4f} deg: the {} flank cannot be followed along the face cone beyond cone distance {:.4f} mm, "
        "the face is {:.4f} to {:.4f} mm{}",
        degrees(gear_.tip_angle_rad), i == 0 ? "concave" : "convex", -last, k.R_i, k.R_e,
        turns ? ": its contact lines run along the circles of the blade there, so that the roll of the cradle, by "
                "which it is followed, turns back"
              : "");
  }
  void pointed(double s, double land) {
    refuse("tip_angle",
           "tip_angle = {:.4f} deg: the tooth is pointed below the face cone at cone distance {:.4f} mm, its top land "
           "is {:.4f} mm, limit 0",
           degrees(gear_.tip_angle_rad), -s, land);
  }

  void hand(const CutterSpace& space) {
    const CutterKernel& k = space.kernel();
    for (std::size_t i = 0; i < 2; ++i) {
      const double spiral = spiral_of(space, side_of(k, i));
      if (spiral > kWrongHand) continue;
      return refuse(
          cut_key(gear_, i, "center_roll_position"),
          "center_roll_position = {:.4f} deg makes a {}-hand gear, spiral angle {:.2f} deg, limit {:g} deg; positive "
          "angles make the hand that is asked for",
          degrees(k.flanks[i].q), k.hand > 0 ? "left" : "right", -degrees(spiral), -degrees(kWrongHand));
    }
  }

  void across(const CutterSpace& space, double s) {
    const double root = root_land_mm(space, s);
    if (!(root >= 0)) {
      const double r = space.outline().chart.r(s, lowest(space, s)),
                   lack = -root / r * gear_.mean_cone_distance() * std::sin(gear_.pitch_angle_rad);
      if (gear_.cuts.size() > 1)
        refuse(width_key(),
               "{} = {:.4f} mm: a space of {:.4f} mm is narrower than its root: the fillets cross by {:.4f} mm at cone "
               "distance {:.4f} mm, limit 0; {:.4f} or more would do",
               width_key(), gear_.backlash_mm.value_or(asked_space_width(gear_)), asked_space_width(gear_), -root, -s,
               std::ceil(1e4 * stated_width(asked_space_width(gear_) + lack)) / 1e4);
      else
        refuse("cut[0].blade_point_radius",
               "blade_point_radius = [{:.4f}, {:.4f}] mm: the fillets cross by {:.4f} mm at cone distance {:.4f} mm, "
               "limit "
               "0: the blades are too close",
               gear_.cuts[0].blades[0].point_radius_mm, gear_.cuts[0].blades[1].point_radius_mm, -root, -s);
      return;
    }
    const double land = tooth_space::top_land_mm(space, s);
    if (!(land > 0)) pointed(s, land);
  }

 public:
  static double spiral_of(const CutterSpace& space, int side) {
    const CutterKernel& k = space.kernel();
    const Vec2 at = k.middle[k.index(side)];
    const auto q = space.at(tooth_space::flank_of(side), at.x(), at.y());
    if (!q) return 0;
    const auto& chart = space.outline().chart;
    // Along the pitch cone, outwards.
    Vec3 along = q->pv * chart.up(q->p, q->pu) - q->pu * chart.up(q->p, q->pv);
    if (chart.along(q->p, along) > 0) along = -along;
    const double around = (q->p.x() * along.y() - q->p.y() * along.x()) / radius(q->p);
    return k.hand * std::atan2(around, -chart.along(q->p, along));
  }

 private:
  const SpiralBevelParameters& gear_;
};

/// What is wrong with a gear; its kernel and body where nothing is.
struct Inspected {
  std::vector<Refusal> refusals;
  bool of_surfaces = false;  ///< the numbers themselves are no reason
  std::shared_ptr<const CutterSpace> space;
  double space_width_mm = 0;
  tooth_space::BevelBody body;
};

Inspected inspected(const SpiralBevelParameters& gear) {
  Inspected out;
  Inspection inspection(gear);
  inspection.numbers();
  if (inspection.refusals.empty()) inspection.cuts();
  out.refusals = inspection.refusals;
  if (!out.refusals.empty()) return out;
  out.of_surfaces = true;
  bool by_circle = false;
  const auto look = [&](bool by_rolls) {
    auto made = set_up(gear, by_rolls);
    if (auto* refusal = made.refused()) return std::vector<Refusal>{std::move(*refusal)};
    const auto& flanks = made->kernel.flanks;
    by_circle = flanks[0].by_circle || flanks[1].by_circle;
    out.space_width_mm = made->space_width_mm;
    out.space = std::make_shared<const CutterSpace>(made->kernel);
    Inspection over_face(gear);
    over_face.surfaces(*out.space);
    return std::move(over_face.refusals);
  };
  out.refusals = look(false);
  if (!out.refusals.empty() && by_circle) out.refusals = look(true);  // what is told is of the rolls
  if (!out.refusals.empty()) return out;
  out.body = body_of(gear, *out.space);
  if (auto bad = out.body.refusal(out.space->outline())) out.refusals = {std::move(*bad)};
  return out;
}

using Set = std::function<void(SpiralBevelParameters&, double)>;
using Search = std::function<std::optional<double>(double from, double to, const Set& set)>;

double up(double x) { return std::ceil(1e4 * x) / 1e4; }

/// `way_out` of a key that says how the cutter is set, not of its blades.
std::string way_out_by_setting(const SpiralBevelParameters& gear, const std::string& key, const Search& search) {
  if (key.ends_with(".radial_distance")) {
    const auto cut = std::size_t(key[4] - '0');
    const double S = gear.cuts[cut].radial_distance_mm;
    const auto radial = [&](SpiralBevelParameters& p, double x) { p.cuts[cut].radial_distance_mm = x; };
    if (const auto x = search(S, 0.5 * S, radial)) return fmt::format("; {:.4f} mm would do", told(*x));
    if (const auto x = search(S, 1.5 * S, radial)) return fmt::format("; {:.4f} mm would do", up(*x));
    return "; another blade_point_radius or center_roll_position is needed";
  }
  if (!key.ends_with(".modified_roll_coefficients")) return "";
  const auto x = search(1, 0, [&](SpiralBevelParameters& p, double share) {
    for (Cut& cut : p.cuts)
      for (double& c : cut.modified) c *= share;
  });
  return x ? fmt::format("; coefficients of {:.1f} % of them would do", std::floor(1e3 * *x) / 10)
           : "; smaller coefficients are needed";
}

/// What would make a gear of one whose surfaces are refused, in words.
std::string way_out(const SpiralBevelParameters& gear, const std::string& key) {
  const Search search = [&](double from, double to, const Set& set) {
    return that_does(from, to, [&](double x) {
      SpiralBevelParameters other = gear;
      set(other, x);
      return inspected(other).refusals.empty();
    });
  };
  const auto all_blades = [](SpiralBevelParameters& p, const auto& set) {
    for (Cut& cut : p.cuts)
      for (Blade& blade : cut.blades) set(blade);
  };
  const auto pressure = [&] {
    double least = INFINITY;
    for (std::size_t i = 0; i < 2; ++i)
      least = std::min(least, gear.cuts[cut_of(gear, i)].blades[i].pressure_angle_rad);
    return search(least, kMostPressure, [&](SpiralBevelParameters& p, double angle) {
      all_blades(p, [&](Blade& b) { b.pressure_angle_rad = std::max(b.pressure_angle_rad, angle); });
    });
  };
  if (key == "tip_angle") {
    const auto tip = [](SpiralBevelParameters& p, double x) { p.tip_angle_rad = x; };
    if (const auto x = search(gear.tip_angle_rad, gear.cuts.front().root_angle_rad, tip))
      return fmt::format("; {:.4f} deg or less would do", told(degrees(*x)));
    if (const auto x = search(gear.tip_angle_rad, gear.tip_angle_rad + kMostTip, tip))
      return fmt::format("; {:.4f} deg or more would do", up(degrees(*x)));
    if (const auto x = pressure())
      return fmt::format("; a blade_pressure_angle of {:.4f} deg would do", up(degrees(*x)));
    return "; none would do with these settings of the cutter";
  }
  const auto ends = [&](const char* name) { return key.ends_with(name); };
  if (ends(".blade_pressure_angle")) {
    const auto x = pressure();
    return x ? fmt::format(": {:.4f} deg would do", up(degrees(*x))) : "";
  }
  if (ends(".sliding_base") || ends(".blade_point_radius")) {
    double most = 0;
    for (std::size_t i = 0; i < 2; ++i) most = std::max(most, gear.cuts[cut_of(gear, i)].blades[i].edge_radius_mm);
    const auto x = search(most, 0.05 * most, [&](SpiralBevelParameters& p, double radius) {
      all_blades(p, [&](Blade& b) { b.edge_radius_mm = std::min(b.edge_radius_mm, radius); });
    });
    return x ? fmt::format("; a tool_edge_radius of {:.4f} mm or less would do", told(*x))
             : "; a deeper cut or other blades are needed";
  }
  return way_out_by_setting(gear, key, search);
}

}  // namespace

Expected<SpiralBevelGear, std::vector<Refusal>> SpiralBevelGear::make(const SpiralBevelParameters& parameters) {
  Inspected found = inspected(parameters);
  if (found.of_surfaces)
    for (Refusal& refusal : found.refusals) refusal.diagnostic.message += way_out(parameters, refusal.key);
  if (!found.refusals.empty()) return std::move(found.refusals);
  SpiralBevelGear gear;
  gear.parameters_ = parameters;
  gear.space_width_mm_ = found.space_width_mm;
  gear.space_ = std::move(found.space);
  gear.body_ = found.body;
  return gear;
}

double SpiralBevelGear::spiral_angle(int side) const { return Inspection::spiral_of(*space_, side); }

double root_land_mm(const CutterSpace& space, double s) {
  const auto plus = tooth_space::place_at(space, Piece::fillet_plus, kPi / 2, s),
             minus = tooth_space::place_at(space, Piece::fillet_minus, kPi / 2, s);
  if (!plus || !minus) return NAN;
  return radius(plus->p) * wrapped(azimuth(minus->p) - azimuth(plus->p));
}

tooth_space::ToothedSolid drawn_solid(const SpiralBevelGear& gear) {
  tooth_space::ToothedSolid out = tooth_space::bevel_solid(gear.space(), gear.body());
  out.ways_out = {"a smaller tip_angle leaves a wider land", "a smaller tool_edge_radius leaves a wider land", ""};
  return out;
}

std::shared_ptr<const tooth_space::ToothedPart> part_of(const SpiralBevelGear& gear) {
  return tooth_space::bevel_part(gear.shared_space(), gear.body());
}

}  // namespace toothpath::spiral_bevel
