#include "postproc/readback/iso/frame_words.h"

#include <algorithm>

#include "geometry/base/angle.h"

namespace toothpath::iso {
namespace {

constexpr int kTurnBehindX = 9;  // parameters of a work offset: X Y Z A B C U V W R

}  // namespace

FrameWords::FrameWords(const readback::NcControl& control, const IsoLanguage& language, NcFlow& flow,
                       readback::NcExecution& execution)
    : control_(control), language_(language), flow_(flow), execution_(execution) {
  for (const auto& [name, at] : control.work_offsets) tell_offset(name, at, 0);
}

std::optional<Diagnostic> FrameWords::select(const Request& r) {
  if (r.offset.empty()) return std::nullopt;
  if (auto bad = flow_.placed(r.column, execution_.select_offset(r.offset))) return bad;
  if (r.offset == control_.index_offset || language_.number_of_offset == nullptr) return std::nullopt;
  const int before = std::exchange(shop_offset_, language_.number_of_offset(r.offset));
  if (shop_offset_ != before) looked_.reset();
  return std::nullopt;
}

std::optional<Diagnostic> FrameWords::zeros(const Request& r) {
  const auto& has = r.move.has;
  if (r.words != 1 + static_cast<std::size_t>(std::count(has.begin(), has.end(), true)) || !moves(r))
    return here(r.column, "G52 stands in a block of its own, with the axes that it is for");
  for (std::size_t a = 0; a < 3; ++a)
    if (has[a] && r.move.axis[a] != 0)
      return here(r.column,
                  fmt::format("G52 {} is not in the subset: it moves the zero of rotaries alone", control_.letters[a]));
  if (clears_zeros(r)) return flow_.placed(r.column, execution_.clear_zeros());
  for (std::size_t a = 3; a < 5; ++a)
    if (has[a])
      if (auto bad = flow_.placed(r.column, execution_.move_zero(a, r.move.axis[a], "G52"))) return bad;
  return std::nullopt;
}

/// Parameters of the control hold the origin of a work offset and its turn: X Y Z A B C, and R. Nothing: where it is
/// they say already.
void FrameWords::tell_offset(const std::string& name, const std::optional<Vec3>& at_mm, double turn_deg) {
  const int number = language_.number_of_offset == nullptr ? -1 : language_.number_of_offset(name);
  if (number < 0) return;
  for (int i = 0; at_mm && i < 6; ++i)
    flow_.tell(static_cast<std::size_t>(language_.origin_parameter(number) + i), i < 3 ? (*at_mm)[i] : 0);
  flow_.tell(static_cast<std::size_t>(language_.origin_parameter(number) + kTurnBehindX), turn_deg);
}

void FrameWords::look() {
  if (language_.origin_parameter == nullptr || shop_offset_ < 0 || looked_ == flow_.seen_zeros()) return;
  looked_ = flow_.seen_zeros();
  const auto x = static_cast<std::size_t>(language_.origin_parameter(shop_offset_));
  bool seen = flow_.seen_zero(x + kTurnBehindX);
  for (std::size_t a = 3; a < 5; ++a)
    if (const char letter = control_.letters[a]; letter >= 'A' && letter <= 'C')
      seen = seen && flow_.seen_zero(x + 3 + static_cast<std::size_t>(letter - 'A'));
  execution_.set_offset_unseen(!seen);
}

std::optional<Diagnostic> FrameWords::write_offset(const Request& r) {
  const auto& has = r.move.has;
  const auto named = static_cast<std::size_t>(std::count(has.begin(), has.end(), true));
  if (!r.l || *r.l != 2) return here(r.write_column, "G10 is read with L2 alone");
  if (control_.index_offset.empty() || !r.p || *r.p != language_.number_of_offset(control_.index_offset))
    return here(r.write_column,
                fmt::format("G10 L2 P{} writes a work offset of the shop: {}", r.p.value_or(0),
                            control_.index_offset.empty() ? "post.index_offset of the machine file names none"
                                                          : "post.index_offset is " + control_.index_offset));
  if (!r.turn || r.words != 4 + named)
    return here(r.write_column, "G10 L2 stands in a block of its own, with P, R and axes");
  bool all = true;
  for (std::size_t a = 0; a < 5; ++a) {
    all = all && (has[a] || control_.letters[a] == 0);
    if (a >= 3 && has[a] && r.move.axis[a] != 0)
      return here(r.write_column, fmt::format("G10 L2 moves the zero of {} by {} deg, limit 0: G52 does that",
                                              control_.letters[a], r.move.axis[a]));
  }
  if (named != 0 && !all) return here(r.write_column, "G10 L2 names all axes of the machine or none");
  const auto at = named == 0 ? std::nullopt : std::optional(Vec3(r.move.axis[0], r.move.axis[1], r.move.axis[2]));
  if (auto bad = flow_.placed(r.write_column, execution_.write_offset(at, *r.turn))) return bad;
  tell_offset(control_.index_offset, at, *r.turn);
  return std::nullopt;
}

std::optional<Diagnostic> FrameWords::tilt(const Request& r) {
  if (r.to_plane) {
    if (!r.p || (*r.p != 1 && *r.p != 2) || r.words != 2)
      return here(r.column, "G53.1 stands in a block of its own, with P1 or P2: which pair of angles is meant");
    const auto pair =
        *r.p == 1 ? readback::NcExecution::PlanePair::not_below_zero : readback::NcExecution::PlanePair::not_above_zero;
    flow_.moved();
    return flow_.placed(r.column, execution_.turn_to_plane(pair, "G53.1", flow_.line()));
  }
  const auto& has = r.move.has;
  if (r.words != 7 || !has[0] || !has[1] || !has[2] || !r.euler[0] || !r.euler[1] || !r.euler[2])
    return here(r.column, "G68.2 stands in a block of its own, with X Y Z I J K");
  if (execution_.in_plane()) return here(r.column, "G68.2 in a tilted plane: G69 is missing ahead of it");
  const Eigen::AngleAxisd turn(radians(*r.euler[0]), Vec3::UnitZ()), tilt(radians(*r.euler[1]), Vec3::UnitX()),
      spin(radians(*r.euler[2]), Vec3::UnitZ());
  return flow_.placed(r.column, execution_.define_plane(Vec3(r.move.axis[0], r.move.axis[1], r.move.axis[2]),
                                                        (turn * tilt * spin).toRotationMatrix(), "G68.2"));
}

bool FrameWords::clears_zeros(const Request& r) const {
  for (std::size_t a = 0; a < 5; ++a)
    if ((!r.move.has[a] && control_.letters[a] != 0) || r.move.axis[a] != 0) return false;
  return true;
}

}  // namespace toothpath::iso
