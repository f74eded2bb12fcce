#include "app/proposal/material.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace toothpath::proposal {
namespace {

constexpr double kThin = 0.005, kThick = 0.05;  // mm, chips
constexpr std::array<std::string_view, 7> kWords = {"steel",     "hardened_steel", "stainless_steel", "cast_iron",
                                                    "aluminium", "copper_alloy",   "titanium"};

struct Group {
  double k_c1 = 0, mc = 0;  // N/mm^2 at 1 mm x 1 mm of chip, and its exponent; 0: the default of a job
  const char* group = "";
};
constexpr std::array<Group, kWords.size()> kGroups = {{{0, 0, "case hardening and quenched and tempered steel"},
                                                       {4650, 0.24, "55 to 60 HRC"},
                                                       {2150, 0.20, "austenitic"},
                                                       {1225, 0.25, "nodular; grey iron costs as much"},
                                                       {800, 0.25, "wrought, cured"},
                                                       {700, 0.27, "brass, bronze"},
                                                       {2110, 0.22, "alpha and beta alloys"}}};

double two_digits(double value) {
  const double step = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::round(value / step) * step;
}

std::size_t place_of(std::string_view word) {
  std::size_t k = 0;
  while (kWords.at(k) != word) ++k;
  return k;
}

}  // namespace

std::span<const std::string_view> material_words() { return kWords; }

force::Material forces_of(std::string_view word) {
  const Group& g = kGroups.at(place_of(word));
  force::Material m;
  if (g.k_c1 == 0) return m;
  const auto edge = [&g](double h) { return g.k_c1 * std::pow(h, 1 - g.mc); };  // N for a mm of edge
  const double K = (edge(kThick) - edge(kThin)) / (kThick - kThin);
  m.cutting_N_mm2 = two_digits(K);
  m.edge_N_mm = two_digits(edge(kThin) - K * kThin);
  return m;
}

std::string material_text(const std::string& word) {
  if (word.empty()) return {};
  const force::Material m = forces_of(word);
  return fmt::format(
      "\n[material]                       # {}, {}\ncutting_coefficient = {:g}       # N/mm^2\n"
      "edge_coefficient = {:g}            # N/mm; usual values, measure yours where tools are slender\n",
      word, kGroups.at(place_of(word)).group, m.cutting_N_mm2, m.edge_N_mm);
}

}  // namespace toothpath::proposal
