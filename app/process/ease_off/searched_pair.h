// What tables, search and proof ask of a pair, whatever its gears: the one place where they meet a gear type. Each has
// its own in its room.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "app/process/ease_off/misalignment_table.h"
#include "app/process/gear_of_job.h"
#include "geometry/contact/modification_search.h"

namespace toothpath::ease_off {

/// Modifications beside those that the pair has.
struct FoundModifications {
  std::vector<modification::Modification> on_gear, on_pinion;
};

/// Where the modifications of a member stand as keys.
struct KeyTable {
  std::string table;      ///< "gear", "contact"
  bool in_job = true;     ///< of the job that was asked
  std::string file = {};  ///< else: whose, in words
};

class SearchedPair {
 public:
  virtual ~SearchedPair() = default;

  [[nodiscard]] virtual const PairWords& words() const = 0;
  [[nodiscard]] virtual KeyTable keys_of(bool on_pinion) const = 0;
  /// Lever of its transmission error in the tables, and in the model of its search. mm
  [[nodiscard]] virtual double pitch_radius_mm() const = 0;
  [[nodiscard]] virtual double motion_lever_mm() const = 0;

  /// What may be taken, with the lengths that reliefs may have.
  [[nodiscard]] virtual std::vector<contact::SearchedModification> searched() const = 0;
  /// Twice the addendum.
  [[nodiscard]] virtual double depth_mm() const = 0;
  /// Grid and steps of its models.
  [[nodiscard]] virtual contact::SearchOptions model_size() const = 0;
  /// One tool makes something of both sides: they are searched together.
  [[nodiscard]] virtual bool sides_share() const = 0;
  /// Side 0 or 1 as modifications call it: right is +1.
  [[nodiscard]] virtual int side_of(std::size_t side) const = 0;
  [[nodiscard]] virtual Result<contact::SearchModel> model(std::size_t side, const contact::Misalignment& moved,
                                                           const std::vector<contact::SearchedModification>& searched,
                                                           const contact::SearchOptions& options) const = 0;

  /// What its gears refuse of these modifications, each with its place in the job; empty: they are made.
  [[nodiscard]] virtual std::vector<Diagnostic> refused(const FoundModifications& with) const = 0;
  /// The pair with these modifications, rolled at each of these places. Refused: modifications that its gears refuse; a
  /// pair that does not meet there, each with its place in the job.
  [[nodiscard]] virtual process::ValueOrErrors<std::vector<MisalignmentRow>> rolled(
      const FoundModifications& with, const std::vector<NamedMisalignment>& list, double margin) const = 0;
};

}  // namespace toothpath::ease_off
