#!/usr/bin/env bash
# markers.sh BIN: marked points of the surface beside the forces: simulated, compared, fitted, judged.
set -uo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh"

"$bin/hs-tetmesh" -q box.off -o block.ply || complain 'the block'

# Presses straight down at four places, and points that a camera sees beside them.
awk 'BEGIN {
  print "# tool_radius: 0.003\npress,t,x,y,z,ux,uy,uz"
  split("0.024 0.025 0.028 0.02 0.026 0.03 0.031 0.026", at, " ")
  for (k = 0; k < 4; ++k)
    for (s = 0; s < 2; ++s)
      for (i = 0; i <= 20; ++i)
        printf "%d,%.2f,%s,%s,0.04,0,0,%.6g\n", 2 * k + s + 1, 2 * (2 * k + s) + 0.05 * i, at[2 * k + 1], at[2 * k + 2],
          -0.0015 * (i <= 10 ? i : 20 - i) / 10
}' >motion.csv
awk 'BEGIN {
  print "point,x,y,z"
  for (i = 0; i < 4; ++i) for (j = 0; j < 3; ++j) printf "p%d%d,%g,%g,0.04\n", i, j, 0.018 + 0.009 * i, 0.015 + 0.01 * j
  print "under,0.031,0.026,0.04"
}' >points.csv
model() { # E0 E1 BORDER: of 0.42; where E1 differs it begins at the border (x)
  echo 'effect,region,parameter,value,unit,std_error,lower,upper,state'
  echo "elastic,0,E,$1,Pa,,,,free"
  [[ $2 == "$1" ]] || echo "elastic,1,E,$2,Pa,,,,fixed"
  echo "elastic,0,nu,0.42,1,,,,${4:-free}"
  [[ $2 == "$1" ]] ||
    awk -v x="$3" 'BEGIN { printf "regions,0,x1,%g,m,,,,fixed\nregions,0,y1,0.025,m,,,,fixed\nregions,1,x2,%g,m,,,,fixed\nregions,1,y2,0.025,m,,,,fixed\n", x - 0.012, x + 0.012 }'
}
model 200000 200000 0 >truth.csv

# What is measured comes from meshes with another edge at the rim; what the camera sees, 20 um of noise beside it.
"$bin/hs-simulate" -q motion.csv --body block.ply --model truth.csv --rim-edge 0.12 --add-noise 0.004 \
  --markers points.csv --markers-out seen.csv --add-marker-noise 20um -o data.csv || complain 'simulated'
grep -q '^point,t,x,y,z,ux,uy,uz,press$' seen.csv || complain 'columns of points'
grep -q '^# marker_noise: 2e-0*5' seen.csv || complain 'declared noise'
"$bin/hs-simulate" -q motion.csv --body block.ply --model truth.csv --rim-edge 0.12 --add-noise 0.004 -o alone.csv
cmp -s data.csv alone.csv || complain 'points change no force'

value() { awk -F, -v p="$2" -v c="$3" '$1 == "elastic" && $3 == p { print $c; exit }' "$1"; } # MODEL PARAMETER COLUMN
holds() { # MODEL: nu within three standard errors of the truth
  awk -v v="$(value "$1" nu 4)" -v e="$(value "$1" nu 6)" 'BEGIN { exit !(e > 0 && (v - 0.42)^2 < 9 * e^2) }'
}
identify=("$bin/hs-identify" --body block.ply --effects elastic --folds 0)
"${identify[@]}" data.csv --markers seen.csv -o with.csv 2>with.txt || complain "fit with points: $(flat with.txt)"
"${identify[@]}" -q data.csv -o without.csv || complain 'fit without points'
flat with.txt | grep -q 'MARKERS .* rows of 13 points count beside the forces' || complain "said of the points: $(flat with.txt)"
flat with.txt | grep -q 'rows do not: the point is under the tool' || complain 'points under the tool'
holds with.csv || complain "nu with points $(value with.csv nu 4) +- $(value with.csv nu 6)"
awk -v a="$(value with.csv nu 6)" -v b="$(value without.csv nu 6)" 'BEGIN {
  printf "standard error of nu: %.4f without points, %.4f with\n", b, a; exit !(a < 0.5 * b) }' || complain 'points narrow nothing'
grep -q '^# marker_rmse: ' with.csv && ! grep -q marker without.csv || complain 'metadata of the models'

# Compared.
"$bin/hs-simulate" -q data.csv --body block.ply --model with.csv --markers seen.csv --markers-out model.csv -o simulated.csv ||
  complain 'simulated again'
"$bin/hs-compare" data.csv --simulated simulated.csv --markers seen.csv --simulated-markers model.csv --json c.json \
  -o residuals.csv 2>compared.txt || complain 'compared'
flat compared.txt | grep -qE 'MARKERS error 0.0[0-9]+ mm = (0.9|1|1.1) x noise' || complain "points compared: $(flat compared.txt)"
grep -q '"marker_points"' c.json || complain 'points in JSON'

