// A whole toothed part, as planners and proofs ask for it: its rings of teeth, the turned body that they stand on and
// the blank that they are cut from.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "geometry/base/angle.h"
#include "geometry/base/refusal.h"
#include "geometry/base/vec.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::tooth_space {

/// Asked from several threads. All zones share one chart and one number of teeth, and none overlaps another along s.
/// Their order is that of the job. Lengths in mm; heights are h of the chart.
class ToothedPart {
 public:
  virtual ~ToothedPart() = default;

  [[nodiscard]] virtual int teeth() const = 0;
  [[nodiscard]] virtual int zones() const = 0;
  /// The flanks to aim at, corrections included.
  [[nodiscard]] virtual const ToothSpace& space(int zone) const = 0;
  /// By which tolerances scale: the module.
  [[nodiscard]] virtual double module_mm() const = 0;
  /// Lowest place of the tooth spaces, over all zones.
  [[nodiscard]] virtual double lowest_root() const = 0;
  /// Floor of the relief groove between two zones; nothing where there is one zone.
  [[nodiscard]] virtual std::optional<double> groove_floor() const = 0;
  /// Highest place of the uncut blank.
  [[nodiscard]] virtual double blank_top() const = 0;
  /// Does the uncut blank hold this place?
  [[nodiscard]] virtual bool in_blank(const Vec3& p) const = 0;
  /// Why this gear type takes no question about a zone: key within [gear] and message; none where its surfaces reach.
  [[nodiscard]] virtual std::optional<Refusal> refusal(int /*zone*/) const { return {}; }
  /// Of a zone that begins close to where its flanks begin: that, in words; else empty.
  [[nodiscard]] virtual std::string close_to_limit(int /*zone*/) const { return {}; }
  /// Of such a zone: the same part where it begins farther out by a share of the module, and what it would take in
  /// words. `part`: null where that is no gear.
  struct OtherBegin {
    std::shared_ptr<const ToothedPart> part;
    std::string words;
  };
  [[nodiscard]] virtual std::optional<OtherBegin> begun_later(int /*zone*/, double /*share*/) const { return {}; }

  [[nodiscard]] double pitch() const { return kTwoPi / teeth(); }
  /// Stretch of s between two zones; nothing where there is one zone.
  struct Stretch {
    double from = 0, to = 0;
  };
  [[nodiscard]] std::optional<Stretch> groove() const {
    if (zones() < 2) return {};
    const Outline &a = space(0).outline(), &b = space(1).outline();
    return a.s_to < b.s_from ? Stretch{a.s_to, b.s_from} : Stretch{b.s_to, a.s_from};
  }
  /// Highest z of the uncut blank from its top down to the roots, between the ends of its zones.
  [[nodiscard]] double highest_z() const {
    double s = space(0).outline().s_from;
    for (int zone = 1; zone < zones(); ++zone) s = std::min(s, space(zone).outline().s_from);
    return std::max(chart().z(s, blank_top()), chart().z(s, lowest_root()));
  }
  [[nodiscard]] const Chart& chart() const { return space(0).outline().chart; }

 protected:
  ToothedPart() = default;
  ToothedPart(const ToothedPart&) = default;
  ToothedPart& operator=(const ToothedPart&) = default;
};

}  // namespace toothpath::tooth_space
