#include "app/process/face/searched_pair.h"

#include <array>
#include <cmath>

namespace toothpath::face {

const ease_off::PairWords kFaceWords =
    ease_off::flank_words("ring", {"r", "r", "radius from the gear's axis [mm]"}, {"z", "z", "height z [mm]"},
                          "pinion's involute ends", "pitch radius");

namespace {

using contact::SearchedModification;
using modification::Kind;

class FacePair final : public ease_off::SearchedPair {
 public:
  explicit FacePair(const FacePairAsked& asked) : asked_(asked) {}

  [[nodiscard]] const ease_off::PairWords& words() const override { return kFaceWords; }
  [[nodiscard]] ease_off::KeyTable keys_of(bool on_pinion) const override { return {on_pinion ? "contact" : "gear"}; }
  [[nodiscard]] double pitch_radius_mm() const override { return first().surface.L_p; }
  [[nodiscard]] double motion_lever_mm() const override { return first().surface.M2; }

  /// Crownings and slopes of one member, reliefs of one or both.
  [[nodiscard]] std::vector<SearchedModification> searched() const override {
    const int zones = static_cast<int>(asked_.gear->rings().size());
    const bool pinion = asked_.modify == "pinion";
    std::vector<double> lengths;
    for (const double share : {0.2, 0.3, 0.4, 0.5}) lengths.push_back(std::round(share * depth_mm() * 100) / 100);
    std::vector<SearchedModification> list = {{pinion, Kind::lead_crowning, {}, false, {}}};
    for (int zone = 0; zone < zones; ++zone)
      list.push_back({pinion, Kind::helix_angle_slope, zones > 1 ? std::optional(zone) : std::nullopt, true, {}});
    list.push_back({pinion, Kind::profile_crowning, {}, false, {}});
    list.push_back({pinion, Kind::tip_relief, {}, false, lengths});
    if (asked_.modify == "both") list.push_back({true, Kind::tip_relief, {}, false, lengths});
    else list.push_back({pinion, Kind::root_relief, {}, false, lengths});
    return list;
  }
  [[nodiscard]] double depth_mm() const override { return 2 * first().surface.shaper.h_a; }
  [[nodiscard]] contact::SearchOptions model_size() const override { return {}; }
  [[nodiscard]] bool sides_share() const override { return false; }
  [[nodiscard]] int side_of(std::size_t side) const override { return side == 0 ? 1 : -1; }
  [[nodiscard]] Result<contact::SearchModel> model(std::size_t side, const contact::Misalignment& moved,
                                                   const std::vector<SearchedModification>& searched,
                                                   const contact::SearchOptions& options) const override {
    return contact::SearchModel::make(*asked_.gear, side_of(side), asked_.pinion_teeth, asked_.settings.modifications,
                                      moved, searched, options);
  }

  [[nodiscard]] std::vector<Diagnostic> refused(const ease_off::FoundModifications& with) const override {
    auto made = with_more(with.on_gear);
    auto* errors = made.refused();
    return errors != nullptr ? std::move(*errors) : std::vector<Diagnostic>{};
  }

  [[nodiscard]] process::ValueOrErrors<std::vector<ease_off::MisalignmentRow>> rolled(
      const ease_off::FoundModifications& with, const std::vector<ease_off::NamedMisalignment>& list,
      double margin) const override {
    auto on_pinion = asked_.settings.modifications;
    on_pinion.insert(on_pinion.end(), with.on_pinion.begin(), with.on_pinion.end());
    auto made = with_more(with.on_gear);
    if (auto* errors = made.refused()) return std::move(*errors);
    std::array<contact::PairSide, 2> pair;
    for (const std::size_t s : {0u, 1u}) {
      pair[s] = {&made.value(), {}, asked_.pinion_teeth, on_pinion};
      for (int zone = 0; zone < static_cast<int>(made.value().rings().size()); ++zone) {
        auto flank = contact::exact_flank(made.value(), zone, side_of(s), asked_.rows, asked_.columns);
        if (!flank)
          return std::vector{process::located(*asked_.job, fmt::format("gear.zone[{}]", zone), flank.error())};
        pair[s].flanks.push_back(std::move(*flank));
      }
    }
    auto rows = ease_off::roll_rows(
        [&](std::size_t s, const contact::Misalignment& moved) {
          return contact::misaligned_contact(pair[s], moved, asked_.roll, margin);
        },
        list);
    if (!rows) return std::vector{process::located(*asked_.job, "contact.misalignment", rows.error())};
    return std::move(*rows);
  }

 private:
  /// The gear with these modifications behind its own.
  [[nodiscard]] process::ValueOrErrors<face_gear::FaceGear> with_more(
      const std::vector<modification::Modification>& more) const {
    job::Job changed = *asked_.job;
    auto& of_gear = std::get<face_gear::FaceGearParameters>(changed.gear).modifications;
    of_gear.insert(of_gear.end(), more.begin(), more.end());
    return process::make_face_gear(changed);
  }
  [[nodiscard]] const face_gear::FaceGearRing& first() const { return asked_.gear->rings().front(); }
  FacePairAsked asked_;
};

}  // namespace

std::unique_ptr<ease_off::SearchedPair> searched_pair(const FacePairAsked& asked) {
  return std::make_unique<FacePair>(asked);
}

}  // namespace toothpath::face
