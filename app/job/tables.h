// The tables of a job file, one function each. Findings go to the reader; what could not be read keeps its default.
#pragma once

#include "app/job/job.h"
#include "machines/toml/table_reader.h"

namespace toothpath::job {

/// [gear] with its type, and [stock] where there is one.
void read_gear(toml::TableReader& root, Job& job);

/// The [[modification]] tables of a gear or a pinion.
/// @param directory  of the job: grids are looked up there
[[nodiscard]] std::vector<modification::Modification> read_modifications(toml::TableReader& owner,
                                                                         const std::string& directory);

/// What a [[tool]] is read in.
struct ToolContext {
  const bevel_gear::BevelGearParameters* bevel = nullptr;  ///< the gear, when it is a bevel gear: a finger mill's flute
                                                           ///< length defaults to dedendum + profile height
  std::string directory;                                   ///< of the job: files that it names are looked up there
};
/// One [[tool]]. @param warnings  located remarks join them
[[nodiscard]] tool::ToolAssembly read_tool(toml::TableReader& table, const ToolContext& context,
                                           std::vector<std::string>& warnings);

/// What an [[operation]] is read in.
struct OperationContext {
  const std::vector<tool::ToolAssembly>& tools;
  bool finger = false;            ///< operations of finger mills, too
  bool teeth_along_radii = true;  ///< as those of a face gear: `tool_axis` counts them
};
/// One [[operation]]; its `tool` becomes an index into the tools.
[[nodiscard]] path::MillingOperation read_operation(toml::TableReader& table, const OperationContext& context);

/// Refused, at the operations: finger mills and other mills in one job; regions that no finishing operation covers,
/// where anything but fingers finishes; what is asked of ball mills alone.
void check_mills(toml::TableReader& root, const Job& job);

/// [setup], with the file of what was measured where it names one. @param job  its file and gear are known already;
/// its warnings say where the part stands
[[nodiscard]] joints::Setup read_setup(toml::TableReader& table, Job& job);
[[nodiscard]] shaper::Shaping read_shaping(toml::TableReader& table);
[[nodiscard]] ContactSettings read_contact(toml::TableReader& table, const Job& job);
[[nodiscard]] VerifySettings read_verify(toml::TableReader& table);
[[nodiscard]] ProgramSettings read_program_settings(toml::TableReader& table);
[[nodiscard]] MaterialSettings read_material(toml::TableReader& table);
/// `chip_load` and `max_engagement` of an operation, where they are.
void read_chip_limits(toml::TableReader& table, path::MillingOperation& operation);
[[nodiscard]] MachineChoice read_machine_choice(toml::TableReader& table);
[[nodiscard]] machines::Coolant read_coolant(toml::TableReader& table);

}  // namespace toothpath::job
