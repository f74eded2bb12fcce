// Import of mesh files: STL through assimp, of which only that reader is left registered; OBJ by obj_scan.
#include "geometry/mesh/file.h"

#include <assimp/BaseImporter.h>
#include <assimp/scene.h>

#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <bit>
#include <exception>
#include <filesystem>
#include <fstream>
#include <set>
#include <vector>

#include "geometry/base/hash.h"
#include "geometry/base/inputs_read.h"
#include "geometry/mesh/obj_scan.h"
#include "geometry/mesh/solid_check.h"
#include "geometry/mesh/stl_scan.h"

namespace toothpath::mesh {
namespace {

/// No file but the one in memory.
class NoFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

void keep_stl(Assimp::Importer& importer) {
  std::vector<Assimp::BaseImporter*> others;
  for (std::size_t k = 0; k < importer.GetImporterCount(); ++k) {
    Assimp::BaseImporter* reader = importer.GetImporter(k);
    std::set<std::string> endings;
    reader->GetExtensionList(endings);
    if (!endings.count("stl")) others.push_back(reader);
  }
  for (Assimp::BaseImporter* reader : others) {
    importer.UnregisterLoader(reader);
    delete reader;
  }
}

/// Shares vertices whose three 32-bit numbers have equal bits. Open addressing on a table of at least twice the
/// corners.
class Weld {
 public:
  explicit Weld(std::size_t corners) : table_(std::bit_ceil(2 * corners + 2), -1) {}

  std::int32_t index(const std::array<float, 3>& p, std::vector<Vec3>& vertices) {
    const std::array<float, 3> key{p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f};  // -0 becomes 0
    const auto bytes = std::bit_cast<std::array<char, sizeof key>>(key);
    for (std::size_t slot = fnv1a({bytes.data(), bytes.size()}) & (table_.size() - 1);;
         slot = (slot + 1) & (table_.size() - 1)) {
      if (table_[slot] < 0) {
        table_[slot] = static_cast<std::int32_t>(keys_.size());
        keys_.push_back(key);
        vertices.emplace_back(key[0], key[1], key[2]);
        return table_[slot];
      }
      if (same_bits(keys_[static_cast<std::size_t>(table_[slot])], key)) return table_[slot];
    }
  }

 private:
  static bool same_bits(const std::array<float, 3>& a, const std::array<float, 3>& b) {
    for (std::size_t k = 0; k < 3; ++k)
      if (std::bit_cast<std::uint32_t>(a[k]) != std::bit_cast<std::uint32_t>(b[k])) return false;
    return true;
  }
  std::vector<std::int32_t> table_;
  std::vector<std::array<float, 3>> keys_;
};

Result<TriangleMesh> welded(const aiScene& scene, const SourcePosition& at, const MeshImportLimits& limits) {
  std::size_t facets = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) facets += scene.mMeshes[m]->mNumFaces;
  if (facets == 0) return fail_at(at, "the file has 0 facets");
  if (facets > limits.most_facets)
    return fail_at(at, "the file has {} facets; the limit is {}", facets, limits.most_facets);
  TriangleMesh mesh;
  mesh.triangles.reserve(facets);
  Weld weld(3 * facets);
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[m];
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3)
        return fail_at(at, "facet {} has {} corners; only triangles are read", mesh.triangles.size(), face.mNumIndices);
      std::array<std::int32_t, 3> t{};
      for (unsigned k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= part.mNumVertices)
          return fail_at(at, "facet {} names vertex {} of {}", mesh.triangles.size(), face.mIndices[k],
                         part.mNumVertices);
        const aiVector3D& p = part.mVertices[face.mIndices[k]];
        t[k] = weld.index({p.x, p.y, p.z}, mesh.vertices);
      }
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

