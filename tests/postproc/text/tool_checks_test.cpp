// Checks of the tools in every form of text: where they stand is counted by a reader of the tests' own (nc_walk), what
// is left out or changed behind and in them must be found by the reader or change no cut; LinuxCNC's interpreter runs
// its own lines.
#include "postproc/text/tool_checks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "postproc/joints/tooth_order.h"
#include "postproc/restart/menu.h"
#include "postproc/restart/parts.h"
#include "postproc/restart/proof.h"
#include "tests/postproc/text/post_forms.h"
#include "tests/support/nc_walk.h"
#include "tests/support/random.h"
#include "tests/support/rs274.h"

namespace toothpath {
namespace {

using namespace test;
using text::ToolChecks;

constexpr int kTeeth = 7;
constexpr double kCheck_min = 0.2;

machines::Machine checking(const PostForm& form) {
  machines::Machine m = machine_of(form);
  machines::ToolCheck check;
  check.position_mm = Vec3(-400, 300, -100);
  check.tolerance_mm = 0.05;
  check.minutes = kCheck_min;
  const std::string d = form.dialect;
  if (d == "fanuc" || d == "haas" || d == "mitsubishi_m80")
    check.lines = {"M19", "G65 P9858 T{tool}. H{tolerance} D{length} Z{z}"};
  if (d == "siemens") check.lines = {"TOOL_CHECK({tool},{length},{tolerance},{x},{y},{z},{clearance})"};
  m.tool_check = check;
  return m;
}

/// Two operations with the first tool, one with the second.
std::vector<path::ClPath> three_operations(const PostForm& form) {
  std::vector<path::ClPath> paths = {sample_path(0.3, form.swing, 3), sample_path(0.3, form.swing, 2, 1),
                                     sample_path(0.2, form.swing, 2, 2)};
  paths[2].tool = 1;
  return paths;
}

Result<joints::AxisProgram> built(const PostForm& form) { return program_of(form, three_operations(form), kTeeth, 1); }

text::NcHeader header_with(const text::TextWishes& wishes) {
  text::NcHeader header;
  header.job_name = "sample";
  header.coolant = machines::Coolant::flood;
  header.wishes = wishes;
  return header;
}

text::TextWishes asking(ToolChecks checks, int teeth = 0) {
  text::TextWishes wishes;
  wishes.checks = checks;
  wishes.teeth_between_checks = teeth;
  return wishes;
}

/// Text with its checks; `whole` program: divided first.
std::string text_with(const machines::Machine& machine, joints::AxisProgram program, const text::TextWishes& wishes) {
  const auto dialect = dialect_of(machine);
  EXPECT_TRUE(dialect) << dialect.error().text();
  note_tool_checks(program, *dialect, wishes, {});
  const auto text = write_nc(program, *dialect, header_with(wishes));
  EXPECT_TRUE(text) << text.error().message;
  return text ? text->text : "";
}

using Lines = std::vector<std::string>;
Lines split(const std::string& text) {
  Lines out;
  std::istringstream in(text);
  for (std::string l; std::getline(in, l);) out.push_back(l);
  return out;
}
/// Heidenhain counts its blocks.
std::string joined(const Lines& lines, const PostForm& form) {
  std::string out;
  const bool numbers = std::string(form.dialect) == "heidenhain";
  for (std::size_t i = 0; i < lines.size(); ++i)
    out += (numbers ? std::to_string(i) + lines[i].substr(lines[i].find(' ')) : lines[i]) + "\n";
  return out;
}
bool is_heading(const std::string& line) { return line.find("TOOL CHECK T") != std::string::npos; }

/// What a text cuts, as its reader says; empty: refused.
struct Read {
  std::string refused;
  int line = 0;
  std::vector<std::string> cuts;
};
Read read_of(const std::string& text, const readback::NcControl& control) {
  Read out;
  readback::ExecutedMove before;
  const auto s = readback::execute_nc(text, "p", control, [&](const readback::ExecutedMove& m) {
    if (!m.rapid)
      out.cuts.push_back(fmt::format("{} {} T{} S{} F{:.9g} cool {} {} {} {} {} {} blend {} {}", m.operation, m.tcp,
                                     m.tool, m.speed_rpm, m.minutes, m.coolants, m.joints[0], m.joints[1], m.joints[2],
                                     m.joints[3], m.joints[4], m.blend_mm, m.corner_path_mm));
    before = m;
  });
  if (!s) out.refused = s.error().message, out.line = s.error().position.line;
  return out;
}

class ToolCheckForms : public testing::TestWithParam<PostForm> {
 protected:
  void SetUp() override {
    machine = checking(GetParam());
    auto made = built(GetParam());
    ASSERT_TRUE(made) << made.error().message;
    program = std::move(*made);
    control = *control_of(machine, standing(), tools());
  }
  std::string text(ToolChecks checks, int teeth = 0) const {
    joints::AxisProgram divided = program;
    (void)text::divide_for_checks(divided, asking(checks, teeth));
    return text_with(machine, divided, asking(checks, teeth));
  }
  machines::Machine machine;
  joints::AxisProgram program;
  readback::NcControl control;
};
std::vector<PostForm> with_lines() {
  std::vector<PostForm> out;
  for (const PostForm& f : post_forms())
    if (std::string(f.dialect) != "apt") out.push_back(f);
  return out;
}
INSTANTIATE_TEST_SUITE_P(Forms, ToolCheckForms, testing::ValuesIn(with_lines()));

TEST_P(ToolCheckForms, StandWhereTheyAreAskedFor) {
  const std::string plain = text(ToolChecks::none);
  {
    const auto without = dialect_of(machine_of(GetParam()));
    EXPECT_EQ(plain, write_nc(program, *without, header_with({}))->text) << "a machine that could check";
  }
  const Read before = read_of(plain, control);
  ASSERT_EQ(before.refused, "");
  const auto plain_read = readback::read_back(plain, "p", control, machine, standing(), {.teeth = kTeeth});
  ASSERT_TRUE(plain_read);
  // By hand: T1 cuts 14 teeth, T2 seven.
  struct Case {
    ToolChecks when;
    int teeth;
    std::vector<std::pair<int, int>> at;  ///< tool, teeth of the program ahead of it
  };
  const std::vector<Case> cases = {
      {ToolChecks::tool_changes, 0, {{1, 0}, {1, 14}, {2, 14}, {2, 21}}},
      {ToolChecks::operations, 0, {{1, 0}, {1, 7}, {1, 14}, {2, 14}, {2, 21}}},
      {ToolChecks::teeth,
       3,
       {{1, 0}, {1, 3}, {1, 6}, {1, 7}, {1, 10}, {1, 13}, {1, 14}, {2, 14}, {2, 17}, {2, 20}, {2, 21}}},
      {ToolChecks::teeth, 50, {{1, 0}, {1, 7}, {1, 14}, {2, 14}, {2, 21}}}};
  for (const Case& c : cases) {
    const std::string checked = text(c.when, c.teeth);
    const Read after = read_of(checked, control);
    ASSERT_EQ(after.refused, "") << after.line << "\n" << checked;
    EXPECT_EQ(after.cuts, before.cuts);
    const auto read = readback::read_back(checked, "p", control, machine, standing(), {.teeth = kTeeth});
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->copies.copies, plain_read->copies.copies) << read->copies.difference;
    EXPECT_EQ(read->mixed_rapid, 0);
    EXPECT_EQ(read->length_off_mm, 0);
    for (const auto& trace : read->between)
      EXPECT_TRUE(
          readback::check_rapids_outside(trace, control, machine, standing(), readback::obstacle_of(kBody), tools()));
    // The ways to the setter are among the times that a check takes; the retract behind it is not.
    const double more = read->minutes - plain_read->minutes, asked = static_cast<double>(c.at.size()) * kCheck_min;
    EXPECT_GT(more, asked * (1 - 1e-6));
    EXPECT_LT(more, asked + static_cast<double>(c.at.size()) * 4 * 2000.0 / 30000);
    // The tip comes to the setter, and nowhere lower.
    EXPECT_NEAR(read->least[0], std::min(-400.0, plain_read->least[0]), 1e-9);
    EXPECT_NEAR(read->greatest[1], std::max(300.0, plain_read->greatest[1]), 1e-9);
    if (GetParam().rollover != 0) continue;  // the reader of the tests does not know axes that roll over
    const NcWalk walk = walk_nc(checked, GetParam().dialect);
    ASSERT_TRUE(walk.faults.empty()) << walk.faults.front();
    ASSERT_TRUE(walk.ended);
    std::size_t feeds = 0;
    for (const NcMove& m : walk.moves) feeds += m.rapid ? 0 : 1;
    ASSERT_EQ(feeds, before.cuts.size());
    // Feeds of a tooth: those of the operation, shared out.
    std::map<int, std::size_t> of_operation;
    for (const std::string& cut : before.cuts) ++of_operation[cut[0] - '0'];
    ASSERT_EQ(walk.checks.size(), c.at.size());
    for (std::size_t n = 0; n < c.at.size(); ++n) {
      EXPECT_EQ(walk.checks[n].tool, c.at[n].first);
      std::size_t ahead = 0, expected = 0;
      for (std::size_t k = 0; k < walk.checks[n].move; ++k) ahead += walk.moves[k].rapid ? 0 : 1;
      for (int op = 0, left = c.at[n].second; op < 3; ++op, left -= kTeeth)
        expected += of_operation[op] / kTeeth * static_cast<std::size_t>(std::clamp(left, 0, kTeeth));
      // A first tooth may be entered by one turn more: it has as many feeds or one tooth's more or less.
      EXPECT_LE(std::max(ahead, expected) - std::min(ahead, expected), 2U) << "check " << n;
    }
  }
}

TEST_P(ToolCheckForms, WhatIsLeftOutIsFoundOrChangesNoCut) {
  const std::string checked = text(ToolChecks::teeth, 3);
  const Lines lines = split(checked);
  const Read whole = read_of(checked, control);
  ASSERT_EQ(whole.refused, "");
  std::vector<std::size_t> headings;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (is_heading(lines[i])) headings.push_back(i);
  const auto dry = [](const Read& read) {  // without its coolant, which a program may lack: its job judges that
    Lines out;
    for (const std::string& cut : read.cuts)
      out.push_back(cut.substr(0, cut.find(" cool")) + cut.substr(cut.find(" blend")));
    return out;
  };
  Random random(7);
  int refused = 0, same = 0;
  for (int trial = 0; trial < 300; ++trial) {
    // Any lines from a check up to where the coolant is on and the teeth begin.
    const std::size_t at = headings[random.index(headings.size())];
    std::size_t to = at;
    const auto is = [&](const char* word) { return lines[to + 1].find(word) != std::string::npos; };
    while (lines[to].find("M8") == std::string::npos && !is("M30") && !is("M2") && !is("HASH")) ++to;
    const double share = random(0.02, 0.6);
    Lines less;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const bool label = lines[i].find("OP ") != std::string::npos || lines[i].find(" sub") != std::string::npos;
      if (i < at || i > to || label || random(0, 1) > share) less.push_back(lines[i]);
    }
    if (less.size() == lines.size()) continue;
    const Read read = read_of(joined(less, GetParam()), control);
    if (read.refused.empty()) {
      ++same;
      EXPECT_EQ(dry(read), dry(whole)) << joined(less, GetParam());
    } else {
      ++refused;
      EXPECT_GT(read.line, 0) << read.refused;
    }
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(same, 3);
}

/// Lines of which none may be missing behind a check: left out wherever they stand between it and the first cut.
TEST_P(ToolCheckForms, EveryModeIsSaidAgain) {
  const std::string d = GetParam().dialect;
  const Lines lines = split(text(ToolChecks::teeth, 3));
  std::vector<std::size_t> headings;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (is_heading(lines[i])) headings.push_back(i);
  ASSERT_EQ(headings.size(), 11U);
  const std::size_t at = headings[1];  // between teeth of the first operation
  const bool iso = d != "siemens" && d != "heidenhain";
  const bool tcp = GetParam().tcp != machines::TcpMode::none;
  const auto without = [&](const std::string& words, std::size_t from, std::size_t to) {
    Lines less;
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (i < from || i >= to || lines[i].find(words) == std::string::npos) less.push_back(lines[i]);
    EXPECT_LT(less.size(), lines.size()) << words;
    return read_of(joined(less, GetParam()), control);
  };
  const std::size_t to = std::min(lines.size(), at + 40);
  const std::string retract = d == "siemens" ? "SUPA" : d == "heidenhain" ? "M91" : "G53";
  std::size_t close = at;  // where the cuts ahead of the check end
  while (close > 0 && lines[close].find("M5") == std::string::npos) --close;
  // With G43.4 a tooth ends with a retract of its own.
  const bool frozen = tcp && d == "fanuc";
  std::vector<std::pair<std::string, std::pair<std::size_t, std::size_t>>> needed;
  if (!frozen) needed.push_back({retract, {close, at}});
  if (iso) needed.insert(needed.end(), {{"G21 G17", {at, to}}, {"G54", {at, to}}, {"S1", {at, to}}});
  if (iso) needed.push_back({d == "linuxcnc" ? "G92.1" : "G52", {at, to}});
  if (iso) needed.push_back({"G61", {at, to}});
  if (iso && !(frozen && !GetParam().expand)) needed.push_back({frozen ? "G43.4" : "G43", {at, to}});
  if (d == "siemens")
    needed.insert(needed.end(), {{"G17 G40", {at, to}},
                                 {"G54", {at, to}},
                                 {"D1", {at, to}},
                                 {"S1", {at, to}},
                                 {"G641", {at, to}},
                                 {"COMPOF", {at, to}}});
  if (d == "heidenhain")
    needed.insert(needed.end(), {{"TOOL CALL 1", {at, to}},
                                 {"CYCL DEF 247", {at, to}},
                                 {"32.1", {at, to}},
                                 {"PLANE RESET", {at, to}},
                                 {"10.1 ROT+0", {at, at + 20}},
                                 {"M3", {at, to}}});
  for (const auto& [words, range] : needed) {
    const Read read = without(words, range.first, range.second);
    EXPECT_NE(read.refused, "") << d << ": without " << words;
    EXPECT_GT(read.line, 0) << words << ": " << read.refused;
  }
}

TEST_P(ToolCheckForms, TheLinesAreThoseOfTheMachine) {
  const Lines lines = split(text(ToolChecks::teeth, 3));
  const std::size_t count = control.tool_check->lines.size();
  std::size_t at = 0;
  while (!is_heading(lines[at])) ++at;
  const auto with = [&](auto&& edit) {
    Lines edited = lines;
    edit(edited);
    return read_of(joined(edited, GetParam()), control);
  };
  const auto replaced = [&](const std::string& what, const std::string& by) {
    return with([&](Lines& l) {
      bool found = false;
      for (std::size_t i = at + 1; i <= at + count; ++i)
        for (std::size_t k = l[i].find(what); k != std::string::npos && !found; k = std::string::npos) {
          l[i].replace(k, what.size(), by);
          found = true;
        }
      EXPECT_TRUE(found) << what;
    });
  };
  EXPECT_EQ(with([](Lines&) {}).refused, "");
  for (std::size_t i = 1; i <= count; ++i) {
    const Read read = with([&](Lines& l) { l.erase(l.begin() + static_cast<std::ptrdiff_t>(at + i)); });
    EXPECT_NE(read.refused, "") << "line " << i;
  }
  const Read tolerance = replaced("0.05", "0.5");
  EXPECT_NE(tolerance.refused.find("lets 0.5 mm pass, limit 0.05"), std::string::npos) << tolerance.refused;
  EXPECT_EQ(replaced("0.05", "0.03").refused, "") << "a closer one is the shop's business";
  const Read other = with([&](Lines& l) { l[at].replace(l[at].find("CHECK T1"), 8, "CHECK T2"); });
  EXPECT_NE(other.refused.find("a check of tool 2 while tool 1 is in the spindle"), std::string::npos) << other.refused;
  EXPECT_EQ(other.line, static_cast<int>(at) + 1);
  const Read unknown = with([&](Lines& l) { l.erase(l.begin() + static_cast<std::ptrdiff_t>(at)); });
  EXPECT_NE(unknown.refused, "") << "without its comment the lines are no words that are read";
  if (std::string(GetParam().dialect) != "heidenhain") {
    const Read place = replaced(std::string(GetParam().dialect) == "siemens" ? "-400" : "-100", "-90");
    if (std::string(GetParam().dialect) != "linuxcnc") {
      EXPECT_NE(place.refused.find("must be -"), std::string::npos) << place.refused;
    }
  }
}

TEST_P(ToolCheckForms, NoneStandsInATooth) {
  const Lines lines = split(text(ToolChecks::teeth, 3));
  const std::size_t count = control.tool_check->lines.size();
  std::size_t at = 0;
  while (!is_heading(lines[at])) ++at;
  const Lines check(lines.begin() + static_cast<std::ptrdiff_t>(at),
                    lines.begin() + static_cast<std::ptrdiff_t>(at + count + 1));
  // Behind every cut of the first tooth, and with the spindle stopped and Z at its top ahead of it as well.
  const std::string d = GetParam().dialect;
  const std::string retract = d == "siemens"      ? "SUPA G0 Z599.9 D0"
                              : d == "heidenhain" ? "0 L Z+599.9 R0 FMAX M91"
                              : d == "linuxcnc"   ? "G53 G0 Z599.9"
                                                  : "G0 G49 G53 Z599.9";
  const std::string number = d == "heidenhain" ? "0 " : "";
  int tried = 0;
  for (std::size_t i = at + count; i < lines.size() && tried < 40; ++i) {
    const bool cut = lines[i].find(" F") != std::string::npos && lines[i].find("FMAX") == std::string::npos &&
                     (lines[i].find('X') != std::string::npos || lines[i].find('Y') != std::string::npos);
    if (!cut) continue;
    ++tried;
    for (const bool prepared : {false, true}) {
      Lines edited(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      if (prepared) edited.insert(edited.end(), {number + "M5", retract});
      edited.insert(edited.end(), check.begin(), check.end());
      if (prepared) edited.insert(edited.end(), {retract, number + "M3"});
      edited.insert(edited.end(), lines.begin() + static_cast<std::ptrdiff_t>(i) + 1, lines.end());
      const Read read = read_of(joined(edited, GetParam()), control);
      EXPECT_NE(read.refused, "") << lines[i];
    }
  }
  EXPECT_GT(tried, 0);
}

TEST_P(ToolCheckForms, RestartsAndPartsBeginWithACheck) {
  const text::TextWishes wishes = asking(ToolChecks::teeth, 3);
  joints::AxisProgram divided = program;
  ASSERT_TRUE(text::divide_for_checks(divided, wishes));
  const std::string whole = text_with(machine, divided, wishes);
  const auto checks_of = [](const std::string& text) {
    std::vector<std::size_t> at;
    const Lines lines = split(text);
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (is_heading(lines[i])) at.push_back(i);
    return at;
  };
  for (const auto& [operation, tooth] : std::vector<std::pair<int, int>>{{0, 0}, {0, 2}, {1, 4}, {2, 6}}) {
    const auto part = joints::program_from(divided, operation, tooth);
    ASSERT_TRUE(part);
    const std::string text = text_with(machine, *part, wishes);
    const auto proof = restart::prove_restart(whole, text, "p", control, {operation, tooth, tooth, kTeeth});
    ASSERT_TRUE(proof) << proof.error().text();
    EXPECT_TRUE(proof->same) << proof->difference << " line " << proof->line << ", whole " << proof->whole_line;
    // Ahead of the first cut, too.
    const auto checks = checks_of(text);
    int first_cut = 0;
    ASSERT_TRUE(readback::execute_nc(text, "p", control, [&](const readback::ExecutedMove& m) {
      if (!m.rapid && first_cut == 0) first_cut = m.line;
    }));
    ASSERT_FALSE(checks.empty());
    const std::string sub = GetParam().dialect;
    if (!GetParam().expand && (sub == "linuxcnc" || sub == "fanuc" || sub == "haas" || sub == "mitsubishi_m80"))
      continue;  // the cuts stand in sub-programs elsewhere
    EXPECT_LT(static_cast<int>(checks.front()), first_cut);
  }
  for (const int most : {2, 3, kTeeth}) {
    const std::vector<joints::ProgramPart> parts = parts_of(divided, most);
    std::vector<std::string> texts;
    {
      const joints::PartMaker maker(divided);
      for (const auto& part : parts) texts.push_back(text_with(machine, maker.make(part), wishes));
    }
    std::vector<restart::PartText> list;
    for (std::size_t n = 0; n < parts.size(); ++n) list.push_back({texts[n], "part", parts[n]});
    const auto proof = restart::prove_parts(whole, "whole", list, control, divided);
    ASSERT_TRUE(proof) << proof.error().text();
    for (const auto& p : *proof) EXPECT_EQ(p.difference, "") << p.line << " " << p.whole_line;
    for (const std::string& text : texts) EXPECT_GE(checks_of(text).size(), 2U) << "at its beginning and its end";
  }
}

// The lines of LinuxCNC in LinuxCNC's interpreter: a probe that meets nothing, a length off by more and by less than
// the tolerance. The probe of the interpreter stops where its move ends.
TEST(ToolChecksLinuxcnc, StopWhereTheToolIsBroken) {
  const PostForm form = post_forms().front();
  machines::Machine machine = checking(form);
  machine.post.tcp_on = machine.post.tcp_off = {};  // codes of a site, which the interpreter alone does not know
  joints::AxisProgram program = *built(form);
  const text::TextWishes wishes = asking(ToolChecks::teeth, 3);
  const std::string plain = text_with(machine, program, asking(ToolChecks::none));
  ASSERT_TRUE(text::divide_for_checks(program, wishes));
  const std::string text = text_with(machine, program, wishes);
  const auto feeds = [](const Canonical& c) {
    std::vector<std::string> out;
    for (const std::string& l : c.lines)
      if (const auto at = l.find("STRAIGHT_FEED"); at != std::string::npos) out.push_back(l.substr(at));
    return out;
  };
  const auto ends = [](const Canonical& c) {
    return std::any_of(c.lines.begin(), c.lines.end(),
                       [](const std::string& l) { return l.find("PROGRAM_END") != std::string::npos; });
  };
  const auto run = [&](double off, bool met, const std::string& name) {
    Lines lines = split(text);
    for (std::string& l : lines) {
      if (const auto at = l.find("Z[0-2*10]"); at != std::string::npos)
        l.replace(at, 9, fmt::format("Z[0-10+{}]", off));
      if (const auto at = l.find("#5070 EQ 0"); at != std::string::npos && met) l.replace(at, 10, "#5070 EQ 9");
    }
    return interpret(joined(lines, form), name);
  };
  const Canonical before = interpret(plain, "tool_check_plain");
  ASSERT_EQ(before.exit, 0) << before.messages;
  for (const double off : {-0.049, 0.0, 0.049}) {
    const Canonical c = run(off, true, "tool_check_met");
    EXPECT_EQ(c.exit, 0) << c.messages;
    EXPECT_TRUE(ends(c));
    EXPECT_EQ(feeds(c), feeds(before));
    std::size_t probes = 0;
    for (const std::string& l : c.lines) probes += l.find("STRAIGHT_PROBE(-400.0000, 300.0000,") != std::string::npos;
    EXPECT_EQ(probes, 11U);
  }
  for (const double off : {-0.051, 0.051, -5.0}) {
    const Canonical c = run(off, true, "tool_check_off");
    EXPECT_NE(c.exit, 0);
    EXPECT_FALSE(ends(c));
    EXPECT_TRUE(feeds(c).empty());
    EXPECT_NE(c.messages.find("TOOL 1: LENGTH OFF BY MORE THAN 0.05 MM"), std::string::npos) << c.messages;
  }
  const Canonical nothing = run(0, false, "tool_check_nothing");
  EXPECT_NE(nothing.exit, 0);
  EXPECT_TRUE(feeds(nothing).empty());
}

// A measured length is off by what the machine file says: from the check on that counts wherever the tool cuts.
TEST(ToolChecksOf, AnUncertaintyCounts) {
  for (const PostForm& form : {post_forms()[0], post_forms()[9]}) {
    machines::Machine machine = checking(form);
    machine.tool_check->uncertainty_mm = 0.0015;
    joints::AxisProgram program = *built(form);
    const std::string text = text_with(machine, program, asking(ToolChecks::tool_changes));
    const auto control = *control_of(machine, standing(), tools());
    const auto read = readback::read_back(text, "p", control, machine, standing(), {.teeth = kTeeth});
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_FLOAT_EQ(static_cast<float>(read->length_off_mm), 0.0015F);
    const machines::Machine certain = checking(form);
    const auto exact_control = *control_of(certain, standing(), tools());
    const auto exact = readback::read_back(text, "p", exact_control, certain, standing(), {.teeth = kTeeth});
    ASSERT_TRUE(exact);
    for (std::size_t k = 0; k < read->operations.size(); ++k) {
      const auto with = readback::tool_motions(read->operations[k], read->copies, control, machine, standing(), kTeeth,
                                               {.tip_mm = 1e-3, .axis_rad = 1e-4});
      const auto sure = readback::tool_motions(exact->operations[k], exact->copies, exact_control, certain, standing(),
                                               kTeeth, {.tip_mm = 1e-3, .axis_rad = 1e-4});
      ASSERT_TRUE(with && sure);
      ASSERT_EQ(with->size(), sure->size());
      for (std::size_t i = 0; i < with->size(); ++i)
        if (!(*with)[i].rapid) { EXPECT_NEAR((*with)[i].deviation_mm, (*sure)[i].deviation_mm + 0.0015, 1e-9); }
    }
  }
}

TEST(ToolChecksOf, MachinesThatCannotAreRefused) {
  const auto told = [](const std::string& dialect, const auto& edit) {
    machines::Machine m = trunnion_with(dialect, machines::TcpMode::none);
    if (dialect == "apt") m.tcp = machines::TcpMode::vectors;
    m.tool_check.emplace();
    m.tool_check->tolerance_mm = 0.05;
    edit(*m.tool_check);
    const auto errors = controls::judge(m);
    return errors.empty() ? std::string() : errors.front().message;
  };
  const auto nothing = [](machines::ToolCheck&) {};
  EXPECT_EQ(told("linuxcnc", nothing), "");
  EXPECT_EQ(told("heidenhain", nothing), "");
  for (const char* d : {"fanuc", "haas", "mitsubishi_m80", "siemens"})
    EXPECT_NE(told(d, nothing).find("has no documented cycle for it: tool_check.lines"), std::string::npos) << d;
  EXPECT_NE(told("apt", nothing).find("has no words for it"), std::string::npos);
  EXPECT_NE(told("fanuc", [](auto& c) { c.lines = {"G65 P1 T{tol}"}; }).find("names {tol}, which is none of {tool}"),
            std::string::npos);
  EXPECT_NE(told("fanuc",
                 [](auto& c) {
                   c.lines = {"G65 P1 T{tool}"};
                   c.tolerance_mm.reset();
                 })
                .find("name no {tolerance}: tool_check.tolerance must say"),
            std::string::npos);
  EXPECT_NE(told("linuxcnc", [](auto& c) { c.position_mm.x() = 950; })
                .find("tool_check.position: X = 950 is outside its travel, -900 to 900"),
            std::string::npos);
}

}  // namespace
}  // namespace toothpath
