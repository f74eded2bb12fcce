#include "app/reference/formats.h"

namespace toothpath::reference {
namespace {

constexpr Meaning kMachineMeanings[] = {
    {"schema", "Version of the format."},
    {"name", "Name of the machine."},
    {"kind", "A milling machine, or a gear shaper."},
    {"dialect", "The control, by its name or another name of it ([dialects](dialects.md#what-is-there))."},
    {"tcp",
     "`none`: the joints move linearly; `angles`, `vectors`: the control keeps the tip on the chord, and reads angles "
     "or "
     "tool vectors."},
    {"assumed",
     "`true`: every value is a guess; `false`: none; or a list of dotted names of keys or tables, "
     "`[\"axes.A.point\", \"limits\"]`."},
    {"max_simultaneous_axes", "Axes that the control interpolates in one block."},
    {"spindle", "The spindle."},
    {"spindle.max_speed", "Highest speed."},
    {"spindle.tool_change",
     "From the last move of one tool to the first of the next; left out: tool changes are not in any time."},
    {"tool_check",
     "How tools are checked at the tool setter, for jobs that ask for it "
     "([dialects](dialects.md#checks-of-the-tools))."},
    {"tool_check.lines",
     "Lines that check the tool in the spindle, templates; left out: those of the control, where it has a documented "
     "cycle."},
    {"tool_check.position",
     "Where the tool setter stands, machine coordinates: X and Y of the spindle above it, Z where the tip of a tool "
     "touches it."},
    {"tool_check.clearance", "So far above that the way to the setter ends; from there on the lines go."},
    {"tool_check.feed", "Feed towards the setter, where the lines name {feed}."},
    {"tool_check.tolerance",
     "How far a length may be off before the program stops, of tools that state no check_tolerance; of lines that name "
     "no {tolerance} what they let pass."},
    {"tool_check.uncertainty",
     "Stated where the lines let the control take the length that they measure: how far that may be off; counts in the "
     "proof. Left out: the lines compare and nothing else."},
    {"tool_check.time", "What a check takes in all, for the times; left out: nothing."},
    {"limits", "What the machine takes."},
    {"limits.cutting_feed", "Highest feed in the cut."},
    {"limits.table_diameter", "Largest circle that fits on the table."},
    {"limits.table_face",
     "Z of the table's face, machine coordinates, all rotaries at zero; left out: Z of the point of the first axis "
     "under "
     "the work."},
    {"limits.min_block_ms", "Shortest block that the control keeps up with."},
    {"limits.part_diameter", "Largest part that turns on the rotary table; left out: as table_diameter."},
    {"limits.part_mass", "Heaviest part; left out: any."},
    {"limits.feed_factor",
     "How many times as fast as its job says a program may cut before it is not verified "
     "([proof](proof.md#feeds-speeds-tool-and-coolant))."},
    {"limits.speed_factor", "How many times as fast or as slow as its job says the spindle of a program may turn."},
    {"limits.limit_margin", "How close to a limit a command of a linear axis may come."},
    {"limits.limit_margin_angle", "How close to a limit a command of a rotary axis may come."},
    {"chain", "Which rotary axes carry the work, and which the tool; at most two in all."},
    {"chain.table", "Letters of the rotary axes under the work, from the work outwards."},
    {"chain.head", "Letters of the rotary axes above the tool, from the ram outwards."},
    {"chain.order",
     "Order of all axes from the work to the tool with \"bed\" where the machine stands, for its bodies; left out: the "
     "table carries its rotaries only."},
    {"body", "A body of the machine for the check of its moves and for the picture: table, cradle, column, head."},
    {"body.name", "Name for messages."},
    {"body.of", "What carries it: \"bed\", \"spindle\", \"table\" (what carries the work) or the letter of an axis."},
    {"body.shape", "What it is. All coordinates: machine axes, all axes at zero."},
    {"body.min", "Lower corner of the box."},
    {"body.max", "Upper corner of the box."},
    {"body.from", "One end of the axis of the cylinder or cone."},
    {"body.to", "The other end."},
    {"body.diameter", "Diameter; of a cone at `from`."},
    {"body.diameter_to", "Diameter at `to`."},
    {"body.file", "STL file beside the machine file; a closed solid, mm."},
    {"body.touches", "Names of bodies that always touch it: they are not checked against it."},
    {"axes", "Every axis of the machine."},
    {"axes.X", "Linear axis; of a gear shaper the infeed, 0 at full depth."},
    {"axes.Y", "Linear axis; of a gear shaper the offset slide."},
    {"axes.Z", "Linear axis; of a gear shaper the stroke."},
    {"axes.A", "Rotary axis; of a gear shaper the cutter."},
    {"axes.B", "Rotary axis."},
    {"axes.C", "Rotary axis; of a gear shaper the work."},
    {"axes.*.min", "Lower end; of a rotary left out where it rolls over."},
    {"axes.*.max", "Upper end; of a rotary left out where it rolls over."},
    {"axes.*.max_speed", "Highest speed."},
    {"axes.*.max_acceleration",
     "For the times ([times](times.md)) and, under LinuxCNC, for what is left of a corner; every axis has one or "
     "none."},
    {"axes.*.max_jerk", "For the times; every axis has one or none, and an acceleration."},
    {"axes.*.direction", "Direction of the axis in machine coordinates, all rotaries at zero; of any length."},
    {"axes.*.point",
     "Of a table axis, required: a point on it, machine coordinates. Of a head axis: its lateral offset `[x, y, 0]` "
     "from "
     "the gauge point."},
    {"axes.*.pivot_length",
     "Of a head axis: its height above the gauge point, all rotaries at zero; may be left out where the axis is "
     "parallel "
     "to Z."},
    {"axes.*.sign", "1: turns in the sense of ISO 841; -1: reversed."},
    {"axes.*.zero", "The command at which the axis stands at its zero; with TCP under LinuxCNC and Fanuc 0 alone."},
    {"axes.*.rollover",
     "`true`: the control counts the axis from 0 to 360 deg and it turns without end, min and max are left out "
     "([dialects](dialects.md#rotaries-that-roll-over)); `false`: words go on beyond a turn, 370 and not 10."},
    {"axes.*.clamp",
     "Words of the builder that clamp a rotary and release it, `[\"M10\", \"M11\"]`: programs release it ahead of its "
     "turns and clamp it where it stands in the cuts that follow ([dialects](dialects.md#clamps-of-the-rotaries))."},
    {"axes.*.clamp_time", "What they take, for the times; left out: nothing."},
    {"post", "How programs are written; which of these keys a control takes is judged by it."},
    {"post.linear_decimals", "Digits after the point of lengths; left out: those of the dialect."},
    {"post.rotary_decimals", "Digits after the point of angles; left out: those of the dialect."},
    {"post.index_loop", "Teeth as a loop of the program, or written out; left out: what the dialect does."},
    {"post.index_offset",
     "LinuxCNC: a work offset that programs may overwrite, `\"G59.3\"`: with TCP one tooth stands in the text, and the "
     "offset turns it to the others ([dialects](dialects.md#the-zero-of-the-index-rotary)); left out: all teeth are "
     "written out."},
    {"post.transformation_takes_rotary_offset",
     "Siemens with `tcp = \"angles\"`: `true` where the machine data 24590 TRAFO5_ROT_OFFSET_FROM_FRAME of the "
     "transformation is 1, so that TRAORI takes the rotary offset of the frame: a loop moves the zero of the index "
     "rotary, and no word holds a sum ([dialects](dialects.md#the-zero-of-the-index-rotary)); the dry run shows "
     "whether "
     "it is so."},
    {"post.tcp_on", "Blocks that switch TCP on, `[\"M428\"]`; needed for TCP under LinuxCNC."},
    {"post.tcp_off", "Blocks that switch TCP off."},
    {"post.corner_tolerance",
     "Fanuc, Mitsubishi, Haas: how far the tip is off a corner at most under G64; programs then say G64 instead of "
     "G61. "
     "LinuxCNC: how far the tool may be off a corner in exact path mode ([dialects](dialects.md)); left out: 0.0005 "
     "mm."},
    {"post.smoothing_on",
     "Blocks that switch the control's own smoothing on around the teeth (Fanuc, Mitsubishi, Siemens), `[\"G5.1 "
     "Q1\"]`."},
    {"post.smoothing_off", "Blocks that switch it off."},
    {"post.smoothing_tolerance", "How far the tip leaves the path while it is on, as the shop states it."},
    {"post.smoothing_axis_tolerance",
     "How far the tool axis turns off meanwhile, where cuts turn a rotary, as the shop states it."},
    {"post.coolant_flood", "Words of the builder for flood coolant, on and off ([dialects](dialects.md#coolant))."},
    {"post.coolant_mist", "Words of the builder for mist, on and off."},
    {"post.coolant_air", "Words of the builder for air, on and off."},
    {"post.coolant_through_spindle", "Words of the builder for coolant through the spindle, on and off."},
    {"post.reference_position",
     "Where G28 takes the axes (Siemens: G75 FP=1; Heidenhain: the zero of M92), machine coordinates: X Y Z in mm, "
     "then "
     "the rotaries in deg, as [chain] names them. `check` refuses these words without it."},
    {"post.second_reference_position", "The same of G30 (Siemens: G75 FP=2)."},
    {"post.retract",
     "How programs take Z to its top. `\"machine\"`: by G53, to the end of its travel less `limit_margin`; "
     "`\"reference\"` (Fanuc, Mitsubishi, Haas): by `G91 G28 Z0.`, to Z of `reference_position`, which must be stated. "
     "G43.4 is ended by G53 all the same ([dialects](dialects.md#how-z-goes-to-its-top))."},
    {"post.start",
     "Lines of the shop behind the start of every program; templates ([dialects](dialects.md#own-lines))."},
    {"post.tool_change",
     "Lines in the place of those that fetch a tool; templates ([dialects](dialects.md#own-lines))."},
    {"post.between_teeth", "Lines of the shop behind every tooth; templates ([dialects](dialects.md#own-lines))."},
    {"post.end", "Lines of the shop ahead of the end of a program; templates ([dialects](dialects.md#own-lines))."},
    {"post.length_reference", "What the tool length of a ball reaches to."},
    {"post.pole",
     "What is done where the tool comes parallel to the rotary axis that carries the work ([axis "
     "motion](axis_motion.md))."},
    {"post.pole_angle",
     "`tilt`: least angle kept from the pole, left out: 5 deg; `hold`, `through`, `retract`: greatest change of the "
     "tool "
     "axis, left out: 0.0573 deg."},
    {"stroke", "The stroke."},
    {"stroke.steps", "Double strokes a minute that the machine has, ascending."},
    {"stroke.max_length", "Longest stroke."},
    {"stroke.relief", "How far the cutter backs off on the return stroke."},
    {"index", "The train of change gears that couples the work to the cutter."},
    {"index.constant", "Its constant as two whole numbers: a/b * c/d = constant * cutter teeth / work teeth, exactly."},
    {"feed", "The train of change gears of the circular feed."},
    {"feed.constant", "Its constant as two whole numbers: gears = constant * circular feed / pitch diameter."},
    {"gears", "The change gears that are there."},
    {"gears.teeth", "Their numbers of teeth; each wheel is there once."},
    {"gears.mesh_margin", "By how much two wheels must exceed the next one to mesh: a + b >= c + margin."},
    {"gearbox", "An electronic gearbox in place of change gears."},
    {"gearbox.relief_on", "M code that lifts the cutter on the return stroke."},
    {"gearbox.relief_off", "M code that ends the lifting."},
    {"gearbox.cutter_axis", "Name of the leading axis."},
    {"gearbox.work_axis", "Name of the following axis."},
    {"gearbox.pulses_per_turn", "Pulses of one turn of the cutter axis."},
};

}  // namespace

std::span<const Meaning> machine_meanings() { return kMachineMeanings; }

}  // namespace toothpath::reference
