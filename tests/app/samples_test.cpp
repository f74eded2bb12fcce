// Samples of a study: numbers by counter, shards, files that are resumed and merged, and all that can be wrong with
// them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "app/studies/samples/counter.h"
#include "app/studies/samples/sample_file.h"
#include "tests/support/files.h"

namespace toothpath::samples {
namespace {

using test::file_text;
using test::TestDir;
using test::write_file;

Head head_of(int samples, const std::string& key = "k") {
  return *read_head(R"({"study":"s","version":1,"key":")" + key + R"(","samples":)" + std::to_string(samples) + "}");
}
std::string line(int sample, int value = 0) {
  return R"({"sample":)" + std::to_string(sample) + R"(,"value":)" + std::to_string(value + 10 * sample) + "}";
}
/// Writes all samples of a shard but those left out.
void fill(const std::string& directory, const Shard& shard, const Head& head, int left_out = -1) {
  auto file = SampleFile::open(directory, shard, head);
  ASSERT_TRUE(file) << file.error().text();
  for (int k = 0; k < head.samples; ++k)
    if (shard.has(k) && k != left_out && !file->has(k)) { ASSERT_TRUE(file->add(k, line(k))); }
}
std::string refusal(const std::string& directory) {
  const auto merged = merge(directory);
  return merged ? "" : merged.error().text();
}

TEST(Numbers, OfSeedSampleAndDrawAlone) {
  const Numbers one(1, 5), again(1, 5), other_seed(2, 5), other_sample(1, 6);
  EXPECT_EQ(one.bits(7), again.bits(7));
  EXPECT_NE(one.bits(7), one.bits(8));
  EXPECT_NE(one.bits(7), other_seed.bits(7));
  EXPECT_NE(one.bits(7), other_sample.bits(7));
}

TEST(Numbers, AreSpreadAsTheySay) {
  double sum = 0, squares = 0, shares = 0;
  int beyond = 0;
  constexpr int kMany = 40000;
  for (int k = 0; k < kMany; ++k) {
    const Numbers numbers(3, std::uint64_t(k));
    const double n = numbers.normal(4), s = numbers.share(1);
    sum += n, squares += n * n, shares += s;
    if (std::abs(n) > 2) ++beyond;
    ASSERT_GE(s, 0);
    ASSERT_LT(s, 1);
    ASSERT_LT(numbers.whole(2, 7), 7);
  }
  EXPECT_NEAR(sum / kMany, 0, 5 / std::sqrt(kMany));
  EXPECT_NEAR(squares / kMany, 1, 5 * std::sqrt(2.0 / kMany));
  EXPECT_NEAR(shares / kMany, 0.5, 5 / std::sqrt(12.0 * kMany));
  EXPECT_NEAR(double(beyond) / kMany, 0.0455, 0.006);
}

/// Sets variables of Slurm while it lives.
class Array {
 public:
  explicit Array(std::vector<std::pair<const char*, const char*>> values) : values_(std::move(values)) {
    for (const auto& [name, value] : values_) ::setenv(name, value, 1);
  }
  ~Array() {
    for (const auto& [name, value] : values_) ::unsetenv(name);
  }
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;

