// The page around the 3D view: controls, legend, markers, the listing.
'use strict';

const kRed = [[0, [128, 12, 38]], [0.2, [196, 62, 60]], [0.36, [236, 150, 116]], [0.5, [243, 240, 232]]];
const kBlue = [[0.64, [142, 186, 217]], [0.8, [62, 124, 182]], [1, [14, 52, 106]]];
const kDiverging = kRed.concat(kBlue);
const kLeftOnly = [[0, [243, 240, 232]], [0.28, [142, 186, 217]], [0.6, [62, 124, 182]], [1, [14, 52, 106]]];
const kDeepOnly = [[0, [128, 12, 38]], [0.4, [196, 62, 60]], [0.72, [236, 150, 116]], [1, [243, 240, 232]]];

const byId = (id) => document.getElementById(id);
const minus = (text) => text.replace('-', '\u2212');
const number = (v, digits = 3) => minus(String(Number(v.toPrecision(digits))));
const fixed = (v, decimals) => minus(v.toFixed(decimals));

function colourAt(stops, t) {
  let k = 1;
  while (k < stops.length - 1 && t > stops[k][0]) k++;
  const [t0, a] = stops[k - 1], [t1, b] = stops[k], s = Math.max(0, Math.min(1, (t - t0) / (t1 - t0)));
  return a.map((v, i) => Math.round(v + s * (b[i] - v)));
}

/** The next 1, 2 or 5 times a power of ten. */
function niceUp(v) {
  const decade = 10 ** Math.floor(Math.log10(v));
  return [1, 1.5, 2, 3, 4, 5, 6, 8, 10].find((d) => d * decade >= v * (1 - 1e-9)) * decade;
}

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

class Page {
  constructor(data, surface, paths, view) {
    Object.assign(this, {data, surface, paths, view, dirty: true, playing: false});
    const [centre, size] = this.extent();
    const down = this.cutsFromBelow();
    if (this.hidesWork(size)) byId('tool-mode').value = 'cutting';
    const across = Math.hypot(centre[0], centre[1]) > 1e-6;
    this.camera = new Camera(centre, size, across ? Math.atan2(down ? -centre[1] : centre[1], centre[0]) : 0, down);
    if (this.leansFar()) {  // from behind such a tool its end would cover the space
      Object.assign(this.camera.home, {azimuth: this.camera.facing + 1.25, elevation: 0.9});
      this.camera.reset();
    }
    this.state = {field: data.fields.length - 1, operation: Math.max(0, paths.length - 1), pass: -1, record: 0};
    this.fillControls();
    this.connectPointer();
    this.connectControls();
    this.makeMarkers();
    if (surface) this.showField();
    if (paths.length) this.showOperation(this.state.operation, true);
    const redraw = () => { this.dirty = true; };
    new ResizeObserver(redraw).observe(view.canvas);
    window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
    window.addEventListener('beforeprint', () => this.draw());
    const frame = (time) => {
      if (this.playing) this.advance(time);
      if (this.dirty) this.draw();
      requestAnimationFrame(frame);
    };
    this.draw();
    requestAnimationFrame(frame);
  }

  /** Whether the tool comes from below the gear frame: the view then stands on its head, so that the tool is above the work. */
  cutsFromBelow() {
    const path = this.paths[this.paths.length - 1];
    return path !== undefined && path.n > 0 && path.toolAxis(Math.floor(path.n / 2))[2] < -0.1;
  }

  /** Whether the tool lies flatter than 45 degrees. */
  leansFar() {
    const path = this.paths[this.paths.length - 1];
    return path !== undefined && path.n > 0 && Math.abs(path.toolAxis(Math.floor(path.n / 2))[2]) < 0.7;
  }

  /** Whether shank or holder of the tool are so thick near the tip that the whole assembly would cover the tooth space. */
  hidesWork(size) {
    const path = this.paths[this.paths.length - 1], tool = path && this.data.tools[path.tool];
    return Boolean(tool) && tool.bodies.some((b) => !b.cutting && b.profile.some(([r, height]) => r > 0.4 * size && height < 4 * size));
  }

