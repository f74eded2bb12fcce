// [[tool]]: what every tool has, and the numbers of its kind of cutter (cam/tool/cutters.h).
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "app/job/tables.h"
#include "app/tool_library/tool_library.h"
#include "cam/tool/cutters.h"
#include "geometry/base/angle.h"
#include "geometry/base/printable.h"
#include "geometry/inspection/table_text.h"
#include "machines/toml/input_text.h"
#include "machines/tool_check.h"
#include "postproc/numbers/comment.h"

namespace toothpath::job {
namespace {

constexpr std::size_t kMostOfName = 40;  // characters: T999999 and a remark of Fanuc's, in one line of 80
constexpr toml::Range kToolLength{0, 2000, " mm", true};
constexpr toml::Range kToolDiameter{0.01, 500, " mm"};
constexpr std::size_t kMostMeridianBytes = 1 << 20;
constexpr std::size_t kMostSegments = 100;  // of a holder
constexpr double kMostHelix = 75;           // deg
constexpr toml::Range kLife{0, 1e6, " min", true};
constexpr std::size_t kMostSisters = 50;
constexpr double kSameInLibrary = 1e-4;  // of a number: rounding
constexpr const char* kTaperAngle = "taper_angle";
constexpr double kLeastBelowGauge = 0.5;  // of the holder: a spindle does not take more of it

std::vector<tool::HolderSegment> read_holder(toml::TableReader& table) {
  std::vector<tool::HolderSegment> result;
  toml::ValueShape rows{toml::ValueKind::rows};
  rows.columns = {"lower diameter", "upper diameter", "height"};
  rows.ranges.assign(rows.columns.size(), toml::Range::positive(2000, " mm"));
  rows.count = {1, kMostSegments};
  const toml::TomlValue* value = table.value("holder", {rows}, toml::Presence::required);
  if (!value) {
    table.refuse("holder", "[{}] lacks the key \"holder\"", table.path());
    return result;
  }
  const auto wrong = [&](const std::string& what) {
    table.refuse("holder",
                 "holder must be an array of [lower diameter, upper diameter, height] in mm, each above 0 and at most "
                 "2000; {}",
                 what);
    return std::vector<tool::HolderSegment>{};
  };
  const toml::TomlArray* segments = value->array();
  if (!segments) return wrong("this is no array");
  if (segments->values.empty() || segments->values.size() > kMostSegments)
    return wrong(fmt::format("this has {} of them, 1 to {} may stand here", segments->values.size(), kMostSegments));
  for (std::size_t s = 0; s < segments->values.size(); ++s) {
    const toml::TomlArray* numbers = segments->values[s].array();
    if (!numbers) return wrong(fmt::format("holder[{}] is no array", s));
    if (numbers->values.size() != 3) return wrong(fmt::format("holder[{}] has {} numbers", s, numbers->values.size()));
    double read[3] = {};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto number = numbers->values[i].number();
      if (!number) return wrong(fmt::format("holder[{}][{}] is no number", s, i));
      if (!(*number > 0 && *number <= 2000)) return wrong(fmt::format("holder[{}][{}] = {}", s, i, *number));
      read[i] = *number;
    }
    result.push_back({read[0], read[1], read[2]});
  }
  return result;
}

/// The gauge line may lie within the holder, where its upper end stands in the spindle: most of the holder is below it,
/// and nothing above it is wider than the holder is there.
void check_gauge_length(toml::TableReader& table, const tool::ToolAssembly& tool) {
  double height = 0, at_line = 0, above = 0;  // of all segments; diameters at the gauge line, and above it
  const double line = tool.length_mm - tool.stick_out_mm;
  for (const tool::HolderSegment& s : tool.holder) {
    const double share = std::clamp((line - height) / s.height_mm, 0.0, 1.0);
    const double cut = s.lower_diameter_mm + share * (s.upper_diameter_mm - s.lower_diameter_mm);
    if (height < line) at_line = cut;
    if (height >= line) above = std::max({above, s.lower_diameter_mm, s.upper_diameter_mm});
    height += s.height_mm;
  }
  if (line >= height || (line >= kLeastBelowGauge * height && above <= at_line)) return;
  table.refuse(
      "length",
      "length = {:.4g} mm, gauge line to tip, is shorter than stick_out = {:.4g} mm and the holder of {:.4g} mm "
      "allow: the gauge line lies {:.4g} mm above the lower end of the holder, where it is {:.4g} mm thick, and "
      "what is above stands in the spindle; state length = {:.4g}, or a holder that ends at the gauge line",
      tool.length_mm, tool.stick_out_mm, height, line, at_line, tool.stick_out_mm + height);
}

/// How long it lasts, and what goes on in its place.
void read_life(toml::TableReader& table, tool::ToolAssembly& tool) {
  tool.life_min = table.optional_number("life", kLife).value_or(0);
  tool.check_tolerance_mm =
      table.optional_number("check_tolerance", {machines::kLeastCheckTolerance, machines::kMostCheckTolerance, " mm"})
          .value_or(0);
  table.relate(toml::KeyRelation::Kind::needs, "sisters", "life");
  const auto sisters = table.optional_integer_list("sisters", kToolNumber, {1, kMostSisters});
  if (!sisters) return;
  tool.sisters = *sisters;
  if (sisters->empty() || sisters->size() > kMostSisters)
    table.refuse("sisters", "sisters has {} numbers, 1 to {} may stand here", sisters->size(), kMostSisters);
  else if (!table.has("life"))
    table.refuse("sisters", "sisters go on when tool {} is used up: state its life (minutes of cutting) too",
                 tool.number);
}

std::string read_shop_name(toml::TableReader& table, std::string_view key) {
  auto name = table.optional_text(key).value_or("");
  if (name.size() > kMostOfName)
    table.refuse(key, "{} has {} characters, {} at most: it stands in a line of the program", key, name.size(),
                 kMostOfName);
  return name;
}

std::vector<std::string_view> kind_words() {
  std::vector<std::string_view> words;
  for (const auto& kind : tool::cutter_kinds()) words.push_back(kind.word);
  return words;
}

void read_numbers(toml::TableReader& table, const tool::CutterKind& kind, tool::ToolAssembly& tool) {
  for (const auto& n : kind.numbers) {
    // Refused for what stands instead of it: read_end_mill.
    if (n.member == &tool::ToolAssembly::half_angle_rad && !table.has(n.key) && table.misplaced(kTaperAngle)) {
      (void)table.misplaced(n.key);
      continue;
    }
    const double read = table.number(n.key, {n.low, n.high, n.degrees ? " deg" : " mm", n.open_low}).value_or(0);
    tool.*n.member = n.degrees ? radians(read) : read;
  }
}

/// A finger mill: its width follows from its numbers, its flutes end at the profile where nothing else is said.
void read_finger_lengths(toml::TableReader& table, const ToolContext& context, tool::ToolAssembly& tool) {
  tool.flute_length_mm = (context.bevel ? context.bevel->dedendum_mm : 0) + tool.profile_height_mm;
  if (const auto flute = table.optional_number("flute_length", kToolLength)) tool.flute_length_mm = *flute;
  if (table.misplaced("diameter"))
    table.refuse("diameter",
                 "diameter contradicts type = \"finger_mill\": its width follows from module and profile_height");
}

/// The measured meridian: a table `t,f`, height above the centre of the ball [mm] and error of rho [um].
void read_meridian(toml::TableReader& table, const ToolContext& context, tool::ToolAssembly& tool) {
  const auto name = table.optional_text("meridian");
  if (!name) return;
  const auto path = (std::filesystem::path(context.directory) / *name).string();
  const auto text = toml::read_input_text(path, kMostMeridianBytes);
  if (!text) return table.refuse("meridian", "meridian = \"{}\": {}", *name, text.error().message);
  tool::MeridianError measured;
  int number = 0;
  for (std::string_view rest = *text; !rest.empty();) {
    const auto line = inspection::take_line(rest, number);
    number = line.number;
    if (number == 1) {
      if (!inspection::names_columns(line.text, "t,f"))
        return table.refuse("meridian", "{}:1: the header must be \"t,f\"", *name);
      continue;
    }
    if (inspection::number_cells(line.text).empty()) continue;
    const auto point = inspection::numbers_of<2>(line.text);
    if (!point) return table.refuse("meridian", "{}:{}: a line is two numbers: t in mm, f in um", *name, number);
    measured.t.push_back((*point)[0]);
    measured.f.push_back((*point)[1] / 1000);
  }
  tool.meridian = std::move(measured);
}

/// What a profile must fulfil, with the keys of the table.
void check_profile(toml::TableReader& table, const tool::ToolAssembly& tool) {
  const auto made = tool::Profile::make(tool::cutter_data(tool));
  if (const auto* refusals = std::get_if<std::vector<Refusal>>(&made))
    for (const auto& refusal : *refusals) table.refuse(refusal.key, "{}", refusal.diagnostic.message);
}

void read_end_mill(toml::TableReader& table, const ToolContext& context, tool::ToolAssembly& tool,
                   std::vector<std::string>& warnings) {
  if (tool::serves(tool, tool::CutterUse::side)) {
    if (table.misplaced(kTaperAngle))
      table.refuse(kTaperAngle,
                   "taper_angle: half or included? Say half_angle, between the axis and the side: half of the included "
                   "angle");
    read_meridian(table, context, tool);
  }
  tool.form_error_mm = table.optional_number("form_error", {0, 1, " mm"});
  tool.run_out_mm = table.optional_number("run_out", {0, 1, " mm"});
  if (tool.half_angle_rad > 0)
    if (const auto error = table.optional_number("half_angle_error", {0, 5, " deg"}))
      tool.half_angle_error_rad = radians(*error);
  const auto helix = table.optional_number("helix", {0, kMostHelix, " deg"});
  if (!helix) return;
  tool.helix_rad = radians(*helix);
  if (*helix == 0) {
    const SourcePosition at = table.where("helix");
    warnings.push_back(
        fmt::format("{}:{}:{}: warning: helix = 0 deg, tool {}: straight flutes cut along the whole line at once; the "
                    "force is several times that of a helix of 30 deg",
                    at.file, at.line, at.column, tool.number));
  }
}

/// What a file of tools says of the one that is read: the reader of its table takes it where the job says nothing.
class LibrarySupply {
 public:
  LibrarySupply(toml::TableReader& table, const ToolContext& context, int number, std::vector<std::string>& warnings)
      : before_(table.errors()) {
    const auto name = table.optional_text("library");
    const auto listed = table.optional_integer("library_number", kToolNumber);
    table.relate(toml::KeyRelation::Kind::supplies, "library", "number");
    table.relate(toml::KeyRelation::Kind::needs, "library_number", "library");
    const auto unit = table.optional_word("library_unit", {"mm", "inch"});
    table.relate(toml::KeyRelation::Kind::needs, "library_unit", "library");
    if (unit && !name) table.refuse("library_unit", "library_unit needs library, the file with that tool");
    if (listed && !name) table.refuse("library_number", "library_number needs library, the file with that tool");
    if (!name) return;
    const auto path = (std::filesystem::path(context.directory) / *name).lexically_normal().string();
    const auto tools = tool_library::read_tool_library(path, tool_library::library_unit_of(unit.value_or("")));
    auto found = tools ? tool_library::tool_of_library(*tools, listed.value_or(number))
                       : Result<tool_library::LibraryTool>(tools.error());
    if (!found) {
      const SourcePosition& at = found.error().position;
      const std::string place = at.file.empty() ? "" : at.line > 0 ? fmt::format("line {}: ", at.line) : "";
      table.refuse("library", "library = \"{}\": {}{}", *name, place, found.error().message);
      failed_ = true;
      return;
    }
    tool_ = std::move(*found);
    if (!tool_->name.empty() && tool_->keys.find("name") == nullptr) {
      const SourcePosition& at = table.where("library");
      tool_->keys.entries.push_back({"name", at, {at, {numbers::first_words(printable(tool_->name), kMostOfName)}}});
    }
    file_ = *name;
    check_unit(table, warnings);
    for (const toml::TomlEntry& said : tool_->keys.entries) compare(table, said, warnings);
    table.supply(tool_->keys);
  }

