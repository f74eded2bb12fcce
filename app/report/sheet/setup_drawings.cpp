#include "app/report/sheet/setup_drawings.h"

#include <algorithm>

#include "app/report/svg/html_text.h"
#include "cam/tool/cutters.h"
#include "geometry/base/result.h"

namespace toothpath::sheet {
namespace {

constexpr double kPageWidth = 182, kSketchHeight = 62;  // mm of paper

}  // namespace

std::string part_sketch(const joints::Setup& setup, const PartOutline& part, const machines::Machine& machine) {
  const double r_in = part.inner_radius, r_out = part.outer_radius;
  const double top = part.tooth_top, root = part.root, bottom = part.bottom;
  const double up = setup.axis_up ? 1.0 : -1.0;
  const Vec3 at = setup.origin_mm, offset = setup.work_offset_at_mm;
  const auto z_of = [&](double z) { return at.z() + up * z; };
  // View box in machine mm, Z upwards.
  std::vector<double> xs = {at.x() - r_out, at.x() + r_out, offset.x()};
  std::vector<double> zs = {z_of(top), z_of(bottom), at.z(), offset.z()};
  for (const auto& axis : machine.chain.table) {
    xs.push_back(axis.point_mm.x());
    zs.push_back(axis.point_mm.z());
  }
  const double x_min = *std::min_element(xs.begin(), xs.end()), x_max = *std::max_element(xs.begin(), xs.end());
  const double z_min = *std::min_element(zs.begin(), zs.end()), z_max = *std::max_element(zs.begin(), zs.end());
  const double margin = 0.12 * std::max(x_max - x_min, z_max - z_min) + 1;
  const double height = z_max - z_min + 2 * margin;
  // The view box is as wide as the page, so that lines and letters have the same size on every sheet.
  const double scale =
      std::max((x_max - x_min + 2 * margin) / kPageWidth, height / kSketchHeight);  // mm of the machine a mm of paper
  const double width = scale * kPageWidth, unit = 1.1 * scale, left = (width - (x_max - x_min)) / 2;
  const auto px = [&](double x) { return x - x_min + left; };
  const auto py = [&](double z) { return z_max - z + margin; };
  std::string svg = fmt::format(
      "<svg viewBox='0 0 {:.3f} {:.3f}' role=img aria-label='part in the machine, X to the right, Z up' "
      "style='width:100%;max-height:{:g}mm' font-size='{:.3f}' font-family='sans-serif'>",
      width, height, kSketchHeight, 2.4 * unit);
  const auto body = [&](double x1, double x2, double z1, double z2, const char* fill) {
    svg += fmt::format(
        "<rect x='{:.3f}' y='{:.3f}' width='{:.3f}' height='{:.3f}' fill='{}' stroke='#333' stroke-width='{:.3f}'/>",
        px(x1), py(std::max(z1, z2)), x2 - x1, std::abs(z2 - z1), fill, 0.2 * unit);
  };
  body(at.x() - r_out, at.x() + r_out, z_of(root), z_of(bottom), "#ddd");
  for (const double side : {-1.0, 1.0}) {
    const double a = at.x() + side * r_in, b = at.x() + side * r_out;
    body(std::min(a, b), std::max(a, b), z_of(top), z_of(root), "#9ab");
  }
  std::vector<std::pair<Vec3, std::string>> marks = {{at, "gear origin"}, {offset, setup.work_offset}};
  for (const auto& axis : machine.chain.table) marks.emplace_back(axis.point_mm, fmt::format("axis {}", axis.letter));
  std::stable_sort(marks.begin(), marks.end(), [](const auto& a, const auto& b) { return a.first.z() > b.first.z(); });
  double free = 0;  // names of places at nearly the same height stand below one another
  for (const auto& [p, name] : marks) {
    const double x = px(p.x()), y = py(p.z()), r = 1.4 * unit;
    svg +=
        fmt::format("<path d='M{0:.3f} {1:.3f}h{2:.3f}M{3:.3f} {4:.3f}v{2:.3f}' stroke='#b00' stroke-width='{5:.3f}'/>",
                    x - r, y, 2 * r, x, y - r, 0.3 * unit);
    const double line = std::max(y + 0.8 * unit, free);
    svg +=
        fmt::format("<text x='{:.3f}' y='{:.3f}' fill='#b00'>{}</text>", x + 1.9 * unit, line, svg::html_escape(name));
    free = line + 2.7 * unit;
  }
  svg += fmt::format("<text x='{:.3f}' y='{:.3f}'>X right, Z up, outer diameter {:.3f} mm</text></svg>\n", unit,
                     3 * unit, 2 * r_out);
  return svg;
}

std::string tool_sketch(const tool::ToolAssembly& tool) {
  double holder_height = 0, widest = std::max(tool.diameter_mm, tool.shank_diameter_mm);
  for (const auto& segment : tool.holder) {
    holder_height += segment.height_mm;
    widest = std::max({widest, segment.lower_diameter_mm, segment.upper_diameter_mm});
  }
  const double height = std::max(tool.length_mm, tool.stick_out_mm + holder_height);
  std::string svg =
      fmt::format("<svg viewBox='{:.3f} {:.3f} {:.3f} {:.3f}' style='height:34mm' role=img aria-label='tool {}'>",
                  -widest / 2 - 1, -height - 1, widest + 2, height + 2, tool.number);
  for (const auto& body : tool::outline_of(tool)) {
    const char* fill = tool::cuts(body.body) ? "#e8c66a" : body.body == tool::Body::shank ? "#bbb" : "#888";
    std::string right, left;
    for (const Vec2& p : body.line) {
      right += fmt::format("{}{:.3f} {:.3f}", right.empty() ? "M" : "L", p[1], -p[0]);
      left = fmt::format("L{:.3f} {:.3f}", -p[1], -p[0]) + left;
    }
    svg += fmt::format("<path d='{}{}Z' fill='{}' stroke='#333' stroke-width='.3'/>", right, left, fill);
  }
  return svg + "</svg>\n";
}

}  // namespace toothpath::sheet
