#include "cam/analytic/body_patches.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cam/analytic/gear_distance.h"

namespace toothpath::analytic {
namespace {

using tooth_space::Piece;

constexpr double kStands = 1e-9;     // mm: a place this far beyond a border still counts
constexpr double kPlainSag = 0.005;  // mm: cells whose bound is larger are looked at more closely
constexpr int kClosest = 3;          // halvings each way for that
constexpr int kSteps = 8;            // of Newton back to a border

/// Extent of the parameters of a quad.
Vec2 extent(const BodyQuad& q) {
  Vec2 low = q.at[0], high = q.at[0];
  for (const Vec2& x : q.at) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  return high - low;
}

bool is_round(const BodySurface& s) { return s.end() || s.piece == Piece::groove; }

/// Radius, middle azimuth and width of the arc that a quad of an end or of the floor spans, and how far its radius
/// changes along the arc.
struct Arc {
  double r = 0, width = 0, slant = 0;
  Vec3 outwards = Vec3::UnitX();
};
Arc arc_of(const BodyQuad& q, const tooth_space::Chart& chart) {
  Arc arc;
  const Vec3 &a = q.corner[0], &b = q.corner[1];
  for (const Vec3& c : q.corner) arc.r = std::max(arc.r, radius(c));
  if (chart.sine > 0)
    arc.slant = std::max(std::abs(radius(b) - radius(a)), std::abs(radius(q.corner[2]) - radius(q.corner[3])));
  arc.width = std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.x() * b.x() + a.y() * b.y()));
  arc.outwards = Vec3(a.x() + b.x(), a.y() + b.y(), 0).normalized();
  return arc;
}

}  // namespace

BodyPatches::BodyPatches(const tooth_space::ToothSpace& space, BodyRing ring, std::size_t cells)
    : space_(space), ring_(std::move(ring)), cells_(cells), boxes_(cells) {}

void BodyPatches::add_blocks(const std::vector<SheetBlock>& blocks) {
  std::vector<std::vector<MadeBlock>> made(blocks.size());
  tbb::parallel_for(std::size_t(0), blocks.size(), [&](std::size_t n) { make(blocks[n], made[n]); });
  std::vector<std::size_t> added;
  for (const auto& parts : made)
    for (const auto& [block, cells] : parts) {
      sampled_ += block.sampled ? 1 : 0;
      blocks_.push_back(block);
      for (const auto& c : cells) {
        Cell& cell = cells_[c.index] = Cell{};
        cell.surface.piece = block.piece;
        cell.block = std::uint32_t(blocks_.size() - 1);
        for (std::size_t k = 0; k < 4; ++k) {
          cell.quad.at[k] = block.frame.ab(c.uv[k]);
          cell.quad.corner[k] = c.corner[k];
          cell.quad.stands[k] = on_ring(space_, c.corner[k], kStands);
        }
        added.push_back(c.index);
      }
    }
  tbb::parallel_for(std::size_t(0), added.size(), [&](std::size_t n) { measure(added[n]); });
  for (const std::size_t index : added) search_margin_ = std::max(search_margin_, cells_[index].sag);
}

void BodyPatches::make(const SheetBlock& of, std::vector<MadeBlock>& out) const {
  const auto& [piece, cells] = of;
  if (cells.empty()) return;
  Block block;
  block.piece = piece;
  Vec2 origin = Vec2::Zero(), a = Vec2::Zero(), b = Vec2::Zero();
  const double share = 1.0 / double(cells.size());
  for (const auto& c : cells) {
    origin += 0.25 * share * (c.uv[0] + c.uv[1] + c.uv[2] + c.uv[3]);
    a += 0.5 * share * (c.uv[1] - c.uv[0] + c.uv[2] - c.uv[3]);
    b += 0.5 * share * (c.uv[3] - c.uv[0] + c.uv[2] - c.uv[1]);
  }
  block.frame = {origin, a, b};
  double half_a = 0, half_b = 0;
  for (const auto& c : cells)
    for (const Vec2& uv : c.uv) {
      const Vec2 ab = block.frame.ab(uv);
      half_a = std::max(half_a, std::abs(ab.x()));
      half_b = std::max(half_b, std::abs(ab.y()));
    }
  half_a *= 1 + 1e-12;
  half_b *= 1 + 1e-12;
  if (const auto bend = patch_bend(space_, piece, block.frame, half_a, half_b)) {
    block.bend = *bend;
  } else if (cells.size() > 1) {
    for (const auto& c : cells) make({piece, {c}}, out);  // a smaller box may do
    return;
  } else {
    const auto sliced = sliced_bend(space_, piece, block.frame, half_a, half_b);
    block.sampled = !sliced;
    block.bend = sliced ? *sliced : sheet_bend(block, half_a, half_b);
  }
  out.push_back({block, cells});
}

