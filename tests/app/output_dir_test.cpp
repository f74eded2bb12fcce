// The output directory and the hash: all files or none.
#include "app/output_dir.h"

#include <sys/stat.h>

#include "geometry/base/hash.h"
#include "program.h"

namespace toothpath::test {
namespace {

TEST(OutputDir, FilesAppearAtCommitOnly) {
  const TestDir dir;
  auto output = OutputDir::open(dir / "out", {"a.txt"});
  ASSERT_TRUE(output.has_value());
  ASSERT_TRUE(output->write("a.txt", "one").has_value());
  EXPECT_FALSE(std::filesystem::exists(dir / "out/a.txt"));
  EXPECT_EQ(*output->read_back("a.txt"), "one");
  ASSERT_TRUE(output->write("a.txt", "two").has_value());
  ASSERT_TRUE(output->commit().has_value());
  EXPECT_EQ(names_in(dir / "out"), std::vector<std::string>{"a.txt"});
  EXPECT_EQ(file_text(dir / "out/a.txt"), "two");
}

TEST(OutputDir, WithoutCommitNothingIsLeftNotEvenTheDirectories) {
  const TestDir dir;
  {
    auto output = OutputDir::open(dir / "x/y/z", {"a.txt"});
    ASSERT_TRUE(output.has_value());
    ASSERT_TRUE(output->write("a.txt", "one").has_value());
  }
  EXPECT_FALSE(std::filesystem::exists(dir / "x"));
}

TEST(OutputDir, WhenOneFileCannotGetItsNameNoneDoes) {
  const TestDir dir;
  auto output = OutputDir::open(dir / "out", {"a.txt", "b.txt"});
  ASSERT_TRUE(output.has_value());
  ASSERT_TRUE(output->write("a.txt", "one").has_value());
  ASSERT_TRUE(output->write("b.txt", "two").has_value());
  std::filesystem::create_directories(dir / "out/b.txt/occupied");
  const auto committed = output->commit();
  ASSERT_FALSE(committed.has_value());
  EXPECT_EQ(committed.error().kind, DiagnosticKind::file_access);
  EXPECT_EQ(names_in(dir / "out"), std::vector<std::string>{"b.txt"});
}

TEST(OutputDir, ASymbolicLinkIsReplacedNotFollowed) {
  const TestDir dir;
  std::filesystem::create_directories(dir / "out");
  write_file(dir / "elsewhere", "mine");
  std::filesystem::create_symlink(dir / "elsewhere", dir / "out/a.txt");
  auto output = OutputDir::open(dir / "out", {});
  ASSERT_TRUE(output.has_value());
  ASSERT_TRUE(output->write("a.txt", "ours").has_value());
  ASSERT_TRUE(output->commit().has_value());
  EXPECT_EQ(file_text(dir / "elsewhere"), "mine");
  EXPECT_FALSE(std::filesystem::is_symlink(dir / "out/a.txt"));
}

TEST(OutputDir, LeftoversOfAKilledRunAreRemoved) {
  const TestDir dir;
  std::filesystem::create_directories(dir / "out");
  write_file(dir / "out/.toothpath-999999999-program.ngc", "half");
  { const auto output = OutputDir::open(dir / "out", {}); }
  EXPECT_TRUE(names_in(dir / "out").empty());
}

// FIPS 180-4: one block, two blocks, and a million letters.
TEST(Sha256, ExamplesOfTheStandard) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_hex(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

}  // namespace
}  // namespace toothpath::test
