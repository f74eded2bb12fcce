// How near shank and holder come to the finished part itself: a gap that exists at a place of it. The proof keeps both
// out of the whole blank, so the proven gap is never above this one (cam/finger/obstacles.h).
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "cam/path/tool_motion.h"
#include "cam/tool/body.h"
#include "geometry/bevel_gear/gear.h"

namespace toothpath::finger {

struct FoundGap {
  double gap_mm = std::numeric_limits<double>::infinity();  ///< negative: the place is so deep in the body
  Vec3 place = Vec3::Zero();                                ///< blank frame
  double t = 0;                                             ///< where on the motion, 0 .. 1
  const char* patch = "";                                   ///< "land", "end", "hub" or "shaft"
};

/// Lands of all teeth between their exact tip edges, ends of the teeth below them, hub and shaft.
class FingerClearance {
 public:
  explicit FingerClearance(const bevel_gear::BevelGear& gear);
  FingerClearance(const FingerClearance&) = delete;
  FingerClearance& operator=(const FingerClearance&) = delete;

  /// Least gap found between one body and the part over a motion; `best` where none is less. Searched downhill in place
  /// and moment from a look at five moments: what is told exists, and a nearer place may be missed.
  [[nodiscard]] FoundGap least(const tool::Frustum& body, const path::ToolMotion& m, const FoundGap& best) const;

 private:
  /// Tip edges of one half of tooth space 0 by cone distance, in even steps.
  struct Edges {
    const bevel_gear::BevelHalf* half = nullptr;
    double from = 0, to = 0;
    std::vector<std::array<double, 2>> azimuth;  ///< wall L, wall U
  };
  /// A piece of the surface over the unit square.
  struct Patch {
    enum class Kind { land, end, turned } kind = Kind::turned;
    const char* name = "";
    std::size_t half = 0;
    int tooth = 0;
    Vec2 a = Vec2::Zero(), b = Vec2::Zero();  ///< turned: a line (r, z). End: its cone distance is a.x
    Vec3 centre = Vec3::Zero();
    double radius = 0;              ///< of a sphere about it
    double size_u = 0, size_w = 0;  ///< mm
  };
  [[nodiscard]] Edges edges_of(const bevel_gear::BevelHalf& half) const;
  /// Azimuths of both sides of the tooth that follows space 0; `exact`: by Newton, else between the stations. Not a
  /// number where the wall has no such place.
  [[nodiscard]] std::array<double, 2> sides(const Edges& edges, double ell, bool exact) const;
  [[nodiscard]] Vec3 place(const Patch& patch, double u, double w, bool exact = false) const;
  void add(Patch patch);

  bevel_gear::BevelGear gear_;
  std::vector<Edges> edges_;
  std::vector<Patch> patches_;
};

}  // namespace toothpath::finger
