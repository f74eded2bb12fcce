// A good machine file to damage, and a directory that goes away with the test.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace toothpath::test {

inline constexpr const char* kMachine = R"(schema = 1
name = "example"
kind = "five_axis"
dialect = "linuxcnc"
tcp = "none"
assumed = false
max_simultaneous_axes = 5

[spindle]
max_speed = 24000

[limits]
cutting_feed = 10000
table_diameter = 500
min_block_ms = 1.0

[chain]
table = ["C", "A"]
head = []

[axes.X]
min = -300.0
max = 300.0
max_speed = 30000

[axes.Y]
min = -250.0
max = 250.0
max_speed = 30000

[axes.Z]
min = -400.0
max = 0.0
max_speed = 20000

[axes.A]
direction = [1.0, 0.0, 0.0]
point = [0.0, 0.0, -285.0]
sign = 1
min = -110.0
max = 30.0
max_speed = 6000

[axes.C]
direction = [0.0, 0.0, 1.0]
point = [0.0, 0.0, 0.0]
sign = 1
min = -36000.0
max = 36000.0
max_speed = 12000
)";

/// `text` with the first `from` replaced; fails the test when it is not there.
inline std::string edited(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) {
    ADD_FAILURE() << "the example has no \"" << from << '"';
    return text;
  }
  return text.replace(at, from.size(), to);
}

inline constexpr std::size_t kMaxBytesForTest = 1u << 20;

class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string pattern = (std::filesystem::temp_directory_path() / "toothpath-XXXXXX").string();
    path_ = mkdtemp(pattern.data()) ? pattern : std::string();
    EXPECT_FALSE(path_.empty());
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  [[nodiscard]] std::string path(const std::string& name) const {
    return name.empty() ? path_ : (std::filesystem::path(path_) / name).string();
  }

 private:
  std::string path_;
};

}  // namespace toothpath::test
