// `surface --step --3mf --gltf`: what other programs read in the files. FreeCAD opens the solids: where it is missing
// the test fails (tools/packages.sh, exchange_packages).
#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <assimp/Importer.hpp>
#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "geometry/mesh/cgal_check.h"
#include "geometry/mesh/file.h"
#include "tests/app/program.h"

namespace toothpath::test {
namespace {

constexpr double kDeflection_mm = 0.02;  // of FreeCAD's facets
constexpr double kSag_mm = 0.02;         // of those of gear.stl, at most

/// gear.stl of a run, as a solid.
mesh::TriangleMesh stl_of(const std::string& directory) {
  auto mesh = mesh::load_mesh(directory + "/gear.stl", {.least_size_mm = 1, .self_intersections = false});
  if (!mesh) throw std::runtime_error(mesh.error().message);
  return *std::move(mesh);
}

nlohmann::json seen_by_freecad(const TestDir& dir, const std::string& step) {
  const std::string command = fmt::format(
      "TOOTHPATH_STEP='{}' TOOTHPATH_DEFLECTION={} TOOTHPATH_STEP_SEEN='{}' freecadcmd '{}' < /dev/null "
      "> '{}' 2>&1",
      step, kDeflection_mm, dir / "seen.json", TOOTHPATH_SOURCE_DIR "/tests/app/open_step.py", dir / "log");
  if (std::system(command.c_str()) != 0 || !std::filesystem::exists(dir / "seen.json")) {
    ADD_FAILURE() << "FreeCAD did not open " << step << ": install exchange_packages of tools/packages.sh\n"
                  << file_text(dir / "log");
    return {};
  }
  return nlohmann::json::parse(file_text(dir / "seen.json"));
}

class Solids : public testing::TestWithParam<std::string> {};

TEST_P(Solids, OpenInFreeCadAsOneValidClosedSolid) {
  const TestDir dir;
  const Finished run =
      run_program({"surface", kSamples + "/" + GetParam() + ".toml", "--step", "--out", dir / "out", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto told = nlohmann::json::parse(run.out)["report"]["solid"];
  EXPECT_LE(told["worst_deviation_um"], 0.1);
  EXPECT_EQ(told["bytes"], std::filesystem::file_size(dir / "out/gear.step"));
  const auto seen = seen_by_freecad(dir, dir / "out/gear.step");
  ASSERT_FALSE(seen.is_null());
  EXPECT_EQ(seen["type"], "Solid");
  EXPECT_EQ(seen["solids"], 1);
  EXPECT_EQ(seen["shells"], 1);
  EXPECT_EQ(seen["valid"], true);
  EXPECT_EQ(seen["closed"], true);
  EXPECT_EQ(seen["faces"], told["faces"]);
  const mesh::TriangleMesh mesh = stl_of(dir / "out");
  const double area = seen["area"];
  EXPECT_NEAR(seen["volume_of_facets"], mesh::signed_volume(mesh), area * (kDeflection_mm + kSag_mm));
  EXPECT_NEAR(seen["volume"], mesh::signed_volume(mesh), 0.01 * mesh::signed_volume(mesh));
  for (int axis = 0; axis < 3; ++axis) {
    double low = INFINITY, high = -INFINITY;
    for (const Vec3& v : mesh.vertices) low = std::min(low, v[axis]), high = std::max(high, v[axis]);
    EXPECT_NEAR(seen["box"][std::size_t(axis)], low, 0.05);
    EXPECT_NEAR(seen["box"][std::size_t(axis) + 3], high, 0.05);
  }
}
INSTANTIATE_TEST_SUITE_P(Samples, Solids,
                         testing::Values("spur_quick", "offset_milled", "dhfg_ball", "bevel_pinion", "bevel_wheel"),
                         [](const auto& sample) { return sample.param; });

/// One file of a ZIP archive, by its central directory.
std::string unzipped(const std::string& archive, const std::string& name) {
  const auto number = [&](std::size_t at, std::size_t bytes) {
    std::uint64_t value = 0;
    for (std::size_t k = bytes; k-- > 0;) value = value << 8 | static_cast<unsigned char>(archive.at(at + k));
    return std::size_t(value);
  };
  const std::size_t end = archive.rfind("PK\5\6"), large = archive.rfind("PK\6\6");  // the second: ZIP64
  std::size_t at = large == std::string::npos ? number(end + 16, 4) : number(large + 48, 8);
  for (std::size_t k = number(end + 10, 2); k > 0; --k) {
    const std::size_t length = number(at + 28, 2);
    if (archive.compare(at + 46, length, name) == 0) {
      std::size_t packed = number(at + 20, 4), size = number(at + 24, 4), local = number(at + 42, 4);
      std::size_t extra = at + 46 + length;  // ZIP64: what does not fit stands in the field 1
      while (number(extra, 2) != 1 && extra < at + 46 + length + number(at + 30, 2)) extra += 4 + number(extra + 2, 2);
      extra += 4;
      for (std::size_t* value : {&size, &packed, &local})
        if (*value == 0xffffffff) {
          *value = number(extra, 8);
          extra += 8;
        }
      const std::size_t data = local + 30 + number(local + 26, 2) + number(local + 28, 2);
      if (number(at + 10, 2) == 0) return archive.substr(data, size);
      std::string out(size, '\0');
      z_stream stream{};
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(archive.data() + data));
      stream.avail_in = uInt(packed);
      stream.next_out = reinterpret_cast<Bytef*>(out.data());
      stream.avail_out = uInt(size);
      EXPECT_EQ(inflateInit2(&stream, -MAX_WBITS), Z_OK);
      EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
      inflateEnd(&stream);
      return out;
    }
    at += 46 + length + number(at + 30, 2) + number(at + 32, 2);
  }
  ADD_FAILURE() << "no " << name << " in the archive";
  return {};
}

/// Values of three attributes of every element of a name, in their order.
template <typename Use>
void for_each_element(const std::string& xml, const std::string& element, const std::array<const char*, 3>& names,
                      Use use) {
  for (std::size_t at = xml.find("<" + element + " "); at != std::string::npos;
       at = xml.find("<" + element + " ", at + 1)) {
    std::array<double, 3> value{};
    for (std::size_t k = 0; k < 3; ++k)
      value[k] =
          std::stod(xml.substr(xml.find(std::string(" ") + names[k] + "=\"", at) + 3 + std::strlen(names[k]), 24));
    use(value);
  }
}

TEST(MeshesForOthers, The3mfIsAClosedGearInMillimetres) {
  for (const char* sample : {"spur_quick", "bevel_pinion"}) {
    const TestDir dir;
    ASSERT_EQ(
        run_program({"surface", kSamples + "/" + sample + ".toml", "--3mf", "--out", dir / "out", "--quiet"}).exit_code,
        0);
    const std::string xml = unzipped(file_text(dir / "out/gear.3mf"), "3D/3dmodel.model");
    EXPECT_NE(xml.find("unit=\"millimeter\""), std::string::npos);
    EXPECT_NE(xml.find("name=\"" + replaced_all(sample, "_", "-") + "\""), std::string::npos);
    EXPECT_NE(xml.find("displaycolor=\"#B0B8BFFF\""), std::string::npos);
    mesh::TriangleMesh mesh;
    for_each_element(xml, "vertex", {"x", "y", "z"},
                     [&](const auto& v) { mesh.vertices.emplace_back(v[0], v[1], v[2]); });
    for_each_element(xml, "triangle", {"v1", "v2", "v3"}, [&](const auto& t) {
      mesh.triangles.push_back({std::int32_t(t[0]), std::int32_t(t[1]), std::int32_t(t[2])});
    });
    const auto check = mesh::check_mesh(mesh, {.self_intersections = false});
    ASSERT_TRUE(check) << check.error().message;
    EXPECT_TRUE(check->manifold && check->closed && check->outward) << sample;
    EXPECT_EQ(check->components, 1u);
    const double volume = mesh::signed_volume(stl_of(dir / "out"));
    EXPECT_NEAR(check->volume_mm3, volume, 1e-5 * volume);
  }
}

void add_instances(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above,
                   std::vector<std::array<Vec3, 3>>& out) {
  const aiMatrix4x4 here = above * node.mTransformation;
  for (unsigned k = 0; k < node.mNumMeshes; ++k) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[k]];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      std::array<Vec3, 3> corners;
      for (unsigned c = 0; c < 3; ++c) {
        const aiVector3D p = here * mesh.mVertices[mesh.mFaces[f].mIndices[c]];
        corners[c] = {double(p.x), double(p.y), double(p.z)};
      }
      out.push_back(corners);
    }
  }
  for (unsigned k = 0; k < node.mNumChildren; ++k) add_instances(scene, *node.mChildren[k], here, out);
}

