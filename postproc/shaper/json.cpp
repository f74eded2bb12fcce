#include <nlohmann/json.hpp>

#include "geometry/base/angle.h"
#include "postproc/shaper/sheet.h"

namespace toothpath::shaper {
namespace {

using Json = nlohmann::ordered_json;

Json ratio(machines::Ratio r) { return Json::array({r.numerator, r.denominator}); }
/// A number that is whole is written as one: 253, not 253.0.
Json plain(double value) {
  const auto whole = static_cast<std::int64_t>(value);
  return static_cast<double>(whole) == value ? Json(whole) : Json(value);
}

Json machine_json(const ShaperSetup& s) {
  Json steps = Json::array();
  for (const double n : s.machine.stroke_steps) steps.push_back(plain(n));
  Json json = {{"name", s.machine.name},
               {"file", s.machine_file},
               {"stroke_steps", steps},
               {"index_constant", ratio(s.machine.index_constant)},
               {"feed_constant", ratio(s.machine.feed_constant)},
               {"gears", s.machine.gears},
               {"mesh_margin", s.machine.mesh_margin},
               {"relief", s.machine.relief_mm}};
  json["dialect"] = s.machine.dialect;
  if (const auto& box = s.machine.gearbox) {
    json["gearbox"] = {{"cutter_axis", box->cutter_axis},
                       {"work_axis", box->work_axis},
                       {"relief_on", box->relief_on},
                       {"relief_off", box->relief_off}};
    if (box->pulses_per_turn > 0) json["gearbox"]["pulses_per_turn"] = box->pulses_per_turn;
  }
  return json;
}

Json passes_json(const ShaperSetup& s) {
  Json passes = Json::array();
  for (const auto& p : s.passes)
    passes.push_back({{"stroke", p.stroke},
                      {"x", p.x_mm},
                      {"depth", p.depth_mm},
                      {"minutes", p.minutes},
                      {"tooth_thickness", p.tooth_thickness_mm},
                      {"space_width", p.space_width_mm}});
  return passes;
}

Json feeds_json(const std::vector<FeedStudyRow>& study) {
  Json feeds = Json::array();
  for (const auto& f : study)
    feeds.push_back({{"circular_feed", f.circular_feed_mm},
                     {"minutes", f.minutes},
                     {"max_um", f.deviation.max_left_um},
                     {"rms_um", f.deviation.rms_um}});
  return feeds;
}

}  // namespace

std::string shaper_json(const ShaperSetup& s, const std::vector<FeedStudyRow>& study) {
  const bool mean = s.shaping.speed_basis == Shaping::SpeedBasis::mean;
  const Json json = {
      {"schema", 1},
      {"job", s.job_name},
      {"machine", machine_json(s)},
      {"assumed", s.machine.assumed_keys},
      {"cutter", {{"teeth", s.cutter_teeth}, {"pitch_diameter", s.pitch_diameter_mm}}},
      {"work",
       {{"teeth", s.work_teeth},
        {"inner_radius", s.inner_radius_mm},
        {"outer_radius", s.outer_radius_mm},
        {"depth", s.depth_mm}}},
      {"offset",
       {{"slide", s.slide_mm},
        {"reference", s.offset_reference_mm},
        {"angle_tan", degrees(s.angle_tan_rad)},
        {"angle_sin", degrees(s.angle_sin_rad)}}},
      {"stroke",
       {{"face", s.face_mm},
        {"over_run", s.shaping.over_run_mm},
        {"length", s.length_mm},
        {"start", s.start_mm},
        {"end", s.end_mm}}},
      {"speed",
       {{"cutting_speed", s.shaping.cutting_speed_m_min},
        {"basis", mean ? "mean" : "peak"},
        {"strokes_wanted", s.strokes_wanted},
        {"strokes_set", plain(s.strokes_set)},
        {"speed_mean", s.speed_mean_m_min},
        {"speed_peak", s.speed_peak_m_min}}},
      {"generating",
       {{"ratio", ratio(s.generating)},
        {"sense", s.sense},
        {"cutter_per_stroke", degrees(s.cutter_per_stroke_rad)},
        {"strokes_per_cutter_turn", s.strokes_per_cutter_turn},
        {"strokes_per_work_turn", s.strokes_per_work_turn}}},
      {"infeed", {{"depth", s.depth_mm}, {"per_stroke", s.infeed_per_stroke_mm}, {"strokes", s.strokes_infeed}}},
      {"index_gears",
       {{"constant", ratio(s.machine.index_constant)},
        {"target", ratio(s.index_target)},
        {"gears", s.index_gears.wheels}}},
      {"feed_gears",
       {{"constant", ratio(s.machine.feed_constant)},
        {"target", s.feed_target},
        {"gears", s.feed_gears.wheels},
        {"circular_feed", s.circular_feed_set_mm}}},
      {"time", {{"infeed", s.infeed_min}, {"generating", s.generating_min}, {"total", s.total_min()}}},
      {"program",
       {{"strokes_infeed", s.strokes_infeed},
        {"strokes_turn", s.strokes_turn},
        {"strokes_total", s.strokes_total()},
        {"relief", s.machine.relief_mm}}},
      {"inspection", {{"radius", s.inspection_radius_mm}, {"passes", passes_json(s)}}},
      {"back_stroke", {{"flank_clearance", s.relief.flank_mm}, {"stock_clearance", s.relief.stock_mm}}},
      {"feed_study", feeds_json(study)},
      {"warnings", s.warnings}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace toothpath::shaper
