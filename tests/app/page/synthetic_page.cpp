#include "tests/app/page/synthetic_page.h"

#include "geometry/base/angle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace toothpath::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDepth = 5.6, kRootHalfWidth = 1.25, kFillet = 0.9, kFloor = -6.0;
constexpr double kBall = 1.0;  ///< radius of the finishing ball

struct Foot {
  Vec3 point, normal;
};

/// Cross section of the space in (across, up): a floor, two round corners, two walls that open upwards and bulge a
/// little. `t` in 0 ... 1 on each of five patches, from the left tip to the right.
Foot section(int patch, double t) {
  const double flare = 0.36;         // slope angle of the wall [rad]
  const auto wall = [&](double s) {  // s: height share above the fillet
    const double up = kFillet * (1 - std::sin(flare)) + s * (kDepth - kFillet);
    const double across =
        kRootHalfWidth + kFillet * std::cos(flare) + std::tan(flare) * s * (kDepth - kFillet) - 0.35 * s * (1 - s);
    const Vec2 slope(std::tan(flare) - 0.35 * (1 - 2 * s) / (kDepth - kFillet), 1);
    const Vec2 n = Vec2(-slope.y(), slope.x()).normalized();
    return Foot{{across, up, 0}, {n.x(), n.y(), 0}};
  };
  const auto corner = [&](double s) {  // from the floor to the wall
    const double angle = -kPi / 2 + s * (kPi / 2 - flare);
    const Vec2 out(std::cos(angle), std::sin(angle));
    return Foot{{kRootHalfWidth + kFillet * out.x(), kFillet + kFillet * out.y(), 0}, {-out.x(), -out.y(), 0}};
  };
  Foot f;
  switch (patch) {
    case 0: f = wall(1 - t); break;
    case 1: f = corner(1 - t); break;
    case 2: return {{kRootHalfWidth * (2 * t - 1), 0, 0}, {0, 1, 0}};
    case 3: return corner(t);
    default: return wall(t);
  }
  f.point.x() *= -1, f.normal.x() *= -1;
  return f;
}

/// Point and outward normal in the gear frame; `r` along the space, which bends with the radius.
Foot surface(int patch, double t, double r) {
  const Foot f = section(patch, t);
  const double width = 0.82 + 0.18 * (r - 70) / 20, bend = 0.012 * (r - 80) * (r - 80);
  const double slope = 0.024 * (r - 80);
  const Vec3 across = Vec3(-slope, 1, 0).normalized();
  Foot out;
  out.point = Vec3(r, bend, kFloor + f.point.y()) + across * (f.point.x() * width);
  out.normal = (across * f.normal.x() + Vec3::UnitZ() * f.normal.y() * width).normalized();
  return out;
}

constexpr tooth_space::Piece kPatches[] = {tooth_space::Piece::flank_minus, tooth_space::Piece::fillet_minus,
                                           tooth_space::Piece::root, tooth_space::Piece::fillet_plus,
                                           tooth_space::Piece::flank_plus};
constexpr double kZone[2][2] = {{66, 76}, {80, 90}};

proof::SurfaceGrid grid(int zone, int patch, int fields) {
  proof::SurfaceGrid g;
  g.zone = zone;
  g.patch = kPatches[patch];
  g.rows = patch == 2 ? 9 : patch == 1 || patch == 3 ? 11 : 31;
  g.columns = 61;
  g.excess_um.resize(static_cast<std::size_t>(fields));
  for (int i = 0; i < g.rows; ++i)
    for (int j = 0; j < g.columns; ++j) {
      const double t = i / (g.rows - 1.0), s = j / (g.columns - 1.0);
      const double r = kZone[zone][0] + s * (kZone[zone][1] - kZone[zone][0]);
      const Foot f = surface(patch, t, r);
      g.points.push_back(f.point);
      g.normals.push_back(f.normal);
      const bool corner = (patch == 1 || patch == 3) && s > 0.72 && t > 0.3 && t < 0.8;
      g.reachable.push_back(corner ? 0 : 1);
      const double cusps = 0.5 + 0.5 * std::cos(2 * kPi * 15 * t);
      const double finish = 0.35 + 2.6 * cusps * cusps -
                            0.9 * std::exp(-40 * (s - 0.2) * (s - 0.2)) * (patch == 4 ? 1.6 : 0.4) + (corner ? 38 : 0);
      const double layers = 260 + 70 * std::abs(std::sin(kPi * 6 * t)) + 25 * s;
      const double semi = 62 + 9 * cusps + 4 * std::sin(9 * s);
      const double by_operation[] = {layers, semi, finish};
      for (int k = 0; k < fields; ++k)
        g.excess_um[static_cast<std::size_t>(k)].push_back(static_cast<float>(by_operation[3 - fields + k]));
    }
  return g;
}

