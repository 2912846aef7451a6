#!/usr/bin/env bash
# tutorial.sh BIN: every command of the tutorial on hidden effects runs as it is printed and finds what
# the text says, and each number in the text is one of the run's.
set -euo pipefail
bin=$(cd "$1" && pwd)
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
export XDG_CACHE_HOME=$out/cache PATH=$bin:$PATH
fail() { printf 'tutorial: %s\n' "$*"; exit 1; }

cp -r "$root/share/examples" "$out/examples"
cd "$out/examples/hidden-effects"
# Each section's commands, and what they say, in files of its own: commands-a.sh, said-a.
awk 'BEGIN { name = 0 } /^## / { name = substr($2, 1, 1) }
     /^```sh$/ { on = 1; next } /^```/ { on = 0 } on { print >("commands-" name ".sh") }' README.md
(($(cat commands-?.sh | wc -l) > 15)) || fail "the commands of README.md were not found"
for section in 0 a b c d e; do
  bash -euo pipefail "commands-$section.sh" 2>"said-$section" ||
    { tail -n 5 "said-$section"; fail "a command failed"; }
done

# Each number with a fraction, or of newtons, millimetres, per cent or times the noise, in the text of a
# section is one that its commands say or write, or the truth's, rounded as the text rounds it.
for section in a b c d e; do
  cat "said-$section" "truth/$section.csv" "$section"[0-9].csv "$section"[0-9]-effects.csv \
    "history-$section.csv" >told 2>none || true
  awk -v section="$section" '
    function a_number(text) { return match(text, /-?[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?/) }
    FNR == NR {
      for (text = $0; a_number(text); text = substr(text, RSTART + RLENGTH))
        told[++count] = substr(text, RSTART, RLENGTH)
      next
    }
    /^## / { here = substr($2, 1, 1) == section }
    /^```/ { code = !code }
    here && !code { gsub(/`[^`]*`/, ""); all = all " " $0 }
    END {
      for (; a_number(all); all = substr(all, RSTART + RLENGTH)) {
        number = substr(all, RSTART, RLENGTH)
        after = substr(all, RSTART + RLENGTH)
        if (number !~ /\./ && after !~ /^ (N|mm|%|kPa|x noise|times the noise)/) continue
        digits = number ~ /\./ ? length(number) - index(number, ".") : 0
        scale = after ~ /^ kPa/ ? 1e-3 : 1 # told in Pa
        found = 0
        for (k = 1; k <= count && !found; ++k)
          found = sprintf("%.*f", digits, scale * told[k]) + 0 == number + 0
        ++checked
        if (!found) print "section " section ": nothing that was run says " number substr(after, 1, 12)
      }
      if (checked == 0 && section != "d") print "section " section ": the text has no numbers"
    }' told README.md >wrong
  [[ ! -s wrong ]] || { cat wrong; fail "numbers of README.md differ from the run's"; }
done

verdict() { awk -F, '!/^#/ && $1 == 0 { print $3 }' "$1"; }
first() { awk -F, '!/^#/ && $1 == 1 { print $2 "," $3 }' "$1"; }
is() { [[ $2 == "$3" ]] || fail "$1 is $2, not $3"; }
is a "$(first a0-effects.csv)" regions,missing
is b "$(first b0-effects.csv)" friction,missing
is c "$(awk -F, '{ last = $3 } END { print last }' history-c.csv)" elastic+sensor-drift+viscoelastic
is d "$(verdict d0-effects.csv)" complete
is e "$(verdict e0-effects.csv)" unexplained
grep -q '</html>' c.html || fail "the report is not whole"
printf 'tutorial: passed\n'
