// The surfaces of a toothed part, by name: the five pieces of a tooth space and what stands next to them.
#pragma once

#include <cstdint>

namespace toothpath::tooth_space {

/// The first five make one smooth tooth space, from tooth 0 through the root to tooth 1. "plus": side +1 of tooth 0,
/// "minus": side -1 of tooth 1.
enum class Piece : std::uint8_t {
  flank_plus,
  fillet_plus,
  root,
  fillet_minus,
  flank_minus,
  tip,     ///< top lands
  end,     ///< end faces of a ring of teeth
  groove,  ///< floor between two rings
};
inline constexpr int kPieces = 5;  ///< of a tooth space

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
  }
  return "";
}

[[nodiscard]] constexpr bool is_flank(Piece piece) { return piece == Piece::flank_plus || piece == Piece::flank_minus; }
[[nodiscard]] constexpr bool is_fillet(Piece piece) {
  return piece == Piece::fillet_plus || piece == Piece::fillet_minus;
}

/// +1 or -1 for flanks and fillets; 0 for everything else.
[[nodiscard]] constexpr int side_of(Piece piece) {
  switch (piece) {
    case Piece::flank_plus:
    case Piece::fillet_plus: return 1;
    case Piece::fillet_minus:
    case Piece::flank_minus: return -1;
    default: return 0;
  }
}
[[nodiscard]] constexpr Piece flank_of(int side) { return side > 0 ? Piece::flank_plus : Piece::flank_minus; }
[[nodiscard]] constexpr Piece fillet_of(int side) { return side > 0 ? Piece::fillet_plus : Piece::fillet_minus; }

}  // namespace toothpath::tooth_space
