#!/usr/bin/env bash
# export.sh BIN: what hs-export writes is read by the others; what cannot be exported is refused by name.
# tests/verify/export_test.cpp compares the forces.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh"
"$bin/hs-tetmesh" -q box.off --max-volume 1e-7 --order 1 -o body.ply || exit 1
"$bin/hs-tetmesh" -q box.off --max-volume 1e-7 --order 2 -o second.ply || exit 1
awk 'BEGIN { print "# tool_radius: 0.006\npress,t,x,y,z,ux,uy,uz"
  for (p = 3; p < 5; ++p) for (i = 0; i <= 60; ++i)
    printf "%d,%.2f,0.03,0.025,0.04,%.6f,0,%.6f\n", p, 0.02 * i, (p == 4) * 1e-5 * i, -2e-5 * i }' >motion.csv
elastic='effect,region,parameter,value
elastic,0,E,10000
elastic,0,nu,0.4'
printf '%s\n' "$elastic" >elastic.csv
printf '%s\nviscoelastic,0,E1,5000\nviscoelastic,0,tau1,0.3\n' "$elastic" >viscoelastic.csv
printf '%s\nhyperelastic,0,s,0\nhyperelastic,0,finite,1\n' "$elastic" >finite.csv
printf '%s\nhyperelastic,0,s,0.3\nhyperelastic,0,finite,1\n' "$elastic" >stiffening.csv
printf '%s\ntip,0,kappa,100\n' "$elastic" >tip.csv
printf '%s\nsensor-bias,0,bx,0.1\nsensor-bias,0,by,0\nsensor-bias,0,bz,0\n' "$elastic" >bias.csv
printf '%s\ninclusion,0,x,0.03\n' "$elastic" >inclusion.csv

export_to() { # CODE TEXT FORMAT MODEL ARGUMENTS...
  local wanted=$1 text=$2 format=$3 model=$4
  shift 4
  "$bin/hs-export" $model --format $format --body "${body:-body.ply}" --data motion.csv "$@" >out 2>err
  local got=$?
  ((got == wanted)) && flat err | grep -qF -- "$text" || complain "$got: hs-export $model --format $format $*"
  ((wanted == 0)) || [[ ! -s out && $(wc -l <err) == 1 ]] || complain 'a refusal is one line and no file'
}
well_formed() { xmllint --noout out 2>err || complain "$1 is XML"; } # the file out
need xmllint
export_to 0 'order 1, 20 steps' calculix elastic.csv
flat err | grep -q 'nodes under the tool: this mesh is' || complain 'what the mesh does under the tool is said'
sed 's/^# tool_radius: 0.006/# tool_radius: 0.001/' motion.csv >small.csv
"$bin/hs-export" elastic.csv --format calculix --body body.ply --data small.csv -o small.inp 2>err
flat err | grep -q 'warning: [0-9]* nodes* under the tool: this mesh is too coarse there, [0-9]* % s' || complain 'a coarse deck is a warning'
head -n 1 out | grep -Eq '^\*\* (warning: )?[0-9]+ nodes? under the tool: this mesh is' || complain 'the deck says it too'
[[ $(grep -c '^\*STEP' out) == 20 ]] && grep -q '^TOOL, 3, 3, -1.2' out || complain 'the deepest row is a step'
awk -F, '/^\*NODE,/ { n = 1; next } /^\*/ { n = 0 } n && (length($2) > 20 || length($4) > 21) { exit 1 }' out ||
  complain 'a field of CalculiX has 20 characters at most'
# Matched: one place alone, then two; the deck says how near it is.
export_to 0 "of hapsim's at this press; the moduli are" calculix elastic.csv --match
flat err | grep -q 'learned here, for the recording has no other place' || complain 'one place is told'
head -n 1 out | grep -q '^\*\* matched to hapsim: its force is within [0-9.]* %' && grep -q 'TYPE=C3D10' out || complain 'the matched deck says so'
{ cat motion.csv; printf '5,0,0.01,0.01,0.04,0,0,0\n5,1,0.012,0.015,0.04,0,0,-0.001\n' | sed 's/0.01,0.01,/0.012,0.015,/'; } >places.csv
"$bin/hs-export" -q elastic.csv --format sofa --body body.ply --data places.csv --match --json match.json -o match.scn 2>err || complain 'matched for SOFA'
grep -q '<!-- matched to hapsim: .*learned at 1 other' match.scn || complain 'the scene says so'
awk '$2 == "{" { name = $1 } $1 == "\"value\":" { v[name] = $2 + 0 }
  END { exit !(v["\"order\":"] == 1 && v["\"modulus_factor\":"] < 0.95 && v["\"largest_held_out_error\":"] < 0.05 && v["\"tetrahedra\":"] > 1000) }' match.json || complain 'first order is softened'