/// Passes along the space, one way, with a lift between them. `offset`: stock left by the operation [mm].
page::PagePath operation(int index, const std::string& type, int tool, double ball, double offset, int passes,
                         int records_per_pass) {
  page::PagePath path;
  path.cl.operation = index;
  path.cl.operation_type = type;
  path.cl.tool = tool;
  path.cl.spindle_rpm = 12000;
  int line = 40 + 100000 * index;
  const auto add = [&](const Vec3& tip, const Vec3& axis, path::MoveKind kind, int zone, int pass) {
    path.cl.records.push_back({tip, axis,
                               kind == path::MoveKind::rapid  ? 0.0
                               : kind == path::MoveKind::feed ? 900.0
                                                              : 400.0,
                               kind, zone, pass});
    path.nc_lines.push_back(line++);
  };
  for (int zone = 0; zone < 2; ++zone)
    for (int pass = 0; pass < passes; ++pass) {
      const double u = (pass + 0.5) / passes * 5;
      const int patch = std::min(4, static_cast<int>(u));
      const double side = u - 2.5;
      const Vec3 axis = Vec3(0.12, -0.10 * side / 2.5, 1).normalized();
      Vec3 first = Vec3::Zero(), last = Vec3::Zero();
      for (int k = 0; k < records_per_pass; ++k) {
        const double s = k / std::max(1.0, records_per_pass - 1.0);
        const double r = kZone[zone][0] - 0.8 + s * (kZone[zone][1] - kZone[zone][0] + 1.6);
        const Foot f = surface(patch, u - patch, r);
        last = f.point + f.normal * (ball + offset) - axis * ball;
        if (k == 0) {
          first = last;
          Vec3 above = first;
          above.z() = 6;
          add(above, axis, path::MoveKind::rapid, zone, pass);
          add(first, axis, path::MoveKind::engage, zone, pass);
        } else {
          add(last, axis, path::MoveKind::feed, zone, pass);
        }
      }
      Vec3 above = last;
      above.z() = 6;
      add(above, axis, path::MoveKind::retract, zone, pass);
    }
  return path;
}

page::PageTool ball_tool(const std::string& name, double radius, double stick_out) {
  page::PageToolBody ball{"ball", {}, true}, flute{"flute", {{radius, radius}, {radius, radius + 5}}, true};
  for (int k = 0; k <= 16; ++k) {
    const double a = kPi / 2 * k / 16;
    ball.profile.emplace_back(radius * std::sin(a), radius - radius * std::cos(a));
  }
  page::PageToolBody shank{
      "shank", {{radius, radius + 5}, {radius + 0.8, radius + 9}, {radius + 0.8, stick_out}}, false};
  page::PageToolBody holder{
      "holder",
      {{7, stick_out}, {8, stick_out + 1}, {11, stick_out + 24}, {16, stick_out + 24}, {16, stick_out + 36}},
      false};
  return {name, {ball, flute, shank, holder}};
}

proof::ExcessResult excess(const page::ReportPage& page, int operation, std::size_t field) {
  proof::ExcessResult e;
  e.operation = operation;
  std::vector<double> values;
  for (const proof::SurfaceGrid& g : page.surface)
    for (std::size_t i = 0; i < g.points.size(); ++i)
      if (g.reachable[i] != 0) values.push_back(g.excess_um[field][i] * 1e-3);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  e.max_mm = *high, e.min_mm = *low, e.bound_mm = *high + 0.0004, e.points = values.size();
  double squares = 0;
  for (const double v : values) squares += v * v;
  e.rms_mm = std::sqrt(squares / static_cast<double>(values.size()));
  e.histogram.assign(48, 0);
  e.histogram_from_mm = *low;
  e.histogram_step_mm = (*high - *low) / 48 * 1.0001;
  for (const double v : values) ++e.histogram[static_cast<std::size_t>((v - *low) / e.histogram_step_mm)];
  return e;
}

