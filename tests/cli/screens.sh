#!/usr/bin/env bash
# screens.sh BIN: what each tool shows on a terminal: the verdict first, at most 24 lines of 80 columns, no number
# that is none; its result only by -o -; and the same as JSON where it has --json, as its schema says. Lists of
# hs: every tool once.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"
need script
/usr/bin/python3 -c 'import jsonschema' || { echo 'screens: python3-jsonschema is missing (share/install-deps.sh --tests)' >&2; exit 1; }
export PATH=$bin:$PATH TERM=xterm LC_ALL=C.UTF-8

hs-tetmesh -q box.off --order 1 --max-volume 2e-8 -o block.ply || exit 1
box_scan >scan.csv
box_presses 12 2e-4 >motion.csv
printf 'effect,region,parameter,value\nelastic,0,E,8000\nelastic,0,nu,0.4\n' >truth.csv
hs-simulate -q motion.csv --body block.ply --model truth.csv --rim-edge 0.3 --add-noise 0.002 -o data.csv || exit 1
hs-identify -q data.csv --body block.ply --rim-edge 0.3 --folds 0 --library lab.db --material foam -o model.csv || exit 1
hs-simulate -q data.csv --body block.ply --model model.csv --rim-edge 0.3 -o forces.csv || exit 1
awk -F, -v OFS=, '/^#/ || !n++ { print; next } { $11 *= 1.3; print }' forces.csv >wrong.csv
awk 'BEGIN { print "# tool_radius: 0.004\nx,y,z,E,nu,E_std,nu_std,n"
  for (i = 0; i < 12; ++i) printf "%g,%g,0.04,%g,0.4,200,0.02,30\n", 0.008 + 0.015 * (i % 4), 0.008 + 0.017 * int(i / 4), i % 4 < 2 ? 8000 : 20000 + i }' >samples.csv
awk 'BEGIN { print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz,fx,fy,fz"
  for (i = 0; i < 400; ++i) { d = 0.001 * sin(i / 90); printf "1,%.3f,0.03,0.025,0.04,0,0,%.9g,0,0,%.9g\n", i / 1000, -d, 90 * d } }' >fast.csv
awk -F, -v OFS=, '/^[#p]/ { print; next } $2 * 1000 % 40 < 0.5 { $11 *= 1.2; print }' fast.csv >slow.csv
awk 'BEGIN { print "Time [s],Travel [mm],Force [N]"; for (i = 0; i <= 40; ++i) printf "%g,%g,%g\n", i / 10, i / 20, i / 30 }' >machine.csv
printf 'name,body,data\none,block.ply,data.csv\n' >manifest.csv
hs-calibrate -q --plan turns.csv --plan-poses 12 || exit 1
awk -F, -v OFS=, '$1 == "pose" { print "qw,qx,qy,qz,fx,fy,fz"; next } { print $2, $3, $4, $5, 4 * $6 + 0.001 * ($1 % 3), 4 * $7 + 0.2, 4 * $8 }' turns.csv >poses.csv

