#include "cam/analytic/gear_ring.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "cam/analytic/gear_cells.h"
#include "cam/analytic/ring_edges.h"
#include "geometry/base/angle.h"
#include "geometry/tooth_space/limits.h"

namespace toothpath::analytic {
namespace {

constexpr double kCellLength = 0.45;  // mm along the tooth
constexpr int kEndPoints = 3000;      // on the profile at an end of the ring
constexpr double kEndSag = 2e-4;      // mm: where the end edge may leave them by more, points are put between them,
constexpr int kMostBetween = 15, kEndRounds = 3;  // so many at a time, so often
constexpr int kBands = GearDistance::kBands;
constexpr int kTable = 257;           // places along the teeth
constexpr std::size_t kLandStep = 4;  // of them, along a cell of a land
constexpr int kLandParts = 4;         // cells across a land
constexpr int kFloorStrips = 48;      // of the groove floor over a pitch
constexpr double kFacetSag = 4e-3;    // mm: quads of the sheet are halved until their facets leave it by no more
constexpr double kThinnest = 0.5;     // mm: no part is thinner where its teeth stand
constexpr int kFacetHalvings = 10;    // at most: near the undercut edge no facet is that close

/// Between two segments of any length, from above by no more than rounding.
double distance_between(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), uw = u.dot(w), vw = v.dot(w);
  const double det = uu * vv - uv * uv;
  const double s = det > 0 ? std::clamp((uv * vw - vv * uw) / det, 0.0, 1.0) : 0.0;
  const double t = vv > 0 ? std::clamp((uv * s + vw) / vv, 0.0, 1.0) : 0.0;
  return (w + s * u - t * v).norm();
}

/// The same angle, the whole turns from it that lie next to `about`.
double next_to(double about, double angle) { return angle + kTwoPi * std::round((about - angle) / kTwoPi); }

/// Makes one ring, step by step.
class Maker {
 public:
  Maker(const tooth_space::ToothedPart& part, int zone, GearRing& ring, double reach_mm)
      : part_(part), zone_(zone), space_(ring.space), chart_(ring.chart), R(ring), reach_(reach_mm) {}

  void make() {
    R.base_mm = std::min(part_.lowest_root(), part_.groove_floor().value_or(INFINITY)) - 0.5;
    tables();
    R.least_radius = std::min(chart_.r(R.s_from, R.base_mm), chart_.r(R.s_to, R.base_mm));
    sheet_cells();
    end_line(R.s_from, R.end_from, places_[0]);
    end_line(R.s_to, R.end_to, places_[1]);
    end_edges();
    for (std::size_t n = 0; n < 2; ++n) {
      tip_bend_[n] = tip_bends(space_, n == 0 ? 1 : -1, tip_[n], R.table_s);
      add_edge(n == 0 ? plus_line_ : minus_line_, tip_edge_sags(space_, tip_bend_[n], R.table_s), "tip edge");
    }
    land_cells();
    end_cells();
    floor_cells();
    cut_triangles();
    R.index = std::make_unique<SpatialIndex>(boxes_);
    body_patches();
    facets();
  }

