// The text of a proposed job, with comments.
#pragma once

#include <string>

#include "app/proposal/library_shelf.h"
#include "app/proposal/place.h"
#include "app/proposal/shelf.h"
#include "app/proposal/wishes.h"
#include "machines/machine.h"

namespace toothpath::proposal {

/// Everything that the text is made of.
struct Draft {
  std::string name;
  Wishes wishes;  ///< whole
  double spindle_rpm = 0, most_feed_mm_min = 0;
  bool assumed = false;       ///< values of the machine are
  std::string assumed_words;  ///< which of them
  std::string work_offset;
  Place place;
  Vec3 work_zero_mm = Vec3::Zero();  ///< of the work offset, machine coordinates
  bool zero_on_top = false;          ///< it is the top of the blank; else the origin of the gear
  tool::ToolAssembly first, second;  ///< roughing ball and finishing mill, numbered; a finger mill is `second`
  bool has_first = false;
  bool coarse = false;  ///< slower, and wider tolerances where nobody asked for one: for controls that count coarsely
  double depth_mm = 0;
  bool up = true;  ///< z of the gear along that of the machine
};

/// Schema, name and [gear]: what limits and tools follow from.
[[nodiscard]] std::string gear_text(const std::string& name, const Wishes& wishes);
/// The whole job.
/// @param library  of the tools, where they stand in one: the job names it
/// @param schema   URL of the schema of jobs, for editors; empty: the job names none
[[nodiscard]] std::string job_text(const Draft& draft, const LibraryWords& library, const std::string& schema);

}  // namespace toothpath::proposal
