#!/usr/bin/env bash
# tutorial.sh BIN: every command of the tutorial on hidden effects runs as it is printed, and finds what
# the text says.
set -euo pipefail
bin=$(cd "$1" && pwd)
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
export XDG_CACHE_HOME=$out/cache PATH=$bin:$PATH
fail() { printf 'tutorial: %s\n' "$*"; exit 1; }

cp -r "$root/share/examples" "$out/examples"
cd "$out/examples/hidden-effects"
awk '/^```sh$/ { on = 1; next } /^```/ { on = 0 } on' README.md >commands.sh
(($(wc -l <commands.sh) > 15)) || fail "the commands of README.md were not found"
bash -euo pipefail commands.sh 2>log || { tail -n 5 log; fail "a command failed"; }

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
