#include "machines/assumed.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

namespace toothpath::machines {
namespace {

/// "t600s.toml: axes.X.min" in its parts; a line that says more than a key has no leaf.
struct Key {
  std::string_view file, table, leaf, whole;
};

Key parts_of(std::string_view text) {
  Key key{{}, {}, {}, text};
  const auto colon = text.find(": ");
  std::string_view path = text;
  if (colon != std::string_view::npos) {
    key.file = text.substr(0, colon);
    path = text.substr(colon + 2);
  }
  if (path.empty() || path.find(' ') != std::string_view::npos) return key;
  const auto dot = path.rfind('.');
  key.table = dot == std::string_view::npos ? std::string_view() : path.substr(0, dot);
  key.leaf = dot == std::string_view::npos ? path : path.substr(dot + 1);
  return key;
}

struct Table {
  std::string_view file;
  std::vector<std::string_view> names, leaves;
  std::string_view whole;  ///< where there are no names

  [[nodiscard]] std::string text() const {
    if (names.empty()) return std::string(whole);
    const std::string start = file.empty() ? "" : fmt::format("{}: ", file);
    if (names.front().empty()) return start + fmt::format("{}", fmt::join(leaves, ", "));
    return start + fmt::format("{}: {}", fmt::join(names, ", "), fmt::join(leaves, ", "));
  }
};

std::vector<Table> tables_of(std::span<const std::string> keys) {
  std::vector<Table> tables;
  for (const std::string& text : keys) {
    const Key key = parts_of(text);
    if (key.leaf.empty()) {
      tables.push_back({key.file, {}, {}, key.whole});
      continue;
    }
    auto table = std::find_if(tables.begin(), tables.end(), [&](const Table& t) {
      return !t.names.empty() && t.file == key.file && t.names.front() == key.table;
    });
    if (table == tables.end()) table = tables.insert(table, Table{key.file, {key.table}, {}, {}});
    table->leaves.push_back(key.leaf);
  }
  return tables;
}

/// Lines of at most `width` characters, broken behind commas; what has none there is not broken.
std::vector<std::string> wrapped(std::string text, std::size_t width) {
  std::vector<std::string> lines;
  while (text.size() > width) {
    const auto comma = text.rfind(", ", width - 1);
    if (comma == std::string::npos || comma == 0) break;
    lines.push_back(text.substr(0, comma + 1));
    text.erase(0, comma + 2);
  }
  lines.push_back(std::move(text));
  return lines;
}

}  // namespace

std::vector<std::string> grouped_keys(std::span<const std::string> keys, std::size_t most, std::size_t width) {
  std::vector<Table> tables;
  for (Table& table : tables_of(keys)) {
    const auto like = std::find_if(tables.begin(), tables.end(), [&](const Table& t) {
      return !table.names.empty() && !t.names.empty() && t.file == table.file && !t.names.front().empty() &&
             !table.names.front().empty() && t.leaves == table.leaves;
    });
    if (like != tables.end()) like->names.push_back(table.names.front());
    else tables.push_back(std::move(table));
  }
  std::vector<std::vector<std::string>> texts;
  std::size_t all = 0;
  for (const Table& table : tables) all += texts.emplace_back(wrapped(table.text(), width)).size();
  std::vector<std::string> lines;
  std::size_t left_out = 0;
  for (std::size_t n = 0; n < tables.size(); ++n) {
    const bool room = all <= most || (left_out == 0 && lines.size() + texts[n].size() < most);
    if (room) lines.insert(lines.end(), texts[n].begin(), texts[n].end());
    else left_out += tables[n].names.empty() ? 1 : tables[n].names.size() * tables[n].leaves.size();
  }
  if (left_out > 0) lines.push_back(fmt::format("and {} more", left_out));
  return lines;
}

std::string counted_keys(std::span<const std::string> keys) {
  if (keys.empty()) return {};
  struct Count {
    std::string_view name;
    std::size_t values = 0;
  };
  std::vector<std::string_view> files;
  std::vector<Count> counts;
  for (const std::string& text : keys) {
    const Key key = parts_of(text);
    if (!key.file.empty() && std::find(files.begin(), files.end(), key.file) == files.end()) files.push_back(key.file);
    std::string_view name = key.whole.substr(key.file.empty() ? 0 : key.file.size() + 2);
    name = name.substr(0, name.find_first_of(". "));
    const auto known = std::find_if(counts.begin(), counts.end(), [&](const Count& c) { return c.name == name; });
    if (known == counts.end()) counts.push_back({name, 1});
    else ++known->values;
  }
  std::vector<std::string> names;
  for (const Count& c : counts)
    names.push_back(c.values == 1 ? std::string(c.name) : fmt::format("{} ({})", c.name, c.values));
  return fmt::format("{} {}{}, not measured: {}", keys.size(), keys.size() == 1 ? "value" : "values",
                     files.empty() ? "" : fmt::format(" of {}", fmt::join(files, ", ")), fmt::join(names, ", "));
}

}  // namespace toothpath::machines
