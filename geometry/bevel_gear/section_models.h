// Two surface models that sweep the meridian section of the cutter along a curve, and how far the machined wall is from
// them.
//
// Both ignore that the contact leaves the normal plane of the path. S1 keeps the section normal to the path of the
// cutter centre: the envelope's formula with gamma := beta_c. S2 sets it on the theoretical tooth trace, in the trace's
// normal plane, turned about the centre of the equivalent gear so that its pitch point lies on the trace. Derivation:
// docs/bevel_gear.md, section 12.
#pragma once

#include <optional>
#include <vector>

#include "geometry/bevel_gear/gear.h"

namespace toothpath::bevel_gear {

enum class SectionModel {
  centre_path,  ///< S1
  tooth_trace,  ///< S2
};

/// Point of the model at spiral angle beta of the trace and profile parameter p; blank frame, mm.
[[nodiscard]] Vec3 section_model_point(SectionModel model, const BevelWall<double>& wall, double beta, double p);

/// Normal distance of the machined wall from the model at (ell, height) of the wall [mm]; negative: the machined tooth
/// is thinner there. Measured along the wall's normal at equal cone distance and height; differs from the shortest
/// distance by the curvature times the square (below 1e-6 mm for 0.01 mm). Empty where wall or model has no such point.
[[nodiscard]] std::optional<double> section_model_deviation(SectionModel model, const BevelWall<double>& wall,
                                                            double ell, double height);

/// Closed estimate of S1's deviation at (beta, p): -rho cos(psi) (gamma - beta_c)^2 / 2 [mm].
[[nodiscard]] double centre_path_estimate(const BevelWall<double>& wall, double beta, double p);

/// The deviations over one wall.
struct SectionModelMap {
  SectionModel model = SectionModel::centre_path;
  int half = 0, sigma = 1;
  int rows = 0, columns = 0;         ///< heights, cone distances
  std::vector<double> ell, height;   ///< columns, rows
  std::vector<double> deviation_mm;  ///< row by row; NaN where there is no point
  double least_mm = 0, greatest_mm = 0, rms_mm = 0;
  double least_ell = 0, least_height = 0;  ///< where the least one is
};

struct SectionModelOptions {
  int rows = 25, columns = 41;
  double height_from = 0, height_to = 0;  ///< both 0: from point C of the cutter to the addendum
};

/// Both models on all walls. Order: half, wall L before U, S1 before S2.
[[nodiscard]] std::vector<SectionModelMap> section_model_maps(const BevelGear& gear,
                                                              const SectionModelOptions& options = {});

}  // namespace toothpath::bevel_gear
