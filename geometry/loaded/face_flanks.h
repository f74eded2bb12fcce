// The flanks of a face gear and its pinion for the cells. docs/loaded_contact.md 2, 5.
#pragma once

#include "geometry/loaded/cell_flanks.h"
#include "geometry/loaded/line_of_tooth.h"
#include "geometry/loaded/loaded_pair.h"

namespace toothpath::loaded {

class FaceFlanks final : public CellFlanks {
 public:
  /// @param force  normal force of all teeth: the first rectangles are those of its ellipses
  /// @param phi    turn of the shaper that stands where the gear does
  /// @param approach_mm  teeth without a line are looked at that stand so much farther off than the first that touches
  FaceFlanks(const LoadedPair& pair, double force, double phi, double approach_mm);

  [[nodiscard]] const CellBodies& bodies() const override { return bodies_; }
  [[nodiscard]] const std::vector<CellSite>& sites() const override { return sites_; }
  [[nodiscard]] double line_mm() const override { return line_mm_; }
  [[nodiscard]] std::vector<CellPlace> places(const CellSite& site, int columns, int rows) const override;

 private:
  [[nodiscard]] LineOfTooth line_of(const CellSite& site) const;
  [[nodiscard]] Segment segment(const CellSite& site, const LineOfTooth& line, const LinePlace& p) const;
  void add(std::size_t ring, const ContactLine& line, double force);
  /// Its rectangle is left to fill in.
  CellSite& add_site(CellSite site, LinePlace middle);
  /// A tooth whose line misses its flank: a site on the edge where it comes nearest.
  void add_edge(std::size_t ring, const ContactLine& edge, double force);
  /// The place of the flank above a point of the tangent plane, by Newton; `inside` < 0 where there is none.
  [[nodiscard]] LinePlace place(const CellSite& site, const LineOfTooth& line, double x, double y,
                                const LinePlace& near) const;

  const LoadedPair& pair_;
  double phi_, line_mm_ = 0;
  CellBodies bodies_;
  std::vector<CellSite> sites_;
  std::vector<LinePlace> middles_;  ///< of the sites
};

}  // namespace toothpath::loaded
