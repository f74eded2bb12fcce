#include "geometry/exchange/step_gear.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/exchange/step_text.h"

namespace toothpath::exchange {
namespace {

constexpr std::size_t kSectors = 2;   ///< faces around a cylinder or cone
constexpr double kSameAngle = 1e-12;  ///< rad: a straight line between two circles runs along a meridian
constexpr double kSameLength_mm = 1e-9;

/// An edge in the direction of its curve, or against it.
struct Oriented {
  StepId edge = 0;
  bool forward = true;
};
using Loop = std::vector<Oriented>;

void append_reversed(Loop& loop, const Loop& way) {
  for (auto e = way.rbegin(); e != way.rend(); ++e) loop.push_back({e->edge, !e->forward});
}

/// A closed way around the gear, cut in sectors: where a surface of revolution begins or ends.
struct Rim {
  std::array<Loop, kSectors> ways;          ///< in growing azimuth
  std::array<StepId, kSectors> vertices{};  ///< where a sector begins
  std::array<Vec3, kSectors> places{};
  Corner corner;  ///< a place of it in the meridian
};

/// Of one ring: [tooth][strip] and, at the ends, [end][tooth][strip].
struct RingEdges {
  std::vector<std::vector<StepId>> side;
  std::array<std::vector<std::vector<StepId>>, 2> end, vertex;
};

/// Where the text of a spline goes: lists of knots with their multiplicities.
std::string multiplicities(const Breaks& breaks) {
  std::string out = "(4";
  for (std::size_t k = 2; k < breaks.size(); ++k) out += ",1";
  return out + ",4)";
}
std::string knots(const Breaks& breaks) {
  std::string out = "(";
  for (const double b : breaks) out += (out.size() > 1 ? "," : "") + real(b);
  return out + ")";
}

class GearBrep {
 public:
  GearBrep(const GearShell& shell, const FittedShell& fitted) : shell_(shell), fitted_(fitted) {}

  Result<StepFile> run(std::string_view name) {
    for (const auto& corners : shell_.corners)
      for (std::size_t k = 0; k + 1 < corners.size(); ++k)
        if (on_axis(corners[k]) != on_axis(corners[k + 1]) &&
            std::abs(corners[k].z - corners[k + 1].z) > kSameLength_mm)
          return fail("the body ends in a point at z = {:.4f} mm: a solid of ours ends in planes there",
                      on_axis(corners[k]) ? corners[k].z : corners[k + 1].z);
    frame_ = step_.placement(Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX());
    for (std::size_t r = 0; r < shell_.rings.size(); ++r) {
      rings_.push_back(edges_of(r));
      for (std::size_t k = 0; k < teeth(); ++k) tooth_faces(r, k);
    }
    for (std::size_t r = 0; r < shell_.rings.size(); ++r) {
      const std::size_t next = (r + 1) % shell_.rings.size();
      const auto& corners = shell_.corners[r];
      Rim rim = end_rim(r, 1, corners.front());
      for (std::size_t k = 1; k + 1 < corners.size(); ++k) rim = surface_to(rim, circle(corners[k], rim));
      const bool on_circle = shell_.rings[next].foot_on_circle[0];
      rim = surface_to(rim, on_circle ? foot_rim(next, 0) : circle(corners.back(), outline(next, 0)));
      if (!on_circle) surface_to(rim, outline(next, 0));
    }
    const StepId shell = step_.add("CLOSED_SHELL('',{})", references(faces_));
    const StepId solid = step_.add("MANIFOLD_SOLID_BREP({},#{})", quoted(name), shell);
    product(name, solid);
    counts_.faces = faces_.size();
    return StepFile{step_.file(name, "toothpath"), counts_};
  }

 private:
  [[nodiscard]] std::size_t teeth() const { return std::size_t(shell_.teeth); }
  [[nodiscard]] Vec3 placed(const Vec3& p, std::size_t tooth) const {
    const std::size_t k = tooth % teeth();
    return k == 0 ? p : turned(p, kTwoPi * double(k) / double(teeth()));
  }
  [[nodiscard]] std::size_t sector_tooth(std::size_t sector) const { return sector * teeth() / kSectors; }

  // --- edges ---------------------------------------------------------------------------------------------------

