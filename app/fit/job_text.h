// A job with other numbers in its [gear]: the text as it stands, comments and all, with these numbers replaced.
#pragma once

#include <string>

#include "app/fit/fit.h"

namespace toothpath::fit {

/// @param text  of the job;  @param file  the name that it will have: what it names is looked up beside it
/// Refused: numbers that the job cannot take where they belong; what its reader refuses then.
[[nodiscard]] Expected<std::string, std::vector<Diagnostic>> job_with_numbers(const job::Job& job,
                                                                              const std::string& text,
                                                                              const Fitted& fitted,
                                                                              const std::string& file);

}  // namespace toothpath::fit
