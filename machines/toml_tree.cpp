#include "machines/toml_tree.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <toml++/toml.h>

namespace toothpath {
namespace {

constexpr int kMaxNesting = 16;

SourcePosition position_of(const toml::source_region& region, const std::string& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

/// Copies a node; false when it nests too deeply.
bool copy_node(const toml::node& node, const std::string& file, int depth, TomlValue& out) {
  using Type = TomlValue::Type;
  out.position = position_of(node.source(), file);
  if (depth > kMaxNesting) return false;
  if (const auto* table = node.as_table()) {
    out.type = Type::table;
    for (const auto& [key, value] : *table) {
      TomlEntry entry;
      entry.key = std::string(key.str());
      entry.key_position = position_of(key.source(), file);
      if (!copy_node(value, file, depth + 1, entry.value)) {
        out.position = entry.value.position;
        return false;
      }
      // A table that only its sub-tables name has no place of its own.
      if (entry.value.position.line == 0) entry.value.position = entry.key_position;
      out.entries.push_back(std::move(entry));
    }
    std::stable_sort(out.entries.begin(), out.entries.end(), [](const TomlEntry& a, const TomlEntry& b) {
      return std::pair(a.key_position.line, a.key_position.column) < std::pair(b.key_position.line, b.key_position.column);
    });
  } else if (const auto* array = node.as_array()) {
    out.type = Type::array;
    for (const auto& item : *array) {
      if (!copy_node(item, file, depth + 1, out.items.emplace_back())) {
        const SourcePosition place = out.items.back().position;
        out.position = place;
        return false;
      }
    }
  } else if (const auto* flag = node.as_boolean()) {
    out.type = Type::boolean;
    out.boolean = flag->get();
  } else if (const auto* integer = node.as_integer()) {
    out.type = Type::integer;
    out.integer = integer->get();
    out.real = static_cast<double>(out.integer);
  } else if (const auto* real = node.as_floating_point()) {
    out.type = Type::real;
    out.real = real->get();
  } else if (const auto* text = node.as_string()) {
    out.type = Type::text;
    out.text = text->get();
  } else {
    out.type = Type::date;
  }
  return true;
}

const char* type_name(const TomlValue& value) {
  switch (value.type) {
    case TomlValue::Type::boolean: return "a boolean";
    case TomlValue::Type::integer: return "a whole number";
    case TomlValue::Type::real: return "a number";
    case TomlValue::Type::text: return "a text";
    case TomlValue::Type::array: return "a list";
    case TomlValue::Type::table: return "a table";
    case TomlValue::Type::date: return "a date or time";
  }
  return "unknown";
}

bool is_number(const TomlValue& value) {
  return value.type == TomlValue::Type::integer || value.type == TomlValue::Type::real;
}

void collect_names(const TomlValue& table, const std::string& prefix, std::vector<std::string>& names) {
  for (const TomlEntry& entry : table.entries) {
    const std::string name = prefix + entry.key;
    if (entry.value.type == TomlValue::Type::table)
      collect_names(entry.value, name + ".", names);
    else
      names.push_back(name);
  }
}

}  // namespace

const TomlEntry* TomlValue::find(std::string_view key) const {
  for (const TomlEntry& entry : entries)
    if (entry.key == key) return &entry;
  return nullptr;
}

Result<std::string> read_text_file(const std::string& path) {
  const auto refuse = [&path](std::string why) {
    return Diagnostic{DiagnosticKind::file_access, {path, 0, 0}, std::move(why)};
  };
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) return refuse("file does not exist");
  if (error) return refuse(fmt::format("cannot be opened: {}", error.message()));
  if (status.type() == std::filesystem::file_type::directory) return refuse("is a directory, not a file");
  if (status.type() != std::filesystem::file_type::regular) return refuse("is not a regular file");
  std::ifstream in(path, std::ios::binary);
  if (!in) return refuse("cannot be opened for reading");
  std::string text(kMaxMachineFileBytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) return refuse("cannot be read");
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kMaxMachineFileBytes)
    return refuse(fmt::format("has more than {} bytes, the largest machine file allowed", kMaxMachineFileBytes));
  return text;
}

Result<TomlValue> parse_toml(std::string_view text, const std::string& file) {
  if (const auto nul = text.find('\0'); nul != std::string_view::npos) {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(nul), '\n');
    const auto line_start = text.rfind('\n', nul);
    const auto column = line_start == std::string_view::npos ? nul + 1 : nul - line_start;
    return fail_at({file, static_cast<int>(line), static_cast<int>(column)}, "NUL byte; this is not a text file");
  }
  try {
    const toml::table root = toml::parse(text, std::string_view{file});
    TomlValue tree;
    if (!copy_node(root, file, 0, tree))
      return fail_at(tree.position, "nested deeper than {} levels", kMaxNesting);
    tree.position = {file, 1, 1};
    return tree;
  } catch (const toml::parse_error& error) {
    return fail_at(position_of(error.source(), file), "{}", error.description());
  }
}

