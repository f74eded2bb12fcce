#include "postproc/restart/menu.h"

#include <algorithm>
#include <charconv>
#include <map>

#include "postproc/joints/tooth_order.h"
#include "postproc/readback/operation_moves.h"
#include "postproc/readback/scanner.h"

namespace toothpath::restart {
namespace {

/// Leading block number and the text of a comment behind it; empty: the line is no comment.
std::string_view comment_of(std::string_view line, int& number) {
  number = -1;
  std::size_t i = 0;
  while (i < line.size() && readback::NcScanner::is_digit(line[i])) ++i;
  if (i > 0 && i < 9) std::from_chars(line.data(), line.data() + i, number);
  line.remove_prefix(i);
  while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
  for (const std::string_view open : {"$$", "(", ";"}) {
    if (line.substr(0, open.size()) != open) continue;
    line.remove_prefix(open.size());
    while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
    if (!line.empty() && line.back() == ')') line.remove_suffix(1);
    return line;
  }
  return {};
}

int number_of(std::string_view line) {
  int number = -1;
  (void)comment_of(line, number);
  return number;
}

/// First lines of the teeth of every piece of the program (ExecutedMove::piece) as they are executed. A tooth begins
/// with its TOOTH comment, or after as many moves as the others have.
class FirstLines {
 public:
  FirstLines(const std::map<int, readback::OperationMoves>& counts, const std::map<int, std::size_t>& teeth)
      : counts_(counts), teeth_(teeth) {}

  void operator()(const readback::ExecutedMove& m) {
    if (m.operation < 0) return;
    const readback::OperationMoves& c = counts_.at(m.piece);
    const std::size_t i = seen_[m.piece]++;
    if (i < c.lead() || i >= c.total - c.trail()) return;
    auto& lines = lines_[m.piece];
    if (m.tooth >= 0) {
      if (lines.empty() || label_[m.piece] != m.tooth) lines.push_back({m.line, m.tooth});
      label_[m.piece] = m.tooth;
      return;
    }
    const std::size_t n = teeth_.at(m.piece), per_tooth = c.teeth() / n;
    if (per_tooth * n == c.teeth() && (i - c.lead()) % per_tooth == 0) lines.push_back({m.line, -1});
  }
  /// Line and label (-1: none) of every tooth of a piece.
  [[nodiscard]] const std::vector<std::pair<int, int>>& of(int piece) { return lines_[piece]; }

 private:
  const std::map<int, readback::OperationMoves>& counts_;
  const std::map<int, std::size_t>& teeth_;
  std::map<int, std::size_t> seen_;
  std::map<int, int> label_;
  std::map<int, std::vector<std::pair<int, int>>> lines_;
};

/// The operations that the comments name, without their teeth.
RestartMenu operations_in(const std::vector<std::string_view>& lines) {
  RestartMenu menu;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    int number = -1;
    const std::string_view comment = comment_of(lines[i], number);
    const RestartLine here{static_cast<int>(i) + 1, number};
    if (const int op = readback::comment_label(comment, "OP "); op >= 0) {
      if (menu.operations.empty() && i > 0) menu.start_end = {static_cast<int>(i), number_of(lines[i - 1])};
      RestartOperation o;
      o.operation = op;
      o.type = comment.substr(std::min(comment.size(), comment.find(' ', 3) + 1));
      o.at = here;
      menu.operations.push_back(std::move(o));
    } else if (const int k = readback::comment_label(comment, "AT TOOTH ");
               k >= 0 && !menu.operations.empty() && i + 1 < lines.size()) {
      menu.operations.back().teeth.push_back({-1, k, {here.line + 1, number_of(lines[i + 1])}});
    } else if (comment.starts_with("FIRST TOOTH") && !menu.operations.empty() && i + 1 < lines.size()) {
      menu.operations.back().first_tooth = {here.line + 1, number_of(lines[i + 1])};
    }
  }
  return menu;
}

/// Places of the teeth that are called, from `place` on, and where the opening ends.
std::optional<Diagnostic> place_calls(RestartOperation& op, int place, std::size_t teeth,
                                      const joints::AxisProgram& program, const std::vector<std::string_view>& lines) {
  if (op.teeth.size() != teeth)
    return fail("operation {} has {} teeth in the text where {} are expected", op.operation, op.teeth.size(), teeth);
  for (RestartTooth& t : op.teeth) {
    t.place = place++;
    const int expected = joints::tooth_of_place(t.place, program.tooth_stride, program.teeth);
    if (t.tooth != expected) return fail("line {}: tooth {} where tooth {} is expected", t.at.line, t.tooth, expected);
  }
  const int end = op.teeth.front().at.line - 2;  // ahead of the comment
  op.opening_end = {end, number_of(lines[static_cast<std::size_t>(end) - 1])};
  return std::nullopt;
}

}  // namespace

