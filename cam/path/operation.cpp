#include "cam/path/operation.h"

#include <cmath>

namespace toothpath::path {

const char* to_string(Region region) {
  switch (region) {
    case Region::flank: return "flank";
    case Region::fillet: return "fillet";
    case Region::root: return "root";
  }
  return "";
}

const char* to_string(OperationType type) {
  switch (type) {
    case OperationType::roughing: return "roughing";
    case OperationType::semi_finishing: return "semi_finishing";
    case OperationType::finishing: return "finishing";
    case OperationType::line_milling: return "line_milling";
    case OperationType::finger_roughing: return "finger_roughing";
    case OperationType::finger_finishing: return "finger_finishing";
  }
  return "";
}

double MillingOperation::feed_for(double steepest, int teeth) const {
  if (chip_load_mm == 0) return feed_mm_min;
  return std::min(chip_load_mm * speed_rpm * teeth / steepest, (finishes() ? 1 : kMostRaise) * feed_mm_min);
}

MillingOperation by_ball_end(const MillingOperation& line) {
  MillingOperation o = line;
  o.strips.reset();
  o.left_mm.reset();
  o.rotaries.reset();
  o.best_way = false;
  o.regions = {{true, false, false}};
  if (line.finishes()) {
    o.type = OperationType::finishing;
    o.scallop_mm = line.most_misfit_mm();
  } else {
    o.type = OperationType::semi_finishing;
    o.scallop_mm = std::max(kCuspPerAllowance * line.allowance_mm, kLeastCusp_mm);
  }
  return o;
}

std::optional<std::size_t> last_before(const std::vector<MillingOperation>& operations, std::size_t n, Region region) {
  while (n-- > 0)
    if (operations[n].regions[region]) return n;
  return {};
}

double left_by(const MillingOperation& o, double radius_mm) {
  if (o.type != OperationType::roughing) return o.allowance_mm + o.scallop_mm;
  const double half = std::min(std::max(o.step_down_mm, o.step_over_mm) / 2, radius_mm);
  return o.allowance_mm + radius_mm - std::sqrt(radius_mm * radius_mm - half * half);
}

}  // namespace toothpath::path
