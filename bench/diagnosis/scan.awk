# Scan [mm] of a closed surface (OFF [m], triangles, seen from above): awk -v count=3000 -f scan.awk SURFACE.
# Evenly over all faces that do not look down; 0.15 mm of noise along the face's normal; one point in a
# hundred is an outlier.
NR == 2 { points = $1; faces = 0 }
NR > 2 && NR <= 2 + points { for (c = 1; c <= 3; ++c) x[NR - 3, c] = 1e3 * $c }
NR > 2 + points && $1 == 3 {
  for (c = 1; c <= 3; ++c) { a[c] = x[$3, c] - x[$2, c]; b[c] = x[$4, c] - x[$2, c] }
  n[1] = a[2] * b[3] - a[3] * b[2]; n[2] = a[3] * b[1] - a[1] * b[3]; n[3] = a[1] * b[2] - a[2] * b[1]
  size = sqrt(n[1] ^ 2 + n[2] ^ 2 + n[3] ^ 2)
  if (size == 0 || n[3] < -0.5 * size) next
  for (c = 1; c <= 3; ++c) { corner[faces, c] = $(c + 1); normal[faces, c] = n[c] / size }
  area[faces++] = all += size
}
END {
  srand(20)
  print "# unit: mm"
  print "x,y,z"
  for (k = 0; k < count; ++k) {
    low = 0; high = faces - 1; at = rand() * all
    while (low < high) {
      middle = int((low + high) / 2)
      if (area[middle] < at) low = middle + 1; else high = middle
    }
    s = sqrt(rand()); t = rand()
    w[1] = 1 - s; w[2] = s * (1 - t); w[3] = s * t
    noise = k % 100 == 37 ? 4 + 12 * rand() : 0.15 * sqrt(-2 * log(1 - rand())) * cos(6.283185307 * rand())
    for (c = 1; c <= 3; ++c) {
      p[c] = noise * normal[low, c]
      for (i = 1; i <= 3; ++i) p[c] += w[i] * x[corner[low, i], c]
    }
    printf "%.3f,%.3f,%.3f\n", p[1], p[2], p[3]
  }
}
