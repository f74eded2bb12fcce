// What a gear type tells, so that every command works on it: the way from a job to a verdict is written once, on these
// two interfaces.
//
// `GearProcess` is the gear that a job asks for; `GearMilling` is that gear while it is milled and proven. Each is
// implemented once a gear type (app/process/face, app/process/bevel), and app/process/flow/registry.cpp has a line for
// each. Virtual calls stand on the cold path only: what is behind them (kernels, planners, checks) knows one gear type
// and stays apart.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/base/output_dir.h"
#include "app/base/stage_clock.h"
#include "app/job/job.h"
#include "app/job/measured_file.h"
#include "app/process/cut_flanks.h"
#include "app/process/gear_of_job.h"
#include "app/process/least_values.h"
#include "app/process/opening_and_end.h"
#include "app/process/program_proof.h"
#include "app/process/scene.h"
#include "app/process/scene_place.h"
#include "app/report/page/page_of_run.h"
#include "app/report/run_report.h"
#include "app/report/sheet/length_tolerance.h"
#include "app/report/sheet/setup_sheet.h"
#include "cam/path/operation.h"
#include "cam/proof/checked_cl_path.h"
#include "cam/proof/limits.h"
#include "cam/rest/rest_mesh.h"
#include "geometry/exchange/shell.h"
#include "geometry/inspection/grid.h"
#include "geometry/inspection/touches.h"
#include "geometry/mesh/triangle_mesh.h"
#include "machines/machine.h"
#include "postproc/joints/program.h"

namespace toothpath::tooth_space {
class ToothedPart;
}
namespace toothpath::process {

/// What every stage may want to know of the finished part; lengths in mm.
struct PartFacts {
  int teeth = 0;
  double diameter_mm = 0;        ///< of the finished teeth
  double swing_diameter_mm = 0;  ///< of all that turns with them: teeth, hub, shaft
  std::vector<std::string> warnings;
  std::optional<report::ModifiedFlanks> modified = {};  ///< none where the flanks are plain
};

/// How fine the facets of a mesh are: as those of gear.stl, or a few thousand a pitch for pictures.
enum class FacetSize : std::uint8_t { file, picture };

/// Operations whose way the job leaves open (`best_way`) become what the plan took; none is open then.
inline void take_ways(std::vector<path::MillingOperation>& operations,
                      const std::vector<report::FlankWaysReport>& ways) {
  for (const report::FlankWaysReport& way : ways)
    if (auto& o = operations[std::size_t(way.operation)]; o.best_way && way.by_ball) o = path::by_ball_end(o);
  for (path::MillingOperation& o : operations) o.best_way = false;
}

/// Points of a flank on which the cut surface is measured; 0: as many as the gear type finds right.
struct FlankGrid {
  int rows = 0, columns = 0;
};

/// Nominal points of both flanks of every zone, in the order of inspection.csv.
struct InspectedFlanks {
  inspection::InspectionOptions grid;
  std::vector<inspection::InspectionPoint> points;
  inspection::FlankNames names;
};
/// Another grid than that of inspection.csv.
struct GridAsked {
  std::optional<int> rows, columns;
  std::optional<double> margin;
  [[nodiscard]] inspection::InspectionOptions instead_of(const inspection::InspectionOptions& usual) const {
    return {rows.value_or(usual.rows), columns.value_or(usual.columns), margin.value_or(usual.margin)};
  }
};

/// A gear that is milled: from its operations to checked paths, and from the motions of a program to a verdict.
class GearMilling {
 public:
  virtual ~GearMilling() = default;

  /// Plans every operation for one tooth space, in stages of the gear's own. Refused: with the place in the job.
  [[nodiscard]] virtual Status plan(app::StageClock& clock, app::Progress& progress) = 0;
  /// As far as it was planned: one an operation, in the order of the job. They live as long as this.
  [[nodiscard]] virtual std::vector<const path::ClPath*> paths() const = 0;
  /// Directions of the tool axis that the plan chose, with its reasons; empty where they are read from the program
  /// only.
  [[nodiscard]] virtual std::vector<proof::DirectionChoice> directions() const = 0;
  /// Passes of the plan for page and report.json; empty where the plan has none to tell.
  [[nodiscard]] virtual std::vector<report::PassReport> passes() const = 0;
  /// What each way of cutting a line-milled flank takes, and which the plan took.
  [[nodiscard]] virtual std::vector<report::FlankWaysReport> flank_ways() const { return {}; }
  /// Engagement along the paths of operations that ask for it; empty where none does.
  [[nodiscard]] virtual std::vector<report::EngagementReport> engagement() const { return {}; }
  /// What the plan would have its reader know; warnings of the report.
  [[nodiscard]] virtual std::vector<std::string> advice() const { return {}; }
  /// The gouge check of one path: the only way to a CheckedClPath. Errors (kind verification): the deepest place.
  [[nodiscard]] virtual Result<proof::CheckedClPath> approve(const path::ClPath& path) const = 0;

