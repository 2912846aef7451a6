#!/usr/bin/env bash
# check-headers.sh ROOT COMPILER [INCLUDE...] [--without=ROOM]: every header below ROOT/lib compiles by itself,
# without the precompiled headers that its own units get. Prints the compiler's words and exits 1 where one does
# not. The headers of a ROOM whose foreign library is not asked for are left out.
#
# Most of the time goes into <Eigen/Core> and <pybind11/pybind11.h>. A header that includes one of them, itself or
# through others, begins with a copy that was compiled once: what stands before it is then in what it includes
# anyway, so nothing that it forgets is lent to it. All others begin with nothing.
set -euo pipefail
root=$(cd "$1" && pwd) compiler=$2
flags=(-std=c++20 -fsyntax-only -I"$root/lib") without=
for argument in "${@:3}"; do
  case $argument in
    --without=*) without=${argument#*=} ;;
    *) flags+=("$argument") ;;
  esac
done
flags=("${flags[@]/#\//-I/}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$root/lib"

find . -name '*.h' ${without:+-not -path "./$without/*"} | sed 's|^\./||' | sort >"$work/all"
grep -rE '^#include "' --include='*.h' . | sed -E 's|^\./([^:]*):#include "([^"]*)".*|\2 \1|' >"$work/edges" || true
begin() { # NAME PATTERN HEADER: those that include it, directly, then through each other, and the copy of it
  grep -rlE "^#include <$2" --include='*.h' . | sed 's|^\./||' | sort -u >"$work/$1" || true
  while :; do
    awk 'NR == FNR { with[$1] = 1; next } $1 in with { print $2 }' "$work/$1" "$work/edges" |
      sort -u - "$work/$1" >"$work/more"
    ! cmp -s "$work/$1" "$work/more" || break
    mv "$work/more" "$work/$1"
  done
  comm -12 "$work/$1" "$work/all" >"$work/more"
  mv "$work/more" "$work/$1"
  [[ -s $work/$1 ]] || return 0
  echo "#include <$3>" >"$work/$1.h"
  "$compiler" "${flags[@]/-fsyntax-only/-O0}" -x c++-header "$work/$1.h" -o "$work/$1.h.gch"
}
begin Eigen Eigen/ Eigen/Core # which Dense, Geometry and their like include
begin pybind11 pybind11/ pybind11/pybind11.h
alone() { # FIRST HEADER: its first words where it does not compile
  "$compiler" "${flags[@]}" ${1:+-include "$1"} -include "$2" -x c++ /dev/null 2>"$work/${2//\//-}.err" ||
    { echo "$2 does not compile by itself:"; grep -m 3 -E 'error|required' "$work/${2//\//-}.err" | sed 's/^/  /'; return 1; }
}
export -f alone
export work compiler
declare -p flags >"$work/flags"
# What is said comes in the order of the headers, whichever was quicker.
each() { # FIRST <HEADERS
  local code=0
  rm -rf "$work/said" && mkdir "$work/said"
  xargs -r -P "$(nproc)" -I{} bash -c '. "$work/flags"; alone "$0" "$1" >"$work/said/${1//\//:}"' "$1" {} || code=$?
  cat "$work/said"/* 2>/dev/null || true
  return $code
}
failed=no
each "$work/Eigen.h" <"$work/Eigen" || failed=yes
each "$work/pybind11.h" <"$work/pybind11" || failed=yes
sort "$work/Eigen" "$work/pybind11" | comm -23 "$work/all" - | each '' || failed=yes
[[ $failed == no ]] || exit 1
echo "$(wc -l <"$work/all") headers compile, each by itself"
