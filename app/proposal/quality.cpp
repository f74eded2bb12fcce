#include "app/proposal/quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace toothpath::proposal {

double profile_form_tolerance_um(int iso_class, double module_mm) {
  return (0.55 * module_mm + 5) * std::pow(2.0, 0.5 * (iso_class - 5));
}

double tolerance_mm(const Quality& quality, double module_mm) {
  const double um = quality.iso_class ? profile_form_tolerance_um(*quality.iso_class, module_mm)
                                      : quality.tolerance_um.value_or(kUsualTolerance);
  return um / 1000;
}

double share_mm(double share, double tolerance_mm) {
  constexpr double kStep = 1e-4, kRounding = 1e-6;  // mm; of a step
  return std::max(1.0, std::floor(share * tolerance_mm / kStep + kRounding)) * kStep;
}

std::string derivation(const Quality& quality, double module_mm, bool cylindrical,
                       std::span<const std::pair<const char*, double>> taken) {
  const double um = 1000 * tolerance_mm(quality, module_mm);
  const std::string from =
      quality.iso_class
          ? fmt::format("ISO 1328-1 class {}: f_f_alpha = (0.55 m + 5) sqrt(2)^({} - 5) with m = {:g} mm{}",
                        *quality.iso_class, *quality.iso_class, module_mm,
                        cylindrical ? "" : ", the standard of cylindrical gears")
      : quality.tolerance_um ? std::string("as asked for")
                             : std::string("where new is given no --class and no --tolerance");
  std::string shares;
  for (const auto& [key, share] : taken) shares += fmt::format("{}{} {:g} T", shares.empty() ? "" : ", ", key, share);
  return fmt::format(
      "# Form of the flanks: T = {:.2f} um, {}.\n"
      "# The program takes of it {};\n"
      "# the rest is for tool, machine and clamping. The smoothing of the control stays within gouge_tolerance.\n",
      um, from, shares);
}

}  // namespace toothpath::proposal
