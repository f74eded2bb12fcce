#include <cmath>
#include <nlohmann/json.hpp>

#include "app/base/units.h"
#include "app/report/run_report.h"
#include "app/report/svg/html_text.h"
#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"

namespace toothpath::report {
namespace {

using Json = nlohmann::ordered_json;

Json text_list(const std::vector<std::string>& texts) {
  Json list = Json::array();
  for (const auto& text : texts) list.push_back(svg::valid_utf8(text));
  return list;
}

Json vector_json(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json excess_json(const proof::ExcessResult& e, bool with_operation) {
  Json json;
  if (with_operation) json["op"] = e.operation;
  json["max"] = app::um(e.max_mm);
  json["min"] = app::um(e.min_mm);
  json["rms"] = app::um(e.rms_mm);
  json["bound"] = app::um(e.bound_mm);
  json["points"] = e.points;
  return json;
}

Json place_json(const proof::WorstPlace& place) {
  return {{"depth_um", app::um(place.depth_mm)},
          {"body", to_string(place.body)},
          {"patch", place.patch},
          {"op", place.operation},
          {"tooth", place.tooth},
          {"zone", place.zone},
          {"line", place.line},
          {"radius", place.radius_mm},
          {"height", place.height_mm},
          {"point", vector_json(place.point)}};
}

/// Programs that hold a part each; tools by T, minutes of each alone.
void add_parts(Json& json, const RunReport& r) {
  for (const PartReport& p : r.parts)
    json["parts"].push_back({{"file", p.file},
                             {"sha256", p.sha256},
                             {"bytes", p.bytes},
                             {"blocks", p.blocks},
                             {"name_on_control", p.name_on_control},
                             {"op", p.part.operation},
                             {"places", {p.part.first_place, p.part.end_place}},
                             {"tools", p.tools},
                             {"cutting_minutes", p.feed_minutes},
                             {"total_minutes", p.total_minutes}});
}

void add_correction_rows(Json& json, const RunReport& r) {
  if (!r.correction.empty()) {
    Json flanks = Json::array();
    for (const auto& c : r.correction)
      flanks.push_back({{"zone", c.zone},
                        {"side", c.side},
                        {"file", svg::valid_utf8(c.file)},
                        {"teeth", c.teeth},
                        {"profile_degree", c.fit.profile_degree},
                        {"lead_degree", c.fit.lead_degree},
                        {"measured_max_um", c.fit.measured_max_mm * 1000},
                        {"measured_rms_um", c.fit.measured_rms_mm * 1000},
                        {"residual_max_um", c.fit.residual_max_mm * 1000},
                        {"residual_rms_um", c.fit.residual_rms_mm * 1000}});
    json["correction"] = std::move(flanks);
  }
}

/// Pitch and run-out of a measured gear.
void add_index(Json& json, const inspection::IndexOfTeeth& index) {
  if (index.pitch.empty()) return;
  Json pitch = Json::array(), run_out = Json::array();
  for (const auto& p : index.pitch)
    pitch.push_back({{"zone", p.zone},
                     {"side", p.side},
                     {"radius", p.radius_mm},
                     {"teeth", p.teeth},
                     {"pairs", p.pairs},
                     {"complete", p.complete},
                     {"single_um", app::um(p.single_mm)},
                     {"tooth", p.single_tooth},
                     {"total_um", app::um(p.total_mm)}});
  for (const auto& r : index.run_out)
    run_out.push_back({{"zone", r.zone},
                       {"radius", r.radius_mm},
                       {"spaces", r.spaces},
                       {"complete", r.complete},
                       {"run_out_um", app::um(r.run_out_mm)}});
  json["pitch"] = std::move(pitch);
  json["run_out"] = std::move(run_out);
}

void add_correction(Json& json, const RunReport& r) {
  add_correction_rows(json, r);
  add_index(json, r.index);
}

void add_proof(Json& json, const RunReport& r) {
  add_parts(json, r);
  if (r.gouge) {
    json["gouge_um"] = {{"measured", app::um(r.gouge->measured_mm)},
                        {"bound", app::um(r.gouge->bound_mm)},
                        {"tolerance", app::um(r.gouge_tolerance_mm)}};
    const bool none_near = r.gouge->clearance_measured_mm >= r.gouge->clearance_followed_mm;
    json["clearance"] = {{"least", r.gouge->clearance_mm},
                         {"at_least", r.gouge->clearance_at_least()},
                         {"measured", none_near ? Json(nullptr) : Json(r.gouge->clearance_measured_mm)},
                         {"required", r.gouge->required_clearance_mm},
                         {"rapids_clear", r.gouge->rapids_clear}};
    Json worst = Json::array();
    for (const auto& place : r.gouge->worst) worst.push_back(place_json(place));
    json["worst_places"] = std::move(worst);
    json["deepest"] = place_json(r.gouge->deepest);
  } else if (r.conditions) {  // it was read: the axes leave their travels
    json["gouge_um"] = {{"measured", nullptr}, {"bound", nullptr}, {"tolerance", app::um(r.gouge_tolerance_mm)}};
  }
  if (!r.excess.empty() || r.finished) {
    Json excess;
    excess["operations"] = Json::array();
    for (const auto& e : r.excess) excess["operations"].push_back(excess_json(e, true));
    if (r.finished) excess["finished"] = excess_json(*r.finished, false);
    json["excess_um"] = std::move(excess);
  }
}

void add_findings(Json& json, const RunReport& r) {
  for (const Finding& f : r.findings)
    for (const auto& [name, detail] : f.details) {
      Json& at = json[f.key][name];
      std::visit([&](const auto& value) { at = value; }, detail);
    }
}

Json value_at(const readback::ValueAt& v) { return {{"value", v.value}, {"line", v.line}}; }

/// Feeds and speeds in mm/min, deg/min and 1/min.
void add_conditions(Json& json, const RunReport& r) {
  if (!r.conditions) return;
  Json all = {{"hash", !r.hash          ? "none"
                       : r.hash->fits() ? "fits"
                                        : "does not fit"},
              {"operations", Json::array()},
              {"axis_speed", Json::object()}};
  for (const auto& [operation, c] : r.conditions->operations) {
    Json entry = {{"op", operation}, {"tool", c.tool}};
    if (c.cut_mm_min.line > 0) entry["cut_feed"] = value_at(c.cut_mm_min);
    if (c.any_mm_min.line > 0) entry["feed"] = value_at(c.any_mm_min);
    if (c.least_rpm.line > 0) entry["least_speed"] = value_at(c.least_rpm);
    if (c.greatest_rpm.line > 0) entry["greatest_speed"] = value_at(c.greatest_rpm);
    entry["coolant"] = Json::array();
    for (const machines::Coolant coolant : machines::kCoolants)
      if (is_on(c.coolants, coolant)) entry["coolant"].push_back(to_string(coolant));
    all["operations"].push_back(std::move(entry));
  }
  for (std::size_t a = 0; a < r.axes.size() && a < r.conditions->axis_speed.size(); ++a)
    if (const readback::ValueAt& v = r.conditions->axis_speed[a]; v.line > 0)
      all["axis_speed"][std::string(1, r.axes[a].letter)] = value_at(v);
  if (r.conditions->shortest_ms.line > 0) all["shortest_block_ms"] = value_at(r.conditions->shortest_ms);
  json["conditions"] = std::move(all);
}

/// Of one tooth space.
void add_passes(Json& json, const RunReport& r) {
  for (const PassReport& p : r.passes) {
    Json pass = {{"op", p.operation}, {"zone", p.zone},        {"pass", p.pass},
                 {"name", p.name},    {"length", p.length_mm}, {"points", p.points}};
    if (p.side) {
      pass["flank"] = p.side->flank;
      pass["strip"] = p.side->strip;
      pass["misfit_um"] = app::um(p.side->misfit_mm);
    }
    json["passes"].push_back(std::move(pass));
  }
}

Json meeting_json(const clearance::MeshMeeting& m) {
  const bool inside = !std::isfinite(m.measured_mm);
  return {{"gap", std::max(m.gap_mm, 0.0)},
          {"touches", m.gap_mm <= 0},
          {"inside", inside},
          {"body", to_string(m.body)},
          {"rapid", m.rapid},
          {"op", m.operation},
          {"tooth", m.tooth},
          {"line", m.line},
          {"file", m.mesh},
          {"point", vector_json(m.place)}};
}

/// "fixture" and "stock": lengths in mm; "file" counts the files from 0.
void add_scene(Json& json, const RunReport& r) {
  for (const auto& v : r.scene) {
    Json entry = {{"meshes", Json::array()}, {"clear", v.clear()}, {"required", v.required_mm}, {"looked", v.look_mm}};
    for (const auto& m : v.meshes)
      entry["meshes"].push_back({{"file", svg::valid_utf8(m.file)},
                                 {"facets", m.facets},
                                 {"low", vector_json(m.low)},
                                 {"high", vector_json(m.high)},
                                 {"to_gear", m.to_gear_mm}});
    entry["clearance"] = v.nearest ? Json(std::max(v.nearest->gap_mm, 0.0)) : Json(nullptr);
    entry["nearest"] = v.nearest ? meeting_json(*v.nearest) : Json(nullptr);
    entry["worst"] = Json::array();
    for (const auto& m : v.worst) entry["worst"].push_back(meeting_json(m));
    entry["failed"] = v.failed;
    entry["motions"] = v.motions;
    entry["unjudged"] = v.unjudged;
    json[v.name] = std::move(entry);
  }
}

Json meeting_json(const bodies::Meeting& m) {
  Json out = {{"bodies", {svg::valid_utf8(m.first), svg::valid_utf8(m.second)}},
              {"clearance", m.proven_mm},
              {"measured", m.measured_mm},
              {"rapid", m.rapid},
              {"op", m.operation},
              {"tooth", m.tooth},
              {"tool", m.tool},
              {"line", m.line},
              {"linear", vector_json(m.joints.linear_mm)},
              {"rotary", {degrees(m.joints.rotary_rad[0]), degrees(m.joints.rotary_rad[1])}}};
  if (m.measured_mm <= 0) {
    out["depth"] = m.depth_mm;
    out["free_along"] = vector_json(m.direction);
  }
  return out;
}

/// "machine_moves": lengths in mm, angles in deg; "failed" has the first place of every pair that comes too near.
void add_machine_moves(Json& json, const RunReport& r) {
  if (!r.machine_moves) return;
  const bodies::MovesFound& found = *r.machine_moves;
  Json entry = {{"bodies", found.stated}};
  if (found.stated > 0) {
    entry["clear"] = found.clear();
    entry["required"] = found.required_mm;
    entry["looked"] = found.look_mm;
    entry["pairs"] = found.pairs;
    entry["moves"] = found.moves;
    entry["unjudged"] = found.unjudged;
    entry["bearing"] = found.bearing;
    entry["nearest"] = Json::array();
    for (const auto& m : found.nearest) entry["nearest"].push_back(meeting_json(m));
    entry["failed"] = Json::array();
    for (const auto& m : found.failed) entry["failed"].push_back(meeting_json(m));
  }
  json["machine_moves"] = std::move(entry);
}

void add_directions(Json& json, const RunReport& r) {
  if (r.directions.empty()) return;
  bool fixed = true;
  Json list = Json::array();
  for (const auto& d : r.directions) {
    fixed = fixed && d.fixed;
    Json entry = {{"op", d.operation},
                  {"zone", d.zone},
                  {"fixed", d.fixed},
                  {"axis", vector_json(d.axis)},
                  {"lean_deg", degrees(d.lean_rad)},
                  {"clearance", d.clearance_mm},
                  {"clearance_at_least", d.clearance_at_least},
                  {"explanation", svg::valid_utf8(d.explanation)}};
    if (!d.fixed && d.passes > 0) {
      entry["lean_from_pitch_normal_deg"] = {{"min", degrees(d.least_lean_rad)}, {"max", degrees(d.greatest_lean_rad)}};
      entry["turn_deg_per_mm"] = degrees(d.greatest_turn_rad_per_mm);
      entry["turning_passes"] = d.turning_passes;
      entry["passes"] = d.passes;
    }
    list.push_back(std::move(entry));
  }
  json["tilt"] = {{"mode", fixed ? "fixed" : "simultaneous"}, {"directions", std::move(list)}};
}

void add_axes(Json& json, const RunReport& r) {
  Json axes = Json::object();
  for (const auto& axis : r.axes) {
    const double f = axis.rotary ? degrees(1.0) : 1.0;
    Json& entry = axes[std::string(1, axis.letter)];
    entry = {{"min", axis.min * f}, {"max", axis.max * f}, {"unit", axis.rotary ? "deg" : "mm"}};
    if (axis.endless()) entry["rolls_over"] = true;
    else entry["limit"] = {axis.lower_limit * f, axis.upper_limit * f};
  }
  json["axes"] = std::move(axes);
  if (r.poles)
    json["poles"] = {{"passages_per_tooth", r.poles->passages},
                     {"option", r.poles->option},
                     {"axis_change_deg", degrees(r.poles->axis_rad)},
                     {"tip_change_um", app::um(r.poles->tip_mm)}};
}

void add_block_times(Json& json, const RunReport& r) {
  if (!r.block_times) return;
  const BlockTimes& t = *r.block_times;
  Json bins = Json::array(), ruled = Json::object();
  for (std::size_t i = 0; i < t.counts.size(); ++i)
    bins.push_back(
        {{"from", std::pow(10.0, t.from_log_ms + t.step_log_ms * static_cast<double>(i))}, {"blocks", t.counts[i]}});
  for (const auto& [what, blocks] : t.ruled) ruled[what] = blocks;
  json["block_time_ms"] = {
      {"least", t.least_ms}, {"median", t.median_ms}, {"ruled_by", std::move(ruled)}, {"histogram", std::move(bins)}};
}

/// What the side of a mill leaves by its form, beside the operation that uses it.
void add_sides(Json& operations, const RunReport& r) {
  for (Json& operation : operations)
    for (const PassReport& p : r.passes) {
      if (!p.side || operation["op"] != p.operation) continue;
      operation["misfit_um"] = std::max(operation.value("misfit_um", 0.0), app::um(p.side->misfit_mm));
      operation["strips"] = std::max(operation.value("strips", 0), p.side->strip + 1);
      operation["rotaries"] = p.side->rotaries;
    }
}

/// What each way of cutting a flank takes, beside the operation that cuts it.
void add_ways(Json& operations, const RunReport& r) {
  for (Json& operation : operations)
    for (const FlankWaysReport& w : r.flank_ways) {
      if (operation["op"] != w.operation) continue;
      Json way = {
          {"zone", w.zone}, {"flank", w.flank}, {"taken", w.by_ball ? "ball" : "side"}, {"tried", Json::array()}};
      for (const auto& t : w.tried)
        way["tried"].push_back({{"strips", t.strips}, {"left_um", app::um(t.left_mm)}, {"more", t.more}});
      if (!w.tried.empty()) way["side_minutes"] = w.side_minutes;
      way["ball_passes"] = w.ball_passes;
      way["ball_minutes"] = w.ball_minutes;
      if (!w.refused.empty()) way["refused"] = svg::valid_utf8(w.refused);
      operation["ways"].push_back(std::move(way));
    }
}

/// What is not computed is null, with the reason beside it.
void add_cutting(Json& operation, const CuttingLoad& c) {
  for (const char* key : {"force_n", "deflection_um", "compliance_um_n", "chip_um"}) operation[key] = nullptr;
  if (c.compliance) operation["compliance_um_n"] = app::um(c.compliance->total());
  if (!c.load) {
    operation["force_note"] = c.not_computed;
    return;
  }
  operation["force_n"] = c.load->force_N;
  operation["deflection_um"] = app::um(c.load->deflection_mm);
  operation["chip_um"] = app::um(c.load->chip_mm);
  operation["mean_chip_um"] = app::um(c.load->mean_chip_mm);
  operation["engagement_deg"] = degrees(c.load->engaged_rad);
  operation["torque_nm"] = c.load->torque_Nm;
  operation["power_w"] = c.load->power_W;
  operation["force_uncertainty"] = c.load->uncertainty;
  operation["slender"] = c.slender;
}

void add_engagement(Json& json, const RunReport& r) {
  for (const EngagementReport& t : r.engagement) {
    if (t.way_mm.empty()) continue;
    const auto [slow, fast] = std::minmax_element(t.feed_mm_min.begin(), t.feed_mm_min.end());
    json["engagement"].push_back(
        {{"op", t.operation},
         {"engaged_deg", degrees(*std::max_element(t.engaged_rad.begin(), t.engaged_rad.end()))},
         {"beside_deg", degrees(t.beside_rad)},
         {"step_over", t.step_over_mm},
         {"chip_um", app::um(*std::max_element(t.chip_mm.begin(), t.chip_mm.end()))},
         {"least_feed", *slow},
         {"most_feed", *fast}});
  }
}

void add_motion(Json& json, const RunReport& r) {
  if (r.operations.empty()) return;
  json["cl_points"] = r.cl_points;
  json["blocks"] = r.blocks;
  json["cutting_minutes"] = r.feed_minutes;
  json["total_minutes"] = r.total_minutes;
  if (r.tool_change_minutes) json["tool_change_minutes"] = *r.tool_change_minutes;
  Json operations = Json::array();
  for (const auto& o : r.operations) {
    operations.push_back({{"op", o.operation},
                          {"type", o.type},
                          {"tool", o.tool_number},
                          {"speed", o.speed_rpm},
                          {"feed", o.feed_mm_min},
                          {"cl_points", o.cl_points},
                          {"cutting_minutes", o.feed_minutes},
                          {"rapid_minutes", o.rapid_minutes},
                          {"minutes", o.minutes()}});
    if (o.places) operations.back()["places"] = {o.places->first, o.places->second};
    if (o.cutting) add_cutting(operations.back(), *o.cutting);
  }
  add_sides(operations, r);
  add_ways(operations, r);
  json["operations"] = std::move(operations);
  if (r.tooth_stride != 1) json["tooth_order"] = {{"order", "spread"}, {"stride", r.tooth_stride}, {"teeth", r.teeth}};
  for (const joints::ToolUse& use : r.tool_uses) {
    Json entry = {{"tool", use.tool}, {"life", use.life_min}, {"minutes", use.minutes()}, {"stretches", Json::array()}};
    if (use.sister_of != 0) entry["sister_of"] = use.sister_of;
    for (const auto& s : use.stretches)
      entry["stretches"].push_back(
          {{"op", s.operation}, {"places", {s.first_place, s.end_place}}, {"minutes", s.minutes}});
    json["tool_life"].push_back(std::move(entry));
  }
  for (const ToolCheckUse& use : r.tool_checks)
    json["tool_checks"].push_back({{"tool", use.tool}, {"checks", use.checks}, {"tolerance", use.tolerance_mm}});
  if (r.restart) json["restart"] = {{"op", r.restart->operation}, {"tooth", r.restart->tooth}};
  Json tolerances = Json::array();
  for (const auto& t : r.length_tolerances) {
    tolerances.push_back({{"op", t.operation},
                          {"tool", t.tool_number},
                          {"share", t.share},
                          {"flank_share", t.flank_share},
                          {"too_long_um", t.too_long_mm * 1000}});
    if (t.too_short_mm) tolerances.back()["too_short_um"] = *t.too_short_mm * 1000;
  }
  if (!tolerances.empty()) json["length_tolerance"] = std::move(tolerances);
  add_axes(json, r);
  json["acceleration_in_times"] = r.has_acceleration;
  json["times"] = times_text(r);
  if (r.travel_room) {
    const choice::TravelOffer& offer = r.travel_room->offer;
    json["travel_room"] = {{"now", offer.room_now_mm},
                           {"most", offer.room_then_mm},
                           {"origin", vector_json(r.travel_room->origin_mm)},
                           {"work_offset_at", vector_json(r.travel_room->work_offset_at_mm)},
                           {"on_index_axis", offer.on_index_axis},
                           {"riser", offer.shift_mm.z()}};
  }
  add_block_times(json, r);
}

void add_solid(Json& json, const RunReport& r) {
  if (r.cad)
    json["solid"] = {{"file", r.cad->file},
                     {"faces", r.cad->faces},
                     {"patches", r.cad->patches},
                     {"bytes", r.cad->bytes},
                     {"places_checked", r.cad->checked},
                     {"worst_deviation_um", r.cad->worst_mm * 1000},
                     {"most_deviation_um", r.cad->asked_mm * 1000},
                     {"worst_at", r.cad->worst_at}};
  if (r.roughed)
    json["roughed"] = {{"file", r.roughed->file},
                       {"triangles", r.roughed->triangles},
                       {"bytes", r.roughed->bytes},
                       {"cell_mm", r.roughed->cell_mm},
                       {"too_thick_mm", r.roughed->thick_mm}};
}

Json most_json(const tooth_space::ModifiedForm::Most& most, const char* key, double scale) {
  return {{key, most.value * scale}, {"side", most.side}, {"r", most.radius_mm}, {"z", most.height_mm}};
}

Json modifications_json(const ModifiedFlanks& modified) {
  Json list = Json::array(), zones = Json::array();
  for (const auto& m : modified.list) {
    Json one = {{"kind", to_string(m.kind)}, {"flank", to_string(m.flanks)}};
    if (!m.grid) one["amount_um"] = m.amount_mm * 1000;
    if (modification::is_relief(m.kind)) {
      one["length_mm"] = m.length_mm;
      one["law"] = to_string(m.law);
    }
    if (m.kind == modification::Kind::end_relief) one["end"] = to_string(m.ends);
    if (m.zone) one["zone"] = *m.zone;
    list.push_back(std::move(one));
  }
  for (const auto& z : modified.zones) {
    const tooth_space::ModifiedForm& f = z.form;
    Json one = {{"zone", z.zone},
                {"most_removed", most_json(f.removed_mm, "um", 1000)},
                {"most_turned", most_json(f.turned_rad, "mrad", 1000)},
                {"least_land", {{"mm", f.land_mm.value}, {"r", f.land_mm.radius_mm}, {"plain_mm", f.plain_land_mm}}}};
    if (std::isfinite(f.hollow_flank.value)) one["hollow_flank"] = most_json(f.hollow_flank, "radius_mm", 1);
    if (std::isfinite(f.hollow_fillet.value)) {
      one["hollow_fillet"] = most_json(f.hollow_fillet, "radius_mm", 1);
      one["hollow_fillet"]["plain_mm"] = f.plain_hollow_fillet_mm;
    }
    zones.push_back(std::move(one));
  }
  Json out = {{"list", std::move(list)}, {"zones", std::move(zones)}};
  if (modified.walls) {
    const bevel_gear::ModifiedForm& f = *modified.walls;
    out["walls"] = {{"profile_um", f.profile_mm * 1000}, {"profile_turned_mrad", f.profile_turned_rad * 1000},
                    {"lead_um", f.lead_mm * 1000},       {"lead_turned_mrad", f.lead_turned_rad * 1000},
                    {"top_land_mm", f.top_land_mm},      {"plain_top_land_mm", f.plain_top_land_mm}};
  }
  return out;
}

}  // namespace

double ModifiedFlanks::most_removed_mm() const {
  double most = 0;
  for (const Zone& z : zones) most = std::max(most, z.form.removed_mm.value);
  return walls ? walls->profile_mm + walls->lead_mm : most;
}

std::string report_json(const RunReport& r) {
  Json json;
  json["schema"] = 1;
  json["command"] = r.command;
  json["job"] = svg::valid_utf8(r.job_name);
  json["job_file"] = svg::valid_utf8(r.job_file);
  const bool proves = r.command != "surface";
  if (proves) {
    json["verified"] = r.verified;
    json["verdict"] = verdict_text(r);
    json["reasons"] = text_list(r.reasons);
    if (!r.would_help.empty()) json["would_help"] = text_list(r.would_help);
    json["machine"] = {
        {"name", svg::valid_utf8(r.machine_name)}, {"file", svg::valid_utf8(r.machine_file)}, {"dialect", r.dialect}};
  }
  if (!r.program_file.empty())
    json["program"] = {
        {"file", r.program_file}, {"sha256", r.program_sha256}, {"bytes", r.program_bytes}, {"blocks", r.blocks}};
  add_proof(json, r);
  add_scene(json, r);
  add_machine_moves(json, r);
  add_motion(json, r);
  add_engagement(json, r);
  add_directions(json, r);
  add_findings(json, r);
  add_conditions(json, r);
  add_passes(json, r);
  if (proves) {
    Json ledger = Json::object();
    for (const auto& entry : r.ledger) {
      Json& source = ledger[to_string(entry.source)];
      source = {{"predicted", entry.predicted_um}, {"measured", entry.measured_um.value_or(0)}};
      if (!entry.measured_um) source["model_only"] = true;
      if (!entry.counted) source["counted"] = false;
      if (!entry.note.empty()) source["note"] = entry.note;
    }
    json["ledger"] = std::move(ledger);
    json["assumed"] = text_list(r.assumed);
  }
  if (r.modified) json["modifications"] = modifications_json(*r.modified);
  add_correction(json, r);
  add_solid(json, r);
  json["warnings"] = text_list(r.warnings);
  json["files"] = text_list(r.files);
  Json stages = Json::object();
  for (const auto& [name, seconds] : r.stages) stages[name] = seconds;
  json["stages"] = std::move(stages);
  return json_text(json, 2) + "\n";
}

}  // namespace toothpath::report
