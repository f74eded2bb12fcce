// `toothpath new`: a job for a gear and a machine, asked for on a terminal or said by options, proven before it is
// written.
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/commands/run.h"
#include "app/commands/shaper.h"
#include "app/job/file.h"
#include "app/proposal/propose.h"
#include "app/tool_library/tool_library.h"
#include "geometry/base/angle.h"
#include "geometry/base/printable.h"
#include "machines/machine_file.h"
#include "machines/toml/near_name.h"

namespace toothpath::commands {
namespace {

namespace fs = std::filesystem;
using proposal::Question;
using proposal::Wishes;

struct NewRequest : CommonRequest {
  std::string gear, route, machine, tools, file, name;
  std::array<std::optional<double>, proposal::kQuantities> numbers;
  std::array<std::optional<int>, proposal::kQuantities> whole;
};

std::vector<Diagnostic> usage(std::string message) {
  return {Diagnostic{DiagnosticKind::usage, {}, std::move(message)}};
}

using DoneOrErrors = Expected<Ok, std::vector<Diagnostic>>;

/// Asks on a terminal, or takes what the options say.
class Dialog {
 public:
  explicit Dialog(bool quiet) : asks_(!quiet && ::isatty(STDIN_FILENO) != 0) {}

  [[nodiscard]] bool asks() const { return asks_; }

  void tell(const proposal::Told& lines) const {
    if (!asks_) return;
    for (const auto& [what, value] : lines) std::fprintf(stderr, "    %s: %s\n", what.c_str(), value.c_str());
  }

  /// One of these words; an empty answer takes the first.
  template <typename Words>
  Expected<std::string, std::vector<Diagnostic>> word(const char* option, const char* text, std::string given,
                                                      const Words& words) const {
    while (true) {
      if (!given.empty()) {
        if (std::find(words.begin(), words.end(), given) != words.end()) return given;
        const std::string wrong = fmt::format("{} = \"{}\" is not one of {}{}", option, printable(given),
                                              fmt::join(words, ", "), toml::did_you_mean(given, words));
        if (!asks_) return usage(wrong);
        std::fprintf(stderr, "  %s\n", wrong.c_str());
      }
      if (!asks_) return usage(fmt::format("{} is missing: {}; one of {}", option, text, fmt::join(words, ", ")));
      auto answer = ask(fmt::format("{} ({}) [{}]", text, fmt::join(words, ", "), *words.begin()));
      if (!answer) return usage(fmt::format("{} is missing: the answers ended", option));
      given = answer->empty() ? std::string(*words.begin()) : *answer;
    }
  }

  Expected<double, std::vector<Diagnostic>> number(const Question& question, std::optional<double> given,
                                                   std::optional<double> proposed) const {
    if (given) return *given;
    if (!asks_) {
      if (proposed) return *proposed;
      return usage(fmt::format("{} is missing: {}, {:g} to {:g}{}", question.option, question.text, question.range.low,
                               question.range.high, question.range.unit));
    }
    const std::string line =
        fmt::format("{} ({:g} to {:g}{}){}", question.text, question.range.low, question.range.high,
                    question.range.unit, proposed ? fmt::format(" [{:g}]", *proposed) : "");
    while (true) {
      auto answer = ask(line);
      if (!answer) return usage(fmt::format("{} is missing: the answers ended", question.option));
      if (answer->empty() && proposed) return *proposed;
      const auto read = read_answer(question, *answer);
      if (read) return *read;
      std::fprintf(stderr, "  %s\n", printable(read.error().message).c_str());
    }
  }

 private:
  static Result<double> read_answer(const Question& question, const std::string& text) {
    if (!question.whole) return app::read_number(question.text, text, question.range);
    const auto whole = app::read_whole_number(question.text, text, question.range);
    if (!whole) return whole.error();
    return static_cast<double>(*whole);
  }

  static std::optional<std::string> ask(const std::string& line) {
    std::fprintf(stderr, "%s: ", line.c_str());
    std::fflush(stderr);
    std::string answer;
    if (!std::getline(std::cin, answer)) return std::nullopt;
    return answer;
  }

