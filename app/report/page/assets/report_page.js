// The page around the 3D view: what it shows, its controls, how it is drawn. What belongs to surface, path, markers and pointer joins the class
// in files of their own.
class Page {
  constructor(data, surface, paths, view, machine = null) {
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
    this.connectMachine(machine);
    const redraw = () => { this.dirty = true; };
    new ResizeObserver(redraw).observe(view.canvas);
    window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
    window.addEventListener('beforeprint', () => this.draw());
    const frame = (time) => {
      if (this.playing) this.advance(time);
      if (this.running) this.runOn(time);
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

  draw() {
    this.dirty = false;
    const {state, view, camera} = this, path = this.path();
    const dark = getComputedStyle(document.documentElement).getPropertyValue('--stage').trim().split(',').map(Number);
    if (this.onMachine) return this.drawMachine(dark.map((v) => v / 255));
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
