// The view of the gear on its machine: what it shows, its controls, and the machine that runs along the program.
Object.assign(Page.prototype, {
  connectMachine(scene) {
    byId('scene-controls').hidden = byId('machine-controls').hidden = !scene;
    if (!scene) return;
    this.machine = new MachineView(this.view, scene);
    this.timelines = {first: new Timeline(scene, false), all: new Timeline(scene, true)};
    this.timeline = this.timelines.first;
    Object.assign(this, {moment: this.cuttingMoment(Math.floor(0.3 * this.timeline.length), Math.ceil(0.7 * this.timeline.length)), momentIsOurs: true, running: false, onMachine: false});
    // A place of the gear above the table, where the program is in the middle; the eye in front, as the machinist stands.
    const state = this.timeline.at(Math.floor(this.moment)) || {joints: [0, 0, 0, 0, 0]};
    const place = Rigid.join(this.machine.places(state.joints)[0], this.machine.gear);
    let reach = 1, low = Infinity, high = -Infinity;
    for (let i = 0; i < scene.pitch.length; i += 3) {
      reach = Math.max(reach, Math.hypot(scene.pitch[i], scene.pitch[i + 1]));
      low = Math.min(low, scene.pitch[i + 2]);
      high = Math.max(high, scene.pitch[i + 2]);
    }
    const target = Vec.add(Rigid.of(place, [0, 0, (low + high) / 2]), [0, 0, 0.35 * reach]);
    this.machineCamera = new Camera(target, 1.6 * reach, -Math.PI / 2);
    Object.assign(this.machineCamera.home, {azimuth: -Math.PI / 2 + 0.6, elevation: 0.36, distance: Math.max(9.6 * reach, Math.min(16 * reach, this.tableSize(scene)))});
    this.machineCamera.reset();
    this.flankCamera = this.camera;
    byId('moment').max = Math.max(0, this.timeline.length - 1);
    this.fillTeeth();
    const on = (id, event, act) => byId(id).addEventListener(event, () => { act(); this.dirty = true; });
    on('scene-machine', 'click', () => this.showScene(true));
    on('scene-flank', 'click', () => this.showScene(false));
    on('moment', 'input', () => { this.halt(); this.chooseMoment(Number(byId('moment').value)); });
    on('run', 'click', () => (this.running ? this.halt() : this.run()));
    on('whole-machine', 'change', () => {});
    on('teeth-shown', 'change', () => this.showTeeth(byId('teeth-shown').value, this.timeline.partAt(Math.floor(this.moment))));
    for (const id of ['machine-operation', 'tooth'])
      on(id, 'change', () => this.goToTooth(Number(byId('machine-operation').value), Number(byId('tooth').value)));
    byId('machine-note').textContent = `${this.data.machine.note}; the machine moves as read back, sampled.`;
    this.showMoment();
    this.showScene(true);
  },

  /** Diagonal of the largest body that carries the work: how far away it takes to see what machine it is. */
  tableSize(scene) {
    const sizes = scene.bodies.filter((b) => b.link === 0 && !b.work && !b.standIn).map((b) => {
      const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
      for (let i = 0; i < b.facets.length; i += 3)
        for (const c of [0, 1]) { low[c] = Math.min(low[c], b.facets[i + c]); high[c] = Math.max(high[c], b.facets[i + c]); }
      return Math.hypot(high[0] - low[0], high[1] - low[1]);
    });
    return Math.max(0, ...sizes);
  },

  /** The state from `from` to `to` whose tool is nearest to the teeth. */
  cuttingMoment(from, to = this.timeline.length) {
    const {scene} = this.machine, teeth = [], step = 3 * Math.max(1, Math.floor(scene.pitch.length / 900));
    for (let i = 0; i < scene.pitch.length; i += step) teeth.push([Math.hypot(scene.pitch[i], scene.pitch[i + 1]), scene.pitch[i + 2]]);
    let best = from, least = Infinity;
    for (let k = from; k < to; k++) {
      const s = this.timeline.at(k);
      if (s.tool < 0) continue;
      const places = this.machine.places(s.joints), gear = Rigid.join(places[0], this.machine.gear);
      const off = Vec.sub(Rigid.of(places.at(-1), [0, 0, -scene.toolLengths[s.tool]]), gear.shift);
      const p = [0, 1, 2].map((c) => Vec.dot(gear.turn.map((row) => row[c]), off));
      const r = Math.hypot(p[0], p[1]), away = Math.min(...teeth.map(([radius, z]) => Math.hypot(r - radius, p[2] - z)));
      if (away < least) { least = away; best = k; }
    }
    return best;
  },

  /** Operations that have teeth, and how many teeth there are to choose from. */
  fillTeeth() {
    const cut = this.timelines.all.parts.filter((s) => s.tooth >= 0);
    for (const id of ['teeth-row', 'operation-row', 'tooth-row']) byId(id).hidden = !cut.length;
    if (!cut.length) return;
    for (const k of new Set(cut.map((s) => s.operation))) {
      const path = this.paths.find((p) => p.index === k);
      byId('machine-operation').add(new Option(path ? path.name : `${k}`, k));
    }
    byId('tooth').max = Math.max(...cut.map((s) => s.tooth));
  },

  /** The first teeth or all; stays at the stretch of the program that was shown, where it is among them. */
  showTeeth(which, part) {
    const shown = this.timeline.parts[part], within = this.moment - this.timeline.starts[part];
    this.halt();
    this.timeline = this.timelines[which];
    byId('teeth-shown').value = which;
    byId('moment').max = Math.max(0, this.timeline.length - 1);
    const same = this.timeline.parts.indexOf(shown);
    if (same >= 0) this.moment = this.timeline.starts[same] + within;
    else this.moment = this.startOf((s) => s.operation === shown.operation && s.tooth >= 0);
    this.showMoment();
  },

  startOf(wanted) {
    const i = Math.max(0, this.timeline.parts.findIndex(wanted));
    return this.timeline.starts[i];
  },

  /** Turns the machine to a tooth, with the tool in it. */
  goToTooth(operation, tooth) {
    const is = (s) => s.operation === operation && s.tooth === tooth;
    if (!this.timeline.parts.some(is)) this.showTeeth('all', this.timeline.partAt(Math.floor(this.moment)));
    const i = this.timeline.parts.findIndex(is);
    this.halt();
    if (i >= 0) this.chooseMoment(this.cuttingMoment(this.timeline.starts[i], this.timeline.starts[i] + this.timeline.parts[i].count));
  },

  /** A moment that a reader asked for: from there it plays on. */
  chooseMoment(moment) {
    Object.assign(this, {moment, momentIsOurs: false});
    this.showMoment();
  },

  /** On the machine, or the tooth space with its deviation. */
  showScene(machine) {
    if (!this.machine || machine === this.onMachine) return;
    this.stop();
    this.halt();
    this.onMachine = machine;
    this.camera = machine ? this.machineCamera : this.flankCamera;
    byId('scene-machine').setAttribute('aria-pressed', machine);
    byId('scene-flank').setAttribute('aria-pressed', !machine);
    byId('machine-controls').hidden = !machine;
    byId('surface-controls').hidden = machine || !this.surface;
    byId('path-controls').hidden = machine || !this.paths.length;
    document.querySelector('[data-view=tool]').hidden = machine || !this.paths.length;
    byId('legend').hidden = machine || !this.surface || this.state.field < 0;
    byId('markers').hidden = machine;
    byId('probe').hidden = true;
    this.dirty = true;
  },

  /** Joints between two of the states that were read back. */
  atMoment() {
    const k = Math.max(0, Math.min(this.timeline.length - 1, Math.floor(this.moment)));
    const a = this.timeline.at(k) || {joints: [0, 0, 0, 0, 0], tool: -1, operation: -1, tooth: -1, line: 0};
    const b = this.timeline.at(k + 1), t = this.moment - k;
    if (!b || t <= 0) return a;
    return {...b, joints: a.joints.map((v, i) => v + t * (b.joints[i] - v))};
  },

  showMoment() {
    const s = this.atMoment(), {joints} = this.machine.scene, tool = this.data.tools[s.tool];
    byId('moment').value = this.moment;
    const words = [...joints].sort((a, b) => a.state - b.state).map((j) => {
      return `${j.letter} ${j.rotary ? angle(s.joints[j.state] * 180 / Math.PI) : fixed(s.joints[j.state], 2)}`;
    });
    const operation = this.paths.find((p) => p.index === s.operation);
    if (s.tooth >= 0) {
      byId('machine-operation').value = s.operation;
      if (document.activeElement !== byId('tooth')) byId('tooth').value = s.tooth;
    }
    byId('moment-note').textContent = [operation ? `Operation ${operation.name}` : 'Between operations',
                                       ...(s.tooth >= 0 ? [`tooth ${s.tooth}`] : []), tool ? tool.name : 'no tool',
                                       `NC line ${s.line}`].join(', ') + `: ${words.join('  ')}.`;
    this.dirty = true;
  },

  /** The whole program, but from a moment that a reader chose. */
  run() {
    if (this.momentIsOurs || this.moment >= this.timeline.length - 1) this.moment = 0;
    Object.assign(this, {running: true, clock: 0, momentIsOurs: false});
    byId('run').textContent = 'Stop';
  },

  halt() {
    this.running = false;
    byId('run').textContent = 'Play';
  },

  /** The first teeth take some forty seconds; all of them go four times as fast, and take six minutes at most. */
  runOn(time) {
    const last = this.timeline.length - 1, first = Math.max(4, this.timelines.first.length / 40);
    const speed = this.timeline === this.timelines.all ? Math.max(4 * first, last / 360) : first;
    const seconds = this.clock ? Math.min(0.2, (time - this.clock) / 1000) : 0;
    this.clock = time;
    this.moment = Math.min(last, this.moment + seconds * speed);
    this.showMoment();
    if (this.moment >= last) this.halt();
  },

  drawMachine(background) {
    this.machine.draw(this.camera, {...this.atMoment(), machine: byId('whole-machine').checked}, background);
    this.drawTriad();
    this.drawScale();
  },
});
