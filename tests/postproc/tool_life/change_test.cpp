// Tools that last so many minutes: random lives in every form of text. Minutes and changes are taken from the text by a
// reader of its own (nc_walk); its order of words must be that of the program without sisters.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "postproc/joints/time.h"
#include "postproc/restart/menu.h"
#include "postproc/restart/parts.h"
#include "postproc/restart/proof.h"
#include "postproc/tool_life/change.h"
#include "tests/postproc/text/post_forms.h"
#include "tests/support/nc_walk.h"
#include "tests/support/random.h"

namespace toothpath {
namespace {

using namespace test;

constexpr int kLifeTeeth = 7;

std::vector<tool::ToolAssembly> with_sisters(int count) {
  std::vector<tool::ToolAssembly> all = tools();
  for (int n = 0; n < count; ++n) {
    tool::ToolAssembly sister = all[0];
    sister.number = 21 + n;
    sister.sister_of = all[0].number;
    all.push_back(sister);
  }
  return all;
}

/// What a text says of its cuts.
struct Cuts {
  std::vector<std::string> words;  ///< of every feed, without its tool
  std::vector<int> tool;           ///< .. and that
  std::vector<double> minutes;     ///< .. and what it takes
};

Cuts cuts_of(const std::string& text, const char* control) {
  const NcWalk walk = walk_nc(text, control);
  EXPECT_TRUE(walk.faults.empty()) << walk.faults.front();
  Cuts out;
  std::array<double, 3> at{}, turned{};
  for (const NcMove& m : walk.moves) {
    std::array<double, 3> to = at, axes = turned;
    for (std::size_t k = 0; k < 3; ++k) {
      to[k] = m.linear[k].value_or(m.machine ? NAN : at[k]);
      axes[k] = m.rotary[k].value_or(turned[k]);
    }
    if (!m.rapid) {
      const double way = std::hypot(to[0] - at[0], to[1] - at[1], to[2] - at[2]);
      const double turn = std::hypot(axes[0] - turned[0], axes[1] - turned[1], axes[2] - turned[2]);
      std::string words = fmt::format("{} {} {} F{}", to[0], to[1], to[2], m.feed);
      for (const double zero : m.zero_deg) words += fmt::format(" zero {:.9g}", zero);
      for (const auto& r : m.rotary) words += r ? fmt::format(" {:.9g}", *r) : " -";
      out.words.push_back(words);
      out.tool.push_back(m.tool);
      out.minutes.push_back(m.inverse ? 1 / m.feed : (way > 1e-9 ? way : turn) / m.feed);
    }
    at = to;
    turned = axes;
  }
  return out;
}

class ToolLife : public testing::TestWithParam<OrderedForm> {
 protected:
  void SetUp() override {
    const PostForm& f = GetParam().form;
    machine = machine_of(f);
    auto built =
        program_of(f, {sample_path(0.3, f.swing, 3), sample_path(0.3, f.swing, 2, 1)}, kLifeTeeth, GetParam().stride);
    ASSERT_TRUE(built) << built.error().message;
    program = std::move(*built);
    plain = text_of(f, program)->text;
    for (const auto& op : program.operations)
      for (const double m : tool_life::minutes_of_places(op, program)) teeth.push_back(m);
  }
  readback::NcControl control(int sisters) const {
    return *controls::control_of(machine, standing(), with_sisters(sisters));
  }
  machines::Machine machine;
  joints::AxisProgram program;
  std::string plain;
  std::vector<double> teeth;  ///< minutes of every tooth, in the order of the program
};
INSTANTIATE_TEST_SUITE_P(Forms, ToolLife, testing::ValuesIn(ordered_forms()));

TEST_P(ToolLife, RandomLives) {
  const PostForm& form = GetParam().form;
  Random random(81 + static_cast<std::uint64_t>(GetParam().stride));
  ASSERT_EQ(teeth.size(), 2U * kLifeTeeth);
  const double longest = *std::max_element(teeth.begin(), teeth.end());
  const bool walks = form.rollover == 0;  // the reader of the tests does not know axes that roll over
  const Cuts before = walks ? cuts_of(plain, form.dialect) : Cuts();
  for (int trial = 0; trial < 6; ++trial) {
    const double life = longest * random(1.0, 6.0);
    // By hand: tooth by tooth, a new tool where one does not fit.
    std::vector<int> cuts_with;
    double used = 0;
    int tool = 0;
    for (const double m : teeth) {
      if (used > 0 && used + m > life * (1 + 1e-9)) used = 0, ++tool;
      used += m;
      cuts_with.push_back(tool == 0 ? 1 : 20 + tool);
    }
    std::vector<int> sisters;
    for (int n = 0; n < tool; ++n) sisters.push_back(21 + n);
    joints::AxisProgram changed = program;
    const std::vector<tool_life::LastingTool> lasting = {{1, life, sisters}};
    const auto short_of = tool_life::change_tools(changed, lasting);
    ASSERT_TRUE(short_of.empty()) << short_of.front().text;
    EXPECT_NEAR(changed.feed_minutes, program.feed_minutes, 1e-9);
    const auto text = text_of(form, changed);
    ASSERT_TRUE(text) << text.error().message;
    // The same cuts in the same order, each tooth with its tool.
    if (walks) {
      const Cuts now = cuts_of(text->text, form.dialect);
      ASSERT_EQ(now.words, before.words);
      std::map<int, double> minutes;
      for (std::size_t n = 0; n < now.tool.size(); ++n) minutes[now.tool[n]] += now.minutes[n];
      for (const auto& use : changed.tool_uses) {
        EXPECT_LE(use.minutes(), life * (1 + 1e-6));
        // With TCP the tip begins where the joints have left it.
        if (form.tcp == machines::TcpMode::none) {
          EXPECT_NEAR(minutes[use.tool], use.minutes(), 1e-2 * use.minutes());
        }
      }
      EXPECT_EQ(minutes.size(), changed.tool_uses.size());
    }
    const auto ctl = control(tool);
    std::vector<std::pair<int, std::size_t>> runs;  // operation and tool, feeds one behind the other
    std::vector<int> seen;                          // tool of every tooth
    std::map<std::pair<int, int>, int> tool_of;     // of teeth that the text names
    ASSERT_TRUE(readback::execute_nc(text->text, "p", ctl, [&](const readback::ExecutedMove& m) {
      if (m.rapid || m.operation < 0) return;
      const auto [named, first] = tool_of.try_emplace({m.operation, m.tooth}, m.tool);
      if (m.tooth >= 0 && first) seen.push_back(m.tool);
      if (m.tooth >= 0) { EXPECT_EQ(named->second, m.tool) << "changed within a tooth"; }
      const int key = m.operation * 1000 + m.tool;
      if (runs.empty() || runs.back().first != key) runs.push_back({key, 0});
      ++runs.back().second;
    }));
    std::map<int, std::size_t> feeds_of;
    for (const auto& [key, count] : runs) feeds_of[key / 1000] += count;
    for (const auto& [key, count] : runs) {
      if (tool_of.begin()->first.second >= 0) continue;
      const std::size_t cut = feeds_of[key / 1000] / kLifeTeeth;
      ASSERT_EQ(count % cut, 0U) << "changed within a tooth";
      for (std::size_t k = 0; k < count / cut; ++k) seen.push_back(key % 1000);
    }
    EXPECT_EQ(seen, cuts_with);
    // Read back as the program without sisters: the same copies, and it lasts.
    const auto read =
        readback::read_back(text->text, "p", ctl, machine, standing(), {.teeth = kLifeTeeth, .life_min = [&] {
                                                                          std::map<int, double> lives = {{1, life}};
                                                                          for (const int s : sisters) lives[s] = life;
                                                                          return lives;
                                                                        }()});
    ASSERT_TRUE(read) << read.error().text();
    const auto plain_read = readback::read_back(plain, "p", ctl, machine, standing(), {.teeth = kLifeTeeth});
    ASSERT_TRUE(plain_read);
    EXPECT_EQ(read->copies.copies, plain_read->copies.copies) << read->copies.difference;
    EXPECT_TRUE(read->worn_out.empty());
    EXPECT_EQ(read->mixed_rapid, 0);
    for (std::size_t k = 0; k < read->copies.operations.size() && read->copies.copies; ++k)
      EXPECT_EQ(read->copies.operations[k].turns, plain_read->copies.operations[k].turns);
    for (const auto& trace : read->between)
      EXPECT_TRUE(readback::check_rapids_outside(trace, ctl, machine, standing(), readback::obstacle_of(kBody),
                                                 with_sisters(tool)));
    // A life that is shorter is seen, with a line of the tool.
    const auto worn =
        readback::read_back(text->text, "p", ctl, machine, standing(),
                            {.teeth = kLifeTeeth, .life_min = {{1, 0.9 * changed.tool_uses[0].minutes()}}});
    ASSERT_TRUE(worn);
    ASSERT_EQ(worn->worn_out.size(), 1U);
    EXPECT_EQ(worn->worn_out[0].tool, 1);
    EXPECT_GT(worn->worn_out[0].line, 0);
  }
}

TEST_P(ToolLife, RestartsAndPartsCallTheRightSister) {
  const PostForm& form = GetParam().form;
  const double life = 2.5 * *std::max_element(teeth.begin(), teeth.end());
  const std::vector<tool_life::LastingTool> lasting = {{1, life, {21, 22, 23, 24, 25, 26}}};
  joints::AxisProgram changed = program;
  ASSERT_TRUE(tool_life::change_tools(changed, lasting).empty());
  const std::string whole = text_of(form, changed)->text;
  const auto ctl = control(6);
  const auto menu = restart::restart_menu(whole, "p", ctl, changed);
  ASSERT_TRUE(menu) << menu.error().text();
  ASSERT_EQ(menu->operations.size(), changed.operations.size());
  std::map<std::pair<int, int>, int> tool_at;  // operation and place
  for (std::size_t k = 0; k < menu->operations.size(); ++k) {
    EXPECT_EQ(menu->operations[k].tool, changed.operations[k].tool_number);
    EXPECT_EQ(menu->operations[k].teeth.size(), std::size_t(changed.operations[k].places(kLifeTeeth)));
    for (const auto& t : menu->operations[k].teeth)
      tool_at[{menu->operations[k].operation, t.place}] = menu->operations[k].tool;
  }
  ASSERT_EQ(tool_at.size(), 2U * kLifeTeeth);
  for (const auto& [where, tool] : tool_at) {
    const int tooth = joints::tooth_of_place(where.second, GetParam().stride, kLifeTeeth);
    const auto part = joints::program_from(changed, where.first, tooth);
    ASSERT_TRUE(part);
    EXPECT_EQ(part->operations.front().tool_number, tool);
    const auto text = text_of(form, *part);
    ASSERT_TRUE(text) << text.error().message;
    const auto proof =
        restart::prove_restart(whole, text->text, "p", ctl, {where.first, tooth, where.second, kLifeTeeth});
    ASSERT_TRUE(proof) << proof.error().text();
    EXPECT_TRUE(proof->same) << proof->difference << " line " << proof->line << ", whole " << proof->whole_line;
  }
  for (const int most : {2, 3, kLifeTeeth}) {
    const std::vector<joints::ProgramPart> parts = parts_of(changed, most);
    std::vector<std::string> texts;
    {
      const joints::PartMaker maker(changed);
      for (const auto& part : parts) texts.push_back(text_of(form, maker.make(part))->text);
    }
    std::vector<restart::PartText> list;
    for (std::size_t n = 0; n < parts.size(); ++n) list.push_back({texts[n], "part", parts[n]});
    const auto proof = restart::prove_parts(whole, "whole", list, ctl, changed);
    ASSERT_TRUE(proof) << proof.error().text();
    for (const auto& p : *proof) EXPECT_EQ(p.difference, "") << p.line << " " << p.whole_line;
    // The tool of before in its place is another program.
    auto wrong = changed;
    for (auto& op : wrong.operations) op.tool_number = 1;
    texts.clear();
    {
      const joints::PartMaker maker(wrong);
      for (const auto& part : parts) texts.push_back(text_of(form, maker.make(part))->text);
    }
    for (std::size_t n = 0; n < parts.size(); ++n) list[n].text = texts[n];
    const auto other = restart::prove_parts(whole, "whole", list, ctl, changed);
    EXPECT_TRUE(!other ||
                std::any_of(other->begin(), other->end(), [](const auto& p) { return !p.difference.empty(); }));
  }
}

TEST(ToolLifeOf, WhatDoesNotLastIsTold) {
  const PostForm form = post_forms().front();
  auto built = program_of(form, {sample_path(0.3, 0.1, 3)}, kLifeTeeth, 1);
  ASSERT_TRUE(built);
  const double tooth = tool_life::minutes_of_places(built->operations[0], *built).front();
  const auto told = [&](double life, std::vector<int> sisters) {
    joints::AxisProgram program = *built;
    const std::vector<tool_life::LastingTool> tools = {{1, life, std::move(sisters)}};
    const auto short_of = tool_life::change_tools(program, tools);
    return short_of.empty() ? tool_life::Shortage{} : short_of.front();
  };
  EXPECT_EQ(told(7.001 * tooth, {}).text, "");
  EXPECT_EQ(told(3.5 * tooth, {21, 22}).text, "");
  const auto one = told(0.9 * tooth, {21, 22, 23});
  EXPECT_TRUE(one.one_tooth);
  EXPECT_NE(one.text.find(fmt::format("one tooth takes {:.4g} min of cutting with tool 1, its life is {:g} min", tooth,
                                      0.9 * tooth)),
            std::string::npos)
      << one.text;
  // Seven teeth, two tools of three: one tooth is left. A life of four would do, or a sister more.
  const auto two = told(3.5 * tooth, {21});
  EXPECT_FALSE(two.one_tooth);
  EXPECT_EQ(two.tool, 1);
  EXPECT_NE(two.text.find(fmt::format("{:.4g} min are missing; 1 more sister, or a life of", tooth)), std::string::npos)
      << two.text;
  const double would_do = std::stod(two.text.substr(two.text.find("life of") + 8));
  EXPECT_GE(would_do, 4 * tooth * (1 - 1e-3));
  EXPECT_LE(would_do, 4 * tooth * (1 + 2e-3));
  const auto none = told(2.5 * tooth, {});
  EXPECT_NE(none.text.find("3 more sisters"), std::string::npos) << none.text;
}

// With accelerations every tooth counts as long as the machine takes for it, and so do the readers.
TEST(ToolLifeOf, AccelerationsCount) {
  const PostForm form = post_forms().front();
  machines::Machine machine = machine_of(form);
  for (auto& axis : machine.chain.linear) axis.max_acceleration = 500 * 3600.0;
  for (auto* list : {&machine.chain.table, &machine.chain.head})
    for (auto& axis : *list) axis.max_acceleration = radians(500) * 3600;
  auto built = program_of(form, {sample_path(0.3, 0.1, 3)}, kLifeTeeth, 1);
  ASSERT_TRUE(built);
  const double asked = tool_life::minutes_of_places(built->operations[0], *built).front();
  estimate_times(*built, machine);
  const double timed = tool_life::minutes_of_places(built->operations[0], *built).front();
  EXPECT_GT(timed, 1.05 * asked);
  const double life = 3.2 * timed;
  const std::vector<tool_life::LastingTool> lasting = {{1, life, {21, 22}}};
  ASSERT_TRUE(tool_life::change_tools(*built, lasting).empty());
  estimate_times(*built, machine);
  const auto control = *controls::control_of(machine, standing(), with_sisters(2));
  const auto read = readback::read_back(text_of(form, *built)->text, "p", control, machine, standing(),
                                        {.teeth = kLifeTeeth, .life_min = {{1, life}, {21, life}, {22, life}}});
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_TRUE(read->worn_out.empty());
  for (const auto& use : built->tool_uses)
    EXPECT_NEAR(read->cutting_minutes.at(use.tool), use.minutes(), 1e-2 * use.minutes());
}

}  // namespace
}  // namespace toothpath
