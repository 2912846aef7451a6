#!/usr/bin/env bash
# image.sh BIN: an image of what is inside a body has its standard errors in every format; the report cuts the body
# open, at a desk and on a phone, without a network; what is no image is refused in a line.
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$here/scratch.sh" "$1"
. "$here/browser.sh" || exit 1
refuses() { # CODE TEXT ARGUMENTS...
  local code=$1 text=$2
  shift 2
  "$bin/hs-compare" -q data.csv --simulated forces.csv -o residuals.csv "$@" 2>err
  local got=$?
  ((got == code)) || complain "exit code $got, not $code: $*"
  grep -qF -- "$text" err || complain "'$text' is not told: $*"
  [[ $(wc -l <err) == 1 ]] || complain "not one line: $*"
}

cat >truth.csv <<'END'
effect,region,parameter,value,unit,std_error,lower,upper,state
elastic,0,E,10000,Pa,,1,1e12,free
elastic,0,nu,0.4,1,,0,0.499,fixed
END
awk 'BEGIN { print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz"; for (p = 0; p < 9; ++p) for (i = 0; i <= 8; ++i)
  printf "%d,%.2f,%.3f,%.3f,0.04,0,0,%.6f\n", p, 0.1 * i, 0.018 + 0.012 * (p % 3), 0.013 + 0.012 * int(p / 3), -0.0002 * i }' >motion.csv
"$bin/hs-tetmesh" box.off -q -o body.ply 2>err || complain 'no body'
"$bin/hs-simulate" -q motion.csv --body body.ply --model truth.csv --rim-edge 0.3 -o forces.csv 2>err || complain 'no forces'
# One press in four is 10 % stiffer than the model; noise on all.
awk -F, -v OFS=, 'BEGIN { srand(2) } /^[0-9]/ { for (k = 9; k <= 11; ++k) { g = -6; for (j = 0; j < 12; ++j) g += rand()
  $k = sprintf("%.6f", $k * ($1 == 4 ? 1.1 : 1) + 0.0015 * g) } } 1' forces.csv >data.csv
image=(data.csv --body body.ply --rim-edge 0.3 --effects elastic --fix nu=0.4 --folds 0 --threads 1 -o model.csv)
for name in image.ply image.csv; do
  "$bin/hs-identify" "${image[@]}" --image $name 2>err || complain "no $name"
done
flat err | grep -q 'the modulus of the image is known within a factor of 2, with 95 %, as far as [0-9]* mm from pressed places' ||
  flat err | grep -q 'nowhere do these presses tell the modulus within a factor of 2' || complain 'how deep is seen is not said'
sed -n '/^[^#]/{p;q}' image.csv | grep -qx 'x,y,z,E,log_E_std,resolution' || complain 'columns of the image'
awk -F, '/^[0-9]/ { if (!($4 > 0 && $5 > 0 && $6 > 0)) exit 1; ++n } END { exit n < 100 }' image.csv || complain 'values of the image'
# Sure near the presses, less so at the bottom.
awk -F, '/^[0-9]/ { if ($3 > 0.034) { a += $5; ++na } if ($3 < 0.01) { b += $5; ++nb } } END { exit !(a / na < b / nb) }' image.csv ||
  complain 'the errors do not grow with depth'
for property in E log_E_std resolution; do
  head -c 600 image.ply | grep -aq "^property double $property$" || complain "image.ply has no $property"
done
head -c 600 image.ply | grep -aq '^comment model_modulus [0-9]' || complain 'image.ply has no model_modulus'
"$bin/hs-simulate" -q motion.csv --body image.ply --model truth.csv --rim-edge 0.3 -o again.csv 2>err && cmp -s <(grep -v '^#' forces.csv) <(grep -v '^#' again.csv) ||
  complain 'an image is a body'

"$bin/hs-compare" -q data.csv --simulated forces.csv --body body.ply --inside image.ply --html report.html -o residuals.csv 2>err ||
  complain 'no report'
