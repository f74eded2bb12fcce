#include "cam/rest/rest_mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::rest {
namespace {

constexpr double kArcSag_mm = 1e-3;
constexpr double kDown_mm = 0.01;         // least step down a column
constexpr std::size_t kLooks = 8;         // parts of a cell in each direction
constexpr double kAboveFloor_mm = 0.01;   // a column never ends on the floor: no facet without area
constexpr std::size_t kBlankPieces = 16;  // of a top that may be hollow
constexpr double kTurn = radians(1);      // between two rows of the underside

/// One row of the grid over one pitch: the column that closes it is the first of the next pitch.
struct Row {
  std::vector<Vec3> places;
};

/// A row before its heights are known.
struct Line {
  double s = 0, begin = 0;
  const BlankRing* ring = nullptr;  ///< none: a corner, at height h
  double h = 0;
};

class RestBuilder {
 public:
  RestBuilder(const Blank& blank, const Excess& removed, const RestOptions& options)
      : blank_(blank), removed_(removed), o_(options) {}

  mesh::TriangleMesh build() {
    choose_cells();
    for (std::size_t r = 0; r < blank_.rings.size(); ++r) add_ring(r);
    measure();
    std::vector<Row> rows(lines_.size());
    for (std::size_t i = 0; i < lines_.size(); ++i)
      for (std::size_t j = 0; j < columns_; ++j) {
        const Line& line = lines_[i];
        const double h = line.ring ? line.ring->top(line.s) - depth_at(i, j) : line.h;
        rows[i].places.push_back(place(line.s, line.begin, double(j), h));
      }
    return joined(rows);
  }

 private:
  [[nodiscard]] double pitch() const { return kTwoPi / blank_.teeth; }
  /// At a column of a row that begins at an azimuth, or between two.
  [[nodiscard]] Vec3 place(double s, double begin, double column, double h) const {
    return blank_.place(s, h, begin + pitch() * column / double(columns_));
  }

  void choose_cells() {
    double radius_mm = 0, length = 0;
    for (const BlankRing& ring : blank_.rings) {
      for (const double s : {ring.from, ring.to})
        radius_mm = std::max(radius_mm, radius(blank_.place(s, ring.top(s), 0)));
      length += ring.to - ring.from;
    }
    const double area = length * kTwoPi * radius_mm;
    cell_ = std::max(o_.cell_mm, std::sqrt(2 * area / double(o_.most_triangles)));
    const double arc = std::min(cell_, std::sqrt(8 * radius_mm * kArcSag_mm));
    columns_ = std::max<std::size_t>(4, std::size_t(std::ceil(pitch() * radius_mm / arc)));
  }

  void add_ring(std::size_t r) {
    const BlankRing& ring = blank_.rings[r];
    const auto pieces =
        removed_ ? std::max(kBlankPieces, std::size_t(std::ceil((ring.to - ring.from) / cell_))) : kBlankPieces;
    for (std::size_t k = 0; k <= pieces; ++k) {
      const double s = k == pieces ? ring.to : ring.from + (ring.to - ring.from) * double(k) / double(pieces);
      lines_.push_back({s, ring.begin(s), &ring, 0});
    }
    const BlankRing& next = blank_.rings[(r + 1) % blank_.rings.size()];
    const double from = ring.begin(ring.to), to = next.begin(next.from);
    const auto& corners = blank_.corners[r];
    const double turn = wrapped(to - from);
    const auto rows = 1 + std::size_t(std::abs(turn) / kTurn);
    for (std::size_t c = 0; c + 1 < corners.size(); ++c)
      for (std::size_t k = 0; k <= rows; ++k) {
        if (c > 0 && k == 0) continue;
        const double t = double(k) / double(rows);
        const Vec2 at = corners[c] + t * (corners[c + 1] - corners[c]);
        // All the turn in the first stretch; it ends where the next ring begins, up to whole turns.
        lines_.push_back({at.x(), c == 0 ? from + t * turn : from + turn, nullptr, at.y()});
      }
  }

