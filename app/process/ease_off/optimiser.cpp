#include "app/process/ease_off/optimiser.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "app/base/units.h"
#include "geometry/base/work_share.h"

namespace toothpath::ease_off {
namespace {

using contact::SearchedModification;
using contact::SearchResult;
using modification::Kind;
using modification::Modification;

constexpr int kRounds = 5;
constexpr double kMore_mm = 5e-5;  // by which a margin that the proof found too narrow is widened beyond that
constexpr double kLargest_mm = 0.1;
constexpr double kUnits = 1e4;          // in a mm
constexpr double kSteepest_rad = 0.08;  // of the shortest relief at its edge, and of a profile crowning
constexpr double kNearlyEqual_mm = 1e-4, kNearlyEqualShare = 0.05;  // errors at the pitch radius: of two, the greater
constexpr int kRandom = 4;                           // misalignments inside the box that only the proof sees
constexpr std::size_t kFirstRolled = 4;              // misalignments that are rolled before all others
constexpr double kModels = 0.05, kFirstRound = 0.6;  // of the work, as it is told

/// What may be taken, no steeper than that.
std::vector<SearchedModification> searched_for(const SearchedPair& pair) {
  auto list = pair.searched();
  for (auto& s : list) {
    if (!s.lengths_mm.empty()) s.largest_mm = kSteepest_rad * s.lengths_mm.front() / 2;
    if (s.kind == Kind::profile_crowning) s.largest_mm = kSteepest_rad * pair.depth_mm() / 4;
  }
  return list;
}

/// Right and left flank with the same are one modification of both.
void join_flanks(std::vector<Modification>& list) {
  const auto twin = [](const Modification& a, const Modification& b) {
    return a.kind == b.kind && a.amount_mm == b.amount_mm && a.length_mm == b.length_mm && a.zone == b.zone &&
           a.flanks != b.flanks && a.flanks != modification::Flanks::both && b.flanks != modification::Flanks::both;
  };
  for (std::size_t k = 0; k < list.size(); ++k)
    for (std::size_t n = k + 1; n < list.size(); ++n)
      if (twin(list[k], list[n])) {
        list[k].flanks = modification::Flanks::both;
        list.erase(list.begin() + static_cast<std::ptrdiff_t>(n--));
      }
}

/// The worst of a table.
struct Limit {
  const MisalignmentRow* row = nullptr;
  std::size_t side = 0;
  double gap_mm = 1e300;
};

class Optimiser {
 public:
  Optimiser(const SearchedPair& pair, const job::ContactSettings& settings, std::string modify)
      : pair_(pair), settings_(settings), options_(pair.model_size()), searched_(searched_for(pair)) {
    const auto& box = settings_.box->most;
    list_ = single_misalignments(settings_.moved, box);
    const auto corners = corner_misalignments(settings_.moved, box);
    list_.insert(list_.end(), corners.begin(), corners.end());
    // The search wants the pair as it stands and the corners; where one quantity alone is given its ends are these.
    searched_at_ = {list_.front()};
    const auto& ends = corners.empty() ? list_ : corners;
    searched_at_.insert(searched_at_.end(), ends.begin() + (corners.empty() ? 1 : 0), ends.end());
    options_.compound_mm = settings_.compound_mm;
    options_.margin = settings_.box->margin;
    options_.unit_mm = 1 / kUnits;
    options_.largest_mm = std::min(kLargest_mm, pair.depth_mm() / 10);
    options_.nearly_equal_mm = kNearlyEqual_mm * pair.motion_lever_mm() / pair.pitch_radius_mm();
    options_.nearly_equal_share = kNearlyEqualShare;
    out_.modify = std::move(modify);
    // The proof alone looks inside the box.
    const auto random = random_misalignments(settings_.moved, box, kRandom);
    list_.insert(list_.end(), random.begin(), random.end());
    out_.table = {&pair.words(), box, options_.margin, options_.compound_mm, pair.pitch_radius_mm(), {}};
    out_.gear = pair.keys_of(false);
    out_.pinion = pair.keys_of(true);
  }

  process::ValueOrErrors<Optimised> run() {
    if (auto refused = make_models(); !refused) return std::vector{refused.error()};
    bool refused = false;
    for (out_.rounds = 1;; ++out_.rounds) {
      const double worth = out_.rounds == 1 ? kFirstRound : (1 - kFirstRound - kModels) / (kRounds - 1);
      search(worth / 2);
      take_over();
      const Made made = hold_refused();
      refused = made != Made::all;
      if (made == Made::not_together || (refused && stops_.size() > searched_.size())) break;
      if (refused) {
        --out_.rounds;  // of search and proof: this one was not rolled
        continue;
      }
      const bool last = out_.rounds == kRounds || !inside();
      if (auto rolled = prove(!last, worth / 2); auto* errors = rolled.refused()) return std::move(*errors);
      if (out_.found || last) break;
      for (const std::size_t s : {0u, 1u})
        if (const double least = least_gap(s); least <= options_.compound_mm)
          side(s).wanted_gap_mm += options_.compound_mm - least + kMore_mm;
    }
    tell_errors();
    out_.keys = keys_text(out_);
    out_.finding =
        refused ? "none was found: " + stops_text() + ". A smaller box, a smaller margin or thinner compound would help"
                : finding();
    return std::move(out_);
  }

