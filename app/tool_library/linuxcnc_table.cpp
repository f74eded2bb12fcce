// The tool table of LinuxCNC: a line a tool, words of a letter and a number, a remark behind a semicolon.
// Source: LinuxCNC, "Tool Table Format": T number (0: no tool), P pocket, Z length offset, D diameter, in machine
// units, which the configuration of the machine names ([TRAJ] LINEAR_UNITS of its .ini).
#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "app/tool_library/formats.h"
#include "geometry/base/length_unit.h"
#include "geometry/base/printable.h"
#include "machines/toml/input_text.h"

namespace toothpath::tool_library {
namespace {

struct Words {
  std::optional<double> T, P, Z, D;
};

constexpr std::size_t kMostIniFiles = 100, kMostIniBytes = 1u << 20;
constexpr std::string_view kLetters = "TPXYZABCUVWDIJQ";

Status read_word(std::string_view word, const SourcePosition& at, Words& words) {
  const char letter = char(std::toupper(static_cast<unsigned char>(word.front())));
  if (kLetters.find(letter) == std::string_view::npos)
    return fail_at(at, "\"{}\": a word begins with one of {}", printable(word), kLetters);
  std::string_view digits = word.substr(1);
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value))
    return fail_at(at, "\"{}\": no number behind {}", printable(word), letter);
  if (letter == 'T') words.T = value;
  if (letter == 'P') words.P = value;
  if (letter == 'Z') words.Z = value;
  if (letter == 'D') words.D = value;
  return Ok{};
}

std::string trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
  return std::string(text);
}

/// What the configurations in the folder of a table say of the unit.
struct UnitBeside {
  std::string file, word;    ///< of the first that is not in mm, or else of the first at all; empty: none says anything
  std::optional<double> mm;  ///< of that word; nothing: no unit that we know
  bool agree = true;         ///< they all say the same
};

/// LINEAR_UNITS and TOOL_TABLE of a configuration.
struct IniWords {
  std::string units, table;
};
IniWords ini_words(std::string_view text) {
  IniWords out;
  std::string section;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string line = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.empty() || line.front() == '#' || line.front() == ';') continue;
    if (line.front() == '[') section = line;
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos) continue;
    const std::string key = trimmed(std::string_view(line).substr(0, equals)),
                      value = trimmed(std::string_view(line).substr(equals + 1));
    if (section.starts_with("[TRAJ]") && key == "LINEAR_UNITS") out.units = value;
    if (section.starts_with("[EMCIO]") && key == "TOOL_TABLE") out.table = value;
  }
  return out;
}

/// A word of LINEAR_UNITS.
std::optional<double> mm_of_ini(const std::string& word) {
  if (word == "metric") return 1.0;
  if (word == "imperial") return kInchMm;
  return mm_of_unit(word);
}

/// The configurations in the folder of the table: those that name it, else all.
UnitBeside unit_beside(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path folder = fs::path(path).parent_path();
  std::vector<std::string> files;
  for (fs::directory_iterator at(folder.empty() ? fs::path(".") : folder, error), end; !error && at != end;
       at.increment(error)) {
    const fs::path& file = at->path();
    if (file.extension() == ".ini" || file.extension() == ".INI") files.push_back((folder / file.filename()).string());
  }
  std::sort(files.begin(), files.end());
  if (files.size() > kMostIniFiles) files.resize(kMostIniFiles);
  struct Said {
    std::string file;
    IniWords words;
  };
  std::vector<Said> all, naming;
  for (const std::string& file : files) {
    const auto text = toml::read_input_text(file, kMostIniBytes);  // one that cannot be read says nothing
    IniWords words = text ? ini_words(*text) : IniWords();
    if (words.units.empty()) continue;
    if (fs::path(words.table).filename() == fs::path(path).filename()) naming.push_back({file, words});
    all.push_back({file, std::move(words)});
  }
  UnitBeside out;
  for (const Said& said : naming.empty() ? all : naming) {
    const auto mm = mm_of_ini(said.words.units);
    if (!out.file.empty() && mm != out.mm) out.agree = false;
    if (out.file.empty() || (out.mm == 1.0 && mm != 1.0))
      out = {fs::path(said.file).filename().string(), said.words.units, mm, out.agree};
  }
  return out;
}

/// A diameter that no mill in mm has, and a mill in inches has: 1/32, or 0.8 mm.
bool looks_like_inches(double diameter) {
  const auto multiple = [](double value, double step, double off) {
    return std::abs(value - step * std::round(value / step)) <= off && value > step / 2;
  };
  constexpr double kUsual = 0.01, kFraction = 1.0 / 128, kHidden = 0.05;  // mm, inch, mm
  constexpr double kTiny = 0.1;  // mm: hardly any mill, so that four digits of a table are enough to ask
  if (multiple(diameter, kUsual, 1e-9)) return false;
  const double rounded = diameter < kTiny ? 5.1e-5 : 5.1e-7;  // half of the last digit, inch
  return multiple(diameter, kFraction, rounded) || multiple(diameter * kInchMm, kHidden, rounded * kInchMm);
}

