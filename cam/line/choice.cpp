#include "cam/line/choice.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "geometry/base/work_share.h"

namespace toothpath::line {
namespace {

constexpr int kMostLeaning = 4;  // strips that are tried of flanks along which a mill may lie
constexpr int kMoreStrips = 4;   // than the bend asks for: poses stand, and the profile bends unevenly

/// All passes of a flank for one choice of strips and rotaries.
struct Choice {
  int strips = 1;
  Rotaries rotaries = Rotaries::both;
};
Result<std::vector<LinePass>> passes_of(const std::vector<FlankTask>& flanks, const FlankTask& flank,
                                        const tool::Profile& tool, const LineOperation& o, const Choice& choice) {
  const auto n = std::size_t(choice.strips);
  std::vector<std::optional<Result<LinePass>>> found(n);
  WorkShare all{double(n)};
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t strip) {
    const WorkShare piece(all);
    PassOptions p;
    p.rotaries = choice.rotaries;
    p.chord_mm = o.chord_tolerance_mm;
    p.bias_mm = o.bias_mm;
    if (strip + 1 == n) p.base_lift = o.base_lift_mm;
    for (const auto& other : flanks) {
      p.lift_from = p.lift_from || other.s_to <= flank.s_from;
      p.lift_to = p.lift_to || other.s_from >= flank.s_to;
    }
    p.room = o.room;
    p.enough_mm = o.left_mm.value_or(INFINITY);
    found[strip].emplace(
        plan_pass(LineFit(flank, *tool.law(), strips_of(flank, choice.strips)[strip]), p, tool.law_end()));
    if (!*found[strip]) return;
    (*found[strip])->strip = int(strip);
    (*found[strip])->strips = choice.strips;
    (*found[strip])->rotaries = choice.rotaries;
  });
  std::vector<LinePass> out;
  for (auto& pass : found) {
    if (!*pass) return pass->error();
    out.push_back(std::move(**pass));
  }
  return out;
}

double worst_of(const std::vector<LinePass>& passes) {
  double worst = 0;
  for (const auto& p : passes) worst = std::max(worst, p.misfit_mm);
  return worst;
}
bool shortened(const std::vector<LinePass>& passes) {
  return std::any_of(passes.begin(), passes.end(), [](const LinePass& p) { return p.shortened_mm > 0; });
}

/// Those that are admitted, in the order in which they are tried.
std::vector<Rotaries> rotaries_of(const LineOperation& o) {
  if (!o.rotaries.empty()) return o.rotaries;
  if (o.left_mm) return {Rotaries::tilt_stands, Rotaries::both};
  return {Rotaries::both};
}

/// The numbers of strips that are tried of a flank.
struct Span {
  int from = 1, to = 1;
};
Result<std::vector<Span>> spans_of(const std::vector<FlankTask>& flanks, const LineOperation& o) {
  if (o.strips || !o.left_mm) return std::vector<Span>(flanks.size(), {o.strips.value_or(1), o.strips.value_or(1)});
  std::vector<Span> out;
  int most = kMostLeaning;  // what one flank may take its neighbour may, too
  for (const FlankTask& flank : flanks) {
    const int least = strips_for(flank, *o.left_mm);
    if (least > kMostStrips)
      return fail(
          "left = {:.3f} um asks for {} strips of flanks that are straight along the tooth: each leaves the sag of its "
          "profile; at most {} are planned; what helps: left = {:.4f} mm, or a finishing with regions = [\"flank\"] by "
          "a ball end",
          1e3 * *o.left_mm, least, kMostStrips,
          std::ceil(1e4 * *o.left_mm * std::pow(double(least) / (kMostStrips - 1), 2)) / 1e4);
    out.push_back({least, least});
    if (const int about = strips_about(flank, *o.left_mm); about > 1)
      most = std::max(most, std::min(about + kMoreStrips, kMostStrips));
  }
  for (Span& span : out) span.to = most;
  return out;
}

std::string strips_text(int n) { return fmt::format("{} strip{}", n, n == 1 ? "" : "s"); }

/// The number of strips of one flank.
class Search {
 public:
  Search(const std::vector<FlankTask>& flanks, const FlankTask& flank, const tool::Profile& tool,
         const LineOperation& o, Span span)
      : flanks_(flanks), flank_(flank), tool_(tool), o_(o), rotaries_(rotaries_of(o)), span_(span) {}

  /// The least number, with the first rotaries that do.
  Status run() {
    for (strips_ = span_.from; strips_ <= span_.to; ++strips_) {
      tried_.clear();
      for (const Rotaries r : rotaries_) {
        if (does(r)) return Ok{};
        // What both rotaries cannot do more strips cannot either; one that stands may have failed by itself.
        if (const auto& error = tried_.back().error; error && r == Rotaries::both) return *error;
      }
    }
    if (least_ == INFINITY && refused_) return *refused_;
    return fail("{}", missed());
  }
  /// Do these rotaries leave little enough in that number?
  [[nodiscard]] bool does(Rotaries r) {
    if (!known(r)) try_one(r);
    return find(r)->does;
  }
  [[nodiscard]] bool known(Rotaries r) const { return find(r) != nullptr; }
  /// The passes with these rotaries, or with the first ones that do.
  [[nodiscard]] FlankPasses take(std::optional<Rotaries> r) {
    for (Tried& t : tried_) {
      if (!t.does || (r && t.rotaries != *r)) continue;
      ways_.back() = {strips_, worst_of(t.passes), false};
      return {std::move(t.passes), std::move(ways_)};
    }
    return {};
  }

