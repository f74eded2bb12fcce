#include "postproc/choice/travel_offer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "postproc/numbers/small_linear_program.h"

namespace toothpath::choice {
namespace {

constexpr std::size_t kMostPairs = std::size_t{1} << 21;
constexpr double kFarthest = 5000;  // mm: shifts and rooms looked at
constexpr double kEqual = 1e-6;     // mm: two rooms are the same
constexpr double kSlack = 1e-7;     // mm: by which a room that is fixed may be missed in the next step

}  // namespace

TravelPoses::TravelPoses(const machines::KinematicChain& chain, const machines::LimitMargin& margin,
                         const std::optional<Vec3>& keep_on)
    : chain_(chain), keep_on_(keep_on) {
  for (std::size_t i = 0; i < 3; ++i) {
    low_[i] = chain.linear[i].min_mm + margin.linear_mm;
    high_[i] = chain.linear[i].max_mm - margin.linear_mm;
  }
}

void TravelPoses::note(const machines::Joints& joints) {
  if (too_many_) return;
  // On the axis of the first rotary its angle does not count.
  std::array<double, 2> angles = joints.rotary_rad;
  if (keep_on_) angles[0] = 0;
  for (std::size_t k = 0; k < 2; ++k)
    if (k >= chain_.table.size()) angles[k] = 0;
  const std::array<std::uint64_t, 2> key = {std::bit_cast<std::uint64_t>(angles[0]),
                                            std::bit_cast<std::uint64_t>(angles[1])};
  const auto [place, added] = index_.try_emplace(key, list_.size());
  if (added) {
    if (list_.size() >= kMostPairs) {
      too_many_ = true;
      return;
    }
    Mat3 turn;
    const Vec3 zero = chain_.table_to_machine(Vec3::Zero(), angles);
    for (int m = 0; m < 3; ++m) turn.col(m) = chain_.table_to_machine(Vec3::Unit(m), angles) - zero;
    list_.push_back({turn, joints.linear_mm, joints.linear_mm});
    return;
  }
  Extremes& e = list_[place->second];
  e.least = e.least.cwiseMin(joints.linear_mm);
  e.greatest = e.greatest.cwiseMax(joints.linear_mm);
}

std::array<double, 3> TravelPoses::room(const Vec3& shift_mm) const {
  std::array<double, 3> out;
  out.fill(std::numeric_limits<double>::infinity());
  for (const auto& e : list_) {
    const Vec3 moved = e.turn * shift_mm;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      out[k] = std::min({out[k], e.least[i] + moved[i] - low_[k], high_[k] - e.greatest[i] - moved[i]});
    }
  }
  return out;
}

std::optional<TravelOffer> TravelPoses::best() const {
  if (list_.empty() || too_many_) return std::nullopt;
  const auto up = best(true);
  if (up && *std::min_element(up->room_then_mm.begin(), up->room_then_mm.end()) >= 0) return up;
  return best(false);
}

/// The linear program of one offer, joint by joint: the least room of all, then what the others can still have.
class TravelPoses::RoomProgram {
 public:
  RoomProgram(const TravelPoses& poses, bool only_up)
      : poses_(poses),
        only_up_(only_up),
        shifts_(poses.keep_on_ ? 1 : 3),
        room_at_(static_cast<std::size_t>(shifts_)) {}

  /// Shift and last room; nothing where not even the first program has a solution.
  std::optional<numbers::LinearPoint> solve() {
    std::optional<numbers::LinearPoint> found;
    for (int left = 3; left > 0;) {
      const auto x = greatest_room();
      if (!x) break;
      found = x;
      const double least = (*x)[room_at_];
      const std::array<bool, 3> tight = tight_at(least);
      const bool none = std::count(tight.begin(), tight.end(), true) == 0;
      for (std::size_t j = 0; j < 3; ++j)
        if (!kept_[j] && (tight[j] || none)) {
          keep(j, least);
          --left;
        }
    }
    return found;
  }
  [[nodiscard]] Vec3 shift_of(const numbers::LinearPoint& x) const {
    return poses_.keep_on_ ? Vec3(x[0] * *poses_.keep_on_) : Vec3(x[0], x[1], x[2]);
  }

