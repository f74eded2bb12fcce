#include "postproc/bodies/of_machine.h"

#include "geometry/mesh/file.h"

namespace toothpath::bodies {
namespace {

constexpr double kLargestBody = 20000;  // mm: a bed

}  // namespace

Expected<std::vector<Body>, std::vector<Diagnostic>> bodies_of(const machines::Machine& machine, bool examine) {
  std::vector<Body> out;
  std::vector<Diagnostic> errors;
  for (const machines::MachineBody& body : machine.bodies) {
    mesh::TriangleMesh mesh;
    if (const auto* shape = std::get_if<machines::MeshShape>(&body.shape)) {
      mesh::MeshImportLimits limits;
      limits.most_size_mm = kLargestBody;
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
    out.push_back({body.name, body.link, Kind::machine, solid_of(body, &mesh), 0, body.touches});
  }
  if (!errors.empty()) return errors;
  return out;
}

}  // namespace toothpath::bodies
