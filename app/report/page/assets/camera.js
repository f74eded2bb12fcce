// Vectors and the camera of the 3D view.
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
