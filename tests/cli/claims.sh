#!/usr/bin/env bash
# claims.sh BIN: files whose header claims two thousand million of something are refused in one line before
# memory is taken for it (there are 1.2 GB of address space here).
cases=$(cd "$(dirname "${BASH_SOURCE[0]}")/../fuzz/cases" && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh"
many=2000000000
export LC_ALL=C
# Sanitizers need more address space than that.
bounded=1200000
(ulimit -v $bounded && "$bin/hs-tetmesh" --version) >/dev/null 2>&1 || { bounded=unlimited; echo 'SKIPPED: these tools do not start in 1.2 GB'; }
refused() { # TOOL FILE
  (ulimit -v $bounded; "$bin/$1" "$2" -q -o out) >/dev/null 2>err
  local code=$?
  [[ $code == 3 && $(wc -l <err) == 1 && ! -e out ]] && grep -q "^$1: $2" err || complain "$2 (exit $code)"
}
next_line() { awk -v after="$1" -v text="$2" 'f { print text; f = 0; next } index($0, after) == 1 { f = 1 } 1' "$3"; } # AFTER TEXT FILE

for kind in vertex face tetrahedron; do
  sed "0,/element $kind [0-9]*/s//element $kind $many/" "$cases/ply/t1.txt.ply" >text-$kind.ply && refused hs-tetmesh text-$kind.ply
  sed "0,/element $kind [0-9]*/s//element $kind $many/" "$cases/ply/tet1.ply" >binary-$kind.ply && refused hs-tetmesh binary-$kind.ply
done
printf 'OFF\n%s 12 0\n0 0 0\n' $many >vertices.off && refused hs-tetmesh vertices.off
printf 'OFF\n1 %s 0\n0 0 0\n3 0 0 0\n' $many >faces.off && refused hs-tetmesh faces.off
{ head -c 80 /dev/zero; printf '\0\0\0\167'; head -c 50 /dev/zero; } >triangles.stl && refused hs-tetmesh triangles.stl
for list in Nodes Elements; do
  next_line "\$$list" $many "$cases/mesh/t1.gmsh" >$list-2.msh && refused hs-tetmesh $list-2.msh
  next_line "\$$list" "1 $many 1 $many" "$cases/mesh/t1.gmsh41" >$list-4.msh && refused hs-tetmesh $list-4.msh
done
printf '%s 3 0 0\n1 0 0 0\n' $many >nodes.node && printf '1 4 0\n1 1 1 1 1\n' >nodes.ele && refused hs-tetmesh nodes.node
for file in t1.txt t1; do
  for what in Points Cells; do
    sed "0,/NumberOf$what=\"[0-9]*\"/s//NumberOf$what=\"$many\"/" "$cases/vtu/$file.vtu" >$file-$what.vtu && refused hs-tetmesh $file-$what.vtu
  done
done
for file in text binary compressed; do
  sed "s/^POINTS .*/POINTS $many/; s/^WIDTH .*/WIDTH $many/; 1{/^FIELDS/s/^/VERSION .7\\n/}" "$cases/pcd/$file.pcd" >$file.pcd && refused hs-scan2ply $file.pcd
done
for file in text raw gzip; do
  sed 's/^sizes: .*/sizes: 30000 30000 30000/' "$cases/volume/$file.nrrd" >$file.nrrd && refused hs-scan2ply $file.nrrd
done
# NIfTI: 16 bits an axis, from byte 42 on.
{ head -c 42 "$cases/volume/small.nii"; printf '\377\177\377\177\377\177'; tail -c +49 "$cases/volume/small.nii"; } >large.nii && refused hs-scan2ply large.nii
((failures == 0)) && echo 'claims: passed'
exit $((failures > 0))