  /// The type of the operations that rough this gear.
  [[nodiscard]] virtual path::OperationType roughing() const = 0;
  /// What those of the plan remove from tooth space 0, never more than they do but for 0.01 mm; none where nothing
  /// roughs.
  [[nodiscard]] virtual rest::Excess roughed() const = 0;

  /// What this gear adds to the proof of the next program; what it has met of another one is forgotten.
  [[nodiscard]] virtual GearCheck& check() = 0;
  /// Every source of deviation of the program that check() judged last, predicted by the plan and measured.
  [[nodiscard]] virtual std::vector<proof::LedgerEntry> ledger(const joints::AxisProgram& program,
                                                               const ProgramProof& proof, double blend_mm) const = 0;
  /// Surface that no grid of the cut surface holds, for the tolerances of tool lengths.
  [[nodiscard]] virtual sheet::OtherSurface beside_the_grid() const = 0;
};

/// What answering a measurement came to.
struct Correction {
  std::vector<report::CorrectionRow> rows;
  inspection::IndexOfTeeth index = {};  ///< where several teeth were measured
  std::vector<std::string> warnings = {};
  std::string json;  ///< correction.json
};

/// A pair to be rolled; what stands here comes instead of the keys of [contact].
struct ContactAsked {
  std::optional<int> pinion_teeth;
  std::optional<double> offset_error_mm, angle_error_deg, axial_error_mm, compound_um;
  std::optional<double> wheel_axial_error_mm;               ///< of the gear, or of the wheel of a bevel pair
  std::string other_job;                                    ///< the mate
  std::optional<double> shaft_angle_deg, axis_distance_mm;  ///< of two jobs whose keys do not say them
  std::optional<double> torque_Nm;                          ///< load the pair, too
  bool torque_on_pinion = false;                            ///< that torque is the pinion's
  bool pinion_held = false;                                 ///< along its axis, where it would float
  std::optional<int> positions;                             ///< of the loaded pair over a pitch
  std::string ccx_dir;                                      ///< where decks of CalculiX go; empty: none
  bool as_cut = false;                                      ///< the surface that the job's operations cut, too
  job::MeasuredInput measured = {};                         ///< or the one that was measured
  bool optimise = false;                                    ///< seek crownings and reliefs for the box of misalignments
  std::string modify;      ///< whose flanks they may take: a word of kModifiable; empty: any
  std::string write_file;  ///< where the job with what was found goes; empty: nowhere
};
/// Whose flanks `contact --optimise` may modify.
inline constexpr std::string_view kModifiable[] = {"gear", "pinion", "both"};
struct ContactFound {
  NamedFiles files;
  NamedFiles decks;  ///< of CalculiX, where they are asked for
  std::string json, summary;
  bool missed = false;   ///< modifications were sought, and none keep the pattern inside
  std::string job_text;  ///< the job with what was found; empty: nothing was, or nobody asked
};

/// The gear that a job asks for. The job must outlive it.
class GearProcess {
 public:
  virtual ~GearProcess() = default;

  [[nodiscard]] virtual const PartFacts& part() const = 0;
  /// From now on the flanks to cut answer measured files, in the order of the cuts. Stage "correction". Refused: what
  /// they refuse; a gear type that cannot.
  [[nodiscard]] virtual Result<Correction> correct(const job::MeasuredInput& measured, app::StageClock& clock) = 0;

