#include "geometry/face_gear/flank_batch.h"

#include <bit>
#include <cassert>
#include <cstdint>

// The same loop is compiled for several vector widths and the processor's best is taken at load time. Contraction to
// fused operations is off, so all of them give the same bits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
#define TOOTHPATH_VECTOR_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define TOOTHPATH_VECTOR_CLONES
#endif

namespace toothpath::face_gear {
namespace {

struct SineCosine {
  double s, c;
};

/// Reduces x to [-pi/4, pi/4] by a multiple of pi/2 (in three parts, the products with the first two exact) and sums
/// the Taylor series: the first terms left out are below 1e-19. Quadrants are chosen with bit masks, without branches.
[[gnu::always_inline]] inline SineCosine sine_cosine_of(double x) {
  constexpr double kMagic = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to an integer held in the low bits
  constexpr double kTwoOverPi = 0.63661977236758134308;
  constexpr double kPart1 = 0x1.921fb544p+0, kPart2 = 0x1.0b4611a6p-34, kPart3 = 0x1.3198a2e037073p-69;
  const double shifted = x * kTwoOverPi + kMagic;
  const double q = shifted - kMagic;
  const double r = ((x - q * kPart1) - q * kPart2) - q * kPart3;
  const double y = r * r;
  double ps = 1.0 / 355687428096000.0;  // 1/17!
  ps = ps * y - 1.0 / 1307674368000.0;
  ps = ps * y + 1.0 / 6227020800.0;
  ps = ps * y - 1.0 / 39916800.0;
  ps = ps * y + 1.0 / 362880.0;
  ps = ps * y - 1.0 / 5040.0;
  ps = ps * y + 1.0 / 120.0;
  ps = ps * y - 1.0 / 6.0;
  const double sine = r + r * y * ps;
  double pc = 1.0 / 20922789888000.0;  // 1/16!
  pc = pc * y - 1.0 / 87178291200.0;
  pc = pc * y + 1.0 / 479001600.0;
  pc = pc * y - 1.0 / 3628800.0;
  pc = pc * y + 1.0 / 40320.0;
  pc = pc * y - 1.0 / 720.0;
  pc = pc * y + 1.0 / 24.0;
  const double half = 0.5 * y, rest = 1.0 - half;
  const double cosine = rest + (((1.0 - rest) - half) + y * y * pc);
  const std::uint64_t quadrant = std::bit_cast<std::uint64_t>(shifted);
  const std::uint64_t swap = std::uint64_t(0) - (quadrant & 1U);
  const std::uint64_t sb = std::bit_cast<std::uint64_t>(sine), cb = std::bit_cast<std::uint64_t>(cosine);
  const std::uint64_t sign_s = (quadrant & 2U) << 62U, sign_c = ((quadrant + 1U) & 2U) << 62U;
  return {std::bit_cast<double>(((sb & ~swap) | (cb & swap)) ^ sign_s),
          std::bit_cast<double>(((cb & ~swap) | (sb & swap)) ^ sign_c)};
}

struct Constants {
  double side, r_b, Sg, Cg, E, D, T, kappa, L0, i, theta_0, cos_bb, sin_bb;
};

TOOTHPATH_VECTOR_CLONES
void evaluate(const Constants& k, std::size_t count, const double* __restrict theta, const double* __restrict B,
              double* __restrict px, double* __restrict py, double* __restrict pz, double* __restrict nx,
              double* __restrict ny, double* __restrict nz) {
  const double side = k.side, r_b = k.r_b, Sg = k.Sg, Cg = k.Cg, E = k.E, D = k.D, T = k.T, kappa = k.kappa, L0 = k.L0,
               i = k.i, theta_0 = k.theta_0, cos_bb = k.cos_bb, sin_bb = k.sin_bb;
  for (std::size_t n = 0; n < count; ++n) {
    const auto [sB, cB] = sine_cosine_of(B[n]);
    const double w = side * theta[n];
    const double Z = (D + E * Cg * sB - Sg * T * (E + r_b * sB - r_b * w * cB)) / (Sg * cB);
    const double x = r_b * (cB + w * sB), y = r_b * (sB - w * cB);
    const double phi = B[n] - side * theta_0 - w - kappa * (Z - L0);
    const auto [st, ct] = sine_cosine_of(-i * phi);
    const double hx = Z * Sg - x * Cg, hy = E + y;
    px[n] = ct * hx - st * hy;
    py[n] = st * hx + ct * hy;
    pz[n] = -Z * Cg - x * Sg;
    const double mx = side * (Cg * sB * cos_bb - Sg * sin_bb), my = side * (cB * cos_bb);
    nx[n] = ct * mx - st * my;
    ny[n] = st * mx + ct * my;
    nz[n] = side * (Sg * sB * cos_bb + Cg * sin_bb);
  }
}

TOOTHPATH_VECTOR_CLONES
void sine_cosine_loop(std::size_t count, const double* __restrict x, double* __restrict s, double* __restrict c) {
  for (std::size_t n = 0; n < count; ++n) {
    const SineCosine v = sine_cosine_of(x[n]);
    s[n] = v.s;
    c[n] = v.c;
  }
}

}  // namespace

void FlankPoints::resize(std::size_t count) {
  for (auto* values : {&x, &y, &z, &nx, &ny, &nz}) values->resize(count);
}

void evaluate_flank(const FaceGearSurface<double>& f, int side, std::span<const double> theta,
                    std::span<const double> B, FlankPoints& out) {
  assert(theta.size() == B.size());
  out.resize(theta.size());
  const auto& w = f.shaper;
  const Constants k{double(side), w.r_b, f.Sg,      f.Cg,     f.E,     w.r_b * (1 / f.i + f.Cg), w.T, w.kappa,
                    f.L0,         f.i,   w.theta_0, w.cos_bb, w.sin_bb};
  evaluate(k, theta.size(), theta.data(), B.data(), out.x.data(), out.y.data(), out.z.data(), out.nx.data(),
           out.ny.data(), out.nz.data());
}

void sine_cosine(std::span<const double> x, std::span<double> sine, std::span<double> cosine) {
  assert(x.size() == sine.size() && x.size() == cosine.size());
  sine_cosine_loop(x.size(), x.data(), sine.data(), cosine.data());
}

}  // namespace toothpath::face_gear
