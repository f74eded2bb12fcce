#include "geometry/inspection/dmis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace toothpath::inspection {
namespace {

constexpr std::size_t kLongest = 78;

/// A statement of DMIS, cut after a comma where it is too long; the `$` continues it.
void statement(std::string& out, std::string text) {
  while (text.size() > kLongest) {
    const auto comma = text.rfind(',', kLongest - 2);
    if (comma == std::string::npos) break;
    out += text.substr(0, comma + 1) + "$\n";
    text.erase(0, comma + 1);
  }
  out += text + "\n";
}

std::string numbers(const Vec3& v, int decimals) {
  std::string out;
  for (int k = 0; k < 3; ++k) {
    std::string number = fmt::format("{:.{}f}", v[k], decimals);
    if (number.find_first_not_of("-0.") == std::string::npos && number.front() == '-') number.erase(0, 1);
    out += (k ? "," : "") + number;
  }
  return out;
}

std::string label(const InspectionPoint& p) {
  return fmt::format("Z{}{}_R{}C{}", p.zone, p.side > 0 ? 'P' : 'M', p.row, p.column);
}

std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text.substr(0, 60))
    out += c >= ' ' && c <= '~' && c != '\'' && c != '$' && c != '/' && c != ',' ? c : '_';
  return out;
}

}  // namespace

std::string inspection_dmis(const face_gear::FaceGear& gear, const std::vector<InspectionPoint>& points,
                            const std::string& job_name) {
  const double module = gear.parameters().module_mm, above = gear.blank_top() + 5;
  // A stylus that comes from half a module away and whose way back is as long stays on its own side of the space.
  const double approach = 0.25 * module;
  std::string out;
  statement(out, "DMISMN/'toothpath " + plain(job_name) + "',05.2");
  statement(out, "$$ Flanks of tooth 0, gear frame: z is the gear axis, teeth point to +z.");
  statement(out, "$$ Before this program: the part alignment is the gear frame, a ball stylus");
  statement(out, "$$ that fits the tooth space is calibrated and selected.");
  statement(out, "UNITS/MM,ANGDEC");
  statement(out, "MODE/PROG,MAN");
  statement(out, "WKPLAN/XYPLAN");
  statement(out, fmt::format("SNSET/APPRCH,{:.3f}", approach));
  statement(out, fmt::format("SNSET/RETRCT,{:.3f}", approach));
  statement(out, fmt::format("SNSET/SEARCH,{:.3f}", approach));
  for (const auto& p : points)
    statement(out, "F(" + label(p) + ")=FEAT/POINT,CART," + numbers(p.p, 6) + "," + numbers(p.n, 8));
  // A space beside every flank: from above its middle to the point and back.
  int zone = -1, side = 0, column = -1;
  Vec3 over = Vec3::Zero();
  std::vector<const InspectionPoint*> order;
  for (const auto& p : points) order.push_back(&p);
  std::stable_sort(order.begin(), order.end(), [](const InspectionPoint* a, const InspectionPoint* b) {
    return std::tuple(a->zone, -a->side, a->column, -a->row) < std::tuple(b->zone, -b->side, b->column, -b->row);
  });
  for (const InspectionPoint* q : order) {
    const auto& p = *q;
    if (p.zone != zone || p.side != side || p.column != column) {
      if (zone >= 0) statement(out, "GOTO/CART," + numbers(over, 4));
      zone = p.zone;
      side = p.side;
      column = p.column;
      // A quarter of a pitch beyond the flank at the tip is about the middle of the space.
      const double r = std::hypot(p.p.x(), p.p.y()),
                   azimuth = std::atan2(p.p.y(), p.p.x()) + p.side * 0.25 * gear.pitch();
      over = {r * std::cos(azimuth), r * std::sin(azimuth), above};
      statement(out, "GOTO/CART," + numbers(over, 4));
    }
    statement(out, "MEAS/POINT,F(" + label(p) + "),1");
    statement(out, "PTMEAS/CART," + numbers(p.p, 6) + "," + numbers(p.n, 8));
    statement(out, "ENDMES");
  }
  if (!points.empty()) statement(out, "GOTO/CART," + numbers(over, 4));
  statement(out, "ENDFIL");
  return out;
}

}  // namespace toothpath::inspection
