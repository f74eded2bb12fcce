// LinuxCNC 2.9, interp_convert.cc (py, pyrun, pyreload, log..), emccanon.cc (probeopen, probeclose, rpy), glcanon.py
// (axis, preview). A comment that begins with ; is one as well; Debian's 2.9 executes ";py," at the beginning of a
// line.
#include "postproc/controls/linuxcnc/comments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace toothpath::controls {
namespace {

struct Acting {
  std::string_view name;  ///< upper case
  std::string_view next;  ///< what must follow behind blanks; empty: anything may
  const char* does;
};

constexpr const char* kPython = "runs Python in the interpreter, which may move the machine and write files";
constexpr const char* kWritesFile = "writes a file at the control";
constexpr const char* kPreview = "lets the preview leave out what follows";

constexpr Acting kActing[] = {{"PYRELOAD", "", "loads the Python of the machine again"},
                              {"PYRUN", ",", kPython},
                              {"PY", ",", kPython},
                              {"LOGOPEN", ",", kWritesFile},
                              {"LOGAPPEND", ",", kWritesFile},
                              {"LOGCLOSE", "", "closes a file that is written at the control"},
                              {"LOG", ",", kWritesFile},
                              {"PROBEOPEN", "", kWritesFile},
                              {"PROBECLOSE", "", "closes a file that is written at the control"},
                              {"RPY", "", "turns the axes of the moves that follow"},
                              {"AXIS", ",HIDE", kPreview},
                              {"AXIS", ",STOP", kPreview},
                              {"PREVIEW", ",HIDE", kPreview},
                              {"PREVIEW", ",STOP", kPreview}};

bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// `text` begins with `wanted`, whatever its case and with blanks ahead of every sign that is no letter.
bool begins(std::string_view& text, std::string_view wanted) {
  std::size_t i = 0;
  for (const char w : wanted) {
    const bool inside = i > 0 && std::isalpha(static_cast<unsigned char>(w)) != 0 &&
                        std::isalpha(static_cast<unsigned char>(text[i - 1])) != 0;
    while (!inside && i < text.size() && is_blank(text[i])) ++i;
    if (i >= text.size() || std::toupper(static_cast<unsigned char>(text[i])) != w) return false;
    ++i;
  }
  text.remove_prefix(i);
  return true;
}

}  // namespace

std::optional<readback::ActingComment> linuxcnc_acting_comment(std::string_view line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] != '(' && line[i] != ';') continue;
    for (const Acting& a : kActing) {
      std::string_view text = line.substr(i + 1);
      if (!begins(text, a.name) || !begins(text, a.next)) continue;
      const bool comma = !a.next.empty();
      return readback::ActingComment{
          static_cast<int>(i) + 1, fmt::format("comment {}{}{}{}: LinuxCNC {}", line[i], a.name, comma ? ", .." : " ..",
                                               line[i] == '(' ? ")" : "", a.does)};
    }
  }
  return std::nullopt;
}

}  // namespace toothpath::controls