  /// What follows from a file that could not be read is not told; what it does not say is asked for by name.
  /// @return were there refusals of a tool of a file?
  bool finish(toml::TableReader& table) const {
    if (failed_) table.forget_errors(before_ + 1);
    else if (tool_) ask_for_missing(table);
    return (failed_ || tool_) && table.errors() > before_;
  }

 private:
  /// What stands in the job holds; where the file says something else the reader is told.
  void compare(const toml::TableReader& table, const toml::TomlEntry& said, std::vector<std::string>& warnings) const {
    const toml::TomlValue* own = table.own(said.key);
    if (!own) return;
    const auto a = own->number(), b = said.value.number();
    const bool same = a && b ? std::abs(*a - *b) <= kSameInLibrary * std::abs(*b)
                             : own->text() && said.value.text() && *own->text() == *said.value.text();
    if (same || own->array()) return;
    const SourcePosition at = table.where(said.key);
    warnings.push_back(fmt::format("{}:{}:{}: warning: {} is taken from here; {} says {}", at.file, at.line, at.column,
                                   table.name(said.key), file_,
                                   b                   ? fmt::format("{:g}", *b)
                                   : said.value.text() ? *said.value.text()
                                                       : "another"));
  }

  /// A unit that somebody says is needed, or is the same; one that nobody says is told.
  void check_unit(toml::TableReader& table, std::vector<std::string>& warnings) const {
    if (tool_->other_unit && !tool_->takes_unit)
      table.refuse("library_unit", "library_unit: {} states another unit for the lengths of tool {} itself", file_,
                   tool_->number);
    if (!tool_->unit_is_open) return;
    const SourcePosition at = table.where("library");
    warnings.push_back(
        fmt::format("{}:{}:{}: warning: {} states no unit, and no .ini beside it does: its lengths are read as mm; say "
                    "library_unit = \"mm\" or \"inch\"",
                    at.file, at.line, at.column, file_));
  }

