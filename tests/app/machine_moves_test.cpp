// Bodies of a machine from outside: samples that are clear, bodies in the way, meshes that are none.
#include <nlohmann/json.hpp>
#include <regex>

#include "geometry/mesh/file.h"
#include "tests/app/program.h"

namespace toothpath::test {
namespace {

using Json = nlohmann::json;

constexpr const char* kPost =
    "\n[[body]]\nname = \"post\"\nof = \"bed\"\nshape = \"cylinder\"\nfrom = [65.0, 0.0, 130.0]\nto = [65.0, 0.0, "
    "200.0]\n"
    "diameter = 2.0\n";

/// spur_quick on a copy of its machine with `bodies` behind it.
class MachineMoves : public ::testing::Test {
 protected:
  Finished run(const std::string& bodies, const std::string& options = {}, double higher = 0) {
    const std::string machine = file_text(kMachines + "/xyzac_large.toml");
    write_file(dir_ / "m.toml", machine.substr(0, machine.find("\n[[body]]")) + bodies);
    const std::string job = replaced(file_text(kSamples + "/spur_quick.toml"), "\"xyzac_large.toml\"", "\"m.toml\"");
    write_file(dir_ / "job.toml",
               replaced(job, "[3.0, -2.0, 120.0]", fmt::format("[3.0, -2.0, {:.1f}]", 120 + higher)));
    std::vector<std::string> words = {"run", dir_ / "job.toml", "--out", dir_ / "out"};
    if (!options.empty()) words.push_back(options);
    const Finished done = run_program(words);
    const std::string text = file_text(dir_ / "out/report.json");
    report_ = text.empty() ? Json() : Json::parse(text);
    return done;
  }
  TestDir dir_;
  Json report_;
};

TEST_F(MachineMoves, WithoutBodiesItSaysSo) {
  const Finished done = run("");
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_NE(done.out.find("none stated, moves of the machine are not checked against each other"), std::string::npos);
  EXPECT_EQ(report_["machine_moves"], Json({{"bodies", 0}}));
}

TEST_F(MachineMoves, ABodyInTheWayIsAVerdictWithItsLine) {
  const Finished done = run(kPost);
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "out/program.ngc"));
  const Json& moves = report_["machine_moves"];
  ASSERT_FALSE(moves["clear"].get<bool>());
  ASSERT_FALSE(moves["failed"].empty());
  const Json& first = moves["failed"][0];
  const int line = first["line"];
  EXPECT_GT(line, 10);
  EXPECT_EQ(first["bodies"][0], "post");
  EXPECT_NE(done.err.find(fmt::format("machine: line {}: ", line)), std::string::npos) << done.err;
  EXPECT_NE(done.err.find("and post "), std::string::npos) << done.err;
  EXPECT_NE(file_text(dir_ / "out/report.html").find("Bodies of the machine"), std::string::npos);
}

/// A post on the table stands in the way of the tool. The heights that are offered end in a verified program; the way
/// out of a higher place may need a little more.
TEST_F(MachineMoves, APlaceThatFitsIsOffered) {
  const std::string post = replaced(kPost, "of = \"bed\"", "of = \"C\"");
  double higher = 0;
  for (int k = 0; k < 3; ++k) {
    const Finished done = run(post, {}, higher);
    if (k > 0 && done.exit_code == 0) return;
    EXPECT_EQ(done.exit_code, 1);
    std::smatch offer;
    ASSERT_TRUE(std::regex_search(done.err, offer, std::regex("what would help: setup.origin ([0-9]+) mm higher")))
        << done.err;
    higher += std::stod(offer[1]);
  }
  FAIL() << higher;
}

// A lintel below the height at which the machine changes tools: no set-up helps.
TEST_F(MachineMoves, TheMachinesOwnHeightIsNamed) {
  const Finished done =
      run("\n[[body]]\nname = \"lintel\"\nof = \"bed\"\nshape = \"box\"\nmin = [-400.0, -400.0, 540.0]\nmax = [400.0, "
          "400.0, 700.0]\n");
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_NE(done.err.find("the way is to or from the machine's own height"), std::string::npos) << done.err;
  EXPECT_EQ(done.err.find("setup.origin"), std::string::npos) << done.err;
}

TEST_F(MachineMoves, TheSameFarAwayIsClear) {
  const Finished clear = run(replaced(replaced(kPost, "from = [65.0, 0.0, 130.0]", "from = [400.0, 0.0, 130.0]"),
                                      "to = [65.0, 0.0, 200.0]", "to = [400.0, 0.0, 200.0]"));
  EXPECT_EQ(clear.exit_code, 0) << clear.err;
  EXPECT_TRUE(report_["machine_moves"]["clear"].get<bool>());
}

