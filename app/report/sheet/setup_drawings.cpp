#include "app/report/sheet/setup_drawings.h"

#include <algorithm>
#include <cmath>

#include "app/report/sheet/sheet_html.h"
#include "app/report/svg/html_text.h"
#include "cam/tool/cutters.h"
#include "geometry/base/result.h"

namespace toothpath::sheet {
namespace {

constexpr double kPageWidth = 182;  // mm of paper, as everything below
constexpr double kPartWidth = 96;   // of the part with its axes
constexpr double kMostHeight = 62;  // of the part
constexpr double kLeastLine = 4.4;  // between two levels in words
constexpr double kTop = 7, kBottom = 13;

/// A height in the machine that the operator looks for.
struct Level {
  std::string name;
  double z = 0;  ///< machine
  const char* colour = "#111";
};

/// The part from the side: X of the machine to the right, Z up, in mm of paper.
class PartDrawing {
 public:
  PartDrawing(const joints::Setup& setup, const PartOutline& part, const machines::Machine& machine)
      : setup_(setup), part_(part), machine_(machine), at_(setup.origin_mm) {
    x_low_ = std::min(at_.x() - part.outer_radius, setup.work_offset_at_mm.x());
    x_high_ = std::max(at_.x() + part.outer_radius, setup.work_offset_at_mm.x());
    if (part.around)
      levels_ = {{"end face, gear Z " + millimetres(part.tooth_top), z_of(part.tooth_top)},
                 {"end face, gear Z " + millimetres(part.bottom), z_of(part.bottom)}};
    else
      levels_ = {
          {"tooth tops", z_of(part.tooth_top)}, {"deepest root", z_of(part.root)}, {"under side", z_of(part.bottom)}};
    levels_.push_back({"gear origin", at_.z(), "#a02020"});
    levels_.push_back({setup.work_offset + " zero", setup.work_offset_at_mm.z(), "#0b4f9e"});
    for (const auto& axis : machine.chain.table) {
      if (is_upright(axis)) continue;
      x_low_ = std::min(x_low_, axis.point_mm.x());
      x_high_ = std::max(x_high_, axis.point_mm.x());
      levels_.push_back({fmt::format("axis {}", axis.letter), axis.point_mm.z(), "#555"});
    }
    std::stable_sort(levels_.begin(), levels_.end(), [](const Level& a, const Level& b) { return a.z > b.z; });
    const double tall = levels_.front().z - levels_.back().z;
    scale_ = std::min(kPartWidth / (x_high_ - x_low_), tall > 0 ? kMostHeight / tall : INFINITY);
    height_ = std::max(scale_ * tall, kLeastLine * double(levels_.size()) - kLeastLine);
    above_ = 0.5 * (height_ - scale_ * tall);
  }

  std::string svg() {
    const double height = kTop + height_ + kBottom;
    out_ = fmt::format(
        "<svg viewBox='0 0 {:g} {:.2f}' role=img aria-label='part in the machine, X to the right, Z up' "
        "style='width:100%' font-size='2.7' font-family='sans-serif'>",
        kPageWidth, height);
    body();
    axes();
    words();
    zero();
    across();
    out_ += "<text x='0' y='3'>X right, Z up, mm</text></svg>\n";
    return std::move(out_);
  }

 private:
  static bool is_upright(const machines::RotaryAxis& axis) { return std::abs(axis.direction.z()) > 0.999; }
  [[nodiscard]] double z_of(double z) const { return at_.z() + (setup_.axis_up ? z : -z); }
  [[nodiscard]] double px(double x) const {
    return 2 + 0.5 * (kPartWidth - scale_ * (x_high_ - x_low_)) + scale_ * (x - x_low_);
  }
  [[nodiscard]] double py(double z) const { return kTop + above_ + scale_ * (levels_.front().z - z); }

