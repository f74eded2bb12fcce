#include "app/report/sheet/cutter_drawing.h"

#include <fmt/format.h>

#include <cmath>

#include "app/report/svg/html_text.h"
#include "geometry/base/angle.h"

namespace toothpath::sheet {
namespace {

using Point = std::pair<double, double>;

/// Text that any DXF reader takes: printable ASCII, at most 200 characters.
std::string plain(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 200)) out += c >= ' ' && c <= '~' ? c : '?';
  return out;
}

/// DXF group writer: code line, value line.
struct Dxf {
  std::string text;
  void group(int code, std::string_view value) { text += fmt::format("{:3d}\n{}\n", code, value); }
  void number(int code, double value) { group(code, fmt::format("{:.9f}", value == 0 ? 0.0 : value)); }
  void entity(std::string_view type, std::string_view layer) { group(0, type), group(8, layer); }
  void line(std::string_view layer, Point a, Point b) {
    entity("LINE", layer);
    number(10, a.first), number(20, a.second), number(30, 0);
    number(11, b.first), number(21, b.second), number(31, 0);
  }
  /// Counter-clockwise from one angle to the other, degrees.
  void arc(std::string_view layer, Point centre, double radius, double from, double to) {
    entity("ARC", layer);
    number(10, centre.first), number(20, centre.second), number(30, 0);
    number(40, radius), number(50, from), number(51, to);
  }
  void polyline(std::string_view layer, const std::vector<Point>& points) {
    entity("POLYLINE", layer);
    group(66, "1");
    number(10, 0), number(20, 0), number(30, 0);
    group(70, "0");
    for (const auto& [x, y] : points) {
      entity("VERTEX", layer);
      number(10, x), number(20, y), number(30, 0);
    }
    group(0, "SEQEND");
    group(8, layer);
  }
  void note(Point at, double height, std::string_view value) {
    entity("TEXT", "NOTES");
    number(10, at.first), number(20, at.second), number(30, 0);
    number(40, height);
    group(1, plain(value));
  }
  void layer(std::string_view name, int color, std::string_view line_type) {
    group(0, "LAYER"), group(2, name), group(70, "0"), group(62, std::to_string(color)), group(6, line_type);
  }
};

void dxf_tables(Dxf& d) {
  d.group(0, "SECTION"), d.group(2, "TABLES");
  d.group(0, "TABLE"), d.group(2, "LTYPE"), d.group(70, "2");
  d.group(0, "LTYPE"), d.group(2, "CONTINUOUS"), d.group(70, "0"), d.group(3, "Solid line"), d.group(72, "65"),
      d.group(73, "0"), d.number(40, 0);
  d.group(0, "LTYPE"), d.group(2, "CENTER"), d.group(70, "0"), d.group(3, "Center ____ _ ____"), d.group(72, "65"),
      d.group(73, "4"), d.number(40, 5);
  d.number(49, 3), d.number(49, -0.75), d.number(49, 0.5), d.number(49, -0.75);
  d.group(0, "ENDTAB");
  d.group(0, "TABLE"), d.group(2, "LAYER"), d.group(70, "4");
  d.layer("0", 7, "CONTINUOUS"), d.layer("CONTOUR", 7, "CONTINUOUS"), d.layer("AXIS", 1, "CENTER"),
      d.layer("NOTES", 3, "CONTINUOUS");
  d.group(0, "ENDTAB");
  d.group(0, "ENDSEC");
}

/// Largest distance of the curve from the chords, seven places inside each.
double chord_error(const bevel_gear::FingerProfile<double>& c, const std::vector<double>& parameters) {
  double worst = 0;
  for (std::size_t i = 0; i + 1 < parameters.size(); ++i) {
    const auto a = c.flank(parameters[i]), b = c.flank(parameters[i + 1]);
    const double dx = b.x - a.x, dr = b.rho - a.rho, length = std::hypot(dx, dr);
    for (int k = 1; k < 8; ++k) {
      const auto q = c.flank(parameters[i] + (parameters[i + 1] - parameters[i]) * k / 8);
      worst = std::max(worst, std::abs((q.x - a.x) * dr - (q.rho - a.rho) * dx) / length);
    }
  }
  return worst;
}

std::string svg_path(const bevel_gear::FingerProfile<double>& c, double length, double scale, double x_0, double y_0,
                     double shift) {
  const auto samples = bevel_gear::sample_profile(c, 1e-3 * c.r_0);
  std::string upper, lower;
  const auto put = [&](std::string& d, double x, double y) {
    d += fmt::format("{}{:.3f} {:.3f}", d.empty() ? "M" : "L", x_0 + scale * (x + shift), y_0 - scale * y);
  };
  for (const auto& s : samples) put(upper, s.from_tip, s.rho), put(lower, s.from_tip, -s.rho);
  put(upper, length - shift, c.rho_D), put(lower, length - shift, -c.rho_D);
  return upper + lower;
}

