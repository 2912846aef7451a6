#!/usr/bin/env bash
# labels.sh BIN: closed regions of a body act: a model's E of a region lies where the tetrahedra have its number.
set -uo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh"

scaled() { # X Y Z SIZE: a cube as OFF
  awk -v x="$1" -v y="$2" -v z="$3" -v s="$4" 'NR > 2 && NF == 3 { print x + s * ($1 > 0), y + s * ($2 > 0), z + s * ($3 > 0); next } { print }' box.off
}
scaled 0.024 0.019 0.024 0.012 >stiff.off
scaled 0.042 0.030 0.020 0.012 >soft.off
"$bin/hs-tetmesh" -q box.off --region stiff.off --region soft.off -o body.ply || complain 'a body with two regions'
"$bin/hs-tetmesh" -q box.off -o plain.ply || complain 'a body without'
model() { # FILE E0 E1 E2: those given
  { echo 'effect,region,parameter,value,unit,std_error,lower,upper,state'
    local k=0
    for e in "${@:2}"; do echo "elastic,$((k++)),E,$e,Pa,,,,free"; done
    echo 'elastic,0,nu,0.42,1,,,,fixed'; } >"$1"
}
model one.csv 20000
model all.csv 20000 80000 8000
model even.csv 20000 20000 20000
model lacks.csv 20000 80000
model more.csv 20000 80000 8000 5000
awk 'BEGIN { print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz"
  split("0.030 0.025 0.047 0.036 0.014 0.012 0.036 0.030 0.022 0.034", at, " ")
  for (p = 0; p < 5; ++p) for (i = 0; i <= 10; ++i)
    printf "%d,%.2f,%s,%s,0.04,%.6f,0,%.6f\n", p, 0.05 * i, at[2 * p + 1], at[2 * p + 2], p % 2 * 5e-5 * i, -1e-4 * i }' >motion.csv
simulate() { # MODEL BODY FLAGS...: the forces at the ends of the presses
  "$bin/hs-simulate" -q motion.csv --body "$2" --model "$1" "${@:3}" >out 2>err || complain "hs-simulate $*"
  awk -F, '/^[0-9]/ && $2 == 0.5 { print $9, $10, $11 }' out
}
near() { # SHARE: two files of forces, the largest difference over the force
  awk -v share="$1" 'NR == FNR { f[FNR] = $0; next } { split(f[FNR], a, " "); d = n = 0
    for (k = 1; k <= 3; ++k) { d += (a[k] - $k) ^ 2; n += $k ^ 2 }
    if (sqrt(d) > share * sqrt(n)) bad = 1; ++rows } END { exit bad || rows != 5 }' "$2" "$3"
}

# A body whose model has one modulus is what it was, and so is one of equal moduli.
simulate one.csv plain.ply >plain.txt
simulate one.csv body.ply >one.txt
"$bin/hs-tetmesh" -q body.ply --ascii | awk '$1 == 4 && NF == 6 { $NF = 0 } 1' >unnumbered.ply
"$bin/hs-tetmesh" -q body.ply --ascii >numbered.ply
simulate one.csv unnumbered.ply >unnumbered.txt
simulate one.csv numbered.ply >numbered.txt
cmp -s unnumbered.txt numbered.txt || complain 'numbers alone change no force'
near 2e-3 plain.txt one.txt || complain 'and what bounds them hardly any'
simulate even.csv body.ply >even.txt
near 5e-3 plain.txt even.txt || complain 'equal moduli are one body' # on meshes that end at the boundaries
simulate all.csv body.ply >all.txt
near 0.02 plain.txt all.txt && complain 'regions act'
# Above the stiff one, above the soft one.
awk 'NR == FNR { f[FNR] = $3; next } FNR == 1 && $3 < 1.05 * f[1] { exit 1 } FNR == 2 && $3 > 0.95 * f[2] { exit 1 }' plain.txt all.txt ||
  complain 'stiff above the stiff one, soft above the soft one'
# Every mode is of the same body; its own mesh as far as that is fine.
"$bin/hs-tetmesh" -q box.off --region stiff.off --region soft.off --contacts motion.csv --order 2 -o fine.ply || complain 'a finer body'
simulate all.csv fine.ply --own-mesh >own.txt
near 0.09 all.txt own.txt || complain 'its own mesh' # 7 % too soft where all is of one modulus as well
simulate all.csv body.ply --full >full.txt
near 0.02 all.txt full.txt || complain 'finite elements at every step'
simulate all.csv body.ply --live --contacts motion.csv >live.txt
near 1e-3 all.txt live.txt || complain 'live at known contacts'

