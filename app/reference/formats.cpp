#include "app/reference/formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "app/job/file.h"
#include "app/job/words.h"
#include "machines/machine_file.h"
#include "postproc/controls/registry.h"
#include "postproc/shaper/control.h"

namespace toothpath::reference {
namespace {

toml::TomlValue start_of(const std::string& text) {
  auto tree = toml::parse_toml(text, "start", job::kJobSyntax);
  if (!tree) throw std::logic_error(tree.error().text());
  return std::move(tree).value();
}

/// The names of the controls are known to their registry alone.
void set_words(Reference& reference, const char* name, const std::vector<std::string>& words) {
  for (Table& table : reference.tables)
    for (Key& key : table.keys)
      if (table.name.empty() && key.name == name)
        for (KeyForm& form : key.forms) form.shapes.front().words = words;
}

}  // namespace

bool stands_for(std::string_view pattern, std::string_view key) {
  const auto cut = [](std::string_view& text) {
    const std::string_view part = text.substr(0, text.find('.'));
    text.remove_prefix(std::min(part.size() + 1, text.size()));
    return part;
  };
  while (!pattern.empty() && !key.empty()) {
    const std::string_view wanted = cut(pattern), part = cut(key);
    if (wanted != "*" && wanted != part) return false;
  }
  return pattern.empty() && key.empty();
}

std::string Format::meaning(const std::string& key) const {
  for (const Meaning& meaning : meanings)
    if (stands_for(meaning.key, key)) return meaning.text;
  return {};
}

namespace {

Format format_of(Ask ask, const std::vector<toml::TomlValue>& starts, std::span<const Meaning> meanings,
                 int most_others = kMostOthers) {
  Reference reference = survey(ask, starts, most_others);
  return {std::move(ask), std::move(reference), meanings};
}

}  // namespace

Format job_format(int most_others) {
  const Ask ask = [](const toml::TomlValue& document, toml::KeyNotes& notes) {
    return job::note_job_keys(document, "job.toml", notes);
  };
  // Which heights of a scallop are asked for depends on the regions.
  return format_of(ask,
                   {start_of(""), start_of("[gear]\n[[operation]]\nregions = [\"flank\"]"),
                    start_of("[gear]\n[[operation]]\nregions = [\"root\"]")},
                   job_meanings(), most_others);
}

Format milling_machine_format() {
  // Every rotary once in the table and once in the head, and once counted without end.
  std::vector<toml::TomlValue> starts;
  for (const auto& [table, head] : {std::pair('A', 'B'), {'B', 'C'}, {'C', 'A'}})
    for (const bool endless : {false, true})
      starts.push_back(start_of(fmt::format(
          "chain = {{ table = [\"{0}\"], head = [\"{1}\"] }}\naxes = {{ {0} = {{ {2} }}, {1} = {{ {2} }} }}", table,
          head, fmt::format("rollover = {}", endless))));
  Format format = format_of(machines::note_machine_keys, starts, machine_meanings());
  std::vector<std::string> names;
  for (const controls::Control* control : controls::all()) {
    names.push_back(control->words.name);
    names.insert(names.end(), control->aliases.begin(), control->aliases.end());
  }
  set_words(format.reference, "dialect", names);
  return format;
}

Format gear_shaper_format() {
  std::vector<machines::ShaperDialect> dialects;
  for (const shaper::ShaperControl& control : shaper::shaper_controls()) dialects.push_back(control.dialect);
  const Ask ask = [dialects](const toml::TomlValue& document, toml::KeyNotes& notes) {
    return machines::note_shaper_keys(document, dialects, notes);
  };
  return format_of(ask, {start_of("kind = \"gear_shaper\"")}, machine_meanings());
}

}  // namespace toothpath::reference
