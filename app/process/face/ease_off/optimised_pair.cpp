#include "app/process/face/ease_off/optimised_pair.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/base/units.h"
#include "app/job/file.h"
#include "machines/toml/regular_file.h"

namespace toothpath::ease_off {
namespace {

using Json = nlohmann::ordered_json;
using contact::SearchedModification;
using modification::Kind;
using modification::Modification;

constexpr int kRounds = 5;
constexpr double kMore_mm = 5e-5;  // by which a margin that the proof found too narrow is widened beyond that
constexpr double kLargest_mm = 0.1;
constexpr double kUnits = 1e4;          // in a mm
constexpr double kSteepest_rad = 0.08;  // of the shortest relief at its edge, and of a profile crowning

/// What may be taken: crownings and slopes of one member, reliefs of one or both.
std::vector<SearchedModification> searched_for(const std::string& modify, int zones, double depth) {
  const bool pinion = modify == "pinion";
  std::vector<double> lengths;
  for (const double share : {0.2, 0.3, 0.4, 0.5}) lengths.push_back(std::round(share * depth * 100) / 100);
  std::vector<SearchedModification> list = {{pinion, Kind::lead_crowning, {}, false, {}}};
  for (int zone = 0; zone < zones; ++zone)
    list.push_back({pinion, Kind::helix_angle_slope, zones > 1 ? std::optional(zone) : std::nullopt, true, {}});
  list.push_back({pinion, Kind::profile_crowning, {}, false, {}});
  list.push_back({pinion, Kind::tip_relief, {}, false, lengths});
  if (modify == "both") list.push_back({true, Kind::tip_relief, {}, false, lengths});
  else list.push_back({pinion, Kind::root_relief, {}, false, lengths});
  for (auto& s : list) {
    if (!s.lengths_mm.empty()) s.largest_mm = kSteepest_rad * lengths.front() / 2;
    if (s.kind == Kind::profile_crowning) s.largest_mm = kSteepest_rad * depth / 4;
  }
  return list;
}

/// What was found for both sides; equal ones are one modification of both flanks.
void take_over(Optimised& out, const std::vector<SearchedModification>& searched,
               const std::array<contact::SearchResult, 2>& found) {
  out.on_gear.clear();
  out.on_pinion.clear();
  for (std::size_t n = 0; n < searched.size(); ++n) {
    const auto of_side = [&](std::size_t s) {
      // The nearest number to the decimals that are written.
      return contact::modification_of(searched[n], found[s].units[n] / kUnits, found[s].lengths[n], s == 0 ? 1 : -1);
    };
    auto& list = searched[n].on_pinion ? out.on_pinion : out.on_gear;
    Modification right = of_side(0), left = of_side(1);
    if (right.amount_mm == left.amount_mm && right.length_mm == left.length_mm) {
      right.flanks = modification::Flanks::both;
      left.amount_mm = 0;
    }
    for (const auto& m : {right, left})
      if (m.amount_mm != 0) list.push_back(m);
  }
}

std::string keys_of(const Optimised& found) {
  std::string out;
  for (const auto& [list, table] : {std::pair(&found.on_gear, "gear"), {&found.on_pinion, "contact"}})
    for (const Modification& m : *list) {
      out +=
          fmt::format("\n[[{}.modification]]\nkind = \"{}\"\namount = {:.4f}\n", table, to_string(m.kind), m.amount_mm);
      if (modification::is_relief(m.kind)) out += fmt::format("length = {:.2f}\n", m.length_mm);
      if (m.flanks != modification::Flanks::both) out += fmt::format("flank = \"{}\"\n", to_string(m.flanks));
      if (m.zone) out += fmt::format("zone = {}\n", *m.zone);
    }
  return out;
}

/// Lists of the job with what was found behind them.
job::Job with_found(const job::Job& job, const Optimised& found) {
  job::Job changed = job;
  auto& gear = std::get<face_gear::FaceGearParameters>(changed.gear);
  gear.modifications.insert(gear.modifications.end(), found.on_gear.begin(), found.on_gear.end());
  if (!changed.contact) changed.contact.emplace();
  auto& pinion = changed.contact->modifications;
  pinion.insert(pinion.end(), found.on_pinion.begin(), found.on_pinion.end());
  return changed;
}

/// The worst of a table.
struct Limit {
  const MisalignmentRow* row = nullptr;
  std::size_t side = 0;
  double gap_mm = 1e300;
};

class Optimiser {
 public:
  explicit Optimiser(const OptimiseAsked& asked) : asked_(asked) {
    const auto& box = asked_.settings.box->most;
    list_ = single_misalignments(asked_.settings.moved, box);
    const auto corners = corner_misalignments(asked_.settings.moved, box);
    list_.insert(list_.end(), corners.begin(), corners.end());
    // The search wants the pair as it stands and the corners; where one quantity alone is given its ends are these.
    searched_at_ = {list_.front()};
    const auto& ends = corners.empty() ? list_ : corners;
    searched_at_.insert(searched_at_.end(), ends.begin() + (corners.empty() ? 1 : 0), ends.end());
    options_.compound_mm = asked_.roll.compound_mm;
    options_.margin = asked_.settings.box->margin;
    options_.unit_mm = 1 / kUnits;
  }

