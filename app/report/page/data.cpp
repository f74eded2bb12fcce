#include "app/report/page/data.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "app/report/page/packed_json.h"
#include "app/report/svg/html_text.h"
#include "geometry/base/json_text.h"

namespace toothpath::page {
namespace {

using nlohmann::json;

constexpr int kNormalSteps = 1023;  ///< of a component of a normal: finer is not seen
constexpr int kAxisSteps = 16383;   ///< of a component of a tool axis: 0.01 deg

json grid_json(const proof::SurfaceGrid& grid) {
  json fields = json::array();
  for (const auto& field : grid.excess_um)
    fields.push_back(pack_floats({std::vector<double>(field.begin(), field.end())}));
  json reachable;
  if (std::find(grid.reachable.begin(), grid.reachable.end(), 0) != grid.reachable.end()) {
    std::vector<double> flags;
    for (const unsigned char flag : grid.reachable) flags.push_back(flag != 0 ? 1 : 0);
    reachable = pack_floats({flags}, 1);
  }
  return {{"zone", grid.zone},
          {"patch", to_string(grid.patch)},
          {"rows", grid.rows},
          {"columns", grid.columns},
          {"points", pack_floats(columns_of(grid.points))},
          {"normals", pack_floats(columns_of(grid.normals), kNormalSteps)},
          {"fields", fields},
          {"reachable", reachable}};
}

json path_json(const ReportPage& page, const PagePath& path) {
  const std::vector<path::ClRecord>& records = path.cl.records;
  std::vector<Vec3> tips, axes;
  Columns marks(3), feed(1), lines(2);
  bool turning = false;
  for (const path::ClRecord& r : records) {
    tips.push_back(r.tip);
    axes.push_back(r.axis);
    turning = turning || r.axis != records.front().axis;
    marks[0].push_back(static_cast<double>(r.kind));
    marks[1].push_back(r.zone);
    marks[2].push_back(r.pass);
    feed[0].push_back(r.feed_mm_min);
  }
  for (const int line : path.nc_lines) {
    lines[0].push_back(line / kLineLow);
    lines[1].push_back(line % kLineLow);
  }
  json axis = json::array();
  if (turning) axis = pack_floats(columns_of(axes), kAxisSteps);
  else if (!axes.empty()) axis = {axes[0].x(), axes[0].y(), axes[0].z()};
  json out = {{"index", path.cl.operation},
              {"name", svg::valid_utf8(operation_name(page, path.cl.operation))},
              {"tool", page.tools.empty() ? -1 : path.cl.tool},
              {"tip", pack_floats(columns_of(tips))},
              {"axis", axis},
              {"feed", pack_floats(feed, 4095)},
              {"lines", nullptr}};
  json mark_list = json::array();
  for (const auto& mark : marks) mark_list.push_back(pack_integers(mark));
  out["marks"] = mark_list;
  if (!path.nc_lines.empty()) out["lines"] = json::array({pack_integers(lines[0]), pack_integers(lines[1])});
  return out;
}

json tool_json(const PageTool& tool) {
  json bodies = json::array();
  for (const PageToolBody& body : tool.bodies) {
    json profile = json::array();
    for (const Vec2& p : body.profile) profile.push_back({p.x(), p.y()});
    if (body.profile.size() >= 2)
      bodies.push_back({{"name", svg::valid_utf8(body.name)}, {"cutting", body.cutting}, {"profile", profile}});
  }
  return {{"name", svg::valid_utf8(tool.name)}, {"bodies", bodies}};
}

bool all_finite(const std::vector<Vec3>& points) {
  return std::all_of(points.begin(), points.end(), [](const Vec3& p) { return p.allFinite(); });
}

Status check_grid(const proof::SurfaceGrid& grid, std::size_t index) {
  if (grid.rows < 0 || grid.columns < 0)
    return fail("surface grid {} has {} rows and {} columns", index, grid.rows, grid.columns);
  const std::size_t n = static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.columns);
  if (grid.points.size() != n)
    return fail("surface grid {} has {} points, {} x {} expected", index, grid.points.size(), grid.rows, grid.columns);
  if (grid.normals.size() != n)
    return fail("surface grid {} has {} normals, {} expected", index, grid.normals.size(), n);
  if (!grid.reachable.empty() && grid.reachable.size() != n)
    return fail("surface grid {} has {} marks of reach, {} expected", index, grid.reachable.size(), n);
  for (const auto& field : grid.excess_um)
    if (field.size() != n) return fail("surface grid {} has a field of {} values, {} expected", index, field.size(), n);
  if (!all_finite(grid.points) || !all_finite(grid.normals))
    return fail("surface grid {} has a point or normal that is not finite", index);
  return Ok{};
}

Status check_path(const ReportPage& page, const PagePath& path) {
  const auto& cl = path.cl;
  if (!page.tools.empty() && (cl.tool < 0 || static_cast<std::size_t>(cl.tool) >= page.tools.size()))
    return fail("operation {} uses tool {}, there are {} tools", cl.operation, cl.tool, page.tools.size());
  if (!path.nc_lines.empty() && path.nc_lines.size() != cl.records.size())
    return fail("operation {} has {} NC lines for {} records", cl.operation, path.nc_lines.size(), cl.records.size());
  for (const path::ClRecord& r : cl.records) {
    if (!r.tip.allFinite() || !r.axis.allFinite())
      return fail("operation {} has a record that is not finite", cl.operation);
    if (r.zone < 0 || r.pass < 0 || r.zone >= kPackedSteps || r.pass >= kPackedSteps)
      return fail("operation {} has zone {} and pass {}, both must lie in 0 ... {}", cl.operation, r.zone, r.pass,
                  kPackedSteps - 1);
  }
  for (const int line : path.nc_lines)
    if (line < 0) return fail("operation {} has the NC line {}, below 0", cl.operation, line);
  return Ok{};
}

}  // namespace

