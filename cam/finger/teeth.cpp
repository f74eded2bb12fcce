#include "cam/finger/teeth.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <utility>

#include "cam/proof/gouge_merge.h"
#include "geometry/base/work_share.h"

namespace toothpath::finger {
namespace {

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

}  // namespace

FingerCheckResult verify_teeth(const FingerGougeCheck& check, std::span<const path::ToolMotion> motions) {
  std::map<int, std::size_t> place;  // tooth that is cut -> its slot, in the order of the teeth
  for (const path::ToolMotion& m : motions)
    if (!m.rapid) place.emplace(m.tooth, 0);
  if (place.size() <= 1) return check.verify(motions);
  std::size_t slots = 0;
  for (auto& [tooth, slot] : place) slot = slots++;
  std::vector<std::vector<path::ToolMotion>> teeth(slots);
  for (const path::ToolMotion& m : motions) {
    const auto found = place.find(m.tooth);
    teeth[found == place.end() ? 0 : found->second].push_back(m);
  }
  std::vector<FingerCheckResult> results(slots);
  WorkShare share{double(slots)};
  tbb::parallel_for(std::size_t{0}, slots, [&](std::size_t k) {
    const WorkShare piece(share);
    results[k] = check.verify(teeth[k]);
  });
  FingerCheckResult all = std::move(results.front());
  for (std::size_t k = 1; k < slots; ++k) take_worse(all, std::move(results[k]));
  return all;
}

}  // namespace toothpath::finger
