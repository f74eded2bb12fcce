#include "app/studies/samples/sample_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "machines/toml/regular_file.h"

namespace toothpath::samples {
namespace {

using Json = nlohmann::json;
constexpr std::size_t kMostBytes = std::size_t(1) << 30;
constexpr int kMostSamples = 100'000'000, kMostVersion = 1000;

Diagnostic not_accessible(const std::string& path, const char* what) {
  return fail_as(DiagnosticKind::file_access, "{}: {}: {}", path, what, std::strerror(errno));
}

/// The sample of a line; nothing: it is none.
std::optional<int> sample_of(const std::string& line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object() || !json.contains("sample") || !json["sample"].is_number_integer()) return std::nullopt;
  const auto sample = json["sample"].get<std::int64_t>();
  return sample < 0 || sample > kMostSamples ? std::nullopt : std::optional(int(sample));
}

/// Lines that end in a line feed; what stands behind the last of them was cut off.
std::vector<std::string> whole_lines(std::string_view text) {
  std::vector<std::string> lines;
  for (std::size_t end; (end = text.find('\n')) != std::string_view::npos; text.remove_prefix(end + 1))
    lines.emplace_back(text.substr(0, end));
  return lines;
}

struct Line {
  int sample = 0, number = 0;  ///< of the file, from 1
  std::string text;
};

Result<std::vector<Line>> lines_of(const std::string& path, const std::vector<std::string>& lines, const Head& head) {
  std::vector<Line> out;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const auto sample = sample_of(lines[k]);
    const int number = int(k) + 1;
    if (!sample)
      return fail_at({path, number, 1},
                     "no sample: not a JSON object with a whole number \"sample\"; take the line out "
                     "and run the shard again");
    if (*sample >= head.samples)
      return fail_at({path, number, 1}, "sample {} is beyond the study's {} samples, 0 to {}", *sample, head.samples,
                     head.samples - 1);
    out.push_back({*sample, number, lines[k]});
  }
  return out;
}

/// The keys in which two heads differ.
std::string differences(const std::string& one, const std::string& other) {
  const Json a = Json::parse(one, nullptr, false), b = Json::parse(other, nullptr, false);
  std::string names;
  if (a.is_object() && b.is_object())
    for (const auto& [key, value] : a.items())
      if (!b.contains(key) || b[key] != value) names += (names.empty() ? "" : ", ") + key;
  return names.empty() ? "bytes" : names;
}

Diagnostic other_study(const std::string& path, const std::string& stands, const std::string& wanted,
                       const char* what_helps) {
  return fail_at({path, 1, 1}, "this file is of another study (they differ in: {}); {}", differences(wanted, stands),
                 what_helps);
}

/// "3, 7, 12 and 40 more".
std::string some_of(const std::vector<int>& numbers) {
  constexpr std::size_t kSome = 10;
  std::string text;
  for (std::size_t k = 0; k < std::min(kSome, numbers.size()); ++k)
    text += (k == 0 ? "" : ", ") + std::to_string(numbers[k]);
  return numbers.size() > kSome ? text + fmt::format(" and {} more", numbers.size() - kSome) : text;
}

Result<std::vector<std::string>> files_of(const std::string& directory) {
  std::vector<std::string> files;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(directory, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with("samples.") && name.ends_with(".jsonl") && name != "samples.jsonl")
      files.push_back(entry->path().string());
  }
  if (error) return fail_as(DiagnosticKind::file_access, "{}: cannot be read: {}", directory, error.message());
  std::sort(files.begin(), files.end());
  if (files.empty())
    return fail_as(DiagnosticKind::file_access,
                   "{}: no file samples.IofN.jsonl is there: run a study with --shard first", directory);
  return files;
}

}  // namespace

Result<Head> read_head(const std::string& line) {
  const Json json = Json::parse(line, nullptr, false);
  const auto has = [&](const char* key, bool (Json::*is)() const noexcept) {
    return json.contains(key) && (json[key].*is)();
  };
  if (!json.is_object() || !has("study", &Json::is_string) || !has("version", &Json::is_number_integer) ||
      !has("key", &Json::is_string) || !has("samples", &Json::is_number_integer))
    return fail(
        "not the head of a study: a JSON object with \"study\" and \"key\" (texts), \"version\" and \"samples\" (whole "
        "numbers)");
  const auto samples = json["samples"].get<std::int64_t>(), version = json["version"].get<std::int64_t>();
  if (samples < 1 || samples > kMostSamples) return fail("samples = {} is not within 1 to {}", samples, kMostSamples);
  if (version < 1 || version > kMostVersion) return fail("version = {} is not within 1 to {}", version, kMostVersion);
  return Head{json["study"].get<std::string>(), int(samples), line, int(version)};
}

