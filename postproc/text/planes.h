// Tilted planes in the text: the values of their templates, from the words of a block that turns the rotaries to one.
#pragma once

#include "postproc/text/axis_words.h"
#include "postproc/text/dialect.h"
#include "postproc/text/lines.h"

namespace toothpath::text {

class NcPlaneWords {
 public:
  NcPlaneWords(const joints::AxisProgram& program, const NcDialect& dialect, const NcAxisWords& words, NcLines& out)
      : program_(program), dialect_(dialect), words_(words), out_(out) {}

  /// Some block of the list stands in a tilted plane.
  [[nodiscard]] bool any(const std::vector<joints::AxisBlock>& list) const;
  [[nodiscard]] bool tilted(const joints::AxisBlock& b) const { return program_.planes->tilted(b.words); }
  /// Lines up to and with the turn of the rotaries to the plane of this block. In a loop its turn has that of the
  /// index.
  void on(const joints::AxisBlock& b, IndexWord index, NcLines::Values& values);

 private:
  [[nodiscard]] std::string angle(std::int64_t word) const;
  [[nodiscard]] std::string turn(const joints::AxisBlock& b, IndexWord index, NcLines::Values& values);

  const joints::AxisProgram& program_;
  const NcDialect& dialect_;
  const NcAxisWords& words_;
  NcLines& out_;
};

}  // namespace toothpath::text