 private:
  void sheet_cells() {
    const auto& st = R.sheet.stations();
    for (std::size_t j = 0; j + 1 < st.size(); ++j) {
      for (std::size_t k = 0; k + 1 < st[j].nodes.size(); ++k) {
        const auto &n00 = st[j].nodes[k], &n01 = st[j].nodes[k + 1], &n10 = st[j + 1].nodes[k],
                   &n11 = st[j + 1].nodes[k + 1];
        if (n00.at.piece != n01.at.piece) continue;
        GearRing::Cell cell;
        cell.corner = {n00.at.contact.p, n01.at.contact.p, n10.at.contact.p, n11.at.contact.p};
        // The sheet goes on beyond the ends and the tip; what lies wholly there is no part of the gear.
        const auto all = [&](auto&& test) { return std::all_of(cell.corner.begin(), cell.corner.end(), test); };
        const auto s = [&](const Vec3& p) { return chart_.along(p); };
        const auto above_tip = [&](const Vec3& p) { return chart_.up(p) > space_.tip(s(p)) + kCellLength; };
        if (all([&](const Vec3& p) { return s(p) < R.s_from; }) || all([&](const Vec3& p) { return s(p) > R.s_to; }) ||
            all(above_tip))
          continue;
        cell.zone = zone_;
        cell.piece = n00.at.piece;
        cell.band = std::clamp(int((0.5 * (n00.sigma + n01.sigma) - std::floor(n00.sigma)) * kBands), 0, kBands - 1);
        cell.u = 0.25 * (n00.at.u + n01.at.u + n10.at.u + n11.at.u);
        cell.v = 0.25 * (n00.at.v + n01.at.v + n10.at.v + n11.at.v);
        cell.centre = 0.25 * (cell.corner[0] + cell.corner[1] + cell.corner[2] + cell.corner[3]);
        if (const auto q = space_.point(cell.piece, cell.u, cell.v)) {
          const double gap = std::min(distance_to_triangle(q->p, cell.corner[0], cell.corner[1], cell.corner[2]),
                                      distance_to_triangle(q->p, cell.corner[1], cell.corner[2], cell.corner[3]));
          R.sag = std::max(R.sag, gap);
        }
        station_.push_back({j, k});
        add_cell(cell);
      }
    }
    for (const auto& station : st) {
      std::vector<Vec2> profile;
      const double middle = R.lookup(R.mid, station.r);
      for (const auto& node : station.nodes) profile.push_back(across(node.at.contact.p, middle));
      R.profiles.push_back(std::move(profile));
    }
    for (std::size_t j = 0; j + 1 < R.profiles.size(); ++j) {
      std::vector<Vec2> steps;
      for (std::size_t k = 0; k < R.profiles[j].size(); ++k) {
        const Vec2 step = R.profiles[j + 1][k] - R.profiles[j][k];
        steps.emplace_back(std::remainder(step.x(), 2 * kPi), step.y());
      }
      R.profile_steps.push_back(std::move(steps));
    }
    R.sag *= 2;  // the middle of a cell shows about the largest sag
    for (auto& cell : R.cells) cell.radius += R.sag;
  }

  /// A place at a station, as azimuth and height.
  [[nodiscard]] Vec2 across(const Vec3& p, double middle) const { return {next_to(middle, azimuth(p)), chart_.up(p)}; }

  void add_cell(GearRing::Cell& cell) {
    Box box;
    for (const auto& p : cell.corner) {
      box.add(p);
      cell.radius = std::max(cell.radius, (p - cell.centre).norm());
    }
    if (!cell.sheet) cell.radius += R.sag;
    boxes_.push_back(box);
    R.cells.push_back(cell);
  }

  /// `sags`: of the segments; below 0: not known.
  void add_edge(const std::vector<Vec3>& line, const std::vector<double>& sags, const char* patch) {
    double shown = 0;
    const std::size_t first = R.edges.size();
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      if ((line[k + 1] - line[k]).norm() < 1e-12) continue;
      R.edges.push_back({line[k], line[k + 1], patch, k < sags.size() ? sags[k] : -1});
      if (k > 0 && k + 2 < line.size()) {
        // Sag of a chord, estimated from the turn between neighbours.
        const Vec3 u = (line[k] - line[k - 1]), v = (line[k + 1] - line[k]);
        if (u.norm() > 1e-9 && v.norm() > 1e-9)
          shown = std::max(shown, 0.125 * v.norm() * u.normalized().cross(v.normalized()).norm());
      }
    }
    for (std::size_t k = first; k < R.edges.size(); ++k) {
      double& sag = R.edges[k].sag;
      if (sag < 0) {
        ++R.unproven_edges;
        sag = 2 * shown;
      }
      R.edge_sag = std::max(R.edge_sag, sag);
    }
  }

