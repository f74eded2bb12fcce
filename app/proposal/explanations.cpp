#include "app/proposal/explanations.h"

#include <utility>

namespace toothpath::proposal {
namespace {

constexpr std::pair<std::string_view, std::string_view> kExplanations[] = {
    {"--gear",
     "face: a face gear with straight or helical teeth; double_helical: a face gear of two rings of opposite hands "
     "with a "
     "groove between; offset: a face gear whose pinion passes its axis; bevel_herringbone: equal base circles, for a "
     "finger mill; flank_grid: any gear of which you have points"},
    {"--cut",
     "ball: rows of a ball mill, for any flank; line: the side of a tapered mill, many times faster; shaped: set-up of "
     "a "
     "gear shaper; finger: a finger mill along the tooth"},
    {"--machine",
     "The file says axes, travels, pivots and control. `toothpath machine list` shows those that come with Toothpath; "
     "yours is copied from the one that is most like it (docs/machine_reference.md)"},
    {"--accept-assumed",
     "Pivots and travels that nobody measured may be wrong. The pages list them; `toothpath machine test` writes a "
     "program that proves them in air"},
    {"--tolerance",
     "How far the flank may be off its form, all causes together. The program takes up to four fifths of it; "
     "class A of ISO 1328-1 allows (0.55 m + 5) sqrt(2)^(A - 5) um"},
    {"--coolant", "What the control can switch on, by its machine file"},
    {"--material",
     "The forces of the cut follow, and from them how far slender tools bend: an estimate, +-50 % (docs/force.md)"},
    {"--blank-top", "Fixture and blank together. Where you are free, \"any\" leaves the most room in the travels"},
    {"--teeth", "Of the gear that is cut here, not of its mate"},
    {"--mate-teeth", "Of the gear that it runs with: with the teeth of this one it gives the pitch cones"},
    {"--shaper-teeth",
     "The tool that would generate the face gear, or the pinion itself. Some more teeth than the pinion move the "
     "contact "
     "to the middle of the face"},
    {"--module", "Pitch diameter over teeth. 25.4 over the diametral pitch gives it in mm"},
    {"--pressure-angle", "As the drawing says it, usually 20 deg; normal where the teeth are helical"},
    {"--helix", "0 for straight teeth; above 0 is a right-hand helix"},
    {"--offset", "The shortest distance between the axes of gear and pinion; its sign is the side"},
    {"--tip-radius", "Of the rounding at the tips of the shaper's teeth: it makes the fillet. 0: sharp corners"},
    {"--inner", "Nearer to the axis teeth are undercut: the limits stand above"},
    {"--outer", "Farther from the axis teeth are pointed: the limits stand above"},
    {"--spiral", "Between tooth and cone element; 30 to 35 deg are usual"},
    {"--face-width", "Length of the teeth; of bevel gears at most a third of the cone distance is usual"},
    {"--profile-shift", "As of ISO 21771, in modules: above 0 the teeth are thicker and stand farther out"},
    {"--cutter-radius", "Half of the nominal diameter of the face mill that would cut the gear on a generator"},
    {"--fillet-radius", "The largest ball that fits between flank and root is proposed"},
    {"--shaft-angle", "Between the axes of gear and mate; 90 deg where the drawing says nothing else"},
    {"--bore", "It is drawn, and tools keep clear of what the machine file places in it"},
    {"--hand",
     "Seen from the outside along the axis, teeth of a right-hand gear lean to the right. A pair has one of each"},
    {"--points", "x y z, and normals where there are any, of both flanks of one tooth space, in any order"},
    {"--points-unit", "mm or inch: it is never guessed"},
    {"--tip", "[[r, z], [r, z]]: the outline of the blank along the tips, at both ends of the teeth"},
    {"--root", "[[r, z], [r, z]]: the line of the roots, at both ends of the teeth"},
    {"--left-flank", "Which of the flanks the file means by left: concave or convex"},
    {"--ratio-of-roll", "Turns of the gear per turn of the cradle, or the other way round"},
    {"--tool", "Only these are used; what the library does not say of them is asked next"},
};

}  // namespace

std::string_view explanation_of(std::string_view option) {
  if (option.starts_with("--tool ")) return {};
  for (const auto& [name, text] : kExplanations)
    if (name == option) return text;
  return {};
}

}  // namespace toothpath::proposal
