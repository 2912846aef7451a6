#!/usr/bin/env bash
# bodies.sh BUILD OUT [FROM:TO]: whether intervals hold over bodies: one drawn by each number (body.awk), pressed with
# nothing hidden, with one effect, and every third with a pair, each in turn, seeds and levels by that number (run.sh).
# What hs-diagnose finds of each size lies in OUT/body-N/sizes.csv; coverage.py counts it. Effects that finite
# elements solve one by one are not among them: half an hour a body. Goes on where it was stopped.
# Recorded in bench/results/diagnosis-coverage.txt (bench/record.sh).
set -euo pipefail
build=$1 out=$2 range=${3:-1:60}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
singles=(viscoelastic tip sensor-gain-x hyperelastic friction sensor-drift softening adhesion sensor-lag temperature
  sensor-rotation damper backlash sensor-bias)
pairs=('hyperelastic&viscoelastic' 'viscoelastic&friction' 'sensor-rotation&viscoelastic' 'softening&viscoelastic'
  'sensor-lag&hyperelastic' 'friction&sensor-drift' 'temperature&sensor-gain-x' 'sensor-drift&viscoelastic')
mkdir -p "$out"
for ((n = ${range%:*}; n <= ${range#*:}; ++n)); do
  truths=(nothing "${singles[n % ${#singles[@]}]}")
  ((n % 3)) || truths+=("${pairs[n / 3 % ${#pairs[@]}]}")
  "$here/run.sh" "$build" "$out/body-$n" "$n:$n" 3:10 "${truths[@]}" --object "body-$n" >"$out/body-$n.txt"
done
/usr/bin/env python3 "$here/coverage.py" "$out"/body-*/sizes.csv
