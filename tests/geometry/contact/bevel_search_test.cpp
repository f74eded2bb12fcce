// The search for what one mill on its paths takes: its model against rolling, its optimum against trying everything.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "geometry/contact/bevel_search_model.h"
#include "tests/geometry/bevel_gear/samples.h"

namespace toothpath {
namespace {

using namespace bevel_test;
using contact::Misalignment;
using contact::SearchedModification;
using contact::SearchedSide;
using modification::Kind;

std::vector<SearchedSide> models_of(const bevel_gear::BevelGear& pinion, const bevel_gear::BevelGear& wheel,
                                    const std::vector<Misalignment>& list,
                                    const std::vector<SearchedModification>& searched,
                                    const contact::SearchOptions& options) {
  std::vector<SearchedSide> sides;
  for (const int sigma : {1, -1}) {
    sides.push_back({contact::side_of_wall(sigma), {}, options.compound_mm});
    for (const Misalignment& moved : list) {
      auto model = contact::bevel_search_model(pinion, wheel, sigma, moved, searched, options);
      if (!model) throw std::invalid_argument(model.error().message);
      sides.back().models.push_back(std::move(*model));
    }
  }
  return sides;
}

/// What a mill can make, and nothing else: profile of all walls alike, path of each wall of each half.
TEST(BevelSearch, SearchesWhatTheMillMakes) {
  const auto single = contact::searched_of_mill(made(w1(), pinion_mill()), true),
             herringbone = contact::searched_of_mill(made(w3(), pinion_mill()), false);
  EXPECT_EQ(single.size(), 4u + 2 * 3);
  EXPECT_EQ(herringbone.size(), 4u + 4 * 3);
  for (const auto* list : {&single, &herringbone})
    for (const auto& s : *list) {
      const bool by_path =
          s.kind == Kind::lead_crowning || s.kind == Kind::helix_angle_slope || s.kind == Kind::end_relief;
      EXPECT_EQ(s.side != 0, by_path) << to_string(s.kind);
      EXPECT_EQ(s.zone.has_value(), by_path && list == &herringbone);
      // A gear takes it.
      auto p = list == &single ? w1() : w3();
      p.modifications = {contact::modification_of(s, 0.004, 0, s.side)};
      EXPECT_FALSE(bevel_gear::BevelGear::make(p, pinion_mill()).refused()) << to_string(s.kind);
    }
}

/// What a search found for a pair whose offset is 0.01 mm off either way: amounts [um] in the order of
/// searched_of_mill, and which length.
struct Found {
  bool herringbone, on_pinion;
  std::vector<double> um;
  std::vector<int> lengths;
};
const Found kFound[] = {
    {false, true, {21.7, -27.1, 0.6, 58.9, 2.2, 11.4, 10.5, 1.6, 8.8, 12.3}, {0, 0, 1, 3, 0, 0, 0, 0, 0, 0}},
    {false, false, {2.6, 4.0, 52.6, 13.6, 1.2, 1.6, 11.9, 2.0, 2.4, 10.0}, {0, 0, 2, 4, 0, 0, 0, 0, 0, 0}},
    {true,
     false,
     {11.3, -2.9, 33.6, 0, 5.2, 20.3, 11.7, 1.2, 0.1, 18.4, 6.0, 33.0, 18.4, 3.6, 7.8, 17.6},
     {0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}}};

/// The model and the roll of the same modifications, on either member, as drawn and misaligned.
TEST(BevelSearch, ModelAgreesWithTheRoll) {
  for (const Found& f : kFound) {
    auto p = f.herringbone ? w3() : w1(), w = f.herringbone ? w4() : w2();
    const auto pinion = made(p, pinion_mill()), wheel = made(w, wheel_mill());
    const auto searched = contact::searched_of_mill(f.on_pinion ? pinion : wheel, f.on_pinion);
    ASSERT_EQ(searched.size(), f.um.size());
    std::vector<double> amounts;
    for (std::size_t n = 0; n < searched.size(); ++n) {
      amounts.push_back(f.um[n] / 1000);
      (f.on_pinion ? p : w)
          .modifications.push_back(
              contact::modification_of(searched[n], amounts.back(), f.lengths[n], searched[n].side));
    }
    const auto as_pinion = made(p, pinion_mill()), as_wheel = made(w, wheel_mill());
    contact::SearchOptions options;
    options.rows = options.columns = 25;
    options.steps = 24;
    for (const double offset : {0.0, 0.01, -0.01})
      for (const int sigma : {1, -1}) {
        const Misalignment moved{offset, 0, 0, 0};
        const auto model = contact::bevel_search_model(pinion, wheel, sigma, moved, searched, options);
        ASSERT_TRUE(model) << model.error().message;
        const auto judged = model->judge(amounts, f.lengths);
        const auto rolled = contact::bevel_misaligned_contact(as_pinion, as_wheel, sigma, moved,
                                                              {25, 25, 48, options.compound_mm}, options.margin);
        ASSERT_TRUE(rolled) << rolled.error().message;
        const double error = rolled->error_range_rad * pinion.R_m() * pinion.sin_delta();
        std::printf("  %s %s, wall %s, offset %+.2f: error %.3f um, model %.3f; margin %.3f um, model %.3f\n",
                    f.herringbone ? "herringbone" : "single", f.on_pinion ? "pinion" : "wheel", sigma > 0 ? "L" : "U",
                    offset, error * 1e3, judged.error_mm * 1e3, rolled->margin_gap_mm * 1e3,
                    judged.margin_gap_mm * 1e3);
        // Not below the roll; above it where one pair takes over from another between places.
        EXPECT_GT(judged.error_mm, error - 3e-4);
        EXPECT_LT(judged.error_mm, error + 2.6e-3);
        EXPECT_NEAR(judged.margin_gap_mm, rolled->margin_gap_mm, 8e-4);
        EXPECT_GT(error, 1e-4);
      }
  }
}

/// No candidate of an exhaustive lattice is better than what the descent finds for both walls together; one and four
/// threads find the same.
TEST(BevelSearch, FindsWhatTryingEverythingFinds) {
  const auto pinion = made(w1(), pinion_mill()), wheel = made(w2(), wheel_mill());
  std::vector<SearchedModification> searched = {{false, Kind::tip_relief, {}, false, {3.28}},
                                                {false, Kind::root_relief, {}, false, {4.1}}};
  for (auto& s : searched) s.from_far = true;
  for (const int side : {1, -1}) {
    searched.push_back({false, Kind::end_relief, {}, false, {7.2}});
    searched.back().side = side;
  }
  contact::SearchOptions options;
  options.rows = options.columns = 15;
  options.steps = 12;
  options.compound_mm = 0.004;
  const auto sides = models_of(pinion, wheel, {{}, {0.01, 0, 0, 0}, {-0.01, 0, 0, 0}}, searched, options);
  std::vector<contact::SearchResult> results;
  for (const std::size_t threads : {1u, 4u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(contact::search_modifications(sides, searched, options));
  }
  EXPECT_EQ(results[0].units, results[1].units);
  EXPECT_EQ(results[0].judged, results[1].judged);
  ASSERT_TRUE(results[0].inside);
  // Of a side: the greatest error and the least gap of its models; the best sum of both sides with all margins kept.
  const auto judged = [&](const SearchedSide& side, const std::vector<double>& amounts) {
    std::pair<double, double> worst{0, 1};
    for (const auto& model : side.models) {
      const auto found = model.judge(amounts, {0, 0, 0, 0});
      worst.first = std::max(worst.first, found.error_mm);
      worst.second = std::min(worst.second, found.margin_gap_mm);
    }
    return worst;
  };
  double best = 1;
  long tried = 0;
  for (double tip = 0.02; tip < 0.0801; tip += 0.004)
    for (double root = 0; root < 0.0401; root += 0.004) {
      double sum = 0;
      for (const std::size_t s : {0u, 1u}) {
        double of_side = 1;
        for (double end = 0; end < 0.0301; end += 0.002) {
          const auto [error, gap] = judged(sides[s], {tip, root, s == 0 ? 0 : end, s == 0 ? end : 0});
          if (gap >= options.compound_mm) of_side = std::min(of_side, error);
          ++tried;
        }
        sum += of_side;
      }
      best = std::min(best, sum);
    }
  std::vector<double> amounts;
  for (const int u : results[0].units) amounts.push_back(u * options.unit_mm);
  const double found = judged(sides[0], amounts).first + judged(sides[1], amounts).first;
  std::printf("  %ld candidates of the lattice: %.4f um of both walls; the search: %.4f um after %ld\n", tried,
              best * 1e3, found * 1e3, results[0].judged);
  ASSERT_LT(best, 1);
  EXPECT_LE(found, best + 1e-4);
}

/// Both walls together: no amount is left that could be 0 without an error that is not nearly equal to the least one,
/// or a margin that lacks.
TEST(BevelSearch, NothingIsTakenThatNeedNotBe) {
  const auto pinion = made(w1(), pinion_mill()), wheel = made(w2(), wheel_mill());
  const auto searched = contact::searched_of_mill(wheel, false);
  contact::SearchOptions options;
  options.rows = options.columns = 13;
  options.steps = 12;
  const auto sides = models_of(pinion, wheel, {{}, {0.01, 0, 0, 0}, {-0.01, 0, 0, 0}}, searched, options);
  const auto found = contact::search_modifications(sides, searched, options);
  ASSERT_TRUE(found.inside);
  const auto judged = [&](const std::vector<int>& units) {
    std::vector<double> amounts;
    for (const int u : units) amounts.push_back(u * options.unit_mm);
    bool within = true;
    for (std::size_t s = 0; s < sides.size(); ++s)
      for (const auto& model : sides[s].models) {
        const auto of_model = model.judge(amounts, found.lengths);
        within = within && of_model.error_mm <= options.nearly_equal_to(found.least_error_mm[s]) &&
                 of_model.margin_gap_mm >= options.compound_mm + 2e-9;
      }
    return within;
  };
  int needed = 0;
  for (std::size_t n = 0; n < searched.size(); ++n) {
    if (found.units[n] == 0) continue;
    ++needed;
    for (const int left : {0, found.units[n] - (found.units[n] > 0 ? 1 : -1)}) {
      auto less = found.units;
      less[n] = left;
      EXPECT_FALSE(judged(less)) << to_string(searched[n].kind) << " need not be more than " << left << " units";
    }
  }
  std::printf("  %d of %zu are needed; at most %.1f um are taken\n", needed, searched.size(),
              found.removal.most_mm * 1e3);
  EXPECT_GE(needed, 2);
}

/// Lead crowning alone cannot bring the pattern off the tips: it says so, and which edge is in the way.
TEST(BevelSearch, SaysWhenThereIsNone) {
  const auto pinion = made(w1(), pinion_mill()), wheel = made(w2(), wheel_mill());
  std::vector<SearchedModification> searched;
  for (const int side : {1, -1}) {
    searched.push_back({true, Kind::lead_crowning, {}, false, {}});
    searched.back().side = side;
  }
  contact::SearchOptions options;
  options.rows = options.columns = 13;
  options.steps = 12;
  const auto found =
      contact::search_modifications(models_of(pinion, wheel, {{}}, searched, options), searched, options);
  EXPECT_FALSE(found.inside);
  EXPECT_LT(found.margin_gap_mm, options.compound_mm);
  EXPECT_NE(found.nearest, contact::Edge::inner_end);
  EXPECT_NE(found.nearest, contact::Edge::outer_end);
}

}  // namespace
}  // namespace toothpath