 private:
  /// Sides that are searched together.
  using Group = std::vector<contact::SearchedSide>;

  contact::SearchedSide& side(std::size_t s) { return groups_.size() == 1 ? groups_[0][s] : groups_[s][0]; }

  Status make_models() {
    const std::size_t places = searched_at_.size();
    std::vector<std::optional<Result<contact::SearchModel>>> made(2 * places);
    WorkShare share(share_, double(made.size()), kModels);
    tbb::parallel_for(std::size_t(0), made.size(), [&](std::size_t k) {
      made[k] = pair_.model(k / places, searched_at_[k % places].moved, searched_, options_);
      share.add();
    });
    groups_.resize(pair_.sides_share() ? 1 : 2);
    for (const std::size_t s : {0u, 1u}) {
      groups_[pair_.sides_share() ? 0 : s].push_back({pair_.side_of(s), {}, options_.compound_mm});
      for (std::size_t k = 0; k < places; ++k) {
        auto& model = *made[s * places + k];
        if (!model) return fail("{}: {}", searched_at_[k].name, model.error().message);
        side(s).models.push_back(std::move(*model));
      }
    }
    found_.resize(groups_.size());
    searched_with_.resize(groups_.size());
    return Ok{};
  }

  /// Every group whose margins shall keep something else than when it was searched last.
  void search(double worth) {
    WorkShare share(share_, 2 * double(groups_.size()), worth);
    const auto each = [&](const auto& work) {
      std::vector<std::optional<SearchResult>> results(groups_.size());
      tbb::parallel_for(std::size_t(0), groups_.size(), [&](std::size_t g) {
        const WorkShare part(share);
        results[g] = work(g);
      });
      return results;
    };
    const auto anew = each([&](std::size_t g) -> std::optional<SearchResult> {
      std::vector<double> wanted;
      for (const auto& side : groups_[g]) wanted.push_back(side.wanted_gap_mm);
      if (wanted == searched_with_[g]) return std::nullopt;
      searched_with_[g] = wanted;
      return contact::search_modifications(groups_[g], searched_, options_);
    });
    for (std::size_t g = 0; g < groups_.size(); ++g)
      if (anew[g]) found_[g] = *anew[g], out_.judged += anew[g]->judged;
    if (groups_.size() != 2) return;
    // What one side found may be better for the other, too; on gears that are their own mirror image it is the same.
    const auto crossed = each([&](std::size_t g) -> std::optional<SearchResult> {
      if (!anew[0] && !anew[1]) return std::nullopt;
      return contact::search_modifications(groups_[g], searched_, options_, &found_[1 - g]);
    });
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (!crossed[g]) continue;
      out_.judged += crossed[g]->judged;
      if (contact::preferred(*crossed[g], found_[g], options_)) found_[g] = *crossed[g];
    }
  }

  /// What was found of searched modification n in a group.
  [[nodiscard]] OfMember of_member(std::size_t n, std::size_t g) const {
    // The nearest number to the decimals that are written.
    return {contact::modification_of(searched_[n], found_[g].units[n] / kUnits, found_[g].lengths[n],
                                     groups_.size() == 2 ? groups_[g][0].side : searched_[n].side),
            searched_[n].on_pinion, n};
  }
  [[nodiscard]] bool inside() const {
    return std::all_of(found_.begin(), found_.end(), [](const auto& f) { return f.inside; });
  }

  void take_over() {
    std::vector<OfMember> all;
    for (std::size_t n = 0; n < searched_.size(); ++n)
      for (std::size_t g = 0; g < groups_.size(); ++g) all.push_back(of_member(n, g));
    out_.found_on = lists_of(all);
    join_flanks(out_.found_on.on_gear);
    join_flanks(out_.found_on.on_pinion);
  }

