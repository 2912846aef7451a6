#!/usr/bin/env bash
# report.sh BIN: the report in a browser, as wide as a desk's screen and a phone's: it draws, a click or a key on
# a press or a position changes the plots, a button changes the colours, everything has a name and can be read,
# the first screen holds the verdict, the versions, the next command, a curve and the body, and the console stays
# silent.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || need chromium

cat >model.csv <<'END'
effect,region,parameter,value,unit,std_error,lower,upper,state
elastic,0,E,20000,Pa,150,100,1e9,free
elastic,1,E,30000,Pa,250,100,1e9,free
elastic,0,nu,0.4,1,0.01,0,0.499,free
regions,0,local,1,1,,0,1,fixed
regions,0,x1,0.01,m,,-10,10,fixed
regions,0,y1,0.025,m,,-10,10,fixed
regions,1,x1,0.05,m,,-10,10,fixed
regions,1,y1,0.025,m,,-10,10,fixed
END
recording() { # GAIN
  awk -v gain="$1" 'BEGIN {
    print "# force_noise: 0.005"; print "# tool_radius: 0.004"
    print "press,t,x,y,z,ux,uy,uz,fx,fy,fz"
    for (p = 0; p < 12; ++p)
      for (i = 0; i <= 20; ++i) {
        d = 0.004 * i / 20; wobble = 0.005 * (((i * 7 + p * 3) % 5) - 2) / 1.4
        printf "%d,%.2f,%.3f,%.2f,0.04,0,0,%.6f,%.5f,0,%.5f\n", p, 10 * p + 0.02 * i,
               0.015 * (1 + p % 3), 0.015 + 0.02 * int(p % 6 / 3), -d, wobble,
               (p % 3 == 1 ? gain : 1) * 200 * d + wobble
      }
  }'
}
recording 1 >data.csv
recording 1.2 >simulated.csv
recording 2 >first.csv
cat >history.csv <<'END'
step,model,effects,parameters,rmse,heldout,noise,force_rms
0,m.csv: elastic,elastic,2,0.2,0.21,0.005,0.4
1,m.csv,elastic+regions,3,0.05,0.06,0.005,0.4
END
cat >effects.csv <<'END'
rank,effect,verdict,rmse_now,rmse_after,heldout_now,heldout_after,p_value,confused_with,where,evidence,next_measurement,command
0,model,incomplete,0.05,0.01,0.06,0.01,,,,missing: friction.,,
1,friction,missing,0.05,0.01,0.06,0.01,0.001,,sideways,most of it,press sideways,hs-identify data.csv --body body.ply --model model.csv --add friction -o better.csv
END
"$bin/hs-tetmesh" box.off -q -o body.ply 2>err || complain 'no body'
"$bin/hs-compare" data.csv --simulated first=first.csv --simulated now=simulated.csv --body body.ply --model model.csv -q \
  --history history.csv --diagnosis effects.csv --html report.html --figures figure- -o residuals.csv 2>err || complain 'no report'
[[ $(ls figure-*.svg | wc -l) -ge 8 ]] || complain "figures: $(ls figure-*)"
[[ $(stat -c %s report.html) -lt 5000000 ]] || complain 'the report is larger than 5 MB'

