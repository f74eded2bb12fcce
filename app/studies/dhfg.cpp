#include "app/studies/dhfg.h"

#include <cmath>
#include <filesystem>
#include <optional>

#include "app/job/file.h"
#include "app/job/tables.h"
#include "app/job/words.h"
#include "app/process/opening_and_end.h"
#include "app/studies/merge.h"
#include "app/studies/samples/run_shard.h"
#include "app/studies/trials/dhfg_summary.h"
#include "geometry/base/angle.h"
#include "geometry/base/work_share.h"
#include "machines/toml/regular_file.h"

namespace toothpath::studies {

using trials::DhfgSamples;
using trials::DhfgStudy;
using trials::StudyFound;

namespace {

void read_study(toml::TableReader& t, DhfgStudy& s) {
  face_gear::FaceGearParameters& p = s.base;
  p.module_mm = t.number("module", {0.05, 100, " mm"}).value_or(5);
  if (const auto plane = t.word("module_plane", {"normal", "transverse"}))
    p.module_plane = *plane == "normal" ? face_gear::ModulePlane::normal : face_gear::ModulePlane::transverse;
  p.pressure_angle_rad = radians(t.number("pressure_angle", {5, 45, " deg"}).value_or(20));
  const auto optional = [&](const char* key, const toml::Range& range, double& value) {
    value = t.number_or(key, range, value);
  };
  optional("addendum_coefficient", {0.1, 2, ""}, p.addendum_coefficient);
  optional("clearance_coefficient", {0, 1, ""}, p.clearance_coefficient);
  optional("shaper_tip_radius", {0, 100, " mm"}, p.shaper_tip_radius_mm);
  optional("groove_width", {0, 500, " mm"}, s.groove_width_mm);
  optional("half_face", {0, 1000, " mm", true}, s.half_face_mm);
  optional("margin", {0, 100, " mm"}, s.margin_mm);
  optional("held_share", {0.5, 1, ""}, s.held_share);
  optional("rapid", {1, 100000, " mm/min"}, s.rapid_mm_min);
  double torque = s.torque_nmm / 1000;
  optional("torque", {0, 1e9, " N m", true}, torque);
  s.torque_nmm = torque * 1000;
  if (const auto v = t.numbers("pinion_teeth", 3, {5, 200, ""})) s.pinion_teeth = *v;
  if (const auto v = t.numbers("ratio", 3, {1.5, 50, ""})) s.ratio = *v;
  if (const auto v = t.numbers("helix_angle", 3, {1, 45, " deg"})) {
    s.helix_angle_rad.clear();
    for (const double beta : *v) s.helix_angle_rad.push_back(radians(beta));
  }
  for (const double teeth : s.pinion_teeth) {
    if (teeth != std::round(teeth)) t.refuse("pinion_teeth", "pinion_teeth = {:g} is not a whole number", teeth);
    for (const double ratio : s.ratio)
      if (std::abs(teeth * ratio - std::round(teeth * ratio)) > 1e-9)
        t.refuse("ratio", "ratio = {:g} with {:g} teeth gives {:g} teeth of the gear", ratio, teeth, teeth * ratio);
  }
  t.finish();
}

DhfgStudy default_study() {
  DhfgStudy s;
  s.name = "dhfg";
  s.base.module_mm = 5;
  s.base.pressure_angle_rad = radians(20);
  s.base.shaper_tip_radius_mm = 1.5;
  s.pinion_teeth = {25, 30, 35};
  s.ratio = {6, 8, 10};
  s.helix_angle_rad = {radians(20), radians(25), radians(30)};
  return s;
}

void coarsen(DhfgStudy& s) {
  for (auto& o : s.operations) {
    o.scallop_mm *= trials::kQuickScallop;
    o.chord_tolerance_mm *= trials::kQuickChord;
    o.step_down_mm *= trials::kQuickStep;
    o.step_over_mm *= trials::kQuickStep;
  }
  s.effort = {3, 4, 5, 4};
}

/// Of about the same time: the rolls of a trial, and its milling.
constexpr double kStepsOfTrial = 4;

commands::CommandOutcome run_whole(const DhfgRequest& request, DhfgStudy&& study) {
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  auto output = app::OutputDir::open(request.out_dir, trials::kDhfgFiles, {request.study_file});
  if (!output) return commands::failed(output.error());
  const DhfgSamples samples = clock.run("limits", [&] { return DhfgSamples(std::move(study), request.quick); });
  StudyFound found = samples.room();
  clock.run("trials", [&] {
    WorkShare share{double(samples.count())};
    for (int k = 0; k < samples.count(); ++k) {
      progress.show(samples.name(k));
      const WorkShare sample(share, kStepsOfTrial);
      samples.compute(k, found);
    }
  });
  progress.clear();
  trials::DhfgSummary summary = summary_of(samples.facts(), found);
  commands::CommandOutcome outcome;
  outcome.report_json = std::move(summary.json);
  outcome.summary = std::move(summary.text);
  return process::finished(*output, summary.files, std::move(outcome));
}

commands::CommandOutcome run_shard(const DhfgRequest& request, const samples::Shard& shard, DhfgStudy&& study) {
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  const DhfgSamples samples = clock.run("limits", [&] { return DhfgSamples(std::move(study), request.quick); });
  StudyFound found = samples.room();
  const auto line = [&](int k) -> Result<std::string> {
    progress.show(samples.name(k));
    samples.compute(k, found);
    return samples.line(k, found);
  };
  const auto ran = clock.run(
      "samples", [&] { return samples::run_shard(request.out_dir, shard, samples.head(samples::key_of({})), line); });
  progress.clear();
  if (!ran) return commands::failed(ran.error());
  commands::CommandOutcome outcome;
  outcome.summary = ran->summary();
  if (shard.count > 1) return outcome;
  commands::CommandOutcome merged = study_merge({{request.quiet, request.color}, request.out_dir});
  merged.summary = outcome.summary + merged.summary;
  return merged;
}

}  // namespace

process::ValueOrErrors<DhfgStudy> parse_dhfg_study(std::string_view text, const std::string& file) {
  const auto document = toml::parse_toml(text, file, job::kJobSyntax);
  if (!document) return std::vector<Diagnostic>{document.error()};
  DhfgStudy study = default_study();
  study.file = file;
  toml::ReaderFindings findings(job::job_words());
  toml::TableReader root(*document, "", findings);
  (void)root.integer("schema", {1, 1});
  study.name = root.text("name").value_or("");
  if (auto table = root.table("study")) read_study(*table, study);
  else if (!root.has("study")) root.refuse("study", "the study lacks the table [study]");
  std::vector<std::string> warnings;  // of tools: a study has no place for them
  const job::ToolContext context{nullptr, std::filesystem::path(file).parent_path().string()};
  for (auto& table : root.tables("tool")) study.tools.push_back(job::read_tool(table, context, warnings));
  for (auto& table : root.tables("operation")) study.operations.push_back(job::read_operation(table, {study.tools}));
  root.finish();
  if (!findings.errors.empty()) return std::move(findings.errors);
  return study;
}

commands::CommandOutcome study_dhfg(const DhfgRequest& request) {
  // A study in one piece measures its run times and leaves no samples; a shard leaves nothing else.
  std::optional<samples::Shard> shard;
  if (!request.shard.empty() || samples::in_slurm_array()) {
    const auto named = samples::shard_of(request.shard);
    if (!named) return commands::failed(named.error());
    shard = *named;
  }
  DhfgStudy study = default_study();
  if (!request.study_file.empty()) {
    const auto text = toml::read_input_file(request.study_file, job::kMaxJobBytes);
    if (!text) return commands::failed(text.error());
    auto parsed = parse_dhfg_study(*text, request.study_file);
    if (auto* errors = parsed.refused()) return commands::failed(std::move(*errors));
    study = std::move(parsed).value();
  }
  if (request.quick) coarsen(study);
  return shard ? run_shard(request, *shard, std::move(study)) : run_whole(request, std::move(study));
}

void add_dhfg(commands::Commands& commands) {
  commands.push_back(commands::command_of<DhfgRequest>(
      "dhfg", "nine orthogonal trials of double helical face gears: limits, contact, forces, milling time",
      [](commands::OptionSet& set, DhfgRequest& request) {
        set.text("--file", request.study_file, "study file (TOML); without it the literature's levels and no milling",
                 "FILE");
        set.out_dir(request.out_dir);
        set.examples({"study dhfg", "study dhfg --file trials.toml --quick"});
        set.flag("--quick", request.quick, "coarse tolerances of the planned paths");
        set.text("--shard", request.shard, samples::kShardHelp, "i/n");
      },
      study_dhfg, &commands::kStudies));
}

}  // namespace toothpath::studies
