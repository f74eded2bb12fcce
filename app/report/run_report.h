// Everything that a run found out, as plain values: the one source of report.json, the set-up sheet and the table on
// the screen.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/report/block_times.h"
#include "app/report/cad_report.h"
#include "app/report/cutting_load.h"
#include "app/report/finding.h"
#include "app/report/scene_report.h"
#include "app/report/section.h"
#include "cam/proof/verification.h"
#include "geometry/bevel_gear/gear.h"
#include "geometry/face_gear/flank_field.h"
#include "geometry/inspection/tooth_index.h"
#include "postproc/bodies/moves.h"
#include "postproc/joints/program.h"
#include "postproc/readback/conditions.h"
#include "postproc/readback/program_hash.h"
#include "postproc/restart/menu.h"

namespace toothpath::report {

/// One operation as the machinist sees it.
struct OperationReport {
  int operation = 0;  ///< index in the job
  std::string type;
  int tool_number = 0;
  double speed_rpm = 0, feed_mm_min = 0;
  std::size_t cl_points = 0;                   ///< one tooth space
  double feed_minutes = 0, rapid_minutes = 0;  ///< all teeth
  /// Where it changes its tool it stands here once a tool: first place in the order of the teeth, and behind the last.
  std::optional<std::pair<int, int>> places = {};
  double share = 1;                         ///< of the teeth
  std::optional<CuttingLoad> cutting = {};  ///< none where forces were not asked for
  [[nodiscard]] double minutes() const { return feed_minutes + rapid_minutes; }
};

/// A program that holds a part of the teeth, beside the whole one.
struct PartReport {
  joints::ProgramPart part;
  std::string type;  ///< of the operation
  std::string file, name_on_control, sha256;
  std::size_t bytes = 0, blocks = 0;
  std::vector<int> tools;                      ///< T, in the order of their use
  double feed_minutes = 0, total_minutes = 0;  ///< of this program
};

/// A flank that was corrected by a measurement.
struct CorrectionRow {
  int zone = 0, side = 1;
  std::string file;  ///< what was fitted
  int teeth = 1;     ///< on which it was measured
  modification::CorrectionResidual fit;
};

/// Flanks whose drawing takes something off the plain ones: what, and what it comes to.
struct ModifiedFlanks {
  struct Zone {
    int zone = 0;
    tooth_space::ModifiedForm form;
  };
  std::vector<modification::Modification> list;
  std::vector<Zone> zones;  ///< those that are modified, of gears that are milled on their tooth spaces
  std::optional<bevel_gear::ModifiedForm> walls = {};  ///< of equal-base-circle bevel gears
  [[nodiscard]] double most_removed_mm() const;
};

/// How wrong the length of a tool may be before a proven program leaves its limits (docs/setup_sheet.md).
struct LengthTolerance {
  int operation = 0, tool_number = 0;
  double share = 1;  ///< proven: the error moves the cut surface along its normal by no more than this times itself
  double flank_share = 1;  ///< the same on the flanks alone
  double too_long_mm = 0;  ///< the gouge tolerance is not left
  std::optional<double>
      too_short_mm;  ///< what a finishing operation may leave is not exceeded; none: another operation cuts there
};

/// A tool whose length the program checks.
struct ToolCheckUse {
  int tool = 0, checks = 0;
  double tolerance_mm = 0;  ///< the program stops where the length is further off
};

/// Poles of a rotary that the program passes (docs/axis_motion.md).
struct PolesReport {
  std::size_t passages = 0;  ///< of one tooth
  std::string option;        ///< of the machine file or the job that was taken: "hold"
  double axis_rad = 0;       ///< proven: for it the tool axis moves by no more ..
  double tip_mm = 0;         ///< .. and the tip, about the centre of the ball, which stays
};

/// The same in one line, for page and set-up sheet.
[[nodiscard]] std::string poles_text(const PolesReport& poles);

/// A pass with the side of a mill along a flank.
struct SidePass {
  int flank = 1, strip = 0;
  std::string rotaries;  ///< which of them move
  double misfit_mm = 0;
  double contact_top_mm = 0;  ///< highest contact above the tip, along the axis
  struct Station {
    double r_mm = 0, lean_rad = 0, tilt_rad = 0, misfit_mm = 0;
  };
  std::vector<Station> stations;  ///< from the inner end to the outer
};

/// One pass of an operation in one zone.
struct PassReport {
  int operation = 0, zone = 0, pass = 0;
  std::string name;      ///< "middle", "wall L"
  bool outward = false;  ///< away from the apex
  double length_mm = 0;
  std::size_t points = 0;
  std::optional<SidePass> side = {};  ///< of a pass with the side of a mill
};

/// What one flank of a line-milled operation takes by the side of its mill and by its ball end. Minutes at the feed of
/// the contact, all teeth.
struct FlankWaysReport {
  int operation = 0, zone = 0, flank = 1;
  struct Tried {
    int strips = 1;
    double left_mm = 0;
    bool more = false;  ///< it leaves more than that
  };
  std::vector<Tried> tried;  ///< with rising strips, the planned one last; empty: the side does not cut it
  double side_minutes = 0;
  int ball_passes = 0;  ///< about
  double ball_minutes = 0;
  bool by_ball = false;  ///< that was taken
  std::string refused;   ///< why the other one could not be; empty: it is slower, or was not asked for
};

/// Where the part has the most room, and set-up origin and work offset there.
struct TravelRoom {
  choice::TravelOffer offer;
  Vec3 origin_mm = Vec3::Zero(), work_offset_at_mm = Vec3::Zero();
};

struct RunReport {
  std::string command;  ///< "run", "check", "surface"
  std::string job_name, job_file, machine_name, machine_file, dialect;
  bool verified = false;
  std::vector<std::string> reasons;     ///< why it is not verified
  std::vector<std::string> would_help;  ///< what would meet the limit that was missed

