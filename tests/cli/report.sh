#!/usr/bin/env bash
# report.sh BIN: the report in a browser, as wide as a desk's screen and a phone's: it draws, a click or a key on
# a press or a position changes the plots, a button changes the colours, everything has a name and can be read,
# the first screen holds the verdict, the versions, the next command, a curve and the body, and the console stays
# silent.
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$here/scratch.sh" "$1"
. "$here/browser.sh" || exit 1

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
function steps(say) {
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
  const seen = selector => { const e = document.querySelector(selector), box = e && e.getBoundingClientRect(); return box && box.top < innerHeight && box.height > 20 ? Math.round(box.bottom) : "no"; };
  say("screen", [".verdict", ".strip", ".next", ".first figure", "#stage"].map(seen).every(b => b !== "no" && b <= innerHeight));
  say("bottoms", [".verdict", ".strip", ".next", ".first figure", "#stage"].map(seen).join(" "));
}
END
probed report.html probe.js
# A desk and a phone.
for size in '1280 800' '390 844'; do
  shown_at $size
  seen curves true
  seen figure true
  seen position true
  seen layers 'error+error before+stiffness+regions'
  seen colours 4
  seen bars 1
  seen turned true
  seen keys true
  seen 'all of it' true
  seen screen true
done
grep -q '1.971e+04 to 2.03e+04' report.html || complain 'no interval of E' # 20000 times or over exp(1.96 * 150 / 20000)
grep -q "<li><span>+ regions</span><b>0.06 N</b>" report.html || complain 'no strip of versions'
grep -q "<code id='next'>hs-identify data.csv .* --add friction -o better.csv</code>" report.html || complain 'no next command'

((failures == 0)) && echo 'all as expected'
exit $((failures > 0))
