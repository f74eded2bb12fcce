// One flank of a pair under load over a pitch, with what else the job asks of it: of any gear type whose room in
// `geometry` has loaded_cycle, friction_of and root_stress of its pair.
#pragma once

#include <string>

#include "app/process/under_load/loaded_contact.h"

namespace toothpath::under_load {

/// Refused: as loaded_cycle and root_stress of the pair, with the name of the side.
template <typename Pair>
[[nodiscard]] Result<LoadedSide> loaded_side(const Pair& pair, const loaded::Load& carried, int side, std::string name,
                                             const job::ContactLoad& asked) {
  auto cycle = loaded_cycle(pair, carried);
  if (!cycle) return fail("{}: {}", name, cycle.error().message);
  LoadedSide out{side, std::move(name), false, std::move(*cycle)};
  if (asked.friction)
    for (const auto& position : out.cycle.positions)
      out.friction.push_back(friction_of(pair, position, *asked.friction));
  if (asked.root_stress) {
    auto root = root_stress(pair, out.cycle);
    if (!root) return fail("{}: {}", out.name, root.error().message);
    out.root = *root;
  }
  return out;
}

}  // namespace toothpath::under_load