/// From second differences, where no proven bound is found.
PatchBend BodyPatches::sheet_bend(const Block& block, double half_a, double half_b) const {
  const auto p = [&](double a, double b) {
    const Vec2 uv = block.frame.uv({a * half_a, b * half_b});
    const auto q = space_.point(block.piece, uv.x(), uv.y());
    return q ? q->p : Vec3(Vec3::Constant(NAN));
  };
  PatchBend bend;
  const Vec3 middle = p(0, 0);
  const auto size = [](const Vec3& x) { return std::isfinite(x.norm()) ? kSampleDoubt * x.norm() : 1e3; };
  bend.spread_aa = size(p(1, 0) - 2 * middle + p(-1, 0)) / (half_a * half_a);
  bend.spread_bb = size(p(0, 1) - 2 * middle + p(0, -1)) / (half_b * half_b);
  bend.spread_ab = size(p(1, 1) - p(1, -1) - p(-1, 1) + p(-1, -1)) / (4 * half_a * half_b);
  return bend;
}

void BodyPatches::add(std::size_t index, BodySurface surface, const Vec2& low, const Vec2& high,
                      const std::array<Vec3, 4>& found_by) {
  Cell& cell = cells_[index] = Cell{};
  cell.surface = surface;
  if (surface.piece == Piece::tip) {
    Block block;
    block.bend = land_bend(low.y(), high.y());
    cell.block = std::uint32_t(blocks_.size());
    blocks_.push_back(block);
  }
  cell.quad = made(cell, {low, Vec2(high.x(), low.y()), high, Vec2(low.x(), high.y())});
  measure(index);
  double off = 0;
  for (const Vec3& c : cell.quad.corner) {
    double least = INFINITY;
    for (const Vec3& f : found_by) least = std::min(least, (c - f).norm());
    off = std::max(off, least);
  }
  search_margin_ = std::max(search_margin_, off + cells_[index].sag);
}

/// Sag and box of a cell whose quad stands.
void BodyPatches::measure(std::size_t index) {
  Cell& kept = cells_[index];
  kept.sag = cell_sag(index);
  const auto& c = kept.quad.corner;
  BodyBox& box = boxes_[index] = {0.25 * (c[0] + c[1] + c[2] + c[3]), 0.25 * (c[1] - c[0] + c[2] - c[3]),
                                  0.25 * (c[3] - c[0] + c[2] - c[1]), 0, 0};
  for (const Vec3& corner : c) box.radius = std::max(box.radius, (corner - box.centre).norm());
  box.radius += kept.sag;
  box.off = 0.25 * (c[0] - c[1] + c[2] - c[3]).norm() + kept.sag;  // its corners leave one plane
}

