# Closed surfaces of examples as OFF, in metres: awk -v what=cuboid|dome -f shapes.awk.
#   cuboid: -v a=0.12 -v b=0.21 -v c=0.06, from the origin
#   dome:   half an ellipsoid on the plane z = 0, half axes a b c, of n meridians and m parallels, its
#           outline drawn towards +x by `lobe` of the radius
BEGIN {
  if (what == "cuboid") {
    print "OFF"; print 8, 12, 0
    for (i = 0; i < 8; ++i) print (i % 2) * a, (int(i / 2) % 2) * b, (i >= 4) * c
    split("0 2 1,1 2 3,4 5 6,5 7 6,0 1 4,1 5 4,2 6 3,3 6 7,0 4 2,2 4 6,1 3 5,3 7 5", f, ",")
    for (i = 1; i <= 12; ++i) print 3, f[i]
  } else {
    pi = 3.14159265358979
    for (i = 1; i <= m; ++i) for (j = 0; j < n; ++j) {
      u = pi / 2 * (1 - i / m); v = 2 * pi * j / n; r = cos(u) * (1 + lobe * cos(v))
      points = points sprintf("%.6f %.6f %.6f\n", a * r * cos(v), b * r * sin(v), c * sin(u))
    }
    last = 1 + m * n
    for (j = 0; j < n; ++j) {
      k = (j + 1) % n
      faces = faces sprintf("3 0 %d %d\n", 1 + j, 1 + k); ++count
      for (i = 0; i < m - 1; ++i) {
        p = 1 + i * n + j; q = 1 + i * n + k
        faces = faces sprintf("3 %d %d %d\n3 %d %d %d\n", p, p + n, q, q, p + n, q + n); count += 2
      }
      faces = faces sprintf("3 %d %d %d\n", 1 + (m - 1) * n + j, last, 1 + (m - 1) * n + k); ++count
    }
    printf "OFF\n%d %d 0\n0 0 %g\n%s0 0 0\n%s", last + 1, count, c, points, faces
  }
}
