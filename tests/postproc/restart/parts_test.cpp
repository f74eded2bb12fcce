// Programs that hold a part of the teeth each: one behind the other they say, to a reader of their own (nc_walk), the
// words of the whole program; the proof sees every part that does not.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <sstream>

#include "postproc/readback/program_hash.h"
#include "postproc/restart/parts.h"
#include "tests/postproc/text/post_forms.h"
#include "tests/support/nc_walk.h"

namespace toothpath {
namespace {

using namespace test;

constexpr int kPartTeeth = 5;

/// The words of all moves that are no machine moves, in order.
std::vector<std::string> words(const std::string& text, const char* control) {
  const NcWalk walk = walk_nc(text, control);
  EXPECT_TRUE(walk.faults.empty()) << walk.faults.front();
  EXPECT_TRUE(walk.ended);
  std::vector<std::string> out;
  double top = -1e9;  // where the block that switches the tool length on goes
  for (const NcMove& m : walk.moves)
    if (m.rapid && !m.machine && m.linear[2]) top = std::max(top, *m.linear[2]);
  for (const NcMove& m : walk.moves) {
    if (m.machine || (m.rapid && !m.linear[0] && m.linear[2] == top && top > 400)) continue;
    std::ostringstream line;
    line.precision(12);
    line << (m.rapid ? "G0" : "G1") << " T" << m.tool << (m.tip ? " tip" : "") << " turned " << m.turned_deg;
    for (const double zero : m.zero_deg) line << " zero " << zero;
    for (const auto* list : {&m.linear, &m.rotary})
      for (const auto& w : *list) line << ' ' << (w ? *w : 1e9);
    if (m.direction)
      for (const double d : *m.direction) line << ' ' << d;
    if (!m.rapid) line << " F" << m.feed << (m.inverse ? " inverse" : "");
    out.push_back(line.str());
  }
  return out;
}

class Parts : public testing::TestWithParam<OrderedForm> {
 protected:
  void SetUp() override {
    const PostForm& f = GetParam().form;
    machine = machine_of(f);
    auto built =
        program_of(f, {sample_path(0.3, f.swing, 3), sample_path(0.3, f.swing, 2, 1)}, kPartTeeth, GetParam().stride);
    ASSERT_TRUE(built) << built.error().message;
    program = std::move(*built);
    const auto text = text_of(f, program);
    ASSERT_TRUE(text) << text.error().message;
    whole = text->text;
    const auto made = controls::control_of(machine, standing(), tools());
    ASSERT_TRUE(made);
    control = *made;
  }
  /// The texts of all parts of at most so many teeth.
  std::vector<restart::PartText> texts(int most_teeth) {
    held.clear();
    std::vector<restart::PartText> out;
    const std::vector<joints::ProgramPart> all = parts_of(program, most_teeth);
    const joints::PartMaker maker(program);
    for (const joints::ProgramPart& part : all) {
      auto text = text_of(GetParam().form, maker.make(part));
      EXPECT_TRUE(text) << (text ? "" : text.error().message);
      held.push_back(std::make_unique<std::string>(text->text));
      out.push_back({*held.back(), fmt::format("part{}", part.number), part});
    }
    return out;
  }
  /// What is found wrong; "refused" where a text is not read at all.
  std::string wrong(const std::vector<restart::PartText>& parts) const {
    const auto proof = restart::prove_parts(whole, "whole", parts, control, program);
    if (!proof) return "refused: " + proof.error().message;
    for (const restart::PartProof& p : *proof) {
      if (!p.difference.empty()) return p.difference;
      for (const auto* trace : {&p.approach, &p.departure})
        if (const auto clear = readback::check_rapids(*trace, control, machine, standing(), kBody, tools()); !clear)
          return clear.error().message;
    }
    return {};
  }
  machines::Machine machine;
  joints::AxisProgram program;
  std::string whole;
  readback::NcControl control;
  std::vector<std::unique_ptr<std::string>> held;
};
INSTANTIATE_TEST_SUITE_P(Forms, Parts, testing::ValuesIn(ordered_forms()));

TEST_P(Parts, OneBehindTheOtherAreTheWhole) {
  const std::vector<std::string> asked =
      GetParam().form.rollover == 0 ? words(whole, GetParam().form.dialect) : std::vector<std::string>();
  for (const int most : {1, 2, kPartTeeth}) {
    const auto parts = texts(most);
    ASSERT_EQ(parts.size(), 2U * static_cast<std::size_t>((kPartTeeth + most - 1) / most));
    EXPECT_EQ(wrong(parts), "");
    std::vector<std::string> said;
    for (std::size_t n = 0; n < parts.size(); ++n) {
      const std::string text(parts[n].text);
      EXPECT_NE(text.find(fmt::format("PART {} OF {}: OPERATION {}", n + 1, parts.size(), parts[n].part.operation)),
                std::string::npos);
      EXPECT_EQ(text.find("PARTS BEFORE") != std::string::npos, n > 0);
      const auto hash = readback::hash_of_program(text);
      EXPECT_TRUE(hash && hash->fits());
      if (GetParam().form.rollover != 0) continue;  // the reader of the tests does not know them
      for (std::string& w : words(text, GetParam().form.dialect)) said.push_back(std::move(w));
    }
    if (GetParam().form.rollover != 0) continue;
    ASSERT_EQ(said.size(), asked.size());
    for (std::size_t n = 0; n < said.size(); ++n) ASSERT_EQ(said[n], asked[n]) << n;
  }
  // The maker has given everything back.
  const auto again = text_of(GetParam().form, program);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->text, whole);
}

TEST_P(Parts, TimesAreThoseOfTheirTeeth) {
  double feed = 0;
  const double all = program.feed_minutes;
  const std::vector<joints::ProgramPart> parts = parts_of(program, 2);
  {
    const joints::PartMaker maker(program);
    for (const joints::ProgramPart& part : parts) {
      const joints::AxisProgram made = maker.make(part);
      ASSERT_EQ(made.operations.size(), 1U);
      EXPECT_EQ(made.operations[0].places(kPartTeeth), part.end_place - part.first_place);
      feed += made.feed_minutes;
      const auto text = text_of(GetParam().form, made);
      const auto read = readback::read_back(text->text, "p", control, machine, standing(), {.teeth = kPartTeeth});
      ASSERT_TRUE(read) << read.error().text();
      if (!made.tcp_starts_at_zero) {  // else the links have G1 of their own
        EXPECT_NEAR(read->feed_minutes, made.feed_minutes, 5e-3 * made.feed_minutes);
      }
    }
  }
  EXPECT_NEAR(feed, all, 1e-9 * all);
}

/// The first number of the line that holds `mark`, from this share of the text on, gets another digit.
std::string other_digit(std::string text, const std::string& mark, double share) {
  std::size_t at = text.find(mark, static_cast<std::size_t>(share * static_cast<double>(text.size())));
  if (at == std::string::npos) return {};
  at = text.find('.', at);
  if (at == std::string::npos) return {};
  text[at - 1] = text[at - 1] == '9' ? '1' : static_cast<char>(text[at - 1] + 1);
  return text;
}

std::string without_line(std::string text, const std::string& what) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) return {};
  const std::size_t begin = text.rfind('\n', at) + 1;
  return text.erase(begin, text.find('\n', at) + 1 - begin);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  return at == std::string::npos ? std::string() : text.replace(at, from.size(), to);
}

