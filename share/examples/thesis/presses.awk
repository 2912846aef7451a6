# Presses of sin^2 shape at the organ's highest place, sideways a little: awk -v presses='RISE:DEPTH ...'
# -v hold=SHARE -v step=SECONDS -f presses.awk. Each is held for that share of its rise and 50 ms more.
BEGIN {
  print "# tool_radius: 0.006"; print "press,t,x,y,z,ux,uy,uz"
  n = split(presses, p, " ")
  for (k = 1; k <= n; ++k) {
    split(p[k], q, ":"); rise = q[1]; d = q[2]; h = hold * rise + 0.05
    for (i = 0; i * step < 2 * rise + h + 0.1 - 1e-9; ++i) {
      t = i * step; left = 2 * rise + h - t
      s = t < rise ? sin(1.5708 * t / rise) ^ 2 : left > rise ? 1 : left > 0 ? sin(1.5708 * left / rise) ^ 2 : 0
      printf "%d,%.6f,0,0,0.055,%.9g,0,%.9g\n", k, t, 0.2 * d * s * sin(3 * t), -d * s
    }
  }
}
