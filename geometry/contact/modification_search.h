// Crownings and reliefs that keep the contact pattern inside the flank over a number of misalignments with the least
// transmission error: a search on ease-off maps.
//
// Removals add to the ease-off, of gear and pinion alike, so a candidate costs a sum of maps and no rolling: at a turn
// of the gear a place stands ease-off + bend/2 (turn - its turn)^2 off its pinion, and the least over all places, teeth
// and rings is the motion curve. What is found is a candidate only; rolling it is the proof. Derivation:
// docs/ease_off.md 4. Which gears they are the search does not know: a model is made of a face gear here, of a bevel
// pair in bevel_search_model.h.
#pragma once

#include <algorithm>
#include <functional>
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
  /// Of one side of the teeth alone, +1 or -1; 0: of the sides that are searched, alike.
  int side = 0;
  /// The search also starts at several times the compound: of flanks that are that far from conjugate.
  bool from_far = false;
};

struct SearchOptions {
  double compound_mm = 0.006, margin = 0.05;
  double largest_mm = 0.1;      ///< of an amount
  double unit_mm = 1e-4;        ///< amounts are whole numbers of it
  int rows = 41, columns = 49;  ///< places of a flank
  int steps = 48;               ///< turns a pitch
  /// Errors of one side are nearly equal if they differ by no more than this, or than this share of the lesser one; of
  /// nearly equal ones the least removal counts.
  double nearly_equal_mm = 1e-4, nearly_equal_share = 0.05;
  [[nodiscard]] double nearly_equal_to(double error_mm) const {
    return error_mm + std::max(nearly_equal_mm, nearly_equal_share * error_mm);
  }
};

/// Ease-off of one flank on a grid, with what each modification takes; lists column by column, rows rising.
struct SearchFlank {
  int rows = 0, columns = 0;
  std::vector<double> gap, phi, bend;  ///< NaN: no common normal. Gaps and bends as motion: divided by `per_motion`
  std::vector<std::size_t> unmet;      ///< places without a common normal
  std::vector<double> per_motion;      ///< distance per unit of motion; empty: 1 everywhere
  /// The places within the margin of an edge, and where lines of the grid cross its bound.
  std::vector<MarginBound> in_margins;
  /// What a mm of an amount takes from every place, as motion: with the turn at which the place is nearest, and how
  /// that changes as the mated place moves on over the gear's turn; slope and bend empty where it stays.
  struct Taken {
    std::vector<double> value, slope, bend;
  };
  std::vector<std::vector<Taken>> up,
      down;                      ///< of modification, length, either way; empty where it meets another flank
  int reach = 2;                 ///< rows either way of the nearest one that may touch
  std::vector<int> nearest_row;  ///< of turn k, column c: [k * columns + c]; -1: none. Filled in by the model

  /// From a map. @param margins  of its places, in the map's order
  SearchFlank(int rows_of_map, int columns_of_map, const EaseOffMap& map, const std::vector<BeyondMargins>& margins,
              double motion_lever);
  /// Removal along the normal by one modification [mm] at every place of the map, row by row, on gear or pinion; `when`
  /// -1, 0, 1: a step of the gear's turn before the place is nearest, then, and after.
  using Removal = std::function<std::vector<double>(const modification::Modification&, bool on_pinion, int when)>;
  /// Adds what each of `searched` takes. @param step  rad; 0: mated places are taken to stay
  void add_removals(const std::vector<SearchedModification>& searched, int side, double step, const Removal& removal);
  [[nodiscard]] double distance_per_motion(std::size_t place) const {
    return per_motion.empty() ? 1 : per_motion[place];
  }
  /// What an amount of modification s takes; null: nothing, or it meets another flank.
  [[nodiscard]] const Taken* taken(std::size_t s, double amount_mm, int length) const {
    const auto& of_way = (amount_mm > 0 ? up : down)[s];
    return amount_mm == 0 || of_way.empty() ? nullptr : &of_way[static_cast<std::size_t>(length)];
  }
};

/// Ease-off of one misalignment, with what each modification adds.
class SearchModel {
 public:
  /// Of a face gear: ease-off as the pair stands, modifications of the drawing and all. Refused: as exact_flank and
  /// ease_off.
  [[nodiscard]] static Result<SearchModel> make(const face_gear::FaceGear& gear, int side, int pinion_teeth,
                                                const std::vector<modification::Modification>& on_pinion,
                                                const Misalignment& moved,
                                                const std::vector<SearchedModification>& searched,
                                                const SearchOptions& options);
  /// Of the flanks of one side of a gear with this pitch [rad]; at least one place has a common normal.
  SearchModel(std::vector<SearchFlank> flanks, double pitch, int steps);

