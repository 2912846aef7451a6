// Cuts through the image of the stiffness: a canvas each for the ratio and for its standard error.
(function () {
  const data = window.hapsimInside;
  if (!data || !document.getElementById("inside")) return;
  const bytes = s => Uint8Array.from(atob(s), c => c.charCodeAt(0));
  const [ratio, error, state, resolution] = [data.ratio, data.error, data.state, data.resolution].map(bytes);
  const [nx, ny] = data.count, axis = ["x", "y", "z"];
  const index = p => (p[2] * ny + p[1]) * nx + p[0];
  const mm = (k, cell) => 1000 * (data.low[k] + cell * data.cell);
  const inside = i => state[i] > 0 && state[i] < 4;
  const mix = (stops, share) => {
    const x = Math.min(1, Math.max(0, share)) * 5, i = Math.min(4, Math.floor(x));
    return stops[i].map((v, k) => v + (stops[i + 1][k] - v) * (x - i));
  };
  // Nothing may look sure that is not: pale where 1 lies within the 95 %, hatched where all is open.
  function colour(which, i, x, y) {
    if (which === "error") return mix(data.errorStops, error[i] / 255);
    if (state[i] === 3) return (x + y) % 7 < 2 ? [120, 130, 140] : data.unknown.map(v => v + 30);
    const c = mix(data.ratioStops, ratio[i] / 255);
    return state[i] === 2 ? c.map(v => 246 + 0.15 * (v - 246)) : c;
  }
  const factor = v => v < 0.1 ? v.toFixed(3) : v < 10 ? v.toFixed(2) : v.toFixed(1);
  function told(i) {
    const log = (ratio[i] / 255 * 2 - 1) * data.top, std = error[i] / 255 * data.most / 100, half = data.half95 * std;
    const least = error[i] === 255 ? " or more" : "";
    if (state[i] === 3) return `not resolved: half and double both lie within the 95 %, standard error ${Math.round(100 * std)} %${least}`;
    return `× ${factor(Math.exp(log))} the model's, 95 % × ${factor(Math.exp(log - half))} to × ${factor(Math.exp(log + half))}` +
      `; standard error ${Math.round(100 * std)} %${least}; an average over ${resolution[i]} mm about it`;
  }

  const left = 40, below = 34, top = 8, right = 10;
  function cut(id, across_of) {
    const slider = document.getElementById(id + "-at"), out = document.getElementById(id + "-out");
    const drawings = ["ratio", "error"].map(which => [which, document.getElementById(id + "-" + which)]);
    const across = () => across_of();
    const plane = () => { const a = across(); return a === 2 ? [0, 1] : [a === 0 ? 1 : 0, 2]; };
    const cell = (u, v) => { const p = [0, 0, 0], [a, b] = plane(); p[a] = u; p[b] = v; p[across()] = +slider.value; return index(p); };
    let unit = 1, high = 0;  // pixels a cell, height of the drawing
    function draw() {
      const a = across(), [u, v] = plane(), pixel = window.devicePixelRatio || 1, at = mm(a, +slider.value + 0.5);
      const surface = 1000 * data.above;
      out.textContent = `${axis[a]} = ${at.toFixed(1)} mm` + (a === 2 ? `, ${(surface - at).toFixed(1)} mm below the top` : "");
      for (const [which, canvas] of drawings) {
        const room = canvas.parentElement.clientWidth - left - right;
        unit = Math.max(1, Math.min(room / data.count[u], 300 / data.count[v]));
        const w = Math.round(unit * data.count[u]), h = Math.round(unit * data.count[v]);
        high = h;
        canvas.style.width = w + left + right + "px"; canvas.style.height = h + top + below + "px";
        canvas.width = (w + left + right) * pixel; canvas.height = (h + top + below) * pixel;
        const pen = canvas.getContext("2d"), W = Math.round(w * pixel), H = Math.round(h * pixel), image = pen.createImageData(W, H);
        for (let y = 0; y < H; ++y)
          for (let x = 0; x < W; ++x) {
            const i = cell(Math.floor(x / W * data.count[u]), Math.floor((H - 1 - y) / H * data.count[v]));
            if (!inside(i)) continue;
            image.data.set([...colour(which, i, Math.floor(x / pixel), Math.floor(y / pixel)), 255], 4 * (y * W + x));
          }
        pen.putImageData(image, Math.round(left * pixel), Math.round(top * pixel));
        pen.setTransform(pixel, 0, 0, pixel, 0, 0);
        const px = value => left + (value / 1000 - data.low[u]) / data.cell * unit, py = value => top + h - (value / 1000 - data.low[v]) / data.cell * unit;
        pen.strokeStyle = "#8794a1"; pen.fillStyle = "#46525f"; pen.font = "11px sans-serif"; pen.lineWidth = 1;
        pen.strokeRect(left + 0.5, top + 0.5, w, h);
        const ticks = k => {
          const from = mm(k, 0), to = mm(k, data.count[k]), step = [1, 2, 5, 10, 20, 50, 100, 200].find(s => (to - from) / s <= 6) || 500, all = [];
          for (let t = Math.ceil(from / step) * step; t <= to + 1e-6; t += step) all.push(t);
          return all;
        };
        pen.textAlign = "center";
        for (const t of ticks(u)) { pen.beginPath(); pen.moveTo(px(t), top + h); pen.lineTo(px(t), top + h + 4); pen.stroke(); pen.fillText(t, px(t), top + h + 15); }
        pen.fillText(axis[u] + " [mm]", left + w / 2, top + h + 29);
        pen.textAlign = "right";
        for (const t of ticks(v)) { pen.beginPath(); pen.moveTo(left - 4, py(t)); pen.lineTo(left, py(t)); pen.stroke(); pen.fillText(t, left - 6, py(t) + 4); }
        pen.save(); pen.translate(11, top + h / 2); pen.rotate(-Math.PI / 2); pen.textAlign = "center"; pen.fillText(axis[v] + " [mm]", 0, 0); pen.restore();
        // Presses: all of them seen from above, upright those within three cells of the cut.
        for (const p of data.presses) {
          if (a !== 2 && Math.abs(1000 * p[a] - at) > 3000 * data.cell) continue;
          pen.beginPath(); pen.arc(px(1000 * p[u]), py(1000 * p[v]), 3.5, 0, 7);
          pen.lineWidth = 3; pen.strokeStyle = "#fff"; pen.stroke(); pen.lineWidth = 1.4; pen.strokeStyle = "#1b2733"; pen.stroke();
        }
      }
    }
    for (const [, canvas] of drawings)
      canvas.onpointermove = e => {
        const [u, v] = plane(), p = [0, 0, 0], x = Math.floor((e.offsetX - left) / unit), y = Math.floor((top + high - e.offsetY) / unit);
        if (x < 0 || y < 0 || x >= data.count[u] || y >= data.count[v]) return;
        p[u] = x; p[v] = y; p[across()] = +slider.value;
        const where = p.map((c, k) => mm(k, c + 0.5).toFixed(1)).join(", ");
        document.getElementById("inside-readout").textContent = inside(cell(x, y)) ? `(${where}) mm: ${told(cell(x, y))}` : `(${where}) mm: outside the body`;
      };
    slider.oninput = draw;
    window.addEventListener("resize", draw);
    return function begin(where) { slider.max = data.count[across()] - 1; slider.value = where; draw(); };
  }
  // Where most is told that differs, by how much over how open it is; else the middle of what is resolved.
  let best = -1, start = data.count.map(n => Math.floor(n / 2));
  for (let k = 0; k < data.count[2]; ++k)
    for (let j = 0; j < ny; ++j)
      for (let i = 0; i < nx; ++i) {
        const at = index([i, j, k]), size = Math.abs(ratio[at] / 127.5 - 1) / (1 + error[at]);
        if (state[at] === 1 && size > best) { best = size; start = [i, j, k]; }
      }
  if (best < 0) start[2] = Math.max(0, Math.floor(0.8 * data.count[2]));
  const chosen = document.getElementById("upright-across");
  const flat = cut("flat", () => 2), upright = cut("upright", () => +chosen.value);
  chosen.onchange = () => upright(start[+chosen.value]);
  flat(start[2]); upright(start[1]);
})();
