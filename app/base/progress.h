// What a long run is at, on stderr: on a terminal one line that is rewritten, with the share that is done and the time
// that is left; elsewhere one line of every stage that lasts longer than two seconds.
#pragma once

#include <memory>
#include <string>

namespace toothpath::app {

class Progress {
 public:
  /// @param quiet  nothing is shown
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// What the stage is at; until it ends.
  void show(const std::string& text);
  /// Takes the line away; the next stage shows another.
  void clear();
  /// From now on it stands before every text: which of several runs this is. Empty: nothing does.
  void label(std::string text);

  /// A stage, as long as it lives; one inside another is shown instead of it. The work in it says how far it has come
  /// (geometry/base/work_share.h).
  class Stage {
   public:
    Stage(Progress& progress, const std::string& name);
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

   private:
    Progress& progress_;
  };

 private:
  struct Shown;
  std::unique_ptr<Shown> shown_;  ///< none: quiet
};

/// "43 %, about 12 s left", "43 %" or "" while too little is known.
/// @param done  0 to 1
[[nodiscard]] std::string share_and_rest(double done, double seconds);

}  // namespace toothpath::app
