#include "geometry/mesh/file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>

#include "tests/geometry/mesh/samples.h"
#include "tests/support/files.h"

namespace toothpath::test {
namespace {

/// Axis-parallel box of 20 x 30 x 40 mm, 12 facets, outward; facet 0 lies on the underside.
mesh::TriangleMesh box(double scale = 1, const Vec3& at = Vec3::Zero()) {
  mesh::TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.vertices.push_back(at + scale * Vec3(k & 1 ? 20 : 0, k & 2 ? 30 : 0, k & 4 ? 40 : 0));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

std::string stl(const mesh::TriangleMesh& mesh) {
  std::ostringstream out;
  const auto written = mesh::write_stl(out, mesh, "box");
  EXPECT_TRUE(written);
  return out.str();
}

/// Keeps degenerate facets, which the writer leaves out.
std::string raw_stl(const mesh::TriangleMesh& mesh) {
  std::string bytes(84, '\0');
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::memcpy(bytes.data() + 80, &count, 4);
  for (std::size_t t = 0; t < count; ++t) {
    std::array<float, 12> f{};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t c = 0; c < 3; ++c) f[3 + 3 * k + c] = static_cast<float>(mesh.corner(t, k)[Eigen::Index(c)]);
    bytes.append(reinterpret_cast<const char*>(f.data()), 48).append(2, '\0');
  }
  return bytes;
}

std::string ascii_stl(const mesh::TriangleMesh& mesh, const std::string& end = "\n") {
  std::string text = "solid box" + end;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    text += "facet normal 0 0 0" + end + "outer loop" + end;
    for (std::size_t k = 0; k < 3; ++k)
      text += fmt::format("vertex {} {} {}", mesh.corner(t, k).x(), mesh.corner(t, k).y(), mesh.corner(t, k).z()) + end;
    text += "endloop" + end + "endfacet" + end;
  }
  return text + "endsolid box" + end;
}

std::string obj(const mesh::TriangleMesh& mesh) {
  std::string text = "mtllib ../../../etc/passwd\n";
  for (const Vec3& v : mesh.vertices) text += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
  for (const auto& t : mesh.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

std::string refusal(const std::string& bytes, const std::string& name = "box.stl",
                    const mesh::MeshImportLimits& limits = {}) {
  const auto mesh = mesh::parse_mesh(bytes, name, limits);
  return mesh ? "accepted" : mesh.error().text();
}

TEST(MeshFile, WholeGearComesBackThroughAssimp) {
  for (const MeshSample& sample : mesh_samples()) {
    if (sample.gear.zones.size() > 1) continue;
    const mesh::ToothMesh pitch = meshed(made(sample.gear), 0.05);
    const mesh::TriangleMesh gear = mesh::join_copies(pitch);
    std::ostringstream out;
    const auto counts = mesh::write_stl(out, pitch, "gear");
    ASSERT_TRUE(counts);
    EXPECT_EQ(out.str().size(), 84 + 50 * counts->facets);
    EXPECT_EQ(counts->facets + counts->collapsed, gear.triangles.size());
    mesh::MeshImportLimits limits;
    limits.self_intersections = false;  // examined in double by the mesh tests
    const auto back = mesh::parse_mesh(out.str(), "gear.stl", limits);
    ASSERT_TRUE(back) << sample.name << ": " << back.error().message;
    EXPECT_EQ(back->triangles.size(), counts->facets);
    EXPECT_NEAR(mesh::signed_volume(*back), mesh::signed_volume(gear), 1e-6 * signed_volume(gear));
    if (counts->collapsed > 0) continue;
    EXPECT_EQ(back->vertices.size(), gear.vertices.size());
    for (std::size_t t = 0; t < gear.triangles.size(); t += 101)
      for (std::size_t k = 0; k < 3; ++k)
        ASSERT_LE((back->corner(t, k) - gear.corner(t, k)).cwiseAbs().maxCoeff(), 1.6e-5) << sample.name;
  }
}

TEST(MeshFile, StreamedCopiesAreTheJoinedMesh) {
  const mesh::ToothMesh pitch = meshed(made(double_helical_parameters()), 0.3);
  std::ostringstream streamed, joined;
  ASSERT_TRUE(mesh::write_stl(streamed, pitch, "gear"));
  ASSERT_TRUE(mesh::write_stl(joined, mesh::join_copies(pitch), "gear"));
  EXPECT_TRUE(streamed.str() == joined.str());
}

TEST(MeshFile, EveryFormatOfTheBoxIsRead) {
  for (const auto& [name, bytes] : std::vector<std::pair<std::string, std::string>>{
           {"box.stl", stl(box())},
           {"box.STL", ascii_stl(box())},
           {"crlf.stl", ascii_stl(box(), "\r\n")},
           {"cr.stl", ascii_stl(box(), "\r")},
           {"upper.stl",
            replaced(replaced(ascii_stl(box()), "solid box", "SOLID BOX"), "facet normal", "FACET Normal")},
           {"wrapped.stl", replaced_all(ascii_stl(box()), " 0 ", "\n0\n")},
           {"fed.stl", replaced_all(replaced_all(ascii_stl(box()), " 0 ", "\v0\f"), "\nendfacet", "\f\v\nendfacet")},
           {"words.stl", replaced_all(replaced_all(ascii_stl(box()), "facet normal", "facet\r\nnormal"), "outer loop",
                                      "outer\n\nloop")},
           {"signs.stl", replaced_all(ascii_stl(box()), "vertex 20", "vertex\n+20.")},
           {"solid_binary.stl", "solid" + stl(box()).substr(5)},
           {"box.obj", obj(box())}}) {
    const auto mesh = mesh::parse_mesh(bytes, name);
    ASSERT_TRUE(mesh) << name << ": " << mesh.error().message;
    EXPECT_EQ(mesh->vertices.size(), 8u) << name;
    EXPECT_EQ(mesh->triangles.size(), 12u) << name;
    EXPECT_NEAR(mesh::signed_volume(*mesh), 24000, 1e-9) << name;
  }
}

TEST(MeshFile, DamagedBytesAreRefusedWithTheirReason) {
  const std::string good = stl(box()), text = ascii_stl(box());
  EXPECT_EQ(refusal(""), "box.stl: error: the file is empty");
  EXPECT_EQ(refusal(good.substr(0, 50)),
            "box.stl: error: 50 bytes are neither a text STL nor the 84 bytes of a binary header");
  EXPECT_EQ(refusal(good.substr(0, 600)),
            "box.stl: error: binary STL states 12 facets, which need 684 bytes; the file has 600");
  EXPECT_EQ(refusal(good + "x"), "box.stl: error: binary STL states 12 facets, which need 684 bytes; the file has 685");
  std::string huge = good;
  huge.replace(80, 4, "\xff\xff\xff\xff");
  EXPECT_EQ(refusal(huge),
            "box.stl: error: binary STL states 4294967295 facets, which need 214748364834 bytes; the file has 684");
  EXPECT_EQ(refusal(std::string(84, '\0')), "box.stl: error: the file has 0 facets");
  EXPECT_EQ(refusal("solid a\nendsolid a\n"), "box.stl: error: the file has 0 facets");
  mesh::MeshImportLimits few;
  few.most_facets = 11;
  EXPECT_EQ(refusal(good, "box.stl", few), "box.stl: error: the file has 12 facets; the limit is 11");
  EXPECT_EQ(refusal(text, "box.stl", few), "box.stl:79: error: more than 11 facets, the limit");
  few = {};
  few.most_bytes = 683;
  EXPECT_EQ(refusal(good, "box.stl", few), "box.stl: error: the file has 684 bytes; the limit is 683");
  EXPECT_EQ(refusal(good, "box.ply"), "box.ply: error: mesh files end in .stl or .obj, not \".ply\"");
  EXPECT_NE(refusal(good, "box.obj"), "accepted");
}

TEST(MeshFile, BadTextIsRefusedWithItsLine) {
  const std::string text = ascii_stl(box());
  EXPECT_EQ(refusal(replaced(text, "vertex 20 0 0", "vertex 20,0 0 0")),
            "box.stl:6: error: facet 0: \"20,0\" has a decimal comma");
  EXPECT_EQ(refusal(replaced(text, "vertex 20 0 0", "vertex nan 0 0")),
            "box.stl:6: error: facet 0: coordinate nan is not finite");
  EXPECT_EQ(refusal(replaced(text, "vertex 20 0 0", "vertex 1e400 0 0")),
            "box.stl:6: error: facet 0: 1e400 does not fit a 32-bit number");
  EXPECT_EQ(refusal(replaced(text, "vertex 20 0 0", "vertex 0x20 0 0")),
            "box.stl:6: error: facet 0: \"0x20\" is not a number");
  for (const std::string word : {"+-20", "-+20", "++20", "+", "-", ".", "e5", "20e", "+inf", "-.e5"})
    EXPECT_TRUE(
        refusal(replaced(text, "vertex 20 0 0", "vertex " + word + " 0 0")).starts_with("box.stl:6: error: facet 0: "))
        << refusal(replaced(text, "vertex 20 0 0", "vertex " + word + " 0 0"));
  EXPECT_EQ(refusal(replaced(text, "endloop", "vertex 1 2 3\nendloop")),
            "box.stl:7: error: facet 0 has more than 3 corners");
  EXPECT_EQ(refusal(replaced(text, "vertex 20 0 0\n", "")),
            "box.stl:6: error: \"endloop\" stands where \"vertex\" is expected");
  EXPECT_EQ(refusal(replaced(text, "endsolid box\n", "")), "box.stl:86: error: the file ends without \"endsolid\"");
  EXPECT_EQ(refusal(text.substr(0, text.find("vertex"))),
            "box.stl:4: error: the file ends where \"vertex\" is expected");
  EXPECT_EQ(refusal(text.substr(0, text.find("vertex 20 0 0") + 9)), "box.stl:6: error: the file ends inside facet 0");
  EXPECT_EQ(refusal(replaced(text, "solid box", "solid " + std::string(2000, 'x'))),
            "box.stl:1: error: the name of the solid has 2001 characters; the limit is 1000");
}

struct Broken {
  const char* name;
  std::function<void(mesh::TriangleMesh&)> fault;
  const char* message;
};

TEST(MeshFile, BrokenSolidsAreRefusedEachWithItsMessage) {
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<Broken> faults{
      {"nan", [](mesh::TriangleMesh& m) { m.vertices[1].y() = NAN; }, "facet 0: corner 2 = (20, nan, 0) is not finite"},
      {"inf", [&](mesh::TriangleMesh& m) { m.vertices[7].z() = inf; },
       "facet 3: corner 1 = (20, 30, inf) is not finite"},
      {"open", [](mesh::TriangleMesh& m) { m.triangles.erase(m.triangles.begin() + 3); },
       "facet 2 near (6.667, 10.000, 40.000) has an open edge: used by 1 facet, a closed surface needs 2"},
      {"flipped", [](mesh::TriangleMesh& m) { std::swap(m.triangles[7][0], m.triangles[7][1]); },
       "and facet 7 run along their common edge in the same direction: one of them is flipped"},
      {"duplicate", [](mesh::TriangleMesh& m) { m.triangles.push_back(m.triangles[5]); },
       "facet 5 near (13.333, 0.000, 26.667) and facet 12 have the same three corners"},
      {"three facets at an edge",
       [](mesh::TriangleMesh& m) {
         m.vertices.emplace_back(-5, -5, 20);
         m.triangles.push_back({0, 4, 8});
       },
       "has an edge used by 3 facets; a solid has 2"},
      {"degenerate",
       [](mesh::TriangleMesh& m) {
         m.triangles.push_back({0, 0, 1});
       },
       "facet 12 near (6.667, 0.000, 0.000) is degenerate: its height is 0 of its longest edge, the limit 1e-12"},
      {"on a line",
       [](mesh::TriangleMesh& m) {
         m.vertices.emplace_back(10, 0, 0);
         m.triangles.push_back({0, 1, 8});
       },
       "facet 12 near (10.000, 0.000, 0.000) is degenerate"},
      {"inside out",
       [](mesh::TriangleMesh& m) {
         for (auto& t : m.triangles) std::swap(t[0], t[1]);
       },
       "enclosed volume = -24000 mm^3 is not above 0: the surface is turned inside out"},
      {"crossing itself",
       [](mesh::TriangleMesh& m) {
         m.vertices[7] = {-10, -10, -10};
       },
       "cross each other"},
      {"two boxes through each other",
       [](mesh::TriangleMesh& m) {
         const mesh::TriangleMesh other = box(1, {10, 10, 10});
         for (const auto& t : other.triangles) m.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
         m.vertices.insert(m.vertices.end(), other.vertices.begin(), other.vertices.end());
       },
       "cross each other"},
      {"touching corners",
       [](mesh::TriangleMesh& m) {
         const mesh::TriangleMesh other = box(1, {20, 30, 40});
         for (const auto& t : other.triangles) m.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
         m.vertices.insert(m.vertices.end(), other.vertices.begin(), other.vertices.end());
       },
       "the surface touches itself at a corner"},
      {"far away",
       [](mesh::TriangleMesh& m) {
         for (Vec3& v : m.vertices) v.x() += 1e9;
       },
       "coordinate 1e+09 mm is farther than 100000 mm from the origin"},
      {"metres",
       [](mesh::TriangleMesh& m) {
         for (Vec3& v : m.vertices) v *= 1e-3;
       },
       "longest side = 0.04 mm is below 1 mm; is the file in inches or metres?"},
      {"micrometres",
       [](mesh::TriangleMesh& m) {
         for (Vec3& v : m.vertices) v *= 1e3;
       },
       "longest side = 40000 mm is above 5000 mm; is the file in micrometres?"},
  };
  for (const Broken& broken : faults) {
    mesh::TriangleMesh mesh = box();
    broken.fault(mesh);
    const std::string text = refusal(raw_stl(mesh));
    EXPECT_NE(text.find(broken.message), std::string::npos) << broken.name << ": " << text;
    EXPECT_EQ(text.rfind("box.stl: error: ", 0), 0u) << text;
  }
}

/// A drum whose lids are fans: every facet of a lid lies beside every other one.
mesh::TriangleMesh drum(int sides) {
  mesh::TriangleMesh m;
  m.vertices = {Vec3(0, 0, 0), Vec3(0, 0, 40)};
  for (int k = 0; k < sides; ++k)
    for (const double z : {0.0, 40.0})
      m.vertices.emplace_back(50 * std::cos(2 * kPi * k / sides), 50 * std::sin(2 * kPi * k / sides), z);
  for (int k = 0; k < sides; ++k) {
    const int a = 2 + 2 * k, b = 2 + 2 * ((k + 1) % sides);
    m.triangles.insert(m.triangles.end(), {{0, b, a}, {1, a + 1, b + 1}, {a, b, b + 1}, {a, b + 1, a + 1}});
  }
  return m;
}

// Pairs of long thin facets grow with the square of their number: a hundred million of them would be compared for
// minutes.
TEST(MeshFile, SliversAreRefusedByTheirNumber) {
  EXPECT_EQ(refusal(raw_stl(drum(2000)), "drum.stl"), "accepted");
  EXPECT_EQ(refusal(raw_stl(drum(20000)), "drum.stl"),
            "drum.stl: error: the boxes around its 80000 facets meet in more than 50000000 pairs: too many long thin "
            "facets to compare them all; a mesh with more even facets is needed");
}

TEST(MeshFile, UnitIsGuessedFromTheExpectedSize) {
  mesh::MeshImportLimits limits;
  limits.expected_size_mm = 40;
  EXPECT_EQ(refusal(stl(box()), "box.stl", limits), "accepted");
  EXPECT_NE(refusal(stl(box(1 / 25.4)), "box.stl", limits).find("probably in inches"), std::string::npos);
  EXPECT_NE(refusal(stl(box(1e-3)), "box.stl", limits).find("probably in metres"), std::string::npos);
}

TEST(MeshFile, FilesThatCannotBeReadAreFileAccessErrors) {
  const auto folder = std::filesystem::temp_directory_path() / "toothpath_mesh_file_test";
  std::filesystem::create_directories(folder / "folder.stl");
  const auto expect = [](const std::string& path, const std::string& message) {
    const auto mesh = mesh::load_mesh(path);
    ASSERT_FALSE(mesh) << path;
    EXPECT_EQ(mesh.error().kind, DiagnosticKind::file_access);
    EXPECT_EQ(mesh.error().message, message);
  };
  expect((folder / "none.stl").string(), "the mesh file does not exist");
  expect((folder / "folder.stl").string(), "the mesh file is not a regular file");
  expect("/dev/zero", "the mesh file is not a regular file");
  const std::string path = (folder / "box.stl").string();
  std::ofstream(path, std::ios::binary) << stl(box());
  EXPECT_TRUE(mesh::load_mesh(path));
  std::filesystem::remove_all(folder);
}

// Any bytes give a solid or a reason, never a crash and never a surface that is not closed.
TEST(MeshFile, MutatedFilesGiveASolidOrADiagnostic) {
  const std::vector<std::pair<std::string, std::string>> seeds{
      {"a.stl", stl(box())}, {"b.stl", ascii_stl(box())}, {"c.obj", obj(box())}};
  std::mt19937 random(20);
  std::size_t accepted = 0, refused = 0;
  for (int n = 0; n < 1500; ++n) {
    const auto& [name, good] = seeds[std::size_t(n) % seeds.size()];
    const std::string bytes = damaged(good, random, 1 + n % 4, "0123456789.-ef \n");
    const auto mesh = mesh::parse_mesh(bytes, name);
    if (mesh) {
      ++accepted;
      EXPECT_GT(mesh::signed_volume(*mesh), 0);
      for (const Vec3& v : mesh->vertices) EXPECT_TRUE(v.allFinite());
    } else {
      ++refused;
      EXPECT_FALSE(mesh.error().message.empty());
      EXPECT_EQ(mesh.error().position.file, name);
    }
  }
  EXPECT_GT(accepted, 20u);
  EXPECT_GT(refused, 200u);
}

TEST(MeshFile, StlOfAThinFacetLeavesItOut) {
  mesh::TriangleMesh mesh = box();
  mesh.vertices.push_back(mesh.vertices[0] + Vec3(20 + 1e-9, 0, 0));
  mesh.triangles.push_back({0, 1, 8});
  std::ostringstream out;
  const auto counts = mesh::write_stl(out, mesh, "box");
  ASSERT_TRUE(counts);
  EXPECT_EQ(counts->facets, 12u);
  EXPECT_EQ(counts->collapsed, 1u);
  EXPECT_FALSE(mesh::write_stl(out, mesh, "solid box"));
  out.setstate(std::ios::badbit);
  const auto failed = mesh::write_stl(out, mesh, "box");
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().kind, DiagnosticKind::file_access);
}

TEST(MeshFile, VtpHoldsEveryDoubleBitForBit) {
  const mesh::TriangleMesh mesh = box(1 / 3.0);
  const std::vector<double> field{0.1, -2, 3, 4, 5, 6, 1e-300, 8};
  std::ostringstream out;
  ASSERT_TRUE(mesh::write_vtp(out, mesh, std::vector<mesh::PointField>{{"deviation_um", field}}));
  const std::string text = out.str();
  const auto data = text.find("\n_") + 2;
  const auto block = [&](const std::string& name) {  // by the offset that the header states
    const auto entry = text.find("Name=\"" + name + "\"");
    const auto at = text.find("offset=\"", entry) + 8;
    const std::size_t offset = std::stoul(text.substr(at));
    std::uint64_t size = 0;
    std::memcpy(&size, text.data() + data + offset, 8);
    return text.substr(data + offset + 8, size);
  };
  EXPECT_EQ(block("Points"), std::string(reinterpret_cast<const char*>(mesh.vertices.data()), 8 * 24));
  EXPECT_EQ(block("deviation_um"), std::string(reinterpret_cast<const char*>(field.data()), 64));
  std::vector<std::int64_t> corners(36), ends(12);
  ASSERT_EQ(block("connectivity").size(), 36 * 8u);
  std::memcpy(corners.data(), block("connectivity").data(), 36 * 8);
  std::memcpy(ends.data(), block("offsets").data(), 12 * 8);
  for (std::size_t t = 0; t < 12; ++t) {
    EXPECT_EQ(ends[t], std::int64_t(3 * t + 3));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(corners[3 * t + k], mesh.triangles[t][k]);
  }
  const std::vector<double> short_field{1, 2};
  EXPECT_FALSE(mesh::write_vtp(out, mesh, std::vector<mesh::PointField>{{"deviation_um", short_field}}));
}

// No library reads this text: one ended with a signal on damaged files (tests/fuzz/found).
TEST(MeshFile, DamagedObjIsRefusedWithItsLine) {
  const std::string good = obj(box());
  EXPECT_EQ(refusal("# made by hand\r\nmtllib nowhere.mtl\no box\ng side\ns off\nvn 0 0 1\n" + good, "a.obj"),
            "accepted");
  struct Case {
    std::string text, words;
  };
  for (const Case& c : {
           Case{good + "f 1 2 3 4\n", "facet 12 has 4 corners; only triangles are read"},
           Case{good + "f 1 2\n", "facet 12 has 2 corners"},
           Case{good + "f 1 2 9\n", "the facet names vertex 9 of the 8 above it"},
           Case{good + "f 1 2 -9\n", "the facet names vertex -9 of the 8 above it"},
           Case{good + "f 1 2 99999999999999999999\n", "names no vertex"},
           Case{good + "f 0 1 2\n", "\"0\" names no vertex"},
           Case{good + "f 1/1/1 x//1 3\n", "\"x//1\" names no vertex"},
           Case{"v 1 2\n" + good, "a.obj:1: error: the vertex has 2 numbers, must have 3"},
           Case{"v 1 2 nan\n" + good, "\"nan\" is no finite number"},
           Case{"v 1 2 1e39\n" + good, "\"1e39\" is no finite number"},
           Case{"v 1 2 3x\n" + good, "\"3x\" is no finite number"},
           Case{"v 1 2 3 0.5\n" + good, "the vertex has the weight 0.5, must be 1"},
           Case{"curv 1 2\n" + good, "\"curv\" begins no line of a mesh in OBJ"},
           Case{"v!0  a", "\"v!0\" begins no line of a mesh in OBJ"},
           Case{"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "the file has 0 facets"},
       })
    EXPECT_NE(refusal(c.text, "a.obj").find(c.words), std::string::npos) << refusal(c.text, "a.obj");
}

}  // namespace
}  // namespace toothpath::test
