#include "app/process/under_load/asked_besides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

namespace toothpath::under_load {
namespace {

/// Largest size of what friction adds over a pitch.
double most_of(const std::vector<loaded::Friction>& friction, double loaded::Friction::*what) {
  double most = 0;
  for (const auto& f : friction) most = std::max(most, std::abs(f.*what));
  return most;
}
nlohmann::ordered_json friction_json(double mu, const std::vector<loaded::Friction>& friction) {
  using loaded::Friction;
  return {{"coefficient", mu},
          {"axial_N", most_of(friction, &Friction::axial_n)},
          {"axial_bound_N", most_of(friction, &Friction::axial_bound_n)},
          {"torque_percent", 100 * most_of(friction, &Friction::torque_part)},
          {"torque_bound_percent", 100 * most_of(friction, &Friction::torque_bound)}};
}

/// The two fillets of a flank, by body.
struct NamedRoot {
  const char *body, *name, *face, *height;  ///< body: key of files; name: for people
  const loaded::RootPlace& at;
  double error;
};
std::array<NamedRoot, 2> roots_of(const PairWords& words, const loaded::RootStress& root) {
  return {{{"gear", words.gear, words.gear_face, words.gear_height, root.gear, root.gear_error},
           {"pinion", "pinion", words.pinion_face, words.pinion_height, root.pinion, root.pinion_error}}};
}
/// A key as people write it.
std::string spoken(std::string key) {
  std::replace(key.begin(), key.end(), '_', ' ');
  return key;
}
nlohmann::ordered_json root_json(const PairWords& words, const loaded::RootStress& root) {
  nlohmann::ordered_json json;
  for (const auto& r : roots_of(words, root))
    json[r.body] = {{"stress_MPa", r.at.stress},
                    {"error_MPa", r.error},
                    {"ring", r.at.ring},
                    {"tooth", r.at.tooth},
                    {"position", r.at.position},
                    {fmt::format("{}_mm", r.face), r.at.face},
                    {fmt::format("{}_mm", r.height), r.at.height}};
  return json;
}

page::PageTable friction_table(const LoadedContact& found) {
  using loaded::Friction;
  page::PageTable t{
      fmt::format("What friction of {:g} could add", *found.settings.friction),
      {"flank", "axial N", "bound N", "torque %", "bound %"},
      {},
      "Not solved: every place slides as the rigid pair does, its friction is the coefficient times the "
      "force found without it. Largest of the pitch, either sign, as the pair turns either way. Bound: no "
      "place cancels another."};
  for (const auto& side : found.sides) {
    const auto most = [&](double Friction::*what) { return most_of(side.friction, what); };
    t.rows.push_back({side.name, fmt::format("{:.2f}", most(&Friction::axial_n)),
                      fmt::format("{:.2f}", most(&Friction::axial_bound_n)),
                      fmt::format("{:.3f}", 100 * most(&Friction::torque_part)),
                      fmt::format("{:.3f}", 100 * most(&Friction::torque_bound))});
  }
  return t;
}

page::PageTable root_table(const LoadedContact& found) {
  page::PageTable t{
      "Stress at the root",
      {"flank", "body", "MPa", "mesh +- MPa", found.words.ring, "tooth", "position", "along mm", "height mm"},
      {},
      fmt::format("The largest principal stress in the fillets under the loaded flanks over the pitch. "
                  "Along and height: of the {} {} and {}, of the pinion {} and {}. Mesh: "
                  "what two meshes tell of their error. {}",
                  found.words.gear, spoken(found.words.gear_face), found.words.gear_height,
                  spoken(found.words.pinion_face), found.words.pinion_height,
                  found.pinion_fillet_mm > 0
                      ? fmt::format("The pinion's fillet is a circle of {:g} mm, not the one that its "
                                    "tool cuts.",
                                    found.pinion_fillet_mm)
                      : "Fillets are those that the corner arcs of the mills leave.")};
  for (const auto& side : found.sides)
    for (const auto& r : roots_of(found.words, side.root.value()))
      t.rows.push_back({side.name, r.name, fmt::format("{:.1f}", r.at.stress), fmt::format("{:.1f}", r.error),
                        std::to_string(r.at.ring), std::to_string(r.at.tooth), std::to_string(r.at.position),
                        fmt::format("{:.3f}", r.at.face), fmt::format("{:.3f}", r.at.height)});
  return t;
}

}  // namespace

std::string besides_summary(const LoadedContact& found, const LoadedSide& side) {
  using loaded::Friction;
  std::string out;
  if (!side.friction.empty())
    out += fmt::format(
        "    friction {:g} could add +-{:.2f} N along the axis (+-{:.2f} N if no place cancelled another), +-{:.2f} % "
        "of "
        "the torque\n",
        *found.settings.friction, most_of(side.friction, &Friction::axial_n),
        most_of(side.friction, &Friction::axial_bound_n), 100 * most_of(side.friction, &Friction::torque_part));
  if (!side.root) return out;
  for (const auto& r : roots_of(found.words, *side.root))
    out += fmt::format(
        "    root stress of the {} {:.1f} MPa (mesh +-{:.1f}) at most, {} {}, tooth {:+}, {} {:.3f}, {} {:.3f} mm\n",
        r.name, r.at.stress, r.error, found.words.ring, r.at.ring, r.at.tooth, spoken(r.face), r.at.face, r.height,
        r.at.height);
  return out;
}

void add_besides(nlohmann::ordered_json& flank, const LoadedContact& found, const LoadedSide& side) {
  if (!side.friction.empty()) flank["friction"] = friction_json(*found.settings.friction, side.friction);
  if (side.root) flank["root_stress"] = root_json(found.words, *side.root);
}

std::string root_csv(const LoadedContact& found) {
  std::string out = "surface,flank,body,ring,tooth,position,along_mm,height_mm,stress_MPa,mesh_error_MPa\n";
  for (const auto& side : found.sides)
    for (const auto& r : roots_of(found.words, side.root.value()))
      out += fmt::format("{},{},{},{},{},{},{:.4f},{:.4f},{:.3f},{:.3f}\n", side.as_cut ? "cut" : "exact", side.side,
                         r.body, r.at.ring, r.at.tooth, r.at.position, r.at.face, r.at.height, r.at.stress, r.error);
  return out;
}

std::vector<page::PageTable> besides_tables(const LoadedContact& found) {
  std::vector<page::PageTable> tables;
  if (found.settings.friction) tables.push_back(friction_table(found));
  if (found.settings.root_stress) tables.push_back(root_table(found));
  return tables;
}

}  // namespace toothpath::under_load
