#include "app/commands/forces.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/process/opening_and_end.h"
#include "app/report/page/study_page.h"
#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"
#include "geometry/bevel_gear/forces.h"

namespace toothpath::commands {
namespace {

const std::vector<std::string> kForcesOutputs = {"forces.csv", "forces.json", "forces.html"};
constexpr int kForceSteps = 72;  // of R_J over the face

struct Member {
  std::string name;
  bevel_gear::BevelForceMember data;
  double torque_Nmm = 0;
  int hand = 1;  ///< of its inner half
};

struct Pair {
  double R_i = 0, R_e = 0, R_J = 0, R_m = 0, relief = 0;
  bool herringbone = false;
  std::vector<Member> members;
};

Pair pair_of(const bevel_gear::BevelGear& g, double torque_Nm) {
  const auto& p = g.parameters();
  Pair pair{g.R_i(), g.R_e(), g.R_ref(), g.R_m(), g.herringbone() ? p.relief_half_width_mm : 0.0, g.herringbone(), {}};
  pair.members.push_back({"gear", {p.pressure_angle_rad, g.delta(), g.R_0()}, 1000 * torque_Nm, p.hand});
  if (p.mate_teeth > 0)
    pair.members.push_back({"mate",
                            {p.pressure_angle_rad, p.shaft_angle_rad - g.delta(), g.R_0()},
                            1000 * torque_Nm * p.mate_teeth / p.teeth,
                            -p.hand});
  return pair;
}

const char* name_of(bevel_gear::LoadSplit split) {
  switch (split) {
    case bevel_gear::LoadSplit::line_load: return "uniform line load";
    case bevel_gear::LoadSplit::line_load_middles: return "uniform line load, halves at their middles";
    case bevel_gear::LoadSplit::equal_torque: return "equal torque";
  }
  return "";
}

/// One line of the table: an arrangement under one assumption, one sense, one member.
struct Row {
  std::string arrangement, sharing, part;
  double R_J = 0;
  int sigma = 1;
  std::string member;
  bevel_gear::BevelForce force;
  double torque_Nmm = 0;
};

void add_rows(std::vector<Row>& rows, const Pair& pair, const std::string& arrangement, double R_J,
              bevel_gear::LoadSplit split) {
  for (const int sigma : {1, -1})
    for (const auto& m : pair.members) {
      const auto faces = bevel_gear::herringbone_faces(pair.R_i, R_J, pair.R_e, pair.relief, m.hand);
      const auto forces = bevel_gear::bevel_face_forces(m.data, faces, sigma, m.torque_Nmm, split);
      bevel_gear::BevelForce sum;
      for (std::size_t i = 0; i < forces.size(); ++i) {
        rows.push_back({arrangement, name_of(split), i == 0 ? "inner half" : "outer half", R_J, sigma, m.name,
                        forces[i], m.torque_Nmm});
        sum += forces[i];
      }
      rows.push_back({arrangement, name_of(split), "sum", R_J, sigma, m.name, sum, m.torque_Nmm});
    }
}

std::vector<Row> cases(const Pair& pair, const std::optional<double>& balanced) {
  std::vector<Row> rows;
  for (const int sigma : {1, -1})
    for (const auto& m : pair.members)
      rows.push_back({"single hand", "at R_m", "sum", pair.R_m, sigma, m.name,
                      bevel_gear::bevel_point_force(m.data, pair.R_m, sigma * m.hand, m.torque_Nmm), m.torque_Nmm});
  if (pair.herringbone)
    for (const bevel_gear::LoadSplit split :
         {bevel_gear::LoadSplit::line_load, bevel_gear::LoadSplit::line_load_middles,
          bevel_gear::LoadSplit::equal_torque})
      add_rows(rows, pair, "herringbone", pair.R_J, split);
  if (balanced)
    for (const bevel_gear::LoadSplit split : {bevel_gear::LoadSplit::line_load, bevel_gear::LoadSplit::equal_torque})
      add_rows(rows, pair, "herringbone, balanced R_J", *balanced, split);
  return rows;
}

/// Three decimals of a kN; what rounds to nothing has no sign.
std::string kN(double newton) { return fmt::format("{:.3f}", std::abs(newton) < 0.5 ? 0.0 : newton / 1000); }

page::PageTable table_of(const std::vector<Row>& rows, bool halves) {
  page::PageTable table{
      halves ? "Every half" : "Sums",
      {"arrangement", "load sharing", "R_J [mm]", "loaded wall", "member", "part", "F_t [kN]", "F_a [kN]", "F_r [kN]",
       "F_a pressure part", "F_a spiral part", "F_a per torque [N/(N m)]"},
      {},
      "F_a > 0: away from the apex; F_r > 0: towards the axis. For the single hand the column R_J holds R_m."};
  for (const auto& r : rows) {
    if ((r.part == "sum") == halves) continue;
    table.rows.push_back({r.arrangement, r.sharing, fmt::format("{:.4f}", r.R_J), r.sigma > 0 ? "L" : "U", r.member,
                          r.part, kN(r.force.tangential), kN(r.force.axial()), kN(r.force.radial()),
                          kN(r.force.axial_pressure), kN(r.force.axial_spiral),
                          fmt::format("{:.4f}", r.force.axial() / (r.torque_Nmm / 1000))});
  }
  return table;
}

/// Force over R_J, NaN where that sharing has no meaning (a half without a face).
double over_apex(const Pair& pair, const Member& m, double R_J, int sigma, bevel_gear::LoadSplit split, bool axial) {
  const auto faces = bevel_gear::herringbone_faces(pair.R_i, R_J, pair.R_e, pair.relief, m.hand);
  if (faces.empty() || (split == bevel_gear::LoadSplit::equal_torque && faces.size() < 2))
    return std::numeric_limits<double>::quiet_NaN();
  const auto f = bevel_gear::bevel_total_force(m.data, faces, sigma, m.torque_Nmm, split);
  return axial ? f.axial() : f.radial();
}

std::string csv_over_apex(const Pair& pair) {
  std::string out = "R_J,member,load_sharing,loaded_wall,F_t_N,F_a_N,F_r_N,F_a_pressure_N,F_a_spiral_N\n";
  for (int k = 0; k <= kForceSteps; ++k) {
    const double R_J = pair.R_i + (pair.R_e - pair.R_i) * k / kForceSteps;
    for (const auto& m : pair.members)
      for (const bevel_gear::LoadSplit split :
           {bevel_gear::LoadSplit::line_load, bevel_gear::LoadSplit::equal_torque}) {
        const auto faces = bevel_gear::herringbone_faces(pair.R_i, R_J, pair.R_e, pair.relief, m.hand);
        if (faces.empty() || (split == bevel_gear::LoadSplit::equal_torque && faces.size() < 2)) continue;
        for (const int sigma : {1, -1}) {
          const auto f = bevel_gear::bevel_total_force(m.data, faces, sigma, m.torque_Nmm, split);
          out +=
              fmt::format("{:.6f},{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f}\n", R_J, m.name, name_of(split),
                          sigma > 0 ? 'L' : 'U', f.tangential, f.axial(), f.radial(), f.axial_pressure, f.axial_spiral);
        }
      }
  }
  return out;
}

svg::LineChart chart_of(const Pair& pair, const Member& m, bool axial) {
  svg::LineChart chart;
  chart.title = fmt::format("{} force on the {} over the apex cone distance", axial ? "Axial" : "Radial", m.name);
  chart.x_label = "R_J [mm]";
  chart.y_label = axial ? "F_a [kN]" : "F_r [kN]";
  for (const bevel_gear::LoadSplit split : {bevel_gear::LoadSplit::line_load, bevel_gear::LoadSplit::equal_torque})
    for (const int sigma : {1, -1}) {
      svg::ChartSeries series;
      series.name =
          fmt::format("{}, wall {} loaded", split == bevel_gear::LoadSplit::line_load ? "line load" : "equal torque",
                      sigma > 0 ? 'L' : 'U');
      for (int k = 0; k <= kForceSteps; ++k) {
        const double R_J = pair.R_i + (pair.R_e - pair.R_i) * k / kForceSteps;
        series.x.push_back(R_J);
        series.y.push_back(over_apex(pair, m, R_J, sigma, split, axial) / 1000);
      }
      chart.series.push_back(std::move(series));
    }
  for (const int sigma : {1, -1}) {
    const auto f = bevel_gear::bevel_point_force(m.data, pair.R_m, sigma * m.hand, m.torque_Nmm);
    chart.limits.push_back(
        {fmt::format("single hand, wall {}", sigma > 0 ? 'L' : 'U'), (axial ? f.axial() : f.radial()) / 1000});
  }
  return chart;
}

page::StudyPage page_of(const Pair& pair, const job::Job& job, const std::vector<Row>& rows,
                        const std::optional<double>& balanced) {
  page::StudyPage page;
  page.title = "Tooth forces";
  page.subtitle = fmt::format(
      "{}: {:.6g} N m on the gear{}", job.name, pair.members[0].torque_Nmm / 1000,
      pair.members.size() > 1 ? fmt::format(", {:.6g} N m on the mate", pair.members[1].torque_Nmm / 1000) : "");
  page.verdict = balanced ? fmt::format("balanced at R_J = {:.4f} mm", *balanced) : "no R_J balances this face";
  page.good = balanced.has_value();
  page.introduction = {
      "F_t is the tangential force, F_a acts along the axis (positive: away from the apex), F_r towards the axis. The "
      "loaded wall tells the sense: wall L loaded, the mesh turns the member towards negative azimuth (clockwise seen "
      "from the large end), and a driving gear runs the other way. Gear and mate load the same letter.",
      "What cancels in a herringbone: only the spiral part, sigma h tan(beta) cos(delta), because both halves have "
      "opposite hands. What does not: the pressure part tan(alpha_n) sin(delta) / cos(beta), which always pushes away "
      "from the apex. Nor do the two spiral parts cancel by themselves: beta falls towards the large end.",
      fmt::format(
          "How the halves share the torque is statically indeterminate; a bevel gear cannot float along its axis until "
          "the halves are even. Two assumptions are shown: a uniform line load over the face (groove of +-{:.4g} mm "
          "left out) and equal torque in both halves. {} Equal torque has no such place: tan(beta)/R falls with R.",
          pair.relief,
          balanced ? fmt::format("Under the uniform line load the spiral parts cancel at R_J = {:.4f} mm: the forces "
                                 "are then the same in both senses.",
                                 *balanced)
                   : "No R_J leaves both halves a face.")};
  for (const auto& m : pair.members)
    for (const bool axial : {true, false}) page.charts.push_back(chart_of(pair, m, axial));
  page.tables = {table_of(rows, false), table_of(rows, true)};
  return page;
}

std::string json_of(const Pair& pair, const std::string& job_file, const std::vector<Row>& rows,
                    const std::optional<double>& balanced) {
  nlohmann::ordered_json json = {{"schema", 1}, {"command", "forces"}, {"job", job_file}};
  if (balanced) json["balanced_apex_cone_distance"] = *balanced;
  if (const auto whole = bevel_gear::balanced_apex_distance(pair.R_i, pair.R_e, pair.members[0].data.R_0))
    json["balanced_without_groove"] = *whole;
  for (const auto& m : pair.members) json["torque_" + m.name + "_Nm"] = m.torque_Nmm / 1000;
  json["cases"] = nlohmann::ordered_json::array();
  for (const auto& r : rows)
    json["cases"].push_back({{"arrangement", r.arrangement},
                             {"load_sharing", r.sharing},
                             {"cone_distance", r.R_J},
                             {"loaded_wall", r.sigma > 0 ? "L" : "U"},
                             {"member", r.member},
                             {"part", r.part},
                             {"F_t_N", r.force.tangential},
                             {"F_a_N", r.force.axial()},
                             {"F_r_N", r.force.radial()},
                             {"F_a_pressure_N", r.force.axial_pressure},
                             {"F_a_spiral_N", r.force.axial_spiral},
                             {"F_r_pressure_N", r.force.radial_pressure},
                             {"F_r_spiral_N", r.force.radial_spiral}});
  return json_text(json, 2) + "\n";
}

}  // namespace

CommandOutcome run_forces(const ForcesRequest& request) {
  auto output = app::OutputDir::open(request.out_dir, kForcesOutputs, {request.job_file});
  if (!output) return failed(output.error());
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  auto read = process::read_bevel_gear_job(request.job_file, clock);
  if (auto* errors = read.refused()) return failed(std::move(*errors));
  const auto& [job, gear] = read.value();
  const auto torque = request.torque_Nm ? request.torque_Nm : job.torque_Nm;
  if (!torque)
    return failed(fail_at(job.where(""),
                          "no torque: give --torque or the table [load] with the key \"torque\" (N m on this gear)"));
  const Pair pair = pair_of(gear, *torque);
  const auto balanced = bevel_gear::balanced_apex_distance(pair.R_i, pair.R_e, gear.R_0(), pair.relief);
  const auto rows = cases(pair, balanced);

  CommandOutcome outcome;
  outcome.report_json = json_of(pair, job.file, rows, balanced);
  page::PageTable screen = table_of(rows, false);
  for (auto& row : screen.rows) row.erase(row.begin() + 5);
  screen.columns.erase(screen.columns.begin() + 5);
  outcome.summary = page::table_text(screen);
  outcome.summary +=
      balanced
          ? fmt::format(
                "same axial force in both senses at R_J = {:.4f} mm (uniform line load, groove +-{:.4g} mm left out)\n",
                *balanced, pair.relief)
          : std::string("no R_J balances this face\n");
  outcome.summary += "files in " + request.out_dir + "\n";
  const process::NamedFiles files = {{"forces.csv", csv_over_apex(pair)},
                                     {"forces.html", page::study_page_html(page_of(pair, job, rows, balanced))},
                                     {"forces.json", outcome.report_json}};
  progress.clear();
  return process::finished(*output, files, std::move(outcome));
}

void add_forces(Commands& commands) {
  commands.push_back(command_of<ForcesRequest>(
      "forces", "tooth forces of a bevel pair over the apex cone distance, and what balances them",
      [](OptionSet& set, ForcesRequest& request) {
        job_options(set, request);
        set.examples({"forces pinion.toml --torque 120"});
        set.number("--torque", request.torque_Nm, "torque on the gear of the job; overrides torque in its [load]",
                   job::kTorque);
      },
      run_forces));
}

}  // namespace toothpath::commands