constexpr const char* kDrawingStyle =
    "<style>.k{fill:none;stroke:#111;stroke-width:.45;stroke-linejoin:round}.o{fill:none;stroke:#c25a12;stroke-width:."
    "35;stroke-dasharray:2 1.2}.a{stroke:#1f6fb2;stroke-width:.22;stroke-dasharray:5 1 1 "
    "1;fill:none}.d{stroke:#555;stroke-width:.2;fill:none}.p{fill:#111}.t{font:3.1px "
    "sans-serif;fill:#222}.u{font:2.7px sans-serif;fill:#555}</style>";

}  // namespace

CutterDxf cutter_dxf(const bevel_gear::FingerProfile<double>& c, double length, const std::vector<std::string>& notes,
                     double chord_mm) {
  std::vector<double> parameters;
  for (const auto& s : bevel_gear::sample_profile(c, chord_mm))
    if (s.part == 'I') parameters.push_back(s.p);
  CutterDxf out;
  out.chord_error_mm = chord_error(c, parameters);
  out.vertices = static_cast<int>(parameters.size());
  Dxf d;
  for (const auto& note : notes) d.group(999, plain(note));
  d.group(999, fmt::format("mm, 1:1; X from the tip along the axis, Y radius; {} as polyline, chord error {:.6f} mm",
                           c.law ? "modified flank" : "involute", out.chord_error_mm));
  d.group(0, "SECTION"), d.group(2, "HEADER");
  d.group(9, "$ACADVER"), d.group(1, "AC1009");
  d.group(9, "$EXTMIN"), d.number(10, 0), d.number(20, -c.rho_D), d.number(30, 0);
  d.group(9, "$EXTMAX"), d.number(10, length), d.number(20, c.rho_D), d.number(30, 0);
  d.group(0, "ENDSEC");
  dxf_tables(d);
  d.group(0, "SECTION"), d.group(2, "ENTITIES");
  const auto at = [&](double x, double rho) { return Point{x + c.h_f, rho}; };
  const double phi = degrees(c.phi);
  d.line("CONTOUR", {0, -c.rho_o}, {0, c.rho_o});
  for (const int side : {1, -1}) {
    const double s = side;
    if (side > 0) d.arc("CONTOUR", at(c.x_o, c.rho_o), c.r_t, 90 + phi, 180);
    else d.arc("CONTOUR", at(c.x_o, -c.rho_o), c.r_t, 180, 270 - phi);
    d.line("CONTOUR", at(c.x_B, s * c.rho_B), at(c.x_C, s * c.rho_C));
    std::vector<Point> points;
    for (const double p : parameters) {
      const auto q = c.flank(p);
      points.push_back(at(q.x, s * q.rho));
    }
    d.polyline("CONTOUR", points);
    d.line("CONTOUR", points.back(), {length, points.back().second});
  }
  d.line("CONTOUR", {length, -c.rho_D}, {length, c.rho_D});
  d.line("AXIS", {-0.1 * length, 0}, {1.1 * length, 0});
  d.line("AXIS", {c.h_f, -1.15 * c.rho_D}, {c.h_f, 1.15 * c.rho_D});
  const double height = 0.06 * c.rho_D;
  double y = -1.3 * c.rho_D;
  for (const auto& note : notes) d.note({0, y}, height, note), y -= 1.8 * height;
  d.group(0, "ENDSEC");
  d.group(0, "EOF");
  out.text = std::move(d.text);
  return out;
}

double cutter_drawing_scale(const bevel_gear::FingerProfile<double>& c, double length, double width, double height) {
  double scale = 200;
  for (int k = 0; k < 40; ++k) {
    if (scale * length <= width && scale * 2 * c.rho_D <= height) return scale;
    const double lead = scale / std::pow(10.0, std::floor(std::log10(scale) + 1e-9));
    scale /= lead > 4 ? 2.5 : 2;  // 5 -> 2, 2 -> 1, 1 -> 0.5
  }
  return scale;
}

