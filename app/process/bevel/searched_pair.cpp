#include "app/process/bevel/searched_pair.h"

#include "geometry/contact/bevel_search_model.h"

namespace toothpath::bevel {

const ease_off::PairWords kBevelWords = {
    "wall",
    "wall",
    {"L", "U"},
    false,
    "half",
    "half",
    "wall,half,row,column,cone_distance,height,ease_off_um,phi_2_deg,pinion_height,pinion_cone_distance",
    "cone_distance",
    "height",
    "cone distance",
    "height",
    "cone distance [mm]",
    "height [mm]",
    "pinion's flank ends",
    "mean pitch radius of the pinion, whose turns are told,"};

namespace {

using contact::SearchedModification;

class BevelSearchedPair final : public ease_off::SearchedPair {
 public:
  explicit BevelSearchedPair(const BevelPairAsked& asked) : asked_(asked) {}

  [[nodiscard]] const ease_off::PairWords& words() const override { return kBevelWords; }
  [[nodiscard]] ease_off::KeyTable keys_of(bool on_pinion) const override {
    if (on_pinion == asked_.job_is_pinion()) return {"gear"};
    return {"gear", false,
            asked_.mate_file.empty() ? "the job of the mate, which --mate did not name" : asked_.mate_file};
  }
  [[nodiscard]] double pitch_radius_mm() const override { return asked_.pinion().R_m() * asked_.pinion().sin_delta(); }
  [[nodiscard]] double motion_lever_mm() const override { return pitch_radius_mm(); }

  /// All that the mill of one member takes; with both, tip relief of the mate, too.
  [[nodiscard]] std::vector<SearchedModification> searched() const override {
    const bool both = asked_.modify == "both", pinion = both ? asked_.job_is_pinion() : asked_.modify == "pinion";
    auto list = contact::searched_of_mill(pinion ? asked_.pinion() : asked_.wheel(), pinion);
    if (!both) return list;
    for (const auto& s : contact::searched_of_mill(pinion ? asked_.wheel() : asked_.pinion(), !pinion))
      if (s.kind == modification::Kind::tip_relief) list.push_back(s);
    return list;
  }
  [[nodiscard]] double depth_mm() const override { return 2 * asked_.gear->parameters().addendum_mm; }
  [[nodiscard]] contact::SearchOptions model_size() const override {
    contact::SearchOptions options;
    options.rows = options.columns = 25;
    options.steps = 24;
    return options;
  }
  [[nodiscard]] bool sides_share() const override { return true; }
  [[nodiscard]] int side_of(std::size_t side) const override { return contact::side_of_wall(sigma_of(side)); }
  [[nodiscard]] Result<contact::SearchModel> model(std::size_t side, const contact::Misalignment& moved,
                                                   const std::vector<SearchedModification>& searched,
                                                   const contact::SearchOptions& options) const override {
    return contact::bevel_search_model(asked_.pinion(), asked_.wheel(), sigma_of(side), moved, searched, options);
  }

  [[nodiscard]] std::vector<Diagnostic> refused(const ease_off::FoundModifications& with) const override {
    std::vector<Diagnostic> all;
    for (const auto& [gear, more] : {std::pair(&asked_.pinion(), &with.on_pinion), {&asked_.wheel(), &with.on_gear}}) {
      auto made = with_more(*gear, *more);
      if (const auto* errors = made.refused()) all.insert(all.end(), errors->begin(), errors->end());
    }
    return all;
  }

  [[nodiscard]] process::ValueOrErrors<std::vector<ease_off::MisalignmentRow>> rolled(
      const ease_off::FoundModifications& with, const std::vector<ease_off::NamedMisalignment>& list,
      double margin) const override {
    auto pinion = with_more(asked_.pinion(), with.on_pinion), wheel = with_more(asked_.wheel(), with.on_gear);
    if (auto* errors = pinion.refused()) return std::move(*errors);
    if (auto* errors = wheel.refused()) return std::move(*errors);
    auto rows = ease_off::roll_rows(
        [&](std::size_t s, const contact::Misalignment& moved) {
          return contact::bevel_misaligned_contact(pinion.value(), wheel.value(), sigma_of(s), moved, asked_.roll,
                                                   margin);
        },
        list);
    if (!rows) return std::vector{process::located(*asked_.job, "contact.misalignment", rows.error())};
    return std::move(*rows);
  }

 private:
  /// A gear with these modifications behind its own.
  [[nodiscard]] process::ValueOrErrors<bevel_gear::BevelGear> with_more(
      const bevel_gear::BevelGear& gear, const std::vector<modification::Modification>& more) const {
    auto parameters = gear.parameters();
    parameters.modifications.insert(parameters.modifications.end(), more.begin(), more.end());
    auto made = bevel_gear::BevelGear::make(parameters, gear.cutter_data());
    std::vector<Diagnostic> errors;
    if (const auto* refused = made.refused()) {
      for (const auto& r : *refused)
        errors.push_back(process::located(*asked_.job, "gear." + r.key, Diagnostic(r.diagnostic)));
      return errors;
    }
    return std::move(made).value();
  }
  BevelPairAsked asked_;
};

}  // namespace

std::unique_ptr<ease_off::SearchedPair> searched_pair(const BevelPairAsked& asked) {
  return std::make_unique<BevelSearchedPair>(asked);
}

}  // namespace toothpath::bevel
