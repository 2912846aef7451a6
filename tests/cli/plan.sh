#!/usr/bin/env bash
# plan.sh BIN: what hs-plan writes and returns: first presses without a recording, presses that go on after one, the end
# of a loop; what it refuses; and the example, a loop of a shell with a simulated robot.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
example=$root/share/examples/explore
. "$(dirname "${BASH_SOURCE[0]}")/tool.sh" "$1/hs-plan"
bin=$(dirname "$tool")
export PATH=$bin:$PATH XDG_CACHE_HOME=$work/cache
of() { sed -n "s/^  \"$2\": \"\{0,1\}\([^\"]*[^\",]\)\"\{0,1\},\{0,1\}\$/\1/p" "$1"; }
awk -v what=cuboid -v a=0.06 -v b=0.05 -v c=0.04 -f "$root/share/examples/shapes.awk" >box.off
hs-tetmesh -q box.off --edge 12mm -o body.ply

# --- Nothing is measured yet.
expect 0 '2 presses to record next' /dev/null --body body.ply --tool-radius 4mm --rim-edge 0.3 --presses 2 -o two.csv --json two.json
[[ $(cut -d, -f1 two.csv | grep '^[0-9]' | uniq | paste -sd ' ') == '1 2' ]] || complain 'two presses'
grep -q '^# tool_radius: 0.004' two.csv || complain 'the tool is in the motion'
[[ $(of two.json reached) == false && $(of two.json aim) == spread && $(of two.json presses) == 0 ]] || complain 'the reason as JSON'
# The same from an empty file whose comments name the tool, and from standard input.
printf '# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz,fx,fy,fz\n' >none.csv
expect 0 '' none.csv --body body.ply --rim-edge 0.3 --presses 2 -o named.csv
cmp -s two.csv named.csv || complain 'the tool by a comment'
"$tool" -q --body body.ply --rim-edge 0.3 --presses 2 <none.csv | cmp -s - two.csv || complain 'standard input and output'
# One after the other, they go on after those that are there, and are as deep as asked for.
awk -F, -v OFS=, '/^#/ { print; next } /^press/ { print $0, "fx,fy,fz"; next } { print $0, 0, 0, $9 ? -500 * $8 : 0 }' two.csv >data.csv
expect 0 'of fewer than 6 presses nothing is settled' data.csv --body body.ply --rim-edge 0.3 --depth 1.5mm -o third.csv
awk -F, 'FNR == 1 { ++file } /^[0-9]/ { if (file == 1) end = $2; else { if ($1 != 3 || $2 <= end) bad = 1; if (-$8 > deep) deep = -$8; ++rows } }
  END { exit bad || !rows || deep > 0.0015001 }' data.csv third.csv || complain 'numbers, times and depth of the third press'

# No press goes through a thin body, whatever is asked for, and none deeper than --depth.
deepest() { awk -F, '/^[0-9]/ { if (-$8 > d) d = -$8 } END { printf "%.2f\n", 1e3 * d }' "$1"; }
awk -v what=cuboid -v a=0.06 -v b=0.05 -v c=0.004 -f "$root/share/examples/shapes.awk" >thin.off
hs-tetmesh -q thin.off --edge 4mm -o thin.ply
expect 0 'the body is thin there' /dev/null --body thin.ply --tool-radius 4mm --rim-edge 0.5 --depth 6mm -o thin.csv --json thin.json
awk -v d="$(deepest thin.csv)" 'BEGIN { exit !(d > 1.9 && d < 2.05) }' || complain "half of 4 mm, got $(deepest thin.csv)"
grep -q 'not 6: the body is thin' thin.json || complain 'shallower presses as JSON'
awk -F, -v OFS=, '/^[0-9]/ { $6 = 0.03 } { print }' data.csv >side.csv
expect 0 '' side.csv --body body.ply --rim-edge 0.3 -o side-next.csv
[[ $(deepest side-next.csv) == 3.00 ]] || complain "sideways is no depth: $(deepest side-next.csv)"
# Times that are not there.
cut -d, -f1,3- data.csv | sed 's/^#,.*//' >no-times.csv && sed -i '1i# tool_radius: 0.004' no-times.csv
expect 0 'no column t' no-times.csv --body body.ply --rim-edge 0.3 -o untimed.csv

