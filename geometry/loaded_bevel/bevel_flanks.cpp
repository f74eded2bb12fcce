#include "geometry/loaded_bevel/bevel_flanks.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "geometry/base/angle.h"

namespace toothpath::loaded_bevel {
namespace {

using bevel_gear::BevelInverse;
using loaded::CellPlace;
using loaded::CellSite;

constexpr int kColumns = 17, kRows = 9;  // of the grid on which teeth are looked at
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kBend = 0.02;    // of the module: step for relative curvatures
constexpr double kFlat = 1e-6;    // 1/mm: less bent flanks count as so bent
constexpr double kAtEdge = 1e-9;  // of the cone distance
constexpr int kHalvings = 26;     // of the grid's steps, to where a tooth is met first
constexpr double kMargin = 1.02;  // of the first rectangle around the flank

}  // namespace

BevelFlanks::BevelFlanks(const LoadedBevelPair& pair, double phi_1) : pair_(pair), phi_1_(phi_1) {
  const auto& options = pair.options;
  bodies_ = {options.wheel,
             options.pinion,
             pair.modulus,
             pair.lever,
             pair.wheel_lever,
             options.edge_radius_mm,
             false,
             true,
             pair.pair.wheel_axis(),
             Vec3::UnitZ(),
             pair.pair.wheel_apex(),
             Vec3::Zero(),
             {}};
  for (std::size_t h = 0; h < pair.halves.size(); ++h) {
    const BevelHalfBodies& half = pair.halves[h];
    bodies_.rings.push_back({static_cast<int>(h), &half.wheel, &half.pinion, &half.wheel_ends, &half.pinion_ends, -1});
  }
  std::vector<Tooth> teeth;
  // A place meets the pinion near the azimuth of the pitch line; the halves of a tooth stand at most so many pitches
  // off.
  const int most = 3 + pair.pair.wheel().parameters().teeth / 4;
  for (int h = 0; h < static_cast<int>(pair.halves.size()); ++h)
    for (int j = -most; j <= most; ++j)
      if (Tooth t = look_at(h, j); std::isfinite(t.first.error)) teeth.push_back(std::move(t));
  if (teeth.empty()) return;
  const auto first = [&] {
    return std::min_element(teeth.begin(), teeth.end(),
                            [](const auto& a, const auto& b) { return a.first.error < b.first.error; })
        ->first.error;
  };
  const double about = first();
  std::erase_if(teeth, [&](const Tooth& t) { return (t.first.error - about) * t.grid.front().lever_1 > kFarthestGap; });
  for (Tooth& t : teeth)
    t.first = pair.pair.first_met(t.half, pair.sigma, turn_of_wheel(t.tooth), t.near, kColumns, kHalvings);
  first_ = first();
  for (const Tooth& t : teeth) add(t);
}

double BevelFlanks::turn_of_wheel(int tooth) const {
  return -phi_1_ / pair_.pair.ratio() + tooth * pair_.pair.wheel().pitch();
}

BevelFlanks::WheelPlace BevelFlanks::wheel_place(int half, int tooth, double beta, double p) const {
  const auto& wall = pair_.pair.wheel().halves()[static_cast<std::size_t>(half)].wall(pair_.sigma);
  const auto f = wall.point(beta, p);
  const double phi_2 = turn_of_wheel(tooth);
  WheelPlace at;
  at.beta = beta, at.p = p, at.blank = f.p;
  at.point = pair_.pair.to_pinion(f.p, phi_2), at.normal = pair_.pair.turned_to_pinion(f.n, phi_2);
  at.lever_1 = std::abs(at.point.x() * at.normal.y() - at.point.y() * at.normal.x());
  at.lever_2 = std::abs(f.p.x() * f.n.y() - f.p.y() * f.n.x());
  return at;
}

std::optional<contact::BevelTouch> BevelFlanks::touch(int half, int tooth, const WheelPlace& at,
                                                      BevelInverse& start) const {
  return pair_.pair.touch(half, pair_.sigma, at.blank, turn_of_wheel(tooth), start);
}

double BevelFlanks::turned(int tooth, const contact::BevelTouch& touch) const {
  return pair_.sigma * wrapped(touch.turn - pair_.pair.nominal_turn(turn_of_wheel(tooth)));
}

BevelFlanks::Tooth BevelFlanks::look_at(int half, int tooth) const {
  const contact::BevelPair& pair = pair_.pair;
  const bevel_gear::BevelHalf& own = pair.wheel().halves()[static_cast<std::size_t>(half)];
  const auto& wall = own.wall(pair_.sigma);
  Tooth t;
  t.half = half, t.tooth = tooth;
  BevelInverse on_pinion;
  const double low = pair.lowest(half), high = pair.highest();
  for (int i = 0; i < kRows; ++i)
    for (int j = 0; j < kColumns; ++j) {
      t.near.push_back({std::numeric_limits<double>::infinity(),
                        own.ell_from + (own.ell_to - own.ell_from) * j / (kColumns - 1),
                        low + (high - low) * i / (kRows - 1)});
      contact::BevelNear& near = t.near.back();
      const auto found = bevel_gear::bevel_inverse(wall, near.ell, near.height);
      if (!found) continue;
      t.grid.push_back(wheel_place(half, tooth, found->beta, found->p));
      const auto met = touch(half, tooth, t.grid.back(), on_pinion);
      t.turned.push_back(met && met->on_flank ? turned(tooth, *met) : kNothing);
      if (std::isnan(t.turned.back())) continue;
      near.error = t.turned.back();
      if (near.error < t.first.error) t.first = near;
    }
  return t;
}

std::optional<BevelFlanks::WheelPlace> BevelFlanks::above(const CellSite& site, int half, const Vec2& at,
                                                          const WheelPlace& near) const {
  const auto& wall = pair_.pair.wheel().halves()[static_cast<std::size_t>(half)].wall(pair_.sigma);
  const auto& c = wall.cutter;
  constexpr double kTurn = 1e-6, kWay = 1e-5;  // steps of the derivatives, rad and mm
  const double lowest = wall.eps() > 0 && wall.trace.beta_end > 0 ? -1e4 : kTurn, highest = kPi / 2 - 0.01,
               deepest = c.p_A, farthest = c.p_D + 0.25 * (c.p_D - c.p_A);
  const auto in_plane = [&](const WheelPlace& p) {
    const Vec3 off = p.point - site.point;
    return Vec2(off.dot(site.across), off.dot(site.along));
  };
  WheelPlace p = near;
  for (int round = 0; round < 20; ++round) {
    const Vec2 here = in_plane(p), miss = at - here;
    if (miss.norm() < 1e-8) return p;
    Eigen::Matrix2d J;
    J.col(0) = (in_plane(wheel_place(half, site.tooth, p.beta + kTurn, p.p)) - here) / kTurn;
    J.col(1) = (in_plane(wheel_place(half, site.tooth, p.beta, p.p + kWay)) - here) / kWay;
    const Vec2 step = J.inverse() * miss;
    if (!step.allFinite()) return std::nullopt;
    const double beta = p.beta + std::clamp(step.x(), -0.1, 0.1), along = p.p + std::clamp(step.y(), -2.0, 2.0);
    if (beta < lowest || beta > highest || along < deepest || along > farthest) return std::nullopt;
    p = wheel_place(half, site.tooth, beta, along);
  }
  return std::nullopt;
}

std::optional<double> BevelFlanks::gap_above(const CellSite& site, int half, const Vec2& at,
                                             const WheelPlace& near) const {
  const auto place = above(site, half, at, near);
  if (!place) return std::nullopt;
  BevelInverse start;
  const auto met = touch(half, site.tooth, *place, start);
  if (!met) return std::nullopt;
  return (turned(site.tooth, *met) - first_) * place->lever_1;
}

std::optional<CellSite> BevelFlanks::site_at(const Tooth& tooth, const WheelPlace& middle) const {
  CellSite site;
  site.ring = static_cast<std::size_t>(tooth.half), site.tooth = tooth.tooth, site.id = sites_.size();
  site.point = middle.point, site.normal = middle.normal;
  site.across = site.normal.cross(Vec3(site.point.normalized())).normalized();  // any direction, for the curvatures
  site.along = site.normal.cross(site.across);
  const double h = kBend * pair_.pair.wheel().parameters().outer_transverse_module_mm;
  double gap[3][3];
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j) {
      const auto one = gap_above(site, tooth.half, Vec2(h * i, h * j), middle);
      if (!one) return std::nullopt;
      gap[i + 1][j + 1] = *one;
    }
  Eigen::Matrix2d bends;
  bends(0, 0) = (gap[2][1] - 2 * gap[1][1] + gap[0][1]) / (h * h);
  bends(1, 1) = (gap[1][2] - 2 * gap[1][1] + gap[1][0]) / (h * h);
  bends(0, 1) = bends(1, 0) = (gap[2][2] - gap[2][0] - gap[0][2] + gap[0][0]) / (4 * h * h);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> parted(bends);
  const Vec2 steep = parted.eigenvectors().col(1);
  const Vec3 across = site.across * steep.x() + site.along * steep.y();
  site.across = across, site.along = site.normal.cross(across);
  site.curvature = std::max(parted.eigenvalues()(1), kFlat);
  // All of the wheel's flank: what presses is not known yet.
  Vec2 least = Vec2::Constant(1e300), most = -least;
  for (const WheelPlace& p : tooth.grid) {
    const Vec3 off = p.point - site.point;
    const Vec2 at(off.dot(site.across), off.dot(site.along));
    least = least.cwiseMin(at), most = most.cwiseMax(at);
  }
  site.x = (least.x() + most.x()) / 2, site.y = (least.y() + most.y()) / 2;
  site.half_x = kMargin * (most.x() - least.x()) / 2, site.half_y = kMargin * (most.y() - least.y()) / 2;
  return site;
}

