# Presses on the phantom as one asks for: awk -f share/examples/phantom/geometry.awk -f pairs.awk with
#   -v places="0 3 5"    of its 12 positions
#   -v kinds="0 1"       0 slow; 1 fast and held; 2 pushed sideways; each at every place
#   -v times=2           how often all that
#   -v depths="3 5"      [mm], in turn
BEGIN {
  n_places = split(places, place, " ")
  n_kinds = split(kinds, kind_of, " ")
  n_depths = split(depths, depth_of, " ")
  print "# object: phantom\n# tool_radius: 0.004"
  print "press,t,x,y,z,ux,uy,uz,contact"
  press = 0; time = 0
  for (again = 0; again < (times ? times : 1); ++again)
    for (k = 1; k <= n_kinds; ++k)
      for (p = 1; p <= n_places; ++p) {
        u = 2.399963 * place[p]
        v = pi / 2 - 0.95 * sqrt((place[p] + 0.5) / 12)
        one_press(press, kind_of[k], u, v, 1e-3 * depth_of[1 + press % n_depths])
        ++press
        time += 10
      }
}