  enum class Made { all, but_one, not_together };
  /// Where the gears refuse what was found: tells which amount stops where, and lets the next search go no farther.
  Made hold_refused() {
    const auto errors = pair_.refused(out_.found_on);
    if (errors.empty()) return Made::all;
    std::vector<OfMember> all;
    for (std::size_t n = 0; n < searched_.size(); ++n)
      for (std::size_t g = 0; g < groups_.size(); ++g) all.push_back(of_member(n, g));
    const auto stop = refused_amount(pair_, all, 1 / kUnits);
    if (!stop) {
      stops_.push_back("what the search came to is refused whichever one amount is 0: " + errors.front().message);
      return Made::not_together;
    }
    searched_[stop->largest.number].largest_mm = stop->limit_mm;
    for (auto& wanted : searched_with_) wanted.clear();
    stops_.push_back(fmt::format("the search stopped at {}: beside the others it is made up to {:.4f} mm; beyond, {}",
                                 amount_text(stop->largest), stop->limit_mm, stop->message));
    return Made::but_one;
  }

  /// Rolls the pair with what was found: where the models put the margins narrowest, and, unless margins lack there and
  /// another search follows, at all misalignments.
  process::ValueOrErrors<Ok> prove(bool may_search_again, double worth) {
    WorkShare share(share_, double(list_.size()), worth);
    std::vector<std::size_t> order = narrowest_first();
    std::vector<MisalignmentRow> rows;
    const auto roll = [&](std::size_t from, std::size_t to) -> process::ValueOrErrors<Ok> {
      std::vector<NamedMisalignment> some;
      for (std::size_t k = from; k < to; ++k) some.push_back(list_[order[k]]);
      const WorkShare part(share, 1, double(some.size()));
      auto rolled = pair_.rolled(out_.found_on, some, options_.margin);
      if (auto* errors = rolled.refused()) return std::move(*errors);
      for (auto& row : rolled.value()) rows.push_back(std::move(row));
      return Ok{};
    };
    const std::size_t first = std::min(kFirstRolled, order.size());
    if (auto rolled = roll(0, first); rolled.refused() != nullptr) return rolled;
    out_.table.rows = rows;
    if (may_search_again && std::min(least_gap(0), least_gap(1)) <= options_.compound_mm) return Ok{};
    if (auto rolled = roll(first, order.size()); rolled.refused() != nullptr) return rolled;
    out_.table.rows.resize(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) out_.table.rows[order[k]] = rows[k];
    out_.error_rad = 0;
    for (const auto& row : out_.table.rows)
      for (const auto& side : row.sides) out_.error_rad = std::max(out_.error_rad, side.error_range_rad);
    out_.found = std::min(least_gap(0), least_gap(1)) > options_.compound_mm;
    return Ok{};
  }
  /// All misalignments: those first whose margins the models put narrowest, those without a model last.
  [[nodiscard]] std::vector<std::size_t> narrowest_first() const {
    std::vector<double> gap(list_.size(), contact::kUnmet);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      std::vector<double> amounts;
      for (const int u : found_[g].units) amounts.push_back(u / kUnits);
      for (const auto& side : groups_[g])
        for (std::size_t m = 0; m < side.models.size(); ++m)
          for (std::size_t k = 0; k < list_.size(); ++k)
            if (list_[k].name == searched_at_[m].name)
              gap[k] = std::min(gap[k], side.models[m].judge(amounts, found_[g].lengths).margin_gap_mm);
    }
    std::vector<std::size_t> order(list_.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return gap[a] < gap[b]; });
    return order;
  }

  /// What the models say of the errors, of what is taken off and of what it is needed for.
  void tell_errors() {
    double error = 0, least = 0, nearly = 0;
    const double um = pair_.pitch_radius_mm() / pair_.motion_lever_mm() * app::kUm;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      error = std::max(error, found_[g].error_mm);
      for (const double of_side : found_[g].least_error_mm) {
        least = std::max(least, of_side);
        nearly = std::max(nearly, options_.nearly_equal_to(of_side));
      }
      out_.removal_mm = std::max(out_.removal_mm, found_[g].removal.most_mm);
      double wanted = 0;
      for (const auto& side : groups_[g]) wanted = std::max(wanted, side.wanted_gap_mm);
      for (const auto& w : found_[g].without)
        out_.needed.push_back({of_member(w.searched, g), w.error_mm * um, w.margin_gap_mm, wanted});
    }
    out_.model_error_rad = error / pair_.motion_lever_mm();
    out_.least_error_rad = least / pair_.motion_lever_mm();
    out_.nearly_equal_rad = nearly / pair_.motion_lever_mm();
  }
  [[nodiscard]] std::string stops_text() const {
    std::string text;
    for (const auto& stop : stops_) text += (text.empty() ? "" : "; ") + stop;
    return text;
  }

  [[nodiscard]] Limit limit() const {
    Limit limit;
    for (const auto& row : out_.table.rows)
      for (const std::size_t s : {0u, 1u})
        if (row.sides[s].margin_gap_mm < limit.gap_mm) limit = {&row, s, row.sides[s].margin_gap_mm};
    return limit;
  }
  [[nodiscard]] double least_gap(std::size_t side) const {
    double least = 1e300;
    for (const auto& row : out_.table.rows) least = std::min(least, row.sides[side].margin_gap_mm);
    return least;
  }

  [[nodiscard]] std::string finding() const {
    const double um = out_.error_rad * pair_.pitch_radius_mm() * app::kUm;
    if (out_.found && out_.keys.empty())
      return fmt::format("nothing need be taken: the pattern stays inside, transmission error at most {:.4f} um", um);
    const Limit at = limit();
    if (at.row == nullptr)
      return fmt::format("the pattern stays inside, no edge is met; transmission error at most {:.4f} um", um);
    const std::string where = fmt::format("{}, {}, at the {}", at.row->at.name, pair_.words().side(at.side),
                                          to_string(at.row->sides[at.side].nearest));
    if (!out_.found)
      return fmt::format(
          "none was found: at best the gap within {:g} % of the edges is {:.2f} um, below the compound of {:g} um "
          "({}); "
          "amounts go up to {:g} um{}. A smaller box, a smaller margin or thinner compound would help",
          100 * options_.margin, at.gap_mm * app::kUm, options_.compound_mm * app::kUm, where,
          options_.largest_mm * app::kUm, stops_.empty() ? "" : "; " + stops_text());
    return fmt::format(
        "the pattern stays inside at all {} misalignments; the least gap within {:g} % of the edges is {:.2f} um ({}); "
        "transmission error at most {:.4f} um{}",
        out_.table.rows.size(), 100 * options_.margin, at.gap_mm * app::kUm, where, um,
        stops_.empty() ? "" : "; " + stops_text());
  }

  const SearchedPair& pair_;
  const job::ContactSettings& settings_;
  contact::SearchOptions options_;
  std::vector<SearchedModification> searched_;
  std::vector<NamedMisalignment> list_, searched_at_;
  std::vector<Group> groups_;                       ///< one with both sides, or one a side
  std::vector<SearchResult> found_;                 ///< one a group
  std::vector<std::vector<double>> searched_with_;  ///< of a group: gaps wanted when it was searched last
  std::vector<std::string> stops_;                  ///< amounts that the gears refused, each with its limit
  WorkShare share_{1};
  Optimised out_;
};

}  // namespace

