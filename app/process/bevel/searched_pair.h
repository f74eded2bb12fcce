// A bevel pair, as the tables and the search of ease_off ask for it.
#pragma once

#include <memory>
#include <string>

#include "app/process/ease_off/searched_pair.h"
#include "geometry/contact/bevel_contact.h"

namespace toothpath::bevel {

/// How tables and maps call the walls of a bevel pair: side 0 is wall L, side 1 wall U.
extern const ease_off::PairWords kBevelWords;
[[nodiscard]] constexpr int sigma_of(std::size_t side) { return side == 0 ? 1 : -1; }

struct BevelPairAsked {
  const job::Job* job = nullptr;
  const bevel_gear::BevelGear *gear = nullptr, *mate = nullptr;  ///< of the job, and what it runs with
  std::string mate_file;                                         ///< empty: by the rules of the pair
  job::ContactSettings settings;
  std::string modify = "pinion";  ///< "gear" (the wheel), "pinion" or "both"
  contact::BevelContactOptions roll;

  [[nodiscard]] bool job_is_pinion() const { return gear->parameters().teeth <= mate->parameters().teeth; }
  [[nodiscard]] const bevel_gear::BevelGear& pinion() const { return job_is_pinion() ? *gear : *mate; }
  [[nodiscard]] const bevel_gear::BevelGear& wheel() const { return job_is_pinion() ? *mate : *gear; }
  /// The member that the job makes, as --modify says it.
  [[nodiscard]] const char* own() const { return job_is_pinion() ? "pinion" : "gear"; }
};
/// What `asked` points at must outlive it.
[[nodiscard]] std::unique_ptr<ease_off::SearchedPair> searched_pair(const BevelPairAsked& asked);

}  // namespace toothpath::bevel
