// The 3D view: decoding of packed arrays, camera, shaders. Plain script, no modules: the page opens from disk.
'use strict';

/** Bytes behind base64 text of a zlib stream. */
async function inflate(text) {
  const raw = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([raw]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Components of a packed array as Float32Array; "no value" is NaN. Integers come back exact after Math.round. */
async function unpack(packed) {
  const n = packed.count;
  const bytes = await inflate(packed.data);
  return packed.low.map((low, c) => {
    const out = new Float32Array(n);
    const step = (packed.high[c] - low) / packed.steps;
    const base = c * n * 2;
    let level = 0;
    for (let i = 0; i < n; i++) {
      const code = bytes[base + i] | (bytes[base + n + i] << 8);
      level = (level + ((code >>> 1) ^ -(code & 1))) & 0xffff;
      out[i] = level === 65535 ? NaN : low + level * step;
    }
    return out;
  });
}

const Vec = {
  add: (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]],
  sub: (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]],
  scale: (a, s) => [a[0] * s, a[1] * s, a[2] * s],
  dot: (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2],
  cross: (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]],
  unit: (a) => Vec.scale(a, 1 / (Math.hypot(...a) || 1)),
};

/** Column-major 4 x 4 product a b. */
function multiply(a, b) {
  const out = new Float32Array(16);
  for (let c = 0; c < 4; c++)
    for (let r = 0; r < 4; r++)
      for (let k = 0; k < 4; k++) out[c * 4 + r] += a[k * 4 + r] * b[c * 4 + k];
  return out;
}

/** Turntable camera about the gear axis: azimuth and elevation of the eye, distance, target. A gear that is cut from below its
 *  frame (`down`) stands on its head: angles are those of the frame turned by 180 degrees about x. */
class Camera {
  constructor(target, size, azimuth, down = false) {
    this.down = down;
    this.home = {target, distance: size * 4, azimuth: azimuth + 0.35, elevation: 1.0};
    this.size = size;
    this.facing = azimuth;
    this.reset();
  }
  reset() { Object.assign(this, this.home, {target: [...this.home.target]}); }
  look(azimuth, elevation) {
    Object.assign(this, {target: [...this.home.target], distance: this.home.distance, azimuth, elevation});
  }
  /** From the turned frame to the gear frame and back. */
  turned(v) { return this.down ? [v[0], -v[1], -v[2]] : v; }
  back() {
    const c = Math.cos(this.elevation);
    return this.turned([c * Math.cos(this.azimuth), c * Math.sin(this.azimuth), Math.sin(this.elevation)]);
  }
  right() { return this.turned([-Math.sin(this.azimuth), Math.cos(this.azimuth), 0]); }
  up() { return Vec.cross(this.back(), this.right()); }
  eye() { return Vec.add(this.target, Vec.scale(this.back(), this.distance)); }
  orbit(dx, dy) {
    this.azimuth -= dx;
    this.elevation = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.elevation + dy));
  }
  zoom(factor) { this.distance = Math.max(this.size * 0.02, Math.min(this.size * 40, this.distance * factor)); }
  /** Moves the target by pixels of a view of that height. */
  pan(dx, dy, height) {
    const scale = 2 * this.distance * Camera.tangent / height;
    this.target = Vec.add(this.target, Vec.add(Vec.scale(this.right(), -dx * scale), Vec.scale(this.up(), dy * scale)));
  }
  matrix(aspect) {
    const near = this.distance * 0.02, far = this.distance + this.size * 60;
    // In a tall view the width decides, so that the part always fits.
    const t = Camera.tangent * Math.max(1, 1 / aspect);
    const f = 1 / t;
    const projection = new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1,
                                         0, 0, 2 * far * near / (near - far), 0]);
    const r = this.right(), u = this.up(), b = this.back(), e = this.eye();
    const view = new Float32Array([r[0], u[0], b[0], 0, r[1], u[1], b[1], 0, r[2], u[2], b[2], 0,
                                   -Vec.dot(r, e), -Vec.dot(u, e), -Vec.dot(b, e), 1]);
    return multiply(projection, view);
  }
}
Camera.tangent = Math.tan(0.24);

