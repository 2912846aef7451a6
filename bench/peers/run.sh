#!/usr/bin/env bash
# run.sh BUILD OUT [ROW...]: every row beside its peer from Debian 12, and how both grow with size. Rows: solver
# (CalculiX), multigrid (PETSc's GAMG and hypre, where python3-petsc4py is installed), mesher (TetGen's own program),
# scan (Open3D, where python3-open3d is installed), fit (SciPy around CalculiX). Each is a bench of its own, whose output is kept in OUT and not made again; an interrupted call is gone
# on with by the same call, a row that failed is tried again, and what could not run is said. Seconds are of the
# processor. Ratios are peer over hapsim: above 1 hapsim is ahead; `asked` is the ratio the project set itself.
# BUILD is build/ci with its benches. Some twenty minutes of one processor.
# Recorded in bench/results/peers.txt (bench/record.sh).
set -euo pipefail
[[ $# -ge 2 && -d $1/bin && -d $1/bench ]] || { echo 'usage: run.sh BUILD OUT [ROW...]' >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$(cd "$1" && pwd)
mkdir -p "$2" && out=$(cd "$2" && pwd)
shift 2
(($#)) || set -- solver multigrid mesher scan fit

row() { # NAME COMMAND...: its output as OUT/NAME.txt, once
  local name=$1
  shift
  [[ -s $out/$name.txt ]] && return
  echo "run.sh: $name" >&2
  if "$@" >"$out/.$name" 2>"$out/$name.log"; then
    mv "$out/.$name" "$out/$name.txt"
  else
    echo "run.sh: $name did not end well; see $out/$name.log" >&2
  fi
}
for name in "$@"; do
  case $name in
    solver) row solver "$build/bench/bench_calculix" "$build/bin" 3 ;;
    multigrid) mkdir -p "$out/million" && row multigrid /usr/bin/python3 "$here/multigrid.py" "$build/bin" "$out/million" ;;
    mesher) row mesher "$build/bench/bench_tetmesh" "$build/bin" ;;
    scan)
      peer=()
      if python3 -c 'import open3d' 2>"$out/scan.log"; then
        peer=(--open3d python3 "$here/../scan_open3d.py")
      fi
      row scan "$build/bench/bench_scan" "$build/bin" 1e4 1e5 1e6 "${peer[@]}"
      ;;
    fit) mkdir -p "$out/fit" && row fit "$build/bench/identification/bench_identify_speed" "$out/fit" "$build/bin" ;;
    *) echo "run.sh: no row $name" >&2; exit 2 ;;
  esac
done
printf '%-46s %-28s %9s %9s %7s %7s %6s\n' row peer hapsim_s peer_s ratio memory asked
for name in solver multigrid mesher scan fit; do
  if [[ -s $out/$name.txt ]]; then awk -v row="$name" -f "$here/table.awk" "$out/$name.txt"; else echo "$name: not run"; fi
done
