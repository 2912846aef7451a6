#!/usr/bin/env bash
# torques.sh BIN: the tool's torques beside the forces: simulated, compared, fitted, judged.
set -uo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh"

"$bin/hs-tetmesh" -q box.off -o block.ply || complain 'the block'

# Presses at five places, three of them near an edge, down and slanted to either side.
awk 'BEGIN {
  print "# tool_radius: 0.003\npress,t,x,y,z,ux,uy,uz"
  split("0.03 0.025 0.055 0.02 0.03 0.006 0.006 0.043 0.047 0.014", at, " ")
  for (k = 0; k < 5; ++k)
    for (s = -1; s <= 1; ++s)
      for (i = 0; i <= 20; ++i) {
        d = 0.0015 * (i <= 10 ? i : 20 - i) / 10
        printf "%d,%.2f,%s,%s,0.04,%.6g,%.6g,%.6g\n", 3 * k + s + 2, 0.05 * i, at[2 * k + 1], at[2 * k + 2],
          0.6 * s * d, (s == 0 ? 0.5 : 0) * d, -d
      }
}' >motion.csv
cat >truth.csv <<'MODEL'
effect,region,parameter,value,unit,std_error,lower,upper,state
elastic,0,E,200000,Pa,,,,fixed
elastic,0,nu,0.42,1,,,,fixed
MODEL

# What is measured comes from meshes with another edge at the rim.
"$bin/hs-simulate" -q motion.csv --body block.ply --model truth.csv --rim-edge 0.12 --torques \
  --add-noise 0.004 --add-torque-noise 1.6e-5 -o data.csv || complain 'simulated'
grep -q '^press,.*,tqx,tqy,tqz$' data.csv || complain 'columns of torques'
grep -q '^# torque_noise: 1.6e-0*5' data.csv || complain 'declared noise'
"$bin/hs-simulate" -q motion.csv --body block.ply --model truth.csv --rim-edge 0.12 \
  --add-noise 0.004 -o forces-alone.csv
cut -d, -f1-11 <(grep -v '^#' data.csv) | cmp -s - <(grep -v '^#' forces-alone.csv) ||
  complain 'torques change no force'

value() { awk -F, -v p="$2" -v c="$3" '$1 == "elastic" && $3 == p { print $c }' "$1"; } # MODEL PARAMETER COLUMN
holds() { # MODEL: nu within three standard errors of the truth
  awk -v v="$(value "$1" nu 4)" -v e="$(value "$1" nu 6)" 'BEGIN { exit !(e > 0 && (v - 0.42)^2 < 9 * e^2) }'
}
"$bin/hs-identify" data.csv --body block.ply --effects elastic --folds 0 -o with.csv 2>with.txt || complain 'fit with torques'
"$bin/hs-identify" -q data.csv --body block.ply --effects elastic --folds 0 --ignore-torques -o without.csv ||
  complain 'fit without torques'
flat with.txt | grep -q 'TORQUES 315 rows count beside the forces' || complain "said of the torques: $(flat with.txt)"
holds with.csv || complain "nu with torques $(value with.csv nu 4) +- $(value with.csv nu 6)"
holds without.csv || complain "nu without torques $(value without.csv nu 4) +- $(value without.csv nu 6)"
awk -v a="$(value with.csv nu 6)" -v b="$(value without.csv nu 6)" 'BEGIN {
  printf "standard error of nu: %.4f without torques, %.4f with\n", b, a; exit !(a < 0.8 * b) }' ||
  complain 'torques narrow nothing'
grep -q '^# torque_rmse: ' with.csv && ! grep -q torque without.csv || complain 'metadata of the models'
"$bin/hs-identify" -q forces-alone.csv --body block.ply --effects elastic --folds 0 -o alone.csv
cmp -s <(grep -v '^#' alone.csv) <(grep -v '^#' without.csv) || complain 'ignored torques are none'

