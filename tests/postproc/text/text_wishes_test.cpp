// What a shop adds to the text and a job asks of it: own lines, tools called where they change, stops, numbers of
// blocks, a short header. In every dialect: the text says it, is read back, and moves as without it.
#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "tests/postproc/text/post_forms.h"
#include "tests/support/files.h"
#include "tests/support/nc_walk.h"

namespace toothpath {
namespace {

using namespace test;
using readback::ExecutedMove;

constexpr int kWishTeeth = 3;

std::vector<std::string> pieces_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}
std::size_t count_of(const std::string& text, const std::string& pattern) {
  const std::regex look(pattern);
  std::size_t n = 0;
  for (const auto& line : pieces_of(text)) n += std::regex_search(line, look) ? 1 : 0;
  return n;
}

class TextWishes : public testing::TestWithParam<PostForm> {
 protected:
  /// Three operations: tool 1 twice, then tool 2.
  [[nodiscard]] joints::AxisProgram program() const {
    const double swing = GetParam().swing;
    std::vector<path::ClPath> paths = {sample_path(0.3, swing, 5), sample_path(0.3, swing, 5, 1),
                                       sample_path(0.3, swing, 5, 2)};
    paths[2].tool = 1;
    auto made = program_of(GetParam(), paths, kWishTeeth, 1);
    EXPECT_TRUE(made) << made.error().message;
    return std::move(made.value());
  }
  [[nodiscard]] std::string text(const machines::Machine& m, const text::TextWishes& wishes = {}) const {
    text::NcHeader header;
    header.job_name = "sample";
    header.machine_name = "trunnion";
    header.coolant = machines::Coolant::flood;
    header.wishes = wishes;
    const auto dialect = controls::dialect_of(m);
    EXPECT_TRUE(dialect) << dialect.error().message;
    const auto made = write_nc(program(), *dialect, header);
    EXPECT_TRUE(made) << made.error().message;
    return made ? made->text : std::string();
  }
  [[nodiscard]] std::vector<ExecutedMove> moves(const std::string& text) const {
    const auto control = control_of(machine_of(GetParam()), standing(), tools());
    std::vector<ExecutedMove> out;
    const auto s = readback::execute_nc(text, "p", *control, [&](const ExecutedMove& e) { out.push_back(e); });
    EXPECT_TRUE(s) << s.error().text();
    return out;
  }
  void expect_same_moves(const std::string& one, const std::string& other) const {
    const auto a = moves(one), b = moves(other);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].known, b[i].known);
      if (a[i].known) { EXPECT_EQ(a[i].joints, b[i].joints) << b[i].line; }
      EXPECT_EQ(a[i].tool, b[i].tool);
      EXPECT_EQ(a[i].coolants, b[i].coolants);
      EXPECT_EQ(a[i].speed_rpm, b[i].speed_rpm);
      EXPECT_FALSE(b[i].in_doubt) << b[i].line;
    }
  }
  /// A reading that shares nothing with ours.
  void expect_same_walk(const std::string& one, const std::string& other) const {
    const NcWalk a = walk_nc(one, GetParam().dialect), b = walk_nc(other, GetParam().dialect);
    if (!a.faults.empty()) return;  // it does not know this machine
    EXPECT_TRUE(b.faults.empty()) << b.faults.front();
    EXPECT_TRUE(b.ended);
    ASSERT_EQ(a.moves.size(), b.moves.size());
    for (std::size_t i = 0; i < a.moves.size(); ++i) {
      EXPECT_EQ(a.moves[i].linear, b.moves[i].linear);
      EXPECT_EQ(a.moves[i].rotary, b.moves[i].rotary);
      EXPECT_EQ(a.moves[i].tool, b.moves[i].tool);
    }
  }
  [[nodiscard]] bool is(const char* dialect) const { return std::string(GetParam().dialect) == dialect; }
};
INSTANTIATE_TEST_SUITE_P(Forms, TextWishes, testing::ValuesIn(post_forms()));

TEST_P(TextWishes, AToolIsCalledWhereItChangesAndTheNextOneIsMadeReady) {
  const std::string t = text(machine_of(GetParam()));
  const char* const call = is("apt") ? "^LOADTL/" : is("heidenhain") ? "TOOL CALL \\d+ Z S\\d+$" : "(^| )M6$";
  EXPECT_EQ(count_of(t, call), 2U);
  const char* const next = is("siemens") ? "^T=\"T2\"$" : is("heidenhain") ? "TOOL DEF 2$" : "^T2$";
  if (!is("apt")) { EXPECT_EQ(count_of(t, next), is("siemens") ? 2U : 1U); }
  if (is("heidenhain")) { EXPECT_EQ(count_of(t, "TOOL CALL S\\d+$"), 1U); }
  std::array<int, 3> of_operation{};
  for (const ExecutedMove& m : moves(t))
    if (m.operation >= 0 && !m.rapid) of_operation.at(static_cast<std::size_t>(m.operation)) = m.tool;
  EXPECT_EQ(of_operation, (std::array{1, 1, 2}));
}

