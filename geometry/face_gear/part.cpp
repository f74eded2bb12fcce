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
constexpr double kWebModules = 0.5;    // top of the web below it
constexpr double kLeastModules = 1;    // least thickness below it that a drawing may say

double lowest_z(const FaceGear& gear) {
  return gear.rings().size() > 1 ? std::min(gear.lowest_root(), gear.groove_floor()) : gear.lowest_root();
}

double tip_z(const FaceGear& gear) { return gear.blank_top() - gear.parameters().allowance_top_mm; }

double back_z(const FaceGear& gear, const Body& body) {
  return body.thickness_mm > 0 ? tip_z(gear) - body.thickness_mm
                               : lowest_z(gear) - kBaseModules * gear.parameters().module_mm;
}

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

std::optional<Refusal> body_refusal(const FaceGear& gear, const Body& body) {
  const double inside = 2 * gear.inner_radius(), outside = 2 * gear.outer_radius(),
               bore = body.bore_mm.value_or(inside),
               least = tip_z(gear) - lowest_z(gear) + kLeastModules * gear.parameters().module_mm;
  if (body.thickness_mm > 0 && body.thickness_mm < least)
    return Refusal{"stock.thickness",
                   fail("thickness = {:.4f} mm is below {:.4f} mm, from the tips to {} module below roots and groove",
                        body.thickness_mm, least, kLeastModules)};
  if (bore > inside)
    return Refusal{"stock.bore_diameter",
                   fail("bore_diameter = {:.4f} mm exceeds {:.4f} mm, where the teeth begin", bore, inside)};
  if (body.hub_length_mm > 0 && !(body.hub_mm > bore && body.hub_mm < outside))
    return Refusal{"stock.hub_diameter",
                   fail("hub_diameter = {:.4f} mm is not between the bore, {:.4f} mm, and {:.4f} mm, the teeth",
                        body.hub_mm, bore, outside)};
  return {};
}

double underside_z(const FaceGear& gear, const Body& body) { return back_z(gear, body) - body.hub_length_mm; }

std::optional<double> web_z(const FaceGear& gear, const Body& body) {
  if (!body.bore_mm || *body.bore_mm >= 2 * gear.inner_radius()) return {};
  return lowest_z(gear) - kWebModules * gear.parameters().module_mm;
}

tooth_space::ToothedSolid drawn_solid(const FaceGear& gear, const Body& body) {
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
  const double back = back_z(gear, body), under = underside_z(gear, body), inner = gear.inner_radius(),
               bore = body.bore_mm ? 0.5 * *body.bore_mm : inner;
  std::vector<Vec2> outline = {{gear.outer_radius(), back}};
  if (under < back)
    for (const double z : {back, under}) outline.emplace_back(0.5 * body.hub_mm, z);
  outline.emplace_back(bore, under);
  if (const auto web = web_z(gear, body))
    for (const double r : {bore, inner}) outline.emplace_back(r, *web);
  out.corners.push_back(std::move(outline));
  return out;
}

}  // namespace toothpath::face_gear
