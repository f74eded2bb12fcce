// Programs of every post walked through by a simulator of the modes, which shares nothing with the writer.
#pragma once

#include "tests/postproc/dangers/danger_case.h"

namespace toothpath::test {

class DangerModes : public EveryPost {
 protected:
  [[nodiscard]] bool apt() const { return std::string(post().dialect) == "apt"; }
  [[nodiscard]] bool heidenhain() const { return std::string(post().dialect) == "heidenhain"; }
  /// Calls `look` with every job's run.
  template <typename Look>
  void every_job(Look look) const {
    for (const auto& [name, paths] : jobs_for(post())) {
      SCOPED_TRACE(name);
      const ModalRun run = simulate_modes(text_of(post(), paths), post().dialect);
      ASSERT_TRUE(run.unknown.empty()) << "not in the data of the control: " << run.unknown.front();
      ASSERT_TRUE(run.ended);
      look(run, paths);
    }
  }
};

}  // namespace toothpath::test
