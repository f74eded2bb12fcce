#include "geometry/face_gear/flank_field.h"

#include "geometry/face_gear/space_sheet.h"

namespace toothpath::face_gear {
tooth_space::ModifiedForm modified_form(const FaceGearParameters& gear, const FaceGearRing& ring) {
  FaceGearRing plain = ring.drawn();
  plain.modification = nullptr;
  return tooth_space::modified_form(SpaceSheet(gear, plain), SpaceSheet(gear, ring.drawn()));
}

Expected<std::shared_ptr<const RingModification>, Refusal> ring_modification(const FaceGearParameters& gear,
                                                                             const FaceGearSurface<double>& surface,
                                                                             int zone) {
  using Made = std::shared_ptr<const RingModification>;
  if (gear.modifications.empty()) return Made{};
  const auto on = rectangle_of(surface, gear.zones[std::size_t(zone)]);
  if (auto refusal = modification::refused(gear.modifications, zone, on)) return std::move(*refusal);
  const auto of_side = [&](int side) { return modification::Field(gear.modifications, side, zone, on); };
  auto made = std::make_shared<RingModification>(RingModification{of_side(1), of_side(-1)});
  if (made->plus.empty() && made->minus.empty()) return Made{};
  return Made(std::move(made));
}

}  // namespace toothpath::face_gear
