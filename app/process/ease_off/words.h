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
  const char* csv_header;            ///< of ease_off.csv
  const char *x_key, *y_key;         ///< coordinates of a place along the face and across it, in JSON
  const char *x_text, *y_text;       ///< on the screen
  const char *x_label, *y_label;     ///< beside drawings
  const char* end_of_mate;           ///< "pinion's involute ends"
  const char* lever;                 ///< where micrometres of transmission error are counted
  /// "flank +1".
  [[nodiscard]] std::string side(std::size_t s) const { return std::string(flank) + " " + sides[s]; }
};

}  // namespace toothpath::ease_off
