// From a job to the face gear and the machine that it asks for; refusals get the place of the key that caused them.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "app/job.h"
#include "geometry/face_gear.h"
#include "machines/machine.h"

namespace toothpath {

template <typename T>
using ValueOrErrors = std::variant<T, std::vector<Diagnostic>>;

/// `gear.type`, as in the job file.
[[nodiscard]] const char* gear_type(const Job& job);

/// The face gear of the job. Refused: a bevel gear; everything that FaceGear::make refuses, all of it, each with its place.
[[nodiscard]] ValueOrErrors<FaceGear> make_face_gear(const Job& job);

/// The milling machine of the job. Refused: no [machine], a file that is missing or wrong, a gear shaper, assumed values that
/// the job does not accept, an operation that is faster than the spindle or the cutting feed of the machine, a work offset or a coolant
/// that its control does not have; with a part diameter [mm] also a part that does not lie on it.
[[nodiscard]] ValueOrErrors<Machine> load_machine(const Job& job, std::optional<double> part_diameter_mm = {});

/// Does a part of this diameter [mm] lie on the machine? Refused at the place of machine.file, with diameter and limit.
[[nodiscard]] Status check_part_on_machine(const Job& job, const Machine& machine, double part_diameter_mm);

/// The diagnostic with the place of a key of the job, where it has none yet.
[[nodiscard]] Diagnostic located(const Job& job, std::string_view key, Diagnostic diagnostic);

}  // namespace toothpath
