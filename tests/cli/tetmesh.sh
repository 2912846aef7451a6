#!/usr/bin/env bash
# tetmesh.sh BIN: what hs-tetmesh reads, writes, says and returns.
set -uo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/tool.sh" "$1/hs-tetmesh"
# box X0 Y0 Z0 X1 Y1 Z1 [TRIANGLES]: OFF
box() {
  awk -v n="${7:-12}" -v x0="$1" -v y0="$2" -v z0="$3" -v x1="$4" -v y1="$5" -v z1="$6" 'BEGIN {
    print "OFF"; print 8, n, 0
    for (i = 0; i < 8; ++i)
      print (i % 2 ? x1 : x0), (int(i / 2) % 2 ? y1 : y0), (i < 4 ? z0 : z1)
    split("0 2 1,1 2 3,4 5 6,5 7 6,0 1 4,1 5 4,2 6 3,3 6 7,0 4 2,2 4 6,1 3 5,3 7 5", f, ",")
    for (i = 1; i <= n; ++i) print 3, f[i]
  }'
}

box 0 0 0 0.06 0.05 0.04 >box.off
box 0 0 0 0.06 0.05 0.04 11 >open.off
box 0.02 0.02 0.01 0.04 0.035 0.03 >inner.off
printf 'x,y,z\n0,0,0\n1,2,3\n' >scan.csv
printf 'x,y,z\n0,0,0\n' >corner.csv
printf 'press,x,y,z,ux,uy,uz,fx,fy,fz\n1,0.03,0.025,0.04,0,0,-0.001,0,0,1\n' >data.csv

expect 0 'nodes fixed' box.off --order 2 --ascii -o body.ply --vtu b.vtu --gmsh b.msh --inp b.inp \
  --tetgen b --json b.json
for file in b.vtu b.msh b.node b.ele body.ply; do
  expect 0 'of order 2 taken as it is' "$file" --ascii -o back.ply
  cmp -s body.ply back.ply || complain "$file does not come back as it was written"
done
expect 0 'fixed' box.off --order 2 --gmsh c.msh --gmsh-version 4.1 --vtu c.vtu --ascii -o c.ply
for file in c.msh c.vtu; do
  expect 0 'taken as it is' "$file" --ascii -o back.ply
  cmp -s body.ply back.ply || complain "$file does not come back as it was written"
done
expect 0 'tetrahedra' box.off --region inner.off --edge 0.01 --ascii -o r.ply
grep -q ' 1$' r.ply || complain 'no tetrahedron has region 1'
expect 0 'smallest dihedral' box.off --normal -o n.ply
expect 0 'nodes fixed' box.off --contacts data.csv --tool-radius 0.004 --size 0.001 --contact-meshes cm -o k.ply
[[ -s cm-1.vtu ]] || complain 'no contact mesh was written'
expect 0 'worst' box.off --remesh -o k.ply
expect 0 '1 nodes fixed' box.off --fixed file:corner.csv -o k.ply

expect 3 'these are points' scan.csv -o x.ply
expect 3 'hs-scan2ply FILE | hs-reconstruct' scan.csv -o x.ply
expect 3 'hole: of 3 edges about (0.06, 0.0333333, 0.0266667)' open.off -o x.ply
expect 3 'makes about' box.off --max-volume 1e-16 -o x.ply
expect 3 'lies in this region' box.off --region <(box 1 1 1 2 2 2) -o x.ply
expect 3 'no triangle lies where the support is' box.off --fixed plane:3 -o x.ply
expect 2 'names no support' box.off --fixed cube -o x.ply
expect 2 'give --order 2' box.off --curved-to box.off -o x.ply
expect 2 'give --contacts' box.off --contact-meshes m -o x.ply
expect 5 'cannot be written' box.off --vtu /dev/full -o x.ply
[[ ! -e x.ply ]] || complain 'a failed run left its output'
head -c 2000 b.vtu >cut.vtu
expect 3 'cut.vtu' cut.vtu -o x.ply
head -n 40 b.msh >cut.msh
expect 3 'cut.msh:' cut.msh -o x.ply

# A reader of standard error that goes away costs no result.
rm -f body.ply
"$tool" box.off -o body.ply 2> >(exec <&-) || true
wait
[[ -s body.ply ]] || complain 'the body is lost when standard error is closed'
# Quads that are nearly flat, whose diagonals TetGen draws anew: a coarse ball.
for rings in '16 5' '24 8'; do
  read -r n m <<<"$rings"
  awk -v what=dome -v a=0.03 -v b=0.03 -v c=0.03 -v n="$n" -v m="$m" -f "$root/share/examples/shapes.awk" >dome.off
  for edge in 26mm 30mm; do expect 0 'nodes fixed' dome.off --edge $edge -o dome.ply; done
done
"$tool" box.off 2>&- >all.ply
[[ $(head -c 3 all.ply) == ply ]] || complain 'no body on standard output'

((failures == 0)) && printf 'tetmesh: passed\n'
exit $((failures > 0))