  /** Middle and half size of the tooth space (of the cutting moves where there is no surface). */
  extent() {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const add = (p) => p.forEach((v, c) => { low[c] = Math.min(low[c], v); high[c] = Math.max(high[c], v); });
    if (this.surface) for (let i = 0; i < this.surface.count; i++) add([...this.surface.points.subarray(i * 3, i * 3 + 3)]);
    else for (const p of this.paths) for (let i = 0; i < p.n; i++) if (p.kind(i) === 2 || p.n < 3) add(p.tip(i));
    if (!(low[0] <= high[0])) return [[0, 0, 0], 10];
    const centre = low.map((v, c) => (v + high[c]) / 2);
    const size = Math.max(0.5, Math.hypot(...low.map((v, c) => high[c] - v)) / 2);
    return [centre, size];
  }

  fillControls() {
    const option = (select, value, text) => select.add(new Option(text, value));
    this.data.fields.forEach((name, k) => option(byId('field'), k, name));
    option(byId('field'), -1, 'plain surface');
    byId('field').value = this.state.field;
    this.paths.forEach((p, k) => option(byId('operation'), k, p.name));
    option(byId('operation'), -1, 'no path');
    byId('surface-controls').hidden = !this.surface;
    byId('path-controls').hidden = !this.paths.length;
    document.querySelector('[data-view=tool]').hidden = !this.paths.length;
  }

  connectControls() {
    const on = (id, event, act) => byId(id).addEventListener(event, () => { act(); this.dirty = true; });
    on('field', 'change', () => { this.state.field = Number(byId('field').value); this.showField(); });
    on('range-mode', 'change', () => this.showField());
    on('range-limit', 'input', () => this.showField());
    on('operation', 'change', () => this.showOperation(Number(byId('operation').value), true));
    on('pass', 'change', () => this.showPass(Number(byId('pass').value)));
    on('pass-back', 'click', () => this.showPass(Math.max(-1, this.state.pass - 1)));
    on('pass-on', 'click', () => this.showPass(Math.min(this.path().passes.length - 1, this.state.pass + 1)));
    on('rapids', 'change', () => {});
    on('tool-mode', 'change', () => {});
    on('record', 'input', () => { this.stop(); this.showRecord(Number(byId('record').value)); });
    on('play', 'click', () => (this.playing ? this.stop() : this.start()));
    byId('views').addEventListener('click', (event) => {
      const name = event.target.dataset.view;
      if (name) this.look(name);
    });
    for (const link of document.querySelectorAll('[data-gouge]'))
      link.addEventListener('click', (event) => { event.preventDefault(); this.showGouge(Number(link.dataset.gouge), true); });
    for (const link of document.querySelectorAll('[data-line]'))
      link.addEventListener('click', (event) => { event.preventDefault(); this.showLine(Number(link.dataset.line)); });
  }

  look(name) {
    const c = this.camera, half = Math.PI / 2;
    if (name === 'reset') c.reset();
    if (name === 'top') c.look(c.facing, half);
    if (name === 'outside') c.look(c.facing, 0.25);
    if (name === 'inside') c.look(c.facing + Math.PI, 0.25);
    if (name === 'side') c.look(c.facing + half, 0.12);
    if (name === 'tool' && this.path()) {
      const a = c.turned(this.path().toolAxis(this.state.record));
      c.look(Math.hypot(a[0], a[1]) > 1e-6 ? Math.atan2(a[1], a[0]) : c.facing, Math.asin(Math.max(-1, Math.min(1, a[2]))));
    }
    this.dirty = true;
  }

  // ---- surface -------------------------------------------------------------------------------------------------

