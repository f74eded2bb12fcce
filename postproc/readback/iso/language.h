// How a member of the family of ISO 6983 differs from the others, as data: the reader of each control calls execute_iso
// with its own.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "postproc/readback/acting_comment.h"
#include "postproc/readback/execution.h"

namespace toothpath::iso {

/// Work offsets behind one G code with a number: G54.1 P1 to P300.
struct ExtendedOffsets {
  int tenths = 0;  ///< of the code: 541 for G54.1; 0: the language has none
  int last = 0;    ///< greatest P
};

/// What the number of G4 P means.
enum class DwellNumber {
  seconds,
  milliseconds,
  by_point,  ///< seconds with a decimal point, milliseconds without
};

/// What a member of the family says beyond G0 G1 G4 G17 G21 G28 G30 G40 G43 G49 G53 G54 to G59 G80 G90 G91 G93 G94, M0
/// M1 M2 M3 M5 M6 M30. G91 is for the way of G28 and G30 alone.
struct IsoLanguage {
  bool o_words = false;  ///< sub-programs, loops and parameters as o-words; else M98, M99 and a program between % and %
  bool point_needed = true;                ///< axis words have a decimal point
  bool codes_of_site = false;              ///< M codes of the machine file switch TCP
  std::vector<int> g_tenths;               ///< further G codes, in tenths: 434 for G43.4
  std::vector<int> coolant_m = {7, 8, 9};  ///< M words that switch coolants
  ExtendedOffsets extended;
  std::size_t most_m = 1;    ///< M words in a block, of different groups
  bool moves_zeros = false;  ///< G52: words of rotaries count from its angle; X Y Z take 0 alone. G92.1 clears it, too
  /// G10 L2 P: writes a work offset, by its number; the parameter that holds the origin of one in X, those of Y Z A B C
  /// follow. Null: there is no G10.
  int (*number_of_offset)(std::string_view name) = nullptr;
  int (*origin_parameter)(int number) = nullptr;
  bool local_calls = false;  ///< M97 P calls the lines from N on, up to M99
  DwellNumber dwell = DwellNumber::milliseconds;
  bool dwell_x = false;         ///< G4 X, seconds with a point
  bool bare_reference = false;  ///< G28 and G30 without axes move all of them; else a refusal
  /// G61 stops at every corner, G64 leaves corners by what the machine file states (NcControl::corner_mm); one of them
  /// must be said ahead of G1.
  bool stops_at_corners = false;
  /// What the control leaves of a corner under G64 P Q, mm; `exact_mm`: what the machine leaves where it stops. Null:
  /// there is no G64 P.
  double (*corner_of_g64)(double p_mm, double q_mm, double exact_mm) = nullptr;
  readback::FindActingComment acting_comment = nullptr;  ///< comments that are executed; null: there are none
  readback::NcRules rules;
};

}  // namespace toothpath::iso
