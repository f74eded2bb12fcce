// Restart: a program that begins at one tooth makes the last moves of the whole one, and so does the whole text when it
// is taken up at each place of the menu with a control that knows nothing but the start of the program.
#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "postproc/joints/time.h"
#include "postproc/restart/menu.h"
#include "postproc/restart/proof.h"
#include "tests/postproc/text/post_forms.h"

namespace toothpath {
namespace {

using namespace test;

constexpr int kTeeth = 5;

std::vector<std::string> lines_in(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string l; std::getline(in, l);) out.push_back(l);
  return out;
}

/// Lines as a text; Heidenhain's numbers count up again.
std::string joined(const std::vector<std::string>& lines, bool numbered) {
  std::string out;
  for (std::size_t i = 0; i < lines.size(); ++i)
    out += numbered ? std::to_string(i) + lines[i].substr(lines[i].find(' ')) + "\n" : lines[i] + "\n";
  return out;
}

class Restart : public testing::TestWithParam<OrderedForm> {
 protected:
  void SetUp() override {
    const PostForm& f = GetParam().form;
    machine = machine_of(f);
    const auto built =
        program_of(f, {sample_path(0.3, f.swing, 3), sample_path(0.3, f.swing, 2, 1)}, kTeeth, GetParam().stride);
    ASSERT_TRUE(built) << built.error().message;
    program = *built;
    const auto text = text_of(f, program);
    ASSERT_TRUE(text) << text.error().message;
    whole = text->text;
    const auto made = controls::control_of(machine, standing(), tools());
    ASSERT_TRUE(made);
    control = *made;
  }
  Result<restart::RestartProof> prove(const std::string& text, int operation, int place) const {
    return restart::prove_restart(whole, text, "p", control,
                                  {operation, joints::tooth_of_place(place, GetParam().stride, kTeeth), place, kTeeth});
  }
  machines::Machine machine;
  joints::AxisProgram program;
  std::string whole;
  readback::NcControl control;
};
INSTANTIATE_TEST_SUITE_P(Forms, Restart, testing::ValuesIn(ordered_forms()));

TEST_P(Restart, WrittenProgramMakesTheLastMoves) {
  const bool numbered = std::string(GetParam().form.dialect) == "heidenhain";
  for (const int op : {0, 1})
    for (int place = 0; place < kTeeth; ++place) {
      const int tooth = joints::tooth_of_place(place, GetParam().stride, kTeeth);
      const auto part = joints::program_from(program, op, tooth);
      ASSERT_TRUE(part);
      EXPECT_LE(part->feed_minutes, program.feed_minutes + 1e-12);
      const double teeth_left = place == 0 ? kTeeth : kTeeth - place;
      EXPECT_NEAR(part->operations[0].feed_minutes,
                  program.operations[static_cast<std::size_t>(op)].feed_minutes * teeth_left / kTeeth, 1e-4);
      const auto text = text_of(GetParam().form, *part);
      ASSERT_TRUE(text) << text.error().message;
      EXPECT_NE(text->text.find(fmt::format("RESTART AT OPERATION {} TOOTH {}", op, tooth)), std::string::npos);
      const auto proof = prove(text->text, op, place);
      ASSERT_TRUE(proof) << proof.error().text();
      EXPECT_TRUE(proof->same) << proof->difference << " line " << proof->line << ", whole " << proof->whole_line;
      const auto clear = readback::check_rapids(proof->approach, control, machine, standing(), kBody, tools());
      EXPECT_TRUE(clear) << (clear ? "" : clear.error().message);
      // The menu of the part itself: as many teeth as are left.
      const auto menu = restart::restart_menu(text->text, "p", control, *part);
      ASSERT_TRUE(menu) << menu.error().text();
      EXPECT_EQ(menu->operations.size(), op == 0 ? 2u : 1u);
      EXPECT_EQ(menu->operations[0].teeth.size(), static_cast<std::size_t>(kTeeth - place));
      EXPECT_EQ(menu->operations[0].teeth.front().tooth, tooth);
      // The same line says the same thing, or is nowhere.
      const auto whole_lines = lines_in(whole), part_lines = lines_in(text->text);
      for (const auto& [from, to] : proof->line_of) {
        std::string a = whole_lines[static_cast<std::size_t>(from) - 1],
                    b = part_lines[static_cast<std::size_t>(to) - 1];
        if (numbered) {
          a = a.substr(a.find(' '));
          b = b.substr(b.find(' '));
        }
        if (GetParam().form.rollover != 0)  // the first tooth is turned to from nowhere, by any way
          for (std::string* line : {&a, &b})
            *line = std::regex_replace(*line, std::regex("^(N[0-9]+ )?G0 C-"), "$1G0 C");
        ASSERT_EQ(a, b);
      }
    }
}

// The part has times and ranges of its own: those of its text, and with accelerations those of its teeth.
TEST_P(Restart, TimesAndRangesAreThoseOfThePart) {
  machines::Machine quick = machine;
  for (auto& axis : quick.chain.linear) axis.max_acceleration = 2000 * 3600.0;
  for (auto* list : {&quick.chain.table, &quick.chain.head})
    for (auto& axis : *list) axis.max_acceleration = radians(3000) * 3600;
  joints::AxisProgram timed = program;
  estimate_times(timed, quick);
  const std::size_t rulers = timed.time_rulers.size();
  const auto shares = [](const joints::AxisOperation& o) { return o.accelerated.feed + o.accelerated.rapid; };
  double before = 1e9;
  for (int place = 0; place < kTeeth; ++place) {
    auto part = joints::program_from(timed, 1, joints::tooth_of_place(place, GetParam().stride, kTeeth));
    ASSERT_TRUE(part);
    estimate_times(*part, quick);
    EXPECT_EQ(part->time_rulers.size(), rulers);
    EXPECT_EQ(part->time_ruled.size(), rulers);
    ASSERT_EQ(part->operations.size(), 1u);
    const joints::AxisOperation &own = part->operations[0], &all = timed.operations[1];
    EXPECT_NEAR(own.accelerated.feed, all.accelerated.feed * (kTeeth - place) / kTeeth, 2e-3 * all.accelerated.feed);
    EXPECT_GE(own.accelerated.feed, own.feed_minutes);
    if (place == 0) {
      // The rotaries stand anywhere ahead of the part, and where the operation before has left them in the whole
      // program.
      EXPECT_NEAR(own.accelerated.rapid, all.accelerated.rapid, 0.1);
      EXPECT_NEAR(own.rapid_minutes, all.rapid_minutes, 1e-12);
    }
    EXPECT_LT(shares(own), before);
    before = shares(own);
    EXPECT_NEAR(part->accelerated.feed + part->accelerated.rapid, shares(own), 1e-12);
    const auto text = text_of(GetParam().form, *part);
    ASSERT_TRUE(text);
    EXPECT_NE(text->text.find(
                  fmt::format("RUN TIME {:.2f} MIN, {:.2f} MIN OF IT CUTTING", shares(own), own.accelerated.feed)),
              std::string::npos);
    const auto read = readback::read_back(text->text, "p", control, machine, standing(), {.teeth = kTeeth});
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_GE(read->feed_minutes, own.feed_minutes * (1 - 5e-3));
    const auto run = readback::read_back(text->text, "p", control, quick, standing(), {.teeth = kTeeth});
    ASSERT_TRUE(run) << run.error().text();
    EXPECT_GT(run->accelerated.feed, own.accelerated.feed * (1 - 1e-2));
    if (!part->tcp_starts_at_zero) {  // else the links have G1 of their own
      EXPECT_LE(read->feed_minutes, own.feed_minutes * (1 + 5e-3));
    }
    const auto proof = prove(text->text, 1, place);
    ASSERT_TRUE(proof);
    for (std::size_t a = 0; a < 5; ++a) {
      EXPECT_EQ(proof->least[a], read->least[a]);
      EXPECT_EQ(proof->greatest[a], read->greatest[a]);
    }
  }
}

/// The operator fetches tool 1 behind the first retract, where the text goes on with it.
void tool_by_hand(std::vector<std::string>& lines) {
  static const std::regex retract("G53 G0 Z|G0 G49 G53 Z|SUPA G0 Z|L Z\\S+ R0 FMAX M91|^SPINDL/RPM");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!std::regex_search(lines[i], retract)) continue;
    const auto at = lines.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    if (lines[i].find("SPINDL") != std::string::npos) lines.insert(at - 1, "LOADTL/1,LENGTH,95.");
    else if (lines[i].find("SUPA") != std::string::npos) lines.insert(at, {"T=\"T1\"", "M6"});
    else if (lines[i].find("M91") != std::string::npos) lines.insert(at, "0 TOOL CALL 1 Z S12000");
    else lines.insert(at, "T1 M6");
    return;
  }
}

