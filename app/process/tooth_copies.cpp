#include "app/process/tooth_copies.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "cam/proof/beside.h"
#include "geometry/base/angle.h"

namespace toothpath::process {

/// Motions that one block of the text was cut into: pieces of equal time, indices [first, last).
struct MotionBlock {
  std::size_t first = 0, last = 0;
  [[nodiscard]] std::size_t pieces() const { return last - first; }
};

namespace {

using Block = MotionBlock;

constexpr double kReach =
    1000;  // mm: the axis also moves shank and holder, less than a metre away; a copy is near there

using ToothOfOperation = std::pair<int, int>;  // operation, tooth
using Blocks = std::map<ToothOfOperation, std::vector<Block>>;

/// Motion k, which cuts, joins the blocks of its tooth.
void add_cut(std::vector<Block>& blocks, std::span<const path::ToolMotion> motions, std::size_t k) {
  if (!blocks.empty() && blocks.back().last == k && motions[k - 1].line == motions[k].line &&
      motions[k - 1].minutes == motions[k].minutes)
    ++blocks.back().last;
  else blocks.push_back({k, k + 1});
}

/// Cutting blocks of every tooth of every operation, in program order.
Blocks cutting_blocks(const std::vector<path::ToolMotion>& motions) {
  Blocks cuts;
  for (std::size_t k = 0; k < motions.size(); ++k)
    if (!motions[k].rapid) add_cut(cuts[{motions[k].operation, motions[k].tooth}], motions, k);
  return cuts;
}

/// Angle that turns a tooth onto the first one.
double back_to_first(int tooth, int first, int teeth) { return -2 * kPi * (tooth - first) / teeth; }

struct Pose {
  Vec3 tip, axis;
};

/// How far copies are away: no tip farther, no axis turned farther.
struct Shift {
  double tip_mm = 0, axis_rad = 0;
  [[nodiscard]] double away() const { return tip_mm + kReach * axis_rad; }
  void take_greater(const Shift& other) {
    tip_mm = std::max(tip_mm, other.tip_mm);
    axis_rad = std::max(axis_rad, other.axis_rad);
  }
};

/// The first tooth and one that may be its copy.
class Turned {
 public:
  /// @param turn  from the copy back to the first tooth
  Turned(std::span<const path::ToolMotion> originals, std::span<const path::ToolMotion> copies, double turn)
      : originals_(originals), copies_(copies), c_(std::cos(turn)), s_(std::sin(turn)) {}

  /// Greatest distance of two blocks, the second one turned back, at the same share of their time. Between two ends of
  /// pieces of either both are straight, so that it is met at such an end; axes that are blended in a straight line and
  /// made unit vectors again differ by the inverse of their least length more.
  [[nodiscard]] Shift distance(const Block& original, const Block& copy) const {
    const std::size_t n = original.pieces(), m = copy.pieces();
    Shift most;
    for (std::size_t k = 0; k <= n; ++k) most.take_greater(apart(original, copy, k, n));
    if (m != n)
      for (std::size_t k = 0; k <= m; ++k) most.take_greater(apart(original, copy, k, m));
    most.axis_rad /= std::min(least_length(originals_, original), least_length(copies_, copy));
    return most;
  }

 private:
  [[nodiscard]] Shift apart(const Block& original, const Block& copy, std::size_t k, std::size_t of) const {
    const Pose a = at(originals_, original, k, of), b = at(copies_, copy, k, of);
    return {(back(b.tip) - a.tip).norm(), (back(b.axis) - a.axis).norm()};
  }
  /// Of the axes while they are blended: in the middle.
  [[nodiscard]] static double least_length(std::span<const path::ToolMotion> motions, const Block& block) {
    double least = 1;
    for (std::size_t k = block.first; k < block.last; ++k)
      least = std::min(least, 0.5 * (motions[k].axis_from + motions[k].axis_to).norm());
    return least;
  }
  /// Where the block is at the share k / of of its time; exact at the ends of its own pieces.
  [[nodiscard]] static Pose at(std::span<const path::ToolMotion> motions, const Block& block, std::size_t k,
                               std::size_t of) {
    const std::size_t whole = k * block.pieces(), piece = std::min(whole / of, block.pieces() - 1);
    const path::ToolMotion& m = motions[block.first + piece];
    const double t = static_cast<double>(whole - piece * of) / static_cast<double>(of);
    return {(1 - t) * m.tip_from + t * m.tip_to, (1 - t) * m.axis_from + t * m.axis_to};
  }
  [[nodiscard]] Vec3 back(const Vec3& v) const { return {c_ * v.x() - s_ * v.y(), s_ * v.x() + c_ * v.y(), v.z()}; }

