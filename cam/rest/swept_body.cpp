#include "cam/rest/swept_body.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace toothpath::rest {
namespace {

constexpr double kTable_mm = 4 * SweptBody::kWithin_mm;  // a kink between four places of the table costs a quarter
constexpr double kLowest_mm = -1;                        // height of its first row
constexpr double kLevel = 1e-3;                          // square of the slope of a motion that counts as level
constexpr double kCube_mm = 0.5;
constexpr double kPose_mm = 0.02;            // the pose that is looked at may be farther than the nearest one by it
constexpr std::uint64_t kCubes = 1U << 20U;  // in each direction; the frame's origin is in the middle of them

}  // namespace

SweptBody::SweptBody(std::vector<path::ToolMotion> motions, Body body, double height_mm, double radius_mm)
    : motions_(std::move(motions)),
      body_(std::move(body)),
      rows_(std::size_t(std::ceil((height_mm - kLowest_mm) / kTable_mm)) + 1),
      columns_(std::size_t(std::ceil(radius_mm / kTable_mm)) + 1),
      table_(rows_ * columns_) {
  std::erase_if(motions_, [](const path::ToolMotion& m) { return m.rapid; });
  tbb::parallel_for(std::size_t(0), rows_, [&](std::size_t i) {
    for (std::size_t j = 0; j < columns_; ++j)
      table_[i * columns_ + j] = body_(kLowest_mm + double(i) * kTable_mm, double(j) * kTable_mm);
  });
}

double SweptBody::distance(double height, double radius) const {
  const double x = (height - kLowest_mm) / kTable_mm, y = radius / kTable_mm;
  if (!(x >= 0 && x < double(rows_ - 1) && y < double(columns_ - 1))) return body_(height, radius);
  const auto i = std::size_t(x), j = std::size_t(y);
  const double *low = &table_[i * columns_ + j], *high = low + columns_, u = x - double(i), v = y - double(j);
  return (1 - u) * ((1 - v) * low[0] + v * low[1]) + u * ((1 - v) * high[0] + v * high[1]);
}

double SweptBody::of_motion(const Vec3& p, const path::ToolMotion& m) const {
  const auto at = [&](double t) {
    const Vec3 axis = path::axis_at(m, t), d = p - path::tip_at(m, t);
    const double height = d.dot(axis);
    return distance(height, (d - height * axis).norm());
  };
  const Vec3 axis = path::axis_at(m, 0.5), way = m.tip_to - m.tip_from;
  // The axis turns: where it passes the place, its foot is as high as the place.
  const double height = (p - path::tip_at(m, 0.5)).dot(axis), rise = way.dot(axis);
  const Vec3 foot = m.tip_from + height * m.axis_from, across = way - rise * axis + height * (m.axis_to - m.axis_from);
  const double a2 = across.squaredNorm(), t = a2 > 0 ? std::clamp((p - foot).dot(across) / a2, 0.0, 1.0) : 0.0;
  const double nearest = at(t);
  return rise * rise <= kLevel * a2 ? nearest : std::min({nearest, at(0), at(1)});
}

std::vector<std::uint32_t> SweptBody::near(const Vec3& middle) const {
  std::vector<double> distances;
  for (const auto& m : motions_) distances.push_back(of_motion(middle, m));
  const double half_diagonal = 0.5 * std::sqrt(3.0) * kCube_mm;
  const double most = *std::min_element(distances.begin(), distances.end()) + 2 * half_diagonal + kPose_mm;
  std::vector<std::uint32_t> out;
  for (std::size_t k = 0; k < distances.size(); ++k)
    if (distances[k] <= most) out.push_back(std::uint32_t(k));
  return out;
}

double SweptBody::excess(const Vec3& p, double cap) const {
  if (motions_.empty()) return cap;
  std::uint64_t key = 0;
  Vec3 middle;
  for (int k = 0; k < 3; ++k) {
    const double cell = std::floor(p[k] / kCube_mm);
    key = key * kCubes + std::uint64_t(std::int64_t(cell) + std::int64_t(kCubes / 2));
    middle[k] = (cell + 0.5) * kCube_mm;
  }
  auto cube = cubes_.find(key);
  if (cube == cubes_.end()) cube = cubes_.emplace(key, near(middle)).first;
  double least = cap;
  for (const std::uint32_t k : cube->second) least = std::min(least, of_motion(p, motions_[k]));
  return least;
}

}  // namespace toothpath::rest
