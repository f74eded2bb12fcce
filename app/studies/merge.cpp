#include "app/process/opening_and_end.h"
#include "app/studies/errors/head.h"
#include "app/studies/errors/summary.h"
#include "app/studies/machine_errors.h"
#include "app/studies/samples/sample_file.h"

namespace toothpath::studies {
namespace {

constexpr const char* kSamples = "samples.jsonl";

}  // namespace

commands::CommandOutcome study_merge(const MergeRequest& request) {
  auto merged = samples::merge(request.directory);
  if (!merged) return commands::failed(merged.error());
  if (merged->head.study != errors::kStudy)
    return commands::failed(
        fail("{}: study \"{}\" is not known; known: {}", request.directory, merged->head.study, errors::kStudy));
  auto summary = errors::summary_of(*merged);
  if (!summary) return commands::failed(summary.error());
  std::vector<std::string> names = errors::kSummaryFiles;
  names.emplace_back(kSamples);
  auto output = app::OutputDir::open(request.directory, names);
  if (!output) return commands::failed(output.error());
  summary->files.emplace_back(kSamples, std::move(merged->text));
  commands::CommandOutcome outcome;
  outcome.report_json = std::move(summary->json);
  outcome.summary = std::move(summary->text);
  return process::finished(*output, summary->files, std::move(outcome));
}

void add_merge(commands::Commands& commands) {
  commands.push_back(commands::command_of<MergeRequest>(
      "merge", "the shards of a study put together",
      [](commands::OptionSet& set, MergeRequest& request) {
        set.file("DIR", request.directory, "directory that the shards wrote into (their --out)");
      },
      study_merge, &commands::kStudies));
}

}  // namespace toothpath::studies
