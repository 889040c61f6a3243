// The map in space, by WebGL: points, trajectories and closures, seen from a camera that orbits a target.

const vertex_shader = `
attribute vec3 position; attribute vec4 colour; attribute float time;
uniform mat4 camera; uniform float size; uniform vec2 limits; uniform vec2 shift;
varying vec4 shade;
void main() {
  shade = colour;
  gl_Position = camera * vec4(position, 1.0);
  gl_Position.xy += shift * gl_Position.w;
  gl_PointSize = clamp(size / gl_Position.w, 1.0, 12.0);
  if (colour.a == 0.0 || position.z > limits.x || time > limits.y) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`;
const fragment_shader = `
precision mediump float; varying vec4 shade;
void main() { gl_FragColor = vec4(shade.rgb, 1.0); }`;
const far_away = 1e9;
const slow_ms = 60, quick_ms = 20;  // per frame while the view moves: fewer points are drawn, or more
const most_sparse = 15;             // every so manieth point; WebGL steps over at most 255 bytes

const has_webgl = Boolean(element("canvas").getContext("webgl"));  // asked once: browsers have few contexts

/// Columns of a perspective camera's matrix.
function camera_matrix(target, yaw, pitch, distance, aspect) {
  const c = Math.cos(pitch), back = [c * Math.cos(yaw), c * Math.sin(yaw), Math.sin(pitch)];
  const right = [-Math.sin(yaw), Math.cos(yaw), 0], up = [-Math.sin(pitch) * Math.cos(yaw), -Math.sin(pitch) * Math.sin(yaw), c];
  const eye = target.map((t, i) => t + distance * back[i]), dot = v => -d3.sum(v, (x, i) => x * eye[i]);
  const f = 1.6, near = distance / 100, far = distance * 100, a = (far + near) / (near - far), b = (2 * far * near) / (near - far);
  const fx = f / Math.max(1, aspect), fy = fx * aspect, rows = [
    [...right.map(v => v * fx), dot(right) * fx], [...up.map(v => v * fy), dot(up) * fy],
    [...back.map(v => v * a), dot(back) * a + b], [...back.map(v => -v), -dot(back)]];
  return { eye, right, up, matrix: d3.range(16).map(k => rows[k % 4][Math.floor(k / 4)]) };
}

class SpaceView {
  constructor(parent) {
    this.parent = parent;
    this.canvas = element("canvas", { tabindex: "0", role: "img", class: "space", hidden: true,
      "aria-label": "Map in space. Arrow keys turn it, shift and arrow keys move it, plus and minus zoom, 0 shows everything." });
    parent.append(this.canvas);
    this.gl = this.canvas.getContext("webgl", { antialias: true, preserveDrawingBuffer: true });
    this.redraw = once_per_frame(() => this.draw());
    this.program = this.link();
    this.buffers = { points: {}, lines: {} };
    for (const change of ["visibility", "theme", "layers", "highlight", "colour"]) changes.on(`${change}.space`, () => { this.stale = true; this.redraw(); });
    changes.on("limits.space", () => this.move());
    this.listen();
    this.stale = true;
    this.step = 1;  // every so manieth point is drawn while the view moves
  }

  /// Draws as many points as are quick, and all of them once the view rests.
  move() {
    this.moving = true;
    clearTimeout(this.rest);
    this.rest = setTimeout(() => { this.moving = false; this.redraw(); }, 250);
    this.redraw();
  }

