// Points of a face gear flank per second: closed form, the same vectorised, and two searches that solve every point.
// Counters: points/s and the largest deviation from the closed form, mm; `wrong` counts points where the search ended
// on another root of the equation of meshing.
#include <benchmark/benchmark.h>

#include <cmath>

#include "geometry/face_gear/flank_batch.h"
#include "tests/support/face_gear_cases.h"

namespace {

using namespace toothpath;
using test::case_named;

/// The double helical sample's outer half; side -1 has no fold, so that Newton for lambda arrives everywhere.
struct Work {
  face_gear::FaceGearSurface<double> f = case_named("dhfg_normal").surface();
  int side;
  std::vector<double> theta, B, phi, r, z;
  face_gear::FlankPoints exact;

  explicit Work(int s) : side(s) {
    const auto samples = test::trimmed_flank(f, 5, 64, 64);
    for (const auto& at : samples) {
      if (at.side != side) continue;
      theta.push_back(at.theta);
      B.push_back(at.B);
      phi.push_back(f.flank_phi(side, at.theta, at.B));
      const auto q = f.flank(side, at.theta, at.B);
      r.push_back(std::hypot(q.p.x(), q.p.y()));
      z.push_back(q.p.z());
    }
    exact.resize(theta.size());
    for (std::size_t k = 0; k < theta.size(); ++k) store(exact, k, f.flank(side, theta[k], B[k]));
  }
  static void store(face_gear::FlankPoints& to, std::size_t k, const face_gear::SurfacePointT<double>& q) {
    to.x[k] = q.p[0];
    to.y[k] = q.p[1];
    to.z[k] = q.p[2];
    to.nx[k] = q.n[0];
    to.ny[k] = q.n[1];
    to.nz[k] = q.n[2];
  }
  void report(benchmark::State& state, const face_gear::FlankPoints& got) const {
    double deviation = 0;
    int wrong = 0;
    for (std::size_t k = 0; k < theta.size(); ++k) {
      const double d = std::hypot(got.x[k] - exact.x[k], got.y[k] - exact.y[k], got.z[k] - exact.z[k]);
      if (d < 1e-3) deviation = std::max(deviation, d);
      else ++wrong;
    }
    state.counters["points/s"] =
        benchmark::Counter(double(theta.size()) * double(state.iterations()), benchmark::Counter::kIsRate);
    state.counters["deviation_mm"] = deviation;
    state.counters["wrong"] = wrong;
    state.counters["points"] = double(theta.size());
  }
};

void closed_form(benchmark::State& state) {
  const Work w(int(state.range(0)));
  face_gear::FlankPoints out;
  out.resize(w.theta.size());
  for (auto _ : state) {
    for (std::size_t k = 0; k < w.theta.size(); ++k) Work::store(out, k, w.f.flank(w.side, w.theta[k], w.B[k]));
    benchmark::DoNotOptimize(out.x.data());
    benchmark::ClobberMemory();
  }
  w.report(state, out);
}
BENCHMARK(closed_form)->Arg(-1);

void closed_form_vectorised(benchmark::State& state) {
  const Work w(int(state.range(0)));
  face_gear::FlankPoints out;
  for (auto _ : state) {
    evaluate_flank(w.f, w.side, w.theta, w.B, out);
    benchmark::DoNotOptimize(out.x.data());
    benchmark::ClobberMemory();
  }
  w.report(state, out);
}
BENCHMARK(closed_form_vectorised)->Arg(-1);

/// Given (theta, phi): Newton for the section Z, started at the reference section, derivative (3.4) in closed form.
void newton_theta_phi(benchmark::State& state) {
  const Work w(int(state.range(0)));
  const auto& f = w.f;
  const double kappa = f.shaper.kappa, T = f.shaper.T, r_b = f.shaper.r_b, s = w.side;
  face_gear::FlankPoints out;
  out.resize(w.theta.size());
  for (auto _ : state) {
    for (std::size_t k = 0; k < w.theta.size(); ++k) {
      const double th = w.theta[k], start = w.phi[k] + s * (f.shaper.theta_0 + th);
      double Z = f.L0, B = start;
      for (int step = 0; step < 50; ++step) {
        const double sB = std::sin(B), cB = std::cos(B);
        const double F = r_b * (1 / f.i + f.Cg) -
                         (Z * f.Sg * cB - f.E * f.Cg * sB + f.Sg * T * (f.E + r_b * sB - s * r_b * th * cB));
        const double dB = Z * f.Sg * sB + f.E * f.Cg * cB - f.Sg * T * (r_b * cB + s * r_b * th * sB);
        const double dZ = -F / (-f.Sg * cB + kappa * dB);
        Z += dZ;
        B = start + kappa * (Z - f.L0);
        if (std::abs(dZ) < 1e-11) break;
      }
      Work::store(out, k, f.flank(w.side, th, B));
    }
    benchmark::DoNotOptimize(out.x.data());
    benchmark::ClobberMemory();
  }
  w.report(state, out);
}
BENCHMARK(newton_theta_phi)->Arg(-1)->Arg(1);

/// Given (r, z), as an inspection grid does: Newton for both parameters, from the pitch point each time.
void newton_radius_height(benchmark::State& state) {
  const Work w(int(state.range(0)));
  face_gear::FlankPoints out;
  out.resize(w.theta.size());
  for (auto _ : state) {
    for (std::size_t k = 0; k < w.theta.size(); ++k) {
      const auto at = face_gear::invert_flank(w.f, w.side, w.r[k], w.z[k]);
      if (at) Work::store(out, k, w.f.flank(w.side, at->theta, at->B));
    }
    benchmark::DoNotOptimize(out.x.data());
    benchmark::ClobberMemory();
  }
  w.report(state, out);
}
BENCHMARK(newton_radius_height)->Arg(-1);

}  // namespace

BENCHMARK_MAIN();
