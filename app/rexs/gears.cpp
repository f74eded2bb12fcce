#include "app/rexs/gears.h"

#include <algorithm>
#include <array>

namespace toothpath::rexs {
namespace {

/// Components that change a flank from its theory.
constexpr std::array<std::string_view, 14> kModifications = {"tip_relief",
                                                             "root_relief",
                                                             "profile_crowning",
                                                             "profile_slope",
                                                             "profile_twist",
                                                             "helix_crowning",
                                                             "helix_slope",
                                                             "end_relief_datum_face",
                                                             "end_relief_non_datum_face",
                                                             "triangular_tip_relief",
                                                             "triangular_root_relief",
                                                             "topographical_modification",
                                                             "profile_deviation",
                                                             "helix_deviation"};

/// Modifications that are related to the gear or to one of its flanks.
std::vector<std::string> left_out(const RexsFile& file, const Component& gear, const Flanks& flanks) {
  std::vector<std::string> out;
  for (const Relation& relation : file.relations) {
    const bool ours = std::any_of(relation.refs.begin(), relation.refs.end(), [&](const Reference& r) {
      return r.id == gear.id || (flanks.left && (r.id == flanks.left->id || r.id == flanks.right->id));
    });
    if (!ours) continue;
    for (const Reference& ref : relation.refs) {
      const Component* part = file.find(ref.id);
      if (part && std::find(kModifications.begin(), kModifications.end(), part->type) != kModifications.end())
        out.push_back(part->title());
    }
  }
  return out;
}

}  // namespace

std::vector<const Component*> gears_of(const RexsFile& file) {
  std::vector<const Component*> out;
  for (const Component& c : file.components)
    if (c.type == "cylindrical_gear" || c.type == "bevel_gear") out.push_back(&c);
  return out;
}

Flanks flanks_of(const RexsFile& file, const Component& gear, Refused& refused) {
  for (const Relation& relation : file.relations) {
    const Reference *owner = relation.role("gear"), *left = relation.role("left"), *right = relation.role("right");
    if (relation.type != "flank" || !owner || owner->id != gear.id) continue;
    if (left && right) return {file.find(left->id), file.find(right->id)};
    refused.add(relation.at, "the relation \"flank\" of {} lacks the role {}", gear.title(), left ? "right" : "left");
    return {};
  }
  refused.add(gear.at, "{} has no flanks: a relation of type \"flank\" with the roles gear, left and right is needed",
              gear.title());
  return {};
}

Step step_of(const RexsFile& file, const Component& flank) {
  const Relation* last = nullptr;
  for (const Relation& relation : file.relations) {
    const Reference* work = relation.role("workpiece");
    if (relation.type != "manufacturing_step" || !work || work->id != flank.id) continue;
    if (!last || relation.order >= last->order) last = &relation;
  }
  Step step;
  if (!last) return step;
  if (const Reference* tool = last->role("tool")) step.tool = file.find(tool->id);
  if (const Reference* settings = last->role("manufacturing_settings")) step.settings = file.find(settings->id);
  return step;
}

Expected<GearOfFile, Obstacles> gear_of(const RexsFile& file, const Component& gear, const Said& said) {
  Refused refused;
  Obstacles obstacles;
  GearOfFile out;
  const bool bevel = gear.type == "bevel_gear";
  if (!bevel && (said.left_is_concave || said.work_per_cradle))
    refused.add(gear.at, "{}: --left-flank and --ratio-of-roll are for bevel gears", gear.title());
  if (bevel && (said.dedendum_coefficient || said.root_radius_coefficient))
    refused.add(gear.at, "{}: --dedendum-coefficient and --root-radius-coefficient are for cylindrical gears",
                gear.title());
  if (bevel) out.gear = spiral_bevel_of(file, gear, said, refused, obstacles);
  else out.gear = cylindrical_of(file, gear, said, refused);
  obstacles.errors = std::move(refused.errors);
  if (!obstacles.errors.empty() || !obstacles.questions.empty()) return obstacles;
  out.left_out = left_out(file, gear, flanks_of(file, gear, refused));
  return out;
}

}  // namespace toothpath::rexs
