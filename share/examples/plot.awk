# plot.awk -v title=TEXT [-v over=t] [-v press=N] FORCES.csv...: force along z over depth, or over time, as
# SVG, a curve a file; of all presses or one.
BEGIN {
  FS = ","
  split("#0072b2 #d55e00 #009e73 #cc79a7 #e69f00 #56b4e9", colour, " ")
}
FNR == 1 { ++files; header = 0; name[files] = FILENAME; sub(/.*\//, "", name[files]); sub(/\.csv$/, "", name[files]) }
/^#/ { next }
!header { header = 1; for (i = 1; i <= NF; ++i) column[$i] = i; next }
press && $column["press"] != press { next }
{
  n = ++count[files]
  x[files, n] = over == "t" ? $column["t"] : -1000 * $column["uz"]
  y[files, n] = $column["fz"]
  if (x[files, n] > most_x) most_x = x[files, n]
  if (y[files, n] > most_y) most_y = y[files, n]
  if (y[files, n] < least_y) least_y = y[files, n]
}
function round_step(range,    s) { # a tick of 1, 2 or 5 about a fifth of the range
  s = 10 ^ int(log(range / 5) / log(10) - (range < 5))
  return range / s > 25 ? 5 * s : range / s > 10 ? 2 * s : s
}
function at_x(v) { return 60 + 420 * v / most_x }
function at_y(v) { return 330 - 280 * (v - least_y) / (most_y - least_y) }
END {
  print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 660 380\" font-family=\"sans-serif\" font-size=\"12\">"
  print "<rect width=\"660\" height=\"380\" fill=\"white\"/>"
  printf "<text x=\"60\" y=\"24\" font-size=\"14\">%s</text>\n", title
  printf "<text x=\"270\" y=\"368\" text-anchor=\"middle\">%s</text>\n", over == "t" ? "time [s]" : "depth [mm]"
  print "<text x=\"16\" y=\"190\" text-anchor=\"middle\" transform=\"rotate(-90 16 190)\">force [N]</text>"
  step = round_step(most_x)
  for (v = 0; v <= most_x * 1.001; v += step)
    printf "<path d=\"M%.1f 50V330\" stroke=\"#ddd\"/><text x=\"%.1f\" y=\"346\" text-anchor=\"middle\">%g</text>\n", at_x(v), at_x(v), v
  step = round_step(most_y - least_y)
  for (v = step * int(least_y / step); v <= most_y * 1.001; v += step)
    printf "<path d=\"M60 %.1fH480\" stroke=\"#ddd\"/><text x=\"54\" y=\"%.1f\" text-anchor=\"end\">%g</text>\n", at_y(v), at_y(v) + 4, v
  for (f = 1; f <= files; ++f) {
    every = int(count[f] / 400) + 1
    printf "<path fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\" d=\"", colour[(f - 1) % 6 + 1]
    for (i = 1; i <= count[f]; i += every) printf "%s%.1f %.1f", i == 1 ? "M" : "L", at_x(x[f, i]), at_y(y[f, i])
    print "\"/>"
    printf "<path d=\"M492 %dH512\" stroke=\"%s\" stroke-width=\"2\"/><text x=\"518\" y=\"%d\">%s</text>\n", 50 + 18 * f, colour[(f - 1) % 6 + 1], 54 + 18 * f, name[f]
  }
  print "</svg>"
}