# --- The end of a loop.
expect 0 '1 press to record next' data.csv --body body.ply --rim-edge 0.3 --presses 5 --most-presses 3 -o last.csv
expect 1 'cannot be reached with this tool' data.csv --body body.ply --rim-edge 0.3 --steepest 0.1 --tool-radius 17mm --more -o none-left.csv
! grep -q '^[0-9]' none-left.csv || complain 'a motion without a place'
expect 0 'no number of presses' /dev/null --body body.ply --tool-radius 4mm --rim-edge 0.3 --goal E=0.1% -o first.csv
expect 0 'no more presses are asked for' data.csv --body body.ply --rim-edge 0.3 --most-presses 2 -o none-left.csv
! grep -q '^[0-9]' none-left.csv || complain 'a motion without rows'
expect 1 'no more presses are asked for' data.csv --body body.ply --rim-edge 0.3 --most-presses 2 --more -o none-left.csv --json end.json
[[ $(of end.json ended) == true && $(of end.json reached) == false ]] || complain 'ended, and not reached'
expect 0 '' data.csv --body body.ply --rim-edge 0.3 --more -o next.csv

# --- Bad input and use.
expect 2 "--goal: 'E' is no goal" data.csv --body body.ply --goal E
expect 2 "--goal: 'E=3' has no share" data.csv --body body.ply --goal E=3
expect 2 "no effect has" data.csv --body body.ply --goal Ee=3%
expect 2 "asked for twice" data.csv --body body.ply --goal E=3%,elastic.E=2%
expect 0 '' data.csv --body body.ply --rim-edge 0.3 --goal 'elastic E=3%' -o next.csv
expect 2 'unseen=2 for twice the noise' data.csv --body body.ply --goal unseen=0.5
expect 2 '--goal: lump' data.csv --body body.ply --goal lump=2kg
expect 3 'tool_radius' /dev/null --body body.ply
expect 3 'no place is left' /dev/null --body body.ply --tool-radius 40mm
expect 3 "column 'fx' is missing" two.csv --body body.ply
printf 'press,nonsense\n' >junk.csv
expect 3 "column 'x' is missing" junk.csv --body body.ply --tool-radius 4mm
printf 'what is this\n' >junk.csv
expect 3 'junk.csv' junk.csv --body body.ply --tool-radius 4mm
: >empty.csv
expect 0 '1 press to record next' empty.csv --body body.ply --tool-radius 4mm --rim-edge 0.3 -o next.csv
awk -F, -v OFS=, '/^[0-9]/ { $5 += 0.1 } { print }' data.csv >off.csv
expect 3 "off the body's surface" off.csv --body body.ply --rim-edge 0.3
expect 5 'none-there.csv' none-there.csv --body body.ply

# --- Places that nobody has pressed: those that were are left out, and the next press lies where they are foretold worst.
{ printf 'effect,region,parameter,value\nelastic,0,E,15000\nelastic,0,nu,0.42\nelastic,1,E,40000\n'
  printf 'regions,0,x1,0.020\nregions,0,y1,0.025\nregions,1,x1,0.040\nregions,1,y1,0.025\n'; } >halves.csv
expect 0 '' /dev/null --body body.ply --tool-radius 4mm --rim-edge 0.3 --presses 7 -o seven.csv
hs-simulate -q seven.csv --body body.ply --model halves.csv --rim-edge 0.25 --add-noise 0.01 -o halves-data.csv || complain 'presses on two halves'
expect 0 'places that were left out are foretold to' halves-data.csv --body body.ply --rim-edge 0.3 --goal unseen=1.01 -o next.csv --json unseen.json
[[ $(of unseen.json aim) == unseen ]] || complain "the aim: $(of unseen.json aim)"
expect 0 '% of the force' halves-data.csv --body body.ply --rim-edge 0.3 --goal unseen=90% -o next.csv

# --- The example: what is hidden is named, to the size that it has.
mkdir relaxing
if "$example/explore.sh" relaxing >.out 2>.err; then
  grep -q '^ *[0-9]* presses; incomplete: viscoelastic;elastic E .*; reached$' .out || { complain 'the loop names what is hidden'; cat .out; }
  (($(sed -n 's/^ *\([0-9]*\) presses.*reached$/\1/p' .out) <= 12)) || complain 'within twelve presses'
  awk -F, '/^elastic,0,E,/ { E = $4 } /,E1,/ { E1 = $4 } END { exit !(E > 14500 && E < 15500 && E1 > 5700 && E1 < 6300) }' relaxing/model.csv ||
    complain "the model: $(grep free relaxing/model.csv)"
  [[ -s relaxing/report.html ]] || complain 'the report'
else
  complain 'explore.sh fails'
fi
((failures == 0)) && echo 'plan: passed'
exit $((failures > 0))
