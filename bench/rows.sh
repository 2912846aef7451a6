#!/usr/bin/env bash
# rows.sh BIN [ROWS...] [--places N] [--truths NAME,...] [--keep FOLDER]: identification and diagnosis as recordings
# grow. The phantom's presses (12 places, 36 presses, simulated with fine contact meshes), or one press of a ramp, a
# hold and a way back at each of N places, sampled to each number of ROWS (7e3, 1e5, 1e6), with noise of 0.02 N,
# simulated on the true surface; identified and diagnosed on the body of the scan, everything prepared. Truths: a
# relaxation, nothing, nothing with noise as large that wanders within 50 ms; with --places a relaxation and friction,
# all on coarser contact meshes; with --truths those, of all that model() has. A line a run: rows as recorded and as
# fitted, processor seconds of all threads, seconds by the clock, peak memory, and of the answer what can be checked:
# how far E1 and tau1 are from the truth, in percent and standard errors, or the verdict and the names. With --keep the
# recordings stay in FOLDER, and are not simulated again by the next call.
# Recorded in bench/results/rows.txt (bench/record.sh).
set -euo pipefail
bin=$(cd "$1" && pwd)
shift
rows=() places=0 keep="" truths=()
while (($#)); do
  case $1 in
    --places) places=$2; shift ;;
    --truths) IFS=, read -ra truths <<<"$2"; shift ;;
    --keep) keep=$2; shift ;;
    *) rows+=("$1") ;;
  esac
  shift
done
((${#rows[@]})) || rows=(7e3 1e5 1e6)
phantom=$(cd "$(dirname "${BASH_SOURCE[0]}")/../share/examples/phantom" && pwd)
if [[ $keep ]]; then
  mkdir -p "$keep" && work=$(cd "$keep" && pwd)
else
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
fi
cd "$work"
export XDG_CACHE_HOME=$work/cache

awk -v what=surface -f "$phantom/geometry.awk" >surface.stl
"$bin/hs-tetmesh" -q surface.stl -o true.ply
"$bin/hs-scan2ply" -q "$phantom/scan.csv" --unit mm | "$bin/hs-reconstruct" -q | "$bin/hs-tetmesh" -q -o body.ply

# Corners of the motion: what lies between is straight.
corners() {
  if ((places == 0)); then
    awk -v what=motion -f "$phantom/geometry.awk"
    return
  fi
  awk -v n="$places" 'BEGIN {
    a = 0.055; b = 0.042; c = 0.038; pi = atan2(0, -1)
    print "# object: phantom\n# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz,contact"
    for (k = 0; k < n; ++k) {
      u = 2.399963 * k; v = pi / 2 - 0.95 * sqrt((k + 0.5) / n)
      x = a * cos(v) * cos(u); y = b * cos(v) * sin(u); z = c * sin(v)
      nx = x / a / a; ny = y / b / b; nz = z / c / c; l = sqrt(nx * nx + ny * ny + nz * nz)
      tl = sqrt(nx * nx + ny * ny); tx = tl > 0 ? -ny / tl : 1; ty = tl > 0 ? nx / tl : 0
      d = 0.002 + 0.002 * (7 * k % 12) / 11
      split("-0.5 0 1 1 1 0 -0.5", q, " "); split("0 0 0 0.5 0.5 0 0", s, " ")
      split("0 0.3 0.6 1 2.5 3 3.3", t, " ")
      for (i = 1; i <= 7; ++i)
        printf "%d,%.3f,%.6f,%.6f,%.6f,%.7f,%.7f,%.7f,%d\n", k, 10 * k + t[i], x, y, z, (-q[i] * nx / l + s[i] * tx) * d,
          (-q[i] * ny / l + s[i] * ty) * d, -q[i] * nz / l * d, (q[i] >= 0) } }'
}
corners >corners.csv
# The same motion in about ROWS rows, evenly in time.
motion() { # ROWS
  awk -F, -v wanted="$1" '
    function end_press(   i, from, steps, k, s) {
      for (i = 2; i <= n; ++i) {
        steps = (t[i] - t[i - 1]) / step; steps = steps < 1 ? 1 : int(steps + 0.5)
        for (k = i == 2 ? 0 : 1; k <= steps; ++k) {
          s = k / steps
          printf "%d,%.9g,%s,%.9g,%.9g,%.9g,%d\n", press, t[i - 1] + s * (t[i] - t[i - 1]), place,
            x[i - 1] + s * (x[i] - x[i - 1]), y[i - 1] + s * (y[i] - y[i - 1]), z[i - 1] + s * (z[i] - z[i - 1]),
            s < 1 ? in_contact[i - 1] && in_contact[i] : in_contact[i] } }
      n = 0
    }
    NR == FNR { if (/^[0-9]/) { if ($1 == last) time += $2 - before; last = $1; before = $2 } next }
    /^[#p]/ { print; next }
    FNR > 1 && $1 != press { end_press(); step = time / wanted }
    { press = $1; place = $3 "," $4 "," $5; ++n; t[n] = $2; x[n] = $6; y[n] = $7; z[n] = $8; in_contact[n] = $9 }
    END { end_press() }' last=- corners.csv press=- corners.csv
}
model() { # what is beside E and nu
  printf 'effect,region,parameter,value\nelastic,0,E,15000\nelastic,0,nu,0.43\n'
  case $1 in
    relaxation) printf 'viscoelastic,0,E1,8000\nviscoelastic,0,tau1,1.2\n' ;;
    friction) printf 'friction,0,mu,0.12\n' ;;
    hyperelastic) printf 'hyperelastic,0,%s\n' s,0.3 finite,1 ;;
    softening) printf 'softening,0,%s\n' s,0.15 m,2 c,1 k,0 rate,0 ;;
    lag) printf 'sensor-lag,0,%s\n' tau,0.02 delay,0 ;;
    layer) printf 'layer,0,thickness,0.003\nlayer,0,ratio,3\n' ;;
    inclusion) printf 'inclusion,0,%s\n' x,0.01 y,0.005 z,0.024 radius,0.008 ratio,8 ;;
    tip) printf 'tip,0,kappa,60\n' ;;
    anisotropic) printf 'anisotropic,0,%s\n' ratio,2 shear,1 tilt,1.4 azimuth,0.3 ;;
    regions) printf '%s\n' elastic,1,E,24000 regions,0,x1,-0.02 regions,0,y1,0 regions,1,x1,0.02 regions,1,y1,0 ;;
    base) printf 'base,0,%s\n' give,0.5 azimuth,0.5 edge,0 ;;
    nothing | wandering) ;;
    *) echo "rows.sh: there is no truth $1" >&2; return 2 ;;
  esac
}
# Noise of 0.02 N in place of white one, each component from the one before in a press; declared.
wandering() {
  awk -F, -v OFS=, 'BEGIN { srand(3) }
    function normal() { return sqrt(-2 * log(1 - rand())) * cos(6.283185307179586 * rand()) }
    /^# simulated/ { print; print "# force_noise: 0.02"; next }
    /^#/ { print; next }
    /^press/ { for (i = 1; i <= NF; ++i) if ($i ~ /^f[xyz]$/) force[++n] = i; print; next }
    { keep = $1 == press ? exp(($1 == press ? t - $2 : 0) / 0.05) : 0; press = $1; t = $2
      for (k = 1; k <= n; ++k) { e[k] = keep * e[k] + sqrt(1 - keep * keep) * 0.02 * normal()
        $force[k] = sprintf("%.7g", $force[k] + e[k]) } print }'
}
# Runs a tool; its times and memory into `took`, what it says into said.
run() {
  if ! /usr/bin/time -f '%U %S %e %M' -o took "$@" 2>said; then
    printf 'failed: %s\n' "$(tail -1 said)"
    return 1
  fi
}
told() { # TRUTH, TOOL, ROWS, answer
  local fitted
  fitted=$(sed -n 's/.* rows are fitted as \([0-9]*\) .*/\1/p' said)
  awk -v truth="$1" -v tool="$2" -v recorded="$3" -v answer="$4" -v fitted="$fitted" '
    END { printf "%-10s %-24s %9d %9d %8.1f %8.1f %7.0f  %s\n", truth, tool, recorded, fitted ? fitted : recorded, $1 + $2,
      $3, $4 / 1024, answer }' took
}
values() { # MODEL
  awk -F, '$3 == "E1" || $3 == "tau1" { true_ = $3 == "E1" ? 8000 : 1.2
    printf "%s %+.2f %% = %+.1f s.e.  ", $3, 100 * ($4 / true_ - 1), ($4 - true_) / $6 }' "$1"
}
verdict() { # DIAGNOSIS
  awk -F, '/^[0-9]+,/ { if ($1 == 0) printf "%s:", $3; else if ($3 == "missing" || $3 == "indistinguishable") printf " %s", $2 }' "$1"
}

