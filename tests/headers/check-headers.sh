#!/usr/bin/env bash
# check-headers.sh ROOT COMPILER [INCLUDE...]: every header below ROOT/lib compiles by itself, without the
# precompiled headers that its own units get. Prints the compiler's words and exits 1 where one does not.
#
# Most of the time goes into <Eigen/Core>. A header that includes it, itself or through others, begins with a
# copy that was compiled once: what stands before it is then in what it includes anyway, so nothing that it
# forgets is lent to it. All others begin with nothing.
set -euo pipefail
root=$(cd "$1" && pwd) compiler=$2
flags=(-std=c++20 -fsyntax-only -I"$root/lib" "${@:3}")
flags=("${flags[@]/#\//-I/}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$root/lib"

# Headers that include Eigen/Core (Dense, Geometry and their like do), directly, then through each other.
grep -rlE '^#include <Eigen/' --include='*.h' . | sed 's|^\./||' | sort -u >"$work/with" || true
grep -rE '^#include "' --include='*.h' . | sed -E 's|^\./([^:]*):#include "([^"]*)".*|\2 \1|' >"$work/edges" || true
while :; do
  awk 'NR == FNR { with[$1] = 1; next } $1 in with { print $2 }' "$work/with" "$work/edges" |
    sort -u - "$work/with" >"$work/more"
  ! cmp -s "$work/with" "$work/more" || break
  mv "$work/more" "$work/with"
done
find . -name '*.h' | sed 's|^\./||' | sort >"$work/all"

if [[ -s $work/with ]]; then
  echo '#include <Eigen/Core>' >"$work/eigen.h"
  "$compiler" "${flags[@]/-fsyntax-only/-O0}" -x c++-header "$work/eigen.h" -o "$work/eigen.h.gch"
fi
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
each "$work/eigen.h" <"$work/with" || failed=yes
comm -23 "$work/all" "$work/with" | each '' || failed=yes
[[ $failed == no ]] || exit 1
echo "$(wc -l <"$work/all") headers compile, each by itself"
