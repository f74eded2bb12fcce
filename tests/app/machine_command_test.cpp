// What `machine show` says of the senses is what the kinematics do; every shipped machine is shown, wrong files are
// refused.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/report/sheet/machine_sheet.h"
#include "machines/machine_file.h"
#include "tests/app/program.h"

namespace toothpath::test {
namespace {

const std::vector<std::string> kShipped = {"t600s.toml",     "xyzac_large.toml",   "xyzac_trt.toml",
                                           "xyzbc_trt.toml", "head_table_bc.toml", "head_head_ca.toml",
                                           "fanuc_ac.toml",  "siemens_ac.toml",    "heidenhain_ac.toml"};

machines::Machine shipped(const std::string& name) {
  return *machines::read_machine_file(machines::find_machine_file(name, ".").value()).machine;
}

// The words of the table against the motion of a point: 1 degree more of one axis, all others at zero.
TEST(MachineShow, SensesAreThoseOfTheKinematics) {
  int tables = 0, heads = 0;
  for (const auto& name : kShipped) {
    const machines::Machine m = shipped(name);
    for (std::size_t k = 0; k < m.chain.rotary_count(); ++k) {
      const std::string said = sheet::positive_turn(m.chain, k);
      const machines::RotaryAxis& axis = m.chain.rotary(k);
      machines::Joints zero;
      for (std::size_t j = 0; j < m.chain.rotary_count(); ++j) zero.rotary_rad[j] = m.chain.rotary(j).zero_rad;
      machines::Joints turned = zero;
      turned.rotary_rad[k] += radians(1);
      if (m.chain.in_table(k)) {
        ++tables;
        const auto moved = [&](const Vec3& arm) {
          const Vec3 p = axis.point_mm + 100 * arm;
          return Vec3(m.chain.table_to_machine(p, turned.rotary_rad) - m.chain.table_to_machine(p, zero.rotary_rad));
        };
        const struct {
          const char* words;
          double motion;
        } senses[] = {{"Y+ side up", moved(Vec3::UnitY()).z()},
                      {"Y+ side down", -moved(Vec3::UnitY()).z()},
                      {"X+ side up", moved(Vec3::UnitX()).z()},
                      {"X+ side down", -moved(Vec3::UnitX()).z()},
                      {"table counter-clockwise", moved(Vec3::UnitX()).y()},
                      {"table clockwise", -moved(Vec3::UnitX()).y()}};
        int matched = 0;
        for (const auto& sense : senses) {
          if (said.find(sense.words) == std::string::npos) continue;
          ++matched;
          EXPECT_GT(sense.motion, 1) << name << axis.letter << said;
        }
        EXPECT_EQ(matched, 1) << said;
      } else {
        ++heads;
        if (said.find("clockwise") != std::string::npos) {
          Vec3 x = axis.rotation(turned.rotary_rad[k]) * Vec3::UnitX();
          EXPECT_EQ(x.y() > 0, said.find("counter-clockwise") != std::string::npos) << name << axis.letter;
          continue;
        }
        const Vec3 moved = m.chain.forward(turned, 100).tip_mm - m.chain.forward(zero, 100).tip_mm;
        const char to = said[said.size() - 2];
        ASSERT_TRUE(to == 'X' || to == 'Y') << said;
        EXPECT_GT((said.back() == '+' ? 1 : -1) * moved[to - 'X'], 1) << name << axis.letter << said;
      }
    }
  }
  EXPECT_GE(tables, 8);
  EXPECT_GE(heads, 3);
}

TEST(MachineShow, EveryAssumedKeyIsNamed) {
  for (const auto& name : kShipped) {
    const machines::Machine m = shipped(name);
    const std::string text = sheet::machine_text(m);
    EXPECT_NE(text.find(m.assumed_keys.empty() ? "No value is assumed"
                                               : std::to_string(m.assumed_keys.size()) + " values are assumed"),
              std::string::npos);
    for (const auto& key : m.assumed_keys)
      EXPECT_NE(text.find(key.substr(key.rfind('.') + 1)), std::string::npos) << key;
  }
}

TEST(MachineShow, WritesPageAndDrawingOnlyWhereAsked) {
  const TestDir dir;
  const Finished plain = run_program({"machine", "show", "t600s.toml"});
  EXPECT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_NE(plain.out.find("work - C - A - X Y - bed - Z - spindle - tool"), std::string::npos);
  const Finished both = run_program({"machine", "show", "t600s.toml", "--out", dir / "m"});
  EXPECT_EQ(both.exit_code, 0) << both.err;
  EXPECT_EQ(names_in(dir / "m"), (std::vector<std::string>{"machine.html", "machine.svg"}));
  EXPECT_EQ(run_program({"machine", "show", "y514.toml"}).exit_code, 0);
  EXPECT_EQ(run_program({"machine"}).exit_code, 2);
  const Finished none = run_program({"machine", "show", "no_such_machine.toml", "--out", dir / "n"});
  EXPECT_EQ(none.exit_code, 4);
  EXPECT_NE(none.err.find("no_such_machine.toml"), std::string::npos);
  const Finished job = run_program({"machine", "show", kSamples + "/spur_quick.toml"});
  EXPECT_EQ(job.exit_code, 3) << job.err;
}

TEST(MachineShow, TellsTheBodies) {
  const Finished run = run_program({"machine", "show", "t600s", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto bodies = nlohmann::json::parse(run.out)["report"]["bodies"];
  ASSERT_EQ(bodies.size(), shipped("t600s.toml").bodies.size());
  EXPECT_EQ(bodies[0]["name"], "plate");
  EXPECT_EQ(bodies[0]["on"], "C");
  EXPECT_NEAR(bodies[0]["high"][2].get<double>(), -305, 1e-6);
  EXPECT_NEAR(bodies[0]["low"][0].get<double>(), -85, 1e-6);
  EXPECT_NEAR(bodies[0]["low"][2].get<double>(), -325, 1e-6);
  const std::string text = run_program({"machine", "show", "t600s"}).out;
  EXPECT_NE(text.find("cylinder dia 170"), std::string::npos) << text;
  EXPECT_NE(text.find("35 x 120 x 115"), std::string::npos) << text;  // an arm of the cradle
  const Finished bare = run_program({"machine", "show", "xyzac_large"});
  EXPECT_NE(bare.out.find("No bodies are stated"), std::string::npos);
}

TEST(MachineShow, OpensTheMeshesOfBodies) {
  const TestDir dir;
  const std::string machine = file_text(machines::find_machine_file("xyzac_large", ".").value());
  write_file(dir / "m.toml",
             machine + "\n[[body]]\nname = \"arm\"\nof = \"A\"\nshape = \"mesh\"\nfile = \"arm.obj\"\n");
  const auto show = [&] { return run_program({"machine", "show", dir / "m.toml"}); };
  const std::string at =
      fmt::format("m.toml:{}:8: error: body \"arm\": ", 2 + std::count(machine.begin(), machine.end(), '\n') + 4);
  const Finished missing = show();
  EXPECT_EQ(missing.exit_code, 4);
  EXPECT_NE(missing.err.find(at), std::string::npos) << missing.err;
  const std::string corners = "v 0 0 0\nv 30 0 0\nv 0 20 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";
  write_file(dir / "arm.obj", corners);
  const Finished open = show();
  EXPECT_EQ(open.exit_code, 3);
  EXPECT_NE(open.err.find(at), std::string::npos) << open.err;
  write_file(dir / "arm.obj", corners + "f 2 3 4\n");
  const Finished good = show();
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_NE(good.out.find("30 x 20 x 10"), std::string::npos) << good.out;
  EXPECT_NE(good.out.find("mesh arm.obj"), std::string::npos) << good.out;
}

TEST(MachineList, EveryInstalledMachineHasItsLine) {
  const Finished run = run_program({"machine", "list"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(static_cast<std::size_t>(std::count(run.out.begin(), run.out.end(), '\n')),
            machines::installed_machines().size() + 1)
      << run.out;
  for (const auto& name : kShipped) {
    const machines::Machine m = shipped(name);
    const auto at = run.out.find(name);
    ASSERT_NE(at, std::string::npos) << name;
    const std::string line = run.out.substr(at, run.out.find('\n', at) - at);
    for (const std::string& word :
         {m.name, m.dialect, m.assumed_keys.empty() ? std::string("-") : std::to_string(m.assumed_keys.size())})
      EXPECT_NE(line.find(word), std::string::npos) << line;
  }
  const auto json = nlohmann::json::parse(run_program({"machine", "list", "--json"}).out);
  EXPECT_EQ(json["command"], "machine list");
  EXPECT_EQ(json["report"]["machines"].size(), machines::installed_machines().size());
  EXPECT_EQ(run_program({"machine", "show", "t600s"}).exit_code, 0) << "without its ending";
  EXPECT_NE(run_program({"machine", "show", "t600"}).err.find("did you mean \"t600s.toml\"?"), std::string::npos);
}

TEST(MachineTest, WritesAProvenProgramForEveryShippedMachine) {
  for (const auto& name : kShipped) {
    const TestDir dir;
    const Finished run = run_program({"machine", "test", name, "--out", dir / "t"});
    ASSERT_EQ(run.exit_code, 0) << name << run.err;
    const auto files = names_in(dir / "t");
    const bool tcp = shipped(name).tcp != machines::TcpMode::none;
    ASSERT_EQ(files.size(), tcp ? 3u : 2u) << name;
    EXPECT_TRUE(files[0].starts_with("machine_test.")) << files[0];
    EXPECT_TRUE(files[1].starts_with("machine_test.")) << files[1];
    if (tcp) { EXPECT_TRUE(files[2].starts_with("machine_test_tcp.")) << files[2]; }
    EXPECT_NE(run.out.find("read back"), std::string::npos);
    std::string all;
    for (const auto& file : files) all += file_text(dir / ("t/" + file));
    if (!shipped(name).assumed_keys.empty()) { EXPECT_NE(all.find("ASSUMED"), std::string::npos) << name; }
  }
}

// The sheet says what is proven, from which error on, and what is left to the eye.
TEST(MachineTest, TheSheetSaysWhatIsProven) {
  const TestDir dir;
  const Finished run = run_program({"machine", "test", "fanuc_ac.toml", "--out", dir / "t"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("machine_test.nc: TCP off, proves the machine file"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("machine_test_tcp.nc: TCP on, proves the data of the control"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("place of A from 0.0"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("not seen: zero of C"), std::string::npos) << run.out;
  const std::string page = file_text(dir / "t/machine_test.html");
  for (const char* said : {"machine_test.nc proves the machine file. TCP is off", "Only the eye proves the rest",
                           "machine_test_tcp.nc proves the data of the control, not the machine file", "dial Z mm",
                           "place of C, from mm", "sense of A, mm"})
    EXPECT_NE(page.find(said), std::string::npos) << said;
  EXPECT_EQ(file_text(dir / "t/machine_test.nc").find("G43.4"), std::string::npos);
  EXPECT_NE(file_text(dir / "t/machine_test_tcp.nc").find("G43.4"), std::string::npos);
}

// Cutter locations have no axes: the machine file is refused where it says so, before anything is touched.
TEST(MachineTest, AptHasNothingToTest) {
  const TestDir dir;
  const Finished run = run_program({"machine", "test", "apt_free.toml", "--out", dir / "t"});
  EXPECT_EQ(run.exit_code, 3) << run.out;
  EXPECT_NE(run.err.find("apt_free.toml:7:"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("has places of the tool and no axes"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(dir / "t"));
}

// A page that stands there stays until there is a new one, and the refusal says what stands there.
TEST(MachineShow, RefusalsLeaveTheOldFiles) {
  const TestDir dir;
  const std::string machine = dir / "m.toml",
                    good = file_text(machines::find_machine_file("xyzac_trt.toml", ".").value());
  write_file(machine, good);
  ASSERT_EQ(run_program({"machine", "show", machine, "--out", dir / "out"}).exit_code, 0);
  const std::string page = file_text(dir / "out/machine.html");
  write_file(machine, good + "\nspeed = 1\n");
  for (const auto& [file, code] : {std::pair{machine, 3}, {std::string("no_such_machine.toml"), 4}}) {
    const Finished refused = run_program({"machine", "show", file, "--out", dir / "out"});
    EXPECT_EQ(refused.exit_code, code);
    EXPECT_NE(refused.err.find("stays as it was: machine.html of 20"), std::string::npos) << refused.err;
    EXPECT_EQ(names_in(dir / "out"), (std::vector<std::string>{"machine.html", "machine.svg"}));
    EXPECT_EQ(file_text(dir / "out/machine.html"), page);
  }
}

TEST(MachineTest, NoProgramThatIsNotProven) {
  const TestDir dir;
  const Finished shaper = run_program({"machine", "test", "y514.toml", "--out", dir / "t"});
  EXPECT_EQ(shaper.exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(dir / "t"));
  EXPECT_EQ(run_program({"machine", "test", "t600s.toml", "--out", dir / "u"}).exit_code, 0);
  const auto files = names_in(dir / "u");
  EXPECT_EQ(run_program({"machine", "test", "no_such_machine.toml", "--out", dir / "u"}).exit_code, 4);
  EXPECT_EQ(names_in(dir / "u"), files) << "refused before anything was planned";
  const Finished length = run_program({"machine", "test", "t600s.toml", "--tool-length", "2000", "--out", dir / "u"});
  EXPECT_EQ(length.exit_code, 1);
  EXPECT_NE(length.err.find("no point near the table"), std::string::npos) << length.err;
  EXPECT_EQ(names_in(dir / "u"), std::vector<std::string>{"previous_machine_test"});
  EXPECT_EQ(names_in(dir / "u/previous_machine_test"), files);
}

}  // namespace
}  // namespace toothpath::test
