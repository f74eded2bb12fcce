#include "postproc/text/planes.h"

#include <algorithm>

#include "postproc/joints/rollover.h"
#include "postproc/numbers/fixed_point.h"

namespace toothpath::text {

std::string NcPlaneWords::angle(std::int64_t word) const { return out_.value(word, program_.format.rotary_decimals); }

bool NcPlaneWords::any(const std::vector<joints::AxisBlock>& list) const {
  return program_.planes &&
         std::any_of(list.begin(), list.end(), [this](const joints::AxisBlock& b) { return tilted(b); });
}

/// Of the plane about Z, deg, in (-360, 360): the word of the first rotary, in a loop with the angle of its tooth,
/// which is 0 to 360 or 0 to -360. Controls without arithmetic in a word get a line ahead.
std::string NcPlaneWords::turn(const joints::AxisBlock& b, IndexWord index, NcLines::Values& values) {
  const joints::PlaneForm& form = *program_.planes;
  std::int64_t word = joints::within_turn(b.words[3] - form.zero[0], words_.turn_word());
  if (index != IndexWord::shifted) return angle(form.turn_sign * word);
  if (program_.index_sign > 0 && word > 0) word -= words_.turn_word();
  const NcLoop& loop = dialect_.loop;
  const std::string sign = form.turn_sign < 0 ? "-" : dialect_.sign_always ? "+" : "";
  if (!dialect_.planes.index_line.empty()) {
    values["angle"] = angle(word);
    out_.fill({dialect_.planes.index_line}, values);
    return sign + dialect_.planes.index;
  }
  const std::int64_t added = form.turn_sign * word;
  return sign + loop.index + (added >= 0 && !dialect_.sign_always ? "+" : "") + angle(added);
}

void NcPlaneWords::on(const joints::AxisBlock& b, IndexWord index, NcLines::Values& values) {
  const joints::PlaneForm& form = *program_.planes;
  const int digits = program_.format.linear_decimals;
  for (int i = 0; i < 3; ++i)
    values[std::string("plane_") + "xyz"[i]] = out_.value(numbers::to_fixed(form.origin_mm[i], digits), digits);
  const std::int64_t tilt = form.tilt_sign * (b.words[4] - form.zero[1]), quarter = words_.turn_word() / 4;
  values["turn"] = turn(b, index, values);
  values["tilt"] = angle(tilt);
  values["tilt_x"] = angle(form.about_y ? 0 : tilt);
  values["tilt_y"] = angle(form.about_y ? tilt : 0);
  const std::int64_t word = form.turn_sign * joints::within_turn(b.words[3] - form.zero[0], words_.turn_word());
  const std::int64_t node = joints::within_turn(word + (form.about_y ? quarter : 0), words_.turn_word());
  values["euler_turn"] = angle(node);
  values["euler_spin"] = angle(form.about_y ? -quarter : 0);
  values["pair"] = b.words[4] > form.zero[1] ? dialect_.planes.upper : dialect_.planes.lower;
  out_.fill(dialect_.planes.off, values);
  if (!form.origin_mm.isZero(0)) out_.fill(dialect_.planes.shift, values);
  out_.fill(dialect_.planes.on, values);
}

}  // namespace toothpath::text
