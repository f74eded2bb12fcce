// Haas NGC: the words of Fanuc with G154 for further work offsets and M88, M89 for coolant through the spindle. The
// tooth is called with M97, by its N word in the same file: what M98 finds depends on settings of the control. G234 and
// rotaries that roll over are left out; their jobs are refused.
#include "postproc/controls/fanuc/fanuc.h"
#include "postproc/controls/work_offset.h"

namespace toothpath::controls {
namespace {

constexpr int kLastExtended = 99;  // G154 P

text::NcDialect words() {
  text::NcDialect d = fanuc_words();
  d.name = "haas";
  d.frame_begin = {"%", "O0{number} ({name})"};  // five digits
  d.tcp_on.clear();
  d.tcp_off.clear();
  d.tcp_starts_at_zero = false;
  d.tcp_notes.clear();
  d.offset_trust =
      "{offset} is 0 for {rotaries}; no G254 is in force; setting 33 is FANUC or HAAS, not YASNAC, so that G52 shifts "
      "{offset}";
  d.planes = {};  // G268 and G269 are an option
  d.loop.before = {"N{label} (OPERATION {operation})"};
  d.loop.call = {"M97 P{label}"};
  d.rollover = {};
  d.coolant = {{machines::Coolant::flood, {"M8", "M9"}}, {machines::Coolant::through_spindle, {"M88", "M89"}}};
  d.clamp_m = {{10, 13}};  // brakes of the fourth and the fifth axis
  d.own_m = {{0, 6}, {10, 19}, {30, 49}, {75, 82}, {85, 87}, {95, 199}};
  return d;
}

const iso::IsoLanguage& language() {
  static const iso::IsoLanguage l = [] {
    iso::IsoLanguage haas;
    haas.g_tenths = {610, 640, 690};
    haas.acting_comment = fanuc_acting_comment;
    haas.stops_at_corners = haas.moves_zeros = haas.local_calls = true;
    haas.dwell = iso::DwellNumber::by_point;
    haas.bare_reference = true;
    haas.rules.stop = readback::ProgramStop::ends_spindle;
    haas.coolant_m = {8, 9, 88, 89};
    haas.extended = {.tenths = 1540, .last = kLastExtended};
    return haas;
  }();
  return l;
}

Status execute(std::string_view text, const std::string& file, const readback::NcControl& control,
               const readback::MoveSink& sink) {
  return execute_iso(text, file, control, sink, language());
}

bool has_offset(std::string_view name) {
  const int n = extended_offset(name, "G154 P");
  return basic_offset(name) > 0 || (n >= 1 && n <= kLastExtended);
}

}  // namespace

Control haas() {
  return {words(),
          {},
          {"G54 to G59 and G154 P1 to P99", has_offset},
          execute,
          std::nullopt,
          probing::g31_probing,
          fanuc_acting_comment};
}

}  // namespace toothpath::controls
