// Reads a milling machine from its TOML file, and finds the file that a job names.
//
// Keys: docs/machine_reference.md lists them; the files in machines/data are commented examples. Lengths mm, angles
// deg, speeds mm/min, deg/min and 1/min. Every key that is not known is refused, so a typing error cannot pass as a
// default. Which controls there are, and which keys each of them takes, is not known here: a `MachineJudge` says it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "machines/machine.h"
#include "machines/toml/key_notes.h"
#include "machines/toml/toml_tree.h"

namespace toothpath::machines {

/// Of the keys pole_angle, deg.
inline constexpr double kLargestPoleAngle = 45.0;

/// A machine, or everything that is wrong with its file. `machine` is empty if and only if `errors` is not.
struct MachineReading {
  std::optional<Machine> machine;
  std::vector<Diagnostic> errors;  ///< in the order of the file, each `file:line:column: error: ...`
};

/// What others have against a machine: those who know its control. Each complaint has the place of its key
/// (Machine::where). Asked even where other keys are refused: what could not be read has its default.
using MachineJudge = std::function<std::vector<Diagnostic>(const Machine&)>;

/// Reads the file at `path`. Errors: see the header of this file; unreadable files have kind file_access.
[[nodiscard]] MachineReading read_machine_file(const std::string& path, const MachineJudge& judge = {});

/// The same from text; `file` is the name in the messages.
[[nodiscard]] MachineReading read_machine_text(std::string_view text, const std::string& file,
                                               const MachineJudge& judge = {});

/// The keys that the reader asks of a machine file. Returns what is wrong with it, in the order of asking.
/// @param document  a table
std::vector<Diagnostic> note_machine_keys(const toml::TomlValue& document, toml::KeyNotes& notes);

/// A machine file that has been opened: what it says can be read from `text`, whatever becomes of the file.
struct MachineFileText {
  std::string path, text;
  MachineKind kind{};
};

/// Opens a machine file and tells what kind of machine it describes, without reading the rest. Errors: unreadable, not
/// TOML, `kind` missing or unknown.
[[nodiscard]] Result<MachineFileText> open_machine_file(const std::string& path);

/// Directories that hold installed machine files, best first: `share/toothpath/machines` beside the executable's
/// folder, then the data folder of the source tree this was built from. Only those that exist.
[[nodiscard]] std::vector<std::string> machine_directories();

/// Path of an installed schema, "job.schema.json": `share/toothpath/schema` beside the executable's folder, then that
/// of the source tree. Empty: there is none.
[[nodiscard]] std::string schema_file(const std::string& name);

/// File names of the installed machines, "t600s.toml", in order, each once.
[[nodiscard]] std::vector<std::string> installed_machines();

/// Path of the machine file that a job calls `name`: `job_directory/name` if it is a file and not the job itself, else
/// `name` among the installed machines (a leading "machines/" is dropped there). ".toml" may be left out. An absolute
/// name is taken as it is. A folder is named only where no file is: to open it says that it is none.
/// Errors (file_access): found nowhere; the message proposes a near name and lists the installed machines.
[[nodiscard]] Result<std::string> find_machine_file(const std::string& name, const std::string& job_directory,
                                                    const std::string& job_file = {});

}  // namespace toothpath::machines
