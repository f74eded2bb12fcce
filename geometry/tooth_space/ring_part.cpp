#include "geometry/tooth_space/ring_part.h"

#include <algorithm>
#include <utility>

namespace toothpath::tooth_space {
namespace {

class RingPart final : public ToothedPart {
 public:
  RingPart(std::shared_ptr<const ToothSpace> space, const RingNumbers& numbers)
      : space_(std::move(space)), numbers_(numbers), blank_top_(space_->highest_tip()) {}

  [[nodiscard]] int teeth() const override { return numbers_.teeth; }
  [[nodiscard]] int zones() const override { return 1; }
  [[nodiscard]] const ToothSpace& space(int /*zone*/) const override { return *space_; }
  [[nodiscard]] double module_mm() const override { return numbers_.module_mm; }
  [[nodiscard]] double lowest_root() const override { return numbers_.lowest_root; }
  [[nodiscard]] std::optional<double> groove_floor() const override { return {}; }
  [[nodiscard]] double blank_top() const override { return blank_top_; }
  [[nodiscard]] bool in_blank(const Vec3& p) const override {
    const auto& ring = space_->outline();
    const double s = ring.chart.along(p);
    return s >= ring.s_from && s <= ring.s_to && ring.chart.up(p) <= space_->tip(s) &&
           radius(p) >= 0.5 * numbers_.bore_mm;
  }

 private:
  std::shared_ptr<const ToothSpace> space_;
  RingNumbers numbers_;
  double blank_top_;  // asked at every place of a tool
};

}  // namespace

std::shared_ptr<const ToothedPart> ring_part(std::shared_ptr<const ToothSpace> space, const RingNumbers& numbers) {
  return std::make_shared<RingPart>(std::move(space), numbers);
}

}  // namespace toothpath::tooth_space
