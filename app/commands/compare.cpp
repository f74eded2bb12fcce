#include "app/commands/compare.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/base/units.h"
#include "app/job/file.h"
#include "app/process/face/contact.h"
#include "app/process/face/shaped_flanks.h"
#include "app/process/flow/cut_flanks.h"
#include "app/process/opening_and_end.h"
#include "app/process/under_load/settings.h"
#include "app/report/page/study_page.h"
#include "app/report/run_report.h"
#include "app/report/svg/contact_pattern.h"
#include "app/report/svg/html_text.h"
#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"

namespace toothpath::commands {
namespace {

const std::vector<std::string> kCompareOutputs = {"compare.csv", "compare.json", "compare.html"};
constexpr int kCompareRows = 121, kCompareColumns = 33;
/// Two numbers of job files that mean the same gear differ by rounding at most.
constexpr double kSameSurface = 1e-9;

struct Side {
  job::Job job;
  std::optional<face_gear::FaceGear> gear;
};

std::vector<Diagnostic> read_side(const std::string& file, Side& side) {
  auto read = job::read_job_file(file);
  if (auto* errors = read.refused()) return std::move(*errors);
  side.job = std::move(read).value();
  auto made = process::make_face_gear(side.job);
  if (auto* errors = made.refused()) return std::move(*errors);
  side.gear = std::move(made).value();
  return {};
}

/// Everything that decides the flanks must agree; each difference is named at its place in the milled job.
std::vector<Diagnostic> differences(const Side& shaped, const Side& milled) {
  std::vector<Diagnostic> found;
  const face_gear::FaceGearParameters &a = shaped.gear->parameters(), &b = milled.gear->parameters();
  const auto compare = [&](const std::string& key, double x, double y) {
    if (std::abs(x - y) <= kSameSurface * std::max(1.0, std::abs(x))) return;
    found.push_back(fail_at(milled.job.where("gear." + key), "{} = {:g} differs from {:g} of {}: not the same gear",
                            key, y, x, shaped.job.file));
  };
  compare("teeth", a.teeth, b.teeth);
  compare("shaper_teeth", a.shaper_teeth, b.shaper_teeth);
  compare("offset", a.offset_mm, b.offset_mm);
  compare("shaft_angle", degrees(a.shaft_angle_rad), degrees(b.shaft_angle_rad));
  compare("backlash", a.backlash_mm, b.backlash_mm);
  compare("zone", static_cast<double>(a.zones.size()), static_cast<double>(b.zones.size()));
  if (!found.empty()) return found;
  for (std::size_t n = 0; n < a.zones.size(); ++n) {
    const std::string zone = fmt::format("zone[{}].", n);
    compare(zone + "helix_angle", degrees(a.zones[n].helix_angle_rad), degrees(b.zones[n].helix_angle_rad));
    compare(zone + "inner_radius", a.zones[n].inner_radius_mm, b.zones[n].inner_radius_mm);
    compare(zone + "outer_radius", a.zones[n].outer_radius_mm, b.zones[n].outer_radius_mm);
    const auto &f = shaped.gear->rings()[n].surface.shaper, &g = milled.gear->rings()[n].surface.shaper;
    compare("module", f.m_t, g.m_t);
    compare("pressure_angle", degrees(f.alpha_t), degrees(g.alpha_t));
    compare("addendum_coefficient", f.h_a / f.m_t, g.h_a / g.m_t);
  }
  return found;
}

struct Figures {
  double least = 0, greatest = 0, rms = 0;
};
Figures figures_of(const std::vector<double>& um) {
  Figures f{1e300, -1e300, 0};
  for (const double v : um) f.least = std::min(f.least, v), f.greatest = std::max(f.greatest, v), f.rms += v * v;
  f.rms = um.empty() ? 0 : std::sqrt(f.rms / static_cast<double>(um.size()));
  return f;
}

/// One flank by both routes, um.
struct ComparedFlank {
  const process::CutFlanks::Flank* places = nullptr;
  std::vector<double> shaped_um, milled_um, difference_um;
  Figures shaped, milled, difference;
};

std::vector<ComparedFlank> compared(const process::CutFlanks& shaped, const process::CutFlanks& milled) {
  std::vector<ComparedFlank> flanks;
  for (std::size_t n = 0; n < milled.flanks.size(); ++n) {
    ComparedFlank f;
    f.places = &milled.flanks[n];
    for (std::size_t k = 0; k < f.places->nominal.size(); ++k) {
      f.shaped_um.push_back(shaped.flanks[n].deviation_mm[k] * app::kUm);
      f.milled_um.push_back(milled.flanks[n].deviation_mm[k] * app::kUm);
      f.difference_um.push_back(f.milled_um.back() - f.shaped_um.back());
    }
    f.shaped = figures_of(f.shaped_um);
    f.milled = figures_of(f.milled_um);
    f.difference = figures_of(f.difference_um);
    flanks.push_back(std::move(f));
  }
  return flanks;
}

std::string csv_of(const std::vector<ComparedFlank>& flanks) {
  std::string out = "zone,flank,row,column,r,z,shaped_um,milled_um,difference_um\n";
  for (const auto& f : flanks)
    for (std::size_t k = 0; k < f.shaped_um.size(); ++k) {
      const Vec3& p = f.places->nominal[k];
      const int columns = f.places->columns, n = static_cast<int>(k);
      out +=
          fmt::format("{},{},{},{},{:.6f},{:.6f},{:.4f},{:.4f},{:.4f}\n", f.places->zone, f.places->side, n / columns,
                      n % columns, std::hypot(p.x(), p.y()), p.z(), f.shaped_um[k], f.milled_um[k], f.difference_um[k]);
    }
  return out;
}

page::PageTable deviation_table(const std::vector<ComparedFlank>& flanks) {
  page::PageTable table{"Deviation of the flanks",
                        {"flank", "ring", "route", "least um", "greatest um", "rms um"},
                        {},
                        "Along the normal of the exact flank, material left positive, on the same places."};
  for (const auto& f : flanks)
    for (const auto& [route, v] :
         {std::pair<std::string, Figures>{"shaped", f.shaped}, {"milled", f.milled}, {"milled - shaped", f.difference}})
      table.rows.push_back({fmt::format("{:+}", f.places->side), std::to_string(f.places->zone), route,
                            fmt::format("{:.3f}", v.least), fmt::format("{:.3f}", v.greatest),
                            fmt::format("{:.3f}", v.rms)});
  return table;
}

page::PageTable time_table(const process::CutFlanks& shaped, const process::CutFlanks& milled) {
  page::PageTable table{"Times on the machine",
                        {"route", "cutting min", "all min", "verified"},
                        {},
                        "Shaped: double strokes of infeed and one full turn. Milled: feed, and feed with rapids, of "
                        "all teeth and operations of the job, without clamping; " +
                            milled.time_model + "."};
  table.rows.push_back({"shaped", fmt::format("{:.2f}", shaped.cutting_minutes),
                        fmt::format("{:.2f}", shaped.total_minutes), "strokes simulated"});
  table.rows.push_back({"milled", fmt::format("{:.2f}", milled.cutting_minutes),
                        fmt::format("{:.2f}", milled.total_minutes), milled.verified ? "yes" : "no"});
  return table;
}

std::vector<page::StudyPage::Figure> maps_of(const std::vector<ComparedFlank>& flanks) {
  std::vector<page::StudyPage::Figure> figures;
  for (const auto& f : flanks) {
    double largest = 0;
    for (const auto* values : {&f.shaped_um, &f.milled_um})
      for (const double v : *values) largest = std::max(largest, std::abs(v));
    // A corner that a ball leaves must not swallow the colours of the flank.
    std::vector<double> sizes;
    for (const double v : f.milled_um) sizes.push_back(std::abs(v));
    for (const double v : f.shaped_um) sizes.push_back(std::abs(v));
    std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() * 99 / 100), sizes.end());
    const double shown = std::min(largest, 1.2 * sizes[sizes.size() * 99 / 100]);
    for (const auto& [name, values] : {std::pair<std::string, const std::vector<double>*>{"shaped", &f.shaped_um},
                                       {"milled", &f.milled_um},
                                       {"milled less shaped", &f.difference_um}}) {
      svg::FlankFieldDrawing d;
      d.title = fmt::format("{}, flank {:+}", name, f.places->side);
      d.x_label = "radius from the gear's axis [mm]";
      d.y_label = "height z [mm]";
      d.unit = "\u00b5m";
      d.columns = f.places->columns;
      d.rows = f.places->rows;
      for (const Vec3& p : f.places->nominal) d.x.push_back(std::hypot(p.x(), p.y())), d.y.push_back(p.z());
      d.value = *values;
      d.largest = shown;
      figures.push_back({fmt::format("Flank {:+}: {}", f.places->side, name), svg::svg_flank_field(d),
                         name == "shaped"
                             ? "Feed marks of the strokes: flats of the cutter's profile between two strokes."
                         : name == "milled" ? "Cusps between the passes of the ball."
                                            : fmt::format("Where the milled flank stands higher ({}) or lower ({}).",
                                                          svg::kAboveZero, svg::kBelowZero)});
    }
  }
  return figures;
}

