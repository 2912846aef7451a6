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

# Each number in the text of a section is one that its commands say or write, or the truth's (numbers.awk).
for section in a b c d e; do
  tables=("$section"[0-9].csv "$section"[0-9]-effects.csv "history-$section.csv")
  for k in "${!tables[@]}"; do [[ -e ${tables[k]} ]] || unset "tables[k]"; done
  awk -v section="$section" -v least="$([[ $section == d ]] && echo 0 || echo 1)" -f "$root/tests/cli/numbers.awk" \
    mode=told "said-$section" "truth/$section.csv" "${tables[@]}" mode=text README.md >wrong
  [[ ! -s wrong ]] || { cat wrong; fail "numbers of README.md differ from the run's"; }
done

# What stands indented is what was said, but for lines that leave something out.
for section in a b c d e; do
  tr -s '\n ' ' ' <"said-$section" >said
  while IFS= read -r line; do
    grep -qF -- "$(tr -s ' ' <<<"$line" | sed 's/^ //; s/ $//')" said || fail "section $section: nothing says: $line"
  done < <(awk -v section="$section" '/^## / { here = substr($2, 1, 1) == section } here && /^    [^ ]|^     /' README.md | grep -v '\.\.\.')
done
# Where the model of a fails, in the words of the text.
where=$(tr '\n' ' ' <README.md | grep -o '[0-9]* % too soft here, [0-9]* % too stiff there' | sed 's/\([0-9]*\) % too soft here, \([0-9]*\) .*/too soft by \1 % at [^a-z]* mm, too stiff by \2 %/')
[[ -n $where ]] && tr -s '\n ' ' ' <said-a | grep -q "$where" || fail "where the model fails is not as the text says: $where"

verdict() { awk -F, '!/^#/ && $1 == 0 { print $3 }' "$1"; }
first() { awk -F, '!/^#/ && $1 == 1 { print $2 "," $3 }' "$1"; }
is() { [[ $2 == "$3" ]] || fail "$1 is $2, not $3"; }
is a "$(first a0-effects.csv)" regions,missing
is b "$(first b0-effects.csv)" friction,missing
is c "$(awk -F, '{ last = $3 } END { print last }' history-c.csv)" elastic+sensor-drift+viscoelastic
is d "$(verdict d0-effects.csv)" complete
is e "$(first e0-effects.csv)" sensor-hum,missing
grep -q '</html>' c.html || fail "the report is not whole"
printf 'tutorial: passed\n'