TEST_P(Parts, PlantedFaultsAreSeen) {
  const std::string dialect = GetParam().form.dialect;
  const auto parts = texts(2);
  ASSERT_EQ(wrong(parts), "");
  const auto without = [&](std::size_t n) {
    auto list = parts;
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(n));
    return list;
  };
  for (std::size_t n = 0; n < parts.size(); ++n) EXPECT_NE(wrong(without(n)), "") << "part " << n << " is missing";
  auto swapped = parts;
  std::swap(swapped[0].text, swapped[1].text);
  EXPECT_NE(wrong(swapped), "") << "two parts swapped";
  auto twice = parts;
  twice[1].text = twice[0].text;
  EXPECT_NE(wrong(twice), "") << "one part twice";
  auto all = parts;
  all[1].text = whole;
  EXPECT_NE(wrong(all), "") << "the whole program as a part";
  const std::string mark = dialect == "apt" ? "GOTO/" : "X";
  for (const double share : {0.5, 0.7}) {
    const std::string text = other_digit(std::string(parts[1].text), mark, share);
    ASSERT_FALSE(text.empty());
    auto list = parts;
    list[1].text = text;
    EXPECT_NE(wrong(list), "") << "a digit at " << share;
  }
  // What no word of the axes says: coolant and speed.
  const std::string dry = without_line(std::string(parts[2].text), dialect == "apt" ? "COOLNT/FLOOD" : "M8");
  const std::string slow = replaced(std::string(parts[2].text), "12000", "1200");
  ASSERT_FALSE(dry.empty());
  ASSERT_FALSE(slow.empty());
  for (const std::string& text : {dry, slow}) {
    auto list = parts;
    list[2].text = text;
    EXPECT_NE(wrong(list), "") << text.substr(0, 600);
  }
}

}  // namespace
}  // namespace toothpath
