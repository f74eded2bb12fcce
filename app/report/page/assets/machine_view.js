// The gear on its machine: one pitch drawn once a tooth, bodies carried by the links of the machine, the tool.
const kMachineVertex = `#version 300 es
uniform mat4 u_matrix, u_model; uniform float u_pitch;
layout(location=0) in vec3 a_point;
out vec3 v_place;
void main() {
  float t = u_pitch * float(gl_InstanceID), c = cos(t), s = sin(t);
  vec4 p = u_model * vec4(c * a_point.x - s * a_point.y, s * a_point.x + c * a_point.y, a_point.z, 1.0);
  v_place = p.xyz;
  gl_Position = u_matrix * p;
}`;
const kMachineFragment = `#version 300 es
precision highp float;
uniform vec4 u_colour; uniform vec3 u_eye;
in vec3 v_place;
out vec4 colour;
void main() {
  vec3 v = normalize(u_eye - v_place), n = normalize(cross(dFdx(v_place), dFdy(v_place)));
  if (dot(n, v) < 0.0) n = -n;
  float sky = 0.5 + 0.5 * n.z, key = max(dot(n, normalize(vec3(0.45, -0.55, 0.7))), 0.0);
  float gleam = pow(max(dot(n, normalize(v + vec3(0.45, -0.55, 0.7))), 0.0), 40.0);
  colour = vec4(u_colour.rgb * (0.42 + 0.26 * sky + 0.40 * key) + 0.10 * gleam, u_colour.a);
}`;

/** Rigid places as {turn: rows of 3, shift}. */
const Rigid = {
  identity: () => ({turn: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], shift: [0, 0, 0]}),
  rotate: (m, p) => m.map((row) => Vec.dot(row, p)),
  of: (place, p) => Vec.add(Rigid.rotate(place.turn, p), place.shift),
  /** Places b in a. */
  join(a, b) {
    const columns = [0, 1, 2].map((k) => Rigid.rotate(a.turn, b.turn.map((row) => row[k])));
    return {turn: [0, 1, 2].map((r) => columns.map((c) => c[r])), shift: Rigid.of(a, b.shift)};
  },
  matrix: ({turn, shift}) => new Float32Array([turn[0][0], turn[1][0], turn[2][0], 0, turn[0][1], turn[1][1], turn[2][1], 0,
                                               turn[0][2], turn[1][2], turn[2][2], 0, ...shift, 1]),
  about(axis, point, angle) {
    const [x, y, z] = axis, c = Math.cos(angle), s = Math.sin(angle), t = 1 - c;
    const turn = [[t * x * x + c, t * x * y - s * z, t * x * z + s * y], [t * x * y + s * z, t * y * y + c, t * y * z - s * x],
                  [t * x * z - s * y, t * y * z + s * x, t * z * z + c]];
    return {turn, shift: Vec.sub(point, Rigid.rotate(turn, point))};
  },
};

/** Corners of a box, three a facet. */
function boxFacets(low, high) {
  const at = (k) => [k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]];
  const faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
  return faces.flatMap(([a, b, c, d]) => [a, b, c, a, c, d].flatMap(at));
}

/** The same of a cone between two circles. */
function coneFacets(from, to, [first, second], segments = 72) {
  const axis = Vec.unit(Vec.sub(to, from));
  const e = Vec.unit(Vec.cross(Math.abs(axis[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0], axis)), f = Vec.cross(axis, e);
  const rim = (centre, radius, k) => {
    const t = 2 * Math.PI * k / segments;
    return Vec.add(centre, Vec.add(Vec.scale(e, radius * Math.cos(t)), Vec.scale(f, radius * Math.sin(t))));
  };
  const out = [];
  for (let k = 0; k < segments; k++) {
    const [a, b, c, d] = [rim(from, first, k), rim(from, first, k + 1), rim(to, second, k), rim(to, second, k + 1)];
    out.push(...a, ...b, ...d, ...a, ...d, ...c, ...from, ...b, ...a, ...to, ...c, ...d);
  }
  return out;
}

/** Data of the page, decoded. */
async function loadMachine(data) {
  const mesh = async (m) => {
    const [x, y, z] = await unpack(m.points);
    const corners = await Promise.all(m.triangles.map(async ([high, low]) => [(await unpack(high))[0], (await unpack(low))[0]]));
    const out = new Float32Array(corners[0][0].length * 9);
    corners.forEach(([high, low], c) => high.forEach((h, t) => {
      const i = Math.round(h) * 32768 + Math.round(low[t]);
      out.set([x[i], y[i], z[i]], 9 * t + 3 * c);
    }));
    return out;
  };
  const joints = await unpack(data.states.joints);
  const [operation, tool, high, low] = (await Promise.all(data.states.marks.map(unpack))).flat();
  const states = Array.from(operation, (_, i) => ({
    joints: joints.map((j) => j[i]), operation: Math.round(operation[i]), tool: Math.round(tool[i]),
    line: Math.round(high[i]) * 32768 + Math.round(low[i]),
  }));
  const [above, below, count, of, tooth, lineHigh, lineLow] = (await Promise.all(data.stretches.marks.map(unpack))).flat();
  const whole = (...parts) => Math.round(parts[0]) * (parts.length > 1 ? 32768 : 1) + (parts.length > 1 ? Math.round(parts[1]) : 0);
  const stretches = data.stretches.turns.map((turn, i) => ({
    turn, first: whole(above[i], below[i]), count: whole(count[i]), operation: whole(of[i]), tooth: whole(tooth[i]),
    lines: whole(lineHigh[i], lineLow[i]),
  }));
  const bodies = await Promise.all(data.bodies.map(async (b) => ({
    ...b, facets: b.low ? new Float32Array(boxFacets(b.low, b.high)) : b.from ? new Float32Array(coneFacets(b.from, b.to, b.radii)) : await mesh(b.mesh),
  })));
  return {...data, pitch: await mesh(data.pitch), bodies, states, stretches};
}

/** The moments of a program, from state to state: of all teeth, or of the first one of every operation. */
class Timeline {
  constructor(scene, all) {
    const seen = new Set();
    this.scene = scene;
    this.parts = scene.stretches.filter((s) => {
      const first = s.tooth < 0 || !seen.has(s.operation);
      if (s.tooth >= 0) seen.add(s.operation);
      return all || first;
    });
    this.starts = [];
    this.length = this.parts.reduce((n, s) => { this.starts.push(n); return n + s.count; }, 0);
  }

  /** Number of the part that holds state k. */
  partAt(k) {
    let low = 0, high = this.parts.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.starts[middle] <= k) low = middle; else high = middle - 1;
    }
    return low;
  }

  at(k) {
    const i = this.partAt(k), part = this.parts[i], state = part && this.scene.states[part.first + k - this.starts[i]];
    if (!state) return undefined;
    return {...state, tooth: part.tooth, line: state.line + part.lines, joints: state.joints.map((v, j) => (j < 3 ? v : v + part.turn[j - 3]))};
  }
}

