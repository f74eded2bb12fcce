#include "geometry/cylindrical/part.h"

#include <fmt/format.h>

#include <algorithm>

namespace toothpath::cylindrical {
namespace {

class CylindricalPart final : public tooth_space::ToothedPart {
 public:
  explicit CylindricalPart(CylindricalGear gear) : gear_(std::move(gear)) {}

  [[nodiscard]] int teeth() const override { return gear_.parameters().teeth; }
  [[nodiscard]] int zones() const override { return gear_.zones(); }
  [[nodiscard]] const tooth_space::ToothSpace& space(int zone) const override { return gear_.space(zone); }
  [[nodiscard]] double module_mm() const override { return gear_.parameters().module_mm; }
  [[nodiscard]] double lowest_root() const override { return 0.5 * gear_.root_diameter(); }
  [[nodiscard]] std::optional<double> groove_floor() const override {
    return zones() > 1 ? std::optional(0.5 * gear_.groove_diameter()) : std::nullopt;
  }
  [[nodiscard]] double blank_top() const override { return 0.5 * gear_.tip_diameter(); }
  [[nodiscard]] bool in_blank(const Vec3& p) const override {
    const double r = radius(p), z = p.z();
    const auto& zones = gear_.parameters().zones;
    if (r < 0.5 * gear_.parameters().bore_diameter_mm || z < zones.front().from_mm || z > zones.back().to_mm)
      return false;
    const bool teeth = std::any_of(zones.begin(), zones.end(),
                                   [&](const CylindricalZone& zone) { return z >= zone.from_mm && z <= zone.to_mm; });
    return r <= (teeth ? blank_top() : 0.5 * gear_.groove_diameter());
  }

 private:
  CylindricalGear gear_;
};

}  // namespace

std::shared_ptr<const tooth_space::ToothedPart> part_of(const CylindricalGear& gear) {
  return std::make_shared<CylindricalPart>(gear);
}

tooth_space::ToothedSolid drawn_solid(const CylindricalGear& gear) {
  const double groove = 0.5 * gear.groove_diameter(), bore = 0.5 * gear.parameters().bore_diameter_mm;
  tooth_space::ToothedSolid out;
  out.teeth = gear.parameters().teeth;
  out.module_mm = gear.parameters().module_mm;
  out.lowest_root = 0.5 * gear.root_diameter();
  out.ways_out = {"a smaller tip_diameter leaves a wider land", "a smaller root_radius_coefficient leaves a wider land",
                  "a smaller groove_diameter leaves it"};
  for (int zone = gear.zones() - 1; zone >= 0; --zone) out.rings.push_back({&gear.space(zone), zone});
  for (std::size_t k = 0; k < out.rings.size(); ++k) {
    const bool last = k + 1 == out.rings.size();
    const auto& next = out.rings[last ? 0 : k + 1];
    const double h = last ? bore : groove;
    out.corners.push_back({{out.rings[k].space->outline().s_to, h}, {next.space->outline().s_from, h}});
  }
  return out;
}

}  // namespace toothpath::cylindrical
