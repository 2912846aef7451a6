#!/usr/bin/env bash
# check-tool.sh BIN SOURCE: hs-import as a command: exit codes, outputs that are complete or absent, and the
# shell recipes of share/examples/import.
set -euo pipefail
export PATH="$1:$PATH"
recipes=$2/share/examples/import
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
fail() { echo "check-tool: $*"; exit 1; }

# A ramp of 1 mm/s after 2 mm of air, then a hold; 20 mN/mm and a little repeatable noise.
awk 'BEGIN {print "Zeit;Standardweg;Standardkraft\ns;mm;N"
  for (i = 0; i < 240; ++i) {t = i * 0.05; s = t < 6 ? t : 6; d = s > 2 ? s - 2 : 0
    line = sprintf("%.2f;%.3f;%.4f", t, s, 0.02 * d + 0.0005 * sin(i * i)); gsub(/\./, ",", line); print line}}' >machine.csv

expect() { # CODE TEXT-ON-STANDARD-ERROR COMMAND...
  local want=$1 text=$2 code=0
  shift 2
  "$@" >out 2>err || code=$?
  [[ $code == "$want" ]] || { cat err; fail "exit $code, not $want: $*"; }
  [[ -z $text ]] || grep -qF -- "$text" err || { cat err; fail "standard error lacks '$text': $*"; }
}

expect 0 "1 press at 1 position" hs-import machine.csv --tool-radius 4mm --block 90x80x40mm --surface block.ply --scan scan.csv -o data.csv
[[ -s block.ply && -s scan.csv ]] || fail "--surface or --scan wrote nothing"
grep -q '^press,t,x,y,z,ux,uy,uz,fx,fy,fz,contact$' data.csv || fail "wrong header: $(grep -v '^#' data.csv | head -n 1)"
grep -q '^# tool_radius: 0.004$' data.csv || fail "no tool_radius"
awk -F, '!/^#/ && $1 == 1 && $12 == 0 {++air} END {exit !(air > 35 && air < 45)}' data.csv || fail "the air is not 40 samples"

expect 0 "" hs-import machine.csv --list
grep -q '^Standardkraft  *N  *force$' out || { cat out; fail "--list does not name the force"; }
expect 0 "presses" bash -c 'cat machine.csv machine.csv | hs-import --tool-radius 4mm -o two.csv'
[[ $(grep -v '^[#p]' two.csv | cut -d, -f1 | sort -u | wc -l) == 2 ]] || fail "two files joined are not two presses"

expect 2 "--block" hs-import machine.csv --surface block2.ply
expect 3 "no column holds a force" hs-import machine.csv --column skip=Standardkraft -o bad.csv
expect 2 "is no length" hs-import machine.csv --tool-radius wide
expect 2 "not on the top" hs-import machine.csv --block 90x80x40mm --at 1,0,0.04
sed 's/^1,00;.*/1,00;oops;0,1/' machine.csv >faulty.csv
expect 3 "'oops' (line" hs-import faulty.csv -o bad.csv
{ echo '# tool_radius: wide'; cat machine.csv; } >wide.csv
expect 3 "wide.csv: tool_radius: 'wide' is no length" hs-import wide.csv -o bad.csv
{ echo '# tool_radius: 4 m'; cat machine.csv; } >large.csv
expect 3 "tool_radius 4 is not between 1e-6 and 1 m" hs-import large.csv -o bad.csv
[[ ! -e bad.csv ]] || fail "a refused table left an output"

if command -v hs-tetmesh >/dev/null; then
  sh "$recipes/machine.sh" 90x80x40mm 4mm machine.csv 2>err || { cat err; fail "machine.sh"; }
  [[ -s body.ply ]] || fail "machine.sh made no body"
fi
echo "hs-import and its recipes: as documented"