  std::string directory;                     ///< of the results, as the user wrote it; empty: not said
  std::string program_file, program_sha256;  ///< empty where no program was written
  std::string name_on_control;               ///< what the job's own name or number makes of it there; may be empty
  std::size_t program_bytes = 0;

  double gouge_tolerance_mm = 0;
  std::optional<proof::GougeResult> gouge;
  std::vector<proof::ExcessResult> excess;  ///< one an operation
  std::optional<proof::ExcessResult>
      finished;                   ///< the finished surface, over the points that the finishing ball reaches
  std::vector<Finding> findings;  ///< what else there is to say about the part
  std::optional<readback::ConditionsFound> conditions;  ///< feeds, speeds, tools and coolant as they were read
  std::optional<readback::ProgramHash> hash;            ///< line HASH of the program that was read; none: it has none

  std::size_t cl_points = 0, blocks = 0;
  double feed_minutes = 0, total_minutes = 0;  ///< all teeth, rapids and `tool_change_minutes` in the second
  std::optional<double> tool_change_minutes;   ///< of all tool changes; none: the machine file does not state them
  std::vector<OperationReport> operations;
  std::vector<proof::DirectionChoice> directions;
  std::vector<PassReport> passes;            ///< of one tooth space, where the plan tells them
  std::vector<FlankWaysReport> flank_ways;   ///< of line milling: what each way takes
  std::vector<EngagementReport> engagement;  ///< of operations that ask for a chip load or an engagement
  std::vector<joints::AxisRange> axes;
  std::optional<PolesReport> poles;                  ///< none where the program comes to no pole
  std::optional<TravelRoom> travel_room;             ///< none where it was not looked for
  bool has_acceleration = false;                     ///< the times above hold the accelerations of the axes
  std::string time_model;                            ///< what the times hold and assume
  std::optional<BlockTimes> block_times;             ///< none where no program was posted
  int teeth = 0, tooth_stride = 1;                   ///< of the program: place n cuts tooth n * stride mod teeth
  std::optional<joints::ProgramRestart> restart;     ///< the program begins there
  std::vector<joints::ToolUse> tool_uses;            ///< of tools whose life is stated
  std::vector<ToolCheckUse> tool_checks;             ///< in the order of their first check
  std::vector<PartReport> parts;                     ///< programs beside the whole one, in their order
  std::optional<restart::RestartMenu> restart_menu;  ///< where it can be taken up again
  std::vector<LengthTolerance> length_tolerances;
  std::vector<Section> sections;  ///< tables for page and set-up sheet: app/report/sections
  std::vector<proof::LedgerEntry> ledger;
  std::string force_basis;          ///< of the forces of the operations: coefficients and where they are from
  std::vector<SceneVerdict> scene;  ///< fixture and stock, where meshes of them were given
  std::optional<bodies::MovesFound> machine_moves;  ///< none where no program was proven
  std::optional<ModifiedFlanks> modified;           ///< none where the flanks are plain
  std::vector<CorrectionRow> correction;            ///< empty: the nominal flanks are the target
  inspection::IndexOfTeeth index;                   ///< pitch and run-out, where several teeth were measured
  std::optional<CadReport> cad;                     ///< none where no solid was asked for
  std::optional<RoughedReport> roughed;             ///< none where it was not asked for, and where nothing roughs
  std::vector<std::string> assumed, warnings;
  std::vector<std::string> files;                      ///< written by this run
  std::vector<std::pair<std::string, double>> stages;  ///< name and seconds, those that ran
};

/// report.json, ending in a line feed. Values that a command does not have are left out; lengths in um where the key
/// says so.
[[nodiscard]] std::string report_json(const RunReport& report);

/// "verified" or "not verified"; a verified one says what qualifies it: "root not finished" (surface that the finishing
/// ball does not reach was left), "3 of 812 patches by sampling" (bends of the surface that no enclosure bounds).
[[nodiscard]] std::string verdict_text(const RunReport& report);
/// What the program leaves though it is verified; empty: nothing.
[[nodiscard]] std::string unfinished_text(const RunReport& report);

/// The table on the screen: verified or not, worst gouge, worst left material, cutting time, tools, axis ranges, how
/// many values are assumed. Plain text; with `color` the verdict is green, amber or red.
[[nodiscard]] std::string summary_table(const RunReport& report, bool color);

/// "1 h 23 min", "4 min 05 s".
[[nodiscard]] std::string readable_minutes(double minutes);

/// What the times of the report hold and assume, tool changes too; one sentence without full stop.
[[nodiscard]] std::string times_text(const RunReport& report);

}  // namespace toothpath::report
