#!/usr/bin/env bash
# fuse.sh BIN: a fast source put right by a slow, late one; what is told and what is refused.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"

# The truth stiffens, the fast source does not; the slow one is the truth every 20 ms.
awk 'BEGIN {
  head = "press,t,x,y,z,ux,uy,uz,fx,fy,fz"
  for (k = 0; k < 3; ++k) print head >(k == 0 ? "exact.csv" : k == 1 ? "fast.csv" : "slow.csv")
  for (p = 1; p <= 3; ++p) for (i = 0; i <= 900; ++i) {
    t = 0.001 * i; u = 0.005 * sin(3.14159 * t / 0.9) ^ 2
    line = sprintf("%d,%.3f,0,0,0.04,0,0,%.9g,0,0,", p, t, -u)
    printf "%s%.9g\n", line, 500 * u * (1 + 60 * u) >"exact.csv"
    printf "%s%.9g\n", line, 450 * u >"fast.csv"
    if (i % 20 == 0) printf "%s%.9g\n", line, 500 * u * (1 + 60 * u) >"slow.csv"
  }
}'
"$bin/hs-fuse" fast.csv --slow slow.csv --delay 0.03 --learn filter.csv --exact exact.csv -o fused.csv 2>err ||
  complain 'not fused'
grep -q '^hs-fuse: 132 slow forces taken' err || complain 'the slow forces are not counted'
awk '/^hs-fuse:   / { for (i = 1; i < NF; ++i) if ($i == "error") { name = $2; e[name] = $(i + 1) } }
  END { exit !(e["fused"] < 0.5 * e["fast"] && e["fused"] < 0.5 * e["slow"]) }' err ||
  complain 'the fused force is not the best'
grep -q ',fz,sdx,sdy,sdz$' fused.csv || complain 'no standard deviations'
"$bin/hs-fuse" fast.csv --slow slow.csv --delay 0.03 --parameters filter.csv -q -o again.csv 2>err ||
  complain 'its own parameters are not read'
cmp -s fused.csv again.csv || complain 'the same parameters give other forces'

refuse() { # CODE TEXT ARGUMENTS...
  local code=$1 text=$2 got
  shift 2
  "$bin/hs-fuse" "$@" -o refused.csv 2>err </dev/null
  got=$?
  ((got == code)) && grep -qF -- "$text" err && [[ $(wc -l <err) == 1 && ! -e refused.csv ]] ||
    complain "exit $got, not $code with '$text': $*"
}
refuse 2 '--slow is required' fast.csv
refuse 2 'leave one of them out' fast.csv --slow slow.csv --learn a.csv --parameters filter.csv
sed 's/^3,/4,/' slow.csv >other.csv
refuse 3 'other.csv:94: press 4 is not in fast.csv' fast.csv --slow other.csv
head -5 slow.csv >few.csv
refuse 3 '4 slow forces are too few to learn from' fast.csv --slow few.csv --learn a.csv
awk -F, 'NR == 1 { print $0 ",arrives"; next } { print $0 "," $2 - 0.01 }' slow.csv >early.csv
refuse 3 'early.csv:2: arrives is' fast.csv --slow early.csv
sed 's/^noise,x,[^,]*/noise,x,-1/' filter.csv >bad.csv
refuse 3 'noise = -1 is out of its bounds' fast.csv --slow slow.csv --parameters bad.csv

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