proof::DirectionChoice direction(int operation, int zone) {
  proof::DirectionChoice c;
  c.operation = operation, c.zone = zone;
  c.axis = Vec3(0.12, 0.02, 1).normalized();
  c.lean_rad = std::acos(c.axis.z());
  c.clearance_mm = 0.62;
  c.explanation = "largest gap of all clear directions; 3 mm flute needs a lean below 19 deg";
  for (int ring = 0; ring <= 10; ++ring)
    for (int k = 0; k < std::max(1, 6 * ring); ++k) {
      proof::DirectionChoice::Candidate d;
      d.lean_rad = ring * 3 * kPi / 180;
      d.azimuth_rad = 2 * kPi * k / std::max(1, 6 * ring);
      const double x = d.lean_rad * std::cos(d.azimuth_rad), y = d.lean_rad * std::sin(d.azimuth_rad);
      d.gap_mm = 0.7 - 8 * ((x - 0.12) * (x - 0.12) + 5 * y * y) - (zone == 0 && x < -0.1 ? 0.4 : 0);
      d.clear = d.gap_mm > 0.1;
      d.worst_body = std::abs(y) > 0.2 ? tool::Body::holder : x < 0 ? tool::Body::shank : tool::Body::flute;
      c.candidates.push_back(d);
    }
  return c;
}

std::vector<svg::LineChart> motion() {
  svg::LineChart position{"Axis positions", "time [s]", "position [mm]", {}, {}, false, false, false, ""};
  svg::LineChart turn{"Rotary axes", "time [s]", "position [\u00b0]", {}, {{"limit of A", 25}}, false, false,
                      false,         ""};
  svg::LineChart speed{"Axis speeds",
                       "time [s]",
                       "speed [mm/min]",
                       {},
                       {},
                       false,
                       false,
                       false,
                       "Rotary axes at 50 mm from their centre."};
  svg::LineChart feed{"Feed", "time [s]", "feed [mm/min]", {}, {{"commanded", 900}}, false, false, false, ""};
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 6);
  const char* const names[] = {"X", "Y", "Z"};
  for (int axis = 0; axis < 3; ++axis) {
    svg::ChartSeries p{names[axis], {}, {}}, v{names[axis], {}, {}};
    for (int i = 0; i < 20000; ++i) {
      const double t = i * 0.02, saw = std::fmod(t, 8) / 8;
      p.x.push_back(t), v.x.push_back(t);
      p.y.push_back(axis == 0    ? 70 + 12 * saw
                    : axis == 1  ? 3 * std::sin(t / 60) + saw
                    : saw > 0.95 ? 4
                                 : -5 + 2 * std::sin(t / 40));
      v.y.push_back(axis == 0    ? (saw > 0.95 ? -4000 : 880 + noise(random))
                    : axis == 1  ? 60 * std::cos(t / 60)
                    : saw > 0.95 ? 2500
                                 : 30 + noise(random));
    }
    position.series.push_back(p), speed.series.push_back(v);
  }
  svg::ChartSeries a{"A", {}, {}}, c{"C", {}, {}}, f{"feed", {}, {}};
  for (int i = 0; i < 4000; ++i) {
    const double t = i * 0.1, saw = std::fmod(t, 8) / 8;
    a.x.push_back(t), a.y.push_back(7 + 4 * std::sin(t / 50));
    c.x.push_back(t), c.y.push_back(-12 + 24 * t / 400);
    f.x.push_back(t), f.y.push_back(saw > 0.95 ? std::nan("") : 900 - 120 * std::exp(-20 * saw) + noise(random));
  }
  turn.series = {a, c}, feed.series = {f};
  return {position, turn, speed, feed};
}

