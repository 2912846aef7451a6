// The surface coloured by a layer: drag to turn, ctrl + wheel to zoom, double click to reset, click on
// a position for its presses.
(function () {
  const data = window.hapsimBody, stage = document.getElementById("stage");
  if (!data || !stage) return;
  const bytes = s => Uint8Array.from(atob(s), c => c.charCodeAt(0)).buffer;
  const q = new Uint16Array(bytes(data.vertices)), near = new Uint16Array(bytes(data.near));
  const face = new Uint32Array(bytes(data.faces));
  const size = data.size, at = (i, k) => (q[3 * i + k] / 65535 - 0.5) * size[k];
  for (const layer of data.layers) layer.level = new Uint16Array(bytes(layer.level));
  let half = 0, shown = 0, chosen = -1;
  for (let i = 0; i < near.length; ++i) half = Math.max(half, Math.hypot(at(i, 0), at(i, 1), at(i, 2)));

  // Normals smooth across small angles only, so that edges of the body stay edges.
  const count = face.length, normal = new Float32Array(face.length), used = new Map();
  for (let f = 0; f < count; f += 3) {
    const [a, b, c] = [face[f], face[f + 1], face[f + 2]];
    const u = [0, 1, 2].map(k => at(b, k) - at(a, k)), v = [0, 1, 2].map(k => at(c, k) - at(a, k));
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const l = Math.hypot(...n) || 1;
    for (let k = 0; k < 3; ++k) normal[f + k] = n[k] / l;
    for (const i of [a, b, c]) used.has(i) ? used.get(i).push(f) : used.set(i, [f]);
  }
  const corner = new Float32Array(count * 8);
  for (let i = 0; i < count; ++i) {
    const f = i - i % 3, n = [0, 0, 0], v = face[i];
    for (const g of used.get(v)) {
      const dot = normal[f] * normal[g] + normal[f + 1] * normal[g + 1] + normal[f + 2] * normal[g + 2];
      if (dot > 0.75) for (let k = 0; k < 3; ++k) n[k] += normal[g + k];
    }
    const l = Math.hypot(...n) || 1;
    corner.set([at(v, 0), at(v, 1), at(v, 2), n[0] / l, n[1] / l, n[2] / l, 0, 0], 8 * i);
  }
  function paint(layer) {
    if (!layer.level.length) return;  // coloured by the cells inside
    for (let i = 0; i < count; ++i) {
      corner[8 * i + 6] = layer.level[face[i]] / 65535;
      corner[8 * i + 7] = layer.local ? near[face[i]] / 65535 : 1;
    }
  }

  const canvas = stage.querySelector("canvas.surface"), over = stage.querySelector("canvas.marks");
  const gl = canvas.getContext("webgl2", { antialias: true, stencil: true, preserveDrawingBuffer: true });
  const pen = over.getContext("2d"), tip = document.getElementById("tip");
  const start = { yaw: -0.6, pitch: 0.62, zoom: 1 };
  let view = { ...start }, program;
  if (gl) {
    const shader = (kind, source) => { const s = gl.createShader(kind); gl.shaderSource(s, source); gl.compileShader(s); return s; };
    program = gl.createProgram();
    gl.attachShader(program, shader(gl.VERTEX_SHADER, `#version 300 es
      in vec3 place; in vec3 normal; in vec2 value;
      uniform mat3 turn; uniform vec3 scale; out vec3 n; out vec2 v; out vec3 at;
      void main() { at = place; vec3 p = turn * place; n = turn * normal; v = value; gl_Position = vec4(p.x * scale.x, p.y * scale.y, -p.z * scale.z, 1.0); }`));
    gl.attachShader(program, shader(gl.FRAGMENT_SHADER, `#version 300 es
      precision highp float; precision highp sampler3D; in vec3 n; in vec2 v; in vec3 at;
      uniform vec3 stops[6]; uniform vec3 unknown; uniform vec4 cut; uniform bool cap; uniform int channel; uniform float pixel;
      uniform sampler3D cells; uniform vec3 low; uniform vec3 extent; out vec4 colour;
      vec3 between(float share) { float x = clamp(share, 0.0, 1.0) * 5.0; int i = int(min(floor(x), 4.0)); return mix(stops[i], stops[i + 1], x - float(i)); }
      void main() {
        float edge = 0.5 - fwidth(v.y);
        if (!cap && dot(cut.xyz, at) > cut.w) discard;
        vec3 base = mix(unknown, between(v.x), smoothstep(edge, 1.0 - edge, v.y));
        if (channel >= 0) {
          vec4 cell = texture(cells, (at - low) / extent);
          int state = int(cell.b * 255.0 + 0.5) & 3;
          base = between(channel == 0 ? cell.r : cell.g);
          if (channel == 0 && state == 2) base = mix(vec3(0.965), base, 0.15);
          if (channel == 0 && state == 3) base = mod(gl_FragCoord.x + gl_FragCoord.y, 7.0 * pixel) < 2.0 * pixel ? vec3(0.47, 0.51, 0.55) : unknown + 0.12;
          if (state == 0) base = unknown;
        } else if (cap) base = unknown;
        vec3 m = normalize(n); float light = 0.74 + 0.26 * max(0.0, dot(m, normalize(vec3(-0.35, 0.55, 0.75))));
        colour = vec4(base * light, 1.0); }`));
    gl.linkProgram(program);
    gl.useProgram(program);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    [["place", 3, 0], ["normal", 3, 12], ["value", 2, 24]].forEach(([name, n, offset]) => {
      const where = gl.getAttribLocation(program, name);
      gl.enableVertexAttribArray(where);
      gl.vertexAttribPointer(where, n, gl.FLOAT, false, 32, offset);
    });
    gl.uniform3fv(gl.getUniformLocation(program, "unknown"), data.unknown.map(v => v / 255));
    gl.enable(gl.DEPTH_TEST);
  }
  const uniform = name => gl.getUniformLocation(program, name);

  // The image inside: its cells, and a plane that takes away the half of the body towards the reader.
  const inside = gl && data.ratioLayer >= 0 && window.hapsimInside, axis_of = document.getElementById("cut-axis"), cut_at = document.getElementById("cut-at");
  if (inside) {
    const [ratio, error, state] = [inside.ratio, inside.error, inside.state].map(s => new Uint8Array(bytes(s)));
    const cells = new Uint8Array(4 * state.length);
    for (let i = 0; i < state.length; ++i) cells.set([ratio[i], error[i], state[i], 255], 4 * i);
    gl.bindTexture(gl.TEXTURE_3D, gl.createTexture());
    gl.texImage3D(gl.TEXTURE_3D, 0, gl.RGBA8, ...inside.count, 0, gl.RGBA, gl.UNSIGNED_BYTE, cells);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_3D, filter, gl.NEAREST);
    for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) gl.texParameteri(gl.TEXTURE_3D, wrap, gl.CLAMP_TO_EDGE);
    gl.uniform3f(uniform("low"), ...inside.low.map((v, k) => v - data.middle[k]));
    gl.uniform3f(uniform("extent"), ...inside.count.map(n => n * inside.cell));
  }
  // Axis (-1: none), its side that is taken away, and where, from the middle of the body.
  function cut_of(r) {
    const axis = inside ? +axis_of.value : -1, side = axis >= 0 && r[2][axis] < 0 ? -1 : 1;
    return { axis, side, at: axis < 0 ? 0 : (cut_at.value / 200 - 0.5) * size[axis] };
  }
  const taken = (p, cut) => cut.axis >= 0 && cut.side * (p[cut.axis] - cut.at) > 0;
  // Of a closed surface, what lies behind its cut has more back faces than front faces before it.
  function draw_cap(cut) {
    const [a, b] = [0, 1, 2].filter(k => k !== cut.axis), quad = new Float32Array(6 * 8);
    [[-1, -1], [1, -1], [1, 1], [-1, -1], [1, 1], [-1, 1]].forEach(([u, v], i) => {
      quad[8 * i + a] = 0.51 * u * size[a]; quad[8 * i + b] = 0.51 * v * size[b]; quad[8 * i + cut.axis] = cut.at;
      quad[8 * i + 3 + cut.axis] = cut.side; quad[8 * i + 7] = 1;
    });
    gl.bufferData(gl.ARRAY_BUFFER, quad, gl.STREAM_DRAW);
    gl.uniform1i(uniform("cap"), 1);
    gl.drawArrays(gl.TRIANGLES, 0, 6);
    gl.uniform1i(uniform("cap"), 0);
    gl.bufferData(gl.ARRAY_BUFFER, corner, gl.STATIC_DRAW);
  }
  function draw_body(cut) {
    const n = [0, 1, 2].map(k => k === cut.axis ? cut.side : 0);
    gl.uniform4f(uniform("cut"), ...n, cut.axis < 0 ? 1e9 : cut.side * cut.at);
    gl.uniform1i(uniform("channel"), inside ? shown === data.ratioLayer ? 0 : shown === data.errorLayer ? 1 : -1 : -1);
    gl.uniform1f(uniform("pixel"), window.devicePixelRatio || 1);
    if (cut.axis < 0) { gl.drawArrays(gl.TRIANGLES, 0, count); return; }
    gl.enable(gl.STENCIL_TEST); gl.disable(gl.DEPTH_TEST); gl.colorMask(false, false, false, false);
    gl.stencilFunc(gl.ALWAYS, 0, 255);
    gl.stencilOpSeparate(gl.FRONT, gl.KEEP, gl.KEEP, gl.DECR_WRAP); gl.stencilOpSeparate(gl.BACK, gl.KEEP, gl.KEEP, gl.INCR_WRAP);
    gl.drawArrays(gl.TRIANGLES, 0, count);
    gl.colorMask(true, true, true, true); gl.enable(gl.DEPTH_TEST); gl.stencilOp(gl.KEEP, gl.KEEP, gl.KEEP);
    gl.drawArrays(gl.TRIANGLES, 0, count);
    gl.stencilFunc(gl.NOTEQUAL, 0, 255);
    draw_cap(cut);
    gl.disable(gl.STENCIL_TEST);
  }

  // Rows of the rotation: right, up, towards the viewer. z of the body stays upright.
  function axes() {
    const c = Math.cos(view.yaw), s = Math.sin(view.yaw), a = Math.cos(view.pitch), b = Math.sin(view.pitch);
    return [[c, -s, 0], [b * s, b * c, a], [-a * s, -a * c, b]];
  }
  const project = (p, r) => r.map(row => row[0] * p[0] + row[1] * p[1] + row[2] * p[2]);
  let marks = [];

  function show(k) {
    const layer = data.layers[shown = k];
    paint(layer);
    if (gl) {
      gl.bufferData(gl.ARRAY_BUFFER, corner, gl.STATIC_DRAW);
      gl.uniform3fv(gl.getUniformLocation(program, "stops"), layer.stops.flat().map(v => v / 255));
    }
    document.getElementById("layernote").textContent = layer.note;
    document.querySelectorAll("#layers button").forEach((b, i) => { b.classList.toggle("on", i === k); b.setAttribute("aria-pressed", i === k); });
    document.querySelectorAll("#bars svg").forEach((bar, i) => bar.toggleAttribute("hidden", i !== k));
    draw();
  }

  function draw() {
    const ratio = window.devicePixelRatio || 1, w = stage.clientWidth, h = stage.clientHeight;
    for (const c of [canvas, over]) { c.width = w * ratio; c.height = h * ratio; }
    const unit = 0.47 * Math.min(w, h) / half * view.zoom, r = axes(), cut = cut_of(r);
    if (gl) {
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.clearColor(0.957, 0.965, 0.973, 1);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
      const turn = [0, 1, 2].flatMap(k => [r[0][k], r[1][k], r[2][k]]);
      gl.uniformMatrix3fv(gl.getUniformLocation(program, "turn"), false, turn);
      gl.uniform3f(gl.getUniformLocation(program, "scale"), 2 * unit / w, 2 * unit / h, 0.9 / half);
      draw_body(cut);
    }
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, w, h);
    marks = [];
    data.positions.forEach((p, i) => {
      if (gl && project(p.normal, r)[2] < 0.02 || taken(p.at, cut)) return;
      const v = project(p.at, r), x = w / 2 + v[0] * unit, y = h / 2 - v[1] * unit;
      marks.push({ x, y, p, i });
      pen.beginPath();
      pen.arc(x, y, p.rank <= 3 ? 7 : 5, 0, 7);
      pen.fillStyle = p.colours[shown]; pen.fill();
      pen.lineWidth = 3; pen.strokeStyle = "#fff"; pen.stroke();
      pen.lineWidth = 1.5; pen.strokeStyle = "#1b2733"; pen.stroke();
      if (i === chosen) {
        pen.beginPath(); pen.arc(x, y, 12, 0, 7); pen.lineWidth = 2; pen.strokeStyle = "#1b2733"; pen.stroke();
      }
      if (p.rank <= 3) {
        pen.font = "600 13px sans-serif"; pen.lineWidth = 3.5; pen.strokeStyle = "#fff"; pen.fillStyle = "#1b2733";
        pen.strokeText(p.rank, x + 9, y - 7); pen.fillText(p.rank, x + 9, y - 7);
      }
    });
    // Directions of the axes, lower left.
    pen.font = "11px sans-serif";
    ["x", "y", "z"].forEach((name, k) => {
      const dx = 30 * r[0][k], dy = -30 * r[1][k];
      pen.strokeStyle = pen.fillStyle = "#5b6876"; pen.lineWidth = 1.2;
      pen.beginPath(); pen.moveTo(46, h - 46); pen.lineTo(46 + dx, h - 46 + dy); pen.stroke();
      pen.fillText(name, 43 + 1.3 * dx, h - 42 + 1.3 * dy);
    });
    const span = [1, 2, 5, 10, 20, 50, 100, 200, 500].map(v => v / 1000).filter(v => v * unit < w / 5).pop();
    if (span) {
      pen.beginPath(); pen.moveTo(w - 20 - span * unit, h - 22); pen.lineTo(w - 20, h - 22); pen.stroke();
      pen.textAlign = "right"; pen.fillText((span * 1000) + " mm", w - 20, h - 28); pen.textAlign = "left";
    }
  }
  const hit_at = e => {
    const box = stage.getBoundingClientRect(), x = e.clientX - box.left, y = e.clientY - box.top;
    return marks.find(m => Math.hypot(m.x - x, m.y - y) < 9);
  };
  let drag = null, turned = 0;
  stage.onpointerdown = e => { drag = [e.clientX, e.clientY]; turned = 0; stage.setPointerCapture(e.pointerId); };
  stage.onpointercancel = () => { drag = null; };
  stage.onpointerup = e => {
    const hit = drag && turned < 4 && hit_at(e);
    drag = null;
    if (hit) window.dispatchEvent(new CustomEvent("hapsim-position", { detail: hit.i }));
  };
  window.addEventListener("hapsim-press", e => { chosen = e.detail; draw(); });
  stage.onpointermove = e => {
    if (drag) {
      view.yaw += (e.clientX - drag[0]) * 0.008;
      view.pitch = Math.max(-1.57, Math.min(1.57, view.pitch + (e.clientY - drag[1]) * 0.008));
      turned += Math.hypot(e.clientX - drag[0], e.clientY - drag[1]);
      drag = [e.clientX, e.clientY];
      draw();
      return;
    }
    const hit = hit_at(e);
    tip.textContent = hit ? hit.p.label : "Drag to turn, ctrl + wheel to zoom, double click to reset; or arrow keys, + and -.";
  };
  stage.addEventListener("wheel", e => {
    if (!e.ctrlKey) return;
    e.preventDefault();
    view.zoom = Math.max(0.4, Math.min(12, view.zoom * Math.exp(-e.deltaY * 0.002)));
    draw();
  }, { passive: false });
  stage.ondblclick = () => { view = { ...start }; draw(); };
  const turns = { ArrowLeft: ["yaw", -0.15], ArrowRight: ["yaw", 0.15], ArrowUp: ["pitch", -0.15], ArrowDown: ["pitch", 0.15] };
  stage.addEventListener("keydown", e => {
    if (turns[e.key]) view[turns[e.key][0]] += turns[e.key][1];
    else if (e.key === "+" || e.key === "-") view.zoom *= e.key === "+" ? 1.2 : 1 / 1.2;
    else if (e.key === "Home") view = { ...start };
    else if (e.key === "n" || e.key === "N") {
      const next = (chosen + 1) % data.positions.length;
      tip.textContent = data.positions[next].label;
      window.dispatchEvent(new CustomEvent("hapsim-position", { detail: next }));
    } else return;
    e.preventDefault();
    view.pitch = Math.max(-1.57, Math.min(1.57, view.pitch));
    view.zoom = Math.max(0.4, Math.min(12, view.zoom));
    draw();
  });
  window.addEventListener("resize", draw);
  if (inside) {
    const cut = () => {
      const axis = +axis_of.value;
      document.getElementById("cut-out").textContent = axis < 0 ? "" : "xyz"[axis] + " = " + (1000 * (data.middle[axis] + cut_of(axes()).at)).toFixed(1) + " mm";
      if (axis >= 0 && shown !== data.ratioLayer && shown !== data.errorLayer) show(data.ratioLayer); else draw();
    };
    axis_of.onchange = cut;
    cut_at.oninput = () => { if (axis_of.value === "-1") axis_of.value = "1"; cut(); };
  }
  if (!gl) tip.textContent = "This browser has no WebGL 2: only the pressed positions are shown.";
  document.querySelectorAll("#layers button").forEach((b, k) => { b.onclick = () => show(k); });
  show(0);
})();
