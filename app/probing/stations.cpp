#include "app/probing/stations.h"

#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::probing {
namespace {

/// Where the gauge point must stand for the ball's centre at a place, against the travels.
class Travels {
 public:
  Travels(const machines::Machine& machine, const joints::Setup& setup, double length)
      : machine_(machine), setup_(setup) {
    for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k)
      zero_.rotary_rad[k] = machine.chain.rotary(k).zero_rad;
    pose_ = machine.chain.forward(zero_, length);
  }
  [[nodiscard]] bool upright() const { return (pose_.axis - Vec3::UnitZ()).norm() < 1e-9; }
  [[nodiscard]] double degrees_of(std::size_t k) const { return degrees(zero_.rotary_rad[k]); }

  [[nodiscard]] Status holds(const Vec3& in_work, const ProbeTouch& touch) const {
    const Vec3 gauge = in_work + setup_.work_offset_at_mm - pose_.tip_mm;
    for (int k = 0; k < 3; ++k) {
      const auto& axis = machine_.chain.linear[std::size_t(k)];
      const double low = axis.min_mm + machine_.limit_margin.linear_mm,
                   high = axis.max_mm - machine_.limit_margin.linear_mm;
      if (!(gauge[k] >= low && gauge[k] <= high))
        return fail("touch {}: {} = {:.4f} mm of the gauge point {} {:.4f} mm", touch.number, "XYZ"[k], gauge[k],
                    gauge[k] > high ? "exceeds" : "is below", gauge[k] > high ? high : low);
    }
    return Ok{};
  }

 private:
  const machines::Machine& machine_;
  const joints::Setup& setup_;
  machines::Joints zero_;
  machines::TablePose pose_;
};

}  // namespace

Status place_touches(const inspection::TouchPlan& plan, const joints::Setup& setup, const machines::Machine& machine,
                     ProbeProgram& program) {
  if (!setup.axis_up)
    return fail("the teeth look away from the spindle (axis = \"down\"): a probe does not reach them");
  const Travels travels(machine, setup, program.probe_length_mm);
  if (!travels.upright()) return fail("with all rotaries at zero the spindle does not stand along Z: no way to probe");
  for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k)
    program.rotaries.emplace_back(machine.chain.rotary(k).letter, travels.degrees_of(k));
  program.top_mm = machine.chain.linear[2].max_mm - machine.limit_margin.linear_mm;
  program.clear_mm = in_work_offset(setup, {0, 0, plan.clear_z_mm}).z() + 0.5 * program.ball_diameter_mm;
  for (const auto& t : plan.touches) {
    ProbeTouch touch;
    touch.number = t.number;
    touch.remark = t.what == inspection::Touched::top ? "TOP OF THE BLANK"
                   : t.what == inspection::Touched::rim
                       ? "RIM OF THE BLANK"
                       : fmt::format("ZONE {} TOOTH {} FLANK {:+}", t.zone, t.tooth, t.side);
    touch.start = in_work_offset(setup, t.start());
    touch.past = in_work_offset(setup, t.centre - kBeyondTouch * t.normal);
    for (const Vec3& at : {touch.start, touch.past, Vec3(touch.start.x(), touch.start.y(), program.clear_mm)})
      if (const auto inside = travels.holds(at, touch); !inside) return inside.error();
    program.touches.push_back(std::move(touch));
  }
  return Ok{};
}

}  // namespace toothpath::probing
