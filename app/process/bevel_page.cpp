#include "app/process/bevel_page.h"

#include <nlohmann/json.hpp>

#include "app/report/page/motion_charts.h"
#include "app/report/page/page_of_run.h"
#include "app/report/page/tool_body.h"
#include "geometry/base/angle.h"

namespace toothpath::process {
namespace {

constexpr std::string_view kRowAfterRidge = "  least clearance";

page::PageTable pass_table(const std::vector<finger::FingerPlan>& plans) {
  page::PageTable table{"Passes", {"op", "zone", "pass", "name", "direction", "length mm", "points"}, {}, "One tooth space; the convex side of a herringbone is one pass through both zones."};
  for (const auto& plan : plans)
    for (const auto& pass : plan.passes)
      table.rows.push_back({std::to_string(plan.path.operation), std::to_string(pass.half), std::to_string(pass.pass), pass.name,
                            pass.outward ? "outwards" : "inwards", fmt::format("{:.3f}", pass.length_mm), std::to_string(pass.points)});
  return table;
}

}  // namespace

page::ReportPage bevel_page(const job::Job& job, const bevel_gear::BevelGear& gear, const machines::Machine& machine, const report::RunReport& report,
                      const std::vector<finger::FingerPlan>& plans, const BevelProof* proof, std::string_view program) {
  std::vector<path::ClPath> paths;
  for (const auto& plan : plans) paths.push_back(plan.path);
  page::ReportPage page = page::page_of_run(job, report, paths, program);
  const auto& p = gear.parameters();
  page.subtitle = fmt::format("equal-base-circle bevel gear z {}, outer module {:g} mm, {}, pitch angle {:.4f} deg, {}", p.teeth,
                              p.outer_transverse_module_mm, gear.herringbone() ? "herringbone" : "single hand", degrees(gear.delta()),
                              report.machine_name);
  page.tools.clear();
  for (const auto& tool : job.tools) page.tools.push_back(page::page_finger_mill(gear, tool));
  if (!plans.empty()) page.tables.push_back(pass_table(plans));
  if (!proof) return page;
  page.surface = proof->result.walls;
  page.motion = page::motion_charts(proof->read, proof->motions, machine);
  for (std::size_t k = 0; k < paths.size(); ++k)
    page.paths[k].nc_lines = page::lines_of_records(paths[k], proof->motions, proof->path_tolerance_mm);
  const finger::RidgeResult& ridge = proof->result.ridge;
  if (ridge.points > 0)
    page.figures.push_back({"highest ridge", fmt::format("{:.4f}", ridge.reached_mm), "mm", fmt::format("asked {:.4f}", ridge.requested_mm),
                            ridge.reached_mm <= ridge.requested_mm ? page::KeyFigure::State::good : page::KeyFigure::State::bad});
  return page;
}

std::string with_bevel_keys(const std::string& json, const bevel_gear::BevelGear& gear, const std::vector<finger::FingerPlan>& plans, const BevelProof* proof) {
  auto j = nlohmann::ordered_json::parse(json);
  if (proof && proof->result.ridge.points > 0) {
    const finger::RidgeResult& ridge = proof->result.ridge;
    j["ridge_mm"] = {{"requested", ridge.requested_mm}, {"reached", ridge.reached_mm}, {"cone_distance", ridge.cone_distance_mm},
                     {"azimuth_deg", degrees(ridge.azimuth_rad)}};
  }
  if (proof && j.contains("tilt")) {
    j["tilt"]["lean_deg"] = 90 - degrees(gear.delta());
    j["tilt"]["simultaneous_axes"] = proof->moving.simultaneous;
    j["tilt"]["moving_axes"] = proof->moving.letters;
  }
  auto passes = nlohmann::ordered_json::array();
  for (const auto& plan : plans)
    for (const auto& pass : plan.passes)
      passes.push_back({{"op", plan.path.operation}, {"zone", pass.half}, {"pass", pass.pass}, {"name", pass.name}, {"length", pass.length_mm}, {"points", pass.points}});
  if (!plans.empty()) j["passes"] = std::move(passes);
  return j.dump(2) + "\n";
}

std::string bevel_summary(const report::RunReport& report, bool color, const BevelProof* proof) {
  std::string table = report::summary_table(report, color);
  if (!proof || proof->result.ridge.points == 0) return table;
  const std::string ridge = fmt::format("  {:<20}{:.4f} mm (asked {:.4f} mm)\n", "highest ridge", proof->result.ridge.reached_mm, proof->result.ridge.requested_mm);
  const auto after = table.find(kRowAfterRidge);
  return table.insert(after == std::string::npos ? table.size() : after, ridge);
}

}  // namespace toothpath::process
