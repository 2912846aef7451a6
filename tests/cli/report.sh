#!/usr/bin/env bash
# report.sh BIN: the report in a browser: it draws, a click on a press or a position changes the
# plots, a button changes the colours, and the console stays silent.
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
"$bin/hs-tetmesh" box.off -q -o body.ply 2>err || complain 'no body'
"$bin/hs-compare" data.csv --simulated simulated.csv --body body.ply --model model.csv -q \
  --html report.html --figures figure- -o residuals.csv 2>err || complain 'no report'
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
  say("errors", window.hapsimErrors.join(";"));
  const out = document.createElement("pre");
  out.textContent = lines.join("\n");
  document.body.appendChild(out);
}, 100));
END
awk 'NR == FNR { script = script $0 "\n"; next }
     { at = index($0, "<head>"); if (at) { print substr($0, 1, at + 5); printf "<script>%s</script>\n", script; print substr($0, at + 6) } else print }' \
  probe.js report.html >probed.html
"$browser" --headless --no-sandbox --disable-gpu-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader \
  --user-data-dir="$work/profile" --enable-logging=stderr --virtual-time-budget=5000 \
  --window-size=1300,1600 --dump-dom "file://$work/probed.html" >dom.html 2>browser.err ||
  complain 'the browser failed'
seen() { # NAME VALUE
  grep -q "probe $1=$2\$" dom.html || grep -q "probe $1=$2<" dom.html ||
    complain "$1 is not $2: $(grep -o "probe $1=[^<]*" dom.html)"
}
seen curves true
seen figure true
seen position true
seen layers 'error+stiffness+regions'
seen colours 3
seen bars 1
seen turned true
grep -q 'probe errors=' dom.html && ! grep -q 'probe errors=[^<]' dom.html || complain "errors: $(grep -o 'probe errors=[^<]*' dom.html)"
grep CONSOLE browser.err && complain 'the console speaks'
grep -q '19706 to 2.029e+04\|1.971e+04 to 2.029e+04' report.html || complain 'no interval of E'

((failures == 0)) && echo 'all as expected'
exit $((failures > 0))
