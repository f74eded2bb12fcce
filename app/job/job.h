// One job: everything that a job file says, checked and in mm and rad. A plain value; made by app/job/file.h.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cam/force/load.h"
#include "cam/path/operation.h"
#include "cam/proof/limits.h"
#include "cam/tool/assembly.h"
#include "geometry/base/diagnostic.h"
#include "geometry/bevel_gear/parameters.h"
#include "geometry/contact/pinion.h"
#include "geometry/cylindrical/parameters.h"
#include "geometry/face_gear/body.h"
#include "geometry/face_gear/parameters.h"
#include "geometry/flank_grid/parameters.h"
#include "geometry/modification/modification.h"
#include "geometry/spiral_bevel/parameters.h"
#include "geometry/straight_bevel/parameters.h"
#include "machines/coolant.h"
#include "machines/toml/table_reader.h"
#include "postproc/joints/setup.h"
#include "postproc/shaper/shaping.h"
#include "postproc/text/stops.h"

namespace toothpath::machines {
enum class PoleOption;  // machines/machine.h
}  // namespace toothpath::machines

namespace toothpath::job {

/// The [machine] table.
struct MachineChoice {
  std::string file;             ///< as written: looked up beside the job first, then among the installed machines
  bool accept_assumed = false;  ///< the user knows that values of this machine are assumed
};

/// The [verify] table.
struct VerifySettings {
  double gouge_tolerance_mm =
      proof::ProofLimits{}.gouge_mm;   ///< deepest cut into the finished surface that counts as verified
  bool all_teeth = false;              ///< false: one space is proven, the others are turned copies
  std::optional<double> clearance_mm;  ///< least gap of neck, shank and holder; none: the program's default
  std::optional<double>
      unreached_mm;  ///< surface out of the finishing ball's reach may stand so high; none: it is told, no verdict
  std::optional<double> form_tolerance_mm;  ///< of the flanks, as asked; what the report compares with
  std::optional<int> iso_class;             ///< the same as a class of ISO 1328-1
};

/// The [program] table.
struct ProgramSettings {
  std::optional<int>
      number;  ///< of the main program (O word), its sub-programs behind it; none: made of the job's name
  bool spread_teeth = false;   ///< tooth_order = "spread": neighbours are not cut one after the other; else in sequence
  text::TextWishes text;       ///< stops and numbers of blocks
  bool tilted_planes = false;  ///< cuts with a standing tool axis in tilted planes of the control
  bool split_operations = false;               ///< beside the program one for every operation
  std::optional<int> teeth_per_program;        ///< .. and of more teeth several
  std::optional<double> contour_tolerance_mm;  ///< that the text allows the control; none: a share of what is left
  std::optional<machines::PoleOption> pole;    ///< instead of post.pole of the machine file
  std::optional<double> pole_angle_rad;        ///< instead of post.pole_angle
};

/// What the keys of [contact], and the options of `contact` in their place, may be.
inline constexpr toml::Range kPinionTeeth{5, 1000}, kMoved{-5, 5, " mm"}, kAngleError{-1, 1, " deg"},
    kCompound{1e-4, 0.1, " mm"};
/// Torque on the gear, in [load] and as an option.
inline constexpr toml::Range kTorque{1e-6, 1e9, " N m"};
/// Numbers of programs: from 8000 on they are the builder's.
inline constexpr toml::Range kProgramNumber{1, 7999};
/// Teeth of a part of a program.
inline constexpr toml::Range kTeethPerProgram{1, 5000};
/// Teeth between two checks of a tool.
inline constexpr toml::Range kToolCheckTeeth{1, 5000};
/// Contour tolerance of a program.
inline constexpr toml::Range kContourTolerance{1e-4, 0.1, " mm"};
/// Numbers of tools.
inline constexpr toml::Range kToolNumber{1, 9999};

/// How the pinion is held along its axis; `automatic`: it floats between two rings of opposite hand of a face gear,
/// else it is held.
enum class PinionHold { automatic, floating, held, spring };
/// The [contact.load] table: what the pair carries and of what it is. docs/loaded_contact.md.
struct ContactLoad {
  double torque_Nm = 0;
  bool on_pinion = false;
  double youngs_modulus_N_mm2[2] = {210e3, 210e3};  ///< of gear, of pinion
  double poisson[2] = {0.3, 0.3};
  PinionHold pinion_axial = PinionHold::automatic;
  double axial_stiffness_N_mm = 0;   ///< of `spring`
  int positions = 24;                ///< over one pitch
  int row_teeth = 5;                 ///< of the clamped row that stands for the body, odd
  std::optional<double> segment_mm;  ///< none: 0.3 m
  std::optional<double> rim_mm;      ///< none: 5 m
  double edge_radius_mm = 0;         ///< rounding of the edges of the teeth; 0: not stated
  std::optional<double> friction;    ///< coefficient; none: nothing is said of friction
  bool root_stress = false;          ///< stress of the fillets, too
};
/// What the torque of [contact.load] and of `contact --torque`, and the positions may be.
inline constexpr toml::Range kContactTorque{1e-6, 1e9, " N m"}, kContactPositions{1, 200};

/// The [contact.misalignment] table: how far the pair may stand off its place, as much either way. docs/ease_off.md.
struct MisalignmentBox {
  contact::Misalignment most;  ///< all >= 0
  double margin = 0.05;        ///< share of face and profile that an optimised pattern keeps off the edges
};

/// The [contact] table: the pinion that runs with the gear, and where it stands.
struct ContactSettings {
  int pinion_teeth = 0;  ///< N_p; 0: mate_teeth of the gear
  contact::Misalignment moved;
  double compound_mm = 0.006;                             ///< thickness of the marking compound
  std::vector<modification::Modification> modifications;  ///< of the pinion's flanks
  std::optional<ContactLoad> load;
  std::optional<MisalignmentBox> box;
};

/// The [material] table: what cutting costs, and of what the tools are. docs/force.md.
struct MaterialSettings {
  force::Material cutting;
  force::Elasticity tools;
  bool stated = false;  ///< the job has the table; else these are the defaults: steel, carbide
};

/// Where a key was written: "gear.module", "gear.zone[0].inner_radius", "tool[1].diameter", "operation[2].scallop",
/// "machine.file"; a table itself as "gear", "tool[1]". Later stages ask it to locate what they refuse.
using KeyPositions = std::map<std::string, SourcePosition, std::less<>>;

struct Job {
  std::string file;  ///< path as given on the command line
  std::string name;
  std::variant<face_gear::FaceGearParameters, bevel_gear::BevelGearParameters, cylindrical::CylindricalParameters,
               straight_bevel::StraightBevelParameters, spiral_bevel::SpiralBevelParameters,
               flank_grid::FlankGridParameters>
      gear;
  face_gear::Body face_body;  ///< of a face gear, [stock]
  /// Of the flanks of gears that stand on their tooth spaces alone; other types have them among their parameters.
  std::vector<modification::Modification> modifications;
  MachineChoice machine;
  std::optional<joints::Setup> setup;  ///< present in every milling job
  std::vector<tool::ToolAssembly> tools;
  std::vector<path::MillingOperation> operations;      ///< `tool` is an index into `tools`
  machines::Coolant coolant = machines::Coolant::off;  ///< mode of [coolant]
  VerifySettings verify;
  MaterialSettings material;
  ProgramSettings program;
  std::optional<shaper::Shaping> shaping;
  std::optional<ContactSettings> contact;
  std::optional<double> torque_Nm;  ///< [load]: on the gear of the job; only forces are computed from it
  KeyPositions positions;
  std::vector<std::string> warnings;  ///< located remarks that do not stop a run, e.g. an angle that looks like radians

