// The words of every control for flood, mist, air and coolant through the spindle: written, read back, and refused
// where there are none.
#include <gtest/gtest.h>

#include "tests/postproc/joints/trunnion_post.h"
#include "tests/support/rs274.h"

namespace toothpath {
namespace {

using namespace test;

constexpr const char* kControls[] = {"linuxcnc", "fanuc", "mitsubishi_m80", "siemens", "heidenhain", "apt"};

machines::Machine machine_for(const std::string& dialect) {
  machines::Machine m = trunnion_with(dialect, dialect == "apt" ? machines::TcpMode::vectors : machines::TcpMode::none);
  return m;
}

Result<text::NcText> text_with(const machines::Machine& m, machines::Coolant coolant) {
  const auto dialect = controls::dialect_of(m);
  if (!dialect) return dialect.error();
  const auto program = axis_program({sample_path(0.3, 0, 3)}, m, standing(), 2, true);
  if (!program) return program.error();
  text::NcHeader header;
  header.coolant = coolant;
  return write_nc(*program, *dialect, header);
}

std::string reading(const std::string& text, const machines::Machine& m) {
  const auto control = controls::control_of(m, standing(), tools());
  const auto s = readback::execute_nc(text, "p", *control, [](const readback::ExecutedMove&) {});
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
  machines::Coolant coolant;
  const char *on, *off;  ///< "" where the control has none
};

constexpr Words kWords[] = {{"linuxcnc", machines::Coolant::flood, "M8", "M9"},
                            {"linuxcnc", machines::Coolant::mist, "M7", "M9"},
                            {"fanuc", machines::Coolant::flood, "M8", "M9"},
                            {"fanuc", machines::Coolant::mist, "M7", "M9"},
                            {"mitsubishi_m80", machines::Coolant::flood, "M8", "M9"},
                            {"mitsubishi_m80", machines::Coolant::mist, "M7", "M9"},
                            {"siemens", machines::Coolant::flood, "M8", "M9"},
                            {"siemens", machines::Coolant::mist, "M7", "M9"},
                            {"heidenhain", machines::Coolant::flood, "M8", "M9"},
                            {"heidenhain", machines::Coolant::mist, "", ""},
                            {"apt", machines::Coolant::flood, "COOLNT/FLOOD", "COOLNT/OFF"},
                            {"apt", machines::Coolant::mist, "COOLNT/MIST", "COOLNT/OFF"}};

TEST(Coolant, IsWrittenInTheWordsOfTheControlAndReadBack) {
  for (const Words& w : kWords) {
    SCOPED_TRACE(std::string(w.dialect) + " " + to_string(w.coolant));
    const machines::Machine m = machine_for(w.dialect);
    const auto text = text_with(m, w.coolant);
    ASSERT_EQ(text.has_value(), *w.on != 0) << (text ? text->text : text.error().message);
    if (!text) continue;
    EXPECT_EQ(lines_with(text->text, w.on), 1u);
    EXPECT_EQ(lines_with(text->text, w.off), 1u);
    for (const char* other : {"M7", "M8", "COOLNT/FLOOD", "COOLNT/MIST", "COOLNT/ON"})
      if (std::string(other) != w.on) { EXPECT_EQ(lines_with(text->text, other), 0u) << other; }
    EXPECT_EQ(reading(text->text, m), "");
    std::string planted = text->text;
    const std::string wrong = std::string(w.dialect) == "apt" ? "COOLNT/TAPKUL" : "M77";
    planted.replace(planted.find(std::string(w.on) + "\n"), std::string(w.on).size(), wrong);
    EXPECT_NE(reading(planted, m).find("not in the subset"), std::string::npos) << reading(planted, m);
  }
}

TEST(Coolant, OffHasNoWord) {
  for (const char* dialect : kControls) {
    const auto text = text_with(machine_for(dialect), machines::Coolant::off);
    ASSERT_TRUE(text) << text.error().message;
    for (const char* word : {"M7", "M8", "M9"}) EXPECT_EQ(lines_with(text->text, word), 0u) << dialect;
    EXPECT_EQ(text->text.find("COOLNT"), std::string::npos);
  }
}

TEST(Coolant, AirAndThroughTheSpindleAreTheBuildersBusiness) {
  for (const char* dialect : kControls)
    for (const machines::Coolant coolant : {machines::Coolant::air, machines::Coolant::through_spindle}) {
      const auto refused = text_with(machine_for(dialect), coolant);
      ASSERT_FALSE(refused) << dialect;
      const std::string message = refused.error().message;
      EXPECT_EQ(message.find(std::string("mode = \"") + to_string(coolant) + "\": dialect \"" + dialect +
                             "\" has words for "),
                0u)
          << message;
      EXPECT_EQ(message.find(std::string("post.coolant_") + to_string(coolant)) == std::string::npos,
                std::string(dialect) == "apt")
          << message;
    }
}

// Words of the machine file take the place of the control's, and only under this machine they are read.
TEST(Coolant, WordsOfTheMachineFile) {
  for (const char* dialect : {"linuxcnc", "fanuc", "mitsubishi_m80", "siemens", "heidenhain"}) {
    SCOPED_TRACE(dialect);
    const machines::Machine plain = machine_for(dialect);
    machines::Machine m = plain;
    m.post.coolant[machines::Coolant::through_spindle] = {"M88", "M89"};
    if (std::string(dialect) == "heidenhain") m.post.coolant[machines::Coolant::through_spindle] = {"M50", "M51"};
    if (std::string(dialect) == "linuxcnc") m.post.coolant[machines::Coolant::through_spindle] = {"M150", "M151"};
    const machines::CoolantWords words = m.post.coolant[machines::Coolant::through_spindle];
    const auto text = text_with(m, machines::Coolant::through_spindle);
    ASSERT_TRUE(text) << text.error().message;
    EXPECT_EQ(lines_with(text->text, words.on), 1u);
    EXPECT_EQ(lines_with(text->text, words.off), 1u);
    EXPECT_EQ(reading(text->text, m), "");
    EXPECT_NE(reading(text->text, plain).find(words.on + " is not in the subset"), std::string::npos)
        << reading(text->text, plain);
  }
  machines::Machine m = machine_for("heidenhain");
  m.post.coolant[machines::Coolant::mist] = {"M7", "M9"};
  const auto text = text_with(m, machines::Coolant::mist);
  ASSERT_TRUE(text) << text.error().message;
  EXPECT_EQ(lines_with(text->text, "M7"), 1u);
  EXPECT_EQ(reading(text->text, m), "");
  EXPECT_NE(reading(text->text, machine_for("heidenhain")), "");
}

TEST(Coolant, WordsThatMeanSomethingElseAreRefused) {
  const auto refusal = [](const char* dialect, const machines::CoolantWords& words) {
    machines::Machine m = machine_for(dialect);
    m.file = "m.toml";
    m.positions["post.coolant_mist"] = {"m.toml", 18, 16};
    m.post.coolant[machines::Coolant::mist] = words;
    const auto d = controls::dialect_of(m);
    return d ? std::string() : d.error().text();
  };
  EXPECT_EQ(refusal("fanuc", {"M50", "M51"}), "");
  EXPECT_EQ(refusal("fanuc", {"M3", "M9"}),
            "m.toml:18:16: error: post.coolant_mist: M3 means something else to dialect \"fanuc\"");
  EXPECT_EQ(refusal("fanuc", {"M7", "M30"}),
            "m.toml:18:16: error: post.coolant_mist: M30 means something else to dialect \"fanuc\"");
  EXPECT_EQ(refusal("fanuc", {"M07", "M9"}), "m.toml:18:16: error: post.coolant_mist: \"M07\" is no M word such as M7");
  EXPECT_EQ(refusal("fanuc", {"M7 S9000", "M9"}),
            "m.toml:18:16: error: post.coolant_mist: \"M7 S9000\" is no M word such as M7");
  EXPECT_EQ(refusal("fanuc", {"M9", "M7"}), "m.toml:18:16: error: post.coolant_mist: M9 switches flood off");
  EXPECT_EQ(refusal("linuxcnc", {"M64", "M65"}),
            "m.toml:18:16: error: post.coolant_mist: M64 means something else to dialect \"linuxcnc\"");
  EXPECT_EQ(refusal("linuxcnc", {"M428", "M9"}),
            "m.toml:18:16: error: post.coolant_mist: M428 is a code of TCP or smoothing in this file");
  EXPECT_EQ(refusal("heidenhain", {"M128", "M9"}),
            "m.toml:18:16: error: post.coolant_mist: M128 means something else to dialect \"heidenhain\"");
  EXPECT_EQ(refusal("apt", {"M7", "M9"}),
            "m.toml:18:16: error: post.coolant_mist: dialect \"apt\" has words of its own and no others");
}

// LinuxCNC's own interpreter takes the words as they are meant.
TEST(Coolant, LinuxcncUnderstandsItsWords) {
  for (const auto& [coolant, canonical] :
       {std::pair{machines::Coolant::mist, "MIST_ON"}, std::pair{machines::Coolant::flood, "FLOOD_ON"}}) {
    const auto text = text_with(with_dialect(trunnion(), "linuxcnc"), coolant);
    ASSERT_TRUE(text) << text.error().message;
    const auto out = interpret(text->text, std::string("coolant_") + to_string(coolant));
    ASSERT_EQ(out.exit, 0) << out.messages;
    for (const char* command : {"MIST_ON", "FLOOD_ON"}) {
      const bool found = std::any_of(out.lines.begin(), out.lines.end(),
                                     [&](const std::string& l) { return l.find(command) != std::string::npos; });
      EXPECT_EQ(found, std::string(command) == canonical) << command;
    }
  }
}

}  // namespace
}  // namespace toothpath
