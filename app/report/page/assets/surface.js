// The field that is shown on the surface, its range and its legend.
Object.assign(Page.prototype, {
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
  },

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
  },
});
