#include "app/process/ease_off/optimiser.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/base/units.h"

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
    out_.modify = std::move(modify);
    out_.table = {&pair.words(), box, options_.margin, options_.compound_mm, pair.pitch_radius_mm(), {}};
    out_.gear = pair.keys_of(false);
    out_.pinion = pair.keys_of(true);
  }

  process::ValueOrErrors<Optimised> run() {
    if (auto refused = make_models(); !refused) return std::vector{refused.error()};
    for (out_.rounds = 1;; ++out_.rounds) {
      search();
      take_over();
      if (auto refused = prove(); auto* errors = refused.refused()) {
        out_.finding = "none was found: what the search came to is refused: " + errors->front().message;
        break;
      }
      const std::array<double, 2> least = {least_gap(0), least_gap(1)};
      out_.found = std::min(least[0], least[1]) > options_.compound_mm;
      const bool inside = std::all_of(found_.begin(), found_.end(), [](const auto& f) { return f.inside; });
      if (out_.found || !inside || out_.rounds == kRounds) break;
      for (const std::size_t s : {0u, 1u})
        if (least[s] <= options_.compound_mm) side(s).wanted_gap_mm += options_.compound_mm - least[s] + kMore_mm;
    }
    double error = 0;
    for (const auto& f : found_) error = std::max(error, f.error_mm);
    out_.model_error_rad = error / pair_.motion_lever_mm();
    out_.keys = keys_text(out_);
    if (out_.finding.empty()) out_.finding = finding();
    return std::move(out_);
  }

 private:
  /// Sides that are searched together.
  using Group = std::vector<contact::SearchedSide>;

  contact::SearchedSide& side(std::size_t s) { return groups_.size() == 1 ? groups_[0][s] : groups_[s][0]; }

  Status make_models() {
    const std::size_t places = searched_at_.size();
    std::vector<std::optional<Result<contact::SearchModel>>> made(2 * places);
    tbb::parallel_for(std::size_t(0), made.size(), [&](std::size_t k) {
      made[k] = pair_.model(k / places, searched_at_[k % places].moved, searched_, options_);
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
    return Ok{};
  }

  /// Every group whose margins shall keep something else than when it was searched last.
  void search() {
    searched_with_.resize(groups_.size());
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      std::vector<double> wanted;
      for (const auto& side : groups_[g]) wanted.push_back(side.wanted_gap_mm);
      if (wanted == searched_with_[g]) continue;
      found_[g] = contact::search_modifications(groups_[g], searched_, options_);
      searched_with_[g] = wanted;
      out_.judged += found_[g].judged;
    }
    if (groups_.size() != 2) return;
    // What one side found may be better for the other, too; on gears that are their own mirror image it is the same.
    for (const std::size_t g : {0u, 1u}) {
      const auto other = contact::search_modifications(groups_[g], searched_, options_, &found_[1 - g]);
      out_.judged += other.judged;
      if (other.score < found_[g].score) found_[g] = other;
    }
  }

  void take_over() {
    out_.found_on = {};
    for (std::size_t n = 0; n < searched_.size(); ++n)
      for (std::size_t g = 0; g < groups_.size(); ++g) {
        // The nearest number to the decimals that are written.
        const auto m = contact::modification_of(searched_[n], found_[g].units[n] / kUnits, found_[g].lengths[n],
                                                groups_.size() == 2 ? groups_[g][0].side : searched_[n].side);
        if (m.amount_mm != 0) (searched_[n].on_pinion ? out_.found_on.on_pinion : out_.found_on.on_gear).push_back(m);
      }
    join_flanks(out_.found_on.on_gear);
    join_flanks(out_.found_on.on_pinion);
  }

  /// Rolls the pair with what was found at all misalignments.
  process::ValueOrErrors<Ok> prove() {
    auto rows = pair_.rolled(out_.found_on, list_, options_.margin);
    if (auto* errors = rows.refused()) return std::move(*errors);
    out_.table.rows = std::move(rows).value();
    out_.error_rad = 0;
    for (const auto& row : out_.table.rows)
      for (const auto& side : row.sides) out_.error_rad = std::max(out_.error_rad, side.error_range_rad);
    return Ok{};
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
          "amounts go up to {:g} um. A smaller box, a smaller margin or thinner compound would help",
          100 * options_.margin, at.gap_mm * app::kUm, options_.compound_mm * app::kUm, where,
          options_.largest_mm * app::kUm);
    return fmt::format(
        "the pattern stays inside at all {} misalignments; the least gap within {:g} % of the edges is {:.2f} um ({}); "
        "transmission error at most {:.4f} um",
        out_.table.rows.size(), 100 * options_.margin, at.gap_mm * app::kUm, where, um);
  }

  const SearchedPair& pair_;
  const job::ContactSettings& settings_;
  contact::SearchOptions options_;
  std::vector<SearchedModification> searched_;
  std::vector<NamedMisalignment> list_, searched_at_;
  std::vector<Group> groups_;                       ///< one with both sides, or one a side
  std::vector<SearchResult> found_;                 ///< one a group
  std::vector<std::vector<double>> searched_with_;  ///< of a group: gaps wanted when it was searched last
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
