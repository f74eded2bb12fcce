// What every command that makes or checks an NC program does in the same way, whatever the gear: begin the report, take
// over the axis program, read a program file, judge travels, print the table of worst places.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/base/outcome.h"
#include "app/base/output_dir.h"
#include "app/job/job.h"
#include "app/process/program_proof.h"
#include "app/report/run_report.h"
#include "cam/proof/checked_cl_path.h"
#include "machines/machine.h"
#include "postproc/readback/reader.h"

namespace toothpath::process {

/// Names of job and machine, assumed values, warnings.
[[nodiscard]] report::RunReport report_of(const std::string& command, const job::Job& job,
                                          const machines::Machine& machine,
                                          const std::vector<std::string>& gear_warnings);

/// Axis ranges, times, poles and operations. `paths`: one an operation.
void note_axis_program(report::RunReport& report, const job::Job& job, const machines::Machine& machine,
                       std::span<const path::ClPath* const> paths, const joints::AxisProgram& program);

/// What the proof found, its reasons and its warnings.
void note_proof(report::RunReport& report, const ProgramProof& proof);

/// The paths that the program follows: those given, or where poles were handled those that were made of them.
[[nodiscard]] std::vector<const path::ClPath*> paths_to_meet(const joints::AxisProgram& program,
                                                             std::span<const path::ClPath* const> paths);

/// One of the programs that hold a part each: on the disk, and what lies there.
struct PostedPart {
  joints::ProgramPart part;
  std::string file, name_on_control, text;
  std::size_t blocks = 0;
  std::vector<int> tools;                      ///< T, in the order of their use
  double feed_minutes = 0, total_minutes = 0;  ///< with the accelerations of the axes where they are stated
};
/// An NC program that this run has made: on the disk, and what lies there.
struct PostedProgram {
  joints::AxisProgram axes;
  std::string file;             ///< name in the output directory
  std::string name_on_control;  ///< under which the control keeps it
  std::string text;  ///< the bytes as read back; with a restart the whole program, which is proven but not written
  std::size_t blocks = 0;
  std::optional<joints::AxisProgram> restarted;  ///< of the file, where it begins in the middle
  std::string restart_text;                      ///< the bytes of that file as read back
  double blend_mm = 0;            ///< how far the control may leave the corners; 0: the dialect has no such word
  std::vector<PostedPart> parts;  ///< beside the program, where the job asks for them
};
/// What a program is made for. Everything named must outlive the call.
struct PostRequest {
  const job::Job& job;
  std::string title;  ///< of the job, at the top of the text
  const machines::Machine& machine;
  int teeth = 0;
  joints::ClearanceBody body;                     ///< that links keep clear of
  std::optional<joints::ProgramRestart> restart;  ///< the file holds the program from there on
  std::optional<double> contour_mm = {};          ///< that the control is granted; none: the narrow one
  bool wide_roughing = false;                     ///< operations that leave an allowance are granted a share of it
  std::optional<joints::GraphicsBlank> blank =
      std::nullopt;  ///< nothing: the part does not stand on Z of the work offset
};

/// Nothing: the first tool of the job rises over the part. Else the refusal at setup.origin, before anything is
/// planned.
[[nodiscard]] std::optional<Diagnostic> no_room_over_part(const job::Job& job, const machines::Machine& machine,
                                                          const joints::ClearanceBody& body);

// The contour tolerance that a text allows its control. `posted`: written for the request, its first teeth are there.
/// The control has words for it, and the machine file states no smoothing of its own.
[[nodiscard]] bool takes_contour(const machines::Machine& machine);
/// Granted without anybody's asking, mm.
[[nodiscard]] double narrow_contour(const PostRequest& request);
/// What the proof counts for it: the tip, and the centre of the largest ball where the rotaries may be off, mm.
[[nodiscard]] double counted_contour(const PostRequest& request, const PostedProgram& posted, double contour_mm);
/// Cutting time of the teeth that are held with this tolerance (none: the narrow one), min.
[[nodiscard]] double first_teeth_minutes(const PostRequest& request, const PostedProgram& posted,
                                         const std::optional<double>& contour_mm);
/// O number of the job's program: its own, or one of 1000, 1100 .. 6900 by its name, so that two jobs on one control
/// hardly ever share it.
[[nodiscard]] int program_number(const job::Job& job);
/// Axis program, NC text, the file, its bytes. Errors carry their place in the job.
/// @param assumed values that the text names at its top
[[nodiscard]] Result<PostedProgram> post_program(std::span<const proof::CheckedClPath> paths,
                                                 const PostRequest& request, const std::vector<std::string>& assumed,
                                                 app::OutputDir& output, app::StageClock& clock);
/// Takes every program file out of the directory again.
void discard_program(app::OutputDir& output);

/// Text of a program that is already there: a regular file of at most 1 GiB.
[[nodiscard]] Result<std::string> read_program_file(const std::string& path);

/// Least and greatest position of every axis over all executed moves, against its limits.
[[nodiscard]] std::vector<joints::AxisRange> ranges_of(const readback::ReadBack& read,
                                                       const machines::Machine& machine);
/// A program may use the travels of the machine, not more: adds to `reasons`.
void judge_travels(std::span<const joints::AxisRange> axes, std::vector<std::string>& reasons);

/// Lines of the table of places that are worst: where, which body, how deep. Empty where there is none.
[[nodiscard]] std::string table_of_worst(const proof::GougeResult& gouge);

/// One error a reason, of kind verification, in `file`.
[[nodiscard]] std::vector<Diagnostic> errors_of(std::span<const std::string> reasons, const std::string& file);

/// The program in the file `file`, whose text was proven, is what the run leaves.
void note_verified(report::RunReport& report, const std::string& file, std::string_view text);

/// The end of a run whose inputs were right, as far as the verdict goes: reasons as errors, the exit code, and no
/// program left that is not verified. `stopped`: what kept the run from its proof; joins the reasons.
[[nodiscard]] app::CommandOutcome verdict_of(report::RunReport& report, const std::optional<Diagnostic>& stopped,
                                             const std::string& job_file, app::OutputDir& output);

}  // namespace toothpath::process
