#!/usr/bin/env bash
# help.sh BIN: -h of every tool is a screen, with the command's use, what is required and an example; --help
# has every option of it with an explanation; a word means the same in all tools.
set -uo pipefail
bin=$1
failures=0
complain() { echo "FAILED: $1"; failures=$((failures + 1)); }
words=$(mktemp)
trap 'rm -f "$words"' EXIT

for path in "$bin"/hs-*; do
  tool=${path##*/}
  [[ $tool != hs-sample ]] || continue
  short=$("$path" -h) full=$("$path" --help)
  [[ $("$path" --version -v) == *$'\n'BLAS:\ * ]] || complain "$tool --version -v does not name the BLAS"
  lines=$(wc -l <<<"$short")
  ((lines <= 30)) || complain "$tool -h has $lines lines"
  # A sentence is not cut at a dot in a name, as of (.inp.
  required=$(sed -n '/^Usage/,/^Options/p' <<<"$short" | tr -dc '()')
  [[ $(tr -dc '(' <<<"$required" | wc -c) == $(tr -dc ')' <<<"$required" | wc -c) ]] ||
    complain "$tool -h cuts a sentence"
  for part in "Usage: $tool " 'Options:' 'Examples:' "--help, or man $tool"; do
    grep -qF -- "$part" <<<"$short" || complain "$tool -h has no '$part'"
  done
  long=$(awk '!/^  hs-|^  make|^  [a-z]/ && length > 84' <<<"$short")
  [[ -z $long ]] || complain "$tool -h is wider than a terminal: $long"
  # More options than a screen holds have headings, and none stands without.
  if (($(grep -cE '^  (-., )?--[a-z]' <<<"$full") > 17)); then
    (($(grep -c '^Options, .*:$' <<<"$full") >= 2)) && ! grep -qx 'Options:' <<<"$full" || complain "$tool --help has many options without a heading"
  fi
  for flag in $(awk '/^Options:/ {on = 1; next} /^$/ {on = 0} on' <<<"$short" | grep -oE -- '--[a-z][a-z0-9-]*'); do
    grep -qE -- "^  (-., )?$flag( |$)" <<<"$full" || complain "$tool --help does not explain $flag"
  done
  # flag and the name of its value, of all tools
  awk '/^[A-Z]/ {on = /^Options/} on' <<<"$full" | grep -oE -- '^  (-., )?--[a-z][a-z0-9-]*( [A-Z][A-Z0-9,:|=.]*)?' | sed "s/^  *\(-., \)*//; s/$/ ($tool)/" >>"$words"
done

# What is read in one tool is written in none: who confuses them loses a file. A history is both: a tool adds to it.
for path in "$bin"/hs-*; do
  tool=${path##*/}
  [[ $tool != hs-sample ]] || continue
  "$path" --help | awk '/^[A-Z]/ { on = /^Options/ } !on { next } /^  -/ { if (line) print line; line = $0; next } { sub(/^ +/, " "); line = line $0 } END { print line }' |
    awk -v tool="$tool" '{ sub(/^ *(-., *)?/, "") } $2 ~ /^(\[NAME=\])?(FILE|PREFIX)$/ && $1 != "--history" { print $1, ($0 ~ /Extensions: / || $2 == "PREFIX" ? "written" : "read"), tool }'
done | awk '!($1 in of) { of[$1] = $2; by[$1] = $3 } of[$1] != $2 { print $1 " is " of[$1] " in " by[$1] " and " $2 " in " $3 }' >"$words.files"
[[ ! -s $words.files ]] || complain "$(cat "$words.files")"
rm -f "$words.files"

# A word with values of two kinds means two things. PREFIX is the beginning of the FILEs that are written.
sed -i 's/ PREFIX / FILE /' "$words"
two=$(awk '{ value = NF > 2 ? $2 : "-"; if (!($1 in of)) of[$1] = value; else if (of[$1] != value) print $1 ": " of[$1] " and " value " " $NF }' "$words")
[[ -z $two ]] || complain "words with two meanings: $two"
echo "$(wc -l <"$words") options, $failures failures"
((failures == 0))
