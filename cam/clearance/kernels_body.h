// Source of the kernels; included by cam/clearance/kernels_plain.cpp and cam/clearance/kernels_avx2.cpp, each in a
// namespace of its own. It uses no inline function of any library: code for one processor must not be linked into the
// program of another. The bit patterns of both are the same: no fused multiply-add, no reordering.

using V = double __attribute__((vector_size(32)));     // four lanes
using M = long long __attribute__((vector_size(32)));  // their masks
#define INLINE inline __attribute__((always_inline))

namespace {

constexpr int kStack = 512;
constexpr double kHuge = 1e300;

INLINE const V& at(const double* lanes, int half) { return reinterpret_cast<const V*>(lanes)[half]; }
INLINE V all(double x) { return V{x, x, x, x}; }
INLINE V least(V a, V b) { return a < b ? a : b; }
INLINE V most(V a, V b) { return a > b ? a : b; }
INLINE V root(V a) { return V{__builtin_sqrt(a[0]), __builtin_sqrt(a[1]), __builtin_sqrt(a[2]), __builtin_sqrt(a[3])}; }
INLINE V clamp01(V t) { return least(most(t, all(0)), all(1)); }
INLINE V size(V a) { return most(a, -a); }
INLINE double least_lane(V m) {
  const double low = m[0] < m[1] ? m[0] : m[1], high = m[2] < m[3] ? m[2] : m[3];
  return low < high ? low : high;
}
INLINE void store(double* out, int half, V v) { reinterpret_cast<V*>(out)[half] = v; }

/// Squared distances from p to four boxes.
INLINE V to_boxes(const MeshNode& node, const double* p, int half) {
  V sum = all(0);
  for (int k = 0; k < 3; ++k) {
    const V d = most(most(at(node.low[k], half) - p[k], p[k] - at(node.high[k], half)), all(0));
    sum += d * d;
  }
  return sum;
}

/// Takes no notice of where on a triangle the nearest place lies.
struct Anywhere {
  INLINE void operator()(M, V, V) const {}
};

/// Squared distances from p to four triangles: the least of the edges and, where the foot lies inside, of the plane.
/// Every candidate is the distance to a point of the triangle, so that a sliver can only come out too far, by less than
/// its width. @param foot  foot(better, v, w): where `better`, a + v ab + w ac is nearer than what was told before
template <typename Foot = Anywhere>
INLINE V to_triangles(const TriangleBlock& b, const double* p, int half, Foot&& foot = {}) {
  const V px = p[0] - at(b.a[0], half), py = p[1] - at(b.a[1], half), pz = p[2] - at(b.a[2], half);
  const V ux = at(b.ab[0], half), uy = at(b.ab[1], half), uz = at(b.ab[2], half);
  const V wx = at(b.ac[0], half), wy = at(b.ac[1], half), wz = at(b.ac[2], half);
  const V g11 = at(b.g11, half), g12 = at(b.g12, half), g22 = at(b.g22, half);
  const V pp = px * px + py * py + pz * pz;
  const V d1 = px * ux + py * uy + pz * uz, d2 = px * wx + py * wy + pz * wz;
  const V t1 = clamp01(d1 * at(b.inverse_ab, half)), t2 = clamp01(d2 * at(b.inverse_ac, half));
  V best = t1 * (t1 * g11 - 2 * d1);
  const auto take = [&](V squared, V v, V w) __attribute__((always_inline)) {
    const M better = squared < best;
    best = better ? squared : best;
    foot(better, v, w);
  };
  foot(best == best, t1, all(0));
  take(t2 * (t2 * g22 - 2 * d2), all(0), t2);
  // Edge bc: from b, so p - b = (p - a) - ab and c - b = ac - ab.
  const V d3 = d2 - d1 - g12 + g11, l3 = g11 - 2 * g12 + g22, t3 = clamp01(d3 * at(b.inverse_bc, half));
  take(g11 - 2 * d1 + t3 * (t3 * l3 - 2 * d3), 1 - t3, t3);
  const V det = at(b.inverse_det, half);
  const V v = (g22 * d1 - g12 * d2) * det, w = (g11 * d2 - g12 * d1) * det;
  const V plane = v * (v * g11 - 2 * d1) + w * (w * g22 - 2 * d2) + 2 * v * w * g12;
  const M inside = (v >= 0) & (w >= 0) & (v + w <= 1);
  take(inside ? plane : all(kHuge), v, w);
  return most(pp + best, all(0));
}

/// A node or block (~block) that is still to be looked at, and how near its box is (squared).
struct Open {
  double d;
  int node;
};

/// The children of a node that lie below a limit (squared) go on the stack, the nearest on top. Returns its new height.
INLINE int open_children(const MeshNode& node, V d0, V d1, double limit2, Open* stack, int open) {
  alignas(32) double d[kLanes];
  store(d, 0, d0);
  store(d, 1, d1);
  const int first = open;
  for (int i = 0; i < kLanes; ++i) {
    if (!(d[i] < limit2)) continue;
    int k = open++;
    while (k > first && stack[k - 1].d < d[i]) {
      stack[k] = stack[k - 1];
      --k;
    }
    stack[k] = {d[i], node.child[i]};
  }
  return open;
}

/// Nearest lane of a block into `hit`.
INLINE void take(const TriangleBlock& b, int block, const double* p, TriangleHit& hit) {
  const V d0 = to_triangles(b, p, 0), d1 = to_triangles(b, p, 1);
  const double d = least_lane(least(d0, d1));
  if (!(d < hit.squared)) return;
  int lane = 0;
  for (int i = 3; i >= 0; --i) {
    if (d1[i] == d) lane = 4 + i;
  }
  for (int i = 3; i >= 0; --i) {
    if (d0[i] == d) lane = i;
  }
  hit = {d, block, lane};
}

INLINE void take_lane(const TriangleBlock& b, int block, int lane, const double* p, TriangleHit& hit) {
  const V d = to_triangles(b, p, lane / 4);
  if (d[lane & 3] < hit.squared) hit = {d[lane & 3], block, lane};
}

TriangleHit nearest(const TreeView& tree, const double* p, double limit2, TriangleHit start) {
  TriangleHit hit{limit2, -1, 0};
  if (start.block >= 0) take_lane(tree.blocks[start.block], start.block, start.lane, p, hit);
  Open stack[kStack];
  int open = 0;
  stack[open++] = {0, 0};
  while (open > 0) {
    const Open next = stack[--open];
    if (next.d >= hit.squared) continue;
    if (next.node < 0) {
      take(tree.blocks[~next.node], ~next.node, p, hit);
      continue;
    }
    const MeshNode& node = tree.nodes[next.node];
    open = open_children(node, to_boxes(node, p, 0), to_boxes(node, p, 1), hit.squared, stack, open);
  }
  return hit;
}

unsigned long near(const TreeView& tree, const double* p, double limit2, double slack, BlockHit* out,
                   unsigned long room) {
  double best = limit2, within = limit2;
  unsigned long count = 0;
  Open stack[kStack];
  int open = 0;
  stack[open++] = {0, 0};
  while (open > 0) {
    const Open next = stack[--open];
    if (next.d >= within) continue;
    if (next.node < 0) {
      const TriangleBlock& block = tree.blocks[~next.node];
      const V d0 = to_triangles(block, p, 0), d1 = to_triangles(block, p, 1);
      const double d = least_lane(least(d0, d1));
      if (!(d < within)) continue;
      if (count < room) {
        store(out[count].squared, 0, d0);
        store(out[count].squared, 1, d1);
        out[count].block = ~next.node;
      }
      ++count;
      if (d < best) {
        best = d;
        const double reach = __builtin_sqrt(d) + slack;
        within = reach * reach < limit2 ? reach * reach : limit2;
      }
      continue;
    }
    const MeshNode& node = tree.nodes[next.node];
    open = open_children(node, to_boxes(node, p, 0), to_boxes(node, p, 1), within, stack, open);
  }
  return count;
}

/// Lower bounds of the distance between a segment and four boxes: the sphere about each box, then the box of the
/// segment.
INLINE V segment_to_boxes(const MeshNode& node, const CapsuleView& s, int half) {
  V d2 = all(0), along = all(0), far2 = all(0), reach2 = all(0);
  V m[3];
  for (int k = 0; k < 3; ++k) {
    const V low = at(node.low[k], half), high = at(node.high[k], half);
    const double end = s.centre[k] + s.height * s.axis[k];
    const double from = s.centre[k] < end ? s.centre[k] : end, to = s.centre[k] < end ? end : s.centre[k];
    const V gap = most(most(low - to, from - high), all(0));
    d2 += gap * gap;
    m[k] = 0.5 * (low + high) - s.centre[k];
    const V h = 0.5 * (high - low);
    reach2 += h * h;
    along += m[k] * s.axis[k];
  }
  const V t = least(most(along, all(0)), all(s.height));
  for (int k = 0; k < 3; ++k) {
    const V q = m[k] - t * s.axis[k];
    far2 += q * q;
  }
  return most(root(d2), root(far2) - root(reach2));
}

unsigned long gather(const TreeView& tree, const CapsuleView& s, double reach, std::int32_t* out, unsigned long room) {
  int stack[kStack];
  int open = 0;
  unsigned long count = 0;
  stack[open++] = 0;
  while (open > 0) {
    const MeshNode& node = tree.nodes[stack[--open]];
    alignas(32) double d[kLanes];
    store(d, 0, segment_to_boxes(node, s, 0));
    store(d, 1, segment_to_boxes(node, s, 1));
    for (int i = 0; i < kLanes; ++i) {
      if (!(d[i] <= reach)) continue;
      if (node.child[i] >= 0) {
        stack[open++] = node.child[i];
      } else {
        if (count < room) out[count] = ~node.child[i];
        ++count;
      }
    }
  }
  return count;
}

/// Squared distances from p to four blocks' own boxes.
INLINE V to_own_boxes(const BoxGroup& g, const double* p, int half) {
  const V x = p[0] - at(g.centre[0], half), y = p[1] - at(g.centre[1], half), z = p[2] - at(g.centre[2], half);
  V sum = all(0);
  for (int d = 0; d < 3; ++d) {
    const V along = x * at(g.axis[d][0], half) + y * at(g.axis[d][1], half) + z * at(g.axis[d][2], half);
    const V gap = most(size(along) - at(g.half[d], half), all(0));
    sum += gap * gap;
  }
  return sum;
}

TriangleHit nearest_in(const TreeView& tree, const BoxGroup* groups, unsigned long count, const double* p,
                       double limit2, TriangleHit start) {
  TriangleHit hit{limit2, -1, 0};
  if (start.block >= 0) take(tree.blocks[start.block], start.block, p, hit);
  for (unsigned long g = 0; g < count; ++g) {
    alignas(32) double d[kLanes];
    const V d0 = to_own_boxes(groups[g], p, 0), d1 = to_own_boxes(groups[g], p, 1);
    const V m = least(d0, d1);
    const double low = m[0] < m[1] ? m[0] : m[1], high = m[2] < m[3] ? m[2] : m[3];
    if (!((low < high ? low : high) < hit.squared)) continue;
    store(d, 0, d0);
    store(d, 1, d1);
    for (int i = 0; i < kLanes; ++i) {
      const int block = groups[g].block[i];
      if (d[i] < hit.squared && block != start.block) take(tree.blocks[block], block, p, hit);
    }
  }
  return hit;
}

/// Lower bounds of the squared distances from the flute's axis to four triangles: across the axis, and from its top for
/// those that stand above it. Huge where the whole triangle lies below the ball's centre: nothing of it is nearer to
/// the flute.
INLINE V beside_axis(const TriangleBlock& b, const CapsuleView& s, const double* e, const double* f, int half) {
  const V x = at(b.a[0], half) - s.centre[0], y = at(b.a[1], half) - s.centre[1], z = at(b.a[2], half) - s.centre[2];
  const V ux = at(b.ab[0], half), uy = at(b.ab[1], half), uz = at(b.ab[2], half);
  const V wx = at(b.ac[0], half), wy = at(b.ac[1], half), wz = at(b.ac[2], half);
  const V ha = x * s.axis[0] + y * s.axis[1] + z * s.axis[2];
  const V hu = ux * s.axis[0] + uy * s.axis[1] + uz * s.axis[2], hw = wx * s.axis[0] + wy * s.axis[1] + wz * s.axis[2];
  const V top = ha + most(most(hu, hw), all(0)), bottom = ha + least(least(hu, hw), all(0));
  const V ae = x * e[0] + y * e[1] + z * e[2], af = x * f[0] + y * f[1] + z * f[2];
  const V ue = ux * e[0] + uy * e[1] + uz * e[2], uf = ux * f[0] + uy * f[1] + uz * f[2];
  const V we = wx * e[0] + wy * e[1] + wz * e[2], wf = wx * f[0] + wy * f[1] + wz * f[2];
  const auto edge = [](V pe, V pf, V de, V df) __attribute__((always_inline)) {
    const V l = de * de + df * df;
    const V t = clamp01(-(pe * de + pf * df) / most(l, all(1e-200)));
    const V qe = pe + t * de, qf = pf + t * df;
    return qe * qe + qf * qf;
  };
  V d = least(edge(ae, af, ue, uf), least(edge(ae, af, we, wf), edge(ae + ue, af + uf, we - ue, wf - uf)));
  // The axis passes through the triangle: the origin lies on one side of all three edges.
  const V s1 = ae * uf - af * ue, s2 = (ae + ue) * (wf - uf) - (af + uf) * (we - ue), s3 = af * we - ae * wf;
  const M through = ((s1 >= 0) & (s2 >= 0) & (s3 >= 0)) | ((s1 <= 0) & (s2 <= 0) & (s3 <= 0));
  d = through ? all(0) : d;
  const V up = most(bottom - s.height, all(0));  // wholly above the top
  return top > 0 ? d + up * up : all(kHuge);
}

/// Two directions across an axis.
INLINE void across(const double* axis, double* e, double* f) {
  const double ax = axis[0] < 0 ? -axis[0] : axis[0], ay = axis[1] < 0 ? -axis[1] : axis[1];
  e[0] = e[1] = e[2] = 0;
  if (ax < ay) {
    e[1] = -axis[2];
    e[2] = axis[1];
  } else {
    e[0] = axis[2];
    e[2] = -axis[0];
  }
  const double length = __builtin_sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
  for (int k = 0; k < 3; ++k) e[k] /= length;
  f[0] = axis[1] * e[2] - axis[2] * e[1];
  f[1] = axis[2] * e[0] - axis[0] * e[2];
  f[2] = axis[0] * e[1] - axis[1] * e[0];
}

unsigned long beside_flute(const TreeView& tree, const BoxGroup* groups, unsigned long count, const CapsuleView& s,
                           double limit2, std::int64_t* out, unsigned long room) {
  double e[3], f[3];
  across(s.axis, e, f);
  const double limit = __builtin_sqrt(limit2);
  unsigned long found = 0;
  for (unsigned long g = 0; g < count; ++g) {
    const BoxGroup& b = groups[g];
    alignas(32) double above[kLanes], gap[kLanes];
    for (int half = 0; half < 2; ++half) {
      const V x = at(b.centre[0], half) - s.centre[0], y = at(b.centre[1], half) - s.centre[1],
              z = at(b.centre[2], half) - s.centre[2];
      const V h = x * s.axis[0] + y * s.axis[1] + z * s.axis[2];
      V high = all(0), wide = all(0);
      for (int d = 0; d < 3; ++d) {
        const V along = at(b.axis[d][0], half) * s.axis[0] + at(b.axis[d][1], half) * s.axis[1] +
                        at(b.axis[d][2], half) * s.axis[2];
        high += size(along) * at(b.half[d], half);
        // Reach of the box towards the axis: its half widths times the share of its directions across.
        const V qe = x - h * s.axis[0], qf = y - h * s.axis[1], qg = z - h * s.axis[2];
        const V rho = root(most(qe * qe + qf * qf + qg * qg, all(1e-200)));
        const V towards =
            (at(b.axis[d][0], half) * qe + at(b.axis[d][1], half) * qf + at(b.axis[d][2], half) * qg) / rho;
        wide += size(towards) * at(b.half[d], half);
      }
      const V q2 = x * x + y * y + z * z - h * h;
      store(above, half, h + high);
      store(gap, half, root(most(q2, all(0))) - wide);
    }
    for (int i = 0; i < kLanes; ++i) {
      if (!(above[i] > 0) || !(gap[i] < limit) || b.block[i] < 0) continue;
      const TriangleBlock& block = tree.blocks[b.block[i]];
      alignas(32) double d[kLanes];
      store(d, 0, beside_axis(block, s, e, f, 0));
      store(d, 1, beside_axis(block, s, e, f, 1));
      for (int lane = 0; lane < kLanes; ++lane) {
        if (!(d[lane] < limit2)) continue;
        if (found < room) out[found] = std::int64_t(kLanes) * b.block[i] + lane;
        ++found;
      }
    }
  }
  return found;
}

/// Lower bounds of the squared distances from a segment to four triangles. The distance of a convex set is convex along
/// the segment: where the place nearest to its start lies below, nothing above the start is nearer.
INLINE V to_segment(const TriangleBlock& b, const CapsuleView& s, const double* e, const double* f, int half) {
  const double* u = s.axis;
  const V ha = (at(b.a[0], half) - s.centre[0]) * u[0] + (at(b.a[1], half) - s.centre[1]) * u[1] +
               (at(b.a[2], half) - s.centre[2]) * u[2];
  const V hu = at(b.ab[0], half) * u[0] + at(b.ab[1], half) * u[1] + at(b.ab[2], half) * u[2];
  const V hw = at(b.ac[0], half) * u[0] + at(b.ac[1], half) * u[1] + at(b.ac[2], half) * u[2];
  V height = all(0);
  const V start = to_triangles(
      b, s.centre, half, [&](M better, V v, V w) __attribute__((always_inline)) {
        height = better ? ha + v * hu + w * hw : height;
      });
  return height > 0 ? least(start, beside_axis(b, s, e, f, half)) : start;
}

double along(const TreeView& tree, const CapsuleView& s, double limit2) {
  double e[3], f[3];
  across(s.axis, e, f);
  double best = limit2;
  Open stack[kStack];
  int open = 0;
  stack[open++] = {0, 0};
  while (open > 0) {
    const Open next = stack[--open];
    if (next.d >= best) continue;
    if (next.node < 0) {
      const TriangleBlock& block = tree.blocks[~next.node];
      const double d = least_lane(least(to_segment(block, s, e, f, 0), to_segment(block, s, e, f, 1)));
      best = d < best ? d : best;
      continue;
    }
    const MeshNode& node = tree.nodes[next.node];
    const V d0 = segment_to_boxes(node, s, 0), d1 = segment_to_boxes(node, s, 1);
    open = open_children(node, d0 * d0, d1 * d1, best, stack, open);
  }
  return best;
}

/// Lower bound of the distance between a frustum and spheres whose centres stand at height h and distance rho from the
/// axis.
INLINE V to_frustum(V h, V rho, V radius, const FrustumView& f) {
  // Outside the generator's cone, and outside the cylinder that holds the frustum: both hold it.
  const V cone = (rho - f.radius_from - f.slope * (h - f.from)) * f.cosine;
  const V up = most(most(f.from - h, h - f.to), all(0)), out = most(rho - f.widest, all(0));
  return most(cone, root(up * up + out * out)) - radius;
}

void frustum_to_boxes(const MeshNode& node, const FrustumView& f, double* out) {
  for (int half = 0; half < 2; ++half) {
    V h = all(0), rho2 = all(0), reach2 = all(0), high = all(0);
    V q[3];
    for (int k = 0; k < 3; ++k) {
      const V low = at(node.low[k], half), top = at(node.high[k], half);
      q[k] = 0.5 * (low + top) - f.tip[k];
      h += q[k] * f.axis[k];
      const V e = 0.5 * (top - low);
      reach2 += e * e;
      high += e * (f.axis[k] < 0 ? -f.axis[k] : f.axis[k]);
    }
    for (int k = 0; k < 3; ++k) {
      const V across = q[k] - h * f.axis[k];
      rho2 += across * across;
    }
    const V rho = root(rho2), reach = root(reach2);
    // The box lies between two heights, and within its half diagonal of its centre.
    const V up = most(most(f.from - h - high, h - high - f.to), all(0)), aside = most(rho - reach - f.widest, all(0));
    store(out, half, most(to_frustum(h, rho, reach, f), root(up * up + aside * aside)));
  }
}

void frustum_to_triangles(const TriangleBlock& b, const FrustumView& f, double* out) {
  for (int half = 0; half < 2; ++half) {
    V h = all(0), rho2 = all(0), to_a = all(0), to_b = all(0), to_c = all(0), ha = all(0), hb = all(0), hc = all(0);
    V q[3];
    for (int k = 0; k < 3; ++k) {
      const V u = at(b.ab[k], half), w = at(b.ac[k], half), third = (u + w) * (1.0 / 3);
      const V a = at(b.a[k], half) - f.tip[k];
      q[k] = a + third;
      h += q[k] * f.axis[k];
      ha += a * f.axis[k];
      hb += u * f.axis[k];
      hc += w * f.axis[k];
      to_a += third * third;
      to_b += (u - third) * (u - third);
      to_c += (w - third) * (w - third);
    }
    for (int k = 0; k < 3; ++k) {
      const V across = q[k] - h * f.axis[k];
      rho2 += across * across;
    }
    const V rho = root(rho2), radius = root(most(to_a, most(to_b, to_c)));
    const V bottom = ha + least(least(hb, hc), all(0)), top = ha + most(most(hb, hc), all(0));
    const V up = most(most(f.from - top, bottom - f.to), all(0)), aside = most(rho - radius - f.widest, all(0));
    store(out, half, most(to_frustum(h, rho, radius, f), root(up * up + aside * aside)));
  }
}

INLINE unsigned bits(M a, M b) {
  unsigned out = 0;
  for (int k = 0; k < 4; ++k) out |= unsigned(a[k] & 1) << k | unsigned(b[k] & 1) << (k + 4);
  return out;
}

INLINE M ray_meets(const MeshNode& node, const RayView& r, int half) {
  constexpr double pad = 1e-9;  // mm: rounding
  V from = all(0), to = all(kHuge);
  for (int k = 0; k < 3; ++k) {
    const V x = (at(node.low[k], half) - pad - r.p[k]) * r.inverse[k];
    const V y = (at(node.high[k], half) + pad - r.p[k]) * r.inverse[k];
    from = most(from, least(x, y));
    to = least(to, most(x, y));
  }
  return (from <= to * (1 + 1e-12) + pad) & (at(node.low[0], half) < 1e149);
}

unsigned ray_to_boxes(const MeshNode& node, const RayView& r) {
  return bits(ray_meets(node, r, 0), ray_meets(node, r, 1));
}

RayLanes ray_to_triangles(const TriangleBlock& b, const RayView& r) {
  constexpr double edge = 1e-9;  // of the triangle
  M through[2], near_edge[2], edge_on[2];
  for (int half = 0; half < 2; ++half) {
    const V ux = at(b.ab[0], half), uy = at(b.ab[1], half), uz = at(b.ab[2], half);
    const V wx = at(b.ac[0], half), wy = at(b.ac[1], half), wz = at(b.ac[2], half);
    const V sx = r.p[0] - at(b.a[0], half), sy = r.p[1] - at(b.a[1], half), sz = r.p[2] - at(b.a[2], half);
    const V qx = r.d[1] * wz - r.d[2] * wy, qy = r.d[2] * wx - r.d[0] * wz, qz = r.d[0] * wy - r.d[1] * wx;
    const V cx = sy * uz - sz * uy, cy = sz * ux - sx * uz, cz = sx * uy - sy * ux;
    const V det = ux * qx + uy * qy + uz * qz;
    edge_on[half] = det * det <= 1e-24 * at(b.g11, half) * at(b.g22, half);
    const V v = (sx * qx + sy * qy + sz * qz) / det, z = (r.d[0] * cx + r.d[1] * cy + r.d[2] * cz) / det;
    const V far = (wx * cx + wy * cy + wz * cz) / det;
    const M met = (v >= -edge) & (z >= -edge) & (v + z <= 1 + edge) & (far >= -edge) & ~edge_on[half];
    near_edge[half] = met & ((v < edge) | (z < edge) | (v + z > 1 - edge) | (size(far) < edge));
    through[half] = met & ~near_edge[half];
  }
  return {bits(through[0], through[1]), bits(near_edge[0], near_edge[1]), bits(edge_on[0], edge_on[1])};
}

}  // namespace
#undef INLINE