  /// How deep below the blank's top every cell is free of material, at its worst place.
  void measure() {
    depths_.assign(lines_.size(), std::vector<double>(columns_));
    if (!removed_) return;
    tbb::parallel_for(std::size_t(0), lines_.size() * columns_, [&](std::size_t k) {
      const std::size_t i = k / columns_;
      if (is_cell(i)) depths_[i][k % columns_] = depth(i, k % columns_);
    });
  }
  /// Does a cell lie between this row and the next?
  [[nodiscard]] bool is_cell(std::size_t i) const {
    return i + 1 < lines_.size() && lines_[i].ring && lines_[i].ring == lines_[i + 1].ring;
  }
  /// Of a corner: the least of the cells that meet there, so that no facet cuts off what stands in one of them.
  [[nodiscard]] double depth_at(std::size_t i, std::size_t j) const {
    double least = INFINITY;
    const std::size_t before = (j + columns_ - 1) % columns_;
    for (const std::size_t row : {i - 1, i})
      if (row < lines_.size() && is_cell(row)) least = std::min({least, depths_[row][before], depths_[row][j]});
    return least;
  }
  /// The cell in kLooks x kLooks parts, each looked at from its middle.
  [[nodiscard]] double depth(std::size_t i, std::size_t j) const {
    double least = INFINITY;
    for (std::size_t a = 0; a < kLooks && least > 0; ++a)
      for (std::size_t b = 0; b < kLooks && least > 0; ++b)
        least = std::min(least, depth_of_part(i, (double(a) + 0.5) / kLooks, double(j) + (double(b) + 0.5) / kLooks));
    return least;
  }
  [[nodiscard]] double depth_of_part(std::size_t i, double t, double column) const {
    const Line &from = lines_[i], &to = lines_[i + 1];
    const auto at = [&](double share, double c, double h) {
      return place(from.s + share * (to.s - from.s), from.begin + share * (to.begin - from.begin), c, h);
    };
    const double s = from.s + t * (to.s - from.s), top = from.ring->top(s), half = 0.5 / kLooks;
    double clear = 0, slope = 0;  // the part lies within `clear` of its middle, its top within `slope`
    for (const double da : {-half, half}) {
      const double edge_top = from.ring->top(s + da * (to.s - from.s));
      slope = std::max(slope, std::abs(edge_top - top));
      for (const double db : {-half, half})
        clear = std::max(clear, (at(t + da, column + db, top) - at(t, column, top)).norm());
    }
    clear += o_.within_mm;
    const double low = from.ring->floor + kAboveFloor_mm;
    double h = top;
    while (h > low) {
      const double free = -removed_(at(t, column, h)) - clear;  // all of the part is gone so far down
      if (free < kDown_mm) break;
      h -= free;
    }
    return std::max(0.0, top - std::max(h, low) - slope);
  }

  [[nodiscard]] mesh::TriangleMesh joined(const std::vector<Row>& rows) const {
    mesh::TriangleMesh mesh;
    const std::size_t teeth = std::size_t(blank_.teeth), around = columns_ * teeth;
    for (const Row& row : rows)
      for (std::size_t k = 0; k < teeth; ++k)
        for (const Vec3& p : row.places) mesh.vertices.push_back(turned(p, pitch() * double(k)));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::size_t next = (i + 1) % rows.size();
      for (std::size_t j = 0; j < around; ++j) {
        const std::size_t k = (j + 1) % around;
        auto a = std::int32_t(i * around + j), b = std::int32_t(next * around + j), c = std::int32_t(next * around + k),
             d = std::int32_t(i * around + k);
        if (blank_.outward < 0) std::swap(b, d);
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      }
    }
    return mesh;
  }

  const Blank& blank_;
  const Excess& removed_;
  const RestOptions& o_;
  double cell_ = 0;
  std::size_t columns_ = 0;
  std::vector<Line> lines_;
  std::vector<std::vector<double>> depths_;  ///< [row before the cell][column]
};

}  // namespace

Excess excess_of(std::vector<std::unique_ptr<cut::Removed>> removed) {
  if (removed.empty()) return {};
  const auto shared = std::make_shared<const std::vector<std::unique_ptr<cut::Removed>>>(std::move(removed));
  return [shared](const Vec3& p) {
    double least = 0;
    for (const auto& one : *shared) least = std::min(least, one->excess(p, 0));
    return least;
  };
}

Result<mesh::TriangleMesh> rest_mesh(const Blank& blank, const Excess& removed, const RestOptions& options) {
  if (!(options.cell_mm > 0)) return fail("cell = {:g} mm must be above 0", options.cell_mm);
  return RestBuilder(blank, removed, options).build();
}

}  // namespace toothpath::rest
