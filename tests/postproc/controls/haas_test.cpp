// Haas: what differs from Fanuc, written, read back, and refused.
#include <gtest/gtest.h>

#include "tests/postproc/readback/nc_case.h"
#include "tests/support/files.h"

namespace toothpath {
namespace {

using namespace test;

const machines::Machine& haas() {
  static const machines::Machine m = with_dialect(trunnion(), "haas");
  return m;
}

std::string text_with(machines::Coolant coolant, const toothpath::joints::Setup& setup) {
  const auto program = axis_program({sample_path(0.3, 0.2, 4)}, haas(), setup, 3, true);
  EXPECT_TRUE(program);
  text::NcHeader header;
  header.job_name = "haas";
  header.coolant = coolant;
  const auto text = text::write_nc(*program, *controls::dialect_of(haas()), header);
  EXPECT_TRUE(text) << text.error().message;
  return text ? text->text : std::string();
}

std::string reading(const std::string& text, const toothpath::joints::Setup& setup) {
  const auto control = controls::control_of(haas(), setup, tools());
  const auto back = readback::read_back(text, "p", *control, haas(), setup, {.teeth = 3});
  if (!back) return back.error().text();
  return back->copies.copies ? std::string() : "the teeth are no copies: " + back->copies.difference;
}

TEST(Haas, WritesEveryToothAndReadsItBack) {
  toothpath::joints::Setup setup = standing();
  setup.work_offset = "G154 P99";
  const std::string text = text_with(machines::Coolant::through_spindle, setup);
  EXPECT_EQ(text.find("%\nO01001 (HAAS)\n"), 0u) << text.substr(0, 40);
  for (const char* line : {"\nG154 P99\n", "\nM88\n", "\nM89\n", "\n(TOOTH 2)\n", "\nG93\n", "\nM30\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line;
  for (const char* word : {"M98", "M99", "G54", "M8\n", "M7\n", "G43.4"})
    EXPECT_EQ(text.find(word), std::string::npos) << word;
  EXPECT_EQ(reading(text, setup), "");
}

TEST(Haas, OtherWordsAreRefusedWhereTheyStand) {
  const std::string good = text_with(machines::Coolant::flood, standing());
  EXPECT_EQ(reading(good, standing()), "");
  const auto planted = [&](const std::string& from, const std::string& to) {
    return reading(replaced(good, from, to), standing());
  };
  EXPECT_NE(planted("\nM8\n", "\nM7\n").find("M7 is not in the subset"), std::string::npos)
      << planted("\nM8\n", "\nM7\n");
  EXPECT_NE(planted("\nG54\n", "\nG154 P100\n").find("G154 needs P1 to P99"), std::string::npos);
  EXPECT_NE(planted("\nG54\n", "\nG154 P3\n").find("work offset G154 P3 is not defined"), std::string::npos);
  EXPECT_NE(planted("\nG54\n", "\nG54.1 P3\n").find("G54.1 is not in the subset"), std::string::npos);
  EXPECT_NE(planted("\nG93\n", "\nG43.4 H1\n").find("G43.4 is not in the dialect"), std::string::npos);
}

// One tooth behind the main program, called by its N word for every one.
TEST(Haas, CallsOneToothForAll) {
  const auto loop = axis_program({sample_path(0.3, 0.2, 4), sample_path(0.3, 0, 4, 1)}, haas(), standing(), 3, false);
  ASSERT_TRUE(loop && loop->loop);
  text::NcHeader header;
  header.job_name = "haas";
  const auto text = text::write_nc(*loop, *controls::dialect_of(haas()), header);
  ASSERT_TRUE(text) << text.error().message;
  for (const char* line :
       {"\nN1002 G52 C-120.\nM97 P100\n", "\nN2003 G52 C-240.\nM97 P102\n", "\nM30\nN100 (OPERATION 0)\n", "\nM99\n"})
    EXPECT_NE(text->text.find(line), std::string::npos) << line;
  EXPECT_EQ(reading(text->text, standing()), "");
  EXPECT_NE(reading(replaced(text->text, "M97 P100\n(AT TOOTH 1", "M97 P101\n(AT TOOTH 1"), standing())
                .find("M97 needs the P of an N word"),
            std::string::npos);
}

TEST(Haas, RefusesWhatItsWordsDoNotCover) {
  machines::Machine m = haas();
  m.tcp = machines::TcpMode::angles;
  EXPECT_EQ(controls::dialect_of(m).error().message,
            "dialect \"haas\" has no TCP: tcp = \"none\" (joint output) is supported");
  m.tcp = machines::TcpMode::none;
  m.chain.table[0].rollover = true;
  EXPECT_EQ(controls::dialect_of(m).error().message,
            "axes.C.rollover: dialect \"haas\" has no words for an axis that rolls over");
  const auto mist = text::coolant_words(*controls::dialect_of(haas()), machines::Coolant::mist);
  ASSERT_FALSE(mist);
  EXPECT_EQ(mist.error().message,
            "mode = \"mist\": dialect \"haas\" has words for flood, through_spindle alone; post.coolant_mist = "
            "[\"M..\", \"M..\"] in the machine file gives those of the builder, on and off");
  for (const char* name : {"G54", "G59", "G154 P1", "G154 P99"})
    EXPECT_FALSE(controls::other_work_offsets(haas(), name)) << name;
  for (const char* name : {"G154 P0", "G154 P100", "G54.1 P1", "G59.1"})
    EXPECT_EQ(controls::other_work_offsets(haas(), name), "G54 to G59 and G154 P1 to P99") << name;
}

}  // namespace
}  // namespace toothpath
