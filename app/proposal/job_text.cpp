#include "app/proposal/job_text.h"

#include <fmt/ranges.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/proposal/gear_limits.h"
#include "app/proposal/material.h"
#include "app/proposal/points_gear.h"
#include "cam/tool/cutters.h"
#include "geometry/base/angle.h"
#include "machines/toml/quoted.h"

namespace toothpath::proposal {
namespace {

/// A number with a point: what TOML takes for a real.
std::string real(double x) {
  std::string text = fmt::format("{:.4f}", x);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text += '0';
  return text;
}

/// Such a number with all that a file said of it; twelve digits, which hide what turning degrees into radians leaves.
std::string exact(double x) {
  std::string text = fmt::format("{:.12g}", x == 0 ? 0.0 : x);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

/// `key = value`, and what it means behind it.
std::string line(const char* key, const std::string& value, const char* meaning = "") {
  const std::string start = fmt::format("{} = {}", key, value);
  return *meaning ? fmt::format("{:<32} # {}\n", start, meaning) : start + "\n";
}

std::string vector_text(const Vec3& v) { return fmt::format("[{}, {}, {}]", real(v.x()), real(v.y()), real(v.z())); }

std::string face_text(const Wishes& wishes) {
  const face_gear::FaceGearParameters p = whole_face_parameters(wishes);
  std::string text = "\n[gear]\ntype = \"face_gear\"\n";
  text += line("teeth", fmt::format("{}", p.teeth));
  text += line("shaper_teeth", fmt::format("{}", p.shaper_teeth), "of the pinion-shaped shaper that makes the flanks");
  text += line("module", real(p.module_mm));
  text += line("module_plane", "\"transverse\"",
               "\"normal\" or \"transverse\": for module, pressure angle and coefficients");
  text += line("pressure_angle", real(wishes.at(Quantity::pressure_angle)));
  if (wishes.gear == Gear::offset) text += line("offset", real(p.offset_mm), "between the axes of gear and pinion");
  if (p.reference_radius_mm)
    text +=
        line("reference_radius", real(*p.reference_radius_mm), "where the two halves are in phase: the apex of the V");
  text += line("shaper_tip_radius", real(p.shaper_tip_radius_mm),
               "rounds the root of the tooth, so that a ball can follow it");
  for (const auto& zone : p.zones) {
    text += "\n[[gear.zone]]                    # one ring of teeth\n";
    text += line("helix_angle", real(degrees(zone.helix_angle_rad)), "of the shaper; above 0 is right hand");
    text += line("inner_radius", real(zone.inner_radius_mm));
    text += line("outer_radius", real(zone.outer_radius_mm));
  }
  return text;
}

std::string cylindrical_text(const Wishes& wishes) {
  const cylindrical::CylindricalParameters p = cylindrical_parameters(wishes);
  std::string text = "\n[gear]\ntype = \"cylindrical_gear\"\n";
  text += line("teeth", fmt::format("{}", p.teeth));
  text += line("module", exact(p.module_mm));
  text += line("module_plane", "\"normal\"", "\"normal\" or \"transverse\": for module and pressure angle");
  text += line("pressure_angle", exact(degrees(p.pressure_angle_rad)));
  text += line("profile_shift", exact(p.profile_shift), "in modules");
  text += line("addendum_coefficient", exact(p.addendum_coefficient), "of the basic rack, in modules");
  text += line("dedendum_coefficient", exact(p.dedendum_coefficient));
  text += line("root_radius_coefficient", exact(p.root_radius_coefficient), "rounding of the rack's tip: the fillet");
  if (p.tip_diameter_mm) text += line("tip_diameter", exact(*p.tip_diameter_mm));
  if (p.thickness_allowance_mm < 0)
    text += line("thickness_allowance", exact(p.thickness_allowance_mm), "of the teeth, on the reference cylinder");
  if (p.bore_diameter_mm > 0) text += line("bore_diameter", exact(p.bore_diameter_mm));
  if (p.groove_diameter_mm) text += line("groove_diameter", exact(*p.groove_diameter_mm));
  for (const cylindrical::CylindricalZone& zone : p.zones) {
    text += "\n[[gear.zone]]                    # one ring of teeth\n";
    text += line("helix_angle", exact(degrees(zone.helix_angle_rad)), "above 0 is right hand");
    text += line("from", exact(zone.from_mm), "along the gear axis");
    text += line("to", exact(zone.to_mm));
  }
  return text;
}

std::string straight_bevel_text(const Wishes& wishes) {
  const straight_bevel::StraightBevelParameters p = straight_bevel_parameters(wishes);
  std::string text = "\n[gear]\ntype = \"straight_bevel_gear\"\n";
  text += line("teeth", fmt::format("{}", p.teeth));
  text += line("mate_teeth", fmt::format("{:.0f}", wishes.at(Quantity::mate_teeth)));
  text += line("shaft_angle", "90.0");
  text += line("outer_transverse_module", real(p.outer_transverse_module_mm));
  text += line("pressure_angle", real(wishes.at(Quantity::pressure_angle)), "of the crown gear");
  text += line("form", "\"octoid\"", "or \"spherical_involute\"");
  text += line("face_width", real(p.face_width_mm), "along the pitch cone, from the large end inwards");
  text += line("addendum", real(p.addendum_mm), "at the large end");
  text += line("dedendum", real(p.dedendum_mm));
  text += line("tip_angle", real(std::round(1e4 * degrees(*p.tip_angle_rad)) / 1e4), "of the face cone");
  text += line("thickness_shift", real(p.thickness_shift), "half of the tooth's excess, in modules");
  if (p.bore_diameter_mm > 0) text += line("bore_diameter", real(p.bore_diameter_mm));
  text += line("fillet_radius", real(p.fillet_radius_mm), "rounding of the crown gear's teeth: the fillet");
  text += line("backlash", "0.0", "of the pair, on the outer pitch circle");
  return text;
}

std::string bevel_text(const Wishes& wishes) {
  const bevel_gear::BevelGearParameters p = bevel_parameters(wishes);
  std::string text = "\n[gear]\ntype = \"equal_base_circle_bevel_gear\"\n";
  text += line("teeth", fmt::format("{}", p.teeth));
  text += line("mate_teeth", fmt::format("{}", p.mate_teeth));
  text += line("shaft_angle", "90.0");
  text += line("outer_transverse_module", real(p.outer_transverse_module_mm));
  text += line("pressure_angle", real(wishes.at(Quantity::pressure_angle)));
  text += line("outer_spiral_angle", real(wishes.at(Quantity::spiral)));
  text += line("face_width", real(p.face_width_mm));
  text += line("form", "\"herringbone\"", "or \"single\"");
  text += line("hand", wishes.hand < 0 ? "\"left\"" : "\"right\"", "of the inner half; the mate has the other");
  text += line("apex_cone_distance", real(p.apex_cone_distance_mm), "where the halves meet");
  text += line("relief_half_width", real(p.relief_half_width_mm), "turned groove there, to root depth");
  text += line("addendum", real(p.addendum_mm));
  text += line("dedendum", real(p.dedendum_mm));
  text += line("backlash", "0.0", "of the pair, along the outer pitch circle");
  return text;
}

/// A number of the one blade, or of both.
std::string blades_text(const spiral_bevel::Cut& cut, double spiral_bevel::Blade::*member, bool angle) {
  const auto text = [&](std::size_t k) {
    const double x = cut.blades[k].*member;
    return exact(angle ? degrees(x) : x);
  };
  if (cut.flank == spiral_bevel::Cuts::both) return fmt::format("[{}, {}]", text(0), text(1));
  return text(cut.flank == spiral_bevel::Cuts::concave ? 0 : 1);
}

std::string cut_text(const spiral_bevel::Cut& cut) {
  using spiral_bevel::Blade;
  using spiral_bevel::Cuts;
  const bool both = cut.flank == Cuts::both;
  std::string text = "\n[[gear.cut]]\n";
  text += line("flank", both ? "\"both\"" : cut.flank == Cuts::concave ? "\"concave\"" : "\"convex\"");
  if (!cut.generated) text += line("generated", "false", "the flank is the cutter's cone");
  text += line("blade_point_radius", blades_text(cut, &Blade::point_radius_mm, false), both ? "[outside, inside]" : "");
  text += line("blade_pressure_angle", blades_text(cut, &Blade::pressure_angle_rad, true));
  text += line("tool_edge_radius", blades_text(cut, &Blade::edge_radius_mm, false), "the fillet is its envelope");
  text += line("radial_distance", exact(cut.radial_distance_mm));
  text += line("center_roll_position", exact(degrees(cut.cradle_angle_rad)));
  text += line("machine_root_angle", exact(degrees(cut.root_angle_rad)));
  text += line("work_offset", exact(cut.work_offset_mm));
  text += line("sliding_base", exact(cut.sliding_base_mm));
  text += line("machine_center_to_crossing_point", exact(cut.machine_center_mm));
  if (cut.generated) text += line("ratio_of_roll", exact(cut.ratio_of_roll), "work per cradle");
  if (!cut.modified.empty()) {
    std::string list;
    for (const double c : cut.modified) list += (list.empty() ? "" : ", ") + exact(c);
    text += line("modified_roll_coefficients", "[" + list + "]");
  }
  if (cut.tilt_rad != 0 || cut.swivel_rad != 0) {
    text += line("cutter_tilt", exact(degrees(cut.tilt_rad)));
    text += line("cutter_swivel", exact(degrees(cut.swivel_rad)));
  }
  return text;
}

/// What a proposal took beside the numbers of a drawing.
std::string assumed_text(const Wishes& wishes) {
  const double shafts = wishes[Quantity::shaft_angle].value_or(90);
  return fmt::format(
      "\n# Proposed from a drawing, not a sheet of a generator: {:.0f}/{:.0f} teeth, outer transverse module {:g} mm,\n"
      "# spiral angle {:g} deg in the middle of the face, pressure angle {:g} deg, face mill of {:g} mm radius. "
      "Assumed:\n"
      "# shafts at {:g} deg without offset or backlash; Gleason's depths (working depth 1.7 m, clearance 0.188 m, "
      "addendum\n"
      "# of the wheel 0.46 m + 0.39 m {}); duplex taper, at most 1.3 times the standard one (ISO 23509); both "
      "flanks\n"
      "# cut at once by spread blades (completing) on the basic setting of the generator: no offset, tilt or modified "
      "roll.\n"
      "# The mate has the same numbers with its teeth exchanged and the other hand: toothpath contact JOB --mate "
      "OTHER.\n",
      wishes.at(Quantity::teeth), wishes.at(Quantity::mate_teeth), wishes.at(Quantity::module),
      wishes.at(Quantity::spiral), wishes.at(Quantity::pressure_angle), wishes.at(Quantity::cutter_radius), shafts,
      shafts == 90 ? "(z1/z2)^2" : "z1 cos(d2)/(z2 cos(d1))");
}

std::string spiral_bevel_text(const Wishes& wishes) {
  const spiral_bevel::SpiralBevelParameters& p = *wishes.spiral;
  std::string text = (wishes.drawn() ? assumed_text(wishes) : "\n") + "[gear]\ntype = \"spiral_bevel_gear\"\n";
  text += line("teeth", fmt::format("{}", p.teeth));
  text += line("hand", p.hand > 0 ? "\"right\"" : "\"left\"");
  text += line("shaft_angle", exact(degrees(p.shaft_angle_rad)), "of the pair");
  text += line("pitch_angle", exact(degrees(p.pitch_angle_rad)));
  text += line("outer_cone_distance", exact(p.outer_cone_distance_mm));
  text += line("face_width", exact(p.face_width_mm), "along the pitch cone, from the large end inwards");
  text += line("tip_angle", exact(degrees(p.tip_angle_rad)), "of the face cone");
  if (p.tip_apex_mm != 0) text += line("tip_apex", exact(p.tip_apex_mm), "beyond the crossing point");
  if (p.root_angle_rad) text += line("root_angle", exact(degrees(*p.root_angle_rad)));
  if (p.root_apex_mm) text += line("root_apex", exact(*p.root_apex_mm), "beyond the crossing point");
  if (p.mean_space_width_mm)
    text += line("mean_space_width", exact(*p.mean_space_width_mm), "arc at the mean cone distance");
  if (p.bore_diameter_mm > 0) text += line("bore_diameter", exact(p.bore_diameter_mm));
  for (const spiral_bevel::Cut& cut : p.cuts) text += cut_text(cut);
  return text;
}

std::string flank_grid_text(const Wishes& wishes) {
  const flank_grid::FlankGridParameters& p = *wishes.grid;
  std::string text = "\n[gear]\ntype = \"flank_grid\"\n";
  text += line("teeth", fmt::format("{}", p.teeth));
  text += line("points", toml::quoted(wishes.points_file), "flank, row, column and place of each; beside this job");
  text += line("fillet_radius", exact(p.fillet_radius_mm), "of the ball that rolls between flank and root");
  text += line("root", meridian_text(p.root), "[r, z] at both ends");
  text += line("tip", meridian_text(p.tip));
  if (p.bore_diameter_mm > 0) text += line("bore_diameter", exact(p.bore_diameter_mm));
  return text;
}

std::string value_text(const toml::TomlValue& value) {
  if (const std::string* text = value.text()) return toml::quoted(*text);
  if (const auto* whole = std::get_if<std::int64_t>(&value.data)) return fmt::format("{}", *whole);
  if (const auto number = value.number()) return real(*number);
  std::string all;
  if (const toml::TomlArray* array = value.array())
    for (const toml::TomlValue& one : array->values) all += (all.empty() ? "" : ", ") + value_text(one);
  return "[" + all + "]";
}

/// A tool of a library: its file says what does not stand here.
std::string library_tool_text(const tool::ToolAssembly& tool, const LibraryWords& library) {
  std::string text = fmt::format("\n[[tool]]\nnumber = {}\n", tool.number);
  text += line("library", toml::quoted(library.file), "says of this tool what does not stand here");
  if (!library.unit.empty()) text += line("library_unit", toml::quoted(library.unit));
  const auto said = library.said.find(tool.number);
  if (said != library.said.end())
    for (const toml::TomlEntry& entry : said->second.entries) text += line(entry.key.c_str(), value_text(entry.value));
  return text;
}

std::string tool_text(const tool::ToolAssembly& tool, double depth) {
  const tool::CutterKind& kind = tool::kind_of(tool);
  std::string text = fmt::format("\n[[tool]]\nnumber = {}\ntype = \"{}\"\n", tool.number, kind.word);
  for (const auto& n : kind.numbers) {
    const double value = tool.*n.member;
    const std::string key = n.key;
    const std::string note = key == "flute_length" ? fmt::format("the teeth are {:.2f} mm deep", depth)
                             : key == "half_angle" ? "between axis and side"
                                                   : "";
    text += line(n.key, real(n.degrees ? degrees(value) : value), note.c_str());
  }
  text += line("shank_diameter", real(tool.shank_diameter_mm));
  if (tool.helix_rad) text += line("helix", real(degrees(*tool.helix_rad)));
  text += line("length", real(tool.length_mm), "gauge line to tip: measure it");
  std::string holder;
  for (const auto& s : tool.holder)
    holder += fmt::format("{}[{}, {}, {}]", holder.empty() ? "" : ", ", real(s.lower_diameter_mm),
                          real(s.upper_diameter_mm), real(s.height_mm));
  text += line("holder", "[" + holder + "]", "[lower diameter, upper diameter, height] from below");
  text += line("stick_out", real(tool.stick_out_mm), "lower face of the holder to the tip");
  text += line("teeth", fmt::format("{}", tool.teeth));
  if (tool.check_tolerance_mm > 0) text += line("check_tolerance", real(tool.check_tolerance_mm));
  if (tool.life_min > 0) text += line("life", real(tool.life_min), "minutes of cutting");
  if (!tool.sisters.empty()) text += line("sisters", fmt::format("[{}]", fmt::join(tool.sisters, ", ")));
  return text;
}

class Operations {
 public:
  explicit Operations(const Draft& draft) : draft_(draft) {}

  void begin(const char* type, const tool::ToolAssembly& tool, double diameter, const char* note = "") {
    const Cutting cutting = cutting_of(diameter, tool.teeth, draft_.spindle_rpm, draft_.most_feed_mm_min);
    text_ += "\n[[operation]]\n" + line("type", fmt::format("\"{}\"", type), note);
    text_ += line("tool", fmt::format("{}", tool.number));
    text_ += line("speed", fmt::format("{:.0f}", cutting.speed_rpm));
    text_ += line("feed", real(draft_.coarse ? std::round(0.07 * cutting.feed_mm_min) * 10 : cutting.feed_mm_min));
  }
  void add(const char* key, double value, const char* note = "") { text_ += line(key, real(value), note); }
  void add(const char* key, const char* value, const char* note = "") { text_ += line(key, value, note); }

  void rough(const tool::ToolAssembly& tool, double allowance, const char* note) {
    begin("roughing", tool, tool.diameter_mm, note);
    add("step_down", 0.28 * tool.diameter_mm, "depth of a layer");
    add("step_over", 0.45 * tool.diameter_mm, "between the passes of a layer");
    add("allowance", allowance, "stock that stays");
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  const Draft& draft_;
  std::string text_;
};

/// Of the operations, mm.
struct Tolerances {
  explicit Tolerances(const Draft& draft)
      : total(tolerance_mm(draft.wishes.quality, draft.wishes.at(Quantity::module))),
        widened(draft.coarse && !draft.wishes.quality.said()),
        gouge(share_mm(widened ? 0.5 : kGougeShare, total)),
        scallop(share_mm(widened ? 0.8 : kScallopShare, total)),
        left(share_mm(widened ? 0.8 : kLeftShare, total)),
        chord(share_mm(kChordShare, total)) {}
  /// Of an operation that leaves stock: so many T, and no more than its stock bears.
  [[nodiscard]] double ahead(double share, double allowance) const {
    return std::min(share_mm(share, total), std::max(share * kUsualTolerance / 1000, 0.6 * allowance));
  }

  double total;
  bool widened;
  double gouge, scallop, left, chord;
};

/// What finishing takes of the tolerance.
std::vector<std::pair<const char*, double>> shares_of(Route route) {
  if (route == Route::finger) return {{"gouge_tolerance", kGougeShare}, {"chord_tolerance", kFingerChordShare}};
  return {{"gouge_tolerance", kGougeShare},
          route == Route::line ? std::pair("left", kLeftShare) : std::pair("scallop", kScallopShare),
          {"chord_tolerance", kChordShare}};
}

std::string face_operations(const Draft& draft) {
  Operations all(draft);
  const Tolerances t(draft);
  const double m = draft.wishes.at(Quantity::module);
  if (draft.has_first) all.rough(draft.first, 0.1 * m, "in layers");
  all.rough(draft.second, 0.07 * m,
            draft.has_first ? "rest material: knows what the operation before left" : "in layers");
  const double D = draft.second.diameter_mm;
  if (draft.wishes.route == Route::line) {
    for (const double share : {0.03, 0.01}) {
      all.begin("line_milling", draft.second, D, share > 0.02 ? "every flank in one pass along the tooth" : "");
      all.add("allowance", share * m);
      all.add("left", t.ahead(0.8, share * m), "largest misfit of the straight side");
    }
    all.begin("semi_finishing", draft.second, D);
    all.add("regions", "[\"fillet\", \"root\"]");
    all.add("scallop", t.ahead(2, 0.01 * m));
    all.add("allowance", 0.01 * m);
    all.begin("line_milling", draft.second, D, "without allowance it finishes");
    all.add("left", t.left);
    all.add("chord_tolerance", t.chord);
    all.begin("finishing", draft.second, D);
    all.add("regions", "[\"fillet\", \"root\"]");
    all.add("scallop", share_mm(1, t.total), "highest cusp between passes");
    all.add("chord_tolerance", t.chord);
    return all.text();
  }
  all.begin("semi_finishing", draft.second, D);
  all.add("scallop", t.ahead(1, 0.015 * m), "highest cusp between passes");
  all.add("allowance", 0.015 * m);
  all.begin("finishing", draft.second, D);
  all.add("scallop", t.scallop);
  all.add("chord_tolerance", t.chord, "largest sag of a straight block");
  return all.text();
}

std::string finger_operations(const Draft& draft) {
  Operations all(draft);
  const double wide = draft.second.shank_diameter_mm;
  all.begin("finger_roughing", draft.second, wide);
  all.add("ridge", 0.05 * draft.wishes.at(Quantity::module), "highest ridge left on the root between passes");
  all.begin("finger_finishing", draft.second, wide);
  all.add("chord_tolerance", share_mm(kFingerChordShare, Tolerances(draft).total), "largest sag of a straight block");
  return all.text();
}

std::string machine_table(const Draft& draft) {
  std::string text = "\n[machine]\n" + line("file", toml::quoted(draft.wishes.machine),
                                            "looked up beside this job, then among the installed machines");
  if (draft.assumed) {
    text += line("accept_assumed", "true", "values of it are assumed: every page says so");
    text += "# " + draft.assumed_words + "\n";
  }
  return text;
}

std::string shaping_text() {
  return "\n[shaping]\n" + line("cutting_speed", "20.0", "m/min") +
         line("speed_basis", "\"mean\"", "\"mean\" of the stroke or \"peak\"") +
         line("circular_feed", "0.1", "mm a double stroke, on the cutter's pitch circle") +
         line("radial_feed", "0.02", "mm a double stroke") + line("over_run", "2.5", "mm at each end of the face") +
         line("offset_reference", "\"outer_radius\"", "\"outer_radius\", \"mean_radius\" or a radius in mm");
}

}  // namespace

std::string gear_text(const std::string& name, const Wishes& wishes) {
  return fmt::format("schema = 1\nname = {}\n", toml::quoted(name)) +
         (wishes.gear == Gear::bevel_herringbone ? bevel_text(wishes)
          : is_cylindrical(wishes.gear)          ? cylindrical_text(wishes)
          : wishes.gear == Gear::straight_bevel  ? straight_bevel_text(wishes)
          : wishes.gear == Gear::spiral_bevel    ? spiral_bevel_text(wishes)
          : wishes.gear == Gear::flank_grid      ? flank_grid_text(wishes)
                                                 : face_text(wishes));
}

std::string job_text(const Draft& draft, const LibraryWords& library, const std::string& schema) {
  const bool finger = draft.wishes.gear == Gear::bevel_herringbone;
  std::string text = schema.empty() ? std::string() : fmt::format("#:schema {}\n", schema);
  text += "# Lengths in mm, angles in degrees, feeds in mm/min, speeds in 1/min. All keys: docs/job_reference.md.\n" +
          gear_text(draft.name, draft.wishes) + machine_table(draft);
  if (draft.wishes.route == Route::shaped) return text + shaping_text();
  text += "\n[setup]\n";
  text += line("origin", vector_text(draft.place.origin_mm), "gear frame in machine coordinates, all rotaries at zero");
  text += line("axis", draft.up ? "\"up\"" : "\"down\"",
               !draft.up                           ? "gear z points down: apex on top"
               : is_cylindrical(draft.wishes.gear) ? "the machine lays the axis down: the tool comes in radially"
                                                   : "teeth towards the spindle");
  text += line("work_offset", toml::quoted(draft.work_offset), "the program counts from it");
  text += line("work_offset_at", vector_text(draft.work_zero_mm),
               draft.zero_on_top ? "on the gear axis; Z 0 is the top of the blank" : "the origin of the gear");
  if (!draft.wishes.coolant.empty()) text += "\n[coolant]\n" + line("mode", toml::quoted(draft.wishes.coolant));
  text += material_text(draft.wishes.material);
  const auto tool = [&](const tool::ToolAssembly& t) {
    return library.file.empty() ? tool_text(t, draft.depth_mm) : library_tool_text(t, library);
  };
  if (draft.has_first) text += tool(draft.first);
  text += tool(draft.second);
  text += finger ? finger_operations(draft) : face_operations(draft);
  const Tolerances tolerance(draft);
  return text + "\n[verify]\n" +
         derivation(draft.wishes.quality, draft.wishes.at(Quantity::module), is_cylindrical(draft.wishes.gear),
                    shares_of(*draft.wishes.route)) +
         (tolerance.widened ? "# This control counts coarsely: gouge_tolerance, scallop and left are wider than that.\n"
                            : "") +
         line("gouge_tolerance", real(tolerance.gouge), "a program that may cut deeper is not written") +
         line("form_tolerance", real(tolerance_mm(draft.wishes.quality, draft.wishes.at(Quantity::module))),
              "T: report.html tells what of it is taken") +
         (draft.wishes.quality.iso_class
              ? line("iso_class", fmt::format("{}", *draft.wishes.quality.iso_class), "of ISO 1328-1")
              : std::string()) +
         line("teeth", "\"one\"", "or \"all\": every tooth space is walked through");
}

}  // namespace toothpath::proposal
