// A Siemens control that runs a probing program against a part: it walks the text line by line, with MEAS=1 the ball
// stops where it meets something, CYCLE978 does what the manual of the measuring cycles says, and WRITE makes the file.
// Shares no code with the writer.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "geometry/base/vec.h"

namespace toothpath::test {

struct SiemensProbe {
  /// Gap of the ball from the part while touch `number` is on, centre in the work offset, mm; <= 0: it touches.
  std::function<double(int number, const Vec3& centre)> gap;
  double radius_mm = 1;     ///< of the ball, as calibrated with the delay below
  double pretravel_mm = 0;  ///< way from the touch to the signal
};

/// A touch as the control made it.
struct SiemensTouch {
  int number = 0;
  bool cycle = false;            ///< CYCLE978, not MEAS
  Vec3 from = Vec3::Zero();      ///< of the measuring way, work offset
  Vec3 farthest = Vec3::Zero();  ///< where it would have ended
  Vec3 met = Vec3::Zero();       ///< true centre of the ball at the touch
};

struct SiemensProbing {
  std::string log;    ///< PROBE_RESULTS
  std::string alarm;  ///< why it stopped ahead of M30; empty: it ran through
  std::vector<SiemensTouch> touches;
};

/// Fails the running test where a line is not understood or breaks a rule of the manual.
[[nodiscard]] SiemensProbing run_siemens_probing(const std::string& text, const SiemensProbe& probe);

}  // namespace toothpath::test