const kSurfaceVertex = `#version 300 es
uniform mat4 u_matrix; uniform vec3 u_eye;
layout(location=0) in vec3 a_point; layout(location=1) in vec3 a_normal;
layout(location=2) in float a_value; layout(location=3) in float a_state;
out vec3 v_normal, v_view; out float v_value, v_state;
void main() {
  v_normal = a_normal; v_view = u_eye - a_point; v_value = a_value; v_state = a_state;
  gl_Position = u_matrix * vec4(a_point, 1.0);
}`;
const kSurfaceFragment = `#version 300 es
precision highp float;
uniform vec2 u_range; uniform float u_middle; uniform sampler2D u_colours; uniform bool u_coloured; uniform float u_pixel;
in vec3 v_normal, v_view; in float v_value, v_state;
out vec4 colour;
void main() {
  vec3 n = normalize(v_normal), v = normalize(v_view);
  float facing = dot(n, v);
  vec3 base = vec3(0.70, 0.72, 0.74);
  if (u_coloured && v_state < 0.5) {
    float t = v_value < u_middle ? 0.5 * (v_value - u_range.x) / max(u_middle - u_range.x, 1e-9)
                                 : 0.5 + 0.5 * (v_value - u_middle) / max(u_range.y - u_middle, 1e-9);
    base = texture(u_colours, vec2(clamp(t, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5)).rgb;
  } else if (u_coloured && v_state < 1.5) {
    base = mod(gl_FragCoord.x + gl_FragCoord.y, 9.0 * u_pixel) < 3.0 * u_pixel ? vec3(0.42, 0.45, 0.48) : vec3(0.86, 0.87, 0.88);
  }
  if (facing < 0.0) base = mix(base, vec3(0.40, 0.43, 0.46), 0.85);
  float light = 0.56 + 0.44 * abs(facing);
  float gleam = 0.10 * pow(abs(facing), 24.0);
  colour = vec4(base * light + gleam, 1.0);
}`;
const kSolidVertex = `#version 300 es
uniform mat4 u_matrix; uniform vec3 u_eye, u_origin, u_axis;
layout(location=0) in vec3 a_point; layout(location=1) in vec3 a_normal;
out vec3 v_normal, v_view;
void main() {
  vec3 x = normalize(abs(u_axis.z) < 0.9 ? cross(vec3(0.0, 0.0, 1.0), u_axis) : cross(vec3(1.0, 0.0, 0.0), u_axis));
  mat3 turn = mat3(x, cross(u_axis, x), u_axis);
  vec3 p = u_origin + turn * a_point;
  v_normal = turn * a_normal; v_view = u_eye - p;
  gl_Position = u_matrix * vec4(p, 1.0);
}`;
const kSolidFragment = `#version 300 es
precision highp float;
uniform vec4 u_colour;
in vec3 v_normal, v_view;
out vec4 colour;
void main() {
  float facing = abs(dot(normalize(v_normal), normalize(v_view)));
  float edge = 1.0 - facing;
  colour = vec4(u_colour.rgb * (0.5 + 0.5 * facing) + 0.12 * pow(facing, 20.0), mix(u_colour.a, min(1.0, u_colour.a * 2.2), edge * edge));
}`;
// A segment is a quad of constant width on the screen: corners from gl_VertexID, ends from two views of one buffer.
const kLineVertex = `#version 300 es
uniform mat4 u_matrix; uniform vec2 u_viewport; uniform float u_width, u_near; uniform int u_first, u_current; uniform bool u_links;
layout(location=0) in vec4 a_from; layout(location=1) in vec4 a_to;
out vec4 v_colour;
const vec3 kKinds[4] = vec3[4](vec3(0.56, 0.32, 0.72), vec3(0.90, 0.52, 0.06), vec3(0.03, 0.47, 0.36), vec3(0.90, 0.52, 0.06));
void main() {
  vec4 p = u_matrix * vec4(a_from.xyz, 1.0), q = u_matrix * vec4(a_to.xyz, 1.0);
  if (p.w < u_near && q.w > u_near) p = mix(q, p, (q.w - u_near) / (q.w - p.w));
  if (q.w < u_near && p.w > u_near) q = mix(p, q, (p.w - u_near) / (p.w - q.w));
  bool at_end = gl_VertexID == 1 || gl_VertexID == 3 || gl_VertexID == 4;
  float side = gl_VertexID == 0 || gl_VertexID == 1 || gl_VertexID == 3 ? -1.0 : 1.0;
  vec2 along = (q.xy / q.w - p.xy / p.w) * u_viewport;
  float len = length(along);
  vec2 across = len > 1e-6 ? vec2(-along.y, along.x) / len : vec2(0.0, 1.0);
  vec4 at = at_end ? q : p;
  bool done = u_first + gl_InstanceID < u_current;
  at.xy += side * across * u_width * (done ? 1.0 : 0.7) / u_viewport * at.w;
  at.z -= 0.00004 * at.w;
  bool hidden = !u_links && abs(a_to.w - 2.0) > 0.5;
  if (hidden || (p.w < u_near && q.w < u_near)) at = vec4(0.0, 0.0, 2.0, 1.0);
  gl_Position = at;
  v_colour = vec4(kKinds[clamp(int(a_to.w + 0.5), 0, 3)], done ? 1.0 : 0.30);
}`;
const kLineFragment = `#version 300 es
precision highp float;
in vec4 v_colour;
out vec4 colour;
void main() { colour = v_colour; }`;