  link() {
    const { gl } = this, program = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, vertex_shader], [gl.FRAGMENT_SHADER, fragment_shader]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    return program;
  }

  /// Coordinates about a centre, which keeps them exact in single precision.
  fill(name, xs, ys, zs, ts) {
    if (!this.centre) this.centre = this.middle();
    const { gl } = this, n = xs.length, data = new Float32Array(4 * n), set = this.buffers[name], [cx, cy, cz] = this.centre;
    for (let k = 0; k < n; ++k) data.set([xs[k] - cx, ys[k] - cy, zs[k] - cz, ts[k]], 4 * k);
    set.vertices = set.vertices || gl.createBuffer();
    set.count = n;
    gl.bindBuffer(gl.ARRAY_BUFFER, set.vertices);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
  }

  colour(name, colours) {
    const { gl } = this, set = this.buffers[name];
    set.colours = set.colours || gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, set.colours);
    gl.bufferData(gl.ARRAY_BUFFER, colours, gl.DYNAMIC_DRAW);
  }

  /// Middle and size of what is seen.
  spans() {
    const span = axis => {
      const ends = cloud.count ? span_of(cloud[axis]) : d3.extent(robots.filter(r => r.estimate && r.estimate[axis]).flatMap(r => d3.extent(r.estimate[axis])));
      return ends[0] === undefined ? [0, 0] : ends;
    };
    return ["x", "y", "z"].map(span);
  }
  middle() { return this.spans().map(([low, high]) => (low + high) / 2); }

  fit() {
    const sizes = this.spans().map(([low, high]) => high - low);
    Object.assign(this, { yaw: -2.2, pitch: 0.8, distance: Math.max(2, 1.15 * Math.hypot(...sizes)), target: [0, 0, 0] });
    this.redraw();
  }

  listen() {
    const down = new Map();
    this.canvas.addEventListener("pointerdown", event => { down.set(event.pointerId, event); this.canvas.focus(); });
    for (const end of ["pointerup", "pointercancel", "pointerleave"]) this.canvas.addEventListener(end, event => down.delete(event.pointerId));
    this.canvas.addEventListener("pointermove", event => {
      const last = down.get(event.pointerId);
      if (!last || (event.pointerType === "touch" && down.size < 2)) return;
      const dx = event.offsetX - last.offsetX, dy = event.offsetY - last.offsetY;
      down.set(event.pointerId, event);
      if (event.shiftKey || last.button === 2) this.pan(dx, dy);
      else this.turn(-dx / 200, dy / 200);
    });
    this.canvas.addEventListener("contextmenu", event => event.preventDefault());
    this.canvas.addEventListener("wheel", event => {
      if (!event.ctrlKey && document.activeElement !== this.canvas) return;
      event.preventDefault();
      this.zoom_by(Math.exp(-event.deltaY / 500));
    }, { passive: false });
    this.canvas.addEventListener("keydown", event => this.key(event));
  }

  key(event) {
    const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (arrow && event.shiftKey) this.pan(-40 * arrow[0], -40 * arrow[1]);
    else if (arrow) this.turn(0.1 * arrow[0], -0.1 * arrow[1]);
    else if (event.key === "+" || event.key === "=") this.zoom_by(1.3);
    else if (event.key === "-") this.zoom_by(1 / 1.3);
    else if (event.key === "0") this.fit();
    else return;
    event.preventDefault();
  }

  turn(yaw, pitch) {
    this.yaw += yaw;
    this.pitch = Math.max(-0.3, Math.min(1.57, this.pitch + pitch));
    this.move();
  }

  pan(dx, dy) {
    const { right, up } = this.camera(), scale = this.distance / this.parent.clientHeight;
    this.target = this.target.map((t, i) => t - scale * (dx * right[i] - dy * up[i]));
    this.move();
  }

  zoom_by(factor) {
    this.distance /= factor;
    this.move();
  }

  camera() {
    return camera_matrix(this.target, this.yaw, this.pitch, this.distance, this.parent.clientWidth / this.parent.clientHeight);
  }

  /// Closures and, over them, trajectories as pairs of ends.
  build_lines() {
    const x = [], y = [], z = [], t = [], colours = [];
    const end = (path, i, colour) => {
      x.push(path.x[i]);
      y.push(path.y[i]);
      z.push(path.z ? path.z[i] : 0);
      t.push(path.t ? path.t[i] : 0);
      colours.push(colour.r, colour.g, colour.b, 255);
    };
    const add = (path, colour) => {
      const rgb = d3.rgb(colour);
      for (let i = 1; path && i < path.x.length; ++i) end(path, i - 1, rgb), end(path, i, rgb);
    };
    for (let c = 0; c < lines.group.length; ++c) {
      if (!line_shown(c)) continue;
      const rgb = d3.rgb(d3.interpolateLab(css("paper"), closure_colour(groups[lines.group[c]]))(0.6));
      end(robots[lines.robot_i[c]].estimate, lines.keyframe_i[c], rgb);
      end(robots[lines.robot_j[c]].estimate, lines.keyframe_j[c], rgb);
    }
    for (const robot of shown()) {
      if (state.layers.truth) add(robot.truth, css("truth"));
      if (state.layers.estimate) add(path_of(robot, "estimate"), fades(robot.index) ? css("line") : robot_colour(robot.index));
    }
    this.fill("lines", x, y, z, t);
    this.colour("lines", new Uint8Array(colours));
  }

  resize() {
    const ratio = window.devicePixelRatio || 1, { clientWidth, clientHeight } = this.parent;
    const [width, height] = [Math.round(clientWidth * ratio), Math.round(clientHeight * ratio)];
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    Object.assign(this.canvas.style, { width: `${clientWidth}px`, height: `${clientHeight}px` });
  }

  draw() {
    if (this.canvas.hidden) return;
    const { gl, program } = this, paper = d3.rgb(css("paper")), start = performance.now();
    if (!this.target) this.fit();
    this.resize();
    if (this.stale) {
      const placed = chosen_team().cloud;
      if (this.placed !== placed) this.fill("points", placed.x, placed.y, placed.z, placed.t);
      this.placed = placed;
      this.colour("points", current_colours());
      this.build_lines();
      this.stale = false;
    }
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(paper.r / 255, paper.g / 255, paper.b / 255, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.useProgram(program);
    const at = name => gl.getUniformLocation(program, name);
    gl.uniformMatrix4fv(at("camera"), false, new Float32Array(this.camera().matrix));
    gl.uniform1f(at("size"), 0.06 * this.canvas.height * 1.6);
    const limit = value => (isFinite(value) ? value : far_away);
    const step = this.moving ? this.step : 1;
    if (state.layers.points) this.render("points", gl.POINTS, [limit(state.top) - this.centre[2], limit(state.until)], [0, 0], step);
    gl.disable(gl.DEPTH_TEST);
    for (const [dx, dy] of [[0, 0], [1, 0], [0, 1], [1, 1]])
      this.render("lines", gl.LINES, [far_away, limit(state.until)], [(2 * dx) / this.canvas.width, (2 * dy) / this.canvas.height]);
    if (this.moving) this.adapt(start);
  }

  /// Reading a pixel waits for what was drawn.
  adapt(start) {
    this.gl.readPixels(0, 0, 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, new Uint8Array(4));
    const took = performance.now() - start;
    if (took > slow_ms) this.step = Math.min(most_sparse, Math.ceil((this.step * took) / slow_ms));
    else if (took < quick_ms) this.step = Math.max(1, this.step - 1);
  }

  /// Every step-th vertex.
  render(name, kind, limits, shift, step = 1) {
    const { gl, program } = this, set = this.buffers[name];
    if (!set.count) return;
    const bind = (buffer, attribute, size, type, normalised, stride, offset) => {
      const place = gl.getAttribLocation(program, attribute);
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, type, normalised, stride, offset);
    };
    bind(set.vertices, "position", 3, gl.FLOAT, false, 16 * step, 0);
    bind(set.vertices, "time", 1, gl.FLOAT, false, 16 * step, 12);
    bind(set.colours, "colour", 4, gl.UNSIGNED_BYTE, true, 4 * step, 0);
    gl.uniform2fv(gl.getUniformLocation(program, "limits"), limits);
    gl.uniform2fv(gl.getUniformLocation(program, "shift"), shift);
    gl.drawArrays(kind, 0, Math.floor(set.count / step));
  }
}
