#include "geometry/exchange/three_mf.h"

#include <Model/COM/NMR_DLLInterfaces.h>

#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "geometry/base/hash.h"
#include "geometry/exchange/steel.h"

namespace toothpath::exchange {
namespace {

constexpr DWORD kMillimetre = NMR::MODELUNIT_MILLIMETER;

/// Anything of the library, given back at the end.
template <typename T>
class Held {
 public:
  Held() = default;
  ~Held() {
    if (held_) NMR::lib3mf_release(held_);
  }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  T** place() { return &held_; }
  T* get() const { return held_; }

 private:
  T* held_ = nullptr;
};

/// Calls until one fails.
class Calls {
 public:
  template <typename Call>
  Calls& then(const char* what, Call call) {
    if (!failed_ && call() != 0) failed_ = what;
    return *this;
  }
  [[nodiscard]] const char* failed() const { return failed_; }

 private:
  const char* failed_ = nullptr;
};

/// What the library would draw by chance: the same gear has the same one.
std::string identifier(const std::string& digest, int number) {
  const std::string hex = sha256_hex(digest + std::to_string(number));
  return hex.substr(0, 8) + "-" + hex.substr(8, 4) + "-4" + hex.substr(13, 3) + "-a" + hex.substr(17, 3) + "-" +
         hex.substr(20, 12);
}

}  // namespace

Result<std::string> three_mf_file(const mesh::TriangleMesh& mesh, const std::string& name) {
  using namespace NMR;
  std::vector<MODELMESHVERTEX> vertices(mesh.vertices.size());
  for (std::size_t k = 0; k < vertices.size(); ++k)
    for (int axis = 0; axis < 3; ++axis) vertices[k].m_fPosition[axis] = float(mesh.vertices[k][axis]);
  std::vector<MODELMESHTRIANGLE> triangles(mesh.triangles.size());
  for (std::size_t k = 0; k < triangles.size(); ++k)
    for (std::size_t corner = 0; corner < 3; ++corner)
      triangles[k].m_nIndices[corner] = DWORD(mesh.triangles[k][corner]);
  const std::string digest = sha256_hex(
      std::string(reinterpret_cast<const char*>(vertices.data()), vertices.size() * sizeof vertices.front()) + name);

  Held<PLib3MFModel> model;
  Held<PLib3MFModelMeshObject> object;
  Held<PLib3MFModelBaseMaterial> materials;
  Held<PLib3MFDefaultPropertyHandler> colour;
  Held<PLib3MFModelBuildItem> item;
  Held<PLib3MFModelWriter> writer;
  DWORD group = 0, steel = 0;
  ULONG64 bytes = 0;
  std::string out;
  Calls calls;
  calls.then("a model", [&] { return lib3mf_createmodel(model.place()); })
      .then("the unit", [&] { return lib3mf_model_setunit(model.get(), kMillimetre); })
      .then("the title", [&] { return lib3mf_model_addmetadatautf8(model.get(), "Title", name.c_str()); })
      .then("the program", [&] { return lib3mf_model_addmetadatautf8(model.get(), "Application", "toothpath"); })
      .then("materials", [&] { return lib3mf_model_addbasematerialgroup(model.get(), materials.place()); })
      .then("a colour",
            [&] {
              return lib3mf_basematerial_addmaterialutf8(materials.get(), "steel", kSteel[0], kSteel[1], kSteel[2],
                                                         &steel);
            })
      .then("an opaque colour",
            [&] {
              return lib3mf_basematerial_setdisplaycolorrgba(materials.get(), steel, kSteel[0], kSteel[1], kSteel[2],
                                                             0xff);
            })
      .then("a group", [&] { return lib3mf_basematerial_getresourceid(materials.get(), &group); })
      .then("an object", [&] { return lib3mf_model_addmeshobject(model.get(), object.place()); })
      .then("its name", [&] { return lib3mf_object_setnameutf8(object.get(), name.c_str()); })
      .then("its identifier", [&] { return lib3mf_object_setuuidutf8(object.get(), identifier(digest, 0).c_str()); })
      .then("its mesh",
            [&] {
              return lib3mf_meshobject_setgeometry(object.get(), vertices.data(), DWORD(vertices.size()),
                                                   triangles.data(), DWORD(triangles.size()));
            })
      .then("its colour", [&] { return lib3mf_object_createdefaultpropertyhandler(object.get(), colour.place()); })
      .then("its colour", [&] { return lib3mf_defaultpropertyhandler_setbasematerial(colour.get(), group, steel); })
      .then("an item", [&] { return lib3mf_model_addbuilditem(model.get(), object.get(), nullptr, item.place()); })
      .then("its identifier", [&] { return lib3mf_builditem_setuuidutf8(item.get(), identifier(digest, 1).c_str()); })
      .then("an identifier", [&] { return lib3mf_model_setbuilduuidutf8(model.get(), identifier(digest, 2).c_str()); })
      .then("a writer", [&] { return lib3mf_model_querywriter(model.get(), "3mf", writer.place()); })
      .then("its size", [&] { return lib3mf_writer_getstreamsize(writer.get(), &bytes); })
      .then("the package", [&] {
        out.resize(bytes);
        return lib3mf_writer_writetobuffer(writer.get(), reinterpret_cast<BYTE*>(out.data()), bytes);
      });
  if (calls.failed())
    return fail("lib3mf did not make {} of a mesh of {} triangles", calls.failed(), mesh.triangles.size());
  return out;
}

}  // namespace toothpath::exchange
