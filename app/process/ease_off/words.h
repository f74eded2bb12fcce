// How tables, maps and keys call the flanks of a pair; one set of words a gear type.
#pragma once

#include <array>
#include <string>

namespace toothpath::ease_off {

struct PairWords {
  const char* flank;                 ///< "flank", "wall"
  const char* side_key;              ///< of a side in JSON
  std::array<const char*, 2> sides;  ///< "+1", "-1"; "L", "U"
  bool numbered;                     ///< sides are numbers in JSON
  const char* ring;                  ///< "ring", "half": part of the face with flanks of its own
  const char* zone;                  ///< the same on the screen
  std::string csv_header;            ///< of ease_off.csv
  const char *x_key, *y_key;         ///< coordinates of a place along the face and across it, in JSON
  const char *x_text, *y_text;       ///< on the screen
  const char *x_label, *y_label;     ///< beside drawings
  const char* end_of_mate;           ///< "pinion's involute ends"
  const char* lever;                 ///< where micrometres of transmission error are counted
  /// "flank +1".
  [[nodiscard]] std::string side(std::size_t s) const { return std::string(flank) + " " + sides[s]; }
};

/// A coordinate of places: in JSON and CSV, on the screen, beside drawings.
struct CoordinateWords {
  const char *key, *text, *label;
};
/// Of flanks that are told by their side: x along the teeth, y across them.
inline PairWords flank_words(const char* ring, const CoordinateWords& x, const CoordinateWords& y,
                             const char* end_of_mate, const char* lever) {
  const std::string header = std::string("surface,flank,zone,row,column,") + x.key + "," + y.key +
                             ",ease_off_um,phi_2_deg,pinion_radius,pinion_Z";
  return {"flank", "side", {"+1", "-1"}, true,    ring,    "zone",      header, x.key,
          y.key,   x.text, y.text,       x.label, y.label, end_of_mate, lever};
}

}  // namespace toothpath::ease_off
