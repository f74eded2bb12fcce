// The tool library of Fusion, as it exports it: an array "data", the numbers named as in ISO 13399 (DC, LCF, SFDM, NOF,
// RE), LB the length below the holder, holder segments from the tool side. Lengths in the unit that the tool states; a
// holder states a unit of its own.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/tool_library/formats.h"
#include "geometry/base/angle.h"
#include "geometry/base/length_unit.h"
#include "geometry/base/printable.h"

namespace toothpath::tool_library {
namespace {

using Json = nlohmann::json;

constexpr double kSameShare = 2e-3;  // of a length: two ways to say it agree (libraries round to 4 digits)
constexpr int kMostSegments = 100;

const Json* member(const Json& object, const char* name) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}
std::optional<double> number(const Json& object, const char* name) {
  const Json* found = member(object, name);
  if (!found || !found->is_number()) return {};
  const double value = found->get<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}
std::string text(const Json& object, const char* name) {
  const Json* found = member(object, name);
  return found && found->is_string() ? found->get<std::string>() : std::string();
}

/// T word; 0: none.
int number_of(const Json& tool) {
  const Json* post = member(tool, "post-process");
  const auto n = post ? number(*post, "number") : std::nullopt;
  return n && *n >= 1 && *n <= 1e6 ? int(*n) : 0;
}

/// One tool of the library while it is read.
class Entry {
 public:
  Entry(const Json& json, const SourcePosition& at, LibraryUnit said) : json_(json), at_(at), said_(said) {}

  /// Nothing: a kind that no job has.
  [[nodiscard]] Result<std::optional<LibraryTool>> read() {
    const std::string type = text(json_, "type");
    if (type != "ball end mill" && type != "flat end mill" && type != "bull nose end mill" && type != "tapered mill")
      return std::optional<LibraryTool>();
    tool_.name = text(json_, "description");
    tool_.number = number_of(json_);
    const auto unit = unit_of(json_, "unit");
    if (!unit) return unit.error();
    scale_ = *unit;
    if (const Json* found = member(json_, "geometry")) geometry_ = found;
    const Json* holder = member(json_, "holder");
    if (holder && (member(*holder, "segments") || member(*holder, "gaugeLength"))) {
      if (const auto own = unit_of(*holder, "unit of the holder")) holder_scale_ = *own;
      else tool_.notes.push_back(own.error().message);
    }
    form(type);
    lengths();
    if (holder) read_holder(*holder);
    else tool_.notes.push_back("no holder");
    return std::optional(std::move(tool_));
  }

 private:
  /// Millimetres of the unit that the tool, or its holder, states: as "unit", or, in older libraries, as the expression
  /// "tool_unit".
  [[nodiscard]] Result<double> unit_of(const Json& json, const char* what) {
    std::string word = text(json, "unit");
    if (const Json* expressions = member(json, "expressions"); word.empty() && expressions) {
      word = text(*expressions, "tool_unit");
      std::erase(word, '\'');
    }
    const auto mm = word.empty() ? std::nullopt : mm_of_unit(word);
    const auto taken = unit_of_length(mm, mm || word.empty() ? said_ : LibraryUnit::none, tool_);
    if (taken) return *taken;
    const std::string which = fmt::format("tool {} \"{}\": {}", tool_.number, printable(tool_.name), what);
    if (word.empty()) return fail_at(at_, "{} is not there: {}", which, kUnitKey);
    return fail_at(at_, "{} = \"{}\" is neither \"millimeters\" nor \"inches\"", which, printable(word));
  }

  [[nodiscard]] std::optional<double> length(const char* name) const {
    const auto value = geometry_ ? number(*geometry_, name) : std::nullopt;
    return value && *value > 0 ? std::optional(*value * scale_) : std::nullopt;
  }
  void key(const char* name, double value) { add_key(tool_, name, value, at_); }
  void key(const char* name, const std::string& word) { add_key(tool_, name, word, at_); }

  void form(const std::string& type) {
    const auto DC = length("DC"), RE = length("RE");
    if (type == "tapered mill") return tapered(DC, RE);
    key("type", type == "ball end mill"   ? std::string("ball_end_mill")
                : type == "flat end mill" ? std::string("flat_end_mill")
                                          : std::string("bull_nose_end_mill"));
    if (DC) key("diameter", *DC);
    if (type == "bull nose end mill" && RE) key("corner_radius", *RE);
  }

