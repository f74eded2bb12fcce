// `toothpath new`: a job for a gear and a machine, asked for on a terminal or said by options, proven before it is
// written.
#include <fcntl.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/base/interruption.h"
#include "app/base/kept_answers.h"
#include "app/base/new_file.h"
#include "app/base/option_number.h"
#include "app/commands/run.h"
#include "app/commands/shaper.h"
#include "app/job/flank_points.h"
#include "app/job/loose_points.h"
#include "app/proposal/explanations.h"
#include "app/proposal/material.h"
#include "app/questions/choose.h"
#include "geometry/base/json_text.h"
#include "machines/machine_file.h"

namespace toothpath::commands {
namespace {

namespace fs = std::filesystem;
using proposal::Quantity;
using proposal::Question;
using proposal::Wishes;
using questions::Choice;

struct NewRequest : CommonRequest, questions::Given {
  bool with_mate = false, resume = false;
};

std::vector<Diagnostic> usage(std::string message) {
  return {Diagnostic{DiagnosticKind::usage, {}, std::move(message)}};
}

/// A folder of its own that goes with it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const char* told = std::getenv("TMPDIR");
    const std::string place = told && *told ? told : "/tmp";
    path_ = place + "/toothpath-new-XXXXXX";
    if (::mkdtemp(path_.data())) {
      (void)app::register_temporary(AT_FDCWD, path_, true);
    } else {
      error_ = errno;
      path_ = place;
    }
  }
  ~TemporaryFolder() {
    if (error_ != 0) return;
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    app::forget_temporary(AT_FDCWD, path_);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }  ///< where it is not there, of its parent
  [[nodiscard]] int error() const { return error_; }               ///< why it is not there, as in errno

 private:
  std::string path_;
  int error_ = 0;
};

/// The job as `run` or `shaper` finds it.
CommandOutcome prove(const app::UnnamedFile& job, const std::string& text, bool shaped, bool quiet) {
  const TemporaryFolder folder;
  if (folder.error() != 0)
    return failed(Diagnostic{DiagnosticKind::file_access,
                             {folder.path(), 0, 0},
                             fmt::format("cannot make a folder in which the job is tried: {}; name a place that can "
                                         "be written in TMPDIR",
                                         std::strerror(folder.error()))});
  if (const auto written = job.write(text); !written) return failed(written.error());
  RunRequest request;
  request.job_file = job.path();
  request.out_dir = folder.path() + "/out";
  request.quiet = quiet;
  return shaped ? run_shaper(request) : run_job(request);
}

struct Proposed {
  proposal::Draft draft;
  std::string text;
  CommandOutcome proof;
};

bool is_verified(const Expected<Proposed, std::vector<Diagnostic>>& proposed) {
  return proposed && proposed.value().proof.exit_code == app::ExitCode::ok;
}

/// Of the schema of jobs, for editors.
std::string schema_url() {
  const std::string path = machines::schema_file("job.schema.json");
  if (path.empty()) return {};
  std::string url = "file://";
  for (const char c : fs::path(path).lexically_normal().string()) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       std::string_view("/-._~").find(c) != std::string_view::npos;
    url += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return url;
}