# TOOL, what its result begins with, its arguments; the tools of a line are tried in turn.
commands() {
  cat <<'END_OF_COMMANDS'
hs-scan2ply|ply|scan.csv --unit mm --ascii
hs-reconstruct|ply|box.off --ascii
hs-tetmesh|ply|box.off --ascii
hs-calibrate|#|poses.csv --plan more.csv
hs-calibrate|#|poses.csv --rigid data.csv
hs-import|#|machine.csv --block 60x50x40mm --tool-radius 4mm
hs-identify|#|data.csv --body block.ply --rim-edge 0.3 --folds 2
hs-identify|#|data.csv --body block.ply --acfm 1
hs-simulate|#|data.csv --body block.ply --model model.csv --rim-edge 0.3
hs-simulate|#|data.csv --body block.ply --model model.csv --own-mesh
hs-compare|#|data.csv --simulated forces.csv
hs-compare|#|data.csv --simulated wrong.csv
hs-diagnose|#|data.csv --body block.ply --model model.csv --rim-edge 0.3 --flips 99
hs-plan|#|data.csv --body block.ply --rim-edge 0.3 --presses 2
hs-cluster|#|samples.csv
hs-library|entry,|lab.db
hs-library|#|lab.db --show 1
hs-fuse|#|fast.csv --slow slow.csv --delay 0.05
hs-fuse|#|fast.csv --slow slow.csv --delay 0.05 --exact fast.csv
hs-export|**|model.csv --body block.ply --data data.csv --format calculix
hs-check|effect,|model.csv --golden model.csv
hs-check|effect,|model.csv --golden truth.csv
hs-batch|name,|manifest.csv --out nothing
END_OF_COMMANDS
}
# What a command writes to a terminal of which both standard output and standard error are one.
on_terminal() { script -qec "stty cols 80; $*" /dev/null </dev/null | tr -d '\r'; }
screen_of() { # TOOL FILE: lines without colours
  sed 's/\x1b\[[0-9;]*[A-Za-z]//g' "$2" >plain
  [[ $(grep -v "^$1: " plain | head -c 3) =~ ^(✓|✗|\?) ]] || { complain "$1: no verdict first"; cat plain; }
  (($(wc -l <plain) <= 24)) || { complain "$1: $(wc -l <plain) lines"; cat plain; }
  local wide
  wide=$(grep -v "^Next: \|^$1: " plain | sed 's/[^ -~]/x/g' | awk 'length > 80') # a letter may be several bytes
  [[ -z $wide ]] || complain "$1: wider than 80 columns: $wide"
  ! grep -Eiw -- '-?(nan|inf)' plain || complain "$1 tells a number that is none"
}

tried=
while IFS='|' read -r tool begins arguments; do
  tried+=" $tool"
  on_terminal "$tool $arguments 2>told" >shown
  [[ ! -s shown ]] || { complain "$tool shows its result without -o -"; head -3 shown; }
  screen_of "$tool" told
  grep -q -- ' -o' told || complain "$tool does not say where its result went"
  on_terminal "$tool $arguments -o - 2>/dev/null" >shown
  [[ $(head -c ${#begins} shown) == "$begins" ]] || { complain "$tool -o - shows no result"; head -3 shown; }
  on_terminal "$tool $arguments -q" >shown
  [[ $tool == hs-check && -s shown ]] || [[ ! -s shown ]] || { complain "$tool -q speaks"; head -3 shown; }
  "$tool" --help | grep -q -- '^ *--json ' || { complain "$tool has no --json"; continue; }
  "$tool" $arguments --json answer.json -q -o result >/dev/null 2>&1
  schema=$root/share/schemas/$tool.schema.json
  [[ -e $schema ]] || schema=$root/share/schemas/summary.schema.json
  /usr/bin/python3 -W ignore -m jsonschema -i answer.json "$schema" 2>err || complain "$tool --json is not what $schema says"
  rm -f answer.json result
done < <(commands)

# A live stream is a conversation: it answers on the terminal.
hs >list
for path in "$bin"/hs-*; do
  tool=${path##*/}
  [[ $tool != hs-sample ]] || continue
  [[ $(grep -c "^  $tool " list) == 1 ]] || complain "hs does not list $tool once"
  [[ " $tried " == *" $tool "* || $tool == hs-link ]] || complain "$tool is not tried on a terminal"
done
awk 'length > 80' list >wide && [[ ! -s wide ]] || complain 'the list is wider than 80 columns'
cmp -s <(hs help) list || complain 'hs help is another list'
for name in 'identify' 'hs-identify' 'help identify'; do
  cmp -s <(hs $name) <(hs-identify -h) || complain "hs $name is not hs-identify -h"
done
hs help idendify 2>err
[[ $? == 2 ]] && grep -q "did you mean 'identify'" err || complain 'a tool that is not there'
((failures == 0)) && echo "screens: passed,$tried"
exit $((failures > 0))
