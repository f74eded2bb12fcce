#include "postproc/text/stretches.h"

namespace toothpath::text {

Result<std::vector<NcStretch>> stretches_of(const std::vector<joints::AxisBlock>& tooth, int index_axis,
                                            std::string_view dialect) {
  const auto axis = static_cast<std::size_t>(index_axis);
  std::vector<NcStretch> out;
  for (std::size_t i = 0; i < tooth.size(); ++i) {
    if (tooth[i].kind == joints::BlockKind::rapid_rotary) out.push_back({i, i});
    if (out.empty() || tooth[i].words[axis] != tooth[out.back().first].words[axis])
      return fail("the index rotary moves inside a tooth: {} cannot loop over it, write the teeth out", dialect);
    out.back().last = i + 1;
  }
  return out;
}

}  // namespace toothpath::text
