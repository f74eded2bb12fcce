#include "app/process/face/shaper_setup.h"

#include <filesystem>

#include "machines/machine_file.h"
#include "postproc/shaper/control.h"

namespace toothpath::face {

process::ValueOrErrors<machines::ShaperMachine> load_shaper_machine(const job::Job& job) {
  if (job.machine.file.empty()) return std::vector{fail_at(job.where(""), "the job lacks the table [machine]")};
  const auto path =
      machines::find_machine_file(job.machine.file, std::filesystem::path(job.file).parent_path().string(), job.file);
  if (!path) return std::vector{process::located(job, "machine.file", path.error())};
  const auto file = machines::open_machine_file(*path);
  if (!file) return std::vector{process::located(job, "machine.file", file.error())};
  if (file->kind != machines::MachineKind::gear_shaper)
    return std::vector{fail_at(job.where("machine.file"),
                               "{} is a milling machine, but this command needs a gear shaper", job.machine.file)};
  auto reading = shaper::read_shaper_machine_of_text(file->text, file->path);
  if (!reading.machine) return std::move(reading.errors);
  if (reading.machine->assumed && !job.machine.accept_assumed) {
    std::string names;
    for (const auto& name : reading.machine->assumed_keys) names += (names.empty() ? "" : ", ") + name;
    return std::vector{fail_at(job.where("machine.file"),
                               "{} has assumed values ({}); measure them, or accept them with accept_assumed = true",
                               job.machine.file, names)};
  }
  return std::move(*reading.machine);
}

process::ValueOrErrors<shaper::ShaperSetup> plan_shaper(const job::Job& job, const face_gear::FaceGear& gear,
                                                        const machines::ShaperMachine& machine) {
  for (const auto& ring : gear.rings())
    if (ring.modification)
      return std::vector{process::located(
          job, "gear.modification[0]",
          fail("modification: a gear shaper makes the plain flanks of its cutter's involute, not modified ones; mill "
               "this gear, or leave the modifications out"))};
  if (!job.shaping) return std::vector{fail_at(job.where(""), "the job lacks the table [shaping]")};
  shaper::ShaperWork work;
  work.job_name = job.name;
  work.machine_file = job.machine.file;
  work.gear = gear.parameters();
  work.shaping = *job.shaping;
  auto planned = shaper::plan_shaper_setup(work, machine);
  if (auto* setup = planned.value_if()) return std::move(*setup);
  std::vector<Diagnostic> errors;
  for (auto& refusal : planned.error())
    errors.push_back(process::located(job, refusal.key, std::move(refusal.diagnostic)));
  return errors;
}

process::ValueOrErrors<shaper::ShaperSetup> shaper_setup_of(const job::Job& job, const face_gear::FaceGear& gear) {
  auto loaded = load_shaper_machine(job);
  if (auto* errors = loaded.refused()) return std::move(*errors);
  return plan_shaper(job, gear, loaded.value());
}

}  // namespace toothpath::face
