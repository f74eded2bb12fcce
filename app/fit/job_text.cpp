#include "app/fit/job_text.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "app/job/file.h"

namespace toothpath::fit {
namespace {

constexpr double kChanged = 1e-12;  // of a reach: less is no change
constexpr double kWritten = 1e-9;   // of a number: what its digits in the text hold

std::string digits(double x) {
  std::string text = fmt::format("{:.11g}", x == 0 ? 0.0 : x);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

/// "cut[0].blade_point_radius" of "cut[0].blade_point_radius[1]".
std::string list_key(const std::string& key) { return key.back() == ']' ? key.substr(0, key.rfind('[')) : key; }

/// Where a place of the text is: columns count characters.
std::size_t offset_of(const std::string& text, const SourcePosition& at) {
  std::size_t offset = 0;
  for (int line = 1; line < at.line && offset < text.size(); ++line) offset = text.find('\n', offset) + 1;
  for (int column = 1; column < at.column && offset < text.size(); ++column) {
    ++offset;
    while (offset < text.size() && (static_cast<unsigned char>(text[offset]) & 0xC0) == 0x80) ++offset;
  }
  return offset;
}

/// Behind the value that begins there: a number, or a list of them.
std::size_t end_of_value(const std::string& text, std::size_t from) {
  const std::size_t end = text[from] == '[' ? text.find(']', from) : text.find_first_of(" \t\r\n#,]}", from);
  if (end == std::string::npos) return text.size();
  return text[from] == '[' ? end + 1 : end;
}

/// A key of the job with its new value.
struct Change {
  std::string key, value;
};
std::vector<Change> changes_of(const job::Job& job, const Fitted& fitted) {
  std::map<std::string, std::vector<double>> lists;
  std::vector<std::string> changed;
  for (const auto* numbers : {&fitted.numbers.free, &fitted.numbers.follow})
    for (const Number& n : *numbers) {
      const double value = n.get(fitted.gear);
      const std::string key = list_key(n.key);
      lists[key].push_back(value);
      const bool written = job.positions.contains("gear." + key);
      if (std::abs(value - n.get(job.gear)) > kChanged * n.reach && (written || !n.where_written) &&
          std::find(changed.begin(), changed.end(), key) == changed.end())
        changed.push_back(key);
    }
  std::vector<Change> out;
  for (const std::string& key : changed) {
    const auto& list = lists[key];
    out.push_back(
        {key, list.size() == 1 ? digits(list[0]) : fmt::format("[{}, {}]", digits(list[0]), digits(list[1]))});
  }
  return out;
}

/// The key of the same table behind which a new one may stand.
std::string neighbour(const std::string& key) {
  const auto dot = key.rfind('.');
  if (dot == std::string::npos) return "gear.type";
  const std::string table = key.substr(0, dot);
  return "gear." + table + ".flank";  // of a zone all keys must stand there
}

}  // namespace

Expected<std::string, std::vector<Diagnostic>> job_with_numbers(const job::Job& job, const std::string& text,
                                                                const Fitted& fitted, const std::string& file) {
  struct Edit {
    std::size_t from = 0, to = 0;
    std::string text;
  };
  std::vector<Edit> edits;
  for (const auto& [key, value] : changes_of(job, fitted)) {
    if (const auto at = job.positions.find("gear." + key); at != job.positions.end()) {
      const std::size_t from = offset_of(text, at->second);
      edits.push_back({from, end_of_value(text, from), value});
      continue;
    }
    const std::size_t line = text.find('\n', offset_of(text, job.where(neighbour(key))));
    const std::size_t to = line == std::string::npos ? text.size() : line;
    edits.push_back({to, to, "\n" + key.substr(key.rfind('.') + 1) + " = " + value});
  }
  std::stable_sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.from > b.from; });
  std::string out = text;
  for (const Edit& edit : edits) out.replace(edit.from, edit.to - edit.from, edit.text);
  auto read = job::parse_job(out, file);
  if (auto* errors = read.refused()) return std::move(*errors);
  for (const auto* numbers : {&fitted.numbers.free, &fitted.numbers.follow})
    for (const Number& n : *numbers)
      if (const double wanted = n.get(fitted.gear), there = n.get(read.value().gear);
          !(std::abs(there - wanted) <= kWritten * std::max(1.0, std::abs(wanted))))
        return std::vector{fail_at(job.where("gear." + n.key),
                                   "the job does not take {} = {:.11g} here: write this key as a line of its own table",
                                   n.key, wanted)};
  return out;
}

}  // namespace toothpath::fit
