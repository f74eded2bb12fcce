// Walks through an NC program as a control would and keeps its modes: units, plane, feed mode, length compensation,
// TCP, spindle, coolant, smoothing .. It knows nothing of kinematics, shares no code with writer or readers, and is
// data for each control: which words set which mode. Loops are walked through twice, so that what a loop leaves behind
// meets its own start.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace toothpath::test {

using ModalState = std::map<std::string, std::string>;

/// One executed line with its modes before and after it.
struct ModalBlock {
  int line = 0;                              ///< of the text, from 1
  std::string code;                          ///< without block number and comment
  std::string comment;                       ///< text of the comments of the line
  std::map<std::string, std::string> words;  ///< axis words, vector words, F, S: as they stand
  ModalState before, after;
  bool moves = false;    ///< it has axis words
  bool rapid = false;    ///< the tool moves at rapid
  bool machine = false;  ///< its words are machine coordinates
  bool vector = false;   ///< it carries a tool vector
  bool tool_change = false;
  bool end = false;  ///< the program ends

  [[nodiscard]] bool has(const std::string& word) const { return words.count(word) != 0; }
  [[nodiscard]] bool linear() const { return has("X") || has("Y") || has("Z"); }
  [[nodiscard]] bool rotary() const { return has("A") || has("B") || has("C"); }
  [[nodiscard]] const std::string& mode(const std::string& group) const;
};

struct ModalRun {
  std::vector<ModalBlock> blocks;
  std::vector<std::string> unknown;  ///< lines that the data of the control do not name
  bool ended = false;
};

/// `dialect`: as in a machine file. Groups that nothing has set yet have no entry.
[[nodiscard]] ModalRun simulate_modes(const std::string& text, const std::string& dialect);

/// The modes that a program must have set before its first motion, and those that it must leave behind.
[[nodiscard]] const ModalState& safe_modes(const std::string& dialect);
[[nodiscard]] const ModalState& end_modes(const std::string& dialect);

}  // namespace toothpath::test
