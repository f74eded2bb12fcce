// The moves of every tooth on the page: what is told of a tooth is where the program was, whether it repeats or not.
#include "app/report/page/machine_states.h"

#include <gtest/gtest.h>

#include <set>

#include "geometry/base/angle.h"

namespace toothpath::page {
namespace {

constexpr int kTeeth = 12, kMoves = 300;

/// Two operations; tooth 5 of the second one goes deeper. Labels may be missing, as in a loop.
std::vector<readback::ExecutedMove> program(bool labels) {
  std::vector<readback::ExecutedMove> out;
  int line = 0;
  for (int operation = -1; operation < 2; ++operation)
    for (int tooth = 0; tooth < (operation < 0 ? 1 : kTeeth); ++tooth)
      for (int k = 0; k < (operation < 0 ? 5 : kMoves); ++k) {
        readback::ExecutedMove m;
        const bool deeper = operation == 1 && tooth == 5 && labels;
        m.joints = {50 + 10 * std::sin(0.1 * k), 3.0 * operation, 100 - 0.01 * k - (deeper ? 1 : 0),
                    30.0 * tooth + 0.02 * k, -20 + 0.01 * k};
        m.line = labels || tooth == 0 ? ++line : line - kMoves + 1 + k;
        m.operation = std::int16_t(operation);
        m.tooth = std::int16_t(labels && operation >= 0 ? tooth : -1);
        m.tool = 7;
        m.known = operation >= 0 || k > 0;
        out.push_back(m);
      }
  return out;
}

SceneStates recorded(const std::vector<readback::ExecutedMove>& moves, const readback::ReadBack& read) {
  StateRecorder recorder({3, 7}, 2, 2 * kTeeth);
  for (const auto& m : moves) recorder.add(m);
  return recorder.finish(read);
}

/// Every state of a stretch is one of the moves of this tooth, in their order.
void expect_true(const std::vector<readback::ExecutedMove>& moves, const SceneStates& told, bool labels) {
  std::size_t at = 0;
  for (const SceneStretch& s : told.stretches)
    for (std::size_t k = s.first; k < s.first + s.count; ++k) {
      const SceneState& state = told.states.at(k);
      const auto is = [&](const readback::ExecutedMove& m) {
        for (std::size_t a = 0; a < 5; ++a) {
          const double wanted = a < 3 ? m.joints[a] : radians(m.joints[a]),
                       have = state.joints[a] + (a < 3 ? 0 : s.turn_rad[a - 3]);
          if (std::abs(wanted - have) > 1e-9) return false;
        }
        return m.line == state.line + s.lines && m.operation == s.operation && (!labels || m.tooth == s.tooth);
      };
      while (at < moves.size() && !is(moves[at])) ++at;
      ASSERT_LT(at, moves.size()) << "operation " << s.operation << ", tooth " << s.tooth;
      EXPECT_EQ(state.tool, 1);
    }
}

TEST(MachineStates, TellEveryToothOfAProgram) {
  const auto moves = program(true);
  const SceneStates told = recorded(moves, {});
  expect_true(moves, told, true);
  EXPECT_EQ(told.stretches.size(), 1u + 2 * kTeeth);
  std::set<std::size_t> firsts;
  for (const SceneStretch& s : told.stretches) {
    firsts.insert(s.first);
    EXPECT_GE(s.count, 4u);
  }
  EXPECT_EQ(firsts.size(), 4u) << "the opening, a tooth of each operation, and the deeper one";
  EXPECT_LT(told.states.size(), 900u);
}

TEST(MachineStates, TellTheTeethOfALoop) {
  const auto moves = program(false);
  readback::ReadBack read;
  read.copies.copies = true;
  for (int operation = 0; operation < 2; ++operation) {
    readback::TurnedCopies::Operation copies{operation, kMoves, {}, {{0, 0, 0}}};
    for (int tooth = 0; tooth < kTeeth; ++tooth) copies.turns.push_back(tooth);
    read.copies.operations.push_back(copies);
    readback::OperationTrace trace;
    trace.operation = operation;
    read.operations.push_back(trace);
  }
  const SceneStates told = recorded(moves, read);
  expect_true(moves, told, false);
  ASSERT_EQ(told.stretches.size(), 1u + 2 * kTeeth);
  for (int k = 0; k < kTeeth; ++k) EXPECT_EQ(told.stretches[std::size_t(1 + k)].tooth, k);
}

}  // namespace
}  // namespace toothpath::page
