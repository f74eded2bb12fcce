#include "geometry/exchange/gltf.h"

#include <tiny_gltf.h>

#include <cstring>
#include <limits>
#include <sstream>

#include "geometry/base/angle.h"
#include "geometry/exchange/steel.h"

namespace toothpath::exchange {
namespace {

constexpr double kMetre = 1e-3;  // of a millimetre
constexpr double kMetallic = 0.3, kRoughness = 0.5;

/// sRGB to linear, as the format wants factors (IEC 61966-2-1).
double linear(std::uint8_t value) {
  const double c = value / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

int add_view(tinygltf::Model& model, std::size_t offset, std::size_t bytes, int target) {
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = offset;
  view.byteLength = bytes;
  view.target = target;
  model.bufferViews.push_back(view);
  return int(model.bufferViews.size()) - 1;
}

int add_accessor(tinygltf::Model& model, int view, int component, int type, std::size_t count) {
  tinygltf::Accessor accessor;
  accessor.bufferView = view;
  accessor.componentType = component;
  accessor.type = type;
  accessor.count = count;
  model.accessors.push_back(accessor);
  return int(model.accessors.size()) - 1;
}

/// Corners, then indices.
void add_pitch(tinygltf::Model& model, const mesh::TriangleMesh& pitch) {
  const std::size_t place_bytes = pitch.vertices.size() * 3 * sizeof(float),
                    index_bytes = pitch.triangles.size() * 3 * sizeof(std::uint32_t);
  tinygltf::Buffer buffer;
  buffer.data.resize(place_bytes + index_bytes);
  std::vector<double> least(3, std::numeric_limits<double>::infinity()), most(3, -least[0]);
  for (std::size_t k = 0; k < pitch.vertices.size(); ++k)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto value = float(pitch.vertices[k][Eigen::Index(axis)]);
      std::memcpy(buffer.data.data() + (3 * k + axis) * sizeof value, &value, sizeof value);
      least[axis] = std::min(least[axis], double(value));
      most[axis] = std::max(most[axis], double(value));
    }
  for (std::size_t k = 0; k < pitch.triangles.size(); ++k)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto index = std::uint32_t(pitch.triangles[k][corner]);
      std::memcpy(buffer.data.data() + place_bytes + (3 * k + corner) * sizeof index, &index, sizeof index);
    }
  model.buffers.push_back(std::move(buffer));
  const int places = add_accessor(model, add_view(model, 0, place_bytes, TINYGLTF_TARGET_ARRAY_BUFFER),
                                  TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, pitch.vertices.size());
  model.accessors[std::size_t(places)].minValues = least;
  model.accessors[std::size_t(places)].maxValues = most;
  const int indices =
      add_accessor(model, add_view(model, place_bytes, index_bytes, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER),
                   TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, 3 * pitch.triangles.size());
  tinygltf::Primitive primitive;
  primitive.attributes["POSITION"] = places;
  primitive.indices = indices;
  primitive.material = 0;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  tinygltf::Mesh mesh;
  mesh.name = "pitch";
  mesh.primitives.push_back(primitive);
  model.meshes.push_back(mesh);
}

void add_steel(tinygltf::Model& model) {
  tinygltf::Material steel;
  steel.name = "steel";
  steel.pbrMetallicRoughness.baseColorFactor = {linear(kSteel[0]), linear(kSteel[1]), linear(kSteel[2]), 1};
  steel.pbrMetallicRoughness.metallicFactor = kMetallic;
  steel.pbrMetallicRoughness.roughnessFactor = kRoughness;
  model.materials.push_back(steel);
}

void add_nodes(tinygltf::Model& model, int teeth, const std::string& name) {
  tinygltf::Node root;
  root.name = name;
  root.rotation = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // a quarter turn about x: z becomes y
  root.scale = {kMetre, kMetre, kMetre};
  for (int k = 0; k < teeth; ++k) root.children.push_back(k + 1);
  model.nodes.push_back(root);
  for (int k = 0; k < teeth; ++k) {
    const double half = kPi * k / teeth;
    tinygltf::Node node;
    node.name = "space " + std::to_string(k);
    node.mesh = 0;
    node.rotation = {0, 0, std::sin(half), std::cos(half)};
    model.nodes.push_back(node);
  }
  tinygltf::Scene scene;
  scene.name = name;
  scene.nodes = {0};
  model.scenes.push_back(scene);
  model.defaultScene = 0;
}

}  // namespace

Result<std::string> gltf_file(const mesh::TriangleMesh& pitch, int teeth, const std::string& name) {
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "toothpath";
  add_steel(model);
  add_pitch(model, pitch);
  add_nodes(model, teeth, name);
  std::ostringstream out;
  if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, out, false, true))
    return fail("tinygltf did not write a mesh of {} triangles", pitch.triangles.size());
  return std::move(out).str();
}

}  // namespace toothpath::exchange
