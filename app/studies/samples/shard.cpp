#include "app/studies/samples/shard.h"

#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>

namespace toothpath::samples {
namespace {

/// 0 and more; below 0: it is no whole number.
int whole(std::string_view text) {
  int value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : -1;
}

/// A variable of Slurm, or `otherwise` where there is none.
Result<int> variable(const char* name, std::optional<int> otherwise = {}) {
  const char* text = std::getenv(name);
  if (text == nullptr && otherwise) return *otherwise;
  if (text == nullptr)
    return fail_as(DiagnosticKind::usage, "SLURM_ARRAY_TASK_ID is set and {} is not: name the shard with --shard",
                   name);
  if (const int value = whole(text); value >= 0) return value;
  return fail_as(DiagnosticKind::usage, "{} = \"{}\" is no whole number", name, text);
}

Result<Shard> shard_of_array() {
  int values[4];
  const Result<int> read[] = {variable("SLURM_ARRAY_TASK_ID"), variable("SLURM_ARRAY_TASK_MIN"),
                              variable("SLURM_ARRAY_TASK_COUNT"), variable("SLURM_ARRAY_TASK_STEP", 1)};
  for (int k = 0; k < 4; ++k) {
    if (!read[k]) return read[k].error();
    values[k] = *read[k];
  }
  const auto [id, least, count, step] = values;
  if (step < 1 || count < 1 || count > kMostShards || id < least || (id - least) % step != 0 ||
      (id - least) / step >= count)
    return fail_as(DiagnosticKind::usage,
                   "task {} of a Slurm array of {} tasks from {} in steps of {} is no shard: the array must be without "
                   "gaps, of at most {} tasks, such as --array=1-8",
                   id, count, least, step, kMostShards);
  return Shard{(id - least) / step + 1, count};
}

}  // namespace

std::string Shard::text() const { return fmt::format("{}/{}", number, count); }
std::string Shard::file_name() const { return fmt::format("samples.{}of{}.jsonl", number, count); }

bool in_slurm_array() { return std::getenv("SLURM_ARRAY_TASK_ID") != nullptr; }

Result<Shard> shard_of(const std::string& option) {
  if (option.empty()) return in_slurm_array() ? shard_of_array() : Shard{};
  const std::string_view text = option;
  const std::size_t slash = text.find('/');
  const int number = whole(text.substr(0, slash)),
            count = slash == std::string_view::npos ? -1 : whole(text.substr(slash + 1));
  if (number < 1 || number > count || count > kMostShards)
    return fail_as(DiagnosticKind::usage, "--shard {}: not i/n with 1 <= i <= n <= {}, such as 3/8", option,
                   kMostShards);
  return Shard{number, count};
}

}  // namespace toothpath::samples
