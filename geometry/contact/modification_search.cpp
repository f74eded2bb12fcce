#include "geometry/contact/modification_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace toothpath::contact {
namespace {

constexpr double kBeyond = 1e300;
constexpr int kReach = 2;  // rows either way of the one that touches: slopes move the nearest place by as much

/// Least of a function known at three neighbours with the least in the middle.
double vertex(double below, double at, double above) {
  const double bend = below - 2 * at + above;
  return bend > 0 ? at - (above - below) * (above - below) / (8 * bend) : at;
}

}  // namespace

modification::Modification modification_of(const SearchedModification& searched, double amount_mm, int length,
                                           int side) {
  modification::Modification m;
  m.kind = searched.kind;
  m.amount_mm = amount_mm;
  m.zone = searched.zone;
  m.flanks = side > 0 ? modification::Flanks::right : modification::Flanks::left;
  if (modification::is_relief(m.kind)) m.length_mm = searched.lengths_mm[static_cast<std::size_t>(length)];
  return m;
}

SearchModel::Ring SearchModel::ring_of(const face_gear::FaceGearRing& gear_ring, const ContactMember& member,
                                       const EaseOffMap& map, const std::vector<SearchedModification>& searched,
                                       double margin) {
  const ContactFlank& f = member.flank;
  Ring ring;
  ring.rows = f.rows, ring.columns = f.columns;
  struct At {
    double depth, along;
  };
  std::vector<At> on_gear, on_pinion;
  for (int c = 0; c < f.columns; ++c)
    for (int r = 0; r < f.rows; ++r) {
      const auto k = f.index(r, c);
      ring.gap.push_back(map.gap_mm[k]);
      ring.phi.push_back(map.phi_2[k]);
      ring.bend.push_back(map.bend_mm[k]);
      ring.edges.push_back(static_cast<std::uint8_t>(edges_at(member, map, r, c, margin, 0)));
      const Vec3 plain = f.surface.flank(f.side, f.theta[k], f.B[k]).p;
      const double radius = std::hypot(plain.x(), plain.y());
      on_gear.push_back({face_gear::FlankField::depth(f.surface, plain, radius), radius});
      on_pinion.push_back({member.pinion.r_a - map.pinion_radius_mm[k], map.pinion_Z_mm[k]});
    }
  for (const auto& s : searched) {
    const auto rectangle =
        s.on_pinion ? rectangle_of(member.pinion, gear_ring) : face_gear::rectangle_of(f.surface, gear_ring.zone);
    const auto& places = s.on_pinion ? on_pinion : on_gear;
    for (const double way : {1.0, -1.0}) {
      auto& of_way = way > 0 ? ring.up : ring.down;
      of_way.emplace_back();
      for (std::size_t n = 0; n < std::max<std::size_t>(1, s.lengths_mm.size()); ++n) {
        const modification::Field field({modification_of(s, way, static_cast<int>(n), f.side)}, f.side, f.zone,
                                        rectangle);
        std::vector<double> taken(ring.gap.size());
        for (std::size_t k = 0; k < taken.size(); ++k)
          if (!std::isnan(ring.gap[k])) taken[k] = field.removal(places[k].depth, places[k].along);
        of_way.back().push_back(std::move(taken));
      }
    }
  }
  return ring;
}

Result<SearchModel> SearchModel::make(const face_gear::FaceGear& gear, int side, int pinion_teeth,
                                      const std::vector<modification::Modification>& on_pinion,
                                      const Misalignment& moved, const std::vector<SearchedModification>& searched,
                                      const SearchOptions& options) {
  std::vector<ContactMember> members;
  for (int zone = 0; zone < static_cast<int>(gear.rings().size()); ++zone) {
    auto flank = exact_flank(gear, zone, side, options.rows, options.columns);
    if (!flank) return flank.error();
    members.push_back(make_member(gear, std::move(*flank), pinion_teeth, moved, on_pinion));
  }
  const auto map = ease_off(members);
  if (!map) return map.error();
  SearchModel model;
  double low = kBeyond, high = -kBeyond;
  for (std::size_t m = 0; m < members.size(); ++m) {
    model.rings_.push_back(ring_of(gear.rings()[m], members[m], map->maps[m], searched, options.margin));
    for (const double phi : model.rings_.back().phi) {
      if (std::isnan(phi)) continue;
      low = std::min(low, phi);
      high = std::max(high, phi);
    }
  }
  model.steps_ = options.steps;
  model.step_ = members.front().flank.surface.pitch / options.steps;
  model.start_ = low;
  model.turns_ = static_cast<int>((high - low) / model.step_) + 2;
  for (auto& ring : model.rings_) model.place_turns(ring);
  return model;
}

