// The program cut down is read, and what it cuts are the first teeth of the whole one.
#include "tests/controller/short_program.h"

#include <gtest/gtest.h>

#include <tuple>

#include "tests/postproc/joints/trunnion_post.h"

namespace toothpath::test {
namespace {

using readback::ExecutedMove;

constexpr int kTeeth = 5;

/// Feeds of an operation, all teeth in their order.
std::vector<std::array<double, 5>> feeds(const std::string& text, const readback::NcControl& control, int operation) {
  std::vector<std::array<double, 5>> out;
  const auto s = readback::execute_nc(text, "p", control, [&](const ExecutedMove& e) {
    if (e.operation == operation && !e.rapid) out.push_back(e.joints);
  });
  EXPECT_TRUE(s) << s.error().text();
  return out;
}

/// With TCP, teeth written out, teeth of the two operations.
class ShortProgram : public testing::TestWithParam<std::tuple<machines::TcpMode, bool, std::array<int, 2>>> {};
INSTANTIATE_TEST_SUITE_P(
    Forms, ShortProgram,
    testing::Combine(testing::Values(machines::TcpMode::none, machines::TcpMode::angles), testing::Bool(),
                     testing::Values(std::array{1, 1}, std::array{0, 2}, std::array{2, 0}, std::array{3, 2})));

TEST_P(ShortProgram, CutsTheFirstTeeth) {
  const auto& [tcp, written_out, teeth] = GetParam();
  const machines::Machine m = trunnion_with("linuxcnc", tcp);
  std::vector<path::ClPath> paths = {sample_path(0.3, 0.4, 6), sample_path(0.3, 0.4, 4, 1)};
  const auto text = nc_text(paths, m, standing(), kTeeth, written_out);
  ASSERT_TRUE(text) << text.error().message;
  const auto part = short_program(text->text, fmt::format("{},{}", teeth[0], teeth[1]), "written");
  ASSERT_TRUE(part) << part.error().message;
  const auto control = controls::control_of(m, standing(), tools());
  for (const int operation : {0, 1}) {
    const auto all = feeds(text->text, *control, operation), some = feeds(*part, *control, operation);
    ASSERT_EQ(some.size() * kTeeth, all.size() * static_cast<std::size_t>(teeth[static_cast<std::size_t>(operation)]));
    EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin()));
  }
}

TEST(ShortProgramText, RefusesOtherOperations) {
  const std::string text = "(OP 0 roughing)\nM5\n(OP 1 finishing)\nM5\n";
  EXPECT_FALSE(short_program(text, "1", "written"));
  EXPECT_FALSE(short_program(text, "1,1,1", "written"));
  EXPECT_TRUE(short_program(text, "1,1", "written"));
}

TEST(ShortProgramText, PutsOtherCornersInThePlaceOfG61) {
  const auto text = short_program("G61\n(OP 0 finishing)\nG1 X1\nM5\n", "1", "G64 P0.0003 Q0");
  ASSERT_TRUE(text);
  EXPECT_EQ(*text, "G64 P0.0003 Q0\n(OP 0 finishing)\nG1 X1\nM5\n");
}

}  // namespace
}  // namespace toothpath::test