  void ask_for_missing(toml::TableReader& table) const {
    std::vector<std::string> missing;
    for (const char* key : {"type", "shank_diameter", "length", "stick_out", "holder"})
      if (!table.has(key)) missing.emplace_back(key);
    if (const toml::TomlValue* type = table.looked_up("type"); type && type->text()) {
      const auto kinds = tool::cutter_kinds();
      const auto kind =
          std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return *type->text() == k.word; });
      if (kind != kinds.end())
        for (const tool::CutterNumber& n : kind->numbers)
          if (!table.has(n.key)) missing.emplace_back(n.key);
    }
    if (missing.empty()) return;
    table.forget_errors(before_);
    table.refuse("library", "tool {} of {} does not say {}: state {} here{}{}", tool_->number, file_,
                 fmt::join(missing, ", "), missing.size() == 1 ? "it" : "them", tool_->notes.empty() ? "" : " (",
                 tool_->notes.empty() ? "" : fmt::format("{})", fmt::join(tool_->notes, "; ")));
  }

  std::size_t before_;
  bool failed_ = false;
  std::optional<tool_library::LibraryTool> tool_;
  std::string file_;
};

}  // namespace

tool::ToolAssembly read_tool(toml::TableReader& table, const ToolContext& context, std::vector<std::string>& warnings) {
  const std::vector<std::string_view> words = kind_words();
  tool::ToolAssembly tool;
  tool.number = table.integer("number", kToolNumber).value_or(0);
  const LibrarySupply supply(table, context, tool.number, warnings);
  tool.name = read_shop_name(table, "name");
  tool.holder_name = read_shop_name(table, "holder_name");
  const auto type = table.variant("type", words);
  tool.shank_diameter_mm = table.number("shank_diameter", kToolDiameter).value_or(0);
  const auto length = table.number("length", kToolLength);
  const auto stick_out = table.number("stick_out", kToolLength);
  tool.length_mm = length.value_or(0);
  tool.stick_out_mm = stick_out.value_or(0);
  tool.holder = read_holder(table);
  tool.teeth = table.integer_or("teeth", {1, 100}, tool.teeth);
  read_life(table, tool);
  if (length && stick_out && *stick_out > *length)
    table.refuse("stick_out", "stick_out = {} mm exceeds length = {} mm", *stick_out, *length);
  else if (length && stick_out && !tool.holder.empty()) check_gauge_length(table, tool);
  if (!type) {
    if (supply.finish(table)) return tool;
    table.name_misspelt("type");
    return tool;  // which other keys belong here is unknown
  }
  const auto& kind = tool::cutter_kinds()[std::size_t(std::find(words.begin(), words.end(), *type) - words.begin())];
  tool.type = kind.type;
  const std::size_t before = table.errors();
  read_numbers(table, kind, tool);
  if (kind.form_from_gear) read_finger_lengths(table, context, tool);
  if (stick_out && tool.flute_length_mm > *stick_out)
    table.refuse(table.has("flute_length") ? "flute_length" : "stick_out",
                 "flute_length = {} mm exceeds stick_out = {} mm", tool.flute_length_mm, *stick_out);
  if (!kind.form_from_gear) {
    read_end_mill(table, context, tool, warnings);
    if (table.errors() == before) check_profile(table, tool);
  }
  table.finish();
  (void)supply.finish(table);
  return tool;
}

}  // namespace toothpath::job
