// From the bytes of an NC program to what is proven about them, whatever the gear: read back through the machine's
// kinematics, rapids one group of axes at a time and clear of the part, travels kept, teeth that are turned copies left
// out, what the motions do to the part, and the program against the path that was asked for. What differs from gear to
// gear is a `GearCheck`: a gear type without one has no proof, and none can leave a step out.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/base/stage_clock.h"
#include "app/job/job.h"
#include "app/process/tooth_copies.h"
#include "app/report/finding.h"
#include "cam/proof/like_motion.h"
#include "cam/proof/verification.h"
#include "machines/machine.h"
#include "postproc/bodies/moves.h"
#include "postproc/readback/conditions.h"
#include "postproc/readback/program_hash.h"
#include "postproc/readback/reader.h"

namespace toothpath::process {

/// A program and where it is to run.
struct ProgramText {
  std::string_view text;
  const std::string& file;  ///< as it stands in messages
  const job::Job& job;      ///< with its [setup]
  const machines::Machine& machine;
  bodies::MovesJudge* moves = nullptr;  ///< sees every move that is executed; null: no bodies are stated
  std::function<void(const readback::ExecutedMove&)> watch = {};  ///< sees them too; may be empty
  std::optional<joints::GraphicsBlank> blank = std::nullopt;      ///< that the graphics of the control should have
  bool stock_is_stated = false;  ///< a mesh is: operations ahead of the first one of the text may be done
};

/// The paths that a program must meet, and how far it may be off them: mm, rad. Without paths (a program that somebody
/// else wrote) nothing is compared.
struct AskedPaths {
  std::span<const path::ClPath* const> paths;
  double mm = 0, rad = 0;  ///< bounds of the axis program; what reading back adds is added
};

/// Takes the motions of one tooth of an operation, in the order of the program, and those among them that are like
/// motions of first teeth: by their number in this list, and in the list of all first teeth. `first`: such a tooth.
using ToothSink =
    std::function<void(std::vector<path::ToolMotion>&& motions, std::span<const proof::LikeMotion> likes, bool first)>;

/// Of later teeth the cuts alone, where they are wanted for what they are like.
enum class TeethWanted : std::uint8_t { whole, cuts };

/// What is found about a program of any gear. The first half is read from the text, the second is what the gear says of
/// it.
struct ProgramProof {
  readback::NcControl control;
  readback::ReadBack read;
  /// In program order. Where the teeth are followed one by one, `each_tooth`: those of the first tooth of every
  /// operation and of tooth space 0; else of all teeth that were kept.
  std::vector<path::ToolMotion> motions;
  std::vector<proof::LikeMotion> likes;  ///< those of `motions` that go nearly as their operation's first tooth
  /// All that is to be proven, tooth by tooth, made anew from the text: they are not held. Empty: `motions` are all.
  std::function<Status(TeethWanted, const ToothSink&)> each_tooth;
  std::size_t tooth_motions = 0;                     ///< that each_tooth gives, at most
  bool likes_follow = false;                         ///< some of them are like others
  Stated stated;                                     ///< of all that is to be proven
  std::vector<ToothCut> other_teeth;                 ///< later teeth that are no copies of their operation's first one
  std::optional<readback::ClComparison> comparison;  ///< only where there is a path to compare with
  double path_tolerance_mm = 0;                      ///< of that comparison
  readback::ConditionsFound conditions;              ///< feeds, speeds, tools, coolant
  std::optional<readback::ProgramHash> hash;         ///< none: the text has no such line
  std::vector<std::string> reasons;                  ///< why the program is not proven; empty: it is
  std::vector<std::string> warnings;                 ///< what may be a choice

  bool others_text = false;  ///< no path is known: what its cuts take off is judged, too
  bool swept = true;         ///< false: the axes leave their travels, and nothing below is known
  proof::GougeResult gouge;
  std::vector<proof::ExcessResult> excess;         ///< one an operation
  std::optional<proof::ExcessResult> finished;     ///< the finished surface; none: no operation finishes it
  std::vector<proof::SurfaceGrid> surface;         ///< the cut surface of one tooth space
  std::vector<proof::DirectionChoice> directions;  ///< as the program was seen to do it; empty: not looked at
  std::vector<report::Finding> findings;           ///< what else there is to say
  bodies::MovesFound machine_moves;                ///< bodies of the machine against each other
};

/// What a gear type adds to the proof of a program.
class GearCheck {
 public:
  virtual ~GearCheck() = default;

  [[nodiscard]] virtual int teeth() const = 0;
  /// How near a motion is followed: largest proven distance from its straight line, mm (tip) and rad (axis). Counts in
  /// every bound.
  [[nodiscard]] virtual double motion_tolerance() const = 0;
  /// How far a place of the tip lies about the gear axis from the middle of tooth space 0 at its radius, in pitches: a
  /// whole number is the middle of another space.
  [[nodiscard]] virtual double pitches_from_space_0(const Vec3& tip) const = 0;
  /// Do the rapids of this trace keep the whole tool clear of part and blank at every moment? A refusal names the line.
  [[nodiscard]] virtual Status rapids_clear(const readback::OperationTrace& trace,
                                            const readback::NcControl& control) const = 0;
  /// Could this feed motion remove anything of the blank? The cuts that could must be made again on every tooth.
  [[nodiscard]] virtual bool may_cut(const path::ToolMotion& motion) const = 0;
  /// Does judge() measure on every tooth what this operation leaves, where a tooth is cut otherwise than the first one?
  /// Of other operations every cut must be made again: the next one would meet more than it was planned for.
  [[nodiscard]] virtual bool measures(int operation) const = 0;
  /// Sees the program as it was read ahead of judge(), all teeth that were kept, before copies among them are left out:
  /// stretch by stretch, each of one operation, the moves with the motions made of them.
  virtual void meet(const readback::OperationTrace& trace, std::span<const path::ToolMotion> motions,
                    const readback::NcControl& control) = 0;
  /// Gouge, clearance, material left on every tooth: what the motions of `program` do to the part, in stages of the
  /// gear's own, goes into the second half of `program`. What is not within its limit joins `program.reasons`.
  virtual void judge(ProgramProof& program, app::StageClock& clock) = 0;
};

/// The motions of `program` that are to be proven as one list, with those that are like others; what keeps them from
/// being made joins its reasons.
void with_all_motions(ProgramProof& program, const std::function<void(const std::vector<path::ToolMotion>& motions,
                                                                      std::span<const proof::LikeMotion> likes)>& work);

/// Cuts of these teeth, each its own list; what keeps them from being made joins the reasons.
[[nodiscard]] std::map<int, std::vector<path::ToolMotion>> cuts_of(ProgramProof& program, const std::set<int>& teeth);

/// Teeth that are told one by one.
inline constexpr std::size_t kTeethTold = 4;

/// The one proof of a program: feeds, speeds, tools and coolant are judged by what the job asks (proof_limits.h), a
/// line HASH that does not fit is a reason where the text is our own, a warning else. Of another text whose axes leave
/// their travels nothing else is asked. Stages "read back", "compare the
/// teeth" (only where teeth are written out), those of the gear, "compare with the path". Errors: what the reader
/// refuses, located in the file. A program that is read but not safe is no error: see `reasons`.
[[nodiscard]] Result<ProgramProof> prove_program(const ProgramText& program, const AskedPaths& asked, GearCheck& gear,
                                                 app::StageClock& clock);

}  // namespace toothpath::process