# What the one has and the other lacks.
tool=$bin/hs-simulate
"$tool" motion.csv --body body.ply --model lacks.csv -o no.csv 2>err && complain 'a number without a modulus is refused'
[[ $? == 3 ]] || complain 'as bad input'
flat err | grep -q 'the body has tetrahedra of region 2, of which the model has no modulus; add a row elastic,2,E' || complain 'and which'
[[ ! -e no.csv ]] || complain 'a refused run leaves nothing behind'
"$tool" motion.csv --body body.ply --model more.csv -o more-forces.csv 2>err || complain 'a modulus without a number is none'
flat err | grep -q 'elastic E of region 3 acts nowhere' || complain 'and told'
"$tool" motion.csv --body plain.ply --model all.csv -o nowhere.csv 2>err || complain 'a body without numbers is one body'
flat err | grep -q 'elastic E of region 1 acts nowhere' || complain 'and that is told'

# Numbers that no model can have, and a sheet that meshes of contacts hardly see.
for number in -1 200000; do
  awk -v n="$number" '$1 == 4 && NF == 6 && $NF == 1 { $NF = n } 1' numbered.ply >odd.ply
  "$tool" motion.csv --body odd.ply --model all.csv -o no.csv 2>err && complain "region $number is refused"
  [[ $? == 3 ]] || complain 'as bad input'
  flat err | grep -q "tetrahedra of region $number; regions of a model have numbers from 0 to 1000" || complain 'and why'
done
awk 'NR > 2 && NF == 3 { print 0.01 + 0.04 * ($1 > 0), 0.01 + 0.03 * ($2 > 0), 0.025 + 0.0008 * ($3 > 0); next } { print }' box.off >sheet.off
"$bin/hs-tetmesh" -q box.off --region sheet.off -o sheet.ply || complain 'a sheet'
model sheet.csv 20000 200
"$tool" motion.csv --body sheet.ply --model sheet.csv -o thin.csv 2>err || complain 'forces over a sheet'
flat err | grep -q 'region 1 of the body is a sheet, some 0.7[0-9]* mm thick' || complain 'and that it is one'
{ cat one.csv; echo 'elastic,1,growth,0.001,m,,,,fixed'; } >grown.csv
"$tool" motion.csv --body body.ply --model grown.csv -o no.csv 2>err && complain 'growth without moduli of regions'
flat err | grep -q 'places no moduli by the body' || complain 'and what is missing'
{ cat all.csv; echo 'elastic,1,growth,0.001,m,,,,fixed'; } >grown.csv
"$tool" motion.csv --body body.ply --model grown.csv --live --contacts motion.csv -o no.csv 2>err && complain 'growth live'
flat err | grep -q 'the live force is not known of a region that grows' || complain 'is refused'

# Both moduli are found again, by presses on finer meshes.
"$tool" -q motion.csv --body body.ply --model all.csv --rim-edge 0.12 --add-noise 0.001 -o data.csv || complain 'presses'
"$bin/hs-identify" -q data.csv --body body.ply --fix nu=0.42 --add regions --regions labels --folds 0 -o found.csv 2>err ||
  complain 'moduli of labels'
grep -q '^regions' found.csv && complain 'no key points'
awk -F, '/^elastic,[012],E/ { true_E[0] = 20000; true_E[1] = 80000; true_E[2] = 8000
  e = true_E[$2]; if (($4 - e) ^ 2 > 9 * $6 ^ 2 + (0.01 * e) ^ 2) bad = 1; ++n } END { exit bad || n != 3 }' found.csv ||
  complain "the moduli of three regions: $(grep ',E,' found.csv | cut -d, -f2,4,6 | xargs)"
"$bin/hs-identify" data.csv --body plain.ply --fix nu=0.42 --add regions --regions labels --folds 0 -o no.csv 2>err &&
  complain 'a body without numbers has no labels'
flat err | grep -q 'all tetrahedra of the body are of region 0' || complain 'and that is said'

# The report cuts through the stiffest.
"$bin/hs-simulate" -q data.csv --body body.ply --model found.csv -o forces.csv
"$bin/hs-compare" -q data.csv --simulated forces.csv --body body.ply --model found.csv --html report.html -o residuals.csv ||
  complain 'the report'
"$bin/hs-compare" -q data.csv --simulated forces.csv --body plain.ply --model one.csv --html plain.html -o residuals.csv
[[ $(grep -c 'stiffness in the cut' report.html) -gt $(grep -c 'stiffness in the cut' plain.html) ]] || complain 'cuts of the labels'

((failures == 0)) && echo 'all as expected'
exit $((failures > 0))
