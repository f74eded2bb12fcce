// Blocks that are packed are the same blocks, and programs made of them the same text.
#include <gtest/gtest.h>

#include <random>

#include "postproc/joints/time.h"
#include "postproc/joints/tooth_order.h"
#include "tests/postproc/readback/nc_case.h"

namespace toothpath {
namespace {

using namespace test;
using joints::AxisBlock;

bool same(const AxisBlock& a, const AxisBlock& b) {
  return a.words == b.words && a.minutes == b.minutes && a.per_minute == b.per_minute && a.axis == b.axis &&
         a.record == b.record && a.kind == b.kind && a.ruler == b.ruler && a.forced == b.forced && a.tip == b.tip;
}

TEST(PackedBlocks, AreTheSame) {
  std::mt19937_64 random(7);
  const auto below = [&](std::uint64_t n) { return random() % n; };
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<AxisBlock> blocks(below(200) + 1);
    AxisBlock before;
    for (AxisBlock& b : blocks) {
      b = before;
      for (auto& word : b.words) switch (below(4)) {
          case 0: word += std::int64_t(below(200)) - 100; break;
          case 1: word = std::int64_t(random()) >> below(64); break;
          default: break;
        }
      if (below(2) == 0) b.minutes = double(random()) * 1e-22;
      if (below(3) == 0) b.minutes = 0;
      b.per_minute = below(2) == 0 ? 0 : double(random()) * 1e-16;
      if (below(2) == 0) b.axis = Vec3(double(random()), double(random()), -double(random())).normalized();
      else b.axis = Vec3::UnitZ();
      if (below(3) == 0) b.record = below(2) == 0 ? -1 : std::int32_t(below(1U << 31));
      b.kind = joints::BlockKind(below(8));
      b.ruler = std::uint8_t(below(8));
      b.forced = below(2) == 0;
      b.tip = below(2) == 0;
      before = b;
    }
    joints::ToothBlocks tooth{3, blocks};
    tooth.pack();
    EXPECT_EQ(tooth.blocks.capacity(), 0u) << "their room is given back";
    std::vector<AxisBlock> room;
    for (int time = 0; time < 2; ++time) {
      const auto& all = tooth.all(room);
      ASSERT_EQ(all.size(), blocks.size());
      for (std::size_t k = 0; k < blocks.size(); ++k) ASSERT_TRUE(same(all[k], blocks[k])) << trial << " " << k;
    }
    tooth.unpack();
    EXPECT_EQ(tooth.blocks.size(), blocks.size());
  }
}

TEST(PackedBlocks, MakeTheSameProgram) {
  for (const char* dialect : {"linuxcnc", "fanuc", "siemens"})
    for (const int from : {0, 4}) {
      const machines::Machine m = with_dialect(trunnion(), dialect);
      joints::Setup setup = standing();
      setup.origin_mm += Vec3(2, 1, 0);
      const std::vector<path::ClPath> paths = {sample_path(0.2, 0.1), sample_path(0.2, 0.1, 25, 1)};
      std::string texts[2];
      for (const bool packed : {false, true}) {
        joints::AxisOptions options = controls::axis_options(*controls::dialect_of(m), m);
        options.expand_teeth = true;
        options.pack_teeth = packed;
        auto program = joints::AxisProgramTestAccess::build(paths, tools(), setup, m, 6, kBody, options);
        ASSERT_TRUE(program) << program.error().message;
        EXPECT_EQ(program->operations[0].teeth[3].blocks.empty(), packed);
        if (from > 0) {
          program = joints::program_from(*program, 1, from);
          ASSERT_TRUE(program);
          joints::estimate_times(*program, m);
          EXPECT_FALSE(program->operations[0].teeth.front().blocks.empty());
        }
        const auto text = text::write_nc(*program, *controls::dialect_of(m), {});
        ASSERT_TRUE(text) << text.error().message;
        texts[packed] = text->text + fmt::format("{} {} {}", program->minutes, program->accelerated.feed,
                                                 program->accelerated.rapid);
      }
      EXPECT_EQ(texts[0], texts[1]) << dialect << " from " << from;
    }
}

}  // namespace
}  // namespace toothpath