TEST_P(TextWishes, LinesOfTheShop) {
  machines::Machine m = machine_of(GetParam());
  if (is("apt")) {
    m.post.own_lines.end = {"M9"};
    const auto errors = controls::judge(m);
    ASSERT_EQ(errors.size(), 1U);
    EXPECT_EQ(errors[0].message, "post.end: dialect \"apt\" takes no lines of the shop");
    return;
  }
  const std::string plain = text(m);
  const std::string wait = is("siemens")      ? "G4 F0.5"
                           : is("heidenhain") ? "FUNCTION DWELL TIME0.5"
                           : is("haas")       ? "G4 P0.5"
                           : is("linuxcnc")   ? "G4 P0.5"
                                              : "G4 P500";
  m.post.own_lines.start = {wait};
  m.post.own_lines.between_teeth = {wait, "M8"};
  m.post.own_lines.end = {"M9"};
  m.post.own_lines.tool_change = is("siemens")      ? std::vector<std::string>{"T=\"T{tool}\"", "M5", "M6"}
                                 : is("heidenhain") ? std::vector<std::string>{"M5", "TOOL CALL {tool} Z S{speed}"}
                                                    : std::vector<std::string>{"T{tool}", "M5", "M6"};
  const std::string own = text(m);
  expect_same_moves(plain, own);
  double waits = 0;
  for (const ExecutedMove& e : moves(own)) waits += double(e.dwell_min) * 60;
  EXPECT_NEAR(waits, 0.5 * (1 + 3 * kWishTeeth), 1e-5);
  EXPECT_EQ(count_of(own, "(^| )M5$"), count_of(plain, "(^| )M5$") + 2);
}

TEST_P(TextWishes, NamesThatDoNotExistHaveTheirPlace) {
  if (is("apt")) return;
  machines::Machine m = machine_of(GetParam());
  m.file = "m.toml";
  m.positions["post.start"] = {"m.toml", 9, 1};
  m.post.own_lines.start = {"M9", "G4 {tool}"};
  m.post.own_lines.tool_change = std::vector<std::string>{"T1 M6"};
  const auto errors = controls::judge(m);
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_EQ(
      errors[0].text().rfind("m.toml:9:1: error: post.start: \"G4 {tool}\" names {tool}, which is none of {offset} "
                             "{top} {teeth} {free} {name} {id}",
                             0),
      0U)
      << errors[0].text();
  EXPECT_EQ(errors[1].message, "post.tool_change names {tool} in no line: it must fetch the tool");
}

TEST_P(TextWishes, StopsOfTheOperator) {
  if (is("apt")) return;
  const machines::Machine m = machine_of(GetParam());
  const std::string plain = text(m);
  using text::Stops, text::StopWord;
  for (const StopWord word : {StopWord::optional_stop, StopWord::block_skip}) {
    const char* const said = word == StopWord::optional_stop ? "(^| )M1$" : "(^| )/M0$";
    const auto with = [&](Stops stops) { return text(m, {stops, word, false}); };
    EXPECT_EQ(count_of(with(Stops::tool_changes), said), 1U);
    EXPECT_EQ(count_of(with(Stops::operations), said), 2U);
    const std::string teeth = with(Stops::teeth);
    const bool repeated = count_of(teeth, said) == 3;  // in a loop
    EXPECT_TRUE(repeated || count_of(teeth, said) == 3U * kWishTeeth) << count_of(teeth, said);
    for (const Stops stops : {Stops::tool_changes, Stops::operations, Stops::teeth})
      expect_same_moves(plain, with(stops)), expect_same_walk(plain, with(stops));
  }
}

