// In which order the teeth of an operation are cut, and how a program begins in the middle of it.
//
// The order has places 0 .. z - 1; place n cuts tooth n * stride mod z. stride 1 is the sequence. A stride that has no
// divisor in common with z meets every tooth once. The spread order takes one whose quotients in the continued fraction
// of z / stride are small, as those of the golden ratio are: after any number of teeth those that are cut divide the
// circle nearly evenly (three-distance theorem), so that heat does not gather at one place. For z up to 130 the largest
// gap is never more than 2.5 times the mean one, where the sequence has up to z / 4. Everything is counted in integers;
// an angle is made from the tooth, never from the angle before it.
#pragma once

#include "postproc/joints/program.h"

namespace toothpath::joints {

/// Stride of the spread order: among the numbers up to teeth / 2 without a divisor in common with `teeth` the one with
/// the smallest largest quotient in the continued fraction of teeth / stride (the last quotient counts one less); of
/// several the one nearest to teeth / phi^2 (phi the golden ratio), then the smallest. 1 for fewer than 5 teeth and for
/// 6, where there is no other.
/// @param teeth z >= 1
[[nodiscard]] int spread_stride(int teeth);

/// Tooth at a place of the order. 0 <= place < teeth, stride without a divisor in common with teeth.
[[nodiscard]] int tooth_of_place(int place, int stride, int teeth);
/// Place of a tooth in the order, 0 <= tooth < teeth.
[[nodiscard]] int place_of_tooth(int tooth, int stride, int teeth);

/// Turns of the index rotary from place to place, in pitches, from `first_place` to the one ahead of `end_place`.
[[nodiscard]] double pitches_turned(int first_place, int end_place, int stride, int teeth);

/// The places [first, end) of an operation, a part of those that it has, with their times.
[[nodiscard]] AxisOperation operation_between(const AxisOperation& operation, int first, int end,
                                              const AxisProgram& program);

/// The times of a program become those of its operations.
void sum_times(AxisProgram& program);

/// The same program from one tooth of one operation on: operations and teeth ahead of it are left out, times are those
/// of what is left. Ranges and bounds stay those of the whole program, which they hold for. Errors (kind usage): no
/// such operation or tooth, with what there is.
[[nodiscard]] Result<AxisProgram> program_from(AxisProgram program, int operation, int tooth);

/// The programs that the operations of `program` make one by one, and of more than `most_teeth` several: their places
/// in the order of the whole. @param most_teeth  above 0
[[nodiscard]] std::vector<ProgramPart> parts_of(const AxisProgram& program, int most_teeth);
/// Takes the parts of a program out one by one; what does not differ between them is held once.
class PartMaker {
 public:
  /// @param program  must outlive this, and is as it was when this is gone
  explicit PartMaker(AxisProgram& program);
  ~PartMaker();
  PartMaker(const PartMaker&) = delete;
  PartMaker& operator=(const PartMaker&) = delete;
  /// The same program with the teeth of one part alone; ranges and bounds stay those of the whole.
  [[nodiscard]] AxisProgram make(const ProgramPart& part) const;

 private:
  AxisProgram& program_;
  std::vector<AxisOperation> operations_;
  std::vector<path::ClPath> followed_;
};

}  // namespace toothpath::joints
