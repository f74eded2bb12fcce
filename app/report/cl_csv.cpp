#include "app/report/cl_csv.h"

#include <fmt/format.h>

#include <iterator>

namespace toothpath::report {
namespace {

/// A coordinate whose printed digits are all zero loses its sign.
double without_negative_zero(double value, double half_step) { return value < 0 && value > -half_step ? 0.0 : value; }

}  // namespace

std::string cl_csv(std::span<const path::ClPath* const> paths) {
  fmt::memory_buffer out;
  fmt::format_to(std::back_inserter(out), "op,tooth,zone,pass,x,y,z,i,j,k,feed,kind\n");
  for (const path::ClPath* path : paths)
    for (const path::ClRecord& record : path->records) {
      fmt::format_to(std::back_inserter(out), "{},0,{},{}", path->operation, record.zone, record.pass);
      for (const double x : record.tip)
        fmt::format_to(std::back_inserter(out), ",{:.7f}", without_negative_zero(x, 0.5e-7));
      for (const double x : record.axis)
        fmt::format_to(std::back_inserter(out), ",{:.9f}", without_negative_zero(x, 0.5e-9));
      fmt::format_to(std::back_inserter(out), ",{:.3f},{}\n", record.feed_mm_min, to_string(record.kind));
    }
  return fmt::to_string(out);
}

}  // namespace toothpath::report
