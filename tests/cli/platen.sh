#!/usr/bin/env bash
# platen.sh BIN: a cylinder between platens. Without lateral contraction it is a bar, F = E A d/h, which gives its
# modulus back; what is beyond the verified strain, or cannot be, is said.
set -uo pipefail
bin=$(cd "$1" && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/tool.sh" "$1/hs-identify"
export XDG_CACHE_HOME=$work/cache
# E = 30 kPa, 50 mm across, 30 mm high; two presses to 40 %, noise of 10 mN.
awk 'BEGIN { srand(1); print "press,time [s],travel [mm],load [N]"
  for (p = 1; p <= 2; ++p) for (i = 0; i <= 120; ++i) { e = -6; for (k = 0; k < 12; ++k) e += rand()
    printf "%d,%g,%.6f,%.6f\n", p, i / 10, i / 10, 30e3 * 3.14159265 * .025 ^ 2 * i / 10 / 30 + .01 * e } }' >bar.csv
"$bin/hs-import" -q bar.csv --block 50x30mm --tool platen --surface bar.ply -o data.csv &&
  "$bin/hs-tetmesh" -q bar.ply -o body.ply || complain 'the table is imported'
grep -q '^# tool_radius: 0.025$' data.csv || complain 'the platen covers the body'
modulus() { awk -F, '$1 == "elastic" && $3 == "E" { print $4 }' "$1"; }
expect 0 'samples strain the body between the plates by more than 30 %' data.csv --body body.ply --fix nu=0 -o bar.model
flat .err | grep -q 'bonded to both plates; where its faces slide, E is 1.00 times this' || complain 'what bonding does is said'
awk -v E="$(modulus bar.model)" 'BEGIN { exit !(E > 29.7e3 && E < 30.3e3) }' || complain "E = $(modulus bar.model) Pa, not 30 kPa"
"$bin/hs-simulate" data.csv --body body.ply --model bar.model -o forces.csv 2>.err
[[ $? == 0 ]] && grep -q 'beyond what was verified' .err || complain 'simulated forces are marked'
(($(grep -c '^[12],' forces.csv) == $(grep -c '^[12],' data.csv))) || complain 'every row has its force'
# What acts under a part of the surface cannot be told.
"$bin/hs-diagnose" data.csv --body body.ply --model bar.model -o effects.csv 2>.err
grep -q ',tip,not testable,.*the tool covers the whole body' effects.csv || complain 'a tip is not testable'
grep -q ',missing,' effects.csv && complain 'nothing is missing in a bar'

refused() { # CODE TEXT COMMAND...
  local code=$1 text=$2 got
  shift 2
  "$@" >out 2>err
  got=$?
  ((got == code)) && grep -qF -- "$text" err && [[ $(wc -l <err) == 1 ]] || { complain "$got, not $code: $*"; cat err; }
}
refused 2 'does not cover the block' "$bin/hs-import" bar.csv --block 50x30mm --tool platen --tool-radius 20mm
refused 2 'needs the body between the plates' "$bin/hs-import" bar.csv --tool platen
refused 2 'neither three nor two positive lengths' "$bin/hs-import" bar.csv --block 50mm --tool platen
refused 3 'simulate it without a live loop' "$bin/hs-simulate" -q --live data.csv --body body.ply --model bar.model --tool-radius 25mm
((failures == 0))