  struct Judged {
    double error_mm = 0;       ///< peak to peak of the motion curve, as a distance between the flanks
    double margin_gap_mm = 0;  ///< least gap in the margin of any edge
    Edge nearest = Edge::inner_end;
  };
  /// @param amounts_mm, lengths  one a searched modification: its amount, and which of its lengths
  [[nodiscard]] Judged judge(const std::vector<double>& amounts_mm, const std::vector<int>& lengths) const;

  /// What a candidate makes of the places of each flank: the sums of ease-off and removals, their slopes and bends;
  /// slope and bend empty where none moves on.
  struct FlankSums {
    std::vector<double> gap, slope, bend;
  };
  using Sums = std::vector<FlankSums>;
  [[nodiscard]] Sums sums(const std::vector<double>& amounts_mm, const std::vector<int>& lengths) const;
  /// `times` what an amount of modification s takes comes to the sums.
  void add(Sums& to, std::size_t s, double amount_mm, int length, double times) const;
  /// Where a candidate was worst: asked first of the next one, which often is worst there as well.
  struct Worst {
    int low = 0, high = 0;         ///< turns of the least and the greatest of the motion curve
    std::size_t flank = 0;         ///< of the least gap,
    std::size_t place = kNowhere;  ///< and its number among `in_margins`
    static constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);
  };
  /// An error is at least, a gap at most so much: does more of it matter?
  using Enough = std::function<bool(double error_mm, double gap_mm)>;
  /// The same from the sums; given up, with what was found by then, as soon as `enough` says so.
  [[nodiscard]] Judged judge(const Sums& sums, Worst& worst, const Enough& enough) const;

  /// The most that is taken at one place, by the modifications of one member together, summed over the flanks and both
  /// members, and the greatest of them, mm.
  struct Removal {
    double sum_mm = 0, most_mm = 0;
  };
  [[nodiscard]] Removal removal(const std::vector<double>& amounts_mm, const std::vector<int>& lengths,
                                const std::vector<SearchedModification>& searched) const;

 private:
  void place_turns(SearchFlank& flank) const;
  class Curve;

  std::vector<SearchFlank> flanks_;
  double start_ = 0, step_ = 0;
  int turns_ = 0, steps_ = 0;
};

/// The models of one side of the teeth, a misalignment each, and what its margins shall keep: more than the compound
/// where the model is not trusted.
struct SearchedSide {
  int side = 1;
  std::vector<SearchModel> models;
  double wanted_gap_mm = 0;
};

struct SearchResult {
  std::vector<int> units;    ///< amount of every searched modification, in SearchOptions::unit_mm
  std::vector<int> lengths;  ///< which of its lengths
  bool inside = false;       ///< the pattern keeps off all edges in every model
  double error_mm = 0;       ///< the greatest of all models
  double margin_gap_mm = 0;  ///< the least of all models
  std::size_t limiting = 0;  ///< the model that has it, of its side
  Edge nearest = Edge::inner_end;
  std::vector<double> side_error_mm;            ///< of every side: the greatest of its models
  std::vector<double> least_error_mm;           ///< of every side: the least that was found, whatever is taken off
  std::vector<int> least_units, least_lengths;  ///< that has them
  SearchModel::Removal removal;                 ///< of the first models of all sides
  double lack_mm = 0;                           ///< by which margins are short, summed over the sides
  /// What is left without one modification: the greatest error, the least gap; of those that are not 0.
  struct Without {
    std::size_t searched = 0;
    double error_mm = 0, margin_gap_mm = 0;
  };
  std::vector<Without> without;
  long judged = 0;  ///< candidates
};
/// The best over all models of all sides: inside first, then the least error of every side; of those with errors nearly
/// equal to it the one with the least removal, and no modification is left that could be 0 or a unit less. From the
/// best of a coarse lattice, steps to ever smaller ones. The same on any number of threads. Its share is told.
/// @param sides  that share a searched modification; what belongs to one of them is sought for it alone
/// @param known  found for another side: the only starts are its modifications, and those of its least errors; null:
/// the lattice
[[nodiscard]] SearchResult search_modifications(const std::vector<SearchedSide>& sides,
                                                const std::vector<SearchedModification>& searched,
                                                const SearchOptions& options, const SearchResult* known = nullptr);
/// Of two results of the same sides: is `a` to be preferred by the same rule?
[[nodiscard]] bool preferred(const SearchResult& a, const SearchResult& b, const SearchOptions& options);

/// The same of one side alone.
[[nodiscard]] inline SearchResult search_modifications(std::vector<SearchModel> models,
                                                       const std::vector<SearchedModification>& searched,
                                                       double wanted_gap_mm, const SearchOptions& options) {
  std::vector<SearchedSide> sides;
  sides.push_back({1, std::move(models), wanted_gap_mm});
  return search_modifications(sides, searched, options);
}

/// The modification that amount and length of a searched one stand for, on the flanks of one side; 0: of both.
[[nodiscard]] modification::Modification modification_of(const SearchedModification& searched, double amount_mm,
                                                         int length, int side);

}  // namespace toothpath::contact