  void line(double x1, double y1, double x2, double y2, const char* colour, const char* dashes = "") {
    out_ += fmt::format("<path d='M{:.2f} {:.2f}L{:.2f} {:.2f}' stroke='{}' stroke-width='.18' fill='none'{}/>", x1, y1,
                        x2, y2, colour, *dashes ? fmt::format(" stroke-dasharray='{}'", dashes) : "");
  }
  void box(double x1, double x2, double z1, double z2, const char* fill) {
    out_ += fmt::format(
        "<rect x='{:.2f}' y='{:.2f}' width='{:.2f}' height='{:.2f}' fill='{}' stroke='#333' "
        "stroke-width='.25'/>",
        px(x1), py(std::max(z1, z2)), scale_ * (x2 - x1), scale_ * std::abs(z2 - z1), fill);
  }
  void body() {
    const double r = part_.outer_radius;
    box(at_.x() - r, at_.x() + r, z_of(part_.around ? part_.tooth_top : part_.root), z_of(part_.bottom), "#ddd");
    for (const double side : {-1.0, 1.0}) {
      const double a = at_.x() + side * part_.inner_radius, b = at_.x() + side * r;
      box(std::min(a, b), std::max(a, b), z_of(part_.tooth_top), z_of(part_.root), "#9ab");
    }
  }
  void axes() {
    const double low = kTop + height_ + 3;
    line(px(at_.x()), kTop - 3, px(at_.x()), low, "#a02020", "4 1 1 1");
    for (const auto& axis : machine_.chain.table) {
      const double x = px(axis.point_mm.x());
      if (is_upright(axis)) {
        line(x, kTop - 3, x, low, "#555", "4 1 1 1");
        out_ += fmt::format("<text x='{:.2f}' y='{:.2f}' text-anchor='middle' fill='#555'>axis {}</text>", x,
                            kTop - 3.6, axis.letter);
      } else {
        out_ += fmt::format("<circle cx='{:.2f}' cy='{:.2f}' r='1.2' fill='#fff' stroke='#555' stroke-width='.3'/>", x,
                            py(axis.point_mm.z()));
      }
    }
  }
  /// The levels in words, none above another, each with a line to its height.
  void words() {
    const double x = kPartWidth + 10;
    double free = 0;
    const double span = kLeastLine * double(levels_.size() - 1);
    for (std::size_t k = 0; k < levels_.size(); ++k) {
      const Level& level = levels_[k];
      const double rest = kTop + height_ - (span - kLeastLine * double(k));  // the others must find their place below
      const double y = std::max(std::min(py(level.z), rest), free);
      free = y + kLeastLine;
      line(px(x_high_) + 1, py(level.z), x - 5, py(level.z), level.colour, ".6 .6");
      line(x - 5, py(level.z), x - 1, y, level.colour);
      out_ += fmt::format("<text x='{:.2f}' y='{:.2f}' fill='{}'>{}: machine Z {} ({} Z {})</text>", x, y + 1,
                          level.colour, svg::html_escape(level.name), millimetres(level.z),
                          svg::html_escape(setup_.work_offset), millimetres(level.z - setup_.work_offset_at_mm.z()));
    }
  }
  /// The zero point: a circle with two quarters filled.
  void zero() {
    const double x = px(setup_.work_offset_at_mm.x()), y = py(setup_.work_offset_at_mm.z()), r = 1.7;
    out_ += fmt::format(
        "<circle cx='{0:.2f}' cy='{1:.2f}' r='{2}' fill='#fff' stroke='#0b4f9e' stroke-width='.3'/>"
        "<path d='M{0:.2f} {1:.2f}h{2}a{2} {2} 0 0 0 -{2} -{2}zM{0:.2f} {1:.2f}h-{2}a{2} {2} 0 0 0 {2} {2}z' "
        "fill='#0b4f9e'/>",
        x, y, r);
    const double gx = px(at_.x()), gy = py(at_.z());
    line(gx - 2, gy, gx + 2, gy, "#a02020");
    line(gx, gy - 2, gx, gy + 2, "#a02020");
  }
  /// Diameters below the part.
  void across() {
    dimension(part_.outer_radius, kTop + height_ + 5.5, "outer diameter");
    if (part_.inner_radius > 0)
      dimension(part_.inner_radius, kTop + height_ + 10.5, part_.around ? "root diameter" : "teeth begin at diameter");
  }
  void dimension(double radius, double y, const char* name) {
    const double a = px(at_.x() - radius), b = px(at_.x() + radius), from = py(z_of(part_.bottom));
    for (const double x : {a, b}) line(x, std::min(from, y) + 0.6, x, y + 1, "#777");
    line(a, y, b, y, "#111");
    out_ += fmt::format("<path d='M{0:.2f} {2:.2f}l2 -.7v1.4zM{1:.2f} {2:.2f}l-2 -.7v1.4z' fill='#111'/>", a, b, y);
    out_ += fmt::format("<text x='{:.2f}' y='{:.2f}' >{} {}</text>", std::max(b, px(at_.x() + part_.outer_radius)) + 2,
                        y + 0.9, name, millimetres(2 * radius));
  }

