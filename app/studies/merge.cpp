#include "app/studies/merge.h"

#include <algorithm>
#include <iterator>

#include "app/process/opening_and_end.h"
#include "app/studies/errors/head.h"
#include "app/studies/errors/summary.h"
#include "app/studies/samples/sample_file.h"
#include "app/studies/trials/dhfg_summary.h"

namespace toothpath::studies {
namespace {

constexpr const char* kSamples = "samples.jsonl";

/// What a study makes of its samples.
struct Summary {
  process::NamedFiles files;
  std::string json, text;
};

Result<Summary> machine_errors(const samples::Merged& merged) {
  auto made = errors::summary_of(merged);
  if (!made) return made.error();
  return Summary{std::move(made->files), std::move(made->json), std::move(made->text)};
}

Result<Summary> dhfg(const samples::Merged& merged) {
  const auto study = trials::study_of(merged);
  if (!study) return study.error();
  trials::DhfgSummary made = summary_of(study->facts, study->found);
  return Summary{std::move(made.files), std::move(made.json), std::move(made.text)};
}

struct Study {
  const char* name;
  int version;
  const std::vector<std::string>& files;
  Result<Summary> (*summary)(const samples::Merged&);
};
const Study kStudies[] = {{errors::kStudy, errors::kVersion, errors::kSummaryFiles, machine_errors},
                          {trials::kDhfg, trials::kDhfgVersion, trials::kDhfgFiles, dhfg}};

}  // namespace

commands::CommandOutcome study_merge(const MergeRequest& request) {
  auto merged = samples::merge(request.directory);
  if (!merged) return commands::failed(merged.error());
  const auto* study = std::find_if(std::begin(kStudies), std::end(kStudies),
                                   [&](const Study& s) { return s.name == merged->head.study; });
  if (study == std::end(kStudies))
    return commands::failed(fail_at(merged->head_place, "study \"{}\" is not known; known: {}, {}", merged->head.study,
                                    errors::kStudy, trials::kDhfg));
  if (merged->head.version != study->version)
    return commands::failed(fail_at(merged->head_place,
                                    "version = {} of study {}, and this program has version {}: merge with the program "
                                    "that ran the shards, or run them again with this one",
                                    merged->head.version, study->name, study->version));
  auto summary = study->summary(*merged);
  if (!summary) return commands::failed(summary.error());
  std::vector<std::string> names = study->files;
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
        set.examples({"study merge out/study_machine-errors"});
        set.file("DIR", request.directory, "directory that the shards wrote into (their --out)");
      },
      study_merge, &commands::kStudies));
}

}  // namespace toothpath::studies
