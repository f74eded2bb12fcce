#include "app/probing/touch_file.h"

#include <algorithm>
#include <cmath>

#include "geometry/inspection/point_words.h"

namespace toothpath::probing {
namespace {

bool parts(char c) { return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r'; }

}  // namespace

Result<std::vector<inspection::TouchResult>> parse_touches(std::string_view text, const std::string& file) {
  std::vector<inspection::TouchResult> out;
  int number = 0;
  while (!text.empty()) {
    const auto end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++number;
    std::size_t at = 0;
    while (at < line.size() && (line[at] == ' ' || line[at] == '\t' || line[at] == '\r')) ++at;
    if (inspection::is_comment(line.substr(at))) continue;
    double value[4] = {};
    int count = 0;
    inspection::TouchResult result;
    result.at = {file, number, int(at) + 1};
    while (at < line.size()) {
      while (at < line.size() && parts(line[at])) ++at;
      if (at == line.size()) break;
      const std::size_t from = at;
      while (at < line.size() && !parts(line[at])) ++at;
      std::string_view cell = line.substr(from, at - from);
      if (count < 4 && cell.size() > 1 && cell.front() == "TXYZ"[count]) cell.remove_prefix(1);
      if (count >= 4) {
        ++count;
        continue;
      }
      if (!inspection::read_number(cell, value[count]))
        return fail_at({file, number, int(from) + 1}, "\"{}\" is no finite number", cell);
      ++count;
    }
    if (count != 4) return fail_at(result.at, "{} columns, must be 4: number x y z", count);
    result.number = value[0] >= 1 && value[0] <= 1e6 ? int(std::lround(value[0])) : 0;
    if (double(result.number) != value[0]) return fail_at(result.at, "\"{:g}\" is no number of a touch", value[0]);
    result.centre = Vec3(value[1], value[2], value[3]);
    out.push_back(std::move(result));
  }
  if (out.empty()) return fail_at({file, std::max(number, 1), 1}, "no touch: lines number x y z are needed");
  return out;
}

}  // namespace toothpath::probing
