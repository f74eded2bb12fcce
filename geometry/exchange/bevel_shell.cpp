#include "geometry/exchange/bevel_shell.h"

#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "geometry/base/angle.h"
#include "geometry/mesh/bevel_mesh.h"

namespace toothpath::exchange {
namespace {

using bevel_gear::BevelGear;
using bevel_gear::BevelHalf;
using bevel_gear::BevelWall;

/// A piece of the mill's profile: from p_from up to p_to.
struct Piece {
  const char* name;
  double p_from = 0, p_to = 0;
};

/// Walls, root and land of one half.
class HalfRows {
 public:
  HalfRows(const BevelGear& gear, const BevelHalf& half) : gear_(gear), half_(half) {
    const auto& c = gear.cutter();
    for (const Piece& piece : {Piece{"fillet", c.p_A, c.p_B}, Piece{"straight", c.p_B, c.p_C}})
      if (piece.p_to - piece.p_from >= kLeastFace_mm) low_.push_back(piece);
  }

  [[nodiscard]] double ell(double u) const {
    return u >= 1 ? half_.ell_to : half_.ell_from + u * (half_.ell_to - half_.ell_from);
  }
  [[nodiscard]] std::vector<Strip> strips() const {
    std::vector<Strip> out{{"flank L", 0}};
    for (auto piece = low_.rbegin(); piece != low_.rend(); ++piece)
      out.push_back({fmt::format("{} L", piece->name), 0});
    out.push_back({"root", 0});
    for (const Piece& piece : low_) out.push_back({fmt::format("{} U", piece.name), 1});
    out.push_back({"flank U", 1});
    out.push_back({"top land", 1});
    return out;
  }
  [[nodiscard]] std::size_t foot() const { return 1 + low_.size(); }

  [[nodiscard]] Result<std::vector<std::vector<Vec3>>> at(double u, const std::vector<std::vector<double>>& v) const {
    std::vector<std::vector<Vec3>> out(v.size());
    const auto tip_L = tip(u, 0), tip_U = tip(u, 1);
    if (!tip_L) return tip_L.error();
    if (!tip_U) return tip_U.error();
    const std::size_t low = low_.size();
    for (std::size_t k = 0; k < v.size(); ++k)
      for (const double share : v[k]) {
        Result<Vec3> p = Vec3::Zero().eval();
        const std::size_t up = v.size() - 2 - k;  // of wall U: 0 is the flank
        if (k <= low) p = wall_point(u, 0, k == 0 ? flank(*tip_L) : low_[low - k], 1 - share);
        else if (k == low + 1) p = between(u, false, share);
        else if (k + 1 == v.size()) p = between(u, true, share);
        else p = wall_point(u, 1, up == 0 ? flank(*tip_U) : low_[low - up], share);
        if (!p) return p.error();
        out[k].push_back(*p);
      }
    return out;
  }

 private:
  [[nodiscard]] Piece flank(double p_tip) const {
    return {"flank", low_.empty() ? gear_.cutter().p_A : low_.back().p_to, p_tip};
  }
  [[nodiscard]] const BevelWall<double>& wall(int k) const { return half_.walls[k]; }
  [[nodiscard]] static const char* letter(int k) { return k == 0 ? "L" : "U"; }

  /// Profile parameter at the tip.
  [[nodiscard]] Result<double> tip(double u, int k) const {
    const auto at = bevel_gear::bevel_inverse(wall(k), ell(u), gear_.parameters().addendum_mm);
    if (!at) return fail("wall {} does not reach the tip at cone distance {:.4f} mm", letter(k), ell(u));
    return at->p;
  }
  [[nodiscard]] Result<Vec3> wall_point(double u, int k, const Piece& piece, double share) const {
    const double p = share >= 1 ? piece.p_to : piece.p_from + share * (piece.p_to - piece.p_from);
    const auto beta = bevel_gear::bevel_beta_at(wall(k), ell(u), p);
    if (!beta) return fail("wall {} does not reach the root at cone distance {:.4f} mm", letter(k), ell(u));
    return wall(k).point(*beta, p).p;
  }
  /// Root, or the land behind it.
  [[nodiscard]] Result<Vec3> between(double u, bool land, double share) const {
    std::array<Vec3, 2> ends;
    for (int k = 0; k < 2; ++k) {
      const auto p_tip = tip(u, k);
      if (!p_tip) return p_tip.error();
      const auto p =
          land ? wall_point(u, k, flank(*p_tip), 1) : wall_point(u, k, low_.empty() ? flank(*p_tip) : low_.front(), 0);
      if (!p) return p.error();
      ends[std::size_t(k)] = *p;
    }
    if (land) {
      std::swap(ends[0], ends[1]);
      ends[1] = turned(ends[1], gear_.pitch());
    }
    if (share <= 0) return ends[0];
    if (share >= 1) return ends[1];
    const double width = angle_from_to(ends[0], ends[1]);
    if (!(width * radius(ends[0]) >= kLeastFace_mm))
      return fail("{} = {:.6f} mm at cone distance {:.4f} mm is below {:g} mm: no face of a solid",
                  land ? "top land" : "root land", width * radius(ends[0]), ell(u), kLeastFace_mm);
    return turned(ends[0], share * width);
  }

  const BevelGear gear_;
  const BevelHalf half_;
  std::vector<Piece> low_;  ///< below the involute, from the root up
};

Corner corner_at(const BevelGear& gear, double ell, double height) {
  const Vec3 p = bevel_gear::blank_point(ell, height, 0, gear.sin_delta(), gear.cos_delta());
  return {p.x(), p.z()};
}

}  // namespace

Result<GearShell> bevel_gear_shell(const BevelGear& gear) {
  GearShell shell;
  shell.teeth = gear.parameters().teeth;
  shell.outward = -1;
  const auto& halves = gear.halves();
  for (std::size_t k = 0; k < halves.size(); ++k) {
    const auto rows = std::make_shared<HalfRows>(gear, halves[k]);
    ToothRing ring;
    ring.strips = rows->strips();
    ring.foot = rows->foot();
    ring.row = [rows](double u, const std::vector<std::vector<double>>& v) { return rows->at(u, v); };
    ring.foot_on_circle = {k > 0, k + 1 < halves.size()};
    ring.place = fmt::format("half {}", k);
    ring.station = [rows](double u) { return fmt::format("cone distance {:.4f} mm", rows->ell(u)); };
    shell.rings.push_back(std::move(ring));
    if (k + 1 < halves.size()) {
      const double floor = -gear.parameters().dedendum_mm;
      shell.corners.push_back(
          {corner_at(gear, halves[k].ell_to, floor), corner_at(gear, halves[k + 1].ell_from, floor)});
    }
  }
  const double under = mesh::underside_height(gear);
  shell.corners.push_back(
      {corner_at(gear, halves.back().ell_to, under), corner_at(gear, halves.front().ell_from, under)});
  return shell;
}

}  // namespace toothpath::exchange