/// Where the parameters of a cell bend its quad far along the surface, its halves tell better how far that leaves the
/// hull of the corners: by their own sag, and by as much as their corners leave it.
double BodyPatches::cell_sag(std::size_t index) const {
  const BodyQuad& whole = cells_[index].quad;
  const double plain = sag(index, whole);
  if (plain <= kPlainSag) return plain;
  std::vector<BodyQuad> quads{whole};
  double best = plain;
  for (int k = 0; k < 2 * kClosest && best > kPlainSag; ++k) {
    std::vector<BodyQuad> halves;
    double most = 0, off = 0;
    for (const auto& q : quads)
      for (const auto& h : halved(index, q)) {
        most = std::max(most, sag(index, h));
        for (const Vec3& c : h.corner)
          off = std::max(off, std::min({distance_to_triangle(c, whole.corner[0], whole.corner[1], whole.corner[2]),
                                        distance_to_triangle(c, whole.corner[0], whole.corner[2], whole.corner[3])}));
        halves.push_back(h);
      }
    quads = std::move(halves);
    best = std::min(best, most + off);
  }
  return best;
}

BodyQuad BodyPatches::made(const Cell& cell, const std::array<Vec2, 4>& at) const {
  if (cell.surface.end()) return end_quad(cell, at);
  BodyQuad q;
  q.at = at;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2& x = at[k];
    switch (cell.surface.piece) {
      case Piece::tip:
        q.corner[k] = land(x.x(), x.y());
        q.stands[k] = true;
        break;
      case Piece::groove:
        q.corner[k] = chart().place(x.y(), x.x(), ring_.floor_mm);
        q.stands[k] = true;
        break;
      default: {
        const Block& block = blocks_[cell.block];
        const Vec2 uv = block.frame.uv(x);
        const auto p = space_.point(block.piece, uv.x(), uv.y());
        q.corner[k] = p ? p->p : Vec3(Vec3::Constant(NAN));
        q.stands[k] = p && on_ring(space_, p->p, kStands);
      }
    }
  }
  return q;
}

/// The straight line between the ends of a stretch of the border, raised so that the stretch lies below it, and lowered
/// where it is the lower side of a quad. Of a stretch that leaves its azimuths the line is moved to the farthest ones,
/// or made a rectangle, whichever holds it more closely: where two points are one but for rounding it hardly leaves.
BodyQuad BodyPatches::end_quad(const Cell& cell, const std::array<Vec2, 4>& at) const {
  const std::size_t n = cell.surface.outer ? 1 : 0;
  const double at_s = n == 1 ? ring_.s_to : ring_.s_from, sag = ring_.border_sag[n], tip = space_.tip(at_s);
  auto s = border_stretch(ring_.border[n], at[0].x(), at[1].x());
  if (s.from.x() > s.to.x()) std::swap(s.from, s.to);
  const double leaves = std::max(s.from.x() - s.least_azimuth, s.most_azimuth - s.to.x());
  if (leaves > 0) {
    const double high = std::max(s.from.y(), s.to.y()), low = std::min(s.from.y(), s.to.y()),
                 tilts = (high - low) * leaves / (s.most_azimuth - s.least_azimuth);
    s.from.x() = s.least_azimuth;
    s.to.x() = s.most_azimuth;
    if (2 * tilts < high - low) {
      s.above += tilts;
      s.below += tilts;
    } else {
      s.from.y() = s.to.y() = high;
      s.below += high - low;
    }
  }
  const auto place = [&](const Vec2& top, double share, double shift) {
    return chart().place(at_s, top.x(), ring_.base_mm + share * (std::min(top.y() + shift, tip) - ring_.base_mm));
  };
  BodyQuad q;
  q.at = at;
  q.corner = {place(s.from, at[0].y(), -s.below - sag), place(s.to, at[0].y(), -s.below - sag),
              place(s.to, at[2].y(), s.above + sag), place(s.from, at[2].y(), s.above + sag)};
  return q;
}

Vec2 BodyPatches::sides(const Cell& cell, const BodyQuad& q) const {
  const auto& c = q.corner;
  Vec2 out(std::max((c[1] - c[0]).norm(), (c[2] - c[3]).norm()), std::max((c[3] - c[0]).norm(), (c[2] - c[1]).norm()));
  if (cell.surface.end()) {  // of the way from the base to the border, of which the upper corners are a share, too
    const double up = std::max(chart().up(c[2]), chart().up(c[3])) - std::min(ring_.base_mm, chart().up(c[0]));
    out.y() = std::min(out.y(), (q.at[2].y() - q.at[0].y()) * up / q.at[2].y());
  }
  return out;
}