  std::span<const path::ToolMotion> originals_, copies_;
  double c_, s_;
};

/// Greatest distance of any block of a tooth from that of the first one; nothing where it is no copy.
std::optional<Shift> shift_of(const Turned& turned, const std::vector<Block>& originals,
                              const std::vector<Block>& copies, double tolerance_mm) {
  if (originals.size() != copies.size()) return std::nullopt;
  Shift shift;
  for (std::size_t k = 0; k < originals.size(); ++k) {
    shift.take_greater(turned.distance(originals[k], copies[k]));
    if (!(shift.away() <= tolerance_mm)) return std::nullopt;
  }
  return shift;
}

Stated most_of(std::span<const path::ToolMotion> motions, const Block& block) {
  Stated most;
  for (std::size_t k = block.first; k < block.last; ++k) {
    most.tip_mm = std::max(most.tip_mm, motions[k].deviation_mm);
    most.axis_rad = std::max(most.axis_rad, motions[k].axis_deviation);
  }
  return most;
}

Stated farther(const Stated& copy, const Shift& by) { return {copy.tip_mm + by.tip_mm, copy.axis_rad + by.axis_rad}; }

/// The first tooth's block stands for copies as well: it may stray as far as they do, and by their distance.
void stand_for(std::span<path::ToolMotion> motions, const Block& original, const Stated& copies) {
  for (std::size_t k = original.first; k < original.last; ++k) {
    motions[k].deviation_mm = std::max(motions[k].deviation_mm, copies.tip_mm);
    motions[k].axis_deviation = std::max(motions[k].axis_deviation, copies.axis_rad);
  }
}

std::vector<path::ToolMotion> motions_of(std::span<const path::ToolMotion> motions, const std::vector<Block>& blocks) {
  std::vector<path::ToolMotion> out;
  for (const Block& block : blocks)
    out.insert(out.end(), motions.begin() + std::ptrdiff_t(block.first), motions.begin() + std::ptrdiff_t(block.last));
  return out;
}

/// By which a tooth is known: a tool that is changed ahead of it comes from anywhere. Null: it cuts nothing.
const path::ToolMotion* first_cut(std::span<const path::ToolMotion> motions) {
  const auto cut = std::find_if(motions.begin(), motions.end(), [](const auto& m) { return !m.rapid; });
  return cut == motions.end() ? nullptr : &*cut;
}

}  // namespace

std::string told(const ToothCut& other) {
  const auto& missing = *other.again.missing;
  return fmt::format(
      "tooth {}: the cut of line {}, tooth {}, is not made again behind line {}, the nearest one is {:.3f} mm away",
      other.tooth, missing.line, other.first_tooth, missing.behind_line, missing.off_mm);
}

std::map<int, int> first_teeth(std::span<const path::ToolMotion> motions) {
  std::map<int, int> first;
  for (const path::ToolMotion& m : motions)
    if (!m.rapid) first.emplace(m.operation, m.tooth);
  return first;
}

std::vector<ToothCut> cuts_of_other_teeth(const std::vector<path::ToolMotion>& motions, int teeth,
                                          std::optional<double> tolerance_mm,
                                          const proof::FirstTooth::MayCut& may_cut) {
  const Blocks cuts = cutting_blocks(motions);
  std::vector<ToothCut> others;
  std::map<int, proof::FirstTooth> firsts;  // of operations
  for (const auto& [operation, reference] : first_teeth(motions)) {
    firsts.try_emplace(operation, motions_of(motions, cuts.at({operation, reference})), may_cut);
    for (int tooth = 0; tooth < teeth; ++tooth)
      if (tooth != reference) others.push_back({operation, tooth, reference, {}});
  }
  std::vector<char> copies(others.size(), 0);
  tbb::parallel_for(std::size_t(0), others.size(), [&](std::size_t n) {
    ToothCut& other = others[n];
    const double turn = back_to_first(other.tooth, other.first_tooth, teeth);
    const auto own = cuts.find({other.operation, other.tooth});
    copies[n] = char(
        tolerance_mm && own != cuts.end() &&
        shift_of({motions, motions, turn}, cuts.at({other.operation, other.first_tooth}), own->second, *tolerance_mm));
    if (copies[n] != 0) return;
    const auto later = own == cuts.end() ? std::vector<path::ToolMotion>() : motions_of(motions, own->second);
    other.again = proof::cuts_again(firsts.at(other.operation), later, -turn);
  });
  std::size_t kept = 0;
  for (std::size_t n = 0; n < others.size(); ++n)
    if (copies[n] == 0) others[kept++] = others[n];
  others.resize(kept);
  return others;
}

std::vector<proof::LikeMotion> like_motions(const std::vector<path::ToolMotion>& motions, int teeth) {
  std::map<ToothOfOperation, std::vector<std::uint32_t>> cuts;
  for (std::size_t k = 0; k < motions.size(); ++k)
    if (!motions[k].rapid) cuts[{motions[k].operation, motions[k].tooth}].push_back(std::uint32_t(k));
  const std::map<int, int> first_tooth = first_teeth(motions);
  std::vector<ToothOfOperation> others;
  for (const auto& [key, cut] : cuts)
    if (key.second != first_tooth.at(key.first)) others.push_back(key);
  std::vector<std::vector<proof::LikeMotion>> found(others.size());
  tbb::parallel_for(std::size_t(0), others.size(), [&](std::size_t n) {
    const auto [operation, tooth] = others[n];
    const int reference = first_tooth.at(operation);
    proof::Beside beside(motions, cuts.at({operation, reference}), back_to_first(tooth, reference, teeth));
    for (const std::uint32_t k : cuts.at(others[n]))
      if (const auto like = beside.next(motions[k], k)) found[n].push_back(*like);
  });
  std::vector<proof::LikeMotion> likes;
  for (const auto& of_tooth : found) likes.insert(likes.end(), of_tooth.begin(), of_tooth.end());
  std::sort(likes.begin(), likes.end(),
            [](const proof::LikeMotion& a, const proof::LikeMotion& b) { return a.motion < b.motion; });
  return likes;
}

std::vector<path::ToolMotion> without_copies(std::vector<path::ToolMotion> motions, int teeth, double tolerance_mm) {
  const Blocks cuts = cutting_blocks(motions);
  const std::map<int, int> first_tooth = first_teeth(motions);
  std::map<ToothOfOperation, Shift> shifts;
  std::map<int, bool> copied;  // tooth -> in every operation
  for (const auto& [key, blocks] : cuts) {
    const auto& [operation, tooth] = key;
    const int reference = first_tooth.at(operation);
    const auto shift = tooth == reference ? std::nullopt
                                          : shift_of({motions, motions, back_to_first(tooth, reference, teeth)},
                                                     cuts.at({operation, reference}), blocks, tolerance_mm);
    const auto known = copied.emplace(tooth, true).first;
    known->second = known->second && shift.has_value();
    if (shift) shifts.emplace(key, *shift);
  }
  for (auto& [tooth, all] : copied)
    for (const auto& [operation, reference] : first_tooth) all = all && cuts.contains({operation, tooth});
  std::vector<bool> drop(motions.size(), false);
  for (const auto& [key, shift] : shifts) {
    if (!copied.at(key.second)) continue;
    const auto &originals = cuts.at({key.first, first_tooth.at(key.first)}), &copies = cuts.at(key);
    for (std::size_t k = 0; k < originals.size(); ++k) {
      stand_for(motions, originals[k], farther(most_of(motions, copies[k]), shift));
      std::fill(drop.begin() + static_cast<std::ptrdiff_t>(copies[k].first),
                drop.begin() + static_cast<std::ptrdiff_t>(copies[k].last), true);
    }
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < motions.size(); ++k)
    if (!drop[k]) motions[kept++] = motions[k];
  motions.resize(kept);
  return motions;
}

Stated stated_deviation(std::span<const path::ToolMotion> motions) {
  Stated out;
  for (const auto& m : motions)
    if (!m.rapid) out.add({m.deviation_mm, m.axis_deviation});
  return out;
}

/// The first tooth of an operation, by the numbers of its motions in the list of all first teeth.
struct ToothByTooth::First {
  int tooth = 0;
  std::size_t begin = 0, end = 0;
  std::vector<Block> blocks;
  std::vector<std::uint32_t> cuts;
  std::vector<Stated> copies;  ///< of every block: how far the teeth may be from it that are its copies
};

/// A later tooth, as it was seen.
struct ToothByTooth::Later {
  bool copy = false, like = false;
  Stated stated;
  proof::CutsAgain again;
};

ToothByTooth::ToothByTooth(int teeth, std::optional<double> copy_tolerance_mm, proof::FirstTooth::MayCut may_cut)
    : teeth_(teeth), tolerance_mm_(copy_tolerance_mm), may_cut_(std::move(may_cut)) {}
ToothByTooth::~ToothByTooth() = default;

void ToothByTooth::first(std::span<const path::ToolMotion> motions) {
  if (motions.empty() || operations_.contains(motions.front().operation)) return;
  First first;
  first.begin = firsts_.size();
  first.end = first.begin + motions.size();
  for (const path::ToolMotion& m : motions) {
    firsts_.push_back(m);
    if (m.rapid) continue;
    first.tooth = m.tooth;
    first.cuts.push_back(std::uint32_t(firsts_.size() - 1));
    add_cut(first.blocks, firsts_, firsts_.size() - 1);
  }
  first_teeth_.try_emplace(motions.front().operation, std::vector(motions.begin(), motions.end()), may_cut_);
  first.copies.resize(first.blocks.size());
  operations_.emplace(motions.front().operation, std::move(first));
}

ToothByTooth::Seen ToothByTooth::seen(std::span<const path::ToolMotion> motions) const {
  Seen out;
  std::vector<Block> blocks;
  for (std::size_t k = 0; k < motions.size(); ++k)
    if (!motions[k].rapid) add_cut(blocks, motions, k);
  if (blocks.empty()) return out;
  const path::ToolMotion& cut = *first_cut(motions);
  out.operation = cut.operation;
  out.tooth = cut.tooth;
  out.stated = stated_deviation(motions);
  const First& first = operations_.at(out.operation);
  const double turn = back_to_first(out.tooth, first.tooth, teeth_);
  proof::Beside beside(firsts_, first.cuts, turn);
  for (std::size_t k = 0; k < motions.size() && !out.like; ++k)
    out.like = !motions[k].rapid && beside.next(motions[k], std::uint32_t(k));
  if (tolerance_mm_)
    if (const auto shift = shift_of({firsts_, motions, turn}, first.blocks, blocks, *tolerance_mm_)) {
      for (const Block& block : blocks) out.blocks.push_back(farther(most_of(motions, block), *shift));
      return out;
    }
  out.again = proof::cuts_again(first_teeth_.at(out.operation), motions, -turn);
  return out;
}

void ToothByTooth::note(const Seen& seen) {
  if (seen.operation < 0) return;
  later_[{seen.operation, seen.tooth}] = {!seen.blocks.empty(), seen.like, seen.stated, seen.again};
  if (copies_ && !copies_->contains(seen.tooth)) return;
  std::vector<Stated>& copies = operations_.at(seen.operation).copies;
  for (std::size_t k = 0; k < seen.blocks.size(); ++k) copies[k].add(seen.blocks[k]);
}

bool ToothByTooth::settle() {
  std::map<int, std::size_t> times;  // that a tooth is a copy
  for (const auto& [key, later] : later_)
    if (later.copy) ++times[key.second];
  std::set<int> copies;
  for (const auto& [tooth, count] : times)
    if (count == operations_.size()) copies.insert(tooth);
  const bool settled = copies_ || copies.size() == times.size();
  copies_ = std::move(copies);
  for (auto& [operation, first] : operations_) {
    for (std::size_t k = 0; settled && k < first.blocks.size(); ++k)
      stand_for(firsts_, first.blocks[k], first.copies[k]);
    first.copies.assign(first.blocks.size(), {});
  }
  return settled;
}

std::vector<ToothCut> ToothByTooth::other_teeth() const {
  std::vector<ToothCut> out;
  for (const auto& [operation, first] : operations_)
    for (int tooth = 0; tooth < teeth_; ++tooth) {
      if (tooth == first.tooth) continue;
      const auto later = later_.find({operation, tooth});
      if (later == later_.end())
        out.push_back({operation, tooth, first.tooth, proof::cuts_again(first_teeth_.at(operation), {}, 0)});
      else if (!later->second.copy) out.push_back({operation, tooth, first.tooth, later->second.again});
    }
  return out;
}

Stated ToothByTooth::stated() const {
  Stated out = stated_deviation(firsts_);
  for (const auto& [key, later] : later_)
    if (!left_out(key.second)) out.add(later.stated);
  return out;
}

bool ToothByTooth::any_like() const {
  return std::any_of(later_.begin(), later_.end(),
                     [this](const auto& later) { return later.second.like && !left_out(later.first.second); });
}

std::span<const path::ToolMotion> ToothByTooth::first_of(int operation) const {
  const First& first = operations_.at(operation);
  return firsts().subspan(first.begin, first.end - first.begin);
}

bool ToothByTooth::left_out(int tooth) const { return copies_ && copies_->contains(tooth); }

std::vector<proof::LikeMotion> ToothByTooth::likes(std::span<const path::ToolMotion> motions) const {
  std::vector<proof::LikeMotion> found;
  const path::ToolMotion* cut = first_cut(motions);
  if (!cut) return found;
  const First& first = operations_.at(cut->operation);
  proof::Beside beside(firsts_, first.cuts, back_to_first(cut->tooth, first.tooth, teeth_));
  for (std::size_t k = 0; k < motions.size(); ++k)
    if (!motions[k].rapid)
      if (const auto like = beside.next(motions[k], std::uint32_t(k))) found.push_back(*like);
  return found;
}

}  // namespace toothpath::process
