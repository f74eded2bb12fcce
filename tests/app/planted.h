// A program of one form of output with a small gear, its text edited as somebody might by hand, and what `check` says
// of that; where its tool goes is read by a reader of the tests' own (nc_walk, plain_machine).
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <sstream>

#include "app/job/file.h"
#include "tests/app/checker.h"
#include "tests/app/judged.h"
#include "tests/support/brute_force_face_gear.h"

namespace toothpath::test {

inline constexpr double kBall = 0.5, kLength = 80, kTolerance_um = 5;
inline constexpr double kSlack_um = 0.5;  // between the judge's point contact and the sampled gouge

inline constexpr const char* kPlantedJob = R"(schema = 1
name = "planted"
[gear]
type = "face_gear"
teeth = 60
module = 2.0
module_plane = "transverse"
pressure_angle = 20.0
shaper_teeth = 20
shaper_tip_radius = 0.6
[[gear.zone]]
helix_angle = 0.0
inner_radius = 62.0
outer_radius = 63.5
[machine]
file = "machine.toml"
accept_assumed = true
[setup]
origin = [3.0, -2.0, 120.0]
axis = "up"
work_offset = "G54"
work_offset_at = [3.0, -2.0, 0.0]
[coolant]
mode = "flood"
[[tool]]
number = 1
type = "ball_end_mill"
diameter = 1.0
flute_length = 6.0
shank_diameter = 0.95
length = 80.0
holder = [[10.0, 10.0, 40.0]]
stick_out = 16.0
[[operation]]
type = "finishing"
tool = 1
speed = 20000
feed = 500.0
scallop = 0.01
chord_tolerance = 0.002
[verify]
gouge_tolerance = 0.005
)";

using Lines = std::vector<std::string>;

