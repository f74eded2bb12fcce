// The comparison itself: it accepts what follows the path and finds what does not.
#include "tests/controller/joint_record.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

namespace toothpath::test {
namespace {

/// A zigzag that goes over the same places many times, with small steps.
std::vector<PathCorner> zigzag() {
  std::vector<PathCorner> path;
  for (int pass = 0; pass < 6; ++pass)
    for (int i = 0; i <= 30; ++i) {
      const double x = pass % 2 ? 30 - i : i;
      path.push_back({{x, 0.2 * pass, std::sin(0.2 * x), 0.5 * x, 3.0 * pass}, static_cast<int>(path.size()) + 10});
    }
  return path;
}

/// The path walked in steps of 0.05 mm, corners met exactly when `stop`.
std::vector<JointVector> walk(const std::vector<PathCorner>& path, bool stop, double step = 0.05) {
  std::vector<JointVector> record;
  double carry = 0;
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    const double length = joint_distance(path[k].joints, path[k + 1].joints);
    double at = stop ? 0 : carry;
    for (; at < length; at += step) {
      JointVector s;
      for (std::size_t i = 0; i < 5; ++i)
        s[i] = path[k].joints[i] + at / length * (path[k + 1].joints[i] - path[k].joints[i]);
      record.push_back(s);
    }
    carry = at - length;
  }
  record.push_back(path.back().joints);
  return record;
}

TEST(JointRecord, ExactStopsLeaveNothing) {
  const auto path = zigzag();
  const auto c = compare_curves(path, walk(path, true), 0.5);
  EXPECT_TRUE(c.followed);
  EXPECT_LT(c.worst, 1e-12);
}

// Corners that are passed between two samples are cut by no more than half a step.
TEST(JointRecord, SamplingCutsCornersByLessThanAStep) {
  const auto path = zigzag();
  const auto c = compare_curves(path, walk(path, false), 0.5);
  EXPECT_TRUE(c.followed);
  EXPECT_GT(c.worst, 1e-4);
  EXPECT_LT(c.worst, 0.05);
}

// A corner that is cut short is not reached while no sample is off the path by as much; a detour is the other way
// round.
TEST(JointRecord, TheTwoDirectionsAreToldApart) {
  std::vector<PathCorner> path{{{0, 0, 0, 0, 0}, 1}, {{10, 0, 0, 0, 0}, 2}, {{10, 10, 0, 0, 0}, 3}};
  const std::vector<JointVector> cut{{0, 0, 0, 0, 0}, {9.99, 0, 0, 0, 0}, {10, 0.01, 0, 0, 0}, {10, 10, 0, 0, 0}};
  EXPECT_NEAR(compare_curves(path, cut, 1.0).worst, 0.01 / std::sqrt(2), 1e-12);
  EXPECT_NEAR(compare_curves(path, cut, 1.0, Counted::corners).worst, 0.01 / std::sqrt(2), 1e-12);
  EXPECT_NEAR(compare_curves(path, cut, 1.0, Counted::samples).worst, 0, 1e-12);
  const std::vector<JointVector> detour{{0, 0, 0, 0, 0}, {5, -0.02, 0, 0, 0}, {10, 0, 0, 0, 0}, {10, 10, 0, 0, 0}};
  EXPECT_NEAR(compare_curves(path, detour, 1.0).worst, 0.02, 1e-12);
  EXPECT_NEAR(compare_curves(path, detour, 1.0, Counted::corners).worst, 0, 1e-12);
  EXPECT_NEAR(compare_curves(path, detour, 1.0, Counted::samples).worst, 0.02, 1e-12);
  EXPECT_FALSE(compare_curves(path, detour, 0.01, Counted::corners).followed)
      << "beyond the limit nothing is followed, whatever is counted";
}

TEST(JointRecord, WaitingAtEitherEndIsAllowed) {
  const auto path = zigzag();
  auto record = walk(path, true);
  record.insert(record.begin(), 500, JointVector{-3, 4, 0, 0, 0});
  record.insert(record.end(), 500, path.back().joints);
  record.insert(record.end(), 50, JointVector{100, 0, 0, 0, 0});
  const auto c = compare_curves(path, record, 0.5);
  EXPECT_TRUE(c.followed);
  EXPECT_LT(c.worst, 1e-12);
}

TEST(JointRecord, FindsEveryPlantedFault) {
  const auto path = zigzag();
  std::mt19937_64 rng(5);
  for (int trial = 0; trial < 60; ++trial) {
    auto executed = path;
    const std::size_t at = 5 + rng() % (path.size() - 10);
    const std::size_t axis = rng() % 5;
    const double amount = 3e-3;
    switch (trial % 4) {
      case 0: executed[at].joints[axis] += amount; break;  // one word off
      case 1:
        for (std::size_t k = at; k < path.size(); ++k) executed[k].joints[axis] += amount;
        break;  // an offset from there on
      case 2:
        executed.erase(executed.begin() + static_cast<std::ptrdiff_t>(at),
                       executed.begin() + static_cast<std::ptrdiff_t>(at) + 4);
        break;
      default: executed.insert(executed.begin() + static_cast<std::ptrdiff_t>(at), PathCorner{{15, 40, 0, 0, 0}, 0});
    }
    const auto c = compare_curves(path, walk(executed, true), 0.5);
    // A word of X or of the tilt moves its corner partly along the path, which runs in both: at least 0.6 of it lies
    // across.
    const double least = 0.6 * amount;
    EXPECT_TRUE(!c.followed || c.worst > (trial % 4 == 2 ? 1e-3 : least)) << trial << " " << c.worst;
    if (trial % 4 == 3) { EXPECT_FALSE(c.followed) << trial; }
    if (c.followed && trial % 4 == 0) { EXPECT_NEAR(c.line, path[at].line, 1); }
  }
}

// A record that stops half way, and one that leaves a pass out although the next begins where this one began.
TEST(JointRecord, EndAndOrderCount) {
  const auto path = zigzag();
  auto half = path;
  half.resize(path.size() / 2);
  const auto c = compare_curves(path, walk(half, true), 0.1);
  EXPECT_FALSE(c.followed);
  EXPECT_EQ(c.stuck_line, half.back().line);

  std::vector<PathCorner> thrice, once;
  for (int pass = 0; pass < 3; ++pass)
    for (const double x : {0.0, 10.0, 0.0}) {
      thrice.push_back({{x, 0, 0, 0, 0}, static_cast<int>(thrice.size())});
      if (!pass) once.push_back(thrice.back());
    }
  EXPECT_TRUE(compare_curves(thrice, walk(thrice, true), 1.0).followed);
  EXPECT_FALSE(compare_curves(thrice, walk(once, true), 1.0).followed);
}

TEST(JointRecord, SamplesAreNumbers) {
  const auto message = [](const char* text) {
    std::istringstream in(text);
    const auto read = read_samples(in);
    return read ? std::string("ok") : read.error().message;
  };
  EXPECT_EQ(message("1 2 3 4 5 \n-1.5 0 0 0 360\n"), "ok");
  EXPECT_EQ(message(""), "no samples were recorded");
  EXPECT_EQ(message("1 2 3 4 5\noverrun\n"), "samples were lost before line 2: the recorder was too slow");
  EXPECT_EQ(message("1 2 3 4 5\n1 2 x 4 5\n"), "line 2 of the samples is not five numbers: \"1 2 x 4 5\"");
  EXPECT_EQ(message("1 2 3 4\n"), "line 1 of the samples is not five numbers: \"1 2 3 4\"");
}

}  // namespace
}  // namespace toothpath::test
