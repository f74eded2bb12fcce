// A control as one object: what it wants to read, who reads its text back, and which names of work offsets it has. One
// folder a control beside this file, one line in registry.inl; everything that must know all controls asks the
// registry.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cam/tool/assembly.h"
#include "postproc/probing/probing.h"
#include "postproc/readback/acting_comment.h"
#include "postproc/readback/reader.h"
#include "postproc/text/dialect.h"

namespace toothpath::controls {

/// The work offsets of a control.
struct WorkOffsets {
  std::string names;  ///< the ones that it has, for messages: "G54 to G59"
  bool (*has)(std::string_view name) = nullptr;
};

/// A file that the control keeps of its tools.
struct ToolTable {
  const char* file = "";  ///< as it is written beside the program
  /// What must stand in it for these tools. Lengths as programs mean them: gauge line to tip.
  std::string (*text)(std::span<const tool::ToolAssembly> tools) = nullptr;
};

struct Control {
  /// Name, file extension, words, coolants, corners, rotaries that roll over; what it takes of a machine file follows
  /// from them: `exact_path_mm` or `corner_flow` corner_tolerance, `takes_smoothing` smoothing_*, `takes_coolant`
  /// coolant_*, `tcp_codes_of_site` tcp_on and tcp_off.
  text::NcDialect words;
  std::vector<std::string> aliases;  ///< other names that a machine file may use
  WorkOffsets offsets;
  readback::NcExecute execute = nullptr;               ///< executes its text; shares nothing with what writes it
  std::optional<ToolTable> tool_table = std::nullopt;  ///< none: tools are entered at the control
  probing::ProbingWords probe = nullptr;               ///< a probing program in its words; null: it has none
  readback::FindActingComment acting_comment =
      nullptr;  ///< null: its comments do nothing; its reader refuses them, too
  /// Of this machine, besides `words.tcp_notes`; null: none.
  text::NcLinesOfText (*tcp_notes)(const machines::KinematicChain& chain) = nullptr;
};

}  // namespace toothpath::controls