/// "1/32 ball", "0.8 mm, inch machine", "1/4\"": a remark that speaks of inches.
bool speaks_of_inches(const std::string& remark) {
  std::string text = remark;
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  if (text.find("inch") != std::string::npos) return true;
  const auto digit = [&](std::size_t k) {
    return k < text.size() && std::isdigit(static_cast<unsigned char>(text[k]));
  };
  const auto number = [&](std::size_t from, std::size_t to) {
    return to - from <= 3 ? std::atoi(text.substr(from, to - from).c_str()) : 0;
  };
  for (std::size_t k = 1; k < text.size(); ++k) {
    if (!digit(k - 1)) continue;
    if (text[k] == '"') return true;
    if (text[k] != '/') continue;
    std::size_t from = k, to = k + 1;
    while (from > 0 && digit(from - 1)) --from;
    while (digit(to)) ++to;
    const int above = number(from, k), below = number(k + 1, to);
    if (above % 2 == 1 && above < below && below <= 128 && std::has_single_bit(unsigned(below))) return true;
  }
  return false;
}

/// Refused: a table whose unit nobody says, where something speaks of inches.
Status ask_for_inches(const std::vector<LibraryTool>& tools, const UnitBeside& beside, const std::string& path) {
  const bool open = beside.file.empty();
  if (!open && (beside.mm != 1.0 || !beside.agree))
    return fail_at({path, 0, 0},
                   "a tool table counts in the unit of its machine, and {} beside it says LINEAR_UNITS = "
                   "{}{}: {}",
                   printable(beside.file), printable(beside.word), beside.agree ? "" : ", another one mm", kUnitKey);
  if (!open) return Ok{};
  for (const LibraryTool& tool : tools) {
    const toml::TomlEntry* diameter = tool.keys.find("diameter");
    const double d = diameter ? *diameter->value.number() : 0;
    if (d > 0 && looks_like_inches(d))
      return fail_at(diameter->value.position,
                     "D{} of tool {} is a usual diameter in inches ({:g} mm), not in mm; the table states no unit: {}",
                     d, tool.number, d * kInchMm, kUnitKey);
    if (speaks_of_inches(tool.name))
      return fail_at({path, 0, 0}, "the remark of tool {} (\"{}\") speaks of inches; the table states no unit: {}",
                     tool.number, printable(tool.name), kUnitKey);
  }
  return Ok{};
}

Result<std::optional<LibraryTool>> read_line(std::string_view line, const std::string& path, int number) {
  const std::size_t remark = line.find(';');
  const std::string_view code = line.substr(0, remark);
  Words words;
  SourcePosition diameter_at, length_at;
  bool any = false;
  for (std::size_t at = 0; at < code.size();) {
    if (std::isspace(static_cast<unsigned char>(code[at]))) {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < code.size() && !std::isspace(static_cast<unsigned char>(code[end]))) ++end;
    const SourcePosition place{path, number, int(at) + 1};
    if (const auto read = read_word(code.substr(at, end - at), place, words); !read) return read.error();
    const char letter = char(std::toupper(static_cast<unsigned char>(code[at])));
    if (letter == 'D') diameter_at = place;
    if (letter == 'Z') length_at = place;
    any = true;
    at = end;
  }
  if (!any) return std::optional<LibraryTool>();
  if (!words.T) return fail_at({path, number, 1}, "a line of a tool table has a T word");
  if (*words.T == 0) return std::optional<LibraryTool>();  // no tool
  if (*words.T < 1 || *words.T > 1e6 || *words.T != std::floor(*words.T))
    return fail_at({path, number, 1}, "T{}: a tool has a whole number above 0", *words.T);
  LibraryTool tool;
  tool.number = int(*words.T);
  if (remark != std::string_view::npos) tool.name = trimmed(line.substr(remark + 1));
  if (words.D && *words.D > 0) add_key(tool, "diameter", *words.D, diameter_at);
  if (words.Z && *words.Z > 0) add_key(tool, "length", *words.Z, length_at);
  else if (words.Z && *words.Z < 0)
    tool.notes.push_back("Z is negative: measured from a reference that is not the gauge line, no length");
  return std::optional(std::move(tool));
}

}  // namespace

Result<std::vector<LibraryTool>> read_linuxcnc_table(const std::string& text, const std::string& path,
                                                     LibraryUnit unit) {
  std::vector<LibraryTool> tools;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    auto line = read_line(std::string_view(text).substr(at, end - at), path, ++number);
    if (!line) return line.error();
    if (*line) tools.push_back(std::move(**line));
    at = end + 1;
  }
  if (tools.empty()) return fail_at({path, 0, 0}, "the tool table has no tool");
  const bool said = unit != LibraryUnit::none;
  const UnitBeside beside = said ? UnitBeside() : unit_beside(path);
  if (!said)
    if (const Status asked = ask_for_inches(tools, beside, path); !asked) return asked.error();
  for (LibraryTool& tool : tools) {
    tool.unit_is_open = !said && beside.file.empty();
    const double mm = unit_of_length(std::nullopt, unit, tool).value_or(1);
    for (toml::TomlEntry& entry : tool.keys.entries) entry.value.data = *entry.value.number() * mm;
  }
  return tools;
}

}  // namespace toothpath::tool_library
