# What each tool says of itself, and of a flag and a file that are not there.
for tool in $tools; do
  step "$tool" "$tool --help
    $tool --man
    $tool --no-such-flag || true
    $tool no-such-file.csv -o none || true
    $tool || true"
done
