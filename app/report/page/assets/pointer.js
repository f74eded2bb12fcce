// Mouse, touch and keys on the 3D view; what stands under the pointer.
Object.assign(Page.prototype, {
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
  },

  /** Deviation at the grid point under the pointer. */
  probe(event) {
    const box = byId('probe'), {surface, view} = this;
    box.hidden = true;
    if (!surface || this.onMachine || !view.matrix || event.pointerType === 'touch') return;
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
  },
});
