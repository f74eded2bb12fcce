// Words of one block, sorted by meaning before anything happens.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "postproc/readback/iso/flow.h"
#include "postproc/readback/iso/language.h"

namespace toothpath::iso {

inline constexpr unsigned kOffsets = 12;  ///< modal group of G54 and its kin
inline constexpr unsigned kZeros = 32;    ///< beside the modal groups: G52

/// What the words of a block ask for.
struct Request {
  readback::NcExecution::Move move;
  std::size_t words = 0;                       ///< of the block, N left out
  bool absolute = false, millimetres = false;  ///< G90, G21
  int motion = -1;                             ///< G0 G1 in this block
  int feed_mode = -1;                          ///< 93 94
  bool g53 = false, g43 = false, tcp = false, g49 = false, g64 = false, g61 = false, stops = false;
  bool extended = false;                                   ///< G54.1, its number in P
  bool plane = false, to_plane = false, no_plane = false;  ///< G68.2, G53.1, G69
  std::array<std::optional<double>, 3> euler;              ///< I J K
  std::string offset;
  std::vector<int> m;
  bool dwell = false;                       ///< G4
  bool zeros = false;                       ///< G52
  bool clears = false;                      ///< G92.1
  bool output = false;                      ///< M64 P, M65 P
  bool incremental = false;                 ///< G91
  std::optional<std::size_t> to_reference;  ///< 0: G28, 1: G30
  bool p_point = false;
  int switch_tcp = -1;  ///< 1 on, 0 off: a code of the site
  std::optional<double> f, s, h, t, p, q, l;
  bool writes = false;  ///< G10
  int write_column = 1;
  std::optional<double> turn;  ///< R
  int column = 1;
  int p_column = 1;
  unsigned groups = 0;
};

/// Any axis has a word.
[[nodiscard]] inline bool moves(const Request& r) {
  return std::any_of(r.move.has.begin(), r.move.has.end(), [](bool h) { return h; });
}
/// A G code in tenths as it is written: 591 is G59.1.
[[nodiscard]] std::string g_word(int tenths);
/// The language says this further G code, in tenths.
[[nodiscard]] bool has_g(const IsoLanguage& language, int tenths);

class WordSorter {
 public:
  /// All must outlive it.
  WordSorter(const readback::NcControl& control, const IsoLanguage& language, const NcFlow& flow)
      : control_(control), language_(language), flow_(flow) {}

  /// The words of a block, each with its value, in `r`. Errors at the word: one that the language or the machine does
  /// not have, two of a letter or of a modal group, an axis word without a point where it needs one.
  [[nodiscard]] std::optional<Diagnostic> sort(const NcBlock& b, Request& r) const;
  /// A block that may be left out must not matter: with others the text would be two programs.
  [[nodiscard]] std::optional<Diagnostic> skippable(const NcBlock& b) const;

 private:
  using Problem = std::optional<Diagnostic>;
  [[nodiscard]] Diagnostic here(int column, std::string message) const {
    return flow_.here(column, std::move(message));
  }
  [[nodiscard]] bool site_code(Request& r, const std::string& code) const;
  [[nodiscard]] Problem once(std::optional<double>& slot, const NcWord& w, double v) const;
  [[nodiscard]] bool has_m(int m) const;
  [[nodiscard]] bool has_outputs() const;
  [[nodiscard]] Problem take(Request& r, const NcWord& w, double v) const;
  [[nodiscard]] Problem take_axis(Request& r, const NcWord& w, double v) const;
  [[nodiscard]] Problem take_m(Request& r, int m, int column) const;
  [[nodiscard]] unsigned group_of(Request& r, int tenths) const;
  [[nodiscard]] Problem take_g(Request& r, const NcWord& w, double v) const;

  const readback::NcControl& control_;
  const IsoLanguage& language_;
  const NcFlow& flow_;
};

}  // namespace toothpath::iso
