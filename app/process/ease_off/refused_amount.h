// Which of the modifications that a search came to its gears refuse, and how far it may go.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/process/ease_off/searched_pair.h"

namespace toothpath::ease_off {

/// A modification with the member that has it.
struct OfMember {
  modification::Modification modification;
  bool on_pinion = false;
  std::size_t number = 0;  ///< of what was searched; one number may stand for an amount on each flank
};

/// Amounts of one number that a gear refuses beside the others.
struct RefusedAmount {
  OfMember largest;          ///< of that number, as it was asked for
  double limit_mm = 0;       ///< the greatest amount of that number that is made beside the others, of either sign
  std::string message = {};  ///< of the gear, for one step more
};

/// The largest amount without whose number all others are made, its limit found by halving. Nothing where no single
/// number is to blame.
/// @param list  what the pair refuses  @param step_mm  of amounts
[[nodiscard]] std::optional<RefusedAmount> refused_amount(const SearchedPair& pair, const std::vector<OfMember>& list,
                                                          double step_mm);

/// "lead_crowning 0.0430 mm of the gear, flank right".
[[nodiscard]] std::string amount_text(const OfMember& of);

/// In the lists of gear and pinion, those of 0 left out.
[[nodiscard]] FoundModifications lists_of(const std::vector<OfMember>& list);

}  // namespace toothpath::ease_off