void SearchModel::place_turns(Ring& ring) const {
  for (int k = 0; k < turns_; ++k)
    for (int c = 0; c < ring.columns; ++c) {
      int best = -1;
      double nearest = kBeyond;
      for (int r = 0; r < ring.rows; ++r) {
        const auto n = static_cast<std::size_t>(c * ring.rows + r);
        const double away = std::abs(ring.phi[n] - (start_ + step_ * k));
        if (away < nearest) nearest = away, best = r;  // a NaN is not below
      }
      ring.nearest_row.push_back(best);
    }
}

double SearchModel::motion(const Ring& ring, const std::vector<double>& gap, int k) const {
  const double turn = start_ + step_ * k;
  double before = kBeyond, last = kBeyond, best = kBeyond;
  for (int c = 0; c < ring.columns; ++c) {
    const int middle = ring.nearest_row[static_cast<std::size_t>(k * ring.columns + c)];
    double of_column = kBeyond;
    if (middle >= 0) {
      std::array<double, 2 * kReach + 1> value;
      value.fill(kBeyond);
      for (int n = -kReach; n <= kReach; ++n) {
        const int r = middle + n;
        if (r < 0 || r >= ring.rows) continue;
        const auto at = static_cast<std::size_t>(c * ring.rows + r);
        if (std::isnan(ring.phi[at])) continue;
        const double away = turn - ring.phi[at];
        value[static_cast<std::size_t>(n + kReach)] = gap[at] + 0.5 * ring.bend[at] * away * away;
      }
      const auto low = static_cast<std::size_t>(std::min_element(value.begin(), value.end()) - value.begin());
      of_column = low > 0 && low + 1 < value.size() && value[low - 1] < kBeyond && value[low + 1] < kBeyond
                      ? vertex(value[low - 1], value[low], value[low + 1])
                      : value[low];
    }
    if (last < kBeyond && last <= before && last <= of_column)
      best = std::min(best, before < kBeyond && of_column < kBeyond ? vertex(before, last, of_column) : last);
    before = last, last = of_column;
  }
  return std::min(best, last);
}

