# 25 s of a hand that presses at 1 kHz, at -v x=M -v y=M -v z=M.
BEGIN {
  print "# tool_radius: 0.004"; print "press,t,x,y,z,ux,uy,uz"
  for (i = 0; i <= 25000; ++i) {
    t = i / 1000; d = 0.002 * (1 - cos(3.6 * t)) * (1 + 0.35 * sin(1.3 * t)); s = 0.25 * d * sin(2.3 * t)
    printf "1,%.3f,%s,%s,%s,%.9g,0,%.9g\n", t, x, y, z, s, -d
  }
}
