#include "app/reference/markdown.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace toothpath::reference {
namespace {

using toml::ValueKind;
using toml::ValueShape;

/// Without an exponent: "0.00001", "1000000".
std::string plain(double x) {
  std::string text = fmt::format("{:.7f}", x);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string range_text(const toml::Range& range) {
  const std::string low = (range.open_low ? "above " : "") + plain(range.low);
  const std::string high = (range.open_high ? "below " : "") + plain(range.high);
  if (range.low == range.high) return plain(range.low) + range.unit;
  return fmt::format("{}{} {}{}", low, range.open_low ? "," : "", range.open_low ? "at most " + high : "to " + high,
                     range.unit);
}

std::string word_list(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += fmt::format("{}`\"{}\"`", list.empty() ? "" : ", ", word);
  return list;
}

std::string count_text(const toml::Count& count) {
  if (count.least == count.most) return fmt::format("{} ", count.least);
  if (count.most == SIZE_MAX) return count.least > 0 ? fmt::format("{} or more ", count.least) : "";
  return fmt::format("{} to {} ", count.least, count.most);
}

std::string rows_text(const ValueShape& shape) {
  std::string columns;
  for (std::size_t i = 0; i < shape.columns.size(); ++i)
    columns += fmt::format("{}{} ({})", i == 0 ? "" : ", ", shape.columns[i], range_text(shape.ranges[i]));
  return fmt::format("{}rows `[{}]`: {}", count_text(shape.count), fmt::join(shape.columns, ", "), columns);
}

std::string shapes_text(const std::vector<ValueShape>& shapes) {
  std::string text;
  for (const ValueShape& shape : shapes) text += (text.empty() ? "" : "; or ") + value_text(shape);
  return text;
}

std::string condition_text(const std::string& table, const Condition& condition) {
  std::string key = condition.key;
  const std::string prefix = table.empty() ? "" : table + ".";
  if (key.starts_with(prefix)) key.erase(0, prefix.size());
  return fmt::format("{} = {}", key, word_list(condition.words));
}

/// Sorted: tables with the same keys are told once, in whatever order they are asked for.
std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  std::sort(lines.begin(), lines.end());
  return lines;
}

/// The key on whose words the others of a table depend: the first that decides on any.
const Key* type_key(const Table& table) {
  for (const Key& key : table.keys)
    if (key.decides)
      for (const Key& other : table.keys)
        for (const KeyForm& form : other.forms)
          for (const Condition& c : form.when)
            if (c.key == dotted(table.name, key.name)) return &key;
  return nullptr;
}

std::vector<std::string> words_of(const Key& key) {
  std::vector<std::string> words;
  for (const KeyForm& form : key.forms)
    for (const ValueShape& shape : form.shapes)
      for (const std::string& word : shape.words)
        if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
  return words;
}

const Condition* on(const KeyForm& form, const std::string& key) {
  const auto found = std::find_if(form.when.begin(), form.when.end(), [&](const Condition& c) { return c.key == key; });
  return found == form.when.end() ? nullptr : &*found;
}

class Page {
 public:
  explicit Page(const Format& format) : format_(format) {}

  [[nodiscard]] std::string sections() {
    const auto& tables = format_.reference.tables;
    std::vector<bool> told(tables.size());
    for (std::size_t i = 0; i < tables.size(); ++i) {
      if (told[i]) continue;
      const std::string body = body_of(tables[i]);
      std::string titles = title_of(tables[i]), meaning = format_.meaning(tables[i].name);
      for (std::size_t j = i + 1; j < tables.size(); ++j)
        if (!tables[i].name.empty() && lines_of(body_of(tables[j])) == lines_of(body)) {
          told[j] = true;
          titles += ", " + title_of(tables[j]);
          meaning.clear();
        }
      out_ += fmt::format("\n## {}\n\n{}{}{}", titles, meaning, meaning.empty() ? "" : "\n\n", body);
    }
    return out_;
  }

 private:
  [[nodiscard]] std::string title_of(const Table& table) const {
    if (table.name.empty()) return "The file itself";
    const auto dot = table.name.rfind('.');
    const Table* above = format_.reference.find(dot == std::string::npos ? "" : table.name.substr(0, dot));
    const Key* key = above ? above->find(table.name.substr(dot == std::string::npos ? 0 : dot + 1)) : nullptr;
    const bool many = key && key->forms.front().shapes.front().kind == ValueKind::tables;
    return fmt::format("{}{}{}", many ? "`[[" : "`[", table.name, many ? "]]`" : "]`");
  }

  [[nodiscard]] std::string row(const Table& table, const Key& key, const KeyForm& form,
                                const std::string& type) const {
    std::string when;
    for (const Condition& c : form.when)
      if (c.key != type) when += fmt::format("{}{}", when.empty() ? "" : " and ", condition_text(table.name, c));
    const std::string absent = form.required         ? "required"
                               : form.absent.empty() ? "may be left out"
                                                     : fmt::format("`{}`", form.absent);
    return fmt::format("| `{}` | {} | {}{}{} | {} |\n", key.name, shapes_text(form.shapes), absent,
                       when.empty() ? "" : ", with ", when, format_.meaning(dotted(table.name, key.name)));
  }

