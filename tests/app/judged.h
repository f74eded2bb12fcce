// What the judged jobs share: the forms of output that the program has, one random machine for each, a run of the
// program, and its text walked through on that machine, in the frame of the gear.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/commands/run.h"
#include "tests/support/files.h"
#include "tests/support/plain_machine.h"
#include "tests/support/random.h"

namespace toothpath::test {

struct OutputForm {
  const char *control, *tcp;
  bool loop;             ///< teeth as loop or sub-programs
  bool granted = false;  ///< Siemens: TRAORI takes the rotary offset of the frame

  [[nodiscard]] std::string name() const {
    return fmt::format("{}{}{}{}", control, tcp == std::string("none") ? "" : std::string(" ") + tcp,
                       loop ? " loop" : "", granted ? " granted" : "");
  }
};

/// Every form. The first ten, of the face gears of a check, have every control, with and without TCP, with vectors, in
/// loops and written out; the next six are those of the bevel gears.
inline constexpr OutputForm kForms[] = {
    {"linuxcnc", "none", true},        {"mitsubishi_m80", "none", true},  {"siemens", "vectors", true},
    {"heidenhain", "angles", true},    {"apt", "vectors", false},         {"haas", "none", false},
    {"fanuc", "angles", false},        {"fanuc", "none", true},           {"heidenhain", "none", true},
    {"linuxcnc", "angles", false},     {"heidenhain", "vectors", true},   {"siemens", "angles", true},
    {"siemens", "none", true},         {"siemens", "angles", false},      {"linuxcnc", "none", false},
    {"siemens", "vectors", false},     {"heidenhain", "none", false},     {"heidenhain", "angles", false},
    {"heidenhain", "vectors", false},  {"siemens", "none", false},        {"fanuc", "none", false},
    {"mitsubishi_m80", "none", false}, {"siemens", "angles", true, true}, {"linuxcnc", "angles", true}};
/// Those ten, the one that turns a work offset and the one that turns the table of a transformation.
inline std::vector<OutputForm> planted_forms() {
  std::vector<OutputForm> out = {std::begin(kForms), std::begin(kForms) + 10};
  out.push_back(kForms[std::size(kForms) - 1]);
  out.push_back(kForms[std::size(kForms) - 2]);
  return out;
}

inline void replace_once(std::string& text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
}

/// xyzac_large.toml with this control, axes elsewhere and turning either way; for cutter locations the machine that is
/// none.
inline std::string random_machine(const OutputForm& form, Random& random) {
  if (form.control == std::string("apt")) return file_text(TOOTHPATH_SOURCE_DIR "/machines/data/apt_free.toml");
  std::string text = file_text(TOOTHPATH_SOURCE_DIR "/machines/data/xyzac_large.toml");
  replace_once(text, "\"linuxcnc\"", fmt::format("\"{}\"", form.control));
  replace_once(text, "tcp = \"none\"", fmt::format("tcp = \"{}\"", form.tcp));
  replace_once(text, "[0.0, 12.5, -31.25]", fmt::format("[0.0, {:.3f}, {:.3f}]", random(-20, 20), random(-60, 0)));
  replace_once(text, "[3.0, -2.0, 0.0]", fmt::format("[{:.3f}, {:.3f}, 0.0]", random(-9, 9), random(-9, 9)));
  replace_once(text, "min = -110.0\nmax = 60.0", "min = -110.0\nmax = 110.0");
  for (const char* sign : {"sign = -1\nmin = -110", "sign = -1\nmin = -36000"})
    if (random(0, 1) < 0.5) replace_once(text, sign, std::string("sign = 1") + (sign + 9));
  text += fmt::format("\n[post]\nindex_loop = {}\n", form.loop);
  if (form.granted) text += "transformation_takes_rotary_offset = true\n";
  if (form.control == std::string("linuxcnc") && form.tcp != std::string("none"))
    text +=
        std::string("tcp_on = [\"M428\"]\ntcp_off = [\"M429\"]\n") + (form.loop ? "index_offset = \"G59.3\"\n" : "");
  return text;
}

struct JudgedSetup {
  Vec3 origin;
  bool down = false;  ///< gear z points down: turned by half a turn about X
  PlainSetup words;
};

/// A run of the program, and its text on the machine. Without a program only the outcome is there.
struct JudgedRun {
  commands::CommandOutcome outcome;
  nlohmann::json report;
  std::string machine_text, program;
};

inline JudgedRun run_judged(const std::string& job, const OutputForm& form, Random& random) {
  const TestDir dir;
  JudgedRun run;
  run.machine_text = random_machine(form, random);
  write_file(dir / "machine.toml", run.machine_text);
  write_file(dir / "job.toml", job);
  commands::RunRequest request;
  request.job_file = dir / "job.toml";
  request.out_dir = dir / "out";
  request.quiet = true;
  run.outcome = commands::run_job(request);
  if (!run.outcome.report_json.empty()) run.report = nlohmann::json::parse(run.outcome.report_json);
  if (run.outcome.exit_code == app::ExitCode::ok)
    run.program = file_text(dir / ("out/" + run.report["program"]["file"].get<std::string>()));
  return run;
}

/// Motions of a text on its machine, and where the tool is then in the frame of the gear.
class JudgedPath {
 public:
  JudgedPath(const std::string& program, const std::string& machine_text, const JudgedSetup& setup)
      : machine_(machine_text), setup_(setup) {
    NcWalk walk = walk_nc(program, machine_.control());
    if (walk.faults.empty()) moves_ = moves_on(machine_, walk, setup.words);
    if (!walk.ended) walk.faults.push_back("the program does not end");
    faults_ = walk.faults;
  }
  [[nodiscard]] const std::vector<std::string>& faults() const { return faults_; }
  [[nodiscard]] const std::vector<MachineMove>& moves() const { return moves_; }
  [[nodiscard]] ToolPlace at(const MachineMove& move, double t) const {
    ToolPlace p = place_on(machine_, move, setup_.words, t);
    p.tip = in_table(p.tip - setup_.origin);
    p.axis = in_table(p.axis);
    return p;
  }
  /// Directions of the gear frame in that of the table, and back: half a turn or none.
  [[nodiscard]] Vec3 in_table(const Vec3& v) const { return setup_.down ? Vec3(v.x(), -v.y(), -v.z()) : v; }
  [[nodiscard]] const PlainMachine& machine() const { return machine_; }

 private:
  PlainMachine machine_;
  JudgedSetup setup_;
  std::vector<MachineMove> moves_;
  std::vector<std::string> faults_;
};

/// A job of `random_jobs.h` on the machine beside it.
inline std::string on_its_machine(std::string job) {
  replace_once(job, "\"xyzac_large.toml\"\n", "\"machine.toml\"\naccept_assumed = true\n");
  return job;
}

/// As many as a check takes, or as the environment asks for.
inline int jobs_asked(int usual) {
  const char* asked = std::getenv("TOOTHPATH_JUDGED_JOBS");
  return asked ? std::atoi(asked) : usual;
}

}  // namespace toothpath::test
