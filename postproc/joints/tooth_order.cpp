#include "postproc/joints/tooth_order.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace toothpath::joints {
namespace {

constexpr double kGoldenShare = 0.38196601125010515;  // 1 / phi^2

/// Of the continued fraction of a / b, a >= b >= 1; the last quotient counts one less (.., q = .., q - 1, 1).
int largest_quotient(int a, int b) {
  int largest = 0;
  while (b != 0) {
    const int q = a / b, rest = a % b;
    largest = std::max(largest, rest == 0 && q > 1 ? q - 1 : q);
    a = b;
    b = rest;
  }
  return largest;
}

}  // namespace

int spread_stride(int teeth) {
  int best = 1, best_quotient = largest_quotient(teeth, 1);
  for (int s = 2; 2 * s <= teeth; ++s) {
    if (std::gcd(s, teeth) != 1) continue;
    const int quotient = largest_quotient(teeth, s);
    const bool nearer = std::abs(s - kGoldenShare * teeth) < std::abs(best - kGoldenShare * teeth);
    if (quotient > best_quotient || (quotient == best_quotient && !nearer)) continue;
    best = s;
    best_quotient = quotient;
  }
  return best;
}

int tooth_of_place(int place, int stride, int teeth) { return static_cast<int>(std::int64_t{place} * stride % teeth); }

int place_of_tooth(int tooth, int stride, int teeth) {
  for (int n = 0; n < teeth; ++n)
    if (tooth_of_place(n, stride, teeth) == tooth) return n;
  return -1;
}

double pitches_turned(int first_place, int stride, int teeth) {
  double sum = 0;
  for (int n = first_place + 1; n < teeth; ++n)
    sum += std::abs(tooth_of_place(n, stride, teeth) - tooth_of_place(n - 1, stride, teeth));
  return sum;
}

Result<AxisProgram> program_from(AxisProgram program, int operation, int tooth) {
  auto& list = program.operations;
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const AxisOperation& o) { return o.operation == operation; });
  if (found == list.end())
    return fail_as(DiagnosticKind::usage, "operation {} does not exist: the program has the operations 0 to {}",
                   operation, list.empty() ? 0 : list.back().operation);
  if (tooth < 0 || tooth >= program.teeth)
    return fail_as(DiagnosticKind::usage, "tooth {} does not exist: the gear has the teeth 0 to {}", tooth,
                   program.teeth - 1);
  list.erase(list.begin(), found);
  AxisOperation& op = list.front();
  op.first_place = place_of_tooth(tooth, program.tooth_stride, program.teeth);
  const double share = static_cast<double>(program.teeth - op.first_place) / program.teeth;
  if (program.loop) {
    // Rapids: those of the blocks, and the turns of the index.
    double blocks = 0;
    for (const auto& t : op.teeth)
      for (const AxisBlock& b : t.blocks) blocks += b.kind == BlockKind::feed ? 0 : b.minutes;
    const double index = std::max(0.0, op.rapid_minutes - blocks * program.teeth);
    const double turns = pitches_turned(0, program.tooth_stride, program.teeth);
    op.feed_minutes *= share;
    op.rapid_minutes =
        blocks * (program.teeth - op.first_place) +
        (turns > 0 ? index * pitches_turned(op.first_place, program.tooth_stride, program.teeth) / turns : 0);
  } else {
    const auto gone = op.teeth.begin() + op.first_place;
    std::vector<AxisBlock> room;
    for (auto t = op.teeth.begin(); t != gone; ++t)
      for (const AxisBlock& b : t->all(room))
        (b.kind == BlockKind::feed ? op.feed_minutes : op.rapid_minutes) -= b.minutes;
    op.teeth.erase(op.teeth.begin(), gone);
    op.teeth.front().unpack();
  }
  op.accelerated = {op.accelerated.feed * share, op.accelerated.rapid * share};
  program.minutes = program.feed_minutes = 0;
  program.accelerated = {};
  for (const auto& o : list) {
    program.accelerated.feed += o.accelerated.feed;
    program.accelerated.rapid += o.accelerated.rapid;
    program.feed_minutes += o.feed_minutes;
    program.minutes += o.feed_minutes + o.rapid_minutes;
  }
  program.restart = ProgramRestart{operation, tooth};
  return program;
}

}  // namespace toothpath::joints
