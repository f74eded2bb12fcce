// Whose results stand in a directory: the words for it, so that nobody takes old results for new ones.
#pragma once

#include <string>
#include <vector>

#include "app/files/folder.h"

namespace toothpath::app {

/// One line: command, job, time and program with the first digits of its hash, as far as report.json says so; else the
/// first of the files and its time. Control characters of names are left out. Empty where `names` is. No link is read.
/// @param names  files of the results that stand there, programs first
[[nodiscard]] std::string describe_results(const files::Folder& folder, const std::vector<std::string>& names);

}  // namespace toothpath::app