Result<RestartMenu> restart_menu(std::string_view text, const std::string& file, const readback::NcControl& control,
                                 const joints::AxisProgram& program) {
  const std::vector<std::string_view> lines = readback::lines_of(text);
  RestartMenu menu = operations_in(lines);
  std::map<int, std::size_t> teeth;  // of every piece: an operation, or what one tool does of it
  std::map<int, int> first_place;
  const auto pieces = static_cast<int>(menu.operations.size());
  for (int k = 0; k < pieces; ++k) {
    RestartOperation& op = menu.operations[static_cast<std::size_t>(k)];
    const bool known = static_cast<std::size_t>(k) < program.operations.size();
    const joints::AxisOperation none, &made = known ? program.operations[static_cast<std::size_t>(k)] : none;
    teeth[k] = static_cast<std::size_t>(made.places(program.teeth));
    first_place[k] = made.first_place;
    op.tool = made.tool_number;
    if (known && k > 0 && program.operations[static_cast<std::size_t>(k) - 1].tool_number == made.tool_number)
      op.tool_before = made.tool_number;
  }
  const auto tooth_at = [&](int place) { return joints::tooth_of_place(place, program.tooth_stride, program.teeth); };
  for (int k = 0; k < pieces; ++k)
    if (auto& op = menu.operations[static_cast<std::size_t>(k)]; op.first_tooth.line != 0)
      for (int n = first_place[k]; n < first_place[k] + static_cast<int>(teeth[k]); ++n)
        op.teeth.push_back({n, tooth_at(n), {}});
  for (int k = 0; k < pieces; ++k)
    if (auto& op = menu.operations[static_cast<std::size_t>(k)]; op.first_tooth.line == 0 && !op.teeth.empty())
      if (auto bad = place_calls(op, first_place[k], teeth[k], program, lines)) return *bad;
  const auto has_lines = [](const auto& op) { return op.first_tooth.line != 0 || !op.teeth.empty(); };
  if (std::all_of(menu.operations.begin(), menu.operations.end(), has_lines)) return menu;

  std::map<int, readback::OperationMoves> counts;
  const auto count = [&](const readback::ExecutedMove& m) { counts[m.piece].add(m); };
  if (auto s = readback::execute_nc(text, file, control, count); !s) return s.error();
  for (const auto& [piece, c] : counts) teeth.emplace(piece, static_cast<std::size_t>(program.teeth));
  FirstLines first(counts, teeth);
  if (auto s = readback::execute_nc(text, file, control, [&](const readback::ExecutedMove& m) { first(m); }); !s)
    return s.error();

  for (int k = 0; k < pieces; ++k) {
    RestartOperation& op = menu.operations[static_cast<std::size_t>(k)];
    if (has_lines(op)) continue;
    const auto& found = first.of(k);
    if (found.size() != teeth[k])
      return fail("operation {} has {} teeth in the text where {} are expected", op.operation, found.size(), teeth[k]);
    for (std::size_t n = 0; n < found.size(); ++n) {
      RestartTooth t;
      t.place = first_place[k] + static_cast<int>(n);
      t.tooth = tooth_at(t.place);
      if (found[n].second >= 0 && found[n].second != t.tooth)
        return fail("line {}: tooth {} where tooth {} is expected", found[n].first, found[n].second, t.tooth);
      int line = found[n].first, number = -1;
      while (found[n].second >= 0 && line > op.at.line &&
             readback::comment_label(comment_of(lines[static_cast<std::size_t>(line) - 1], number), "TOOTH ") < 0)
        --line;
      t.at = {line, number_of(lines[static_cast<std::size_t>(line) - 1])};
      op.teeth.push_back(t);
    }
    if (op.teeth.empty()) continue;
    const int end = op.teeth.front().at.line - 1;
    op.opening_end = {end, number_of(lines[static_cast<std::size_t>(end) - 1])};
  }
  return menu;
}

}  // namespace toothpath::restart