Vec2 BodyPatches::bends(const Cell& cell, const BodyQuad& q) const {
  if (is_round(cell.surface)) return Vec2::Zero();
  const Vec2 size = extent(q);
  const PatchBend& bend = blocks_[cell.block].bend;
  return {bend.sag(size.x(), 0), bend.sag(0, size.y())};
}

double BodyPatches::stands_out(const Cell& cell, const BodyQuad& q) const {
  if (!cell.surface.end()) return 0;
  const double height = std::max((q.corner[3] - q.corner[0]).norm(), (q.corner[2] - q.corner[1]).norm());
  return std::max(0.0, height - sides(cell, q).y());
}

double BodyPatches::stays(std::size_t index, const BodyQuad& q) const {
  const Cell& cell = cells_[index];
  return std::min(stands_out(cell, q), 2 * ring_.border_sag[cell.surface.outer ? 1 : 0]);
}

double BodyPatches::size(std::size_t index, const BodyQuad& q) const { return sides(cells_[index], q).maxCoeff(); }

std::array<BodyQuad, 2> BodyPatches::halved(std::size_t index, const BodyQuad& q) const {
  // A narrow quad whose bound is poor (close to a fold of the fillet) would stay as poor however short it is made.
  const Vec2 side = sides(cells_[index], q), bend = bends(cells_[index], q);
  const Vec2& shorten = bend.maxCoeff() > side.maxCoeff() ? bend : side;
  const bool across = shorten.x() >= shorten.y() || stands_out(cells_[index], q) > std::max(side.y(), stays(index, q));
  const auto& x = q.at;
  std::array<std::array<Vec2, 4>, 2> at;
  std::array<std::array<int, 4>, 2> old;  // corners that stay, and -1
  if (across) {
    const Vec2 low = 0.5 * (x[0] + x[1]), high = 0.5 * (x[3] + x[2]);
    at = {{{x[0], low, high, x[3]}, {low, x[1], x[2], high}}};
    old = {{{0, -1, -1, 3}, {-1, 1, 2, -1}}};
  } else {
    const Vec2 left = 0.5 * (x[0] + x[3]), right = 0.5 * (x[1] + x[2]);
    at = {{{x[0], x[1], right, left}, {left, right, x[2], x[3]}}};
    old = {{{0, 1, -1, -1}, {-1, -1, 2, 3}}};
  }
  const Cell& cell = cells_[index];
  if (cell.surface.end()) return {end_quad(cell, at[0]), end_quad(cell, at[1])};
  std::array<BodyQuad, 2> out;
  out[0].at = at[0];
  out[1].at = at[1];
  // Both halves share the two new corners.
  const BodyQuad fresh = made(cell, across ? std::array<Vec2, 4>{at[0][1], at[0][2], at[0][1], at[0][2]}
                                           : std::array<Vec2, 4>{at[0][3], at[0][2], at[0][3], at[0][2]});
  for (std::size_t n = 0; n < 2; ++n)
    for (std::size_t k = 0; k < 4; ++k) {
      const int kept = old[n][k];
      const std::size_t from = kept >= 0 ? std::size_t(kept) : (at[n][k] == fresh.at[0] ? 0 : 1);
      out[n].corner[k] = kept >= 0 ? q.corner[from] : fresh.corner[from];
      out[n].stands[k] = kept >= 0 ? q.stands[from] : fresh.stands[from];
    }
  return out;
}

