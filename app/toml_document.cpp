#include "app/toml_document.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <toml++/toml.h>

namespace toothpath {
namespace {

/// Looks for what could make the parser or its tree recurse without bound. Strings cannot span lines here, so the state of
/// a line does not depend on the lines before it, except for the open brackets.
Status check_nesting(std::string_view text, const std::string& file, int max_nesting) {
  int line = 1, column = 0, depth = 0, dots = 0;
  char quote = 0;
  bool comment = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    ++column;
    if (c == '\n') {
      ++line;
      column = dots = 0;
      quote = 0;
      comment = false;
      continue;
    }
    if (c == '\r' && text.substr(i + 1, 1) != "\n") return fail_at({file, line, column}, "a carriage return without a line feed");
    if (comment) continue;
    if (quote != 0) {
      if (quote == '"' && c == '\\') { ++i; ++column; }
      else if (c == quote) quote = 0;
      continue;
    }
    const SourcePosition here{file, line, column};
    switch (c) {
      case '#': comment = true; break;
      case '"':
      case '\'':
        if (text.substr(i, 3) == std::string(3, c)) return fail_at(here, "multi-line strings are not part of this format");
        quote = c;
        break;
      case '[':
      case '{':
        if (++depth > max_nesting) return fail_at(here, "brackets are nested deeper than {}", max_nesting);
        dots = 0;
        break;
      case ']':
      case '}':
        depth = std::max(0, depth - 1);
        dots = 0;
        break;
      case ',':
      case '=': dots = 0; break;
      case '.':
        if (++dots >= max_nesting) return fail_at(here, "a key has more than {} parts", max_nesting);
        break;
      default: break;
    }
  }
  return Ok{};
}

SourcePosition position_of(const toml::source_region& region, const std::string& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

DocumentValue convert(const toml::node& node, const std::string& file);

DocumentTable convert_table(const toml::table& table, const std::string& file) {
  DocumentTable result;
  for (const auto& [key, value] : table)
    result.members.push_back({std::string(key.str()), position_of(key.source(), file), convert(value, file)});
  const auto before = [](const DocumentMember& a, const DocumentMember& b) {
    return std::pair(a.key_position.line, a.key_position.column) < std::pair(b.key_position.line, b.key_position.column);
  };
  std::stable_sort(result.members.begin(), result.members.end(), before);
  return result;
}

DocumentValue convert(const toml::node& node, const std::string& file) {
  DocumentValue result;
  result.position = position_of(node.source(), file);
  if (const auto* table = node.as_table()) {
    result.data = convert_table(*table, file);
  } else if (const auto* array = node.as_array()) {
    DocumentArray values;
    for (const auto& element : *array) values.values.push_back(convert(element, file));
    result.data = std::move(values);
  } else if (const auto* text = node.as_string()) {
    result.data = text->get();
  } else if (const auto* integer = node.as_integer()) {
    result.data = std::int64_t{integer->get()};
  } else if (const auto* number = node.as_floating_point()) {
    result.data = number->get();
  } else if (const auto* boolean = node.as_boolean()) {
    result.data = boolean->get();
  } else {
    result.data = DocumentDate{};
  }
  return result;
}

/// One line of printable text: the library quotes bytes of the file in its messages.
std::string printable(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte >= 0x7f) result += fmt::format("\\x{:02X}", byte);
    else result += c;
  }
  return result;
}

}  // namespace

const DocumentMember* DocumentTable::find(std::string_view key) const {
  for (const auto& member : members)
    if (member.key == key) return &member;
  return nullptr;
}

const char* DocumentValue::type_name() const {
  static constexpr const char* kNames[] = {"a boolean", "a whole number", "a number", "a string",
                                           "a date or time", "an array", "a table"};
  return kNames[data.index()];
}

Result<DocumentValue> parse_document(std::string_view text, const std::string& file, int max_nesting) {
  if (const auto checked = check_nesting(text, file, max_nesting); !checked) return checked.error();
  try {
    const toml::table table = toml::parse(text, std::string_view{file});
    DocumentValue root;
    root.position = {file, 1, 1};
    root.data = convert_table(table, file);
    return root;
  } catch (const toml::parse_error& error) {
    return fail_at(position_of(error.source(), file), "{}", printable(error.description()));
  }
}

Result<std::string> read_regular_file(const std::string& path, std::size_t max_bytes) {
  const auto cannot = [&](const char* what) {
    return Diagnostic{DiagnosticKind::file_access, {path, 0, 0}, fmt::format("cannot {}: {}", what, std::strerror(errno))};
  };
  // O_NONBLOCK: opening a pipe must not wait for its writer.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) return cannot("open");
  struct Closer {
    int descriptor;
    ~Closer() { ::close(descriptor); }
  } closer{descriptor};
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return cannot("look at");
  const SourcePosition position{path, 0, 0};
  if (S_ISDIR(status.st_mode)) return Diagnostic{DiagnosticKind::file_access, position, "cannot read: it is a directory"};
  if (!S_ISREG(status.st_mode)) return fail_at(position, "is not a regular file");
  std::string text;
  char block[1 << 16];
  while (true) {
    const ssize_t got = ::read(descriptor, block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return cannot("read");
    if (got == 0) return text;
    text.append(block, static_cast<std::size_t>(got));
    if (text.size() > max_bytes) return fail_at(position, "is longer than {} bytes", max_bytes);
  }
}

}  // namespace toothpath
