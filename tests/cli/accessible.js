// What keeps a page from those who do not see, point or see colours well, by the rules of WCAG 2.1 AA that a
// program can tell; Debian has no package of such checks. One sentence each.
function hapsimBarriers() {
  const found = [];
  const all = selector => [...document.querySelectorAll(selector)].filter(e => !e.closest("[hidden], [aria-hidden=true]"));
  const say = (what, e) => found.push(what + ": " + (e.outerHTML || "").replace(/\s+/g, " ").slice(0, 70));
  const referred = ids => ids.split(/\s+/).map(id => document.getElementById(id));
  const name = e => {
    const by = e.getAttribute("aria-labelledby");
    if (by) return referred(by).map(r => r ? r.textContent : "").join(" ").trim();
    return (e.getAttribute("aria-label") || "").trim() || (e.labels && [...e.labels].map(l => l.textContent).join(" ").trim()) ||
      (e.getAttribute("alt") || "").trim() || (["INPUT", "SELECT"].includes(e.tagName) ? "" : e.textContent.trim()) || (e.getAttribute("title") || "").trim();
  };
  if (!document.documentElement.lang) found.push("the page has no language");
  if (!document.title.trim()) found.push("the page has no title");
  if (all("h1").length !== 1) found.push("there are " + all("h1").length + " h1");
  let level = 0;
  for (const h of all("h1, h2, h3, h4, h5, h6")) {
    const own = +h.tagName[1];
    if (own > level + 1) say("a heading leaves out a level", h);
    if (!h.textContent.trim()) say("a heading is empty", h);
    level = own;
  }
  const view = document.querySelector("meta[name=viewport]");
  if (!view || /user-scalable\s*=\s*no|maximum-scale/.test(view.content)) found.push("the page cannot be zoomed, or has no viewport");
  if (!document.querySelector("main")) found.push("there is no main part");
  for (const e of all("img, canvas, svg, button, a[href], input, select, textarea, summary, [role=button], [role=img], [role=application]")) {
    // A canvas or drawing may be named by what it is in.
    if (e.closest("[role=application], [role=img], button, a") !== e && e.closest("[role=application][aria-label], [role=img][aria-label], button, a")) continue;
    if (!name(e)) say("no name", e);
  }
  const interactive = all("button, a[href], input, select, textarea, summary, [role=button], [role=application]");
  for (const e of interactive) if (e.tabIndex < 0) say("not reached by Tab", e);
  for (const e of all("[tabindex]")) if (e.tabIndex > 0) say("jumps the order of Tab", e);
  for (const e of all("*")) {
    const style = getComputedStyle(e);
    if ((style.overflowX === "auto" || style.overflowX === "scroll") && e.scrollWidth > e.clientWidth + 1 && e.tabIndex < 0 && !e.querySelector("a, button"))
      say("scrolls, and not by keys", e);
  }
  const ids = new Set();
  for (const e of document.querySelectorAll("[id]")) ids.has(e.id) ? say("an id is given twice", e) : ids.add(e.id);
  for (const attribute of ["for", "aria-labelledby", "aria-describedby", "aria-controls"])
    for (const e of document.querySelectorAll("[" + attribute + "]"))
      if (referred(e.getAttribute(attribute)).some(r => !r)) say(attribute + " names what is not there", e);
  for (const e of all("th")) if (!e.textContent.trim()) say("a head of a table is empty", e);
  for (const e of all("table")) if (!e.querySelector("th")) say("a table has no heads", e);
  for (const e of all("ul > :not(li), ol > :not(li)")) say("in a list, and no item of it", e);
  // Contrast of text against the nearest background: 4.5, or 3 where it is large.
  const light = colour => colour.slice(0, 3).map(v => v / 255).map(v => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
    .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
  const rgb = text => text.match(/[\d.]+/g).map(Number);
  const behind = e => { for (; e; e = e.parentElement) { const c = rgb(getComputedStyle(e).backgroundColor); if (c.length < 4 || c[3] > 0) return c; } return [255, 255, 255]; };
  for (const e of all("body *")) {
    if (e.closest("script, style") || ![...e.childNodes].some(n => n.nodeType === 3 && n.textContent.trim())) continue;
    const style = getComputedStyle(e), ink = e.closest("svg") ? style.fill : style.color;
    if (!ink.startsWith("rgb")) continue;
    const a = light(rgb(ink)), b = light(behind(e)), ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    const size = parseFloat(style.fontSize), large = size >= 24 || (size >= 18.66 && +style.fontWeight >= 700);
    if (ratio < (large ? 3 : 4.5)) say("contrast " + ratio.toFixed(1), e);
  }
  for (const e of interactive.slice(0, 40)) {
    e.focus({ preventScroll: true });
    if (document.activeElement !== e) say("takes no focus", e);
  }
  if (document.activeElement) document.activeElement.blur();
  return found;
}
