#!/usr/bin/env bash
# constrain.sh BIN: hs-identify --constrain: what binds and what does not, what is refused, and what is told of it.
set -uo pipefail
bin=$(cd "$1" && pwd)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$here/tool.sh" "$1/hs-identify"
. "$here/identify_data.sh"
common=(data.csv --body block.ply --rim-edge 0.3 --folds 0)
maxwell=("${common[@]}" --add viscoelastic)
value() { awk -F, -v n="$2" '$3 == n { print $4 }' "$1"; } # FILE PARAMETER
holds() { # CONDITION of awk in E, nu, E1, tau1, of out.csv
  awk -F, "/^(el|vis)/ { v[\$3] = \$4 } END { E = v[\"E\"]; nu = v[\"nu\"]; E1 = v[\"E1\"]; tau1 = v[\"tau1\"]
    exit !($1) }" out.csv || complain "out.csv: $1"
}
rows() { grep -v '^#' "$1"; }
error() { sed -n 's/^# rmse: //p' "$1"; }

# What the fit keeps by itself leaves every digit of it.
"$tool" -q "${maxwell[@]}" -o free.csv || complain 'a fit without constraints'
expect 0 'kept without being asked for: E <= 50 kPa; E1 <= E' "${maxwell[@]}" --constrain 'E <= 50 kPa' \
  --constrain 'E1 <= E' -o out.csv
cmp -s <(rows free.csv) <(rows out.csv) || complain 'constraints that do not bind change nothing'
cmp -s <(grep -v '^# constraints: E <= 50 kPa; E1 <= E$' out.csv) free.csv || complain 'and they alone are written down'

# What binds holds to the last digits, is told with its cost, and is written down.
expect 0 'E1 <= E/2 binds: it costs' "${maxwell[@]}" --constrain 'E1 <= E/2; tau1 <= 5 s' -o out.csv
holds '(E1 / E - 0.5)^2 < 1e-20'
flat .err | grep -qE 'binds: it costs 0\.00?[0-9]* N of error, [0-9.]* standard errors' || complain 'the cost is told'
grep -qx '# constraints: E1 <= E/2; tau1 <= 5 s' out.csv && grep -qx '# binding: E1 <= E/2' out.csv ||
  complain 'constraints are in the model'
awk -v a="$(error out.csv)" -v b="$(error free.csv)" 'BEGIN { exit !(a > b) }' || complain 'it costs error'
expect 0 'binds' "${maxwell[@]}" --constrain 'elastic.E + viscoelastic.E1 = 14kPa' --json j.json -o out.csv
holds '(E + E1 - 14000)^2 < 1e-14'
# With one that binds, the cost by the multiplier is the rise of the error, to second order.
/usr/bin/python3 -c 'import json; v = {n: x["value"] for n, x in json.load(open("j.json"))["values"].items()}
rise = v["error"] - v["unconstrained_error"]
assert rise > 1e-4 and abs(v["cost of elastic.E + viscoelastic.E1 = 14kPa"] / rise - 1) < 0.2, v' || complain 'the cost is the rise of the error'
expect 0 'held by them' "${maxwell[@]}" --constrain 'tau1 = 0.5' -o out.csv
holds '(tau1 - 0.5)^2 < 1e-20'
grep -q '^viscoelastic,0,tau1,0.5[0-9]*,s,,' out.csv || complain 'what is held has no standard error'
# Standard errors of a sum that is held: those of E and of E1 are one.
expect 0 'binds' "${maxwell[@]}" --constrain 'E + E1 = 14 kPa' -o out.csv
awk -F, '$3 == "E" { a = $6 } $3 == "E1" { b = $6 } END { exit !((a / b - 1)^2 < 1e-6) }' out.csv ||
  complain 'standard errors lie along what is left free'
# Chains, powers, what is fixed, and readings that lie far off.
expect 0 'binds' "${maxwell[@]}" --fix nu=0.4 --constrain '2 <= (E1/E)^2/nu <= 3' -o out.csv
holds '((E1 / E)^2 / 0.4 - 2)^2 < 1e-18'
expect 0 'binds' "${maxwell[@]}" --robust huber --constrain 'E1 <= E/2' -o out.csv
holds '(E1 / E - 0.5)^2 < 1e-20'
# On unseen data too, and gone on with: what was kept is no promise of the next fit.
expect 0 'binds' data.csv --body block.ply --rim-edge 0.3 --folds 2 --add viscoelastic --constrain 'E1 <= E/2' -o kept.csv
expect 0 'error' "${common[@]}" --model kept.csv -o out.csv
! grep -qE '^# (constraints|binding)' out.csv || complain 'a fit without constraints has none'
cmp -s <(rows free.csv | cut -d, -f1-3) <(rows out.csv | cut -d, -f1-3) || complain 'the model stays'
# Two terms in an order of their own.
expect 0 'binds' "${common[@]}" --add viscoelastic --terms 2 --fix nu=0.4 --constrain 'tau2 >= 10*tau1; E2 = E1/4' -o out.csv
awk -F, '/^vis/ { v[$3] = $4 } END { exit !(v["tau2"] >= 9.9999999 * v["tau1"] && (v["E1"] / v["E2"] - 4)^2 < 1e-18) }' \
  out.csv || complain 'two terms keep their relations'

