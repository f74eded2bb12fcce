// The joints of a machine over a program, for the 3D view: some states of every tooth. A tooth that repeats another one
// of its operation but for turns of the rotaries, the index angle, is told by those turns.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "postproc/readback/reader.h"

namespace toothpath::page {

/// The joints at the end of one move.
struct SceneState {
  std::array<double, 5> joints{};  ///< X Y Z mm, rotaries rad
  int operation = -1, line = 0;
  int tool = -1;  ///< index in the job
};

/// One tooth of an operation, or what is between: states, turned. Between two stretches the machine goes straight from
/// the last state to the first one, as the program does.
struct SceneStretch {
  std::size_t first = 0, count = 0;  ///< of SceneStates::states
  int operation = -1, tooth = -1;    ///< -1: none
  std::array<double, 2> turn_rad{};  ///< on top of the states' rotaries
  int lines = 0;                     ///< on top of the states' lines
};

struct SceneStates {
  std::vector<SceneState> states;
  std::vector<SceneStretch> stretches;  ///< in the order of the program
};

/// Sees every move that is read back, in order.
class StateRecorder {
 public:
  /// @param tool_numbers T of the job's tools, in its order
  /// @param tooth_spaces that all operations together cut: how many states there is room for of teeth that repeat none
  StateRecorder(std::vector<int> tool_numbers, std::size_t operations, std::size_t tooth_spaces);

  void add(const readback::ExecutedMove& move);
  /// @param read of the same moves: where teeth are not labelled, for they stand in a loop, it says how long they are
  [[nodiscard]] SceneStates finish(const readback::ReadBack& read);

 private:
  struct Kept {
    std::vector<SceneState> whole;
    std::size_t first = 0, count = 0;
  };
  using Moves = std::vector<SceneState>;

  /// Operations without labels wait for finish(): moves, and where their stretch stands among the others.
  struct Loop {
    Moves moves;
    std::size_t at = 0;
    int operation = -1;
    int piece = -1;
    std::size_t ahead = 0;  ///< states of the piece ahead of these
  };

  void end_stretch();
  void add_stretch(const Moves& moves, int operation, int tooth);
  [[nodiscard]] bool add_repeated(const Moves& moves, int operation, int tooth);
  void add_loop(const readback::ReadBack& read, const Loop& loop, std::size_t piece);

  std::vector<int> tool_numbers_;
  std::size_t each_, others_;  ///< states of a tooth, of one that repeats none
  SceneStates out_;
  std::map<int, std::vector<Kept>> kept_;  ///< teeth of an operation that others may repeat
  Moves open_;
  int operation_ = -1, piece_ = -1, tooth_ = -1, tool_ = 0;
  std::size_t in_piece_ = 0;  ///< states of the piece so far
  std::vector<Loop> loops_;
  std::size_t looped_ = 0;
};

}  // namespace toothpath::page
