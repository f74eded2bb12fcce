#include "app/process/ease_off/refused_amount.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace toothpath::ease_off {

FoundModifications lists_of(const std::vector<OfMember>& list) {
  FoundModifications out;
  for (const OfMember& of : list)
    if (of.modification.amount_mm != 0) (of.on_pinion ? out.on_pinion : out.on_gear).push_back(of.modification);
  return out;
}

std::string amount_text(const OfMember& of) {
  const auto& m = of.modification;
  std::string text =
      fmt::format("{} {:.4f} mm of the {}", to_string(m.kind), m.amount_mm, of.on_pinion ? "pinion" : "gear");
  if (m.flanks != modification::Flanks::both) text += fmt::format(", flank {}", to_string(m.flanks));
  if (m.zone) text += fmt::format(", zone {}", *m.zone);
  return text;
}

std::optional<RefusedAmount> refused_amount(const SearchedPair& pair, const std::vector<OfMember>& list,
                                            double step_mm) {
  const double steps_a_mm = std::round(1 / step_mm);
  auto order = list;
  std::stable_sort(order.begin(), order.end(), [](const OfMember& a, const OfMember& b) {
    return std::abs(a.modification.amount_mm) > std::abs(b.modification.amount_mm);
  });
  for (const OfMember& largest : order) {
    const auto refusals = [&](long steps) {
      auto held = list;
      for (OfMember& of : held) {
        double& amount = of.modification.amount_mm;
        if (of.number == largest.number)
          amount = std::copysign(std::min(std::abs(amount), double(steps) / steps_a_mm), amount);
      }
      return pair.refused(lists_of(held));
    };
    long made = 0, refused = std::lround(std::abs(largest.modification.amount_mm) * steps_a_mm);
    if (refused == 0 || !refusals(0).empty()) continue;
    while (refused - made > 1) {
      const long middle = (made + refused) / 2;
      (refusals(middle).empty() ? made : refused) = middle;
    }
    const auto why = refusals(refused);
    return RefusedAmount{largest, double(made) / steps_a_mm, why.empty() ? "" : why.front().message};
  }
  return std::nullopt;
}

}  // namespace toothpath::ease_off
