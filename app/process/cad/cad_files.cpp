#include "app/process/cad/cad_files.h"

#include <algorithm>

#include "app/process/gear_files.h"
#include "cam/path/operation.h"
#include "cam/rest/rest_mesh.h"
#include "geometry/base/angle.h"
#include "geometry/exchange/gltf.h"
#include "geometry/exchange/step_gear.h"
#include "geometry/exchange/three_mf.h"

namespace toothpath::cad {
namespace {

constexpr const char *kStep = "gear.step", *kThreeMf = "gear.3mf", *kGltf = "gear.glb", *kBlank = "blank.stl",
                     *kRoughed = "roughed.stl";
constexpr double kRemoved_mm = 0.01;   ///< what is said to be removed may be too much by it
constexpr double kCellsOfHeight = 24;  ///< cells of a roughed part, as shares of the height of its teeth

struct StepMade {
  std::string text;
  report::CadReport report;
};

Result<StepMade> make_step(const process::GearProcess& gear, const std::string& name) {
  const auto shell = gear.shell();
  if (!shell) return shell.error();
  const auto fitted = exchange::fit_shell(*shell);
  if (!fitted) return fitted.error();
  auto file = exchange::step_gear(*shell, *fitted, name);
  if (!file) return file.error();
  report::CadReport report{kStep,
                           file->counts.faces,
                           fitted->patches,
                           file->text.size(),
                           fitted->checked,
                           fitted->worst_mm,
                           exchange::kFitTolerance_mm,
                           fitted->worst_at};
  return StepMade{std::move(file->text), std::move(report)};
}

/// The blank with its pitches cut in the middle of the lands, so that all of a tooth space lies in one of them.
Result<rest::Blank> between_lands(const process::GearProcess& gear) {
  const auto shell = gear.shell();
  if (!shell) return shell.error();
  rest::Blank blank = gear.blank();
  for (std::size_t k = 0; k < blank.rings.size(); ++k) {
    rest::BlankRing& ring = blank.rings[k];
    const std::size_t strips = shell->rings[k].strips.size();
    ring.begin = [row = shell->rings[k].row, strips, pitch = kTwoPi / blank.teeth, from = ring.from,
                  to = ring.to](double s) {
      std::vector<std::vector<double>> middle(strips);
      middle.back() = {0.5};
      const auto places = row(std::clamp((s - from) / (to - from), 0.0, 1.0), middle);
      return places ? azimuth(places->back().front()) - pitch : 0.0;
    };
  }
  return blank;
}

struct RoughedMade {
  std::string text;
  report::RoughedReport report;
};

Result<RoughedMade> make_roughed(const process::GearProcess& gear, const Milled& milled, const rest::Excess& removed,
                                 const std::string& name) {
  const auto blank = between_lands(gear);
  if (!blank) return blank.error();
  const rest::BlankRing& ring = blank->rings.front();
  rest::RestOptions options;
  options.cell_mm = (ring.top(ring.from) - ring.floor) / kCellsOfHeight;
  options.within_mm = milled.off_mm + kRemoved_mm;
  const auto rest = rest::rest_mesh(*blank, removed, options);
  if (!rest) return rest.error();
  auto text = process::stl_text(rest->mesh, name);
  if (!text) return text.error();
  report::RoughedReport report{kRoughed, rest->mesh.triangles.size(), text->size(), rest->cell_mm,
                               rest->thick_mm + milled.off_mm};
  return RoughedMade{std::move(*text), std::move(report)};
}

/// Why there is no roughed.stl, and what would make one.
std::string nothing_roughs(const job::Job& job, path::OperationType roughing) {
  const bool any = !job.operations.empty();
  const SourcePosition at = job.where(any ? "operation[0]" : "operation");
  std::string text =
      fmt::format("{}:{}:{}: warning: {} is not written: no operation roughs", at.file, at.line, at.column, kRoughed);
  if (any) text += fmt::format(", and the first one ({}) cuts from the blank", to_string(job.operations.front().type));
  return text +
         fmt::format("; an [[operation]] with type = \"{}\" before it leaves a part to write", to_string(roughing));
}

Status write_stock(const job::Job& job, const process::GearProcess& gear, const std::optional<Milled>& milled,
                   app::StageClock& clock, process::GearFiles& to, Written& written) {
  const auto blank = clock.run("stock", [&]() -> Result<std::string> {
    const auto rest = rest::rest_mesh(gear.blank(), {});
    return rest ? process::stl_text(rest->mesh, job.name) : Result<std::string>(rest.error());
  });
  if (const auto s = to.write(kBlank, blank); !s) return s;
  if (!milled) return Ok{};
  const rest::Excess removed = milled->milling.roughed();
  if (!removed) {
    written.warnings.push_back(nothing_roughs(job, milled->milling.roughing()));
    return Ok{};
  }
  auto roughed = clock.run("stock", [&] { return make_roughed(gear, *milled, removed, job.name); });
  if (!roughed) return roughed.error();
  written.roughed = std::move(roughed->report);
  return to.write(kRoughed, std::move(roughed->text));
}

}  // namespace

const std::vector<std::string>& file_names() {
  static const std::vector<std::string> names = {kStep, kThreeMf, kGltf, kBlank, kRoughed};
  return names;
}

Result<Written> write_files(const FilesAsked& asked, const job::Job& job, const process::GearProcess& gear,
                            const std::optional<Milled>& milled, app::OutputDir& output, app::StageClock& clock,
                            std::vector<std::string>& files) {
  process::GearFiles to(output, files);
  Written written;
  if (asked.step) {
    auto made = clock.run("STEP", [&] { return make_step(gear, job.name); });
    if (!made) return process::located(job, "gear", made.error());
    if (const auto s = to.write(kStep, made->text); !s) return s.error();
    written.solid = std::move(made->report);
  }
  if (asked.three_mf) {
    const auto text = clock.run("3MF", [&]() -> Result<std::string> {
      const auto mesh = gear.mesh();
      return mesh ? exchange::three_mf_file(*mesh, job.name) : Result<std::string>(mesh.error());
    });
    if (!text) return process::located(job, "gear", text.error());
    if (const auto s = to.write(kThreeMf, text); !s) return s.error();
  }
  if (asked.gltf) {
    const auto text = clock.run("glTF", [&]() -> Result<std::string> {
      const auto pitch = gear.pitch_mesh(process::FacetSize::file);
      return pitch ? exchange::gltf_file(*pitch, gear.part().teeth, job.name) : Result<std::string>(pitch.error());
    });
    if (!text) return process::located(job, "gear", text.error());
    if (const auto s = to.write(kGltf, text); !s) return s.error();
  }
  if (asked.stock) {
    if (const auto s = write_stock(job, gear, milled, clock, to, written); !s)
      return process::located(job, "gear", s.error());
  }
  return written;
}

}  // namespace toothpath::cad