// What the shop calls tool and holder stands beside what the cutter is, in capitals and without brackets of its own.
TEST_P(TextWishes, NamesOfToolAndHolder) {
  if (is("apt")) return;
  joints::AxisProgram p = program();
  tool::ToolAssembly named;
  named.name = "Gr\u00fcn (R2) lang";
  named.holder_name = "ER16 x 70";
  p.operations[2].shop_names = tool::shop_names(named);
  text::NcHeader header;
  header.job_name = "sample";
  const auto with = write_nc(p, *controls::dialect_of(machine_of(GetParam())), header);
  ASSERT_TRUE(with) << with.error().message;
  EXPECT_EQ(count_of(with->text, "T2 NAME GRUEN \\[R2\\] LANG\\)?$"), 1U) << with->text.substr(0, 3000);
  EXPECT_EQ(count_of(with->text, "T2 HOLDER ER16 X 70\\)?$"), 1U);
  EXPECT_EQ(count_of(with->text, "T1 NAME"), 0U);
}

// The tool is there and turns behind it; nothing is cut ahead of it.
TEST_P(TextWishes, AStopAheadOfTheFirstCutOfATool) {
  if (is("apt")) return;
  const machines::Machine m = machine_of(GetParam());
  text::TextWishes wishes;
  wishes.stop_at_first_cut = true;
  const std::string plain = text(m), stopped = text(m, wishes);
  EXPECT_EQ(count_of(stopped, "(^| )M1$"), 2U);
  expect_same_moves(plain, stopped);
  expect_same_walk(plain, stopped);
  const std::vector<std::string> lines = pieces_of(stopped);
  const std::regex call(is("heidenhain") ? "TOOL CALL \\d+ Z S\\d+$" : "(^| )M6$"), stop("(^| )M1$"),
      cut(is("heidenhain") ? " F\\d+" : "(^|[^A-Z0-9])G1 |^M9[78] ");  // a tooth that is called, too
  int state = 0;                                                       // 1: called, 2: stopped, 0: cut
  for (const std::string& line : lines) {
    if (std::regex_search(line, call)) EXPECT_EQ(std::exchange(state, 1), 0) << line;
    else if (std::regex_search(line, stop)) EXPECT_EQ(std::exchange(state, 2), 1) << line;
    else if (std::regex_search(line, cut)) { EXPECT_NE(std::exchange(state, 0), 1) << line; }
  }
}

// By default; Heidenhain has a number in every block.
TEST_P(TextWishes, NumbersWhereTheProgramIsTakenUpAgain) {
  if (is("apt")) return;
  const machines::Machine m = machine_of(GetParam());
  text::TextWishes none;
  none.restart_numbers = false;
  const std::string plain = text(m, none), numbered = text(m);
  if (is("heidenhain")) {
    EXPECT_EQ(plain, numbered);
    return;
  }
  for (const char* n : {"^N1000 ", "^N2000 ", "^N3000 "}) EXPECT_EQ(count_of(numbered, n), 1U) << n;
  const std::size_t all = count_of(numbered, "^N\\d{4} ");
  EXPECT_TRUE(all == 3U || all == 3U * (1 + kWishTeeth)) << all;
  expect_same_moves(plain, numbered);
  expect_same_walk(plain, numbered);
  EXPECT_EQ(std::regex_replace(numbered, std::regex("(^|\n)N\\d{4} "), "$1").size(), plain.size());
}

TEST_P(TextWishes, AHeaderOfTwentyLines) {
  text::NcHeader header;
  header.job_name = "sample";
  header.job_hash = "0123";
  header.machine_name = "trunnion";
  for (int table = 0; table < 60; ++table) header.assumed.push_back(fmt::format("table_of_long_name_{}.key", table));
  const machines::Machine m = machine_of(GetParam());
  const auto dialect = controls::dialect_of(m);
  for (const std::size_t most : {3U, 12U, 60U}) {
    header.assumed.resize(most);
    const auto made = write_nc(program(), *dialect, header);
    ASSERT_TRUE(made) << made.error().message;
    std::size_t lines = 0;
    bool counted = false;
    for (const auto& line : pieces_of(made->text)) {
      const std::string code = is("heidenhain") ? line.substr(line.find(' ') + 1) : line;
      const bool frame = code[0] == '%' || code[0] == 'O' || code.rfind("BEGIN", 0) == 0 ||
                         code.rfind("PARTNO", 0) == 0 || code.rfind("UNITS", 0) == 0;
      if (!frame && code[0] != '(' && code[0] != ';' && code[0] != '$') break;
      counted = counted || code.find("MORE: THE SET-UP SHEET HAS THEM ALL") != std::string::npos;
      ++lines;
    }
    EXPECT_LE(lines, 20U);
    EXPECT_GE(lines, 4U);
    if (most == 3U) { EXPECT_FALSE(counted); }
    if (!is("apt")) { EXPECT_FALSE(moves(made->text).empty()); }
  }
}

}  // namespace
}  // namespace toothpath
