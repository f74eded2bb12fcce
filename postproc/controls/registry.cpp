#include "postproc/controls/registry.h"

#include <algorithm>

namespace toothpath::controls {

#define CONTROL(name) [[nodiscard]] Control name();
#include "postproc/controls/registry.inl"
#undef CONTROL

namespace {

/// Every object is made once.
const std::vector<Control>& objects() {
#define CONTROL(name) name(),
  static const std::vector<Control> made = {
#include "postproc/controls/registry.inl"
  };
#undef CONTROL
  return made;
}

}  // namespace

const std::vector<const Control*>& all() {
  static const std::vector<const Control*> list = [] {
    std::vector<const Control*> pointers;
    for (const Control& control : objects()) pointers.push_back(&control);
    return pointers;
  }();
  return list;
}

const Control* find(std::string_view name) {
  for (const Control* control : all())
    if (control->words.name == name ||
        std::find(control->aliases.begin(), control->aliases.end(), name) != control->aliases.end())
      return control;
  return nullptr;
}

std::vector<std::string> names() {
  std::vector<std::string> list;
  for (const Control* control : all()) list.push_back(control->words.name);
  return list;
}

std::string list_of_names() {
  std::string list;
  for (const Control* control : all()) list += (list.empty() ? "" : ", ") + control->words.name;
  return list;
}

std::vector<std::string> program_extensions() {
  std::vector<std::string> extensions;
  for (const Control* control : all())
    if (const std::string& e = control->words.extension;
        std::find(extensions.begin(), extensions.end(), e) == extensions.end())
      extensions.push_back(e);
  return extensions;
}

Result<std::string> probing_text(const probing::ProbeProgram& program, std::string_view dialect) {
  const Control* control = find(dialect);
  if (control != nullptr && control->probe != nullptr) return control->probe(program);
  std::string have;
  for (const Control* c : all())
    if (c->probe != nullptr) have += (have.empty() ? "" : ", ") + c->words.name;
  return fail("dialect = \"{}\" has no words for a probe; these have: {}", dialect, have);
}

}  // namespace toothpath::controls