/** A linked program with its uniform locations; throws with the compiler's text. */
function buildProgram(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const at = {};
  for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i++) {
    const name = gl.getActiveUniform(program, i).name;
    at[name] = gl.getUniformLocation(program, name);
  }
  return {program, at};
}

/** Triangles of a profile [[radius, height], ...] turned about z: interleaved point and normal. */
function revolve(profile, segments) {
  const outline = profile.slice();
  if (outline[0][0] > 0) outline.unshift([0, outline[0][1]]);
  if (outline[outline.length - 1][0] > 0) outline.push([0, outline[outline.length - 1][1]]);
  const normals = outline.slice(1).map((q, i) => {
    const [r, h] = [q[0] - outline[i][0], q[1] - outline[i][1]];
    const length = Math.hypot(r, h) || 1;
    return [h / length, -r / length];
  });
  // Neighbours that meet at a blunt angle share a normal: a ball made of short pieces looks round.
  const shared = (i, j) => {
    if (j < 0 || j >= normals.length) return normals[i];
    const [a, b] = [normals[i], normals[j]];
    if (a[0] * b[0] + a[1] * b[1] < 0.9) return a;
    const sum = [a[0] + b[0], a[1] + b[1]], length = Math.hypot(...sum);
    return [sum[0] / length, sum[1] / length];
  };
  const out = [];
  for (let i = 0; i + 1 < outline.length; i++) {
    const ends = [[outline[i], shared(i, i - 1)], [outline[i + 1], shared(i, i + 1)]];
    for (let k = 0; k < segments; k++) {
      for (const [end, turn] of [[0, 0], [0, 1], [1, 1], [0, 0], [1, 1], [1, 0]]) {
        const angle = 2 * Math.PI * (k + turn) / segments, c = Math.cos(angle), s = Math.sin(angle);
        const [p, n] = ends[end];
        out.push(p[0] * c, p[0] * s, p[1], n[0] * c, n[0] * s, n[1]);
      }
    }
  }
  return new Float32Array(out);
}

