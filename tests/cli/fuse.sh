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
flat err | grep -q '132 slow forces taken' || complain 'the slow forces are not counted'
flat err | grep -o '[a-z]* error [0-9.]* N' | awk '{ e[$1] = $3 }
  END { exit !(e["fused"] > 0 && e["fused"] < 0.5 * e["alone"] && e["fused"] < 0.5 * e["held"] && e["fused"] < 0.5 * e["extrapolated"]) }' ||
  complain 'the fused force is not the best'
[[ $(grep '^press' fused.csv) == *,fz,sdx,sdy,sdz ]] || complain 'no standard deviations'
"$bin/hs-fuse" fast.csv --slow slow.csv --delay 0.03 --parameters filter.csv -q -o again.csv 2>err ||
  complain 'its own parameters are not read'
cmp -s fused.csv again.csv || complain 'the same parameters give other forces'

# Live: finite elements of a stiffer body beside the analytical model, line by line at the clock's pace.
"$bin/hs-tetmesh" box.off --edge 0.02 -q -o body.ply || complain 'no body'
printf 'effect,region,parameter,value,unit\nelastic,0,E,20000,Pa\nelastic,0,nu,0.4,1\n' >model.csv
awk 'BEGIN { print "# tool_radius: 0.004"; print "press,t,x,y,z,ux,uy,uz"
  for (p = 1; p <= 2; ++p) for (i = 0; i <= 400; ++i)
    printf "%d,%.3f,0.03,0.025,0.04,%.9g,0,%.9g\n", p, 0.001 * i, 0.0003 * i / 400, -0.003 * sin(3.14159 * i / 400) ^ 2 }' >motion.csv
"$bin/hs-simulate" motion.csv --body body.ply --model model.csv --full --own-mesh -q -o truth.csv 2>err ||
  complain 'no finite elements'
awk -F, -v OFS=, '/^#/ || !h++ { print; next } { for (k = 9; k <= 11; ++k) $k *= 0.8; print }' truth.csv >soft.csv
"$bin/hs-identify" soft.csv --body body.ply --acfm 0 -q -o acfm.csv 2>err || complain 'no analytical model'
cat motion.csv | "$bin/hs-fuse" --live - --body body.ply --model model.csv --acfm-model acfm.csv 2>err | cat >live.csv
[[ $(grep -c '^[0-9]' live.csv) == 802 ]] || complain 'not every line was answered'
grep -q '^hs-fuse: finite elements: [0-9]* samples' err && grep -q 'slow forces taken' err ||
  complain 'what the finite elements did is not told'
# For a hand: no force above its limit, zero at the end.
"$bin/hs-fuse" --live motion.csv --hand --max-force 0.1 --rate 1000 --body body.ply --model model.csv --acfm-model acfm.csv \
  >hand.csv 2>err || complain 'no forces for a hand'
awk -F, '/^[0-9]/ { if (sqrt($9 * $9 + $10 * $10 + $11 * $11) > 0.1) bad = 1; if (int($14) % 2 == 1) ++cut; ++n; f = $11 }
  END { exit bad || !cut || n != 803 || f != 0 }' hand.csv || complain 'a hand may feel more than its limit'
grep -q '^hs-fuse: safety: force cut in' err || complain 'that forces were cut is not said'
"$bin/hs-simulate" motion.csv --model acfm.csv -q -o alone.csv 2>err
distance() { # FILE: of its forces to the finite elements'
  paste -d, <(grep '^[0-9]' truth.csv | cut -d, -f9-11) <(grep '^[0-9]' "$1" | cut -d, -f9-11) |
    awk -F, '{ s += ($1 - $4) ^ 2 + ($2 - $5) ^ 2 + ($3 - $6) ^ 2 } END { print sqrt(s / NR) }'
}
# However late the finite elements are: never worse than without them.
awk -v live="$(distance live.csv)" -v alone="$(distance alone.csv)" 'BEGIN { exit !(alone > 0 && live <= 1.05 * alone) }' ||
  complain "the live force is worse than the analytical model's: $(distance live.csv), $(distance alone.csv)"

refuse() { # CODE TEXT ARGUMENTS...
  local code=$1 text=$2 got
  shift 2
  "$bin/hs-fuse" "$@" -o refused.csv 2>err </dev/null
  got=$?
  ((got == code)) && grep -qF -- "$text" err && [[ $(wc -l <err) == 1 && ! -e refused.csv ]] ||
    complain "exit $got, not $code with '$text': $*"
}
refuse 2 '--slow is required' fast.csv
refuse 2 '--live needs --acfm-model' --live motion.csv --body body.ply --model model.csv
refuse 2 'is of whole recordings' --live motion.csv --body body.ply --model model.csv --acfm-model acfm.csv --delay 0.1
refuse 2 '--stepped is of whole recordings' --live motion.csv --body body.ply --model model.csv --acfm-model acfm.csv --stepped slow.csv
refuse 2 'is of the live mode' fast.csv --slow slow.csv --rate 100
refuse 2 'leave one of them out' fast.csv --slow slow.csv --learn a.csv --parameters filter.csv
sed 's/^3,/4,/' slow.csv >other.csv
refuse 3 'other.csv:94: press 4 is not in fast.csv' fast.csv --slow other.csv
head -5 slow.csv >few.csv
refuse 3 '4 slow forces are too few to learn from' fast.csv --slow few.csv --learn a.csv
awk -F, 'NR == 1 { print $0 ",arrives"; next } { print $0 "," $2 - 0.01 }' slow.csv >early.csv
refuse 3 'early.csv:2: arrives is' fast.csv --slow early.csv
awk -F, -v OFS=, 'NR > 1 { $8 = -0.005 * sin(9 * $2) ^ 2 } 1' slow.csv >other.csv
refuse 3 'off those of fast.csv at the same times' fast.csv --slow other.csv --parameters filter.csv
head -40 slow.csv >short.csv
refuse 3 'short.csv: it has 39 rows, slow.csv has 138' fast.csv --slow slow.csv --stepped short.csv --parameters filter.csv
awk -F, -v OFS=, 'NR == 9 { $2 += 0.001 } 1' slow.csv >shifted.csv
refuse 3 'shifted.csv:9: its press, t or displacement is not that of the row in slow.csv' fast.csv --slow slow.csv --stepped shifted.csv --parameters filter.csv
awk -F, -v OFS=, 'NR > 1 { $8 /= 2 } 1' slow.csv >half.csv
refuse 3 'its press, t or displacement is not that of the row in slow.csv' fast.csv --slow slow.csv --stepped half.csv --parameters filter.csv
sed 's/^noise,x,[^,]*/noise,x,-1/' filter.csv >bad.csv
refuse 3 'noise = -1 is out of its bounds' fast.csv --slow slow.csv --parameters bad.csv

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
