#include "tests/controller/short_program.h"

#include <regex>
#include <sstream>
#include <vector>

namespace toothpath::test {

Result<std::string> short_program(const std::string& text, const std::string& teeth, const std::string& corners_line) {
  std::vector<std::string> counts;
  std::istringstream list(teeth), in(text);
  for (std::string count; std::getline(list, count, ',');) counts.push_back(count);
  const std::regex loop(R"(\[#1 LT (\d+)\])"), tooth(R"(\(TOOTH (\d+)\))"), corners(R"(^(G64 P[0-9.]+ Q0|G61)$)");
  std::string out;
  std::size_t operations = 0;
  bool dropped = false;
  for (std::string line; std::getline(in, line);) {
    std::smatch m;
    if (line.rfind("(OP ", 0) == 0 && ++operations > counts.size())
      return fail("the program has more operations than \"{}\"", teeth);
    if (std::regex_search(line, m, tooth)) dropped = std::stoi(m[1]) >= std::stoi(counts.at(operations - 1));
    const bool head = std::regex_search(line, loop);
    if (head && std::stoi(counts.at(operations - 1)) == 0) dropped = true;
    if (line.rfind("G94 F", 0) == 0 || line == "M5") dropped = false;  // the end of the operation
    if (dropped) continue;
    if (head) line = std::regex_replace(line, loop, "[#1 LT " + counts.at(operations - 1) + "]");
    if (corners_line != "written") line = std::regex_replace(line, corners, corners_line);
    out += line + "\n";
  }
  if (operations < counts.size()) return fail("the program has fewer operations than \"{}\"", teeth);
  return out;
}

}  // namespace toothpath::test