void BevelFlanks::add(const Tooth& tooth) {
  // The place of least gap from which both flanks can be continued.
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < tooth.grid.size(); ++k)
    if (!std::isnan(tooth.turned[k])) order.push_back(k);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return tooth.turned[a] < tooth.turned[b]; });
  for (const std::size_t k : order)
    if (auto site = site_at(tooth, tooth.grid[k])) {
      if (const auto first = pair_.pair.wheel_place(tooth.half, pair_.sigma, tooth.first.ell, tooth.first.height)) {
        const WheelPlace at = wheel_place(tooth.half, tooth.tooth, first->beta, first->p);
        const Vec3 off = at.point - site->point;
        site->first = Vec2(off.dot(site->across), off.dot(site->along));
        site->first_gap = (tooth.first.error - first_) * at.lever_1;
        site->first_lever = (pair_.options.torque_on_pinion ? at.lever_1 : at.lever_2) / pair_.lever;
      }
      sites_.push_back(*site);
      middles_.push_back(tooth.grid[k]);
      return;
    }
  const WheelPlace& any = tooth.grid[order.front()];
  const double lever = pair_.options.torque_on_pinion ? any.lever_1 : any.lever_2,
               approach = (tooth.first.error - first_) * any.lever_1 / (lever / pair_.lever);
  if (approach < siteless_.approach_mm) siteless_ = {tooth.tooth, approach};
}

