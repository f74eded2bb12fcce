// The flanks of a bevel pair for the cells: every pair of teeth that comes near, and any place of the wheel's wall
// against the pinion's. docs/loaded_contact.md 8.
#pragma once

#include <limits>

#include "geometry/loaded/cell_flanks.h"
#include "geometry/loaded_bevel/loaded_bevel_pair.h"

namespace toothpath::loaded_bevel {

/// Flanks of pairs that are farther apart than this when the first one touches are not looked at, mm.
inline constexpr double kFarthestGap = 0.25;

class BevelFlanks final : public loaded::CellFlanks {
 public:
  /// @param phi_1  turn of the pinion at the exact ratio
  BevelFlanks(const LoadedBevelPair& pair, double phi_1);

  [[nodiscard]] const loaded::CellBodies& bodies() const override { return bodies_; }
  [[nodiscard]] const std::vector<loaded::CellSite>& sites() const override { return sites_; }
  [[nodiscard]] double line_mm() const override { return 0; }
  /// sigma times the turn of the rigid pinion beyond the exact ratio, rad: there the gaps count from. With sites only.
  [[nodiscard]] double first_turn() const { return first_; }
  /// A tooth that comes near but has no site, since its flanks cannot be continued about any place of theirs; and the
  /// approach at which it would touch.
  struct Siteless {
    int tooth = 0;
    double approach_mm = std::numeric_limits<double>::infinity();
  };
  [[nodiscard]] const Siteless& nearest_siteless() const { return siteless_; }
  [[nodiscard]] std::vector<loaded::CellPlace> places(const loaded::CellSite& site, int columns,
                                                      int rows) const override;

 private:
  /// A place of wall sigma of the wheel by the parameters of its envelope.
  struct WheelPlace {
    double beta = 0, p = 0;
    Vec3 blank = Vec3::Zero(), point = Vec3::Zero(), normal = Vec3::Zero();  ///< blank frame; fixed frame, both others
    double lever_1 = 0, lever_2 = 0;                                         ///< about the axes of pinion and wheel
  };
  struct Tooth {
    int half = 0, tooth = 0;
    std::vector<WheelPlace> grid;  ///< row-major from the lowest row; where the wheel has its flank
    std::vector<double> turned;    ///< sigma times the turn of the pinion beyond the exact ratio; NaN: it is not there
    std::vector<contact::BevelNear> near;                                     ///< the same grid, whole
    contact::BevelNear first{std::numeric_limits<double>::infinity(), 0, 0};  ///< the place that is met first
  };
  [[nodiscard]] double turn_of_wheel(int tooth) const;
  [[nodiscard]] WheelPlace wheel_place(int half, int tooth, double beta, double p) const;
  /// Of the pinion at a place, sigma (phi_1 - nominal), also beyond its edges.
  [[nodiscard]] std::optional<contact::BevelTouch> touch(int half, int tooth, const WheelPlace& at,
                                                         bevel_gear::BevelInverse& start) const;
  [[nodiscard]] double turned(int tooth, const contact::BevelTouch& touch) const;
  [[nodiscard]] Tooth look_at(int half, int tooth) const;
  /// The place above a point (x, y) of a site's plane, by Newton; empty: the wall does not reach it.
  [[nodiscard]] std::optional<WheelPlace> above(const loaded::CellSite& site, int half, const Vec2& at,
                                                const WheelPlace& near) const;
  [[nodiscard]] std::optional<double> gap_above(const loaded::CellSite& site, int half, const Vec2& at,
                                                const WheelPlace& near) const;
  /// A site at a place of the grid; empty: the flanks cannot be continued around it.
  [[nodiscard]] std::optional<loaded::CellSite> site_at(const Tooth& tooth, const WheelPlace& middle) const;
  void add(const Tooth& tooth);
  [[nodiscard]] loaded::CellPlace cell_at(const loaded::CellSite& site, int half, const WheelPlace& at,
                                          bevel_gear::BevelInverse& start) const;

  const LoadedBevelPair& pair_;
  double phi_1_, first_ = 0;  ///< least of `turned`: where the rigid pinion stops
  loaded::CellBodies bodies_;
  std::vector<loaded::CellSite> sites_;
  std::vector<WheelPlace> middles_;  ///< of the sites
  Siteless siteless_;
};

}  // namespace toothpath::loaded_bevel
