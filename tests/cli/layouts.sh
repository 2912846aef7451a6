#!/usr/bin/env bash
# layouts.sh BIN SCATTER: the same call gives the same bytes, wherever its memory lies: from a file or a pipe,
# with -q or without, in a long environment, on memory filled with something, and with blocks of memory in
# shuffled order (SCATTER, a library to preload; not where a sanitizer has replaced the allocation itself).
scatter=$(realpath "$2")
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"
seeds=(1 2)
if ldd "$bin/hs-reconstruct" | grep -q 'lib[at]san'; then seeds=(); fi

# same INPUT TOOL [FLAGS...]: what comes of INPUT is the same in every layout
same() {
  local input=$1 tool=$bin/$2
  shift 2
  local quiet=("$@" -q)
  "$tool" "$@" "$input" >whole 2>err </dev/null || complain "$tool $* $input"
  check() { # HOW, of standard input
    cmp -s whole - || complain "other bytes $1: ${tool##*/} ${quiet[*]} $input"
  }
  cat "$input" | "$tool" "$@" 2>err | check 'through a pipe'
  FILLER=$(printf '%050000d' 0) "$tool" "${quiet[@]}" <"$input" 2>err |
    check 'with -q, from a file as standard input, in a long environment'
  MALLOC_PERTURB_=165 MALLOC_MMAP_THRESHOLD_=4096 "$tool" "${quiet[@]}" "$input" 2>err </dev/null |
    check 'with -q, on filled memory in mapped blocks'
  local seed
  for seed in "${seeds[@]}"; do
    HAPSIM_SCATTER=$seed LD_PRELOAD=$scatter "$tool" "${quiet[@]}" "$input" 2>err </dev/null |
      check "with shuffled blocks ($seed)"
  done
}

box_scan >scan.csv
same scan.csv hs-scan2ply --unit mm --spacing 3mm
cp whole points.ply
for method in $("$bin/hs-reconstruct" --help | tr -s ' \n' ' ' | sed 's/.*--method METHOD How to reconstruct. One of: \([^.]*\)\..*/\1/' | tr -d ,); do
  same points.ply hs-reconstruct --method "$method" --edge 4mm
  methods+=("$method")
done
((${#methods[@]} >= 7)) || complain "methods: ${methods[*]}"
# A scan of the upper side alone.
awk 'BEGIN { print "x,y,z"; for (i = 0; i < 400; ++i) { u = sqrt((i + 0.5) / 400); v = 2.399963 * i
  printf "%.6f,%.6f,%.6f\n", 0.045 * u * cos(v), 0.035 * u * sin(v), 0.025 * sqrt(1 - 0.9 * u * u) } }' >top.csv
same top.csv hs-reconstruct --base-depth 1cm
cp whole top.ply
same top.ply hs-tetmesh
same top.ply hs-tetmesh --order 2 --preserve-surface
same top.ply hs-reconstruct --repair --edge 6mm

# One processor or several, prepared stiffnesses kept or not.
"$bin/hs-tetmesh" -q box.off -o body.ply 2>err || complain 'no body'
box_presses 12 1e-4 >motion.csv
printf 'effect,region,parameter,value\nelastic,0,E,8000\nelastic,0,nu,0.4\nviscoelastic,0,E1,4000\nviscoelastic,0,tau1,0.2\n' >model.csv
same motion.csv hs-simulate --body body.ply --model model.csv --rim-edge 0.5 --add-noise 0.002 --cache none --threads 1
cp whole data.csv
for threads in 2 3; do
  same motion.csv hs-simulate --body body.ply --model model.csv --rim-edge 0.5 --add-noise 0.002 --cache kept --threads $threads
  cmp -s whole data.csv || complain "other forces by $threads threads"
done
for threads in 1 3; do
  same data.csv hs-identify --body body.ply --rim-edge 0.5 --effects auto --folds 0 --cache kept$threads --threads $threads
  cp whole model$threads.csv
done
cmp -s model1.csv model3.csv || complain 'another model by 3 threads'
((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
echo 'layouts: passed'
