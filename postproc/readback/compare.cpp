// Is what the program does what the path asked for? Every CL record met in order, nothing cut in between.
#include <algorithm>
#include <cmath>
#include <optional>

#include "postproc/readback/reader.h"

namespace toothpath::readback {
namespace {

constexpr double kStillTip = 1e-6;  // mm

/// Walks along the motions of one operation, record by record.
class Walk {
 public:
  Walk(const path::ClPath& path, double tolerance, double axis_tolerance, ClComparison& result)
      : path_(path), tolerance_(tolerance), axis_tolerance_(axis_tolerance), result_(result) {}

  void add(const path::ToolMotion& m) { motions_.push_back(&m); }

  bool run() {
    for (std::size_t i = 0; i < path_.records.size(); ++i) {
      record_ = i;
      if (!(path_.records[i].kind == path::MoveKind::rapid ? rapid() : feed())) return false;
    }
    for (; next_ < motions_.size(); ++next_)
      if (!links(*motions_[next_])) return miss("the program feeds on behind the last record");
    return true;
  }

 private:
  const path::ClRecord& record() const { return path_.records[record_]; }

  /// Rapids, and turns with the tip standing still (links with TCP).
  static bool links(const path::ToolMotion& m) { return m.rapid || (m.tip_to - m.tip_from).norm() < kStillTip; }

  /// Links: rapids until the record's pose is reached for good.
  bool rapid() {
    std::optional<std::size_t> met;
    std::size_t j = next_;
    for (; j < motions_.size() && links(*motions_[j]); ++j)
      if (near(motions_[j]->tip_to, motions_[j]->axis_to)) met = j;
    const bool stands = position_known_ && near(tip_, axis_);
    if (!met && stands) return true;
    if (!met) return miss("no rapid ends at this record");
    // The first arrival counts when another rapid record follows, else the last one.
    if (record_ + 1 < path_.records.size() && path_.records[record_ + 1].kind == path::MoveKind::rapid) {
      for (std::size_t k = next_; k < j; ++k)
        if (near(motions_[k]->tip_to, motions_[k]->axis_to)) {
          met = k;
          break;
        }
    }
    stand_at(*motions_[*met]);
    next_ = *met + 1;
    return measure();
  }

  /// From here to the next rapid: where the tool may be at the latest when it meets each record, so that every later
  /// one can still be met. Records as near to each other as their words are rounded would else be met by blocks that
  /// were made for others.
  void find_latest() {
    std::size_t last = record_, end = next_;
    while (last + 1 < path_.records.size() && path_.records[last + 1].kind != path::MoveKind::rapid) ++last;
    while (end < motions_.size() && !motions_[end]->rapid) ++end;
    first_of_run_ = record_;
    latest_.assign(last - record_ + 1, end);
    for (std::size_t r = last + 1; r-- > first_of_run_;) {
      const path::ClRecord& asked = path_.records[r];
      std::size_t k = end;
      while (k > next_ && !near(asked, motions_[k - 1]->tip_to, motions_[k - 1]->axis_to)) --k;
      if (k == next_ && !near(asked, tip_, axis_)) return;  // not met at all, or before the first: said where it is
      latest_[r - first_of_run_] = end = k;
    }
  }

  /// Feed motions up to the one that comes nearest to the record; each must stay on the chord from the record before.
  /// Between two ends of a block the tip may stray by the tolerance, so that it may also fall back by it on the way.
  bool feed() {
    if (path_.records[record_ - 1].kind == path::MoveKind::rapid) find_latest();
    const Vec3 from = path_.records[record_ - 1].tip, to = record().tip;
    double minutes = 0, length = 0;
    double nearest = off(tip_, axis_);
    std::size_t end = next_;
    for (std::size_t j = next_; j < latest_[record_ - first_of_run_]; ++j) {
      const double then = off(motions_[j]->tip_to, motions_[j]->axis_to);
      if (then > nearest + tolerance_) break;
      if (then >= nearest) continue;
      nearest = then;
      end = j + 1;
    }
    for (; next_ < end; ++next_) {
      const path::ToolMotion& m = *motions_[next_];
      const double extra = distance_to_segment(m.tip_to, from, to);
      result_.worst_extra_mm = std::max(result_.worst_extra_mm, extra);
      if (extra > tolerance_) return miss("a block leaves the path before this record", extra);
      minutes += m.minutes;
      length += (m.tip_to - m.tip_from).norm();
      stand_at(m);
    }
    if (minutes > 0) {
      const double ratio = length / minutes / record().feed_mm_min;
      if (length > 10 * tolerance_) result_.fastest_ratio = std::max(result_.fastest_ratio, ratio);
    }
    if (!near(tip_, axis_)) return miss("no block ends at this record", (tip_ - record().tip).norm());
    return measure();
  }

  /// Distance in one number: mm, the axis weighted so that both tolerances count alike.
  double off(const Vec3& tip, const Vec3& axis) const {
    return (tip - record().tip).norm() + angle_between(axis, record().axis) * (tolerance_ / axis_tolerance_);
  }
  bool near(const Vec3& tip, const Vec3& axis) const { return near(record(), tip, axis); }
  bool near(const path::ClRecord& asked, const Vec3& tip, const Vec3& axis) const {
    return (tip - asked.tip).norm() <= tolerance_ && angle_between(axis, asked.axis) <= axis_tolerance_;
  }
  void stand_at(const path::ToolMotion& m) {
    tip_ = m.tip_to;
    axis_ = m.axis_to;
    line_ = m.line;
    position_known_ = true;
  }
  bool measure() {
    result_.worst_mm = std::max(result_.worst_mm, (tip_ - record().tip).norm());
    result_.worst_axis_rad = std::max(result_.worst_axis_rad, angle_between(axis_, record().axis));
    return true;
  }
  bool miss(const std::string& why, double distance = 0) {
    result_.complete = false;
    result_.missed_operation = path_.operation;
    result_.missed_record = record_;
    result_.line = next_ < motions_.size() ? motions_[next_]->line : line_;
    result_.worst_mm = std::max(result_.worst_mm, distance);
    result_.message = fmt::format("operation {} record {} near line {}: {} (distance {:.6f} mm)", path_.operation,
                                  record_, result_.line, why, distance);
    return false;
  }

  const path::ClPath& path_;
  double tolerance_, axis_tolerance_;
  ClComparison& result_;
  std::vector<const path::ToolMotion*> motions_;
  std::size_t next_ = 0, record_ = 0, first_of_run_ = 0;
  std::vector<std::size_t> latest_;  ///< from `first_of_run_`: motions behind the tool when it meets the record
  Vec3 tip_ = Vec3::Zero(), axis_ = Vec3::UnitZ();
  int line_ = 0;
  bool position_known_ = false;
};

}  // namespace

ClComparison compare_with_cl(std::span<const path::ToolMotion> motions, std::span<const path::ClPath* const> paths,
                             double tolerance_mm, double axis_tolerance_rad) {
  ClComparison result;
  result.complete = true;
  for (const path::ClPath* path : paths) {
    Walk walk(*path, tolerance_mm, axis_tolerance_rad, result);
    for (const auto& m : motions)
      if (m.operation == path->operation && m.tooth == 0) walk.add(m);
    if (!walk.run()) break;
  }
  return result;
}

}  // namespace toothpath::readback
