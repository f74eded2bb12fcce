#include "app/studies/machine_errors.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/job/file.h"
#include "app/process/flow/stages.h"
#include "app/process/program_report.h"
#include "app/process/proof_limits.h"
#include "app/studies/errors/head.h"
#include "app/studies/merge.h"
#include "app/studies/samples/run_shard.h"
#include "geometry/base/json_text.h"

namespace toothpath::studies {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kSamplesOfRow = 24;
constexpr process::FlankGrid kCoarse{12, 9};  // of a flank: errors of a machine are smooth on it

/// What all samples stand on.
struct Study {
  flow::Run run;
  std::vector<errors::Error> errors;
  std::unique_ptr<errors::RealFlanks> flanks;
  samples::Head head;
  explicit Study(bool quiet) : run(quiet) {}
};

samples::Head head_of(const MachineErrorsRequest& request, const Study& study) {
  Json head{{"study", errors::kStudy}, {"version", errors::kVersion}, {"key", ""}};
  const int rows = int(study.errors.size()) + 1;
  head["samples"] = request.samples.value_or(kSamplesOfRow) * rows;
  head["seed"] = request.seed.value_or(1);
  head["job"] = study.run.job.name;
  head["machine"] = study.run.machine.name;
  head["teeth"] = study.flanks->teeth();
  head["fine"] = request.fine;
  head["verified"] = study.run.report.verified;
  head["nominal"] = errors::json_of(study.flanks->nominal());
  head["errors"] = errors::json_of(study.errors);
  head["key"] = samples::key_of({json_text(head), study.run.program_text});
  return {errors::kStudy, head["samples"], json_text(head), errors::kVersion};
}

/// Job, machine, errors, program; the gear beside its nominal flanks. Nothing: done.
std::vector<Diagnostic> begin(const MachineErrorsRequest& request, Study& study, app::OutputDir& scratch) {
  flow::Run& run = study.run;
  auto read = run.clock.run("job", [&] { return job::read_job_file(request.job_file); });
  if (auto* errors = read.refused()) return std::move(*errors);
  run.job = std::move(read).value();
  if (auto errors = flow::prepare(run, {}); !errors.empty()) return errors;
  if (!run.job.setup)
    return {fail_at(run.job.where("setup"), "the job lacks a [setup]: where the gear stands is not known")};
  study.errors = errors::errors_of(run.machine, run.job);
  if (const auto set = errors::set_sizes(study.errors, request.errors, request.only); !set) return {set.error()};
  const auto limits = process::proof_limits(run.job);
  const process::FlankGrid grid = request.fine ? process::FlankGrid{} : kCoarse;
  if (const auto stopped = flow::plan_post_and_prove(run, scratch, limits, grid)) return {*stopped};
  process::discard_program(scratch);
  auto flanks = run.clock.run("nominal flanks", [&] { return errors::RealFlanks::make(run, limits, grid); });
  if (!flanks) return {flanks.error()};
  study.flanks = std::move(*flanks);
  study.head = head_of(request, study);
  return {};
}

Result<std::string> sample_line(Study& study, int sample, int seed) {
  const samples::Numbers numbers{std::uint64_t(seed), std::uint64_t(sample)};
  const auto which = errors::error_of_sample(sample, study.errors.size());
  const errors::Drawn drawn = errors::draw(study.errors, which, study.run.machine.chain, study.run.job, numbers);
  const int tooth = numbers.whole(0, study.flanks->teeth());
  const auto cost = study.flanks->cost(drawn, tooth);
  if (!cost) return fail("sample {}: {}", sample, cost.error().message);
  Json json{{"sample", sample},
            {"error", which ? study.errors[*which].name : errors::kAll},
            {"tooth", tooth},
            {"magnitude", drawn.magnitude}};
  json.update(errors::json_of(*cost));
  return json_text(json);
}

}  // namespace

commands::CommandOutcome study_machine_errors(const MachineErrorsRequest& request) {
  const auto shard = samples::shard_of(request.shard);
  if (!shard) return commands::failed(shard.error());
  commands::CommandOutcome outcome;
  {
    Study study(request.quiet);
    // Shards share a directory: each plans in a folder of its own.
    auto scratch = app::OutputDir::open_below(request.out_dir, fmt::format(".shard{}of{}", shard->number, shard->count),
                                              {"program."}, {request.job_file});
    if (!scratch) return commands::failed(scratch.error());
    if (auto errors = begin(request, study, *scratch); !errors.empty()) {
      study.run.progress.clear();
      return commands::failed(std::move(errors));
    }
    const auto ran = study.run.clock.run("samples", [&] {
      return samples::run_shard(request.out_dir, *shard, study.head,
                                [&](int k) { return sample_line(study, k, request.seed.value_or(1)); });
    });
    study.run.progress.clear();
    if (!ran) return commands::failed(ran.error());
    outcome.summary = ran->summary();
  }
  if (shard->count > 1) return outcome;
  commands::CommandOutcome merged = study_merge({{request.quiet, request.color}, request.out_dir});
  merged.summary = outcome.summary + merged.summary;
  return merged;
}

void add_machine_errors(commands::Commands& commands) {
  commands.push_back(commands::command_of<MachineErrorsRequest>(
      "machine-errors", "what errors of the machine cost on the flank, by many samples through the proof",
      [](commands::OptionSet& set, MachineErrorsRequest& request) {
        commands::job_options(set, request);
        set.examples({"study machine-errors gear.toml", "study machine-errors gear.toml --error C.pivot=5 --only"});
        set.whole_number("--samples", request.samples,
                         "samples of each error alone, and of all together: 1 to 100000 (24)", {1, 100000});
        set.whole_number("--seed", request.seed, "of the random numbers: 0 to 2147483647 (1)", {0, 2147483647});
        set.text("--shard", request.shard, samples::kShardHelp, "i/n");
        set.texts("--error", request.errors,
                  "size (standard deviation) of an error, um or urad: C.pivot=5; 0 leaves it out; repeatable",
                  "NAME=SIZE");
        set.flag("--only", request.only, "only the errors named by --error");
        set.flag("--fine", request.fine, "as many points of a flank as run measures");
      },
      study_machine_errors, &commands::kStudies));
}

}  // namespace toothpath::studies
