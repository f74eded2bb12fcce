#include "app/report/page/machine_scene.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/report/page/packed_json.h"
#include "app/report/svg/html_text.h"
#include "machines/links.h"

namespace toothpath::page {
namespace {

using nlohmann::json;

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
  json out = {{"name", svg::valid_utf8(body.name)},
              {"link", body.link},
              {"standIn", body.stand_in},
              {"work", body.work},
              {"tool", body.tool}};
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

json stretches_json(const SceneStates& moves) {
  Columns columns(7);
  json turns = json::array();
  const auto rounded = [](double v) { return std::round(v * 1e6) / 1e6; };
  for (const SceneStretch& s : moves.stretches) {
    columns[0].push_back(double(s.first / kLineLow));
    columns[1].push_back(double(s.first % kLineLow));
    columns[2].push_back(double(s.count));
    columns[3].push_back(s.operation);
    columns[4].push_back(s.tooth);
    columns[5].push_back(s.lines / kLineLow);
    columns[6].push_back(s.lines % kLineLow);
    turns.push_back({rounded(s.turn_rad[0]), rounded(s.turn_rad[1])});
  }
  json out = {{"turns", turns}, {"marks", json::array()}};
  for (const auto& column : columns) out["marks"].push_back(pack_integers(column));
  return out;
}

}  // namespace

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
  out["states"] = states_json(scene.moves.states);
  out["stretches"] = stretches_json(scene.moves);
  return out;
}

}  // namespace toothpath::page