# What a reader does, and what is to be seen then, written into the page as text.
cat >probe.js <<'END'
window.hapsimErrors = [];
window.addEventListener("error", e => window.hapsimErrors.push(e.message));
window.addEventListener("load", () => setTimeout(() => {
  const lines = [], say = (name, value) => lines.push("probe " + name + "=" + value);
  const curve = () => [...document.querySelectorAll("#press path")].map(p => p.getAttribute("d")).join("");
  const pixels = () => document.querySelector("canvas.surface").toDataURL();
  const pick = document.getElementById("pick"), before = curve();
  say("curves", before.length > 100);
  const figures = [...document.querySelectorAll("figure[data-press]")];
  const other = figures.find(f => f.dataset.press !== pick.value);
  other.click();
  say("figure", pick.value === other.dataset.press && curve() !== before);
  const at = index => window.hapsimPresses.presses[index].p;
  const elsewhere = [0, 1, 2, 3, 4, 5].find(p => p !== at(pick.value));
  window.dispatchEvent(new CustomEvent("hapsim-position", { detail: elsewhere }));
  say("position", at(pick.value) === elsewhere);
  const buttons = [...document.querySelectorAll("#layers button")];
  say("layers", buttons.map(b => b.textContent).join("+"));
  const drawn = buttons.map(b => { b.click(); return pixels(); });
  say("colours", new Set(drawn).size);
  say("bars", [...document.querySelectorAll("#bars svg")].filter(b => !b.hasAttribute("hidden")).length);
  const stage = document.getElementById("stage"), was = pixels();
  const pointer = (type, x, y) => stage.dispatchEvent(new PointerEvent(type, { clientX: x, clientY: y, pointerId: 1 }));
  stage.setPointerCapture = () => {};
  pointer("pointerdown", 300, 300); pointer("pointermove", 360, 320); pointer("pointerup", 360, 320);
  say("turned", pixels() !== was);
  const key = (type, name) => document.getElementById(type).dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true }));
  const before_keys = pixels();
  key("stage", "ArrowLeft"); key("stage", "+");
  say("keys", pixels() !== before_keys);
  const last = figures[figures.length - 1];
  last.querySelector("button").click();
  say("all of it", pick.value === last.dataset.press);
  document.getElementById("copy").click();
  scrollTo(0, 0);
  say("named", [...document.querySelectorAll("svg[role=img], button, select, [role=button], [role=application]")].filter(e =>
    !(e.getAttribute("aria-label") || e.textContent.trim() || (e.labels && e.labels.length))).length);
  say("heads", [...document.querySelectorAll("th")].filter(h => !h.textContent.trim()).length);
  say("reach", [...document.querySelectorAll(".scroll, #stage")].filter(e => e.tabIndex < 0).length);
  // Contrast of text by WCAG 2, against the nearest background.
  const light = colour => colour.map(v => v / 255).map(v => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
    .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
  const rgb = text => text.match(/[\d.]+/g).map(Number);
  const behind = e => { for (; e; e = e.parentElement) { const c = rgb(getComputedStyle(e).backgroundColor); if (c.length < 4 || c[3] > 0) return c; } return [255, 255, 255]; };
  const faint = [...document.querySelectorAll("body *")].filter(e => [...e.childNodes].some(n => n.nodeType === 3 && n.textContent.trim()) && !e.closest("script, style, pre#probe")).filter(e => {
    const style = getComputedStyle(e), ink = e.closest("svg") ? style.fill : style.color;
    if (!ink.startsWith("rgb")) return false;
    const a = light(rgb(ink)), b = light(behind(e));
    return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05) < 4.5;
  });
  say("faint", faint.length + (faint.length ? " " + faint[0].tagName + " " + faint[0].textContent.slice(0, 40) : ""));
  say("width", document.documentElement.scrollWidth <= innerWidth);
  say("inner", innerWidth);
  const seen = selector => { const e = document.querySelector(selector), box = e && e.getBoundingClientRect(); return box && box.top < innerHeight && box.height > 20 ? Math.round(box.bottom) : "no"; };
  say("screen", [".verdict", ".strip", ".next", ".first figure", "#stage"].map(seen).every(b => b !== "no" && b <= innerHeight));
  say("bottoms", [".verdict", ".strip", ".next", ".first figure", "#stage"].map(seen).join(" "));
  say("errors", window.hapsimErrors.join(";"));
  const out = document.createElement("pre");
  out.textContent = lines.join("\n");
  parent.document.body.appendChild(out);
}, 100));
END
awk 'NR == FNR { script = script $0 "\n"; next }
     { at = index($0, "<head>"); if (at) { print substr($0, 1, at + 5); printf "<script>%s</script>\n", script; print substr($0, at + 6) } else print }' \
  probe.js report.html >probed.html
seen() { # NAME VALUE
  grep -q "probe $1=$2\$" dom.html || grep -q "probe $1=$2<" dom.html ||
    complain "$width px: $1 is not $2: $(grep -o "probe $1=[^<]*" dom.html)"
}
# A desk and a phone: in a frame of that size, for the browser's own window has a least width.
sed 's/&/\&amp;/g; s/"/\&quot;/g' probed.html >escaped
for size in 1280x800 390x844; do
  width=${size%x*}
  { printf '<!DOCTYPE html><body style="margin:0"><iframe style="border:0" width="%s" height="%s" srcdoc="' "$width" "${size#*x}"
    cat escaped
    printf '"></iframe></body>'; } >framed.html
  "$browser" --headless --no-sandbox --disable-gpu-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader \
    --hide-scrollbars --user-data-dir="$work/profile" --enable-logging=stderr --virtual-time-budget=5000 \
    --window-size=1300,1000 --dump-dom "file://$work/framed.html" >dom.html 2>browser.err ||
    complain 'the browser failed'
  seen inner "$width"
  seen curves true
  seen figure true
  seen position true
  seen layers 'error+error before+stiffness+regions'
  seen colours 4
  seen bars 1
  seen turned true
  seen keys true
  seen 'all of it' true
  seen named 0
  seen heads 0
  seen reach 0
  seen faint 0
  seen width true
  seen screen true
  grep -q 'probe errors=' dom.html && ! grep -q 'probe errors=[^<]' dom.html || complain "errors: $(grep -o 'probe errors=[^<]*' dom.html)"
  grep CONSOLE browser.err && complain 'the console speaks'
done
grep -q '19706 to 2.029e+04\|1.971e+04 to 2.029e+04' report.html || complain 'no interval of E'
grep -q "<li><span>+ regions</span><b>0.06 N</b>" report.html || complain 'no strip of versions'
grep -q "<code id='next'>hs-identify data.csv .* --add friction -o better.csv</code>" report.html || complain 'no next command'

((failures == 0)) && echo 'all as expected'
exit $((failures > 0))
