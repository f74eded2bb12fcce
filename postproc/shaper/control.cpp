#include "postproc/shaper/control.h"

#include <algorithm>
#include <cassert>

namespace toothpath::shaper {

#define CONTROL(name) [[nodiscard]] ShaperControl name();
#include "postproc/shaper/controls/registry.inl"
#undef CONTROL

namespace {

std::vector<machines::ShaperDialect> dialects_of_list() {
  std::vector<machines::ShaperDialect> dialects;
  for (const ShaperControl& control : shaper_controls()) dialects.push_back(control.dialect);
  return dialects;
}

}  // namespace

const std::vector<ShaperControl>& shaper_controls() {
#define CONTROL(name) name(),
  static const std::vector<ShaperControl> made = {
#include "postproc/shaper/controls/registry.inl"
  };
#undef CONTROL
  return made;
}

const ShaperControl& shaper_control(const machines::ShaperMachine& machine) {
  const auto& all = shaper_controls();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const ShaperControl& c) { return c.dialect.name == machine.dialect; });
  assert(found != all.end());
  return *found;
}

machines::ShaperMachineReading read_shaper_machine(const std::string& path) {
  return machines::read_shaper_machine_file(path, dialects_of_list());
}
machines::ShaperMachineReading read_shaper_machine_of_text(std::string_view text, const std::string& file) {
  return machines::read_shaper_machine_text(text, file, dialects_of_list());
}

std::string shaper_program(const ShaperSetup& setup) { return shaper_control(setup.machine).program(setup); }

}  // namespace toothpath::shaper
