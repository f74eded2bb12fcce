#include "app/studies/trace_model.h"

#include <nlohmann/json.hpp>

#include "app/process/opening_and_end.h"
#include "app/report/page/study_page.h"
#include "app/report/svg/field_map.h"
#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"
#include "geometry/bevel_gear/section_models.h"

namespace toothpath::studies {
namespace {

const std::vector<std::string> kTraceModelOutputs = {"trace_model.csv", "trace_model.json", "trace_model.html"};

const char* name_of(bevel_gear::SectionModel model) {
  return model == bevel_gear::SectionModel::centre_path ? "S1" : "S2";
}

std::string wall_of(const bevel_gear::BevelGear& g, const bevel_gear::SectionModelMap& m) {
  const int eps = -m.sigma * g.halves()[static_cast<std::size_t>(m.half)].hand;
  const std::string half = g.herringbone() ? (m.half == 0 ? "inner half, " : "outer half, ") : "";
  return fmt::format("{}wall {} (eps {:+d})", half, m.sigma > 0 ? "L" : "U", eps);
}

std::string points_csv(const std::vector<bevel_gear::SectionModelMap>& maps) {
  std::string out = "model,half,wall,cone_distance,height,deviation_um\n";
  for (const auto& m : maps)
    for (std::size_t r = 0; r < m.height.size(); ++r)
      for (std::size_t c = 0; c < m.ell.size(); ++c) {
        const double d = m.deviation_mm[r * m.ell.size() + c];
        out += fmt::format("{},{},{},{:.6f},{:.6f},{}\n", name_of(m.model), m.half, m.sigma > 0 ? 'L' : 'U', m.ell[c],
                           m.height[r], std::isfinite(d) ? fmt::format("{:.6f}", 1000 * d) : std::string());
      }
  return out;
}

page::PageTable numbers(const bevel_gear::BevelGear& g, const std::vector<bevel_gear::SectionModelMap>& maps) {
  page::PageTable table{"Normal deviation of the machined wall from the model",
                        {"wall", "model", "least [um]", "greatest [um]", "rms [um]", "least at R [mm]", "height [mm]"},
                        {},
                        ""};
  for (const auto& m : maps)
    table.rows.push_back({wall_of(g, m), name_of(m.model), fmt::format("{:.3f}", 1000 * m.least_mm),
                          fmt::format("{:.3f}", 1000 * m.greatest_mm), fmt::format("{:.3f}", 1000 * m.rms_mm),
                          fmt::format("{:.3f}", m.least_ell), fmt::format("{:.3f}", m.least_height)});
  return table;
}

std::string json_of(const bevel_gear::BevelGear& g, const std::string& job_file,
                    const std::vector<bevel_gear::SectionModelMap>& maps) {
  nlohmann::ordered_json json = {
      {"schema", 1}, {"command", "study trace-model"}, {"job", job_file}, {"pitch_angle", degrees(g.delta())}};
  json["walls"] = nlohmann::ordered_json::array();
  for (const auto& m : maps)
    json["walls"].push_back({{"half", m.half},
                             {"wall", m.sigma > 0 ? "L" : "U"},
                             {"model", name_of(m.model)},
                             {"least_um", 1000 * m.least_mm},
                             {"greatest_um", 1000 * m.greatest_mm},
                             {"rms_um", 1000 * m.rms_mm},
                             {"least_at", {m.least_ell, m.least_height}},
                             {"height_range", {m.height.front(), m.height.back()}},
                             {"cone_distance_range", {m.ell.front(), m.ell.back()}}});
  return json_text(json, 2) + "\n";
}

page::StudyPage page_of(const bevel_gear::BevelGear& g, const job::Job& job,
                        const std::vector<bevel_gear::SectionModelMap>& maps) {
  page::StudyPage page;
  double worst[2] = {0, 0};
  for (const auto& m : maps) {
    double& w = worst[m.model == bevel_gear::SectionModel::centre_path ? 0 : 1];
    w = std::max({w, -m.least_mm, m.greatest_mm});
  }
  page.title = "Trace model against surface model";
  page.subtitle =
      fmt::format("{}: {} teeth, pitch angle {:.4f} deg", job.name, g.parameters().teeth, degrees(g.delta()));
  page.verdict = fmt::format("S1 up to {:.2f} um, S2 up to {:.2f} um", 1000 * worst[0], 1000 * worst[1]);
  page.introduction = {
      "The machined wall is the envelope of the finger mill. Two simpler models sweep the mill's meridian section "
      "instead: S1 keeps it normal to the path of the mill's centre, S2 sets it on the theoretical tooth trace, in the "
      "trace's normal plane, with its pitch point on the trace.",
      "The maps show how far the machined wall lies from each model, along the wall's normal: negative (blue) where "
      "the machined tooth is thinner than the model. All maps share one scale a model. The difference grows towards "
      "tip and small end with 1/(R tan(delta))^2 and vanishes for a crown wheel, so a sweep model is good enough for "
      "drawings and wheels, not as the reference of a pinion."};
  for (const auto& m : maps) {
    svg::FieldMap map;
    map.title = fmt::format("{}, {}", name_of(m.model), wall_of(g, m));
    map.x_label = "cone distance [mm]";
    map.y_label = "height above the pitch cone [mm]";
    map.unit = "um";
    map.x = m.ell;
    map.y = m.height;
    for (const double d : m.deviation_mm) map.values.push_back(1000 * d);
    map.largest = 1000 * worst[m.model == bevel_gear::SectionModel::centre_path ? 0 : 1];
    page.figures.push_back(
        {map.title, svg::svg_field_map(map),
         fmt::format("{:.3f} .. {:.3f} um, rms {:.3f} um", 1000 * m.least_mm, 1000 * m.greatest_mm, 1000 * m.rms_mm)});
  }
  page.tables = {numbers(g, maps)};
  return page;
}

}  // namespace

commands::CommandOutcome study_trace_model(const TraceModelRequest& request) {
  auto output = app::OutputDir::open(request.out_dir, kTraceModelOutputs, {request.job_file});
  if (!output) return commands::failed(output.error());
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  auto read = process::read_bevel_gear_job(request.job_file, clock);
  if (auto* errors = read.refused()) return commands::failed(std::move(*errors));
  const job::Job& job = read.value().job;
  const bevel_gear::BevelGear& gear = read.value().gear;
  const auto maps = clock.run("models", [&] {
    return section_model_maps(
        gear, request.quick ? bevel_gear::SectionModelOptions{9, 13, 0, 0} : bevel_gear::SectionModelOptions{});
  });
  commands::CommandOutcome outcome;
  outcome.report_json = json_of(gear, job.file, maps);
  const process::NamedFiles files = {{"trace_model.csv", points_csv(maps)},
                                     {"trace_model.html", page::study_page_html(page_of(gear, job, maps))},
                                     {"trace_model.json", outcome.report_json}};
  outcome.summary = page::table_text(numbers(gear, maps)) + "files in " + request.out_dir + "\n";
  progress.clear();
  return process::finished(*output, files, std::move(outcome));
}

void add_trace_model(commands::Commands& commands) {
  commands.push_back(commands::command_of<TraceModelRequest>(
      "trace-model", "section-sweep models of a bevel gear against its envelope",
      [](commands::OptionSet& set, TraceModelRequest& request) {
        job_options(set, request);
        set.examples({"study trace-model pinion.toml"});
        set.flag("--quick", request.quick, "a coarser grid");
      },
      study_trace_model, &commands::kStudies));
}

}  // namespace toothpath::studies