nlohmann::ordered_json figures_json(const Figures& f) {
  return {{"min_um", f.least}, {"max_um", f.greatest}, {"rms_um", f.rms}};
}

/// Both jobs and their gears; refused: all that is wrong with either, or that they are not one gear by two routes.
std::vector<Diagnostic> read_sides(const CompareRequest& request, Side& shaped, Side& milled) {
  std::vector<Diagnostic> errors = read_side(request.job_file, shaped);
  auto more = read_side(request.other_job, milled);
  errors.insert(errors.end(), more.begin(), more.end());
  if (!errors.empty()) return errors;
  if (!shaped.job.shaping) return {fail_at(shaped.job.where(""), "the job lacks the table [shaping]")};
  if (milled.job.operations.empty())
    return {fail_at(milled.job.where(""), "the job lacks an [[operation]]: nothing is milled")};
  return differences(shaped, milled);
}

/// Both flanks under the same pinion: what the deviations mean in the mesh.
struct ComparedContact {
  page::PageTable table{
      "Under the same pinion", {"flank", "route", "transmission error um", "within compound", "pattern %"}, {}, ""};
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
};
process::ValueOrErrors<ComparedContact> compared_contact(const Side& milled_side, const process::CutFlanks& shaped,
                                                         const process::CutFlanks& milled, app::StageClock& clock) {
  const job::ContactSettings settings = under_load::contact_settings(milled_side.job, {});
  ComparedContact out;
  for (const process::CutFlanks* cut : {&shaped, &milled}) {
    auto analysed =
        clock.run("contact", [&] { return face::analyse_contact(milled_side.job, *milled_side.gear, settings, cut); });
    if (auto* e = analysed.refused()) return std::move(*e);
    const auto& a = analysed.value();
    out.table.note = fmt::format(
        "Pinion of {} teeth, rigid and unloaded; peak to peak at the pitch radius {:.3f} mm; compound {:g} um.",
        a.pinion_teeth, a.pitch_radius_mm, a.settings.compound_mm * app::kUm);
    for (const auto& side : a.sides) {
      if (!side.as_cut) continue;
      const double um = side.roll.error_range_rad * a.pitch_radius_mm * app::kUm,
                   share = side.roll.patterns.front().marked_share;
      out.table.rows.push_back({fmt::format("{:+}", side.side), cut->route, fmt::format("{:.3f}", um),
                                fmt::format("{} to {}", side.roll.least_marking, side.roll.most_marking),
                                fmt::format("{:.1f}", share * 100)});
      out.rows.push_back({{"route", cut->route},
                          {"flank", side.side},
                          {"error_range_um", um},
                          {"error_range_urad", side.roll.error_range_rad * 1e6},
                          {"pattern_share", share}});
    }
  }
  return out;
}