  bool asks_;
};

/// A machine file by the word of a job, without its ending.
std::vector<std::string> machine_names(bool shaper) {
  std::vector<std::string> names;
  for (const std::string& file : machines::installed_machines()) {
    const auto path = machines::find_machine_file(file, ".");
    const auto opened = path ? machines::open_machine_file(*path) : Result<machines::MachineFileText>(path.error());
    if (opened && (opened->kind == machines::MachineKind::gear_shaper) == shaper)
      names.push_back(fs::path(file).stem().string());
  }
  return names;
}

Expected<Wishes, std::vector<Diagnostic>> kinds_wished(const NewRequest& request, const Dialog& dialog) {
  Wishes wishes;
  const auto gear = dialog.word("--gear", "kind of gear", request.gear, proposal::gear_words());
  if (auto* errors = gear.refused()) return *errors;
  wishes.gear = proposal::gear_of(gear.value());
  std::vector<std::string_view> routes;
  for (const proposal::Route route : proposal::routes_of(*wishes.gear)) routes.push_back(word_of(route));
  const std::string given = request.route.empty() && !dialog.asks() ? std::string(routes.front()) : request.route;
  const auto route = dialog.word("--cut", "how it is cut", given, routes);
  if (auto* errors = route.refused()) return *errors;
  wishes.route = proposal::route_of(route.value());
  wishes.machine = request.machine;
  if (wishes.machine.empty()) {
    const auto machine =
        dialog.word("--machine", "machine", "", machine_names(wishes.route == proposal::Route::shaped));
    if (auto* errors = machine.refused()) return *errors;
    wishes.machine = machine.value();
  }
  return wishes;
}

/// All numbers of the gear, each with the limits that are known before it.
DoneOrErrors wish_numbers(Wishes& wishes, const NewRequest& request, const Dialog& dialog) {
  for (const Question& question : proposal::questions()) {
    const auto at = static_cast<std::size_t>(question.what);
    const auto given =
        question.whole && request.whole[at] ? std::optional<double>(*request.whole[at]) : request.numbers[at];
    if (!belongs(question, *wishes.gear)) {
      if (given) return usage(fmt::format("{} does not belong to --gear {}", question.option, word_of(*wishes.gear)));
      continue;
    }
    if (question.what == proposal::Quantity::inner) dialog.tell(limits_of(wishes));
    const bool ends = question.what == proposal::Quantity::inner || question.what == proposal::Quantity::outer;
    const auto proposed = proposal::proposed(question.what, wishes);
    if (ends && !proposed && !given)
      return std::vector{Diagnostic{DiagnosticKind::refused_input,
                                    {},
                                    "no tooth has room with these numbers: its teeth are undercut where they are not "
                                    "pointed; fewer teeth of the shaper, or less helix angle, would help"}};
    const auto answer = dialog.number(question, given, proposed);
    if (auto* errors = answer.refused()) return *errors;
    wishes[question.what] = answer.value();
  }
  return Ok{};
}

/// A folder of its own that goes with it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string path = (fs::temp_directory_path() / "toothpath-new-XXXXXX").string();
    if (::mkdtemp(path.data())) path_ = path;
  }
  ~TemporaryFolder() {
    std::error_code error;
    if (!path_.empty()) fs::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

bool write_text(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  return !out.fail();
}

/// The job as `run` or `shaper` finds it.
CommandOutcome prove(const std::string& text, bool shaped, bool quiet) {
  const TemporaryFolder folder;
  const std::string file = folder.path() + "/job.toml";
  if (folder.path().empty() || !write_text(file, text))
    return failed(Diagnostic{DiagnosticKind::file_access, {}, "no temporary folder can be written"});
  RunRequest request;
  request.job_file = file;
  request.out_dir = folder.path() + "/out";
  request.quiet = quiet;
  return shaped ? run_shaper(request) : run_job(request);
}

/// Under its name at once, and never over another file.
DoneOrErrors write_job(const std::string& file, const std::string& text) {
  const auto fail = [&](const std::string& why) {
    return std::vector{Diagnostic{DiagnosticKind::file_access, {file, 0, 0}, why}};
  };
  const std::string half = fmt::format("{}.{}.part", file, ::getpid());
  if (!write_text(half, text)) {
    ::unlink(half.c_str());
    return fail("cannot be written");
  }
  const int linked = ::link(half.c_str(), file.c_str()), error = errno;
  ::unlink(half.c_str());
  if (linked != 0) return fail(error == EEXIST ? "exists already, and is not replaced" : "cannot be written");
  return Ok{};
}

struct Proposed {
  proposal::Draft draft;
  std::string text;
  CommandOutcome proof;
};

bool is_verified(const Expected<Proposed, std::vector<Diagnostic>>& proposed) {
  return proposed && proposed.value().proof.exit_code == app::ExitCode::ok;
}

/// The first way that is verified, else the last that was tried.
Expected<Proposed, std::vector<Diagnostic>> propose(const NewRequest& request, const Wishes& wishes,
                                                    const proposal::ChosenMachine& machine,
                                                    const proposal::ChosenGear& gear, const proposal::Shelf& shelf) {
  std::optional<Proposed> last;
  std::vector<Diagnostic> refused;
  for (int attempt = 0; attempt < proposal::kAttempts; ++attempt) {
    auto draft = proposal::draft_of(request.name, wishes, machine, gear, shelf, attempt);
    if (!draft) {
      if (refused.empty()) refused.push_back(draft.error());
      continue;
    }
    const std::string text = job_text(*draft);
    last = Proposed{*draft, text, prove(text, wishes.route == proposal::Route::shaped, request.quiet)};
    if (last->proof.exit_code == app::ExitCode::ok || last->proof.exit_code == app::ExitCode::interrupted ||
        wishes.route == proposal::Route::shaped)
      return std::move(*last);
  }
  if (!last) return refused;
  return std::move(*last);
}

CommandOutcome told(const NewRequest& request, const Proposed& proposed, const proposal::Told& limits) {
  CommandOutcome outcome;
  outcome.exit_code = proposed.proof.exit_code;
  std::string out = request.file + "\n";
  nlohmann::ordered_json json = {{"schema", 1}, {"command", "new"}, {"file", request.file}, {"job", proposed.text}};
  json["limits"] = nlohmann::ordered_json::object();
  for (const auto& [what, value] : limits) {
    out += fmt::format("  {:<40} {}\n", what, value);
    json["limits"][what] = value;
  }
  const bool verified = proposed.proof.exit_code == app::ExitCode::ok;
  json["verified"] = verified;
  json["proof"] = proposed.proof.report_json.empty() ? nlohmann::ordered_json()
                                                     : nlohmann::ordered_json::parse(proposed.proof.report_json);
  out += fmt::format("  {:<40} {}\n", "tried as it stands", verified ? "verified" : "NOT verified");
  if (!verified)
    for (const char* key : {"reasons", "would_help"})
      for (const auto& line : json["proof"].value(key, nlohmann::ordered_json::array()))
        out += fmt::format("    {} {}\n", std::string_view(key) == "reasons" ? "because   " : "would help",
                           line.get<std::string>());
  out += fmt::format("next: toothpath {} {} --out DIR\n",
                     proposed.draft.wishes.route == proposal::Route::shaped ? "shaper" : "run", request.file);
  outcome.summary = out;
  outcome.report_json = json.dump(2) + "\n";
  return outcome;
}

/// What a [[tool]] needs that a file does not say of its tool.
std::vector<std::string> unsaid(const tool_library::LibraryTool& tool, bool tapered) {
  std::vector<std::string> missing;
  for (const char* key : {"diameter", "flute_length", "shank_diameter", "length", "stick_out", "holder"})
    if (!tool.keys.find(key)) missing.emplace_back(key);
  if (tapered && !tool.keys.find("half_angle")) missing.emplace_back("half_angle");
  return missing;
}

/// Ball mills and tapered ball mills of a file of another program; those of which it says all that a job must know.
Expected<proposal::Shelf, std::vector<Diagnostic>> shelf_of_library(const std::string& file) {
  const auto read = tool_library::read_tool_library(file);
  if (!read) return std::vector{read.error()};
  proposal::Shelf shelf;
  std::string asked_for;
  for (const tool_library::LibraryTool& known : *read) {
    const toml::TomlEntry* type = known.keys.find("type");
    const std::string* word = type ? type->value.text() : nullptr;
    tool::ToolAssembly tool;
    if (word && *word == "tapered_ball_end_mill") tool.type = tool::CutterType::tapered_ball_end_mill;
    else if (word && *word != "ball_end_mill") continue;
    std::vector<std::string> missing = unsaid(known, tool.type == tool::CutterType::tapered_ball_end_mill);
    if (!word) missing.insert(missing.begin(), "type");
    if (!missing.empty()) {
      if (asked_for.empty()) asked_for = fmt::format("; tool {} lacks {}", known.number, fmt::join(missing, ", "));
      continue;
    }
    const auto number = [&](const char* key) {
      const toml::TomlEntry* entry = known.keys.find(key);
      return entry ? entry->value.number().value_or(0) : 0;
    };
    tool.diameter_mm = number("diameter");
    tool.flute_length_mm = number("flute_length");
    tool.shank_diameter_mm = number("shank_diameter");
    tool.stick_out_mm = number("stick_out");
    tool.length_mm = number("length");
    tool.half_angle_rad = radians(number("half_angle"));
    if (const toml::TomlEntry* holder = known.keys.find("holder"); holder && holder->value.array())
      for (const toml::TomlValue& row : holder->value.array()->values)
        if (const toml::TomlArray* r = row.array(); r && r->values.size() == 3)
          tool.holder.push_back({r->values[0].number().value_or(0), r->values[1].number().value_or(0),
                                 r->values[2].number().value_or(0)});
    if (const double teeth = number("teeth"); teeth >= 1) tool.teeth = static_cast<int>(teeth);
    shelf.push_back(tool);
  }
  if (shelf.empty())
    return usage(fmt::format(
        "--tools: {} has no ball mill and no tapered ball mill of which it says all that a job must know{}; "
        "a job with `library = \"{}\"` in its tools says the rest, and can be given as --tools",
        file, asked_for, file));
  return shelf;
}

Expected<proposal::Shelf, std::vector<Diagnostic>> shelf_of(const std::string& file) {
  if (file.empty()) return proposal::Shelf{};
  if (fs::path(file).extension() != ".toml") return shelf_of_library(file);
  auto read = job::read_job_file(file);
  if (auto* errors = read.refused()) return std::move(*errors);
  return std::move(read.value().tools);
}

CommandOutcome run_new(const NewRequest& asked) {
  NewRequest request = asked;
  if (request.file.empty()) return failed(usage("-o is missing: the job file to write"));
  if (fs::exists(request.file))
    return failed(
        Diagnostic{DiagnosticKind::usage, {}, fmt::format("-o: {} exists already, and is not replaced", request.file)});
  if (request.name.empty()) request.name = fs::path(request.file).stem().string();
  const Dialog dialog(request.quiet);
  auto wished = kinds_wished(request, dialog);
  if (auto* errors = wished.refused()) return failed(std::move(*errors));
  Wishes wishes = std::move(wished.value());
  const std::string directory = fs::path(request.file).parent_path().string();
  auto machine = proposal::choose_machine(wishes, directory);
  if (auto* errors = machine.refused()) return failed(std::move(*errors));
  dialog.tell(limits_of(machine.value()));
  auto shelf = shelf_of(request.tools);
  if (auto* errors = shelf.refused()) return failed(std::move(*errors));
  if (auto numbers = wish_numbers(wishes, request, dialog); auto* errors = numbers.refused())
    return failed(std::move(*errors));
  auto gear = proposal::choose_gear(wishes);
  if (auto* errors = gear.refused()) return failed(std::move(*errors));
  dialog.tell(limits_of(gear.value()));
  auto proposed = propose(request, wishes, machine.value(), gear.value(), shelf.value());
  if (request.route.empty() && !dialog.asks() && wishes.route == proposal::Route::line && !is_verified(proposed)) {
    wishes.route = proposal::Route::ball;  // nobody asked for the side of a mill
    if (auto other = propose(request, wishes, machine.value(), gear.value(), shelf.value()); is_verified(other))
      proposed = std::move(other);
  }
  if (auto* errors = proposed.refused()) return failed(std::move(*errors));
  CommandOutcome& proof = proposed.value().proof;
  if (proof.exit_code != app::ExitCode::ok && proof.exit_code != app::ExitCode::unverified) {
    for (Diagnostic& error : proof.errors) error.position = {};
    return failed(std::move(proof.errors));
  }
  proposal::Told limits = limits_of(wishes);
  for (const auto& more : {limits_of(gear.value()), limits_of(proposed.value().draft, machine.value(), gear.value())})
    limits.insert(limits.end(), more.begin(), more.end());
  if (auto written = write_job(request.file, proposed.value().text); auto* errors = written.refused())
    return failed(std::move(*errors));
  return told(request, proposed.value(), limits);
}

void new_options(OptionSet& set, NewRequest& request) {
  set.text("--gear", request.gear, "face, double_helical, offset or bevel_herringbone", "KIND");
  set.text("--cut", request.route, "line, ball or shaped (a bevel gear: finger)", "WAY");
  set.text("--machine", request.machine, "a machine file, or the name of an installed machine", "NAME");
  set.text("--tools", request.tools, "tools instead of standard sizes: a job, a tool library of Fusion or FreeCAD",
           "FILE");
  for (const Question& question : proposal::questions()) {
    const auto at = static_cast<std::size_t>(question.what);
    if (question.whole) set.whole_number(question.option, request.whole[at], question.text, question.range);
    else set.number(question.option, request.numbers[at], question.text, question.range);
  }
  set.text("--name", request.name, "name of the job; else that of the file", "NAME");
  set.text("-o", request.file, "the job file to write; an existing one is not replaced", "JOB.toml");
}

}  // namespace

void add_new(Commands& commands) {
  commands.push_back(command_of<NewRequest>(
      "new", "a job for a gear and a machine, asked for on a terminal or said by options, and tried as it stands",
      new_options, run_new));
}

}  // namespace toothpath::commands
