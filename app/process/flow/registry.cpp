#include "app/process/flow/registry.h"

#include "app/process/bevel/process.h"
#include "app/process/cylinder/process.h"
#include "app/process/face/process.h"
#include "app/process/flank_grid/process.h"
#include "app/process/spiral_bevel/process.h"
#include "app/process/straight_bevel/process.h"

namespace toothpath::flow {
namespace {

using Made = process::ValueOrErrors<std::unique_ptr<process::GearProcess>>;

// A line a gear type: the parameters in the job, and who works on them. A type of gear without its line does not
// compile.
Made process_of(const face_gear::FaceGearParameters&, const job::Job& job) { return face::make_process(job); }
Made process_of(const bevel_gear::BevelGearParameters&, const job::Job& job) { return bevel::make_process(job); }
Made process_of(const cylindrical::CylindricalParameters&, const job::Job& job) { return cylinder::make_process(job); }
Made process_of(const straight_bevel::StraightBevelParameters&, const job::Job& job) {
  return straight_bevel::make_process(job);
}
Made process_of(const spiral_bevel::SpiralBevelParameters&, const job::Job& job) {
  return spiral_bevel::make_process(job);
}
Made process_of(const flank_grid::FlankGridParameters&, const job::Job& job) { return flank_grid::make_process(job); }

}  // namespace

Made make_process(const job::Job& job) {
  return std::visit([&](const auto& gear) { return process_of(gear, job); }, job.gear);
}

}  // namespace toothpath::flow