/// Number of a place: of one that was near it before.
class Welded {
 public:
  int operator()(const Vec3& p) {
    const std::array<long, 3> cell{std::lround(p.x() / kWeld), std::lround(p.y() / kWeld), std::lround(p.z() / kWeld)};
    for (long a = -1; a <= 1; ++a)
      for (long b = -1; b <= 1; ++b)
        for (long c = -1; c <= 1; ++c)
          if (const auto known = cells_.find({cell[0] + a, cell[1] + b, cell[2] + c}); known != cells_.end())
            return known->second;
    return cells_.emplace(cell, int(cells_.size())).first->second;
  }

 private:
  static constexpr double kWeld = 5e-7;  // metres
  std::map<std::array<long, 3>, int> cells_;
};

TEST(MeshesForOthers, TheGltfIsAClosedGearInMetresWithItsAxisUp) {
  for (const char* sample : {"spur_quick", "bevel_pinion"}) {
    const TestDir dir;
    ASSERT_EQ(run_program({"surface", kSamples + "/" + sample + ".toml", "--gltf", "--out", dir / "out", "--quiet"})
                  .exit_code,
              0);
    EXPECT_LT(std::filesystem::file_size(dir / "out/gear.glb"), 200'000u);
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(dir / "out/gear.glb", 0);
    ASSERT_NE(scene, nullptr) << importer.GetErrorString();
    std::vector<std::array<Vec3, 3>> triangles;
    add_instances(*scene, *scene->mRootNode, {}, triangles);
    double volume = 0;
    Vec3 low = Vec3::Constant(INFINITY), high = -low;
    Welded weld;
    std::map<std::pair<int, int>, int> edges;
    for (const auto& t : triangles) {
      volume += t[0].dot(t[1].cross(t[2])) / 6;
      std::array<int, 3> index{};
      for (std::size_t k = 0; k < 3; ++k) {
        low = low.cwiseMin(t[k]);
        high = high.cwiseMax(t[k]);
        index[k] = weld(t[k]);
      }
      for (std::size_t k = 0; k < 3; ++k) ++edges[{index[k], index[(k + 1) % 3]}];
    }
    std::size_t open = 0;
    for (const auto& [edge, count] : edges) open += count != 1 || !edges.contains({edge.second, edge.first});
    EXPECT_EQ(open, 0u) << sample;
    const mesh::TriangleMesh stl = stl_of(dir / "out");
    EXPECT_NEAR(volume, mesh::signed_volume(stl) * 1e-9, 1e-4 * volume) << sample;
    Vec3 stl_low = Vec3::Constant(INFINITY), stl_high = -stl_low;
    for (const Vec3& v : stl.vertices) stl_low = stl_low.cwiseMin(v), stl_high = stl_high.cwiseMax(v);
    // x stays, y is the gear's axis, z is -y of the gear.
    EXPECT_LT((low - 1e-3 * Vec3(stl_low.x(), stl_low.z(), -stl_high.y())).norm(), 1e-6) << sample;
    EXPECT_LT((high - 1e-3 * Vec3(stl_high.x(), stl_high.z(), -stl_low.y())).norm(), 1e-6) << sample;
  }
}

TEST(FilesForOthers, AreWrittenWhereTheyAreAskedForAndAreTheSameBytes) {
  const TestDir dir;
  const std::string job = kSamples + "/spur_quick.toml";
  const std::vector<std::string> files = {"gear.step", "gear.3mf", "gear.glb"};
  for (const char* threads : {"1", "2"})
    ASSERT_EQ(run_program({"surface", job, "--step", "--3mf", "--gltf", "--out", dir / threads, "--threads", threads})
                  .exit_code,
              0);
  for (const auto& file : files) {
    ASSERT_FALSE(file_text(dir / "1/" + file).empty()) << file;
    EXPECT_EQ(file_text(dir / "1/" + file), file_text(dir / "2/" + file)) << file;
  }
  // Not asked for: not written, and those of another gear do not stay.
  const Finished again = run_program({"surface", job, "--out", dir / "1", "--json"});
  ASSERT_EQ(again.exit_code, 0);
  EXPECT_FALSE(nlohmann::json::parse(again.out)["report"].contains("solid"));
  for (const auto& file : files) EXPECT_FALSE(std::filesystem::exists(dir / "1/" + file)) << file;
}

TEST(FilesForOthers, ARunWritesThem) {
  const TestDir dir;
  const Finished run =
      run_program({"run", kSamples + "/spur_quick.toml", "--step", "--3mf", "--gltf", "--out", dir / "out", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const auto& file : {"gear.step", "gear.3mf", "gear.glb"})
    EXPECT_TRUE(std::filesystem::exists(dir / "out/" + file)) << file;
  EXPECT_EQ(nlohmann::json::parse(run.out)["report"]["solid"]["file"], "gear.step");
}

/// A groove whose floor is a hair below the root: no step that a solid can have.
TEST(FilesForOthers, WhatHasNoSolidIsRefusedAtItsPlace) {
  const TestDir dir;
  std::string job = file_text(kSamples + "/dhfg_paper.toml");
  const std::size_t depth = job.find("groove_depth");
  ASSERT_NE(depth, std::string::npos);
  job.replace(depth, job.find('\n', depth) - depth, "groove_depth = 11.2501");
  write_file(dir / "job.toml", job);
  const Finished run = run_program({"surface", dir / "job.toml", "--step", "--out", dir / "out"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("the groove's floor"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("job.toml:"), std::string::npos) << run.err;
  EXPECT_TRUE(names_in(dir / "out").empty());
}

}  // namespace
}  // namespace toothpath::test
