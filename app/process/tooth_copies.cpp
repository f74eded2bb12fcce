#include "app/process/tooth_copies.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "geometry/base/angle.h"

namespace toothpath::process {
namespace {

constexpr double kReach = 1000;  // mm: the axis also moves shank and holder, less than a metre away

/// Motions that one block of the text was cut into: pieces of equal time, indices [first, last).
struct Block {
  std::size_t first = 0, last = 0;
  [[nodiscard]] std::size_t pieces() const { return last - first; }
};
using ToothOfOperation = std::pair<int, int>;  // operation, tooth
using Blocks = std::map<ToothOfOperation, std::vector<Block>>;

/// Cutting blocks of every tooth of every operation, in program order.
Blocks cutting_blocks(const std::vector<path::ToolMotion>& motions) {
  Blocks cuts;
  for (std::size_t k = 0; k < motions.size(); ++k) {
    const path::ToolMotion& m = motions[k];
    if (m.rapid) continue;
    std::vector<Block>& blocks = cuts[{m.operation, m.tooth}];
    if (!blocks.empty() && blocks.back().last == k && motions[k - 1].line == m.line &&
        motions[k - 1].minutes == m.minutes)
      ++blocks.back().last;
    else blocks.push_back({k, k + 1});
  }
  return cuts;
}

struct Pose {
  Vec3 tip, axis;
};

/// The first tooth and one that may be its copy.
class Turned {
 public:
  Turned(const std::vector<path::ToolMotion>& motions, double turn)
      : motions_(motions), c_(std::cos(turn)), s_(std::sin(turn)) {}

  /// Greatest distance of two blocks, the second one turned back, at the same share of their time. Between two ends of
  /// pieces of either both are straight, so that it is met at such an end. mm, with what the axes do at the far end of
  /// the tool.
  [[nodiscard]] double distance(const Block& original, const Block& copy) const {
    const std::size_t n = original.pieces(), m = copy.pieces();
    double most = 0;
    for (std::size_t k = 0; k <= n; ++k) most = std::max(most, apart(original, copy, k, n));
    if (m != n)
      for (std::size_t k = 0; k <= m; ++k) most = std::max(most, apart(original, copy, k, m));
    return most;
  }

 private:
  [[nodiscard]] double apart(const Block& original, const Block& copy, std::size_t k, std::size_t of) const {
    const Pose a = at(original, k, of), b = at(copy, k, of);
    return (back(b.tip) - a.tip).norm() + kReach * (back(b.axis) - a.axis).norm();
  }
  /// Where the block is at the share k / of of its time; exact at the ends of its own pieces.
  [[nodiscard]] Pose at(const Block& block, std::size_t k, std::size_t of) const {
    const std::size_t whole = k * block.pieces(), piece = std::min(whole / of, block.pieces() - 1);
    const path::ToolMotion& m = motions_[block.first + piece];
    const double t = static_cast<double>(whole - piece * of) / static_cast<double>(of);
    return {(1 - t) * m.tip_from + t * m.tip_to, (1 - t) * m.axis_from + t * m.axis_to};
  }
  [[nodiscard]] Vec3 back(const Vec3& v) const { return {c_ * v.x() - s_ * v.y(), s_ * v.x() + c_ * v.y(), v.z()}; }

  const std::vector<path::ToolMotion>& motions_;
  double c_, s_;
};

/// Greatest distance of any block of a tooth from that of the first one; nothing where it is no copy.
std::optional<double> shift_of(const Turned& turned, const std::vector<Block>& originals,
                               const std::vector<Block>& copies, double tolerance_mm) {
  if (originals.size() != copies.size()) return std::nullopt;
  double shift = 0;
  for (std::size_t k = 0; k < originals.size(); ++k) {
    shift = std::max(shift, turned.distance(originals[k], copies[k]));
    if (!(shift <= tolerance_mm)) return std::nullopt;
  }
  return shift;
}

/// The first tooth's block stands for the copy as well: it may stray as far as that does, and by their distance.
void stand_for(std::vector<path::ToolMotion>& motions, const Block& original, const Block& copy, double shift) {
  double tip = 0, axis = 0;
  for (std::size_t k = copy.first; k < copy.last; ++k) {
    tip = std::max(tip, motions[k].deviation_mm);
    axis = std::max(axis, motions[k].axis_deviation);
  }
  for (std::size_t k = original.first; k < original.last; ++k) {
    motions[k].deviation_mm = std::max(motions[k].deviation_mm, tip + shift);
    motions[k].axis_deviation = std::max(motions[k].axis_deviation, axis);
  }
}

}  // namespace

std::vector<path::ToolMotion> without_copies(std::vector<path::ToolMotion> motions, int teeth, double tolerance_mm) {
  const Blocks cuts = cutting_blocks(motions);
  std::map<int, int> first_tooth;  // of an operation
  for (const path::ToolMotion& m : motions)
    if (!m.rapid) first_tooth.emplace(m.operation, m.tooth);
  std::map<ToothOfOperation, double> shifts;
  std::map<int, bool> copied;  // tooth -> in every operation
  for (const auto& [key, blocks] : cuts) {
    const auto& [operation, tooth] = key;
    const int reference = first_tooth.at(operation);
    const auto shift = tooth == reference ? std::nullopt
                                          : shift_of({motions, -2 * kPi * (tooth - reference) / teeth},
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
      stand_for(motions, originals[k], copies[k], shift);
      std::fill(drop.begin() + static_cast<std::ptrdiff_t>(copies[k].first),
                drop.begin() + static_cast<std::ptrdiff_t>(copies[k].last), true);
    }
  }
  std::vector<path::ToolMotion> kept;
  for (std::size_t k = 0; k < motions.size(); ++k)
    if (!drop[k]) kept.push_back(motions[k]);
  return kept;
}

}  // namespace toothpath::process
