#include "geometry/straight_bevel/gear.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "geometry/base/angle.h"
#include "geometry/base/refusals.h"
#include "geometry/tooth_space/limits.h"

template class toothpath::tooth_space::KernelSpace<toothpath::straight_bevel::CrownKernel<double>>;

namespace toothpath::straight_bevel {
namespace {

using tooth_space::Piece;

constexpr int kLeastTeeth = 5, kMostTeeth = 2000;
constexpr double kLeastPitchAngle = 3, kMostPitchAngle = 89.9;  // deg
constexpr double kElevationShare = 0.95;  // of the pressure angle, where a crown of involutes ends
constexpr int kHalvings = 60;

/// The greatest value in (0, most] that a test admits, when smaller ones are better; 0: none is found.
double largest(double most, const std::function<bool(double)>& does) {
  double low = 0, high = most;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (does(middle) ? low : high) = middle;
  }
  return low;
}
double told(double x) { return std::floor(1e4 * x) / 1e4; }

tooth_space::BevelBody body_of(const StraightBevelParameters& p, const CrownKernel<double>& w) {
  const double slope = std::tan(w.theta_f);
  return {p.teeth,        p.outer_transverse_module_mm, -p.dedendum_mm,    -w.R_e * slope,
          -w.R_i * slope, p.bore_diameter_mm,           p.hub_diameter_mm, p.hub_length_mm};
}

/// Gathers what is wrong with a gear.
class Inspection : public Refusals {
 public:
  explicit Inspection(const StraightBevelParameters& gear) : gear_(gear) {}

  void numbers() {
    integer_range("teeth", gear_.teeth, kLeastTeeth, kMostTeeth);
    range("pitch_angle", degrees(gear_.pitch_angle_rad), kLeastPitchAngle, kMostPitchAngle, " deg");
    range("outer_transverse_module", gear_.outer_transverse_module_mm, 0.05, 100, " mm");
    range("pressure_angle", degrees(gear_.pressure_angle_rad), 5, 45, " deg");
    range("thickness_shift", gear_.thickness_shift, -0.5, 0.5, "");
    range("backlash", gear_.backlash_mm, 0, gear_.outer_transverse_module_mm, " mm");
    range("least_land", gear_.least_land, 0, 2, "");
    positive("face_width", gear_.face_width_mm);
    positive("addendum", gear_.addendum_mm);
    positive("dedendum", gear_.dedendum_mm);
    positive("fillet_radius", gear_.fillet_radius_mm);
    not_negative("bore_diameter", gear_.bore_diameter_mm);
    not_negative("hub_diameter", gear_.hub_diameter_mm);
    not_negative("hub_length", gear_.hub_length_mm);
  }

  /// Limits of the blank.
  void cones(const CrownKernel<double>& w) {
    if (!(gear_.face_width_mm < 0.9 * w.R_e)) {
      refuse("face_width", "face_width = {:.4f} mm is not below {:.4f} mm, 0.9 of the outer cone distance",
             gear_.face_width_mm, 0.9 * w.R_e);
      return;
    }
    if (!(w.theta_f < gear_.pitch_angle_rad))
      return refuse(
          "dedendum", "dedendum = {:.4f} mm gives a root angle of {:.4f} deg, limit 0; less than {:.4f} mm would do",
          gear_.dedendum_mm, degrees(gear_.pitch_angle_rad - w.theta_f), w.R_e * std::tan(gear_.pitch_angle_rad));
    const double h_root = -std::tan(w.theta_f) * w.R_i, h_tip = w.tip<double>(-w.R_i);
    if (!(h_tip > h_root))
      refuse_tip(-w.R_i, fmt::format("the face cone lies {:.4f} mm below the root cone", h_root - h_tip));
    if (gear_.tip_angle_rad && !(std::abs(*gear_.tip_angle_rad - gear_.pitch_angle_rad) < radians(45)))
      refuse("tip_angle", "tip_angle = {:.4f} deg is not within 45 deg of the pitch angle, {:.4f} deg",
             degrees(*gear_.tip_angle_rad), degrees(gear_.pitch_angle_rad));
    if (!(w.psi > 0 && w.psi * w.sin_d < 1))
      refuse("thickness_shift", "thickness_shift = {:.4f} leaves a space of {:.4f} mm on the outer pitch circle",
             gear_.thickness_shift, 2 * w.psi * w.R_e);
    if (auto bad = body_of(gear_, w).refusal(w.outline())) refusals.push_back(std::move(*bad));
    if (gear_.form != Form::spherical_involute) return;
    const double limit = kElevationShare * gear_.pressure_angle_rad,
                 tip = std::max(std::atan2(gear_.addendum_mm, w.R_e), std::atan2(h_tip, w.R_i));
    if (w.theta_f > limit)
      refuse("dedendum",
             "dedendum = {:.4f} mm: the crown gear of spherical involutes ends {:.4f} mm below the pitch cone",
             gear_.dedendum_mm, w.R_e * std::tan(limit));
    if (tip > limit)
      refuse("addendum",
             "addendum = {:.4f} mm: the crown gear of spherical involutes ends {:.4f} mm above the pitch cone",
             gear_.addendum_mm, w.R_e * std::tan(limit));
  }