"$bin/hs-tetmesh" -q match.scn -o back.ply 2>err || complain 'comments are passed over'
cp match.scn out && well_formed SOFA
export_to 2 'export to calculix, febio or sofa' gmsh elastic.csv --match
export_to 0 '20 steps' calculix finite.csv --press 4
grep -q 'NEO HOOKE' out && grep -q 'NLGEOM' out && grep -q '^TOOL, 1, 1, 6.0' out || complain 'finite strain, the other press'
export_to 0 'steps' febio viscoelastic.csv
grep -q '<g1>0.5</g1>' out && grep -q '<t1>0.3</t1>' out && grep -q 'pt>1.2,-0.0012<' out || complain 'relaxation for FEBio'
well_formed FEBio
body=second.ply export_to 0 "steps" febio finite.csv
well_formed FEBio
grep -q 'tet10' out || complain 'second order for FEBio'
export_to 0 'steps' sofa elastic.csv
well_formed SOFA
export_to 0 'steps' calculix bias.csv --bare
export_to 3 'hs-export: viscoelastic.csv: CalculiX has no linear viscoelasticity' calculix viscoelastic.csv
export_to 3 'the scene for SOFA has no finite strain' sofa finite.csv
body=second.ply export_to 3 "hs-export: second.ply: SOFA's tetrahedra are of first order" sofa elastic.csv
export_to 3 'the effect tip cannot be exported' calculix tip.csv
export_to 3 'the effect hyperelastic cannot be exported: its exponential law' febio stiffening.csv
export_to 3 'the effect sensor-bias acts on what is measured' febio bias.csv
export_to 2 'has no press 9' calculix elastic.csv --press 9
export_to 3 'inclusion' calculix inclusion.csv

regions() { "$bin/hs-tetmesh" -q "$1" --ascii | awk '$1 == 4 && NF == 6 { print $NF }' | sort | uniq -c; }
# Meshes come back with their regions, and every tool takes them as a body.
"$bin/hs-tetmesh" -q body.ply --ascii | awk '$1 == 4 && NF == 6 { $NF = n++ % 2 } 1' >parts.ply
printf '%s\nelastic,1,E,20000\n' "$elastic" >two.csv
"$bin/hs-simulate" -q motion.csv --body parts.ply --model two.csv --own-mesh -o expected.csv || complain 'the body is pressed'
for format in vtu gmsh calculix febio sofa; do
  "$bin/hs-export" -q two.csv --format $format --body parts.ply >back.$format || complain "$format is written"
  "$bin/hs-simulate" -q motion.csv --body back.$format --model two.csv --own-mesh -o forces.csv || complain "$format is a body"
  paste -d, <(grep '^[0-9]' expected.csv) <(grep '^[0-9]' forces.csv) |
    awk -F, '{ for (k = 9; k <= 11; ++k) { d = $k - $(k + NF / 2); if (d < 0) d = -d; if (d > 1e-9) bad = 1 } n++ } END { exit bad || n != 122 }' ||
    complain "$format gives the same forces"
  cmp -s <(regions parts.ply) <(regions back.$format) || complain "$format keeps the body's regions"
done
# E of a number acts where the tetrahedra have it; of no number nowhere.
"$bin/hs-export" two.csv --format calculix --body parts.ply | grep -A1 '^\*ELASTIC' | grep -c '^[12]\.0*e+04, 4\.0*e-01' | grep -q '^2$' ||
  complain 'both moduli are in the deck'
grep -q 'acts nowhere' <("$bin/hs-export" two.csv --format vtu --body parts.ply 2>&1 >/dev/null) && complain 'both moduli act'
grep -q 'elastic E of region 1 acts nowhere' <("$bin/hs-export" two.csv --format vtu --body body.ply 2>&1 >/dev/null) ||
  complain 'a modulus without a place is told'
{ echo '# converged: no'; echo "$elastic"; } >early.csv
grep -q 'before it converged' <("$bin/hs-export" early.csv --format vtu --body parts.ply 2>&1 >/dev/null) ||
  complain 'a fit that did not converge is told'
# A deck as others write them: words in any case, an element over two lines, sets by ranges, a clamp.
cat >deck.inp <<'INP'
*Heading
 a tetrahedron
** written by hand
*Node
1, 0., 0., 0.
2, 0.05, 0, 0
3, 0, 0.05, 0
7, 0, 0, 5e-2
11, .025,0,0
12, .025,.025,0
13, 0,.025,0
14, 0,0,.025
15, .025,0,.025
16, 0,.025,.025
*Element, type=C3D10, elset=all
40, 1, 2, 3, 7, 11, 12, 13,
14, 15, 16
*Elset, elset=region_3, generate
1, 2000000000, 39
*Nset, nset=ground, generate
1, 3, 1
*Boundary
ground, 1, 3
*Step
*Boundary
7, 1, 3
INP
"$bin/hs-tetmesh" -q deck.inp --ascii -o deck.ply 2>err || complain 'a deck is read'
[[ $(awk '/^end_header/ { n = 1; next } n && n++ <= 10 { s = s $4 } END { print s }' deck.ply) == 1110000000 ]] || complain 'the clamp before the step is the support'
"$bin/hs-export" -q elastic.csv --format gmsh --body deck.ply -o /dev/null || complain 'the deck is a body'
deck() { # TEXT SED: what is said of a damaged deck
  sed "$2" deck.inp >bad.inp
  "$bin/hs-tetmesh" -q bad.inp -o bad.ply 2>err
  [[ $? == 3 && $(wc -l <err) == 1 ]] && grep -qF "$1" err || complain "a damaged deck: $1"
}
deck 'bad.inp:17: there is no node 99' 's/^14, 15, 16/14, 15, 99/'
deck 'bad.inp:6: node 1 is given twice' 's/^2, 0.05/1, 0.05/'
deck "bad.inp:5: 'zero' is no coordinate" 's/^1, 0., 0./1, zero, 0./'
deck 'only tetrahedra are read: split the other cells first' 's/C3D10/C3D8/'
deck 'the deck includes another file' 's/^.Heading/*Include, input=nodes.inp/'
((failures == 0)) && echo 'export: passed'
exit $((failures > 0))
