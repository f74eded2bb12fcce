#include "app/process/face/contact.h"

#include "app/base/units.h"
#include "app/process/face/searched_pair.h"
#include "app/process/rolled/figures.h"
#include "app/process/under_load/loaded_page.h"
#include "app/process/under_load/settings.h"

namespace toothpath::face {
namespace {

/// What can be said of the flanks of a face gear with the pinion of its shaper.
std::string about(const rolled::RolledPair& a) {
  return rolled::is_modified(a)
             ? "The flanks are modified: the transmission error is what they depart from each other along the path of "
               "contact, and at its ends where one pair takes over from the other."
             : "A pinion with fewer teeth than the shaper touches the exact flank in one point that runs along a "
               "straight line of the housing; a pinion that is the shaper touches along lines. In both cases the "
               "transmission error is a constant, aligned or not, as long as contact stays inside the flank.";
}

/// The table of misalignments, and what keeps the pattern inside over its box, as far as that is asked for.
process::ValueOrErrors<ease_off::Misaligned> misalign(const job::Job& job, const face_gear::FaceGear& gear,
                                                      const process::ContactAsked& asked, const rolled::RolledPair& a,
                                                      app::StageClock& clock) {
  const ContactGrid grid;
  contact::RollOptions roll;
  roll.steps = grid.steps;
  roll.compound_mm = a.settings.compound_mm;
  const std::string modify = asked.modify.empty() ? job.shaping ? "pinion" : "both" : asked.modify;
  const auto pair = searched_pair({&job, &gear, a.pinion_teeth, a.settings, modify, roll, grid.rows, grid.columns});
  return ease_off::misalign(*pair, job, a.settings, asked, modify, clock);
}

}  // namespace

process::ValueOrErrors<process::CutFlanks> measured_flanks(const face_gear::FaceGear& gear,
                                                           const job::MeasuredInput& measured) {
  const auto fitted = job::correct_gear(gear, measured);
  if (!fitted) return std::vector{fitted.error()};
  process::CutFlanks out;
  out.route = "measured";
  out.warnings = fitted->fit.warnings;
  for (const auto& f : fitted->fit.flanks) out.warnings.push_back(process::words_of_fit(f.zone, f.side, f.residual));
  const ContactGrid grid;
  for (int zone = 0; zone < static_cast<int>(gear.rings().size()); ++zone)
    for (const int side : {1, -1}) {
      const auto flank = contact::exact_flank(gear, zone, side, grid.rows, grid.columns);
      if (!flank) return std::vector{flank.error()};
      process::CutFlanks::Flank f{zone, side, flank->rows, flank->columns, flank->points, flank->normals, {}};
      const auto& target = fitted->fit.rings[static_cast<std::size_t>(zone)]->side(side);
      for (std::size_t k = 0; k < flank->points.size(); ++k)
        f.deviation_mm.push_back(-target.at(flank->theta[k], radius(flank->points[k])).value);
      out.flanks.push_back(std::move(f));
    }
  return out;
}

process::ValueOrErrors<process::ContactFound> roll_pair(const job::Job& job, const face_gear::FaceGear& gear,
                                                        const process::ContactAsked& asked,
                                                        const process::CutFlanks* cut, app::StageClock& clock) {
  std::optional<process::CutFlanks> measured;
  if (!asked.measured.files.empty()) {
    auto read = clock.run("measured", [&] { return measured_flanks(gear, asked.measured); });
    if (auto* errors = read.refused()) return std::move(*errors);
    measured = std::move(read).value();
    cut = &*measured;
  }
  auto analysed =
      clock.run("contact", [&] { return analyse_contact(job, gear, under_load::contact_settings(job, asked), cut); });
  if (auto* errors = analysed.refused()) return std::move(*errors);
  rolled::RolledPair& analysis = analysed.value();
  if (cut != nullptr) {
    for (auto& note : process::notes_of(*cut)) analysis.notes.push_back(std::move(note));
    if (measured) analysis.notes.insert(analysis.notes.end(), measured->warnings.begin(), measured->warnings.end());
  }
  if (!asked.ccx_dir.empty() && !analysis.loaded)
    return std::vector{fail_at(job.where(""), "--ccx needs a load: --torque or [contact.load]")};
  process::ContactFound found;
  auto misaligned = misalign(job, gear, asked, analysis, clock);
  if (auto* errors = misaligned.refused()) return std::move(*errors);
  analysis.misaligned = std::move(misaligned).value();
  found.missed = analysis.misaligned.missed();
  found.job_text = analysis.misaligned.job_text;
  found.json = rolled::contact_json(analysis);
  found.summary = rolled::contact_summary(analysis);
  found.files = rolled::contact_files(analysis, about(analysis));
  if (analysis.loaded) {
    under_load::add_files(found.files, *analysis.loaded);
    if (!asked.ccx_dir.empty()) {
      auto decks = loaded_decks(job, gear, *analysis.loaded);
      if (auto* errors = decks.refused()) return std::move(*errors);
      found.decks = std::move(decks).value();
    }
  }
  return found;
}

std::string contact_section(const job::Job& job, const face_gear::FaceGear& gear,
                            const std::vector<proof::SurfaceGrid>& surface, std::vector<std::string>& warnings) {
  if (!job.contact) return {};
  process::CutFlanks cut;
  cut.route = "milled";
  cut.flanks = process::flanks_of(surface);
  auto analysed = analyse_contact(job, gear, *job.contact, cut.flanks.empty() ? nullptr : &cut);
  if (const auto* errors = analysed.refused()) {
    warnings.push_back("no contact analysis: " + errors->front().message);
    return {};
  }
  auto& analysis = analysed.value();
  if (!analysis.route.empty())
    analysis.notes.emplace_back(
        "The cut surface is taken from the report's grid, which does not resolve every cusp: for its transmission "
        "error run `toothpath contact --as-cut`.");
  return rolled::contact_section_body(analysis);
}

}  // namespace toothpath::face
