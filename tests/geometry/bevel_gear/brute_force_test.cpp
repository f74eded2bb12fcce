// A blank point is gone if and only if it lies inside the solid mill at some instant of some pass. The mill here is
// built from the equivalent gear's tooth space in polar form, apart from the library's profile, and no equation of
// meshing is used.
#include <map>
#include <random>

#include "geometry/bevel_gear/part.h"
#include "geometry/mesh/tooth_mesh.h"
#include "tests/geometry/bevel_gear/samples.h"
#include "tests/support/brute_force_bevel_gear.h"

namespace toothpath {
namespace {

using namespace bevel_test;

/// Meridian radius of the mill from its definition: involute of the base circle r_vb with half space angle tau, tangent
/// at C, arc.
class PolarMill {
 public:
  PolarMill(const bevel_gear::BevelGear& g, const bevel_gear::FingerCutterData& d)
      : r_v_(1 / g.kappa_v()),
        alpha_(g.parameters().pressure_angle_rad),
        r_b_(r_v_ * std::cos(alpha_)),
        tau_0_(kPi * d.module_mm / 4 / r_v_),
        h_f_(g.parameters().dedendum_mm),
        r_t_(d.tip_radius_mm),
        x_D_(d.profile_height_mm) {
    // C where the rack of depth h_C stops: base tangent length r_v sin(alpha) - h_C / sin(alpha).
    const double length = r_v_ * std::sin(alpha_) - d.rack_depth_mm / std::sin(alpha_);
    r_C_ = std::hypot(r_b_, std::max(0.0, length));
    x_C_ = r_C_ * std::cos(tau(r_C_)) - r_v_;
    rho_C_ = r_C_ * std::sin(tau(r_C_));
    // Tangent of the involute at C: the base tangent is its normal; by differences.
    const double h = 1e-6 * r_v_, a = r_C_ + h, b = r_C_ + 2 * h;
    const auto X = [&](double r) { return r * std::cos(tau(r)); };
    const auto Y = [&](double r) { return r * std::sin(tau(r)); };
    slope_ = (-3 * Y(r_C_) + 4 * Y(a) - Y(b)) / (-3 * X(r_C_) + 4 * X(a) - X(b));
    const double phi = std::atan(slope_);
    x_o_ = r_t_ - h_f_;
    rho_o_ = rho_C_ + (x_o_ - x_C_) * slope_ - r_t_ / std::cos(phi);
    x_B_ = x_o_ - r_t_ * std::sin(phi);
    widest_ = radius(x_D_);
  }
  [[nodiscard]] double radius(double x) const {
    if (x <= -h_f_) return -1;
    if (x < x_B_) return rho_o_ + std::sqrt(std::max(0.0, r_t_ * r_t_ - (x - x_o_) * (x - x_o_)));
    if (x < x_C_) return rho_C_ + (x - x_C_) * slope_;
    const double top = std::min(x, x_D_);
    double lo = r_C_, hi = r_v_ + 2 * x_D_ + 5;
    for (int k = 0; k < 70; ++k) {
      const double mid = 0.5 * (lo + hi);
      (mid * std::cos(tau(mid)) - r_v_ < top ? lo : hi) = mid;
    }
    return lo * std::sin(tau(lo));
  }
  [[nodiscard]] double depth() const { return h_f_; }
  [[nodiscard]] double widest() const { return widest_; }