  StepId edge(StepId from, StepId to, StepId curve) {
    ++counts_.edges;
    return step_.add("EDGE_CURVE('',#{},#{},#{},.T.)", from, to, curve);
  }
  StepId vertex(const Vec3& p) {
    ++counts_.vertices;
    return step_.vertex(p);
  }
  StepId spline(const Breaks& breaks, const std::vector<StepId>& control) {
    return step_.add("B_SPLINE_CURVE_WITH_KNOTS('',3,{},.UNSPECIFIED.,.F.,.F.,{},{},.UNSPECIFIED.)",
                     references(control), multiplicities(breaks), knots(breaks));
  }
  StepId spline_through(const SplineCurve& curve) {
    std::vector<StepId> control;
    for (const Vec3& p : curve.control) control.push_back(step_.point(p));
    return spline(curve.breaks, control);
  }
  /// Control points of a strip along one of its four borders.
  [[nodiscard]] static SplineCurve border(const SplineSurface& s, bool along, bool far) {
    const std::size_t rows = control_count(s.u), columns = s.columns();
    SplineCurve out{along ? s.u : s.v, {}};
    for (std::size_t k = 0; k < (along ? rows : columns); ++k)
      out.control.push_back(along ? s.point(k, far ? columns - 1 : 0) : s.point(far ? rows - 1 : 0, k));
    return out;
  }
  [[nodiscard]] SplineCurve turned_curve(SplineCurve curve, std::size_t tooth) const {
    for (Vec3& p : curve.control) p = placed(p, tooth);
    return curve;
  }

  RingEdges edges_of(std::size_t ring) {
    const auto& strips = fitted_.rings[ring].strips;
    const std::size_t n = strips.size();
    RingEdges out;
    out.side.assign(teeth(), std::vector<StepId>(n));
    for (std::size_t e = 0; e < 2; ++e) out.end[e] = out.vertex[e] = out.side;
    for (std::size_t k = 0; k < teeth(); ++k)
      for (std::size_t j = 0; j < n; ++j) {
        const SplineCurve side = turned_curve(border(strips[j], true, false), k);
        for (std::size_t e = 0; e < 2; ++e)
          out.vertex[e][k][j] = vertex(e == 0 ? side.control.front() : side.control.back());
        out.side[k][j] = edge(out.vertex[0][k][j], out.vertex[1][k][j], spline_through(side));
      }
    for (std::size_t e = 0; e < 2; ++e)
      for (std::size_t k = 0; k < teeth(); ++k)
        for (std::size_t j = 0; j < n; ++j) {
          const StepId to = j + 1 < n ? out.vertex[e][k][j + 1] : out.vertex[e][(k + 1) % teeth()][0];
          out.end[e][k][j] =
              edge(out.vertex[e][k][j], to, spline_through(turned_curve(border(strips[j], false, e == 1), k)));
        }
    return out;
  }

  // --- faces ---------------------------------------------------------------------------------------------------

  StepId bound(Loop loop, bool outer) {
    if (shell_.outward < 0) {
      Loop reversed;
      append_reversed(reversed, loop);
      loop = std::move(reversed);
    }
    std::vector<StepId> edges;
    for (const Oriented& e : loop)
      edges.push_back(step_.add("ORIENTED_EDGE('',*,*,#{},.{}.)", e.edge, e.forward ? 'T' : 'F'));
    const StepId ring = step_.add("EDGE_LOOP('',{})", references(edges));
    ++counts_.bounds;
    return step_.add("{}('',#{},.T.)", outer ? "FACE_OUTER_BOUND" : "FACE_BOUND", ring);
  }
  void face(const std::string& name, const std::vector<StepId>& bounds, StepId surface, bool same_sense) {
    faces_.push_back(
        step_.add("ADVANCED_FACE({},{},#{},.{}.)", quoted(name), references(bounds), surface, same_sense ? 'T' : 'F'));
  }

