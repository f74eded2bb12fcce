// Is a point of a bevel blank cut away, and how deep does a place lie in what must remain? Answered by the solid finger
// mill along the paths that define the two walls of a space, without any equation of meshing: the definitions (trace,
// equidistant, cutter, ends of the passes) are written out from docs/bevel_gear.md and share no code with geometry/.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "geometry/base/vec.h"
#include "geometry/bevel_gear/parameters.h"

namespace toothpath::test {

/// What defines a finger mill; mm.
struct FingerMill {
  double module = 0, tip_radius = 0, rack_depth = 0, profile_height = 0;
};

/// Least value of a function in an interval: places evenly spread, then a search beside the two lowest of them.
[[nodiscard]] double least_of(const std::function<double(double)>& f, double from, double to, int places,
                              double* at = nullptr);

/// What a mill takes more than the plain one at a depth below the tip of the teeth.
using TakenAtDepth = std::function<double(double)>;

/// A finger mill as a body of revolution. x along its axis from the pitch cone towards the shank, the flat tip at
/// -dedendum.
class PlainFingerMill {
 public:
  /// @param pitch_radius of the equivalent gear
  /// @param taken  null: nothing; its bends end at the depth `bent_to`  @param addendum  where the depth begins
  PlainFingerMill(const FingerMill& mill, double pressure_angle, double pitch_radius, double dedendum,
                  TakenAtDepth taken = nullptr, double bent_to = 0, double addendum = 0);
  /// Distance of a point to the solid, positive outside; exact near the surface, elsewhere of the right sign.
  [[nodiscard]] double clearance(double x, double rho) const;
  struct Place {
    double x = 0, rho = 0, normal_x = 0, normal_rho = 1;  ///< normal out of the cutter
  };
  /// Places of the profile from the flat to the height x.
  [[nodiscard]] std::vector<Place> places(double to_x, int count) const;
  [[nodiscard]] double half_width() const { return r_0_; }        ///< r_0, along the arc
  [[nodiscard]] double largest_radius() const { return rho_D_; }  ///< of the cylinder above the profile
  /// Radius at a height of the profile.
  [[nodiscard]] double radius_at(double x) const;
  /// Largest tip radius that leaves a flat, and that keeps the arc below the involute.
  [[nodiscard]] std::array<double, 2> largest_tip_radii() const;

 private:
  [[nodiscard]] Place involute(double tangent) const;
  /// On the straight below C, `back` from it, without modification.
  [[nodiscard]] Place plain_line(double back) const;
  /// A place of the plain flank moved by what is taken there, and turned by its slope.
  [[nodiscard]] Place modified(const std::function<Place(double)>& plain, double at, double step) const;
  TakenAtDepth taken_;
  double addendum_ = 0;
  double to_S_ = 0;  ///< from C back to where the straight of a modified mill begins; S_ is that place
  Place S_;
  double r_v_, r_b_, r_0_, start_, dedendum_, r_t_, t_C_, t_D_, x_D_, rho_D_;
  Place C_;
  double x_o_ = 0, rho_o_ = 0, to_B_ = 0;
};

/// One tooth space, centred on azimuth 0 at the reference cone distance.
class BruteForceBevelGear {
 public:
  BruteForceBevelGear(const bevel_gear::BevelGearParameters& gear, const FingerMill& mill);

  /// Least distance of a place to the mill along the passes of this space, positive in the material that remains,
  /// negative where cut; of the right sign everywhere within the face.
  [[nodiscard]] double clearance(const Vec3& place) const;
  /// How deep a place lies in what must remain; negative outside of it, by at least its distance or where it is cut
  /// away by how much. Any value not above `enough` ends the search.
  [[nodiscard]] double depth(const Vec3& place, double enough = -1e9) const;
  /// Azimuth of the wall sigma (+1: lower azimuth) at cone distance and height above the pitch cone.
  [[nodiscard]] double wall(int sigma, double ell, double height) const;
  /// Azimuths between which the axis of the mill may be at a cone distance.
  [[nodiscard]] std::array<double, 2> room(double cone_distance) const;
  [[nodiscard]] Vec3 place(double ell, double azimuth, double height) const;
  [[nodiscard]] double ell_of(const Vec3& p) const { return p.head<2>().norm() * sin_d_ + p.z() * cos_d_; }
  [[nodiscard]] double height_of(const Vec3& p) const { return p.head<2>().norm() * cos_d_ - p.z() * sin_d_; }
  [[nodiscard]] bool in_groove(double ell, double margin = 0) const;
  [[nodiscard]] double pitch() const { return pitch_; }
  [[nodiscard]] double inner() const { return R_i_; }
  [[nodiscard]] double outer() const { return R_e_; }
  [[nodiscard]] double normal_module(double cone_distance) const;
  [[nodiscard]] double pitch_angle() const { return delta_; }
  [[nodiscard]] const PlainFingerMill& mill() const { return mill_; }
  /// How far along the axis of the face the circle of the mill at the height of the tip touches the walls beside the
  /// corner of a herringbone, seen from there.
  [[nodiscard]] double corner_reach() const;
  /// How far from the middle of the groove, at the tip of the teeth, the mill as it stands in the corner makes the
  /// wall.
  [[nodiscard]] double fillet_reach() const;
  /// Width of the lands between two spaces at a cone distance, at the height of the tip; negative: pointed.
  [[nodiscard]] double top_land(double cone_distance) const;

 private:
  /// Path of one wall on the crown plane as a polar angle over the cone distance of the cutter's axis.
  struct Path {
    int sigma = 1;
    double from = 0, to = 0;                // cone distances of the axis
    double corner_from = 0, corner_to = 0;  // of the arc about the corner of the trace, or both where the halves cross
    double straight = 0, straight_angle = 0,
           straight_foot = 0;  // run-out: from here; direction; distance from the apex
    struct Piece {
      double from = 0, step = 1;
      std::vector<double> polar;
    };
    std::vector<Piece> pieces;  // the same, tabulated
  };
  [[nodiscard]] double beta(double R) const;
  [[nodiscard]] double trace(double R, int hand) const;
  [[nodiscard]] int hand_of(bool outer) const { return outer ? -inner_hand_ : inner_hand_; }
  /// Half width of the mill less what its path takes at this foot; the middle of the face decides the half.
  [[nodiscard]] double width_at(double R, int sigma, bool outer) const;
  [[nodiscard]] double foot_of(double R_c, int sigma, int hand) const;
  [[nodiscard]] bool is_outer(int hand) const { return herringbone_ && hand != inner_hand_; }
  [[nodiscard]] double on_equidistant(double R_c, int sigma, int hand) const;
  [[nodiscard]] double polar(const Path& path, double R_c) const;
  [[nodiscard]] Path path_of(int sigma) const;
  void tabulate(Path& path) const;
  [[nodiscard]] static double tabulated(const Path& path, double R_c);
  [[nodiscard]] double to_mill(const Vec3& p, double R_c, double theta) const;
  [[nodiscard]] double clearance(const Vec3& p, double enough) const;

  static double pitch_angle_of(const bevel_gear::BevelGearParameters& gear);
  bevel_gear::BevelGearParameters gear_;
  double delta_, sin_d_, cos_d_, R_e_, R_i_, R_0_, R_ref_, half_space_, pitch_;
  bool herringbone_;
  int inner_hand_;
  double lean_;  ///< of the mill's flank at the pitch cone, against its axis
  PlainFingerMill mill_;
  std::array<Path, 2> paths_;  // L, U
};

}  // namespace toothpath::test
