#include "cam/finger/bodies.h"

#include <algorithm>
#include <cmath>

#include "cam/tool/body.h"
#include "geometry/base/angle.h"

namespace toothpath::finger {
namespace {

constexpr int kArcPieces = 16;
constexpr double kSag = 1e-3;  // mm

}  // namespace

double finger_flute_end(const bevel_gear::FingerProfile<double>& c, const tool::ToolAssembly& tool) {
  return tool.flute_length_mm > 0 ? tool.flute_length_mm : c.h_f + c.x_D;
}

std::vector<Vec2> finger_meridian(const bevel_gear::FingerProfile<double>& c, const tool::ToolAssembly& tool, double sag_mm) {
  std::vector<Vec2> line;
  // Corners of tangents around the arc, from the flat (psi = 90 deg) to the straight (phi).
  const double step = (kPi / 2 - c.phi) / kArcPieces, out = c.r_t / std::cos(0.5 * step);
  for (int k = 0; k < kArcPieces; ++k) {
    const double psi = kPi / 2 - (k + 0.5) * step;
    line.emplace_back(std::max(0.0, c.x_o - out * std::sin(psi) + c.h_f), c.rho_o + out * std::cos(psi));
  }
  // The flank is hollow: its chords enclose it. The sag of a chord over dp is its arc length times its turn, an eighth of dS dpsi.
  const auto end = c.involute(c.p_D);
  const double bend = end.dS * end.dpsi / 8;
  const int chords = std::max(1, int(std::ceil((c.p_D - c.p_C) * std::sqrt(bend / sag_mm))));
  for (int k = 0; k <= chords; ++k) {
    const auto q = c.involute(c.p_C + (c.p_D - c.p_C) * k / chords);
    line.emplace_back(q.x + c.h_f, q.rho);
  }
  const double top = finger_flute_end(c, tool);
  if (top > line.back().x()) line.emplace_back(top, c.rho_D);
  return line;
}

std::vector<clearance::MeshBody> finger_bodies(const bevel_gear::FingerProfile<double>& c, const tool::ToolAssembly& tool) {
  clearance::MeshBody cutter{tool::Body::cutter, {}, 0};
  const auto line = finger_meridian(c, tool, kSag);
  for (std::size_t k = 1; k < line.size(); ++k) cutter.pieces.push_back({line[k - 1].x(), line[k].x(), line[k - 1].y(), line[k].y(), tool::Body::cutter});
  std::vector<clearance::MeshBody> bodies{std::move(cutter)};
  tool::ToolAssembly whole = tool;
  whole.flute_length_mm = finger_flute_end(c, tool);
  for (const tool::Frustum& f : tool::shank_and_holder(whole)) bodies.push_back({f.body, {f}, 0});
  return bodies;
}

}  // namespace toothpath::finger