# Compared: noise alone of the model's own, and a tip taken for a point 1 mm beside it.
"$bin/hs-simulate" -q data.csv --body block.ply --model with.csv -o simulated.csv || complain 'simulated again'
"$bin/hs-compare" data.csv --simulated simulated.csv --json c.json -o residuals.csv 2>compared.txt
flat compared.txt | grep -q 'TORQUE error' || complain 'torques compared'
grep -q '^press,.*,rtqx,rtqy,rtqz$' residuals.csv || complain 'residuals of torques'
grep -q torque_rmse c.json || complain 'torques in JSON'
awk 'BEGIN { FS = OFS = "," } /^#/ { print; next } !head { head = 1; for (c = 1; c <= NF; ++c) at[$c] = c; print; next }
  { # the tip is 1 mm along x from where it is said to be: torque + (1 mm, 0, 0) x f
    $at["tqy"] -= 0.001 * $at["fz"]; $at["tqz"] += 0.001 * $at["fy"]; print }' data.csv >off.csv
"$bin/hs-compare" off.csv --simulated simulated.csv -o r.csv 2>off.txt
flat off.txt | grep -q 'touched 1 mm from where it is said to, at (1.0' || complain "a tip 1 mm off: $(flat off.txt)"

# Judged: the same forces, complete with their own torques and not with those.
"$bin/hs-diagnose" -q data.csv --body block.ply --model with.csv --check -o d.csv || complain 'complete with torques'
"$bin/hs-diagnose" -q off.csv --body block.ply --model with.csv --check -o d_off.csv
[[ $? == 1 ]] || complain 'a tip 1 mm off is complete'
grep -q '^0,model,unexplained,.*touched' d_off.csv || complain "diagnosis of a tip 1 mm off: $(grep '^0,' d_off.csv)"
"$bin/hs-diagnose" -q off.csv --body block.ply --model with.csv --ignore-torques --check -o d.csv ||
  complain 'complete without torques'

# Refused, or left out and said.
refuses() { # WORDS CODE COMMAND...
  local words=$1 code=$2
  shift 2
  "$@" >out.txt 2>err.txt
  [[ $? == "$code" ]] && flat err.txt | grep -qF -- "$words" || complain "$* : $(flat err.txt)"
}
awk 'BEGIN { FS = OFS = "," } /^#/ { print; next } !head { head = 1; for (c = 1; c <= NF; ++c) at[$c] = c; print; next }
  { for (n in at) if (n ~ /^tq/) $at[n] *= 1000; print }' off.csv >mm.csv
refuses '1 N mm is 0.001 N m' 3 "$bin/hs-identify" mm.csv --body block.ply --effects elastic -o x.csv
sed 's/tqx,tqy,tqz/tx,ty,tz/' data.csv >sensor.csv
refuses "torque_at" 0 "$bin/hs-identify" sensor.csv --body block.ply --effects elastic --folds 0 -o x.csv
{ cat truth.csv; echo 'friction,0,mu,0.5,1,,,,fixed'; } >slips.csv
refuses "with 'friction' they are no lever times the force" 3 "$bin/hs-simulate" motion.csv --body block.ply --model slips.csv --torques -o x.csv
refuses 'the torques are left out' 0 "$bin/hs-simulate" data.csv --body block.ply --model slips.csv -o x.csv
# A sensor that lags shows the torque late as well, and a dashpot at the tool has none.
{ cat truth.csv; echo 'sensor-lag,0,tau,0.1,s,,,,fixed'; echo 'sensor-lag,0,delay,0,s,,,,fixed'; } >lags.csv
refuses "with 'sensor-lag' they are no lever" 0 "$bin/hs-simulate" data.csv --body block.ply --model lags.csv -o x.csv
grep -q tqx x.csv && complain 'measured torques pass for simulated ones of a sensor that lags'
# Rows that are means of several have none.
awk '/^[0-9]/ { print; print; print } { print }' data.csv >dense.csv
refuses 'means of several, whose torques are not used' 0 "$bin/hs-identify" dense.csv --body block.ply --model truth.csv --folds 0 --most-rows 700 -o x.csv
grep -q tqx x.csv && complain 'measured torques pass for simulated ones'
refuses '--torques is of forces at prepared places' 2 "$bin/hs-simulate" motion.csv --body block.ply --model truth.csv --torques --full -o x.csv
exit $((failures > 0))