  /// The sheet at an end of the ring, from tip to tip.
  void end_line(double s, std::vector<Vec2>& profile, std::vector<EndPlace>& places) {
    const double tip = space_.tip(s), middle = R.lookup(R.mid, s);
    for (int k = 0; k <= kEndPoints; ++k) {
      const auto q = R.sheet.raw(5.0 * k / kEndPoints, s);
      if (!q || chart_.up(q->contact.p) > tip) continue;
      places.push_back({q->piece, q->u, q->v, q->contact.p, 5.0 * k / kEndPoints});
      profile.push_back(across(q->contact.p, middle));
    }
    // The corners where the flanks leave through the tip surface.
    for (const int side : {1, -1}) {
      const auto c = space_.tip_edge(side, s);
      if (!c) continue;
      const auto piece = tooth_space::flank_of(side);
      const auto q = space_.point(piece, c->u, c->v);
      if (!q) continue;
      const Vec2 corner(next_to(middle, azimuth(q->p)), tip);
      const EndPlace place{piece, c->u, c->v, q->p, corner_sigma(places, side, c->u)};
      places.insert(side > 0 ? places.begin() : places.end(), place);
      profile.insert(side > 0 ? profile.begin() : profile.end(), corner);
    }
  }
  /// Of a corner beside the first or the last place: sigma goes evenly with u.
  [[nodiscard]] static double corner_sigma(const std::vector<EndPlace>& places, int side, double u) {
    if (places.size() < 2) return places.empty() ? 0 : places.front().sigma;
    const EndPlace &a = side > 0 ? places.front() : places.back(),
                   &b = side > 0 ? places[1] : places[places.size() - 2];
    return a.sigma + (u - a.u) / (b.u - a.u) * (b.sigma - a.sigma);
  }

  /// Proven sags of an end line, which gets more places where they are large: beside an undercut edge flank and fillet
  /// bend quickly.
  [[nodiscard]] std::vector<double> end_sags(double s, std::vector<Vec2>& profile, std::vector<EndPlace>& places) {
    std::vector<double> sags = end_edge_sags(space_, places);
    const double tip = space_.tip(s), middle = R.lookup(R.mid, s);
    for (int round = 0; round < kEndRounds; ++round) {
      std::vector<EndPlace> closer;
      std::vector<Vec2> beside;
      for (std::size_t k = 0; k < places.size(); ++k) {
        closer.push_back(places[k]);
        beside.push_back(profile[k]);
        if (k + 1 == places.size() || sags[k] <= kEndSag) continue;  // below 0: it is not known
        const int parts = std::min(kMostBetween + 1, 1 + int(std::ceil(std::sqrt(sags[k] / kEndSag))));
        for (int part = 1; part < parts; ++part) {
          const double sigma = places[k].sigma + (places[k + 1].sigma - places[k].sigma) * part / parts;
          const auto q = R.sheet.raw(sigma, s);
          if (!q || chart_.up(q->contact.p) > tip) continue;
          closer.push_back({q->piece, q->u, q->v, q->contact.p, sigma});
          beside.push_back(across(q->contact.p, middle));
        }
      }
      if (closer.size() == places.size()) break;
      places = std::move(closer);
      profile = std::move(beside);
      sags = end_edge_sags(space_, places);
    }
    return sags;
  }