std::string TomlTableReader::name(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

SourcePosition TomlTableReader::at(std::string_view key) const {
  const TomlEntry* entry = table_.find(key);
  return entry ? entry->value.position : table_.position;
}

const TomlValue* TomlTableReader::value(std::string_view key) {
  known_.emplace_back(key);
  const TomlEntry* entry = table_.find(key);
  if (!entry) {
    refuse(table_.position, "{} is missing", name(key));
    return nullptr;
  }
  return &entry->value;
}

const std::vector<TomlEntry>& TomlTableReader::entries() {
  for (const TomlEntry& entry : table_.entries) known_.push_back(entry.key);
  return table_.entries;
}

std::optional<double> TomlTableReader::number_in(const TomlValue& v, const std::string& label, const Range& range) {
  if (!is_number(v)) {
    refuse(v.position, "{} must be a number, is {}", label, type_name(v));
    return std::nullopt;
  }
  if (!std::isfinite(v.real)) {
    refuse(v.position, "{} = {} must be finite", label, v.real);
    return std::nullopt;
  }
  const char* space = *range.unit ? " " : "";
  if (v.real < range.low || (range.above_low && v.real == range.low)) {
    refuse(v.position, "{} = {} {} {}{}{}", label, v.real, range.above_low ? "must be above" : "is below", range.low, space,
           range.unit);
    return std::nullopt;
  }
  if (v.real > range.high) {
    refuse(v.position, "{} = {} exceeds {}{}{}", label, v.real, range.high, space, range.unit);
    return std::nullopt;
  }
  return v.real;
}

std::optional<int> TomlTableReader::whole_in(const TomlValue& v, const std::string& label, int low, int high) {
  if (v.type != TomlValue::Type::integer) {
    refuse(v.position, "{} must be a whole number, is {}", label, type_name(v));
    return std::nullopt;
  }
  if (v.integer < low || v.integer > high) {
    if (low == high) refuse(v.position, "{} = {} must be {}", label, v.integer, low);
    else refuse(v.position, "{} = {} is outside {} to {}", label, v.integer, low, high);
    return std::nullopt;
  }
  return static_cast<int>(v.integer);
}

std::optional<std::string> TomlTableReader::text_in(const TomlValue& v, const std::string& label, bool ascii) {
  if (v.type != TomlValue::Type::text) {
    refuse(v.position, "{} must be a text, is {}", label, type_name(v));
    return std::nullopt;
  }
  if (v.text.empty() || v.text.size() > 120) {
    refuse(v.position, "{} has {} characters, allowed are 1 to 120", label, v.text.size());
    return std::nullopt;
  }
  for (const char c : v.text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f || (ascii && byte > 0x7f)) {
      refuse(v.position, "{} contains byte 0x{:02x}; only {} is allowed", label, byte,
             ascii ? "printable ASCII" : "printable text");
      return std::nullopt;
    }
  }
  return v.text;
}

std::optional<double> TomlTableReader::number(std::string_view key, const Range& range) {
  const TomlValue* v = value(key);
  return v ? number_in(*v, name(key), range) : std::nullopt;
}

std::optional<int> TomlTableReader::whole_number(std::string_view key, int low, int high) {
  const TomlValue* v = value(key);
  return v ? whole_in(*v, name(key), low, high) : std::nullopt;
}

int TomlTableReader::sense(std::string_view key) {
  const TomlValue* v = value(key);
  if (!v) return 1;
  if (v->type == TomlValue::Type::integer && (v->integer == 1 || v->integer == -1)) return static_cast<int>(v->integer);
  if (v->type == TomlValue::Type::integer) refuse(v->position, "{} = {} must be 1 or -1", name(key), v->integer);
  else refuse(v->position, "{} must be 1 or -1, is {}", name(key), type_name(*v));
  return 1;
}

std::optional<bool> TomlTableReader::boolean(std::string_view key) {
  const TomlValue* v = value(key);
  if (!v) return std::nullopt;
  if (v->type != TomlValue::Type::boolean) {
    refuse(v->position, "{} must be true or false, is {}", name(key), type_name(*v));
    return std::nullopt;
  }
  return v->boolean;
}

std::optional<std::string> TomlTableReader::text(std::string_view key, bool ascii) {
  const TomlValue* v = value(key);
  return v ? text_in(*v, name(key), ascii) : std::nullopt;
}

std::optional<std::string> TomlTableReader::word(std::string_view key, const std::vector<std::string>& allowed) {
  const auto found = text(key);
  if (!found || std::find(allowed.begin(), allowed.end(), *found) != allowed.end()) return found;
  refuse(at(key), "{} = \"{}\" is not one of {}", name(key), *found, fmt::join(allowed, ", "));
  return std::nullopt;
}

