// The surfaces of a tooth space that a program finishes: what is measured on each is judged by its kind. (Single places
// of a gear, as messages name them, are text.)
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

#include "cam/path/operation.h"

namespace toothpath::proof {

/// Face gears: the five pieces of a tooth space from flank +1 to flank -1. Bevel gears: the two walls.
enum class Patch : std::uint8_t { flank_plus, fillet_plus, root, fillet_minus, flank_minus, wall_l, wall_u };

[[nodiscard]] constexpr const char* to_string(Patch patch) {
  switch (patch) {
    case Patch::flank_plus: return "flank +1";
    case Patch::fillet_plus: return "fillet +1";
    case Patch::root: return "root";
    case Patch::fillet_minus: return "fillet -1";
    case Patch::flank_minus: return "flank -1";
    case Patch::wall_l: return "wall L";
    case Patch::wall_u: return "wall U";
  }
  return "";
}

/// The region of a patch of a face gear; walls are flanks.
[[nodiscard]] constexpr path::Region region_of(Patch patch) {
  switch (patch) {
    case Patch::fillet_plus:
    case Patch::fillet_minus: return path::Region::fillet;
    case Patch::root: return path::Region::root;
    default: return path::Region::flank;
  }
}

/// +1 or -1 for a flank of a face gear; 0 for everything else.
[[nodiscard]] constexpr int flank_side(Patch patch) {
  return patch == Patch::flank_plus ? 1 : patch == Patch::flank_minus ? -1 : 0;
}

/// +1 for wall L, -1 for wall U of a bevel gear; 0 for everything else.
[[nodiscard]] constexpr int wall_side(Patch patch) {
  return patch == Patch::wall_l ? 1 : patch == Patch::wall_u ? -1 : 0;
}

/// Fillets and root: no mate ever touches them.
[[nodiscard]] constexpr bool below_the_flanks(Patch patch) {
  return patch == Patch::fillet_plus || patch == Patch::root || patch == Patch::fillet_minus;
}

}  // namespace toothpath::proof

/// Patches in formatted text.
template <>
struct fmt::formatter<toothpath::proof::Patch> : fmt::formatter<std::string_view> {
  template <typename Context>
  auto format(toothpath::proof::Patch patch, Context& context) const {
    return fmt::formatter<std::string_view>::format(to_string(patch), context);
  }
};
