// Files and texts of the tests: reading, writing, a directory that goes away, one part replaced, damage.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <string_view>

namespace toothpath::test {

/// The bytes of a file; empty where there is none.
inline std::string file_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return std::move(out).str();
}

inline void write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A directory of its own for the running test, removed at the end.
class TestDir {
 public:
  TestDir() {
    std::string pattern = (std::filesystem::temp_directory_path() / "toothpath_test_XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) ADD_FAILURE() << "no directory for the test";
    path_ = pattern;
  }
  ~TestDir() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TestDir(const TestDir&) = delete;
  TestDir& operator=(const TestDir&) = delete;
  [[nodiscard]] std::string path() const { return path_.string(); }
  [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

inline std::string replaced_all(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// `text` with the first `from` replaced; a test that replaces what is not there fails.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

inline std::size_t times_in(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// `text` damaged at some places: bytes changed, taken out, repeated elsewhere, everything behind them cut off.
/// `letters` are what the text is made of: a letter in place of another often leaves words that can be read.
template <typename Generator>
std::string damaged(std::string text, Generator& random, int places, std::string_view letters) {
  for (int k = 0; k < places && !text.empty(); ++k) {
    const std::size_t at = random() % text.size();
    switch (random() % 8) {
      case 0: text[at] = static_cast<char>(random() & 255); break;
      case 1: text[at] = static_cast<char>(text[at] ^ (1 << (random() % 8))); break;
      case 2:
      case 3: text.erase(at, 1 + random() % 20); break;
      case 4: text.insert(at, text.substr(random() % text.size(), random() % 40)); break;
      case 5: text.resize(at); break;
      default: text[at] = letters[random() % letters.size()]; break;
    }
  }
  return text;
}

}  // namespace toothpath::test
