#!/usr/bin/env bash
# match.sh BIN [NU,NU...]: hs-export --match against CalculiX (calculix-ccx), which solves each deck. A block, an
# organ-like lump and the body of the shipped phantom's scan, each as hs-tetmesh makes it by default, pressed by a flat
# tool of 4 mm at six places, each held out by its own export. A row a press: the force of hapsim (hs-simulate), what
# CalculiX has of the default deck and of the matched one, each with its error in %, what the matched deck says of
# itself, and its size. Ends with 1 where a matched force is more than 5 % off, or more than 1 % from what was said.
# Recorded in bench/results/match.txt (bench/record.sh).
set -euo pipefail
[[ -n ${1-} && -x $1/hs-export ]] || { echo "usage: match.sh BIN [NU,NU...]" >&2; exit 2; }
bin=$(cd "$1" && pwd) nus=${2:-0.3,0.45}
examples=$(cd "$(dirname "${BASH_SOURCE[0]}")/../share/examples" && pwd)
command -v ccx >/dev/null || { echo 'match.sh: ccx is not installed (apt-get install calculix-ccx)' >&2; exit 5; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export XDG_CACHE_HOME=$work/cache OMP_NUM_THREADS=1

awk -v what=cuboid -v a=0.12 -v b=0.09 -v c=0.06 -f "$examples/shapes.awk" >block.off
awk -v what=dome -v a=0.045 -v b=0.035 -v c=0.055 -v n=24 -v m=10 -v lobe=0.12 -f "$examples/shapes.awk" >organ.off
"$bin/hs-tetmesh" -q block.off -o block.ply
"$bin/hs-tetmesh" -q organ.off -o organ.ply
"$bin/hs-scan2ply" -q "$examples/phantom/scan.csv" --unit mm | "$bin/hs-reconstruct" -q | "$bin/hs-tetmesh" -q -o phantom.ply

# 2 mm down, some of it aside.
motion() { awk 'BEGIN { print "# tool_radius: 0.004\npress,x,y,z,ux,uy,uz" } { printf "%d,%s,%s,%s,%g,%g,-0.002\n", NR, $1, $2, $3, 5e-4 * (NR % 3 - 1), 3e-4 * (NR % 2) }'; }
printf '%s\n' '0.03 0.03 0.06' '0.09 0.06 0.06' '0.06 0.045 0.06' '0.1 0.02 0.06' '0.02 0.07 0.06' '0.055 0.08 0.06' | motion >block.csv
awk 'BEGIN { split("0.35 0 0.5 1.2 0.6 2.5 0.4 4 0.75 5.2 0.2 3", p, " ")
  for (k = 1; k < 12; k += 2) { r = p[k] * (1 + 0.12 * cos(p[k + 1]))
    print 0.045 * r * cos(p[k + 1]), 0.035 * r * sin(p[k + 1]), 0.055 * sqrt(1 - p[k] ^ 2) } }' | motion >organ.csv
awk -F, '/^[0-9]/ && !($1 in seen) { seen[$1]; if (n++ % 2 == 0 && n < 12) print $3, $4, $5 }' "$examples/phantom/data.csv" | motion >phantom.csv

force() { awk 'NF == 3 && $1 + 0 == $1 { f = -$1 " " (-$2) " " (-$3) } END { print f }' "$1"; } # FILE.dat
solve() { ccx -i "$1" >"$1.log" 2>&1 || { tail -n 5 "$1.log" >&2; exit 4; }; }
printf '%-8s %4s %5s %9s %9s %7s %9s %7s %6s %7s %6s\n' body nu press hapsim,N default '%' matched '%' said tets factor
for nu in ${nus//,/ }; do
  printf 'effect,region,parameter,value\nelastic,0,E,15000\nelastic,0,nu,%s\n' "$nu" >model.csv
  for body in block organ phantom; do
    "$bin/hs-simulate" -q $body.csv --body $body.ply --model model.csv -o forces.csv
    for press in 1 2 3 4 5 6; do
      for deck in default matched; do
        match=()
        [[ $deck == default ]] || match=(--match)
        "$bin/hs-export" -q model.csv --body $body.ply --data $body.csv --press $press "${match[@]}" --format calculix \
          --json $deck.json -o $deck.inp
        solve $deck
      done
      value() { awk -v name="\"$1\":" '$1 == name { found = 1 } found && $1 == "\"value\":" { print $2 + 0; exit }' matched.json; }
      ours=$(awk -F, -v p=$press '/^[0-9]/ && $1 == p { print $(NF - 2), $(NF - 1), $NF }' forces.csv)
      awk -v body=$body -v nu="$nu" -v press=$press -v said="$(value force_error)" -v tets="$(value tetrahedra)" -v factor="$(value modulus_factor)" '
        function size(x, y, z) { return sqrt(x * x + y * y + z * z) }
        { f[NR] = size($1, $2, $3); x[NR] = $1; y[NR] = $2; z[NR] = $3 }
        function error(k) { return 100 * size(x[k] - x[1], y[k] - y[1], z[k] - z[1]) / f[1] * (f[k] < f[1] ? -1 : 1) }
        END {
          printf "%-8s %4s %5d %9.4f %9.4f %7.1f %9.4f %7.2f %6.2f %7d %6.3f\n", body, nu, press, f[1], f[2], error(2), f[3], error(3), 100 * said, tets, factor
        }' <<<"$ours
$(force default.dat)
$(force matched.dat)"
    done
  done
done | tee table
awk '
  function size(x) { return x < 0 ? -x : x }
  {
    before += size($6); after += size($8); ++n
    if (size($6) > worst) worst = size($6)
    if (size($8) > left) left = size($8)
    if (size($8) > 5 || size($8 - $9) > 1 || NF != 11) ++missed
  }
  END {
    printf "%d held-out presses: the default deck %.1f %% off (mean), %.1f %% at most; the matched one %.2f and %.2f %%\n", n, before / n, worst, after / n, left
    if (missed || n == 0) printf "%d not as asked\n", missed
    exit missed > 0 || n == 0
  }' table
