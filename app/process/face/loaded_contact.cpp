#include "app/process/face/loaded_contact.h"

#include <algorithm>

#include "app/job/file.h"
#include "app/process/cut_flanks.h"
#include "app/process/under_load/loaded_side.h"
#include "geometry/decks/rows_deck.h"

namespace toothpath::face {
namespace {

constexpr double kPinionFillet = 0.24;  // of the module

/// Deviation of a cut flank at radius r and height z, bilinear on its grid; beyond it that of its rim.
double deviation_at(const contact::ContactFlank& f, double r, double z) {
  const auto place = [](double x, int n, const auto& value) {  // index and share, values rising or falling
    const bool rises = value(n - 1) > value(0);
    int low = 0, high = n - 1;
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      ((value(middle) > x) == rises ? high : low) = middle;
    }
    const double share = (x - value(low)) / (value(high) - value(low));
    return std::pair(low, std::clamp(share, 0.0, 1.0));
  };
  const auto [c, across] = place(r, f.columns, [&](int k) { return radius(f.points[f.index(f.rows / 2, k)]); });
  double sum = 0;
  for (int k = 0; k < 2; ++k) {
    const int column = c + k;
    const auto [row, up] = place(z, f.rows, [&](int n) { return f.points[f.index(n, column)].z(); });
    sum += (k == 0 ? 1 - across : across) *
           ((1 - up) * f.deviation_mm[f.index(row, column)] + up * f.deviation_mm[f.index(row + 1, column)]);
  }
  return sum;
}

/// Material that is left closes the gap: mean over the piece of a line.
double gap_of_cut(const std::vector<const contact::ContactFlank*>& flanks, const loaded::Segment& s) {
  for (const auto* flank : flanks) {
    if (flank->zone != s.ring) continue;
    constexpr int kPlaces = 9;
    double sum = 0;
    for (int k = 0; k < kPlaces; ++k) {
      const Vec3 p = s.nearest + s.along * (s.length * ((k + 0.5) / kPlaces - 0.5));
      sum += deviation_at(*flank, radius(p), p.z()) / kPlaces;
    }
    return -sum;
  }
  return 0;
}

/// What modifications take off gear and pinion at a place of the housing.
double removed_at(const contact::ContactMember& member, const Vec3& p) {
  double sum = 0;
  if (member.flank.modified)
    if (const auto* drawn = member.flank.modified->field(member.flank.side).drawn)
      sum += drawn->removal(face_gear::FlankField::depth<double>(member.flank.surface, p, radius(p)), radius(p));
  if (!member.on_pinion) return sum;
  const auto place = member.pinion.place(p);
  return sum + member.on_pinion->removal(member.pinion.r_a - place.radius, place.Z);
}

/// Options of the pair for a gear of this module. Refused: a rim that does not fit the gear.
Result<loaded::PairOptions> pair_options(const job::ContactLoad& load, const face_gear::FaceGear& gear,
                                         const contact::Misalignment& moved) {
  const double m = gear.parameters().module_mm;
  loaded::PairOptions options;
  const double rim = load.rim_mm.value_or(5 * m);
  if (!(rim >= 0.5 * m) || !(rim < gear.inner_radius()))
    return fail("rim = {:g} mm is not between half the module, {:g} mm, and the inner radius, {:g} mm", rim, 0.5 * m,
                gear.inner_radius());
  const auto plans = under_load::body_plans(load, rim);
  options.gear = plans[0], options.pinion = plans[1];
  options.segment_mm = load.segment_mm.value_or(0.3 * m);
  options.pinion_fillet_mm = kPinionFillet * m;
  options.moved = moved;
  options.edge_radius_mm = load.edge_radius_mm;
  return options;
}

}  // namespace