 private:
  std::vector<std::pair<const char*, const char*>> values_;
};

TEST(Shards, OfTheOptionAndOfSlurm) {
  EXPECT_EQ(shard_of("")->text(), "1/1");
  EXPECT_EQ(shard_of("3/8")->text(), "3/8");
  EXPECT_EQ(shard_of("3/8")->file_name(), "samples.3of8.jsonl");
  for (const char* bad : {"0/8", "9/8", "3", "3/", "/8", "a/8", "3/8/1", "-1/2", "1/10001", " 1/2"}) {
    const auto shard = shard_of(bad);
    ASSERT_FALSE(shard) << bad;
    EXPECT_EQ(shard.error().kind, DiagnosticKind::usage);
    EXPECT_NE(shard.error().message.find(std::string("--shard ") + bad), std::string::npos);
  }
  const Array array({{"SLURM_ARRAY_TASK_ID", "7"},
                     {"SLURM_ARRAY_TASK_MIN", "3"},
                     {"SLURM_ARRAY_TASK_COUNT", "4"},
                     {"SLURM_ARRAY_TASK_STEP", "2"}});
  EXPECT_EQ(shard_of("")->text(), "3/4");
  EXPECT_EQ(shard_of("1/2")->text(), "1/2");  // what is said counts
}

TEST(Shards, AnArrayWithGapsIsRefused) {
  const Array array({{"SLURM_ARRAY_TASK_ID", "7"}, {"SLURM_ARRAY_TASK_MIN", "1"}, {"SLURM_ARRAY_TASK_COUNT", "3"}});
  const auto shard = shard_of("");
  ASSERT_FALSE(shard);
  EXPECT_NE(shard.error().message.find("task 7 of a Slurm array of 3 tasks from 1"), std::string::npos);
}

TEST(Shards, EverySampleIsOfOne) {
  for (const int count : {1, 2, 3, 8})
    for (int k = 0; k < 50; ++k) {
      int of = 0;
      for (int i = 1; i <= count; ++i) of += Shard{i, count}.has(k) ? 1 : 0;
      EXPECT_EQ(of, 1);
    }
}

TEST(Samples, TheSameBytesHoweverCut) {
  std::string first;
  for (const int count : {1, 2, 8}) {
    const TestDir dir;
    for (int i = count; i >= 1; --i) fill(dir.path(), {i, count}, head_of(20));
    const auto merged = merge(dir.path());
    ASSERT_TRUE(merged) << merged.error().text();
    EXPECT_EQ(merged->lines.size(), 20u);
    if (first.empty()) first = merged->text;
    EXPECT_EQ(merged->text, first);
  }
}

TEST(Samples, ALineThatWasCutOffIsDoneAgain) {
  const TestDir dir;
  fill(dir.path(), {1, 1}, head_of(6));
  const std::string path = dir / "samples.1of1.jsonl", whole = file_text(path);
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    write_file(path, whole.substr(0, cut));
    const bool head_stands = cut > head_of(6).line.size();
    EXPECT_NE(refusal(dir.path()), "");  // a sample, or the head, is missing
    {
      auto file = SampleFile::open(dir.path(), {1, 1}, head_of(6));
      ASSERT_TRUE(file) << file.error().text();
      EXPECT_EQ(file->size(),
                head_stands ? std::size_t(std::count(whole.begin(), whole.begin() + long(cut), '\n')) - 1 : 0);
    }
    fill(dir.path(), {1, 1}, head_of(6));
    EXPECT_EQ(file_text(path), whole) << cut;
  }
}

TEST(Samples, AnotherStudyIsRefused) {
  const TestDir dir;
  fill(dir.path(), {1, 2}, head_of(6));
  const auto file = SampleFile::open(dir.path(), {1, 2}, head_of(6, "other"));
  ASSERT_FALSE(file);
  EXPECT_NE(
      file.error().text().find("samples.1of2.jsonl:1:1: error: this file is of another study (they differ in: key)"),
      std::string::npos)
      << file.error().text();
  fill(dir.path(), {2, 2}, head_of(6, "other"));
  EXPECT_NE(refusal(dir.path())
                .find("samples.2of2.jsonl:1:1: error: this file is of another study (they differ in: key); than"),
            std::string::npos)
      << refusal(dir.path());
}

TEST(Samples, AMissingSampleIsNamed) {
  const TestDir dir;
  fill(dir.path(), {1, 2}, head_of(8), 4);
  fill(dir.path(), {2, 2}, head_of(8));
  EXPECT_NE(refusal(dir.path()).find("1 of 8 samples are missing: 4; run the shards"), std::string::npos)
      << refusal(dir.path());
}

TEST(Samples, TwoResultsOfOneSampleAreRefused) {
  const TestDir dir;
  fill(dir.path(), {1, 1}, head_of(4));
  fill(dir.path(), {2, 2}, head_of(4));  // the same again is none
  EXPECT_EQ(refusal(dir.path()), "");
  write_file(dir / "samples.2of2.jsonl", head_of(4).line + "\n" + line(1) + "\n" + line(3, 1) + "\n");
  EXPECT_NE(refusal(dir.path()).find("samples.2of2.jsonl:3:1: error: sample 3 has another result than in "),
            std::string::npos)
      << refusal(dir.path());
  EXPECT_NE(refusal(dir.path()).find("samples.1of1.jsonl:5"), std::string::npos);
}

TEST(Samples, LinesThatAreNone) {
  const TestDir dir;
  EXPECT_NE(refusal(dir.path()).find("no file samples.IofN.jsonl"), std::string::npos);
  EXPECT_NE(refusal(dir / "none").find("cannot be read"), std::string::npos);
  const auto with = [&](const std::string& text) {
    write_file(dir / "samples.1of1.jsonl", text);
    return refusal(dir.path());
  };
  EXPECT_NE(with("").find("no head of a study"), std::string::npos);
  EXPECT_NE(with("x\n").find(":1:1: error: not the head of a study"), std::string::npos);
  EXPECT_NE(with(head_of(2).line + "\n{}\n").find(":2:1: error: no sample"), std::string::npos);
  EXPECT_NE(with(head_of(2).line + "\n" + line(2) + "\n").find(":2:1: error: sample 2 is beyond the study's 2 samples"),
            std::string::npos);
  write_file(dir / "samples.1of2.jsonl", head_of(2).line + "\n" + line(1) + "\n");
  const auto file = SampleFile::open(dir.path(), {1, 2}, head_of(2));
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().text().find(":2:1: error: sample 1 is not of shard 1/2"), std::string::npos);
}