BodyHull BodyPatches::outline(std::size_t index, const BodyQuad& q) const {
  BodyHull hull;
  const Cell& cell = cells_[index];
  if (!cell.surface.sheet() || (q.stands[0] && q.stands[1] && q.stands[2] && q.stands[3])) {
    for (std::size_t k = 0; k < 4; ++k) hull.corner[hull.count++] = {q.corner[k], q.at[k], q.stands[k]};
    return hull;
  }
  const double sag = this->sag(index, q);
  for (const auto& [a, b, c] : {std::array<std::size_t, 3>{0, 1, 2}, std::array<std::size_t, 3>{0, 2, 3}}) {
    Facet facet;
    for (const std::size_t k : {a, b, c}) facet.add({q.corner[k], q.at[k], q.stands[k]});
    const Facet left = on_ring(space_, facet, sag);
    for (std::size_t k = 0; k < left.count; ++k) hull.corner[hull.count++] = left.corner[k];
  }
  return hull;
}

double BodyPatches::above(std::size_t index, const BodyQuad& q, const Vec3& g) const {
  const Cell& cell = cells_[index];
  if (is_round(cell.surface)) {
    const Arc arc = arc_of(q, chart());
    return 0.125 * arc.r * arc.width * arc.width * (std::max(0.0, -g.dot(arc.outwards)) + 0.5 * arc.width) +
           0.25 * arc.slant * arc.width;
  }
  const Vec2 size = extent(q);
  return blocks_[cell.block].bend.above(g, size.x(), size.y());
}

double BodyPatches::sag(std::size_t index, const BodyQuad& q) const {
  const Cell& cell = cells_[index];
  if (is_round(cell.surface)) {
    const Arc arc = arc_of(q, chart());
    return 0.125 * arc.r * arc.width * arc.width + 0.25 * arc.slant * arc.width;
  }
  const Vec2 size = extent(q);
  return blocks_[cell.block].bend.sag(size.x(), size.y());
}

std::optional<Vec3> BodyPatches::settled(std::size_t index, const Vec2& at) const {
  const Cell& cell = cells_[index];
  switch (cell.surface.piece) {
    case Piece::tip: return land(at.x(), at.y());
    case Piece::groove: return chart().place(at.y(), at.x(), ring_.floor_mm);
    case Piece::end: {
      const std::size_t n = cell.surface.outer ? 1 : 0;
      const Vec2 top = border_place(ring_.border[n], at.x());
      return chart().place(n == 1 ? ring_.s_to : ring_.s_from, top.x(),
                           ring_.base_mm + at.y() * (top.y() - ring_.base_mm));
    }
    default: return settled_sheet(blocks_[cell.block], blocks_[cell.block].frame.uv(at));
  }
}

std::optional<Vec3> BodyPatches::settled_sheet(const Block& block, Vec2 uv) const {
  const auto piece = block.piece;
  const auto lacks = [&](const Vec3& p) {  // in s and h
    const double s = chart().along(p), inside = std::clamp(s, ring_.s_from, ring_.s_to);
    return Vec2(inside - s, std::min(0.0, space_.tip(inside) - chart().up(p)));
  };
  auto q = space_.point(piece, uv.x(), uv.y());
  for (int k = 0; q && k < kSteps; ++k) {
    const Vec2 lack = lacks(q->p);
    if (lack.cwiseAbs().maxCoeff() < 1e-10) break;
    const auto d = space_.at(piece, uv.x(), uv.y());
    if (!d) return {};
    const double su = chart().along(d->p, d->pu), sv = chart().along(d->p, d->pv);
    if (std::abs(lack.y()) < 1e-10) {
      uv.y() += lack.x() / sv;
    } else {  // to the tip edge, at the station where it stands or at the end
      const double hu = chart().up(d->p, d->pu), hv = chart().up(d->p, d->pv), det = su * hv - sv * hu;
      uv += Vec2(lack.x() * hv - sv * lack.y(), su * lack.y() - lack.x() * hu) / det;
    }
    q = space_.point(piece, uv.x(), uv.y());
  }
  if (!q || lacks(q->p).cwiseAbs().maxCoeff() > 1e-7) return {};
  if (!space_.borders(piece).hold(uv.x(), kStands)) return {};
  return q->p;
}

}  // namespace toothpath::analytic
