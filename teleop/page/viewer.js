// Draws the scene with WebGL2: all meshes in one call, poses in a texture, one light with a shadow. Runs in a worker.

import {placed} from "./projection.js";

const VERTEX = `#version 300 es
precision highp float;
layout(location=0) in vec3 corner;
layout(location=1) in vec4 normal;
layout(location=2) in vec4 colour;
layout(location=3) in uint owner;
uniform highp sampler2D poses;
uniform mat4 clip;
uniform mat4 light;
out vec3 at; out vec3 facing; out vec3 shade; out vec4 lit;
void main() {
  int row = int(owner);
  vec4 p = vec4(corner, 1.0);
  vec4 a = texelFetch(poses, ivec2(0, row), 0);
  vec4 b = texelFetch(poses, ivec2(1, row), 0);
  vec4 c = texelFetch(poses, ivec2(2, row), 0);
  at = vec3(dot(a, p), dot(b, p), dot(c, p));
  facing = vec3(dot(a.xyz, normal.xyz), dot(b.xyz, normal.xyz), dot(c.xyz, normal.xyz));
  shade = colour.rgb;
  lit = light * vec4(at, 1.0);
  gl_Position = clip * vec4(at, 1.0);
}`;
const FRAGMENT = `#version 300 es
precision highp float;
in vec3 at; in vec3 facing; in vec3 shade; in vec4 lit;
uniform vec3 eye; uniform vec3 sun; uniform vec3 sky; uniform vec4 middle; uniform float shadowed;
uniform highp sampler2DShadow shadow;
out vec4 pixel;
float light() {
  if (shadowed < 0.5) return 1.0;
  vec3 place = lit.xyz * 0.5 + 0.5;
  if (any(lessThan(place, vec3(0.0))) || any(greaterThan(place, vec3(1.0)))) return 1.0;
  float sum = 0.0;
  for (int x = 0; x < 2; x++) for (int y = 0; y < 2; y++)
    sum += texture(shadow, vec3(place.xy + (vec2(x, y) - 0.5) / 1024.0, place.z - 0.0025));
  return sum / 4.0;
}
void main() {
  vec3 to_eye = normalize(eye - at);
  vec3 n = normalize(facing);
  if (dot(n, to_eye) < 0.0) n = -n;
  vec3 base = pow(shade, vec3(2.2));
  float above = 0.5 + 0.5 * n.z;
  float direct = max(dot(n, sun), 0.0) * light();
  float fill = max(dot(n, to_eye), 0.0);
  vec3 colour = (base + 0.012) * (mix(vec3(0.17, 0.16, 0.16), vec3(0.36, 0.39, 0.44), above) + 0.72 * direct + 0.30 * fill);
  float gleam = pow(max(dot(n, normalize(sun + to_eye)), 0.0), 40.0);
  colour += 0.10 * gleam * direct + 0.05 * pow(1.0 - max(dot(n, to_eye), 0.0), 4.0);
  colour = pow(colour, vec3(1.0 / 2.2));
  float far = smoothstep(1.6, 3.4, length(at.xy - middle.xy) / middle.w);
  pixel = vec4(mix(colour, sky, far), 1.0);
}`;
const DEPTH_FRAGMENT = `#version 300 es
precision highp float;
void main() {}`;
const SHADOW_SIZE = 1024;
const SUN = unit([0.15, -0.35, 1.0]);
const MOVE_MS = 350;
const PIXELS = [0.6, 0.8, 1]; // of those that the screen has
const TELL_EVERY = 5;
const SAME_VIEW = 1 - 1e-7; // cosine of half the angle that a view must turn by to count as another one, 0.05 degrees
const SLOW_MS = 150;
/** Direction from which each view looks (x away from the robot, y left, z up) and its distance in radii. */
const VIEWS = {
  overview: {from: [-0.55, -0.62, 0.8], far: 2.9},
  behind: {from: [-0.75, 0.0, 1.0], far: 2.9},
  front: {from: [1.0, 0.0, 0.42], far: 2.9},
  side: {from: [0.0, -1.0, 0.30], far: 2.9},
  top: {from: [-0.02, 0.0, 1.0], far: 2.9},
};

