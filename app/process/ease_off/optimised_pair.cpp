#include "app/process/ease_off/optimised_pair.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/base/units.h"
#include "app/job/file.h"
#include "machines/toml/regular_file.h"

namespace toothpath::ease_off {
namespace {

using Json = nlohmann::ordered_json;
using modification::Modification;

/// Null: this gear type has none.
std::vector<Modification>* of_gear(job::Job& job) {
  return std::visit(
      [](auto& gear) -> std::vector<Modification>* {
        if constexpr (requires { gear.modifications; }) return &gear.modifications;
        else return nullptr;
      },
      job.gear);
}

/// The job with what was found behind its lists, as far as it has keys for it.
job::Job with_found(const job::Job& job, const Optimised& found) {
  job::Job changed = job;
  for (const auto& [list, where] :
       {std::pair(&found.found_on.on_gear, &found.gear), {&found.found_on.on_pinion, &found.pinion}}) {
    if (!where->in_job || list->empty()) continue;
    if (where->table != "gear" && !changed.contact) changed.contact.emplace();
    auto* of_job = where->table == "gear" ? of_gear(changed) : &changed.contact->modifications;
    if (of_job) of_job->insert(of_job->end(), list->begin(), list->end());
  }
  return changed;
}

bool same(const std::vector<Modification>& a, const std::vector<Modification>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Modification& x, const Modification& y) {
    return x.kind == y.kind && x.amount_mm == y.amount_mm && x.length_mm == y.length_mm && x.flanks == y.flanks &&
           x.zone == y.zone;
  });
}

}  // namespace

std::string keys_text(const Optimised& found) {
  std::string out;
  for (const auto& [list, where] :
       {std::pair(&found.found_on.on_gear, &found.gear), {&found.found_on.on_pinion, &found.pinion}}) {
    if (!list->empty() && !where->in_job) out += "\n# These belong to " + where->file + ":\n";
    for (const Modification& m : *list) {
      out += fmt::format("\n[[{}.modification]]\nkind = \"{}\"\namount = {:.4f}\n", where->table, to_string(m.kind),
                         m.amount_mm);
      if (modification::is_relief(m.kind)) out += fmt::format("length = {:.2f}\n", m.length_mm);
      if (m.flanks != modification::Flanks::both) out += fmt::format("flank = \"{}\"\n", to_string(m.flanks));
      if (m.zone) out += fmt::format("zone = {}\n", *m.zone);
    }
  }
  return out;
}

Result<std::string> job_with_keys(const job::Job& job, const Optimised& found, const std::string& file) {
  auto text = toml::read_input_file(job.file, job::kMaxJobBytes);
  if (!text) return text.error();
  std::string whole = std::move(*text);
  if (!whole.empty() && whole.back() != '\n') whole += '\n';
  whole += "\n# Found by `toothpath contact --optimise` for [contact.misalignment]: " + found.finding + ".\n" +
           found.keys.substr(found.keys.empty() ? 0 : 1);
  auto read = job::parse_job(whole, file);
  job::Job wanted = with_found(job, found);
  auto* parsed = read.value_if();
  const auto *there = parsed ? of_gear(*parsed) : nullptr, *asked = of_gear(wanted);
  if (there && asked && same(*there, *asked) && parsed->contact &&
      same(parsed->contact->modifications, wanted.contact->modifications))
    return whole;
  return fail_at(job.where("gear"),
                 "--write: the job does not take the keys at its end: modifications must be written "
                 "as [[gear.modification]] and [[contact.modification]], and grids lie beside {}",
                 file);
}

Json optimised_json(const Optimised& found) {
  Json list = Json::array();
  for (const auto& [of, member] : {std::pair(&found.found_on.on_gear, "gear"), {&found.found_on.on_pinion, "pinion"}})
    for (const Modification& m : *of) {
      Json json = {{"member", member}, {"kind", to_string(m.kind)}, {"amount", m.amount_mm}};
      if (modification::is_relief(m.kind)) json["length"] = m.length_mm;
      json["flank"] = to_string(m.flanks);
      if (m.zone) json["zone"] = *m.zone;
      list.push_back(std::move(json));
    }
  const double um = found.table.pitch_radius_mm * app::kUm;
  Json needed = Json::array();
  for (const Needed& n : found.needed) {
    const Modification& m = n.of.modification;
    Json json = {{"member", n.of.on_pinion ? "pinion" : "gear"}, {"kind", to_string(m.kind)}, {"amount", m.amount_mm}};
    json["flank"] = to_string(m.flanks);
    if (m.zone) json["zone"] = *m.zone;
    json["transmission_error_um"] = n.error_um;
    json["margin_gap_um"] = n.margin_gap_mm < 1e100 ? Json(n.margin_gap_mm * app::kUm) : Json(nullptr);
    json["wanted_gap_um"] = n.wanted_gap_mm * app::kUm;
    needed.push_back(std::move(json));
  }
  return {{"found", found.found},
          {"modify", found.modify},
          {"finding", found.finding},
          {"modifications", std::move(list)},
          {"keys", found.keys},
          {"transmission_error_um",
           {{"worst", found.error_rad * um},
            {"of_the_search", found.model_error_rad * um},
            {"least_of_the_search", found.least_error_rad * um},
            {"nearly_equal_up_to", found.nearly_equal_rad * um}}},
          {"removal_um", found.removal_mm * app::kUm},
          {"without", std::move(needed)},
          {"candidates", found.judged},
          {"rounds", found.rounds},
          {"misalignments", table_json(found.table)}};
}

std::string optimised_summary(const Optimised& found) {
  std::string out = "optimised: " + found.finding + "\n";
  const double um = found.table.pitch_radius_mm * app::kUm;
  out += fmt::format("  {} candidates, rolled {} times; the search put the error at {:.4f} um\n", found.judged,
                     found.rounds, found.model_error_rad * um);
  out += fmt::format(
      "  errors up to {:.4f} um count as nearly equal to the least of the search, {:.4f} um: of those the least is "
      "taken "
      "off, at one place of a flank {:.1f} um at most\n",
      found.nearly_equal_rad * um, found.least_error_rad * um, found.removal_mm * app::kUm);
  for (const Needed& n : found.needed)
    out += fmt::format(
        "  without {}: transmission error {:.4f} um, gap at the edges {} of {:.2f} um that the models keep\n",
        amount_text(n.of), n.error_um,
        n.margin_gap_mm < 1e100 ? fmt::format("{:.2f}", n.margin_gap_mm * app::kUm) : "none",
        n.wanted_gap_mm * app::kUm);
  if (!found.keys.empty()) out += (found.found ? "" : "  the best that was seen:\n") + found.keys + "\n";
  return out + page::table_text(table_page(found.table, ""));
}

}  // namespace toothpath::ease_off
