// `toothpath check` of a sample with meshes beside it: the program is made once for all tests of a suite, every test
// asks with its own meshes.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "geometry/mesh/file.h"
#include "tests/app/program.h"
#include "tests/cam/clearance/shapes.h"

namespace toothpath::test {

class CheckScene : public ::testing::Test {
 protected:
  using Json = nlohmann::json;

  /// To be called once a suite: runs the job of the sample.
  static void run_sample(const std::string& file) {
    dir_.emplace();
    job_ = kSamples + "/" + file;
    ASSERT_EQ(run_program({"run", job_, "--out", *dir_ / "run", "--quiet"}).exit_code, 0);
  }
  static void TearDownTestSuite() { dir_.reset(); }

  /// The mesh as a file; its path.
  static std::string stl(const std::string& name, const mesh::TriangleMesh& mesh) {
    std::ofstream out(*dir_ / name, std::ios::binary);
    EXPECT_TRUE(mesh::write_stl(out, mesh, name));
    return *dir_ / name;
  }
  /// Checks the program of the sample; its report is in `report_`, empty where there is none.
  Finished check(const std::vector<std::string>& options) {
    std::vector<std::string> words = {"check", job_, *dir_ / "run/program.ngc", "--out", *dir_ / "check"};
    words.insert(words.end(), options.begin(), options.end());
    const auto finished = run_program(words);
    const std::string text = file_text(*dir_ / "check/report.json");
    report_ = text.empty() ? Json() : Json::parse(text);
    return finished;
  }
  void expect_nothing_loaded_without_meshes() {
    ASSERT_EQ(check({}).exit_code, 0);
    EXPECT_FALSE(report_.contains("fixture"));
    EXPECT_FALSE(report_.contains("stock"));
    for (const auto& [stage, seconds] : report_["stages"].items()) EXPECT_EQ(stage.find("stock"), std::string::npos);
  }
  /// A file that is not there and one that is no mesh, as "--fixture" or "--stock".
  void expect_bad_files_refused(const std::string& option) {
    const auto missing = check({option, *dir_ / "nowhere.stl"});
    EXPECT_EQ(missing.exit_code, 4);
    EXPECT_NE(missing.err.find("nowhere.stl"), std::string::npos);
    write_file(*dir_ / "broken.stl", "solid nothing\nfacet nonsense");
    const auto broken = check({option, *dir_ / "broken.stl"});
    EXPECT_EQ(broken.exit_code, 3);
    EXPECT_NE(broken.err.find("broken.stl"), std::string::npos);
  }

  Json report_;
  static inline std::optional<TestDir> dir_;
  static inline std::string job_;
};

}  // namespace toothpath::test
