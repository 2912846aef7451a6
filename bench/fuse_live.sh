#!/usr/bin/env bash
# fuse_live.sh BIN FOLDER [REPEATS] [RATE]: hs-fuse --live at RATE (1000) lines a second, fed by another
# process through a pipe, on the organ that share/examples/thesis/heart.sh has left in FOLDER; its fast motion
# so many times over (5), with 0.2 s of air between. Prints the error against the exact solution beside that of
# the analytical model alone. Recorded in bench/results/fuse-live.txt (bench/record.sh).
set -euo pipefail
bin=$(cd "$1" && pwd) heart=$(cd "$2" && pwd) repeats=${3:-5} rate=${4:-1000}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
again() { # FILE: its presses so many times, one after the other
  awk -F, -v OFS=, -v repeats="$repeats" '
    /^#/ || !head { if (!/^#/) head = 1; print; next }
    $1 != press { base = end + 0.2; press = $1 }
    { row[++n] = $0; at[n] = base + $2; last = base + $2; end = last; id[n] = $1; if ($1 > most) most = $1 }
    END { for (k = 0; k < repeats; ++k) for (i = 1; i <= n; ++i) {
      $0 = row[i]; $1 = id[i] + k * most; $2 = sprintf("%.6f", at[i] + k * (last + 0.2)); print } }' "$1"
}
again "$heart/fast.csv" >motion.csv
again "$heart/fast.exact.csv" >exact.csv
"$bin/hs-simulate" motion.csv --model "$heart/acfm.csv" -q -o alone.csv
cat motion.csv | "$bin/hs-fuse" --live - --body "$heart/organ.ply" --model "$heart/organ.csv" \
  --acfm-model "$heart/acfm.csv" --parameters "$heart/filter.csv" --rate "$rate" 2>said | cat >fused.csv
sed 's/^hs-fuse: //' said
error() { # FILE: root mean square of a component, and the largest step in a millisecond
  paste -d, <(grep '^[0-9]' exact.csv | cut -d, -f1,9-11) <(grep '^[0-9]' "$1" | cut -d, -f9-11) |
    awk -F, '{ s += ($2 - $5) ^ 2 + ($3 - $6) ^ 2 + ($4 - $7) ^ 2; n += 3
        d = sqrt(($5 - x) ^ 2 + ($6 - y) ^ 2 + ($7 - z) ^ 2); if ($1 == press && d > step) step = d
        press = $1; x = $5; y = $6; z = $7 }
      END { printf "%-22s %8.4f %14.4f\n", name, sqrt(s / n), step }' name="$2"
}
printf '%-22s %8s %14s\n' '' 'error N' 'step N per ms'
error fused.csv 'fused, live'
error alone.csv 'analytical model alone'
