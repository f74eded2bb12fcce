#include "app/studies/trials/dhfg_article.h"

#include <algorithm>
#include <cmath>

namespace toothpath::trials {
namespace {

using Of = double (*)(const LoadedTrial&);
using Three = std::array<double, 3>;

constexpr double kSteady = 0.1;  // peaks that differ by less than this part of their mean are stable
constexpr const char* kFactors[] = {"teeth", "ratio", "helix"};
constexpr const char* kReproduced = "reproduced";

std::string three(const Three& v, double scale, int digits) {
  return fmt::format("{:.{}f}, {:.{}f}, {:.{}f}", v[0] * scale, digits, v[1] * scale, digits, v[2] * scale, digits);
}

/// The trials and what is asked of them.
class Judge {
 public:
  Judge(const StudyFacts& facts, const StudyFound& found, page::PageTable& table)
      : facts_(facts), found_(found), table_(table) {}

  void model() {
    add("torque of 532 N m on the gear shaft, on the rig by a hydraulic motor (3.1, 3.4.2)",
        fmt::format("{:g} N m on the gear", facts_.torque_nmm / 1e3),
        std::abs(facts_.torque_nmm - 532e3) < 1 ? "as in the article" : "another torque");
    const LoadedTrial& four = of(4);
    add(fmt::format("friction {:g} (3.1)", kArticleFriction),
        fmt::format("none; it would add {:.0f} N along the pinion of trial 4 and {:.2f} % of the torque at most",
                    four.friction_axial_n, 100 * four.friction_torque),
        "left out: a bound, not a solution");
    const auto row = [&](const char* name) {
      return std::find_if(found_.efforts.begin(), found_.efforts.end(), [&](const auto& r) { return r.name == name; });
    };
    const auto coarse = row("default"), finer = row("short pieces of line");
    if (coarse != found_.efforts.end() && finer != found_.efforts.end())
      add("refinement changes the largest stress by less than 2 % (3.1)",
          fmt::format("pieces half as long: inside {:+.1f} %, line ends {:+.1f} %",
                      100 * (finer->found.pressure / coarse->found.pressure - 1),
                      100 * (finer->found.end_pressure / coarse->found.end_pressure - 1)),
          "differs at edges: their pressure is a property of the mesh");
  }

  void pairs() {
    const Range least = whole([](const LoadedTrial&l) { return double(l.least_pairs); }),
                most = whole([](const LoadedTrial&l) { return double(l.most_pairs); });
    int least_equal = 99, most_equal = 0;
    for (const auto& l : found_.equal.trials)
      least_equal = std::min(least_equal, l.least_pairs), most_equal = std::max(most_equal, l.most_pairs);
    add("2 to 3 pairs in contact (3.2)",
        fmt::format("{:g} to {:g} V-teeth; {} to {} with halves of {:.1f} mm", least.least, most.most, least_equal,
                    most_equal, found_.equal.half_face_mm),
        least_equal >= 2 && most_equal <= 3
            ? "reproduced with narrow halves; more where they take the whole feasible width"
            : "differs");
    add("trial 4: three pairs, then two (3.2, figure 7)", fmt::format("{} to {}", of(4).least_pairs, of(4).most_pairs),
        of(4).least_pairs == 2 && of(4).most_pairs == 3 ? kReproduced : "differs: its halves are as wide as feasible");
    const Of mean = [](const LoadedTrial& l) { return l.mean_pairs; };
    for (int f = 0; f < 3; ++f) {
      const Three wide = levels(f, mean), equal = levels(f, mean, true);
      const auto rises = [](const Three& v) { return v[0] < v[1] && v[1] < v[2]; };
      add(fmt::format("pairs rise with {} (3.2)", kFactors[f]),
          fmt::format("level means {}; {} with equal halves", three(wide, 1, 3), three(equal, 1, 3)),
          rises(wide)    ? rises(equal) ? kReproduced : "reproduced; with equal halves it differs"
          : rises(equal) ? "reproduced with equal halves alone"
                         : "differs: not at every level");
    }
  }