  void tooth_faces(std::size_t ring, std::size_t k) {
    const auto& strips = fitted_.rings[ring].strips;
    const RingEdges& e = rings_[ring];
    const std::size_t n = strips.size();
    for (std::size_t j = 0; j < n; ++j) {
      const StepId next = j + 1 < n ? e.side[k][j + 1] : e.side[(k + 1) % teeth()][0];
      const Loop loop{{e.side[k][j], true}, {e.end[1][k][j], true}, {next, false}, {e.end[0][k][j], false}};
      std::string rows = "(";
      for (std::size_t i = 0; i < control_count(strips[j].u); ++i) {
        std::vector<StepId> row;
        for (std::size_t c = 0; c < strips[j].columns(); ++c)
          row.push_back(step_.point(placed(strips[j].point(i, c), k)));
        rows += (i > 0 ? "," : "") + references(row);
      }
      const StepId surface =
          step_.add("B_SPLINE_SURFACE_WITH_KNOTS('',3,3,{}),.UNSPECIFIED.,.F.,.F.,.F.,{},{},{},{},.UNSPECIFIED.)", rows,
                    multiplicities(strips[j].u), multiplicities(strips[j].v), knots(strips[j].u), knots(strips[j].v));
      const Strip& strip = shell_.rings[ring].strips[j];
      face(fmt::format("{} of tooth {}{}", strip.name, (k + std::size_t(strip.tooth)) % teeth(),
                       shell_.rings.size() > 1 ? ", " + shell_.rings[ring].place : ""),
           {bound(loop, true)}, surface, shell_.outward > 0);
    }
  }

  // --- surfaces of revolution ----------------------------------------------------------------------------------