const TomlValue* TomlTableReader::array(std::string_view key) {
  const TomlValue* v = value(key);
  if (v && v->type != TomlValue::Type::array) {
    refuse(v->position, "{} must be a list, is {}", name(key), type_name(*v));
    return nullptr;
  }
  return v;
}

std::optional<Vec3> TomlTableReader::vector(std::string_view key, double largest_mm) {
  const TomlValue* v = array(key);
  if (!v) return std::nullopt;
  if (v->items.size() != 3) {
    refuse(v->position, "{} has {} numbers, must have 3", name(key), v->items.size());
    return std::nullopt;
  }
  Vec3 out = Vec3::Zero();
  bool good = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto x = number_in(v->items[i], fmt::format("{}[{}]", name(key), i), {-largest_mm, largest_mm});
    good = good && x;
    if (x) out[static_cast<Eigen::Index>(i)] = *x;
  }
  return good ? std::optional(out) : std::nullopt;
}

std::optional<std::vector<double>> TomlTableReader::numbers(std::string_view key, const Range& range) {
  const TomlValue* v = array(key);
  if (!v) return std::nullopt;
  std::vector<double> out;
  for (std::size_t i = 0; i < v->items.size(); ++i)
    if (const auto x = number_in(v->items[i], fmt::format("{}[{}]", name(key), i), range)) out.push_back(*x);
  return out.size() == v->items.size() ? std::optional(out) : std::nullopt;
}

std::optional<std::vector<int>> TomlTableReader::whole_numbers(std::string_view key, int low, int high) {
  const TomlValue* v = array(key);
  if (!v) return std::nullopt;
  std::vector<int> out;
  for (std::size_t i = 0; i < v->items.size(); ++i)
    if (const auto n = whole_in(v->items[i], fmt::format("{}[{}]", name(key), i), low, high)) out.push_back(*n);
  return out.size() == v->items.size() ? std::optional(out) : std::nullopt;
}

std::optional<std::vector<std::string>> TomlTableReader::texts(std::string_view key) {
  const TomlValue* v = array(key);
  if (!v) return std::nullopt;
  std::vector<std::string> out;
  for (std::size_t i = 0; i < v->items.size(); ++i)
    if (auto t = text_in(v->items[i], fmt::format("{}[{}]", name(key), i), true)) out.push_back(std::move(*t));
  return out.size() == v->items.size() ? std::optional(out) : std::nullopt;
}

std::optional<TomlTableReader> TomlTableReader::table(std::string_view key) {
  const TomlValue* v = value(key);
  if (!v) return std::nullopt;
  if (v->type != TomlValue::Type::table) {
    refuse(v->position, "{} must be a table, is {}", name(key), type_name(*v));
    return std::nullopt;
  }
  return TomlTableReader(*v, name(key), errors_);
}

void TomlTableReader::refuse_unknown_keys() {
  for (const TomlEntry& entry : table_.entries)
    if (std::find(known_.begin(), known_.end(), entry.key) == known_.end())
      refuse(entry.key_position, "unknown key {}", name(entry.key));
}

void sort_by_position(std::vector<Diagnostic>& errors) {
  std::stable_sort(errors.begin(), errors.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::pair(a.position.line, a.position.column) < std::pair(b.position.line, b.position.column);
  });
}

std::vector<std::string> value_names(const TomlValue& root) {
  std::vector<std::string> names;
  collect_names(root, "", names);
  std::erase_if(names, [](const std::string& n) {
    return n == "schema" || n == "name" || n == "kind" || n == "assumed";
  });
  return names;
}

std::vector<std::string> read_assumed(TomlTableReader& root, const TomlValue& tree) {
  const TomlValue* v = root.value("assumed");
  if (!v) return {};
  const std::vector<std::string> all = value_names(tree);
  if (v->type == TomlValue::Type::boolean) return v->boolean ? all : std::vector<std::string>{};
  if (v->type != TomlValue::Type::array) {
    root.refuse(v->position, "assumed must be true, false or a list of key names, is {}", type_name(*v));
    return {};
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < v->items.size(); ++i) {
    const TomlValue& item = v->items[i];
    if (item.type != TomlValue::Type::text) {
      root.refuse(item.position, "assumed[{}] must be a text, is {}", i, type_name(item));
      continue;
    }
    const bool exists = std::any_of(all.begin(), all.end(), [&item](const std::string& n) {
      return n == item.text || n.starts_with(item.text + ".");
    });
    if (exists) names.push_back(item.text);
    else root.refuse(item.position, "assumed names \"{}\", which this file does not have", item.text);
  }
  return names;
}

}  // namespace toothpath
