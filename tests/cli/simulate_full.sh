#!/usr/bin/env bash
# simulate_full.sh BIN: hs-simulate --full agrees with the quick laws where they hold, presses with
# several tools and with given forces, and says where it fails.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"
# The largest difference of the columns named, as a share of the largest value.
apart() { # FILE FILE COLUMN...
  local a=$1 b=$2
  shift 2
  awk -F, -v names="$*" '
    BEGIN { count = split(names, name, " ") }
    /^#/ { next }
    FNR != NR && !second { second = 1; row = 0; header = 0 }
    !header { header = 1; for (i = 1; i <= NF; ++i) at[second + 0, $i] = i; next }
    { ++row; for (k = 1; k <= count; ++k) {
        value = $at[second + 0, name[k]]
        if (!second) { first[row, k] = value; continue }
        difference = value - first[row, k]; if (difference < 0) difference = -difference
        if (difference > worst) worst = difference
        if (value < 0) value = -value
        if (value > most) most = value } }
    END { print (most > 0 ? worst / most : 1) }' "$a" "$b"
}
below() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a < b) }'; }

awk 'BEGIN {
  print "# tool_radius: 0.004"; print "press,x,y,z,ux,uy,uz,fx,fy,fz"
  print "1,0.02,0.025,0.04,0,0,-0.001,0,0,1"; print "2,0.045,0.025,0.04,0,0,-0.001,0,0,1"
}' >contacts.csv
"$bin/hs-tetmesh" box.off --edge 0.012 --contacts contacts.csv --tool-radius 0.004 -q -o body.ply 2>err ||
  complain 'no body'
head=effect,region,parameter,value,unit,std_error,lower,upper,state
cat >linear.csv <<END
$head
elastic,0,E,20000,Pa,,1,1e12,fixed
elastic,0,nu,0.4,1,,0,0.499,fixed
viscoelastic,0,E1,8000,Pa,,0,1e12,fixed
viscoelastic,0,tau1,0.2,s,,0.0001,100000,fixed
sensor-bias,0,bx,0.01,N,,-10,10,fixed
sensor-bias,0,by,0,N,,-10,10,fixed
sensor-bias,0,bz,0.02,N,,-10,10,fixed
END
cat >finite.csv <<END
$head
elastic,0,E,20000,Pa,,1,1e12,fixed
elastic,0,nu,0.4,1,,0,0.499,fixed
hyperelastic,0,s,0.2,1,,0,1.2,fixed
hyperelastic,0,finite,1,1,,0,1,fixed
END
{ cat finite.csv; printf 'tip,0,kappa,100,1/m,,0,10000,fixed\nfriction,0,mu,0.4,1,,0.001,1000,fixed\n'; } >tip.csv
awk 'BEGIN {
  print "# tool_radius: 0.004"; print "press,t,x,y,z,ux,uy,uz"
  for (i = 0; i <= 4; ++i) printf "1,%g,0.02,0.025,0.04,%g,0,%g\n", 0.1 * i, 2e-5 * i, -2e-4 * i
}' >motion.csv

"$bin/hs-simulate" motion.csv --body body.ply --model linear.csv -q -o quick.csv 2>err || complain 'the quick laws failed'
"$bin/hs-simulate" --full motion.csv --body body.ply --model linear.csv -o full.csv 2>err || complain 'the linear body failed'
grep -q '5 rows by finite elements' err || complain 'no summary'
below "$(apart quick.csv full.csv fx fy fz)" 1e-9 || complain 'a linear body has other forces in full'

# Finite strain, a round tip that slips; the forces given back find the motion.
"$bin/hs-simulate" --full --own-mesh motion.csv --body body.ply --model finite.csv -q -o finite-forces.csv 2>err ||
  complain 'finite strain failed'
"$bin/hs-simulate" --full --own-mesh --force-control finite-forces.csv --body body.ply --model finite.csv -q -o back.csv 2>err ||
  complain 'given forces failed'
