// What the graphics card runs: surface, solids of the tool, lines of the path.
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
