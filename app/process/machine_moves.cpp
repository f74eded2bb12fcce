#include "app/process/machine_moves.h"

#include <algorithm>

#include "app/report/machine_moves.h"
#include "geometry/mesh/file.h"

namespace toothpath::process {
namespace {

bodies::Cone cone_between(double from, double to, double radius_from, double radius_to, const Vec3& at,
                          const Vec3& axis) {
  return {at + from * axis, axis, to - from, radius_from, radius_to};
}

/// From the gear frame to machine coordinates with all joints at zero.
Vec3 in_machine(const joints::Setup& setup, const Vec3& p) { return setup.origin_mm + setup.rotation() * p; }

void add_meshes(const std::vector<SceneMesh>& meshes, const char* name, const joints::Setup& setup,
                std::vector<bodies::Body>& out) {
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    mesh::TriangleMesh mesh = meshes[k].mesh;
    for (Vec3& p : mesh.vertices) p = in_machine(setup, p);
    const std::string number = meshes.size() > 1 ? fmt::format(" {}", k + 1) : "";
    out.push_back({name + number, 0, bodies::Kind::work, bodies::Solid(mesh)});
  }
}

}  // namespace

ValueOrErrors<std::vector<bodies::Body>> machine_bodies(const machines::Machine& machine, bool examine) {
  std::vector<bodies::Body> out;
  std::vector<Diagnostic> errors;
  for (const machines::MachineBody& body : machine.bodies) {
    mesh::TriangleMesh mesh;
    if (const auto* shape = std::get_if<machines::MeshShape>(&body.shape)) {
      mesh::MeshImportLimits limits;
      limits.most_size_mm = 20000;
      limits.self_intersections = examine;
      auto read = mesh::load_mesh(shape->file, limits);
      if (!read) {
        const auto& why = read.error();
        errors.push_back(
            fail_at(machine.where(body.key + ".file"), "body \"{}\": {}: {}", body.name, shape->file, why.message));
        errors.back().kind = why.kind;
        continue;
      }
      mesh = std::move(*read);
    }
    out.push_back({body.name, body.link, bodies::Kind::machine, bodies::solid_of(body, &mesh), 0, body.touches});
  }
  if (!errors.empty()) return errors;
  return out;
}

Result<std::vector<bodies::Body>> bodies_in_machine(const job::Job& job, const machines::Machine& machine,
                                                    const GearProcess& gear, const Scene* scene) {
  if (machine.bodies.empty() || !job.setup) return std::vector<bodies::Body>();
  auto stated = machine_bodies(machine, false);
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
      std::vector<bodies::Convex> pieces;
      for (const tool::Frustum& f : body.pieces)
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

std::vector<std::string> reasons_of(const machines::Machine& machine, const bodies::MovesFound& found) {
  std::vector<std::string> out;
  for (const bodies::Meeting& m : found.failed)
    out.push_back(fmt::format("machine: line {}: {}, at {}", m.line, report::meeting_text(m, found.required_mm),
                              report::joints_text(machine, m.joints)));
  return out;
}

std::vector<std::string> help_for(const bodies::MovesFound& found) {
  std::vector<std::string> out;
  const auto add = [&](std::string text) {
    if (std::find(out.begin(), out.end(), text) == out.end()) out.push_back(std::move(text));
  };
  for (const bodies::Meeting& m : found.failed) {
    const auto either = [&](bodies::Kind kind) { return m.first_kind == kind || m.second_kind == kind; };
    if (either(bodies::Kind::tool))
      add(fmt::format("setup.origin with the gear farther from \"{}\", or a longer T{}",
                      m.first_kind == bodies::Kind::tool ? m.second : m.first, m.tool));
    else if (either(bodies::Kind::work))
      add(fmt::format("a longer tool than T{} (length, stick_out), or another setup.origin", m.tool));
    else
      add(fmt::format(
          "another setup.origin; or, where \"{}\" and \"{}\" bear on one another, touches in the machine file", m.first,
          m.second));
  }
  return out;
}

}  // namespace toothpath::process