 private:
  [[nodiscard]] double tau(double r) const {
    const auto inv = [](double a) { return std::tan(a) - a; };
    return tau_0_ + inv(std::acos(std::min(1.0, r_b_ / r))) - inv(alpha_);
  }
  double r_v_, alpha_, r_b_, tau_0_, h_f_, r_t_, x_D_, r_C_ = 0, x_C_ = 0, rho_C_ = 0, slope_ = 0, x_o_ = 0, rho_o_ = 0,
                                                       x_B_ = 0, widest_ = 0;
};

/// Least rho - radius(x) over a pass; negative: the point is gone.
double least_gap(const Vec3& point, const bevel_gear::BevelTrace<double>& t, int sigma, double from, double to,
                 const PolarMill& mill, int samples) {
  const auto gap = [&](double beta) {
    const auto c = sigma == 0 ? t.middle(beta) : t.centre(sigma, beta);
    const Vec3 q = bevel_gear::cutter_from_blank<double>(point, c.R_c, c.e, t.sin_delta, t.cos_delta);
    if (q.x() <= -mill.depth()) return 1e3;
    const double rho = std::hypot(q.y(), q.z());
    return rho > mill.widest() ? rho - mill.widest() : rho - mill.radius(q.x());
  };
  double best = 1e9;
  int at = 0;
  for (int i = 0; i <= samples; ++i)
    if (const double d = gap(from + (to - from) * i / samples); d < best) best = d, at = i;
  double a = from + (to - from) * std::max(0, at - 1) / samples,
         b = from + (to - from) * std::min(samples, at + 1) / samples;
  const double g = 0.5 * (std::sqrt(5.0) - 1);
  for (int k = 0; k < 36; ++k) {
    const double x1 = b - g * (b - a), x2 = a + g * (b - a);
    (gap(x1) < gap(x2) ? b : a) = gap(x1) < gap(x2) ? x2 : x1;
  }
  return std::min(best, gap(0.5 * (a + b)));
}

struct Case {
  const char* name;
  bevel_gear::BevelGearParameters p;
  bevel_gear::FingerCutterData c;
};
std::vector<Case> cases() {
  const auto steep = design(12, 60, 3, 45, 0.25), flat = design(25, 25, 5, 5, 0.22, -1);
  return {{"W1", w1(), pinion_mill()}, {"W2", w2(), wheel_mill()},   {"W3", w3(), pinion_mill()},
          {"W4", w4(), wheel_mill()},  {"45 deg", steep.p, steep.c}, {"5 deg", flat.p, flat.c}};
}

/// Points 1e-6 mm on either side of every wall: in the space gone, in the tooth there after all passes of all halves.
TEST(BevelBruteForce, WallsSeparateWhatIsGoneFromWhatStays) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0.001, 0.999);
  for (const auto& test : cases()) {
    const bevel_gear::BevelGear g = made(test.p, test.c);
    const PolarMill mill(g, test.c);
    const double low = -g.parameters().dedendum_mm + 0.02 * g.parameters().outer_transverse_module_mm,
                 high = g.parameters().addendum_mm, off = 1e-6;
    for (const auto& half : g.halves())
      for (int k = 0; k < 2; ++k)
        for (int n = 0; n < 8; ++n) {
          const auto& w = half.walls[k];
          const double ell = half.ell_from + (half.ell_to - half.ell_from) * share(random),
                       height = low + (high - low) * share(random);
          const auto at = bevel_gear::bevel_inverse(w, ell, height);
          ASSERT_TRUE(at) << test.name << ' ' << ell << ' ' << height;
          const auto f = w.point(at->beta, at->p);
          EXPECT_LT(least_gap(f.p + off * f.n, w.trace, w.sigma, half.beta_from[k], half.beta_to[k], mill, 300), 0)
              << test.name;
          const Vec3 inside = f.p - off * f.n;
          for (const auto& other : g.halves()) {
            for (int s = 0; s < 2; ++s)
              EXPECT_GT(least_gap(inside, other.walls[s].trace, other.walls[s].sigma, other.beta_from[s],
                                  other.beta_to[s], mill, 300),
                        0)
                  << test.name;
            const auto& t = other.walls[0].trace;
            EXPECT_GT(least_gap(inside, t, 0, t.beta(other.R_from), t.beta(std::min(other.R_to, t.R_lim())), mill, 300),
                      0)
                << test.name;
          }
        }
  }
}

