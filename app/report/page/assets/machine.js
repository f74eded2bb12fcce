// The view of the gear on its machine: what it shows, its controls, and the machine that runs along the program.
Object.assign(Page.prototype, {
  connectMachine(scene) {
    byId('scene-controls').hidden = byId('machine-controls').hidden = !scene;
    if (!scene) return;
    this.machine = new MachineView(this.view, scene);
    Object.assign(this, {moment: this.cuttingMoment(scene), running: false, onMachine: false});
    // A place of the gear above the table, where the program is in the middle; the eye in front, as the machinist stands.
    const state = scene.states[Math.floor(this.moment)] || {joints: [0, 0, 0, 0, 0]};
    const place = Rigid.join(this.machine.places(state.joints)[0], this.machine.gear);
    let reach = 1, low = Infinity, high = -Infinity;
    for (let i = 0; i < scene.pitch.length; i += 3) {
      reach = Math.max(reach, Math.hypot(scene.pitch[i], scene.pitch[i + 1]));
      low = Math.min(low, scene.pitch[i + 2]);
      high = Math.max(high, scene.pitch[i + 2]);
    }
    const target = Vec.add(Rigid.of(place, [0, 0, (low + high) / 2]), [0, 0, 0.35 * reach]);
    this.machineCamera = new Camera(target, 1.6 * reach, -Math.PI / 2);
    Object.assign(this.machineCamera.home, {azimuth: -Math.PI / 2 + 0.6, elevation: 0.36, distance: 9.6 * reach});
    this.machineCamera.reset();
    this.flankCamera = this.camera;
    byId('moment').max = Math.max(0, scene.states.length - 1);
    const on = (id, event, act) => byId(id).addEventListener(event, () => { act(); this.dirty = true; });
    on('scene-machine', 'click', () => this.showScene(true));
    on('scene-flank', 'click', () => this.showScene(false));
    on('moment', 'input', () => { this.halt(); this.moment = Number(byId('moment').value); this.showMoment(); });
    on('run', 'click', () => (this.running ? this.halt() : this.run()));
    on('whole-machine', 'change', () => {});
    byId('machine-note').textContent = `${this.data.machine.note}; the machine moves as read back, sampled.`;
    this.showMoment();
    this.showScene(true);
  },

  /** The state in the second half of the program whose tool is nearest to the teeth. */
  cuttingMoment(scene) {
    let reach = 0, best = 0, least = Infinity;
    for (let i = 0; i < scene.pitch.length; i += 3) reach = Math.max(reach, Math.hypot(scene.pitch[i], scene.pitch[i + 1]));
    scene.states.forEach((s, k) => {
      if (s.tool < 0 || k < 0.5 * scene.states.length) return;
      const places = this.machine.places(s.joints), gear = Rigid.join(places[0], this.machine.gear);
      const off = Vec.sub(Rigid.of(places.at(-1), [0, 0, -scene.toolLengths[s.tool]]), gear.shift);
      const p = [0, 1, 2].map((c) => Vec.dot(gear.turn.map((row) => row[c]), off));
      const away = Math.abs(Math.hypot(p[0], p[1]) - reach) + Math.abs(p[2] - scene.pitch[2]);
      if (away < least) { least = away; best = k; }
    });
    return best;
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
    const {states} = this.machine.scene, k = Math.min(states.length - 1, Math.floor(this.moment));
    const a = states[k] || {joints: [0, 0, 0, 0, 0], tool: -1, operation: -1, line: 0}, b = states[k + 1], t = this.moment - k;
    if (!b || t <= 0) return a;
    return {...b, joints: a.joints.map((v, i) => v + t * (b.joints[i] - v))};
  },

  showMoment() {
    const s = this.atMoment(), {joints} = this.machine.scene, tool = this.data.tools[s.tool];
    byId('moment').value = this.moment;
    const words = [...joints].sort((a, b) => a.state - b.state).map((j) =>
      `${j.letter} ${j.rotary ? `${fixed(s.joints[j.state] * 180 / Math.PI, 2)}\u00b0` : fixed(s.joints[j.state], 2)}`);
    const operation = this.paths.find((p) => p.index === s.operation);
    byId('moment-note').textContent = [operation ? `Operation ${operation.name}` : 'Between operations', tool ? tool.name : 'no tool',
                                       `NC line ${s.line}`].join(', ') + `: ${words.join('  ')}.`;
    this.dirty = true;
  },

  run() {
    if (this.moment >= this.machine.scene.states.length - 1) this.moment = 0;
    Object.assign(this, {running: true, clock: 0});
    byId('run').textContent = 'Stop';
  },

  halt() {
    this.running = false;
    byId('run').textContent = 'Play';
  },

  /** The whole program takes some forty seconds. */
  runOn(time) {
    const last = this.machine.scene.states.length - 1;
    const seconds = this.clock ? Math.min(0.2, (time - this.clock) / 1000) : 0;
    this.clock = time;
    this.moment = Math.min(last, this.moment + seconds * Math.max(4, last / 40));
    this.showMoment();
    if (this.moment >= last) this.halt();
  },

  drawMachine(background) {
    this.machine.draw(this.camera, {...this.atMoment(), machine: byId('whole-machine').checked}, background);
    this.drawTriad();
    this.drawScale();
  },
});
