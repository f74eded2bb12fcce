#include "cam/tool/cutters.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::tool {
namespace {

constexpr double kMostLength = 2000, kMostDiameter = 500;  // mm

constexpr CutterNumber kDiameter{"diameter", &ToolAssembly::diameter_mm, 0.01, kMostDiameter};
constexpr CutterNumber kFlute{"flute_length", &ToolAssembly::flute_length_mm, 0, kMostLength, true};

constexpr std::array kBallUses{CutterUse::layers, CutterUse::ball_end};
constexpr std::array kTaperedUses{CutterUse::layers, CutterUse::ball_end, CutterUse::side};
constexpr std::array kLayersOnly{CutterUse::layers};
constexpr std::array kToothForm{CutterUse::tooth_form};

constexpr std::array kCommon{kDiameter, kFlute};
constexpr std::array kTapered{kDiameter, kFlute,
                              CutterNumber{"half_angle", &ToolAssembly::half_angle_rad, 0, 45, true, true}};
constexpr std::array kBullNose{kDiameter, kFlute,
                               CutterNumber{"corner_radius", &ToolAssembly::corner_radius_mm, 0, 250, true}};
constexpr std::array kFinger{CutterNumber{"module", &ToolAssembly::module_mm, 0.01, 100},
                             CutterNumber{"tip_radius", &ToolAssembly::tip_radius_mm, 0, 100},
                             CutterNumber{"rack_depth", &ToolAssembly::rack_depth_mm, 0, kMostLength, true},
                             CutterNumber{"profile_height", &ToolAssembly::profile_height_mm, 0, kMostLength, true}};

std::string diameter_text(const ToolAssembly& t) { return fmt::format("dia {:g} mm", t.diameter_mm); }
std::string diameter_word(const ToolAssembly& t) { return fmt::format("D{}", t.diameter_mm); }

const std::array kKinds{
    CutterKind{CutterType::ball_end_mill, "ball_end_mill", "ball end mill", false, CutterShape::ball, kBallUses,
               kCommon, diameter_text, diameter_word},
    CutterKind{
        CutterType::tapered_ball_end_mill, "tapered_ball_end_mill", "tapered ball end mill", false,
        CutterShape::tapered_ball, kTaperedUses, kTapered,
        [](const ToolAssembly& t) {
          return fmt::format("ball dia {:g} mm, half angle {:g} deg", t.diameter_mm, degrees(t.half_angle_rad));
        },
        [](const ToolAssembly& t) { return fmt::format("D{} {:g} DEG", t.diameter_mm, degrees(t.half_angle_rad)); }},
    CutterKind{CutterType::flat_end_mill, "flat_end_mill", "flat end mill", false, CutterShape::flat, kLayersOnly,
               kCommon, diameter_text, diameter_word},
    CutterKind{CutterType::bull_nose_end_mill, "bull_nose_end_mill", "bull nose end mill", false,
               CutterShape::bull_nose, kLayersOnly, kBullNose,
               [](const ToolAssembly& t) {
                 return fmt::format("dia {:g} mm, corner radius {:g} mm", t.diameter_mm, t.corner_radius_mm);
               },
               [](const ToolAssembly& t) { return fmt::format("D{} R{}", t.diameter_mm, t.corner_radius_mm); }},
    CutterKind{CutterType::finger_mill, "finger_mill", "finger mill", true, CutterShape::ball, kToothForm, kFinger,
               [](const ToolAssembly& t) {
                 return fmt::format("module {:g}, tip radius {:g}, rack depth {:g}, profile height {:g} mm",
                                    t.module_mm, t.tip_radius_mm, t.rack_depth_mm, t.profile_height_mm);
               },
               [](const ToolAssembly& t) { return fmt::format("M{}", t.module_mm); }},
};

constexpr int kArcChords = 12;  // of a drawn quarter circle

void add_piece(const MeridianPiece& piece, std::vector<Vec2>& line) {
  if (line.empty()) line.push_back(piece.from);
  if (piece.bend != 0) {
    const auto c = circle_of<double>(piece);
    for (int k = 1; k < kArcChords; ++k) {
      const Vec2 chord = piece.from + (piece.to - piece.from) * (double(k) / kArcChords);
      line.emplace_back(c.centre + (chord - c.centre).normalized() * c.R);
    }
  }
  line.push_back(piece.to);
}

Outline outline(Body body, const Meridian& meridian) {
  Outline out{body, {}};
  for (const auto& piece : meridian.pieces()) add_piece(piece, out.line);
  return out;
}

}  // namespace

