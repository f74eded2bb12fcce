#include "app/base/standing_results.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <ctime>
#include <nlohmann/json.hpp>

#include "app/report/svg/html_text.h"

namespace toothpath::app {
namespace {

constexpr const char* kReport = "report.json";
constexpr std::size_t kMostReportBytes = std::size_t(1) << 26;
constexpr std::size_t kShownDigits = 12;  // of a hash
constexpr std::size_t kLongestName = 80;

/// Local time at which the file was written; empty where that is not known.
std::string time_of(const files::Folder& folder, const std::string& name) {
  struct stat status {};
  std::tm local{};
  char text[32] = "";
  if (!folder.look(name, status) || ::localtime_r(&status.st_mtime, &local) == nullptr) return {};
  return std::string(text, std::strftime(text, sizeof text, " of %Y-%m-%d %H:%M", &local));
}

/// A text of a report, safe on a terminal.
std::string text_in(const nlohmann::json& object, const char* key) {
  if (!object.is_object() || !object.contains(key) || !object[key].is_string()) return {};
  std::string text = svg::valid_utf8(object[key].get<std::string>());
  std::erase_if(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
  return text.size() > kLongestName ? svg::valid_utf8(text.substr(0, kLongestName)) + "..." : text;
}

}  // namespace

std::string describe_results(const files::Folder& folder, const std::vector<std::string>& names) {
  if (names.empty()) return {};
  nlohmann::json report;
  if (std::find(names.begin(), names.end(), kReport) != names.end())
    if (const auto text = folder.read(kReport, kMostReportBytes)) report = nlohmann::json::parse(*text, nullptr, false);
  const std::string job = text_in(report, "job"), command = text_in(report, "command");
  if (job.empty()) return names.front() + time_of(folder, names.front());
  std::string out = fmt::format("{} \"{}\"{}", command.empty() ? "job" : command, job, time_of(folder, kReport));
  const nlohmann::json program = report.contains("program") ? report["program"] : nlohmann::json();
  const std::string file = text_in(program, "file"), digits = text_in(program, "sha256");
  if (std::find(names.begin(), names.end(), file) != names.end())
    return fmt::format("{}, {} (sha256 {})", out, file, digits.substr(0, kShownDigits));
  return out;
}

}  // namespace toothpath::app
