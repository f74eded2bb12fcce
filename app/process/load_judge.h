// What the cuts of a text take off, against what the job asks and what a plan of it would meet: nobody who wrote a text
// by hand sees that.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/job/job.h"
#include "app/process/program_proof.h"
#include "cam/cut/engagement.h"
#include "cam/path/tool_motion.h"
#include "cam/tool/profile.h"
#include "cam/tool/proof_tool.h"
#include "geometry/base/result.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::process {

/// Motions turned to tooth space 0.
[[nodiscard]] std::vector<path::ToolMotion> in_space_0(std::vector<path::ToolMotion> motions, int teeth);
/// The first tooth of every operation, as if it were tooth 0.
[[nodiscard]] std::vector<path::ToolMotion> first_in_space_0(const std::vector<path::ToolMotion>& motions, int teeth);

/// Motions of the first operations in tooth space 0, as the job is planned for its machine.
using PlannedMotions = Result<std::vector<path::ToolMotion>>;
using PlanAnew = std::function<const PlannedMotions&(std::size_t operations)>;
/// Planned when it is first asked, and kept: whoever checks many texts of a job plans it once. A job asks for the same
/// number of operations whenever it asks.
[[nodiscard]] PlanAnew planned_once(std::function<PlannedMotions(std::size_t operations)> plan);

/// What a gear tells of its mills and its blank.
struct LoadQuery {
  const job::Job& job;
  std::vector<tool::Profile> mills = {};     ///< of the operations
  std::vector<tool::ProofTool> bodies = {};  ///< the same as bodies
  std::function<bool(const Vec3&)> in_blank = {};
  double top_mm = 0;  ///< z above which it never is
  tooth_space::Chart chart = {};
  std::vector<double> stock_before_mm =
      {};              ///< of the operations: the most that those ahead leave; infinite: not known
  PlanAnew plan = {};  ///< tells what is not known; empty: nothing is planned
};

class LoadJudge {
 public:
  explicit LoadJudge(LoadQuery query) : q_(std::move(query)) {}

  /// Joins what is more than `cut::kLoadFactor` times what the job asks. @param one_space  cuts in tooth space 0
  void judge(std::span<const path::ToolMotion> one_space, std::vector<std::string>& reasons) const;
  /// Joins what is more than so many times what a plan made anew meets, of operations that do not rough and meet what
  /// others left, of which the job says nothing. Operations that are the plan's, as those ahead of them are, meet what
  /// it meets. Planning takes long: only of a text that nothing else refuses, and no side of a mill whose stock is
  /// asked: there the text's own motions are taken through what the plan leaves.
  /// @param warnings  get why there is no plan
  void judge_by_plan(std::span<const path::ToolMotion> one_space, std::vector<std::string>& reasons,
                     std::vector<std::string>& warnings) const;

 private:
  [[nodiscard]] bool asks_plan(std::size_t operation) const;
  /// So many operations are planned for those that ask.
  [[nodiscard]] std::size_t planned_operations() const;
  /// What an operation of the plan meets: stock, and the angle over which a tooth is in the material and a step, of
  /// motions so far apart.
  [[nodiscard]] double planned_stock(std::span<const path::ToolMotion> plan, std::size_t operation) const;
  [[nodiscard]] double planned_rad(std::span<const path::ToolMotion> plan, std::size_t operation,
                                   double radii_apart) const;
  void judge_engagement(std::span<const path::ToolMotion> plan, std::size_t operation,
                        const std::vector<path::ToolMotion>& motions, const cut::EngagementQuery& query,
                        std::vector<std::string>& reasons) const;

  static void judge_stock(std::size_t operation, const cut::Overload& load, double stock_mm,
                          std::vector<std::string>& reasons);

  LoadQuery q_;
};

/// Later teeth with cuts that the first one does not have: what they take off is not what it takes off there.
class LoadedOtherwise {
 public:
  /// Looks at texts of others alone.
  LoadedOtherwise(const ProgramProof& program, const GearCheck& gear);
  /// Sees all motions, in one list or tooth by tooth, with those that go as a first tooth's do.
  void see(const std::vector<path::ToolMotion>& motions, std::span<const proof::LikeMotion> likes);
  /// Each by itself; reasons name the tooth.
  void judge(ProgramProof& program, const LoadJudge& load) const;

 private:
  const GearCheck& gear_;
  std::map<int, int> firsts_;  // tooth of every operation; empty: nothing is looked at
  std::set<int> teeth_;
};

}  // namespace toothpath::process
