// What the machinist reads beside the machine while `toothpath machine test` runs: what to do, what the dials must
// show, what the dry run proves of the machine file, and what only the eye can.
#pragma once

#include <span>
#include <string>

#include "machines/machine.h"
#include "postproc/self_test/self_test.h"

namespace toothpath::sheet {

/// One program of a dry run.
struct DryRunPart {
  std::string program;             ///< name of its file
  bool tcp = false;                ///< the control keeps the tip on the point; else the joints follow from the file
  self_test::SelfTest test;        ///< planned for it
  self_test::SelfTestProof proof;  ///< of its text
};

/// The page. `parts`: the one that moves the joints first.
[[nodiscard]] std::string dry_run_page(const machines::Machine& machine, std::span<const DryRunPart> parts);

/// What the part that moves the joints can see of the machine file: "sense of A (52.3 mm), place of A from 0.019 mm ..;
/// not seen: zero of C".
[[nodiscard]] std::string dry_run_sight(const machines::Machine& machine, const DryRunPart& part);

}  // namespace toothpath::sheet
