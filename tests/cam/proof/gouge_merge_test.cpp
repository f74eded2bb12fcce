// Results of the gouge check put together: any division of the same findings gives the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "cam/proof/gouge_merge.h"

namespace toothpath {
namespace {

/// One finding of one motion.
proof::GougeResult finding(std::mt19937& random, int line) {
  std::uniform_int_distribution<int> depth(-5, 40);  // few values: many are equal
  proof::GougeResult r = proof::no_motion_yet(0.05);
  proof::WorstPlace w;
  w.line = line;
  w.body = tool::Body::flute;
  w.depth_mm = 1e-3 * depth(random);
  r.measured_mm = w.depth_mm;
  r.bound_mm = w.depth_mm + 1e-4;
  r.bound_line = line;
  r.clearance_mm = r.clearance_measured_mm = 1e-2 * depth(random);
  r.closest = w;
  r.rapids_clear = depth(random) < 40;
  note_deepest(r, w);
  if (w.depth_mm > 2e-3) proof::add_worst(r, w);
  r.motions = 1;
  r.distance_queries = 3;
  return r;
}

void expect_same(const proof::GougeResult& a, const proof::GougeResult& b) {
  EXPECT_EQ(a.measured_mm, b.measured_mm);
  EXPECT_EQ(a.bound_mm, b.bound_mm);
  EXPECT_EQ(a.bound_line, b.bound_line);
  EXPECT_EQ(a.clearance_mm, b.clearance_mm);
  EXPECT_EQ(a.closest.line, b.closest.line);
  EXPECT_EQ(a.deepest.line, b.deepest.line);
  EXPECT_EQ(a.rapids_clear, b.rapids_clear);
  EXPECT_EQ(a.motions, b.motions);
  EXPECT_EQ(a.distance_queries, b.distance_queries);
  ASSERT_EQ(a.worst.size(), b.worst.size());
  for (std::size_t k = 0; k < a.worst.size(); ++k) EXPECT_EQ(a.worst[k].line, b.worst[k].line) << k;
}

TEST(GougeMerge, AnyDivisionGivesTheSame) {
  std::mt19937 random(42);
  for (int round = 0; round < 50; ++round) {
    std::vector<proof::GougeResult> findings;
    const int n = 1 + static_cast<int>(random() % 120);
    for (int k = 0; k < n; ++k) findings.push_back(finding(random, k + 1));
    proof::GougeResult one_by_one = proof::no_motion_yet(0.05), in_chunks = proof::no_motion_yet(0.05);
    for (const auto& f : findings) add_result(one_by_one, f);
    for (std::size_t at = 0; at < findings.size();) {
      proof::GougeResult chunk = proof::no_motion_yet(0.05);
      for (const std::size_t end = std::min(findings.size(), at + 1 + random() % 40); at < end; ++at)
        add_result(chunk, findings[at]);
      add_result(in_chunks, chunk);
    }
    expect_same(one_by_one, in_chunks);

    // By hand: the deepest twenty, of equal depth the first of the program.
    std::vector<proof::WorstPlace> listed;
    for (const auto& f : findings) listed.insert(listed.end(), f.worst.begin(), f.worst.end());
    std::stable_sort(listed.begin(), listed.end(),
                     [](const auto& a, const auto& b) { return a.depth_mm > b.depth_mm; });
    listed.resize(std::min<std::size_t>(20, listed.size()));
    ASSERT_EQ(one_by_one.worst.size(), listed.size());
    for (std::size_t k = 0; k < listed.size(); ++k) EXPECT_EQ(one_by_one.worst[k].line, listed[k].line);
  }
}

}  // namespace
}  // namespace toothpath