nlohmann::ordered_json comparison_json(const Side& shaped_side, const Side& milled_side,
                                       const process::CutFlanks& shaped, const process::CutFlanks& milled,
                                       const std::vector<ComparedFlank>& flanks) {
  nlohmann::ordered_json json;
  json["schema"] = 1;
  json["command"] = "compare";
  json["shaped"] = {{"job", shaped_side.job.name},
                    {"minutes", shaped.total_minutes},
                    {"cutting_minutes", shaped.cutting_minutes},
                    {"assumed", shaped.assumed}};
  json["milled"] = {
      {"job", milled_side.job.name}, {"minutes", milled.total_minutes}, {"cutting_minutes", milled.cutting_minutes},
      {"verified", milled.verified}, {"assumed", milled.assumed},       {"warnings", milled.warnings}};
  json["flanks"] = nlohmann::ordered_json::array();
  for (const auto& f : flanks)
    json["flanks"].push_back({{"zone", f.places->zone},
                              {"flank", f.places->side},
                              {"points", f.shaped_um.size()},
                              {"shaped", figures_json(f.shaped)},
                              {"milled", figures_json(f.milled)},
                              {"difference", figures_json(f.difference)}});
  return json;
}

/// Verdict and what is to be known before the figures are read; figures and tables are the caller's.
page::StudyPage page_about(const Side& shaped_side, const Side& milled_side, const process::CutFlanks& shaped,
                           const process::CutFlanks& milled) {
  page::StudyPage page;
  page.title = milled_side.job.name + ": shaped and milled";
  page.subtitle = fmt::format("{} against {}, {} x {} places a flank", shaped_side.job.file, milled_side.job.file,
                              kCompareRows, kCompareColumns);
  page.good = milled.verified;
  page.verdict = milled.verified ? "both routes cut the gear" : "milled program not verified";
  page.introduction = {
      "The same flanks by two routes, each judged on what it cuts: the strokes of the shaper as straight sweeps of the "
      "cutter's profile, the milled surface from the program as it was read back. Both deviations are taken on the "
      "same places along the same normals.",
      "Feed, depth of cut and tolerances are those of the two jobs: the figures compare these jobs, not the processes "
      "in general."};
  const double shaped_tip = shaped_side.gear->parameters().shaper_tip_radius_mm,
               milled_tip = milled_side.gear->parameters().shaper_tip_radius_mm;
  if (shaped_tip != milled_tip)
    page.introduction.push_back(
        fmt::format("The shapers' tip radii differ ({:g} and {:g} mm), so the fillets do; the flanks above the higher "
                    "fillet line are the same.",
                    shaped_tip, milled_tip));
  for (const auto& a : shaped.assumed) page.introduction.push_back("Assumed: " + a);
  return page;
}

}  // namespace