below "$(apart motion.csv back.csv ux uy uz)" 1e-6 || complain 'given forces do not find the motion'
"$bin/hs-simulate" --full --rim-edge 0.33 motion.csv --body body.ply --model tip.csv -q -o tip-forces.csv 2>err ||
  complain 'a tip with friction failed'
awk -F, '/^#/ { next } !h++ { for (i = 1; i <= NF; ++i) at[$i] = i; next }
  $at["fz"] < 0 || $at["fx"]^2 + $at["fy"]^2 > (0.4 * $at["fz"])^2 * 1.000001 + 1e-20 { exit 1 }
  { last = $at["fz"] } END { exit !(last > 0) }' tip-forces.csv || complain 'the tip pulls, or slips beyond its bound'

# Two tools at once: rows of one time, one a tool.
awk 'BEGIN {
  print "# tool_radius: 0.004"; print "press,t,tool_id,x,y,z,ux,uy,uz"
  for (i = 0; i <= 2; ++i) {
    printf "1,%g,left,0.02,0.025,0.04,0,0,%g\n", 0.1 * i, -2e-4 * i
    printf "1,%g,right,0.045,0.025,0.04,0,0,%g\n", 0.1 * i, -1e-4 * i
  }
}' >two.csv
"$bin/hs-simulate" --full two.csv --body body.ply --model linear.csv -q -o two-forces.csv 2>err || complain 'two tools failed'
[[ $(grep -c '^1,' two-forces.csv) == 6 ]] || complain 'two tools lose rows'

# What fails says where: a step that turns elements inside out, an effect it has no form of.
sed 's/^\(1,0.4,.*\),[^,]*$/\1,-0.039/' motion.csv >deep.csv
"$bin/hs-simulate" --full --own-mesh deep.csv --body body.ply --model finite.csv -q -o none.csv 2>err
[[ $? == 4 ]] || complain 'no convergence is not exit code 4'
grep -q 'hs-simulate: deep.csv:7: the body was deformed to' err || complain 'no convergence does not say where'
[[ -e none.csv ]] && complain 'a failed run leaves a file behind'
{ cat linear.csv; printf 'damper,0,c,1,N s/m,,0,1000000,fixed\n'; } >damped.csv
"$bin/hs-simulate" --full motion.csv --body body.ply --model damped.csv -q 2>err >/dev/null
[[ $? == 3 ]] && grep -q damper err || complain 'an effect without such a form is not refused'
# Forces that are given without elements at every step, on the contacts' meshes and on the body's own by either solver.
grep -v '^sensor' linear.csv >pure.csv
round() { # NAME ARGUMENTS...: the forces of the motion find the motion
  "$bin/hs-simulate" motion.csv --body body.ply --model pure.csv -q "${@:2}" -o there.csv 2>err &&
    "$bin/hs-simulate" --force-control there.csv --body body.ply --model pure.csv -q "${@:2}" -o back.csv 2>err ||
    complain "given forces failed, $1"
  below "$(apart motion.csv back.csv ux uy uz)" 1e-9 || complain "the forces of $1 do not find the motion"
  below "$(apart there.csv back.csv fx fy fz)" 1e-12 || complain "the forces given to $1 are not kept"
}
round 'the contact meshes'
round 'the own mesh, direct' --own-mesh --solver direct
round 'the own mesh, iterative' --own-mesh --solver iterative
refused() { # TEXT ARGUMENTS...
  "$bin/hs-simulate" --force-control "${@:2}" --body body.ply -q 2>err >/dev/null
  [[ $? == 3 ]] && grep -q "$1" err || complain "$1"
}
refused "column 'fx' is missing" motion.csv --model pure.csv
refused 'without sensor-bias' there.csv --model linear.csv
grep -v '^sensor' damped.csv >pure-damped.csv
refused 'not linear' there.csv --model pure-damped.csv

((failures == 0)) && echo ok
exit $((failures > 0))