  void rounding(const CrownKernel<double>& w) {
    if (w.chi >= 0 && w.b_F > 0) return;
    const auto with = [&](double StraightBevelParameters::*number, double x) {
      StraightBevelParameters other = gear_;
      other.*number = x;
      const CrownKernel<double> k(other);
      return k.chi >= 0 && k.b_F > 0;
    };
    const double most = largest(gear_.dedendum_mm / (1 - std::sin(gear_.pressure_angle_rad)), [&](double radius) {
      return with(&StraightBevelParameters::fillet_radius_mm, radius);
    });
    if (most > 0)
      return refuse("fillet_radius",
                    "fillet_radius = {:.4f} mm does not fit on the crown gear's tooth tip; {:.4f} or less would do",
                    gear_.fillet_radius_mm, told(most));
    // Nothing is left of the tip: a thick gear tooth makes a thin one of the crown gear, and a deep one ends in a
    // point.
    StraightBevelParameters sharp = gear_;
    sharp.fillet_radius_mm = 0;
    const double least_shift = -0.5, shift = least_shift + largest(gear_.thickness_shift - least_shift, [&](double x) {
                                               return with(&StraightBevelParameters::thickness_shift, least_shift + x);
                                             });
    const double dedendum =
        largest(gear_.dedendum_mm, [&](double x) { return with(&StraightBevelParameters::dedendum_mm, x); });
    const bool thick = with(&StraightBevelParameters::thickness_shift, std::min(0.0, gear_.thickness_shift));
    std::string way;
    if (shift > least_shift) way = fmt::format("a thickness_shift of {:.4f} or less", std::floor(1e4 * shift) / 1e4);
    if (dedendum > 0)
      way += fmt::format("{}a dedendum of {:.4f} mm or less", way.empty() ? "" : ", or ", told(dedendum));
    refuse(
        thick ? "thickness_shift" : "dedendum",
        "{}: the tip of the crown gear's tooth is {:.4f} mm wide at the large end and has no width for a rounding of "
        "{:.4f} mm; {}",
        thick ? fmt::format("thickness_shift = {:.4f}", gear_.thickness_shift)
              : fmt::format("dedendum = {:.4f} mm", gear_.dedendum_mm),
        2 * w.R_e * CrownKernel<double>(sharp).chi, gear_.fillet_radius_mm,
        way.empty() ? std::string("less pressure angle is needed") : way + " would do");
  }

  void undercut(const CrownKernel<double>& w) {
    const auto cut = [](const CrownKernel<double>& k) { return !(flank_speed(k, k.u_F) > 0); };
    if (!cut(w)) return;
    const double most = largest(gear_.dedendum_mm, [&](double dedendum) {
      StraightBevelParameters other = gear_;
      other.dedendum_mm = dedendum;
      const CrownKernel<double> k(other);
      return k.b_F > 0 && !cut(k);
    });
    const std::string way =
        most > 0 ? fmt::format("a dedendum of {:.4f} mm or less would do, or more pressure angle or fillet_radius",
                               told(most))
                 : std::string("more pressure angle or more teeth are needed");
    refuse("dedendum", "dedendum = {:.4f} mm: the crown gear undercuts the flank of {} teeth above the fillet; {}",
           gear_.dedendum_mm, gear_.teeth, way);
  }

  void lands(const CrownSpace& space) {
    const auto& w = space.kernel();
    const double least = gear_.least_land * gear_.outer_transverse_module_mm;
    for (const double s : {-w.R_e, -w.R_i}) {
      const double share = -s / w.R_e;  // widths shrink with the cone distance
      const double land = tooth_space::top_land_mm(space, s);
      const auto join = tooth_space::place_at(space, Piece::flank_plus, space.borders(Piece::flank_plus).to, s);
      const double sunk = join ? space.outline().chart.up(join->p) - space.tip(s) : NAN;
      if (sunk >= 0) {
        refuse_tip(s, fmt::format("the face cone lies {:.4f} mm below the end of the fillet", sunk));
        return;
      }
      if (land >= least * share) continue;
      if (!(land > 0))
        refuse_tip(
            s, land < 0
                   ? fmt::format("the tooth is pointed below the face cone, its top land is {:.4f} mm (limit 0)", land)
                   : fmt::format("the flanks end {:.4f} mm below the face cone (limit 0)",
                                 space.tip(s) - top_of(space, s)));
      else
        refuse_tip(s, fmt::format("the top land is {:.4f} mm, the least is {:.4f} mm ({:g} modules)", land,
                                  least * share, gear_.least_land));
      return;
    }
  }