  [[nodiscard]] static bool on_axis(const Corner& corner) { return corner.radius < kSameLength_mm; }
  [[nodiscard]] std::size_t foot(std::size_t ring) const { return shell_.rings[ring].foot; }
  [[nodiscard]] Vec3 end_place(std::size_t ring, std::size_t end, std::size_t tooth, std::size_t strip) const {
    const SplineSurface& s = fitted_.rings[ring].strips[strip];
    return placed(s.point(end == 1 ? control_count(s.u) - 1 : 0, 0), tooth);
  }
  /// The whole end of a ring of teeth.
  [[nodiscard]] Rim outline(std::size_t ring, std::size_t end) const {
    const RingEdges& e = rings_[ring];
    const std::size_t n = e.end[end].front().size();
    Rim rim;
    for (std::size_t s = 0; s < kSectors; ++s) {
      rim.vertices[s] = e.vertex[end][sector_tooth(s)][foot(ring)];
      rim.places[s] = end_place(ring, end, sector_tooth(s), foot(ring));
      for (std::size_t k = sector_tooth(s); k < sector_tooth(s + 1); ++k)
        for (std::size_t j = 0; j < n; ++j) {
          const std::size_t strip = (foot(ring) + j) % n, tooth = (k + (foot(ring) + j) / n) % teeth();
          rim.ways[s].push_back({e.end[end][tooth][strip], true});
        }
    }
    const Vec3 tip = end_place(ring, end, 0, 0);
    rim.corner = {radius(tip), tip.z()};
    return rim;
  }
  /// Feet of the tooth spaces and arcs below the teeth, where every tooth has an end face of its own: those, too.
  Rim foot_rim(std::size_t ring, std::size_t end) {
    const RingEdges& e = rings_[ring];
    const std::size_t n = e.end[end].front().size(), f = foot(ring);
    const Vec3 at = end_place(ring, end, 0, f), tip = end_place(ring, end, 0, 0);
    const Corner corner{radius(at), at.z()}, top{radius(tip), tip.z()};
    const StepId curve = circle_curve(corner);
    const Surface cap = end == 1 ? surface(top, corner) : surface(corner, top);
    std::vector<Loop> pieces(teeth());
    for (std::size_t k = 0; k < teeth(); ++k) {
      const std::size_t next = (k + 1) % teeth();
      const StepId arc = edge(e.vertex[end][k][f + 1], e.vertex[end][next][f], curve);
      pieces[k] = {{e.end[end][k][f], true}, {arc, true}};
      Loop teeth_way;
      for (std::size_t j = 1; j < n; ++j) teeth_way.push_back({e.end[end][f + j < n ? k : next][(f + j) % n], true});
      Loop loop = end == 1 ? Loop{{arc, true}} : teeth_way;
      append_reversed(loop, end == 1 ? teeth_way : Loop{{arc, true}});
      face(fmt::format("end of tooth {}, {}", next, shell_.rings[ring].place), {bound(loop, true)}, cap.id, cap.same);
    }
    Rim rim;
    rim.corner = corner;
    for (std::size_t s = 0; s < kSectors; ++s) {
      rim.vertices[s] = e.vertex[end][sector_tooth(s)][f];
      rim.places[s] = end_place(ring, end, sector_tooth(s), f);
      for (std::size_t k = sector_tooth(s); k < sector_tooth(s + 1); ++k)
        rim.ways[s].insert(rim.ways[s].end(), pieces[k].begin(), pieces[k].end());
    }
    return rim;
  }
  /// The rim from which the surface behind a ring goes on.
  Rim end_rim(std::size_t ring, std::size_t end, const Corner& corner) {
    if (shell_.rings[ring].foot_on_circle[end]) return foot_rim(ring, end);
    const Rim rim = outline(ring, end);
    return surface_to(rim, circle(corner, rim));
  }
  StepId circle_curve(const Corner& corner) {
    const StepId at = step_.placement({0, 0, corner.z}, Vec3::UnitZ(), Vec3::UnitX());
    return step_.add("CIRCLE('',#{},{})", at, real(corner.radius));
  }
  /// A circle, cut where `like` is; on the axis nothing.
  Rim circle(const Corner& corner, const Rim& like) {
    Rim rim;
    rim.corner = corner;
    if (on_axis(corner)) return rim;
    const StepId curve = circle_curve(corner);
    for (std::size_t s = 0; s < kSectors; ++s) {
      const double at = azimuth(like.places[s]);
      rim.places[s] = {corner.radius * std::cos(at), corner.radius * std::sin(at), corner.z};
      rim.vertices[s] = vertex(rim.places[s]);
    }
    for (std::size_t s = 0; s < kSectors; ++s)
      rim.ways[s] = {{edge(rim.vertices[s], rim.vertices[(s + 1) % kSectors], curve), true}};
    return rim;
  }
  struct Surface {
    StepId id = 0;
    bool same = true;  ///< its normal points out of the material
    bool plane = false;
    std::string name;
  };
  /// Through both places of the meridian; u runs from `from` to `to`.
  Surface surface(const Corner& from, const Corner& to) {
    const double dr = to.radius - from.radius, dz = to.z - from.z;
    Surface out;
    if (std::abs(dz) < kSameLength_mm) {
      const StepId at = step_.placement({0, 0, from.z}, Vec3::UnitZ(), Vec3::UnitX());
      out = {step_.add("PLANE('',#{})", at), dr * shell_.outward > 0, true, "plane"};
    } else if (std::abs(dr) < kSameLength_mm) {
      out = {step_.add("CYLINDRICAL_SURFACE('',#{},{})", frame_, real(from.radius)), -dz * shell_.outward > 0, false,
             "cylinder"};
    } else {
      // The radius grows along the axis of the surface.
      const Vec3 axis = dr / dz > 0 ? Vec3::UnitZ() : Vec3(-Vec3::UnitZ());
      const StepId at = step_.placement({0, 0, from.z}, axis, Vec3::UnitX());
      out = {step_.add("CONICAL_SURFACE('',#{},{},{})", at, real(from.radius), real(std::atan(std::abs(dr / dz)))),
             -dz * shell_.outward > 0, false, "cone"};
    }
    return out;
  }
  /// From one rim to another along a surface of revolution: a straight line, or a spline where the rims are cut at
  /// different azimuths.
  StepId cut(const Rim& from, const Rim& to, std::size_t s) {
    const Vec3 &a = from.places[s], &b = to.places[s];
    const double turn = angle_from_to(a, b);
    if (std::abs(turn) < kSameAngle) {
      const Vec3 way = b - a;
      const StepId at = step_.point(a), along = step_.direction(way.normalized());
      const StepId line = step_.add("LINE('',#{},#{})", at, step_.add("VECTOR('',#{},1.)", along));
      return edge(from.vertices[s], to.vertices[s], line);
    }
    const double r = radius(a), dr = radius(b) - r;
    const auto place = [&](double t) {
      const double angle = azimuth(a) + t * turn;
      return Vec3((r + t * dr) * std::cos(angle), (r + t * dr) * std::sin(angle), a.z() + t * (b.z() - a.z()));
    };
    // A cubic leaves r (turn / pieces)^4 / 384 of an arc.
    const double pieces = std::abs(turn) * std::pow(std::max(r, r + dr) / (384 * 0.01 * kFitTolerance_mm), 0.25);
    const Breaks breaks = even_breaks(2 + std::size_t(pieces));
    std::vector<Vec3> places;
    for (const double t : greville_points(breaks)) places.push_back(place(t));
    return edge(from.vertices[s], to.vertices[s], spline_through(curve_through(breaks, places)));
  }
  Rim surface_to(const Rim& from, const Rim& to) {
    if (on_axis(from.corner) && on_axis(to.corner)) return to;
    const Surface surface = this->surface(from.corner, to.corner);
    if (surface.plane) {
      const bool outwards = to.corner.radius > from.corner.radius;
      Loop ahead, back;
      for (const Loop& way : to.ways) ahead.insert(ahead.end(), way.begin(), way.end());
      for (auto way = from.ways.rbegin(); way != from.ways.rend(); ++way) append_reversed(back, *way);
      std::vector<StepId> bounds{bound(outwards ? ahead : back, true)};
      const Loop& inner = outwards ? back : ahead;  // empty: down to the axis
      if (!inner.empty()) bounds.push_back(bound(inner, false));
      face(surface.name, bounds, surface.id, surface.same);
      return to;
    }
    std::array<StepId, kSectors> cuts{};
    for (std::size_t s = 0; s < kSectors; ++s) cuts[s] = cut(from, to, s);
    for (std::size_t s = 0; s < kSectors; ++s) {
      Loop loop{{cuts[s], true}};
      loop.insert(loop.end(), to.ways[s].begin(), to.ways[s].end());
      loop.push_back({cuts[(s + 1) % kSectors], false});
      append_reversed(loop, from.ways[s]);
      face(surface.name, {bound(loop, true)}, surface.id, surface.same);
    }
    return to;
  }

