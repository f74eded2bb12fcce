// What nobody measured stands in the head of the program, in every dialect, ahead of the first motion.
#include <gtest/gtest.h>

#include "postproc/numbers/comment.h"
#include "tests/postproc/readback/nc_case.h"

namespace toothpath {
namespace {

using namespace test;

class AssumedHeader : public testing::TestWithParam<const char*> {};

TEST_P(AssumedHeader, WarnsAheadOfTheFirstMotion) {
  machines::Machine m = with_dialect(trunnion(), GetParam());
  if (m.dialect == "apt") m.tcp = machines::TcpMode::vectors;
  m.assumed = true;
  m.assumed_keys = {"axes.A.point", "axes.C.sign"};
  const auto program = axis_program({sample_path(0.3, 0, 8)}, m, standing(), 3);
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_EQ(program->assumed, m.assumed_keys);
  text::NcHeader header;
  header.job_name = "sample";
  header.machine_name = m.name;
  header.assumed = m.assumed_keys;
  const auto dialect = controls::dialect_of(m);
  ASSERT_TRUE(dialect);
  const auto text = text::write_nc(*program, *dialect, header);
  ASSERT_TRUE(text) << text.error().message;
  const auto warning = text->text.find("WARNING, ASSUMED AND NOT MEASURED:");
  ASSERT_NE(warning, std::string::npos) << text->text.substr(0, 500);
  std::size_t motion = std::string::npos;
  for (const char* word : {"G0 ", "G1 ", "G00 ", "G53", "SUPA", "L Z", "L X", "GOTO/", "G28"})
    motion = std::min(motion, text->text.find(word));
  ASSERT_NE(motion, std::string::npos);
  for (const char* key : {"AXES.A: POINT", "AXES.C: SIGN"}) {
    const auto at = text->text.find(std::string("ASSUMED ") + key);
    EXPECT_GT(at, warning) << key;
    EXPECT_LT(at, motion) << key;
  }
  // Nothing assumed: no such line.
  header.assumed.clear();
  const auto clean = text::write_nc(*program, *dialect, header);
  ASSERT_TRUE(clean);
  EXPECT_EQ(clean->text.find("ASSUMED"), std::string::npos);
  // Danger 24, in every dialect: hash and number of blocks at the head and at the end.
  const auto first = text->text.find("HASH "), last = text->text.rfind("HASH ");
  ASSERT_NE(first, last);
  const auto hash = [&](std::size_t at) { return text->text.substr(at, text->text.find_first_of(")\n", at) - at); };
  EXPECT_EQ(hash(first), hash(last));
  EXPECT_NE(hash(first).find(fmt::format("BLOCKS {}", text->blocks)), std::string::npos);
  EXPECT_LT(first, motion);
  EXPECT_LT(text->text.size() - last, 120u);
}

TEST(Comment, IsAsciiByRule) {
  const std::pair<const char*, const char*> cases[] = {{"grün Größe ÄÖÜ", "GRUEN GROESSE AEOEUE"},
                                                       {"Ångström, señor, ÿ, Þ", "AANGSTROEM, SENOR, Y, TH"},
                                                       {"ø25 × 3 ÷ 2", "OE25 X 3 X 2"},
                                                       {"Łódź 齿 €", "?OD? ? ?"},
                                                       {"a(b)%;\n\x7f", "A[B]????"},
                                                       {"a ~", "A ?"},
                                                       {"\xc3", "?"},
                                                       {"\xff\xfe"
                                                        "a",
                                                        "??A"},
                                                       {"\xe9\xbd", "?"},
                                                       {"5°", "5?"},
                                                       {"", ""}};
  for (const auto& [text, ascii] : cases) EXPECT_EQ(numbers::comment_text(text), ascii);
}

INSTANTIATE_TEST_SUITE_P(Dialects, AssumedHeader,
                         testing::Values("linuxcnc", "fanuc", "siemens", "heidenhain", "mitsubishi_m80", "apt"),
                         [](const auto& place) { return std::string(place.param); });

}  // namespace
}  // namespace toothpath
