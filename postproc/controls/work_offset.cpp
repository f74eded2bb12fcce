#include "postproc/controls/work_offset.h"

#include <charconv>
#include <system_error>

namespace toothpath::controls {

int whole_number(std::string_view text) {
  int n = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
  return error == std::errc() && end == text.data() + text.size() && !text.empty() && text[0] >= '1' && text[0] <= '9'
             ? n
             : -1;
}

int basic_offset(std::string_view name) {
  const int n = name.size() == 3 && name[0] == 'G' ? whole_number(name.substr(1)) : -1;
  return n >= 54 && n <= 59 ? n : -1;
}

int tenth_offset(std::string_view name) {
  const int n = name.size() == 5 && name.substr(0, 4) == "G59." ? whole_number(name.substr(4)) : -1;
  return n >= 1 && n <= 3 ? n : -1;
}

int extended_offset(std::string_view name, std::string_view prefix) {
  return name.substr(0, prefix.size()) == prefix ? whole_number(name.substr(prefix.size())) : -1;
}

}  // namespace toothpath::controls