inline Lines lines_of(const std::string& text) {
  Lines out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

inline std::string joined(const Lines& lines) {
  std::string out;
  for (const std::string& line : lines) out += line + "\n";
  return out;
}

/// A small gear on the axis of its rotary, where teeth are copies; that place, too.
inline std::pair<std::string, Vec3> planted_job(const OutputForm& form, const std::string& machine) {
  std::string job = kPlantedJob;
  Vec3 origin(3, -2, 0);
  std::smatch found;
  static const std::regex axis(R"(point = \[([-0-9.]+), ([-0-9.]+), 0\.0\])");
  if (form.control != std::string("apt") && std::regex_search(machine, found, axis)) {
    origin = {std::stod(found[1]), std::stod(found[2]), 0};
    for (const char* height : {"120.0", "0.0"})
      replace_once(job, fmt::format("[3.0, -2.0, {}]", height),
                   fmt::format("[{}, {}, {}]", found[1].str(), found[2].str(), height));
  }
  return {job, origin};
}

/// A program of one form, and what is said of its text when that is edited.
class PlantedProgram {
 public:
  PlantedProgram(const OutputForm& form, const std::string& machine, const std::string& job, const Vec3& origin)
      : form_(form), origin_(origin) {
    write_file(dir_ / "machine.toml", machine);
    write_file(dir_ / "job.toml", job);
    commands::RunRequest request;
    request.job_file = dir_ / "job.toml";
    request.out_dir = dir_ / "out";
    request.quiet = true;
    const auto outcome = commands::run_job(request);
    if (outcome.exit_code != app::ExitCode::ok) {
      ADD_FAILURE() << form.name() << ": " << to_text(outcome.errors) << outcome.report_json.substr(0, 2000);
      return;
    }
    report_ = nlohmann::json::parse(outcome.report_json);
    lines_ = lines_of(file_text(dir_ / ("out/" + report_["program"]["file"].get<std::string>())));
  }

  struct Found {
    std::string kind;  ///< "harmless", "refused", or what it is not verified for
    std::string text;
    double gouge_um = 0;
    bool operator==(const Found&) const = default;
  };
  /// What `check` says of a text; the job is read once for all of them.
  [[nodiscard]] Found check(const Lines& lines) const {
    if (!checker_) checker_ = checker_of(dir_ / "job.toml");
    const auto report = checker_->prove(joined(lines), dir_ / "edited.nc");
    return report ? found_in(report::report_json(*report)) : Found{"refused", to_text({report.error()}), 0};
  }
  /// The same by the command, in a whole run of its own.
  [[nodiscard]] Found check_alone(const Lines& lines) const {
    write_file(dir_ / "edited.nc", joined(lines));
    commands::CheckRequest request;
    request.job_file = dir_ / "job.toml";
    request.program_file = dir_ / "edited.nc";
    request.out_dir = dir_ / "check";
    request.quiet = true;
    const auto outcome = commands::check_program(request);
    return outcome.report_json.empty() ? Found{"refused", to_text(outcome.errors), 0} : found_in(outcome.report_json);
  }

  [[nodiscard]] const Lines& lines() const { return lines_; }
  [[nodiscard]] double gouge_um() const { return report_["gouge_um"]["measured"].get<double>(); }

 protected:
  [[nodiscard]] static Found found_in(const std::string& report_json) {
    const auto report = nlohmann::json::parse(report_json);
    Found found;
    if (const auto& gouge = report["gouge_um"]["measured"]; !gouge.is_null()) found.gouge_um = gouge.get<double>();
    const auto is = [&](const std::string& reason, const char* word) { return reason.find(word) != std::string::npos; };
    for (const auto& entry : report["reasons"]) {
      const auto reason = entry.get<std::string>();
      found.text += reason + "; ";
      const char* kind = is(reason, "not made again") || is(reason, "does not cut")                ? "missing"
                         : is(reason, "the job says T")                                            ? "tool"
                         : is(reason, "coolant of the job")                                        ? "coolant"
                         : is(reason, "turns with S")                                              ? "speed"
                         : is(reason, "mm/min") || is(reason, "max_speed") || is(reason, " chip ") ? "feed"
                         : is(reason, "rapid")                                                     ? "rapid"
                         : is(reason, "left material") || is(reason, "leaves")                     ? "left"
                         : is(reason, "gouge") || is(reason, "cuts")                               ? "gouge"
                                                                                                   : "other";
      if (found.kind.find(kind) == std::string::npos) found.kind += (found.kind.empty() ? "" : "+") + std::string(kind);
    }
    if (!found.kind.empty()) return found;
    found.kind = "harmless";
    for (const auto& entry : report["warnings"]) {
      const auto warning = entry.get<std::string>();
      if (warning.find("HASH does not fit") != std::string::npos || !warning.starts_with("line ")) continue;
      found.kind = "warning";
      found.text += warning + "; ";
    }
    return found;
  }
  [[nodiscard]] JudgedPath walk(const Lines& lines) const {
    return {
        joined(lines), file_text(dir_ / "machine.toml"), {origin_ + Vec3(0, 0, 120), false, {origin_, {0, kLength}}}};
  }

  OutputForm form_;
  TestDir dir_;
  Vec3 origin_;
  nlohmann::json report_;
  Lines lines_;
  mutable std::unique_ptr<commands::ProgramChecker> checker_;
};

/// One of whose cuts can be moved.
class Planted : public PlantedProgram {
 public:
  Planted(const OutputForm& form, Random& random) : Planted(form, random_machine(form, random)) {}
  [[nodiscard]] bool made() const { return cut_ > 0; }
  /// How deep the ball is in the flank at the block that is moved, by brute force.
  [[nodiscard]] double depth_um() const { return depth_um_; }

  /// A block that touches a flank moved towards the work at its contact by so many um (off it below 0); `moved`: by how
  /// many um it then truly is, from the words.
  [[nodiscard]] Lines moved_cut(double um, double& moved) const {
    Lines lines = lines_;
    const Vec3 by = 1e-3 * um * into_;
    for (const std::size_t end : {before_, cut_}) set_words(lines, end, words_at(end) + word_step(end, by));
    set_words(lines, after_, words_at(after_));
    const JudgedPath path = walk(lines);
    EXPECT_TRUE(path.faults().empty()) << path.faults().front();
    moved = 1e3 * (tip_at(path, cut_) - tip_at(*path_, cut_)).dot(into_);
    return lines;
  }

 private:
  Planted(const OutputForm& form, const std::string& machine) : Planted(form, machine, planted_job(form, machine)) {}
  Planted(const OutputForm& form, const std::string& machine, const std::pair<std::string, Vec3>& job)
      : PlantedProgram(form, machine, job.first, job.second) {
    if (!lines_.empty()) find_cut();
  }
  static const MachineMove& move_at(const JudgedPath& path, std::size_t line) {
    const auto& moves = path.moves();
    return *std::find_if(moves.begin(), moves.end(), [&](const MachineMove& m) { return std::size_t(m.line) == line; });
  }
  static Vec3 tip_at(const JudgedPath& path, std::size_t line) { return path.at(move_at(path, line), 1).tip; }

  /// Greatest depth of the ball in the flanks when its centre is here (below 0: it stays away from them), and where.
  [[nodiscard]] std::pair<double, Vec3> deepest(const BruteForceFaceGear& gear, const Vec3& centre) const {
    Random random(5);
    double most = -INFINITY, step = 1;
    const auto depth = [&](const Vec3& out) {  // where it is no more than the most so far: not how much less
      return gear.least_clearance(centre + kBall * out, most / gear.cos_base_helix()) * gear.cos_base_helix();
    };
    Vec3 at = -Vec3::UnitZ();
    for (int k = 0; k < 900; ++k, step = k < 200 ? 1 : step * 0.985) {
      const Vec3 out = (step == 1 ? random.vector(1) : Vec3(at + random.vector(step))).normalized();
      if (const double d = depth(out); d > most) {
        most = d;
        at = out;
      }
    }
    return {most, at};
  }
  /// Of the first space a block in the middle of a pass that touches a flank. All forms cut the same passes: that of
  /// one form shows the others where to look.
  void find_cut() {
    path_ = std::make_unique<JudgedPath>(walk(lines_));
    ASSERT_TRUE(path_->faults().empty()) << form_.name() << ": " << path_->faults().front();
    static std::optional<Vec3> known;  // centre of the ball
    constexpr double kSame_mm = 0.05;  // words are rounded, and passes are parted by machines' angles
    if (known) search_cut([&](const Vec3& centre) { return (centre - *known).norm() < kSame_mm; });
    if (depth_um_ < kTouches_um) search_cut([](const Vec3&) { return true; });
    ASSERT_GT(depth_um_, kTouches_um) << form_.name() << ": no block touches a flank";
    const ToolPlace place = path_->at(move_at(*path_, cut_), 1);
    known = place.tip + kBall * place.axis;
  }
  void search_cut(const std::function<bool(const Vec3& centre)>& wanted) {
    static const BruteForceFaceGear gear(*job::parse_job(kPlantedJob, "job.toml").value().face_gear(), 0);
    const auto& moves = path_->moves();
    double most = -INFINITY;
    for (std::size_t k = 2; k + 2 < moves.size() / 60; ++k) {
      bool pass = true;
      for (std::size_t n = k - 2; n <= k + 2; ++n)
        pass =
            pass && !moves[n].rapid && std::abs(path_->at(moves[n], 1).tip.z() - path_->at(moves[k], 1).tip.z()) < 0.1;
      const ToolPlace place = path_->at(moves[k], 1);
      const Vec3 centre = place.tip + kBall * place.axis;
      const double r = std::hypot(place.tip.x(), place.tip.y());
      if (!pass || r < 62.3 || r > 63.2 || !wanted(centre)) continue;
      const auto [depth, out] = deepest(gear, centre);
      if (depth <= most || std::abs(out.z()) > 0.7) continue;
      most = depth;
      into_ = out;
      before_ = std::size_t(moves[k - 1].line);
      cut_ = std::size_t(moves[k].line);
      after_ = std::size_t(moves[k + 1].line);
    }
    depth_um_ = 1e3 * most;
  }
  /// X Y Z in force at the end of this line, in the first tooth that it cuts.
  [[nodiscard]] Vec3 words_at(std::size_t line) const {
    const NcWalk all = walk_nc(joined(lines_), form_.control);
    Vec3 words(NAN, NAN, NAN);
    for (const NcMove& m : all.moves) {
      for (std::size_t k = 0; k < 3; ++k)
        if (m.linear[k] && !m.machine) words[int(k)] = *m.linear[k];
      if (std::size_t(m.line) == line) return words;
    }
    ADD_FAILURE() << "line " << line << " is no motion";
    return words;
  }
  /// What the words change by when the tip moves by this in the gear frame.
  [[nodiscard]] Vec3 word_step(std::size_t line, const Vec3& by) const {
    const MachineMove& m = move_at(*path_, line);
    if (m.tip) {
      const NcWalk all = walk_nc(joined(lines_), form_.control);
      double turned = 0;
      for (const NcMove& n : all.moves)
        if (std::size_t(n.line) == line) {
          turned = n.turned_deg;
          break;
        }
      return Eigen::AngleAxisd(-turned * kPi / 180, Vec3::UnitZ()) * by;
    }
    Mat3 columns;
    for (std::size_t k = 0; k < 3; ++k) {
      PlainJoints at = m.to;
      at[k] += 1;
      columns.col(int(k)) = path_->machine().place(at, kLength).tip - path_->machine().place(m.to, kLength).tip;
    }
    return columns.inverse() * by;
  }
  void set_words(Lines& lines, std::size_t line, const Vec3& words) const {
    std::string& text = lines[line - 1];
    const std::string control = form_.control;
    const auto printed = [&](double v) {
      const int digits = control == "apt"                          ? 6
                         : control == "fanuc" || control == "haas" ? 3
                         : control == "linuxcnc"                   ? 4
                                                                   : 5;
      return (control == "heidenhain" && v >= 0 ? "+" : "") + fmt::format("{:.{}f}", v, digits);
    };
    if (control == "apt") {
      const std::regex all(R"(GOTO/[-0-9.]+,[-0-9.]+,[-0-9.]+)");
      ASSERT_TRUE(std::regex_search(text, all)) << text;
      text = std::regex_replace(
          text, all, fmt::format("GOTO/{},{},{}", printed(words.x()), printed(words.y()), printed(words.z())));
      return;
    }
    for (int k = 0; k < 3; ++k) {
      const std::regex word(fmt::format("\\b{}[-+0-9.]+", "XYZ"[k]));
      const std::string by = fmt::format("{}{}", "XYZ"[k], printed(words[k]));
      if (std::regex_search(text, word)) text = std::regex_replace(text, word, by);
      else if (control == "heidenhain") text = std::regex_replace(text, std::regex("\\b(LN?)\\b"), "$1 " + by);
      else text += " " + by;
    }
  }

  std::unique_ptr<JudgedPath> path_;
  std::size_t before_ = 0, cut_ = 0, after_ = 0;  ///< lines of three blocks, from 1
  Vec3 into_ = Vec3::Zero();
  static constexpr double kTouches_um = -1.5;
  double depth_um_ = -INFINITY;  ///< of the ball in the flank at the end of the middle one, by brute force
};

}  // namespace toothpath::test
