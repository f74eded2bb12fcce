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

double pitches_turned(int first_place, int end_place, int stride, int teeth) {
  double sum = 0;
  for (int n = first_place + 1; n < end_place; ++n)
    sum += std::abs(tooth_of_place(n, stride, teeth) - tooth_of_place(n - 1, stride, teeth));
  return sum;
}

AxisOperation operation_between(const AxisOperation& op, int first, int end, const AxisProgram& program) {
  AxisOperation out = op;
  out.first_place = first;
  out.tooth_minutes.clear();
  const int had = op.places(program.teeth), kept = end - first;
  if (kept == had) return out;
  out.end_place = end == program.teeth && op.end_place < 0 ? -1 : end;
  const double share = static_cast<double>(kept) / had;
  if (program.loop) {
    // Rapids: those of the blocks, and the turns of the index.
    double blocks = 0;
    for (const auto& t : op.teeth)
      for (const AxisBlock& b : t.blocks) blocks += b.kind == BlockKind::feed ? 0 : b.minutes;
    const auto turns = [&](int from, int to) { return pitches_turned(from, to, program.tooth_stride, program.teeth); };
    const double index = std::max(0.0, op.rapid_minutes - blocks * had);
    const double all = turns(op.first_place, op.end_of(program.teeth));
    out.feed_minutes *= share;
    out.rapid_minutes = blocks * kept + (all > 0 ? index * turns(first, end) / all : 0);
  } else {
    const auto at = op.teeth.begin() - op.first_place;
    out.teeth.assign(at + first, at + end);
    out.teeth.front().unpack();
    out.feed_minutes = out.rapid_minutes = 0;
    std::vector<AxisBlock> room;
    for (const ToothBlocks& tooth : out.teeth)
      for (const AxisBlock& b : tooth.all(room))
        (b.kind == BlockKind::feed ? out.feed_minutes : out.rapid_minutes) += b.minutes;
  }
  out.accelerated = {op.accelerated.feed * share, op.accelerated.rapid * share};
  return out;
}

void sum_times(AxisProgram& program) {
  program.minutes = program.feed_minutes = 0;
  program.accelerated = {};
  for (const auto& o : program.operations) {
    program.accelerated.feed += o.accelerated.feed;
    program.accelerated.rapid += o.accelerated.rapid;
    program.feed_minutes += o.feed_minutes;
    program.minutes += o.feed_minutes + o.rapid_minutes;
  }
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
  const int place = place_of_tooth(tooth, program.tooth_stride, program.teeth);
  const auto piece = std::find_if(found, list.end(), [&](const AxisOperation& o) {
    return o.operation == operation && place >= o.first_place && place < o.end_of(program.teeth);
  });
  list.erase(list.begin(), piece);
  list.front() = operation_between(list.front(), place, list.front().end_of(program.teeth), program);
  sum_times(program);
  program.restart = ProgramRestart{operation, tooth};
  return program;
}

std::vector<ProgramPart> parts_of(const AxisProgram& program, int most_teeth) {
  std::vector<ProgramPart> parts;
  for (const AxisOperation& op : program.operations) {
    if (!parts.empty() && parts.back().operation == op.operation) continue;
    for (int first = 0; first < program.teeth; first += most_teeth)
      parts.push_back(
          {static_cast<int>(parts.size()) + 1, 0, op.operation, first, std::min(program.teeth, first + most_teeth)});
  }
  for (ProgramPart& part : parts) part.count = static_cast<int>(parts.size());
  return parts;
}

PartMaker::PartMaker(AxisProgram& program)
    : program_(program), operations_(std::move(program.operations)), followed_(std::move(program.followed)) {}

PartMaker::~PartMaker() {
  program_.operations = std::move(operations_);
  program_.followed = std::move(followed_);
}

AxisProgram PartMaker::make(const ProgramPart& part) const {
  AxisProgram out = program_;
  out.part = part;
  for (const AxisOperation& op : operations_) {
    const int first = std::max(part.first_place, op.first_place);
    const int end = std::min(part.end_place, op.end_of(out.teeth));
    if (op.operation == part.operation && first < end) out.operations.push_back(operation_between(op, first, end, out));
  }
  sum_times(out);
  return out;
}

}  // namespace toothpath::joints
