#include "cam/proof/cuts_again.h"

#include <algorithm>
#include <cmath>

#include "cam/proof/beside.h"

namespace toothpath::proof {
namespace {

constexpr double kNear = 0.005;  // mm: what is farther is looked for elsewhere, too; passes are close to each other
// Places of the later tooth that are looked at for that. Ways that go alike need few of them.
constexpr std::size_t kMostLooks = 20'000'000;
constexpr std::uint32_t kInOrder = 64;  // motions; what is found farther ahead is another cut that goes the same way

/// From a place to the nearest of these motions, mm.
double off_nearest(const Vec3& tip, std::span<const path::ToolMotion> motions, const std::vector<std::uint32_t>& cuts) {
  double least = INFINITY;
  for (const std::uint32_t k : cuts)
    least = std::min(least, distance_to_segment(tip, motions[k].tip_from, motions[k].tip_to));
  return least;
}

}  // namespace

FirstTooth::FirstTooth(std::vector<path::ToolMotion> motions, MayCut may_cut)
    : motions_(std::move(motions)), may_cut_(std::move(may_cut)), known_(motions_.size()) {
  for (auto& known : known_) known = -1;
}

bool FirstTooth::may_cut(std::size_t k) const {
  if (motions_[k].rapid) return false;
  if (known_[k] < 0) known_[k] = static_cast<signed char>(may_cut_(motions_[k]));
  return known_[k] > 0;
}

CutsAgain cuts_again(const FirstTooth& first_tooth, std::span<const path::ToolMotion> later, double turn) {
  CutsAgain out;
  const auto first = first_tooth.motions();
  std::vector<std::uint32_t> cuts;
  for (std::size_t k = 0; k < later.size(); ++k)
    if (!later[k].rapid) cuts.push_back(std::uint32_t(k));
  if (cuts.empty()) {
    for (std::size_t k = 0; k < first.size() && !out.missing; ++k)
      if (first_tooth.may_cut(k)) out.missing = {first[k].line, 0, INFINITY};
    return out;
  }
  Beside beside(later, cuts, turn);
  const Turn to_later(turn);
  const auto off = [&](const Vec3& v) { return off_nearest(to_later(v), later, cuts); };
  std::uint32_t behind = cuts.front();  // where the last cut was made again in its order
  std::size_t looks = kMostLooks / cuts.size();
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (first[k].rapid) continue;
    bool made = beside.next(first[k], std::uint32_t(k)).has_value();
    if ((!made || beside.tip_mm() > kNear) && !first_tooth.may_cut(k)) continue;
    double tip = beside.tip_mm(), axis = beside.axis_rad();
    if (made && beside.stands_at() <= behind + kInOrder) behind = std::max(behind, beside.stands_at());
    if ((!made || tip > kNear) && beside.anywhere(first[k], looks) && (!made || beside.tip_mm() < tip)) {
      tip = beside.tip_mm();
      axis = beside.axis_rad();
      made = true;
    }
    if (made) {
      out.tip_mm = std::max(out.tip_mm, tip);
      out.axis_rad = std::max(out.axis_rad, axis);
      continue;
    }
    double most = 0;
    for (const double t : {0.0, 0.5, 1.0}) most = std::max(most, off(path::tip_at(first[k], t)));
    out.missing = {first[k].line, later[behind].line, most};
    return out;
  }
  return out;
}

}  // namespace toothpath::proof