  process::ValueOrErrors<Optimised> run() {
    auto made = process::make_face_gear(*asked_.job);
    if (auto* errors = made.refused()) return std::move(*errors);
    const face_gear::FaceGear& gear = made.value();
    const double depth = 2 * gear.rings().front().surface.shaper.h_a;
    options_.largest_mm = std::min(kLargest_mm, depth / 10);
    const auto searched = searched_for(asked_.modify, static_cast<int>(gear.rings().size()), depth);
    if (auto refused = make_models(gear, searched); !refused) return std::vector{refused.error()};
    Optimised out;
    out.modify = asked_.modify;
    std::array<double, 2> wanted = {options_.compound_mm, options_.compound_mm};
    std::array<contact::SearchResult, 2> found;
    for (out.rounds = 1;; ++out.rounds) {
      for (const std::size_t s : {0u, 1u}) {
        if (out.rounds > 1 && wanted[s] == searched_with_[s]) continue;
        found[s] = contact::search_modifications(models_[s], searched, wanted[s], options_);
        searched_with_[s] = wanted[s];
        out.judged += found[s].judged;
      }
      out.judged += exchange(found, searched, wanted);
      take_over(out, searched, found);
      if (auto refused = prove(out); auto* errors = refused.refused()) {
        out.finding = "none was found: what the search came to is refused: " + errors->front().message;
        break;
      }
      const std::array<double, 2> least = {least_gap(out, 0), least_gap(out, 1)};
      out.found = std::min(least[0], least[1]) > options_.compound_mm;
      if (out.found || !found[0].inside || !found[1].inside || out.rounds == kRounds) break;
      for (const std::size_t s : {0u, 1u})
        if (least[s] <= options_.compound_mm) wanted[s] += options_.compound_mm - least[s] + kMore_mm;
    }
    const double lever = gear.rings().front().surface.M2;
    out.model_error_rad = std::max(found[0].error_mm, found[1].error_mm) / lever;
    out.keys = keys_of(out);
    if (out.finding.empty()) out.finding = finding(out);
    return out;
  }

 private:
  Status make_models(const face_gear::FaceGear& gear, const std::vector<SearchedModification>& searched) {
    for (const std::size_t s : {0u, 1u})
      for (const auto& at : searched_at_) {
        auto model = contact::SearchModel::make(gear, s == 0 ? 1 : -1, asked_.pinion_teeth,
                                                asked_.settings.modifications, at.moved, searched, options_);
        if (!model) return fail("{}: {}", at.name, model.error().message);
        models_[s].push_back(std::move(*model));
      }
    return Ok{};
  }

  /// What one side found may be better for the other, too; on gears that are their own mirror image it is the same.
  [[nodiscard]] long exchange(std::array<contact::SearchResult, 2>& found,
                              const std::vector<SearchedModification>& searched,
                              const std::array<double, 2>& wanted) const {
    long judged = 0;
    for (const std::size_t s : {0u, 1u}) {
      const auto other = contact::search_modifications(models_[s], searched, wanted[s], options_, &found[1 - s]);
      judged += other.judged;
      if (other.score < found[s].score) found[s] = other;
    }
    return judged;
  }

  /// Rolls the pair with what was found at all misalignments.
  process::ValueOrErrors<Ok> prove(Optimised& out) const {
    const job::Job changed = with_found(*asked_.job, out);
    auto made = process::make_face_gear(changed);
    if (auto* errors = made.refused()) return std::move(*errors);
    PairSides pair;
    for (const std::size_t s : {0u, 1u}) {
      pair[s] = {&made.value(), {}, asked_.pinion_teeth, changed.contact->modifications};
      for (int zone = 0; zone < static_cast<int>(made.value().rings().size()); ++zone) {
        auto flank = contact::exact_flank(made.value(), zone, s == 0 ? 1 : -1, asked_.rows, asked_.columns);
        if (!flank)
          return std::vector{process::located(*asked_.job, fmt::format("gear.zone[{}]", zone), flank.error())};
        pair[s].flanks.push_back(std::move(*flank));
      }
    }
    auto rows = roll_rows(pair, list_, asked_.roll, options_.margin);
    if (!rows) return std::vector{process::located(*asked_.job, "contact.misalignment", rows.error())};
    out.table = {asked_.settings.box->most, options_.margin, options_.compound_mm, asked_.pitch_radius_mm,
                 std::move(*rows)};
    out.error_rad = 0;
    for (const auto& row : out.table.rows)
      for (const auto& side : row.sides) out.error_rad = std::max(out.error_rad, side.error_range_rad);
    return Ok{};
  }