printf '%-10s %-24s %9s %9s %8s %8s %7s  %s\n' truth run rows fitted cpu_s clock_s MB answer
chosen=(relaxation nothing wandering) fine=(--rim-edge 0.12) usual=()
((places == 0)) || chosen=(relaxation friction) fine=(--rim-edge 0.25) usual=(--rim-edge 0.3)
((${#truths[@]})) || truths=("${chosen[@]}")
for n in "${rows[@]}"; do
  motion "$n" >motion.csv
  for truth in "${truths[@]}"; do
    model "$truth" >truth.csv
    made=("${fine[@]}")
    [[ $truth != @(layer|inclusion|anisotropic|base|regions) ]] || made=(--rim-edge 0.4)  # whose elements are solved anew
    simulated=("$bin/hs-simulate" -q motion.csv --body true.ply --model truth.csv "${made[@]}")
    data=$truth-$places-$n.csv
    if [[ -s $data ]]; then
      :
    elif [[ $truth == wandering ]]; then
      "${simulated[@]}" | wandering >made.csv && mv made.csv "$data"
    else
      "${simulated[@]}" --add-noise 0.02 -o "$data"
    fi
    count=$(grep -c '^[0-9]' "$data")
    # What is prepared once a body is not counted.
    "$bin/hs-identify" -q "$data" --body body.ply "${usual[@]}" --effects elastic --folds 0 -o m0.csv
    if [[ $truth == relaxation ]]; then
      run "$bin/hs-identify" "$data" --body body.ply "${usual[@]}" --effects elastic,viscoelastic -o m1.csv &&
        told "$truth" hs-identify "$count" "$(values m1.csv)"
      run "$bin/hs-identify" "$data" --body body.ply "${usual[@]}" --effects elastic,viscoelastic --robust huber -o m1.csv &&
        told "$truth" 'hs-identify, huber' "$count" "$(values m1.csv)"
      ((count > 200000)) &&
        run "$bin/hs-identify" "$data" --body body.ply "${usual[@]}" --effects elastic,viscoelastic --most-rows 0 -o m1.csv &&
        told "$truth" 'hs-identify, all rows' "$count" "$(values m1.csv)"
    fi
    "$bin/hs-diagnose" -q "$data" --body body.ply "${usual[@]}" --model m0.csv -o effects.csv
    run "$bin/hs-diagnose" "$data" --body body.ply "${usual[@]}" --model m0.csv -o effects.csv &&
      told "$truth" hs-diagnose "$count" "$(verdict effects.csv)"
  done
done