CommandOutcome run_compare(const CompareRequest& request) {
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  auto output = app::OutputDir::open(request.out_dir, kCompareOutputs, {request.job_file, request.other_job});
  if (!output) return failed(output.error());
  Side shaped_side, milled_side;
  if (auto errors = read_sides(request, shaped_side, milled_side); !errors.empty()) return failed(std::move(errors));

  auto milled_or = clock.run("milled", [&] {
    return flow::cut_flanks(milled_side.job, {kCompareRows, kCompareColumns}, *output, request.quiet);
  });
  if (auto* e = milled_or.refused()) return failed(std::move(*e));
  const process::CutFlanks& milled = milled_or.value();
  auto shaped_or =
      clock.run("shaped", [&] { return face::shaped_flanks(shaped_side.job, *shaped_side.gear, milled.flanks); });
  if (auto* e = shaped_or.refused()) return failed(std::move(*e));
  const process::CutFlanks& shaped = shaped_or.value();
  const auto flanks = compared(shaped, milled);
  auto contact = compared_contact(milled_side, shaped, milled, clock);
  if (auto* e = contact.refused()) return failed(std::move(*e));

  nlohmann::ordered_json json = comparison_json(shaped_side, milled_side, shaped, milled, flanks);
  json["contact"] = contact.value().rows;
  page::StudyPage page = page_about(shaped_side, milled_side, shaped, milled);
  page.figures = maps_of(flanks);
  page.tables = {time_table(shaped, milled), deviation_table(flanks), contact.value().table};

  CommandOutcome outcome;
  outcome.report_json = json_text(json, 2) + "\n";
  outcome.summary = page.title + "\n";
  for (const auto& table : page.tables) outcome.summary += "\n" + page::table_text(table);
  outcome.summary += "\nfiles in " + request.out_dir + "\n";
  const process::NamedFiles files = {{"compare.csv", csv_of(flanks)},
                                     {"compare.json", outcome.report_json},
                                     {"compare.html", page::study_page_html(page)}};
  progress.clear();
  return process::finished(*output, files, std::move(outcome));
}

void add_compare(Commands& commands) {
  commands.push_back(command_of<CompareRequest>(
      "compare", "one gear shaped and milled: deviations on the same places, times",
      [](OptionSet& set, CompareRequest& request) {
        set.file("SHAPED", request.job_file, "job file with [shaping]");
        set.file("MILLED", request.other_job, "job file with operations of the same gear");
        set.out_dir(request.out_dir);
        set.examples({"compare shaped.toml milled.toml"});
      },
      run_compare));
}

}  // namespace toothpath::commands
