// What the part is made of, and the forces of [material] that follow from it.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "cam/force/load.h"

namespace toothpath::proposal {

/// The words of --material; the first is what a job without [material] takes.
[[nodiscard]] std::span<const std::string_view> material_words();

/// Cutting and edge coefficient of a material. @param word  one of `material_words`
///
/// Two chips of this work, 5 and 50 um, cost what the specific cutting force k_c1 h^-mc says: K h + K_e = k_c1 h^(1 -
/// mc) at both, rounded to two digits. "steel" is the default of a job. Source: k_c1 and mc of the material groups of
/// VDI 3323 as makers of tools print them (docs/force.md 5). Errors: none.
[[nodiscard]] force::Material forces_of(std::string_view word);

/// The table [material] of a job, with comments. Empty: no material was said.
[[nodiscard]] std::string material_text(const std::string& word);

}  // namespace toothpath::proposal
