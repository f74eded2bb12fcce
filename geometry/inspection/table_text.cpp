#include "geometry/inspection/table_text.h"

#include <algorithm>

#include "geometry/inspection/point_words.h"

namespace toothpath::inspection {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Places of a line that stand in quotes; a quote opens where a cell begins.
std::vector<bool> quoted(std::string_view line) {
  std::vector<bool> in(line.size(), false);
  bool open = false, begins = true;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (c == '"' && (open || begins)) {
      in[k] = true;
      open = !open;
    } else {
      in[k] = open;
    }
    begins = !open && (c == ';' || c == ',' || is_blank(c));
  }
  return in;
}

bool has(std::string_view line, const std::vector<bool>& in, char wanted) {
  for (std::size_t k = 0; k < line.size(); ++k)
    if (line[k] == wanted && !in[k]) return true;
  return false;
}

/// A cell without the blanks and quotes around it; two quotes stand for one.
TableCell cell_of(std::string_view line, std::size_t from, std::size_t to) {
  while (from < to && is_blank(line[from])) ++from;
  while (to > from && is_blank(line[to - 1])) --to;
  TableCell cell{{}, int(from) + 1};
  const bool quotes = to - from >= 2 && line[from] == '"' && line[to - 1] == '"';
  std::string_view text = line.substr(from, to - from);
  if (quotes) text = text.substr(1, text.size() - 2);
  for (std::size_t k = 0; k < text.size(); ++k) {
    cell.text += text[k];
    if (quotes && text[k] == '"' && k + 1 < text.size() && text[k + 1] == '"') ++k;
  }
  if (quotes) cell.text = trimmed(cell.text);
  return cell;
}

bool commas_part(std::string_view line, const std::vector<bool>& in) {
  if (has(line, in, ';')) return false;
  const std::string_view inside = trimmed(line);
  bool blanks = false, between_digits = true;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (in[k]) continue;
    if (line[k] == '.') return true;
    if (line[k] == ',')
      between_digits = between_digits && k > 0 && k + 1 < line.size() && is_digit(line[k - 1]) && is_digit(line[k + 1]);
    blanks = blanks ||
             (is_blank(line[k]) && line.data() + k > inside.data() && line.data() + k < inside.data() + inside.size());
  }
  return !(blanks && between_digits);
}

}  // namespace

std::vector<TableCell> heading_cells(std::string_view line) {
  const std::vector<bool> in = quoted(line);
  char separator = ' ';
  for (const char one : {',', '\t', ';'})
    if (has(line, in, one)) separator = one;
  std::vector<TableCell> cells;
  std::size_t from = 0;
  int brackets = 0;
  for (std::size_t k = 0; k <= line.size(); ++k) {
    const bool end = k == line.size();
    if (!end && !in[k]) brackets += (line[k] == '[' || line[k] == '(') - (line[k] == ']' || line[k] == ')');
    if (separator == ' ') {
      if (!end && (!is_blank(line[k]) || in[k] || brackets > 0)) continue;
      std::size_t next = k;
      while (next < line.size() && is_blank(line[next])) ++next;
      const bool unit_follows = next < line.size() && (line[next] == '[' || line[next] == '(');
      if (!end && unit_follows) continue;
      if (trimmed(line.substr(from, k - from)).empty()) continue;
    } else if (!end && (line[k] != separator || in[k])) {
      continue;
    }
    cells.push_back(cell_of(line, from, k));
    from = k + 1;
  }
  while (!cells.empty() && cells.back().text.empty()) cells.pop_back();
  return cells;
}

std::vector<TableCell> number_cells(std::string_view line) {
  const std::vector<bool> in = quoted(line);
  const bool semicolons = has(line, in, ';'), commas = commas_part(line, in);
  const auto parts = [&](std::size_t k) { return !in[k] && (line[k] == ';' || (commas && line[k] == ',')); };
  std::vector<TableCell> cells;
  for (std::size_t k = 0; k < line.size();) {
    while (k < line.size() && is_blank(line[k])) ++k;
    if (k == line.size()) break;
    const std::size_t begin = k;
    while (k < line.size() && (in[k] || ((semicolons || !is_blank(line[k])) && !parts(k)))) ++k;
    cells.push_back(cell_of(line, begin, k));
    while (k < line.size() && is_blank(line[k]) && !in[k]) ++k;
    if (k < line.size() && parts(k)) ++k;
  }
  while (!cells.empty() && cells.back().text.empty()) cells.pop_back();
  return cells;
}

bool read_cell(std::string_view text, double& value) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return read_number(text, value);
  if (text.find('.') != std::string_view::npos) return false;
  std::string pointed(text);
  pointed[comma] = '.';
  return read_number(pointed, value);
}

bool names_columns(std::string_view line, std::string_view names) {
  const auto cells = heading_cells(line), wanted = heading_cells(names);
  return std::equal(cells.begin(), cells.end(), wanted.begin(), wanted.end(),
                    [](const TableCell& a, const TableCell& b) { return a.text == b.text; });
}

TextLine take_line(std::string_view& rest, int before) {
  const std::size_t end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return {line, before + 1};
}

bool is_separator_line(std::string_view line) {
  const std::string head = upper(trimmed(line));
  return head.size() <= 7 && (head.starts_with("SEP=") || head.starts_with("\"SEP="));
}

}  // namespace toothpath::inspection