std::vector<svg::LineChart> study() {
  svg::LineChart error{
      "Error against run time",           "run time [s]", "deviation [\u00b5m]", {}, {}, true, true, true,
      "Each point is one run of the job."};
  svg::LineChart stages{
      "Run time of the stages", "scallop asked for [\u00b5m]", "run time [s]", {}, {}, true, true, true, ""};
  svg::ChartSeries worst{"worst", {}, {}}, rms{"rms", {}, {}}, bound{"bound", {}, {}}, plan{"plan", {}, {}},
      check{"check", {}, {}};
  for (const double scallop : {0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0}) {
    const double seconds = 0.4 + 9 / std::sqrt(scallop);
    for (auto* s : {&worst, &rms, &bound}) s->x.push_back(seconds);
    worst.y.push_back(scallop * 1.1 + 0.2), rms.y.push_back(scallop * 0.38), bound.y.push_back(scallop * 1.2 + 0.5);
    plan.x.push_back(scallop), plan.y.push_back(3 / std::sqrt(scallop));
    check.x.push_back(scallop), check.y.push_back(6 / std::sqrt(scallop) + 0.2);
  }
  error.series = {worst, rms, bound}, stages.series = {plan, check};
  return {error, stages};
}

proof::GougeResult gouge(const page::ReportPage& page, bool gouged) {
  proof::GougeResult g;
  g.motions = 0;
  for (const page::PagePath& p : page.paths) g.motions += p.cl.records.size();
  g.clearance_mm = 0.62, g.required_clearance_mm = 0.3;
  g.measured_mm = gouged ? 0.0064 : -0.00021;
  g.bound_mm = gouged ? 0.0069 : 0.0004;
  const page::PagePath& finishing = page.paths.back();
  for (int k = 0; gouged && k < 7; ++k) {
    const int patch = k % 2 == 0 ? 4 : 0;
    const double r = kZone[k % 2][0] + 1.0 + 1.2 * k;
    const Foot f = surface(patch, 0.25 + 0.1 * k, r);
    proof::WorstPlace place;
    place.depth_mm = 0.0064 - 0.0006 * k;
    place.body = k == 5 ? tool::Body::shank : tool::Body::ball;
    place.patch = to_string(kPatches[patch]);
    place.operation = finishing.cl.operation;
    place.tooth = 3 * k, place.zone = k % 2;
    const std::size_t record = finishing.cl.records.size() * static_cast<std::size_t>(k + 1) / 9;
    place.line = finishing.nc_lines[record];
    place.radius_mm = r, place.height_mm = f.point.z(), place.point = f.point;
    g.worst.push_back(place);
  }
  if (gouged) g.deepest = g.worst.front();
  else
    g.deepest.depth_mm = g.measured_mm, g.deepest.body = tool::Body::ball, g.deepest.patch = "flank +1",
    g.deepest.tooth = 11, g.deepest.line = 4711;
  return g;
}

std::vector<page::NcExcerpt> listing(const page::ReportPage& page) {
  std::vector<page::NcExcerpt> excerpts;
  std::vector<int> lines;
  for (const proof::WorstPlace& w : page.gouge->worst) lines.push_back(w.line);
  std::sort(lines.begin(), lines.end());
  for (const int line : lines) {
    page::NcExcerpt e{line - 5, {}};
    for (int i = line - 5; i <= line + 5; ++i)
      e.lines.push_back(fmt::format("N{} G1 X{:.4f} Y{:.4f} Z{:.4f} A{:.4f} C{:.4f} F{:.1f}", i,
                                    71.2 + 0.11 * (i - line), -3.1 + 0.02 * i / 7, -4.2 + 0.013 * (i - line), 6.8421,
                                    -12.4402 + 0.004 * (i - line), 912.5));
    excerpts.push_back(e);
  }
  return excerpts;
}

}  // namespace

