// A STEP file read back by its own text: instances, B-splines by the recursion of Cox and de Boor, and what a closed
// shell must be. Shares nothing with the writer.
#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "geometry/base/vec.h"

namespace toothpath::test {

/// `#n=NAME(arguments)`.
struct StepInstance {
  std::string name, arguments;
};

/// Splits `a,(b,c),'d,e'` at its own commas.
inline std::vector<std::string> step_arguments(const std::string& text) {
  std::vector<std::string> out(1);
  int depth = 0;
  bool quoted = false;
  for (const char c : text) {
    if (c == '\'') quoted = !quoted;
    if (!quoted && c == '(') ++depth;
    if (!quoted && c == ')') --depth;
    if (!quoted && c == ',' && depth == 0) out.emplace_back();
    else out.back() += c;
  }
  return out;
}
inline std::vector<std::string> step_list(const std::string& text) {
  if (text.size() < 2 || text.front() != '(' || text.back() != ')') return {};
  const std::string inside = text.substr(1, text.size() - 2);
  return inside.empty() ? std::vector<std::string>{} : step_arguments(inside);
}
inline int step_id(const std::string& text) { return text.starts_with("#") ? std::stoi(text.substr(1)) : 0; }

/// Knots with their multiplicities written out.
struct ReadSpline {
  std::vector<double> u, v;                ///< v empty: a curve
  std::vector<std::vector<Vec3>> control;  ///< [u][v]
};

/// Basis function by its recursion; the last piece holds its end.
inline double cox_de_boor(const std::vector<double>& knots, std::size_t i, std::size_t degree, double t) {
  if (degree == 0) {
    const bool last = t == knots.back() && knots[i] < knots[i + 1] && knots[i + 1] == knots.back();
    return (knots[i] <= t && t < knots[i + 1]) || last ? 1 : 0;
  }
  double sum = 0;
  if (knots[i + degree] > knots[i])
    sum += (t - knots[i]) / (knots[i + degree] - knots[i]) * cox_de_boor(knots, i, degree - 1, t);
  if (knots[i + degree + 1] > knots[i + 1])
    sum +=
        (knots[i + degree + 1] - t) / (knots[i + degree + 1] - knots[i + 1]) * cox_de_boor(knots, i + 1, degree - 1, t);
  return sum;
}

inline Vec3 spline_at(const ReadSpline& s, double u, double v = 0) {
  std::vector<double> across(s.control.front().size(), 1);
  if (!s.v.empty())
    for (std::size_t j = 0; j < across.size(); ++j) across[j] = cox_de_boor(s.v, j, 3, v);
  Vec3 p = Vec3::Zero();
  for (std::size_t i = 0; i < s.control.size(); ++i) {
    const double along = cox_de_boor(s.u, i, 3, u);
    if (along == 0) continue;
    for (std::size_t j = 0; j < across.size(); ++j)
      if (across[j] != 0) p += along * across[j] * s.control[i][j];
  }
  return p;
}

/// An edge as a face meets it.
struct ReadEdge {
  int edge = 0;
  bool forward = true;
};
struct ReadFace {
  std::string name;
  std::vector<std::vector<ReadEdge>> loops;
  int surface = 0;
  bool same_sense = true;
};

class StepReader {
 public:
  explicit StepReader(const std::string& text) {
    const std::size_t begin = text.find("DATA;\n");
    for (std::size_t at = begin + 6; at < text.size() && text[at] == '#';) {
      const std::size_t equals = text.find('=', at), end = text.find(";\n", at);
      const std::size_t open = text.find('(', equals);
      instances_[std::stoi(text.substr(at + 1, equals - at - 1))] = {text.substr(equals + 1, open - equals - 1),
                                                                     text.substr(open + 1, end - open - 2)};
      at = end + 2;
    }
  }

  [[nodiscard]] const std::map<int, StepInstance>& instances() const { return instances_; }
  [[nodiscard]] const StepInstance& at(int id) const { return instances_.at(id); }
  [[nodiscard]] std::vector<int> named(const std::string& name) const {
    std::vector<int> out;
    for (const auto& [id, instance] : instances_)
      if (instance.name == name) out.push_back(id);
    return out;
  }
  [[nodiscard]] std::vector<std::string> arguments(int id) const { return step_arguments(at(id).arguments); }

