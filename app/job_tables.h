// The tables of a job file, one function each. Findings go to the reader; what could not be read keeps its default.
#pragma once

#include "app/job.h"
#include "machines/toml/table_reader.h"

namespace toothpath {

/// [gear] with type = "face_gear", its [[gear.zone]] tables, and [stock] where there is one.
[[nodiscard]] FaceGearParameters read_face_gear(TableReader& gear, TableReader* stock, std::vector<std::string>& warnings);

/// [gear] with type = "equal_base_circle_bevel_gear".
[[nodiscard]] BevelGearParameters read_bevel_gear(TableReader& gear);

/// One [[tool]].
/// @param bevel  the gear, when it is a bevel gear: a finger mill's flute length defaults to dedendum + profile height
[[nodiscard]] ToolAssembly read_tool(TableReader& table, const BevelGearParameters* bevel);

/// One [[operation]]; its `tool` becomes an index into `tools`.
/// @param bevel_gear  which operations fit: finger operations for bevel gears, ball operations for face gears
[[nodiscard]] MillingOperation read_operation(TableReader& table, const std::vector<ToolAssembly>& tools, bool bevel_gear);

[[nodiscard]] Setup read_setup(TableReader& table);
[[nodiscard]] Shaping read_shaping(TableReader& table);
[[nodiscard]] ContactSettings read_contact(TableReader& table);
[[nodiscard]] VerifySettings read_verify(TableReader& table, bool bevel);
[[nodiscard]] ProgramSettings read_program_settings(TableReader& table);
[[nodiscard]] MachineChoice read_machine_choice(TableReader& table);
[[nodiscard]] Coolant read_coolant(TableReader& table);

}  // namespace toothpath
