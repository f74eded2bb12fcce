// How far work has come: parts of parts, on other threads, and never beyond the whole.
#include "geometry/base/work_share.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <thread>

namespace toothpath {
namespace {

TEST(WorkShare, CountsItsPieces) {
  WorkShare whole(4);
  EXPECT_EQ(whole.done(), 0);
  whole.add();
  EXPECT_EQ(whole.done(), 0.25);
  whole.add(2);
  EXPECT_EQ(whole.done(), 0.75);
  whole.add(2);
  EXPECT_EQ(whole.done(), 1) << "more pieces than were announced";
  EXPECT_EQ(WorkShare(0).done(), 0);
}

TEST(WorkShare, PartsOfTheSameThreadCountWhileTheyRunAndWhenTheyEnd) {
  WorkShare whole(4);
  {
    WorkShare part(10, 2);
    part.add(5);
    EXPECT_EQ(whole.done(), 0.25);
    {
      WorkShare inner(2);
      inner.add();
      EXPECT_EQ(part.done(), 0.55);
    }
    EXPECT_EQ(part.done(), 0.6);
  }
  EXPECT_EQ(whole.done(), 0.5) << "a part that ends is done, whatever it counted";
  WorkShare next(1);
  EXPECT_EQ(whole.done(), 0.5);
}

TEST(WorkShare, AnotherThreadIsPartOnlyOfWhatItNames) {
  WorkShare whole(2);
  std::thread([] {
    WorkShare other(1);
    other.add();
  }).join();
  EXPECT_EQ(whole.done(), 0);
  std::thread([&] {
    WorkShare part(whole);
    WorkShare inner(2);  // a part of `part`
    inner.add();
    EXPECT_EQ(whole.done(), 0.25);
  }).join();
  EXPECT_EQ(whole.done(), 0.5);
}

TEST(WorkShare, PartsOfManyThreadsAddUp) {
  WorkShare whole(64);
  std::vector<std::thread> threads;
  for (int n = 0; n < 4; ++n)
    threads.emplace_back([&] {
      for (int k = 0; k < 8; ++k) {
        WorkShare part(whole, 100, 2);
        for (int i = 0; i < 100; ++i) {
          part.add();
          EXPECT_LE(whole.done(), 1);
        }
      }
    });
  double before = 0;
  for (int k = 0; k < 200; ++k) {
    const double now = whole.done();
    EXPECT_GE(now, before - 1e-12) << "it never goes back";
    before = now;
  }
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(whole.done(), 1);
}

}  // namespace
}  // namespace toothpath
