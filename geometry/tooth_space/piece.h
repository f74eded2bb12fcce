// The surfaces of a toothed part, by name: the five pieces of a tooth space and what stands next to them.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

namespace toothpath::tooth_space {

/// The first five make one smooth tooth space, from tooth 0 through the root to tooth 1. "plus": side +1 of tooth 0,
/// "minus": side -1 of tooth 1. Files of programs hold the numbers.
enum class Piece : std::uint8_t {
  flank_plus,
  fillet_plus,
  root,
  fillet_minus,
  flank_minus,
  tip,     ///< top lands
  end,     ///< end faces of a ring of teeth
  groove,  ///< floor between two rings
  body,    ///< underside, and what lies below the teeth
  wall_l,  ///< flank and fillet in one, as a finger mill cuts them: sides +1
  wall_u,  ///< and -1
};
inline constexpr int kPieces = 5;            ///< of a tooth space
inline constexpr std::size_t kSurfaces = 9;  ///< with those next to it

[[nodiscard]] constexpr const char* to_string(Piece piece) {
  switch (piece) {
    case Piece::flank_plus: return "flank +1";
    case Piece::fillet_plus: return "fillet +1";
    case Piece::root: return "root";
    case Piece::fillet_minus: return "fillet -1";
    case Piece::flank_minus: return "flank -1";
    case Piece::tip: return "tip";
    case Piece::end: return "end";
    case Piece::groove: return "groove";
    case Piece::body: return "body";
    case Piece::wall_l: return "wall L";
    case Piece::wall_u: return "wall U";
  }
  return "";
}

[[nodiscard]] constexpr bool is_flank(Piece piece) { return piece == Piece::flank_plus || piece == Piece::flank_minus; }
[[nodiscard]] constexpr bool is_fillet(Piece piece) {
  return piece == Piece::fillet_plus || piece == Piece::fillet_minus;
}
/// Fillets and root: no mate ever touches them.
[[nodiscard]] constexpr bool below_the_flanks(Piece piece) { return is_fillet(piece) || piece == Piece::root; }

/// +1 or -1 for flanks, fillets and walls; 0 for everything else.
[[nodiscard]] constexpr int side_of(Piece piece) {
  switch (piece) {
    case Piece::flank_plus:
    case Piece::fillet_plus:
    case Piece::wall_l: return 1;
    case Piece::fillet_minus:
    case Piece::flank_minus:
    case Piece::wall_u: return -1;
    default: return 0;
  }
}
/// The same of flanks and walls alone.
[[nodiscard]] constexpr int flank_side(Piece piece) { return below_the_flanks(piece) ? 0 : side_of(piece); }
[[nodiscard]] constexpr Piece flank_of(int side) { return side > 0 ? Piece::flank_plus : Piece::flank_minus; }
[[nodiscard]] constexpr Piece fillet_of(int side) { return side > 0 ? Piece::fillet_plus : Piece::fillet_minus; }

}  // namespace toothpath::tooth_space

/// Pieces in formatted text.
template <>
struct fmt::formatter<toothpath::tooth_space::Piece> : fmt::formatter<std::string_view> {
  template <typename Context>
  auto format(toothpath::tooth_space::Piece piece, Context& context) const {
    return fmt::formatter<std::string_view>::format(to_string(piece), context);
  }
};
