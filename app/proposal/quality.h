// How exact the flanks shall be, and the tolerances of a job that follow from it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>

#include "machines/toml/table_reader.h"

namespace toothpath::proposal {

/// What somebody asks for: a class, or the tolerance itself; nothing: kUsualTolerance.
struct Quality {
  std::optional<int> iso_class;        ///< of ISO 1328-1
  std::optional<double> tolerance_um;  ///< of the form of the flanks
  [[nodiscard]] bool said() const { return iso_class || tolerance_um; }
};
inline constexpr toml::Range kIsoClass{1, 11}, kTolerance{2, 200, " um"};
inline constexpr double kUsualTolerance = 10;  ///< um

/// Tolerance of the profile form f_f_alpha [um] of a cylindrical gear, (0.55 m_n + 5) sqrt(2)^(A - 5), unrounded.
/// Source: ISO 1328-1:2013, profile form tolerance. @param module_mm  normal module, 0.5 to 70 in the standard
[[nodiscard]] double profile_form_tolerance_um(int iso_class, double module_mm);

/// Shares of the tolerance T that the program takes; the rest is that of tool, machine and clamping. Ball mills take
/// 0.68 T with the sag of a block, the side of a mill 0.78 T.
inline constexpr double kGougeShare = 0.2;    ///< cut too deep, at most
inline constexpr double kScallopShare = 0.4;  ///< highest cusp between passes
inline constexpr double kLeftShare = 0.5;     ///< largest misfit of a straight side
inline constexpr double kChordShare = 0.08;   ///< largest sag of a block
inline constexpr double kFingerChordShare = 0.05;

/// T [mm] for a gear of this module. Errors: none.
[[nodiscard]] double tolerance_mm(const Quality& quality, double module_mm);
/// A share of it [mm] as a job says it: whole tenths of a micrometre, downwards, at least one.
[[nodiscard]] double share_mm(double share, double tolerance_mm);
/// Where T comes from and what the job took of it: lines of a comment.
/// @param cylindrical  the standard is its own;  @param taken  keys of the job and their shares
[[nodiscard]] std::string derivation(const Quality& quality, double module_mm, bool cylindrical,
                                     std::span<const std::pair<const char*, double>> taken);

}  // namespace toothpath::proposal
