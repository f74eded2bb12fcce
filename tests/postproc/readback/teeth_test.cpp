// Programs followed tooth by tooth: the same moves, motions and bounds as of the whole program, in every way a corner
// can lie on two teeth; programs that do not stand tooth by tooth are held as a whole.
#include "postproc/readback/teeth.h"

#include <gtest/gtest.h>

#include "postproc/joints/tooth_order.h"
#include "tests/postproc/readback/nc_case.h"

namespace toothpath {
namespace {

using namespace test;

constexpr int kTeeth = 6;

struct Written {
  machines::Machine machine;
  joints::Setup setup;
  std::string text;
  readback::NcControl control;
};

Written written(const char* dialect, double swing, bool eccentric) {
  Written w;
  w.machine = with_dialect(trunnion(), dialect);
  w.setup = standing();
  if (eccentric) w.setup.origin_mm += Vec3(2, 1, 0);
  const std::vector<path::ClPath> paths = {sample_path(0.3, swing), sample_path(0.2, swing, 25, 1)};
  const auto program = axis_program(paths, w.machine, w.setup, kTeeth, true);
  EXPECT_TRUE(program) << program.error().message;
  const auto text = text::write_nc(*program, *controls::dialect_of(w.machine), {});
  EXPECT_TRUE(text) << text.error().message;
  w.text = text->text;
  w.control = *controls::control_of(w.machine, w.setup, tools());
  return w;
}

readback::ReadBack read(const Written& w, const std::string& text, bool first_teeth, std::size_t max_kept = 1 << 20) {
  auto back =
      readback::read_back(text, "p.nc", w.control, w.machine, w.setup,
                          {.teeth = kTeeth, .keep_all = false, .first_teeth = first_teeth, .max_kept = max_kept});
  EXPECT_TRUE(back) << back.error().message;
  return back ? std::move(*back) : readback::ReadBack();
}

void append(const Written& w, const readback::OperationTrace& trace, std::vector<path::ToolMotion>& motions) {
  const Status added =
      readback::add_tool_motions(trace, {}, {w.control, w.machine, w.setup, kTeeth, {2e-4, 1e-4}}, motions);
  EXPECT_TRUE(added) << added.error().message;
}

bool same(const path::ToolMotion& a, const path::ToolMotion& b) {
  return a.tip_from == b.tip_from && a.tip_to == b.tip_to && a.axis_from == b.axis_from && a.axis_to == b.axis_to &&
         a.deviation_mm == b.deviation_mm && a.axis_deviation == b.axis_deviation && a.minutes == b.minutes &&
         a.rapid == b.rapid && a.operation == b.operation && a.tooth == b.tooth && a.line == b.line;
}

// Siemens lets corners go by a way (G641): what a motion may stray depends on the blocks on both sides of it.
TEST(TeethOneByOne, GiveTheMotionsOfTheWholeProgram) {
  int followed = 0;
  for (const char* dialect : {"linuxcnc", "fanuc", "siemens"})
    for (const bool eccentric : {false, true}) {
      const Written w = written(dialect, 0.2, eccentric);
      const auto whole = read(w, w.text, false), first = read(w, w.text, true);
      EXPECT_EQ(first.first_teeth, !whole.copies.copies) << dialect;
      if (!first.first_teeth) continue;
      ++followed;
      EXPECT_EQ(whole.blend_mm, first.blend_mm);
      EXPECT_EQ(whole.between.size(), first.between.size());
      std::vector<path::ToolMotion> all, one_by_one;
      for (const auto& trace : whole.operations) append(w, trace, all);
      std::size_t teeth = 0, firsts = 0;
      const Status walked = readback::walk_teeth(w.text, "p.nc", w.control, first, [&](auto&& trace) {
        ++teeth;
        firsts += trace.before == 0 ? 1 : 0;
        EXPECT_EQ(trace.tool, whole.operations[std::size_t(trace.operation)].tool);
        append(w, trace, one_by_one);
      });
      ASSERT_TRUE(walked);
      EXPECT_EQ(teeth, 2u * kTeeth) << dialect;
      EXPECT_EQ(firsts, 2u);
      ASSERT_EQ(all.size(), one_by_one.size()) << dialect;
      for (std::size_t k = 0; k < all.size(); ++k) ASSERT_TRUE(same(all[k], one_by_one[k])) << dialect << " " << k;
      auto kept = whole;
      keep_first_teeth(kept);
      for (std::size_t n = 0; n < kept.operations.size(); ++n) {
        ASSERT_EQ(kept.operations[n].moves.size(), first.operations[n].moves.size());
        EXPECT_EQ(kept.operations[n].tool, first.operations[n].tool);
        EXPECT_EQ(kept.operations[n].kept_teeth, first.operations[n].kept_teeth);
      }
    }
  EXPECT_EQ(followed, 3) << "off the axis";
}

TEST(TeethOneByOne, AreHeldAsAWholeWhereTheyDoNotStandSo) {
  const Written w = written("linuxcnc", 0.2, true);
  ASSERT_TRUE(read(w, w.text, true).first_teeth);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = w.text;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return read(w, text.replace(at, from.size(), to), true).first_teeth;
  };
  EXPECT_FALSE(with("(TOOTH 0)", "")) << "cuts without a name";
  EXPECT_FALSE(with("(TOOTH 4)", "(TOOTH 2)")) << "a tooth in two places";
  EXPECT_FALSE(with("(OP 1", "(OP 0")) << "an operation in two places";
  EXPECT_TRUE(with("(TOOTH 4)", "(TOOTH 4)\n(BY HAND)"));
}

// What is kept is one tooth an operation: a program of many fits where its moves do not.
TEST(TeethOneByOne, TakeTheRoomOfTheFirstOnes) {
  const Written w = written("linuxcnc", 0.2, true);
  const std::size_t all = read(w, w.text, false).executed, room = all / 2;
  EXPECT_FALSE(readback::read_back(w.text, "p.nc", w.control, w.machine, w.setup,
                                   {.teeth = kTeeth, .keep_all = false, .first_teeth = false, .max_kept = room}));
  const auto first = read(w, w.text, true, room);
  std::size_t kept = 0;
  for (const auto& trace : first.operations) kept += trace.moves.size();
  EXPECT_LT(kept, all / (kTeeth - 2));
}

// A fault in the text of the last tooth is in its motions.
TEST(TeethOneByOne, TheLastOneIsReadToo) {
  const Written w = written("linuxcnc", 0.2, true);
  const auto tips = [&](const std::string& text) {
    std::vector<path::ToolMotion> motions;
    const auto back = read(w, text, true);
    EXPECT_TRUE(readback::walk_teeth(text, "p.nc", w.control, back, [&](auto&& t) { append(w, t, motions); }));
    return motions;
  };
  std::string text = w.text;
  const std::size_t tooth = text.rfind("(TOOTH 5)"), z = text.find(" Z", text.find("G93", tooth)) + 2,
                    dot = text.find('.', z) + 1;
  text[dot] = text[dot] == '9' ? '8' : char(text[dot] + 1);
  const auto clean = tips(w.text), faulty = tips(text);
  ASSERT_EQ(clean.size(), faulty.size());
  double most = 0;
  for (std::size_t k = 0; k < clean.size(); ++k)
    if (const double off = (clean[k].tip_to - faulty[k].tip_to).norm(); off > most) {
      most = off;
      EXPECT_EQ(clean[k].tooth, 5);
      EXPECT_EQ(clean[k].operation, 1);
    }
  EXPECT_NEAR(most, 0.1, 1e-9);
}

}  // namespace
}  // namespace toothpath
