// Executes NC text of every control that the program writes for: loops, sub-programs, sections, variables and sums, all
// teeth. An own reading of the controls' manuals: shares no code and no table with writer, readers or modal simulator.
// It takes the words that it knows and says so where it meets another.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace toothpath::test {

/// Words of one executed motion as they were said; what is left out stays where it was.
struct NcMove {
  int line = 0;  ///< of the text, from 1
  bool rapid = false;
  bool machine = false;                            ///< X Y Z are machine coordinates of the gauge line
  bool tip = false;                                ///< the control keeps the tip on the chord (TCP, CLDATA)
  double turned_deg = 0;                           ///< of the frame of X Y Z and the vector about Z of the work
  std::array<double, 3> zero_deg{};                ///< where the words of A B C count from
  bool granted = false;                            ///< .. where the machine's transformation takes that: X Y Z, too
  bool frozen = false;                             ///< X Y Z name places of the work as it stood when `tip` began
  int tool = 0;                                    ///< in the spindle, 0: none
  bool length = false;                             ///< the length of the tool counts
  double feed = 0;                                 ///< F in force, 0: none was said
  bool inverse = false;                            ///< F is of inverse time
  std::array<std::optional<double>, 3> linear;     ///< X Y Z
  std::array<std::optional<double>, 3> rotary;     ///< A B C
  std::optional<std::array<double, 3>> direction;  ///< tool vector, tip to holder
};

/// The tool is measured at a setter, and the program stops where it is broken.
struct NcToolCheck {
  int line = 0, tool = 0;
  std::size_t move = 0;  ///< so many motions stand ahead of it
};

struct NcWalk {
  std::vector<NcMove> moves;
  std::vector<NcToolCheck> checks;  ///< of tools; behind each, units, kind of motion and length must be said again
  std::vector<std::string>
      faults;          ///< "line: text" of what was not understood or may not be; such a walk judges nothing
  bool ended = false;  ///< by the word that ends a program
};

/// `control`: as in a machine file.
[[nodiscard]] NcWalk walk_nc(const std::string& text, const std::string& control);

}  // namespace toothpath::test
