# What a bench printed, as rows of ratios: awk -v row=solver|multigrid|mesher|scan|fit -f table.awk OUTPUT
function line(what, peer, ours, theirs, memory, asked) {
  printf "%-46s %-28s %9.4g %9.4g %7.2f %7s %6s\n", what, peer, ours, theirs, theirs / ours, (memory > 0 ? sprintf("%.2f", memory) : ""), asked
}
function power(s1, s2, n1, n2) { return log(s2 / s1) / log(n2 / n1) }

# tets order patch program... s MB force ratio
row == "solver" && $1 ~ /^[0-9]+$/ && NF >= 8 {
  key = $1 " " $2; s = $(NF - 3); mb = $(NF - 2)
  if (!(key in seen)) { seen[key] = 1; keys[++count] = key }
  if (/by-size/) { ours[key] = s; our_mb[key] = mb }
  if (/SPOOLES/) { direct[key] = s; direct_mb[key] = mb }
  if (/ITERATIVE/ && (!(key in iterative) || s < iterative[key])) { iterative[key] = s; iterative_mb[key] = mb }
}

# tetrahedra, ...; nu by ... s MB iterations force ratio
row == "multigrid" && / tetrahedra, / { tets = $1 }
row == "multigrid" && $2 == "hapsim" { ours[$1] = $3; held[$1] = $4 }
row == "multigrid" && NF == 9 && $2 != "by" {
  line(sprintf("three columns, %d tetrahedra, nu %s", tets, $1), "PETSc, " $2, ours[$1], $5, $6 / held[$1], 1)
}

# program: status N, s, processor s, MB
row == "mesher" && /^(tetgen|hs-tetmesh) *: status 0,/ { split($0, c, /[:,]/); gsub(/ /, "", c[1]); cpu[c[1]] = c[4] + 0; mem[c[1]] = c[5] + 0 }

# body points by kept ... both_s rms max
row == "scan" && $2 ~ /^[0-9]+$/ {
  if ($3 == "hapsim") { body = $1; n = $2; mine[$1, $2] = $(NF - 2); their[$1, $2] = "" ; order[++scans] = $1 " " $2 }
  if ($3 == "Open3D") their[$1, $2] = $(NF - 2)
}

# preparation, N samples: s; what, s ratio ...
row == "fit" && /^preparation/ && !prepared { prepared = $(NF - 1) }
row == "fit" && /^(E and nu|six parameters), / {
  match($0, /  +[0-9.]+/); s = substr($0, RSTART) + 0; split($0, c, /,|  /); what = c[1]
  if ($0 ~ /, hapsim  /) fit_s = s
  else if ($0 ~ /SciPy/) line("fit of " what ", prepared", (/CalculiX/ ? "SciPy around CalculiX" : "SciPy around hs-simulate"), fit_s, s, 0, (/CalculiX/ ? 100 : ""))
  if ($0 ~ /CalculiX/ && what == "E and nu") line("fit of E and nu, a first run on a new body", "SciPy around CalculiX", prepared + fit_s, s, 0, 8)
}

END {
  for (k = 1; k <= count; ++k) {
    key = keys[k]; split(key, c, " ")
    what = sprintf("one press, %d tetrahedra, order %d", c[1], c[2])
    if (key in direct) line(what, "CalculiX, direct", ours[key], direct[key], direct_mb[key] / our_mb[key], (c[1] > 1e5 ? 4 : ""))
    line(what, "CalculiX, its best iterative", ours[key], iterative[key], iterative_mb[key] / our_mb[key], (c[2] == 2 ? 3 : 1))
    if (k > 1) {
      split(keys[k - 1], b, " ")
      if (b[2] == c[2])
        printf "one press, order %d: time grows by the power %.2f, CalculiX %s%.2f iterative\n", c[2],
          power(ours[keys[k - 1]], ours[key], b[1], c[1]),
          (key in direct ? sprintf("%.2f direct and ", power(direct[keys[k - 1]], direct[key], b[1], c[1])) : ""),
          power(iterative[keys[k - 1]], iterative[key], b[1], c[1])
    }
  }
  if (row == "mesher" && cpu["tetgen"] > 0) line("tetrahedra in 99,372 triangles", "TetGen's program", cpu["hs-tetmesh"], cpu["tetgen"], mem["tetgen"] / mem["hs-tetmesh"], 1)
  for (k = 1; k <= scans; ++k) {
    split(order[k], c, " "); what = sprintf("points to a surface, %s, %d", c[1], c[2])
    if (their[c[1], c[2]] != "") line(what, "Open3D", mine[c[1], c[2]], their[c[1], c[2]], 0, 2)
    else printf "%-46s %-28s %9.4g\n", what, "(Open3D is not installed)", mine[c[1], c[2]]
    split(order[k - 1], b, " ")
    if (k > 1 && b[1] == c[1]) printf "... time grows by the power %.2f\n", power(mine[b[1], b[2]], mine[c[1], c[2]], b[2], c[2])
  }
}
