#include "cam/rest/rest_mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "geometry/base/angle.h"

namespace toothpath::rest {
namespace {

constexpr double kArcSag_mm = 1e-3;
constexpr double kDown_mm = 0.01;         // least step down a column
constexpr std::size_t kLooks = 8;         // knots of a cell in each direction; parts of it along the teeth
constexpr std::size_t kAcross = 2;        // knots of a part across them
constexpr double kColumnsOfCell = 4;      // walls are steep across the teeth and smooth along them
constexpr int kMostSweeps = 30;           // over all corners
constexpr double kLowered_mm = 1e-4;      // a sweep that lowers no corner by more is the last one
constexpr double kLeastThick = 0.0625;    // of a cell: nothing thinner is looked for
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

  RestMesh build() {
    choose_cells();
    for (std::size_t r = 0; r < blank_.rings.size(); ++r) add_ring(r);
    depths_.assign(lines_.size() * columns_, 0);
    RestMesh out;
    out.cell_mm = cell_;
    if (removed_) {
      measure();
      lower_corners();
      out.thick_mm = thickness();
    }
    std::vector<Row> rows(lines_.size());
    for (std::size_t i = 0; i < lines_.size(); ++i)
      for (std::size_t j = 0; j < columns_; ++j) {
        const Line& line = lines_[i];
        const double h = line.ring ? line.ring->top(line.s) - depths_[i * columns_ + j] : line.h;
        rows[i].places.push_back(place(line.s, line.begin, double(j), h));
      }
    out.mesh = joined(rows);
    return out;
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
    cell_ = std::max(o_.cell_mm, std::sqrt(2 * kColumnsOfCell * area / double(o_.most_triangles)));
    const double arc = std::min(removed_ ? cell_ / kColumnsOfCell : cell_, std::sqrt(8 * radius_mm * kArcSag_mm));
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

  /// Does a cell lie between this row and the next?
  [[nodiscard]] bool is_cell(std::size_t i) const {
    return i + 1 < lines_.size() && lines_[i].ring && lines_[i].ring == lines_[i + 1].ring;
  }
  template <typename Work>
  void every_cell(const Work& work) const {
    tbb::parallel_for(std::size_t(0), lines_.size() * columns_, [&](std::size_t k) {
      if (is_cell(k / columns_)) work(k / columns_, k % columns_);
    });
  }

  /// How deep below the blank's top every part of every cell is free of material, at its worst place. Where a look
  /// from the middle of the cell is enough for all of them, that is taken.
  void measure() {
    parts_.assign(lines_.size() * columns_, {});
    every_cell([&](std::size_t i, std::size_t j) {
      auto& parts = parts_[i * columns_ + j];
      const Part cell = part_of(i, j, 0, 0, kLooks, kLooks);
      if (removed_(at(cell, cell.top + cell.slope), 2 * cell.clear) > cell.clear + cell.slope) return;
      const double free = free_depth(cell, 0);
      for (std::size_t a = 0; a < kLooks; ++a)
        for (std::size_t b = 0; b < kLooks; b += kAcross) {
          const double depth = free_depth(part_of(i, j, a, b, 1, kAcross), free);
          for (std::size_t k = 0; k < kAcross; ++k) parts[a * kLooks + b + k] = depth;
        }
    });
  }

  /// A part of a cell, seen from its middle.
  struct Part {
    const BlankRing* ring = nullptr;
    double s = 0, begin = 0, column = 0, top = 0;
    double clear = 0;  ///< every place of it lies so near to the one of equal height in the middle
    double slope = 0;  ///< of its top: the highest place of it above the middle
  };
  [[nodiscard]] Vec3 at(const Part& part, double h) const { return place(part.s, part.begin, part.column, h); }
  /// From knot (a, b) of the cell on, so many knots along and across.
  [[nodiscard]] Part part_of(std::size_t i, std::size_t j, std::size_t a, std::size_t b, std::size_t along,
                             std::size_t across) const {
    const Line &from = lines_[i], &to = lines_[i + 1];
    const double half_t = 0.5 * double(along) / kLooks, half_u = 0.5 * double(across) / kLooks,
                 t = double(a) / kLooks + half_t;
    const auto at = [&](double share, double c, double h) {
      return place(from.s + share * (to.s - from.s), from.begin + share * (to.begin - from.begin), c, h);
    };
    Part part;
    part.ring = from.ring;
    part.s = from.s + t * (to.s - from.s);
    part.begin = from.begin + t * (to.begin - from.begin);
    part.column = double(j) + double(b) / kLooks + half_u;
    part.top = part.ring->top(part.s);
    for (const double da : {-half_t, half_t}) {
      part.slope = std::max(part.slope, std::abs(part.ring->top(from.s + (t + da) * (to.s - from.s)) - part.top));
      for (const double db : {-half_u, half_u})
        part.clear =
            std::max(part.clear, (at(t + da, part.column + db, part.top) - at(t, part.column, part.top)).norm());
    }
    return part;
  }
  /// @param known  so deep it is free, that much is known
  [[nodiscard]] double free_depth(const Part& part, double known) const {
    const double clear = part.clear + o_.within_mm, low = part.ring->floor + kAboveFloor_mm;
    double h = part.top + part.slope - known;
    while (h > low) {
      const double free = -removed_(at(part, h), 0) - clear;  // of all of the part
      if (free < kDown_mm) break;
      h -= free;
    }
    return std::max(known, part.top - std::max(h, low) - part.slope);
  }

  /// Shares of the corners (0, 0), (1, 0), (1, 1), (0, 1) of a cell in a place of its two facets.
  using Shares = std::array<double, 4>;
  [[nodiscard]] static Shares shares(double t, double u) {
    return u <= t ? Shares{1 - t, t - u, u, 0} : Shares{1 - u, 0, t, u - t};
  }
  [[nodiscard]] std::array<std::size_t, 4> corners_of(std::size_t i, std::size_t j) const {
    const std::size_t k = (j + 1) % columns_;
    return {i * columns_ + j, (i + 1) * columns_ + j, (i + 1) * columns_ + k, i * columns_ + k};
  }

  /// From the safe beginning, corner by corner, until none can be lowered.
  void lower_corners() {
    std::fill(depths_.begin(), depths_.end(), INFINITY);
    limits_.assign(parts_.size(), {});
    for (std::size_t i = 0; i < lines_.size(); ++i)
      for (std::size_t j = 0; is_cell(i) && j < columns_; ++j) {
        const auto& parts = parts_[i * columns_ + j];
        const double least = *std::min_element(parts.begin(), parts.end());
        for (const std::size_t corner : corners_of(i, j)) depths_[corner] = std::min(depths_[corner], least);
        limits_[i * columns_ + j] = limits_of(parts);
      }
    double lowered = INFINITY;
    for (int sweep = 0; sweep < kMostSweeps && lowered > kLowered_mm; ++sweep) {
      lowered = 0;
      for (std::size_t i = 0; i < lines_.size(); ++i)
        for (std::size_t j = 0; lines_[i].ring && j < columns_; ++j) {
          double& depth = depths_[i * columns_ + j];
          const double deepest = deepest_corner(i, j);
          lowered = std::max(lowered, deepest - depth);
          depth = std::max(depth, deepest);
        }
    }
  }
  static constexpr std::size_t kKnots = kLooks + 1;
  using Limits = std::array<double, kKnots * kKnots>;
  /// Greatest depth at every corner of the parts of a cell: facets are flat between them.
  [[nodiscard]] static Limits limits_of(const std::array<double, kLooks * kLooks>& parts) {
    Limits limits;
    limits.fill(INFINITY);
    for (std::size_t a = 0; a < kLooks; ++a)
      for (std::size_t b = 0; b < kLooks; ++b)
        for (const std::size_t at :
             {a * kKnots + b, a * kKnots + b + 1, (a + 1) * kKnots + b, (a + 1) * kKnots + b + 1})
          limits[at] = std::min(limits[at], parts[a * kLooks + b]);
    return limits;
  }
  /// How deep one corner may be while all others stay.
  [[nodiscard]] double deepest_corner(std::size_t i, std::size_t j) const {
    double deepest = INFINITY;
    const std::size_t before = (j + columns_ - 1) % columns_;
    for (const auto& [row, column, role] : {std::tuple(i, j, 0), {i - 1, j, 1}, {i - 1, before, 2}, {i, before, 3}}) {
      if (row >= lines_.size() || !is_cell(row)) continue;
      const auto corner = corners_of(row, column);
      const Limits& limits = limits_[row * columns_ + column];
      for (std::size_t a = 0; a < kKnots; ++a)
        for (std::size_t b = 0; b < kKnots; ++b) {
          const Shares w = shares(double(a) / kLooks, double(b) / kLooks);
          if (!(w[std::size_t(role)] > 0)) continue;
          double room = limits[a * kKnots + b];
          for (std::size_t k = 0; k < 4; ++k)
            if (int(k) != role) room -= w[k] * depths_[corner[k]];
          deepest = std::min(deepest, room / w[std::size_t(role)]);
        }
    }
    return deepest;
  }

  /// How deep inside of what was removed the mesh reaches.
  [[nodiscard]] double thickness() const {
    std::vector<double> thick(lines_.size() * columns_, 0);
    every_cell([&](std::size_t i, std::size_t j) {
      const double low = nothing_removed_below(i, j);
      double& most = thick[i * columns_ + j];
      most = 2 * kLeastThick * cell_;
      for (std::size_t a = 0; a < kLooks; ++a)
        for (std::size_t b = 0; b < kLooks; b += kAcross) most = std::max(most, thickness_of_part(i, j, a, b, low));
    });
    return *std::max_element(thick.begin(), thick.end());
  }
  /// Below it no place of a cell lies deeper in what was removed than what is not looked for.
  [[nodiscard]] double nothing_removed_below(std::size_t i, std::size_t j) const {
    const Part cell = part_of(i, j, 0, 0, kLooks, kLooks);
    double h = cell.ring->floor;
    while (h < cell.top) {
      const double up = removed_(at(cell, h), 8 * cell_) - cell.clear + kLeastThick * cell_;
      if (up < kDown_mm) break;
      h += up;
    }
    return h;
  }
  /// It is followed down from its highest place.
  [[nodiscard]] double thickness_of_part(std::size_t i, std::size_t j, std::size_t a, std::size_t b, double low) const {
    const Part part = part_of(i, j, a, b, 1, kAcross);
    const auto corner = corners_of(i, j);
    double depth = INFINITY;
    for (const std::size_t t : {a, a + 1})
      for (std::size_t u = b; u <= b + kAcross; ++u) {
        const Shares w = shares(double(t) / kLooks, double(u) / kLooks);
        double here = 0;
        for (std::size_t k = 0; k < 4; ++k) here += w[k] * depths_[corner[k]];
        depth = std::min(depth, here);
      }
    double most = 0;
    for (double h = part.top + part.slope - depth; h > low;) {
      const double e = removed_(at(part, h), 8 * cell_);
      most = std::max(most, -e);
      h -= most + e + kLeastThick * cell_;  // nothing deeper by more is between
    }
    return most + kLeastThick * cell_ + part.clear;
  }

  /// All teeth. A row on the axis is one vertex.
  [[nodiscard]] mesh::TriangleMesh joined(const std::vector<Row>& rows) const {
    mesh::TriangleMesh mesh;
    const std::size_t teeth = std::size_t(blank_.teeth), around = columns_ * teeth;
    std::vector<std::size_t> begins, steps;
    for (const Row& row : rows) {
      const bool on_axis =
          std::all_of(row.places.begin(), row.places.end(), [](const Vec3& p) { return radius(p) == 0; });
      begins.push_back(mesh.vertices.size());
      steps.push_back(on_axis ? 0 : 1);
      if (on_axis) mesh.vertices.push_back(row.places.front());
      for (std::size_t k = 0; !on_axis && k < teeth; ++k)
        for (const Vec3& p : row.places) mesh.vertices.push_back(turned(p, pitch() * double(k)));
    }
    const auto index = [&](std::size_t row, std::size_t column) {
      return std::int32_t(begins[row] + steps[row] * column);
    };
    const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
      if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
    };
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::size_t next = (i + 1) % rows.size();
      for (std::size_t j = 0; j < around; ++j) {
        const std::size_t k = (j + 1) % around;
        auto a = index(i, j), b = index(next, j), c = index(next, k), d = index(i, k);
        if (blank_.outward < 0) std::swap(b, d);
        add(a, b, c);
        add(a, c, d);
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
  std::vector<double> depths_;                              ///< of the corners: row, column
  std::vector<std::array<double, kLooks * kLooks>> parts_;  ///< of the cells: row before it, column
  std::vector<Limits> limits_;                              ///< of the same
};

}  // namespace

Excess excess_of(std::vector<Excess> removed) {
  if (removed.empty()) return {};
  return [removed = std::move(removed)](const Vec3& p, double cap) {
    double least = cap;
    for (const Excess& one : removed) least = std::min(least, one(p, std::max(least, 0.0)));
    return least;
  };
}

Result<RestMesh> rest_mesh(const Blank& blank, const Excess& removed, const RestOptions& options) {
  if (!(options.cell_mm > 0)) return fail("cell = {:g} mm must be above 0", options.cell_mm);
  return RestBuilder(blank, removed, options).build();
}

}  // namespace toothpath::rest
