// What gears refuse of the modifications that a search comes to: which amount, its limit, and what the search does
// then.
#include "app/process/ease_off/refused_amount.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "app/job/file.h"
#include "app/process/ease_off/optimiser.h"
#include "app/process/face/searched_pair.h"
#include "geometry/base/work_share.h"
#include "tests/support/files.h"

namespace toothpath::test {
namespace {

using ease_off::FoundModifications;
using ease_off::OfMember;
using modification::Kind;

/// A pair whose gear is refused where its crownings and reliefs together, or one alone, are too much.
class Bounded final : public ease_off::SearchedPair {
 public:
  Bounded(const ease_off::SearchedPair* pair, Kind kind, double most_mm) : pair_(pair), kind_(kind), most_(most_mm) {}
  [[nodiscard]] const ease_off::PairWords& words() const override { return pair_->words(); }
  [[nodiscard]] ease_off::KeyTable keys_of(bool on_pinion) const override { return pair_->keys_of(on_pinion); }
  [[nodiscard]] double pitch_radius_mm() const override { return pair_->pitch_radius_mm(); }
  [[nodiscard]] double motion_lever_mm() const override { return pair_->motion_lever_mm(); }
  [[nodiscard]] std::vector<contact::SearchedModification> searched() const override { return pair_->searched(); }
  [[nodiscard]] double depth_mm() const override { return pair_->depth_mm(); }
  [[nodiscard]] contact::SearchOptions model_size() const override {
    contact::SearchOptions options;
    options.rows = options.columns = 17;
    options.steps = 12;
    return options;
  }
  [[nodiscard]] bool sides_share() const override { return pair_->sides_share(); }
  [[nodiscard]] int side_of(std::size_t side) const override { return pair_->side_of(side); }
  [[nodiscard]] Result<contact::SearchModel> model(std::size_t side, const contact::Misalignment& moved,
                                                   const std::vector<contact::SearchedModification>& searched,
                                                   const contact::SearchOptions& options) const override {
    return pair_->model(side, moved, searched, options);
  }
  [[nodiscard]] std::vector<Diagnostic> refused(const FoundModifications& with) const override {
    for (const auto& m : with.on_gear)
      if (m.kind == kind_ && std::abs(m.amount_mm) > most_ + 1e-12)
        return {fail("the mill does not fit the fillet: {} {:.4f} mm exceeds {:.4f} mm", to_string(m.kind), m.amount_mm,
                     most_)};
    return {};
  }
  [[nodiscard]] process::ValueOrErrors<std::vector<ease_off::MisalignmentRow>> rolled(
      const FoundModifications& with, const std::vector<ease_off::NamedMisalignment>& list,
      double margin) const override {
    EXPECT_TRUE(refused(with).empty()) << "what is refused is not rolled";
    return pair_->rolled(with, list, margin);
  }

