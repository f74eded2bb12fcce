#include "geometry/loaded/root_stress.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <map>
#include <optional>

namespace toothpath::loaded {
namespace {

/// Forces of one position on the stations of a body, by tooth.
std::map<int, Eigen::VectorXd> station_forces(const RootBody& of, int ring, const LoadedPosition& position) {
  const ToothBody& body = of.bricks;
  std::map<int, Eigen::VectorXd> forces;
  for (const PressedSegment& s : position.segments) {
    if (s.place.ring != ring || !(s.force > 0)) continue;
    auto [at, fresh] = forces.try_emplace(s.place.tooth);
    if (fresh) at->second = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(body.sector.stations.size()));
    const ToothBody::Weights on = of.on_gear ? body.weights(s.place.r, s.place.z) : body.weights(s.place.Z, s.place.R);
    for (std::size_t k = 0; k < 4; ++k) at->second(on.station[k]) += on.weight[k] * s.force;
  }
  return forces;
}

/// Two meshes. A fillet's stress dies away within its radius: bricks must be thin under it (grading 2), more than many.
constexpr int kMeshes = 2, kFillet = 6, kFlank = 6, kFace = 8;
constexpr double kGrading = 2;

elastic::SectorPlan plan_of(int across, double rim_mm) {
  elastic::SectorPlan plan;
  plan.across = across, plan.fillet = kFillet;
  plan.flank = kFlank, plan.face = kFace, plan.grading = kGrading, plan.rim_mm = rim_mm;
  return plan;
}

}  // namespace

Result<RootBody> with_stress(RootBody body, const BodyPlan& of) {
  const auto fields = elastic::tooth_fields(body.bricks.sector, of.nu, of.teeth);
  if (!fields) return fields.error();
  body.nodes = elastic::fillet_nodes(body.bricks.sector);
  body.stress = elastic::hat_stress(body.bricks.sector, of.nu, *fields, body.nodes);
  return body;
}

Result<RootBody> root_body(const LoadedPair& pair, const PairRing& ring, bool on_gear,
                           const elastic::SectorPlan& plan) {
  const ContactBounds& b = ring.bounds;
  const BodyPlan& of = on_gear ? pair.options.gear : pair.options.pinion;
  const auto pinion = contact::make_pinion(ring.surface, pair.pinion_teeth);
  auto bricks =
      on_gear ? gear_bricks(ring.surface, pair.side, b.inner_mm, b.outer_mm, plan)
              : pinion_bricks(pinion, pinion_profile(pinion, ring.surface.shaper.h_f, pair.options.pinion_fillet_mm),
                              pair.side, b.least_Z, b.most_Z, plan);
  if (!bricks) return bricks.error();
  return with_stress({std::move(*bricks), on_gear, 1,
                      [on_gear](const Vec3& p) {
                        const double radius = std::hypot(p.x(), p.y());
                        return on_gear ? Vec2(radius, p.z()) : Vec2(p.z(), radius);
                      }},
                     of);
}

RootPlace most_stressed(const RootBody& body, int ring, const LoadedCycle& cycle) {
  RootPlace most;
  most.stress = -1e300;
  for (std::size_t k = 0; k < cycle.positions.size(); ++k) {
    const auto forces = station_forces(body, ring, cycle.positions[k]);
    for (const auto& [tooth, own] : forces) {
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(6 * body.nodes.size()));
      for (const auto& [loaded, force] : forces) {
        const int offset = (tooth - loaded) * body.next + body.stress.reach;
        if (offset >= 0 && offset <= 2 * body.stress.reach)
          sum += body.stress.at_offset[static_cast<std::size_t>(offset)] * force;
      }
      for (std::size_t n = 0; n < body.nodes.size(); ++n) {
        const double stress = elastic::largest_principal(sum.segment<6>(static_cast<Eigen::Index>(6 * n)));
        if (!(stress > most.stress)) continue;
        const Vec2 at = body.place(body.bricks.sector.nodes[static_cast<std::size_t>(body.nodes[n])]);
        most = {stress, static_cast<int>(k), ring, tooth, at.x(), at.y()};
      }
    }
  }
  return most;
}

Result<RootStress> root_stress(const RootBodies& of, const LoadedCycle& cycle) {
  const std::size_t bodies = 2 * of.rings.size();
  std::vector<std::optional<Result<RootPlace>>> found(kMeshes * bodies);
  tbb::parallel_for(std::size_t(0), found.size(), [&](std::size_t n) {
    const std::size_t ring = n / 2 % of.rings.size();
    const bool on_gear = n % 2 == 0;
    const auto body = of.make(ring, on_gear, plan_of(of.across[n / bodies], of.rim_mm[n % 2]));
    if (body) found[n] = most_stressed(*body, of.rings[ring], cycle);
    else found[n] = body.error();
  });
  RootStress out;
  for (const bool on_gear : {true, false}) {
    RootPlace most[kMeshes];
    for (std::size_t n = on_gear ? 0 : 1; n < found.size(); n += 2) {
      if (!*found[n]) return found[n]->error();
      RootPlace& best = most[n / bodies];
      if (best.stress < (*found[n])->stress) best = **found[n];
    }
    (on_gear ? out.gear : out.pinion) = most[1];
    (on_gear ? out.gear_error : out.pinion_error) = std::abs(most[1].stress - most[0].stress);
  }
  return out;
}

Result<RootStress> root_stress(const LoadedPair& pair, const LoadedCycle& cycle) {
  RootBodies of;
  for (const PairRing& ring : pair.rings) {
    if (const double rho = ring.surface.shaper.rho; !(rho > 0))
      return fail("shaper_tip_radius = {:g} mm is not above 0: a fillet without a radius has no finite stress", rho);
    of.rings.push_back(ring.ring);
  }
  of.rim_mm = {pair.options.gear.bricks.rim_mm, pair.options.pinion.bricks.rim_mm};
  of.make = [&](std::size_t ring, bool on_gear, const elastic::SectorPlan& plan) {
    return root_body(pair, pair.rings[ring], on_gear, plan);
  };
  return root_stress(of, cycle);
}

}  // namespace toothpath::loaded
