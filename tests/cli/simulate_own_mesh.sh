#!/usr/bin/env bash
# simulate_own_mesh.sh BIN: hs-simulate --own-mesh presses the body's own tetrahedra, by either
# solver, and writes their fields.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"

cat >model.csv <<'END'
effect,region,parameter,value,unit,state
elastic,0,E,20000,Pa,fixed
elastic,0,nu,0.4,1,fixed
viscoelastic,0,E1,8000,Pa,fixed
viscoelastic,0,tau1,0.2,s,fixed
END
awk 'BEGIN {
  print "# tool_radius: 0.006"; print "press,t,x,y,z,ux,uy,uz"
  for (p = 1; p <= 2; ++p)
    for (i = 0; i <= 20; ++i)
      printf "%d,%g,%g,0.025,0.04,%g,0,%g\n", p, 0.02 * i, 0.01 + 0.015 * p, 2e-5 * i * (p == 2), -1e-4 * i
}' >motion.csv
for order in 1 2; do
  "$bin/hs-tetmesh" box.off --edge 0.01 --contacts motion.csv --size 0.0015 --order $order -q \
    -o body$order.ply || complain 'no body'
done
column() { # NAME FILE
  awk -F, -v name="$1" '/^#/ { next } !n++ { for (i = 1; i <= NF; ++i) at[$i] = i; next }
    { print $at[name] }' "$2"
}
same() { # FILE FILE TOLERANCE: all force components, relative to the largest
  for k in fx fy fz; do paste -d' ' <(column $k "$1") <(column $k "$2"); done | awk -v t="$3" '
    { d = $1 - $2; if (d < 0) d = -d; if (d > w) w = d; a = $1 < 0 ? -$1 : $1; if (a > m) m = a; ++n }
    END { printf "differ by %g of %g N, %d numbers\n", w, m, n; exit !(n == 126 && m > 0 && w < t * m) }'
}

for order in 1 2; do
  common=(motion.csv --body body$order.ply --model model.csv --own-mesh)
  for solver in direct iterative; do
    "$bin/hs-simulate" "${common[@]}" --solver $solver -o $solver.csv 2>err || complain "$solver failed"
    flat err | grep -q 'right-hand sides' || complain 'the solver is not told'
    [[ $(flat err | grep -c '; [0-9]* iterations') == $([[ $solver == iterative ]] && echo 1 || echo 0) ]] || complain 'iterations are told where there are any'
  done
  same direct.csv iterative.csv 1e-7 || complain "the solvers differ, order $order"
done

# Against the meshes of the contacts: as near as this mesh of second order comes.
"$bin/hs-simulate" motion.csv --body body2.ply --model model.csv --rim-edge 0.3 -q -o fine.csv 2>err ||
  complain 'the contact meshes failed'
same fine.csv direct.csv 0.05 || complain 'far from the contact meshes'

# Fields: the deepest row of each press, or those asked for; the tool's displacement is in them.
"$bin/hs-simulate" "${common[@]}" --vtu field -q -o out.csv 2>err || complain 'no fields'
[[ $(ls field-*.vtu | tr '\n' ' ') == 'field-21.vtu field-42.vtu ' ]] || complain "fields: $(ls field-*)"
for name in displacement stress energy_density fixed region; do
  grep -aq "Name=\"$name\"" field-42.vtu || complain "the field has no $name"
done
"$bin/hs-simulate" "${common[@]}" --vtu some --rows 5,30 -q -o out.csv 2>err || complain 'no rows'
[[ -s some-5.vtu && -s some-30.vtu ]] || complain 'rows were not written'

refuse() { # CODE TEXT ARGUMENTS...
  local code=$1 text=$2 got
  shift 2
  "$bin/hs-simulate" "$@" >/dev/null 2>err
  got=$?
  ((got == code)) && flat err | grep -qF -- "$text" || complain "exit $got, not $code with '$text': $*"
}
refuse 2 "no row '43'" "${common[@]}" --vtu x --rows 43
refuse 2 'add --own-mesh' motion.csv --body body1.ply --model model.csv --vtu x
refuse 2 'batch mode' --live "${common[@]}"
{ cat model.csv; echo 'tip,0,R,0.003,m,fixed'; } >tip.csv
{ cat model.csv; echo 'layer,0,thickness,0.003,m,fixed'; echo 'layer,0,ratio,2,1,fixed'; } >layer.csv
refuse 3 'without --own-mesh' motion.csv --body body1.ply --model layer.csv --own-mesh
{ cat model.csv; printf 'elastic,1,E,10000,Pa,fixed\nviscoelastic,1,E1,9000,Pa,fixed\nviscoelastic,1,tau1,1,s,fixed\n'; } >own.csv
own=(motion.csv --body body1.ply --model own.csv)
refuse 3 'each in its own way' "${own[@]}" --own-mesh --vtu x
for mode in --live --own-mesh; do
  "$bin/hs-simulate" $mode "${own[@]}" >out.csv 2>err || complain "regions that relax apart, $mode"
done

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