TEST_P(Restart, EveryPlaceOfTheMenuGivesTheSameMotion) {
  const bool numbered = std::string(GetParam().form.dialect) == "heidenhain";
  const auto menu = restart::restart_menu(whole, "p", control, program);
  ASSERT_TRUE(menu) << menu.error().text();
  ASSERT_EQ(menu->operations.size(), 2u);
  const auto lines = lines_in(whole);
  const auto at = [&](const restart::RestartLine& l) { return lines[static_cast<std::size_t>(l.line) - 1]; };
  for (std::size_t k = 0; k < 2; ++k) {
    const restart::RestartOperation& op = menu->operations[k];
    EXPECT_EQ(op.operation, static_cast<int>(k));
    EXPECT_EQ(op.type, "finishing");
    EXPECT_NE(at(op.at).find(fmt::format("OP {} finishing", k)), std::string::npos);
    EXPECT_EQ(op.at.number, numbered ? op.at.line - 1 : -1);
    ASSERT_EQ(op.teeth.size(), static_cast<std::size_t>(kTeeth));
    const bool loop = op.first_tooth.line != 0;
    const std::string dialect = GetParam().form.dialect;
    EXPECT_EQ(loop, program.loop && dialect != "fanuc" && dialect != "haas" && dialect != "mitsubishi_m80");
    for (const restart::RestartTooth& t : op.teeth) {
      std::vector<std::string> part(lines.begin(), lines.begin() + menu->start_end.line);
      auto rest = lines;
      if (loop) {
        std::string& first = rest[static_cast<std::size_t>(op.first_tooth.line) - 1];
        const std::string before = first;
        first = std::regex_replace(first, std::regex("(=|= )0( |$)"), fmt::format("$01{}$2", t.place));
        if (t.place > 0) { ASSERT_NE(first, before); }
        part.insert(part.end(), rest.begin() + op.at.line - 1, rest.end());
      } else {
        part.insert(part.end(), rest.begin() + op.at.line - 1, rest.begin() + op.opening_end.line);
        part.insert(part.end(), rest.begin() + t.at.line - 1, rest.end());
      }
      EXPECT_EQ(op.tool_before, k == 1 ? 1 : 0);  // both operations have the same tool
      if (op.tool_before > 0) tool_by_hand(part);
      const auto proof = prove(joined(part, numbered), op.operation, t.place);
      ASSERT_TRUE(proof) << proof.error().text() << " tooth " << t.tooth;
      EXPECT_TRUE(proof->same) << "op " << k << " tooth " << t.tooth << ": " << proof->difference << " line "
                               << proof->line << ", whole " << proof->whole_line;
    }
  }
}

