#!/usr/bin/env bash
# machines.sh BIN: share/examples/batch/machines.sh on tables of a testing machine: elastic and with the effects that
# they ask for, one command, one overview; a table that cannot be read is a line of its own.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh"

# Blocks of 60 x 50 x 40 mm, simulated on a finer mesh than they are identified on: eight recordings of each,
# on the middle of the top.
awk '/^[0-9.]+ [0-9.]+ [0-9.]+$/ && NR > 2 { print $1 - 0.03, $2 - 0.025, $3; next } 1' box.off >block.off
"$bin/hs-tetmesh" -q block.off --max-volume 2e-9 -o block.ply || exit 1
awk 'BEGIN { print "# tool_radius: 0.004\n# force_noise: 0.002\npress,t,x,y,z,ux,uy,uz"
  for (p = 1; p <= 8; ++p) { rise = 0.2 * p; depth = 0.0012 + 0.0002 * p
    for (i = 0; i <= 100; ++i) { t = 0.04 * i; s = t < rise ? t / rise : t < 2.5 ? 1 : t < 3.5 ? 3.5 - t : 0
      printf "%d,%.2f,0,0,0.04,0,0,%.6f\n", p, t, -depth * s } } }' >motion.csv
mkdir tables
table() { # NAME MODEL SEED: as a machine exports them, each with an approach through the air, in one file
  printf 'effect,region,parameter,value\nelastic,0,nu,0.49\n%b' "$2" >truth.csv
  "$bin/hs-simulate" -q motion.csv --body block.ply --model truth.csv --rim-edge 0.2 --add-noise 0.002 --seed "$3" -o forces.csv || exit 1
  awk -F, -v OFS=';' 'function row(t, s, f) { line = sprintf("%.2f;%.4f;%.5f", t, s, f); gsub(/\./, ",", line); print line }
    /^#/ { next } !h { h = 1; for (i = 1; i <= NF; ++i) c[$i] = i; srand(5); print "Material;meat"; print ""; next }
    $c["press"] != p { p = $c["press"]; print "Prüfzeit;Standardweg;Standardkraft"; print "s;mm;N"
      for (k = -25; k < 0; ++k) row(k * 0.04 + 1, 0.02 * k, 0.006 * (rand() - 0.5)) }
    { row($c["t"] + 1, -1000 * $c["uz"], $c["fz"]) }' forces.csv >"tables/$1.csv"
}
table 'soft' 'elastic,0,E,8000\n' 1
table "it's tough" 'elastic,0,E,20000\nviscoelastic,0,E1,15000\nviscoelastic,0,tau1,0.3\n' 2
printf 'Prüfzeit;Standardweg\ns;mm\n0,0;0,1\n0,1;0,2\n' >tables/broken.csv
run() { BIN=$bin "$root/share/examples/batch/machines.sh" 60x50x40mm 4mm out tables/*.csv >log 2>err; }
run && complain 'a table that cannot be read must be told by the exit code'
grep -q '✗ 4 of 6 recordings done, 2 failed$' err || complain 'what became of them'
[[ $(grep -c '^hs-batch: failed: broken .*: hs-import: .*no column holds a force' err) == 2 ]] || complain 'the broken table in its own lines'
flat err | grep -q 'elastic (2): median error .*; models: .*auto (2): median error .*; models: ' ||
  complain 'median error and verdicts of either kind of model'
awk -F, 'NR > 1 && $3 == "done" { name = $1; gsub(/"/, "", name); rmse[name] = $7; noise[name] = $9; effects[name] = $4; E[name] = $5 }
  END { tough = "it'"'"'s tough"
    exit !(rmse[tough " elastic"] > 3 * rmse[tough " auto"] && effects[tough " auto"] ~ /viscoelastic/ &&
      E["soft auto"] > 7600 && E["soft auto"] < 8400) }' out/summary.csv || { complain 'the models'; cut -d, -f1-11 out/summary.csv; }
# One axis was measured: the zeros of the others do not make its error smaller.
awk -F, 'NR > 1 && $1 ~ /auto/ && $3 == "done" { ratio = $7 / $9; n += ratio > 0.9 && ratio < 1.5 } END { exit n != 2 }' out/summary.csv ||
  complain "errors are as large as the noise: $(cut -d, -f1,7,9 out/summary.csv)"
grep -q 'By the effects asked for' out/overview.html && grep -q "href='recordings/soft-elastic" out/overview.html ||
  complain 'the overview'
touch before
run
[[ -z $(find out/recordings -newer before -type f) ]] || complain 'a second run makes nothing'
((failures == 0)) && echo 'machines: passed'
exit $((failures > 0))