/** Draws surface, paths and tool. Call draw() after any change of `state`. */
class View {
  constructor(canvas) {
    const gl = canvas.getContext('webgl2', {antialias: true, preserveDrawingBuffer: true});
    if (!gl) throw new Error('no WebGL2');
    Object.assign(this, {gl, canvas, surface: null, paths: [], tools: []});
    this.surfaceProgram = buildProgram(gl, kSurfaceVertex, kSurfaceFragment);
    this.solidProgram = buildProgram(gl, kSolidVertex, kSolidFragment);
    this.lineProgram = buildProgram(gl, kLineVertex, kLineFragment);
    this.colours = gl.createTexture();
  }

  /** 256 colours as RGBA bytes, from the lowest value to the highest. */
  setColours(rgba) {
    const gl = this.gl;
    gl.bindTexture(gl.TEXTURE_2D, this.colours);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
    for (const which of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, which, gl.LINEAR);
    for (const which of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, which, gl.CLAMP_TO_EDGE);
  }

  buffer(target, data) {
    const buffer = this.gl.createBuffer();
    this.gl.bindBuffer(target, buffer);
    this.gl.bufferData(target, data, this.gl.STATIC_DRAW);
    return buffer;
  }

  /** points, normals: 3 floats a vertex; triangles: indices. */
  setSurface(points, normals, triangles) {
    const gl = this.gl;
    const vao = gl.createVertexArray();
    gl.bindVertexArray(vao);
    [points, normals].forEach((data, slot) => {
      this.buffer(gl.ARRAY_BUFFER, data);
      gl.enableVertexAttribArray(slot);
      gl.vertexAttribPointer(slot, 3, gl.FLOAT, false, 0, 0);
    });
    const values = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, values);
    for (const slot of [2, 3]) {
      gl.enableVertexAttribArray(slot);
      gl.vertexAttribPointer(slot, 1, gl.FLOAT, false, 8, slot === 2 ? 0 : 4);
    }
    this.buffer(gl.ELEMENT_ARRAY_BUFFER, triangles);
    gl.bindVertexArray(null);
    this.surface = {vao, values, count: triangles.length};
  }

  /** Two floats a vertex: value, and 0 shown, 1 unreached, 2 without value. */
  setValues(values) {
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.surface.values);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, values, this.gl.DYNAMIC_DRAW);
  }

  /** Four floats a record: tip and kind of the move that leads there. */
  addPath(records) {
    const gl = this.gl;
    const vao = gl.createVertexArray();
    const buffer = this.buffer(gl.ARRAY_BUFFER, records);
    this.paths.push({vao, buffer, count: records.length / 4});
  }

  addTool(bodies) {
    const gl = this.gl;
    this.tools.push(bodies.map((body) => {
      const data = revolve(body.profile, 64);
      const vao = gl.createVertexArray();
      gl.bindVertexArray(vao);
      this.buffer(gl.ARRAY_BUFFER, data);
      for (const slot of [0, 1]) {
        gl.enableVertexAttribArray(slot);
        gl.vertexAttribPointer(slot, 3, gl.FLOAT, false, 24, slot * 12);
      }
      gl.bindVertexArray(null);
      return {vao, count: data.length / 6, cutting: body.cutting, name: body.name};
    }));
  }

  resize() {
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const box = this.canvas.getBoundingClientRect();
    const width = Math.max(1, Math.round(box.width * ratio)), height = Math.max(1, Math.round(box.height * ratio));
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, {width, height});
    this.ratio = ratio;
  }

  draw(camera, state) {
    const gl = this.gl;
    this.resize();
    const {width, height} = this.canvas;
    this.matrix = camera.matrix(width / height);
    const eye = camera.eye();
    gl.viewport(0, 0, width, height);
    gl.clearColor(...state.background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.depthMask(true);
    if (this.surface && state.showSurface) this.drawSurface(eye, state);
    if (state.tool) this.drawTool(eye, state.tool, true);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    for (const path of state.paths) this.drawPath(path, camera);
    if (state.tool) this.drawTool(eye, state.tool, false);
  }

  drawSurface(eye, state) {
    const gl = this.gl, {program, at} = this.surfaceProgram;
    gl.useProgram(program);
    gl.uniformMatrix4fv(at.u_matrix, false, this.matrix);
    gl.uniform3fv(at.u_eye, eye);
    gl.uniform2f(at.u_range, state.range[0], state.range[2]);
    gl.uniform1f(at.u_middle, state.range[1]);
    gl.uniform1i(at.u_coloured, state.coloured ? 1 : 0);
    gl.uniform1f(at.u_pixel, this.ratio);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.colours);
    gl.uniform1i(at.u_colours, 0);
    gl.bindVertexArray(this.surface.vao);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 1);
    gl.drawElements(gl.TRIANGLES, this.surface.count, gl.UNSIGNED_INT, 0);
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  /** path: {index, first, last, current, links}: segments first ... last - 1, those before `current` in full colour;
   *  without `links` only feed moves. */
  drawPath(path, camera) {
    const gl = this.gl, {program, at} = this.lineProgram;
    const {vao, buffer} = this.paths[path.index];
    const segments = path.last - path.first;
    if (segments < 1) return;
    gl.useProgram(program);
    gl.uniformMatrix4fv(at.u_matrix, false, this.matrix);
    gl.uniform2f(at.u_viewport, this.canvas.width, this.canvas.height);
    gl.uniform1f(at.u_width, 1.7 * this.ratio);
    gl.uniform1f(at.u_near, camera.distance * 0.02);
    gl.uniform1i(at.u_first, path.first);
    gl.uniform1i(at.u_current, path.current);
    gl.uniform1i(at.u_links, path.links ? 1 : 0);
    gl.bindVertexArray(vao);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    for (const slot of [0, 1]) {
      gl.enableVertexAttribArray(slot);
      gl.vertexAttribPointer(slot, 4, gl.FLOAT, false, 16, (path.first + slot) * 16);
      gl.vertexAttribDivisor(slot, 1);
    }
    gl.depthMask(false);
    gl.drawArraysInstanced(gl.TRIANGLES, 0, 6, segments);
    gl.depthMask(true);
  }

  drawTool(eye, tool, opaque) {
    const gl = this.gl, {program, at} = this.solidProgram;
    gl.useProgram(program);
    gl.uniformMatrix4fv(at.u_matrix, false, this.matrix);
    gl.uniform3fv(at.u_eye, eye);
    gl.uniform3fv(at.u_origin, tool.tip);
    gl.uniform3fv(at.u_axis, tool.axis);
    if (!opaque) {
      gl.enable(gl.CULL_FACE);
      gl.depthMask(false);
    }
    for (const body of this.tools[tool.index]) {
      if (body.cutting !== opaque || (tool.cuttingOnly && !opaque)) continue;
      gl.uniform4fv(at.u_colour, opaque ? [0.86, 0.68, 0.24, 1] : body.name === 'holder' ? [0.24, 0.29, 0.36, 0.30] : [0.36, 0.42, 0.49, 0.38]);
      gl.bindVertexArray(body.vao);
      gl.drawArrays(gl.TRIANGLES, 0, body.count);
    }
    gl.disable(gl.CULL_FACE);
    gl.depthMask(true);
  }

  /** Place of a point in CSS pixels of the canvas, with its depth (smaller is nearer); null behind the eye. */
  project(p) {
    const m = this.matrix, w = m[3] * p[0] + m[7] * p[1] + m[11] * p[2] + m[15];
    if (!(w > 0)) return null;
    const x = m[0] * p[0] + m[4] * p[1] + m[8] * p[2] + m[12], y = m[1] * p[0] + m[5] * p[1] + m[9] * p[2] + m[13];
    return {x: (x / w + 1) / 2 * this.canvas.width / this.ratio, y: (1 - y / w) / 2 * this.canvas.height / this.ratio, depth: w};
  }
}
