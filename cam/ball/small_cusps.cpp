#include "cam/ball/small_cusps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cam/ball/pass_count.h"
#include "cam/ball/sheet_pass.h"
#include "geometry/base/refusals.h"

namespace toothpath::ball {
namespace {

constexpr double kHigher = 1.05;  // from one height that is tried to the next

/// What the regions of a sheet ask for: passes side by side with the heights of the options, and points of a pass.
class Counted {
 public:
  Counted(const tooth_space::OffsetSheet& sheet, const FinishingOptions& options) : sheet_(sheet), o_(options) {
    const PassCount count(sheet, options, 0);
    for (std::size_t j = 0; j < sheet.stations().size(); ++j)
      for (int piece = 0; piece < 5; ++piece) {
        const double passes = count.count_at(j, piece + 1) - count.count_at(j, piece);
        widest_[std::size_t(piece)] = std::max(widest_[std::size_t(piece)], passes);
      }
  }
  /// Of one region, with another height: cusps grow with the square of the step-over.
  [[nodiscard]] double passes(path::Region region, double scallop_mm) const {
    double sum = 0;
    for (int piece = 0; piece < 5; ++piece)
      if (o_.regions[region] && FinishingOptions::region_at(piece + 0.5) == region) sum += widest_[std::size_t(piece)];
    return sum * std::sqrt(o_.scallop_mm[region] / scallop_mm);
  }
  [[nodiscard]] double passes(const path::ByRegion<double>& scallop_mm) const {
    double sum = 0;
    for (const path::Region region : path::kRegions) sum += passes(region, scallop_mm[region]);
    return sum;
  }
  /// Of passes along the middles of the asked pieces, as far as they can be followed.
  [[nodiscard]] double points_of_a_pass() const {
    double points = 0, followed = 0;
    for (int piece = 0; piece < 5; ++piece) {
      const double sigma = piece + 0.5;
      if (!o_.regions[FinishingOptions::region_at(sigma)]) continue;
      const auto made = make_sheet_pass(sheet_, o_, {[sigma](double) { return sigma; }, {}, sigma < 2.5});
      if (!made || made->pass.points.empty()) continue;
      points += double(made->pass.points.size());
      ++followed;
    }
    return followed > 0 ? points / followed : 0;
  }

 private:
  const tooth_space::OffsetSheet& sheet_;
  const FinishingOptions& o_;
  std::array<double, 5> widest_{};  ///< passes over each piece of the sheet, where it has the most
};

}  // namespace

double finishing_places(const tooth_space::OffsetSheet& sheet, const FinishingOptions& options) {
  const Counted counted(sheet, options);
  return counted.points_of_a_pass() * counted.passes(options.scallop_mm);
}

std::optional<Refusal> cusps_too_small(const tooth_space::OffsetSheet& sheet, const FinishingOptions& o) {
  if (sheet.empty()) return {};
  const Counted counted(sheet, o);
  const double points = counted.points_of_a_pass(), all = counted.passes(o.scallop_mm);
  if (points * all <= double(kMostPlaces)) return {};
  const auto does = [&](const path::ByRegion<double>& scallop_mm) {
    return points * counted.passes(scallop_mm) <= double(kMostPlaces);
  };
  path::Region most = path::Region::flank;
  bool alike = true;
  double least_asked = INFINITY, first = NAN;
  for (const path::Region region : path::kRegions) {
    if (!o.regions[region]) continue;
    if (std::isnan(first)) first = o.scallop_mm[region];
    alike = alike && o.scallop_mm[region] == first;
    least_asked = std::min(least_asked, o.scallop_mm[region]);
    if (counted.passes(region, o.scallop_mm[region]) > counted.passes(most, o.scallop_mm[most])) most = region;
  }
  const double both = told_that_does(least_asked, kHigher, o.ball_radius_mm,
                                     [&](double mm) { return does(path::ByRegion<double>::everywhere(mm)); });
  const double alone = alike ? both : told_that_does(o.scallop_mm[most], kHigher, o.ball_radius_mm, [&](double mm) {
    path::ByRegion<double> scallop_mm = o.scallop_mm;
    scallop_mm[most] = mm;
    return does(scallop_mm);
  });
  std::string help = fmt::format("{:g} mm {}does", both, alike ? "or more " : "for all regions ");
  if (!alike && alone < o.ball_radius_mm) help = fmt::format("{:g} mm or more does, or {}", alone, help);
  return Refusal{
      alike ? "scallop" : fmt::format("scallop.{}", to_string(most)),
      fail("scallop = {:g} mm makes about {:.2g} places of one tooth space ({:.2g} passes), more than {}: minutes of "
           "planning and proof; {}",
           o.scallop_mm[most], points * all, all, kMostPlaces, help)};
}

}  // namespace toothpath::ball