/** Draws the machine into the canvas of a View. */
class MachineView {
  constructor(view, scene) {
    const gl = view.gl;
    Object.assign(this, {view, gl, scene});
    Object.assign(this, buildProgram(gl, kMachineVertex, kMachineFragment));
    const buffered = (facets) => {
      const vao = gl.createVertexArray();
      gl.bindVertexArray(vao);
      view.buffer(gl.ARRAY_BUFFER, facets);
      gl.enableVertexAttribArray(0);
      gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
      gl.bindVertexArray(null);
      return {vao, count: facets.length / 3};
    };
    this.pitch = buffered(scene.pitch);
    this.bodies = scene.bodies.map((b) => ({...b, ...buffered(b.facets)}));
    const [x, y, z] = scene.turn;  // columns
    this.gear = {turn: [0, 1, 2].map((r) => [x[r], y[r], z[r]]), shift: scene.origin};
  }

  /** Place of every link against the bed; joints as machines/links.cpp. */
  places(joints) {
    const {joints: chain, bed} = this.scene, all = Array.from({length: chain.length + 1}, Rigid.identity);
    const moved = (base, k, workSide) => {
      const j = chain[k], value = joints[j.state];
      if (!j.rotary) return Rigid.join(base, {...Rigid.identity(), shift: Vec.scale(j.direction, workSide ? -value : value)});
      return Rigid.join(base, Rigid.about(j.direction, j.point, (workSide ? -1 : 1) * j.sign * (value - j.zero)));
    };
    for (let k = bed - 1; k >= 0; k--) all[k] = moved(all[k + 1], k, true);
    for (let k = bed; k < chain.length; k++) all[k + 1] = moved(all[k], k, false);
    return all;
  }

  colourOf(body) {
    if (body.standIn) return [0.52, 0.55, 0.59, 1];
    const {bed, joints} = this.scene;
    if (body.work) return [0.50, 0.42, 0.34, 1];
    if (body.tool >= 0) return [0.30, 0.34, 0.40, 1];
    if (body.link === joints.length) return [0.40, 0.46, 0.54, 1];
    if (body.link === 0) return [0.46, 0.49, 0.53, 1];
    if (body.link === bed) return [0.80, 0.82, 0.84, 1];
    return body.link < bed ? [0.60, 0.65, 0.70, 1] : [0.70, 0.74, 0.79, 1];
  }

  /** state: {joints, tool, machine: whether bodies of bed, column and head are drawn} */
  draw(camera, state, background) {
    const {gl, view, at} = this;
    view.resize();
    const {width, height} = view.canvas;
    view.matrix = camera.matrix(width / height);
    gl.viewport(0, 0, width, height);
    gl.clearColor(...background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.depthMask(true);
    gl.useProgram(this.program);
    gl.uniformMatrix4fv(at.u_matrix, false, view.matrix);
    gl.uniform3fv(at.u_eye, camera.eye());
    const places = this.places(state.joints), last = places.length - 1;
    const solid = (vao, count, place, colour, instances = 1) => {
      gl.uniformMatrix4fv(at.u_model, false, Rigid.matrix(place));
      gl.uniform4fv(at.u_colour, colour);
      gl.bindVertexArray(vao);
      gl.drawArraysInstanced(gl.TRIANGLES, 0, count, instances);
    };
    gl.uniform1f(at.u_pitch, 0);
    for (const b of this.bodies) {
      if (b.tool >= 0 && b.tool !== state.tool) continue;
      if (!state.machine && b.link !== 0 && b.tool < 0 && !(b.link === last && b.standIn)) continue;
      solid(b.vao, b.count, b.work ? Rigid.join(places[0], this.gear) : places[b.link], this.colourOf(b));
    }
    if (state.tool >= 0 && view.tools[state.tool]) {
      const tip = Rigid.join(places[last], {...Rigid.identity(), shift: [0, 0, -this.scene.toolLengths[state.tool]]});
      for (const b of view.tools[state.tool])
        solid(b.vao, b.count, tip, b.cutting ? [0.93, 0.72, 0.22, 1] : b.name === 'holder' ? [0.30, 0.34, 0.40, 1] : [0.62, 0.66, 0.70, 1]);
    }
    gl.uniform1f(at.u_pitch, 2 * Math.PI / this.scene.teeth);
    solid(this.pitch.vao, this.pitch.count, Rigid.join(places[0], this.gear), [0.83, 0.66, 0.42, 1], this.scene.teeth);
    gl.bindVertexArray(null);
  }
}
