// The only reader of job files: TOML text to a Job, or every diagnostic that the file deserves.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/job/job.h"

namespace toothpath::job {

/// A larger job file is refused before it is parsed.
inline constexpr std::size_t kMaxJobBytes = 4u << 20;

/// What a reader returns: the job, or all that is wrong with it, in the order of the file.
using JobOrErrors = Expected<Job, std::vector<Diagnostic>>;

/// Reads and checks the job at `path`.
///
/// Refused: anything but a regular file, more than kMaxJobBytes, text that is not UTF-8 TOML 1.0, unknown keys, wrong
/// types, NaN, infinity, missing keys, values out of range or that contradict each other. All findings are collected,
/// each with line and column. A file that cannot be opened is `DiagnosticKind::file_access`.
[[nodiscard]] JobOrErrors read_job_file(const std::string& path);

/// The same from text; `file` is what the diagnostics call it.
[[nodiscard]] JobOrErrors parse_job(std::string_view text, const std::string& file);

/// The keys that the reader asks of a job. Returns what is wrong with it, in the order of asking.
/// @param document  a table; `file` is what it came from: what it names is looked up beside it
std::vector<Diagnostic> note_job_keys(const toml::TomlValue& document, const std::string& file, toml::KeyNotes& notes);

}  // namespace toothpath::job
