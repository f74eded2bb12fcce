#include "machines/machine_table.h"

#include <algorithm>
#include <filesystem>

#include "geometry/base/printable.h"
#include "machines/toml/near_name.h"
#include "machines/toml/regular_file.h"

namespace toothpath::machines {
namespace {

const char* type_name(toml::TomlType type) {
  switch (type) {
    case toml::TomlType::boolean: return "a boolean";
    case toml::TomlType::integer: return "a whole number";
    case toml::TomlType::real: return "a number";
    case toml::TomlType::text: return "a text";
    case toml::TomlType::date: return "a date or time";
    case toml::TomlType::array: return "a list";
    case toml::TomlType::table: return "a table";
  }
  return "";
}

class MachineWords final : public toml::TableWords {
 public:
  std::string name(const std::string& path, std::string_view key) const override {
    return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
  }

  std::string missing(const std::string& path, std::string_view key) const override {
    return fmt::format("{} is missing", name(path, key));
  }

  std::string unknown(const std::string& path, const std::string& key, const KnownKeys& known) const override {
    const std::string_view near = toml::near_name(key, known);
    const std::string hint = near.empty() ? "" : fmt::format("; did you mean {}?", near);
    return fmt::format("unknown key {}{}", name(path, key), hint);
  }

  std::string wrong_type(const std::string& name, toml::TomlType wanted, toml::TomlType found) const override {
    return fmt::format("{} must be {}, is {}", name,
                       wanted == toml::TomlType::boolean ? "true or false" : type_name(wanted), type_name(found));
  }

  std::string no_table(const std::string& path, std::string_view key, bool many, toml::TomlType found) const override {
    return wrong_type(name(path, key), many ? toml::TomlType::array : toml::TomlType::table, found);
  }

  std::string not_numbers(const std::string& name, std::size_t count, const toml::TomlValue& found) const override {
    const toml::TomlArray* array = found.array();
    if (!array) return wrong_type(name, toml::TomlType::array, found.type());
    return fmt::format("{} has {} numbers, must have {}", name, array->values.size(), count);
  }

  std::string not_finite(const std::string& name, double number) const override {
    return fmt::format("{} = {} must be finite", name, number);
  }

  std::string outside(const std::string& name, double number, const toml::Range& range) const override {
    if (number > range.high) return fmt::format("{} = {} exceeds {}{}", name, number, range.high, range.unit);
    return fmt::format("{} = {} {} {}{}", name, number, range.open_low ? "must be above" : "is below", range.low,
                       range.unit);
  }

  std::string integer_outside(const std::string& name, std::int64_t number, const toml::Range& range) const override {
    if (range.low == range.high) return fmt::format("{} = {} must be {}", name, number, range.low);
    return fmt::format("{} = {} is outside {} to {}", name, number, range.low, range.high);
  }

  std::optional<std::string> text_fault(const std::string& name, const std::string& text, bool ascii) const override {
    if (text.empty() || text.size() > 120)
      return fmt::format("{} has {} characters, allowed are 1 to 120", name, text.size());
    for (const char c : text) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte < 0x20 || byte == 0x7f || (ascii && byte > 0x7f))
        return fmt::format("{} contains byte 0x{:02x}; only {} is allowed", name, byte,
                           ascii ? "printable ASCII" : "printable text");
    }
    if (const std::string shown = printable(text); shown != text)
      return fmt::format("{} = \"{}\" contains a character that is no printable text", name, shown);
    return std::nullopt;
  }

  std::string not_one_of(const std::string& name, const std::string& text,
                         std::span<const std::string_view> words) const override {
    return fmt::format("{} = \"{}\" is not one of {}", name, text, fmt::join(words, ", "));
  }
};

/// Dotted names of all values below a table.
void collect_names(const toml::TomlTable& table, const std::string& prefix, std::vector<std::string>& names) {
  for (const toml::TomlEntry& entry : table.entries) {
    const std::string name = prefix + entry.key;
    if (const toml::TomlTable* inner = entry.value.table()) collect_names(*inner, name + ".", names);
    else names.push_back(name);
  }
}

}  // namespace

Result<std::string> read_machine_bytes(const std::string& path) {
  const auto refuse = [&path](std::string why) {
    return Diagnostic{DiagnosticKind::file_access, {path, 0, 0}, std::move(why)};
  };
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) return refuse("file does not exist");
  if (error) return refuse(fmt::format("cannot be opened: {}", error.message()));
  if (status.type() == std::filesystem::file_type::directory) return refuse("is a directory, not a file");
  if (status.type() != std::filesystem::file_type::regular) return refuse("is not a regular file");
  auto text = toml::read_input_file(path, kMaxMachineFileBytes);
  if (!text && text.error().kind == DiagnosticKind::file_access) return refuse("cannot be opened for reading");
  return text;
}

Result<toml::TomlValue> parse_machine_toml(std::string_view text, const std::string& file) {
  return toml::parse_toml(text, file, {});
}

const toml::TableWords& machine_words() {
  static const MachineWords words;
  return words;
}

int read_sense(toml::TableReader& table, std::string_view key, toml::Presence presence) {
  toml::ValueShape senses{toml::ValueKind::integer};
  senses.choices = {1, -1};
  const toml::TomlValue* value =
      presence == toml::Presence::required ? table.required(key, {senses}) : table.value(key, {senses});
  if (!value) return 1;
  const auto* sense = std::get_if<std::int64_t>(&value->data);
  if (sense && (*sense == 1 || *sense == -1)) return static_cast<int>(*sense);
  if (sense) table.refuse(key, "{} = {} must be 1 or -1", table.name(key), *sense);
  else table.refuse(key, "{} must be 1 or -1, is {}", table.name(key), type_name(value->type()));
  return 1;
}

std::optional<Vec3> read_vector(toml::TableReader& table, std::string_view key, double largest_mm, const char* unit) {
  const auto xyz = table.numbers(key, 3, {-largest_mm, largest_mm, unit});
  return xyz ? std::optional(Vec3((*xyz)[0], (*xyz)[1], (*xyz)[2])) : std::nullopt;
}

std::optional<std::string> read_kind(toml::TableReader& root) {
  return root.word("kind", {"five_axis", "gear_shaper"});
}

std::vector<std::string> read_assumed(toml::TableReader& root, const toml::TomlValue& tree) {
  const toml::TomlValue* value = root.required("assumed", {{toml::ValueKind::boolean}, {toml::ValueKind::texts}});
  if (!value) return {};
  std::vector<std::string> all;
  collect_names(*tree.table(), "", all);
  std::erase_if(all,
                [](const std::string& n) { return n == "schema" || n == "name" || n == "kind" || n == "assumed"; });
  if (const auto* every = std::get_if<bool>(&value->data)) return *every ? all : std::vector<std::string>{};
  const toml::TomlArray* list = value->array();
  if (!list) {
    root.refuse("assumed", "assumed must be true, false or a list of key names, is {}", type_name(value->type()));
    return {};
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < list->values.size(); ++i) {
    const toml::TomlValue& item = list->values[i];
    const std::string* text = item.text();
    if (!text) {
      root.refuse_at(item.position, "assumed[{}] must be a text, is {}", i, type_name(item.type()));
      continue;
    }
    const bool exists = std::any_of(all.begin(), all.end(),
                                    [text](const std::string& n) { return n == *text || n.starts_with(*text + "."); });
    if (exists) names.push_back(*text);
    else root.refuse_at(item.position, "assumed names \"{}\", which this file does not have", *text);
  }
  return names;
}

}  // namespace toothpath::machines