 private:
  struct Tried {
    Rotaries rotaries = Rotaries::both;
    bool does = false;
    std::vector<LinePass> passes;
    std::optional<Diagnostic> error;
  };
  [[nodiscard]] const Tried* find(Rotaries r) const {
    const auto at = std::find_if(tried_.begin(), tried_.end(), [&](const Tried& t) { return t.rotaries == r; });
    return at == tried_.end() ? nullptr : &*at;
  }
  void try_one(Rotaries r) {
    Tried t;
    t.rotaries = r;
    auto passes = passes_of(flanks_, flank_, tool_, o_, {strips_, r});
    if (passes) {
      t.passes = std::move(*passes);
      judge(t);
    } else {
      refused_ = t.error = passes.error();
    }
    tried_.push_back(std::move(t));
  }
  void judge(Tried& t) {
    const double misfit = worst_of(t.passes);
    const bool given_up =
        std::any_of(t.passes.begin(), t.passes.end(), [](const LinePass& pass) { return pass.records.empty(); });
    if (ways_.empty() || ways_.back().strips != strips_) ways_.push_back({strips_, INFINITY, true});
    if (Way& way = ways_.back(); misfit < way.misfit_mm) way.misfit_mm = misfit, way.given_up = given_up;
    if (misfit < least_) best_ = {strips_, t.rotaries};
    least_ = std::min(least_, misfit);
    // A pass that ends early leaves a corner; with both rotaries there may be room.
    const bool both_follow = std::find(rotaries_.begin(), rotaries_.end(), Rotaries::both) != rotaries_.end();
    t.does =
        !(o_.left_mm && misfit > *o_.left_mm) && !(t.rotaries != Rotaries::both && both_follow && shortened(t.passes));
  }
  /// No choice leaves little enough: the best one, what was tried, what would help.
  [[nodiscard]] std::string missed() const {
    const auto moving = [](Rotaries r) { return r == Rotaries::both ? "both rotaries move" : to_string(r); };
    std::string rotaries, help;
    bool both = false;
    for (const Rotaries r : rotaries_) {
      rotaries += fmt::format("{}{}", rotaries.empty() ? "" : " or ", moving(r));
      both = both || r == Rotaries::both;
    }
    if (span_.to < kMostStrips) help += fmt::format(", more strips (at most {})", kMostStrips);
    if (!both && o_.both_admitted) help += ", rotaries = \"both\"";
    return fmt::format(
        "left = {:.3f} um cannot be met: the side of this tool leaves {:.3f} um at best on flank {:+d} of zone {}, "
        "with {} while {}; tried: {} while {}; what helps: left = {:.4f} mm{}, a smaller half_angle, or a finishing "
        "with regions = [\"flank\"] by a ball end",
        1e3 * o_.left_mm.value_or(0), 1e3 * least_, flank_.side, flank_.zone, strips_text(best_.strips),
        moving(best_.rotaries),
        span_.from == span_.to ? strips_text(span_.from) : fmt::format("{} to {}", span_.from, strips_text(span_.to)),
        rotaries, std::ceil(1e4 * least_ + 1) / 1e4, help);
  }

  const std::vector<FlankTask>& flanks_;
  const FlankTask& flank_;
  const tool::Profile& tool_;
  const LineOperation& o_;
  std::vector<Rotaries> rotaries_;
  Span span_;
  int strips_ = 1;
  std::vector<Tried> tried_;  ///< of that number
  std::vector<Way> ways_;
  Choice best_;
  double least_ = INFINITY;
  std::optional<Diagnostic> refused_;
};

/// The first rotaries with which every flank keeps its number of strips.
std::optional<Rotaries> common_rotaries(std::vector<Search>& searches, const LineOperation& o) {
  for (const Rotaries r : rotaries_of(o)) {
    const bool failed =
        std::any_of(searches.begin(), searches.end(), [&](Search& s) { return s.known(r) && !s.does(r); });
    if (failed) continue;
    WorkShare all{double(searches.size())};
    tbb::parallel_for(std::size_t{0}, searches.size(), [&](std::size_t k) {
      const WorkShare piece(all);
      (void)searches[k].does(r);
    });
    if (std::all_of(searches.begin(), searches.end(), [&](Search& s) { return s.does(r); })) return r;
  }
  return {};
}

}  // namespace

double FlankPasses::misfit_mm() const { return worst_of(passes); }

Result<std::vector<FlankPasses>> plan_flanks(const std::vector<FlankTask>& flanks, const tool::Profile& tool,
                                             const LineOperation& o) {
  const auto spans = spans_of(flanks, o);
  if (!spans) return spans.error();
  std::vector<Search> searches;
  searches.reserve(flanks.size());
  for (std::size_t k = 0; k < flanks.size(); ++k) searches.emplace_back(flanks, flanks[k], tool, o, (*spans)[k]);
  std::vector<std::optional<Diagnostic>> refused(searches.size());
  {
    WorkShare all{double(searches.size())};
    tbb::parallel_for(std::size_t{0}, searches.size(), [&](std::size_t k) {
      const WorkShare piece(all, double((*spans)[k].to - (*spans)[k].from + 1));
      if (auto found = searches[k].run(); !found) refused[k] = found.error();
    });
  }
  for (auto& error : refused)
    if (error) return std::move(*error);
  const auto common = common_rotaries(searches, o);
  std::vector<FlankPasses> out;
  for (Search& search : searches) out.push_back(search.take(common));
  return out;
}

}  // namespace toothpath::line