/// The first way that is verified, else the last that was tried.
Expected<Proposed, std::vector<Diagnostic>> propose(const NewRequest& request, const Choice& choice) {
  std::optional<Proposed> last;
  std::vector<Diagnostic> refused;
  const bool shaped = choice.wishes.route == proposal::Route::shaped;
  const app::UnnamedFile job(request.file);
  for (int attempt = 0; attempt < proposal::kAttempts; ++attempt) {
    auto draft = proposal::draft_of(request.name, choice.wishes, choice.machine, choice.gear, choice.shelf, attempt);
    if (!draft) {
      if (refused.empty()) refused.push_back(draft.error());
      continue;
    }
    const std::string text = job_text(*draft, choice.library, schema_url());
    last = Proposed{*draft, text, prove(job, text, shaped, request.quiet)};
    if (last->proof.exit_code == app::ExitCode::ok || last->proof.exit_code == app::ExitCode::interrupted || shaped)
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
  if (const std::string& points = proposed.draft.wishes.points_file; !points.empty()) {
    json["points"] = points;
    out += fmt::format("  {:<40} {}\n", "its points, in order, beside it", points);
  }
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
  out += fmt::format("next: toothpath {} {}\n",
                     proposed.draft.wishes.route == proposal::Route::shaped ? "shaper" : "run", request.file);
  outcome.summary = out;
  outcome.report_json = json_text(json, 2) + "\n";
  return outcome;
}

/// The ordered points of a gear beside its job: there while the job is tried, and afterwards where it is kept.
class PointsBesideJob {
 public:
  /// Nothing for gears that have no points. Errors: as of the job itself.
  Status write(const std::string& job, Wishes& wishes) {
    if (!wishes.grid) return Ok{};
    fs::path path(job);
    path.replace_filename(path.stem().string() + "_flanks.csv");
    wishes.points_file = path.filename().string();
    if (auto named = questions::can_be_named("-o", wishes.points_file); !named) return named;
    if (auto fresh = app::check_new_file(path.string(), "-o"); !fresh) return fresh;
    auto written = app::write_new_file(path.string(), job::flank_points_text({wishes.grid->plus, wishes.grid->minus}));
    if (!written) return written;
    path_ = path.string();
    (void)app::register_temporary(AT_FDCWD, path_, false);
    return Ok{};
  }
  void keep() {
    if (!path_.empty()) app::forget_temporary(AT_FDCWD, path_);
    path_.clear();
  }
  PointsBesideJob() = default;
  ~PointsBesideJob() {
    if (path_.empty()) return;
    ::unlink(path_.c_str());
    app::forget_temporary(AT_FDCWD, path_);
  }
  PointsBesideJob(const PointsBesideJob&) = delete;
  PointsBesideJob& operator=(const PointsBesideJob&) = delete;

 private:
  std::string path_;
};

/// What the try refused, without places in a job that goes again.
std::vector<Diagnostic> without_places(std::vector<Diagnostic> errors) {
  for (Diagnostic& error : errors)
    if (error.kind != DiagnosticKind::file_access) error.position = {};
  return errors;
}

/// A job and what is told of it.
struct MadeJob {
  Proposed proposed;
  proposal::Told limits;
};

/// Tries ways to make the gear. Refused also: what `run` refuses of it, but for a program that is not verified.
Expected<MadeJob, std::vector<Diagnostic>> make_job(const NewRequest& request, Choice& choice, bool asks) {
  auto proposed = propose(request, choice);
  if (request.route.empty() && !asks && choice.wishes.route == proposal::Route::line && !is_verified(proposed)) {
    choice.wishes.route = proposal::Route::ball;  // nobody asked for the side of a mill
    if (auto other = propose(request, choice); is_verified(other)) proposed = std::move(other);
  }
  if (auto* errors = proposed.refused()) return std::move(*errors);
  CommandOutcome& proof = proposed.value().proof;
  if (proof.exit_code != app::ExitCode::ok && proof.exit_code != app::ExitCode::unverified)
    return without_places(std::move(proof.errors));
  proposal::Told limits = choice.notes;
  if (choice.machine.assumed) limits.emplace_back("assumed in the machine file", assumed_words(choice.machine));
  for (const auto& more : {limits_of(choice.wishes), limits_of(choice.gear),
                           limits_of(proposed.value().draft, choice.machine, choice.gear)})
    limits.insert(limits.end(), more.begin(), more.end());
  return MadeJob{std::move(proposed.value()), std::move(limits)};
}

/// Where the job of the mate goes: beside the other.
std::string mate_file(const std::string& file) {
  fs::path path(file);
  return path.replace_filename(path.stem().string() + "_mate" + path.extension().string()).string();
}

/// The other gear of a bevel pair: teeth exchanged, the other hand.
Expected<MadeJob, std::vector<Diagnostic>> make_mate(NewRequest request, const Choice& of, bool asks) {
  Choice choice = of;
  std::swap(choice.wishes[Quantity::teeth], choice.wishes[Quantity::mate_teeth]);
  choice.wishes.hand = -of.wishes.hand;
  request.file = mate_file(request.file), request.name += "_mate";
  auto gear = proposal::choose_gear(choice.wishes);
  if (auto* errors = gear.refused()) return std::move(*errors);
  choice.gear = std::move(gear.value());
  return make_job(request, choice, asks);
}

bool has_bevel_mate(const Wishes& wishes) {
  return wishes.gear == proposal::Gear::bevel_herringbone || wishes.gear == proposal::Gear::straight_bevel ||
         wishes.drawn();
}

/// Writes the job of the mate, and tells of both.
CommandOutcome with_mate(const NewRequest& request, CommandOutcome outcome, const MadeJob& mate) {
  NewRequest other = request;
  other.file = mate_file(request.file);
  if (auto written = app::write_new_file(other.file, mate.proposed.text); !written) return failed(written.error());
  const CommandOutcome more = told(other, mate.proposed, mate.limits);
  if (outcome.exit_code == app::ExitCode::ok) outcome.exit_code = more.exit_code;
  outcome.summary +=
      more.summary + fmt::format("and of both: toothpath contact {} --mate {}\n", request.file, other.file);
  auto json = nlohmann::ordered_json::parse(outcome.report_json);
  json["mate"] = nlohmann::ordered_json::parse(more.report_json);
  outcome.report_json = json_text(json, 2) + "\n";
  return outcome;
}

CommandOutcome make_and_write(const NewRequest& request, Choice& choice, bool asks) {
  if (request.with_mate && !has_bevel_mate(choice.wishes))
    return failed(usage("--with-mate: only bevel gears by their numbers have a mate of their own kind"));
  PointsBesideJob points;
  if (auto written = points.write(request.file, choice.wishes); !written) return failed(written.error());
  auto made = make_job(request, choice, asks);
  if (auto* errors = made.refused()) return failed(std::move(*errors));
  std::optional<MadeJob> mate;
  if (request.with_mate) {
    auto other = make_mate(request, choice, asks);
    if (auto* errors = other.refused()) {
      for (Diagnostic& error : *errors) error.message = "the mate: " + error.message;
      return failed(std::move(*errors));
    }
    mate = std::move(other.value());
  }
  if (auto written = app::write_new_file(request.file, made.value().proposed.text); !written)
    return failed(written.error());
  points.keep();
  CommandOutcome outcome = told(request, made.value().proposed, made.value().limits);
  return mate ? with_mate(request, std::move(outcome), *mate) : outcome;
}

CommandOutcome run_new(const NewRequest& asked) {
  NewRequest request = asked;
  if (request.file.empty()) {
    std::vector<Diagnostic> missing = usage("-o is missing: the job file to write");
    if (app::Dialog dialog(request.quiet); !dialog.asks()) {
      const auto more = questions::missing_in(request, dialog);
      missing.insert(missing.end(), more.begin(), more.end());
    }
    return failed(std::move(missing));
  }
  std::vector<std::string> files = {request.file};
  if (request.with_mate) files.push_back(mate_file(request.file));
  for (const std::string& file : files)
    if (const auto fresh = app::check_new_file(file, "-o"); !fresh) return failed(fresh.error());
  if (request.name.empty()) request.name = fs::path(request.file).stem().string();
  for (const auto& [option, text] : {std::pair("--name", &request.name), {"--machine", &request.machine}})
    if (const auto named = questions::can_be_named(option, *text); !named) return failed(named.error());
  const app::KeptAnswers kept(request.file);
  bool cannot_keep = false;
  app::Dialog dialog(request.quiet, proposal::explanation_of, [&](std::span<const app::SaidAnswer> said) {
    const auto written = kept.write(said);
    if (!written && !cannot_keep) dialog.tell({{"answers are not kept", written.error().text()}});
    cannot_keep = !written;
    app::set_state(written && !said.empty()
                       ? "the answers are kept in " + kept.path() + ": the same command with --resume goes on with them"
                       : "");
  });
  if (request.resume && !dialog.asks()) return failed(usage("--resume goes on with questions: it needs a terminal"));
  if (request.resume) {
    auto said = kept.read();
    if (!said) return failed(said.error());
    dialog.begin_again(std::move(*said));
  } else if (dialog.asks() && kept.there()) {
    return failed(
        usage(fmt::format("{} keeps answers to an earlier `new`: --resume goes on with them; to begin anew, "
                          "delete it",
                          kept.path())));
  }
  auto chosen = questions::choose(request, dialog);
  if (auto* errors = chosen.refused()) return failed(std::move(*errors));
  CommandOutcome outcome = make_and_write(request, chosen.value(), dialog.asks());
  if (dialog.asks() && outcome.errors.empty()) (void)kept.write({});  // one that stays is told of by the next `new`
  return outcome;
}

void new_options(OptionSet& set, NewRequest& request) {
  set.examples({"new -o gear.toml", "new --gear face --teeth 60 --module 2 --machine xyzac_large -o gear.toml"});
  set.word("--gear", request.gear, "kind of gear", "KIND", proposal::gear_words());
  set.word("--cut", request.route, "how it is cut; bevel_herringbone: finger", "WAY", proposal::route_words());
  set.text("--machine", request.machine, "a machine file, or the name of an installed machine", "NAME");
  set.word("--accept-assumed", request.accept_assumed,
           "assumed values of the machine file are taken; asked for on a terminal, else yes", "ANSWER",
           questions::kYesNo);
  set.whole_number("--class", request.iso_class, "quality of the flanks by ISO 1328-1: tolerances follow",
                   proposal::kIsoClass);
  set.number("--tolerance", request.tolerance_um, "the same by the tolerance of their form (default 10)",
             proposal::kTolerance);
  set.word("--coolant", request.coolant, "as far as the control has it", "WAY", questions::kCoolantWords);
  set.word("--material", request.material, "of the part: forces follow", "NAME", proposal::material_words());
  set.number("--blank-top", request.blank_top_mm,
             "height of the blank's top above the face of the table (default: where the travels have most room)",
             questions::kBlankTop);
  set.text("--tools", request.tools,
           "tools instead of standard sizes: those of a job, or of a tool library of LinuxCNC, Fusion or FreeCAD",
           "FILE");
  set.word("--library-unit", request.unit, "unit of the lengths for which a tool library states none", "UNIT",
           app::kLengthUnits);
  set.texts("--tool", request.said, "what a tool library does not say of a tool: \"12: stick_out = 40, teeth = 2\"",
            "NUMBER:KEYS");
  for (const Question& question : proposal::questions()) {
    const auto at = static_cast<std::size_t>(question.what);
    if (question.whole) set.whole_number(question.option, request.whole[at], question.text, question.range);
    else set.number(question.option, request.numbers[at], question.text, question.range);
  }
  set.text("--points", request.points,
           "a gear by points: a file of x y z[ i j k] of both flanks of one space, in any order", "FILE");
  set.word("--points-unit", request.points_unit, "unit of x, y and z for which the file states none", "UNIT",
           app::kLengthUnits);
  set.text("--tip", request.tip,
           "its tip surface in the meridian, where not through the last rows of points: r z at both ends",
           "[[R, Z], [R, Z]]");
  set.text("--root", request.root, "its root surface, where not as deep as the fillet below the first rows",
           "[[R, Z], [R, Z]]");
  set.text("--rexs", request.rexs,
           "a cylindrical or spiral bevel gear, with the settings of its generator, from a REXS file 1.4 to 1.7",
           "FILE");
  set.whole_number("--component", request.component, "number of the gear in a REXS file that has several",
                   questions::kComponent);
  set.word("--left-flank", request.left_flank, "of a bevel gear in a REXS file whose flanks have a set-up each",
           "WHICH", questions::kFlankWords);
  set.word("--ratio-of-roll", request.ratio_of_roll, "sense of ratio_of_roll where the file leaves it open", "SENSE",
           questions::kRatioWords);
  set.word("--hand", request.hand,
           "hand of a spiral bevel gear, or of the inner half of a herringbone; without: pinions left, wheels right",
           "HAND", questions::kHandWords);
  set.number("--dedendum-coefficient", request.dedendum, "of a cylindrical gear whose REXS file has no tool",
             questions::kRackCoefficient);
  set.number("--root-radius-coefficient", request.root_radius, "of the rounding of its rack's tip",
             questions::kRackCoefficient);
  set.text("--name", request.name, "name of the job; else that of the file", "NAME");
  set.flag("--with-mate", request.with_mate,
           "of a bevel gear by its numbers: the job of its mate, too, as JOB_mate.toml beside it");
  set.flag("--resume", request.resume, "goes on with the answers of a `new` on a terminal that ended before its job");
  set.text("-o", request.file, "the job file to write; an existing one is not replaced", "JOB.toml");
}

}  // namespace

void add_new(Commands& commands) {
  commands.push_back(command_of<NewRequest>(
      "new", "writes a job file: asks on a terminal, or takes options; tries the job before it writes it", new_options,
      run_new));
}

}  // namespace toothpath::commands