  // --- product -------------------------------------------------------------------------------------------------

  void product(std::string_view name, StepId solid) {
    const StepId mm = step_.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
    const StepId rad = step_.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
    const StepId sr = step_.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
    const StepId accuracy = step_.add(
        "UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE({}),#{},'distance_accuracy_value','greatest deviation from the "
        "exact surface')",
        real(kFitTolerance_mm), mm);
    const StepId context = step_.add(
        "(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{}))GLOBAL_UNIT_ASSIGNED_CONTEXT(("
        "#{},#{},#{}))REPRESENTATION_CONTEXT('','3D'))",
        accuracy, mm, rad, sr);
    const StepId representation =
        step_.add("ADVANCED_BREP_SHAPE_REPRESENTATION('',(#{},#{}),#{})", frame_, solid, context);
    const StepId application = step_.add("APPLICATION_CONTEXT('automotive design')");
    step_.add("APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,#{})", application);
    const StepId mechanical = step_.add("PRODUCT_CONTEXT('',#{},'mechanical')", application);
    const StepId part = step_.add("PRODUCT({0},{0},'',(#{1}))", quoted(name), mechanical);
    step_.add("PRODUCT_RELATED_PRODUCT_CATEGORY('part','',(#{}))", part);
    const StepId formation = step_.add("PRODUCT_DEFINITION_FORMATION('','',#{})", part);
    const StepId design = step_.add("PRODUCT_DEFINITION_CONTEXT('part definition',#{},'design')", application);
    const StepId definition = step_.add("PRODUCT_DEFINITION('design','',#{},#{})", formation, design);
    const StepId shape = step_.add("PRODUCT_DEFINITION_SHAPE('','',#{})", definition);
    step_.add("SHAPE_DEFINITION_REPRESENTATION(#{},#{})", shape, representation);
  }

  const GearShell& shell_;
  const FittedShell& fitted_;
  StepText step_;
  StepId frame_ = 0;
  std::vector<RingEdges> rings_;
  std::vector<StepId> faces_;
  StepCounts counts_;
};

}  // namespace

Result<StepFile> step_gear(const GearShell& shell, const FittedShell& fitted, std::string_view name) {
  return GearBrep(shell, fitted).run(name);
}

}  // namespace toothpath::exchange