  /// DC is where the side would meet the end without its rounding RE: a ball, where the rounding takes all of the end.
  void tapered(const std::optional<double>& DC, const std::optional<double>& RE) {
    const double angle = geometry_ ? number(*geometry_, "TA").value_or(NAN) : NAN;
    if (!DC || !RE || std::isnan(angle))
      return tool_.notes.push_back("tapered mill without DC, RE or TA: its tip is not known");
    const double whole = *DC / (2 * std::tan(radians(45 - angle / 2)));
    if (std::abs(*RE - whole) > kSameShare * whole) {
      tool_.notes.push_back(
          fmt::format("tapered mill: DC = {:.4f}, RE = {:.4f} mm and TA = {} are no ball end with a "
                      "half angle in deg, which needs RE = {:.4f} mm: type, diameter and half_angle "
                      "are not taken",
                      *DC, *RE, angle, whole));
      return;
    }
    key("type", std::string("tapered_ball_end_mill"));
    key("diameter", 2 * *RE);
    key("half_angle", angle);
  }

  void lengths() {
    if (const auto LCF = length("LCF")) key("flute_length", *LCF);
    if (const auto LB = length("LB")) key("stick_out", *LB);
    read_gauge_length();
    if (const auto teeth = geometry_ ? number(*geometry_, "NOF") : std::nullopt; teeth && *teeth == std::floor(*teeth))
      add_key(tool_, "teeth", std::int64_t(std::clamp(*teeth, -1e6, 1e6)), at_);
    auto shank = length("SFDM");
    if (!shank) return;
    // A shaft that widens below the holder: one diameter stands for all of it, the largest.
    if (const Json* shaft = member(json_, "shaft"))
      if (const Json* segments = member(*shaft, "segments"); segments && segments->is_array())
        for (const Json& segment : *segments)
          for (const char* end : {"lower-diameter", "upper-diameter"})
            if (const auto d = number(segment, end)) shank = std::max(*shank, *d * scale_);
    key("shank_diameter", neck_up_to_the_holder(*shank).value_or(*shank));
  }

  /// What stands between flutes and holder: a neck ("shoulder") that reaches the holder is the shank that a [[tool]]
  /// has. Of one that ends below it there is no key: the tool is taken as thick as its shank.
  [[nodiscard]] std::optional<double> neck_up_to_the_holder(double shank) {
    const auto neck = length("shoulder-diameter"), to = length("shoulder-length"), below = length("LB");
    if (!neck || !to || *neck >= shank || tool_.keys.find("half_angle")) return std::nullopt;
    if (below && *to >= (1 - kSameShare) * *below) return neck;
    tool_.notes.push_back(fmt::format(
        "its neck of {:g} mm ends {:g} mm above the tip, below the holder: a [[tool]] has one thickness from "
        "flutes to holder, and that of the shank is taken, {:g} mm",
        *neck, *to, shank));
    return std::nullopt;
  }

  /// Gauge line to tip: as stated, else what the holder says of its own and the tool below it.
  void read_gauge_length() {
    if (const auto stated = length("assemblyGaugeLength")) return key("length", *stated);
    const Json* holder = member(json_, "holder");
    const auto own = holder ? number(*holder, "gaugeLength") : std::nullopt;
    if (const auto below = length("LB"); own && below && holder_scale_) key("length", *own * *holder_scale_ + *below);
  }

  void read_holder(const Json& holder) {
    const Json* segments = member(holder, "segments");
    if (!segments || !segments->is_array() || segments->empty() || segments->size() > kMostSegments)
      return tool_.notes.push_back("the holder has no segments");
    if (!holder_scale_) return;
    toml::TomlArray all;
    for (const Json& segment : *segments) {
      toml::TomlArray one;
      for (const char* name : {"lower-diameter", "upper-diameter", "height"}) {
        const auto value = number(segment, name);
        if (!value) return tool_.notes.push_back(fmt::format("a segment of the holder has no {}", name));
        one.values.push_back({at_, {*value * *holder_scale_}});
      }
      all.values.push_back({at_, {std::move(one)}});
    }
    add_key(tool_, "holder", std::move(all), at_);
  }

  const Json& json_;
  const SourcePosition at_;
  const Json* geometry_ = nullptr;
  LibraryUnit said_;
  double scale_ = 1;                    ///< mm of the unit
  std::optional<double> holder_scale_;  ///< nothing: its unit is not known
  LibraryTool tool_;
};

}  // namespace

Result<std::vector<LibraryTool>> read_fusion_library(const std::string& content, const std::string& path,
                                                     LibraryUnit unit, std::vector<OtherTool>* others) {
  const auto json = parse_object(content, path);
  if (!json) return json.error();
  const Json* data = member(*json, "data");
  if (!data || !data->is_array()) return fail_at({path, 0, 0}, "a tool library of Fusion has an array \"data\"");
  std::vector<LibraryTool> tools;
  for (const Json& one : *data) {
    auto tool = Entry(one, {path, 0, 0}, unit).read();
    if (!tool) return tool.error();
    if (*tool) tools.push_back(std::move(**tool));
    else if (others) others->push_back({number_of(one), text(one, "description"), text(one, "type")});
  }
  if (tools.empty()) return fail_at({path, 0, 0}, "the library has no end mill: {} entries", data->size());
  return tools;
}

}  // namespace toothpath::tool_library