  /// The body that links go around, on this machine.
  [[nodiscard]] virtual joints::ClearanceBody link_body(const machines::Machine& machine) const = 0;
  /// For the sketch of the set-up sheet.
  [[nodiscard]] virtual sheet::PartOutline outline() const = 0;
  /// Subtitle and tools of the report page.
  [[nodiscard]] virtual page::GearOnPage on_page(const std::string& machine_name) const = 0;
  /// limits.json.
  [[nodiscard]] virtual std::string limits_json() const = 0;
  /// Refused: a grid that the gear type does not measure; a station where a flank does not reach from tip to fillet.
  [[nodiscard]] virtual Result<InspectedFlanks> inspected(const GridAsked& asked = {}) const = 0;
  /// Where its flanks end, for the page of a run; may be empty.
  [[nodiscard]] virtual std::vector<svg::LineChart> limit_charts() const = 0;
  /// What a check of fixture and stock must know. Errors: a tool that does not fit the gear, at its place in the job.
  [[nodiscard]] virtual Result<SceneGear> scene(double clearance_mm) const = 0;
  /// The finished gear as a mesh, its facets within 0.02 mm. Errors: what has no mesh, at gear.
  [[nodiscard]] virtual Result<FinishedGear> solid() const = 0;

  /// The same with its facets as those of gear.stl.
  [[nodiscard]] virtual Result<mesh::TriangleMesh> mesh() const = 0;
  /// One of as many equal parts as it has teeth: turned once a tooth it is the whole gear. Errors: what has no mesh, at
  /// gear.
  [[nodiscard]] virtual Result<mesh::TriangleMesh> pitch_mesh(FacetSize size) const = 0;
  /// The turned body before its teeth are cut; its pitches begin at azimuth 0.
  [[nodiscard]] virtual rest::Blank blank() const = 0;
  /// The skin of the nominal gear as exact surfaces. Errors: what is no solid.
  [[nodiscard]] virtual Result<exchange::GearShell> shell() const = 0;

  /// Limits, inspection points, meshes; with `surface` tooth.vtp is the cut surface with its deviation, without the
  /// plain tooth.
  /// @param assumed values of the machine that nobody measured;  @param files names join it
  [[nodiscard]] virtual Status write_files(app::OutputDir& output, const std::vector<proof::SurfaceGrid>& surface,
                                           const std::vector<std::string>& assumed, app::StageClock& clock,
                                           std::vector<std::string>& files) const = 0;

  /// What control, words and proof of this machine take of the job's tolerances, at these teeth.
  [[nodiscard]] virtual Taken taken(const machines::Machine& machine) const {
    return taken_by(machine, 0.5 * part().diameter_mm);
  }
  /// To mill it on this machine within these limits. The machine must outlive it.
  [[nodiscard]] virtual std::unique_ptr<GearMilling> milling(const machines::Machine& machine,
                                                             const proof::ProofLimits& limits, const FlankGrid& grid,
                                                             app::StageClock& clock) const = 0;

  /// Its flanks as the strokes of the job's gear shaper leave them. Refused: what `shaper` refuses; a gear type that is
  /// not shaped.
  [[nodiscard]] virtual ValueOrErrors<CutFlanks> shaped(const FlankGrid& grid) const = 0;
  /// What a probe may touch of it, teeth and blank. The gear must outlive it.
  [[nodiscard]] virtual std::unique_ptr<inspection::TouchedPart> touched() const = 0;
  /// Its teeth with the flanks to aim at, to roll with those of another job; null: a gear type that rolls with mates of
  /// its own alone.
  [[nodiscard]] virtual std::shared_ptr<const tooth_space::ToothedPart> toothed() const { return nullptr; }
  /// The flanks of toothed() as measured files tell of them: the fit of their deviations. Refused: what the files
  /// refuse; a gear type that has no toothed().
  [[nodiscard]] virtual ValueOrErrors<CutFlanks> measured(const job::MeasuredInput& /*measured*/) const {
    return std::vector{fail("such flanks are measured in another way")};
  }
  /// Refused, at gear.type: what is asked and this gear type does not have.
  [[nodiscard]] virtual Status accepts(const ContactAsked& asked) const = 0;
  /// The gear and its mate rolled. @param cut flanks as they were cut, beside the exact ones; may be null. Refused: a
  /// mate that cannot run.
  [[nodiscard]] virtual ValueOrErrors<ContactFound> contact(const ContactAsked& asked, const CutFlanks* cut,
                                                            app::StageClock& clock) const = 0;
  /// The section on contact of a run's page, for jobs that ask for it with [contact]; else empty, as where the mate
  /// cannot run: that joins `warnings`. @param surface as it was cut
  [[nodiscard]] virtual std::string contact_section(const std::vector<proof::SurfaceGrid>& surface,
                                                    std::vector<std::string>& warnings) const = 0;
};

}  // namespace toothpath::process
