// Operation, pass and record that are shown; the tool that runs along them.
Object.assign(Page.prototype, {
  path() { return this.paths[this.state.operation]; },

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
  },

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
    this.recordIsOurs = true;
  },

  span() {
    const path = this.path(), pass = path.passes[this.state.pass];
    return pass ? [pass.first, pass.last] : [0, path.n - 1];
  },

  showRecord(i) {
    const path = this.path();
    if (!path) return;
    this.recordIsOurs = false;
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
  },

  start() {
    const [first, last] = this.span();
    if (this.recordIsOurs || this.state.record >= last) this.showRecord(first);
    Object.assign(this, {playing: true, clock: 0, ahead: 0});
    byId('play').textContent = 'Stop';
  },

  stop() {
    this.playing = false;
    byId('play').textContent = 'Play';
  },

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
  },
});
