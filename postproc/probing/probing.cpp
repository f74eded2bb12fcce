#include "postproc/probing/probing.h"

#include <cmath>

#include "postproc/numbers/comment.h"
#include "postproc/probing/probing_text.h"

namespace toothpath::probing {

std::string word(char letter, double value, bool sign) {
  const double rounded = std::round(value * 1e4) / 1e4 + 0.0;  // -0 becomes 0
  return sign ? fmt::format("{}{:+.4f}", letter, rounded) : fmt::format("{}{:.4f}", letter, rounded);
}

std::string words(const Vec3& place, int count, bool sign) {
  std::string out;
  for (int k = 0; k < count; ++k) out += (k ? " " : "") + word("XYZ"[k], place[k], sign);
  return out;
}

Coming coming_to(const ProbeProgram& program, std::size_t touch) {
  if (touch == 0) return Coming::first;
  return program.touches[touch].rotaries == program.touches[touch - 1].rotaries ? Coming::beside : Coming::turned;
}

std::vector<std::string> header(const ProbeProgram& program) {
  return {numbers::comment_text("PROBE JOB " + program.job_name),
          numbers::comment_text("MACHINE " + program.machine_name),
          fmt::format("T{} IS THE PROBE: BALL {:.4f} MM, LENGTH {:.4f} MM TO THE CENTRE OF THE BALL", program.tool,
                      program.ball_diameter_mm, program.probe_length_mm),
          "X Y Z ARE THE CENTRE OF THE BALL IN THE WORK OFFSET",
          fmt::format("{} TOUCHES OF THE PART: THE PROGRAM CUTS NOTHING", program.touches.size()),
          "NO MACHINE WAS AT HAND: RUN IT SLOWLY AND ABOVE THE PART FIRST"};
}

}  // namespace toothpath::probing
