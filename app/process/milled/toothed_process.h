// Everything that the commands want of a gear that stands on its tooth spaces alone: what a gear type adds are its
// numbers and words.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/process/gear_process.h"
#include "app/process/milled/bodies.h"
#include "app/process/milled/body.h"
#include "app/process/milled/tooth_data.h"
#include "geometry/tooth_space/toothed_part.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::milled {

/// A gear type as the commands see it.
struct ToothedGear {
  std::shared_ptr<const tooth_space::ToothedPart> part;
  tooth_space::ToothedSolid solid;  ///< its spaces live as long as `owner`
  std::shared_ptr<const void> owner;
  process::PartFacts facts;
  double least_land_mm = 0;  ///< of the tips: modifications that leave less are told
  double above_mm = 0;       ///< stock on the tips
  GearBody body;
  sheet::PartOutline outline;
  std::string subtitle;  ///< of the page, without the machine
  std::function<std::string()> limits_json;
  std::vector<svg::LineChart> limit_charts;      ///< one a zone
  std::vector<proof::LedgerEntry> ledger = {};   ///< what this gear type adds to it
  std::vector<sheet::DataGroup> data = {};       ///< of the drawing, for the data sheet
  std::vector<ThicknessPlace> measured_at = {};  ///< where that states the thickness; empty: the middle of each zone
};

/// A gear type that has more to say derives from it. The job must outlive it.
class ToothedProcess : public process::GearProcess {
 public:
  ToothedProcess(const job::Job& job, ToothedGear gear) : job_(job), gear_(std::move(gear)), aimed_(gear_.part) {}

  /// The job's modifications of the drawing. Refused: those that do not fit, at their keys.
  [[nodiscard]] Status modify();

  [[nodiscard]] const process::PartFacts& part() const override { return gear_.facts; }
  [[nodiscard]] Result<process::Correction> correct(const job::MeasuredInput& measured,
                                                    app::StageClock& clock) override;
  [[nodiscard]] joints::ClearanceBody link_body(const machines::Machine&) const override { return gear_.body.links; }
  [[nodiscard]] sheet::PartOutline outline() const override { return gear_.outline; }
  [[nodiscard]] page::GearOnPage on_page(const std::string& machine_name) const override;
  [[nodiscard]] std::string limits_json() const override { return gear_.limits_json(); }
  [[nodiscard]] Result<process::InspectedFlanks> inspected(const process::GridAsked& asked = {}) const override;
  [[nodiscard]] std::vector<svg::LineChart> limit_charts() const override { return gear_.limit_charts; }
  [[nodiscard]] Result<process::SceneGear> scene(double clearance_mm) const override;
  [[nodiscard]] Result<process::FinishedGear> solid() const override;
  [[nodiscard]] Result<mesh::TriangleMesh> mesh() const override;
  [[nodiscard]] Result<mesh::TriangleMesh> pitch_mesh(process::FacetSize size) const override;
  [[nodiscard]] rest::Blank blank() const override;
  [[nodiscard]] Result<exchange::GearShell> shell() const override;
  [[nodiscard]] Status write_files(app::OutputDir& output, const std::vector<proof::SurfaceGrid>& surface,
                                   const std::vector<std::string>& assumed, app::StageClock& clock,
                                   std::vector<std::string>& files) const override;
  [[nodiscard]] std::unique_ptr<process::GearMilling> milling(const machines::Machine& machine,
                                                              const proof::ProofLimits& limits,
                                                              const process::FlankGrid& grid,
                                                              app::StageClock& clock) const override;
  [[nodiscard]] process::ValueOrErrors<process::CutFlanks> shaped(const process::FlankGrid&) const override;
  [[nodiscard]] std::unique_ptr<inspection::TouchedPart> touched() const override;
  [[nodiscard]] std::shared_ptr<const tooth_space::ToothedPart> toothed() const override { return aimed_; }
  [[nodiscard]] process::ValueOrErrors<process::CutFlanks> measured(const job::MeasuredInput& measured) const override;
  [[nodiscard]] Status accepts(const process::ContactAsked&) const override;
  [[nodiscard]] process::ValueOrErrors<process::ContactFound> contact(const process::ContactAsked& asked,
                                                                      const process::CutFlanks*,
                                                                      app::StageClock&) const override;
  [[nodiscard]] std::string contact_section(const std::vector<proof::SurfaceGrid>&,
                                            std::vector<std::string>& warnings) const override {
    if (job_.contact)
      warnings.push_back("[contact] is not rolled by a run: the mate has a job of its own, toothpath contact --mate");
    return {};
  }

 protected:
  /// From now on it is another one: the flanks to aim at.
  void become(ToothedGear gear) {
    gear_ = std::move(gear);
    aimed_ = gear_.part;
  }
  [[nodiscard]] const job::Job& job() const { return job_; }
  [[nodiscard]] const ToothedGear& gear() const { return gear_; }

 public:
  /// data_sheet.html: the table of the drawing, and what is measured on the teeth of the drawing, modifications
  /// included.
  [[nodiscard]] sheet::DataSheet data_sheet() const;

 private:
  /// Where measured places lie on the flanks.
  [[nodiscard]] job::GridOfGear measured_grid() const;
  /// The flanks to aim at answer measured grids.
  [[nodiscard]] Result<process::Correction> answer(const job::MeasuredInput& measured);

  const job::Job& job_;
  ToothedGear gear_;
  std::shared_ptr<const tooth_space::ToothedPart> drawn_;  ///< with the modifications of the drawing; none: plain
  std::shared_ptr<const tooth_space::ToothedPart> aimed_;  ///< with the answer to a measurement
};

/// The gear with the modifications of the job, which must outlive it. Refused: modifications that do not fit.
[[nodiscard]] process::ValueOrErrors<std::unique_ptr<process::GearProcess>> toothed_process(const job::Job& job,
                                                                                            ToothedGear gear);

}  // namespace toothpath::milled