  void tables() {
    const double pitch = part_.pitch();
    std::optional<tooth_space::EdgePlace> last_plus, last_minus;
    for (int k = 0; k < kTable; ++k) {
      const double s = R.s_from + (R.s_to - R.s_from) * k / (kTable - 1);
      const auto middle = tooth_space::place_at(space_, tooth_space::Piece::root, 0.5, s);
      const double tip = space_.tip(s), root = middle ? azimuth(middle->p) : NAN;
      R.table_s.push_back(s);
      R.mid.push_back(k > 0 ? next_to(R.mid.back(), root) : root);
      last_plus = edge_at(1, s, last_plus, R.mid.back());
      last_minus = edge_at(-1, s, last_minus, R.mid.back());
      R.tip_plus.push_back(last_plus ? last_plus->azimuth : R.mid.back() - pitch / 2);
      R.tip_minus.push_back(last_minus ? last_minus->azimuth + pitch : R.mid.back() + pitch / 2);
      plus_line_.push_back(chart_.place(s, R.tip_plus.back(), tip));
      minus_line_.push_back(chart_.place(s, R.tip_minus.back(), tip));
      tip_[0].push_back(last_plus);
      tip_[1].push_back(last_minus);
    }
    for (std::size_t k = 0; k < R.tip_plus.size(); ++k) R.opening.push_back(0.5 * (R.tip_plus[k] + R.tip_minus[k]));
    for (std::size_t k = 0; k + 1 < R.opening.size(); ++k)
      R.opening_slope = std::max(
          R.opening_slope, 1.000001 * std::abs(R.opening[k + 1] - R.opening[k]) / (R.table_s[k + 1] - R.table_s[k]));
    R.tip_from = space_.tip(R.s_from);
    R.tip_to = space_.tip(R.s_to);
    const CurveBend tip = space_.tip_bend(R.s_from, R.s_to);
    R.tip_slope = tip.slope.magnitude();
    for (int k = 1; k < 64; ++k) {
      const double t = k / 64.0, h = space_.tip(R.s_from + t * (R.s_to - R.s_from));
      R.tip_sag = std::max(R.tip_sag, 1.01 * std::abs(h - R.tip_from - t * (R.tip_to - R.tip_from)) - 1e-12);
    }
    R.tip_sag += 0.125 * tip.bend.magnitude() * std::pow((R.s_to - R.s_from) / 64, 2);  // between these places
  }
  /// A tip edge at s, behind `last`; its azimuth within half a turn of the root's.
  [[nodiscard]] std::optional<tooth_space::EdgePlace> edge_at(int side, double s,
                                                              const std::optional<tooth_space::EdgePlace>& last,
                                                              double root) const {
    auto place = space_.tip_edge(side, s, last);
    if (place && !last) place->azimuth = next_to(root, place->azimuth);
    return place;
  }

  void end_edges() {
    for (std::size_t n = 0; n < 2; ++n) {
      const auto sags = n == 0 ? end_sags(R.s_from, R.end_from, places_[n]) : end_sags(R.s_to, R.end_to, places_[n]);
      std::vector<Vec3> line;
      for (const auto& place : places_[n]) line.push_back(place.p);
      const std::size_t first = R.edges.size();
      add_edge(line, sags, "end edge");
      for (std::size_t k = first; k < R.edges.size(); ++k) border_sag_[n] = std::max(border_sag_[n], R.edges[k].sag);
      if (chart_.sine == 0) continue;
      // What is straight in azimuth and height is bent where the end is no cylinder.
      double bent = 0;
      for (std::size_t k = 0; k + 1 < line.size(); ++k) {
        const double turn = std::abs(angle_from_to(line[k], line[k + 1])), a = radius(line[k]), b = radius(line[k + 1]);
        bent = std::max(bent, turn * (0.125 * std::max(a, b) * turn + 0.25 * std::abs(b - a)));
      }
      border_sag_[n] += bent;
    }
  }

