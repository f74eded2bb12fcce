// The blank in the words of the graphics: BLK FORM of Heidenhain, WORKPIECE of Siemens.
#include <gtest/gtest.h>

#include "tests/postproc/joints/trunnion_post.h"

namespace toothpath {
namespace {

using namespace test;

std::string text_with(const std::string& dialect, const std::optional<joints::GraphicsBlank>& blank,
                      const std::string& none = "") {
  const machines::Machine m = trunnion_with(dialect, machines::TcpMode::none);
  const auto program = axis_program({sample_path(0.3, 0, 3)}, m, standing(), 2, dialect == "haas");
  EXPECT_TRUE(program);
  text::NcHeader header;
  header.blank = blank;
  header.no_blank = none;
  const auto text = write_nc(*program, *controls::dialect_of(m), header);
  EXPECT_TRUE(text);
  return text->text;
}

/// Of the reader: the blank with its line, or the refusal.
std::string read_from(const std::string& dialect, const std::string& text) {
  const machines::Machine m = trunnion_with(dialect, machines::TcpMode::none);
  auto control = controls::control_of(m, standing(), tools());
  std::string out;
  control->blank = [&](const joints::GraphicsBlank& b, std::int32_t line) {
    out += fmt::format("{}: {} {} {} {}", line, b.radius_mm, b.bore_mm, b.bottom_mm, b.top_mm);
  };
  const auto s = readback::execute_nc(text, "p", *control, [](const readback::ExecutedMove&) {});
  return s ? out : s.error().text();
}

std::string line_with(const std::string& text, const std::string& part) {
  const std::size_t at = text.find(part);
  return at == std::string::npos ? std::string() : text.substr(at, text.find('\n', at) - at);
}

TEST(GraphicsBlank, StandsInTheWordsOfTheControl) {
  const joints::GraphicsBlank ring{65.5, 40, -12.25, 150.125}, solid{65.5, 0, -12.25, 150.125};
  EXPECT_EQ(line_with(text_with("heidenhain", ring), "BLK"), "BLK FORM CYLINDER Z R65.5 L162.375 DIST+150.125 RI40");
  EXPECT_EQ(line_with(text_with("heidenhain", solid), "BLK"), "BLK FORM CYLINDER Z R65.5 L162.375 DIST+150.125");
  EXPECT_EQ(line_with(text_with("siemens", ring), "WORKPIECE"),
            "WORKPIECE(,\"\",,\"PIPE\",448,150.125,-12.25,-12.25,131,80)");
  EXPECT_EQ(line_with(text_with("siemens", solid), "WORKPIECE"),
            "WORKPIECE(,\"\",,\"CYLINDER\",192,150.125,-12.25,-12.25,131)");
  for (const char* other : {"fanuc", "linuxcnc", "haas"})
    EXPECT_EQ(text_with(other, ring), text_with(other, {})) << other;
}

TEST(GraphicsBlank, IsReadBack) {
  const joints::GraphicsBlank ring{65.5, 40, -12.25, 150.125}, solid{65.5, 0, -12.25, 150.125};
  for (const char* dialect : {"siemens", "heidenhain"}) {
    EXPECT_NE(read_from(dialect, text_with(dialect, ring)).find(": 65.5 40 -12.25 150.125"), std::string::npos);
    EXPECT_NE(read_from(dialect, text_with(dialect, solid)).find(": 65.5 0 -12.25 150.125"), std::string::npos);
    EXPECT_EQ(read_from(dialect, text_with(dialect, {})), "");
  }
}

TEST(GraphicsBlank, WhatIsLeftOutSaysWhy) {
  EXPECT_NE(text_with("heidenhain", {}, "no blank: why").find("; NO BLANK: WHY"), std::string::npos);
  EXPECT_NE(text_with("siemens", {}, "no blank: why").find(";NO BLANK: WHY"), std::string::npos);
  EXPECT_EQ(text_with("fanuc", {}, "no blank: why").find("NO BLANK"), std::string::npos);
}

TEST(GraphicsBlank, OtherWordsAreRefusedWhereTheyStand) {
  const joints::GraphicsBlank ring{65.5, 40, -12.25, 150.125};
  const auto edited = [&](const char* dialect, const std::string& from, const std::string& to) {
    std::string text = text_with(dialect, ring);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return read_from(dialect, text.replace(at, from.size(), to));
  };
  EXPECT_NE(edited("siemens", "PIPE\",448", "PIPE\",64").find("WORKPIECE is read with"), std::string::npos);
  EXPECT_NE(edited("siemens", "131,80)", "131)").find("error: , expected"), std::string::npos);
  EXPECT_NE(edited("siemens", "131,80)", "131,80) G0").find("with other words in a block"), std::string::npos);
  EXPECT_NE(edited("heidenhain", " L162", " M162").find("L expected"), std::string::npos);
  EXPECT_NE(edited("heidenhain", "CYLINDER Z", "CYLINDER X").find("BLK FORM CYLINDER X"), std::string::npos);
  EXPECT_NE(edited("heidenhain", "RI40", "RI40 X+1").find("words that do not belong to the block"), std::string::npos);
}

}  // namespace
}  // namespace toothpath