SearchModel::Judged SearchModel::judge(const std::vector<double>& amounts_mm, const std::vector<int>& lengths) const {
  std::vector<std::vector<double>> gaps;
  for (const Ring& ring : rings_) {
    gaps.push_back(ring.gap);
    for (std::size_t s = 0; s < amounts_mm.size(); ++s) {
      const double size = std::abs(amounts_mm[s]);
      if (size == 0) continue;
      const auto& taken = (amounts_mm[s] > 0 ? ring.up : ring.down)[s][static_cast<std::size_t>(lengths[s])];
      for (std::size_t k = 0; k < taken.size(); ++k) gaps.back()[k] += size * taken[k];
    }
  }
  // The motion curve of one pair, then that of all pairs: tooth j stands where tooth 0 stands j pitches later.
  std::vector<double> pair(static_cast<std::size_t>(turns_), kBeyond), curve(static_cast<std::size_t>(steps_), kBeyond);
  std::vector<int> bears(static_cast<std::size_t>(steps_), 0);
  for (int k = 0; k < turns_; ++k) {
    double& least = pair[static_cast<std::size_t>(k)];
    for (std::size_t m = 0; m < rings_.size(); ++m) least = std::min(least, motion(rings_[m], gaps[m], k));
    const auto n = static_cast<std::size_t>(k % steps_);
    if (least < curve[n]) curve[n] = least, bears[n] = k;
  }
  Judged judged;
  const auto [low, high] = std::minmax_element(curve.begin(), curve.end());
  double highest = *high;
  for (int n = 0; n < steps_; ++n) {
    const int a = bears[static_cast<std::size_t>(n)], b = bears[static_cast<std::size_t>((n + 1) % steps_)];
    if (a + 1 == b || a + 1 >= turns_ || b >= turns_ || b < 1) continue;
    const auto at = [&](int k) { return pair[static_cast<std::size_t>(k)]; };
    if (const auto over = handover(at(a), at(a + 1), at(b - 1), at(b))) highest = std::max(highest, *over);
  }
  judged.error_mm = highest - *low;
  judged.margin_gap_mm = kBeyond;
  for (std::size_t m = 0; m < rings_.size(); ++m)
    for (std::size_t k = 0; k < gaps[m].size(); ++k) {
      const Ring& ring = rings_[m];
      if (ring.edges[k] == 0 || std::isnan(gaps[m][k])) continue;
      const double place = (ring.phi[k] - start_) / step_;
      const int whole = static_cast<int>(place);
      const double share = place - whole, here = curve[static_cast<std::size_t>(whole % steps_)],
                   next = curve[static_cast<std::size_t>((whole + 1) % steps_)];
      const double gap = gaps[m][k] - (here + share * (next - here));
      if (gap >= judged.margin_gap_mm) continue;
      judged.margin_gap_mm = gap;
      int edge = 0;
      while ((ring.edges[k] >> edge & 1) == 0) ++edge;
      judged.nearest = Edge(edge);
    }
  return judged;
}

namespace {

/// In units.
int largest_of(const SearchedModification& searched, const SearchOptions& options) {
  return static_cast<int>(std::floor(std::min(options.largest_mm, searched.largest_mm) / options.unit_mm + 1e-9));
}

struct Candidate {
  std::vector<int> units, lengths;
  double score = kBeyond;
};

/// The search on the models of one side.
class Search {
 public:
  Search(const std::vector<SearchModel>& models, const std::vector<SearchedModification>& searched, double wanted_gap,
         const SearchOptions& options)
      : models_(models), searched_(searched), wanted_(wanted_gap), options_(options) {}

  /// Micrometres of error, ten for every one that the margins lack, a thousandth for every one that is taken.
  double score(const Candidate& c, double at_least) {
    ++judged;
    std::vector<double> amounts;
    double taken = 0;
    for (const int u : c.units) {
      amounts.push_back(u * options_.unit_mm);
      taken += std::abs(u) * options_.unit_mm;
    }
    double error = 0, lack = 0;
    for (std::size_t n = 0; n < models_.size(); ++n) {
      // The one that spoilt the last candidate first: most are spoilt by the same.
      const std::size_t m = n == 0 ? spoils_ : n <= spoils_ ? n - 1 : n;
      const auto found = models_[m].judge(amounts, c.lengths);
      error = std::max(error, found.error_mm);
      lack = std::max(lack, wanted_ - found.margin_gap_mm);
      if (const double now = 1e3 * (error + 10 * lack + 1e-3 * taken); now >= at_least) {
        spoils_ = m;
        return now;
      }
    }
    return 1e3 * (error + 10 * lack + 1e-3 * taken);
  }

  void descend(Candidate& c) {
    const auto n = c.units.size();
    for (int step = 64; step > 0; step /= 2)
      for (bool better = true; better;) {
        better = false;
        for (std::size_t i = 0; i < n; ++i)
          for (std::size_t j = i; j < n; ++j)
            for (const auto& [a, b] : {std::pair(1, 1), {-1, -1}, {1, -1}, {-1, 1}}) {
              if (i == j && a != b) continue;
              while (moved(c, i, a * step, j, i == j ? 0 : b * step)) better = true;
            }
        for (std::size_t i = 0; i < n; ++i)
          for (const int way : {1, -1})
            while (lengthened(c, i, way)) better = true;
      }
  }

  long judged = 0;