  /// The top land of tooth 0, which ends space 0 on its low side: bodies wider than a space may stand on it.
  void land_cells() {
    for (std::size_t k = 0; k + kLandStep < plus_line_.size(); k += kLandStep) {
      for (int part = 0; part < kLandParts; ++part) {
        GearRing::Cell cell;
        cell.sheet = false;
        cell.zone = zone_;
        for (int corner = 0; corner < 4; ++corner) {
          const std::size_t at = k + (corner / 2 ? kLandStep : 0);
          const Vec3 &a = plus_line_[at], b = turned(minus_line_[at], -part_.pitch());
          cell.corner[std::size_t(corner)] = b + (a - b) * ((part + corner % 2) / double(kLandParts));
        }
        cell.centre = 0.25 * (cell.corner[0] + cell.corner[1] + cell.corner[2] + cell.corner[3]);
        others_.push_back({R.cells.size(),
                           {tooth_space::Piece::tip},
                           Vec2(part / double(kLandParts), R.table_s[k]),
                           Vec2((part + 1) / double(kLandParts), R.table_s[k + kLandStep])});
        add_cell(cell);
      }
    }
  }

  void add_flat(const std::array<Vec3, 4>& corner, BodySurface surface, const Vec2& low, const Vec2& high) {
    GearRing::Cell cell;
    cell.sheet = false;
    cell.zone = zone_;
    cell.corner = corner;
    cell.centre = 0.25 * (corner[0] + corner[1] + corner[2] + corner[3]);
    others_.push_back({R.cells.size(), surface, low, high});
    add_cell(cell);
  }

  [[nodiscard]] EndFace end_face(bool outer) const {
    const double s = outer ? R.s_to : R.s_from;
    return {chart_, s, outer, space_.tip(s), R.lookup(R.opening, s) - part_.pitch() / 2, part_.pitch(), R.base_mm};
  }

  /// A strip of an end face ends at the lower of its two edges: the sheet itself stands for the rest.
  void end_cells() {
    for (const bool outer : {false, true})
      for (const auto& quad : end_face_quads(end_face(outer), outer ? R.end_to : R.end_from))
        add_flat(quad.corner, {tooth_space::Piece::end, outer}, {quad.from, quad.low}, {quad.to, quad.high});
  }

  void floor_cells() {
    const auto groove = part_.groove();
    if (!groove || zone_ != 0) return;
    const double floor = *part_.groove_floor(), pitch = part_.pitch(), width = groove->to - groove->from,
                 beside = groove->from == R.s_to ? R.s_to : R.s_from, from = R.lookup(R.mid, beside) - pitch / 2;
    const int rows = std::max(1, int(std::ceil(width / 1.0)));
    for (int k = 0; k < kFloorStrips; ++k)
      for (int q = 0; q < rows; ++q) {
        const double a = from + pitch * k / kFloorStrips, b = from + pitch * (k + 1) / kFloorStrips;
        const double s0 = groove->from + width * q / rows, s1 = groove->from + width * (q + 1) / rows;
        add_flat({chart_.place(s0, a, floor), chart_.place(s0, b, floor), chart_.place(s1, a, floor),
                  chart_.place(s1, b, floor)},
                 {tooth_space::Piece::groove}, {a, s0}, {b, s1});
      }
  }

  void cut_triangles() {
    for (auto& cell : R.cells) {
      cell.first_triangle = std::uint32_t(R.triangles.size());
      for (const std::size_t first : {0, 1}) {
        Facet facet;
        for (std::size_t k = first; k < first + 3; ++k) facet.add({cell.corner[k], Vec2::Zero(), true});
        if (cell.sheet) facet = on_ring(space_, facet, R.sag);
        for (std::size_t k = 1; k + 1 < facet.count; ++k)
          R.triangles.push_back({facet.corner[0].p, facet.corner[k].p, facet.corner[k + 1].p});
      }
      cell.triangles = std::uint32_t(R.triangles.size()) - cell.first_triangle;
    }
  }