  showField() {
    const {surface, state} = this, field = surface.fields[state.field];
    byId('legend').hidden = !field;
    byId('range-row').hidden = byId('range-mode').value !== 'fixed';
    byId('range-mode').disabled = !field;
    const values = new Float32Array(surface.count * 2).fill(2);
    if (!field) {
      this.view.setValues(values);
      byId('field-note').textContent = '';
      this.dirty = true;
      return;
    }
    let low = Infinity, high = -Infinity, squares = 0, n = 0, unreached = 0;
    const sizes = [];
    for (let i = 0; i < surface.count; i++) {
      const v = field[i], shown = Number.isFinite(v);
      values[2 * i] = shown ? v : 0;
      values[2 * i + 1] = !shown ? 2 : surface.reachable[i] ? 0 : 1;
      if (!surface.reachable[i]) unreached++;
      if (!shown || !surface.reachable[i]) continue;
      low = Math.min(low, v); high = Math.max(high, v); squares += v * v; n++;
      sizes.push(Math.abs(v));
    }
    this.view.setValues(values);
    if (!n) low = high = 0;
    sizes.sort((a, b) => a - b);
    const mode = byId('range-mode').value;
    let range, stops = kDiverging;
    if (mode === 'extremes' && high > low) {
      range = low < 0 && high > 0 ? [low, 0, high] : [low, (low + high) / 2, high];
      if (low >= 0) stops = kLeftOnly;
      if (high <= 0) stops = kDeepOnly;
    } else {
      const wish = Number(byId('range-limit').value);
      const limit = mode === 'fixed' && wish > 0 ? wish : niceUp(Math.max(0.01, sizes[Math.floor(0.99 * (sizes.length - 1))] || 0));
      range = [-limit, 0, limit];
    }
    Object.assign(state, {range, stops, shown: [low, high]});
    const rgba = new Uint8Array(1024);
    for (let k = 0; k < 256; k++) rgba.set([...colourAt(stops, k / 255), 255], 4 * k);
    this.view.setColours(rgba);
    byId('field-note').textContent = n
      ? `least ${number(low)}, greatest ${number(high)}, rms ${number(Math.sqrt(squares / n))} \u00b5m on ${n} points` +
        (unreached ? `; ${(100 * unreached / surface.count).toFixed(1)} % out of the ball\u2019s reach (hatched)` : '')
      : 'no values';
    this.showLegend();
    this.dirty = true;
  }

  showLegend() {
    const {range: [low, middle, high], stops, shown} = this.state;
    byId('legend-title').textContent = 'Deviation [\u00b5m]';
    byId('legend-bar').style.background =
      `linear-gradient(to top, ${stops.map(([t, c]) => `rgb(${c}) ${100 * t}%`).join(', ')})`;
    const ticks = byId('legend-ticks');
    ticks.textContent = '';
    const digits = Math.max(Math.abs(low), Math.abs(high)) >= 100 ? 0 : Math.max(Math.abs(low), Math.abs(high)) >= 10 ? 1 : 2;
    for (const share of [0, 0.25, 0.5, 0.75, 1]) {
      const value = share < 0.5 ? low + (middle - low) * share * 2 : middle + (high - middle) * (share - 0.5) * 2;
      const tick = document.createElement('span');
      tick.style.bottom = `${100 * share}%`;
      const sign = value > 0 ? '+' : '';
      tick.textContent = sign + fixed(value, digits).replace(/^\u2212(0(\.0+)?)$/, '$1');
      ticks.append(tick);
    }
    const beyond = shown[0] < low - 1e-9 || shown[1] > high + 1e-9;
    byId('legend-note').textContent = '+ left, \u2212 cut too deep' + (beyond ? '; ends hold values beyond' : '');
  }

  // ---- path and tool -------------------------------------------------------------------------------------------

  path() { return this.paths[this.state.operation]; }

  showOperation(index, choosePass) {
    this.stop();
    this.state.operation = index;
    byId('operation').value = index;
    const path = this.path(), select = byId('pass');
    select.textContent = '';
    for (const id of ['pass', 'pass-back', 'pass-on', 'play', 'record', 'tool-mode', 'rapids']) byId(id).disabled = !path;
    this.dirty = true;
    if (!path) {
      byId('record-note').textContent = '';
      return;
    }
    select.add(new Option(`all ${path.passes.length}`, -1));
    const zones = path.passes.some((p) => p.zone !== path.passes[0].zone);
    path.passes.forEach((p, k) => select.add(new Option(zones ? `zone ${p.zone}: ${p.pass}` : `${p.pass}`, k)));
    if (!choosePass) return;
    // Something to look at: the middle of a pass in the middle that cuts.
    const cutting = path.passes.map((p, k) => k).filter((k) => path.passes[k].last - path.passes[k].first > 3);
    this.showPass(cutting.length ? cutting[Math.floor(cutting.length * 0.3)] : -1);
  }

  showPass(k) {
    const path = this.path();
    if (!path) return;
    this.stop();
    this.state.pass = k;
    byId('pass').value = k;
    const [first, last] = this.span();
    Object.assign(byId('record'), {min: first, max: last});
    let at = Math.round(first + (last - first) * 0.5);
    for (let i = at; i <= last; i++) if (path.kind(i) === 2) { at = i; break; }
    this.showRecord(at);
  }