std::vector<Outline> outline_of(const ToolAssembly& tool) {
  std::vector<Outline> out;
  const Meridian cutting =
      kind_of(tool).form_from_gear
          ? Meridian({{Vec2(0, tool.module_mm / 4), Vec2(tool.flute_length_mm, tool.shank_diameter_mm / 2), 0}})
          : profile_of(tool).cutting();
  for (const auto& piece : cutting.pieces()) {
    const Body body = piece.bend != 0 ? Body::ball : Body::flute;
    if (out.empty() || out.back().body != body) out.push_back({body, {}});
    add_piece(piece, out.back().line);
  }
  for (const auto& part : {outline(Body::shank, shank_of(tool)), outline(Body::holder, holder_of(tool))})
    if (!part.line.empty()) out.push_back(part);
  return out;
}

bool CutterKind::serves(CutterUse use) const { return std::find(uses.begin(), uses.end(), use) != uses.end(); }

std::span<const CutterKind> cutter_kinds() { return kKinds; }

const CutterKind& kind_of(CutterType type) {
  return *std::find_if(kKinds.begin(), kKinds.end(), [&](const CutterKind& kind) { return kind.type == type; });
}

bool turns_freely(const ToolAssembly& tool) {
  const CutterKind& kind = kind_of(tool);
  return kind.serves(CutterUse::ball_end) && !kind.serves(CutterUse::side);
}

std::string cutter_text(const ToolAssembly& tool) {
  const CutterKind& kind = kind_of(tool);
  std::string names = tool.name;
  if (!tool.holder_name.empty()) names += (names.empty() ? "holder " : ", holder ") + tool.holder_name;
  return fmt::format("{}, {}{}", kind.name, kind.size(tool), names.empty() ? "" : fmt::format(" ({})", names));
}

std::string cutter_comment(const ToolAssembly& tool) {
  const CutterKind& kind = kind_of(tool);
  std::string name = kind.name;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? char(c - 32) : c; });
  return name + " " + kind.short_size(tool);
}

std::vector<std::string> shop_names(const ToolAssembly& tool) {
  std::vector<std::string> out;
  if (!tool.name.empty()) out.push_back("NAME " + tool.name);
  if (!tool.holder_name.empty()) out.push_back("HOLDER " + tool.holder_name);
  return out;
}

std::optional<AptCutter> apt_cutter(const ToolAssembly& tool) {
  const double R = tool.radius_mm(), r = end_centre_mm(tool), h = tool.flute_length_mm;
  switch (tool.type) {
    case CutterType::ball_end_mill:
    case CutterType::flat_end_mill:
    case CutterType::bull_nose_end_mill: return AptCutter{2 * R, r, R - r, r, 0, 0, h};
    case CutterType::tapered_ball_end_mill: {
      // The side touches the ball; level with the tip it stands this far from the axis.
      const double b = tool.half_angle_rad;
      return AptCutter{2 * R * (1 - std::sin(b)) / std::cos(b), R, 0, R, 0, degrees(b), h};
    }
    case CutterType::finger_mill: break;
  }
  return std::nullopt;
}

Profile profile_of(const ToolAssembly& tool) { return Profile::of_accepted(cutter_data(tool)); }

double end_centre_mm(const ToolAssembly& tool) {
  switch (kind_of(tool).shape) {
    case CutterShape::flat: return 0;
    case CutterShape::bull_nose: return tool.corner_radius_mm;
    default: return tool.radius_mm();
  }
}

}  // namespace toothpath::tool
