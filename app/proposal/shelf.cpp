#include "app/proposal/shelf.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::proposal {
namespace {

using tool::CutterType;

constexpr double kBalls[] = {0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.2,  1.5,
                             2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0};
constexpr double kShanks[] = {4, 6, 8, 10, 12, 16};  // h6, of carbide mills
constexpr double kTaper = 5;                         // deg, half angle
constexpr double kHelix = 30;                        // deg
constexpr double kSurfaceSpeed = 110;                // m/min
constexpr double kChip = 0.014;                      // of the diameter, a tooth

double rounded_up(double x, double step) { return std::ceil(x / step - 1e-9) * step; }

double shank_for(double diameter) {
  for (const double shank : kShanks)
    if (shank >= diameter) return shank;
  return diameter;
}

/// Collet chuck: nut and body.
void hold(tool::ToolAssembly& tool, double stick_out) {
  const double nut = tool.shank_diameter_mm + 6;
  tool.stick_out_mm = rounded_up(stick_out, 1);
  tool.holder = {{nut, nut, 30}, {32, 32, 30}};
  if (nut > 32) tool.holder = {{nut, nut, 60}};
  tool.length_mm = rounded_up(tool.stick_out_mm + 70, 5);
}

tool::ToolAssembly ball(double diameter, double depth) {
  tool::ToolAssembly tool;
  tool.type = CutterType::ball_end_mill;
  tool.diameter_mm = diameter;
  tool.shank_diameter_mm = shank_for(std::max(diameter, 4.0));
  tool.flute_length_mm = rounded_up(least_flute_mm(depth), 0.5);
  hold(tool, least_stick_out_mm(depth));
  return tool;
}

tool::ToolAssembly tapered(double diameter, double depth) {
  tool::ToolAssembly tool = ball(diameter, depth);
  tool.type = CutterType::tapered_ball_end_mill;
  tool.half_angle_rad = radians(kTaper);
  tool.helix_rad = radians(kHelix);
  tool.shank_diameter_mm = shank_for(std::max(6.0, diameter + 2 * tool.flute_length_mm * std::tan(radians(kTaper))));
  hold(tool, least_stick_out_mm(depth) + 6);
  return tool;
}

}  // namespace

double least_flute_mm(double depth_mm) { return 1.45 * depth_mm; }
double least_stick_out_mm(double depth_mm) { return 14 + 2.2 * depth_mm; }

tool::ToolAssembly completed(const tool::ToolAssembly& known, double depth_mm) {
  const bool side = known.type == CutterType::tapered_ball_end_mill;
  const tool::ToolAssembly standard = side ? tapered(known.diameter_mm, depth_mm) : ball(known.diameter_mm, depth_mm);
  tool::ToolAssembly tool = known;
  for (double tool::ToolAssembly::*length : {&tool::ToolAssembly::flute_length_mm,
                                             &tool::ToolAssembly::shank_diameter_mm, &tool::ToolAssembly::stick_out_mm})
    if (!(tool.*length > 0)) tool.*length = standard.*length;
  if (tool.holder.empty()) tool.holder = standard.holder;
  if (!(tool.length_mm > 0)) tool.length_mm = rounded_up(tool.stick_out_mm + 70, 5);
  if (side && !(tool.half_angle_rad > 0)) tool.half_angle_rad = standard.half_angle_rad;
  return tool;
}

Shelf standard_shelf(double depth_mm) {
  Shelf shelf;
  for (const double diameter : kBalls) {
    shelf.push_back(ball(diameter, depth_mm));
    shelf.push_back(tapered(diameter, depth_mm));
  }
  return shelf;
}

bool reaches_root(const tool::ToolAssembly& tool, double depth_mm) {
  if (tool.flute_length_mm >= depth_mm) return true;
  return tool.type == CutterType::ball_end_mill && tool.shank_diameter_mm > 0 &&
         tool.shank_diameter_mm <= tool.diameter_mm && tool.stick_out_mm > depth_mm;
}

const tool::ToolAssembly* largest(const Shelf& shelf, CutterType type, double most_mm, double depth_mm, int skip) {
  std::vector<const tool::ToolAssembly*> fitting;
  for (const tool::ToolAssembly& tool : shelf)
    if (tool.type == type && tool.diameter_mm <= most_mm && reaches_root(tool, depth_mm)) fitting.push_back(&tool);
  std::stable_sort(fitting.begin(), fitting.end(),
                   [](const auto* a, const auto* b) { return a->diameter_mm > b->diameter_mm; });
  return static_cast<std::size_t>(skip) < fitting.size() ? fitting[static_cast<std::size_t>(skip)] : nullptr;
}

Cutting cutting_of(double diameter_mm, int teeth, double spindle_rpm, double most_feed_mm_min) {
  const double speed = std::min({1000 * kSurfaceSpeed / (kPi * diameter_mm), spindle_rpm, 20000.0});
  Cutting cutting;
  cutting.speed_rpm = std::max(100.0, std::floor(speed / 100) * 100);
  cutting.feed_mm_min =
      std::min(most_feed_mm_min, std::max(50.0, std::round(cutting.speed_rpm * teeth * kChip * diameter_mm / 10) * 10));
  return cutting;
}

}  // namespace toothpath::proposal