 private:
  [[nodiscard]] bool fits(std::size_t s, int units) const {
    const int largest = largest_of(searched_[s], options_);
    return units <= largest && units >= (searched_[s].both_ways ? -largest : 0);
  }
  bool moved(Candidate& c, std::size_t i, int by_i, std::size_t j, int by_j) {
    Candidate next = c;
    next.units[i] += by_i;
    next.units[j] += by_j;
    return fits(i, next.units[i]) && fits(j, next.units[j]) && taken(c, std::move(next));
  }
  bool lengthened(Candidate& c, std::size_t i, int way) {
    Candidate next = c;
    next.lengths[i] += way;
    if (next.lengths[i] < 0 || next.lengths[i] >= static_cast<int>(searched_[i].lengths_mm.size())) return false;
    return c.units[i] != 0 && taken(c, std::move(next));
  }
  bool taken(Candidate& c, Candidate next) {
    next.score = score(next, c.score);
    if (!(next.score < c.score)) return false;
    c = std::move(next);
    return true;
  }

  const std::vector<SearchModel>& models_;
  const std::vector<SearchedModification>& searched_;
  double wanted_;
  const SearchOptions& options_;
  std::size_t spoils_ = 0;
};

/// Multiples of the compound from which the search starts: crownings, slopes, reliefs.
std::vector<Candidate> lattice(const std::vector<SearchedModification>& searched, const SearchOptions& options) {
  const int unit = std::max(1, static_cast<int>(std::lround(options.compound_mm / options.unit_mm)));
  std::vector<Candidate> all(1);
  for (const auto& s : searched) {
    const int largest = largest_of(s, options);
    std::vector<int> levels = {0, 2 * unit};
    if (s.kind == modification::Kind::lead_crowning) levels = {unit, 3 * unit};
    if (s.both_ways) levels = {-2 * unit, 0, 2 * unit};
    std::vector<Candidate> next;
    for (const Candidate& c : all)
      for (const int level : levels) {
        next.push_back(c);
        next.back().units.push_back(std::clamp(level, -largest, largest));
        next.back().lengths.push_back(static_cast<int>(s.lengths_mm.size()) / 2);
      }
    all = std::move(next);
  }
  all.push_back(all.front());  // nothing at all
  std::fill(all.back().units.begin(), all.back().units.end(), 0);
  return all;
}

constexpr std::size_t kStarts = 4;

}  // namespace

SearchResult search_modifications(const std::vector<SearchModel>& models,
                                  const std::vector<SearchedModification>& searched, double wanted_gap_mm,
                                  const SearchOptions& options, const SearchResult* known) {
  std::vector<Candidate> starts = lattice(searched, options);
  if (known != nullptr) starts = {{known->units, known->lengths}};
  std::vector<long> judged(starts.size());
  tbb::parallel_for(std::size_t(0), starts.size(), [&](std::size_t k) {
    Search search(models, searched, wanted_gap_mm, options);
    starts[k].score = search.score(starts[k], kBeyond);
    judged[k] = search.judged;
  });
  std::stable_sort(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.score < b.score; });
  starts.resize(std::min(starts.size(), kStarts));
  tbb::parallel_for(std::size_t(0), starts.size(), [&](std::size_t k) {
    Search search(models, searched, wanted_gap_mm, options);
    search.descend(starts[k]);
    judged[k] += search.judged;
  });
  const Candidate& best =
      *std::min_element(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.score < b.score; });
  SearchResult result;
  result.units = best.units;
  result.lengths = best.lengths;
  result.score = best.score;
  for (const long n : judged) result.judged += n;
  std::vector<double> amounts;
  for (const int u : best.units) amounts.push_back(u * options.unit_mm);
  result.margin_gap_mm = kBeyond;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const auto found = models[m].judge(amounts, best.lengths);
    result.error_mm = std::max(result.error_mm, found.error_mm);
    if (found.margin_gap_mm >= result.margin_gap_mm) continue;
    result.margin_gap_mm = found.margin_gap_mm;
    result.limiting = m;
    result.nearest = found.nearest;
  }
  result.inside = result.margin_gap_mm >= wanted_gap_mm;
  return result;
}

}  // namespace toothpath::contact
