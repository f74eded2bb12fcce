// A whole equal-base-circle bevel gear as the finger mill leaves it: halves, walls, corner, blank and limits. The one
// object that planners and checks ask.
//
// Blank frame: origin at the pitch apex, z the axis, body on z > 0. Tooth space 0 is centred on theta(R_ref) = 0, the
// azimuth 0 of the frame. Halves count from the inside. Derivation: docs/bevel_gear.md.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "geometry/base/refusal.h"
#include "geometry/base/result.h"
#include "geometry/bevel_gear/parameters.h"
#include "geometry/bevel_gear/surface.h"

namespace toothpath::bevel_gear {

/// Numbers that the report and limits.json show; mm and rad.
struct BevelLimits {
  double top_land_mm = 0;             ///< at R_i, normal to the tooth, backlash taken off: of the walls as they are cut
  double space_width_mm = 0;          ///< at R_i, normal, pitch cone
  double module_at_small_end_mm = 0;  ///< m_n(R_i)
  double module_limit_mm = 0;         ///< largest m_nj: 0.99 m_n(R_i)
  double tip_flat_mm = 0;             ///< rho_A, radius of the flat tip
  double tip_radius_limit_mm = 0;     ///< largest r_t: tip not pointed, arc below C
  double line_angle_rad = 0;          ///< phi of the straight BC
  double fillet_reach_mm = 0;         ///< of the herringbone corner's fillet about R_J at the tip; 0 for a single hand
  double least_regularity = 0;        ///< smallest J_n over both walls of all halves
  double cusp_speed_ratio = 0;        ///< smallest F of any pass
  double cusp_loss_mm = 0;            ///< flank error where a path has to leave the trace before its cusp
  double largest_face_width_mm = 0;   ///< b at which m_nj = 0.99 m_n(R_i)
};

/// One hand of teeth, between two cone distances.
struct BevelHalf {
  int hand = 1;
  double R_from = 0, R_to = 0;      ///< trace of this half
  double ell_from = 0, ell_to = 0;  ///< face that is left after the relief groove, at most up to R_lim
  BevelWall<double> walls[2];       ///< L (sigma = +1), U (sigma = -1)
  /// Ends of each wall's pass as spiral angles of the trace, at R_from's and R_to's side (6.2 of the page). On the
  /// concave side of a herringbone the path stops at the crossing.
  double beta_from[2] = {0, 0}, beta_to[2] = {0, 0};

  [[nodiscard]] const BevelWall<double>& wall(int sigma) const { return walls[sigma > 0 ? 0 : 1]; }
};

/// Where the offset curves of the concave side of a herringbone cross.
struct BevelCorner {
  int sigma = 0;                          ///< wall whose corner is concave: -h of the inner half
  double beta_inner = 0, beta_outer = 0;  ///< spiral angles of the two traces
  double R_c = 0, e = 0;                  ///< the crossing
};

/// What modifications come to.
struct ModifiedForm {
  double profile_mm = 0, profile_turned_rad = 0;  ///< taken by the profile of the mill, and turn of the normals by it
  double lead_mm = 0, lead_turned_rad = 0;        ///< taken by its paths at the pitch cone
  double top_land_mm = 0, plain_top_land_mm = 0;  ///< BevelLimits::top_land_mm, and that of the plain gear
};

class BevelGear {
 public:
  /// Checks every limit of section 4, 6 and 11 of the page. `cutter` is the mill that finishes the walls.
  static Expected<BevelGear, std::vector<Refusal>> make(const BevelGearParameters& parameters,
                                                        const FingerCutterData& cutter);

  [[nodiscard]] const BevelGearParameters& parameters() const { return parameters_; }
  [[nodiscard]] const FingerCutterData& cutter_data() const { return cutter_; }
  [[nodiscard]] const FingerProfile<double>& cutter() const { return halves_.front().walls[0].cutter; }
  [[nodiscard]] const std::vector<BevelHalf>& halves() const { return halves_; }
  [[nodiscard]] const BevelCorner& corner() const { return corner_; }
  [[nodiscard]] bool herringbone() const { return halves_.size() == 2; }
  [[nodiscard]] const BevelLimits& limits() const { return limits_; }
  /// With a modification that takes something.
  [[nodiscard]] const std::optional<ModifiedForm>& modified() const { return modified_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  [[nodiscard]] double delta() const { return delta_; }
  [[nodiscard]] double sin_delta() const { return sin_delta_; }
  [[nodiscard]] double cos_delta() const { return cos_delta_; }
  [[nodiscard]] double R_e() const { return R_e_; }
  [[nodiscard]] double R_i() const { return R_i_; }
  [[nodiscard]] double R_m() const { return R_e_ - parameters_.face_width_mm / 2; }
  [[nodiscard]] double R_0() const { return R_0_; }
  [[nodiscard]] double R_ref() const { return R_ref_; }
  [[nodiscard]] double kappa_v() const { return cos_delta_ / (R_0_ * sin_delta_); }  ///< 1/r_v
  [[nodiscard]] double e_h() const { return e_h_; }
  [[nodiscard]] double pitch() const;  ///< 2 pi / z
  /// Normal module at cone distance R.
  [[nodiscard]] double normal_module(double R) const;
  /// The profile that a mill of this gear has.
  [[nodiscard]] FingerProfile<double> profile_of(const FingerCutterData& cutter) const;
  /// A trace of this gear for a cutter with half width r_0, hand h; without modifications along the face.
  [[nodiscard]] BevelTrace<double> trace(int h, double r_0) const;

  /// Cutter-frame pose: tip and axis (tip to shank) in the blank frame, tip `lift` above its working depth.
  [[nodiscard]] Vec3 tip(double R_c, double e, double lift = 0) const;
  [[nodiscard]] Vec3 axis(double e) const;

 private:
  BevelGear() = default;
  BevelGearParameters parameters_;
  FingerCutterData cutter_;
  std::vector<BevelHalf> halves_;
  BevelCorner corner_;
  BevelLimits limits_;
  std::optional<ModifiedForm> modified_;
  std::vector<std::string> warnings_;
  double delta_ = 0, sin_delta_ = 0, cos_delta_ = 0, R_e_ = 0, R_i_ = 0, R_0_ = 0, R_ref_ = 0, e_h_ = 0;
  friend class BevelGearBuilder;
};

/// Crossing of the offset curves of wall sigma of two traces of opposite hand: 2 x 2 Newton, 1e-13 of R.
/// @param R_J where the traces meet. Empty: no crossing near R_J.
[[nodiscard]] std::optional<BevelCorner> bevel_corner(const BevelTrace<double>& inner, const BevelTrace<double>& outer,
                                                      int sigma, double R_J);

/// rho sin(gamma) of the contact at the tip height h_a: how far from its cutter centre a pass forms the wall, mm.
[[nodiscard]] double contact_reach(const BevelWall<double>& wall, double beta, double height);

}  // namespace toothpath::bevel_gear
