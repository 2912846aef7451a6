#!/usr/bin/env bash
# compare.sh OLD NEW: the files of two recordings (record.sh) that differ, byte by byte. Of a text whose words are
# the same it tells how far its numbers differ at most: relative to themselves, and to the largest number in that
# column (numbers near zero, which rounding alone moves, differ by much of themselves). Otherwise it shows the
# first lines that differ. Exit code 1 when anything differs.
set -uo pipefail
(($# == 2)) && [[ -d $1 && -d $2 ]] || { echo 'usage: compare.sh OLD NEW' >&2; exit 2; }
old=${1%/} new=${2%/}
export LC_ALL=C

recorded() { # FOLDER: the files that are compared
  (cd "$1" && find . -type f ! -path ./times.txt ! -path ./stderr ! -path './cache/*' ! -path './tools/*' | sed 's|^\./||' | sort)
}

# A line a number, marked by a 1, and a line a piece of text between numbers; each line of the file begins by a 2.
pieces() { sed -E 's/[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?/\n\x01&\n/g; s/^/\x02\n/' "$1"; }

# Prints how far the numbers differ; nothing when the words differ.
numbers() { # OLD NEW
  paste -d $'\003' <(pieces "$1") <(pieces "$2") | awk -F '\003' '
    function size(x) { return x < 0 ? -x : x }
    $1 == "\002" { ++line; column = 0 }
    $1 == $2 && $1 !~ /^\001/ { next }
    $1 !~ /^\001/ || $2 !~ /^\001/ { differ = 1; exit }
    {
      ++column
      a = substr($1, 2) + 0; b = substr($2, 2) + 0
      top = size(a) > size(b) ? size(a) : size(b)
      if (top > most[column]) most[column] = top
      if ($1 == $2) next
      ++n
      d = size(a - b)
      if (d > off[column]) off[column] = d
      if (top > 0 && d / top >= worst) { worst = d / top; where = sprintf("line %d: %s, now %s", line, substr($1, 2), substr($2, 2)) }
    }
    END {
      if (differ || !n) exit
      for (c in off) if (most[c] > 0 && off[c] / most[c] > share) share = off[c] / most[c]
      printf "%.3g %.3g %d numbers differ, at most by %.3g of themselves (%s), by %.3g of the largest in the column\n", worst, share, n, worst, where, share
    }'
}

# The first lines that differ; of long ones (reports) what stands about the first byte that differs.
first_lines() { # OLD NEW
  local lines at file
  lines=$(diff "$1" "$2" | head -n 8)
  if awk 'length > 240 { exit 1 }' <<<"$lines"; then
    printf '%s\n' "$lines"
  else
    at=$(cmp "$1" "$2" 2>&1 | sed -E 's/.* (byte|char) ([0-9]+).*/\2/')
    for file in "$1" "$2"; do
      printf 'byte %s: %s\n' "$at" "$(tail -c "+$((at > 80 ? at - 80 : 1))" "$file" | head -c 200 | tr '\n' ' ')"
    done
  fi
}

identical=0 numeric=0 other=0 alone=0 largest=0 largest_share=0
greater() { awk -v a="$1" -v b="$2" 'BEGIN { print (a + 0 > b + 0 ? a : b) }'; }
while IFS= read -r file; do
  a=$old/$file b=$new/$file
  if [[ ! -e $a || ! -e $b ]]; then
    [[ -e $a ]] && echo "only in OLD: $file" || echo "only in NEW: $file"
    alone=$((alone + 1))
  elif cmp -s "$a" "$b"; then
    identical=$((identical + 1))
  elif [[ -s $a && -s $b ]] && ! { grep -qI '' "$a" && grep -qI '' "$b"; }; then
    printf '%s: binary, %s and %s bytes, %s of them differ\n' "$file" "$(stat -c %s "$a")" "$(stat -c %s "$b")" \
      "$(cmp -l "$a" "$b" 2>/dev/null | wc -l)"
    other=$((other + 1))
  elif text=$(numbers "$a" "$b") && [[ -n $text ]]; then
    read -r worst share text <<<"$text"
    printf '%s: %s\n' "$file" "$text"
    largest=$(greater "$worst" "$largest") largest_share=$(greater "$share" "$largest_share")
    numeric=$((numeric + 1))
  else
    printf '%s:\n' "$file"
    first_lines "$a" "$b" | sed 's/^/    /'
    other=$((other + 1))
  fi
done < <(sort -u <(recorded "$old") <(recorded "$new"))

printf '%d files are identical; %d differ in numbers alone' "$identical" "$numeric"
((numeric == 0)) || printf ' (at most by %s of themselves, %s of the largest in the column)' "$largest" "$largest_share"
printf ', %d otherwise; %d are in one recording only\n' "$other" "$alone"
((identical > 0 && numeric + other + alone == 0))
