// The chosen press: three components and the residual, measured against simulated.
(function () {
  const data = window.hapsimPresses, host = document.getElementById("press");
  if (!data || !host) return;
  const pick = document.getElementById("pick"), readout = document.getElementById("readout");
  const W = 1120, left = 58, right = 12, NS = "http://www.w3.org/2000/svg";
  const make = (name, attributes, parent, text) => {
    const e = document.createElementNS(NS, name);
    for (const k in attributes) e.setAttribute(k, attributes[k]);
    if (text !== undefined) e.textContent = text;
    if (parent) parent.appendChild(e);
    return e;
  };
  const ticks = (lo, hi, n) => {
    const raw = (hi - lo) / n, p = Math.pow(10, Math.floor(Math.log10(raw))), r = raw / p;
    const step = p * (r <= 1.5 ? 1 : r <= 3.5 ? 2 : r <= 7.5 ? 5 : 10), out = [];
    for (let k = Math.ceil(lo / step - 1e-9); k * step <= hi + 1e-9 * step; ++k) out.push(k * step);
    return { out, step, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
  };
  const text = (v, digits) => (Math.abs(v) < 1e-12 ? 0 : v).toFixed(digits).replace("-", "\u2212");
  let t, panels, svg, cursor;

  function panel(top, height, label, curves) {
    let lo = 0, hi = 0;
    for (const c of curves) for (const v of c.y) { lo = Math.min(lo, v); hi = Math.max(hi, v); }
    if (hi === lo) hi = lo + 1;
    const s = ticks(lo, hi, Math.max(2, height / 34));
    const air = 0.04 * (hi - lo);
    if (lo) lo -= air;
    if (hi) hi += air;
    const X = v => left + (v - t[0]) / (t[t.length - 1] - t[0] || 1) * (W - left - right);
    const Y = v => top + height - (v - lo) / (hi - lo) * height;
    for (const v of ticks(lo, hi, Math.max(2, height / 34)).out) {
      make("path", { d: `M${left} ${Y(v)}H${W - right}`, class: Math.abs(v) < 1e-9 * (hi - lo) ? "zero" : "grid" }, svg);
      make("text", { x: left - 6, y: Y(v) + 4, "text-anchor": "end" }, svg, text(v, s.digits));
    }
    make("text", { transform: `translate(11 ${top + height / 2}) rotate(-90)`, "text-anchor": "middle", class: "name" }, svg, label);
    for (const c of curves) {
      let d = "";
      for (let i = 0; i < t.length; ++i) d += (i ? "L" : "M") + X(t[i]).toFixed(1) + " " + Y(c.y[i]).toFixed(1);
      make("path", { d, fill: "none", stroke: c.colour, "stroke-width": c.width, "stroke-linejoin": "round" }, svg);
    }
    return X;
  }

  function draw() {
    const p = data.presses[pick.value], unit = data.unit, n = p.s.length;
    t = p.t;
    host.textContent = "";
    svg = make("svg", { viewBox: `0 0 ${W} 600`, class: "plot", width: W, height: 600, role: "img", "aria-label": "the chosen press: " + pick.selectedOptions[0].textContent }, host);
    const real = list => list.map(v => v * unit);
    panels = [];
    let X, top = 8;
    ["fx", "fy", "fz"].forEach((name, k) => {
      const curves = [{ name: "measured", colour: "#1b2733", width: 1.8, y: real(p.m[k]) }];
      for (let v = 0; v < n; ++v)
        curves.push({ name: data.names[v], colour: data.colours[v], width: v === n - 1 ? 1.8 : 1.2, y: real(p.s[v][k]) });
      X = panel(top, 118, name + " [N]", curves);
      panels.push({ name, curves });
      top += 142;
    });
    const last = n - 1;
    const residual = [0, 1, 2].map(k => ({ colour: ["#0072b2", "#009e73", "#d55e00"][k], width: 1.2, y: p.m[k].map((v, i) => (v - p.s[last][k][i]) * unit) }));
    panel(top, 118, "residual [N]", residual);
    ["x", "y", "z"].forEach((name, k) => make("text", { x: W - right - 54 + 20 * k, y: top + 12, style: `fill:${["#005a8c", "#00664a", "#a34700"][k]};font-weight:600` }, svg, name));
    const s = ticks(t[0], t[t.length - 1] || 1, 12);
    for (const v of s.out) {
      make("path", { d: `M${X(v)} ${top + 118}v4`, class: "axis" }, svg);
      make("text", { x: X(v), y: top + 134, "text-anchor": "middle" }, svg, text(v, s.digits));
    }
    make("text", { x: (left + W - right) / 2, y: top + 154, "text-anchor": "middle", class: "name" }, svg, data.time);
    cursor = make("path", { stroke: "#5b6876", "stroke-dasharray": "3 3", fill: "none" }, svg);
    readout.textContent = "Move the pointer over the plot to read values.";
    svg.onmousemove = event => {
      const box = svg.getBoundingClientRect(), x = (event.clientX - box.left) * W / box.width;
      let best = 0;
      for (let i = 1; i < t.length; ++i) if (Math.abs(X(t[i]) - x) < Math.abs(X(t[best]) - x)) best = i;
      cursor.setAttribute("d", `M${X(t[best])} 8V${top + 118}`);
      readout.textContent = data.time.replace(/ \[.*/, "") + " " + t[best].toFixed(3) + ":  " +
        panels.map(q => q.name + "  " + q.curves.map(c => c.name + " " + text(c.y[best], 3) + " N").join(", ")).join("   |   ");
    };
  }
  // Another press, of the plots, the list, or the position that was clicked on the body.
  const choose = index => {
    pick.value = String(index);
    draw();
    window.dispatchEvent(new CustomEvent("hapsim-press", { detail: data.presses[index].p }));
  };
  const reveal = () => host.parentElement.querySelector(".picker").scrollIntoView({ block: "nearest" });
  document.querySelectorAll("figure[data-press]").forEach(f => {
    f.onclick = () => { choose(Number(f.dataset.press)); reveal(); };
  });
  window.addEventListener("hapsim-position", e => {
    const there = data.presses.map((p, i) => i).filter(i => data.presses[i].p === e.detail);
    if (there.length === 0) return;
    choose(there[(there.indexOf(Number(pick.value)) + 1) % there.length]);
    reveal();
  });
  const step = by => choose((pick.selectedIndex + by + pick.length) % pick.length);
  pick.onchange = () => choose(pick.selectedIndex);
  document.getElementById("before").onclick = () => step(-1);
  document.getElementById("after").onclick = () => step(1);
  draw();
})();