/// Material simulation: whatever of a grid is gone lies between the walls and above the root, and next to the walls
/// nothing is left.
TEST(BevelBruteForce, RemovedGridPointsLieInTheToothSpace) {
  for (const auto& test : {cases()[0], cases()[2]}) {
    const bevel_gear::BevelGear g = made(test.p, test.c);
    const PolarMill mill(g, test.c);
    int gone = 0, kept = 0;
    for (const auto& half : g.halves())
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j) {
          const double ell = half.ell_from + (half.ell_to - half.ell_from) * (i + 0.5) / 3,
                       height = -g.parameters().dedendum_mm + 0.4 +
                                (g.parameters().addendum_mm + g.parameters().dedendum_mm - 0.5) * j / 3;
          const auto L = bevel_gear::bevel_inverse(half.walls[0], ell, height),
                     U = bevel_gear::bevel_inverse(half.walls[1], ell, height);
          ASSERT_TRUE(L && U);
          const double width = U->azimuth - L->azimuth;
          for (int k = -8; k <= 24; ++k) {
            const double u = k / 16.0 + 1e-3;  // 0 .. 1 inside the space
            const Vec3 p = bevel_gear::blank_point(ell, height, L->azimuth + u * width, g.sin_delta(), g.cos_delta());
            bool removed = false;
            for (const auto& other : g.halves()) {
              for (int s = 0; s < 2 && !removed; ++s)
                removed = least_gap(p, other.walls[s].trace, other.walls[s].sigma, other.beta_from[s], other.beta_to[s],
                                    mill, 160) < 0;
              const auto& t = other.walls[0].trace;
              removed = removed || least_gap(p, t, 0, t.beta(other.R_from), t.beta(std::min(other.R_to, t.R_lim())),
                                             mill, 160) < 0;
            }
            if (removed) {
              EXPECT_GT(u, 0);
              EXPECT_LT(u, 1);
            }
            // Ridges stay on the root between the passes, never beside a wall.
            if ((u > 0 && u < 0.06) || (u > 0.94 && u < 1)) {
              EXPECT_TRUE(removed) << ell << ' ' << height << ' ' << u;
            }
            ++(removed ? gone : kept);
          }
        }
    EXPECT_GT(gone, 100);
    EXPECT_GT(kept, 100);
  }
}

/// Flank against the moving cutter at 1e-9 mm on the worked gears (m_te 6), both halves, up to the ends and the groove.
TEST(BevelBruteForce, FlankWithinANanometreOfTheMovingCutter) {
  for (const auto& test : {cases()[1], cases()[2], cases()[3]}) {
    const bevel_gear::BevelGear g = made(test.p, test.c);
    const bevel_gear::FingerSolid solid(g.cutter());
    for (const auto& half : g.halves())
      for (int k = 0; k < 2; ++k)
        for (const double u : {0.0, 0.37, 1.0})
          for (const double v : {0.02, 0.3, 0.66, 1.0}) {
            const auto& w = half.walls[k];
            const auto at = bevel_gear::bevel_inverse(
                w, half.ell_from + (half.ell_to - half.ell_from) * u,
                -g.parameters().dedendum_mm + (g.parameters().addendum_mm + g.parameters().dedendum_mm) * v);
            ASSERT_TRUE(at);
            const Vec3 p = w.point(at->beta, at->p).p;
            for (const auto& other : g.halves())
              for (int s = 0; s < 2; ++s) {
                const double gap = clearance_of_pass(p, other.walls[s].trace, other.walls[s].sigma, other.beta_from[s],
                                                     other.beta_to[s], solid, 200);
                if (&other == &half && s == k) {
                  EXPECT_NEAR(gap, 0, 1e-9) << test.name;
                } else {
                  EXPECT_GE(gap, -1e-9) << test.name;
                }
              }
          }
  }
}

