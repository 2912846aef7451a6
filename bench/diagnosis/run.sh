#!/usr/bin/env bash
# run.sh BUILD OUT [FROM:TO [LOW:HIGH [TRUTH...]]] [--object phantom|off|block|lump|body-N] [--protocol rich|edge|robot|few]
# [--verbose] [--keep FOLDER] [--leave-out | --at-shown]: trials on the shipped phantom (or a cuboid, or a lobed dome, each made of a scan
# of its own; `off`: the phantom whose scan is 1 mm off, rms, in broad waves; body-N: a dome or a cuboid drawn by N),
# pressed as presses.awk says, seeds FROM to TO, errors LOW to HIGH times the noise. The results in
# OUT/trials.csv are gone on with when it is run again with the same object and protocol; delete OUT to begin
# anew. Two runs at once share nothing: give each an OUT of its own and put the files together. Inclusions lie
# where they are seen from the phantom's places. Truths whose finite elements are solved (regions, layer,
# anisotropic, base, inclusion) take up to 13 GB: one such run at a time.
# Recorded in bench/results/diagnosis*.txt (bench/record.sh).
set -euo pipefail
arguments=() options=() object=phantom protocol=rich
while (($#)); do
  case $1 in
    --object) object=$2; shift ;;
    --protocol) protocol=$2; shift ;;
    --keep) options+=(--keep "$2"); shift ;;
    --*) options+=("$1") ;;
    *) arguments+=("$1") ;;
  esac
  shift
done
set -- "${arguments[@]}"
build=$1 out=$2 seeds=${3:-1:8} levels=${4:-3:10}
shift $(($# < 4 ? $# : 4))
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
examples=$here/../../share/examples
made=$out/made-of
mkdir -p "$out"
if [[ -e $made && $(<"$made") != "$object $protocol" ]]; then
  echo "run.sh: $out holds trials of $(<"$made"); give another folder" >&2
  exit 2
fi
if [[ ! -e $made ]]; then
  case $object in
    phantom | off) awk -v what=dome -v a=0.055 -v b=0.042 -v c=0.038 -v n=96 -v m=32 -v lobe=0 -f "$examples/shapes.awk" ;;
    lump) awk -v what=dome -v a=0.05 -v b=0.045 -v c=0.035 -v n=96 -v m=32 -v lobe=0.25 -f "$examples/shapes.awk" ;;
    block) awk -v what=cuboid -v a=0.11 -v b=0.09 -v c=0.04 -f "$examples/shapes.awk" |
      awk 'NF == 3 && NR > 2 { $1 -= 0.055; $2 -= 0.045 } { print }' ;;
    body-*) awk -v n="${object#body-}" -v shapes="$examples/shapes.awk" -f "$here/body.awk" ;;
    *) echo "run.sh: no object $object" >&2; exit 2 ;;
  esac >"$out/surface.off"
  awk -v protocol="$protocol" -f "$here/presses.awk" "$out/surface.off" >"$out/motion.csv"
  awk -v count=3000 -f "$here/scan.awk" "$out/surface.off" >"$out/scan.csv"
  if [[ $object == phantom ]]; then
    cp "$examples/phantom/scan.csv" "$out/scan.csv"
    [[ $protocol != rich ]] || awk -v what=motion -f "$examples/phantom/geometry.awk" >"$out/motion.csv"
  fi
  if [[ $object == off ]]; then
    awk -F, -v OFS=, '/^[-0-9.]/ { r = sqrt($1 * $1 + $2 * $2 + $3 * $3)
      s = 1 + 1.4 * cos(2 * atan2($2, $1) + 1) * sin(3 * $3 / r) / r; $1 *= s; $2 *= s; $3 *= s } { print }' \
      "$examples/phantom/scan.csv" >"$out/scan.csv"
  fi
  "$build/bin/hs-tetmesh" -q "$out/surface.off" -o "$out/true.ply"
  "$build/bin/hs-scan2ply" -q "$out/scan.csv" --unit mm | "$build/bin/hs-reconstruct" -q |
    "$build/bin/hs-tetmesh" -q -o "$out/diagnosed.ply"
  echo "$object $protocol" >"$made"
fi
"$build/bench/diagnosis/bench_diagnosis" "$out/diagnosed.ply" "$out/true.ply" "$out/motion.csv" \
  "$out/trials.csv" "$seeds" "$levels" "$@" "${options[@]}"
