#!/usr/bin/env bash
# mutants.sh [-j JOBS] BUILD FOLDER COUNT [ROW...]: gives every tool COUNT mutants of a valid file of each
# format that it reads, and counts how it ends: with 0, or with 3 and lines that say why, and never otherwise.
# Before that the readers alone (row readers) have COUNT mutants of each of these files, of the cases
# and of the shipped examples, in one process. ROW are patterns of row names ('hs-fuse*'). An interrupted
# call is gone on with by the same, one of fewer mutants by one of more; a row whose folder FOLDER/ROW is
# removed begins anew. Mutants that end otherwise stay there and are tried again by every call. Prints
# the table of all rows so far; exit code 1 when any mutant ended otherwise.
set -uo pipefail
jobs=1
while getopts j: flag; do
  case $flag in j) jobs=$OPTARG ;; *) exit 2 ;; esac
done
shift $((OPTIND - 1))
(($# >= 3)) || { sed -n '2,9s/^# //p' "$0" >&2; exit 2; }
build=$(cd "$1" && pwd) folder=$2 count=$3
shift 3
patterns=("${@:-*}")
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
cases=$root/tests/fuzz/cases
bin=$build/bin
mkdir -p "$folder/examples" && cd "$folder/examples" || exit 5
folder=$(cd .. && pwd)
export XDG_CACHE_HOME=$folder/cache

pcd() { # KIND: the head of 80 points
  printf 'VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 80\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 80\nDATA %s\n' "$1"
}
# The valid files.
prepare() {
  awk 'BEGIN {
    print "OFF"; print 8, 12, 0
    for (i = 0; i < 8; ++i) print (i % 2) * 0.06, (int(i / 2) % 2) * 0.05, (i >= 4) * 0.04
    split("0 2 1,1 2 3,4 5 6,5 7 6,0 1 4,1 5 4,2 6 3,3 6 7,0 4 2,2 4 6,1 3 5,3 7 5", f, ",")
    for (i = 1; i <= 12; ++i) print 3, f[i] }' >box.off
  awk '{ for (i = 1; i <= NF; ++i) v[NR, i] = $i } END { print "solid box"
    for (f = 11; f <= NR; ++f) { print "facet normal 0 0 0\nouter loop"
      for (k = 2; k <= 4; ++k) print "vertex", v[v[f, k] + 3, 1], v[v[f, k] + 3, 2], v[v[f, k] + 3, 3]
      print "endloop\nendfacet" } print "endsolid box" }' box.off >box.stl
  awk 'NR == 2 { print "ply\nformat ascii 1.0\nelement vertex 8\nproperty double x\nproperty double y\nproperty double z"
      print "element face 12\nproperty list uchar int vertex_indices\nend_header" } NR > 2' box.off >surface.ply
  "$bin/hs-tetmesh" -q box.off --max-volume 2e-6 -o body.ply &&
    awk 'BEGIN { print "# tool_radius: 0.004\n# force_noise: 0.002\npress,t,x,y,z,ux,uy,uz"
      for (p = 1; p <= 2; ++p) for (i = 0; i <= 10; ++i)
        printf "%d,%.2f,%.3f,0.025,0.04,%.5f,0,%.5f\n", p, 0.1 * i, 0.02 * p, i * 2e-5, -i * 1e-4 }' >motion.csv &&
    printf 'effect,region,parameter,value\nelastic,0,E,8000\nelastic,0,nu,0.4\nviscoelastic,0,E1,3000\nviscoelastic,0,tau1,0.3\n' >model.csv &&
    head -n 3 model.csv >elastic.csv &&
    "$bin/hs-simulate" -q motion.csv --body body.ply --model model.csv --rim-edge 0.5 --add-noise 0.002 -o data.csv &&
    for format in vtu gmsh calculix febio sofa; do
      "$bin/hs-export" -q elastic.csv --body body.ply --format $format >body.$format || return
    done &&
    awk 'BEGIN { srand(3); print "x,y,z"; for (i = 0; i < 400; ++i) { f = int(3 * rand()); a = rand(); b = rand(); s = rand() < 0.5
      x = f == 0 ? s : a; y = f == 1 ? s : f == 0 ? a : b; z = f == 2 ? s : b
      printf "%.4f,%.4f,%.4f\n", 0.06 * x, 0.05 * y, 0.04 * z } }' >scan.csv &&
    "$bin/hs-scan2ply" -q scan.csv -o points.ply &&
    awk 'BEGIN { print "time [s],force [N],displacement [mm]"
      for (i = 0; i < 100; ++i) print i * 0.01 "," (i > 30 ? (i - 30) * 0.02 : 0) "," i * 0.02 }' >machine.csv &&
    awk 'BEGIN { srand(3); print "x,y,z,E,nu,E_std,nu_std,n"; for (i = 0; i < 12; ++i)
      printf "%.2f,%.2f,0.04,%.0f,%.3f,200,0.01,90\n", 0.01 * (i % 4), 0.01 * int(i / 4), (i < 6 ? 8000 : 16000) + 300 * rand(), 0.4 + 0.02 * rand() }' >samples.csv &&
    "$bin/hs-identify" -q data.csv --body body.ply --rim-edge 0.5 --folds 0 --library lab.db -o identified.csv &&
    "$bin/hs-identify" -q data.csv --body body.ply --acfm 1 -o acfm.csv &&
    "$bin/hs-calibrate" -q --plan turns.csv --plan-poses 12 &&
    awk -F, -v OFS=, '$1 == "pose" { print "qw,qx,qy,qz,fx,fy,fz,temp,load"; next } { m = 4 + ($1 % 3 ? 0 : 5)
      print $2, $3, $4, $5, m * $6 + 0.001 * ($1 % 5), m * $7 + 0.2, m * $8, 20 + $1 % 7, $1 % 3 ? 0 : 0.5 }' turns.csv >poses.csv &&
    "$bin/hs-calibrate" -q poses.csv --rigid data.csv -o cal.csv &&
    printf 'name,body,data,effects,options,common_options\na,body.ply,data.csv,elastic,--folds 0 --data data.csv,--rim-edge 0.5\nb,body.ply,data.csv,elastic viscoelastic,,\n' >manifest.csv &&
    awk 'BEGIN { print "q1,q2,q3,q4,q5,q6,d"
      for (i = 0; i < 20; ++i) printf "%.2f,%.2f,-0.3,0.1,0.2,0,%.3f\n", 0.02 * (i % 5), 0.1 + 0.02 * int(i / 5), 0.1 + 0.001 * (i % 3) }' >joints.csv &&
    pcd ascii >text.pcd && awk 'NR % 5 == 2 { gsub(",", " "); print }' scan.csv >>text.pcd &&
    pcd binary >binary.pcd && awk 'NR % 5 == 2 { gsub(",", " "); print }' scan.csv | perl -ne 'print pack("f<3", split)' >>binary.pcd &&
    cp "$root/share/examples/robot/arm.urdf" "$cases"/volume/*.n* "$cases"/mesh/t1.gmsh41 "$cases"/records/press "$cases"/motion/press.csv . &&
    touch ready
}
[[ -e ready ]] || prepare || { echo 'mutants: the valid files cannot be made' >&2; exit 1; }

# One row: NAME EXAMPLE COMMAND..., where @ in the command is the mutant.
rows=()
row() { rows+=("$(printf '%q ' "$@")"); }
row hs-tetmesh-off box.off hs-tetmesh @ --max-volume 2e-6
row hs-tetmesh-stl box.stl hs-tetmesh @ --max-volume 2e-6
row hs-tetmesh-ply surface.ply hs-tetmesh @ --max-volume 2e-6
row hs-scan2ply-csv scan.csv hs-scan2ply @
row hs-scan2ply-pcd-text text.pcd hs-scan2ply @
row hs-scan2ply-pcd-binary binary.pcd hs-scan2ply @
row hs-scan2ply-nrrd text.nrrd hs-scan2ply @ --threshold 4.5
row hs-scan2ply-nrrd-gzip gzip.nrrd hs-scan2ply @ --threshold 4.5
row hs-scan2ply-nifti small.nii hs-scan2ply @ --threshold 4.5
row hs-scan2ply-joints joints.csv hs-scan2ply @ --robot arm.urdf --tip-link sensor
row hs-scan2ply-urdf arm.urdf hs-scan2ply joints.csv --robot @ --tip-link sensor
row hs-reconstruct-ply points.ply hs-reconstruct @
row hs-calibrate-poses poses.csv hs-calibrate @ --rigid data.csv
row hs-calibrate-rigid data.csv hs-calibrate --rigid @
row hs-compare-calibration cal.csv hs-compare data.csv --simulated data.csv --calibration @
row hs-import-machine machine.csv hs-import @ --block 60x50x40mm --tool-radius 4mm
row hs-identify-data data.csv hs-identify @ --body body.ply --rim-edge 0.5 --folds 0 --tool-radius 0.004
row hs-identify-model model.csv hs-identify data.csv --model @ --body body.ply --rim-edge 0.5 --folds 0
row hs-identify-body body.ply hs-identify data.csv --body @ --rim-edge 0.5 --folds 0
row hs-identify-acfm data.csv hs-identify @ --body body.ply --acfm 1
row hs-cluster-samples samples.csv hs-cluster @ --scan-points 400
row hs-simulate-motion motion.csv hs-simulate @ --model model.csv --body body.ply --rim-edge 0.5
row hs-simulate-model model.csv hs-simulate motion.csv --model @ --body body.ply --rim-edge 0.5
row hs-simulate-acfm acfm.csv hs-simulate motion.csv --model @
row hs-simulate-live press.csv hs-simulate --live @ --model acfm.csv --tool-radius 0.004
row hs-simulate-records press hs-simulate --live --binary press @ --model acfm.csv --tool-radius 0.004
for format in ply vtu gmsh calculix febio sofa; do
  row hs-export-$format body.$format hs-export model.csv --body @ --format vtu
done
row hs-export-gmsh41 t1.gmsh41 hs-export model.csv --body @ --format vtu
row hs-export-model model.csv hs-export @ --body body.ply --data data.csv --format febio
row hs-export-data data.csv hs-export model.csv --body body.ply --data @ --format febio
row hs-compare-data data.csv hs-compare @ --simulated data.csv
row hs-compare-simulated data.csv hs-compare data.csv --simulated @
row hs-diagnose-data data.csv hs-diagnose @ --model model.csv --body body.ply --rim-edge 0.5 --flips 99
row hs-diagnose-model model.csv hs-diagnose data.csv --model @ --body body.ply --rim-edge 0.5 --flips 99
row hs-plan-data data.csv hs-plan @ --body body.ply --rim-edge 0.5 --tool-radius 0.004
row hs-check-model model.csv hs-check @ --golden model.csv
row hs-check-golden model.csv hs-check model.csv --golden @
row hs-fuse-fast data.csv hs-fuse @ --slow data.csv
row hs-fuse-slow data.csv hs-fuse data.csv --slow @
row hs-library-database lab.db hs-library @
row hs-batch-manifest manifest.csv hs-batch @ --prepare --out batch

# The readers alone, within one process.
readers() {
  local r=$folder/readers shipped=$root/share/examples
  cp -r "$cases" "$r" && cp data.csv motion.csv "$r/recording" && cp scan.csv points.ply "$r/scan" &&
    cp "$shipped"/phantom/truth*.csv model.csv identified.csv "$r/model" && cp body.* "$r/mesh" &&
    cp surface.ply points.ply "$r/ply" && cp box.stl "$r/stl" && cp box.off "$r/off" && cp machine.csv "$r/import" &&
    cp manifest.csv "$r/manifest" && cp samples.csv "$r/locations" && cp *.pcd "$r/pcd" && cp arm.urdf "$r/urdf" &&
    cp acfm.csv "$r/acfm" && for file in "$shipped"/phantom/{data,plain}.csv "$shipped"/hidden-effects/?.csv; do
      cp "$file" "$r/recording/shipped-$(basename "$file")" || return
    done && cp "$shipped/phantom/scan.csv" "$r/scan/shipped.csv" || return
  "$build/tests/fuzz/test_fuzz_cases" "$r" "$count" >"$folder/readers.new" && mv "$folder/readers.new" "$folder/readers.table"
}

make_row() { # NAME EXAMPLE COMMAND...
  local name=$1 example=$2 mutant word command=() checks=() ends
  shift 2
  mkdir -p "$folder/$name"
  mutant=$folder/$name/$(basename "$example")
  for word; do command+=("${word/#@/$mutant}"); done
  [[ ${command[0]} != hs-check ]] || checks=(-c)
  ends=$("$build/tests/fuzz/tool_mutants" "${checks[@]}" "$count" "$example" "$mutant" "$bin/${command[0]}" "${command[@]:1}" -q)
  [[ -n $ends ]] && echo "$ends" >"$folder/$name/row"
}
wanted() { # NAME
  local pattern
  for pattern in "${patterns[@]}"; do
    # shellcheck disable=SC2053  # a pattern
    [[ $1 == $pattern ]] && return
  done
  return 1
}
bad=0
if wanted readers && [[ ! -e $folder/readers.table ]]; then
  rm -rf "$folder/readers"
  readers || { echo 'mutants: a reader neither read nor refused a file' >&2; bad=1; }
fi
for line in "${rows[@]}"; do
  eval "words=($line)"
  wanted "${words[0]}" || continue
  ends=$(cat "$folder/${words[0]}/row" 2>/dev/null)
  awk -v count="$count" '{ made = $1 + $2 + $3; bad = $3 } END { exit made >= count && bad == 0 }' <<<"$ends" || continue
  while (($(jobs -rp | wc -l) >= jobs)); do wait -n; done
  make_row "${words[@]}" &
done
wait
printf '%-28s %9s %9s %10s\n' 'tool and format' 'exit 0' 'exit 3' otherwise
for line in "${rows[@]}"; do
  eval "words=($line)"
  [[ -s $folder/${words[0]}/row ]] && echo "${words[0]} $(cat "$folder/${words[0]}/row")"
done | awk '{ printf "%-28s %9d %9d %10d\n", $1, $2, $3, $4; bad += $4 } END { exit bad > 0 }' || bad=1
cat "$folder/readers.table" 2>/dev/null
exit $bad
