#include "postproc/work_offset.h"

#include <algorithm>
#include <charconv>

namespace toothpath {
namespace {

/// Whole number above 0, without leading zeros, that is all of the text; -1: it is none.
int whole(std::string_view text) {
  int n = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
  return error == std::errc() && end == text.data() + text.size() && !text.empty() && text[0] >= '1' && text[0] <= '9' ? n : -1;
}

/// n of "G54.1 Pn"; -1: the name is none of these.
int extended_number(std::string_view name) { return name.substr(0, 7) == "G54.1 P" ? whole(name.substr(7)) : -1; }

/// 54 to 59 of G54 to G59; -1: the name is none of these.
int basic_number(std::string_view name) {
  const int n = name.size() == 3 && name[0] == 'G' ? whole(name.substr(1)) : -1;
  return n >= 54 && n <= 59 ? n : -1;
}

/// 1 to 3 of G59.1 to G59.3; -1: the name is none of these.
int tenth_number(std::string_view name) {
  const int n = name.size() == 5 && name.substr(0, 4) == "G59." ? whole(name.substr(4)) : -1;
  return n >= 1 && n <= 3 ? n : -1;
}

bool between(int n, int low, int high) { return n >= low && n <= high; }

}  // namespace

int preset_number(std::string_view name) {
  if (const int n = basic_number(name); n > 0) return n - 53;
  if (const int n = tenth_number(name); n > 0) return 6 + n;
  if (const int n = extended_number(name); n > 0) return n;
  return std::max(0, whole(name));
}

std::optional<std::string> other_work_offsets(std::string_view dialect, std::string_view name) {
  const bool basic = basic_number(name) > 0, tenth = tenth_number(name) > 0;
  if (dialect == "linuxcnc") {
    if (basic || tenth) return std::nullopt;
    return "G54 to G59 and G59.1 to G59.3";
  }
  if (dialect == "fanuc" || dialect == "mitsubishi_m80") {
    if (basic || between(extended_number(name), 1, 300)) return std::nullopt;
    return "G54 to G59 and G54.1 P1 to P300";
  }
  if (dialect == "siemens") {
    const int n = !name.empty() && name[0] == 'G' ? whole(name.substr(1)) : -1;
    if (between(n, 54, 57) || between(n, 505, 599)) return std::nullopt;
    return "G54 to G57 and G505 to G599 (G58 and G59 shift single axes)";
  }
  if (dialect == "heidenhain") {
    if (basic || tenth || between(whole(name), 1, 99)) return std::nullopt;
    return "the presets 1 to 99, or G54 for preset 1 to G59 for 6, G59.1 for 7 to G59.3 for 9";
  }
  if (dialect == "apt") return std::nullopt;  // cutter location data know no work offset
  return "none that is known: there is no such control";
}

}  // namespace toothpath