export class Viewer {
  /** @param {OffscreenCanvas} canvas  @param {() => void} changed is called when a view is chosen or views change. */
  constructor(canvas, changed) {
    this.canvas = canvas;
    this.changed = changed;
    this.view = "overview";
    this.cameras = [];
    this.scene = null;
    this.frames = 0;
    this.seen = null; // orientation of the last picture, as opticalQuaternion has it
    [this.width, this.height, this.ratio, this.sky] = [800, 600, 1, [0.9, 0.925, 0.955]];
    this.orbit = {target: [0.2, 0, 0.1], yaw: -2.4, pitch: 0.6, distance: 1.6};
    this.flight = null;
    this.drawing = false;
    this.fence = null;
    this.slow = SLOW_MS / 2;
    this.quality = PIXELS.length - 1;
    [this.marked, this.marks, this.shown] = [[], [], ""]; // places to be marked, where they are in the picture
    this.gl = canvas.getContext("webgl2", {antialias: true, alpha: false, powerPreference: "high-performance"});
    if (!this.gl) return;
    this.prepare();
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => {
      this.prepare();
      if (this.message) this.setGeometry(this.message);
    });
  }

  /** Take the size on the screen [CSS pixel], pixels per CSS pixel, and the colour behind everything. */
  setFrame(width, height, ratio, sky) {
    Object.assign(this, {width, height, ratio, sky});
    this.redraw();
  }

  /** Take what is marked in the scene: centre and half of the width of each [m]. */
  setMarks(marks) {
    this.marked = marks;
    this.shown = "";
    this.redraw();
  }

  get views() {
    return [...Object.keys(VIEWS), ...this.cameras.map((each) => each.name)];
  }

  prepare() {
    const gl = this.gl;
    this.fence = null;
    this.drawing = false;
    this.program = program(gl, VERTEX, FRAGMENT);
    this.depthProgram = program(gl, VERTEX, DEPTH_FRAGMENT);
    this.shadow = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.shadow);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.DEPTH_COMPONENT24, SHADOW_SIZE, SHADOW_SIZE, 0, gl.DEPTH_COMPONENT,
      gl.UNSIGNED_INT, null);
    parameters(gl, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    this.shadowFrame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowFrame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.shadow, 0);
    gl.drawBuffers([gl.NONE]);
    gl.readBuffer(gl.NONE);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** Take a geometry message (the layout is in teleop/loop_view.py). */
  setGeometry(message) {
    this.message = message;
    if (!this.gl) return;
    const gl = this.gl;
    const numbers = new DataView(message);
    const length = numbers.getUint32(8, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(message, 16, length)));
    const {corners, triangles, drawables} = header;
    let at = 16 + length;
    const take = (size) => {
      const start = at;
      at += Math.ceil(size / 4) * 4;
      return new Uint8Array(message, start, size);
    };
    if (this.scene) this.forget(this.scene);
    const scene = {number: numbers.getUint32(4, true), header, count: triangles * 3, buffers: []};
    scene.array = gl.createVertexArray();
    gl.bindVertexArray(scene.array);
    const attribute = (index, data) => {
      const buffer = gl.createBuffer();
      scene.buffers.push(buffer);
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(index);
    };
    attribute(0, take(corners * 12));
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    attribute(1, take(corners * 4));
    gl.vertexAttribPointer(1, 4, gl.BYTE, true, 0, 0);
    attribute(2, take(corners * 4));
    gl.vertexAttribPointer(2, 4, gl.UNSIGNED_BYTE, true, 0, 0);
    attribute(3, take(corners * 2));
    gl.vertexAttribIPointer(3, 1, gl.UNSIGNED_SHORT, 0, 0);
    const indices = gl.createBuffer();
    scene.buffers.push(indices);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, take(triangles * 12), gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    scene.rows = new Float32Array(drawables.length * 12);
    drawables.forEach((_, i) => scene.rows.set([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0], i * 12));
    scene.moving = drawables.filter((each) => each.slot >= 0).length;
    scene.texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, scene.texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, 3, drawables.length);
    parameters(gl, gl.NEAREST);
    scene.ready = false;
    const before = this.scene?.header;
    this.scene = scene;
    this.cameras = header.cameras;
    this.cameraPoses = [];
    if (!this.views.includes(this.view)) this.view = "overview";
    if (JSON.stringify(before?.centre) !== JSON.stringify(header.centre)) this.look(this.view, true);
    this.changed();
  }

  forget(scene) {
    const gl = this.gl;
    scene.buffers.forEach((each) => gl.deleteBuffer(each));
    gl.deleteVertexArray(scene.array);
    gl.deleteTexture(scene.texture);
  }

  /** Take a poses message. */
  setPoses(message) {
    const scene = this.scene;
    if (!scene || new DataView(message).getUint32(4, true) !== scene.number) return;
    const poses = new Float32Array(message, 16);
    scene.header.drawables.forEach(({slot}, i) => {
      if (slot >= 0) scene.rows.set(poses.subarray(slot * 12, slot * 12 + 12), i * 12);
    });
    this.cameraPoses = this.cameras.map((_, i) => poses.slice((scene.moving + i) * 12, (scene.moving + i + 1) * 12));
    scene.fresh = scene.ready = true;
    this.redraw();
  }

  /** Change to a view by name. */
  look(name, at_once = false) {
    this.view = name;
    if (name in VIEWS && this.scene) {
      const {centre, radius, overview} = this.scene.header;
      const from = name === "overview" ? overview : VIEWS[name].from;
      const {far} = VIEWS[name];
      const wide = Math.max(1, 1.25 / Math.max(this.width / Math.max(this.height, 1), 0.4));
      const goal = {
        target: centre, yaw: Math.atan2(from[1], from[0]), pitch: Math.atan2(from[2], Math.hypot(from[0], from[1])),
        distance: far * radius * wide,
      };
      if (at_once) this.orbit = goal;
      else this.flight = {from: {...this.orbit}, to: goal, start: performance.now()};
    }
    this.changed();
    this.redraw();
  }

  /** Draw at the next chance, but never ahead of the graphics card: what waits there would hold up the sticks. */
  redraw() {
    if (this.drawing || !this.gl) return;
    this.drawing = true;
    requestAnimationFrame(() => this.whenIdle());
  }

  whenIdle() {
    const {gl, fence} = this;
    if (fence && !gl.isContextLost()) {
      if (gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED) {
        setTimeout(() => this.whenIdle(), 8);
        return;
      }
      gl.deleteSync(fence);
      this.fence = null;
      this.adapt(performance.now() - this.began);
    }
    this.draw();
  }

  /** Fewer pixels where drawing is slow, as without a graphics card; more again where it is fast. */
  adapt(taken) {
    this.slow += (taken - this.slow) * 0.1;
    if (this.slow > SLOW_MS && this.quality > 0) this.quality -= 1;
    else if (this.slow < SLOW_MS / 6 && this.quality < PIXELS.length - 1) this.quality += 1;
    else return;
    this.slow = SLOW_MS / 2;
  }

  draw() {
    this.drawing = false;
    this.began = performance.now();
    const {gl, scene, canvas} = this;
    if (!scene?.ready || gl.isContextLost()) return;
    this.fly();
    const ratio = Math.min(this.ratio, 2) * PIXELS[this.quality];
    const width = Math.max(1, Math.round(this.width * ratio));
    const height = Math.max(1, Math.round(this.height * ratio));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
    if (scene.fresh) {
      gl.activeTexture(gl.TEXTURE0);
      gl.bindTexture(gl.TEXTURE_2D, scene.texture);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, 3, scene.header.drawables.length, gl.RGBA, gl.FLOAT, scene.rows);
      this.drawShadow();
      scene.fresh = false;
    }
    const [clip, eye, axes] = this.camera(width / height);
    const {sky} = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    gl.clearColor(sky[0], sky[1], sky[2], 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.program);
    const place = (name) => gl.getUniformLocation(this.program, name);
    gl.uniformMatrix4fv(place("clip"), true, clip);
    gl.uniformMatrix4fv(place("light"), true, this.lightMatrix());
    gl.uniform3fv(place("eye"), eye);
    gl.uniform3fv(place("sun"), SUN);
    gl.uniform3fv(place("sky"), sky);
    gl.uniform4f(place("middle"), ...scene.header.centre, scene.header.radius);
    gl.uniform1f(place("shadowed"), 1);
    gl.uniform1i(place("poses"), 0);
    gl.uniform1i(place("shadow"), 1);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.shadow);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, scene.texture);
    this.drawMeshes();
    this.frames += 1;
    // What is driven along the axes of the picture means the picture that is seen.
    const seen = opticalQuaternion(axes);
    const turned = !this.seen || Math.abs(seen.reduce((sum, value, i) => sum + value * this.seen[i], 0)) < SAME_VIEW;
    if (turned) this.seen = seen;
    this.marks = this.marked.map((each) => placed(each, clip, axes[0], this.width, this.height));
    const shown = JSON.stringify(this.marks);
    if (turned || shown !== this.shown || this.frames % TELL_EVERY === 1) this.changed();
    this.shown = shown;
    this.fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    if (this.flight) this.redraw();
  }

  drawShadow() {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowFrame);
    gl.viewport(0, 0, SHADOW_SIZE, SHADOW_SIZE);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.depthProgram);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, null);
    gl.activeTexture(gl.TEXTURE0);
    gl.uniform1i(gl.getUniformLocation(this.depthProgram, "poses"), 0);
    gl.uniformMatrix4fv(gl.getUniformLocation(this.depthProgram, "clip"), true, this.lightMatrix());
    this.drawMeshes();
  }

  drawMeshes() {
    const gl = this.gl;
    gl.enable(gl.DEPTH_TEST);
    gl.bindVertexArray(this.scene.array);
    gl.drawElements(gl.TRIANGLES, this.scene.count, gl.UNSIGNED_INT, 0);
    gl.bindVertexArray(null);
  }

  lightMatrix() {
    const {centre, radius} = this.scene.header;
    const size = 1.7 * radius;
    const eye = centre.map((value, i) => value + 3 * size * SUN[i]);
    const view = viewMatrix(eye, axesLooking(SUN, [0, 1, 0]));
    const box = new Float32Array([1 / size, 0, 0, 0, 0, 1 / size, 0, 0, 0, 0, -1 / (2.5 * size), -3 / 2.5, 0, 0, 0, 1]);
    return multiply(box, view);
  }

  /** Clip matrix and eye of the view that is on, and its axes: right, up and back. */
  camera(aspect) {
    const mounted = this.cameras.findIndex((each) => each.name === this.view);
    if (mounted >= 0 && this.cameraPoses[mounted]) {
      const p = this.cameraPoses[mounted];
      const eye = [p[3], p[7], p[11]];
      const axes = [[p[0], p[4], p[8]], [-p[1], -p[5], -p[9]], [-p[2], -p[6], -p[10]]];
      return [multiply(perspective(this.cameras[mounted].height, aspect, 0.05, 30), viewMatrix(eye, axes)), eye, axes];
    }
    const {target, yaw, pitch, distance} = this.orbit;
    const back = [Math.cos(yaw) * Math.cos(pitch), Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch)];
    const eye = target.map((value, i) => value + distance * back[i]);
    const right = [-Math.sin(yaw), Math.cos(yaw), 0];
    const axes = [right, cross(back, right), back];
    return [multiply(perspective(0.75, aspect, 0.02 * distance, 40), viewMatrix(eye, axes)), eye, axes];
  }

  fly() {
    if (!this.flight) return;
    const {from, to, start} = this.flight;
    const share = Math.min(1, (performance.now() - start) / MOVE_MS);
    const s = share * share * (3 - 2 * share);
    const mix = (a, b) => a + (b - a) * s;
    const turn = Math.atan2(Math.sin(to.yaw - from.yaw), Math.cos(to.yaw - from.yaw));
    this.orbit = {
      target: from.target.map((value, i) => mix(value, to.target[i])), yaw: from.yaw + turn * s,
      pitch: mix(from.pitch, to.pitch), distance: mix(from.distance, to.distance),
    };
    if (share === 1) this.flight = null;
  }

  leaveMounted() {
    this.flight = null;
    if (!(this.view in VIEWS)) this.look("overview", true);
  }

  turn(dx, dy) {
    this.leaveMounted();
    this.orbit.yaw -= dx * 0.006;
    this.orbit.pitch = Math.min(1.56, Math.max(-0.2, this.orbit.pitch + dy * 0.006));
    this.redraw();
  }

  pan(dx, dy) {
    this.leaveMounted();
    const {yaw, pitch, distance, target} = this.orbit;
    const scale = (distance * 0.79) / Math.max(this.height, 1);
    const right = [-Math.sin(yaw), Math.cos(yaw), 0];
    const up = [-Math.cos(yaw) * Math.sin(pitch), -Math.sin(yaw) * Math.sin(pitch), Math.cos(pitch)];
    this.orbit.target = target.map((value, i) => value + scale * (dy * up[i] - dx * right[i]));
    this.redraw();
  }

  zoom(factor) {
    this.leaveMounted();
    this.orbit.distance = Math.min(12, Math.max(0.15, this.orbit.distance * factor));
    this.redraw();
  }
}

