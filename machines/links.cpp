#include "machines/links.h"

namespace toothpath::machines {
namespace {

/// Axes from the work to the tool with the bed between them.
std::string order_of(const KinematicChain& chain) {
  if (!chain.order.empty()) return chain.order;
  std::string order;
  for (const RotaryAxis& axis : chain.table) order += axis.letter;
  order += kBedMark;
  order += "XYZ";
  for (const RotaryAxis& axis : chain.head) order += axis.letter;
  return order;
}

}  // namespace

Links::Links(const KinematicChain& chain) : chain_(chain) {
  for (const char letter : order_of(chain)) {
    if (letter == kBedMark) bed_ = joints_.size();
    else if (letter >= 'X') joints_.push_back({letter, false, static_cast<std::size_t>(letter - 'X')});
    else joints_.push_back({letter, true, chain.rotary_index(letter).value_or(0)});
  }
}

std::optional<std::size_t> Links::find(std::string_view name) const {
  if (name == "bed") return bed_;
  if (name == "table") return 0;
  if (name == "spindle") return joints_.size();
  if (name.size() != 1) return std::nullopt;
  for (std::size_t k = 0; k < joints_.size(); ++k)
    if (joints_[k].letter == name.front()) return k < bed_ ? k : k + 1;
  return std::nullopt;
}

std::vector<std::string> Links::names() const {
  std::vector<std::string> all = {"table", "bed", "spindle"};
  for (const Joint& joint : joints_) all.emplace_back(1, joint.letter);
  return all;
}

Vec3 Links::point(std::size_t joint) const {
  return joints_[joint].rotary ? chain_.rotary(joints_[joint].axis).point_mm : Vec3::Zero();
}

Vec3 Links::direction(std::size_t joint) const {
  const Joint& j = joints_[joint];
  return j.rotary ? chain_.rotary(j.axis).direction : Vec3(Vec3::Unit(static_cast<Eigen::Index>(j.axis)));
}

std::vector<Place> Links::places(const Joints& joints) const {
  std::vector<Place> all(count());
  // One joint nearer to the bed at a time, outwards on both sides: what stands behind a joint moves with it.
  const auto moved = [&](const Place& base, std::size_t k, bool work_side) {
    const Joint& j = joints_[k];
    Place out = base;
    if (!j.rotary) {
      const double way = joints.linear_mm[static_cast<Eigen::Index>(j.axis)];
      out.shift += base.turn * (direction(k) * (work_side ? -way : way));
      return out;
    }
    Mat3 turn = chain_.rotary(j.axis).rotation(joints.rotary_rad[j.axis]);
    if (work_side) turn.transposeInPlace();
    out.turn = base.turn * turn;
    out.shift = base.of(point(k) - turn * point(k));
    return out;
  };
  for (std::size_t k = bed_; k-- > 0;) all[k] = moved(all[k + 1], k, true);
  for (std::size_t k = bed_; k < joints_.size(); ++k) all[k + 1] = moved(all[k], k, false);
  return all;
}

}  // namespace toothpath::machines
