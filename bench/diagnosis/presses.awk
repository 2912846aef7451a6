# Presses on the upper side of a closed surface (OFF [m], triangles) in the data format:
#   awk -v protocol=rich|edge|robot|few -f presses.awk SURFACE
# rich:  12 places; slow, fast with a hold, sideways at depth; the way in and out through the air
# edge:  the same at places 5 to 8 mm from the edges of a rectangular face
# robot: 12 places, 42 presses in a shuffled order, five depths, three speeds, a third of them aslant, each
#        with a hold; recorded from the first contact to the end of the hold
# few:   6 places, a slow and a fast press with a hold each; the way in and out through the air
NR == 2 { points = $1; faces = 0 }
NR > 2 && NR <= 2 + points {
  for (c = 1; c <= 3; ++c) x[NR - 3, c] = $c
  for (c = 1; c <= 2; ++c) { if ($c > most[c]) most[c] = $c; if ($c < least[c]) least[c] = $c }
}
NR > 2 + points && $1 == 3 { for (c = 1; c <= 3; ++c) corner[faces, c] = $(c + 1); ++faces }
END {
  srand(7)
  places = protocol == "few" ? 6 : 12
  for (k = 0; k < places; ++k) place(k)
  print "# tool_radius: 0.004"
  print "press,t,x,y,z,ux,uy,uz,contact"
  if (protocol == "rich" || protocol == "edge") rich(); else if (protocol == "few") few(); else robot()
}

# The place's point and outward normal: evenly spread in plan view, as far as 0.7 of the half axes, or along
# the edges.
function place(k,    e, from, u, r, px, py, f, i, a, b, c, det, s, t, z, n, size) {
  u = 2.399963 * k + 0.4; r = 0.7 * sqrt((k + 0.5) / places)
  px = (most[1] + least[1]) / 2 + r * (most[1] - least[1]) / 2 * cos(u)
  py = (most[2] + least[2]) / 2 + r * (most[2] - least[2]) / 2 * sin(u)
  if (protocol == "edge") {
    e = 5e-3 + 1e-3 * (k % 4)
    from = 0.1 + 0.8 * (k + 0.5) / places
    px = k % 2 ? least[1] + from * (most[1] - least[1]) : int(k / 2) % 2 ? least[1] + e : most[1] - e
    py = k % 2 == 0 ? least[2] + from * (most[2] - least[2]) : int(k / 2) % 2 ? least[2] + e : most[2] - e
  }
  at[k, 3] = -1
  for (f = 0; f < faces; ++f) {
    a = corner[f, 1]; b = corner[f, 2]; c = corner[f, 3]
    det = (x[b, 1] - x[a, 1]) * (x[c, 2] - x[a, 2]) - (x[c, 1] - x[a, 1]) * (x[b, 2] - x[a, 2])
    if (det <= 1e-14) continue                            # looks aside or down
    s = ((px - x[a, 1]) * (x[c, 2] - x[a, 2]) - (x[c, 1] - x[a, 1]) * (py - x[a, 2])) / det
    t = ((x[b, 1] - x[a, 1]) * (py - x[a, 2]) - (px - x[a, 1]) * (x[b, 2] - x[a, 2])) / det
    if (s < 0 || t < 0 || s + t > 1) continue
    z = x[a, 3] + s * (x[b, 3] - x[a, 3]) + t * (x[c, 3] - x[a, 3])
    if (z <= at[k, 3]) continue
    at[k, 1] = px; at[k, 2] = py; at[k, 3] = z
    n[1] = (x[b, 2] - x[a, 2]) * (x[c, 3] - x[a, 3]) - (x[b, 3] - x[a, 3]) * (x[c, 2] - x[a, 2])
    n[2] = (x[b, 3] - x[a, 3]) * (x[c, 1] - x[a, 1]) - (x[b, 1] - x[a, 1]) * (x[c, 3] - x[a, 3])
    n[3] = det
    size = sqrt(n[1] ^ 2 + n[2] ^ 2 + n[3] ^ 2)
    for (i = 1; i <= 3; ++i) out[k, i] = n[i] / size
  }
}

function rich(   kind, k, p) {
  for (kind = 0; kind < 3; ++kind)
    for (k = 0; k < places; ++k) {
      p = (k * 5 + kind * 7) % places
      press(p, 2.5e-3 * (1 + ((p * 7) % 12) / 11), kind == 0 ? 2 : 0.25, kind == 0 ? 0.4 : 2, 0, kind == 2 ? 0.6 : 0, 1)
    }
}

function few(   k, p) {
  for (k = 0; k < 2 * places; ++k) {
    p = (k * 5) % places
    press(p, 3e-3 + 2e-3 * rand(), k < places ? 2 : 0.25, k < places ? 0.4 : 2, 0, 0, 1)
  }
}

function robot(   k, swap, i, order) {
  for (k = 0; k < 42; ++k) order[k] = k
  for (k = 41; k > 0; --k) { i = int((k + 1) * rand()); swap = order[k]; order[k] = order[i]; order[i] = swap }
  for (k = 0; k < 42; ++k)
    press(order[k] % places, 1e-3 * (1 + int(5 * rand())), 0.2 * 2 ^ int(3 * rand()), 2 + rand(), order[k] < 14 ? 0.75 : 0, 0, 0)
}

# One press to `depth` [m] in `way` [s], held for `hold` [s]: `aslant` of the depth sideways on the way in, or
# `slide` of it after; with `whole`, from the air and back to it.
function press(p, depth, way, hold, aslant, slide, whole,    turn, a, b, c, i, s, t, q, side, end, moving, air) {
  turn = 6.283185307 * rand()
  a[1] = out[p, 3]; a[2] = 0; a[3] = -out[p, 1]              # two directions along the surface
  b[1] = 0; b[2] = out[p, 3]; b[3] = -out[p, 2]
  for (i = 1; i <= 3; ++i) a[i] = cos(turn) * a[i] + sin(turn) * b[i]
  s = sqrt(a[1] ^ 2 + a[2] ^ 2 + a[3] ^ 2)
  air = whole ? 0.3 : 0
  moving = slide > 0 ? 0.5 : 0
  end = way + moving + hold + (whole ? 0.5 + air : 0)
  for (i = 0; i * 0.02 < air + end - 1e-9; ++i) {
    t = i * 0.02 - air; side = 0
    if (t < 0) q = 2 * t / 3
    else if (t < way) { q = t / way; side = aslant * q }
    else if (t < way + moving) { q = 1; side = slide * (t - way) / moving }
    else if (t < way + moving + hold) { q = 1; side = aslant + slide }
    else if (t < way + moving + hold + 0.5) { q = 1 - (t - way - moving - hold) / 0.5; side = (aslant + slide) * q }
    else q = -(t - way - moving - hold - 0.5) / 0.3 * 0.4
    printf "%d,%.2f,%.6f,%.6f,%.6f", number, session + t, at[p, 1], at[p, 2], at[p, 3]
    for (c = 1; c <= 3; ++c) printf ",%.7f", depth * (side * a[c] / s - q * out[p, c])
    printf ",%d\n", (q >= 0)
  }
  ++number
  session += end + 12 + int(20 * rand())
}