 private:
  /// Highest place of a flank at s: the crown gear's flank ends a quarter turn beyond the pitch line of the octoid, or
  /// beyond the base cone of the involute.
  static double top_of(const CrownSpace& space, double s) {
    constexpr int kSteps = 512;
    const auto& w = space.kernel();
    const double from = w.u_F, to = w.form == Form::octoid ? -kPi / 2 : kPi / 2;
    double top = -INFINITY;
    for (int k = 0; k <= kSteps; ++k)
      if (const auto q = tooth_space::place_at(space, Piece::flank_minus, from + (to - from) * k / kSteps, s))
        top = std::max(top, space.outline().chart.up(q->p));
    return top;
  }
  /// A face cone that the tooth does not reach, or the fillet passes: what states it there, and what would do.
  void refuse_tip(double s, const std::string& what) {
    const CrownKernel<double> w(gear_);
    const bool angle = gear_.tip_angle_rad && s > -w.R_e;
    const double R_e = w.R_e, natural = gear_.pitch_angle_rad + std::atan2(gear_.addendum_mm, R_e);
    const double asked = angle ? *gear_.tip_angle_rad : gear_.addendum_mm;
    std::string way;
    if (helps_) {
      const auto found = that_does(asked, angle ? natural : 0.02 * asked, [&](double x) {
        StraightBevelParameters other = gear_;
        (angle ? *other.tip_angle_rad : other.addendum_mm) = x;
        const CrownKernel<double> kernel(other);
        Inspection tried(other);
        tried.helps_ = false;
        tried.cones(kernel);
        if (tried.refusals.empty()) tried.lands(CrownSpace(kernel));
        return tried.refusals.empty();
      });
      const double unit = angle ? kDegree : 1;
      if (found && *found < asked) way = fmt::format("; {:.4f} or less would do", told(*found / unit));
      else if (found) way = fmt::format("; {:.4f} or more would do", std::ceil(1e4 * *found / unit) / 1e4);
      else if (angle) way = fmt::format("; {:.4f} deg lets the tooth shrink with its cone distance", degrees(natural));
      else way = "; more pressure angle, or another thickness_shift";
    }
    refuse(angle ? "tip_angle" : "addendum", "{} = {:.4f} {}: {} at cone distance {:.4f} mm{}",
           angle ? "tip_angle" : "addendum", angle ? degrees(asked) : asked, angle ? "deg" : "mm", what, -s, way);
  }

  const StraightBevelParameters& gear_;
  bool helps_ = true;  ///< is it told what would do?
};

}  // namespace

double pitch_angle(int teeth, int mate_teeth, double shaft_angle_rad) {
  return std::atan2(std::sin(shaft_angle_rad), double(mate_teeth) / teeth + std::cos(shaft_angle_rad));
}

double flank_speed(const CrownKernel<double>& w, double u) {
  // The curve on the unit sphere goes on along n x P, towards the tip where u falls (octoid) or grows (involute).
  using D = Dual<double, 2>;
  Vec3T<D> p, n;
  if (!w.place<D>(Piece::flank_minus, D::variable(u, 0), D(-1.0), p, n)) return 0;
  const Vec3 along = value(n).cross(value(p));
  const double sense = w.form == Form::octoid ? -1 : 1;
  // Outwards the polar angle grows: z falls.
  return sense * derivative(p, 0).dot(along) * (along.z() < 0 ? 1 : -1);
}

Expected<StraightBevelGear, std::vector<Refusal>> StraightBevelGear::make(const StraightBevelParameters& parameters) {
  Inspection inspection(parameters);
  inspection.numbers();
  if (!inspection.refusals.empty()) return std::move(inspection.refusals);
  const CrownKernel<double> kernel(parameters);
  inspection.cones(kernel);
  if (inspection.refusals.empty()) inspection.rounding(kernel);
  if (inspection.refusals.empty()) inspection.undercut(kernel);
  if (!inspection.refusals.empty()) return std::move(inspection.refusals);
  StraightBevelGear gear;
  gear.parameters_ = parameters;
  gear.space_ = std::make_shared<const CrownSpace>(kernel);
  gear.body_ = body_of(parameters, kernel);
  inspection.lands(*gear.space_);
  if (!inspection.refusals.empty()) return std::move(inspection.refusals);
  return gear;
}

tooth_space::ToothedSolid drawn_solid(const StraightBevelGear& gear) {
  tooth_space::ToothedSolid out = tooth_space::bevel_solid(gear.space(), gear.body());
  out.ways_out = {"less addendum leaves a wider land", "a smaller fillet_radius leaves a wider land", ""};
  return out;
}

std::shared_ptr<const tooth_space::ToothedPart> part_of(const StraightBevelGear& gear) {
  return tooth_space::bevel_part(gear.shared_space(), gear.body());
}

}  // namespace toothpath::straight_bevel