  span() {
    const path = this.path(), pass = path.passes[this.state.pass];
    return pass ? [pass.first, pass.last] : [0, path.n - 1];
  }

  showRecord(i) {
    const path = this.path();
    if (!path) return;
    this.state.record = i;
    byId('record').value = i;
    const [x, y, z] = path.tip(i), axis = path.toolAxis(i), line = path.line(i), p = path.passes[path.passOf(i)];
    const kind = ['rapid', 'engage', 'feed', 'retract'][path.kind(i)];
    const feed = path.kind(i) === 0 ? '' : ` at ${Math.round(path.feed[i])} mm/min`;
    byId('record-note').textContent =
      `Record ${i + 1} of ${path.n}, zone ${p.zone}, pass ${p.pass}: ${kind}${feed}. Tip ${fixed(x, 3)}, ${fixed(y, 3)}, ${fixed(z, 3)} mm; ` +
      `axis leans ${(Math.acos(Math.max(-1, Math.min(1, axis[2]))) * 180 / Math.PI).toFixed(2)}\u00b0.` + (line ? ` NC line ${line}.` : '');
    this.markLine(line);
    this.dirty = true;
  }

  start() {
    const [first, last] = this.span();
    if (this.state.record >= last) this.showRecord(first);
    Object.assign(this, {playing: true, clock: 0, ahead: 0});
    byId('play').textContent = 'Stop';
  }

  stop() {
    this.playing = false;
    byId('play').textContent = 'Play';
  }

  /** A pass takes some five seconds, a whole operation thirty. */
  advance(time) {
    const [first, last] = this.span();
    const seconds = this.clock ? Math.min(0.2, (time - this.clock) / 1000) : 0;
    this.clock = time;
    this.ahead += seconds * (last - first) / (this.state.pass < 0 ? 30 : 5);
    const whole = Math.floor(this.ahead);
    if (!whole) return;
    this.ahead -= whole;
    this.showRecord(Math.min(last, this.state.record + whole));
    if (this.state.record >= last) this.stop();
  }

  // ---- markers and listing -------------------------------------------------------------------------------------

  makeMarkers() {
    this.markers = this.data.gouges.map((g, k) => {
      const button = document.createElement('button');
      Object.assign(button, {type: 'button', className: 'marker', textContent: k + 1, title: g.text});
      button.addEventListener('click', () => this.showGouge(k, false));
      g.normal = this.normalNear(g.point);
      byId('markers').append(button);
      return button;
    });
  }

  /** Normal of the surface at the grid point nearest to a place; null without a surface. */
  normalNear(point) {
    let best = null, least = Infinity;
    for (let i = 0; this.surface && i < this.surface.count; i++) {
      const p = this.surface.points, away = Math.hypot(p[3 * i] - point[0], p[3 * i + 1] - point[1], p[3 * i + 2] - point[2]);
      if (away < least) { least = away; best = i; }
    }
    return best === null ? null : [...this.surface.normals.subarray(3 * best, 3 * best + 3)];
  }