// A shard is added to where it stands: never to a file outside the directory, nor to somebody else's.
TEST(Samples, WhatIsNotOfThisStudyKeepsItsBytes) {
  namespace fs = std::filesystem;
  const std::string ours = head_of(4).line + "\n" + line(0) + "\n{\"sam";
  for (const std::string& foreign :
       {std::string("my notes, without an end"), std::string("my notes\nand a last line"), std::string("\n"),
        head_of(4, "other").line + "\n{\"sam", head_of(4, "other").line, head_of(4).line + "\n" + line(7) + "\n{\"sam",
        head_of(4).line + "\nmy notes\nlast", ours})
    for (const std::string kind : {"file", "link", "hard link"}) {
      if (kind == "file" && foreign == ours) continue;
      const TestDir dir, outside;
      const std::string path = dir / "samples.1of1.jsonl", target = outside / "victim";
      write_file(kind == "file" ? path : target, foreign);
      if (kind == "link") fs::create_symlink(target, path);
      if (kind == "hard link") fs::create_hard_link(target, path);
      const auto file = SampleFile::open(dir.path(), {1, 1}, head_of(4));
      ASSERT_FALSE(file) << kind << ": " << foreign;
      EXPECT_NE(file.error().text().find(path), std::string::npos) << file.error().text();
      EXPECT_EQ(file_text(kind == "file" ? path : target), foreign) << kind;
    }
  const TestDir dir, outside;  // a link to a file that is not there makes none
  fs::create_symlink(outside / "not yet", dir / "samples.1of1.jsonl");
  EXPECT_FALSE(SampleFile::open(dir.path(), {1, 1}, head_of(4)));
  EXPECT_FALSE(fs::exists(outside / "not yet"));
}

TEST(Samples, AHeadHasItsKeys) {
  for (const char* head :
       {R"({"study":"s","key":"k","samples":2})", R"({"study":"s","version":"1","key":"k","samples":2})",
        R"({"study":"s","version":1,"key":3,"samples":2})", R"({"study":"s","version":1,"samples":2})",
        R"({"study":"s","version":0,"key":"k","samples":2})",
        R"({"study":"s","version":1,"key":"k","samples":18446744073709551615})"})
    EXPECT_FALSE(read_head(head)) << head;
  EXPECT_EQ(read_head(R"({"study":"s","version":3,"key":"k","samples":2})")->version, 3);
}

TEST(Samples, OneProcessAShard) {
  const TestDir dir;
  const auto first = SampleFile::open(dir.path(), {1, 1}, head_of(4));
  const auto second = SampleFile::open(dir.path(), {1, 1}, head_of(4));
  ASSERT_TRUE(first);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().kind, DiagnosticKind::file_access);
}

}  // namespace
}  // namespace toothpath::samples