  /// Position of a key, of the nearest table above it where the key was not written, or of the file.
  [[nodiscard]] SourcePosition where(std::string_view key) const;
  /// Where the job lies: files that it names are looked up there.
  [[nodiscard]] std::string directory() const;
  /// The word of the gear's type, as job files say it.
  [[nodiscard]] const char* gear_type() const;
  [[nodiscard]] const face_gear::FaceGearParameters* face_gear() const {
    return std::get_if<face_gear::FaceGearParameters>(&gear);
  }
  [[nodiscard]] const bevel_gear::BevelGearParameters* bevel_gear() const {
    return std::get_if<bevel_gear::BevelGearParameters>(&gear);
  }
  [[nodiscard]] const cylindrical::CylindricalParameters* cylindrical_gear() const {
    return std::get_if<cylindrical::CylindricalParameters>(&gear);
  }
  [[nodiscard]] const straight_bevel::StraightBevelParameters* straight_bevel_gear() const {
    return std::get_if<straight_bevel::StraightBevelParameters>(&gear);
  }
  [[nodiscard]] const spiral_bevel::SpiralBevelParameters* spiral_bevel_gear() const {
    return std::get_if<spiral_bevel::SpiralBevelParameters>(&gear);
  }
  [[nodiscard]] const flank_grid::FlankGridParameters* flank_grid() const {
    return std::get_if<flank_grid::FlankGridParameters>(&gear);
  }
};

}  // namespace toothpath::job
