#include "postproc/bodies/scene.h"

#include <algorithm>
#include <cmath>

namespace toothpath::bodies {
namespace {

constexpr double kParallel = 1e-12;    // sine of axes that are one direction
constexpr double kTouching = 1e-6;     // mm
constexpr double kLeastReach = 1e-13;  // mm: of whatever turns, less than the rounding of places

double to_line(const Vec3& p, const Vec3& point, const Vec3& direction) { return (p - point).cross(direction).norm(); }

/// What is less than rounding is nothing.
double kept(double reach) { return reach < kLeastReach ? 0 : reach; }

bool names(const Body& a, const Body& b) {
  return std::find(a.touches.begin(), a.touches.end(), b.name) != a.touches.end();
}

machines::Place relative(const machines::Place& a, const machines::Place& b) {
  const Mat3 back = a.turn.transpose();
  return {back * b.turn, back * (b.shift - a.shift)};
}

}  // namespace

Scene::Scene(const machines::KinematicChain& chain, std::vector<Body> bodies)
    : links_(chain), bodies_(std::move(bodies)) {
  for (std::size_t a = 0; a < bodies_.size(); ++a)
    for (std::size_t b = a + 1; b < bodies_.size(); ++b) {
      Pair pair{a, b, {}};
      if (bodies_[a].link > bodies_[b].link) std::swap(pair.first, pair.second);
      const Body &first = bodies_[pair.first], &second = bodies_[pair.second];
      if (first.link == second.link) continue;
      const auto either = [&](Kind kind) { return first.kind == kind || second.kind == kind; };
      if (either(Kind::tool) && either(Kind::work)) continue;
      if (bears(first, second)) {
        bearing_.push_back(first.name + ", " + second.name);
        continue;
      }
      for (std::size_t k = first.link; k < second.link; ++k)
        pair.reach.push_back(!links_.joints()[k].rotary ? 1.0 : kept(std::min(reach(first, k), reach(second, k))));
      pairs_.push_back(std::move(pair));
    }
}

bool Scene::bears(const Body& a, const Body& b) const {
  if (names(a, b) || names(b, a)) return true;
  if (a.kind != Kind::machine || b.kind != Kind::machine || b.link != a.link + 1) return false;
  machines::Joints at;
  const machines::Joint& joint = links_.joints()[a.link];
  for (std::size_t k = 0; k < 3; ++k) {
    const machines::LinearAxis& axis = links_.chain().linear[k];
    if (!joint.rotary && joint.axis == k)
      at.linear_mm[Eigen::Index(k)] = std::clamp(0.0, std::min(axis.min_mm, axis.max_mm), axis.max_mm);
  }
  for (std::size_t k = 0; k < links_.chain().rotary_count(); ++k) at.rotary_rad[k] = links_.chain().rotary(k).zero_rad;
  const auto places = links_.places(at);
  return a.solid.gap_to(b.solid, relative(places[a.link], places[b.link]), 2 * kTouching).proven <= kTouching;
}

double Scene::reach(const Body& body, std::size_t joint) const {
  const Vec3 point = links_.point(joint), direction = links_.direction(joint);
  const bool outer = joint >= body.link;  // the joint lies towards the tool as seen from the body
  const bool next = outer ? joint == body.link : joint + 1 == body.link;
  if (const auto& axis = body.solid.axis(); next && axis && axis->second.cross(direction).norm() < kParallel)
    return to_line(axis->first, point, direction);
  std::vector<Ball> balls = body.solid.extent();
  const auto pass = [&](std::size_t k) {
    const machines::Joint& between = links_.joints()[k];
    if (between.rotary) {  // anywhere on its circle
      for (Ball& ball : balls) {
        const Vec3 from = ball.centre - links_.point(k), d = links_.direction(k);
        const Vec3 along = d * from.dot(d);
        ball.radius += (from - along).norm();
        ball.centre = links_.point(k) + along;
      }
      return;
    }
    const machines::LinearAxis& axis = links_.chain().linear[between.axis];
    const double sign = outer ? -1 : 1, middle = sign * (axis.min_mm + axis.max_mm) / 2;
    for (Ball& ball : balls) {
      ball.centre += middle * links_.direction(k);
      ball.radius += (axis.max_mm - axis.min_mm) / 2;
    }
  };
  if (outer)
    for (std::size_t k = body.link; k < joint; ++k) pass(k);
  else
    for (std::size_t k = body.link; k-- > joint + 1;) pass(k);
  double most = 0;
  for (const Ball& ball : balls) most = std::max(most, to_line(ball.centre, point, direction) + ball.radius);
  return most;
}

machines::Place Scene::between(const Pair& pair, const std::vector<machines::Place>& places) const {
  return relative(places[bodies_[pair.first].link], places[bodies_[pair.second].link]);
}

Gap Scene::gap_of(const Pair& pair, const machines::Joints& joints, double within) const {
  const auto places = links_.places(joints);
  return bodies_[pair.first].solid.gap_to(bodies_[pair.second].solid, between(pair, places), within);
}

Overlap Scene::overlap_of(const Pair& pair, const machines::Joints& joints) const {
  const auto places = links_.places(joints);
  Overlap found = overlap(bodies_[pair.first].solid, bodies_[pair.second].solid, between(pair, places));
  found.direction = places[bodies_[pair.first].link].turn * found.direction;
  return found;
}

}  // namespace toothpath::bodies