  void body_patches() {
    BodyRing ring;
    ring.s_from = R.s_from;
    ring.s_to = R.s_to;
    ring.base_mm = R.base_mm;
    ring.floor_mm = part_.groove_floor().value_or(0);
    ring.table_s = R.table_s;
    ring.tip = tip_;
    ring.tip_bend = tip_bend_;
    ring.edge = {R.tip_plus, R.tip_minus};
    for (double& azimuth : ring.edge[1]) azimuth -= part_.pitch();
    ring.border = {end_border(end_face(false), R.end_from), end_border(end_face(true), R.end_to)};
    ring.border_sag = border_sag_;
    R.patches = std::make_unique<BodyPatches>(space_, std::move(ring), R.cells.size());
    // Blocks of the sheet: fillets bend quickly across, and slowly along the tooth.
    std::map<std::array<std::size_t, 3>, BodyPatches::SheetBlock> blocks;
    const auto& st = R.sheet.stations();
    const std::size_t first_row = station_.empty() ? 0 : station_.front().row;
    for (std::size_t n = 0; n < station_.size(); ++n) {
      const auto [j, k] = station_[n];
      const auto piece = R.cells[n].piece;
      const bool fillet = is_fillet(piece);
      BodyPatches::SheetCell cell;
      cell.index = n;
      const std::array<const tooth_space::OffsetSheet::Node*, 4> nodes{&st[j].nodes[k], &st[j].nodes[k + 1],
                                                                       &st[j + 1].nodes[k + 1], &st[j + 1].nodes[k]};
      for (std::size_t c = 0; c < 4; ++c) {
        cell.uv[c] = {nodes[c]->at.u, nodes[c]->at.v};
        cell.corner[c] = nodes[c]->at.contact.p;
      }
      auto& block = blocks[{(j - first_row) / (fillet ? 8 : 4), std::size_t(piece), fillet ? k : k / 4}];
      block.piece = piece;
      block.cells.push_back(cell);
    }
    std::vector<BodyPatches::SheetBlock> in_order;
    for (auto& [key, block] : blocks) in_order.push_back(std::move(block));
    R.patches->add_blocks(in_order);
    for (const auto& other : others_)
      R.patches->add(other.index, other.surface, other.low, other.high, R.cells[other.index].corner);
  }

  /// Facets of one cell of the sheet. Owners count from its first quad.
  struct CellFacets {
    std::vector<SheetQuad> quads;
    std::array<std::vector<clearance::Facet>, 2> of;  // wholly on the ring, and the others
    double sag = 0;
  };

  /// The same surfaces for questions about points.
  void facets() {
    std::vector<clearance::Facet> edges;
    for (std::size_t n = 0; n < R.edges.size(); ++n)
      edges.push_back({{R.edges[n].a, R.edges[n].b, R.edges[n].b}, std::uint32_t(n)});
    std::array<std::vector<clearance::Facet>, 2> sheet;
    std::vector<clearance::Facet> others;
    std::vector<CellFacets> cells(R.cells.size());
    tbb::parallel_for(std::size_t(0), cells.size(), [&](std::size_t n) {
      if (R.cells[n].sheet) add_quads(n, R.patches->quad(n), kFacetHalvings, cells[n]);
    });
    for (std::size_t n = 0; n < cells.size(); ++n) {
      const auto first = std::uint32_t(R.quads.size());
      R.quads.insert(R.quads.end(), cells[n].quads.begin(), cells[n].quads.end());
      R.facet_sag = std::max(R.facet_sag, cells[n].sag);
      for (std::size_t border = 0; border < 2; ++border)
        for (clearance::Facet& facet : cells[n].of[border]) {
          facet.owner += first;
          sheet[border].push_back(facet);
        }
      if (!R.cells[n].sheet && R.patches->surface(n).piece != tooth_space::Piece::groove) add_other(n, others);
    }
    tbb::parallel_invoke([&] { R.edge_facets = clearance::FacetTree(edges); },
                         [&] { R.whole_facets = clearance::FacetTree(sheet[0]); },
                         [&] { R.border_facets = clearance::FacetTree(sheet[1]); },
                         [&] { R.other_facets = clearance::FacetTree(others); });
  }

  /// How far a piece of the surface may leave the two facets of its quad: its sag over the hull of the four corners,
  /// and the hull leaves the facets by no more than its diagonals lie apart.
  [[nodiscard]] double facet_sag(std::size_t cell, const BodyQuad& quad) const {
    const auto& c = quad.corner;
    return R.patches->sag(cell, quad) + distance_between(c[0], c[2], c[1], c[3]);
  }

