// The numbers of a gear that a fit may change, by the keys of its job; and the exact flanks that such a gear has.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/job/job.h"
#include "geometry/base/refusal.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::fit {

using Gear = decltype(job::Job::gear);

struct Number {
  std::string key;             ///< within [gear]: "zone[0].helix_angle"; of a list "cut[0].blade_point_radius[1]"
  const char* unit;            ///< of job files: "deg", "mm" or ""
  double reach = 0;            ///< of a number without stated bounds: as far either way of its start
  bool usual = true;           ///< free where nobody says which numbers are
  bool where_written = false;  ///< the job has it only where it has the key
  double least = -INFINITY, most = INFINITY;  ///< what the gear type takes
  std::function<double(const Gear&)> get = {};
  std::function<void(Gear&, double)> set = {};
};

/// Those of one gear. A number that the points do not determine beside others is held: of these the one that stands
/// last.
struct Numbers {
  std::vector<Number> free;
  std::vector<Number> follow;                        ///< what a fit changes besides, so that the gear stays one
  std::function<void(Gear&)> settle = [](Gear&) {};  ///< lets them follow
  double module_mm = 0;
  int teeth = 0;
};

/// Refused, at gear.type: a type that no settings make.
[[nodiscard]] Result<Numbers> numbers_of(const job::Job& job);

/// The tooth spaces of a gear, one a zone, without a look at the limits that a gear to cut must keep.
using Spaces = std::vector<std::shared_ptr<const tooth_space::ToothSpace>>;
/// @param like  the job whose gear it would be: its modifications are on the flanks
/// Refused: numbers that make no flank.
[[nodiscard]] Expected<Spaces, Refusal> spaces_of(const Gear& gear, const job::Job& like);

}  // namespace toothpath::fit
