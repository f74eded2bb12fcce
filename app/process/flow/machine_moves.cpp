#include "app/process/flow/machine_moves.h"

#include <algorithm>

#include "cam/tool/body.h"
#include "postproc/bodies/of_machine.h"

namespace toothpath::flow {
namespace {

bodies::Cone cone_between(double from, double to, double radius_from, double radius_to, const Vec3& at,
                          const Vec3& axis) {
  return {at + from * axis, axis, to - from, radius_from, radius_to};
}

/// From the gear frame to machine coordinates with all joints at zero.
Vec3 in_machine(const joints::Setup& setup, const Vec3& p) { return setup.origin_mm + setup.rotation() * p; }

void add_meshes(const std::vector<process::SceneMesh>& meshes, const char* name, const joints::Setup& setup,
                std::vector<bodies::Body>& out) {
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    mesh::TriangleMesh mesh = meshes[k].mesh;
    for (Vec3& p : mesh.vertices) p = in_machine(setup, p);
    const std::string number = meshes.size() > 1 ? fmt::format(" {}", k + 1) : "";
    out.push_back({name + number, 0, bodies::Kind::work, bodies::Solid(mesh)});
  }
}

}  // namespace

Result<std::vector<bodies::Body>> bodies_in_machine(const job::Job& job, const machines::Machine& machine,
                                                    const process::GearProcess& gear, const process::Scene* scene) {
  if (machine.bodies.empty() || !job.setup) return std::vector<bodies::Body>();
  auto stated = bodies::bodies_of(machine, false);
  if (const auto* errors = stated.refused()) return errors->front();
  std::vector<bodies::Body> out = std::move(stated).value();
  const joints::Setup& setup = *job.setup;
  const sheet::PartOutline part = gear.outline();
  const double low = std::min(part.tooth_top, part.bottom), high = std::max(part.tooth_top, part.bottom);
  out.push_back({"part", 0, bodies::Kind::work,
                 bodies::Solid({cone_between(low, high, part.outer_radius, part.outer_radius, setup.origin_mm,
                                             setup.rotation().col(2))})});
  if (scene) {
    add_meshes(scene->fixture, "fixture", setup, out);
    add_meshes(scene->stock, "stock", setup, out);
  }
  const auto tools = gear.scene(0);
  if (!tools) return tools.error();
  const std::size_t spindle = machines::Links(machine.chain).count() - 1;
  for (std::size_t k = 0; k < job.tools.size(); ++k)
    for (const clearance::MeshBody& body : tools->bodies[k]) {
      std::vector<tool::Frustum> frustums(body.pieces.begin(), body.pieces.end());
      if (const auto top = tool::holder_to_gauge_line(job.tools[k]); top && body.body == top->body)
        frustums.push_back(*top);
      std::vector<bodies::Convex> pieces;
      for (const tool::Frustum& f : frustums)
        pieces.emplace_back(
            cone_between(f.from, f.to, f.radius_from, f.radius_to, Vec3(0, 0, -job.tools[k].length_mm), Vec3::UnitZ()));
      if (!pieces.empty())
        out.push_back({fmt::format("T{} {}", job.tools[k].number, to_string(body.body)), spindle, bodies::Kind::tool,
                       bodies::Solid(std::move(pieces)), job.tools[k].number});
    }
  return out;
}

bodies::MovesJudge judge_of(const machines::Machine& machine, std::vector<bodies::Body> bodies, const job::Job& job,
                            double clearance_mm) {
  std::map<int, double> lengths;
  for (const auto& tool : job.tools) lengths[tool.number] = tool.length_mm;
  return {machine, std::move(bodies), std::move(lengths), {.required_mm = clearance_mm}};
}

}  // namespace toothpath::flow