page::MachineScene synthetic_machine() {
  page::MachineScene scene;
  machines::RotaryAxis c, a;
  a.letter = 'A';
  a.direction = Vec3::UnitX();
  a.point_mm = Vec3(0, 0, 30);
  scene.chain.table = {c, a};
  scene.teeth = 24;
  scene.origin_mm = Vec3(0, 0, 60);
  const double pitch = 2 * kPi / scene.teeth;
  for (const double turn : {0.0, 0.5 * pitch, pitch})
    for (const double r : {45.0, 60.0}) {
      const double high = turn == 0.5 * pitch ? 0.0 : -8.0;
      scene.pitch.vertices.emplace_back(r * std::cos(turn), r * std::sin(turn), high);
      scene.pitch.vertices.emplace_back(r * std::cos(turn), r * std::sin(turn), -20.0);
    }
  scene.pitch.triangles = {{0, 2, 6},  {0, 6, 4},   {4, 6, 10}, {4, 10, 8}, {2, 3, 7}, {2, 7, 6},
                           {6, 7, 11}, {6, 11, 10}, {0, 4, 5},  {0, 5, 1},  {4, 8, 9}, {4, 9, 5}};
  scene.bodies = {{"plate", 0, machines::ConeShape{Vec3(0, 0, 0), Vec3(0, 0, 20), 70, 70}},
                  {"cradle", 1, machines::BoxShape{Vec3(-110, -40, -30), Vec3(110, 40, 0)}},
                  {"column", 2, machines::BoxShape{Vec3(-100, 160, -100), Vec3(100, 260, 300)}},
                  {"nose", 5, machines::ConeShape{Vec3(0, 0, 0), Vec3(0, 0, 60), 30, 40}, true}};
  scene.tool_length_mm = {90, 90};
  for (int k = 0; k <= 40; ++k)
    scene.moves.states.push_back({{50, 0, 160.0 - k, 0.02 * k, -0.01 * k}, 0, 100 + 3 * k, 0});
  for (int tooth = 0; tooth < scene.teeth; ++tooth)
    scene.moves.stretches.push_back({0, 41, 0, tooth, {tooth * pitch, 0}, 200 * tooth});
  scene.note = "planted";
  return scene;
}