/// Pulling out along the axis from any point of any pass takes nothing more from the blank.
TEST(BevelBruteForce, RetractingRemovesNothing) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  int inside = 0;
  for (const auto& test : cases()) {
    const bevel_gear::BevelGear g = made(test.p, test.c);
    const PolarMill mill(g, test.c);
    const double h_f = g.parameters().dedendum_mm, h_a = g.parameters().addendum_mm;
    for (const auto& half : g.halves())
      for (int n = 0; n < 900; ++n) {
        const int k = n % 2;
        const auto& w = half.walls[k];
        const auto c =
            w.trace.centre(w.sigma, half.beta_from[k] + (half.beta_to[k] - half.beta_from[k]) * share(random));
        // A random blank point near the mill, and the same mill lifted.
        const double reach = 1.2 * g.cutter().rho_D;
        const Vec3 q(-1.1 * h_f + (1.1 * h_f + h_a) * share(random), reach * (2 * share(random) - 1),
                     reach * (2 * share(random) - 1));
        const Vec3 p =
            bevel_gear::blank_from_cutter<double>(q.x(), q.y(), q.z(), c.R_c, c.e, g.sin_delta(), g.cos_delta());
        if (bevel_gear::cone_point(p, g.sin_delta(), g.cos_delta()).height > h_a) continue;
        const double lift = 3 * h_f * share(random);
        const Vec3 tip = g.tip(c.R_c, c.e, lift), axis = g.axis(c.e), rel = p - tip;
        const double along = rel.dot(axis), rho = (rel - along * axis).norm();
        const bool lifted = along > 0 && rho < mill.radius(along - h_f);
        const bool down = q.x() > -h_f && std::hypot(q.y(), q.z()) < mill.radius(q.x());
        if (lifted) { EXPECT_TRUE(down) << test.name; }
        inside += lifted;
      }
  }
  EXPECT_GT(inside, 100);
}

/// Planted: a mill that leans inwards below C (phi < 0) falls in radius towards the shank, so the same test would find
/// it.
TEST(BevelBruteForce, ALeaningMillWouldGougeOnTheWayOut) {
  const auto bent = bevel_gear::make_finger_profile<double>(radians(40), 1 / 18.0, 9.0, 2.0, 0.1, 8.0, 3.0);
  EXPECT_LT(bent.phi, 0);
  EXPECT_GT(bent.line_radius(bent.x_C - 1), bent.rho_C);
}

/// r_v is the same at every cone distance: z_v m_n / 2 with the text book's z_v = z / (cos(delta) cos^3(beta)).
TEST(BevelBruteForce, EqualBaseCircle) {
  for (const auto& test : cases()) {
    const bevel_gear::BevelGear g = made(test.p, test.c);
    for (int k = 0; k <= 10; ++k) {
      const double R = g.R_i() + (g.R_e() - g.R_i()) * k / 10, cb = std::sqrt(R / g.R_0());
      const double m_t = 2 * R * g.sin_delta() / g.parameters().teeth,
                   z_v = g.parameters().teeth / (g.cos_delta() * cb * cb * cb);
      EXPECT_NEAR(m_t * cb, g.normal_module(R), 1e-12 * m_t);
      EXPECT_NEAR(0.5 * z_v * m_t * cb * g.kappa_v(), 1, 1e-12);
    }
  }
}

/// Index: the finished gear turned by one pitch is itself.
TEST(BevelBruteForce, OnePitchOnIsTheSameGear) {
  const bevel_gear::BevelGear g = made(w3(), pinion_mill());
  const bevel_gear::BevelPart part(g);
  const auto mesh = mesh::mesh_gear(drawn_solid(part), 0.2);
  ASSERT_TRUE(mesh);
  const auto key = [](const Vec3& p) {
    return std::array<long, 3>{std::lround(p.x() * 1e6), std::lround(p.y() * 1e6), std::lround(p.z() * 1e6)};
  };
  std::map<std::array<long, 3>, int> there;
  for (const auto& v : mesh->vertices)
    for (long a = -1; a <= 1; ++a)
      for (long b = -1; b <= 1; ++b) {
        auto k = key(v);
        k[0] += a, k[1] += b;
        ++there[k];
      }
  const double c = std::cos(g.pitch()), s = std::sin(g.pitch());
  for (const auto& v : mesh->vertices)
    EXPECT_TRUE(there.count(key({c * v.x() - s * v.y(), s * v.x() + c * v.y(), v.z()})));
}