Status check_report_page(const ReportPage& page) {
  for (std::size_t i = 0; i < page.surface.size(); ++i)
    if (auto status = check_grid(page.surface[i], i); !status) return status;
  for (const PagePath& path : page.paths)
    if (auto status = check_path(page, path); !status) return status;
  for (const PageTool& tool : page.tools)
    for (const PageToolBody& body : tool.bodies)
      for (const Vec2& p : body.profile)
        if (!p.allFinite() || p.x() < 0)
          return fail("tool \"{}\" has the radius {} mm in its profile", tool.name, p.x());
  if (page.gouge)
    for (const proof::WorstPlace& place : page.gouge->worst)
      if (!place.point.allFinite()) return fail("the gouge at NC line {} has a point that is not finite", place.line);
  return Ok{};
}

std::string operation_name(const ReportPage& page, int operation) {
  for (const PagePath& path : page.paths)
    if (path.cl.operation == operation && !path.cl.operation_type.empty()) {
      std::string type = path.cl.operation_type;
      std::replace(type.begin(), type.end(), '_', ' ');
      return fmt::format("{} {}", operation, type);
    }
  return fmt::format("operation {}", operation);
}

std::string report_data_json(const ReportPage& page) {
  json data = {{"title", svg::valid_utf8(page.title)},
               {"fields", json::array()},
               {"grids", json::array()},
               {"paths", json::array()},
               {"tools", json::array()},
               {"gouges", json::array()}};
  std::size_t fields = 0;
  for (const proof::SurfaceGrid& grid : page.surface) fields = std::max(fields, grid.excess_um.size());
  for (std::size_t k = 0; k < fields; ++k) {
    const int operation = k < page.paths.size() ? page.paths[k].cl.operation : static_cast<int>(k);
    data["fields"].push_back(svg::valid_utf8(operation_name(page, operation)));
  }
  for (const proof::SurfaceGrid& grid : page.surface)
    if (grid.rows > 1 && grid.columns > 1) data["grids"].push_back(grid_json(grid));
  for (const PagePath& path : page.paths)
    if (!path.cl.records.empty()) data["paths"].push_back(path_json(page, path));
  for (const PageTool& tool : page.tools) data["tools"].push_back(tool_json(tool));
  if (page.gouge)
    for (const proof::WorstPlace& place : page.gouge->worst)
      data["gouges"].push_back({{"point", {place.point.x(), place.point.y(), place.point.z()}},
                                {"operation", place.operation},
                                {"line", place.line},
                                {"text", svg::valid_utf8(fmt::format("{}, {}: {:.2f} \u00b5m, NC line {}", place.body,
                                                                     place.patch, place.depth_mm * 1e3, place.line))}});
  if (page.machine) data["machine"] = machine_scene_json(*page.machine);
  return svg::script_safe_json(json_text(data));
}

}  // namespace toothpath::page
