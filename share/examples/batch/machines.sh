#!/bin/sh
# machines.sh LxWxH RADIUS OUT TABLE...: recordings of a testing machine, each on the middle of a block of that
# size, as one batch: every table is identified elastic and then with the effects that it asks for (auto), and
# diagnosed. Makes OUT/manifest.csv, OUT/summary.csv and OUT/overview.html; the same command again goes on
# after an interruption, and makes only what has changed. From the environment: JOBS (side by side, 2),
# NU (Poisson's ratio, 0.49: pressing one place in one direction cannot tell it), FLAGS (further ones of
# hs-import), PIPELINE (Makefile.pipeline), BIN (where the tools are).
#   machines.sh 100x100x40mm 4mm meat meat_recordings/*.csv
set -eu
[ $# -ge 4 ] || { sed -n '2,8s/^# //p' "$0" >&2; exit 2; }
block=$1 radius=$2 out=$3
shift 3
here=$(cd "$(dirname "$0")/../.." && pwd)
pipeline=${PIPELINE:-$here/Makefile.pipeline}
[ -e "$pipeline" ] || pipeline=$(dirname "$here")/Makefile.pipeline

mkdir -p "$out"
quoted() { printf '"%s"' "$(printf %s "$1" | sed 's/"/""/g')"; }
{
  echo 'name,raw,import_options,effects,options'
  for table; do
    case $table in /*) ;; *) table=$PWD/$table ;; esac
    name=$(basename "$table")
    for effects in elastic auto; do
      printf '%s,%s,%s,%s,%s\n' "$(quoted "${name%.*} $effects")" "$(quoted "$table")" \
        "$(quoted "--block $block --tool-radius $radius ${FLAGS:-}")" $effects "--fix nu=${NU:-0.49}"
    done
  done
} >"$out/manifest.new"
mv "$out/manifest.new" "$out/manifest.csv"
exec make --no-print-directory -s -f "$pipeline" batch -j"${JOBS:-2}" BIN="${BIN:-}" MANIFEST="$out/manifest.csv" OUT="$out"
