#include "tests/controller/joint_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

namespace toothpath::test {
namespace {

constexpr std::size_t kAxes = 5;

double weight(std::size_t axis) { return axis < 3 ? 1.0 : kMmPerDegree; }

/// Distance of a point from a straight segment.
double distance_to_segment(const JointVector& p, const JointVector& a, const JointVector& b) {
  double along = 0, length = 0;
  for (std::size_t i = 0; i < kAxes; ++i) {
    const double w = weight(i) * weight(i), d = b[i] - a[i];
    along += w * d * (p[i] - a[i]);
    length += w * d * d;
  }
  const double t = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
  JointVector nearest{};
  for (std::size_t i = 0; i < kAxes; ++i) nearest[i] = a[i] + t * (b[i] - a[i]);
  return joint_distance(p, nearest);
}

struct Cost {
  double value = std::numeric_limits<double>::infinity();
  int line = 0;
};

Cost raised(const Cost& cost, double distance, int line) { return distance > cost.value ? Cost{distance, line} : cost; }

}  // namespace

double joint_distance(const JointVector& a, const JointVector& b) {
  double sum = 0;
  for (std::size_t i = 0; i < kAxes; ++i) sum += weight(i) * weight(i) * (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

// costs[j - first]: the least greatest distance over all walks that stand in segment j (corner j to j + 1) at this
// sample. Segments whose cost is beyond give_up are dropped at both ends, so the list stays short.
CurveComparison compare_curves(std::span<const PathCorner> path, std::span<const JointVector> record, double give_up,
                               Counted counted) {
  CurveComparison result;
  const auto sample = [&](double distance) {
    return counted == Counted::corners && distance <= give_up ? 0 : distance;
  };
  const auto corner = [&](double distance) {
    return counted == Counted::samples && distance <= give_up ? 0 : distance;
  };
  if (path.size() < 2) return result;
  const std::size_t last = path.size() - 2;
  const auto to_segment = [&](const JointVector& p, std::size_t j) {
    return distance_to_segment(p, path[j].joints, path[j + 1].joints);
  };

  std::size_t first = 0, best_j = 0;
  std::vector<Cost> costs, next;
  Cost arrived;
  std::size_t started_at = 0, arrived_at = 0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const JointVector& s = record[i];
    const JointVector& before = record[i ? i - 1 : 0];
    // As long as it has not left the first segment behind, the walk may begin at any sample that is at the first
    // corner.
    const double at_start = corner(joint_distance(s, path[0].joints));
    const bool may_start = first == 0 && at_start <= give_up;
    next.clear();
    if (may_start && costs.empty()) started_at = i;
    Cost carry;
    for (std::size_t j = first; j <= last; ++j) {
      // Over the corner j: it lies within the distance of the stretch from the sample before.
      if (j > first && std::isfinite(carry.value))
        carry = raised(carry, corner(distance_to_segment(path[j].joints, before, s)), path[j].line);
      if (carry.value > give_up) carry = Cost{};
      if (j < first + costs.size() && costs[j - first].value < carry.value) carry = costs[j - first];
      if (j == 0 && may_start && at_start < carry.value) carry = {at_start, path[0].line};
      Cost here = raised(carry, sample(to_segment(s, j)), path[j + 1].line);
      if (here.value > give_up) here = Cost{};
      next.push_back(here);
      if (j >= first + costs.size() && !std::isfinite(carry.value)) break;
    }
    std::size_t drop = 0;
    while (drop < next.size() && !std::isfinite(next[drop].value)) ++drop;
    next.erase(next.begin(), next.begin() + static_cast<std::ptrdiff_t>(drop));
    while (!next.empty() && !std::isfinite(next.back().value)) next.pop_back();
    first = next.empty() ? 0 : first + drop;
    costs.swap(next);
    if (!costs.empty()) best_j = std::max(best_j, first + costs.size() - 1);
    if (!costs.empty() && first + costs.size() - 1 == last) {
      const Cost end = raised(costs.back(), corner(joint_distance(s, path[last + 1].joints)), path[last + 1].line);
      if (end.value <= give_up && end.value < arrived.value) {
        arrived = end;
        arrived_at = i;
      }
    }
  }
  result.followed = std::isfinite(arrived.value);
  result.stuck_line = path[best_j].line;
  if (result.followed) {
    result.worst = arrived.value;
    result.line = arrived.line;
    result.samples = arrived_at - started_at + 1;
  }
  return result;
}

Result<std::vector<JointVector>> read_samples(std::istream& in) {
  std::vector<JointVector> samples;
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    if (text.find("overrun") != std::string::npos)
      return fail("samples were lost before line {}: the recorder was too slow", line);
    std::istringstream numbers(text);
    JointVector s{};
    for (double& v : s)
      if (!(numbers >> v) || !std::isfinite(v))
        return fail("line {} of the samples is not five numbers: \"{}\"", line, text.substr(0, 80));
    samples.push_back(s);
  }
  if (samples.empty()) return fail("no samples were recorded");
  return samples;
}

}  // namespace toothpath::test