function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost()) {
    throw new Error(gl.getProgramInfoLog(made) || "the shaders do not link");
  }
  return made;
}

function parameters(gl, filter) {
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, filter);
  for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
}

function unit(v) {
  const length = Math.hypot(...v);
  return v.map((value) => value / length);
}

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

/** Unit quaternion x, y, z, w of a picture in the world: x to its right, y down, z into it. */
function opticalQuaternion([right, up, back]) {
  const [a, b, c] = [right, up.map((value) => -value), back.map((value) => -value)]; // columns of the rotation matrix
  // Of the four ways to get it, the one that divides by the largest number.
  const squares = [1 + a[0] - b[1] - c[2], 1 - a[0] + b[1] - c[2], 1 - a[0] - b[1] + c[2], 1 + a[0] + b[1] + c[2]];
  const rows = [
    [squares[0], a[1] + b[0], c[0] + a[2], b[2] - c[1]], [a[1] + b[0], squares[1], b[2] + c[1], c[0] - a[2]],
    [c[0] + a[2], b[2] + c[1], squares[2], a[1] - b[0]], [b[2] - c[1], c[0] - a[2], a[1] - b[0], squares[3]],
  ];
  return unit(rows[squares.indexOf(Math.max(...squares))]);
}

function axesLooking(back, up) {
  const right = unit(cross(up, back));
  return [right, cross(back, right), back];
}

/** World to eye, row by row; the rows are right, up and back. */
function viewMatrix(eye, axes) {
  const rows = axes.map((axis) => [...axis, -(axis[0] * eye[0] + axis[1] * eye[1] + axis[2] * eye[2])]);
  return new Float32Array([...rows.flat(), 0, 0, 0, 1]);
}

function perspective(height, aspect, near, far) {
  const f = 1 / Math.tan(height / 2);
  const depth = near - far;
  return new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / depth, (2 * far * near) / depth,
    0, 0, -1, 0]);
}

function multiply(a, b) {
  const c = new Float32Array(16);
  for (let i = 0; i < 4; i++) {
    for (let j = 0; j < 4; j++) {
      for (let k = 0; k < 4; k++) c[4 * i + j] += a[4 * i + k] * b[4 * k + j];
    }
  }
  return c;
}
