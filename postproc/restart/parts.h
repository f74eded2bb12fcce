// Programs that hold a part of the teeth each make, one behind the other, the moves of the whole program.
//
// The whole program is proven as ever. That carries over to the parts when their teeth, part by part, are bit for bit
// the moves of the whole program in its order: the same words, tool, times, spindle, coolant, operation. What a part
// adds is its beginning and its end, machine moves alone; with the links to its first cut they are proven on their own.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "postproc/joints/program.h"
#include "postproc/readback/reader.h"

namespace toothpath::restart {

struct PartText {
  std::string_view text;
  std::string file;  ///< as it stands in messages
  joints::ProgramPart part;
};

struct PartProof {
  int line = 0, whole_line = 0;        ///< first place that differs, in the part and in the whole program
  std::string difference;              ///< what differs there; empty: nothing
  readback::OperationTrace approach;   ///< moves of the part from its beginning to the first cut
  readback::OperationTrace departure;  ///< from the last move of its last tooth to its end
  std::size_t moves = 0;               ///< that were compared
  double feed_minutes = 0;             ///< of its feeds, as the text asks
};

/// Executes the whole text once and every part twice. `parts`: in the order in which they are run; those of an
/// operation, taken together, have its teeth once each. @returns one a part
/// Errors: what the reader refuses in any text.
[[nodiscard]] Result<std::vector<PartProof>> prove_parts(std::string_view whole, const std::string& whole_file,
                                                         std::span<const PartText> parts,
                                                         const readback::NcControl& control,
                                                         const joints::AxisProgram& program);

}  // namespace toothpath::restart
