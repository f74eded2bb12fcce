// The flanks of one tooth as they were cut, by whichever route.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "cam/proof/verification.h"
#include "geometry/base/vec.h"

namespace toothpath::process {

/// Flanks of one tooth with the deviation along the normal, and what it took to cut them.
struct CutFlanks {
  struct Flank {
    int zone = 0, side = 1;              ///< side of a wall: +1 L, -1 U
    int rows = 0, columns = 0;           ///< rows along the profile
    std::vector<Vec3> nominal, normals;  ///< gear frame, out of the material
    std::vector<double> deviation_mm;    ///< > 0 material left
    /// 0: no place of the flank, or none that the mill reaches; empty: all are.
    std::vector<unsigned char> reached = {};
  };
  std::vector<Flank> flanks;
  std::string route;  ///< "milled" or "shaped"
  double cutting_minutes = 0, total_minutes = 0;
  std::string time_model;  ///< milled: what the times hold and assume
  bool verified = true;    ///< milled: the program was proven; its reasons stand in `warnings` otherwise
  std::vector<std::string> warnings, assumed;
  std::vector<std::pair<std::string, double>> stages;  ///< milled: seconds of the run
};

/// "as cut"; "measured" where the flanks are those of a measurement.
[[nodiscard]] inline const char* words_of_route(const std::string& route) {
  return route == "measured" ? "measured" : "as cut";
}

/// What a reader of their contact must know: a program that is not proven, values of the machine nobody measured.
[[nodiscard]] std::vector<std::string> notes_of(const CutFlanks& cut);

/// How well the fit of a measured flank meets its places.
template <typename Residual>
[[nodiscard]] std::string words_of_fit(int zone, int side, const Residual& residual) {
  return fmt::format("zone {}, flank {:+}: {} measured places up to {:.2f} um off, met by the fit within {:.2f} um",
                     zone, side, residual.points, 1000 * residual.measured_max_mm, 1000 * residual.residual_max_mm);
}

/// Flank patches of a cut surface after the last operation.
[[nodiscard]] std::vector<CutFlanks::Flank> flanks_of(const std::vector<proof::SurfaceGrid>& surface);

}  // namespace toothpath::process
