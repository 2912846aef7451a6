#!/bin/sh
# meshes.sh [FOLDER]: normal against quality mesh (thesis Table 6.2): a ball, a cuboid, elastic and viscoelastic, and an
# organ, each from one triangulated surface by both; tetrahedra of first order, and the steps that conjugate gradients
# (with an incomplete factor) take for a unit press, whose stiffness then serves every force. Needs the hs- tools on
# the PATH; writes into FOLDER (meshes).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=${1:-meshes}
mkdir -p "$out"
cd "$out"

dome() { awk -v what=dome -v a="$1" -v b="$2" -v c="$3" -v n="$4" -v m="$5" -v lobe="$6" -f "$here/../shapes.awk"; }
dome 0.05 0.05 0.05 14 6 0 >ball.off
dome 0.045 0.035 0.055 18 8 0.12 >organ.off
# The cuboid 120 x 210 x 60 mm as it was scanned: a grid of points on every side.
awk 'BEGIN {
  n[0] = 5; n[1] = 8; n[2] = 3; l[0] = 0.12; l[1] = 0.21; l[2] = 0.06
  for (axis = 0; axis < 3; ++axis) for (end = 0; end < 2; ++end) {
    a = (axis + 1) % 3; b = (axis + 2) % 3
    for (i = 0; i < n[a]; ++i) for (j = 0; j < n[b]; ++j) {
      split("0 0 1 0 1 1 0 1", q, " ")
      for (k = 0; k < 4; ++k) { p[axis] = end * n[axis]; p[a] = i + q[2 * k + 1]; p[b] = j + q[2 * k + 2]; v[k] = node() }
      faces = faces (end ? sprintf("3 %d %d %d\n3 %d %d %d\n", v[0], v[1], v[2], v[0], v[2], v[3]) : sprintf("3 %d %d %d\n3 %d %d %d\n", v[0], v[2], v[1], v[0], v[3], v[2]))
      count += 2
    }
  }
  printf "OFF\n%d %d 0\n%s%s", total, count, points, faces
}
function node(  key) {
  key = p[0] " " p[1] " " p[2]
  if (!(key in known)) { known[key] = total++; points = points sprintf("%g %g %g\n", p[0] * l[0] / n[0], p[1] * l[1] / n[1], p[2] * l[2] / n[2]) }
  return known[key]
}' >cuboid.off

model() { # NU
  printf 'effect,region,parameter,value\nelastic,0,E,20000\nelastic,0,nu,%s\n' "$1"
}
model 0.3 >elastic.csv
{ model 0.3; printf 'viscoelastic,0,E1,10000\nviscoelastic,0,tau1,0.1\nviscoelastic,0,E2,6000\nviscoelastic,0,tau2,0.2\n'; } >viscoelastic.csv
model 0.45 >heart.csv
number() { # NAME FILE: of a summary, or of a mesh
  awk -v name="\"$1\":" '$1 == name && $2 != "{" { print $2 + 0; exit } $1 == name { found = 1 } found && $1 == "\"value\":" { print $2 + 0; exit }' "$2"
}
press() { # BODY MODEL X Y Z: steps
  printf '# tool_radius: 0.006\npress,t,x,y,z,ux,uy,uz\n1,0,%s,%s,%s,0,0,0\n1,0.1,%s,%s,%s,0,0,-0.003\n' "$3" "$4" "$5" "$3" "$4" "$5" >press.csv
  hs-simulate press.csv --body "$1.ply" --model "$2.csv" --own-mesh --solver iterative --json said.json -q -o /dev/null
  number iterations said.json
}
row() { # NAME SURFACE MODEL X Y Z THEIRS-QUALITY THEIRS-NORMAL
  hs-tetmesh "$2.off" --edge "$edge" --json quality.json -q -o quality.ply
  hs-tetmesh "$2.off" --edge "$edge" --normal --json normal.json -q -o normal.ply
  q=$(press quality "$3" "$4" "$5" "$6") n=$(press normal "$3" "$4" "$5" "$6")
  printf '%-22s quality %5d tetrahedra, %3d steps; normal %5d tetrahedra, %3d steps\n' "$1" \
    "$(number tetrahedra quality.json)" "$q" "$(number tetrahedra normal.json)" "$n"
  echo "$1: normal over quality mesh [times],$7,$(awk -v n="$n" -v q="$q" 'BEGIN { printf "%.2f", n / q }')" >>summary.part
}
: >summary.part
edge=0.022 row 'ball' ball elastic 0 0 0.05 7.7
edge=0.023 row 'cuboid (elastic)' cuboid elastic 0.06 0.105 0.06 7.3
edge=0.023 row 'cuboid (viscoelastic)' cuboid viscoelastic 0.06 0.105 0.06 4.3
edge=0.0098 row 'organ' organ heart 0 0 0.055 1.2
{ echo 'figure,thesis,ours'; cat summary.part; } >summary.csv
rm summary.part
