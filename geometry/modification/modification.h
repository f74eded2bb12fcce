// Flank modifications: what a drawing takes off a plain flank, by kind, amount, length and law (ISO 21771 words).
//
// A flank is a rectangle here: `depth` below its tip, 0 to the end of the active profile, and `along` its face, from
// the end nearer to the gear's axis outwards. Removal is counted along the normal of the plain flank into the material
// and never negative, grids excepted: where a slope or a hollow would add, the whole flank is set back instead. Beyond
// the rectangle every law goes on along its tangent. mm. Formulas: docs/modifications.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/refusal.h"
#include "geometry/base/result.h"
#include "geometry/modification/smooth_curve.h"

namespace toothpath::modification {

enum class Kind : std::uint8_t {
  tip_relief,
  root_relief,
  end_relief,
  profile_crowning,
  lead_crowning,
  pressure_angle_slope,
  helix_angle_slope,
  twist,
  grid
};
inline constexpr int kKinds = 9;
[[nodiscard]] const char* to_string(Kind kind);
/// Does a kind have a length, and a law?
[[nodiscard]] inline bool is_relief(Kind kind) { return kind <= Kind::end_relief; }

/// How a relief begins: linear with its kink rounded over the transition, or as a parabola.
enum class Law : std::uint8_t { linear, parabolic };
[[nodiscard]] const char* to_string(Law law);
/// Seen from outside towards the axis with the tips up; right: side +1 of a face gear.
enum class Flanks : std::uint8_t { both, left, right };
[[nodiscard]] const char* to_string(Flanks flanks);
enum class Ends : std::uint8_t { both, inner, outer };
[[nodiscard]] const char* to_string(Ends ends);

/// Removals on a rectangular grid: natural cubic splines both ways.
struct Grid {
  std::vector<double> depth_mm, along_mm;  ///< rising; along as it is counted in the file, at least 3 each
  std::vector<double> removal_mm;          ///< of depth k, along n: [k * along.size() + n]
};

/// One modification as a job states it.
struct Modification {
  Kind kind = Kind::tip_relief;
  double amount_mm = 0;  ///< grids: a factor of their values, in place of an amount
  double length_mm = 0;  ///< of reliefs
  Law law = Law::parabolic;
  std::optional<double> transition_mm;  ///< of linear reliefs; none: a quarter of the length
  Flanks flanks = Flanks::both;
  Ends ends = Ends::both;   ///< of end reliefs
  std::optional<int> zone;  ///< none: all
  std::optional<Grid> grid;
  [[nodiscard]] bool meets(int side, int in_zone) const {
    return (flanks == Flanks::both || (flanks == Flanks::right) == (side > 0)) && (!zone || *zone == in_zone);
  }
  [[nodiscard]] double transition() const { return transition_mm.value_or(0.25 * length_mm); }
};

/// Where modifications are counted: depth 0 to `depth_mm`, along `from_mm` to `to_mm`.
struct Rectangle {
  double depth_mm = 0, from_mm = 0, to_mm = 0;
  [[nodiscard]] double face() const { return to_mm - from_mm; }
};

/// What does not fit the rectangle of a zone; nothing: all that meet it fit. Amounts beyond a tenth of the depth,
/// lengths beyond flank or face, transitions that do not fit, grids that are none.
[[nodiscard]] std::optional<Refusal> refused(const std::vector<Modification>& modifications, int zone,
                                             const Rectangle& on);

/// Those whose `zone` the gear does not have: keys modification[k].zone.
[[nodiscard]] std::vector<Refusal> refused_zones(const std::vector<Modification>& modifications, int zones);

/// The sum of modifications of one flank.
class Field {
 public:
  /// A removal that is the product of both.
  struct Term {
    SmoothCurve over_depth, over_face;
  };
  /// Those of `modifications` that meet this flank; amounts of zero are left out.
  /// Precondition: not `refused`.
  Field(const std::vector<Modification>& modifications, int side, int zone, const Rectangle& on);

  [[nodiscard]] bool empty() const { return terms_.empty(); }
  [[nodiscard]] const Rectangle& rectangle() const { return on_; }
  [[nodiscard]] const std::vector<Term>& terms() const { return terms_; }
  /// Removed at a depth and a place along the face, mm.
  template <typename S>
  [[nodiscard]] S removal(const S& depth, const S& along) const {
    S sum(0);
    for (const auto& t : terms_) sum = sum + t.over_depth(depth) * t.over_face(along);
    return sum;
  }

 private:
  void add(const Modification& m);
  void add_grid(const Grid& grid, double factor);
  Rectangle on_;
  std::vector<Term> terms_;
};

}  // namespace toothpath::modification
