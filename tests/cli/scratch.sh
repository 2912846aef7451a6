# Sourced by the command tests, with BIN as $1: an own empty folder to work in, a count of failures,
# a box of 60 x 50 x 40 mm as box.off, and what presses and scans it.
set -uo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
bin=$(cd "$1" && pwd)
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
box_presses() { # SAMPLES STEP: a motion of three presses on its top, so many samples of STEP [m] down
  awk -v samples="$1" -v step="$2" 'BEGIN {
    print "# tool_radius: 0.004\n# force_noise: 0.002\npress,t,x,y,z,ux,uy,uz"
    for (p = 0; p < 3; ++p) for (i = 0; i <= samples; ++i)
      printf "%d,%.2f,%.3f,0.025,0.04,0,0,%.6f\n", p, 0.05 * i, 0.02 + 0.01 * p, -i * step }'
}
box_scan() { # points all over it [mm]
  awk 'BEGIN { srand(3); print "x,y,z"; for (i = 0; i < 3000; ++i) { f = int(3 * rand()); a = rand(); b = rand(); s = rand() < 0.5
    x = f == 0 ? s : a; y = f == 1 ? s : f == 0 ? a : b; z = f == 2 ? s : b; print 60 * x "," 50 * y "," 40 * z } }'
}
