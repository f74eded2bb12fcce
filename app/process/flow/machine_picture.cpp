#include "app/process/flow/machine_picture.h"

#include <algorithm>
#include <cmath>

#include "cam/tool/body.h"
#include "geometry/mesh/file.h"
#include "machines/links.h"

namespace toothpath::flow {
namespace {

constexpr std::size_t kMostFacets = 6000;  // of a mesh on the page; larger ones are drawn as their box
constexpr double kMostClamping = 400;      // mm between the underside of the gear and what stands below it

std::variant<machines::BoxShape, machines::ConeShape, mesh::TriangleMesh> drawn(mesh::TriangleMesh mesh) {
  if (mesh.triangles.size() <= kMostFacets) return mesh;
  machines::BoxShape box{mesh.vertices.front(), mesh.vertices.front()};
  for (const Vec3& p : mesh.vertices) {
    box.low = box.low.cwiseMin(p);
    box.high = box.high.cwiseMax(p);
  }
  return box;
}

page::SceneBody round(const char* name, std::size_t link, double radius, const Vec3& from, const Vec3& to) {
  return {name, link, machines::ConeShape{from, to, radius, radius}, true};
}

void add_stated(const machines::Machine& machine, std::vector<page::SceneBody>& out) {
  for (const machines::MachineBody& body : machine.bodies) {
    page::SceneBody drawn_body{body.name, body.link, machines::BoxShape{}};
    if (const auto* box = std::get_if<machines::BoxShape>(&body.shape)) drawn_body.shape = *box;
    else if (const auto* cone = std::get_if<machines::ConeShape>(&body.shape)) drawn_body.shape = *cone;
    else {
      mesh::MeshImportLimits limits;
      limits.most_size_mm = 1e6;
      limits.self_intersections = false;
      auto mesh = mesh::load_mesh(std::get<machines::MeshShape>(body.shape).file, limits);
      if (!mesh) continue;
      drawn_body.shape = drawn(std::move(*mesh));
    }
    out.push_back(std::move(drawn_body));
  }
}

}  // namespace

page::StateRecorder recorder_of(const job::Job& job, int teeth) {
  std::vector<int> numbers;
  for (const auto& tool : job.tools) numbers.push_back(tool.number);
  return {std::move(numbers), job.operations.size(), job.operations.size() * std::size_t(teeth)};
}

std::optional<page::MachineScene> machine_picture(const job::Job& job, const machines::Machine& machine,
                                                  const process::GearProcess& gear, page::SceneStates states,
                                                  const process::Scene* scene) {
  auto pitch = gear.pitch_mesh(process::FacetSize::picture);
  if (!pitch || !job.setup) return std::nullopt;
  page::MachineScene out;
  out.chain = machine.chain;
  out.origin_mm = job.setup->origin_mm;
  out.rotation = job.setup->rotation();
  out.teeth = gear.part().teeth;
  out.pitch = std::move(*pitch);
  for (const auto& tool : job.tools) out.tool_length_mm.push_back(tool.length_mm);
  out.moves = std::move(states);
  add_stated(machine, out.bodies);

  const sheet::PartOutline part = gear.outline();
  const auto height = [&](double z) { return (out.origin_mm + z * out.rotation.col(2)).z(); };
  double under = std::min(height(part.bottom), height(part.tooth_top));
  for (const Vec3& p : out.pitch.vertices) under = std::min(under, (out.origin_mm + out.rotation * p).z());
  const auto at = [&](double z) { return Vec3(out.origin_mm.x(), out.origin_mm.y(), z); };
  const bool stated = !machine.bodies.empty();
  const std::size_t spindle = machines::Links(machine.chain).count() - 1;
  auto top = machine.top_under(at(under));
  if (!stated) {
    const double radius = std::min(machine.table_diameter_mm / 2, std::max(1.5 * part.outer_radius, 60.0));
    top = under - 0.15 * radius;
    out.bodies.push_back(round("table", 0, radius, at(*top - 0.12 * radius), at(*top)));
    const double nose = std::clamp(0.2 * radius, 25.0, 80.0);
    out.bodies.push_back(round("spindle", spindle, nose, Vec3::Zero(), Vec3(0, 0, 2.4 * nose)));
  }
  for (std::size_t k = 0; k < job.tools.size(); ++k)
    if (const auto rest = tool::holder_to_gauge_line(job.tools[k])) {
      const double length = job.tools[k].length_mm;
      out.bodies.push_back({"holder", spindle,
                            machines::ConeShape{Vec3(0, 0, rest->from - length), Vec3(0, 0, rest->to - length),
                                                rest->radius_from, rest->radius_to},
                            false, false, int(k)});
    }
  const bool held = top && under - *top > 0.1 && under - *top < kMostClamping;
  const double inner = std::max(part.inner_radius, 0.35 * part.outer_radius);
  if (held) out.bodies.push_back(round("clamping", 0, 0.97 * inner, at(*top), at(under + 0.6)));
  if (scene)
    for (const auto& fixture : scene->fixture) out.bodies.push_back({"fixture", 0, drawn(fixture.mesh), false, true});
  out.note = stated ? "bodies as the machine file states them"
                    : "the machine file states no bodies: table and spindle stand in for them";
  if (held) out.note += "; what holds the gear is not stated, a disc stands in for it";
  return out;
}

}  // namespace toothpath::flow
