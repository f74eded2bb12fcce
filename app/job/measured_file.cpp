#include "app/job/measured_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/base/units.h"
#include "app/job/measured_points.h"
#include "app/report/svg/html_text.h"
#include "geometry/base/json_text.h"
#include "geometry/base/printable.h"
#include "geometry/face_gear/part.h"
#include "geometry/inspection/table_text.h"
#include "machines/toml/input_text.h"

namespace toothpath::job {
namespace {

constexpr std::string_view kHeader = "zone,flank,row,column,x,y,z,i,j,k,deviation_um";
constexpr std::size_t kMeasuredColumns = 11, kMostMeasuredBytes = 64u << 20;
constexpr double kPlaceTolerance = 0.005;  // mm

template <typename... Args>
Diagnostic at(const std::string& file, int line, std::size_t column, fmt::format_string<Args...> text, Args&&... args) {
  Diagnostic d = fail(text, std::forward<Args>(args)...);
  d.position = {file, line, static_cast<int>(column) + 1};
  return d;
}

constexpr std::array<std::string_view, kMeasuredColumns> kNames = {"zone", "flank", "row", "column", "x",           "y",
                                                                   "z",    "i",     "j",   "k",      "deviation_um"};

struct Line {
  int number = 0;
  std::array<std::size_t, kMeasuredColumns> column{};  ///< where its cells begin, from 0
  int zone = 0, side = 1, row = 0, place = 0;          ///< place: along the face
  Vec3 p = Vec3::Zero();
  double deviation_um = 0;
};

bool parse_whole(std::string_view text, int& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

Result<Line> parse_line(const std::vector<inspection::TableCell>& cells, int number, const std::string& file,
                        bool walls) {
  Line line;
  line.number = number;
  if (cells.size() != kMeasuredColumns)
    return at(file, number, 0, "{} columns, must be {}: {}", cells.size(), kMeasuredColumns, kHeader);
  for (std::size_t k = 0; k < kMeasuredColumns; ++k) line.column[k] = static_cast<std::size_t>(cells[k].column) - 1;
  if (walls && cells[1].text != "L" && cells[1].text != "U")
    return at(file, number, line.column[1], "flank = \"{}\" must be L or U", printable(cells[1].text));
  if (walls) line.side = cells[1].text == "L" ? 1 : -1;
  std::array<int*, 4> whole = {&line.zone, &line.side, &line.row, &line.place};
  for (std::size_t k = 0; k < 4; ++k)
    if (!(walls && k == 1) &&
        (!parse_whole(cells[k].text, *whole[k]) || (k != 1 && (*whole[k] < 0 || *whole[k] > 999))))
      return at(file, number, line.column[k], "{} = \"{}\" is no whole number from 0 to 999", kNames[k],
                printable(cells[k].text));
  if (line.side != 1 && line.side != -1)
    return at(file, number, line.column[1], "flank = {} must be 1 or -1", line.side);
  double normal = 0;
  for (std::size_t k = 4; k < kMeasuredColumns; ++k) {
    double& value = k < 7 ? line.p[Eigen::Index(k) - 4] : k < 10 ? normal : line.deviation_um;
    if (!inspection::read_cell(cells[k].text, value))
      return at(file, number, line.column[k], "{} = \"{}\" is no finite number", kNames[k], printable(cells[k].text));
  }
  return line;
}

/// The places of the file against the nominal ones; another unit shows as one common factor.
std::optional<Diagnostic> compare_places(const std::string& file, const std::vector<const Line*>& lines,
                                         const std::vector<inspection::InspectionPoint>& grid) {
  double pg = 0, gg = 0;
  for (std::size_t k = 0; k < grid.size(); ++k) {
    pg += lines[k]->p.dot(grid[k].p);
    gg += grid[k].p.squaredNorm();
  }
  const double scale = pg / gg;
  struct Unit {
    double factor;
    const char* name;
  };
  for (const Unit unit : {Unit{25.4, "25.4 times too large: an inch file was multiplied twice"},
                          Unit{1 / 25.4, "25.4 times too small: in inch"}, Unit{1000, "1000 times too large: in um"},
                          Unit{1e-3, "1000 times too small: in m"}})
    if (std::abs(scale / unit.factor - 1) < 1e-3)
      return at(file, lines[0]->number, lines[0]->column[4],
                "x, y, z are those of the inspection grid, but {}; mm are needed", unit.name);
  for (std::size_t k = 0; k < grid.size(); ++k) {
    const double off = (lines[k]->p - grid[k].p).norm();
    if (off > kPlaceTolerance)
      return at(file, lines[k]->number, lines[k]->column[4],
                "zone {}, flank {}, row {}, column {} lies {:.4f} mm off the nominal point ({:.4f}, {:.4f}, {:.4f}), "
                "at most {} mm: the grid of another job, gear frame or tooth",
                grid[k].zone, grid[k].side, grid[k].row, grid[k].column, off, grid[k].p.x(), grid[k].p.y(),
                grid[k].p.z(), kPlaceTolerance);
  }
  return {};
}

std::optional<Diagnostic> check_sizes(const std::string& file, const std::vector<const Line*>& lines) {
  const Line* largest = lines[0];
  for (const Line* line : lines)
    if (std::abs(line->deviation_um) > std::abs(largest->deviation_um)) largest = line;
  const double size = std::abs(largest->deviation_um);
  if (size > kLargestDeviationUm)
    return at(file, largest->number, largest->column[10],
              "deviation_um = {:.10g} exceeds {:g} um: is it in nm (1000 times) or in millionths of an inch (39.37 "
              "times)? More than {:g} um is no correction",
              largest->deviation_um, kLargestDeviationUm, kLargestDeviationUm);
  if (size < kLeastDeviationUm)
    return at(file, largest->number, largest->column[10],
              "deviation_um reaches {:.10g} only, below {:g} um: is it in mm (1000 times) or inch (25400 times)? So "
              "little needs no correction",
              size, kLeastDeviationUm);
  return {};
}

/// Flanks of a face gear are counted by roll angle and radius.
GridOfGear grid_of(const face_gear::FaceGear& gear) {
  return {gear.rings().size(),
          false,
          [&gear](int rows, int columns) {
            return inspection::inspection_grid(drawn_solid(gear), {rows, columns});
          },
          [](const inspection::InspectionPoint& at) { return Vec2(radius(at.p), -at.theta); },
          [&gear](int zone) { return -gear.rings()[std::size_t(zone)].surface.shaper.theta_t; },
          drawn_solid(gear)};
}

}  // namespace

Result<MeasuredFlanks> parse_measured(std::string_view text, const std::string& file, const face_gear::FaceGear& gear) {
  return parse_measured(text, file, grid_of(gear));
}

Result<MeasuredFlanks> parse_measured(std::string_view text, const std::string& file, const GridOfGear& gear) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  std::vector<Line> lines;
  int number = 0;
  bool headed = false;
  while (!text.empty()) {
    const auto [row, at_line] = inspection::take_line(text, number);
    number = at_line;
    if (!headed) {
      if (inspection::is_separator_line(row)) continue;
      if (!inspection::names_columns(row, kHeader))
        return at(file, number, 0, "the header is \"{}\", must be \"{}\"", printable(row.substr(0, 120)), kHeader);
      headed = true;
      continue;
    }
    const auto cells = inspection::number_cells(row);
    if (cells.empty()) continue;
    auto line = parse_line(cells, number, file, gear.walls);
    if (!line) return line.error();
    lines.push_back(*line);
  }
  if (lines.empty())
    return at(file, std::max(number, 1), 0, "no measured point; one line for each point of inspection.csv is needed");
  inspection::InspectionOptions options{0, 0};
  for (const Line& line : lines) {
    options.rows = std::max(options.rows, line.row + 1);
    options.columns = std::max(options.columns, line.place + 1);
  }
  auto grid = gear.nominal(options.rows, options.columns);
  if (!grid) return at(file, lines.back().number, 0, "wrong grid: {}", grid.error().message);
  std::vector<const Line*> placed(grid->size(), nullptr);
  for (const Line& line : lines) {
    if (std::size_t(line.zone) >= gear.zones)
      return at(file, line.number, line.column[0], "zone = {}, the gear has zones 0 .. {}", line.zone, gear.zones - 1);
    const std::size_t k =
        ((std::size_t(line.zone) * 2 + (line.side > 0 ? 0 : 1)) * std::size_t(options.rows) + std::size_t(line.row)) *
            std::size_t(options.columns) +
        std::size_t(line.place);
    if (placed[k])
      return at(file, line.number, 0, "zone {}, flank {}, row {}, column {} stands in line {} already", line.zone,
                line.side, line.row, line.place, placed[k]->number);
    placed[k] = &line;
  }
  for (std::size_t k = 0; k < placed.size(); ++k)
    if (!placed[k])
      return at(file, number, 0, "wrong grid: zone {}, flank {}, row {}, column {} is missing of {} rows x {} columns",
                (*grid)[k].zone, (*grid)[k].side, (*grid)[k].row, (*grid)[k].column, options.rows, options.columns);
  if (auto off = compare_places(file, placed, *grid)) return *off;
  if (auto size = check_sizes(file, placed)) return *size;
  MeasuredFlanks measured{file, std::move(*grid), {}};
  for (const Line* line : placed) measured.deviation_mm.push_back(line->deviation_um / 1000);
  return measured;
}

namespace {

/// Each grid was taken on a gear cut with the corrections of all before it, so their deviations add up.
Result<FittedCorrection> fit_grids(const std::vector<MeasuredFlanks>& grids, const GridOfGear& gear) {
  const auto& points = grids.front().points;
  for (const auto& grid : grids)
    if (grid.points.size() != points.size())
      return at(grid.file, 1, 0, "{} points, but {} has {}: all measurements need the same grid", grid.points.size(),
                grids.front().file, points.size());
  FittedCorrection out;
  out.grid = points;
  for (int zone = 0; zone < static_cast<int>(gear.zones); ++zone) {
    modification::RingCorrection ring;
    for (const int side : {1, -1}) {
      // The field counts down the profile: its roll parameter is the height with the other sign.
      std::vector<modification::FlankDeviation> flank;
      for (std::size_t k = 0; k < points.size(); ++k) {
        if (points[k].zone != zone || points[k].side != side) continue;
        double sum = 0;
        for (const auto& grid : grids) sum += grid.deviation_mm[k];
        const Vec2 place = gear.place(points[k]);
        flank.push_back({points[k].row, points[k].column, -place.y(), place.x(), sum});
      }
      auto fit = modification::FlankCorrection::fit(flank, -gear.foot(zone));
      if (!fit) return at(grids.front().file, 1, 0, "zone {}, flank {:+}: {}", zone, side, fit.error().message);
      out.flanks.push_back({zone, side, grids.back().file, 1, fit->residual()});
      (side > 0 ? ring.plus : ring.minus) = std::move(*fit);
    }
    out.rings.push_back(std::make_shared<modification::RingCorrection>(std::move(ring)));
  }
  return out;
}

/// The second of two corrections on top of the first.
void add(FittedCorrection& sum, FittedCorrection more) {
  for (std::size_t k = 0; k < more.rings.size(); ++k)
    if (k < sum.rings.size())
      sum.rings[k] = std::make_shared<modification::RingCorrection>(modification::RingCorrection{
          sum.rings[k]->plus.plus(more.rings[k]->plus), sum.rings[k]->minus.plus(more.rings[k]->minus)});
    else sum.rings.push_back(more.rings[k]);
  sum.flanks.insert(sum.flanks.end(), more.flanks.begin(), more.flanks.end());
  sum.warnings.insert(sum.warnings.end(), more.warnings.begin(), more.warnings.end());
  if (!more.index.pitch.empty()) sum.index = std::move(more.index);
}

}  // namespace

Result<FittedCorrection> fit_measured(const MeasuredInput& measured, const GridOfGear& gear) {
  std::vector<MeasuredFlanks> grids;
  std::vector<FittedCorrection> of_points;
  for (const auto& file : measured.files) {
    const auto text = toml::read_input_text(file, kMostMeasuredBytes);
    if (!text) return text.error();
    if (looks_like_grid(*text)) {
      if (measured.ball_diameter_mm)
        return at(file, 1, 0, "an inspection grid holds deviations: a ball's diameter is for files of points");
      auto grid = parse_measured(*text, file, gear);
      if (!grid) return grid.error();
      grids.push_back(std::move(*grid));
      continue;
    }
    if (!gear.solid)
      return at(file, 1, 0,
                "files of points are not put on this gear; the grid of inspection.csv with a column deviation_um is "
                "needed: \"{}\"",
                kHeader);
    const auto points = parse_measured_points(*text, file, *gear.solid, measured.ball_diameter_mm.value_or(0));
    if (!points) return points.error();
    auto fit = fit_points(gear, *points);
    if (!fit) return fit.error();
    of_points.push_back(std::move(*fit));
  }
  FittedCorrection out;
  if (!grids.empty()) {
    auto fit = fit_grids(grids, gear);
    if (!fit) return fit.error();
    out = std::move(*fit);
  }
  for (auto& fit : of_points) add(out, std::move(fit));
  return out;
}

Result<CorrectedGear> correct_gear(const face_gear::FaceGear& nominal, const MeasuredInput& measured) {
  auto fit = fit_measured(measured, grid_of(nominal));
  if (!fit) return fit.error();
  CorrectedGear corrected{nominal.corrected(fit->rings), std::move(*fit), measured.files, {}};
  corrected.grid = std::move(corrected.fit.grid);
  if (!corrected.grid.empty()) return corrected;
  auto grid = inspection::inspection_grid(drawn_solid(nominal));
  if (!grid) return grid.error();
  corrected.grid = std::move(*grid);
  return corrected;
}

std::string correction_json(const CorrectedGear& corrected) {
  const FittedCorrection& fit = corrected.fit;
  return correction_json(corrected.files, fit.flanks, corrected.grid, [&](const inspection::InspectionPoint& p) {
    return fit.rings[std::size_t(p.zone)]->side(p.side).at(p.theta, radius(p.p)).value;
  });
}

std::string correction_json(const std::vector<std::string>& measured, const std::vector<FittedFlank>& fitted,
                            const std::vector<inspection::InspectionPoint>& grid,
                            const std::function<double(const inspection::InspectionPoint&)>& offset_mm) {
  using Json = nlohmann::ordered_json;
  Json files = Json::array(), flanks = Json::array();
  for (const auto& file : measured) files.push_back(svg::valid_utf8(file));
  for (const auto& f : fitted) {
    Json offsets = Json::array();
    for (const auto& p : grid)
      if (p.zone == f.zone && p.side == f.side)
        offsets.push_back({{"row", p.row}, {"column", p.column}, {"offset_um", app::um(offset_mm(p))}});
    const auto& r = f.residual;
    flanks.push_back({{"zone", f.zone},
                      {"side", f.side},
                      {"file", svg::valid_utf8(f.file)},
                      {"teeth", f.teeth},
                      {"basis", "tensor Chebyshev"},
                      {"profile_degree", r.profile_degree},
                      {"lead_degree", r.lead_degree},
                      {"points", r.points},
                      {"measured_max_um", app::um(r.measured_max_mm)},
                      {"measured_rms_um", app::um(r.measured_rms_mm)},
                      {"residual_max_um", app::um(r.residual_max_mm)},
                      {"residual_rms_um", app::um(r.residual_rms_mm)},
                      {"target", std::move(offsets)}});
  }
  return json_text(Json{{"schema", 1}, {"measured", std::move(files)}, {"flanks", std::move(flanks)}}, 2) + "\n";
}

}  // namespace toothpath::job
