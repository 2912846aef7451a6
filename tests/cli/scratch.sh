# Sourced by the command tests, with BIN as $1: an own empty folder to work in, a count of failures,
# and a box of 60 x 50 x 40 mm as box.off.
set -uo pipefail
bin=$1
work=$(mktemp -d)
# A child that is killed before it has become its command must not tidy up.
trap '[[ $BASHPID != "$$" ]] || rm -rf "$work"' EXIT
cd "$work" || exit 1
export XDG_CACHE_HOME=$work/cache
failures=0
complain() { # TEXT
  printf 'FAILED: %s\n' "$1"
  [[ -s err ]] && sed 's/^/    /' err
  failures=$((failures + 1))
}
awk 'BEGIN {
  print "OFF"; print 8, 12, 0
  for (i = 0; i < 8; ++i) print (i % 2) * 0.06, (int(i / 2) % 2) * 0.05, (i >= 4) * 0.04
  split("0 2 1,1 2 3,4 5 6,5 7 6,0 1 4,1 5 4,2 6 3,3 6 7,0 4 2,2 4 6,1 3 5,3 7 5", f, ",")
  for (i = 1; i <= 12; ++i) print 3, f[i]
}' >box.off
