#include "geometry/base/diagnostic.h"

#include "geometry/base/printable.h"

namespace toothpath {

std::string Diagnostic::text() const {
  std::string out;
  if (!position.file.empty()) {
    out += printable(position.file) + ":";
    if (position.line > 0) {
      out += std::to_string(position.line) + ":";
      if (position.column > 0) out += std::to_string(position.column) + ":";
    }
    out += " ";
  }
  return out + "error: " + printable(message);
}

std::string to_text(const std::vector<Diagnostic>& diagnostics) {
  std::string out;
  for (const auto& d : diagnostics) out += d.text() + "\n";
  return out;
}

}  // namespace toothpath
