// From the bytes of an NC program to what is proven about the bevel gear that it mills: read back through the machine's kinematics,
// compared with the path that was asked for, checked against the walls, the root, blank, hub and shaft. As proof.h for face gears.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/job.h"
#include "app/report/run_report.h"
#include "app/stage_clock.h"
#include "cam/finger_check.h"
#include "machines/machine.h"
#include "postproc/nc_reader.h"

namespace toothpath {

/// Axes that change in blocks along the path; moves along the tool axis (engage, retract) are left out.
struct MovingAxes {
  std::string letters;           ///< every axis that moves in any of them: "YC"
  std::size_t simultaneous = 0;  ///< most axes that one block moves
};

struct BevelProof {
  ReadBack read;
  std::vector<ToolMotion> motions;  ///< in program order; all teeth that were kept
  FingerCheckResult result;
  MovingAxes moving;
  std::optional<ClComparison> comparison;  ///< only where there is a path to compare with
  double path_tolerance_mm = 0;
  std::vector<std::string> reasons;        ///< why the program is not proven; empty: it is
};

/// How far CL records and program may differ, mm and rad.
struct PathTolerance {
  double mm = 0, rad = 0;
};

/// Tolerances of the proof that a job asks for.
[[nodiscard]] Tolerances proof_tolerances(const Job& job);

/// Reads `text` back and checks it. `paths` may be empty (a program that somebody else wrote); then `path` is not used.
/// Errors: what the reader refuses, located in `file`. A program that is read but not safe is no error: see `reasons`.
[[nodiscard]] Result<BevelProof> prove_bevel_program(std::string_view text, const std::string& file, const Job& job, const Machine& machine,
                                                     const BevelGear& gear, const FingerGougeCheck& check, std::span<const ClPath* const> paths,
                                                     const PathTolerance& path, StageClock& clock);

/// One direction an operation and half: the angle of the axis, and which axes were seen to move.
[[nodiscard]] std::vector<DirectionChoice> directions_of(const BevelGear& gear, const Job& job, const BevelProof& proof);

}  // namespace toothpath
