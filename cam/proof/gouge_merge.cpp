#include "cam/proof/gouge_merge.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace toothpath::proof {
namespace {

constexpr std::size_t kMostWorst = 20;  // places that are listed

/// The list is in order but for what was put behind its first `ordered` places.
void keep_worst(std::vector<WorstPlace>& places, std::size_t ordered) {
  const auto deeper = [](const WorstPlace& a, const WorstPlace& b) { return a.depth_mm > b.depth_mm; };
  std::inplace_merge(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(ordered), places.end(),
                     deeper);  // stable
  if (places.size() > kMostWorst) places.resize(kMostWorst);
}

}  // namespace

GougeResult no_motion_yet(double required_clearance_mm) {
  GougeResult r;
  r.measured_mm = r.bound_mm = -INFINITY;
  r.clearance_mm = r.clearance_measured_mm = r.clearance_followed_mm = INFINITY;
  r.required_clearance_mm = required_clearance_mm;
  return r;
}

void add_worst(GougeResult& result, WorstPlace place) {
  if (result.worst.size() >= kMostWorst && place.depth_mm <= result.worst.back().depth_mm) return;
  result.worst.push_back(std::move(place));
  keep_worst(result.worst, result.worst.size() - 1);
}

void note_deepest(GougeResult& result, const WorstPlace& place) {
  if (result.deepest.body == tool::Body::none || place.depth_mm > result.deepest.depth_mm) result.deepest = place;
}

void add_result(GougeResult& all, const GougeResult& later) {
  if (later.deepest.body != tool::Body::none) note_deepest(all, later.deepest);
  all.measured_mm = std::max(all.measured_mm, later.measured_mm);
  if (later.bound_mm > all.bound_mm) {
    all.bound_mm = later.bound_mm;
    all.bound_line = later.bound_line;
  }
  if (later.clearance_mm < all.clearance_mm) all.closest = later.closest;
  all.clearance_mm = std::min(all.clearance_mm, later.clearance_mm);
  all.clearance_measured_mm = std::min(all.clearance_measured_mm, later.clearance_measured_mm);
  all.clearance_followed_mm = std::min(all.clearance_followed_mm, later.clearance_followed_mm);
  all.rapids_clear = all.rapids_clear && later.rapids_clear;
  const std::size_t ordered = all.worst.size();
  all.worst.insert(all.worst.end(), later.worst.begin(), later.worst.end());
  keep_worst(all.worst, ordered);
  all.motions += later.motions;
  all.distance_queries += later.distance_queries;
  all.sampled_patches = std::max(all.sampled_patches, later.sampled_patches);
  all.patches = std::max(all.patches, later.patches);
}

}  // namespace toothpath::proof
