#!/usr/bin/env bash
# single_presses.sh BIN OUT: each of the presses of CalculiX's block and ball that hide nothing (E = 20 kPa; OUT
# as bench/open-world/run.sh leaves it with THIN=1) identified alone. One press tells hardly more than E / (1 - nu^2):
# whether the 95 % intervals of E hold all the same, with nu at its bound and not. Recorded in
# bench/results/single-presses.txt (bench/record.sh).
set -euo pipefail
[[ -n ${2-} && -x $1/hs-identify ]] || { echo "usage: single_presses.sh BIN OUT" >&2; exit 2; }
bin=$1 out=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for body in cuboid ball; do
  null=$out/thin-$body.csv
  for press in $(awk -F, '!/^#/ && $1 != "press" && !seen[$1]++ { print $1 }' "$null"); do
    awk -F, -v p="$press" '/^#/ || $1 == "press" || $1 == p' "$null" >"$work/one.csv"
    "$bin/hs-identify" -q "$work/one.csv" --body "$out/$body-stl.ply" --effects elastic --folds 0 -o "$work/model.csv" 2>"$work/said"
    awk -F, -v body="$body" -v press="$press" '$3 == "E" { e = $4; s = $6 } $3 == "nu" { nu = $4; known = $6 != "" }
      END { print body, press, e, s, nu, known }' "$work/model.csv"
  done
done | awk '{ z = log($3 / 20000) * $3 / $4; held = z * z < 1.959963985 ^ 2; kind = $6 ? "inside" : "at its bound"
    ++of[$1 " " kind]; in95[$1 " " kind] += held; if (z * z > worst * worst) worst = z }
  END { for (k in of) printf "%s: E held in %d of %d\n", k, in95[k], of[k]; printf "farthest: %.1f standard errors\n", worst }' | sort