grep -Eq '(src|href)=.?https?:|@import|fetch\(|XMLHttpRequest|WebSocket' report.html && complain 'the report asks the network'
grep -q "default-src 'none'" report.html || complain 'the report may ask the network'
grep -q 'The image of what is inside' report.html || complain 'no section of the image'
grep -Eq 'as far as [0-9]+ mm from pressed places|Nowhere do these presses tell' report.html || complain 'how deep is seen is not in the report'
grep -q '>std. error \[%\]<' report.html || complain 'no bar of standard errors'
cp report.html both.html
"$bin/hs-compare" -q data.csv --simulated forces.csv --inside image.ply --html report.html -o residuals.csv 2>err &&
  grep -q 'id=.stage.' report.html || complain 'the image is no body where none is given'

cat >probe.js <<'END'
function steps(say) {
  const canvas = id => document.getElementById(id).toDataURL(), slide = (id, value) => {
    const e = document.getElementById(id); e.value = value; e.dispatchEvent(new Event("input"));
  };
  const flat = canvas("flat-ratio"), errors = canvas("flat-error");
  say("two pictures", flat !== errors);
  const at = +document.getElementById("flat-at").value;
  slide("flat-at", at > 3 ? at - 3 : at + 3);
  say("depth", canvas("flat-ratio") !== flat || canvas("flat-error") !== errors);
  say("below", / mm below the top/.test(document.getElementById("flat-out").textContent));
  const upright = canvas("upright-error"), across = document.getElementById("upright-across");
  across.value = "0"; across.onchange();
  say("across", canvas("upright-error") !== upright && /^x = /.test(document.getElementById("upright-out").textContent));
  const drawing = document.getElementById("upright-error");
  drawing.dispatchEvent(new PointerEvent("pointermove", { clientX: drawing.getBoundingClientRect().left + 80, clientY: drawing.getBoundingClientRect().top + 40 }));
  say("readout", /mm: (not resolved: half and double|× [0-9.]+ the model's, 95 %|outside)/.test(document.getElementById("inside-readout").textContent));
  const pixels = () => document.querySelector("canvas.surface").toDataURL();
  say("layers", [...document.querySelectorAll("#layers button")].map(b => b.textContent).join("+"));
  const whole = pixels();
  slide("cut-at", 90);
  const open = pixels();
  say("cut open", open !== whole && document.querySelector("#layers button.on").textContent === "inside");
  slide("cut-at", 120);
  say("cut moves", pixels() !== open);
  document.querySelectorAll("#layers button")[3].click();
  say("cut of errors", pixels() !== open);
}
END
probed both.html probe.js
for size in '1280 800' '390 844'; do
  shown_at $size
  for name in 'two pictures' depth below across readout 'cut open' 'cut moves' 'cut of errors'; do seen "$name" true; done
  seen layers error+stiffness+inside+"its error"
done

rm -f residuals.csv
refuses 2 'add --html report.html' --inside image.ply
refuses 3 'image.csv: not a PLY with an image of the stiffness; make it by hs-identify --image image.ply' --inside image.csv --html r.html
refuses 3 'body.ply: its tetrahedra have no modulus E' --inside body.ply --html r.html
sed 's/^property double log_E_std$/property double log_E_old/' image.ply >older.ply
refuses 3 'older.ply: an image without its standard errors, as earlier versions of hapsim wrote it' --inside older.ply --html r.html
awk '{ if (NF == 3 && NR > 2 && $1 > 0) $1 = 0.09 } 1' box.off >wide.off
"$bin/hs-tetmesh" wide.off -q -o wide.ply 2>err || complain 'no wide body'
refuses 3 'image.ply: an image of another body: its bounds differ by 30 mm' --body wide.ply --inside image.ply --html r.html
[[ ! -e r.html && ! -e residuals.csv ]] || complain 'a refused run leaves nothing behind'

((failures == 0)) && echo 'all as expected'
exit $((failures > 0))