/// Samples on machines with a head: verified with their bodies; and with a post that stands where the teeth are cut.
struct HeadCase {
  const char *sample, *machine, *program;
  Vec3 post;
  int first_tooth, last_tooth;  ///< that meets it
};
class HeadMachines : public ::testing::TestWithParam<HeadCase> {};

TEST_P(HeadMachines, AreClearAndAPostIsFoundAtItsTooth) {
  const HeadCase c = GetParam();
  const TestDir dir;
  const std::string sample = file_text(kSamples + "/" + c.sample + ".toml");
  const auto run = [&](const std::string& name, const std::string& more) {
    write_file(dir / "m.toml", file_text(kMachines + "/" + c.machine + ".toml") + more);
    write_file(dir / "job.toml", replaced(sample, std::string("\"") + c.machine + ".toml\"", "\"m.toml\""));
    return run_program({"run", dir / "job.toml", "--out", dir / name});
  };
  const Finished clear = run("clear", "");
  EXPECT_EQ(clear.exit_code, 0) << clear.err;
  const Json good = Json::parse(file_text(dir / "clear/report.json"))["machine_moves"];
  EXPECT_TRUE(good["clear"].get<bool>());
  EXPECT_GE(good["bodies"].get<int>(), 9);
  const Finished met = run("met", fmt::format("\n[[body]]\nname = \"post\"\nof = \"bed\"\nshape = \"cylinder\"\nfrom = "
                                              "[{0:.3f}, {1:.3f}, {2:.3f}]\nto = [{0:.3f}, {1:.3f}, {3:.3f}]\ndiameter "
                                              "= 2.0\n",
                                              c.post.x(), c.post.y(), c.post.z(), c.post.z() + 8));
  EXPECT_EQ(met.exit_code, 1);
  EXPECT_FALSE(std::filesystem::exists(dir / std::string("met/program.") + c.program));
  const Json first = Json::parse(file_text(dir / "met/report.json"))["machine_moves"]["failed"][0];
  EXPECT_EQ(first["bodies"][0], "post");
  EXPECT_GE(first["tooth"].get<int>(), c.first_tooth) << first;
  EXPECT_LE(first["tooth"].get<int>(), c.last_tooth) << first;
  EXPECT_NE(met.err.find(fmt::format("machine: line {}: ", first["line"].get<int>())), std::string::npos) << met.err;
}

INSTANTIATE_TEST_SUITE_P(Samples, HeadMachines,
                         ::testing::Values(HeadCase{"spur_head_table", "head_table_bc", "ngc", Vec3(62, 0, 92), -1, 0},
                                           HeadCase{"spur_fork_head", "head_head_ca", "h", Vec3(0, 62, 92), 13, 16}));

TEST_F(MachineMoves, TheSameOnAnyNumberOfThreads) {
  (void)run(kPost, "--threads=1");
  const Json one = report_["machine_moves"];
  (void)run(kPost);
  EXPECT_EQ(one, report_["machine_moves"]);
}

TEST_F(MachineMoves, MeshesMustBeSolids) {
  const std::string body = "\n[[body]]\nname = \"arm\"\nof = \"A\"\nshape = \"mesh\"\nfile = \"arm.stl\"\n";
  const Finished missing = run(body);
  EXPECT_EQ(missing.exit_code, 4) << missing.err;
  EXPECT_NE(missing.err.find("m.toml:"), std::string::npos) << missing.err;
  EXPECT_NE(missing.err.find(":8: error: body \"arm\": "), std::string::npos) << missing.err;
  mesh::TriangleMesh open;
  open.vertices = {Vec3(-900, 0, -500), Vec3(-800, 0, -500), Vec3(-900, 100, -500), Vec3(-900, 0, -400)};
  open.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}};
  const auto write = [&] {
    std::ofstream out(dir_ / "arm.stl", std::ios::binary);
    ASSERT_TRUE(mesh::write_stl(out, open, "arm"));
  };
  write();
  const Finished refused = run(body);
  EXPECT_EQ(refused.exit_code, 3) << refused.err;
  EXPECT_NE(refused.err.find(":8: error: body \"arm\": "), std::string::npos) << refused.err;
  open.triangles.push_back({1, 2, 3});
  write();
  const Finished closed = run(body);
  EXPECT_EQ(closed.exit_code, 0) << closed.err;
  EXPECT_EQ(report_["machine_moves"]["bodies"], 1);
}

}  // namespace
}  // namespace toothpath::test
