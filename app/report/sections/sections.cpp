#include "app/report/sections/sections.h"

namespace toothpath::sections {

// Each makes one section; without a title it has nothing to say.
#define SECTION(name) report::Section name(const SectionInput& input);
#include "app/report/sections/registry.inl"
#undef SECTION

std::vector<report::Section> sections_of(const SectionInput& input) {
  std::vector<report::Section> out;
#define SECTION(name) \
  if (report::Section section = name(input); !section.title.empty()) out.push_back(std::move(section));
#include "app/report/sections/registry.inl"
#undef SECTION
  return out;
}

}  // namespace toothpath::sections
