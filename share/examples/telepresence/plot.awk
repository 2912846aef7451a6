# plot.awk -v title=TEXT FELT.csv: depth, felt force and the newest measured force over time, as SVG.
BEGIN { FS = "," }
/^#/ { next }
!header { header = 1; for (i = 1; i <= NF; ++i) column[$i] = i; next }
{
  t = $column["t"]
  if (t - last < 0.02 && n) next
  last = t; ++n
  time[n] = t
  value["depth", n] = -1000 * $column["uz"]
  value["felt", n] = $column["fz"]
  value["measured", n] = $column["mz"]
  if (!begun && $column["predicted"] == 1) begun = t
  if (value["depth", n] > most_depth) most_depth = value["depth", n]
  if (value["felt", n] > most) most = value["felt", n]
  if (value["measured", n] > most) most = value["measured", n]
}
function x(t) { return 60 + 680 * t / time[n] }
function curve(name, colour, top, height, largest,    i) {
  printf "<path fill=\"none\" stroke=\"%s\" stroke-width=\"1.2\" d=\"", colour
  for (i = 1; i <= n; ++i) printf "%s%.1f %.1f", i == 1 ? "M" : "L", x(time[i]), top + height * (1 - value[name, i] / largest)
  print "\"/>"
}
END {
  print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 780 430\" font-family=\"sans-serif\" font-size=\"12\">"
  print "<rect width=\"780\" height=\"430\" fill=\"white\"/>"
  printf "<text x=\"60\" y=\"22\" font-size=\"14\">%s</text>\n", title
  step = time[n] > 12 ? 5 : time[n] > 4 ? 1 : 0.5
  for (v = 0; v <= time[n] * 1.001; v += step)
    printf "<path d=\"M%.1f 40V390\" stroke=\"#ddd\"/><text x=\"%.1f\" y=\"406\" text-anchor=\"middle\">%g</text>\n", x(v), x(v), v
  print "<text x=\"400\" y=\"424\" text-anchor=\"middle\">time [s]</text>"
  printf "<text x=\"54\" y=\"50\" text-anchor=\"end\">%.2g mm</text><text x=\"54\" y=\"150\" text-anchor=\"end\">0</text>\n", most_depth
  printf "<text x=\"54\" y=\"180\" text-anchor=\"end\">%.2g N</text><text x=\"54\" y=\"390\" text-anchor=\"end\">0</text>\n", most
  curve("depth", "#555", 45, 105, most_depth)
  curve("measured", "#d55e00", 175, 215, most)
  curve("felt", "#0072b2", 175, 215, most)
  if (begun) printf "<path d=\"M%.1f 40V390\" stroke=\"#009e73\" stroke-dasharray=\"5 3\"/><text x=\"%.1f\" y=\"168\" fill=\"#009e73\">identified</text>\n", x(begun), x(begun) + 4
  print "<text x=\"600\" y=\"60\" fill=\"#555\">depth</text><text x=\"560\" y=\"190\" fill=\"#0072b2\">felt force</text><text x=\"640\" y=\"190\" fill=\"#d55e00\">delayed measurement</text></svg>"
}
