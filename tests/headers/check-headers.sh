#!/usr/bin/env bash
# check-headers.sh ROOT COMPILER [INCLUDE...] [--without=ROOM]: every header below ROOT/lib compiles by itself,
# without the precompiled headers that its own units get. Prints the compiler's words and exits 1 where one does
# not. The headers of a ROOM whose foreign library is not asked for are left out.
#
# Most of the time goes into what many headers include: <Eigen/Core>, <pybind11/pybind11.h>, a body, an experiment, a
# fit; of the others, <string>. A header that includes one of those, itself or through others, begins with a copy that
# was compiled once: what the copy holds is in what the header includes anyway, so nothing that it forgets is lent to
# it. All others begin with nothing.
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
# begin HEADER [PATTERN]: a copy of the header for those that include it, or what the pattern says, directly, then
# through each other, and that have not begun with another.
touch "$work/begun"
begin() {
  local name=${1//[^A-Za-z0-9]/-}
  grep -rlE "^#include ${2-$1}" --include='*.h' . | sed 's|^\./||' | sort -u >"$work/$name" || true
  while :; do
    awk 'NR == FNR { with[$1] = 1; next } $1 in with { print $2 }' "$work/$name" "$work/edges" |
      sort -u - "$work/$name" >"$work/more"
    ! cmp -s "$work/$name" "$work/more" || break
    mv "$work/more" "$work/$name"
  done
  comm -12 "$work/$name" "$work/all" | comm -23 - "$work/begun" >"$work/more"
  mv "$work/more" "$work/$name"
  [[ -s $work/$name ]] || return 0
  sort -o "$work/begun" "$work/begun" "$work/$name"
  echo "#include $1" >"$work/$name.h"
  # One that does not compile is told when its own turn comes; those that include it then begin with its text.
  "$compiler" "${flags[@]/-fsyntax-only/-O0}" -x c++-header "$work/$name.h" -o "$work/$name.h.gch" 2>/dev/null || true
  copies+=("$name")
}
copies=()
begin '<pybind11/pybind11.h>' '<pybind11/'
for header in realtime/prepared_body.h fit/fit.h experiment/experiment.h contact/contact_library.h mesh/tetmesh.h \
  effects/effect.h; do
  begin "\"$header\""
done
begin '<Eigen/Core>' '<Eigen/' # which Dense, Geometry and their like include
begin '<string>'
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
for name in "${copies[@]}"; do each "$work/$name.h" <"$work/$name" || failed=yes; done
comm -23 "$work/all" "$work/begun" | each '' || failed=yes
[[ $failed == no ]] || exit 1
echo "$(wc -l <"$work/all") headers compile, each by itself"
