#!/usr/bin/env bash
# slip.sh BIN OUT [FRICTION [NU]]: a tool that slips (0.4 and 0.4) at finite strain, hs-simulate --live --large-strain
# against --full, whose elements slip (of a quarter of a radius at the rim). A block 80 x 60 x 30 mm that stiffens (s =
# 0.2), a tool of 4 mm at places that were not pressed beforehand, up to 0.65 radii deep, where --full ends: straight in
# and out; drawn aside with the depth and out; in, aside as far as it slips, back across and over; in askew, aside
# another way, and out; eight ways from corner to corner that were drawn at random, each at its place, out at last,
# around at one depth, and in and out while it goes on, as (others of) those are that places are pressed along; and five
# of kinds that they are not: out in a spiral, an eight, to and fro ever deeper, by stairs, and a star. Then ways to 2.25
# radii (30 % of the thickness) and back, against --full of half a radius, since no finer elements converge there:
# straight, askew with a turn, four drawn at random, and (kinds that were not pressed) to and fro ever deeper and a spiral.
# Of every motion, over its rows: the error of the force over it (floor 5 % of the largest), how many of the rows 1.96
# times the stated uncertainty covers (a motion whose elements do not converge is said to be, and counts nowhere), and the same error of the law of a held tool; then the same of all rows, and what
# a step of a millisecond takes along the random ways, also of a body that relaxes. Places stay in OUT/cache. Recorded
# in bench/results/large-strain.txt (bench/record.sh).
set -euo pipefail
(($# >= 2 && $# <= 4)) || { echo 'usage: slip.sh BIN OUT [FRICTION [NU]]' >&2; exit 2; }
friction=${3:-0.4} nu=${4:-0.4}
bin=$(cd "$1" && pwd)
mkdir -p "$2" && cd "$2"
export XDG_CACHE_HOME=$PWD/cache
awk 'BEGIN { X = 0.08; Y = 0.06; Z = 0.03; print "OFF\n8 12 0"
  for (k = 0; k < 2; k++) for (j = 0; j < 2; j++) for (i = 0; i < 2; i++) print i * X, j * Y, k * Z
  print "3 0 2 1\n3 1 2 3\n3 4 5 6\n3 5 7 6\n3 0 1 4\n3 1 5 4\n3 2 6 3\n3 3 6 7\n3 0 4 2\n3 2 4 6\n3 1 3 5\n3 3 7 5" }' >block.off
"$bin/hs-tetmesh" -q block.off --edge 0.0042 -o block.ply
printf '%s\n' effect,region,parameter,value,unit,std_error,lower,upper,state elastic,0,E,20000,Pa,,1,1e12,fixed \
  elastic,0,nu,$nu,1,,0,0.499,fixed hyperelastic,0,s,0.2,1,,0,1.2,fixed hyperelastic,0,finite,1,1,,0,1,fixed >held.csv
{ cat held.csv; echo friction,0,mu,$friction,1,,0.001,1000,fixed; } >slips.csv
printf '# tool_radius: 0.004\npress,x,y,z,ux,uy,uz\n0,0.04,0.034,0.03,0,0,0\n' >contacts.csv
deep=(deep_straight deep_askew deep_wander{1..4} deep_zigzag deep_spiral)
for motion in straight drawn aside askew wander{1..8} circle pecks spiral eight zigzag stairs star "${deep[@]}"; do
  # Ways aside go with the friction, since a tool slips by so much.
  awk -v motion=$motion -v far="$friction" 'BEGIN {
    far = far > 0.5 ? 1.25 : far / 0.4
    at = motion == "askew" ? "0.0321,0.0287,0.03" : "0.04,0.034,0.03"; n = 0
    if (motion ~ /^wander/) { seed = 7919 * substr(motion, 7); at = sprintf("%.4f,%.4f,0.03", 0.032 + 0.014 * draw(), 0.026 + 0.014 * draw()) }
    if (motion ~ /^deep_w/) { seed = 6007 * substr(motion, 12); at = sprintf("%.4f,%.4f,0.03", 0.032 + 0.014 * draw(), 0.026 + 0.014 * draw()) }
    if (motion ~ /^deep_[sz]/) at = "0.0387,0.0313,0.03"
    if (motion == "deep_askew") at = "0.0356,0.0279,0.03"
    if (motion == "circle") at = "0.0387,0.0313,0.03"
    if (motion == "pecks") at = "0.0356,0.0279,0.03"
    if (motion == "spiral") at = "0.0431,0.0336,0.03"
    if (motion == "eight") at = "0.0371,0.0302,0.03"
    if (motion == "zigzag") at = "0.0412,0.0291,0.03"
    if (motion == "stairs") at = "0.0339,0.0331,0.03"
    if (motion == "star") at = "0.0427,0.0318,0.03"
    print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz"
    row(0, 0, 0)
    if (motion == "straight") { for (i = 1; i <= 6; ++i) row(0.1 * i, 0, 0); for (i = 5; i >= 1; --i) row(0.1 * i, 0, 0) }
    if (motion == "drawn") { for (i = 1; i <= 6; ++i) row(0.1 * i, 0.067 * i, 0); for (i = 5; i >= 1; --i) row(0.1 * i, 0.067 * i, 0) }
    if (motion == "aside") { for (i = 1; i <= 5; ++i) row(0.1 * i, 0, 0); for (i = 1; i <= 4; ++i) row(0.5, 0.1 * i, 0)
      for (i = 3; i >= -3; --i) row(0.5, 0.1 * i, 0) }
    if (motion == "askew") { for (i = 1; i <= 5; ++i) row(0.13 * i, 0.05 * i, 0.02 * i)
      for (i = 1; i <= 5; ++i) row(0.65, 0.25 - 0.02 * i, 0.1 + 0.08 * i); for (i = 4; i >= 1; --i) row(0.13 * i, 0.15, 0.5) }
    if (motion == "circle") { for (i = 1; i <= 5; ++i) row(0.1 * i, 0.04 * i, 0)
      for (i = 1; i <= 23; ++i) row(0.5, 0.2 * cos(0.4 * i), 0.2 * sin(0.4 * i)) }
    if (motion == "pecks") for (i = 0; i < 4; ++i) { peck(0.2, 0.06 * i); peck(0.4, 0.06 * i + 0.01)
      peck(0.55, 0.06 * i + 0.03); peck(0.35, 0.06 * i + 0.045); peck(0.15, 0.06 * i + 0.055) }
    if (motion == "spiral") { for (i = 1; i <= 5; ++i) row(0.12 * i, 0, 0)
      for (i = 1; i <= 22; ++i) row(0.6 - 0.02 * i, 0.016 * i * cos(0.6 * i), 0.016 * i * sin(0.6 * i)) }
    if (motion == "eight") { for (i = 1; i <= 5; ++i) row(0.09 * i, 0, 0)
      for (i = 1; i <= 21; ++i) row(0.45, 0.25 * sin(0.35 * i), 0.15 * sin(0.7 * i)) }
    if (motion == "zigzag") for (i = 0; i < 26; ++i) row(0.1 + 0.02 * i, 0.166 * cos(0.8 * i), 0.07 * cos(0.8 * i))
    if (motion == "stairs") { steps = split("0.2 0.2 0.4 0.4 0.6 0.6 0.4 0.4 0.2 0.2 0.1", depth, " ")
      split("0 0.1 0.1 0.2 0.2 0.32 0.32 0.12 0.12 0.02 0.02", side, " ")
      for (i = 1; i <= steps; ++i) for (half = 0.5; half >= 0; half -= 0.5) {
        s = side[i] - half * (side[i] - side[i - 1]); row(depth[i] - half * (depth[i] - depth[i - 1]), -0.8 * s, 0.6 * s) } }
    if (motion == "star") { for (i = 1; i <= 5; ++i) row(0.1 * i, 0, 0)
      for (k = 0; k < 5; ++k) for (i = 1; i <= 4; ++i) { r = 0.12 * (i < 3 ? i : 4 - i); row(0.5, r * cos(0.3 + 2.4 * k), r * sin(0.3 + 2.4 * k)) } }
    if (motion == "deep_straight") { for (i = 1; i <= 15; ++i) row(0.15 * i, 0, 0); for (i = 14; i >= 1; --i) row(0.15 * i, 0, 0) }
    if (motion == "deep_askew") { for (i = 1; i <= 10; ++i) row(0.15 * i, 0.05 * i, 0.02 * i)
      for (i = 1; i <= 8; ++i) row(1.5, 0.5 - 0.1 * i, 0.2); for (i = 9; i >= 2; --i) row(0.15 * i, -0.3, 0.2) }
    if (motion == "deep_zigzag") { for (i = 1; i <= 20; ++i) row(0.1 * i, 0.25 * sin(0.9 * i), 0.1 * sin(0.9 * i)); for (i = 9; i >= 1; --i) row(0.2 * i, 0.1, 0) }
    if (motion == "deep_spiral") { for (i = 1; i <= 11; ++i) row(0.15 * i, 0, 0)
      for (i = 1; i <= 25; ++i) row(1.65 - 0.06 * i, 0.018 * i * cos(0.6 * i), 0.018 * i * sin(0.6 * i)) }
    if (motion ~ /^deep_w/) wander(0.6, 0.6, 1.3, 0.2, 0.15)
    if (motion ~ /^wander/) wander(0.35, 0.3, 0.33, 0.12, 0.11)
  }
  function wander(aside, low, range, out, apart) {
    for (leg = 1; leg <= 4; ++leg) {
      r = aside * sqrt(draw()); turn = 6.2832 * draw(); to = leg < 4 ? low + range * draw() : out
      dp = r * cos(turn) - p; dq = r * sin(turn) - q; dd = to - deep
      steps = int(sqrt(dp ^ 2 + dq ^ 2 + dd ^ 2) / apart) + 1
      for (i = 1; i <= steps; ++i) row(deep + dd * i / steps, p + dp * i / steps, q + dq * i / steps)
      deep = to; p += dp; q += dq }
  }
  function peck(d, p) { row(d, p, 0.6 * p) }
  function draw() { seed = (16807 * seed) % 2147483647; return seed / 2147483647 }
  function row(d, p, q) { p *= far; q *= far; printf "0,%.2f,%s,%.7f,%.7f,%.7f\n", 0.1 * n++, at, 0.004 * p, 0.004 * q, -0.004 * d }' >$motion.csv
  [[ $motion == deep_* ]] && edge=0.5 || edge=0.25
  "$bin/hs-simulate" -q $motion.csv --body block.ply --model slips.csv --full --rim-edge $edge -o $motion-full.csv ||
    { echo "$motion: elements do not converge"; continue; }
  for model in held slips; do
    "$bin/hs-simulate" -q $motion.csv --body block.ply --model $model.csv --live --large-strain --accuracy 0.05 \
      --contacts contacts.csv --uncertainty -o $motion-$model.csv
  done
  forces() { awk -F, -v OFS=, '/^#/ { next } !("fx" in c) { for (i = 1; i <= NF; ++i) c[$i] = i; next }
    { print $c["fx"], $c["fy"], $c["fz"], "uncertainty" in c ? $c["uncertainty"] : 0 }' "$1"; }
  paste -d, <(forces $motion-full.csv) <(forces $motion-slips.csv) <(forces $motion-held.csv) | awk -F, -v motion=$motion '
    function off(k) { return sqrt(($1 - $k) ^ 2 + ($2 - $(k + 1)) ^ 2 + ($3 - $(k + 2)) ^ 2) }
    { f[NR] = sqrt($1 ^ 2 + $2 ^ 2 + $3 ^ 2); e[NR] = off(5); h[NR] = off(9); s[NR] = 1.96 * $8; if (f[NR] > peak) peak = f[NR] }
    END { for (r = 2; r <= NR; ++r) { u = f[r] > 0.05 * peak ? f[r] : 0.05 * peak; ++n; covered += e[r] <= s[r]
        x = 100 * e[r] / u; within += x <= 2; sum += x; if (x > worst) worst = x
        x = 100 * h[r] / u; held += x; if (x > held_worst) held_worst = x }
      printf "%-13s mean %.2f %% worst %.2f %%, within 2 %%: %d of %d, covered %d; a held tool: mean %.2f %% worst %.2f %%\n",
        motion, sum / n, worst, within, n, covered, held / n, held_worst }'
done | tee told.txt
total() {
  sed 's/[,:;]//g' | awk -v of="$1" '{ within += $11; n += $13; covered += $15; held += $20 * $13; sum += $3 * $13 }
    END { if (n) printf "%-13s mean %.2f %%, within 2 %%: %d of %d (%.0f %%), covered %d (%.0f %%); a held tool: mean %.2f %%\n",
      of, sum / n, within, n, 100 * within / n, covered, 100 * covered / n, held / n }'
}
grep -v ^deep_ told.txt | total all
grep ^deep_ told.txt | total deep

{ cat slips.csv; printf '%s\n' viscoelastic,0,E1,10000,Pa,,0,1e12,fixed viscoelastic,0,tau1,0.5,s,,1e-4,1e5,fixed; } >relaxing.csv
for motion in wander{1..8}; do # rows of 0.1 s, straight between
  awk -F, -v OFS=, -v press=${motion#wander} '!/^0,/ { if (press == 1) print; next }
    n++ { for (i = 1; i <= 100; ++i) print press, sprintf("%.3f", t + i / 1000), $3, $4, $5, x + i * ($6 - x) / 100, y + i * ($7 - y) / 100, z + i * ($8 - z) / 100 }
    { if (n == 1) { $1 = press; print } t = $2; x = $6; y = $7; z = $8 }' $motion.csv
done >steps.csv
for model in slips relaxing; do
  "$bin/hs-simulate" steps.csv --body block.ply --model $model.csv --live --large-strain --accuracy $([[ $model == slips ]] && echo 0.05 || echo 0.1) \
    --contacts contacts.csv -o steps-out.csv 2>&1 | sed -n "s/^hs-simulate: \([0-9]* samples: median\)/step, $model: \1/p"
done
