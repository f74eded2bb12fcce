// What nobody measured, told in few lines.
#include "machines/assumed.h"

#include <gtest/gtest.h>

namespace toothpath {
namespace {

using Lines = std::vector<std::string>;

const Lines kKeys = {"m.toml: dialect",
                     "m.toml: spindle.max_speed",
                     "m.toml: axes.X.min",
                     "m.toml: axes.X.max",
                     "m.toml: axes.Y.min",
                     "m.toml: axes.Y.max",
                     "m.toml: tcp",
                     "m.toml: axes.A.min",
                     "m.toml: post.corner_tolerance = 0.02 mm, what G64 leaves of corners",
                     "m.toml: axes.A.sign"};

TEST(Assumed, KeysOfATableShareALineAndTablesLikeIt) {
  EXPECT_EQ(
      machines::grouped_keys(kKeys),
      (Lines{"m.toml: dialect, tcp", "m.toml: spindle: max_speed", "m.toml: axes.X, axes.Y: min, max",
             "m.toml: axes.A: min, sign", "m.toml: post.corner_tolerance = 0.02 mm, what G64 leaves of corners"}));
  EXPECT_EQ(machines::grouped_keys(Lines{"axes.X.min", "tcp", "axes.Y.min"}), (Lines{"axes.X, axes.Y: min", "tcp"}));
  EXPECT_TRUE(machines::grouped_keys(Lines{}).empty());
  // What is no key stays as it is.
  const Lines odd = {"", "m.toml: ", ": ", "a b", ".", "m.toml: x.", ""};
  EXPECT_EQ(machines::grouped_keys(odd), odd);
  EXPECT_FALSE(machines::counted_keys(odd).empty());
}

TEST(Assumed, WhatDoesNotFitIsCounted) {
  EXPECT_EQ(machines::grouped_keys(kKeys, 3),
            (Lines{"m.toml: dialect, tcp", "m.toml: spindle: max_speed", "and 7 more"}));
  EXPECT_EQ(machines::grouped_keys(kKeys, 5).size(), 5u);
  EXPECT_EQ(machines::grouped_keys(kKeys, 4).back(), "and 3 more");
}

TEST(Assumed, LongLinesAreBrokenBehindACommaAndLoseNothing) {
  Lines keys;
  for (const char* axis : {"X", "Y", "Z"})
    for (const char* key : {"min", "max", "max_speed", "max_acceleration", "max_jerk"})
      keys.push_back(std::string("machine.toml: axes.") + axis + "." + key);
  const Lines lines = machines::grouped_keys(keys, 10, 40);
  EXPECT_EQ(lines,
            (Lines{"machine.toml: axes.X, axes.Y,", "axes.Z: min, max, max_speed,", "max_acceleration, max_jerk"}));
  for (const std::string& line : machines::grouped_keys(keys)) EXPECT_LE(line.size(), 68U);
  EXPECT_EQ(machines::grouped_keys(keys, 2, 40), (Lines{"and 15 more"}));
}

TEST(Assumed, OneLineCountsThem) {
  EXPECT_EQ(machines::counted_keys(kKeys), "10 values of m.toml, not measured: dialect, spindle, axes (6), tcp, post");
  EXPECT_EQ(machines::counted_keys(Lines{"a.toml: axes.A.point"}), "1 value of a.toml, not measured: axes");
  EXPECT_EQ(machines::counted_keys(Lines{"tcp", "post.pole"}), "2 values, not measured: tcp, post");
  EXPECT_EQ(machines::counted_keys(Lines{}), "");
}

}  // namespace
}  // namespace toothpath
