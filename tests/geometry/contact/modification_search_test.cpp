// The search for modifications: its model against rolling, its optimum against trying everything, threads.
#include "geometry/contact/modification_search.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cmath>
#include <tuple>

#include "tests/support/face_gear_cases.h"
#include "tests/support/sample_gears.h"

namespace toothpath::test {
namespace {

using contact::SearchedModification;
using modification::Kind;

const std::vector<SearchedModification>& crowning_and_relief() {
  static const std::vector<SearchedModification> list = {{false, Kind::lead_crowning, {}, false, {}},
                                                         {false, Kind::helix_angle_slope, {}, true, {}},
                                                         {false, Kind::tip_relief, {}, false, {1.2, 1.6}},
                                                         {true, Kind::tip_relief, {}, false, {1.2, 1.6}}};
  return list;
}

contact::MisalignedContact rolled(const std::vector<double>& amounts, const std::vector<int>& lengths, int side,
                                  const contact::Misalignment& moved, int rows, int columns, int steps) {
  std::vector<modification::Modification> on_gear, on_pinion;
  for (std::size_t n = 0; n < amounts.size(); ++n) {
    const auto& s = crowning_and_relief()[n];
    (s.on_pinion ? on_pinion : on_gear).push_back(contact::modification_of(s, amounts[n], lengths[n], side));
  }
  const face_gear::FaceGear gear = modified_spur(on_gear);
  auto flank = contact::exact_flank(gear, 0, side, rows, columns);
  if (!flank) throw std::invalid_argument(flank.error().message);
  contact::PairSide pair{&gear, {*flank}, 20, on_pinion};
  auto found = contact::misaligned_contact(pair, moved, {.steps = steps}, 0.05);
  if (!found) throw std::invalid_argument(found.error().message);
  return *found;
}

/// The model and the roll of the same modifications: error and margin on grids that grow, with the time of a candidate
/// beside it.
TEST(ModificationSearch, ModelAgreesWithTheRoll) {
  const face_gear::FaceGear gear = modified_spur();
  const std::vector<double> amounts = {0.011, 0.003, 0.012, 0.010};
  const std::vector<int> lengths = {0, 0, 1, 0};
  const double lever = gear.rings()[0].surface.M2;
  std::printf("  | places | turns | error um | margin gap um | off um | us a candidate |\n");
  for (const contact::Misalignment& moved : {contact::Misalignment{}, contact::Misalignment{0.01, 0.01, 0.0005, 0.01}})
    for (const int side : {1, -1}) {
      const auto exact = rolled(amounts, lengths, side, moved, 41, 49, 96);
      double last = 1, margin = 0;
      for (const auto& [rows, columns, turns] : {std::tuple(13, 13, 12), {25, 25, 24}, {41, 49, 48}}) {
        contact::SearchOptions options;
        options.rows = rows;
        options.columns = columns;
        options.steps = turns;
        const auto model = contact::SearchModel::make(gear, side, 20, {}, moved, crowning_and_relief(), options);
        ASSERT_TRUE(model) << model.error().message;
        const auto begin = std::chrono::steady_clock::now();
        const auto judged = model->judge(amounts, lengths);
        const auto end = std::chrono::steady_clock::now();
        const double off = std::abs(judged.error_mm - exact.error_range_rad * lever) * 1e3;
        std::printf("  | %d x %d | %d | %.4f | %.3f | %.4f | %.0f |\n", rows, columns, turns, judged.error_mm * 1e3,
                    judged.margin_gap_mm * 1e3, off, std::chrono::duration<double, std::micro>(end - begin).count());
        last = off;
        margin = judged.margin_gap_mm;
      }
      // What is left: the pinion's reliefs move the place that a place of the gear mates with.
      EXPECT_LT(last, 0.06);
      EXPECT_NEAR(margin, exact.margin_gap_mm, 4e-4);
      EXPECT_GT(exact.error_range_rad * lever, 1e-4);
    }
}

/// No candidate of an exhaustive lattice is better than what the descent finds; one and four threads find the same.
TEST(ModificationSearch, FindsWhatTryingEverythingFinds) {
  const face_gear::FaceGear gear = modified_spur();
  contact::SearchOptions options;
  options.rows = options.columns = 17;
  options.steps = 12;
  options.compound_mm = 0.004;
  std::vector<contact::SearchModel> models;
  for (const contact::Misalignment& moved :
       {contact::Misalignment{}, contact::Misalignment{0.01, 0, 0.0004}, contact::Misalignment{-0.01, 0, -0.0004}}) {
    auto model = contact::SearchModel::make(gear, 1, 20, {}, moved, crowning_and_relief(), options);
    ASSERT_TRUE(model) << model.error().message;
    models.push_back(std::move(*model));
  }
  std::vector<contact::SearchResult> results;
  for (const std::size_t threads : {1u, 4u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(contact::search_modifications(models, crowning_and_relief(), options.compound_mm, options));
  }
  EXPECT_EQ(results[0].units, results[1].units);
  EXPECT_EQ(results[0].lengths, results[1].lengths);
  EXPECT_EQ(results[0].judged, results[1].judged);
  ASSERT_TRUE(results[0].inside);
  double best = 1;
  long tried = 0;
  for (double lead = 0; lead < 0.0245; lead += 0.002)
    for (double slope = -0.008; slope < 0.0085; slope += 0.004)
      for (double tip = 0; tip < 0.0205; tip += 0.002)
        for (double on_pinion = 0; on_pinion < 0.0205; on_pinion += 0.002)
          for (const int length : {0, 1}) {
            double error = 0, gap = 1;
            for (const auto& model : models) {
              const auto judged = model.judge({lead, slope, tip, on_pinion}, {0, 0, length, length});
              error = std::max(error, judged.error_mm);
              gap = std::min(gap, judged.margin_gap_mm);
              if (error >= best) break;
            }
            ++tried;
            if (gap >= options.compound_mm) best = std::min(best, error);
          }
  std::printf("  %ld candidates of the lattice: %.4f um; the search: %.4f um after %ld\n", tried, best * 1e3,
              results[0].error_mm * 1e3, results[0].judged);
  ASSERT_LT(best, 1);
  EXPECT_LE(results[0].error_mm, best + 2e-5);
}

/// Where amounts may not be large enough the search says so, and which edge is in the way.
TEST(ModificationSearch, SaysWhenThereIsNone) {
  const face_gear::FaceGear gear = modified_spur();
  contact::SearchOptions options;
  options.rows = options.columns = 13;
  options.steps = 12;
  options.largest_mm = 0.004;  // below the compound
  auto model = contact::SearchModel::make(gear, 1, 20, {}, {}, crowning_and_relief(), options);
  ASSERT_TRUE(model) << model.error().message;
  const auto found = contact::search_modifications({*model}, crowning_and_relief(), options.compound_mm, options);
  EXPECT_FALSE(found.inside);
  EXPECT_LT(found.margin_gap_mm, options.compound_mm);
  for (const int u : found.units) EXPECT_LE(std::abs(u), 40);
}

/// Of nearly equal errors the least removal: what does nothing is gone, and no amount is left that could be 0 or a unit
/// less, with end reliefs to choose from and with useless ones planted in the start.
TEST(ModificationSearch, NothingIsTakenThatNeedNotBe) {
  const face_gear::FaceGear gear = modified_spur();
  auto searched = crowning_and_relief();
  searched.push_back({false, Kind::end_relief, {}, false, {0.6, 1.2}});
  searched.push_back({false, Kind::root_relief, 1, false, {1.0}});  // of a ring that the gear has not
  contact::SearchOptions options;
  options.rows = options.columns = 17;
  options.steps = 12;
  options.compound_mm = 0.004;
  for (const int side : {1, -1}) {
    std::vector<contact::SearchedSide> sides(1);
    sides[0] = {side, {}, options.compound_mm};
    for (const contact::Misalignment& moved :
         {contact::Misalignment{}, contact::Misalignment{0.01, 0, 0.0004}, contact::Misalignment{-0.01, 0, -0.0004}}) {
      auto model = contact::SearchModel::make(gear, side, 20, {}, moved, searched, options);
      ASSERT_TRUE(model) << model.error().message;
      sides[0].models.push_back(std::move(*model));
    }
    auto planted = contact::search_modifications(sides, searched, options);
    std::vector<contact::SearchResult> results = {planted};
    planted.units[4] = planted.units[5] = 1000;
    results.push_back(contact::search_modifications(sides, searched, options, &planted));
    for (const auto& found : results) {
      ASSERT_TRUE(found.inside);
      const double most = options.nearly_equal_to(found.least_error_mm[0]);
      EXPECT_LE(found.error_mm, most);
      EXPECT_EQ(found.units[5], 0);
      EXPECT_LT(found.removal.most_mm, 0.08) << "of the 0.1 mm that are planted little is left";
      std::printf("  side %+d: error %.3f um, least %.3f, removal %.1f um:", side, found.error_mm * 1e3,
                  found.least_error_mm[0] * 1e3, found.removal.most_mm * 1e3);
      for (const int u : found.units) std::printf(" %.1f", u / 10.0);
      std::printf("\n");
      EXPECT_GE(found.without.size(), 2u);
      for (std::size_t n = 0; n < searched.size(); ++n)
        for (const int left : {0, found.units[n] - (found.units[n] > 0 ? 1 : -1)}) {
          if (found.units[n] == 0) continue;
          std::vector<double> amounts;
          for (const int u : found.units) amounts.push_back(u * options.unit_mm);
          amounts[n] = left * options.unit_mm;
          double error = 0, gap = 1;
          for (const auto& model : sides[0].models) {
            const auto judged = model.judge(amounts, found.lengths);
            error = std::max(error, judged.error_mm);
            gap = std::min(gap, judged.margin_gap_mm);
          }
          EXPECT_TRUE(error > most || gap < options.compound_mm + 2e-9)
              << to_string(searched[n].kind) << " need not be more than " << left << " units: error " << error;
        }
    }
  }
}

}  // namespace
}  // namespace toothpath::test
