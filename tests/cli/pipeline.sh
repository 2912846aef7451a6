#!/usr/bin/env bash
# pipeline.sh BIN: the whole pipeline on the shipped phantom names the hidden effect, adds it, and finds
# nothing missing after that; the phantom without it lacks nothing.
set -euo pipefail
bin=$(cd "$1" && pwd)
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
export XDG_CACHE_HOME=$out/cache
fail() { printf 'pipeline: %s\n' "$*"; exit 1; }
field() { awk -F, -v row="$2" -v column="$3" '/^#/ { next } !header { header = 1; for (i = 1; i <= NF; ++i) at[$i] = i; next } $1 == row { print $at[column] }' "$1"; }
below() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a < b) }'; }

make --no-print-directory -s -f "$root/Makefile.pipeline" BIN="$bin" OUT="$out/run" report 2>"$out/log" ||
  { cat "$out/log"; fail "the pipeline failed"; }
first=$out/run/effects0.csv second=$out/run/effects1.csv
[[ $(field "$first" 0 verdict) == incomplete ]] || fail "the elastic model is not called incomplete"
[[ $(field "$first" 1 effect) == viscoelastic && $(field "$first" 1 verdict) == missing ]] ||
  fail "the hidden effect is not named first"
[[ $(field "$second" 0 verdict) == complete ]] || fail "the improved model is not called complete"
noise=$(sed -n 's/^# force_noise: //p' "$out/run/m1.csv")
heldout=$(sed -n 's/^# heldout: //p' "$out/run/m1.csv")
printf 'held-out error %s N, noise %s N\n' "$heldout" "$noise"
below "$heldout" "$(awk -v n="$noise" 'BEGIN { print 1.5 * n }')" || fail "the held-out error did not fall"
grep -q '</html>' "$out/run/report.html" || fail "the report is not whole"

# Nothing to make again, and the recipe can be read without running it.
make --no-print-directory -q -f "$root/Makefile.pipeline" BIN="$bin" OUT="$out/run" report ||
  fail "a second run would make something again"
make --no-print-directory -n -f "$root/Makefile.pipeline" OUT="$out/other" report >"$out/recipe"
grep -q hs-tetmesh "$out/recipe" || fail "make -n does not read like a recipe"

# The same by one command, every step in the history.
"$bin/hs-identify" "$root/share/examples/phantom/data.csv" --body "$out/run/body.ply" --effects auto \
  --history "$out/steps.csv" -q -o "$out/auto.csv"
[[ $(field "$out/steps.csv" 0 effects) == elastic && $(field "$out/steps.csv" 1 effects) == elastic+viscoelastic &&
  -z $(field "$out/steps.csv" 2 effects) ]] || fail "--effects auto did not add the hidden effect alone"
below "$(field "$out/steps.csv" 1 heldout)" "$(awk -v n="$noise" 'BEGIN { print 1.5 * n }')" ||
  fail "the held-out error of --effects auto did not fall"

plain=$root/share/examples/phantom/plain.csv
"$bin/hs-identify" "$plain" --body "$out/run/body.ply" -q -o "$out/plain.csv"
"$bin/hs-diagnose" "$plain" --body "$out/run/body.ply" --model "$out/plain.csv" --check -q -o "$out/plain-effects.csv" ||
  fail "the plain phantom is said to lack something"

# The same call gives the same bytes, with the cache and without it, with one thread and with several.
for way in 'none --threads 1' "$out/one --threads 4" "$out/one --threads 1"; do
  "$bin/hs-identify" "$plain" --body "$out/run/body.ply" -q --cache $way --fix nu=0.4 -o "$out/again.csv"
  cmp -s "$out/again.csv" "${previous:-$out/again.csv}" || fail "the result depends on the cache or the threads"
  previous=$out/previous.csv
  cp "$out/again.csv" "$previous"
done

# Bad input: the exit code, and one line.
refused() { # CODE COMMAND...
  local wanted=$1 code=0 text
  shift
  text=$("$@" 2>&1 >/dev/null) || code=$?
  [[ $code == "$wanted" ]] || fail "exit $code instead of $wanted: $*"
  [[ $(printf '%s\n' "$text" | wc -l) == 1 ]] || fail "more than one line: $text"
}
refused 2 "$bin/hs-identify" "$plain" --body "$out/run/body.ply" --add magic
refused 2 "$bin/hs-identify" "$plain" --body "$out/run/body.ply" --modle x
refused 2 "$bin/hs-identify" "$plain" --body "$out/run/body.ply" --effects auto --add tip
refused 3 "$bin/hs-identify" "$plain" --body "$out/run/surface.ply"
refused 3 "$bin/hs-identify" "$out/run/m0.csv" --body "$out/run/body.ply"
refused 3 "$bin/hs-simulate" "$plain" --body "$out/run/body.ply" --model "$plain"
refused 5 "$bin/hs-identify" "$plain" --body "$out/missing.ply"
refused 5 "$bin/hs-simulate" "$plain" --body "$out/run/body.ply" --model "$out/run/m0.csv" -q -o /dev/full
printf 'pipeline: passed\n'