  [[nodiscard]] static Limit limit(const Optimised& out) {
    Limit limit;
    for (const auto& row : out.table.rows)
      for (const std::size_t s : {0u, 1u})
        if (row.sides[s].margin_gap_mm < limit.gap_mm) limit = {&row, s, row.sides[s].margin_gap_mm};
    return limit;
  }
  [[nodiscard]] static double least_gap(const Optimised& out, std::size_t side) {
    double least = 1e300;
    for (const auto& row : out.table.rows) least = std::min(least, row.sides[side].margin_gap_mm);
    return least;
  }

  [[nodiscard]] std::string finding(const Optimised& out) const {
    const Limit at = limit(out);
    const std::string where = fmt::format("{}, flank {:+}, at the {}", at.row->at.name, at.side == 0 ? 1 : -1,
                                          to_string(at.row->sides[at.side].nearest));
    const double um = out.error_rad * asked_.pitch_radius_mm * app::kUm;
    if (!out.found)
      return fmt::format(
          "none was found: at best the gap within {:g} % of the edges is {:.2f} um, below the compound of {:g} um "
          "({}); "
          "amounts go up to {:g} um. A smaller box, a smaller margin or thinner compound would help",
          100 * options_.margin, at.gap_mm * app::kUm, options_.compound_mm * app::kUm, where,
          options_.largest_mm * app::kUm);
    if (out.keys.empty())
      return fmt::format("nothing need be taken: the pattern stays inside, transmission error at most {:.4f} um", um);
    return fmt::format(
        "the pattern stays inside at all {} misalignments; the least gap within {:g} % of the edges is {:.2f} um ({}); "
        "transmission error at most {:.4f} um",
        out.table.rows.size(), 100 * options_.margin, at.gap_mm * app::kUm, where, um);
  }

  const OptimiseAsked& asked_;
  contact::SearchOptions options_;
  std::vector<NamedMisalignment> list_, searched_at_;
  std::array<std::vector<contact::SearchModel>, 2> models_;
  std::array<double, 2> searched_with_{};
};

bool same(const std::vector<Modification>& a, const std::vector<Modification>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Modification& x, const Modification& y) {
    return x.kind == y.kind && x.amount_mm == y.amount_mm && x.length_mm == y.length_mm && x.flanks == y.flanks &&
           x.zone == y.zone;
  });
}

}  // namespace

process::ValueOrErrors<Optimised> optimise(const OptimiseAsked& asked) { return Optimiser(asked).run(); }

Result<std::string> job_with_keys(const job::Job& job, const Optimised& found, const std::string& file) {
  auto text = toml::read_input_file(job.file, job::kMaxJobBytes);
  if (!text) return text.error();
  std::string whole = std::move(*text);
  if (!whole.empty() && whole.back() != '\n') whole += '\n';
  whole += "\n# Found by `toothpath contact --optimise` for [contact.misalignment]: " + found.finding + ".\n" +
           found.keys.substr(found.keys.empty() ? 0 : 1);
  const auto read = job::parse_job(whole, file);
  const job::Job wanted = with_found(job, found);
  if (const auto* parsed = read.value_if();
      parsed != nullptr && parsed->contact &&
      same(parsed->face_gear()->modifications, wanted.face_gear()->modifications) &&
      same(parsed->contact->modifications, wanted.contact->modifications))
    return whole;
  return fail_at(job.where("gear"),
                 "--write: the job does not take the keys at its end: modifications must be written "
                 "as [[gear.modification]] and [[contact.modification]], and grids lie beside {}",
                 file);
}

Json optimised_json(const Optimised& found) {
  Json list = Json::array();
  for (const auto& [of, member] : {std::pair(&found.on_gear, "gear"), {&found.on_pinion, "pinion"}})
    for (const Modification& m : *of) {
      Json json = {{"member", member}, {"kind", to_string(m.kind)}, {"amount", m.amount_mm}};
      if (modification::is_relief(m.kind)) json["length"] = m.length_mm;
      json["flank"] = to_string(m.flanks);
      if (m.zone) json["zone"] = *m.zone;
      list.push_back(std::move(json));
    }
  const double um = found.table.pitch_radius_mm * app::kUm;
  return {{"found", found.found},
          {"modify", found.modify},
          {"finding", found.finding},
          {"modifications", std::move(list)},
          {"keys", found.keys},
          {"transmission_error_um", {{"worst", found.error_rad * um}, {"of_the_search", found.model_error_rad * um}}},
          {"candidates", found.judged},
          {"rounds", found.rounds},
          {"misalignments", table_json(found.table)}};
}

std::string optimised_summary(const Optimised& found) {
  std::string out = "optimised: " + found.finding + "\n";
  out += fmt::format("  {} candidates, rolled {} times; the search put the error at {:.4f} um\n", found.judged,
                     found.rounds, found.model_error_rad * found.table.pitch_radius_mm * app::kUm);
  if (!found.keys.empty()) out += (found.found ? "" : "  the best that was seen:\n") + found.keys + "\n";
  return out + page::table_text(table_page(found.table, ""));
}

}  // namespace toothpath::ease_off