# Judged: complete with its own points.
"$bin/hs-diagnose" -q data.csv --body block.ply --model with.csv --markers seen.csv --check -o d.csv ||
  complain "complete with points: $(grep '^0,' d.csv)"
# Presses on one side of a border, beyond which the stiffness is known: 5 mm off it is nothing to the forces, and to
# points that saw it.
model 200000 600000 0.040 fixed >border.csv
model 200000 600000 0.045 fixed >off.csv
"$bin/hs-simulate" -q motion.csv --body block.ply --model border.csv --rim-edge 0.12 --add-noise 0.004 \
  --markers points.csv --markers-out seen2.csv --add-marker-noise 20um -o data2.csv || complain 'simulated with a border'
diagnose() { "$bin/hs-diagnose" -q data2.csv --body block.ply --check -o d.csv "$@" 2>/dev/null; } # MODEL AND MARKERS
diagnose --model border.csv --markers seen2.csv || complain "complete with its border: $(grep '^0,' d.csv)"
diagnose --model off.csv || complain "a border 5 mm off by forces alone: $(grep '^0,' d.csv)"
diagnose --model off.csv --markers seen2.csv
[[ $? == 1 ]] && grep -q '^0,model,unexplained,.*marked points of the surface do not move as' d.csv ||
  complain "a border 5 mm off: $(grep '^0,' d.csv)"

# Refused, or left out and said.
refuses() { # WORDS CODE COMMAND...
  local words=$1 code=$2
  shift 2
  "$@" >out.txt 2>err.txt
  [[ $? == "$code" ]] && flat err.txt | grep -qF -- "$words" || complain "$* : $(flat err.txt)"
}
awk 'BEGIN { FS = OFS = "," } /^#|^point/ { print; next } { for (c = 6; c <= 8; ++c) $c *= 1000; print }' seen.csv >mm.csv
refuses 'are these millimetres? name the column' 3 "${identify[@]}" data.csv --markers mm.csv -o x.csv
awk 'BEGIN { FS = OFS = "," } /^#|^point/ { print; next } { for (c = 6; c <= 8; ++c) $c /= 4; print }' mm.csv >larger.csv
refuses '1000 times too large, name the columns ux_mm' 3 "${identify[@]}" data.csv --markers larger.csv -o x.csv
sed 's/ux,uy,uz/ux_mm,uy_mm,uz_mm/' mm.csv >named.csv
"${identify[@]}" -q data.csv --markers named.csv -o named_model.csv
awk -v a="$(value with.csv nu 4)" -v b="$(value named_model.csv nu 4)" 'BEGIN { exit !((a - b)^2 < 1e-12) }' || complain 'mm in the header'
awk 'BEGIN { FS = OFS = "," } /^#|^point/ { print; next } { for (c = 3; c <= 5; ++c) $c *= 100; print }' seen.csv >cm.csv
refuses 'times 0.01 they lie on it' 3 "${identify[@]}" data.csv --markers cm.csv -o x.csv
awk 'BEGIN { FS = OFS = "," } /^p00/ { $5 += 0.004 } { print }' seen.csv >off_surface.csv
refuses '1 of 13 marked points lies farther than' 3 "${identify[@]}" data.csv --markers off_surface.csv -o x.csv
{ cat truth.csv; echo 'friction,0,mu,0.5,1,,,,fixed'; } >slips.csv
refuses "marked points do not count: with 'friction'" 0 "$bin/hs-identify" data.csv --body block.ply --model slips.csv --folds 0 --markers seen.csv -o x.csv
refuses "with 'friction' they are no constant" 3 "$bin/hs-simulate" motion.csv --body block.ply --model slips.csv --markers points.csv --markers-out m.csv -o x.csv
awk '/^[0-9]/ { print; print; print } { print }' data.csv >dense.csv
awk 'BEGIN { FS = OFS = "," } /^#/ { print; next } !head { head = 1; print $0, "thx,thy,thz"; next } { print $0, 0.01, 0, 0 }' data.csv >turned.csv
refuses 'the tool turns (thx,thy,thz): its forces are taken for those of one that does not' 0 "${identify[@]}" turned.csv -o x.csv
refuses 'take all rows (--most-rows 0)' 3 "${identify[@]}" dense.csv --markers seen.csv --most-rows 500 -o x.csv
awk -F, '/^# marker_noise/ { next } /^#|^point,/ { print; next } $8 < least[$1] { least[$1] = $8; row[$1] = $0 }
  END { for (p in row) print row[p] }' seen.csv >one.csv
refuses 'declare it: # marker_noise' 3 "${identify[@]}" data.csv --markers one.csv -o x.csv
refuses 'is no noise of a point' 2 "$bin/hs-simulate" -q motion.csv --body block.ply --model truth.csv --markers points.csv --markers-out m.csv --add-marker-noise 20m -o x.csv
refuses '--markers and --markers-out go together' 2 "$bin/hs-simulate" motion.csv --body block.ply --model truth.csv --markers points.csv -o x.csv
refuses '--markers and --simulated-markers go together' 2 "$bin/hs-compare" data.csv --simulated simulated.csv --markers seen.csv -o x.csv
exit $((failures > 0))
