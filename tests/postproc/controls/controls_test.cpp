// What is known of every control, from one place: the registry.
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <regex>
#include <set>

#include "postproc/controls/of_machine.h"
#include "postproc/controls/registry.h"
#include "tests/machines/bad_machine_files.h"
#include "tests/machines/bad_post_keys.h"
#include "tests/machines/example_files.h"
#include "tests/postproc/readback/nc_case.h"
#include "tests/postproc/text/post_forms.h"
#include "tests/support/files.h"

namespace toothpath {
namespace {

using test::file_text, test::kMachine, test::replaced;

const std::string kRoot = TOOTHPATH_SOURCE_DIR;

std::string messages(const std::string& text) { return to_text(controls::read_machine_of_text(text, "m.toml").errors); }

TEST(Controls, HaveNamesOfTheirOwnAndAllTheirParts) {
  std::set<std::string> names;
  for (const auto* c : controls::all()) {
    SCOPED_TRACE(c->words.name);
    EXPECT_TRUE(names.insert(c->words.name).second);
    for (const auto& alias : c->aliases) {
      EXPECT_TRUE(names.insert(alias).second) << alias;
      EXPECT_EQ(controls::find(alias), c);
    }
    EXPECT_EQ(controls::find(c->words.name), c);
    EXPECT_TRUE(std::regex_match(c->words.extension, std::regex("\\.[a-z]+")));
    EXPECT_NE(c->execute, nullptr);
    EXPECT_NE(c->offsets.has, nullptr);
    EXPECT_TRUE(c->offsets.has("G54"));
    EXPECT_NE(c->offsets.names, "");
    EXPECT_TRUE(c->words.coolant.count(machines::Coolant::flood));
  }
  EXPECT_EQ(controls::find("grbl"), nullptr);
  EXPECT_EQ(controls::find(""), nullptr);
}

// A machine file may say another name of its control.
TEST(Controls, AnAliasIsTheSameControl) {
  for (const auto* c : controls::all())
    for (const auto& alias : c->aliases) {
      const std::string text = replaced(kMachine, "\"linuxcnc\"", "\"" + alias + "\"");
      const auto reading = controls::read_machine_of_text(
          c->words.cutter_locations ? replaced(text, "\"none\"", "\"vectors\"") : text, "m.toml");
      ASSERT_TRUE(reading.machine) << to_text(reading.errors);
      const auto words = controls::dialect_of(*reading.machine);
      ASSERT_TRUE(words);
      EXPECT_EQ(words->name, c->words.name);
    }
}

TEST(Controls, WorkOffsetsAreThoseOfTheControl) {
  machines::Machine m;
  const auto others = [&m](const char* control, const char* name) {
    m.dialect = control;
    return controls::other_work_offsets(m, name).value_or("");
  };
  const std::pair<const char*, std::vector<const char*>> right[] = {
      {"linuxcnc", {"G54", "G59", "G59.3"}},       {"fanuc", {"G54", "G54.1 P1", "G54.1 P300"}},
      {"mitsubishi_m80", {"G59", "G54.1 P12"}},    {"siemens", {"G54", "G57", "G505", "G599"}},
      {"heidenhain", {"G54", "G59.1", "1", "99"}}, {"apt", {"G54", "17"}}};
  for (const auto& [control, names] : right)
    for (const char* name : names) EXPECT_EQ(others(control, name), "") << control << " " << name;
  const std::tuple<const char*, const char*, const char*> wrong[] = {
      {"linuxcnc", "G54.1 P3", "G54 to G59 and G59.1 to G59.3"},
      {"linuxcnc", "G59.4", "G54 to G59 and G59.1 to G59.3"},
      {"fanuc", "G54.1 P301", "G54 to G59 and G54.1 P1 to P300"},
      {"fanuc", "G59.1", "G54 to G59 and G54.1 P1 to P300"},
      {"siemens", "G58", "G54 to G57 and G505 to G599 (G58 and G59 shift single axes)"},
      {"heidenhain", "100", "the presets 1 to 99, or G54 for preset 1 to G59 for 6, G59.1 for 7 to G59.3 for 9"},
      {"heidenhain", "07", "the presets 1 to 99, or G54 for preset 1 to G59 for 6, G59.1 for 7 to G59.3 for 9"}};
  for (const auto& [control, name, text] : wrong) EXPECT_EQ(others(control, name), text) << name;
  m.post.index_offset = "G59.3";
  EXPECT_EQ(others("linuxcnc", "G59.2"), "");
  EXPECT_EQ(others("linuxcnc", "G59.3"),
            "G54 to G59 and G59.1 to G59.3 without G59.3, which post.index_offset lets programs overwrite");
  EXPECT_EQ(others("grbl", "G54"), "none that is known: \"grbl\" is not one of " + controls::list_of_names());
}

// Every way in which the keys of smoothing, corners and coolants can be wrong, alone or with their partners and the
// control.
/// What the work offset must hold beside its place is told for every control that makes joints of words.
TEST(Controls, SayWhatTheWorkOffsetMustHold) {
  const std::array<char, 5> letters{'X', 'Y', 'Z', 'C', 'A'};
  for (const auto* c : controls::all()) {
    const std::string trust = text::offset_trust(c->words, "G54", letters);
    EXPECT_EQ(trust.empty(), c->words.name == "apt") << c->words.name;
    EXPECT_EQ(trust.find('{'), std::string::npos) << trust;
    EXPECT_EQ(trust.find("A, C") == std::string::npos, trust.empty()) << trust;
    for (const std::string& line : text::offset_check_lines(c->words, "G54", letters))
      EXPECT_EQ(line.find('{'), std::string::npos) << line;
  }
  EXPECT_EQ(text::offset_trust(controls::find("linuxcnc")->words, "G55", {'X', 'Y', 'Z', 'B', 0}),
            "B, R of G55 must be 0: the program looks and ends if they are not");
}

// Which pin must know the tool, and which versions err: by the kinematics that the chain of the machine has.
TEST(Controls, LinuxcncSaysWhatItsTcpMustKnow) {
  const auto notes = [](machines::Machine m) {
    m.tcp = machines::TcpMode::angles;
    m.post.tcp_on = {"M428"};
    m.post.tcp_off = {"M429"};
    const auto d = controls::dialect_of(m);
    return d ? fmt::format("{}", fmt::join(d->tcp_notes, "; ")) : d.error().message;
  };
  machines::Machine m = test::trunnion();
  for (machines::RotaryAxis& axis : m.chain.table) axis.sign = 1;
  EXPECT_EQ(notes(m),
            "TCP: motion.tooloffset.z must reach xyzac-trt-kins.tool-offset; xyzac-trt-kins.conventional-directions "
            "must be 1");
  m.chain.table[0].sign = -1;
  EXPECT_EQ(notes(m),
            "TCP: motion.tooloffset.z must reach xyzac-trt-kins.tool-offset; xyzac-trt-kins turns C and A both as ISO "
            "says or both reversed, this machine file does not");
  m.chain.table[1].sign = -1;
  EXPECT_EQ(notes(m),
            "TCP: motion.tooloffset.z must reach xyzac-trt-kins.tool-offset; xyzac-trt-kins.conventional-directions "
            "must be 0, as by default");
  m.chain.table[1].letter = 'B';
  m.chain.table[1].direction = Vec3::UnitY();
  EXPECT_EQ(notes(m),
            "TCP: motion.tooloffset.z must reach xyzbc-trt-kins.tool-offset; xyzbc-trt-kins.conventional-directions "
            "must be 0, as by default; xyzbc-trt-kins: none of master from 2025-06-26 to 2026-09-15, it errs");
  m.chain.head = {m.chain.table[1]};
  m.chain.table.pop_back();
  EXPECT_EQ(notes(m), "TCP: motion.tooloffset.z must reach the kinematics");
  m.chain.head.insert(m.chain.head.begin(), m.chain.table[0]);
  m.chain.table.clear();
  EXPECT_EQ(notes(m), "TCP: 5axiskins.pivot-length is the pivot and motion.tooloffset.z");
}

// A line of a list is refused where it stands, not where the list begins.
TEST(Controls, ALineOfAListIsRefusedAtItsPlace) {
  const std::string file = std::string(test::kMachine) + "\n[post]\nstart = [\"M9\",\n  \"G4 {tool}\", \"(PY,x)\"]\n";
  const int line = int(std::count(file.begin(), file.end(), '\n'));
  const auto read = machines::read_machine_text(file, "m.toml");
  ASSERT_TRUE(read.machine) << to_text(read.errors);
  std::string places;
  for (const auto& error : controls::judge(*read.machine))
    places += error.text().substr(0, error.text().find(" error")) + " ";
  EXPECT_EQ(places, fmt::format("m.toml:{0}:3: m.toml:{0}:16: ", line));
}

// A rotary that is not at its zero at 0 deg: with TCP the control calculates with its own data. One that counts from 0
// alone is refused, of the others the data are named; without TCP the words are the machine's.
TEST(Controls, ZerosUnderTcpAreTheControls) {
  const std::tuple<const char*, machines::TcpMode, const char*, const char*> cases[] = {
      {"linuxcnc", machines::TcpMode::angles,
       "axes.A.zero = 90 deg: with TCP dialect \"linuxcnc\" takes the table as level and straight at A = 0; home A so "
       "that it is, with zero = 0, or take tcp = \"none\"",
       ""},
      {"fanuc", machines::TcpMode::angles,
       "axes.A.zero = 90 deg: with TCP dialect \"fanuc\" takes the table as level and straight at A = 0; home A so "
       "that "
       "it is, with zero = 0, or take tcp = \"none\"",
       ""},
      {"siemens", machines::TcpMode::angles, "",
       "axes.A.zero = 90 deg, TRAORI counts A from it, machine data 24510 (24610, ..) TRAFO5_ROT_AX_OFFSET"},
      {"siemens", machines::TcpMode::vectors, "",
       "axes.A.zero = 90 deg, TRAORI counts A from it, machine data 24510 (24610, ..) TRAFO5_ROT_AX_OFFSET"},
      {"heidenhain", machines::TcpMode::angles, "",
       "axes.A.zero = 90 deg, TCPM counts A from it, in the kinematics of the control"},
      {"apt", machines::TcpMode::vectors, "", ""},
      {"linuxcnc", machines::TcpMode::none, "", ""},
      {"fanuc", machines::TcpMode::none, "", ""}};
  for (const auto& [dialect, tcp, refused, trusted] : cases)
    for (const double zero : {90.0, 0.0}) {
      machines::Machine m = test::with_dialect(test::trunnion(), dialect);
      m.tcp = tcp;
      if (m.dialect == "linuxcnc") m.post.tcp_on = m.post.tcp_off = {"M428"};
      m.chain.table[1].zero_rad = radians(zero);
      std::string complaints;
      for (const auto& e : controls::judge(m)) complaints += e.message;
      EXPECT_EQ(complaints, zero == 0 ? "" : refused) << dialect;
      EXPECT_EQ(fmt::format("{}", fmt::join(controls::trusted_zeros(m, false), "; ")), zero == 0 ? "" : trusted);
    }
}

TEST(ControlKeys, AreJudgedWithTheirPlace) {
  for (const test::PostKeys& keys : test::kPostKeys)
    EXPECT_EQ(messages(test::machine_with(keys)), std::string(keys.messages)) << keys.what;
  for (const test::BadFile& bad : test::kBadControls)
    EXPECT_EQ(messages(replaced(kMachine, bad.from, bad.to)),
              test::with_controls(bad.messages, controls::list_of_names()))
        << bad.what;
}

TEST(ControlKeys, ComplaintsStandInTheOrderOfTheFile) {
  std::string text = replaced(kMachine, "\"linuxcnc\"", "\"heidenhain\"");
  text = replaced(text, "max_speed = 24000", "max_speed = 0");
  text =
      replaced(text, "[chain]",
               "[post]\ncorner_tolerance = 0.001\ncoolant_air = [\"M128\", \"M129\"]\nlinear_decimals = 9\n\n[chain]");
  EXPECT_EQ(messages(text),
            "m.toml:10:13: error: spindle.max_speed = 0 must be above 0 1/min\n"
            "m.toml:18:20: error: post.corner_tolerance belongs to dialect \"linuxcnc\", \"fanuc\", "
            "\"mitsubishi_m80\", \"haas\", this is \"heidenhain\"\n"
            "m.toml:19:15: error: post.coolant_air: M128 means something else to dialect \"heidenhain\"\n"
            "m.toml:19:15: error: post.coolant_air: M129 means something else to dialect \"heidenhain\"\n"
            "m.toml:20:19: error: post.linear_decimals = 9: 1 to 7 decimals are possible in a word\n");
}

// Below the controls none is known by its name. (Gear shapers say theirs in a file of their own.)
TEST(Controls, ReadersOfMachineFilesAndTheCommonTextNameNone) {
  int seen = 0;
  for (const char* folder : {"/machines", "/postproc"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kRoot + folder)) {
      const std::string name = entry.path().lexically_relative(kRoot).generic_string();
      if (entry.path().extension() != ".cpp" || name.starts_with("postproc/controls/") ||
          name.find("shaper") != std::string::npos)
        continue;
      ++seen;
      const std::string text = file_text(entry.path());
      for (const auto* c : controls::all())
        EXPECT_EQ(text.find("\"" + c->words.name + "\""), std::string::npos) << name << " names " << c->words.name;
    }
  EXPECT_GT(seen, 40);
}

// The tables of the documentation name every control, with its file extension.
TEST(ControlTables, NameEveryControl) {
  const std::string dialects = file_text(kRoot + "/docs/dialects.md"),
                    machines = file_text(kRoot + "/machines/README.md"),
                    folder = file_text(kRoot + "/postproc/controls/README.md");
  for (const auto* c : controls::all()) {
    EXPECT_NE(dialects.find("| `" + c->words.name + "` | `" + c->words.extension + "` |"), std::string::npos)
        << "docs/dialects.md lacks " << c->words.name;
    for (const auto& alias : c->aliases)
      EXPECT_NE(dialects.find("`" + alias + "`"), std::string::npos) << "docs/dialects.md lacks the alias " << alias;
    EXPECT_NE(folder.find("`" + c->words.name + "/`"), std::string::npos)
        << "postproc/controls/README.md lacks " << c->words.name;
  }
  // Below the controls no list of them is kept.
  EXPECT_EQ(machines.find("`heidenhain`"), std::string::npos);
  const std::string row = dialects.substr(
      dialects.find("## What is there"), dialects.find("What a dialect cannot do") - dialects.find("## What is there"));
  const std::regex named("\\n\\| `([a-z0-9_]+)` \\|");
  for (auto it = std::sregex_iterator(row.begin(), row.end(), named); it != std::sregex_iterator(); ++it)
    EXPECT_NE(controls::find((*it)[1].str()), nullptr) << "docs/dialects.md names " << (*it)[1];
}

// By the job, so that two of them do not replace each other on a control; "SAMPLE" stands in BEGIN PGM, too.
TEST(ProgramNames, OfFilesFollowTheJob) {
  const auto name = [](const char* control, const char* job) {
    text::NcHeader header;
    header.job_name = job;
    header.program_number = 2500;
    return text::name_on_control(controls::find(control)->words, header);
  };
  EXPECT_EQ(name("fanuc", "gear"), "O2500");
  EXPECT_EQ(name("haas", "gear"), "O2500");
  EXPECT_EQ(name("siemens", "dhfg-t600s"), "DHFG_T600S.MPF");
  EXPECT_EQ(name("siemens", "z8 pinion"), "Z_8_PINION.MPF");
  EXPECT_EQ(name("siemens", "8 teeth"), "P_8_TEETH.MPF");
  EXPECT_EQ(name("siemens", "a very long name of a gear with a number"), "A_VERY_LONG_NAME_OF_A_GE.MPF");
  EXPECT_EQ(name("heidenhain", "z8 pinion"), "Z8_PINION.H");
  EXPECT_EQ(name("linuxcnc", "gear"), "GEAR.NGC");
  EXPECT_EQ(name("apt", "gear"), "GEAR.APT");
}

// The sub-programs of a job stand behind its own number, never among the builder's.
TEST(ProgramNumbers, OfSubProgramsFollowThatOfTheProgram) {
  for (const auto* c : controls::all()) {
    const bool numbers = c->words.name == "fanuc" || c->words.name == "haas" || c->words.name == "mitsubishi_m80";
    EXPECT_EQ(text::has_program_number(c->words), numbers) << c->words.name;
  }
  for (const char* dialect : {"fanuc", "mitsubishi_m80"}) {
    const test::PostForm form{dialect, machines::TcpMode::none, 0, false};
    const auto program = test::program_of(form, {test::sample_path(0.3, 0, 4)}, 3, 1);
    ASSERT_TRUE(program) << program.error().message;
    const auto words = controls::dialect_of(test::machine_of(form));
    text::NcHeader header;
    header.job_name = "sample";
    header.program_number = 1234;
    const auto text = text::write_nc(*program, *words, header);
    ASSERT_TRUE(text) << text.error().message;
    EXPECT_NE(text->text.find("O1234 (SAMPLE)"), std::string::npos);
    std::set<int> called, there;
    const std::regex call("M98 P([0-9]+)"), begin("\nO([0-9]+) \\(OPERATION");
    for (std::sregex_iterator it(text->text.begin(), text->text.end(), call), end; it != end; ++it)
      called.insert(std::stoi((*it)[1]));
    for (std::sregex_iterator it(text->text.begin(), text->text.end(), begin), end; it != end; ++it)
      there.insert(std::stoi((*it)[1]));
    EXPECT_EQ(called, there);
    ASSERT_FALSE(there.empty());
    EXPECT_EQ(*there.begin(), 1235);
    EXPECT_EQ(*there.rbegin(), 1234 + int(there.size()));
    header.program_number = 8000 - int(there.size());
    const auto above = text::write_nc(*program, *words, header);
    ASSERT_FALSE(above);
    EXPECT_NE(above.error().message.find("above O7999"), std::string::npos) << above.error().message;
    header.program_number = 7999 - int(there.size());
    EXPECT_TRUE(text::write_nc(*program, *words, header));
  }
}

}  // namespace
}  // namespace toothpath
