#include "app/job/words.h"

#include <algorithm>

#include "geometry/base/printable.h"
#include "machines/toml/near_name.h"

namespace toothpath::job {
namespace {

/// A key, not longer than a line.
std::string_view shown(std::string_view key) { return key.substr(0, 60); }

std::string title(const std::string& path) { return path.empty() ? "the job" : "[" + path + "]"; }

const char* type_name(toml::TomlType type) {
  switch (type) {
    case toml::TomlType::boolean: return "a boolean";
    case toml::TomlType::integer: return "a whole number";
    case toml::TomlType::real: return "a number";
    case toml::TomlType::text: return "a string";
    case toml::TomlType::date: return "a date or time";
    case toml::TomlType::array: return "an array";
    case toml::TomlType::table: return "a table";
  }
  return "";
}

class JobWords final : public toml::TableWords {
 public:
  std::string name(const std::string&, std::string_view key) const override { return std::string(key); }

  std::string missing(const std::string& path, std::string_view key) const override {
    return fmt::format("{} lacks the key \"{}\"", title(path), key);
  }

  std::string unknown(const std::string& path, const std::string& key, const KnownKeys& known) const override {
    return fmt::format("unknown key \"{}\" in {}{}", shown(key), title(path), toml::did_you_mean(key, known));
  }

  std::string wrong_type(const std::string& name, toml::TomlType wanted, toml::TomlType found) const override {
    return fmt::format("{} must be {}, not {}", name,
                       wanted == toml::TomlType::boolean ? "true or false" : type_name(wanted), type_name(found));
  }

  std::string no_table(const std::string& path, std::string_view key, bool many, toml::TomlType found) const override {
    const std::string whole = path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
    return many ? fmt::format("{} must be a list of tables [[{}]], not {}", key, whole, type_name(found))
                : fmt::format("{} must be one table [{}], not {}", key, whole, type_name(found));
  }

  std::string not_numbers(const std::string& name, std::size_t count, const toml::TomlValue&) const override {
    return fmt::format("{} must be an array of {} numbers", name, count);
  }

  std::string not_finite(const std::string& name, double number) const override {
    return fmt::format("{} = {} is not a finite number", name, number);
  }

  std::string outside(const std::string& name, double number, const toml::Range& range) const override {
    const bool low = range.open_low ? number <= range.low : number < range.low;
    const double limit = low ? range.low : range.high;
    const bool open = low ? range.open_low : range.open_high;
    const char* relation = low ? (open ? "is not above" : "is below") : (open ? "is not below" : "exceeds");
    return fmt::format("{} = {}{} {} {}{}", name, number, range.unit, relation, limit, range.unit);
  }

  std::string integer_outside(const std::string& name, std::int64_t number, const toml::Range& range) const override {
    return outside(name, static_cast<double>(number), range);
  }

  std::optional<std::string> text_fault(const std::string& name, const std::string& text, bool ascii) const override {
    if (text.empty()) return fmt::format("{} is empty", name);
    if (text.size() > 255) return fmt::format("{} has {} bytes, which exceeds 255", name, text.size());
    if (printable(text) != text) return fmt::format("{} contains a control character", name);
    if (ascii && std::any_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) > 0x7f; }))
      return fmt::format("{} contains a character outside ASCII", name);
    return std::nullopt;
  }

  std::string not_one_of(const std::string& name, const std::string& text,
                         std::span<const std::string_view> words) const override {
    std::string list;
    for (const auto word : words) list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", word);
    return fmt::format("{} = \"{}\" is not one of {}", name, shown(text), list);
  }
};

}  // namespace

const toml::TableWords& job_words() {
  static const JobWords words;
  return words;
}

}  // namespace toothpath::job
