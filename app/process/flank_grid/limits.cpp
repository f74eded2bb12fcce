#include "app/process/flank_grid/limits.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/process/ledger_sources.h"
#include "app/process/milled/ring_limits.h"
#include "geometry/base/json_text.h"

namespace toothpath::flank_grid {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLever = 1;  // mm, over which an angle of normals is told as a height

}  // namespace

std::string limits_json(const FlankGridGear& gear) {
  const GridSpace& space = gear.space();
  const GridQuality& q = gear.quality();
  const auto known = [](const std::optional<double>& x) { return x ? Json(*x) : Json(nullptr); };
  const Json points = {{"rows", gear.parameters().plus.rows},  {"columns", gear.parameters().plus.columns},
                       {"spacing_error", known(q.spacing_mm)}, {"going_on", q.going_on},
                       {"meridian_corners", q.corners_mm},     {"normals", known(q.normals_rad)}};
  const Json out = {{"schema", 1},
                    {"module", gear.module_mm()},
                    {"fillet_radius", gear.parameters().fillet_radius_mm},
                    {"points", points},
                    {"zones", Json::array({milled::ring_zone(space)})}};
  return json_text(out, 2) + "\n";
}

svg::LineChart limit_chart(const FlankGridGear& gear) {
  return milled::land_chart(
      gear.space(), [&](double s) { return root_land_mm(gear.space(), s); },
      "The root land lies between the two fillets, each of the radius of the ball that rolls there.");
}

std::vector<proof::LedgerEntry> point_ledger(const FlankGridGear& gear) {
  using proof::ErrorSource;
  const GridQuality& q = gear.quality();
  std::vector<proof::LedgerEntry> out;
  out.push_back(process::stated_entry(ErrorSource::point_spacing, q.spacing_mm,
                                      "every second row and column left out: how far its points lie beside the spline",
                                      "fewer than six rows or columns leave too few to compare with"));
  if (q.normals_rad)
    out.push_back(process::unmeasured(
        ErrorSource::given_normals, *q.normals_rad * kLever,
        fmt::format("{:.4f} mrad to the spline's at {}, over {:g} mm", 1e3 * *q.normals_rad, q.normals_at, kLever)));
  if (q.corners_mm > 0)
    out.push_back(process::unmeasured(
        ErrorSource::meridian_corners, q.corners_mm,
        fmt::format("the lines through the points of root and tip turn in rounded corners, at most this far beside "
                    "them: {}",
                    q.corners_at)));
  out.push_back({ErrorSource::continuation,
                 0,
                 {},
                 q.going_on > 0 ? fmt::format("no deviation: the flanks go on beyond their points by {:.2f} % ({:.4f} "
                                              "mm) at {}, limit {:.0f} %",
                                              100 * q.going_on, q.going_on_mm, q.going_on_at, 100 * kMostBeyond)
                                : std::string("the flanks end within their points"),
                 false});
  return out;
}

}  // namespace toothpath::flank_grid