 private:
  const ease_off::SearchedPair* pair_;
  Kind kind_;
  double most_;
};

OfMember amount(Kind kind, double amount_mm, std::size_t number = 0) {
  OfMember of;
  of.number = number;
  of.modification.kind = kind;
  of.modification.amount_mm = amount_mm;
  return of;
}

TEST(RefusedAmount, HasItsLimitWithinAStep) {
  for (const double most : {0.0, 0.0123, 0.0299}) {
    const Bounded pair(nullptr, Kind::root_relief, most);
    const std::vector<OfMember> list = {amount(Kind::lead_crowning, 0.05), amount(Kind::root_relief, 0.03, 1)};
    const auto stop = ease_off::refused_amount(pair, list, 1e-4);
    ASSERT_TRUE(stop);
    EXPECT_EQ(stop->largest.number, 1u);
    EXPECT_EQ(stop->largest.modification.amount_mm, 0.03);
    EXPECT_NEAR(stop->limit_mm, most, 1e-9);
    EXPECT_NE(stop->message.find("the mill does not fit"), std::string::npos);
    EXPECT_NE(stop->message.find(fmt::format("{:.4f} mm exceeds", most + 1e-4)), std::string::npos) << stop->message;
  }
  const Bounded slope(nullptr, Kind::helix_angle_slope, 0.01);
  // One number on both flanks is held on both.
  const std::vector<OfMember> both = {amount(Kind::helix_angle_slope, -0.02), amount(Kind::helix_angle_slope, 0.03)};
  const auto stop = ease_off::refused_amount(slope, both, 1e-4);
  ASSERT_TRUE(stop);
  EXPECT_NEAR(stop->limit_mm, 0.01, 1e-9);
  EXPECT_EQ(stop->largest.modification.amount_mm, 0.03);
  // Two numbers that are refused each: neither alone is to blame.
  EXPECT_FALSE(ease_off::refused_amount(
      slope, {amount(Kind::helix_angle_slope, -0.02), amount(Kind::helix_angle_slope, 0.03, 1)}, 1e-4));
}

/// The search goes no farther than what is made, and says so; where nothing is left inside that bound the ending has
/// quantity, value, limit and what would help.
TEST(RefusedAmount, HoldsTheSearch) {
  const TestDir dir;
  std::string text = file_text(TOOTHPATH_SOURCE_DIR "/samples/spur_quick.toml");
  text.insert(text.find("[machine]"), "[contact]\npinion_teeth = 20\n[contact.misalignment]\nangle = 0.03\n\n");
  write_file(dir / "job.toml", text);
  const auto job = job::read_job_file(dir / "job.toml");
  ASSERT_NE(job.value_if(), nullptr);
  const auto gear = process::make_face_gear(*job.value_if());
  ASSERT_NE(gear.value_if(), nullptr);
  const auto& settings = *job.value_if()->contact;
  const auto pair = face::searched_pair({job.value_if(), gear.value_if(), 20, settings, "gear", {}, 21, 25});
  process::ContactAsked asked;
  asked.optimise = true;
  const auto optimised = [&](const ease_off::SearchedPair& of) {
    app::Progress progress(true);
    app::StageClock clock(progress);
    auto found = ease_off::misalign(of, *job.value_if(), settings, asked, "gear", clock);
    EXPECT_NE(found.value_if(), nullptr);
    return *found.value_if()->optimised;
  };
  const auto largest = [](const ease_off::Optimised& found, Kind kind) {
    double most = 0;
    for (const auto& m : found.found_on.on_gear)
      if (m.kind == kind) most = std::max(most, std::abs(m.amount_mm));
    return most;
  };
  // Meanwhile the share that is done grows.
  std::vector<double> shares;
  ease_off::Optimised freely;
  {
    const WorkShare whole(2);  // the table of misalignments, the search
    const std::jthread watch([&](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        shares.push_back(whole.done());
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
    });
    freely = optimised(Bounded(pair.get(), Kind::lead_crowning, 1));
  }
  int grown = 0;
  for (std::size_t k = 1; k < shares.size(); ++k) {
    EXPECT_GE(shares[k], shares[k - 1] - 1e-9);
    grown += shares[k] > shares[k - 1] + 0.005;
  }
  EXPECT_GT(grown, 10) << "of " << shares.size() << " looks";
  ASSERT_TRUE(freely.found) << freely.finding;
  const double tip = largest(freely, Kind::tip_relief), crowning = largest(freely, Kind::lead_crowning);
  ASSERT_GT(crowning, 0.002);
  const auto held = optimised(Bounded(pair.get(), Kind::lead_crowning, crowning - 2e-4));
  EXPECT_LE(largest(held, Kind::lead_crowning), crowning - 2e-4 + 1e-12);
  EXPECT_NE(held.finding.find("the search stopped at lead_crowning"), std::string::npos) << held.finding;
  EXPECT_NE(held.finding.find(fmt::format("made up to {:.4f} mm; beyond, the mill does not fit", crowning - 2e-4)),
            std::string::npos)
      << held.finding;
  const auto none = optimised(Bounded(pair.get(), Kind::lead_crowning, 0));
  std::printf("  tip relief %.4f, crowning %.4f mm; held: %s\n  none: %s\n", tip, crowning, held.finding.c_str(),
              none.finding.c_str());
  if (!none.found) {
    EXPECT_NE(none.finding.find("none was found"), std::string::npos);
    EXPECT_NE(none.finding.find("would help"), std::string::npos);
  }
  EXPECT_NE(none.finding.find("lead_crowning"), std::string::npos);
  EXPECT_EQ(largest(none, Kind::lead_crowning), 0);
}

}  // namespace
}  // namespace toothpath::test
