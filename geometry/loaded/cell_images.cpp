#include "geometry/loaded/cell_images.h"

#include <algorithm>
#include <cmath>

#include "geometry/loaded/half_space.h"

namespace toothpath::loaded {
namespace {

constexpr int kBlock = 4;            // cells of a side of a block whose image is counted as one
constexpr double kImageReach = 2.0;  // windows: farther ends have no image

int blocks_across(const CellWindow& c) { return (c.columns + kBlock - 1) / kBlock; }

void start_blocks(CellWindow& c) {
  const int across = blocks_across(c), along = (c.rows + kBlock - 1) / kBlock;
  c.images = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(c.size()), across * along);
  for (int row = 0; row < c.rows; ++row)
    for (int column = 0; column < c.columns; ++column) c.blocks.push_back(row / kBlock * across + column / kBlock);
}

void mirror(const CellSite& w, const std::vector<CellPlace>& places, const FreeEnds& ends, std::size_t end,
            double compliance, CellWindow& c) {
  const double a = kBlock * c.dx / 2, b = kBlock * c.dy / 2;
  const int across = blocks_across(c);
  for (Eigen::Index block = 0; block < c.images.cols(); ++block) {
    const int bx = static_cast<int>(block) % across, by = static_cast<int>(block) / across;
    const Vec3 centre =
        w.point + w.across * (w.x - w.half_x + (2 * bx + 1) * a) + w.along * (w.y - w.half_y + (2 * by + 1) * b);
    const Vec3 image = ends.mirrored(centre, end);
    const Vec3 ex = (ends.mirrored(centre + w.across * a, end) - image).normalized(),
               ey = (ends.mirrored(centre + w.along * b, end) - image).normalized();
    for (std::size_t k = 0; k < c.size(); ++k) {
      if (!std::isfinite(c.gap[k])) continue;
      const Vec3 v = places[k].at.point - image;
      const double far = v.norm();
      c.images(static_cast<Eigen::Index>(k), block) +=
          compliance *
          (far > 4 * std::max(a, b) ? 1 / far : rectangle_influence(v.dot(ex), v.dot(ey), a, b) / (4 * a * b));
    }
  }
}

}  // namespace

void add_images(const CellBodies& bodies, const CellSite& site, const std::vector<CellPlace>& places,
                CellWindow& window) {
  const CellRing& ring = bodies.rings[site.ring];
  const Vec3 centre = site.point + site.across * site.x + site.along * site.y;
  const double reach = kImageReach * 2 * std::max(site.half_x, site.half_y);
  for (const bool on_gear : {true, false}) {
    const FreeEnds& ends = on_gear ? *ring.gear_ends : *ring.pinion_ends;
    const BodyPlan& plan = on_gear ? bodies.gear : bodies.pinion;
    for (std::size_t end = 0; end < 2; ++end) {
      if ((ends.mirrored(centre, end) - centre).norm() / 2 > reach) continue;
      if (window.images.size() == 0) start_blocks(window);
      mirror(site, places, ends, end, half_space_compliance(plan.E, plan.nu), window);
    }
  }
}

}  // namespace toothpath::loaded
