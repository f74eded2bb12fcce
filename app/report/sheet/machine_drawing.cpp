#include <algorithm>
#include <cmath>
#include <limits>

#include "app/report/sheet/machine_sheet.h"
#include "app/report/svg/html_text.h"

namespace toothpath::sheet {
namespace {

constexpr double kWidth = 720, kHeight = 540, kMargin = 46;

/// Seen from the front, right and above: X to the right, Y away, Z up.
Vec3 seen(const Vec3& p) {
  const double turn = radians(-28), down = radians(24);
  const double x = std::cos(turn) * p.x() - std::sin(turn) * p.y();
  const double away = std::sin(turn) * p.x() + std::cos(turn) * p.y();
  return {x, std::cos(down) * p.z() + std::sin(down) * away, 0};
}

class Drawing {
 public:
  /// A polyline in machine coordinates.
  void line(std::vector<Vec3> points, std::string style, bool arrow = false) {
    lines_.push_back({std::move(points), std::move(style), arrow});
  }
  void label(const Vec3& at, std::string text, std::string color) {
    labels_.push_back({at, std::move(text), std::move(color)});
  }

  [[nodiscard]] std::string svg(const std::string& name) const {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const auto& l : lines_)
      for (const auto& p : l.points) {
        low = low.cwiseMin(seen(p));
        high = high.cwiseMax(seen(p));
      }
    const double scale = std::min((kWidth - 2 * kMargin) / std::max(high.x() - low.x(), 1e-9),
                                  (kHeight - 2 * kMargin) / std::max(high.y() - low.y(), 1e-9));
    const auto place = [&](const Vec3& p) {
      const Vec3 q = seen(p);
      return Vec3(kWidth / 2 + scale * (q.x() - (low.x() + high.x()) / 2),
                  kHeight / 2 - scale * (q.y() - (low.y() + high.y()) / 2), 0);
    };
    std::string out = fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {:.0f} {:.0f}' style='width:{:.0f}px;max-width:100%' "
        "role='img' "
        "aria-label='chain of {}' font-family='sans-serif' font-size='13'>\n"
        "<rect width='100%' height='100%' fill='#fff'/>\n"
        "<defs><marker id='tip' viewBox='0 0 10 10' refX='8' refY='5' markerWidth='7' markerHeight='7' "
        "orient='auto-start-reverse'><path d='M0 0L10 5L0 10z' fill='context-stroke'/></marker></defs>\n",
        kWidth, kHeight, kWidth, svg::html_escape(name));
    for (const auto& l : lines_) {
      std::string points;
      for (const auto& p : l.points) points += fmt::format("{:.1f},{:.1f} ", place(p).x(), place(p).y());
      out += fmt::format("<polyline points='{}' fill='none' {}{}/>\n", points, l.style,
                         l.arrow ? " marker-end='url(#tip)'" : "");
    }
    for (const auto& l : labels_)
      out += fmt::format(
          "<text x='{:.1f}' y='{:.1f}' fill='{}' stroke='#fff' stroke-width='3' paint-order='stroke'>{}</text>\n",
          place(l.at).x() + 5, place(l.at).y() - 5, l.color, svg::html_escape(l.text));
    return out + "</svg>\n";
  }

 private:
  struct Line {
    std::vector<Vec3> points;
    std::string style;
    bool arrow;
  };
  struct Label {
    Vec3 at;
    std::string text, color;
  };
  std::vector<Line> lines_;
  std::vector<Label> labels_;
};

std::vector<Vec3> arc(const Vec3& centre, const Vec3& axis, double radius, double from, double to) {
  const Vec3 u = (std::abs(axis.z()) < 0.9 ? Vec3::UnitZ().cross(axis) : Vec3::UnitY().cross(axis)).normalized(),
             v = axis.cross(u);
  std::vector<Vec3> points;
  for (int i = 0; i <= 48; ++i) {
    const double t = from + (to - from) * i / 48;
    points.push_back(centre + radius * (std::cos(t) * u + std::sin(t) * v));
  }
  return points;
}

