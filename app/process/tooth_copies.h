// Teeth of a program that are written out one by one: those that are the first tooth again, turned, need not be proven
// again.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cam/path/tool_motion.h"
#include "cam/proof/cuts_again.h"
#include "cam/proof/like_motion.h"

namespace toothpath::process {

/// Cutting motions of a tooth are left out where every operation cuts it as it cuts its own first tooth, turned about
/// the gear axis, to within the tolerance at every moment of every block, up to a metre from the tip. How far tip and
/// axis are found away is added to the deviations of the first tooth's motions, so that what is proven of these holds
/// for all. Rapids, and teeth that differ anywhere, are kept as they are.
/// @param motions  in program order, W; @param teeth  of the gear
[[nodiscard]] std::vector<path::ToolMotion> without_copies(std::vector<path::ToolMotion> motions, int teeth,
                                                           double tolerance_mm);

/// Cutting motions of later teeth that go within 0.1 mm of their operation's first tooth, however either is cut into
/// blocks, in the order of the motions. What is proven of the first tooth tells of them all but this distance.
/// @param motions, teeth  as above
[[nodiscard]] std::vector<proof::LikeMotion> like_motions(const std::vector<path::ToolMotion>& motions, int teeth);

/// A later tooth of an operation that is no copy of the first one: how it makes the cuts of that again. A tooth that
/// the operation does not cut at all has all of them missing, behind no line.
struct ToothCut {
  int operation = 0, tooth = 0;
  int first_tooth = 0;  ///< of the operation
  proof::CutsAgain again;
  [[nodiscard]] bool cuts_nothing() const { return again.missing && again.missing->behind_line == 0; }
};

/// Of one with a missing cut: "tooth 3: the cut of line 17, tooth 0, is not made again behind line 345 ..".
[[nodiscard]] std::string told(const ToothCut& other);

/// Every tooth 0 .. teeth - 1 that is no copy of its operation's first one, by operation and tooth.
/// @param motions, teeth, tolerance_mm  as of without_copies(), ahead of it; no tolerance: no tooth is a copy
[[nodiscard]] std::vector<ToothCut> cuts_of_other_teeth(const std::vector<path::ToolMotion>& motions, int teeth,
                                                        std::optional<double> tolerance_mm,
                                                        const proof::FirstTooth::MayCut& may_cut);

/// Of every operation the first tooth that it cuts.
[[nodiscard]] std::map<int, int> first_teeth(std::span<const path::ToolMotion> motions);

/// Largest deviations that motions state while cutting.
struct Stated {
  double tip_mm = 0, axis_rad = 0;
  void add(const Stated& other) {
    tip_mm = std::max(tip_mm, other.tip_mm);
    axis_rad = std::max(axis_rad, other.axis_rad);
  }
};
[[nodiscard]] Stated stated_deviation(std::span<const path::ToolMotion> motions);

/// The same of a program that is never held as a whole: its teeth come one by one, and what stays is the first one of
/// every operation. All teeth are seen once before anything is said of them.
class ToothByTooth {
 public:
  /// @param copy_tolerance_mm  none: no tooth is left out as a copy
  ToothByTooth(int teeth, std::optional<double> copy_tolerance_mm, proof::FirstTooth::MayCut may_cut);
  ToothByTooth(const ToothByTooth&) = delete;
  ToothByTooth& operator=(const ToothByTooth&) = delete;
  ~ToothByTooth();

  /// The first tooth of an operation, with the rapids ahead of it. It cuts.
  void first(std::span<const path::ToolMotion> motions);
  /// A later one beside the first; several at a time may be looked at.
  struct Seen {
    int operation = -1, tooth = -1;  ///< below 0: it cuts nothing
    Stated stated;
    bool like = false;           ///< some motion is like the first tooth
    std::vector<Stated> blocks;  ///< a copy: how far each of its blocks may be from the first tooth's
    proof::CutsAgain again;      ///< else
  };
  [[nodiscard]] Seen seen(std::span<const path::ToolMotion> motions) const;
  void note(const Seen& seen);
  /// All teeth were seen. False: they must be seen once more, for one is a copy in some operations only.
  [[nodiscard]] bool settle();

  /// Of all operations, in their order; they stand for the teeth that are left out.
  [[nodiscard]] std::span<const path::ToolMotion> firsts() const { return firsts_; }
  [[nodiscard]] std::span<const path::ToolMotion> first_of(int operation) const;
  /// The cuts of this tooth are those of the first one in every operation.
  [[nodiscard]] bool left_out(int tooth) const;
  /// As cuts_of_other_teeth() says it of the whole program.
  [[nodiscard]] std::vector<ToothCut> other_teeth() const;
  /// Of all that is not left out.
  [[nodiscard]] Stated stated() const;
  /// Some of it is like a first tooth.
  [[nodiscard]] bool any_like() const;
  /// Those of a later tooth by their number among `motions`, what they are like by its number in firsts().
  [[nodiscard]] std::vector<proof::LikeMotion> likes(std::span<const path::ToolMotion> motions) const;

 private:
  struct First;
  struct Later;
  int teeth_;
  std::optional<double> tolerance_mm_;
  proof::FirstTooth::MayCut may_cut_;
  std::map<int, proof::FirstTooth> first_teeth_;  ///< of the operations, with what each of them may cut
  std::vector<path::ToolMotion> firsts_;
  std::map<int, First> operations_;
  std::map<std::pair<int, int>, Later> later_;  ///< by operation and tooth
  std::optional<std::set<int>> copies_;         ///< once all teeth were seen
};

}  // namespace toothpath::process
