# Drives the plan: what a laser of 0.1 mm noise reads when the joints stand 0.1 mrad off what is reported.
#   awk -f laser.awk plan.csv >driven.csv
# The arm is that of arm.urdf, the object the phantom (half an ellipsoid on its plate) at `object` below.
BEGIN {
  FS = OFS = ","
  srand(3)
  pi = atan2(0, -1)
  a = 0.055; b = 0.042; c = 0.038                      # semi-axes of the phantom [m]
  print "q1,q2,q3,q4,q5,q6,d"
}
/^#/ { next }
!header { header = 1; next }
{
  for (i = 1; i <= 6; ++i) q[i] = $i + 1e-4 * normal_number()
  unit_frame()
  move(0, 0, 0.33); turn(3, q[1]); move(0.05, 0, 0); turn(2, q[2]); move(0, 0, 0.44); turn(2, q[3])
  move(0.20, 0, 0.035); turn(1, q[4]); move(0.22, 0, 0); turn(2, q[5]); move(0.08, 0, 0); turn(1, q[6])
  move(0.01, 0, 0); turn(2, pi / 2)
  move(0.02, 0, 0.015)                                 # the sensor's mount
  # Beam and its origin in the phantom's frame: at 0.45, 0.05, 0.10, turned by 0.4 about z.
  x = p[1] - 0.45; y = p[2] - 0.05; oz = p[3] - 0.10
  ox = cos(0.4) * x + sin(0.4) * y; oy = -sin(0.4) * x + cos(0.4) * y
  dx = cos(0.4) * R[1, 3] + sin(0.4) * R[2, 3]; dy = -sin(0.4) * R[1, 3] + cos(0.4) * R[2, 3]; dz = R[3, 3]
  d = hit()
  print $1, $2, $3, $4, $5, $6, (d > 0 ? sprintf("%.6f", d + 1e-4 * normal_number()) : "")
}
# Distance to the ellipsoid or the plate, whichever comes first; 0 when the beam meets neither.
function hit(   A, B, C, root, t, plate) {
  A = (dx / a) ^ 2 + (dy / b) ^ 2 + (dz / c) ^ 2
  B = ox * dx / a ^ 2 + oy * dy / b ^ 2 + oz * dz / c ^ 2
  C = (ox / a) ^ 2 + (oy / b) ^ 2 + (oz / c) ^ 2 - 1
  root = B * B - A * C
  t = root >= 0 ? (-B - sqrt(root)) / A : 0
  if (t > 0 && oz + t * dz >= 0) return t
  return 0                                             # the plate is black
}
function normal_number() { return sqrt(-2 * log(1 - rand())) * cos(2 * pi * rand()) }
function unit_frame(   i, j) {
  for (i = 1; i <= 3; ++i) { p[i] = 0; for (j = 1; j <= 3; ++j) R[i, j] = (i == j) }
}
function move(x, y, z,   i) { for (i = 1; i <= 3; ++i) p[i] += R[i, 1] * x + R[i, 2] * y + R[i, 3] * z }
function turn(axis, angle,   i, j, k, u, v) {
  j = axis % 3 + 1; k = j % 3 + 1
  for (i = 1; i <= 3; ++i) {
    u = R[i, j]; v = R[i, k]
    R[i, j] = u * cos(angle) + v * sin(angle)
    R[i, k] = v * cos(angle) - u * sin(angle)
  }
}
