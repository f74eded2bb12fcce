// A gear shaper as its file describes it: stroke, index and feed trains, change gears, axis ranges.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/diagnostic.h"
#include "machines/toml/key_notes.h"
#include "machines/toml/toml_tree.h"

namespace toothpath::machines {

/// A ratio of whole numbers, both > 0, as written (not reduced).
struct Ratio {
  std::int64_t numerator = 1;
  std::int64_t denominator = 1;
  [[nodiscard]] double value() const { return static_cast<double>(numerator) / static_cast<double>(denominator); }
};

/// Range of one shaper axis. X infeed, Y offset slide, Z stroke [mm, mm/min]; A cutter, C work [rad, rad/min].
struct ShaperAxis {
  double min = 0.0;
  double max = 0.0;
  double max_speed = 0.0;
  int sign = 1;  ///< A and C: +1 turns about the axes of the gear frame, -1 reverses the words
};

/// What couples the work to the cutter, as the machine files of a control say it: change gears ([index], [feed],
/// [gears]); or [gearbox], with the names of its axes or with the pulses of one turn.
enum class ShaperGears { change_gears, named_axes, pulses };

/// A control that a machine file may name. Which ones exist is the post's business.
struct ShaperDialect {
  std::string name;
  ShaperGears gears = ShaperGears::change_gears;
};

/// An electronic gearbox in place of change gears: the control couples the work to the cutter by a ratio of whole
/// numbers.
struct ElectronicGearbox {
  std::string cutter_axis = "A";      ///< words of the leading axis: a letter, or a machine axis name as C1
  std::string work_axis = "C";        ///< words of the following axis
  std::string relief_on, relief_off;  ///< M codes of the lift on the back stroke, as "M61"
  std::int64_t pulses_per_turn = 0;   ///< pulses of one turn of the cutter axis; 0: not given
};

struct ShaperMachine {
  std::string name;
  std::string file;     ///< path as it was opened
  std::string dialect;  ///< name of the control
  bool assumed = false;
  std::vector<std::string> assumed_keys;  ///< dotted names; of `assumed = true`, every value of the file

  std::vector<double> stroke_steps;  ///< double strokes per minute, ascending
  double max_stroke_mm = 0.0;
  double relief_mm = 0.0;                    ///< back-off of the cutter on the return stroke
  Ratio index_constant;                      ///< a/b * c/d = index_constant * N_s/N_2
  Ratio feed_constant;                       ///< feed gears = feed_constant * s_c/d_s
  std::vector<int> gears;                    ///< teeth of the change gears; each is there once
  int mesh_margin = 15;                      ///< a + b >= c + mesh_margin and c + d >= b + mesh_margin
  std::optional<ElectronicGearbox> gearbox;  ///< then [index], [feed] and [gears] are absent
  std::map<char, ShaperAxis> axes;           ///< X Y Z A C, all present
};

/// A shaper, or everything that is wrong with its file. `machine` is empty if and only if `errors` is not.
struct ShaperMachineReading {
  std::optional<ShaperMachine> machine;
  std::vector<Diagnostic> errors;
};

/// Reads the file at `path`, whose control is one of `dialects`. Errors: every refusal with its place, unreadable files
/// with kind file_access.
[[nodiscard]] ShaperMachineReading read_shaper_machine_file(const std::string& path,
                                                            const std::vector<ShaperDialect>& dialects);

/// The same from text; `file` is the name in the messages.
[[nodiscard]] ShaperMachineReading read_shaper_machine_text(std::string_view text, const std::string& file,
                                                            const std::vector<ShaperDialect>& dialects);

/// The keys that the reader asks of the file of a shaper. Returns what is wrong with it, in the order of asking.
/// @param document  a table
std::vector<Diagnostic> note_shaper_keys(const toml::TomlValue& document, const std::vector<ShaperDialect>& dialects,
                                         toml::KeyNotes& notes);

}  // namespace toothpath::machines
