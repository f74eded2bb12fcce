// sample_curve: bisect until the exact curve is nowhere farther than the chord tolerance from the chord.
#pragma once

namespace toothpath::ball {

template <typename Curve>
std::optional<SampledCurve> sample_curve(const Curve& curve, double r_begin, double r_end, double chord_mm,
                                         double longest_mm) {
  struct Node {
    double r;
    BallPass::Point at;
  };
  SampledCurve out;
  const auto node = [&](double r) -> std::optional<Node> {
    const auto p = curve(r);
    if (!p) return {};
    return Node{r, *p};
  };
  const auto sag = [](const Vec3& a, const Vec3& b, const Vec3& p) {
    const Vec3 ab = b - a;
    const double t = ab.squaredNorm() > 0 ? std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0) : 0.0;
    return (p - a - t * ab).norm();
  };
  auto previous = node(r_begin);
  if (!previous) return {};
  out.points.push_back(previous->at);
  std::vector<Node> ahead;
  auto last = node(r_end);
  if (!last) return {};
  ahead.push_back(*last);
  while (!ahead.empty()) {
    const Node next = ahead.back();
    const double gap = next.r - previous->r;
    const auto middle = node(previous->r + 0.5 * gap), quarter = node(previous->r + 0.25 * gap),
               three = node(previous->r + 0.75 * gap);
    if (!middle || !quarter || !three) return {};
    const Vec3 &a = previous->at.centre, &b = next.at.centre;
    const double worst =
        std::max({sag(a, b, middle->at.centre), sag(a, b, quarter->at.centre), sag(a, b, three->at.centre)});
    const bool fine = worst <= chord_mm && (b - a).norm() <= longest_mm;
    if (fine || std::abs(gap) < 1e-7) {
      out.worst_chord_mm = std::max(out.worst_chord_mm, worst);
      out.points.push_back(next.at);
      previous = next;
      ahead.pop_back();
    } else {
      ahead.push_back(*middle);
    }
  }
  return out;
}

}  // namespace toothpath::ball