std::string cutter_svg(const bevel_gear::FingerProfile<double>& c, double length, double scale,
                       const std::optional<bevel_gear::FingerProfile<double>>& other, bool standalone) {
  const double widest = std::max(c.rho_D, other ? other->rho_D : 0.0), left = 8, right = 24, top = 9, bottom = 14;
  const double width = left + scale * length + right, height = top + 2 * scale * widest + bottom;
  const double x_0 = left, y_0 = top + scale * widest;
  std::string s = fmt::format(
      "<svg{} width=\"{:.2f}mm\" height=\"{:.2f}mm\" viewBox=\"0 0 {:.2f} {:.2f}\" role=\"img\" aria-label=\"Section "
      "of the finger mill\">",
      standalone ? " xmlns=\"http://www.w3.org/2000/svg\"" : "", width, height, width, height);
  s += kDrawingStyle;
  if (standalone) s += "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>";
  const auto X = [&](double from_tip) { return x_0 + scale * from_tip; };
  const auto Y = [&](double rho) { return y_0 - scale * rho; };
  const auto line = [&](double x1, double y1, double x2, double y2, const char* css) {
    s += fmt::format("<path class=\"{}\" d=\"M{:.3f} {:.3f}L{:.3f} {:.3f}\"/>", css, x1, y1, x2, y2);
  };
  const auto text = [&](double x, double y, const std::string& value, const char* anchor, const char* css) {
    s += fmt::format("<text class=\"{}\" x=\"{:.2f}\" y=\"{:.2f}\" text-anchor=\"{}\">{}</text>", css, x, y, anchor,
                     svg::html_escape(value));
  };
  line(x_0 - 5, y_0, X(length) + 4, y_0, "a");
  line(X(c.h_f), top - 3, X(c.h_f), y_0 + scale * widest + 3, "a");
  text(X(c.h_f) + 1, top - 3, "pitch cone", "start", "u");
  if (other)
    s += fmt::format("<path class=\"o\" d=\"{}\"/>", svg_path(*other, length, scale, x_0, y_0, c.h_f - other->h_f));
  s += fmt::format("<path class=\"k\" d=\"{}\"/>", svg_path(c, length, scale, x_0, y_0, 0));
  // The closing line of the cylinder is a break, not an edge.
  line(X(length), Y(c.rho_D) - 2, X(length), Y(-c.rho_D) + 2, "d");
  struct Mark {
    char name;
    double x, rho, dx, dy;
    const char* anchor;
  };
  for (const Mark& m : {Mark{'A', -c.h_f, c.rho_o, -1.2, 1.0, "end"}, Mark{'B', c.x_B, c.rho_B, -0.4, -1.4, "end"},
                        Mark{'C', c.x_C, c.rho_C, -0.2, -1.6, "end"}, Mark{'D', c.x_D, c.rho_D, 0, -1.6, "middle"}}) {
    s += fmt::format("<circle class=\"p\" cx=\"{:.3f}\" cy=\"{:.3f}\" r=\".7\"/>", X(m.x + c.h_f), Y(m.rho));
    text(X(m.x + c.h_f) + m.dx, Y(m.rho) + m.dy, std::string(1, m.name), m.anchor, "t");
  }
  // Diameter at D, to the right of the break.
  const double right_x = X(length) + 6;
  line(X(length), Y(c.rho_D), right_x + 1.5, Y(c.rho_D), "d");
  line(X(length), Y(-c.rho_D), right_x + 1.5, Y(-c.rho_D), "d");
  line(right_x, Y(c.rho_D), right_x, Y(-c.rho_D), "d");
  text(right_x + 1, y_0 + 5, fmt::format("\u00d8{:.4f}", 2 * c.rho_D), "start", "t");
  // Tip to pitch cone, tip to D.
  const double below = y_0 + scale * widest + 4;
  line(X(0), below, X(c.h_f + c.x_D), below, "d");
  for (const double x : {0.0, c.h_f, c.h_f + c.x_D}) line(X(x), below - 1.2, X(x), below + 1.2, "d");
  text(X(0.5 * c.h_f), below + 3.6, fmt::format("h_f {:.4f}", c.h_f), "middle", "t");
  text(X(c.h_f + 0.5 * c.x_D), below + 3.6, fmt::format("x_D {:.4f}", c.x_D), "middle", "t");
  text(x_0, height - 1.2, scale >= 1 ? fmt::format("scale {:g}:1", scale) : fmt::format("scale 1:{:g}", 1 / scale),
       "start", "u");
  const double bar = std::pow(10.0, std::floor(std::log10(40 / scale)));
  line(x_0 + 24, height - 2.2, x_0 + 24 + scale * bar, height - 2.2, "k");
  text(x_0 + 26 + scale * bar, height - 1.2, fmt::format("{:g} mm", bar), "start", "u");
  return s + "</svg>\n";
}

}  // namespace toothpath::sheet
