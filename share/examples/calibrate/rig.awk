# A rig with faults: what its sensor shows.
#   awk -v what=poses -f rig.awk plan.csv          of a plan of hs-calibrate --plan, the robot at rest
#   awk -v what=presses -f rig.awk data.csv        of a recording whose forces and motion are true
# The sensor is mounted 3 degrees askew, its axes show shares of each other, its zero is off and drifts; the
# tool weighs 0.15 kg, and the arm gives way by 0.005 mm/N. While it presses the tool leans by 20 degrees.
BEGIN {
  FS = OFS = ","
  srand(seed ? seed : 1)
  noise = 0.005                                        # of a component [N]
  turn(R, 0.02, -0.03, 0.037)                          # tool to sensor
  split("1.02 0.015 -0.01 0.015 0.99 0.02 -0.01 0.02 1.01", c, " ")
  split("0.35 -0.2 0.5", offset, " "); split("0.004 0.002 -0.006", drift, " ")
  mass = 0.15; gravity = 9.80665; hung = 0.5           # [kg], [m/s2], [kg]
  jitter = 1e-6                                        # of the robot's position [m]
  arm = 5e-6                                           # [m/N]
  lean = 20 * atan2(0, -1) / 180
}
/^#/ { print; next }
!header {
  header = 1
  for (i = 1; i <= NF; ++i) at[$i] = i
  if (what == "poses") print "# temp_ref: 21\nqw,qx,qy,qz,load,temp,fx,fy,fz"
  else print "# orientation: " cos(lean / 2) "," sin(lean / 2) ",0,0\n" $0 ",temp"
  next
}
what == "poses" {
  ++n
  quaternion($at["qw"], $at["qx"], $at["qy"], $at["qz"])
  temp = 19 + 5 * rand()
  load = n % 3 ? 0 : hung                              # every third pose with the weight on the hook
  show(0, 0, -(mass + load) * gravity, temp)
  print $at["qw"], $at["qx"], $at["qy"], $at["qz"], load, sprintf("%.2f", temp), sensed
}
what == "presses" {
  quaternion(cos(lean / 2), sin(lean / 2), 0, 0)
  temp = 23
  split("x y z", axis, " ")
  for (k = 1; k <= 3; ++k) { f[k] = $at["f" axis[k]]; $at["u" axis[k]] = sprintf("%.8f", $at["u" axis[k]] - arm * f[k] + jitter * normal_number()) }
  show(f[1], f[2], f[3] - mass * gravity, temp)
  split(sensed, s, ",")
  for (k = 1; k <= 3; ++k) $at["f" axis[k]] = s[k]
  print $0, temp
}
# sensed: C R Q' (x, y, z) + offset + drift and noise, Q the tool in the base
function show(x, y, z, temp,   i, j, w, v) {
  for (i = 1; i <= 3; ++i) w[i] = Q[1, i] * x + Q[2, i] * y + Q[3, i] * z
  for (i = 1; i <= 3; ++i) { v[i] = 0; for (j = 1; j <= 3; ++j) v[i] += R[i, j] * w[j] }
  sensed = ""
  for (i = 1; i <= 3; ++i) {
    w[i] = offset[i] + drift[i] * (temp - 21) + noise * normal_number()
    for (j = 1; j <= 3; ++j) w[i] += c[3 * (i - 1) + j] * v[j]
    sensed = sensed (i > 1 ? "," : "") sprintf("%.5f", w[i])
  }
}
function quaternion(w, x, y, z,   n) {
  n = sqrt(w * w + x * x + y * y + z * z); w /= n; x /= n; y /= n; z /= n
  Q[1, 1] = 1 - 2 * (y * y + z * z); Q[1, 2] = 2 * (x * y - w * z); Q[1, 3] = 2 * (x * z + w * y)
  Q[2, 1] = 2 * (x * y + w * z); Q[2, 2] = 1 - 2 * (x * x + z * z); Q[2, 3] = 2 * (y * z - w * x)
  Q[3, 1] = 2 * (x * z - w * y); Q[3, 2] = 2 * (y * z + w * x); Q[3, 3] = 1 - 2 * (x * x + y * y)
}
# M: the rotation about (x, y, z) by its length
function turn(M, x, y, z,   a, h, i, j) {
  a = sqrt(x * x + y * y + z * z); h = sin(a / 2) / a
  quaternion(cos(a / 2), h * x, h * y, h * z)
  for (i = 1; i <= 3; ++i) for (j = 1; j <= 3; ++j) M[i, j] = Q[i, j]
}
function normal_number(   u) { do u = rand(); while (u == 0); return sqrt(-2 * log(u)) * cos(6.283185307 * rand()) }
