// One thing that a run or a check found out about the part: what the page, the table on the screen and report.json say
// of it is said once, here.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

namespace toothpath::report {

struct Finding {
  enum class State { plain, good, bad };
  using Detail = std::variant<double, std::size_t, std::string, std::nullptr_t>;

  std::string key;              ///< in report.json: an object; details of one key go into the same object
  std::string label;            ///< for people: "highest ridge"; empty: only report.json says it
  double value = 0;             ///< in `unit`
  std::optional<double> limit;  ///< what was asked for, in `unit`
  std::string unit;
  int decimals = 2;
  State state = State::plain;
  std::string text;        ///< instead of value and unit
  std::string note;        ///< instead of the limit
  std::string unfinished;  ///< a sentence: what the program leaves, though nothing is wrong with what it cuts; it
                           ///< stands beside the verdict
  std::vector<std::pair<std::string, Detail>> details;  ///< what stands below `key`, in this order

  [[nodiscard]] std::string value_text() const {
    return !text.empty() ? text : fmt::format("{:.{}f}", value, decimals);
  }
  [[nodiscard]] std::string limit_text() const {
    return !note.empty() ? note : limit ? fmt::format("asked {:.{}f}", *limit, decimals) : std::string();
  }
  /// On the screen: "0.0421 mm (asked 0.1000 mm)".
  [[nodiscard]] std::string row_text() const {
    const std::string space = unit.empty() ? "" : " ", beside = limit_text();
    return value_text() + space + unit + (beside.empty() ? "" : " (" + beside + space + unit + ")");
  }
};

}  // namespace toothpath::report
