#include "app/fit/report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/base/units.h"
#include "app/report/svg/contact_pattern.h"
#include "app/report/svg/html_text.h"
#include "geometry/inspection/grid.h"
#include "geometry/modification/flank_correction.h"
#include "geometry/tooth_space/exact_space.h"
#include "geometry/tooth_space/modified_part.h"

namespace toothpath::fit {
namespace {

using Json = nlohmann::ordered_json;
using tooth_space::ToothSpace;

constexpr int kMapRows = 21, kMapColumns = 25;

std::string digits(double x) { return svg::short_number(x, 9); }
std::string with_unit(double x, const char* unit) { return *unit ? digits(x) + " " + unit : digits(x); }

std::string moves_text(const Row& row) {
  std::string text;
  for (const auto& [key, amount] : row.moves_with)
    text += fmt::format("{}{} by {}", text.empty() ? "" : ", ", key, svg::short_number(amount, 3));
  return text;
}

std::string remark(const Row& row) {
  switch (row.end) {
    case End::determined: return fmt::format("+- {}", svg::short_number(row.deviation, 2));
    case End::at_bound: return "at its bound";
    case End::held: return "held at its start: the points do not determine it";
  }
  return "";
}

std::string where(const Told& told, const PlacedPoint& at) {
  const SourcePosition& p = told.points.points[at.point].at;
  return fmt::format("line {}, flank {:+}", p.line, at.side);
}

/// (s, h) of a placed point.
Vec2 chart_place(const Told& told, const PlacedPoint& at) {
  const ToothSpace& space = *told.fitted.spaces[std::size_t(at.zone)];
  const auto q = space.point(tooth_space::flank_of(at.side), at.u, at.v);
  if (!q) return {NAN, NAN};
  const auto& outline = space.outline();
  return {outline.sign * outline.chart.along(q->p), outline.chart.up(q->p)};
}

/// Places all over a flank, in rows from the fillet to the tip.
struct FlankMap {
  std::vector<double> along, height;
  std::vector<modification::FlankDeviation> places;
};
FlankMap places_on(const ToothSpace& space, int side, const tooth_space::FlankRectangle& rectangle) {
  tooth_space::ToothedSolid solid;
  solid.rings = {{&space, 0}};
  const auto grid = inspection::inspection_grid(solid, {kMapRows, kMapColumns, 0});
  FlankMap out;
  const auto& outline = space.outline();
  for (const auto& at : grid ? *grid : std::vector<inspection::InspectionPoint>()) {
    if (at.side != side) continue;
    const Vec2 share = rectangle.share_at(space, at.p);
    out.along.push_back(outline.sign * outline.chart.along(at.p));
    out.height.push_back(outline.chart.up(at.p));
    out.places.push_back({at.row, at.column, share.y(), share.x(), 0});
  }
  return out;
}

/// The map of one flank, or why there is none.
page::StudyPage::Figure map_of(const Told& told, int zone, int side) {
  const Fitted& fitted = told.fitted;
  const ToothSpace& space = *fitted.spaces[std::size_t(zone)];
  const std::string name =
      fmt::format("Flank {:+}{}", side, fitted.spaces.size() > 1 ? fmt::format(", zone {}", zone) : "");
  std::vector<modification::ScatteredDeviation> points;
  const auto rectangle = tooth_space::flank_rectangle(space, side);
  double worst = 0;
  for (std::size_t i = 0; rectangle && i < fitted.placing.points.size(); ++i) {
    const PlacedPoint& at = fitted.placing.points[i];
    if (at.zone != zone || at.side != side) continue;
    const auto q = space.point(tooth_space::flank_of(side), at.u, at.v);
    if (!q) continue;
    const Vec2 share = rectangle->share_at(space, q->p);
    points.push_back({at.space, share.y(), share.x(), fitted.after_mm[i]});
    worst = std::max(worst, std::abs(fitted.after_mm[i]));
  }
  const FlankMap flank = rectangle ? places_on(space, side, *rectangle) : FlankMap{};
  if (points.empty() || flank.places.empty()) return {name, "", "No map: no points on this flank."};
  const auto field = modification::FlankCorrection::fit_scattered(points, flank.places, 1);
  if (!field) return {name, "", fmt::format("{} points, no map: {}.", points.size(), field.error().message)};
  svg::FlankFieldDrawing drawing;
  drawing.title = name + ", what remains";
  drawing.x_label = fmt::format("{} [mm]", space.outline().along);
  drawing.y_label = "height on the tooth [mm]";
  drawing.unit = "um";
  drawing.rows = kMapRows;
  drawing.columns = kMapColumns;
  drawing.x = flank.along;
  drawing.y = flank.height;
  for (const auto& place : flank.places)
    drawing.value.push_back(-app::um(field->field.at(place.theta, place.along_mm).value));
  return {name, svg::svg_flank_field(drawing),
          fmt::format("The smooth part of what {} points stand off the fitted flank, {} outside of it; one point at "
                      "most {:.2f} um.",
                      points.size(), svg::kAboveZero, app::um(worst))};
}

Json size_json(const Told& told, const Size& size, bool with_place) {
  Json json = {{"rms_um", app::um(size.rms_mm)}, {"worst_um", app::um(size.worst_mm)}};
  if (with_place) json["worst_line"] = told.points.points[told.fitted.placing.points[size.worst].point].at.line;
  return json;
}

std::vector<std::string> told_of_points(const Told& told) {
  const Placing& placing = told.fitted.placing;
  std::vector<std::string> out;
  if (placing.below_flanks)
    out.push_back(fmt::format("{} points lie below the end of their flank, in the fillet: they are left out",
                              placing.below_flanks));
  if (placing.beside)
    out.push_back(fmt::format("{} points lie where the gear has no flank: they are left out", placing.beside));
  for (const Row& row : told.fitted.rows) {
    if (row.end == End::held)
      out.push_back(
          row.moves_with.size() < 2
              ? fmt::format("{} is held at {}: it does not move the flanks at these points", row.key,
                            with_unit(row.start, row.unit))
              : fmt::format("{} is held at {}: at these points the flanks do not move when these go together: {}",
                            row.key, with_unit(row.start, row.unit), moves_text(row)));
    if (row.end == End::at_bound)
      out.push_back(fmt::format("{} ends at its bound, {}: wider bounds (--bounds {}=a:b), or another gear", row.key,
                                with_unit(row.value, row.unit), row.key));
  }
  for (const std::string& refusal : told.refused) out.push_back("the fitted gear cannot be cut: " + refusal);
  return out;
}

}  // namespace

Json fit_json(const Told& told) {
  const Fitted& f = told.fitted;
  Json rows = Json::array();
  for (const Row& row : f.rows) {
    Json json = {{"key", row.key},
                 {"unit", row.unit},
                 {"start", row.start},
                 {"value", row.value},
                 {"bounds", {row.low, row.high}},
                 {"end", to_string(row.end)}};
    json["deviation"] = row.end == End::determined ? Json(row.deviation) : Json(nullptr);
    if (row.end == End::held)
      for (const auto& [key, amount] : row.moves_with) json["moves_with"][key] = amount;
    rows.push_back(std::move(json));
  }
  Json follow = Json::object();
  for (const Number& n : f.numbers.follow) follow[n.key] = n.get(f.gear);
  return {{"schema", 1},
          {"command", "fit"},
          {"job", told.job.file},
          {"points", told.points.file},
          {"count", f.placing.points.size()},
          {"below_flanks", f.placing.below_flanks},
          {"beside_flanks", f.placing.beside},
          {"numbers", std::move(rows)},
          {"follow", std::move(follow)},
          {"before", size_json(told, f.before, false)},
          {"after", size_json(told, f.after, true)},
          {"steps", f.steps},
          {"notes", told_of_points(told)}};
}

std::string points_csv(const Told& told) {
  std::string out = "line,zone,flank,space,along,height,before_um,after_um\n";
  const Fitted& f = told.fitted;
  for (std::size_t i = 0; i < f.placing.points.size(); ++i) {
    const PlacedPoint& at = f.placing.points[i];
    const Vec2 place = chart_place(told, at);
    out += fmt::format("{},{},{},{},{:.6f},{:.6f},{},{:.5f}\n", told.points.points[at.point].at.line, at.zone, at.side,
                       at.space, place.x(), place.y(),
                       std::isnan(f.before_mm[i]) ? "" : fmt::format("{:.5f}", app::um(f.before_mm[i])),
                       app::um(f.after_mm[i]));
  }
  return out;
}

page::StudyPage fit_page(const Told& told) {
  const Fitted& f = told.fitted;
  page::StudyPage page;
  page.title = told.job.name + ": fitted to points";
  page.subtitle = fmt::format("{} on {}, {} points", told.points.file, told.job.file, f.placing.points.size());
  page.good = told.refused.empty();
  page.verdict = fmt::format("rms {} um, at most {} um", svg::short_number(app::um(f.after.rms_mm)),
                             svg::short_number(app::um(f.after.worst_mm)));
  page.introduction = {
      "The numbers of the gear that make the sum of the squared distances least, each distance along the normal of the "
      "exact flank. A standard deviation is that of the number when points scatter as they do about the fit.",
      "A number that the points do not determine beside the others keeps its start, and is named."};
  page::PageTable numbers{"Numbers of [gear]", {"number", "unit", "start", "from", "to", "fitted", "+-", ""}, {}, ""};
  for (const Row& row : f.rows)
    numbers.rows.push_back({row.key, row.unit, digits(row.start), digits(row.low), digits(row.high), digits(row.value),
                            row.end == End::determined ? svg::short_number(row.deviation, 2) : "",
                            row.end == End::determined ? "" : remark(row)});
  for (const Number& n : f.numbers.follow)
    numbers.rows.push_back(
        {n.key, n.unit, digits(n.get(told.job.gear)), "", "", digits(n.get(f.gear)), "", "follows the others"});
  page::PageTable sizes{"What the points stand off the flanks", {"", "rms um", "worst um", "at"}, {}, ""};
  sizes.rows.push_back(
      {"start", svg::short_number(app::um(f.before.rms_mm)), svg::short_number(app::um(f.before.worst_mm)), ""});
  sizes.rows.push_back({"fitted", svg::short_number(app::um(f.after.rms_mm)),
                        svg::short_number(app::um(f.after.worst_mm)), where(told, f.placing.points[f.after.worst])});
  for (const std::string& note : told_of_points(told)) page.introduction.push_back(note + ".");
  page.tables = {std::move(sizes), std::move(numbers)};
  for (std::size_t zone = 0; zone < f.spaces.size(); ++zone)
    for (const int side : {1, -1}) page.figures.push_back(map_of(told, int(zone), side));
  return page;
}

std::string fit_summary(const Told& told, const page::StudyPage& page) {
  std::string out = page.title + "\n";
  for (const auto& table : page.tables) out += "\n" + page::table_text(table);
  for (const std::string& note : told_of_points(told)) out += "  " + note + "\n";
  return out;
}

}  // namespace toothpath::fit
