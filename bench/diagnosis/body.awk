# A closed surface drawn by a number, as OFF [m]: awk -v n=7 -v shapes=shapes.awk -f body.awk. Half of them
# domes, more or less lobed, half cuboids about the origin; 70 to 130 mm long, 25 to 45 mm high.
BEGIN {
  srand(1000 + n); rand()
  long = 0.07 + 0.06 * rand(); wide = long * (0.6 + 0.35 * rand()); high = 0.025 + 0.02 * rand()
  if (n % 2) {
    command = sprintf("awk -v what=dome -v a=%g -v b=%g -v c=%g -v n=96 -v m=32 -v lobe=%g -f %s", long / 2, wide / 2, high, 0.3 * rand(), shapes)
    while ((command | getline line) > 0) print line
  } else {
    command = sprintf("awk -v what=cuboid -v a=%g -v b=%g -v c=%g -f %s", long, wide, high, shapes)
    while ((command | getline line) > 0) {
      count = split(line, p, " ")
      if (++rows > 2 && rows <= 10) print p[1] - long / 2, p[2] - wide / 2, p[3]; else print line
    }
  }
}