process::ValueOrErrors<under_load::LoadedContact> analyse_loaded(
    const job::Job& job, const face_gear::FaceGear& gear, const job::ContactSettings& settings, int pinion_teeth,
    const std::vector<const contact::ContactMember*>& exact, const std::vector<const contact::ContactFlank*>& cut,
    const std::string& route) {
  under_load::LoadedContact found;
  found.words = under_load::kFaceWords;
  found.settings = settings.load.value();
  const job::ContactLoad& load = found.settings;
  const face_gear::FaceGearParameters& p = gear.parameters();
  found.rings = static_cast<int>(p.zones.size());
  found.pinion_teeth = pinion_teeth;
  found.torque_gear_Nm = load.on_pinion ? load.torque_Nm * p.teeth / pinion_teeth : load.torque_Nm;
  const bool opposite = p.zones.size() == 2 && p.zones[0].helix_angle_rad * p.zones[1].helix_angle_rad < 0;
  if (load.pinion_axial == job::PinionHold::floating && !opposite)
    return std::vector{
        process::located(job, "contact.load.pinion_axial",
                         fail("pinion_axial = \"floating\" needs two rings of opposite hand: nothing else "
                              "keeps the pinion in its place"))};
  found.floating =
      load.pinion_axial == job::PinionHold::floating || (load.pinion_axial == job::PinionHold::automatic && opposite);
  const auto options = pair_options(load, gear, settings.moved);
  if (!options) return std::vector{process::located(job, "contact.load.rim", options.error())};
  found.segment_mm = options->segment_mm;
  found.rim_mm = options->gear.bricks.rim_mm;
  found.pinion_fillet_mm = options->pinion_fillet_mm;
  const char* teeth_key = settings.pinion_teeth > 0 ? "contact.pinion_teeth" : "gear.mate_teeth";
  const loaded::Load carried = under_load::load_of(found, found.torque_gear_Nm);
  for (const int side : {1, -1}) {
    auto pair = loaded::make_loaded_pair(gear, side, pinion_teeth, *options);
    if (!pair) return std::vector{process::located(job, teeth_key, pair.error())};
    for (const auto* member : exact)
      if (member->flank.side == side && member->modified())
        pair->rings[static_cast<std::size_t>(member->flank.zone)].removal = [member](const Vec3& at) {
          return removed_at(*member, at);
        };
    auto drawn = under_load::loaded_side(*pair, carried, side, fmt::format("flank {:+}, exact", side), load);
    if (!drawn) return std::vector{process::located(job, "contact.load", drawn.error())};
    under_load::add_side(found, std::move(*drawn), under_load::is_steel(load));
    std::vector<const contact::ContactFlank*> of_side;
    for (const auto* flank : cut)
      if (flank->side == side) of_side.push_back(flank);
    if (of_side.empty()) continue;
    loaded::LoadedPair rough = *pair;
    rough.options.gap = [&](const loaded::Segment& s) { return gap_of_cut(of_side, s); };
    auto worn = under_load::loaded_side(rough, carried, side,
                                        fmt::format("flank {:+}, {}", side, process::words_of_route(route)), load);
    if (!worn) return std::vector{process::located(job, "contact.load", worn.error())};
    worn->as_cut = true;
    under_load::add_side(found, std::move(*worn), false);
  }
  return found;
}

process::ValueOrErrors<process::NamedFiles> loaded_decks(const job::Job& job, const face_gear::FaceGear& gear,
                                                         const under_load::LoadedContact& found) {
  if (found.pinion_teeth != gear.parameters().shaper_teeth)
    return std::vector{fail_at(job.where("gear.shaper_teeth"),
                               "--ccx is for a pinion of as many teeth as the shaper, {}, not {}",
                               gear.parameters().shaper_teeth, found.pinion_teeth)};
  process::NamedFiles files;
  for (int ring = 0; ring < found.rings; ++ring)
    for (const auto& side : found.sides) {
      if (side.as_cut) continue;
      decks::DeckOptions options;
      options.bricks.rim_mm = found.rim_mm;
      options.teeth = found.settings.row_teeth;
      options.E = found.settings.youngs_modulus_N_mm2[0], options.nu = found.settings.poisson[0];
      options.pinion_fillet_mm = kPinionFillet * gear.parameters().module_mm;
      options.approach_mm =
          under_load::range_of(side.cycle, [](const loaded::LoadedPosition& p) { return p.approach_mm; }).mean;
      auto deck = decks::contact_deck(gear, ring, side.side, options);
      if (!deck) return std::vector{process::located(job, fmt::format("gear.zone[{}]", ring), deck.error())};
      files.emplace_back(fmt::format("ring_{}_flank_{}.inp", ring, side.side > 0 ? "plus" : "minus"), std::move(*deck));
    }
  return files;
}

}  // namespace toothpath::face
