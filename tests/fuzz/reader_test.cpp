// Every reader on damaged seeds, fixed random numbers. TOOTHPATH_FUZZ_RUNS: inputs for each reader, for long runs
// (`ctest -L fuzz`); a coverage-guided fuzzer drives the same functions (`libfuzzer.cpp`).
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "tests/fuzz/readers.h"
#include "tests/support/files.h"

namespace toothpath::test {
namespace {

constexpr int kShortRuns = 1000;

int runs() {
  const char* asked = std::getenv("TOOTHPATH_FUZZ_RUNS");
  return asked ? std::atoi(asked) : kShortRuns;
}

class FuzzedReader : public ::testing::TestWithParam<std::size_t> {};

TEST_P(FuzzedReader, EndsWithAResultOrARefusal) {
  const test::ByteReader& reader = fuzzed_readers()[GetParam()];
  for (const std::string& seed : reader.seeds) ASSERT_EQ(reader.fault_of(seed), "");
  std::mt19937_64 random(20260000 + GetParam());
  for (int k = 0; k < runs() / reader.cost; ++k) {
    const std::string bytes =
        damaged(reader.seeds[random() % reader.seeds.size()], random, 1 + int(random() % 6), reader.letters);
    ASSERT_EQ(reader.fault_of(bytes), "") << "input " << k << ":\n" << bytes.substr(0, 2000);
  }
}

INSTANTIATE_TEST_SUITE_P(All, FuzzedReader, ::testing::Range(std::size_t(0), fuzzed_readers().size()),
                         [](const auto& index) { return fuzzed_readers()[index.param].name; });

}  // namespace
}  // namespace toothpath::test
