// The 3D view: surface, paths and tools as buffers, and how they are drawn.
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
