# Whether a text states only numbers that were told: awk -f numbers.awk mode=told TOLD... mode=text TEXT. Of the text
# each number with a fraction, or of N, mm, %, kPa or times the noise, outside of code, must be one that was told with
# the same unit, rounded as the text rounds it. Tables (.csv) tell numbers without units: they count for N, for kPa
# (told in Pa) and where the text gives no unit, not for %, mm or times the noise. `section` (optional): the letter
# with which the heading begins. Prints what was not told; `least`: numbers that the text must have.
function next_number(text) { return match(text, /-?[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?/) }
function unit_of(after) {
  if (after ~ /^[ ,;)]*(and|to|->|or|in turn)? *[-(0-9., ]*\)? ?mm/ && after ~ /^( |,|\)| to | -> | and )/) return "mm"
  if (after ~ /^ ?mm/) return "mm"
  if (after ~ /^ ?%/) return "%"
  if (after ~ /^ ?(x|times) (the )?noise/) return "noise"
  if (after ~ /^ ?kPa/) return "kPa"
  if (after ~ /^ ?Pa/) return "Pa"
  if (after ~ /^ ?N([^a-zA-Z]|$)/) return "N"
  return ""
}
function keep(line, plain,   text, unit, number) {
  for (text = line; next_number(text); text = substr(text, RSTART + RLENGTH)) {
    number = substr(text, RSTART, RLENGTH)
    unit = plain ? "" : unit_of(substr(text, RSTART + RLENGTH))
    ++count
    told[count] = number
    of[count] = unit
  }
}
function fits(unit, k) {
  if (unit == "%" || unit == "mm" || unit == "noise") return of[k] == unit
  if (unit == "kPa") return of[k] == "Pa" || of[k] == "" || of[k] == "kPa"
  if (unit == "N") return of[k] == "N" || of[k] == ""
  return of[k] != "%"
}
{ gsub(/\^[0-9]/, "") } # of units
mode == "told" {
  if (FILENAME ~ /\.csv$/) { keep($0, 1); next }
  gsub(/ +/, " ")
  said = said $0 " "
  next
}
/^## / { here = section == "" || substr($2, 1, 1) == section }
FNR == 1 && section == "" { here = 1 }
/^```/ { code = !code; next }
here && !code { gsub(/`[^`]*`/, ""); gsub(/\]\([^)]*\)/, "]"); all = all " " $0 }
END {
  keep(said, 0)
  for (; next_number(all); all = substr(all, RSTART + RLENGTH)) {
    number = substr(all, RSTART, RLENGTH)
    after = substr(all, RSTART + RLENGTH)
    unit = unit_of(after)
    if (number !~ /\./ && unit == "") continue
    digits = number ~ /\./ ? length(number) - index(number, ".") : 0
    found = 0
    for (k = 1; k <= count && !found; ++k)
      if (fits(unit, k)) found = sprintf("%.*f", digits, (unit == "kPa" && of[k] != "kPa" ? 1e-3 : 1) * told[k]) + 0 == number + 0
    ++checked
    if (!found) print (section == "" ? "" : "section " section ": ") "nothing that was run says " number substr(after, 1, 12)
  }
  if (checked < least) print "the text has " checked + 0 " numbers, not " least
}
