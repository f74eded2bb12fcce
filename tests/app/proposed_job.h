// The job that `toothpath new` would try first, read by the reader of jobs; nothing is planned.
#pragma once

#include <gtest/gtest.h>

#include "app/job/file.h"
#include "app/job/job.h"
#include "app/proposal/propose.h"

namespace toothpath::test {

struct ProposedJob {
  proposal::Draft draft;
  job::Job job;
};

/// @param file  of the job: what it names lies beside it
inline ProposedJob proposed_job(proposal::Wishes wishes, const std::string& file) {
  wishes.route = proposal::Route::ball;
  wishes.machine = "xyzac_large";
  const auto machine = proposal::choose_machine(wishes, ".");
  EXPECT_TRUE(machine);
  const auto gear = proposal::choose_gear(wishes);
  if (!gear) ADD_FAILURE() << to_text(gear.error());
  if (!machine || !gear) return {};
  const auto draft = proposal::draft_of("proposed", wishes, machine.value(), gear.value(), {}, 0);
  if (!draft) ADD_FAILURE() << draft.error().message;
  if (!draft) return {};
  const auto read = job::parse_job(job_text(*draft, {}, ""), file);
  if (!read) ADD_FAILURE() << to_text(read.error());
  return read ? ProposedJob{*draft, *read} : ProposedJob{};
}

}  // namespace toothpath::test
