// Crownings and reliefs that keep the contact pattern inside the flank over a number of misalignments with the least
// transmission error: a search on ease-off maps.
//
// Removals add to the ease-off, of gear and pinion alike, so a candidate costs a sum of maps and no rolling: at a turn
// of the gear a place stands ease-off + bend/2 (turn - its turn)^2 off its pinion, and the least over all places, teeth
// and rings is the motion curve. What is found is a candidate only; rolling it is the proof. Derivation:
// docs/ease_off.md 4.
#pragma once

#include <vector>

#include "geometry/contact/pattern_place.h"

namespace toothpath::contact {

/// Something that the search may take off.
struct SearchedModification {
  bool on_pinion = false;
  modification::Kind kind = modification::Kind::lead_crowning;
  std::optional<int> zone;         ///< none: all
  bool both_ways = false;          ///< amounts below 0, too
  std::vector<double> lengths_mm;  ///< of reliefs: one of these
  double largest_mm = 1e300;       ///< of its amount, where that is less than that of the search
};

struct SearchOptions {
  double compound_mm = 0.006, margin = 0.05;
  double largest_mm = 0.1;      ///< of an amount
  double unit_mm = 1e-4;        ///< amounts are whole numbers of it
  int rows = 41, columns = 49;  ///< places of a flank
  int steps = 48;               ///< turns a pitch
};

/// Ease-off of one misalignment on a grid of its own, with what each modification adds.
class SearchModel {
 public:
  /// Ease-off as the pair stands, modifications of the drawing and all. Refused: as exact_flank and ease_off.
  [[nodiscard]] static Result<SearchModel> make(const face_gear::FaceGear& gear, int side, int pinion_teeth,
                                                const std::vector<modification::Modification>& on_pinion,
                                                const Misalignment& moved,
                                                const std::vector<SearchedModification>& searched,
                                                const SearchOptions& options);
  struct Judged {
    double error_mm = 0;       ///< peak to peak of the motion curve, as a distance between the flanks
    double margin_gap_mm = 0;  ///< least gap in the margin of any edge
    Edge nearest = Edge::inner_end;
  };
  /// @param amounts_mm, lengths  one a searched modification: its amount, and which of its lengths
  [[nodiscard]] Judged judge(const std::vector<double>& amounts_mm, const std::vector<int>& lengths) const;

 private:
  struct Ring {
    int rows = 0, columns = 0;
    std::vector<double> gap, phi, bend;  ///< column by column, rows rising; NaN: no common normal
    std::vector<std::uint8_t> edges;
    std::vector<std::vector<std::vector<double>>> up, down;  ///< of modification, length: per mm of amount, either way
    std::vector<int> nearest_row;                            ///< of turn k, column c: [k * columns + c]; -1: none
  };
  /// Turns and what each modification takes, of one member.
  [[nodiscard]] static Ring ring_of(const face_gear::FaceGearRing& ring, const ContactMember& member,
                                    const EaseOffMap& map, const std::vector<SearchedModification>& searched,
                                    double margin);
  void place_turns(Ring& ring) const;
  [[nodiscard]] double motion(const Ring& ring, const std::vector<double>& gap, int k) const;

  std::vector<Ring> rings_;
  double start_ = 0, step_ = 0;
  int turns_ = 0, steps_ = 0;
};

struct SearchResult {
  std::vector<int> units;    ///< amount of every searched modification, in SearchOptions::unit_mm
  std::vector<int> lengths;  ///< which of its lengths
  bool inside = false;       ///< the pattern keeps off all edges in every model
  double error_mm = 0;       ///< the greatest of all models
  double margin_gap_mm = 0;  ///< the least of all models
  std::size_t limiting = 0;  ///< the model that has it
  Edge nearest = Edge::inner_end;
  double score = 0;  ///< what the search made least; of the same models and gap only
  long judged = 0;   ///< candidates
};
/// The best over all models of one side: inside first, then the least error. From the best of a coarse lattice, steps
/// to ever smaller ones. The same on any number of threads.
/// @param wanted_gap_mm  that the margins shall keep; above the compound where the model is not trusted
/// @param known  the only start, found for another side; null: the lattice
[[nodiscard]] SearchResult search_modifications(const std::vector<SearchModel>& models,
                                                const std::vector<SearchedModification>& searched, double wanted_gap_mm,
                                                const SearchOptions& options, const SearchResult* known = nullptr);

/// The modification that amount and length of a searched one stand for, on the flanks of one side.
[[nodiscard]] modification::Modification modification_of(const SearchedModification& searched, double amount_mm,
                                                         int length, int side);

}  // namespace toothpath::contact