Result<TriangleMesh> welded(const ObjScan& scan, const SourcePosition& at) {
  if (scan.facets.empty()) return fail_at(at, "the file has 0 facets");
  TriangleMesh mesh;
  mesh.triangles.reserve(scan.facets.size());
  Weld weld(3 * scan.facets.size());
  for (const auto& facet : scan.facets) {
    std::array<std::int32_t, 3> t{};
    for (std::size_t k = 0; k < 3; ++k)
      t[k] = weld.index(scan.vertices[static_cast<std::size_t>(facet[k])], mesh.vertices);
    mesh.triangles.push_back(t);
  }
  return mesh;
}

std::string lower_ending(const std::string& name) {
  std::string ending = std::filesystem::path(name).extension().string();
  for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return ending;
}

Result<TriangleMesh> import_stl(std::string_view bytes, const SourcePosition& at, const MeshImportLimits& limits) {
  try {
    Assimp::Importer importer;
    importer.SetIOHandler(new NoFiles);  // the importer owns it
    keep_stl(importer);
    const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, "stl");
    if (!scene) return fail_at(at, "the file is damaged: {}", importer.GetErrorString());
    return welded(*scene, at, limits);
  } catch (const std::exception& problem) { return fail_at(at, "the file could not be read: {}", problem.what()); }
}

Result<TriangleMesh> import_obj(std::string_view bytes, const SourcePosition& at, const MeshImportLimits& limits) {
  const auto scan = scan_obj(bytes, at.file, limits.most_facets);
  return scan ? welded(*scan, at) : Result<TriangleMesh>(scan.error());
}

}  // namespace

Result<TriangleMesh> parse_mesh(std::string_view bytes, const std::string& name, const MeshImportLimits& limits) {
  const SourcePosition at{name, 0, 0};
  const std::string ending = lower_ending(name);
  if (ending != ".stl" && ending != ".obj") return fail_at(at, "mesh files end in .stl or .obj, not \"{}\"", ending);
  if (bytes.size() > limits.most_bytes)
    return fail_at(at, "the file has {} bytes; the limit is {}", bytes.size(), limits.most_bytes);
  if (bytes.empty()) return fail_at(at, "the file is empty");
  std::string text;
  std::size_t stated = 0;
  if (ending == ".stl") {
    auto scan = scan_stl(bytes, name, limits.most_facets);
    if (!scan) return scan.error();
    stated = scan->facets;
    text = std::move(scan->lower_case);
    if (!scan->binary) bytes = text;
  }
  auto mesh = ending == ".obj" ? import_obj(bytes, at, limits) : import_stl(bytes, at, limits);
  if (!mesh) return mesh;
  if (stated > 0 && mesh->triangles.size() != stated)
    return fail_at(at, "the file states {} facets, {} were read", stated, mesh->triangles.size());
  if (const auto solid = check_solid(*mesh, name, limits); !solid) return solid.error();
  return mesh;
}

Result<TriangleMesh> load_mesh(const std::string& path, const MeshImportLimits& limits) {
  note_input(path);
  const auto unreadable = [&](std::string why) {
    return Diagnostic{DiagnosticKind::file_access, {path, 0, 0}, std::move(why)};
  };
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) return unreadable("the mesh file does not exist");
  if (error) return unreadable(fmt::format("the mesh file cannot be read: {}", error.message()));
  if (status.type() != std::filesystem::file_type::regular) return unreadable("the mesh file is not a regular file");
  const auto size = std::filesystem::file_size(path, error);
  if (error) return unreadable(fmt::format("the mesh file cannot be read: {}", error.message()));
  if (size > limits.most_bytes)
    return fail_at({path, 0, 0}, "the file has {} bytes; the limit is {}", size, limits.most_bytes);
  std::ifstream in(path, std::ios::binary);
  if (!in) return unreadable("the mesh file cannot be opened");
  std::string bytes(size, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (std::size_t(in.gcount()) != size) return unreadable("the mesh file changed while it was read");
  return parse_mesh(bytes, path, limits);
}

}  // namespace toothpath::mesh
