// Every bad machine file of tests/machines through the program, as a user meets it: exit code 3, the exact messages
// with their place, nothing written. `machine show` reads the file by itself; `run` meets it by way of a job.
#include "postproc/controls/registry.h"
#include "tests/app/program.h"
#include "tests/machines/bad_bodies.h"
#include "tests/machines/bad_machine_files.h"
#include "tests/machines/bad_post_keys.h"
#include "tests/machines/example_files.h"

namespace toothpath::test {
namespace {

/// The messages with the path of the file instead of the name that they have in the table.
std::string with_path(std::string messages, const std::string& path) {
  std::string out;
  std::istringstream in(messages);
  for (std::string line; std::getline(in, line);) {
    EXPECT_TRUE(line.starts_with("m.toml:")) << line;
    out += path + line.substr(6) + "\n";
  }
  return out;
}

TEST(BadMachines, ShowRefusesEachWithItsPlace) {
  const TestDir dir;
  const std::string path = dir / "m.toml";
  for (const auto& bad : test::kBadMachineFiles) {
    if (std::string(bad.to) == "\"gear_shaper\"")
      continue;  // `machine show` shows shapers, too: their reader complains of other keys
    write_file(path, replaced(kMachine, bad.from, bad.to));
    const Finished shown = run_program({"machine", "show", path, "--out", dir / "out"});
    EXPECT_EQ(shown.exit_code, 3) << bad.what;
    EXPECT_EQ(shown.err, with_path(bad.messages, path)) << bad.what;
    EXPECT_TRUE(names_in(dir / "out").empty()) << bad.what;
  }
  for (const auto& bad : test::kBadControls) {
    write_file(path, replaced(kMachine, bad.from, bad.to));
    EXPECT_EQ(run_program({"machine", "show", path, "--out", dir / "out"}).err,
              with_path(with_controls(bad.messages, controls::list_of_names()), path))
        << bad.what;
  }
}

TEST(BadMachines, SmoothingAndCornerKeys) {
  const TestDir dir;
  const std::string path = dir / "m.toml";
  for (const PostKeys& keys : kPostKeys) {
    write_file(path, machine_with(keys));
    const Finished shown = run_program({"machine", "show", path, "--out", dir / "out"});
    const bool good = std::string(keys.messages).empty();
    EXPECT_EQ(shown.exit_code, good ? 0 : 3) << keys.what;
    EXPECT_EQ(shown.err, with_path(keys.messages, path)) << keys.what;
    EXPECT_EQ(names_in(dir / "out").empty(), !good) << keys.what;
    std::filesystem::remove_all(dir / "out");
  }
}

TEST(BadMachines, Bodies) {
  const TestDir dir;
  const std::string path = dir / "m.toml";
  for (const Bodies& bodies : kBodies) {
    write_file(path, machine_with(bodies));
    const Finished shown = run_program({"machine", "show", path, "--out", dir / "out"});
    EXPECT_EQ(shown.exit_code, std::string(bodies.messages).empty() ? 0 : 3) << bodies.what;
    EXPECT_EQ(shown.err, with_path(bodies.messages, path)) << bodies.what;
    std::filesystem::remove_all(dir / "out");
  }
}

TEST(BadMachines, RunRefusesThemToo) {
  const TestDir dir;
  const std::string path = dir / "m.toml", job = dir / "job.toml";
  std::string text = file_text(kSamples + "/spur_quick.toml");
  const std::string shipped = "file = \"xyzac_large.toml\"";
  text.replace(text.find(shipped), shipped.size(), "file = \"m.toml\"");
  write_file(job, text);
  int tried = 0;
  for (const auto& bad : test::kBadMachineFiles) {
    const std::string number(bad.what, 2);
    if (number < "69" || number > "78") continue;
    write_file(path, replaced(kMachine, bad.from, bad.to));
    const Finished run = run_program({"run", job, "--out", dir / "out"});
    EXPECT_EQ(run.exit_code, 3) << bad.what;
    EXPECT_EQ(run.err, with_path(bad.messages, path)) << bad.what;
    EXPECT_TRUE(names_in(dir / "out").empty()) << bad.what;
    ++tried;
  }
  EXPECT_GE(tried, 20);
}

}  // namespace
}  // namespace toothpath::test
