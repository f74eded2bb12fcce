// The words of every control for flood, mist, air and coolant through the spindle: written, read back, and refused where there are none.
#include <gtest/gtest.h>

#include "tests/postproc/trunnion_post.h"
#include "tests/support/rs274.h"

namespace toothpath {
namespace {

using namespace test;

constexpr const char* kControls[] = {"linuxcnc", "fanuc", "mitsubishi_m80", "siemens", "heidenhain", "apt"};

Machine machine_for(const std::string& dialect) {
  Machine m = trunnion_with(dialect, dialect == "apt" ? TcpMode::vectors : TcpMode::none);
  return m;
}

Result<NcText> text_with(const Machine& m, Coolant coolant) {
  const auto dialect = dialect_of(m);
  if (!dialect) return dialect.error();
  const auto program = axis_program({sample_path(0.3, 0, 3)}, m, standing(), 2, true);
  if (!program) return program.error();
  NcHeader header;
  header.coolant = coolant;
  return write_nc(*program, *dialect, header);
}

std::string reading(const std::string& text, const Machine& m) {
  const auto control = control_of(m, standing(), tools());
  const auto s = execute_nc(text, "p", *control, [](const ExecutedMove&) {});
  return s ? std::string() : s.error().text();
}

/// Number of lines that end in these words.
std::size_t lines_with(const std::string& text, const std::string& words) {
  std::size_t n = 0;
  for (std::size_t at = text.find(words + "\n"); at != std::string::npos; at = text.find(words + "\n", at + 1))
    n += at == 0 || text[at - 1] == '\n' || text[at - 1] == ' ' ? 1 : 0;
  return n;
}

struct Words {
  const char* dialect;
  Coolant coolant;
  const char *on, *off;  ///< "" where the control has none
};

constexpr Words kWords[] = {
    {"linuxcnc", Coolant::flood, "M8", "M9"},       {"linuxcnc", Coolant::mist, "M7", "M9"},
    {"fanuc", Coolant::flood, "M8", "M9"},          {"fanuc", Coolant::mist, "M7", "M9"},
    {"mitsubishi_m80", Coolant::flood, "M8", "M9"}, {"mitsubishi_m80", Coolant::mist, "M7", "M9"},
    {"siemens", Coolant::flood, "M8", "M9"},        {"siemens", Coolant::mist, "M7", "M9"},
    {"heidenhain", Coolant::flood, "M8", "M9"},     {"heidenhain", Coolant::mist, "", ""},
    {"apt", Coolant::flood, "COOLNT/FLOOD", "COOLNT/OFF"}, {"apt", Coolant::mist, "COOLNT/MIST", "COOLNT/OFF"}};

TEST(Coolant, IsWrittenInTheWordsOfTheControlAndReadBack) {
  for (const Words& w : kWords) {
    SCOPED_TRACE(std::string(w.dialect) + " " + to_string(w.coolant));
    const Machine m = machine_for(w.dialect);
    const auto text = text_with(m, w.coolant);
    ASSERT_EQ(text.has_value(), *w.on != 0) << (text ? text->text : text.error().message);
    if (!text) continue;
    EXPECT_EQ(lines_with(text->text, w.on), 1u);
    EXPECT_EQ(lines_with(text->text, w.off), 1u);
    for (const char* other : {"M7", "M8", "COOLNT/FLOOD", "COOLNT/MIST", "COOLNT/ON"})
      if (std::string(other) != w.on) {
        EXPECT_EQ(lines_with(text->text, other), 0u) << other;
      }
    EXPECT_EQ(reading(text->text, m), "");
    std::string planted = text->text;
    const std::string wrong = std::string(w.dialect) == "apt" ? "COOLNT/TAPKUL" : "M77";
    planted.replace(planted.find(std::string(w.on) + "\n"), std::string(w.on).size(), wrong);
    EXPECT_NE(reading(planted, m).find("not in the subset"), std::string::npos) << reading(planted, m);
  }
}

TEST(Coolant, OffHasNoWord) {
  for (const char* dialect : kControls) {
    const auto text = text_with(machine_for(dialect), Coolant::off);
    ASSERT_TRUE(text) << text.error().message;
    for (const char* word : {"M7", "M8", "M9"}) EXPECT_EQ(lines_with(text->text, word), 0u) << dialect;
    EXPECT_EQ(text->text.find("COOLNT"), std::string::npos);
  }
}

TEST(Coolant, AirAndThroughTheSpindleAreTheBuildersBusiness) {
  for (const char* dialect : kControls)
    for (const Coolant coolant : {Coolant::air, Coolant::through_spindle}) {
      const auto refused = text_with(machine_for(dialect), coolant);
      ASSERT_FALSE(refused) << dialect;
      const std::string message = refused.error().message;
      EXPECT_EQ(message.find(std::string("mode = \"") + to_string(coolant) + "\": dialect \"" + dialect + "\" has words for "), 0u) << message;
      EXPECT_EQ(message.find(std::string("post.coolant_") + to_string(coolant)) == std::string::npos, std::string(dialect) == "apt") << message;
    }
}

// Words of the machine file take the place of the control's, and only under this machine they are read.
TEST(Coolant, WordsOfTheMachineFile) {
  for (const char* dialect : {"linuxcnc", "fanuc", "mitsubishi_m80", "siemens", "heidenhain"}) {
    SCOPED_TRACE(dialect);
    const Machine plain = machine_for(dialect);
    Machine m = plain;
    m.post.coolant[Coolant::through_spindle] = {"M88", "M89"};
    if (std::string(dialect) == "heidenhain") m.post.coolant[Coolant::through_spindle] = {"M50", "M51"};
    if (std::string(dialect) == "linuxcnc") m.post.coolant[Coolant::through_spindle] = {"M150", "M151"};
    const CoolantWords words = m.post.coolant[Coolant::through_spindle];
    const auto text = text_with(m, Coolant::through_spindle);
    ASSERT_TRUE(text) << text.error().message;
    EXPECT_EQ(lines_with(text->text, words.on), 1u);
    EXPECT_EQ(lines_with(text->text, words.off), 1u);
    EXPECT_EQ(reading(text->text, m), "");
    EXPECT_NE(reading(text->text, plain).find(words.on + " is not in the subset"), std::string::npos) << reading(text->text, plain);
  }
  Machine m = machine_for("heidenhain");
  m.post.coolant[Coolant::mist] = {"M7", "M9"};
  const auto text = text_with(m, Coolant::mist);
  ASSERT_TRUE(text) << text.error().message;
  EXPECT_EQ(lines_with(text->text, "M7"), 1u);
  EXPECT_EQ(reading(text->text, m), "");
  EXPECT_NE(reading(text->text, machine_for("heidenhain")), "");
}

TEST(Coolant, WordsThatMeanSomethingElseAreRefused) {
  const auto refusal = [](const char* dialect, const CoolantWords& words) {
    Machine m = machine_for(dialect);
    m.file = "m.toml";
    m.positions["post.coolant_mist"] = {"m.toml", 18, 16};
    m.post.coolant[Coolant::mist] = words;
    const auto d = dialect_of(m);
    return d ? std::string() : d.error().text();
  };
  EXPECT_EQ(refusal("fanuc", {"M50", "M51"}), "");
  EXPECT_EQ(refusal("fanuc", {"M3", "M9"}), "m.toml:18:16: error: post.coolant_mist: M3 means something else to dialect \"fanuc\"");
  EXPECT_EQ(refusal("fanuc", {"M7", "M30"}), "m.toml:18:16: error: post.coolant_mist: M30 means something else to dialect \"fanuc\"");
  EXPECT_EQ(refusal("fanuc", {"M07", "M9"}), "m.toml:18:16: error: post.coolant_mist: \"M07\" is no M word such as M7");
  EXPECT_EQ(refusal("fanuc", {"M7 S9000", "M9"}), "m.toml:18:16: error: post.coolant_mist: \"M7 S9000\" is no M word such as M7");
  EXPECT_EQ(refusal("fanuc", {"M9", "M7"}), "m.toml:18:16: error: post.coolant_mist: M9 switches flood off");
  EXPECT_EQ(refusal("linuxcnc", {"M64", "M65"}), "m.toml:18:16: error: post.coolant_mist: M64 means something else to dialect \"linuxcnc\"");
  EXPECT_EQ(refusal("linuxcnc", {"M428", "M9"}), "m.toml:18:16: error: post.coolant_mist: M428 is a code of TCP or smoothing in this file");
  EXPECT_EQ(refusal("heidenhain", {"M128", "M9"}), "m.toml:18:16: error: post.coolant_mist: M128 means something else to dialect \"heidenhain\"");
  EXPECT_EQ(refusal("apt", {"M7", "M9"}), "m.toml:18:16: error: post.coolant_mist: dialect \"apt\" has words of its own and no others");
}

// LinuxCNC's own interpreter takes the words as they are meant.
TEST(Coolant, LinuxcncUnderstandsItsWords) {
  for (const auto& [coolant, canonical] : {std::pair{Coolant::mist, "MIST_ON"}, std::pair{Coolant::flood, "FLOOD_ON"}}) {
    const auto text = text_with(with_dialect(trunnion(), "linuxcnc"), coolant);
    ASSERT_TRUE(text) << text.error().message;
    const auto out = interpret(text->text, std::string("coolant_") + to_string(coolant));
    ASSERT_EQ(out.exit, 0) << out.messages;
    for (const char* command : {"MIST_ON", "FLOOD_ON"}) {
      const bool found = std::any_of(out.lines.begin(), out.lines.end(), [&](const std::string& l) { return l.find(command) != std::string::npos; });
      EXPECT_EQ(found, std::string(command) == canonical) << command;
    }
  }
}

}  // namespace
}  // namespace toothpath