  /// The quads of a cell of the sheet, halved until their facets are close.
  void add_quads(std::size_t n, const BodyQuad& quad, int halvings, CellFacets& out) const {
    const double sag = facet_sag(n, quad);
    if (sag > kFacetSag && halvings > 0) {
      const auto halves = R.patches->halved(n, quad);
      const auto exists = [](const BodyQuad& q) {
        return std::all_of(q.corner.begin(), q.corner.end(), [](const Vec3& c) { return c.allFinite(); });
      };
      if (exists(halves[0]) && exists(halves[1])) {
        for (const auto& half : halves) add_quads(n, half, halvings - 1, out);
        return;
      }
    }
    out.sag = std::max(out.sag, sag);
    const auto& c = quad.corner;
    const bool border = !std::all_of(c.begin(), c.end(), [&](const Vec3& p) { return R.on_ring(p); });
    const Vec2 uv = R.patches->parameters(n, 0.25 * (quad.at[0] + quad.at[1] + quad.at[2] + quad.at[3]));
    const auto owner = std::uint32_t(out.quads.size());
    out.quads.push_back({R.cells[n].piece, std::uint8_t(R.cells[n].band), border, uv.x(), uv.y()});
    out.of[border].push_back({{c[0], c[1], c[2]}, owner});
    out.of[border].push_back({{c[0], c[2], c[3]}, owner});
  }

  void add_other(std::size_t n, std::vector<clearance::Facet>& others) {
    const auto& quad = R.patches->quad(n);
    R.facet_sag = std::max(R.facet_sag, facet_sag(n, quad));
    const int about = 1 + int(std::ceil(reach_ / (part_.pitch() * std::max(R.least_radius, kThinnest))));
    for (int tooth = -about; tooth <= about; ++tooth) {
      std::array<Vec3, 4> c;
      for (std::size_t k = 0; k < 4; ++k) c[k] = turned(quad.corner[k], tooth * part_.pitch());
      others.push_back({{c[0], c[1], c[2]}, std::uint32_t(n)});
      others.push_back({{c[0], c[2], c[3]}, std::uint32_t(n)});
    }
  }

  struct Station {
    std::size_t row, node;
  };
  struct Other {
    std::size_t index;
    BodySurface surface;
    Vec2 low, high;
  };
  const tooth_space::ToothedPart& part_;
  int zone_;
  const tooth_space::ToothSpace& space_;
  const tooth_space::Chart& chart_;
  GearRing& R;
  double reach_;
  std::vector<Box> boxes_;
  std::vector<Station> station_;  // of the cells of the sheet
  std::vector<Other> others_;
  std::array<std::vector<EndPlace>, 2> places_;
  std::array<std::vector<std::optional<tooth_space::EdgePlace>>, 2> tip_;
  std::vector<Vec3> plus_line_, minus_line_;
  std::array<double, 2> border_sag_{};
  std::array<std::vector<std::optional<CurveBend>>, 2> tip_bend_;
};

}  // namespace

