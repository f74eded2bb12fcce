// Mitsubishi M80: the Fanuc words with four decimals, a larger greatest F in G93, F behind every return to G94, no TCP.
// Made as docs/dialects.md tells: the words of Fanuc with what the manual of the control says differently.
#include "postproc/controls/fanuc/fanuc.h"

namespace toothpath::controls {
namespace {

text::NcDialect words() {
  text::NcDialect d = fanuc_words();
  d.name = "mitsubishi_m80";
  d.format = {.linear_decimals = 4, .rotary_decimals = 4};
  d.max_inverse_time = 999999.999;
  d.tcp_on.clear();
  d.tcp_off.clear();
  d.tcp_starts_at_zero = false;
  d.tcp_notes.clear();
  d.offset_trust = "{offset} and EXT are 0 for {rotaries}; no G54.4 is in force";
  d.rollover.note = "{axis} ROLLS OVER: SHORTCUT OF THE ROTARY AXIS VALID, 8213=1";
  return d;
}

Status execute(std::string_view text, const std::string& file, const readback::NcControl& control,
               const readback::MoveSink& sink) {
  static const iso::IsoLanguage language = fanuc_language();
  return execute_iso(text, file, control, sink, language);
}

}  // namespace

Control mitsubishi_m80() {
  return {words(),      {"mitsubishi", "m80"}, fanuc_offsets(),     execute,
          std::nullopt, probing::g31_probing,  fanuc_acting_comment};
}

}  // namespace toothpath::controls