process::ValueOrErrors<Misaligned> misalign(const SearchedPair& pair, const job::Job& job,
                                            const job::ContactSettings& settings, const process::ContactAsked& asked,
                                            const std::string& modify, app::StageClock& clock) {
  Misaligned out;
  if (!settings.box) {
    if (!asked.optimise) return out;
    return std::vector{fail_at(job.where("contact"),
                               "--optimise needs a box of misalignments: [contact.misalignment] "
                               "with offset, angle, pinion_axial or gear_axial")};
  }
  const job::MisalignmentBox& box = *settings.box;
  auto rows = clock.run("misalignments",
                        [&] { return pair.rolled({}, single_misalignments(settings.moved, box.most), box.margin); });
  if (auto* errors = rows.refused()) return std::move(*errors);
  out.table = {&pair.words(),          box.most, box.margin, settings.compound_mm, pair.pitch_radius_mm(),
               std::move(rows).value()};
  if (!asked.optimise) return out;
  auto found = clock.run("optimise", [&] { return Optimiser(pair, settings, modify).run(); });
  if (auto* errors = found.refused()) return std::move(*errors);
  out.optimised = std::move(found).value();
  if (!out.optimised->found || asked.write_file.empty()) return out;
  auto text = job_with_keys(job, *out.optimised, asked.write_file);
  if (!text) return std::vector{text.error()};
  out.job_text = std::move(*text);
  return out;
}

void add_misaligned(nlohmann::ordered_json& json, const Misaligned& misaligned) {
  if (misaligned.table) json["misalignments"] = table_json(*misaligned.table);
  if (misaligned.optimised) json["optimised"] = optimised_json(*misaligned.optimised);
}

void add_to_page(page::StudyPage& page, const Misaligned& misaligned) {
  if (misaligned.table) {
    page.tables.push_back(table_page(*misaligned.table, "Misaligned"));
    if (misaligned.table->rows.size() > 1) page.charts.push_back(centre_chart(*misaligned.table));
  }
  if (misaligned.optimised) {
    page.introduction.push_back("Optimised: " + misaligned.optimised->finding + ".");
    page.tables.push_back(table_page(misaligned.optimised->table, "Misaligned, with what was found"));
  }
}

std::string misaligned_summary(const Misaligned& misaligned) {
  std::string out;
  if (misaligned.table) out += page::table_text(table_page(*misaligned.table, ""));
  if (misaligned.optimised) out += optimised_summary(*misaligned.optimised);
  return out;
}

}  // namespace toothpath::ease_off
