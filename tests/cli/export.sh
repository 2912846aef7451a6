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
  ((got == wanted)) && grep -qF -- "$text" err || complain "$got: hs-export $model --format $format $*"
  ((wanted == 0)) || [[ ! -s out && $(wc -l <err) == 1 ]] || complain 'a refusal is one line and no file'
}
well_formed() { # the file out, where a parser is installed
  if command -v xmllint >/dev/null; then xmllint --noout out 2>err || complain "$1 is XML"
  elif command -v python3 >/dev/null; then python3 -c 'import xml.dom.minidom as m; m.parse("out")' 2>err || complain "$1 is XML"
  else echo "SKIPPED: neither xmllint nor python3 reads the XML"; fi
}
export_to 0 'nodes under the tool, 20 steps' calculix elastic.csv
[[ $(grep -c '^\*STEP' out) == 20 ]] && grep -q '^TOOL, 3, 3, -1.2' out || complain 'the deepest row is a step'
awk -F, '/^\*NODE,/ { n = 1; next } /^\*/ { n = 0 } n && (length($2) > 20 || length($4) > 21) { exit 1 }' out ||
  complain 'a field of CalculiX has 20 characters at most'
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
export_to 2 'CalculiX has no linear viscoelasticity' calculix viscoelastic.csv
export_to 2 'the scene for SOFA has no finite strain' sofa finite.csv
body=second.ply export_to 2 "SOFA's tetrahedra are of first order" sofa elastic.csv
export_to 2 'the effect tip cannot be exported' calculix tip.csv
export_to 2 'the effect hyperelastic cannot be exported: its exponential law' febio stiffening.csv
export_to 2 'the effect sensor-bias acts on what is measured' febio bias.csv
export_to 2 'has no press 9' calculix elastic.csv --press 9
export_to 3 'inclusion' calculix inclusion.csv

# Meshes come back, and every tool takes them as a body.
"$bin/hs-simulate" -q motion.csv --body body.ply --model elastic.csv --own-mesh -o expected.csv || complain 'the body is pressed'
for format in vtu gmsh; do
  "$bin/hs-export" -q elastic.csv --format $format --body body.ply -o back.$format || complain "$format is written"
  "$bin/hs-simulate" -q motion.csv --body back.$format --model elastic.csv --own-mesh -o forces.csv || complain "$format is a body"
  cmp -s <(grep -v '^#' expected.csv) <(grep -v '^#' forces.csv) || complain "$format gives the same forces"
done
((failures == 0)) && echo 'export: passed'
exit $((failures > 0))
