# The recipes of bench/real/run.sh, one function each: what a user would do with a table of that kind. Called in the
# set's own folder as `RECIPE FLAGS TABLE...`; `$bin` holds the tools. Each leaves files behind and prints nothing;
# what fails ends it with the tool's own last line in `err`.

# step SECONDS COMMAND...: one tool, within its time; its words are kept in `log`.
step() {
  local limit=$1 code
  shift
  echo "\$ $*" >>log
  timeout "$limit" "$@" 2>err
  code=$?
  cat err >>log
  ((code == 0)) && return
  ((code == 124)) && echo "$(basename "$1"): not done within $limit s" >err
  return 1
}

# fit_and_diagnose FLAGS...: the first model, what is missing in it, and the model that the loop ends with.
fit_and_diagnose() {
  step 300 hs-identify data.csv --body body.ply --effects elastic --fix nu=0.45 "$@" --history steps.csv -o m0.csv || return 1
  step 900 hs-diagnose data.csv --body body.ply --model m0.csv --json effects.json -o effects.csv || return 1
  step 600 hs-identify data.csv --body body.ply --model m0.csv --effects auto "$@" --history steps.csv -o m1.csv || return 1
  step 120 hs-simulate data.csv --body body.ply --model m1.csv -o forces.csv || return 1
  step 120 hs-compare data.csv --simulated forces.csv --html report.html -o residuals.csv
}

# An organ or phantom that a robot probed: its touched points are its surface.
organ() {
  local flags=$1
  # shellcheck disable=SC2086
  step 60 hs-import "$2" --unit mm $flags --scan touched.csv -o data.csv || return 1
  step 60 hs-scan2ply touched.csv -o points.ply && step 120 hs-reconstruct points.ply --window -o surface.ply &&
    step 120 hs-tetmesh surface.ply -o body.ply && fit_and_diagnose
}

# A testing machine on a block; several tables are one recording.
machine() {
  local flags=$1
  shift
  cat "$@" >tables.csv
  # shellcheck disable=SC2086
  step 60 hs-import tables.csv $flags --surface block.ply -o data.csv && step 60 hs-tetmesh block.ply -o body.ply &&
    fit_and_diagnose
}

# A tool that slid over the surface: a body.
surface() {
  # shellcheck disable=SC2086
  step 60 hs-import "$2" $1 --scan touched.csv -o data.csv && points '' touched.csv
}
points() {
  # shellcheck disable=SC2086
  step 60 hs-scan2ply "$2" $1 -o points.ply && step 300 hs-reconstruct points.ply -o surface.ply &&
    step 300 hs-tetmesh surface.ply -o body.ply
}
mesh() {
  # shellcheck disable=SC2086
  step 120 hs-tetmesh "$2" $1 -o body.ply
}