// Planted faults: another tooth, a digit, a tooth that is missing.
TEST_P(Restart, PlantedFaultsAreSeen) {
  const PostForm& f = GetParam().form;
  const auto part = joints::program_from(program, 0, joints::tooth_of_place(2, GetParam().stride, kTeeth));
  ASSERT_TRUE(part);
  std::string text = text_of(f, *part)->text;
  const auto wrong = [&](const std::string& t, int place) {
    const auto proof = prove(t, 0, place);
    return !proof || !proof->same;
  };
  EXPECT_FALSE(wrong(text, 2));
  EXPECT_TRUE(wrong(text, 1));
  EXPECT_TRUE(wrong(text, 3));
  EXPECT_TRUE(wrong(whole, 2));
  // One digit of a number behind the middle of the program.
  for (const double share : {0.55, 0.7, 0.85}) {
    std::string t = text;
    std::size_t at = static_cast<std::size_t>(share * static_cast<double>(t.size()));
    const std::string mark = std::string(f.dialect) == "apt" ? "GOTO/" : "X";
    at = t.find(mark, at);
    if (at == std::string::npos) continue;
    at = t.find('.', at);
    ASSERT_NE(at, std::string::npos);
    t[at - 1] = t[at - 1] == '9' ? '1' : static_cast<char>(t[at - 1] + 1);
    EXPECT_TRUE(wrong(t, 2)) << share;
  }
}

TEST(RestartOf, WhatDoesNotExistIsRefused) {
  const PostForm f = post_forms().front();
  const auto program = program_of(f, {sample_path(0.3, 0.1, 3)}, kTeeth, 1);
  ASSERT_TRUE(program);
  const auto message = [&](int op, int tooth) {
    const auto r = joints::program_from(*program, op, tooth);
    return r ? std::string("none") : r.error().message;
  };
  EXPECT_EQ(message(0, 4), "none");
  EXPECT_EQ(message(1, 0), "operation 1 does not exist: the program has the operations 0 to 0");
  EXPECT_EQ(message(0, 5), "tooth 5 does not exist: the gear has the teeth 0 to 4");
  EXPECT_EQ(message(0, -1), "tooth -1 does not exist: the gear has the teeth 0 to 4");
}

}  // namespace
}  // namespace toothpath
