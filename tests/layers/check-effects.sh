#!/usr/bin/env bash
# check-effects.sh ROOT: nothing below ROOT/lib and ROOT/tools but lib/effects knows an effect: no string is the
# name of one, and no call asks for one (x_effect()). Names come from the cards, `.name = "..."`. Comments and
# longer texts, such as the examples of a tool's specification, may speak of effects.
# A word that means something else in a place is listed with that place.
# Prints one line a breach and exits 1 when there is any.
set -euo pipefail
root=$1
mapfile -t names < <(sed -nE 's/^[ \t]*\.name = "([^"]+)".*/\1/p' "$root"/lib/effects/*.cpp | sort -u)
((${#names[@]})) || { echo "no card below $root/lib/effects has a .name"; exit 1; }
# PLACE WORD: in files whose path begins so, the word is another than the effect of that name.
export others="
lib/tables/ tip
lib/tables/ tare
lib/tables/ clock
lib/tables/ touch
lib/import/ tip
lib/import/ temperature
lib/compare/ temperature
lib/scan/ tip
lib/reconstruct/ base
lib/scan/ shift
tools/hs-cluster.cpp regions
lib/compare/report_body.cpp regions
lib/tetmesh/body_words.cpp regions
tools/hs-simulate/ tip
lib/python/ regions
lib/python/ temperature
"
export literal="\"($(IFS='|'; echo "${names[*]}"))\""
export call="(^|[^A-Za-z0-9_])($(IFS='|'; echo "${names[*]//-/_}"))_effect\\("
breaches=$(cd "$root" && find lib tools -path lib/effects -prune -o \( -name '*.h' -o -name '*.cpp' \) -print | sort |
  xargs -r awk '
    BEGIN { count = split(ENVIRON["others"], other, "\n") }
    {
      text = $0
      sub(/(^|[ \t])\/\/.*/, "", text)
      for (i = 1; i <= count; ++i)
        if (split(other[i], part, " ") == 2 && index(FILENAME, part[1]) == 1) gsub("\"" part[2] "\"", "", text)
      if (text !~ ENVIRON["literal"] && text !~ ENVIRON["call"]) next
      sub(/^[ \t]+/, "")
      printf "%s:%d: %s\n", FILENAME, FNR, $0
    }')
[[ -z $breaches ]] || {
  printf '%s\n' "$breaches"
  echo "$(wc -l <<<"$breaches") line(s) know an effect; ask for a property that the effect tells, or move them to lib/effects"
  exit 1
}