  const joints::Setup& setup_;
  const PartOutline& part_;
  const machines::Machine& machine_;
  const Vec3 at_;              ///< gear origin
  std::vector<Level> levels_;  ///< from above
  double x_low_ = 0, x_high_ = 0, scale_ = 1, height_ = 0, above_ = 0;
  std::string out_;
};

}  // namespace

std::string part_sketch(const joints::Setup& setup, const PartOutline& part, const machines::Machine& machine) {
  return PartDrawing(setup, part, machine).svg();
}

namespace {

constexpr double kToolHeight = 40, kToolSide = 17,
                 kToolFoot = 9;     // of paper: the tool, the room for words beside and below it
constexpr double kLeastWord = 3.2;  // between two words

/// A tool from the side with its lengths, in mm of paper: the tip below, lengths from the tip up at the right, the
/// length to the gauge line at the left.
class ToolDrawing {
 public:
  explicit ToolDrawing(const tool::ToolAssembly& tool) : tool_(tool) {
    double holder = 0, widest = std::max(tool.diameter_mm, tool.shank_diameter_mm);
    for (const auto& segment : tool.holder) {
      holder += segment.height_mm;
      widest = std::max({widest, segment.lower_diameter_mm, segment.upper_diameter_mm});
    }
    top_ = std::max(tool.length_mm, tool.stick_out_mm + holder);
    scale_ = kToolHeight / top_;
    half_ = 0.5 * scale_ * widest;
  }

  std::string svg() {
    const double width = 2 * (half_ + kToolSide), height = kToolHeight + kToolFoot + 2;
    out_ = fmt::format(
        "<svg viewBox='{:.2f} -1 {:.2f} {:.2f}' style='width:{:.2f}mm;height:{:.2f}mm' font-size='2.5' "
        "font-family='sans-serif' role=img aria-label='tool {}'>",
        -0.5 * width, width, height, width, height, tool_.number);
    bodies();
    words();
    length();
    out_ += fmt::format("<text x='0' y='{:.2f}' text-anchor='middle' font-weight='600'>T{}</text>", kToolHeight + 4,
                        tool_.number);
    out_ += fmt::format("<text x='0' y='{:.2f}' text-anchor='middle'>{}</text></svg>\n", kToolHeight + 7.5,
                        tool_.diameter_mm > 0 ? fmt::format("\u00f8 {:g}", tool_.diameter_mm)
                                              : fmt::format("module {:g}", tool_.module_mm));
    return std::move(out_);
  }

 private:
  [[nodiscard]] double y_of(double along) const { return kToolHeight - scale_ * along; }

  void bodies() {
    for (const auto& body : tool::outline_of(tool_)) {
      const char* fill = tool::cuts(body.body) ? "#e8c66a" : body.body == tool::Body::shank ? "#bbb" : "#888";
      std::string right, left;
      for (const Vec2& p : body.line) {
        right += fmt::format("{}{:.3f} {:.3f}", right.empty() ? "M" : "L", scale_ * p[1], y_of(p[0]));
        left = fmt::format("L{:.3f} {:.3f}", -scale_ * p[1], y_of(p[0])) + left;
      }
      out_ += fmt::format("<path d='{}{}Z' fill='{}' stroke='#333' stroke-width='.15'/>", right, left, fill);
    }
  }
  void line(double x1, double y1, double x2, double y2) {
    out_ += fmt::format("<path d='M{:.2f} {:.2f}L{:.2f} {:.2f}' stroke='#777' stroke-width='.12' fill='none'/>", x1, y1,
                        x2, y2);
  }
  /// Flutes and stick-out, each at its height above the tip; no word covers another.
  void words() {
    double free = kToolHeight;
    const double x = half_ + 3;
    for (const auto& [name, mm] : {std::pair{"flute", tool_.flute_length_mm}, {"out", tool_.stick_out_mm}}) {
      const double y = std::min(y_of(mm), free);
      free = y - kLeastWord;
      line(0.5 * scale_ * tool_.shank_diameter_mm, y_of(mm), half_ + 1, y_of(mm));
      line(half_ + 1, y_of(mm), x - 0.5, y);
      out_ += fmt::format("<text x='{:.2f}' y='{:.2f}'>{} {:g}</text>", x, y + 0.9, name, mm);
    }
  }
  void length() {
    const double x = -half_ - 2, high = y_of(tool_.length_mm);
    for (const double y : {kToolHeight, high}) line(x - 1, y, 0, y);
    line(x, kToolHeight, x, high);
    out_ += fmt::format("<text x='{:.2f}' y='{:.2f}' text-anchor='end'>{:g}</text>", x - 0.8,
                        0.5 * (kToolHeight + high) + 0.9, tool_.length_mm);
  }

  const tool::ToolAssembly& tool_;
  double top_ = 0, scale_ = 1, half_ = 0;
  std::string out_;
};

}  // namespace

std::string tool_sketch(const tool::ToolAssembly& tool) { return ToolDrawing(tool).svg(); }

}  // namespace toothpath::sheet
