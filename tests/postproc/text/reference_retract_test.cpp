// Z goes to its top by G28 where the machine file says so: written, read back, and refused where a word is missing.
#include <gtest/gtest.h>

#include "tests/postproc/readback/nc_case.h"
#include "tests/support/files.h"

namespace toothpath {
namespace {

using namespace test;

constexpr double kReferenceZ = 580;  // below the end of the travel, 600 with a margin of 0.1

machines::Machine retracting(const std::string& dialect, machines::TcpMode tcp = machines::TcpMode::none) {
  machines::Machine m = with_dialect(trunnion(), dialect);
  m.tcp = tcp;
  m.post.retracts_to_reference = true;
  m.post.reference_positions[0] = {0, 0, kReferenceZ, 0, 0};
  return m;
}

std::string retract_text(const machines::Machine& m) {
  const auto text = nc_text({sample_path(0.3, 0.1, 4), sample_path(0.2, 0.1, 4, 1)}, m, standing(), 2);
  EXPECT_TRUE(text) << text.error().message;
  return text ? text->text : std::string();
}

/// What the reader says against a text; the heights of Z in machine coordinates go to `tops`.
std::string what_reader_says(const std::string& text, const machines::Machine& m, std::vector<double>* tops = nullptr) {
  const auto control = controls::control_of(m, standing(), tools());
  const auto read = readback::execute_nc(text, "p", *control, [&](const readback::ExecutedMove& e) {
    if (e.machine && e.rapid && tops != nullptr) tops->push_back(e.joints[2]);
  });
  if (!read) return read.error().text();
  const auto back = readback::read_back(text, "p", *control, m, standing(), {.teeth = 2});
  if (!back) return back.error().text();
  return back->copies.copies ? std::string() : "the teeth are no copies: " + back->copies.difference;
}

std::size_t times(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

class RetractByReference : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Controls, RetractByReference, ::testing::Values("fanuc", "mitsubishi_m80", "haas"));

TEST_P(RetractByReference, IsWrittenAndReadBack) {
  const machines::Machine m = retracting(GetParam());
  EXPECT_TRUE(controls::judge(m).empty());
  EXPECT_EQ(m.top_mm(), kReferenceZ);
  const std::string text = retract_text(m);
  EXPECT_EQ(times(text, "\nG91 G28 Z0.\nG90\n"), 4U) << text;  // ahead of two operations and behind them
  EXPECT_EQ(text.find("G53"), std::string::npos);
  EXPECT_EQ(text.find("G49"), std::string::npos);
  std::vector<double> tops;
  EXPECT_EQ(what_reader_says(text, m, &tops), "");
  EXPECT_EQ(std::count(tops.begin(), tops.end(), kReferenceZ), 6);  // G43 says two lengths there, and Z stays
}

TEST_P(RetractByReference, WordsThatAreMissingAreRefused) {
  const machines::Machine m = retracting(GetParam());
  const std::string text = retract_text(m);
  const auto said = [&](const std::string& from, const std::string& to) {
    return what_reader_says(replaced(text, from, to), m);
  };
  // The safe start says G90, too.
  const std::string steps = replaced_all(replaced_all(text, "G28 Z0.\nG90\n", "G28 Z0.\n"), " G90 ", " ");
  EXPECT_NE(what_reader_says(steps, m).find("axis words in G91"), std::string::npos) << what_reader_says(steps, m);
  EXPECT_NE(what_reader_says(replaced_all(text, "G91 G28 Z0.", "G28 Z0."), m), "");  // through Z 0 of the work offset
  EXPECT_NE(said("G0 G43 H1", "G0").find("length"), std::string::npos) << said("G0 G43 H1", "G0");
  machines::Machine unsaid = m;
  unsaid.post.reference_positions = {};
  EXPECT_NE(what_reader_says(text, unsaid).find("nothing says where it goes: post.reference_position"),
            std::string::npos);
}

TEST(ReferenceRetract, TcpEndsWithG53) {
  const machines::Machine m = retracting("fanuc", machines::TcpMode::angles);
  const std::string text = retract_text(m);
  EXPECT_EQ(times(text, "\nG91 G28 Z0.\nG90\n"), 4U) << text;
  EXPECT_EQ(times(text, "\nG0 G49 G53 Z580.\n"), 2U) << text;  // one sub-program an operation
  EXPECT_EQ(what_reader_says(text, m), "");
}

TEST(ReferenceRetract, IsJudgedInTheMachineFile) {
  const auto complaint = [](machines::Machine m) {
    const auto errors = controls::judge(m);
    return errors.empty() ? std::string() : errors.front().message;
  };
  EXPECT_EQ(
      complaint(retracting("siemens")),
      "post.retract = \"reference\" belongs to dialect \"fanuc\", \"mitsubishi_m80\", \"haas\", this is \"siemens\"");
  machines::Machine m = retracting("fanuc");
  m.post.reference_positions[0].clear();
  EXPECT_EQ(complaint(m),
            "post.retract = \"reference\": nothing says how high Z goes: post.reference_position = [X, Y, Z, "
            "rotaries] does");
}

}  // namespace
}  // namespace toothpath
