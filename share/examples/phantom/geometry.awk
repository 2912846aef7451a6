# Shape, scan and pressing of the phantom, in closed form: half an ellipsoid on the plane z = 0.
#   awk -v what=surface|scan|motion -f geometry.awk
# surface: ASCII STL [m]; scan: CSV [mm]; motion: CSV in the data format [m, s].
BEGIN {
  pi = atan2(0, -1)
  a = 0.055; b = 0.042; c = 0.038          # semi-axes [m]
  srand(20)
  if (what == "surface") surface()
  else if (what == "scan") scan()
  else if (what == "motion") motion()
}

function normal_number() { return sqrt(-2 * log(1 - rand())) * cos(2 * pi * rand()) }

# Point of the ellipsoid at azimuth u and elevation v.
function px(u, v) { return a * cos(v) * cos(u) }
function py(u, v) { return b * cos(v) * sin(u) }
function pz(u, v) { return c * sin(v) }

function vertex(u, v) { printf "vertex %.9g %.9g %.9g\n", px(u, v), py(u, v), pz(u, v) }
function facet(u1, v1, u2, v2, u3, v3) {
  print "facet normal 0 0 0\nouter loop"
  vertex(u1, v1); vertex(u2, v2); vertex(u3, v3)
  print "endloop\nendfacet"
}

function surface(   nu, nv, i, j, u0, u1, v0, v1) {
  nu = 96; nv = 32
  print "solid phantom"
  for (j = 0; j < nv; ++j)
    for (i = 0; i < nu; ++i) {
      u0 = 2 * pi * i / nu; u1 = i + 1 == nu ? 0 : 2 * pi * (i + 1) / nu
      v0 = pi / 2 * j / nv; v1 = pi / 2 * (j + 1) / nv
      if (j + 1 < nv) { facet(u0, v0, u1, v0, u1, v1); facet(u0, v0, u1, v1, u0, v1) }
      else facet(u0, v0, u1, v0, 0, pi / 2)
    }
  # The plate's side: rings of the ellipse towards its centre.
  for (j = 0; j < 8; ++j)
    for (i = 0; i < nu; ++i) {
      u0 = 2 * pi * i / nu; u1 = i + 1 == nu ? 0 : 2 * pi * (i + 1) / nu
      plate(u0, u1, 1 - j / 8, 1 - (j + 1) / 8)
    }
  print "endsolid phantom"
}
function plate_vertex(u, s) { printf "vertex %.9g %.9g 0\n", s * a * cos(u), s * b * sin(u) }
function plate_facet(u1, s1, u2, s2, u3, s3) {
  print "facet normal 0 0 -1\nouter loop"
  plate_vertex(u1, s1); plate_vertex(u2, s2); plate_vertex(u3, s3)
  print "endloop\nendfacet"
}
function plate(u0, u1, outer, inner) {
  if (inner > 0) { plate_facet(u0, outer, u1, inner, u1, outer); plate_facet(u0, outer, u0, inner, u1, inner) }
  else plate_facet(u0, outer, 0, 0, u1, outer)
}

# Evenly over the curved surface by rejection; 0.15 mm of noise; one point in a hundred is an outlier.
function scan(   n, u, v, area, nx, ny, nz, length_, noise) {
  print "# scan of the phantom: laser line from above and the sides, no underside"
  print "# unit: mm"
  print "x,y,z"
  for (n = 0; n < 3000; ) {
    u = 2 * pi * rand(); v = pi / 2 * rand()
    nx = cos(v) * cos(u) / a; ny = cos(v) * sin(u) / b; nz = sin(v) / c
    length_ = sqrt(nx * nx + ny * ny + nz * nz)
    area = length_ * a * b * c * cos(v)
    if (rand() * a * a > area) continue
    noise = 0.00015 * normal_number()
    if (n % 100 == 37) noise = 0.004 + 0.012 * rand()
    printf "%.3f,%.3f,%.3f\n", 1e3 * (px(u, v) + noise * nx / length_), \
      1e3 * (py(u, v) + noise * ny / length_), 1e3 * (pz(u, v) + noise * nz / length_)
    ++n
  }
}

# 12 positions, three presses each: slow; fast with a hold; sideways at depth.
function motion(   press, k, kind, position, u, v) {
  print "# object: phantom"
  print "# tool_radius: 0.004"
  print "press,t,x,y,z,ux,uy,uz,contact"
  time = 0
  for (kind = 0; kind < 3; ++kind)
    for (k = 0; k < 12; ++k) {
      position = (k * 5 + kind * 7) % 12    # not in the same order each time
      u = 2.399963 * position               # golden angle: evenly spread
      v = pi / 2 - 0.95 * sqrt((position + 0.5) / 12)
      one_press(press++, kind, u, v, 0.0025 + 0.0025 * ((position * 7) % 12) / 11)
      time += 12 + int(20 * rand())
    }
}

function one_press(press, kind, u, v, depth,    nx, ny, nz, len, tx, ty, tl, i, n, s, t, q, in_, side, out, hold, slide) {
  nx = cos(v) * cos(u) / a; ny = cos(v) * sin(u) / b; nz = sin(v) / c
  len = sqrt(nx * nx + ny * ny + nz * nz); nx /= len; ny /= len; nz /= len
  tx = -ny; ty = nx; tl = sqrt(tx * tx + ty * ty)
  if (tl < 1e-6) { tx = 1; ty = 0; tl = 1 }
  tx /= tl; ty /= tl
  in_ = kind == 0 ? 2.0 : 0.25; hold = kind == 0 ? 0.4 : 2.0; out = kind == 0 ? 2.0 : 0.5
  slide = kind == 2 ? 0.5 : 0
  for (t = 0; t < 0.3 + in_ + slide + hold + out + 0.3; t += 0.02) {
    s = t - 0.3; q = 0; side = 0
    if (s < 0) q = 20 * s / 3 / 10          # in the air, coming closer at 2 mm per 0.3 s
    else if (s < in_) q = s / in_
    else if (s < in_ + slide) { q = 1; side = (s - in_) / slide }
    else if (s < in_ + slide + hold) { q = 1; side = (slide > 0) }
    else if (s < in_ + slide + hold + out) { q = 1 - (s - in_ - slide - hold) / out; side = (slide > 0) * q }
    else q = -(s - in_ - slide - hold - out) / 0.3 * 0.4
    d = depth * q
    touching = q >= 0
    printf "%d,%.2f,%.6f,%.6f,%.6f,%.7f,%.7f,%.7f,%d\n", press, time + t, px(u, v), py(u, v), pz(u, v), \
      -d * nx + 0.6 * depth * side * tx, -d * ny + 0.6 * depth * side * ty, -d * nz, touching
  }
  time += t
}
