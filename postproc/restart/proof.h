// A program that begins at one tooth of one operation does what the whole program does from there on.
//
// The whole program is proven as ever; what stands ahead of the restart is taken as done. That carries over to the
// restart when every move from the first tooth to the end is, bit for bit, the move of the whole program at the same
// place: the same words, tool, times, operation. Until an axis has had its first word it stands where the start left
// it, at the top of Z, instead of where the tooth before left it; nothing may be cut like that, and these first links
// are proven on their own.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "postproc/readback/reader.h"

namespace toothpath::restart {

struct RestartProof {
  bool same = false;
  int line = 0, whole_line = 0;       ///< first place that differs, in the restart and in the whole program
  std::string difference;             ///< what differs there
  readback::OperationTrace approach;  ///< moves of the restart from its beginning to the first cut
  std::map<int, int> line_of;  ///< line of the whole program -> line of the restart, of every move that both make
  std::array<double, 5> least{}, greatest{};  ///< joints of the restart, mm and deg
  std::size_t moves = 0;                      ///< of the restart, that were compared
};

/// Where a restart begins.
struct RestartPlace {
  int operation = 0;
  int tooth = 0;  ///< tooth space cut first
  int place = 0;  ///< its place in the order of the teeth, 0 .. teeth - 1
  int teeth = 1;  ///< of the gear
};

/// Executes both texts twice and compares. Errors: what the reader refuses in either text.
[[nodiscard]] Result<RestartProof> prove_restart(std::string_view whole, std::string_view restart,
                                                 const std::string& file, const readback::NcControl& control,
                                                 const RestartPlace& from);

}  // namespace toothpath::restart