  [[nodiscard]] Vec3 point(int id) const {
    const auto xyz = step_list(arguments(id).at(1));
    return {std::stod(xyz.at(0)), std::stod(xyz.at(1)), std::stod(xyz.at(2))};
  }
  [[nodiscard]] Vec3 vertex(int id) const { return point(step_id(arguments(id).at(1))); }
  /// (vertex from, vertex to, curve)
  [[nodiscard]] std::array<int, 3> edge(int id) const {
    const auto a = arguments(id);
    return {step_id(a.at(1)), step_id(a.at(2)), step_id(a.at(3))};
  }
  [[nodiscard]] ReadSpline spline(int id) const {
    const auto a = arguments(id);
    const bool surface = at(id).name == "B_SPLINE_SURFACE_WITH_KNOTS";
    ReadSpline s;
    if (surface) {
      for (const auto& row : step_list(a.at(3))) s.control.push_back(points(row));
      s.u = knots(a.at(8), a.at(10));
      s.v = knots(a.at(9), a.at(11));
    } else {
      for (const Vec3& p : points(a.at(2))) s.control.push_back({p});
      s.u = knots(a.at(6), a.at(7));
    }
    return s;
  }
  [[nodiscard]] ReadFace face(int id) const {
    const auto a = arguments(id);
    ReadFace f{a.at(0).substr(1, a.at(0).size() - 2), {}, step_id(a.at(2)), a.at(3) == ".T."};
    for (const auto& bound : step_list(a.at(1))) {
      f.loops.emplace_back();
      for (const auto& e : step_list(arguments(step_id(arguments(step_id(bound)).at(1))).at(1))) {
        const auto oriented = arguments(step_id(e));
        f.loops.back().push_back({step_id(oriented.at(3)), oriented.at(4) == ".T."});
      }
    }
    return f;
  }
  [[nodiscard]] std::vector<int> faces() const {
    std::vector<int> out;
    for (const int shell : named("CLOSED_SHELL"))
      for (const auto& f : step_list(arguments(shell).at(1))) out.push_back(step_id(f));
    return out;
  }

 private:
  [[nodiscard]] std::vector<Vec3> points(const std::string& list) const {
    std::vector<Vec3> out;
    for (const auto& p : step_list(list)) out.push_back(point(step_id(p)));
    return out;
  }
  [[nodiscard]] static std::vector<double> knots(const std::string& counts, const std::string& values) {
    const auto count = step_list(counts), value = step_list(values);
    std::vector<double> out;
    for (std::size_t k = 0; k < value.size(); ++k) out.insert(out.end(), std::stoul(count.at(k)), std::stod(value[k]));
    return out;
  }