Expected<std::unique_ptr<GearRing>, Refusal> GearRing::make(const tooth_space::ToothedPart& part, int zone,
                                                            double reach_mm) {
  const tooth_space::ToothSpace& space = part.space(zone);
  const tooth_space::Outline& ring = space.outline();
  const double width = ring.s_to - ring.s_from, beyond = std::min(reach_mm, 0.25 * width + 1.0);
  const int stations = std::clamp(int((width + 2 * beyond) / kCellLength) + 2, 9, 400);
  auto out = std::make_unique<GearRing>(space, ring.s_from - beyond, ring.s_to + beyond, stations);
  out->s_from = ring.s_from;
  out->s_to = ring.s_to;
  const auto& sheet = out->sheet;
  const std::string key = "zone[" + std::to_string(zone) + "]";
  if (sheet.empty()) {
    const auto [from, to] = ring.told(ring.s_from - beyond, ring.s_to + beyond);
    return Refusal{key, fail("zone {}: the flanks and fillets of the tooth space are found at no {} between {:.4f} and "
                             "{:.4f} mm",
                             zone, ring.along, from, to)};
  }
  if (sheet.r_from() > ring.s_from || sheet.r_to() < ring.s_to) {
    const auto [from, to] = ring.told(sheet.r_from(), sheet.r_to());
    const auto [whole_from, whole_to] = ring.told(ring.s_from, ring.s_to);
    return Refusal{key, fail("zone {}: the flanks and fillets of the tooth space are found from "
                             "{} {:.4f} to {:.4f} mm only, the ring is {:.4f} to {:.4f} mm",
                             zone, ring.along, from, to, whole_from, whole_to)};
  }
  if (auto refusal = part.refusal(zone)) return std::move(*refusal);
  Maker(part, zone, *out, reach_mm).make();
  return out;
}

bool GearRing::on_ring(const Vec3& p) const {
  const double s = chart.along(p);
  return s >= s_from - 1e-9 && s <= s_to + 1e-9 && chart.up(p) <= space.tip(s) + 1e-9;
}

bool GearRing::over_land(double azimuth, double s) const {
  return azimuth <= lookup(tip_plus, s) || azimuth >= lookup(tip_minus, s);
}

double GearRing::to_tip_meridian(double s, double h, double& foot) const {
  const double ds = s_to - s_from, dh = tip_to - tip_from;
  const double t = std::clamp(((s - s_from) * ds + (h - tip_from) * dh) / (ds * ds + dh * dh), 0.0, 1.0);
  foot = s_from + t * ds;
  return std::hypot(s - foot, h - tip_from - t * dh) - tip_sag;
}

double GearRing::lookup(const std::vector<double>& y, double s) const {
  const double t =
      std::clamp((s - table_s.front()) / (table_s.back() - table_s.front()), 0.0, 1.0) * double(y.size() - 1);
  const auto k = std::min(std::size_t(t), y.size() - 2);
  return y[k] + (t - double(k)) * (y[k + 1] - y[k]);
}

namespace {

/// The profile runs from tip to tip; `point(k)` is a place of it, k < count.
template <typename Point>
bool inside_profile(std::size_t count, const Point& point, double azimuth, double h, double tip) {
  if (h >= tip) return false;
  Vec2 a = point(0);
  if (azimuth <= a.x() || azimuth >= point(count - 1).x()) return true;
  // Straight up from a place in the material the profile is crossed an odd number of times, also where a flank leans
  // back.
  bool inside = false;
  for (std::size_t k = 1; k < count; ++k) {
    const Vec2 b = point(k);
    if ((a.x() <= azimuth) != (b.x() <= azimuth) && h < a.y() + (azimuth - a.x()) / (b.x() - a.x()) * (b.y() - a.y()))
      inside = !inside;
    a = b;
  }
  return inside;
}

}  // namespace

bool GearRing::in_material_at(double s, double azimuth, double h, double tip) const {
  const auto& st = sheet.stations();
  const double last = double(st.size() - 1),
               t = std::clamp((s - st.front().r) / (st.back().r - st.front().r) * last, 0.0, last);
  const std::size_t j = std::min(std::size_t(t), st.size() - 2);
  const auto &at = profiles[j], &step = profile_steps[j];
  return inside_profile(
      at.size(), [&, x = t - double(j)](std::size_t k) -> Vec2 { return at[k] + x * step[k]; }, azimuth, h, tip);
}

bool in_material(const std::vector<Vec2>& profile, double azimuth, double h, double tip) {
  return inside_profile(
      profile.size(), [&](std::size_t k) { return profile[k]; }, azimuth, h, tip);
}

}  // namespace toothpath::analytic
