// How two gears with a job each stand to each other: which carries the grid, their shafts, read from the keys of both.
#pragma once

#include <memory>

#include "app/process/gear_process.h"
#include "geometry/contact/toothed_pair.h"

namespace toothpath::toothed_pair {

/// A gear with its job; both outlive what is made of them.
struct JobGear {
  const job::Job& job;
  std::shared_ptr<const tooth_space::ToothedPart> part;
};

/// Where the shafts stand, without misalignments.
struct Shafts {
  bool job_is_gear = true;      ///< the gear of the job carries the grid; else that of the mate
  bool pinion_carries = false;  ///< and has fewer teeth, or is the pinion of a face gear
  double angle_rad = 0, distance_mm = 0;
  bool skew = false;  ///< cylindrical gears whose shafts are turned about the line of centres
  /// Of the other gear to that which carries the grid.
  contact::MatePlace (*place)(const Shafts&, const JobGear& carrier, const JobGear& other,
                              const contact::Misalignment& moved) = nullptr;
};

/// The gear with more teeth carries the grid, a face gear before its pinion; but as cut or as measured that of the job.
/// Parallel shafts of cylindrical gears stand at the distance without backlash, as crossed ones without profile shift
/// do; bevel gears have their crossing points together. Refused, each with its place: gears that cannot mesh, a
/// quantity that neither the keys nor the options say, an option that the keys contradict.
[[nodiscard]] process::ValueOrErrors<Shafts> shafts_of(const JobGear& job, const JobGear& mate,
                                                       const process::ContactAsked& asked);

}  // namespace toothpath::toothed_pair