  placeMarkers() {
    const eye = this.camera.eye();
    const {clientWidth: width, clientHeight: height} = this.view.canvas;
    this.data.gouges.forEach((g, k) => {
      const at = this.view.project(g.point);
      const inside = at && at.x > 0 && at.y > 0 && at.x < width && at.y < height;
      this.markers[k].hidden = !inside;
      this.markers[k].classList.toggle('behind', g.normal !== null && Vec.dot(g.normal, Vec.sub(eye, g.point)) < 0);
      if (inside) this.markers[k].style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px)`;
    });
  }

  /** Tool at the record nearest to the place on that NC line, the row and the line marked. */
  showGouge(k, scrollToView) {
    const g = this.data.gouges[k];
    for (const row of document.querySelectorAll('tr[data-row]')) row.classList.toggle('current', Number(row.dataset.row) === k);
    this.markers.forEach((m, i) => m.classList.toggle('current', i === k));
    const index = this.paths.findIndex((p) => p.index === g.operation);
    if (index >= 0) {
      const path = this.paths[index];
      let best = -1, least = Infinity;
      const on_line = g.line > 0 && path.lines;
      for (let i = 0; i < path.n; i++) {
        const away = Math.hypot(...Vec.sub(path.tip(i), g.point)) + (on_line ? 1e3 * Math.min(1e3, Math.abs(path.line(i) - g.line)) : 0);
        if (away < least) { least = away; best = i; }
      }
      if (best >= 0) this.goTo(index, best);
    }
    this.markLine(g.line);
    const line = byId(`L${g.line}`);
    if (line) line.scrollIntoView({block: 'nearest'});
    if (scrollToView) byId('space').scrollIntoView({behavior: 'smooth', block: 'start'});
    else if (line) line.closest('section').scrollIntoView({behavior: 'smooth', block: 'nearest'});
    this.dirty = true;
  }

  showLine(line) {
    for (let k = 0; k < this.paths.length; k++) {
      if (!this.paths[k].lines) continue;
      for (let i = 0; i < this.paths[k].n; i++)
        if (this.paths[k].line(i) === line) {
          this.goTo(k, i);
          byId('space').scrollIntoView({behavior: 'smooth', block: 'start'});
          return;
        }
    }
    this.markLine(line);
  }

  goTo(operation, record) {
    if (operation !== this.state.operation) this.showOperation(operation, false);
    this.showPass(this.path().passOf(record));
    this.showRecord(record);
  }

  markLine(line) {
    const old = document.querySelector('.listing .current');
    if (old) old.classList.remove('current');
    const now = line ? byId(`L${line}`) : null;
    if (now) {
      now.classList.add('current');
      const box = now.closest('.listing');
      if (now.offsetTop < box.scrollTop || now.offsetTop > box.scrollTop + box.clientHeight - 24) box.scrollTop = now.offsetTop - box.clientHeight / 2;
    }
  }

  // ---- pointer -------------------------------------------------------------------------------------------------

  connectPointer() {
    const canvas = this.view.canvas, touches = new Map();
    const spread = () => {
      const [a, b] = [...touches.values()];
      return {x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, gap: Math.hypot(a.x - b.x, a.y - b.y)};
    };
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      touches.set(event.pointerId, {x: event.clientX, y: event.clientY});
      byId('probe').hidden = true;
    });
    canvas.addEventListener('pointermove', (event) => {
      const before = touches.get(event.pointerId);
      if (!before) { this.probe(event); return; }
      const dx = event.clientX - before.x, dy = event.clientY - before.y;
      const old = touches.size === 2 ? spread() : null;
      touches.set(event.pointerId, {x: event.clientX, y: event.clientY});
      if (old) {
        const now = spread();
        if (now.gap > 0 && old.gap > 0) this.camera.zoom(old.gap / now.gap);
        this.camera.pan(now.x - old.x, now.y - old.y, canvas.clientHeight);
      } else if (event.shiftKey || event.buttons & 6) this.camera.pan(dx, dy, canvas.clientHeight);
      else this.camera.orbit(dx * 0.008, dy * 0.008);
      this.dirty = true;
    });
    for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, (event) => touches.delete(event.pointerId));
    canvas.addEventListener('pointerleave', () => { byId('probe').hidden = true; });
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('dblclick', () => this.look('reset'));
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.camera.zoom(Math.exp(event.deltaY * (event.deltaMode ? 0.04 : 0.0014)));
      this.dirty = true;
    }, {passive: false});
    canvas.addEventListener('keydown', (event) => {
      const keys = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1]};
      if (keys[event.key]) this.camera.orbit(-keys[event.key][0], -keys[event.key][1]);
      else if (event.key === '+' || event.key === '=') this.camera.zoom(0.85);
      else if (event.key === '-') this.camera.zoom(1 / 0.85);
      else if (event.key === 'Home') this.camera.reset();
      else return;
      event.preventDefault();
      this.dirty = true;
    });
  }

  /** Deviation at the grid point under the pointer. */
  probe(event) {
    const box = byId('probe'), {surface, view} = this;
    box.hidden = true;
    if (!surface || !view.matrix || event.pointerType === 'touch') return;
    const frame = view.canvas.getBoundingClientRect();
    const x = event.clientX - frame.left, y = event.clientY - frame.top;
    let best = -1, cost = Infinity;
    for (let i = 0; i < surface.count; i++) {
      const at = view.project([surface.points[3 * i], surface.points[3 * i + 1], surface.points[3 * i + 2]]);
      if (!at || Math.abs(at.x - x) > 9 || Math.abs(at.y - y) > 9) continue;
      const away = Math.hypot(at.x - x, at.y - y) / 9 + 60 * at.depth / this.camera.distance;
      if (away < cost) { cost = away; best = i; }
    }
    if (best < 0) return;
    const grid = surface.grids.findLast((g) => g.base <= best);
    const p = [...surface.points.subarray(3 * best, 3 * best + 3)];
    const value = this.state.field >= 0 ? surface.fields[this.state.field][best] : NaN;
    box.textContent = `${grid.patch}, zone ${grid.zone}: r ${Math.hypot(p[0], p[1]).toFixed(2)}, z ${fixed(p[2], 2)} mm` +
      (surface.reachable[best] ? '' : ' (out of reach)') + (Number.isFinite(value) ? `, ${value > 0 ? '+' : ''}${fixed(value, 2)} \u00b5m` : '');
    box.hidden = false;
  }

  // ---- drawing -------------------------------------------------------------------------------------------------

  draw() {
    this.dirty = false;
    const {state, view, camera} = this, path = this.path();
    const dark = getComputedStyle(document.documentElement).getPropertyValue('--stage').trim().split(',').map(Number);
    const [first, last] = path ? this.span() : [0, 0];
    const paths = path ? [{index: state.operation, first, last, current: state.record, links: byId('rapids').checked}] : [];
    const mode = byId('tool-mode').value;
    const tool = path && path.tool >= 0 && mode !== 'none'
      ? {index: path.tool, tip: path.tip(state.record), axis: path.toolAxis(state.record), cuttingOnly: mode === 'cutting'} : null;
    view.draw(camera, {background: dark.map((v) => v / 255), showSurface: true, range: state.range || [-1, 0, 1],
                       coloured: state.field >= 0, paths, tool});
    this.placeMarkers();
    this.drawTriad();
    this.drawScale();
  }

  drawTriad() {
    const c = this.camera, r = c.right(), u = c.up(), b = c.back();
    const axes = ['x', 'y', 'z'].map((name, i) => ({name, x: r[i] * 22, y: -u[i] * 22, depth: b[i]})).sort((p, q) => p.depth - q.depth);
    byId('triad').innerHTML = axes.map((a) =>
      `<line x2="${a.x.toFixed(1)}" y2="${a.y.toFixed(1)}" class="t${a.name}"/>` +
      `<text x="${(a.x * 1.32).toFixed(1)}" y="${(a.y * 1.32 + 3.5).toFixed(1)}" class="t${a.name}">${a.name}</text>`).join('');
  }

  /** A bar of a round length, true at the distance of the target. */
  drawScale() {
    const height = this.view.canvas.clientHeight, width = this.view.canvas.clientWidth;
    const per_px = 2 * this.camera.distance * Camera.tangent * Math.max(1, height / width) / height;
    const wanted = per_px * 90;
    const decade = 10 ** Math.floor(Math.log10(wanted));
    const length = [5, 2, 1].find((d) => d * decade <= wanted) * decade;
    byId('scale').firstElementChild.style.width = `${(length / per_px).toFixed(1)}px`;
    byId('scale').lastElementChild.textContent = `${number(length)} mm`;
  }
}

(async () => {
  const data = JSON.parse(byId('report-data').textContent);
  const say = (text) => {
    byId('message').textContent = text;
    byId('message').hidden = false;
    byId('controls').hidden = true;
    for (const id of ['legend', 'scale', 'triad']) byId(id).style.display = 'none';
  };
  let title = data.title;
  if (data.grids.length || data.paths.length) {
    try {
      const view = new View(byId('view'));
      const surface = data.grids.length ? await loadSurface(data) : null;
      const paths = await Promise.all(data.paths.map(loadPath));
      if (surface) view.setSurface(surface.points, surface.normals, surface.triangles);
      for (const path of paths) view.addPath(path.records);
      for (const tool of data.tools) view.addTool(tool.bodies);
      window.toothpathPage = new Page(data, surface, paths, view);
    } catch (error) {
      say(error.message === 'no WebGL2' ? 'The 3D view needs a browser with WebGL 2. Plots and tables below are complete without it.'
                                        : `The 3D view stopped: ${error.message}`);
      title += ' (no 3D view)';
      if (error.message !== 'no WebGL2') console.error(error);
    }
  }
  document.title = title;
})();