/// Walls, fillets and root of the mesh lie where the solid mill along its paths leaves them, at the facets' middles
/// too.
TEST(BevelBruteForce, FacetsOfTheMeshLieOnTheTeeth) {
  for (const auto& test : cases()) {
    const bevel_gear::BevelGear g = made(test.p, test.c);
    const toothpath::test::BruteForceBevelGear brute(
        test.p, {test.c.module_mm, test.c.tip_radius_mm, test.c.rack_depth_mm, test.c.profile_height_mm});
    const bevel_gear::BevelPart part(g);
    const auto pitch = mesh::mesh_tooth_space(drawn_solid(part), 0.005);
    ASSERT_TRUE(pitch) << pitch.error().message;
    const mesh::TriangleMesh* const mesh = &pitch->mesh;
    double most = 0;
    Vec3 at = Vec3::Zero();
    int facets = 0;
    for (std::size_t n = 0; n < mesh->triangles.size(); ++n) {
      const auto& t = mesh->triangles[n];
      if (pitch->tags[n].patch > tooth_space::Piece::flank_minus) continue;
      const Vec3 middle =
          (mesh->vertices[std::size_t(t[0])] + mesh->vertices[std::size_t(t[1])] + mesh->vertices[std::size_t(t[2])]) /
          3;
      if (brute.in_groove(brute.ell_of(middle), 1e-6)) continue;
      ++facets;
      const double off = std::abs(brute.clearance(middle));
      if (off > most) most = off, at = middle;
    }
    EXPECT_GT(facets, 500);
    EXPECT_LT(most, 0.005) << at.transpose() << " ell " << brute.ell_of(at) << " height " << brute.height_of(at);
  }
}

/// Extreme sizes keep their digits.
TEST(BevelBruteForce, SmallAndLargeModules) {
  for (const double m : {0.1, 60.0}) {
    const auto d = design(18, 37, m, 30, 36 / 123.438243669), unit = design(18, 37, 6, 30, 36 / 123.438243669);
    const bevel_gear::BevelGear g = gear_of(d), u = gear_of(unit);
    for (int k = 0; k < 2; ++k)
      for (const double share : {0.1, 0.5, 0.9}) {
        const auto& w = g.halves()[0].walls[k];
        const double ell = g.R_i() + share * (g.R_e() - g.R_i());
        const auto a = bevel_gear::bevel_inverse(w, ell, 0.3 * m),
                   b = bevel_gear::bevel_inverse(u.halves()[0].walls[k], ell * 6 / m, 0.3 * 6);
        ASSERT_TRUE(a && b);
        EXPECT_LT((w.point(a->beta, a->p).p / m - u.halves()[0].walls[k].point(b->beta, b->p).p / 6).norm(), 1e-9);
      }
  }
}

/// The steep gear and the almost straight one stay regular where the page says so.
TEST(BevelBruteForce, RegularityOfTheExtremeCases) {
  EXPECT_GT(gear_of(design(12, 60, 3, 45, 0.25)).limits().least_regularity, 0.9);
  EXPECT_GT(gear_of(design(25, 25, 5, 0, 20 / 88.388)).limits().least_regularity, 0.1);
  const bevel_gear::BevelGear few = gear_of(design(7, 40, 4, 30, 0.2));
  EXPECT_GE(degrees(few.limits().line_angle_rad), 0);
  EXPECT_LT(degrees(few.limits().line_angle_rad), 8);
}

}  // namespace
}  // namespace toothpath
