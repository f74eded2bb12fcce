#include "geometry/face_gear/part.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/face_gear/space_sheet.h"

namespace toothpath::face_gear {
namespace {

constexpr double kCloseToLimit = 0.5;  // of the module
constexpr double kToldSize = 0.01;     // mm: to which another begin is told
constexpr double kBaseModules = 2.5;   // thickness below the lowest point of teeth and groove

class FacePart final : public tooth_space::ToothedPart {
 public:
  explicit FacePart(const FaceGear& gear) : gear_(gear) {
    for (const auto& ring : gear_.rings()) spaces_.push_back(std::make_unique<SpaceSheet>(gear_.parameters(), ring));
  }

  [[nodiscard]] int teeth() const override { return gear_.parameters().teeth; }
  [[nodiscard]] int zones() const override { return int(spaces_.size()); }
  [[nodiscard]] const SpaceSheet& space(int zone) const override { return *spaces_[std::size_t(zone)]; }
  [[nodiscard]] double module_mm() const override { return gear_.parameters().module_mm; }
  [[nodiscard]] double lowest_root() const override { return gear_.lowest_root(); }
  [[nodiscard]] std::optional<double> groove_floor() const override {
    return spaces_.size() > 1 ? std::optional(gear_.groove_floor()) : std::nullopt;
  }
  [[nodiscard]] double blank_top() const override { return gear_.blank_top(); }
  [[nodiscard]] bool in_blank(const Vec3& p) const override { return gear_.in_blank(p); }
  [[nodiscard]] std::optional<Refusal> refusal(int zone) const override;
  [[nodiscard]] std::string close_to_limit(int zone) const override;
  [[nodiscard]] std::optional<OtherBegin> begun_later(int zone, double share) const override;

 private:
  [[nodiscard]] const FaceGearRing& ring(int zone) const { return gear_.rings()[std::size_t(zone)]; }
  [[nodiscard]] double beyond_limit(int zone) const {
    return ring(zone).zone.inner_radius_mm - ring(zone).limits.hard_inner_limit;
  }

  FaceGear gear_;
  std::vector<std::unique_ptr<SpaceSheet>> spaces_;
};

/// A flank whose fold lies below the tip surface somewhere on the ring, with the radius from which it reaches it.
std::optional<Refusal> FacePart::refusal(int zone) const {
  constexpr int kSections = 16, kHalvings = 30;
  const SpaceSheet& space = this->space(zone);
  const double inner = ring(zone).zone.inner_radius_mm, step = (ring(zone).zone.outer_radius_mm - inner) / kSections;
  for (const int side : {1, -1})
    for (int k = kSections; k >= 0; --k) {
      double folded = inner + k * step, reaches = folded + step;
      if (space.tip_edge(side, folded)) continue;
      for (int n = 0; n < kHalvings && k < kSections; ++n) {
        const double middle = 0.5 * (folded + reaches);
        (space.tip_edge(side, middle) ? reaches : folded) = middle;
      }
      const std::string way_out =
          k < kSections
              ? fmt::format("an inner_radius of at least {:.4f} mm would do", reaches)
              : std::string("no ring that ends there would do: fewer shaper teeth or more pressure angle are needed");
      return Refusal{
          fmt::format("zone[{}]", zone),
          fail("zone {}: at radius {:.4f} mm flank side {:+d} folds back (undercut) below the tip surface at height "
               "{:.4f} mm; {}",
               zone, inner + k * step, side, space.surface().z_tip(inner + k * step), way_out)};
    }
  return {};
}

std::string FacePart::close_to_limit(int zone) const {
  if (beyond_limit(zone) > kCloseToLimit * module_mm()) return "";
  return fmt::format(" (the zone begins {:.4f} mm outside its limit, {:.4f} mm)", beyond_limit(zone),
                     ring(zone).limits.hard_inner_limit);
}

std::optional<tooth_space::ToothedPart::OtherBegin> FacePart::begun_later(int zone, double share) const {
  const double inner = ring(zone).zone.inner_radius_mm;
  if (ring(zone).correction || beyond_limit(zone) > kCloseToLimit * module_mm()) return {};
  FaceGearParameters moved = gear_.parameters();
  auto& its = moved.zones[std::size_t(zone)];
  its.inner_radius_mm = std::ceil((inner + share * module_mm()) / kToldSize) * kToldSize;
  if (!(its.inner_radius_mm < its.outer_radius_mm)) return {};
  auto gear = FaceGear::make(moved);
  if (gear.refused()) return OtherBegin{nullptr, ""};
  return OtherBegin{part_of(std::move(gear).value()),
                    fmt::format("an inner_radius of {:.2f} mm (now {:g})", its.inner_radius_mm, inner)};
}

}  // namespace

std::shared_ptr<const tooth_space::ToothedPart> part_of(const FaceGear& gear) {
  return std::make_shared<FacePart>(gear);
}

double underside_z(const FaceGear& gear) {
  const double lowest = gear.lowest_root();
  const double floor = gear.rings().size() > 1 ? std::min(lowest, gear.groove_floor()) : lowest;
  return floor - kBaseModules * gear.parameters().module_mm;
}

tooth_space::ToothedSolid drawn_solid(const FaceGear& gear) {
  const auto& rings = gear.rings();
  tooth_space::ToothedSolid out;
  out.teeth = gear.parameters().teeth;
  out.module_mm = gear.parameters().module_mm;
  out.lowest_root = gear.lowest_root();
  out.measured_on_one_tooth = true;
  out.flanks_begin = 0;  // of the involute
  out.ways_out = {"a smaller outer radius leaves a wider land", "a smaller shaper_tip_radius leaves a wider land",
                  "a deeper stock.groove_depth leaves it"};
  for (std::size_t k = 0; k < rings.size(); ++k) {
    out.rings.push_back({&gear.drawn(k), int(k)});
    if (k + 1 < rings.size())
      out.corners.push_back({{rings[k].zone.outer_radius_mm, gear.groove_floor()},
                             {rings[k + 1].zone.inner_radius_mm, gear.groove_floor()}});
  }
  const double under = underside_z(gear);
  out.corners.push_back({{gear.outer_radius(), under}, {gear.inner_radius(), under}});
  return out;
}

}  // namespace toothpath::face_gear
