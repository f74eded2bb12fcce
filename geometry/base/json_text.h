// JSON as text. Names of files and folders may be any bytes; JSON is UTF-8.
#pragma once

#include <string>

namespace toothpath {

/// @param json    of nlohmann::basic_json; bytes of its texts that are not UTF-8 become U+FFFD
/// @param indent  of a level; -1: all in one line
template <typename Json>
[[nodiscard]] std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace toothpath
