#include "app/process/cad/cad_files.h"

#include "app/process/gear_files.h"
#include "geometry/exchange/gltf.h"
#include "geometry/exchange/step_gear.h"
#include "geometry/exchange/three_mf.h"

namespace toothpath::cad {
namespace {

constexpr const char *kStep = "gear.step", *kThreeMf = "gear.3mf", *kGltf = "gear.glb";

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

}  // namespace

const std::vector<std::string>& file_names() {
  static const std::vector<std::string> names = {kStep, kThreeMf, kGltf};
  return names;
}

Result<std::optional<report::CadReport>> write_files(const FilesAsked& asked, const job::Job& job,
                                                     const process::GearProcess& gear, app::OutputDir& output,
                                                     app::StageClock& clock, std::vector<std::string>& files) {
  process::GearFiles to(output, files);
  std::optional<report::CadReport> report;
  if (asked.step) {
    auto made = clock.run("STEP", [&] { return make_step(gear, job.name); });
    if (!made) return process::located(job, "gear", made.error());
    if (const auto s = to.write(kStep, made->text); !s) return s.error();
    report = std::move(made->report);
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
      const auto pitch = gear.pitch_mesh();
      return pitch ? exchange::gltf_file(*pitch, gear.part().teeth, job.name) : Result<std::string>(pitch.error());
    });
    if (!text) return process::located(job, "gear", text.error());
    if (const auto s = to.write(kGltf, text); !s) return s.error();
  }
  return report;
}

}  // namespace toothpath::cad