# Names, formulas and sets that cannot be.
expect 2 "the model has no parameter 'tau2', of 'tau2 >= tau1'; it has elastic.E, elastic.nu, viscoelastic.E1, viscoelastic.tau1" \
  "${maxwell[@]}" --constrain 'tau2 >= tau1' -o out.csv
expect 2 "--constrain 'E1 >' lacks a number or a name at its end" "${maxwell[@]}" --constrain 'E1 >' -o out.csv
expect 2 "E >= 15 kPa and E <= 4 kPa contradict each other" "${maxwell[@]}" \
  --constrain 'tau1 >= 0.1; E >= 15 kPa; E1 <= E' --constrain 'E <= 4 kPa' -o out.csv
expect 2 "E1 >= E, E = 2*E1 and elastic.E's lower bound 1 contradict each other" "${maxwell[@]}" --constrain 'E1 >= E; E = 2*E1; E >= 5 kPa' -o out.csv
expect 2 "nu >= 0.6 and elastic.nu's upper bound 0.499 contradict each other" "${common[@]}" --constrain 'nu >= 0.6' -o out.csv
expect 2 "E <= 10000*nu, E >= 5 kPa and elastic.nu fixed at 0.4 contradict each other" "${common[@]}" --fix nu=0.4 \
  --constrain 'E <= 10000*nu; E >= 5 kPa' -o out.csv
expect 2 '--constrain needs the model' "${common[@]}" --effects auto --constrain 'E >= 1' -o out.csv
expect 2 '--profile and --constrain exclude each other' "${common[@]}" --profile --constrain 'E >= 1' -o out.csv
expect 2 '--constrain is of models with effects' "${common[@]}" --acfm 1 --constrain 'E >= 1' -o out.csv

# Regions, whose body is solved anew: a ratio between two of them.
awk -F, -v OFS=, '/^#|^press/ { print; next } { print; $1 += 4; $4 = 0.015; print }' motion.csv | sort -t, -k1,1n -k2,2n -s \
  >four.csv
"$bin/hs-simulate" -q four.csv --body block.ply --model truth.csv --rim-edge 0.3 -o sites.csv || complain 'four places'
expect 0 'binds' sites.csv --body block.ply --rim-edge 0.3 --folds 0 --noise 0.002 --fix nu=0.4 --add regions \
  --regions sites --constrain 'E[1] = 1.2*E' -o out.csv
awk -F, '$3 == "E" { v[$2] = $4 } END { exit !((v[1] / v[0] - 1.2)^2 < 1e-18) }' out.csv || complain 'regions keep their ratio'
# The same by names, which the model keeps, and by points of the two places.
at=$(awk -F, '/^regions,[01],x/ { x[$2] = $4 } /^regions,[01],y/ { y[$2] = $4 } END { printf "E(%s, %s) = 1.2*E(%s, %s)", x[1], y[1], x[0], y[0] }' out.csv)
cp out.csv numbers.csv
expect 0 'E(right) = 1.2*E(left) binds' sites.csv --body block.ply --rim-edge 0.3 --folds 0 --noise 0.002 --fix nu=0.4 --add regions \
  --regions sites --region-names left,right --constrain 'E(right) = 1.2*E(left)' -o out.csv
cmp -s <(rows numbers.csv) <(rows out.csv) && grep -qx '# region_names: left,right' out.csv || complain 'regions by their names'
expect 0 'binds' sites.csv --body block.ply --rim-edge 0.3 --folds 0 --noise 0.002 --fix nu=0.4 --add regions --regions sites \
  --constrain "$at" -o points.csv
cmp -s <(rows numbers.csv) <(rows points.csv) || complain "regions by points: $at"
expect 2 "no region is called 'middle', of 'E(middle) = 5000'; name regions 0, 1, ... by --region-names" "${maxwell[@]}" \
  --constrain 'E(middle) = 5000' -o bad.csv
expect 2 "--region-names: '2nd' is no name of a region" sites.csv --body block.ply --region-names left,2nd --constrain 'E >= 1' -o bad.csv

rm -f out.csv
expect 2 'contradict each other' "${maxwell[@]}" --constrain 'E >= 15 kPa; E <= 4 kPa' -o out.csv
[[ ! -e out.csv ]] || complain 'a refused run leaves nothing behind'

((failures == 0)) && echo 'all as expected'
exit $((failures > 0))
