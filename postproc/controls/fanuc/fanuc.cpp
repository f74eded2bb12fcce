// Fanuc and compatible controls, IS-B (3 decimals): every value has a point, G43 stands with Z, G49 only in the block
// of a machine-coordinate retract, the largest F in G93 is 9999.999. G52 lets the words
// of C count from the angle of a tooth, which one sub-program cuts. TCP is G43.4: its block moves Z alone, at rotary
// zero, where the table frame is frozen; where zero counts from the angle of a tooth, the words of all teeth are those
// of tooth 0. G61 stops at every corner: G64 states no bound of what it leaves.
#include "postproc/controls/fanuc/fanuc.h"

#include "postproc/controls/work_offset.h"

namespace toothpath::controls {
namespace {

constexpr int kLastExtended = 300;  // G54.1 P

bool has_offset(std::string_view name) {
  const int n = extended_offset(name, "G54.1 P");
  return basic_offset(name) > 0 || (n >= 1 && n <= kLastExtended);
}

Status execute(std::string_view text, const std::string& file, const readback::NcControl& control,
               const readback::MoveSink& sink) {
  static const iso::IsoLanguage language = fanuc_language();
  return execute_iso(text, file, control, sink, language);
}

}  // namespace

text::NcDialect fanuc_words() {
  text::NcDialect d;
  d.name = "fanuc";
  d.extension = ".nc";
  d.format = {.linear_decimals = 3, .rotary_decimals = 3};
  d.point_always = true;
  d.max_inverse_time = 9999.999;
  d.max_line = 80;
  d.frame_begin = {"%", "O{number} ({name})"};
  d.safe_start = {"G21 G17 G90 G94 G40 G80 G69", "G52 {zeros}", "G61"};
  d.corner_stop = "G61";
  d.corner_flow = "G64";
  d.start = {"{safe_start}", "{offset}"};
  d.retract = {"G0 G49 G53 Z{top}"};
  d.reference_retract = {"G91 G28 Z0.", "G90"};  // G49 of its own could move Z by the length
  d.tool_call = {"T{tool} M6"};
  d.tool_next = {"T{next}"};
  d.tool_change = {"{safe_start}", "{offset}", "S{speed} M3"};
  d.compensation = {"G0 G43 H{tool} Z{work_top}"};
  d.operation_end = {"G94 F{free}"};
  d.body_end = {"M30"};
  d.frame_end = {"%"};
  d.tcp_on = {"G0 G43.4 H{tool} Z{z}"};
  d.tcp_off = d.retract;
  d.tcp_starts_at_zero = true;
  d.offset_trust = "{offset} and EXT are 0 for {rotaries}; no G54.2 and no G54.4 is in force";
  d.tcp_notes = {"TCP G43.4 from rotary zero, parameters 19696#5 WKP=0, 1401#1 LRP=1"};
  d.takes_smoothing = true;  // G5.1 Q1 and the like state no bound of their own
  d.planes.on = {"G68.2 X{plane_x} Y{plane_y} Z{plane_z} I{euler_turn} J{tilt} K{euler_spin}", "G53.1 P{pair}"};
  d.planes.off = {"G69"};
  d.planes.upper = "1";
  d.planes.lower = "2";
  d.planes.assumed =
      "G53.1 P1 takes the pair with {axis} above its zero, P2 below; G68.2 counts from the work offset of the part "
      "with all rotaries at zero, with G43 on; every rotary goes the nearer way";
  d.loop.form = text::NcLoop::Form::called;
  d.loop.before = {"O{program} (OPERATION {operation})"};
  d.loop.after = {"M99"};
  d.loop.call = {"M98 P{program}"};
  d.loop.zero_on = {"G52 {index_axis}{angle}"};
  d.loop.zero_off = {"G52 {zeros}"};
  d.loop.zero_with_tcp = true;  // the table frame is frozen at the angle of the tooth
  d.rollover.way = text::NcRollover::Way::shortest;
  d.rollover.note = "{axis} ROLLS OVER: PARAMETERS 1008#0 ROA=1, 1008#1 RAB=0, 1260=360.";
  return d;
}

std::optional<readback::ActingComment> fanuc_acting_comment(std::string_view line) {
  if (const std::size_t first = line.find_first_not_of(" \t"); first < line.size() && line[first] == '%') return {};
  bool comment = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '(' || line[i] == ')') comment = line[i] == '(';
    if (line[i] == '%' && comment)
      return readback::ActingComment{static_cast<int>(i) + 1,
                                     "% in a comment: this control takes it for the end of the text when it reads it "
                                     "in, and what follows is not there"};
    if (line[i] != ';' || comment) continue;
    if (line.find_first_not_of(" \t\r;", i) == std::string_view::npos) return std::nullopt;
    return readback::ActingComment{static_cast<int>(i) + 1,
                                   "text behind ; which ends a block on this control: what follows is executed as the "
                                   "next block, a comment stands in ( )"};
  }
  return std::nullopt;
}

iso::IsoLanguage fanuc_language() {
  iso::IsoLanguage l;
  l.acting_comment = fanuc_acting_comment;
  l.g_tenths = {434, 531, 610, 640, 682, 690};
  l.stops_at_corners = l.moves_zeros = true;
  l.extended = {.tenths = 541, .last = kLastExtended};
  l.most_m = 3;  // 3404#7 M3B
  l.dwell_x = true;
  l.rules.tcp_needs_zero = true;
  return l;
}

WorkOffsets fanuc_offsets() { return {"G54 to G59 and G54.1 P1 to P300", has_offset}; }

Control fanuc() {
  return {fanuc_words(), {}, fanuc_offsets(), execute, std::nullopt, probing::g31_probing, fanuc_acting_comment};
}

}  // namespace toothpath::controls
