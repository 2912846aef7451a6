#!/usr/bin/env bash
# quantities.sh BIN: every option of every tool that speaks of metres, seconds, newtons or pascals takes its
# value plain, with a unit and with a unit after a space, and understands the same.
set -uo pipefail
bin=$1
failures=0
options=0

# understood TOOL REQUIRED... -- FLAG VALUE: the line of that flag in what the tool has understood
understood() {
  local tool=$1 flag
  shift
  flag=${*: -2:1}
  "$bin/$tool" "${@:1:$#-2}" "$flag" "${*: -1}" --parsed 2>&1 </dev/null | grep -e "^$flag " -e "^$tool:"
}

for path in "$bin"/hs-*; do
  tool=${path##*/}
  [[ $tool != hs-sample ]] || continue
  help=$("$path" --help)
  # flag, name of its value, help on one line
  lines=$(awk '/^[A-Z]/ {on = /^Options/} !on {next}
    /^  -/ {if (line) print line; line = $0; next} {sub(/^ +/, " "); line = line $0} END {print line}' <<<"$help" |
    sed 's/^ *//; s/  */ /g' | grep '^--')
  required=()
  for flag in $(sed -n '/^Usage:/,/^$/p' <<<"$help" | grep -o -e '--[a-z-]*'); do
    choice=$(grep -e "^$flag " <<<"$lines" | sed -n 's/.*One of: \([a-z0-9]*\).*/\1/p')
    required+=("$flag" "${choice:-x}")
  done
  while read -r flag value text; do
    [[ $value =~ ^[A-Z] && $value != FILE ]] || continue
    case $text in
      *"[m]"* | *"A length "* | *"In m"*) plain=0.004 unit=4mm spaced="0.004 m" ;;
      *"[s]"* | *"A time "* | *"In s,"*) plain=0.7 unit=700ms spaced="0.7 s" ;;
      *"[N]"* | *"A force "*) plain=0.02 unit=20mN spaced="0.02 N" ;;
      *"[Pa]"* | *"A pressure "*) plain=3000 unit=3kPa spaced="3000 Pa" ;;
      *) continue ;;
    esac
    case $text in # several numbers in one value
      *"In m"* | *"In s,"*)
        plain=$plain,$plain,$plain spaced=$spaced,$unit,$unit unit=$unit,$unit,$unit ;;
    esac
    options=$((options + 1))
    want=$(understood "$tool" "${required[@]}" "$flag" "$plain")
    for spelt in "$unit" "$spaced"; do
      got=$(understood "$tool" "${required[@]}" "$flag" "$spelt")
      if [[ $got != "$want" || $got != "$flag ${plain//,*/}"* ]]; then
        echo "FAILED: $tool $flag '$spelt' is understood as '$got', $plain as '$want'"
        failures=$((failures + 1))
      fi
    done
    # a unit of something else is refused
    if [[ $(understood "$tool" "${required[@]}" "$flag" 1parsec) != *"unknown unit"* ]]; then
      echo "FAILED: $tool $flag takes parsecs"
      failures=$((failures + 1))
    fi
  done <<<"$lines"
done
((options >= 40)) || { echo "FAILED: only $options options have units"; failures=$((failures + 1)); }
echo "$options options with units, $failures failures"
((failures == 0))