  [[nodiscard]] std::string rows(const std::vector<std::string>& rows) const {
    if (rows.empty()) return "";
    return fmt::format("| key | value | left out | meaning |\n|---|---|---|---|\n{}", fmt::join(rows, ""));
  }

  [[nodiscard]] std::string relations(const Table& table) const {
    std::string text;
    for (const Relation& r : table.relations) {
      const char* words = "";
      switch (r.relation.kind) {
        case toml::KeyRelation::Kind::one_of: words = "Exactly one of `{}` and `{}`"; break;
        case toml::KeyRelation::Kind::together: words = "`{}` and `{}` stand together or not at all"; break;
        case toml::KeyRelation::Kind::needs: words = "`{}` needs `{}`"; break;
        case toml::KeyRelation::Kind::excludes: words = "`{}` and `{}` contradict each other"; break;
        case toml::KeyRelation::Kind::supplies:
          words = "Where `{}` is there, the file that it names may say every other key but `{}`";
          break;
      }
      std::string when;
      for (const Condition& c : r.when)
        when += fmt::format("{}{}", when.empty() ? ", with " : " and ", condition_text(table.name, c));
      text += fmt::format("- {}{}.\n", fmt::format(fmt::runtime(words), r.relation.first, r.relation.second), when);
    }
    return text.empty() ? text : "\n" + text;
  }

  [[nodiscard]] std::string body_of(const Table& table) const {
    const Key* type = type_key(table);
    const std::string decides = type ? dotted(table.name, type->name) : "";
    std::vector<std::string> common;
    for (const Key& key : table.keys)
      for (const KeyForm& form : key.forms)
        if (!type || !on(form, decides)) common.push_back(row(table, key, form, ""));
    std::string text = rows(common);
    if (type)
      for (const std::string& word : words_of(*type)) {
        std::vector<std::string> own;
        for (const Key& key : table.keys)
          for (const KeyForm& form : key.forms)
            if (const Condition* c = on(form, decides);
                c && std::find(c->words.begin(), c->words.end(), word) != c->words.end())
              own.push_back(row(table, key, form, decides));
        text += own.empty() ? fmt::format("\n`{} = \"{}\"` has no other keys.\n", type->name, word)
                            : fmt::format("\nWith `{} = \"{}\"`:\n\n{}", type->name, word, rows(own));
      }
    return text + relations(table);
  }

  const Format& format_;
  std::string out_;
};

constexpr const char* kHowToUse =
    "Made from the reader itself by `toothpath reference {0} --markdown`; a test compares. Lengths are in mm, angles "
    "in "
    "degrees, feeds in mm/min, speeds in 1/min, unless the value says otherwise.\n\n"
    "Editors with a TOML language server complete and check the keys while one writes, when the first line of the file "
    "names the schema ([{0}.schema.json](schema/{0}.schema.json), or what `toothpath reference {0} --schema` "
    "prints):\n\n"
    "    #:schema PATH/{0}.schema.json\n\n"
    "The schema knows each key by itself and which keys belong together; what follows from several numbers (undercut, "
    "a stick-out beyond the length) only the program knows.\n";

}  // namespace

std::string value_text(const ValueShape& shape) {
  switch (shape.kind) {
    case ValueKind::boolean: return "`true` or `false`";
    case ValueKind::integer:
      if (!shape.choices.empty()) return fmt::format("{}", fmt::join(shape.choices, " or "));
      return "whole number, " + range_text(shape.ranges.front());
    case ValueKind::number: return range_text(shape.ranges.front());
    case ValueKind::text:
      if (!shape.words.empty()) return word_list(shape.words);
      return shape.pattern.empty() ? "text" : fmt::format("text `{}`", shape.pattern);
    case ValueKind::integers:
      return fmt::format("list of {}whole numbers, {}", count_text(shape.count), range_text(shape.ranges.front()));
    case ValueKind::numbers:
      return fmt::format("list of {}numbers, {}", count_text(shape.count), range_text(shape.ranges.front()));
    case ValueKind::texts:
      return fmt::format("list of {}texts{}{}", count_text(shape.count), shape.words.empty() ? "" : ": ",
                         word_list(shape.words));
    case ValueKind::rows: return rows_text(shape);
    case ValueKind::tables: return fmt::format("{}tables", count_text(shape.count));
    case ValueKind::table: return "table";
  }
  return "";
}

std::string markdown_sections(const Format& format) { return Page(format).sections(); }

std::string job_markdown() {
  return "# All keys of a job\n\n" + fmt::format(fmt::runtime(kHowToUse), "job") + markdown_sections(job_format());
}

std::string machine_markdown() {
  return "# All keys of a machine file\n\n" + fmt::format(fmt::runtime(kHowToUse), "machine") +
         "\n# Milling machines\n\n`kind = \"five_axis\"`.\n" + markdown_sections(milling_machine_format()) +
         "\n# Gear shapers\n\n`kind = \"gear_shaper\"`.\n" + markdown_sections(gear_shaper_format());
}

}  // namespace toothpath::reference
