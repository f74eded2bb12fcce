#include "app/process/flow/contour.h"

#include <cmath>

#include "app/process/gear_of_job.h"

namespace toothpath::flow {
namespace {

constexpr double kShares[] = {1.0 / 16, 1.0 / 8, 1.0 / 4, 1.0 / 2, 7.0 / 8};  // the rest is for what is rounded
constexpr double kUsualShare = 1.0 / 2;                                       // where no time tells
constexpr double kLargest = 0.02;                                             // mm
constexpr double kDigits = 1e4;                                               // of the word: 0.1 um
constexpr double kSure = 0.9;  // of what is told to fit: the proof is not linear to the last digit
constexpr double kSameTime = 1e-3;
constexpr double kWorthWhile = 1.25;  // of the narrow tolerance

/// Largest tolerance that counts as no more than this, mm.
double largest_for(const process::PostRequest& request, const process::PostedProgram& posted, double counted_mm) {
  double fits = 0, too_much = kLargest;
  if (process::counted_contour(request, posted, kLargest) <= counted_mm) fits = kLargest;
  for (int step = 0; step < 24 && fits < kLargest; ++step) {
    const double middle = 0.5 * (fits + too_much);
    (process::counted_contour(request, posted, middle) <= counted_mm ? fits : too_much) = middle;
  }
  return std::floor(fits * kDigits) / kDigits;
}

}  // namespace

std::optional<double> contour_to_grant(const process::PostRequest& request, const process::PostedProgram& posted,
                                       double left_mm) {
  if (!process::takes_contour(request.machine) || !(left_mm > 0)) return std::nullopt;
  const auto of_share = [&](double share) { return largest_for(request, posted, posted.blend_mm + share * left_mm); };
  const auto worth = [&](double mm) -> std::optional<double> {
    if (mm < kWorthWhile * process::narrow_contour(request)) return std::nullopt;
    return mm;
  };
  if (!posted.axes.has_acceleration) return worth(of_share(kUsualShare));
  const double narrow = process::first_teeth_minutes(request, posted, std::nullopt),
               least = process::first_teeth_minutes(request, posted, of_share(std::end(kShares)[-1]));
  if (least > narrow * (1 - kSameTime)) return std::nullopt;
  for (const double share : kShares)
    if (const double mm = of_share(share);
        worth(mm) && process::first_teeth_minutes(request, posted, mm) <= least * (1 + kSameTime))
      return mm;
  return std::nullopt;
}

std::optional<Diagnostic> contour_refusal(const process::PostRequest& request, const process::PostedProgram& posted,
                                          double over_mm) {
  const double asked = *request.contour_mm, fits = kSure * largest_for(request, posted, posted.blend_mm - over_mm),
               most = std::floor(fits * kDigits) / kDigits;
  if (!(most > 0)) return std::nullopt;
  Diagnostic bad = fail(
      "program.contour_tolerance = {:g} mm does not fit into [verify] gouge_tolerance = {:g} mm: what "
      "the proof counts beside it leaves {:g} mm",
      asked, request.job.verify.gouge_tolerance_mm, most);
  bad.kind = DiagnosticKind::verification;
  return process::located(request.job, "program.contour_tolerance", bad);
}

}  // namespace toothpath::flow
