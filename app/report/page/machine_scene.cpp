#include "app/report/page/machine_scene.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/report/page/packed_json.h"
#include "app/report/svg/html_text.h"
#include "geometry/base/angle.h"
#include "machines/links.h"

namespace toothpath::page {
namespace {

using nlohmann::json;

constexpr double kTurnWay = 200;  // mm for each rad, where moves are thinned
constexpr int kMeshSteps = 16383;

json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

json mesh_json(const mesh::TriangleMesh& mesh) {
  Columns corners(3);
  for (const auto& triangle : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) corners[k].push_back(triangle[k]);
  json indices = json::array();
  for (const auto& column : corners) {
    Columns halves(2);  // numbers below 2^15 each
    for (const double index : column) {
      halves[0].push_back(std::floor(index / kLineLow));
      halves[1].push_back(std::fmod(index, kLineLow));
    }
    indices.push_back({pack_integers(halves[0]), pack_integers(halves[1])});
  }
  return {{"points", pack_floats(columns_of(mesh.vertices), kMeshSteps)}, {"triangles", indices}};
}

json body_json(const SceneBody& body) {
  json out = {
      {"name", svg::valid_utf8(body.name)}, {"link", body.link}, {"standIn", body.stand_in}, {"work", body.work}};
  if (const auto* box = std::get_if<machines::BoxShape>(&body.shape)) {
    out["low"] = vector_json(box->low);
    out["high"] = vector_json(box->high);
  } else if (const auto* cone = std::get_if<machines::ConeShape>(&body.shape)) {
    out["from"] = vector_json(cone->from);
    out["to"] = vector_json(cone->to);
    out["radii"] = {cone->radius_from, cone->radius_to};
  } else {
    out["mesh"] = mesh_json(std::get<mesh::TriangleMesh>(body.shape));
  }
  return out;
}

json states_json(const std::vector<SceneState>& states) {
  Columns joints(5), marks(4);
  for (const SceneState& s : states) {
    for (std::size_t k = 0; k < 5; ++k) joints[k].push_back(s.joints[k]);
    marks[0].push_back(s.operation);
    marks[1].push_back(s.tool);
    marks[2].push_back(s.line / kLineLow);
    marks[3].push_back(s.line % kLineLow);
  }
  json out = {{"joints", pack_floats(joints)}, {"marks", json::array()}};
  for (const auto& column : marks) out["marks"].push_back(pack_integers(column));
  return out;
}

double way_between(const SceneState& a, const SceneState& b) {
  double way = 0;
  for (std::size_t k = 0; k < 5; ++k) way += std::abs(b.joints[k] - a.joints[k]) * (k < 3 ? 1 : kTurnWay);
  return way;
}

/// Of one stretch of the program, its ends and places between them at equal ways; at least one move apart.
void add_thinned(const std::vector<SceneState>& stretch, std::size_t most, std::vector<SceneState>& out) {
  if (stretch.empty()) return;
  double whole = 0;
  for (std::size_t k = 1; k < stretch.size(); ++k) whole += way_between(stretch[k - 1], stretch[k]);
  // Half of them by way, half by number: rapids are long, cuts are many.
  double way = 0, since = 0;
  for (std::size_t k = 0; k < stretch.size(); ++k) {
    const double step = k == 0 ? 0 : way_between(stretch[k - 1], stretch[k]);
    way += step;
    since += 0.5 * double(most) * (step / std::max(whole, 1e-9) + 1.0 / double(stretch.size()));
    if (k > 0 && k + 1 < stretch.size() && since < 1) continue;
    since = 0;
    out.push_back(stretch[k]);
  }
}

}  // namespace

std::vector<SceneState> scene_states(const readback::ReadBack& read, const std::vector<int>& tool_numbers,
                                     std::size_t most) {
  struct Stretch {
    std::vector<SceneState> states;
    int line = 0;
  };
  std::vector<Stretch> stretches;
  const auto add = [&](const readback::OperationTrace& trace, bool one_tooth) {
    Stretch stretch;
    int tooth = -1;
    for (const readback::ExecutedMove& m : trace.moves) {
      if (!m.known) continue;
      if (one_tooth && m.tooth >= 0) {
        if (tooth >= 0 && m.tooth != tooth) break;
        tooth = m.tooth;
      }
      SceneState s;
      s.joints = {m.joints[0], m.joints[1], m.joints[2], radians(m.joints[3]), radians(m.joints[4])};
      s.operation = m.operation;
      s.line = m.line;
      const auto tool = std::find(tool_numbers.begin(), tool_numbers.end(), int(m.tool));
      s.tool = tool == tool_numbers.end() ? -1 : int(tool - tool_numbers.begin());
      stretch.states.push_back(s);
    }
    if (stretch.states.empty()) return;
    stretch.line = stretch.states.back().line;
    stretches.push_back(std::move(stretch));
  };
  for (const auto& trace : read.operations) add(trace, true);
  for (const auto& trace : read.between) add(trace, false);
  std::stable_sort(stretches.begin(), stretches.end(),
                   [](const Stretch& a, const Stretch& b) { return a.line < b.line; });
  const std::size_t each = std::max<std::size_t>(12, most / std::max<std::size_t>(1, read.operations.size()));
  std::vector<SceneState> out;
  for (const Stretch& s : stretches) add_thinned(s.states, each, out);
  return out;
}

json machine_scene_json(const MachineScene& scene) {
  const machines::Links links(scene.chain);
  json out = {{"bed", links.bed()},
              {"joints", json::array()},
              {"origin", vector_json(scene.origin_mm)},
              {"turn", json::array()},
              {"teeth", scene.teeth},
              {"pitch", mesh_json(scene.pitch)},
              {"bodies", json::array()},
              {"toolLengths", scene.tool_length_mm},
              {"note", svg::valid_utf8(scene.note)}};
  for (int k = 0; k < 3; ++k) out["turn"].push_back(vector_json(scene.rotation.col(k)));
  for (std::size_t k = 0; k < links.joints().size(); ++k) {
    const machines::Joint& joint = links.joints()[k];
    json entry = {{"letter", std::string(1, joint.letter)},
                  {"state", joint.rotary ? 3 + joint.axis : joint.axis},
                  {"rotary", joint.rotary},
                  {"point", vector_json(links.point(k))},
                  {"direction", vector_json(links.direction(k))}};
    if (joint.rotary) {
      const machines::RotaryAxis& axis = scene.chain.rotary(joint.axis);
      entry["sign"] = axis.sign;
      entry["zero"] = axis.zero_rad;
    }
    out["joints"].push_back(std::move(entry));
  }
  for (const SceneBody& body : scene.bodies) out["bodies"].push_back(body_json(body));
  out["states"] = states_json(scene.states);
  return out;
}

}  // namespace toothpath::page
