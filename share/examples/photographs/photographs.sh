#!/bin/sh
# photographs.sh PHOTOGRAPHS MARKS KNOWN [FOLDER]: photographs of a body (a folder of them) to its closed surface, by
# COLMAP on the processor, in the frame and to the scale of known marks (scale_points.py). Needs colmap (Debian's, or any
# of 3.8), python3 with numpy, and hapsim's tools on the PATH; writes into FOLDER (here). From the environment: ABOVE, the
# height of the support and what of the body is lost with it (0.002 m); BESIDE, how far the body reaches to the side (0.1
# m), both empty with two marks, which give no frame; FEATURES, the most that are looked for in a photograph (4000): more
# find more points, and the time for a pair of photographs grows with their square.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
fail() { echo "photographs.sh: $1" >&2; exit "${2:-2}"; }
[ $# -ge 3 ] && [ $# -le 4 ] || fail "usage: photographs.sh PHOTOGRAPHS MARKS KNOWN [FOLDER]"
out=${4:-.}
[ -d "$1" ] || fail "$1: no folder of photographs" 5
command -v colmap >/dev/null || fail "colmap is not installed; on Debian 12: apt install --no-install-recommends colmap" 5
export QT_QPA_PLATFORM=offscreen # no screen is needed

mkdir -p "$out/colmap/sparse"
run() { colmap "$@" >>"$out/colmap/log" 2>&1 || fail "colmap $1 failed; see $out/colmap/log" 4; }
: >"$out/colmap/log"
# One camera took all of them.
run feature_extractor --database_path "$out/colmap/database.db" --image_path "$1" --ImageReader.single_camera 1 \
  --ImageReader.camera_model SIMPLE_RADIAL --SiftExtraction.use_gpu 0 \
  --SiftExtraction.max_num_features "${FEATURES:-4000}"
run exhaustive_matcher --database_path "$out/colmap/database.db" --SiftMatching.use_gpu 0
run mapper --database_path "$out/colmap/database.db" --image_path "$1" --output_path "$out/colmap/sparse"
[ -d "$out/colmap/sparse/0" ] || fail "colmap finds no place for the cameras; more photographs, nearer to each other" 4
run model_converter --input_path "$out/colmap/sparse/0" --output_path "$out/colmap/sparse/0" --output_type TXT

above=${ABOVE-0.002} beside=${BESIDE-0.1}
python3 "$here/scale_points.py" "$out/colmap/sparse/0" "$2" "$3" ${above:+--above "$above"} ${beside:+--beside "$beside"} \
  >"$out/points.csv" || exit $?
hs-scan2ply "$out/points.csv" -o "$out/points.ply"
hs-reconstruct "$out/points.ply" -o "$out/surface.ply"
