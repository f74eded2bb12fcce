// Machine files: those that ship, the one of a job, and every way in which one can be wrong, with its exact message.
#include "machines/machine_file.h"

#include <gtest/gtest.h>

#include <tuple>

#include <filesystem>
#include <fstream>
#include <random>

#include "machines/shaper_machine.h"
#include "machines/toml/toml_tree.h"
#include "tests/machines/bad_bodies.h"
#include "tests/machines/bad_machine_files.h"
#include "tests/machines/example_files.h"

namespace toothpath {
namespace {

namespace fs = std::filesystem;
using test::damaged, test::replaced, test::kMachine, test::kMaxBytesForTest, test::TestDir;

std::vector<std::string> shipped(machines::MachineKind kind) {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(fs::path(TOOTHPATH_SOURCE_DIR) / "machines" / "data")) {
    const auto found = machines::open_machine_file(entry.path().string());
    EXPECT_TRUE(found) << entry.path();
    if (found && found->kind == kind) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

machines::Machine load(const std::string& path) {
  machines::MachineReading reading = machines::read_machine_file(path);
  EXPECT_TRUE(reading.machine) << to_text(reading.errors);
  return reading.machine.value_or(machines::Machine{});
}

TEST(ShippedMachines, EveryFileLoadsAndRoundTrips) {
  const auto files = shipped(machines::MachineKind::five_axis);
  ASSERT_GE(files.size(), 7u);
  std::mt19937_64 rng(11);
  for (const std::string& file : files) {
    const machines::Machine machine = load(file);
    const machines::KinematicChain& chain = machine.chain;
    EXPECT_EQ(chain.rotary_count(), 2u) << file;
    int reached = 0;
    for (int i = 0; i < 300; ++i) {
      // A pose inside the limits, then every solution for it.
      machines::Joints joints;
      std::uniform_real_distribution<double> unit(0.01, 0.99);
      for (std::size_t k = 0; k < 3; ++k)
        joints.linear_mm[static_cast<Eigen::Index>(k)] =
            chain.linear[k].min_mm + unit(rng) * (chain.linear[k].max_mm - chain.linear[k].min_mm);
      for (std::size_t k = 0; k < 2; ++k)
        joints.rotary_rad[k] =
            chain.rotary(k).min_rad + unit(rng) * (chain.rotary(k).max_rad - chain.rotary(k).min_rad);
      const machines::TablePose pose = chain.forward(joints, 110);
      const auto found = chain.candidates(pose, 110, machine.limit_margin);
      ASSERT_TRUE(found) << file << ": " << found.error().message;
      bool same = false;
      for (const machines::JointSolution& s : *found) {
        const machines::TablePose back = chain.forward(s.joints, 110);
        ASSERT_LE((back.axis - pose.axis).norm(), 1e-12);
        ASSERT_LE((back.tip_mm - pose.tip_mm).norm(), 1e-9);
        same = same || (std::abs(s.joints.rotary_rad[0] - joints.rotary_rad[0]) < 1e-7 &&
                        std::abs(s.joints.rotary_rad[1] - joints.rotary_rad[1]) < 1e-7);
      }
      reached += same;
    }
    EXPECT_GE(reached, 299) << file;  // within 1e-7 rad of a pole the angles themselves are not unique
  }
}

TEST(ShippedMachines, LargeTrunnionIsWhatItsFileSays) {
  const machines::Machine m = load(TOOTHPATH_SOURCE_DIR "/machines/data/xyzac_large.toml");
  EXPECT_EQ(m.name, "XYZAC trunnion, large");
  EXPECT_EQ(m.dialect, "linuxcnc");
  EXPECT_EQ(m.tcp, machines::TcpMode::none);
  EXPECT_FALSE(m.assumed);
  EXPECT_EQ(m.max_simultaneous_axes, 5);
  EXPECT_EQ(m.max_spindle_speed, 24000);
  EXPECT_EQ(m.max_cutting_feed, 10000);
  EXPECT_EQ(m.table_diameter_mm, 1200);
  EXPECT_EQ(m.min_block_ms, 1.0);
  EXPECT_EQ(m.feed_factor, 2.0);
  EXPECT_EQ(m.speed_factor, 1.25);
  EXPECT_EQ(m.chain.letters(), "XYZCA");
  EXPECT_EQ(m.chain.linear[2].min_mm, -900);
  EXPECT_EQ(m.chain.linear[2].max_mm, 600);
  ASSERT_EQ(m.chain.table.size(), 2u);
  EXPECT_EQ(m.chain.table[1].point_mm, Vec3(0, 12.5, -31.25));
  EXPECT_EQ(m.chain.table[1].sign, -1);
  EXPECT_NEAR(degrees(m.chain.table[1].min_rad), -110, 1e-12);
  EXPECT_NEAR(degrees(m.chain.table[1].max_speed), 6000, 1e-9);
  EXPECT_EQ(m.chain.table[0].point_mm, Vec3(3, -2, 0));
  EXPECT_NEAR(m.limit_margin.linear_mm, 0.1, 0);
  EXPECT_NEAR(degrees(m.limit_margin.rotary_rad), 0.01, 1e-15);
}

// Every value of the T-600S is a guess, and its report must be able to name each of them.
TEST(ShippedMachines, T600sNamesEveryValueAsAssumed) {
  const machines::Machine m = load(TOOTHPATH_SOURCE_DIR "/machines/data/t600s.toml");
  EXPECT_TRUE(m.assumed);
  for (const char* key : {"dialect", "tcp", "max_simultaneous_axes", "spindle.max_speed", "limits.part_diameter",
                          "chain.table", "axes.X.min", "axes.A.point", "axes.C.point", "axes.A.sign"})
    EXPECT_EQ(std::count(m.assumed_keys.begin(), m.assumed_keys.end(), key), 1) << key;
  EXPECT_EQ(machines::check_part_fits(m, 900).error().message,
            "part diameter = 900.0000 mm exceeds 250.0000 mm, the largest that turns on T-600S");
  EXPECT_TRUE(machines::check_part_fits(m, 248));
}

// Trunnion with ISO signs and its plate on top: a gear of 248 mm is reached all round with a vertical tool.
TEST(ShippedMachines, T600sReachesAGearOf248mmAllRound) {
  const machines::Machine m = load(TOOTHPATH_SOURCE_DIR "/machines/data/t600s.toml");
  const Vec3 origin(0, 0, -240);  // gear frame on the C axis
  for (const double L : {100.0, 125.0, 150.0})
    for (const double z : {-21.0, -17.0, 40.0})
      for (int k = 0; k < 360; ++k) {
        const double t = 2 * kPi * k / 360;
        const machines::TablePose pose{origin + Vec3(126 * std::cos(t), 126 * std::sin(t), z), Vec3::UnitZ()};
        for (const double c : {0.0, t}) {  // C at rest, or turning the place to the front
          const auto found = m.chain.candidates(pose, L, m.limit_margin, c);
          ASSERT_TRUE(found) << found.error().message;
          EXPECT_EQ(found->front().joints.rotary_rad[1], 0.0);
        }
      }
}

std::string messages(const std::string& text) {
  const machines::MachineReading reading = machines::read_machine_text(text, "m.toml");
  EXPECT_EQ(reading.machine.has_value(), reading.errors.empty());
  return to_text(reading.errors);
}

TEST(MachineFile, TheExampleItselfIsGood) { EXPECT_EQ(messages(kMachine), ""); }

/// "a.a.a", n parts.
std::string parts(int n) {
  std::string text = "a";
  for (int k = 1; k < n; ++k) text += ".a";
  return text;
}

// One key of 40 000 parts is as many tables in each other: no stack holds them.
TEST(TomlDepth, IsBoundedInEveryForm) {
  const std::string many = parts(40'000), key = "a key has more than 16 parts", deep = std::string(100'000, '[');
  const std::pair<std::string, std::string> cases[] = {
      {many + " = 1", "t:1:32: error: " + key},
      {"[" + many + "]", "t:1:33: error: " + key},
      {"[[" + many + "]]", "t:1:34: error: " + key},
      {"x = {" + many + " = 1}", "t:1:37: error: " + key},
      {"x = [{" + many + " = 1}]", "t:1:38: error: " + key},
      {"x = [\n{b = 1, " + many + " = 1}]", "t:2:40: error: " + key},
      {"x = \"\"\"\n\"\"\"\n" + many + " = 1", "t:3:32: error: " + key},
      {"x = \"a\\\"#[\"\n" + many + " = 1", "t:2:32: error: " + key},
      {"x = " + deep, "t:1:21: error: brackets are nested deeper than 16"},
      {"x = {a = " + deep, "t:1:25: error: brackets are nested deeper than 16"},
      {"[" + parts(15) + "]\n" + parts(15) + " = 1", "t:2:3: error: nested deeper than 16 levels"},
  };
  for (const auto& [text, message] : cases) {
    const auto tree = toml::parse_toml(text, "t", {});
    ASSERT_FALSE(tree) << text.substr(0, 60);
    EXPECT_EQ(tree.error().text(), message) << text.substr(0, 60);
  }
  EXPECT_EQ(machines::read_machine_text(many + " = 1", "m.toml").errors.front().text(), "m.toml:1:32: error: " + key);
  EXPECT_EQ(machines::read_shaper_machine_text(many + " = 1", "m.toml", {}).errors.front().text(),
            "m.toml:1:32: error: " + key);
}

TEST(TomlDepth, StringsAndNumbersAreNoNesting) {
  const std::string noise = std::string(100, '[') + parts(100) + std::string(100, '{');
  for (const std::string& text :
       {"x = \"" + noise + "\"\ny = 1", "x = '" + noise + "\\'\ny = 1", "x = 1 # " + noise + "\ny = 1",
        "x = \"\"\"\n" + noise + "\n\\\"\"\" " + noise + "\"\"\"\ny = 1", "x = '''\n'" + noise + "\\\n''''\ny = 1",
        "x = \"\"\"a\\\n\n  b" + noise + "\"\"\"\"\"\ny = 1", std::string("x = [1.5, 2.5,\n 1.5]\ny = 1"),
        "[" + parts(15) + "]\ny = 1"}) {
    const auto tree = toml::parse_toml(text, "t", {});
    EXPECT_TRUE(tree) << text.substr(0, 30) << (tree ? "" : tree.error().text().substr(0, 100));
  }
}

// What is missing are the quotes; no word of what else might have begun with such a letter.
TEST(TomlText, AWordWithoutQuotesIsTold) {
  const std::pair<std::string, std::string> cases[] = {
      {"[gear]\ntype = face_gear\n", "t:2:8: error: face_gear is text and stands in quotes: \"face_gear\""},
      {"a = t600s.toml  # the machine", "t:1:5: error: t600s.toml is text and stands in quotes: \"t600s.toml\""},
      {"a = 1\r\nb=inner-radius\r\n", "t:2:3: error: inner-radius is text and stands in quotes: \"inner-radius\""},
      {"a = Yes", "t:1:5: error: Yes is text and stands in quotes: \"Yes\""},
      {"a = True", "t:1:5: error: True is text and stands in quotes: \"True\""},
      {"a = truth", "t:1:5: error: truth is text and stands in quotes: \"truth\""},
      {"a = infinite", "t:1:5: error: infinite is text and stands in quotes: \"infinite\""},
  };
  for (const auto& [text, message] : cases) {
    const auto tree = toml::parse_toml(text, "t", {});
    ASSERT_FALSE(tree) << text;
    EXPECT_EQ(tree.error().text(), message);
  }
  for (const std::string text : {"a = \"x", "a = 1.2.3", "a = [b]", "a = ", "a == b", "a b = c", "\"=\" = 1 x",
                                 "a = true\na = true", "a = 1\na = nan", "a = true x"}) {
    const auto tree = toml::parse_toml(text, "t", {});
    ASSERT_FALSE(tree) << text;
    EXPECT_EQ(tree.error().text().find("stands in quotes"), std::string::npos) << tree.error().text();
  }
}

// Decimal commas and units, in the words of who wrote them; what is no such number keeps the message of the library.
TEST(TomlText, ADecimalCommaOrAUnitIsTold) {
  const std::pair<std::string, std::string> cases[] = {
      {"[gear]\nmodule = 2,5\n", "t:2:10: error: 2,5 has a decimal comma; write a decimal point: 2.5"},
      {"a = -0,25  # offset", "t:1:5: error: -0,25 has a decimal comma; write a decimal point: -0.25"},
      {"a = 2 mm", "t:1:5: error: 2 mm has a unit; write the number alone, in the unit of the key"},
      {"a = 0.002mm # fine", "t:1:5: error: 0.002mm has a unit; write the number alone, in the unit of the key"},
      {"a = 2,5 mm", "t:1:5: error: 2,5 mm has a unit; write the number alone, in the unit of the key"},
      {"a = 20\u00b0", "t:1:5: error: 20\u00b0 has a unit; write the number alone, in the unit of the key"},
      {"a = 20 %", "t:1:5: error: 20 % has a unit; write the number alone, in the unit of the key"},
  };
  for (const auto& [text, message] : cases) {
    const auto tree = toml::parse_toml(text, "t", {});
    ASSERT_FALSE(tree) << text;
    EXPECT_EQ(tree.error().text(), message);
  }
  for (const std::string text : {"a = 1.2.3", "a = 1,2,3", "a = 1.234,5", "a = 1, b", "a = [1,5 2]", "a = 1 2",
                                 "a = ,5 x", "a = 1,", "a = 1 b = 2", "a = 0xg", "a = 0b2", "a = 1_", "a = 1 \"mm\""}) {
    const auto tree = toml::parse_toml(text, "t", {});
    ASSERT_FALSE(tree) << text;
    EXPECT_EQ(tree.error().text().find("decimal comma"), std::string::npos) << tree.error().text();
    EXPECT_EQ(tree.error().text().find("has a unit"), std::string::npos) << tree.error().text();
  }
}

TEST(TomlText, AnotherKindOfFileIsTold) {
  const auto message = [](const std::string& text) {
    const auto tree = toml::parse_toml(text, "t", {});
    return tree ? std::string("read") : tree.error().text();
  };
  EXPECT_EQ(message(std::string("\xff\xfe"
                                "a\0=\0",
                                6)),
            "t:1:1: error: this text is UTF-16; save it as UTF-8");
  EXPECT_EQ(message(std::string("\xfe\xff\0a", 4)), "t:1:1: error: this text is UTF-16; save it as UTF-8");
  for (const char* text : {"%\nO1001 (PART)\n", "(JOB PART)\nG21\n", ";JOB\nG17 G40\n", "0 BEGIN PGM PART MM\n",
                           "\nG21 G90\n", "N10 G0 X1\n", "PARTNO / PART\n"})
    EXPECT_NE(message(text).find("error: this begins as an NC program"), std::string::npos) << text << message(text);
  EXPECT_EQ(message("G1 = 2").find("NC program"), std::string::npos);
  EXPECT_EQ(message("gear 2").find("NC program"), std::string::npos);
}

class BadMachineFile : public testing::TestWithParam<test::BadFile> {};

TEST_P(BadMachineFile, IsRefusedWithItsPlace) {
  EXPECT_EQ(messages(replaced(kMachine, GetParam().from, GetParam().to)), std::string(GetParam().messages));
}

INSTANTIATE_TEST_SUITE_P(Checklist, BadMachineFile, testing::ValuesIn(test::kBadMachineFiles), [](const auto& place) {
  std::string name = "_";
  for (const char* c = place.param.what; *c; ++c) name += std::isalnum(static_cast<unsigned char>(*c)) ? *c : '_';
  return name;
});

TEST(MachineFile, Bodies) {
  for (const test::Bodies& bodies : test::kBodies)
    EXPECT_EQ(messages(test::machine_with(bodies)), bodies.messages) << bodies.what;
  const auto read = machines::read_machine_text(test::machine_with(test::kBodies[0]), "m.toml");
  ASSERT_TRUE(read.machine);
  ASSERT_EQ(read.machine->bodies.size(), 3u);
  const auto& [table, cradle, nose] =
      std::tie(read.machine->bodies[0], read.machine->bodies[1], read.machine->bodies[2]);
  EXPECT_EQ(table.link, 0u);
  EXPECT_EQ(cradle.link, 1u);
  EXPECT_EQ(nose.link, 5u);
  EXPECT_EQ(std::get<machines::ConeShape>(table.shape).radius_to, 200);
  EXPECT_EQ(std::get<machines::BoxShape>(cradle.shape).high, Vec3(1, 2, 3));
  EXPECT_EQ(std::get<machines::ConeShape>(nose.shape).radius_from, 0);
  EXPECT_EQ(cradle.touches, std::vector<std::string>{"table"});
  EXPECT_EQ(read.machine->where(nose.key + ".to").line, 70);
  const auto guessed = machines::read_machine_text(
      test::replaced(test::machine_with(test::kBodies[0]), "assumed = false", "assumed = [\"body\"]"), "m.toml");
  ASSERT_TRUE(guessed.machine);
  EXPECT_TRUE(guessed.machine->assumed);
}

TEST(MachineFile, TopUnderAPlace) {
  machines::Machine m;
  const auto add = [&](std::size_t link, auto shape) { m.bodies.push_back({"", link, shape, {}, ""}); };
  EXPECT_FALSE(m.top_under(Vec3(0, 0, 100)));
  add(0, machines::BoxShape{Vec3(-50, -50, -20), Vec3(50, 50, 0)});
  add(0, machines::ConeShape{Vec3(0, 0, 0), Vec3(0, 0, 12), 30, 20});
  add(0, machines::BoxShape{Vec3(60, -50, -20), Vec3(80, 50, 90)});      // a wall beside it
  add(1, machines::BoxShape{Vec3(-50, -50, 20), Vec3(50, 50, 40)});      // what carries no work
  add(0, machines::ConeShape{Vec3(-90, 0, 60), Vec3(90, 0, 60), 5, 5});  // lies
  EXPECT_EQ(m.top_under(Vec3(0, 0, 100)).value_or(-1), 12);
  EXPECT_EQ(m.top_under(Vec3(40, 0, 100)).value_or(-1), 0);
  EXPECT_EQ(m.top_under(Vec3(0, 0, 11)).value_or(-1), 0);
  EXPECT_EQ(m.top_under(Vec3(70, 0, 100)).value_or(-1), 90);
  EXPECT_FALSE(m.top_under(Vec3(200, 0, 100)));
}

TEST(MachineFile, OrderOfTheChain) {
  for (const test::Order& order : test::kOrders)
    EXPECT_EQ(messages(test::machine_ordered(order.order)), order.messages) << order.order;
}

// Which controls there are, and what they take, is the business of whoever judges the file: asked with what could be
// read, his complaints stand in their place among those of the reader.
TEST(MachineFile, AJudgeIsAskedAboutTheControl) {
  const machines::MachineJudge judge = [](const machines::Machine& m) {
    EXPECT_EQ(m.dialect, "any");
    return std::vector{fail_at(m.where("dialect"), "no"), fail_at(m.where("axes.C.max"), "too far")};
  };
  const std::string text = replaced(kMachine, "\"linuxcnc\"", "\"any\"");
  EXPECT_EQ(messages(text), "");
  EXPECT_EQ(to_text(machines::read_machine_text(text, "m.toml", judge).errors),
            "m.toml:4:11: error: no\nm.toml:49:7: error: too far\n");
  EXPECT_EQ(
      to_text(
          machines::read_machine_text(replaced(text, "max_speed = 24000", "max_speed = 0"), "m.toml", judge).errors),
      "m.toml:4:11: error: no\nm.toml:10:13: error: spindle.max_speed = 0 must be above 0 1/min\nm.toml:49:7: error: "
      "too far\n");
}

TEST(MachineFile, NulByteIsNoText) {
  std::string text = kMachine;
  text[text.find("five_axis")] = '\0';
  EXPECT_EQ(messages(text), "m.toml:3:9: error: NUL byte; this is not a text file\n");
}

TEST(MachineFile, EmptyFileLacksEveryRequiredKey) {
  const auto reading = machines::read_machine_text("", "m.toml");
  ASSERT_EQ(reading.errors.size(), 11u) << to_text(reading.errors);
  EXPECT_EQ(reading.errors.front().text(), "m.toml:1:1: error: schema is missing");
}

// 78: a head axis 0.25 above the nose is one given in metres.
TEST(MachineFile, PivotInMetres) {
  std::string text = replaced(kMachine, "table = [\"C\", \"A\"]\nhead = []", "table = [\"C\"]\nhead = [\"A\"]");
  text = replaced(text, "point = [0.0, 0.0, -285.0]", "pivot_length = 0.25");
  EXPECT_EQ(messages(text),
            "m.toml:38:16: error: axes.A.pivot_length = 0.25 mm is below 1 mm; lengths are in mm, not metres\n");
  const auto good = machines::read_machine_text(replaced(text, "0.25", "250"), "m.toml");
  ASSERT_TRUE(good.machine);
  EXPECT_EQ(good.machine->chain.head.at(0).pivot_length_mm(), 250);
}

// An axis that stands 0.4 mm off is a measured one wherever another length shows that the file is in mm: a pivot, or
// travels that do not reach where the axis would stand in metres. Where nothing shows it, the message tells the way
// out.
TEST(MachineFile, AnAxisAFewTenthsOff) {
  const auto off = [](const std::string& text, const char* point) {
    return replaced(text, "point = [0.0, 0.0, 0.0]", std::string("point = ") + point);
  };
  std::string head = replaced(kMachine, "table = [\"C\", \"A\"]\nhead = []", "table = [\"C\"]\nhead = [\"A\"]");
  head = replaced(head, "point = [0.0, 0.0, -285.0]", "pivot_length = 165.0");
  EXPECT_EQ(messages(off(head, "[0.18, -0.4, 0.0]")), "");
  EXPECT_EQ(messages(off(kMachine, "[0.18, -0.4, 0.0]")), "");  // A stands 285 mm below
  const std::string flat = replaced(kMachine, "point = [0.0, 0.0, -285.0]", "point = [0.0, 0.05, 0.0]");
  EXPECT_EQ(messages(off(flat, "[0.0, 0.41, 0.0]")), "");  // at 410 mm of Y: beyond its travel
  EXPECT_EQ(messages(off(flat, "[0.2, 0.0, 0.0]")),
            "m.toml:46:9: error: axes.C.point = [0.2, 0, 0]: the largest offset of the rotary axes, 0.2 mm, is below 1 "
            "mm; lengths are in mm, not metres. If it is in mm, name another point of that axis: [0.2, 0, 100]\n");
  EXPECT_EQ(messages(off(flat, "[0.2, 0.0, 100.0]")), "");
}

TEST(MachineFile, FaceOfTheTable) {
  machines::Machine m = *machines::read_machine_text(kMachine, "m.toml").machine;
  EXPECT_EQ(m.table_middle_mm(), Vec3(0, 0, 0));
  m = *machines::read_machine_text(
           replaced(kMachine, "table_diameter = 500", "table_diameter = 500\ntable_face = -85.5"), "m.toml")
           .machine;
  EXPECT_EQ(m.table_middle_mm(), Vec3(0, 0, -85.5));
  m.chain.table[0].direction = Vec3(0, 0.6, 0.8);  // leans: where it comes through the face
  m.chain.table[0].point_mm = Vec3(1, 2, -5.5);
  EXPECT_LT((m.table_middle_mm() - Vec3(1, 2 - 60, -85.5)).norm(), 1e-12);
  EXPECT_EQ(messages(replaced(kMachine, "table_diameter = 500", "table_diameter = 500\ntable_face = nan")),
            "m.toml:15:14: error: limits.table_face = nan must be finite\n");
}

// The file of a shaper is refused as such, not for the keys that it cannot have.
TEST(MachineFile, KindDecidesBeforeTheKeys) {
  const std::string data = TOOTHPATH_SOURCE_DIR "/machines/data/";
  const auto shaper = machines::read_machine_file(data + "y514.toml");
  ASSERT_EQ(shaper.errors.size(), 1u);
  EXPECT_EQ(shaper.errors[0].message, "kind = \"gear_shaper\" is no milling machine; \"five_axis\" is needed here");
  const auto mill = machines::read_shaper_machine_file(data + "t600s.toml", {{"linuxcnc"}});
  ASSERT_EQ(mill.errors.size(), 1u);
  EXPECT_EQ(mill.errors[0].message, "kind = \"five_axis\" is no gear shaper; \"gear_shaper\" is needed here");
}

TEST(MachineFile, EveryComplaintIsCollected) {
  std::string text = replaced(kMachine, "sign = 1\nmin = -110.0", "sign = 0\nmin = nan");
  text = replaced(text, "max_speed = 24000", "max_sped = 24000");
  EXPECT_EQ(messages(text),
            "m.toml:9:1: error: spindle.max_speed is missing\n"
            "m.toml:10:1: error: unknown key spindle.max_sped; did you mean max_speed?\n"
            "m.toml:39:8: error: axes.A.sign = 0 must be 1 or -1\n"
            "m.toml:40:7: error: axes.A.min = nan must be finite\n");
}

TEST(MachineFile, AssumedMayBeAListOfKeysOrTables) {
  const auto reading = machines::read_machine_text(
      replaced(kMachine, "assumed = false", "assumed = [\"axes.A.point\", \"limits\"]"), "m");
  ASSERT_TRUE(reading.machine) << to_text(reading.errors);
  EXPECT_TRUE(reading.machine->assumed);
  EXPECT_EQ(reading.machine->assumed_keys, (std::vector<std::string>{"axes.A.point", "limits"}));
  const auto none = machines::read_machine_text(replaced(kMachine, "assumed = false", "assumed = []"), "m");
  EXPECT_FALSE(none.machine->assumed);
}

TEST(MachineFile, DirectionsAreNormalised) {
  const auto reading =
      machines::read_machine_text(replaced(kMachine, "direction = [1.0, 0.0, 0.0]", "direction = [0, 3, 3]"), "m");
  ASSERT_TRUE(reading.machine) << to_text(reading.errors);
  EXPECT_LE((reading.machine->chain.table[1].direction - Vec3(0, 1, 1).normalized()).norm(), 1e-15);
}

TEST(MachineFile, FilesThatCannotBeRead) {
  const TestDir dir;
  const auto error_of = [](const std::string& path) {
    const auto reading = machines::read_machine_file(path);
    EXPECT_EQ(reading.errors.size(), 1u);
    EXPECT_EQ(reading.errors[0].kind, DiagnosticKind::file_access);
    return reading.errors[0].message;
  };
  EXPECT_EQ(error_of(dir / "none.toml"), "file does not exist");
  EXPECT_EQ(error_of(dir.path()), "is a directory, not a file");
  EXPECT_EQ(error_of("/dev/zero"), "is not a regular file");
  fs::create_symlink(dir / "loop.toml", dir / "loop.toml");
  EXPECT_EQ(error_of(dir / "loop.toml").substr(0, 17), "cannot be opened:");
}

TEST(MachineFile, OneAboveItsLargestSizeIsRefused) {
  const TestDir dir;
  std::ofstream(dir / "big.toml") << std::string(kMaxBytesForTest + 1, '#');
  const auto reading = machines::read_machine_file(dir / "big.toml");
  ASSERT_EQ(reading.errors.size(), 1u);
  EXPECT_EQ(reading.errors[0].kind, DiagnosticKind::refused_input);
  EXPECT_EQ(reading.errors[0].text(), (dir / "big.toml") + ": error: is longer than 1048576 bytes");
}

TEST(MachineFile, BytesOfTheFileCannotReachTheTerminal) {
  EXPECT_EQ(messages(replaced(kMachine, "max_speed = 24000", "max_speed = 24000\n\"a\\u001b[2Jb\\nc\\u0000d\" = 1")),
            "m.toml:11:1: error: unknown key spindle.a\\x1B[2Jb\\nc\\x00d\n");
  EXPECT_EQ(messages(replaced(kMachine, "\"example\"", "\"a\\u009bb\"")),
            "m.toml:2:8: error: name = \"a\\u{009B}b\" contains a character that is no printable text\n");
}

// Any bytes give a machine or complaints: damaged copies of the example, one to six random bytes each.
TEST(MachineFile, DamagedFilesNeverCrash) {
  std::mt19937_64 rng(12);
  const std::string good = kMachine;
  int refused = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::string text = damaged(good, rng, 1 + i % 6, "0123456789.-=[]\"\n");
    const auto reading = machines::read_machine_text(text, "m.toml");
    ASSERT_EQ(reading.machine.has_value(), reading.errors.empty());
    for (const Diagnostic& d : reading.errors) ASSERT_FALSE(d.message.empty());
    refused += !reading.errors.empty();
    (void)machines::read_shaper_machine_text(
        text, "m.toml",
        {{"linuxcnc"}, {"fanuc", machines::ShaperGears::pulses}, {"siemens", machines::ShaperGears::named_axes}});
  }
  EXPECT_GT(refused, 2000);
}

TEST(FindMachineFile, BesideTheJobFirstThenInstalled) {
  const TestDir dir;
  const auto installed = machines::find_machine_file("t600s.toml", dir.path());
  ASSERT_TRUE(installed) << installed.error().message;
  EXPECT_TRUE(fs::equivalent(*installed, TOOTHPATH_SOURCE_DIR "/machines/data/t600s.toml"));
  const auto in_folder = machines::find_machine_file("machines/xyzac_large.toml", dir.path());
  ASSERT_TRUE(in_folder);
  EXPECT_TRUE(fs::equivalent(*in_folder, TOOTHPATH_SOURCE_DIR "/machines/data/xyzac_large.toml"));
  std::ofstream(dir / "t600s.toml") << "schema = 1\n";
  const auto beside = machines::find_machine_file("t600s.toml", dir.path());
  ASSERT_TRUE(beside);
  EXPECT_TRUE(fs::equivalent(*beside, dir / "t600s.toml"));
  const auto beside_plain = machines::find_machine_file("t600s", dir.path());
  ASSERT_TRUE(beside_plain);
  EXPECT_TRUE(fs::equivalent(*beside_plain, dir / "t600s.toml"));
  const auto not_the_job = machines::find_machine_file("t600s.toml", dir.path(), dir / "t600s.toml");
  ASSERT_TRUE(not_the_job);
  EXPECT_TRUE(fs::equivalent(*not_the_job, TOOTHPATH_SOURCE_DIR "/machines/data/t600s.toml"));
  const auto none = machines::find_machine_file("no_such.toml", dir.path());
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, DiagnosticKind::file_access);
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(fs::path(TOOTHPATH_SOURCE_DIR) / "machines" / "data"))
    files.push_back(entry.path().filename().string());
  std::sort(files.begin(), files.end());
  std::string list;
  for (const auto& file : files) list += (list.empty() ? "" : ", ") + file;
  EXPECT_EQ(list.find("apt_free.toml, fanuc_ac.toml, "), 0u);
  EXPECT_EQ(none.error().message,
            "machine file \"no_such.toml\" is neither beside the job nor installed; installed are: " + list);
  // A folder of that name, such as the results of a job named like its machine, hides no installed machine.
  fs::create_directory(dir / "fanuc_ac");
  const auto past_a_folder = machines::find_machine_file("fanuc_ac", dir.path());
  ASSERT_TRUE(past_a_folder) << past_a_folder.error().message;
  EXPECT_TRUE(fs::equivalent(*past_a_folder, TOOTHPATH_SOURCE_DIR "/machines/data/fanuc_ac.toml"));
  fs::create_directory(dir / "alone");
  EXPECT_TRUE(fs::equivalent(machines::find_machine_file("alone", dir.path()).value(), dir / "alone"));
  // A job of that name says what it is.
  std::ofstream(dir / "haas_ac.toml") << "schema = 1\n[gear]\ntype = \"face_gear\"\n";
  const auto job = machines::open_machine_file(machines::find_machine_file("haas_ac", dir.path()).value());
  ASSERT_FALSE(job);
  EXPECT_EQ(job.error().message, "[gear]: this is a job file, a machine file is needed here");
  EXPECT_EQ(job.error().position.line, 2);
  // The ending may be left out, and a misspelt name brings the near one.
  const auto plain = machines::find_machine_file("xyzac_trt", dir.path());
  ASSERT_TRUE(plain) << plain.error().message;
  EXPECT_TRUE(fs::equivalent(*plain, TOOTHPATH_SOURCE_DIR "/machines/data/xyzac_trt.toml"));
  for (const auto& [wrong, meant] : {std::pair{"t600.toml", "t600s.toml"}, {"fanuc_ca", "fanuc_ac.toml"}}) {
    const auto refused = machines::find_machine_file(wrong, dir.path());
    ASSERT_FALSE(refused) << wrong;
    EXPECT_NE(refused.error().message.find(std::string("installed; did you mean \"") + meant +
                                           "\"?; installed are: apt_free.toml,"),
              std::string::npos)
        << refused.error().message;
  }
  EXPECT_FALSE(machines::find_machine_file("../data/t600s.toml", dir.path()));  // installed files have plain names
}

}  // namespace
}  // namespace toothpath
