#include "cam/finger/teeth.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "cam/proof/gouge_merge.h"
#include "geometry/base/work_share.h"

namespace toothpath::finger {
namespace {

constexpr double kMostUnlike = 0.05;  // a like motion, of a tooth that goes as others do

/// The worse of two teeth, field by field.
void take_worse(FingerCheckResult& all, FingerCheckResult&& one) {
  add_result(all.gouge, one.gouge);
  all.root_gouge_mm = std::max(all.root_gouge_mm, one.root_gouge_mm);
  all.tilt_rad = std::max(all.tilt_rad, one.tilt_rad);
  all.wall_excess_bound_mm = std::max(all.wall_excess_bound_mm, one.wall_excess_bound_mm);
  if (one.ridge.reached_mm > all.ridge.reached_mm) all.ridge = one.ridge;
  if (one.finished.bound_mm > all.finished.bound_mm) {
    all.finished = one.finished;
    all.operations = std::move(one.operations);
    all.walls = std::move(one.walls);
  }
}

/// Slots of the least proven: the greatest bound, the least proven gap, the most that may be left; of equal ones the
/// first.
std::set<std::size_t> least_proven(const std::vector<FingerCheckResult>& results) {
  const auto first_most = [&](auto value) {
    std::size_t at = 0;
    for (std::size_t k = 1; k < results.size(); ++k)
      if (value(results[k]) > value(results[at])) at = k;
    return at;
  };
  return {first_most([](const FingerCheckResult& r) { return r.gouge.bound_mm; }),
          first_most([](const FingerCheckResult& r) { return -r.gouge.clearance_mm; }),
          first_most([](const FingerCheckResult& r) { return r.wall_excess_bound_mm; })};
}

}  // namespace

FingerCheckResult verify_teeth(const FingerGougeCheck& check, std::span<const path::ToolMotion> motions,
                               std::span<const proof::LikeMotion> likes, const std::map<int, double>& away) {
  std::map<int, std::size_t> place;  // tooth that is cut -> its slot, in the order of the teeth
  for (const path::ToolMotion& m : motions)
    if (!m.rapid) place.emplace(m.tooth, 0);
  if (place.size() <= 1) return check.verify(motions);
  std::size_t slots = 0;
  for (auto& [tooth, slot] : place) slot = slots++;
  struct Tooth {
    std::vector<path::ToolMotion> motions;
    std::vector<char> own;  // motions among the teeth that are like no other
    std::size_t likes = 0, unlike = 0;
    bool looked_at = false;
  };
  std::vector<Tooth> teeth(slots);
  auto like = likes.begin();
  for (std::size_t k = 0; k < motions.size(); ++k) {
    const bool is_like = like != likes.end() && like->motion == k;
    if (is_like) ++like;
    const auto found = place.find(motions[k].tooth);
    Tooth& tooth = teeth[found == place.end() ? 0 : found->second];
    const bool own = !is_like && check.among_teeth(motions[k]);
    tooth.motions.push_back(motions[k]);
    tooth.own.push_back(char(own));
    tooth.likes += is_like;
    tooth.unlike += own;
  }
  std::vector<FingerCheckResult> results(slots);
  WorkShare share{double(slots)};
  tbb::parallel_for(std::size_t{0}, slots, [&](std::size_t k) {
    const WorkShare piece(share);
    Tooth& tooth = teeth[k];
    tooth.looked_at = tooth.likes == 0 || double(tooth.unlike) > kMostUnlike * double(tooth.likes);
    results[k] = tooth.looked_at ? check.verify(tooth.motions) : check.bounds(tooth.motions, tooth.own);
  });
  std::set<std::size_t> look = least_proven(results);
  RidgeResult ridge;  // of the teeth that were looked at, the first one among them
  for (const FingerCheckResult& r : results)
    if (r.ridge.points > 0 && r.ridge.reached_mm >= ridge.reached_mm) ridge = r.ridge;
  for (const auto& [tooth, mm] : away) {
    const bool higher = ridge.requested_mm > 0 && ridge.reached_mm + mm > ridge.requested_mm;
    if (const auto found = place.find(tooth); found != place.end() && (higher || std::isinf(mm)))
      look.insert(found->second);
  }
  for (const std::size_t k : look)
    if (!teeth[k].looked_at) results[k] = check.verify(teeth[k].motions);
  FingerCheckResult all = std::move(results.front());
  for (std::size_t k = 1; k < slots; ++k) take_worse(all, std::move(results[k]));
  return all;
}

}  // namespace toothpath::finger