  std::map<int, StepInstance> instances_;
};

/// Distance of a place from the plane, cylinder or cone of an instance.
inline double distance_to_revolved(const StepReader& step, int surface, const Vec3& p) {
  const auto a = step.arguments(surface);
  const auto frame = step.arguments(step_id(a.at(1)));
  const Vec3 origin = step.point(step_id(frame.at(1))), axis = step.point(step_id(frame.at(2)));
  const double along = (p - origin).dot(axis), across = (p - origin - along * axis).norm();
  const std::string& kind = step.at(surface).name;
  if (kind == "PLANE") return std::abs(along);
  const double r = std::stod(a.at(2));
  if (kind == "CYLINDRICAL_SURFACE") return std::abs(across - r);
  const double half = std::stod(a.at(3));
  return std::abs((across - r - along * std::tan(half)) * std::cos(half));
}

/// Is the curve one of the four borders of the surface, control point by control point?
inline bool is_border(const ReadSpline& surface, const ReadSpline& curve, double tolerance) {
  const std::size_t rows = surface.control.size(), columns = surface.control.front().size();
  for (int side = 0; side < 4; ++side) {
    const bool along = side < 2;
    if (curve.u != (along ? surface.u : surface.v)) continue;
    bool same = curve.control.size() == (along ? rows : columns);
    for (std::size_t k = 0; same && k < curve.control.size(); ++k) {
      const Vec3& p =
          along ? surface.control[k][side == 0 ? 0 : columns - 1] : surface.control[side == 2 ? 0 : rows - 1][k];
      same = (p - curve.control[k][0]).norm() <= tolerance;
    }
    if (same) return true;
  }
  return false;
}

/// Normal of the surface of a face near a place, out of the material as the face says.
inline Vec3 normal_of(const StepReader& step, const ReadFace& face, const Vec3& p) {
  const double sign = face.same_sense ? 1 : -1;
  const std::string& kind = step.at(face.surface).name;
  if (kind == "B_SPLINE_SURFACE_WITH_KNOTS") {
    const ReadSpline s = step.spline(face.surface);
    const double h = 1e-4;
    const Vec3 du = spline_at(s, 0.5 + h, 0.5) - spline_at(s, 0.5 - h, 0.5),
               dv = spline_at(s, 0.5, 0.5 + h) - spline_at(s, 0.5, 0.5 - h);
    return sign * du.cross(dv).normalized();
  }
  const auto a = step.arguments(face.surface), frame = step.arguments(step_id(a.at(1)));
  const Vec3 origin = step.point(step_id(frame.at(1))), axis = step.point(step_id(frame.at(2)));
  if (kind == "PLANE") return sign * axis;
  const Vec3 across = p - origin - (p - origin).dot(axis) * axis;
  const double half = kind == "CONICAL_SURFACE" ? std::stod(a.at(3)) : 0;
  return sign * (std::cos(half) * across.normalized() - std::sin(half) * axis);
}

/// Twice the area that vertices and places on the edges of a face go around, all loops together, and the middle of all
/// of them. Seen against it they go counter-clockwise.
inline std::pair<Vec3, Vec3> area_of_loops(const StepReader& step, const ReadFace& face) {
  Vec3 area = Vec3::Zero(), middle = Vec3::Zero();
  double count = 0;
  for (const auto& loop : face.loops) {
    std::vector<Vec3> places;
    for (const ReadEdge& e : loop) {
      const auto edge = step.edge(e.edge);
      const Vec3 a = step.vertex(edge[e.forward ? 0 : 1]), b = step.vertex(edge[e.forward ? 1 : 0]);
      places.push_back(a);
      const std::string& kind = step.at(edge[2]).name;
      if (kind == "B_SPLINE_CURVE_WITH_KNOTS") places.push_back(spline_at(step.spline(edge[2]), 0.5));
      if (kind == "CIRCLE") {  // counter-clockwise about z from the first vertex
        const Vec3 from = step.vertex(edge[0]);
        double turn = angle_from_to(from, step.vertex(edge[1]));
        if (turn <= 0) turn += 2 * 3.14159265358979323846;
        for (const double share : {0.25, 0.5, 0.75})
          places.push_back(turned(from, (e.forward ? share : 1 - share) * turn));
      }
      if (places.back() != b) places.push_back(b);
    }
    for (const Vec3& p : places) middle += p, count += 1;
    for (std::size_t k = 0; k < places.size(); ++k) area += places[k].cross(places[(k + 1) % places.size()]);
  }
  return {area, middle / count};
}

/// What is wrong with the solid; empty: one closed shell of one piece, with so many holes through it, every edge used
/// once in each direction and lying on both its surfaces. `tolerance_mm`: of edges on planes, cylinders and cones.
inline std::vector<std::string> faults_of(const StepReader& step, double tolerance_mm, long holes = 1) {
  std::vector<std::string> out;
  if (step.named("MANIFOLD_SOLID_BREP").size() != 1 || step.named("CLOSED_SHELL").size() != 1) return {"not one shell"};
  const auto faces = step.faces();
  if (faces.size() != step.named("ADVANCED_FACE").size()) out.emplace_back("faces outside the shell");
  for (const auto& [id, instance] : step.instances())
    for (std::size_t at = instance.arguments.find('#'); at != std::string::npos;
         at = instance.arguments.find('#', at + 1))
      if (!step.instances().contains(std::stoi(instance.arguments.substr(at + 1))))
        out.push_back("a reference to nothing in #" + std::to_string(id));
  if (!out.empty()) return out;
  std::map<int, std::array<int, 2>> used;
  std::set<int> vertices;
  std::size_t loops = 0;
  for (const int id : faces) {
    const ReadFace face = step.face(id);
    const bool teeth = step.at(face.surface).name == "B_SPLINE_SURFACE_WITH_KNOTS";
    const ReadSpline surface = teeth ? step.spline(face.surface) : ReadSpline{};
    const auto [area, middle] = area_of_loops(step, face);
    if (!(area.dot(normal_of(step, face, middle)) > 0)) out.push_back("'" + face.name + "' goes around the wrong way");
    for (const auto& loop : face.loops) {
      ++loops;
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const auto here = step.edge(loop[k].edge), next = step.edge(loop[(k + 1) % loop.size()].edge);
        const int end = here[loop[k].forward ? 1 : 0], begin = next[loop[(k + 1) % loop.size()].forward ? 0 : 1];
        if (end != begin) out.push_back("a loop of '" + face.name + "' is open");
        ++used[loop[k].edge][loop[k].forward ? 1 : 0];
        vertices.insert(end);
        if (step.at(here[2]).name == "B_SPLINE_CURVE_WITH_KNOTS") {
          const ReadSpline curve = step.spline(here[2]);
          if ((curve.control.front()[0] - step.vertex(here[0])).norm() > 1e-6 ||
              (curve.control.back()[0] - step.vertex(here[1])).norm() > 1e-6)
            out.push_back("an edge of '" + face.name + "' misses its vertex");
          if (teeth && !is_border(surface, curve, 3e-7))
            out.push_back("an edge of '" + face.name + "' is not its border");
          for (int s = 0; !teeth && s <= 40; ++s)
            if (distance_to_revolved(step, face.surface, spline_at(curve, s / 40.0)) > tolerance_mm)
              out.push_back("an edge leaves the surface of '" + face.name + "'");
        } else if (teeth) {
          out.push_back("an edge of '" + face.name + "' is no spline");
        } else if (distance_to_revolved(step, face.surface, step.vertex(end)) > tolerance_mm) {
          out.push_back("a vertex of '" + face.name + "' is off it");
        }
      }
    }
  }
  for (const auto& [edge, count] : used)
    if (count != std::array<int, 2>{1, 1})
      out.push_back("edge #" + std::to_string(edge) + " is not used once each way");
  // V - E + F - (L - F) = 2 - 2 G, G = 1: a ring.
  const long euler = long(vertices.size()) - long(used.size()) + 2 * long(faces.size()) - long(loops);
  if (euler != 2 - 2 * holes)
    out.push_back("Euler's sum is " + std::to_string(euler) + ", not " + std::to_string(2 - 2 * holes));
  if (used.size() != step.named("EDGE_CURVE").size()) out.emplace_back("edges that no face has");
  return out;
}

}  // namespace toothpath::test