Status SampleFile::take_up(const std::string& text, const Shard& shard, const Head& head) {
  const std::vector<std::string> lines = whole_lines(text);
  std::size_t kept = 0;
  for (const auto& line : lines) kept += line.size() + 1;
  if (lines.empty() && !(head.line + '\n').starts_with(text))
    return fail_at({path_, 1, 1}, "not the head of this study; choose another directory, or take the file away");
  if (!lines.empty() && lines.front() != head.line)
    return other_study(path_, lines.front(), head.line, "choose another directory, or take the file away");
  auto read = lines_of(path_, lines, head);
  if (!read) return read.error();
  for (const Line& line : *read) {
    if (!shard.has(line.sample))
      return fail_at({path_, line.number, 1}, "sample {} is not of shard {}", line.sample, shard.text());
    done_.insert(line.sample);
  }
  if (kept < text.size() && ::ftruncate(::fileno(file_.get()), off_t(kept)) != 0)
    return not_accessible(path_, "a line that was cut off cannot be taken away");
  return lines.empty() ? write(head.line) : Ok{};
}

Result<SampleFile> SampleFile::open(const std::string& directory, const Shard& shard, const Head& head) {
  std::vector<files::Folder::Made> made;
  const auto folder = files::Folder::open_or_make(directory, made);
  if (!folder) return folder.error();
  const auto handle = folder->open_file(shard.file_name(), O_RDWR | O_CREAT | O_APPEND);
  if (!handle) return handle.error();
  SampleFile out;
  out.path_ = folder->at(shard.file_name());
  out.file_.reset(::fdopen(*handle, "a+b"));
  if (!out.file_) {
    ::close(*handle);
    return not_accessible(out.path_, "cannot be opened");
  }
  if (::flock(*handle, LOCK_EX | LOCK_NB) != 0)
    return fail_as(DiagnosticKind::file_access, "{}: another process is writing shard {}", out.path_, shard.text());
  struct stat status {};
  if (::fstat(*handle, &status) == 0 && status.st_nlink > 1)
    return fail_as(
        DiagnosticKind::file_access,
        "{}: the file has {} names (hard links), and lines that are added would stand under all of them: put "
        "a copy in its place",
        out.path_, status.st_nlink);
  const auto text = toml::read_regular_file(*handle, out.path_, kMostBytes);
  if (!text) return text.error();
  if (auto taken = out.take_up(*text, shard, head); !taken) return taken.error();
  return out;
}

Status SampleFile::write(const std::string& line) {
  const std::string text = line + '\n';
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() || std::fflush(file_.get()) != 0)
    return not_accessible(path_, "cannot be written");
  return Ok{};
}

Status SampleFile::add(int sample, const std::string& line) {
  auto written = write(line);
  if (written) done_.insert(sample);
  return written;
}

Result<Merged> merge(const std::string& directory) {
  const auto files = files_of(directory);
  if (!files) return files.error();
  Merged merged;
  std::map<int, std::pair<Line, std::string>> samples;  // and the file of each
  std::string first;
  for (const std::string& path : *files) {
    const auto text = toml::read_input_file(path, kMostBytes);
    if (!text) return text.error();
    const std::vector<std::string> lines = whole_lines(*text);
    if (lines.empty()) continue;  // killed before its head was whole
    auto head = read_head(lines.front());
    if (!head) return fail_at({path, 1, 1}, "{}", head.error().message);
    if (first.empty()) {
      first = path;
      merged.head = *head;
      merged.head_place = {path, 1, 1};
    } else if (head->line != merged.head.line) {
      return other_study(path, head->line, merged.head.line,
                         ("than " + first + "; one directory holds one study").c_str());
    }
    auto read = lines_of(path, lines, *head);
    if (!read) return read.error();
    for (Line& line : *read) {
      const auto [place, fresh] = samples.try_emplace(line.sample, line, path);
      if (!fresh && place->second.first.text != line.text)
        return fail_at({path, line.number, 1},
                       "sample {} has another result than in {}:{}; it must be the same on every "
                       "machine: take one of the files away and run its shard again",
                       line.sample, place->second.second, place->second.first.number);
    }
  }
  if (first.empty()) return fail_at({files->front(), 1, 1}, "no head of a study: run the shard again");
  std::vector<int> missing;
  for (int k = 0; k < merged.head.samples; ++k)
    if (!samples.contains(k)) missing.push_back(k);
  if (!missing.empty())
    return fail_at({directory, 0, 0}, "{} of {} samples are missing: {}; run the shards that have them to their end",
                   missing.size(), merged.head.samples, some_of(missing));
  merged.text = merged.head.line + '\n';
  for (auto& [sample, found] : samples) {
    merged.text += found.first.text + '\n';
    merged.lines.push_back({std::move(found.first.text), {found.second, found.first.number, 1}});
  }
  return merged;
}

}  // namespace toothpath::samples
