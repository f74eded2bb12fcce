// Surface and paths of the page's data, decoded and joined for view and pointer.
/** All grids as one vertex list, with what the pointer may ask of a vertex. */
async function loadSurface(data) {
  const grids = await Promise.all(data.grids.map(async (g) => ({
    ...g,
    points: await unpack(g.points), normals: await unpack(g.normals),
    fields: await Promise.all(g.fields.map(async (f) => (await unpack(f))[0])),
    reachable: g.reachable ? (await unpack(g.reachable))[0] : null,
  })));
  const count = grids.reduce((n, g) => n + g.rows * g.columns, 0);
  const points = new Float32Array(count * 3), normals = new Float32Array(count * 3), triangles = [];
  const fields = data.fields.map(() => new Float32Array(count).fill(NaN));
  const reachable = new Uint8Array(count).fill(1);
  let base = 0;
  for (const g of grids) {
    g.base = base;
    const n = g.rows * g.columns;
    for (let i = 0; i < n; i++)
      for (let c = 0; c < 3; c++) {
        points[(base + i) * 3 + c] = g.points[c][i];
        normals[(base + i) * 3 + c] = g.normals[c][i];
      }
    g.fields.forEach((f, k) => fields[k].set(f, base));
    if (g.reachable) reachable.set(g.reachable.map((v) => (v > 0.5 ? 1 : 0)), base);
    for (let r = 0; r + 1 < g.rows; r++)
      for (let c = 0; c + 1 < g.columns; c++) {
        const a = base + r * g.columns + c, b = a + g.columns;
        triangles.push(a, b, a + 1, a + 1, b, b + 1);
      }
    base += n;
  }
  return {grids, points, normals, fields, reachable, count, triangles: new Uint32Array(triangles)};
}

async function loadPath(op) {
  const [x, y, z] = await unpack(op.tip);
  const axis = op.axis.length ? null : await unpack(op.axis);
  const [kind, zone, pass] = (await Promise.all(op.marks.map(unpack))).flat();
  const [feed] = await unpack(op.feed);
  const lines = op.lines ? (await Promise.all(op.lines.map(unpack))).flat() : null;
  const n = x.length, records = new Float32Array(n * 4);
  for (let i = 0; i < n; i++) records.set([x[i], y[i], z[i], Math.round(kind[i])], i * 4);
  const passes = [];
  for (let i = 0; i < n; i++) {
    const last = passes[passes.length - 1], zi = Math.round(zone[i]), pi = Math.round(pass[i]);
    if (last && last.zone === zi && last.pass === pi) last.last = i;
    else passes.push({zone: zi, pass: pi, first: i, last: i});
  }
  return {
    ...op, n, records, passes, feed,
    tip: (i) => [x[i], y[i], z[i]],
    toolAxis: (i) => Vec.unit(axis ? [axis[0][i], axis[1][i], axis[2][i]] : op.axis),
    kind: (i) => Math.round(kind[i]),
    line: (i) => (lines ? Math.round(lines[0][i]) * 32768 + Math.round(lines[1][i]) : 0),
    passOf: (i) => passes.findIndex((p) => i <= p.last),
  };
}