  void stiffness() {
    int single = 0;
    for (const auto& t : found_.trials) single += t.loaded.stiffness_falls == 1 ? 1 : 0;
    add("stiffness gradually decreases, then increases (3.2.1)",
        fmt::format("one fall and one rise a pitch in {} of 9 trials, {} in trial 4", single, of(4).stiffness_falls),
        single == 9  ? kReproduced
        : single > 4 ? "reproduced in most trials"
                     : "differs");
    const Range low = whole([](const LoadedTrial&l) { return l.stiffness.least; }),
                high = whole([](const LoadedTrial&l) { return l.stiffness.most; });
    const double normal = of(4).normal_n;
    add("stiffness 0.5 to 30e4 N/mm, a spread of 60 (3.2.1)",
        fmt::format("{:.2f} to {:.2f}e6 N/mm", low.least / 1e6, high.most / 1e6),
        fmt::format("differs: 0.5 to 2.5e4 N/mm in trial 4 would mean {:.0f} to {:.0f} um of approach under {:.0f} N; "
                    "nine gears of one module have no cause for a spread of 60",
                    normal / 5e3 * kUm, normal / 2.5e4 * kUm, normal));
    std::vector<int> order = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    std::sort(order.begin(), order.end(), [&](int a, int b) { return of(a).stiffness.mean < of(b).stiffness.mean; });
    add("order by stiffness: 1 4 7 8, then 2 3 5, then 6 9 (3.2.1)", fmt::format("{}", fmt::join(order, " ")),
        out_of_order());
  }

  void error_and_stress() {
    for (int f = 0; f < 3; ++f)
      falls(
          "transmission error", "3.2.2", f, [](const LoadedTrial& l) { return l.error_rad; }, kMicro, 3, "urad");
    const Of peak = [](const LoadedTrial& l) { return l.pressure; };
    const Range p = whole(peak);
    add("stress 850 to 1150 MPa, 500 to 650 in trials 5 and 8 (3.2.3)",
        fmt::format("{:.0f} to {:.0f} MPa, {:.0f} and {:.0f} in trials 5 and 8", p.least, p.most, of(5).pressure,
                    of(8).pressure),
        p.most < 850 ? "differs: line contact of this load has less; edges and nodes have more" : "within reach");
    const auto group = [&](int first) {
      return Three{of(first).pressure, of(first + 1).pressure, of(first + 2).pressure};
    };
    const auto spread = [](const Three& v) {
      const auto [low, high] = std::minmax({v[0], v[1], v[2]});
      return 3 * (high - low) / (v[0] + v[1] + v[2]);
    };
    const Three one = group(1), two = group(4), three_of = group(7);
    add("stress of trials 1 to 3 stable (3.2.3)", three(one, 1, 0) + " MPa",
        spread(one) < kSteady ? kReproduced : fmt::format("differs: a spread of {:.0f} %", 100 * spread(one)));
    add("stress of trials 4 to 6 falls (3.2.3)", three(two, 1, 0) + " MPa",
        two[0] > two[1] && two[1] > two[2] ? kReproduced : "differs");
    add("stress of trials 7 to 9 fluctuates, in all falls (3.2.3)", three(three_of, 1, 0) + " MPa",
        three_of[0] > three_of[2] ? kReproduced : "differs");
    for (int f = 0; f < 3; ++f) falls("stress", "3.2.3", f, peak, 1, 0, "MPa");
  }

  /// Newtons of four trials against one helical gear, that of trial 4 (30 and 180 teeth, 30 deg).
  void axial_force() {
    const double single = of(4).single_axial_n;
    const auto held = [&](int number) { return of(number).remainder.mean * of(number).single_axial_n; };
    std::vector<std::string> each;
    double least = 1e300, most = 0;
    for (const int n : {2, 4, 6, 8}) {
      each.push_back(fmt::format("{:.0f} N in trial {}", held(n), n));
      least = std::min(least, held(n)), most = std::max(most, held(n));
    }
    add("axial force about 70 % lower than that of one helical gear of 30 and 180 teeth, 30 deg; trials 2, 4, 6, 8 "
        "(3.3)",
        fmt::format("helical gear {:.0f} N; pinion held at its exact place {} (means): {:.0f} to {:.0f} % lower; "
                    "floating pinion 100 %",
                    single, fmt::join(each, ", "), 100 * (1 - most / single), 100 * (1 - least / single)),
        fmt::format("differs: lower by more; a remainder of 30 % is a pinion about {:.1f} um off its place along its "
                    "axis",
                    0.15 / std::abs(of(4).share_per_um)));
    const double at_25 = std::max(held(2), held(6)), at_30 = std::min(held(4), held(8));
    add("a helix of 25 deg is best: the least axial force (3.3)",
        fmt::format("{:.0f} and {:.0f} N in trials 2 and 6 of 25 deg, {:.0f} and {:.0f} N in trials 4 and 8 of 30 deg",
                    held(2), held(6), held(4), held(8)),
        at_25 < at_30 ? "reproduced for a held pinion; 20 deg is not among the four, and teeth and ratio differ, too"
                      : "differs: no such optimum among the four; a floating pinion has no axial force at any angle");
  }