page::ReportPage synthetic_page(const SyntheticPageOptions& options) {
  page::ReportPage page;
  page.title = "dhfg_synthetic";
  page.subtitle = "Double helical face gear, module 3, 41 teeth, five-axis mill with table A and C";
  page.verified = !options.gouged;
  if (options.gouged)
    page.reasons = {
        "gouge 6.40 \u00b5m (bound 6.90 \u00b5m) exceeds gouge_tolerance 2.00 \u00b5m at NC line "
        "1234, tooth 0, flank +1"};
  page.warnings = {"axis C comes within 3.1\u00b0 of its limit"};
  page.assumed = {"backlash = 0 mm", "mate_teeth = 20 (as shaper_teeth)", "chord_tolerance = 0.005 mm for roughing"};
  page.summary = {{"gear", "face gear, double helical, 41 teeth"},
                  {"module", "3 mm (normal plane)"},
                  {"pressure angle", "20\u00b0"},
                  {"reference radius", "78.0000 mm"},
                  {"machine", "vertical five-axis mill, table A/C"},
                  {"blank", "rings 66 to 76 mm and 80 to 90 mm"}};
  page.tools = {ball_tool("T1 ball 3.0 mm", 1.5, 26), ball_tool("T2 ball 2.0 mm", kBall, 20)};
  const double share = static_cast<double>(options.path_points) / 12000;
  const int per_pass = std::max(20, static_cast<int>(80 * std::sqrt(share)));
  const int passes = std::max(
      6, static_cast<int>(static_cast<double>(options.path_points) / 2 / per_pass / (options.one_operation ? 1 : 2.2)));
  if (options.one_operation) {
    page.paths = {operation(0, "finishing", 1, kBall, 0, passes, per_pass)};
  } else {
    page.paths = {operation(0, "roughing", 0, 1.5, 0.3, passes / 2, per_pass),
                  operation(1, "semi_finishing", 1, kBall, 0.06, passes * 7 / 10, per_pass),
                  operation(2, "finishing", 1, kBall, 0, passes, per_pass)};
  }
  for (int zone = 0; zone < 2; ++zone)
    for (int patch = 0; patch < 5; ++patch)
      page.surface.push_back(grid(zone, patch, static_cast<int>(page.paths.size())));
  for (std::size_t k = 0; k < page.paths.size(); ++k)
    page.excess.push_back(excess(page, page.paths[k].cl.operation, k));
  page.gouge = gouge(page, options.gouged);
  page.gouge_tolerance_mm = 0.002;
  page.nc_file = "program.ngc";
  page.listing = listing(page);
  using State = page::KeyFigure::State;
  page.figures = {{"worst gouge", options.gouged ? "6.40" : "\u22120.21", "\u00b5m",
                   options.gouged ? "bound 6.90, tolerance 2.00" : "bound 0.40, tolerance 2.00",
                   options.gouged ? State::bad : State::good},
                  {"material left", "3.10", "\u00b5m", "bound 3.50", State::plain},
                  {"scallop", "2.84", "\u00b5m", "3.00 asked for", State::plain},
                  {"path points", std::to_string(page.gouge->motions), "", "41 spaces in the program", State::plain},
                  {"cutting time", "148", "min", "all teeth", State::plain},
                  {"run time", "3.9", "s", "2 threads", State::plain}};
  page.ledger = {{proof::ErrorSource::flank_solve, 0.00002, 0.000004, ""},
                 {proof::ErrorSource::chord, 0.5, 0.41, ""},
                 {proof::ErrorSource::scallop, 3.0, 2.84, ""},
                 {proof::ErrorSource::orientation, 0, 0, ""},
                 {proof::ErrorSource::axis_linearisation, 0.2, 0.034, ""},
                 {proof::ErrorSource::rounding, 0.09, 0.062, ""},
                 {proof::ErrorSource::verification, 0.15, 0.02, ""}};
  for (const page::PagePath& p : page.paths)
    for (int zone = 0; zone < 2; ++zone) page.directions.push_back(direction(p.cl.operation, zone));
  page.motion = motion();
  if (options.study) page.work_precision = study();
  page.stage_seconds = {{"surface", 0.21},   {"plan", 1.32},  {"post", 0.44},
                        {"read back", 0.38}, {"check", 1.51}, {"report", 0.06}};
  page.tables = {{"Axes",
                  {"Axis", "Least", "Greatest", "Limits", "Fastest"},
                  {{"X [mm]", "\u2212120.402", "98.114", "\u2212300 / 300", "8000"},
                   {"Y [mm]", "\u221245.000", "44.203", "\u2212200 / 200", "6100"},
                   {"Z [mm]", "\u22126.204", "40.000", "\u2212250 / 50", "5000"},
                   {"A [\u00b0]", "2.914", "11.020", "\u221230 / 110", "310"},
                   {"C [\u00b0]", "\u221212.440", "356.9", "", "1200"}},
                  "Speeds in mm/min and \u00b0/min."},
                 {"Tools",
                  {"Tool", "Diameter [mm]", "Length [mm]", "Stick-out [mm]"},
                  {{"T1 ball", "3.000", "92.140", "26.0"}, {"T2 ball", "2.000", "88.005", "20.0"}},
                  ""}};
  if (options.awkward_names) {
    const std::string nasty = "</script><script>document.title='broken'</script><!-- <b>&amp;\"' \xE2\x80\xA8\xFF \xC3";
    page.title = page.subtitle = page.nc_file = nasty;
    page.reasons = page.warnings = page.assumed = {nasty};
    page.summary = {{nasty, nasty}};
    page.figures[0] = {nasty, nasty, nasty, nasty, State::bad};
    for (auto& p : page.paths) p.cl.operation_type = nasty;
    for (auto& t : page.tools) t.name = nasty;
    for (auto& w : page.gouge->worst) w.patch = nasty;
    for (auto& e : page.listing)
      for (auto& l : e.lines) l = nasty;
    for (auto& d : page.directions) d.explanation = nasty;
    for (auto& c : page.motion) c.title = c.x_label = c.y_label = c.note = c.series[0].name = nasty;
    for (auto& s : page.stage_seconds) s.first = nasty;
    for (auto& t : page.tables) t.title = t.note = t.columns[0] = t.rows[0][0] = nasty;
  }
  return page;
}

}  // namespace toothpath::test