 private:
  void keep(std::size_t joint, double room) {
    kept_[joint] = true;
    fixed_[joint] = room - kSlack;
  }
  [[nodiscard]] std::optional<numbers::LinearPoint> greatest_room() const {
    numbers::LinearPoint objective{};
    objective[room_at_] = 1;
    return numbers::maximize(shifts_ + 1, objective, kFarthest,
                             [&](const numbers::LinearPoint& x) { return most_broken(x); });
  }
  /// Which joints cannot have more than that, whatever the others give up down to it?
  std::array<bool, 3> tight_at(double least) {
    const auto kept_before = kept_;
    const auto fixed_before = fixed_;
    std::array<bool, 3> tight{};
    for (std::size_t j = 0; j < 3; ++j) {
      if (kept_before[j]) continue;
      for (std::size_t k = 0; k < 3; ++k)
        if (!kept_before[k] && k != j) keep(k, least);
      const auto more = greatest_room();
      kept_ = kept_before;
      fixed_ = fixed_before;
      tight[j] = !more || (*more)[room_at_] <= least + kEqual;
    }
    return tight;
  }
  /// The row that x breaks most: joint i keeps its fixed room, or the room that is a variable.
  [[nodiscard]] numbers::LinearRow most_broken(const numbers::LinearPoint& x) const {
    numbers::LinearRow worst;
    double greatest = -std::numeric_limits<double>::infinity();
    const Vec3 d = shift_of(x);
    const auto& keep_on = poses_.keep_on_;
    if (only_up_) {
      greatest = -d.z();
      if (keep_on) worst.a[0] = -keep_on->z();
      else worst.a[2] = -1;
    }
    for (const auto& e : poses_.list_) {
      const Vec3 moved = e.turn * d;
      for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double asked = kept_[k] ? fixed_[k] : x[room_at_];
        for (const double side : {1.0, -1.0}) {
          const double free = side > 0 ? poses_.high_[k] - e.greatest[i] : e.least[i] - poses_.low_[k];
          const double excess = side * moved[i] + asked - free;
          if (excess <= greatest) continue;
          greatest = excess;
          worst = {};
          if (keep_on) worst.a[0] = side * e.turn.row(i).dot(*keep_on);
          else
            for (int m = 0; m < 3; ++m) worst.a[static_cast<std::size_t>(m)] = side * e.turn(i, m);
          worst.b = free;
          if (kept_[k]) worst.b -= fixed_[k];
          else worst.a[room_at_] = 1;
        }
      }
    }
    return worst;
  }

  const TravelPoses& poses_;
  bool only_up_;
  int shifts_;
  std::size_t room_at_;
  std::array<bool, 3> kept_{};
  std::array<double, 3> fixed_{};  ///< room of the joints that are kept
};

std::optional<TravelOffer> TravelPoses::best(bool only_up) const {
  RoomProgram program(*this, only_up);
  const auto found = program.solve();
  if (!found) return std::nullopt;
  TravelOffer offer;
  for (int m = 0; m < 3; ++m) offer.shift_mm[m] = std::round(program.shift_of(*found)[m] * 1e3) / 1e3;
  if (keep_on_) offer.shift_mm = std::round((*found)[0] * 1e3) / 1e3 * *keep_on_;
  if (offer.shift_mm.z() == 0) offer.shift_mm.z() = 0;  // no -0
  offer.on_index_axis = keep_on_.has_value();
  offer.room_now_mm = room(Vec3::Zero());
  offer.room_then_mm = room(offer.shift_mm);
  return offer;
}

}  // namespace toothpath::choice