  void experiment() {
    std::vector<std::string> ranks;
    bool best = true;
    const auto rank = [&](const char* name, Of of_trial) {
      const auto better = std::count_if(found_.trials.begin(), found_.trials.end(),
                                        [&](const auto& t) { return of_trial(t.loaded) < of_trial(of(4)); });
      best = best && better == 0;
      ranks.push_back(fmt::format("{} of 9 by {}", better + 1, name));
    };
    rank("axial force", [](const LoadedTrial& l) { return l.remainder.mean * l.single_axial_n; });
    rank("stress", [](const LoadedTrial& l) { return l.pressure; });
    rank("transmission error", [](const LoadedTrial& l) { return l.error_rad; });
    add("trial 4 is optimal in axial force, stress and transmission error (3.4.2)",
        fmt::format("{}", fmt::join(ranks, ", ")), best ? kReproduced : "differs: others are better");
    add("the contact pattern covers the whole flank (3.4.2, figure 18)",
        fmt::format("{:.0f} % of the flanks of trial 4 are marked", 100 * found_.trials[3].marked_share),
        found_.trials[3].marked_share > 0.95 ? "reproduced: contact along lines" : "differs");
    add("simulation agrees with the rig, at 1500 rpm (3.4.2)", "",
        "cannot be judged: no figures of the rig are printed, and this is quasi-static");
  }

 private:
  void add(std::string statement, std::string here, std::string verdict) {
    table_.rows.push_back({std::move(statement), std::move(here), std::move(verdict)});
  }
  [[nodiscard]] const LoadedTrial& of(int number) const {
    return found_.trials[static_cast<std::size_t>(number - 1)].loaded;
  }
  /// Least and most of a quantity over the trials.
  [[nodiscard]] Range whole(Of what) const {
    Range r;
    for (const auto& x : found_.trials)
      r.least = std::min(r.least, what(x.loaded)), r.most = std::max(r.most, what(x.loaded));
    return r;
  }
  /// Means of a factor's levels. @param equal  of the trials with equal halves
  [[nodiscard]] Three levels(int factor, Of what, bool equal = false) const {
    Three sums{};
    for (std::size_t k = 0; k < found_.trials.size(); ++k) {
      if (equal && found_.equal.trials.size() != found_.trials.size()) continue;
      const TrialLevels& at = found_.trials[k].levels;
      const int level = factor == 0 ? at.teeth : factor == 1 ? at.ratio : at.helix;
      sums[static_cast<std::size_t>(level)] += what(equal ? found_.equal.trials[k] : found_.trials[k].loaded) / 3;
    }
    return sums;
  }
  void falls(const char* what, const char* section, int factor, Of quantity, double scale, int digits,
             const char* unit) {
    const Three v = levels(factor, quantity);
    add(fmt::format("{} falls with {} ({})", what, kFactors[factor], section),
        fmt::format("level means {} {}", three(v, scale, digits), unit),
        v[0] > v[1] && v[1] > v[2] ? kReproduced : "differs: not at every level");
  }
  /// Is every trial of one group softer than every one of the next? Those that are not.
  [[nodiscard]] std::string out_of_order() const {
    const std::vector<std::vector<int>> groups = {{1, 4, 7, 8}, {2, 3, 5}, {6, 9}};
    const auto wrong = [&](int without) {
      for (std::size_t a = 0; a + 1 < groups.size(); ++a)
        for (const int low : groups[a])
          for (const int high : groups[a + 1])
            if (of(low).stiffness.mean >= of(high).stiffness.mean && low != without && high != without) return true;
      return false;
    };
    if (!wrong(0)) return kReproduced;
    for (int one = 1; one <= 9; ++one)
      if (!wrong(one))
        return fmt::format("reproduced but for trial {}: the order is that of the length of the lines", one);
    return "differs: the order here is that of the length of the lines, and with it of the chosen face widths";
  }

  const StudyFacts& facts_;
  const StudyFound& found_;
  page::PageTable& table_;
};

}  // namespace

page::PageTable article_table(const StudyFacts& facts, const StudyFound& found) {
  page::PageTable t{"Against the article", {"statement", "here", "verdict"}, {}, ""};
  t.note =
      "X. Chu, F. Chen, Machines 2025, 13, 912, with its sections. It prints no face widths, groove or place of the "
      "pinion: its figures cannot be matched, only their order. Nothing was fitted to it.";
  for (const auto& r : found.trials)
    if (!r.loaded.refusal.empty() || r.loaded.normal_n == 0) return t;
  Judge judge(facts, found, t);
  judge.model();
  judge.pairs();
  judge.stiffness();
  judge.error_and_stress();
  judge.axial_force();
  judge.experiment();
  return t;
}

}  // namespace toothpath::trials
