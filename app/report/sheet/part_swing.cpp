#include "app/report/sheet/part_swing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/angle.h"

namespace toothpath::sheet {
namespace {

constexpr int kRimPoints = 1440;
constexpr double kSwingStep = radians(0.5);

/// Points of both rims, table frame, on circles so much wider that the true rim lies inside their polygon.
std::vector<Vec3> rims(const BlankCylinder& blank, const joints::Setup& setup) {
  std::vector<Vec3> out;
  const double r = blank.radius_mm / std::cos(kPi / kRimPoints);
  for (int i = 0; i < kRimPoints; ++i) {
    const double a = 2 * kPi * i / kRimPoints;
    for (const double z : {blank.z_min_mm, blank.z_max_mm})
      out.push_back(setup.origin_mm + setup.rotation() * Vec3(r * std::cos(a), r * std::sin(a), z));
  }
  return out;
}

/// The circle on which an axis carries a point: centre and radius.
std::pair<Vec3, double> circle(const Vec3& p, const machines::RotaryAxis& axis) {
  const Vec3 d = axis.direction, from = p - axis.point_mm;
  const Vec3 along = d * d.dot(from);
  return {axis.point_mm + along, (from - along).norm()};
}

std::pair<double, double> range_of(const std::vector<joints::AxisRange>& axes, char letter) {
  for (const auto& a : axes)
    if (a.letter == letter) return {a.min, a.max};
  return {0, 0};
}

}  // namespace

PartSwing part_swing(const BlankCylinder& blank, const joints::Setup& setup, const machines::Machine& machine,
                     const std::vector<joints::AxisRange>& axes) {
  PartSwing out;
  const auto& table = machine.chain.table;
  std::vector<Vec3> points = rims(blank, setup);
  // The first axis may stand anywhere: what it carries is two or more circles about it.
  if (!table.empty()) {
    double reach = 0, low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& p : points) {
      const auto [centre, radius] = circle(p, table[0]);
      const double along = (centre - table[0].point_mm).dot(table[0].direction);
      reach = std::max(reach, radius);
      low = std::min(low, along);
      high = std::max(high, along);
    }
    out.axes.push_back({table[0].letter, reach,
                        machine.largest_part_mm() > 0 ? std::optional(machine.largest_part_mm() / 2) : std::nullopt});
    const Vec3 d = table[0].direction, side = d.unitOrthogonal(), other = d.cross(side);
    points.clear();
    const double r = reach / std::cos(kPi / kRimPoints);
    for (int i = 0; i < kRimPoints; ++i) {
      const double a = 2 * kPi * i / kRimPoints;
      for (const double z : {low, high})
        points.push_back(table[0].point_mm + d * z + r * (std::cos(a) * side + std::sin(a) * other));
    }
  }
  out.top_mm = -std::numeric_limits<double>::infinity();
  out.bottom_mm = std::numeric_limits<double>::infinity();
  const auto height = [&](double z, double slack) {
    out.top_mm = std::max(out.top_mm, z + slack);
    out.bottom_mm = std::min(out.bottom_mm, z - slack);
  };
  if (table.size() < 2) {
    for (const Vec3& p : points) height(p.z(), 0);
  } else {
    const machines::RotaryAxis& tilt = table[1];
    double reach = 0;
    for (const Vec3& p : points) reach = std::max(reach, circle(p, tilt).second);
    out.axes.push_back({tilt.letter, reach, std::nullopt});
    const auto [from, most] = range_of(axes, tilt.letter);
    const double to = std::min(most, from + 2 * kPi);  // a text that lost its point may turn for millions of degrees
    const int n = std::max(1, static_cast<int>(std::ceil((to - from) / kSwingStep)));
    const double slack = reach * (1 - std::cos((to - from) / n / 2));  // an arc between two samples rises by no more
    for (int i = 0; i <= n; ++i) {
      // The command turns the tool relative to the work: the table turns the other way.
      const Mat3 turn = tilt.rotation(from + (to - from) * i / n).transpose();
      for (const Vec3& p : points) height((tilt.point_mm + turn * (p - tilt.point_mm)).z(), slack);
    }
  }
  out.lowest_nose_mm = range_of(axes, 'Z').first;
  return out;
}

report::Section swing_section(const PartSwing& swing) {
  report::Section s;
  s.title = "Swing and height of the part";
  s.columns = {"what", "mm", "limit", "left"};
  const auto mm = [](double v) { return fmt::format("{:.1f}", v); };
  for (const auto& a : swing.axes)
    s.rows.push_back({fmt::format("largest radius about {}", a.letter), mm(a.radius_mm),
                      a.limit_mm ? mm(*a.limit_mm) : "not stated in the machine file",
                      a.limit_mm ? mm(*a.limit_mm - a.radius_mm) : ""});
  s.rows.push_back({"highest point of the blank over all turns, machine Z", mm(swing.top_mm), mm(swing.lowest_nose_mm),
                    mm(swing.lowest_nose_mm - swing.top_mm)});
  s.rows.push_back(
      {"lowest point of the blank over all turns, machine Z", mm(swing.bottom_mm), "table: not stated", ""});
  s.note =
      "Blank alone, as a cylinder, over the turns of this program; fixture and chuck are not in it. Limit of the "
      "highest point: the lowest height of the spindle nose. Below zero is left where the nose goes down beside the "
      "part; the holder is proven clear of the blank all the same.";
  return s;
}

}  // namespace toothpath::sheet