void draw_travel(Drawing& drawing, const machines::KinematicChain& chain, Vec3& low, Vec3& high) {
  for (int i = 0; i < 3; ++i) {
    low[i] = chain.linear[static_cast<std::size_t>(i)].min_mm;
    high[i] = chain.linear[static_cast<std::size_t>(i)].max_mm;
  }
  const char* thin = "stroke='#8a8f98' stroke-width='1' stroke-dasharray='5 4'";
  for (int axis = 0; axis < 3; ++axis)
    for (int corner = 0; corner < 4; ++corner) {
      Vec3 a, b;
      const int j = (axis + 1) % 3, k = (axis + 2) % 3;
      a[axis] = low[axis];
      b[axis] = high[axis];
      a[j] = b[j] = corner & 1 ? high[j] : low[j];
      a[k] = b[k] = corner & 2 ? high[k] : low[k];
      drawing.line({a, b}, thin);
    }
  const double reach = 0.18 * (high - low).maxCoeff();
  constexpr std::array<const char*, 3> color = {"#c0392b", "#1e8449", "#1f5fa8"};
  for (int i = 0; i < 3; ++i) {
    Vec3 end = low;
    end[i] += reach;
    drawing.line({low, end}, fmt::format("stroke='{}' stroke-width='2.5'", color[static_cast<std::size_t>(i)]), true);
    drawing.label(end, fmt::format("+{} tool", "XYZ"[i]), color[static_cast<std::size_t>(i)]);
  }
  drawing.label({low.x(), high.y(), high.z()}, "travel of the gauge point", "#666");
}

}  // namespace

std::string machine_drawing_svg(const machines::Machine& machine) {
  const machines::KinematicChain& chain = machine.chain;
  Drawing drawing;
  Vec3 low, high;
  draw_travel(drawing, chain, low, high);
  const double size = 0.16 * (high - low).maxCoeff();
  // Spindle: its nose in the middle of the travel, at the top.
  const Vec3 nose((low.x() + high.x()) / 2, (low.y() + high.y()) / 2, high.z());
  drawing.line({nose + Vec3(0, 0, 1.2 * size), nose}, "stroke='#333' stroke-width='7'");
  drawing.line({nose, nose - Vec3(0, 0, 0.5 * size)}, "stroke='#333' stroke-width='2'", true);
  drawing.label(nose, "G, gauge point", "#333");
  if (!chain.table.empty()) {
    const Vec3 middle = machine.table_middle_mm();
    drawing.line(arc(middle, Vec3::UnitZ(), 0.5 * machine.table_diameter_mm, 0, 2 * kPi),
                 "stroke='#555' stroke-width='1.5'");
    drawing.label(middle + Vec3(0.5 * machine.table_diameter_mm, 0, 0),
                  fmt::format("table, diameter {:g}", machine.table_diameter_mm), "#555");
  }
  for (std::size_t k = 0; k < chain.rotary_count(); ++k) {
    const machines::RotaryAxis& axis = chain.rotary(k);
    const bool table = chain.in_table(k);
    const Vec3 at = table ? axis.point_mm : Vec3(nose + axis.point_mm);
    const std::string color = k == 0 ? "#8e44ad" : "#b9770e";
    drawing.line({at - 1.3 * size * axis.direction, at + 1.5 * size * axis.direction},
                 fmt::format("stroke='{}' stroke-width='2' stroke-dasharray='12 3 3 3'", color), true);
    const double sense = table ? -axis.sign : axis.sign;
    drawing.line(arc(at + 1.1 * size * axis.direction, axis.direction, 0.38 * size, 0, sense * radians(280)),
                 fmt::format("stroke='{}' stroke-width='2.5'", color), true);
    drawing.label(at + 1.5 * size * axis.direction,
                  fmt::format("+{} turns the {}", axis.letter, table ? "table" : "head"), color);
  }
  return drawing.svg(machine.name);
}

}  // namespace toothpath::sheet