CellPlace BevelFlanks::cell_at(const CellSite& site, int half, const WheelPlace& at, BevelInverse& start) const {
  const contact::BevelPair& pair = pair_.pair;
  const bevel_gear::BevelHalf& own = pair.wheel().halves()[static_cast<std::size_t>(half)];
  CellPlace cell;
  loaded::Segment& s = cell.at;
  s.ring = half, s.tooth = site.tooth;
  s.point = s.nearest = at.point, s.normal = at.normal, s.along = site.along;
  const auto on_wheel = bevel_gear::cone_point(at.blank, pair.wheel().sin_delta(), pair.wheel().cos_delta());
  s.r = on_wheel.ell, s.z = on_wheel.height;
  cell.lever = (pair_.options.torque_on_pinion ? at.lever_1 : at.lever_2) / pair_.lever;
  const double edge = kAtEdge * pair.wheel().R_0();
  const bool on_flank = on_wheel.ell >= own.ell_from - edge && on_wheel.ell <= own.ell_to + edge &&
                        on_wheel.height <= pair.highest() + edge && at.p >= own.wall(pair_.sigma).cutter.p_B;
  const auto met = touch(half, site.tooth, at, start);
  if (!met) return cell;
  s.Z = met->ell, s.R = met->height;
  s.gap = (turned(site.tooth, *met) - first_) * at.lever_1;
  cell.material = on_flank && met->on_flank;
  return cell;
}

std::vector<CellPlace> BevelFlanks::places(const CellSite& site, int columns, int rows) const {
  const int half = static_cast<int>(site.ring);
  const double dx = 2 * site.half_x / columns, dy = 2 * site.half_y / rows;
  std::vector<std::optional<WheelPlace>> found;
  std::vector<CellPlace> out;
  for (int row = 0; row < rows; ++row) {
    BevelInverse start;
    for (int column = 0; column < columns; ++column) {
      const Vec2 at(site.x - site.half_x + (column + 0.5) * dx, site.y - site.half_y + (row + 0.5) * dy);
      const auto before = found.size() - static_cast<std::size_t>(row > 0 ? columns : 0);
      const WheelPlace& near = column > 0 && found.back() ? *found.back()
                               : row > 0 && found[before] ? *found[before]
                                                          : middles_[site.id];
      const auto place = above(site, half, at, near);
      if (place) out.push_back(cell_at(site, half, *place, start));
      else out.emplace_back();
      found.push_back(place);
    }
  }
  return out;
}

}  // namespace toothpath::loaded_bevel
