#!/usr/bin/env bash
# formats.sh BIN: every format of body is read by every tool with --body, with the results of the PLY;
# every output is in the format that its extension says, or refused before the work.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"
quiet() { "$bin/$1" "${@:2}" -q >out 2>err </dev/null || complain "$*"; }

# --- Bodies -----------------------------------------------------------------------------------------
# Coordinates of twelve digits, as an Abaqus deck has them, are the same number in every format.
quiet hs-tetmesh box.off --edge 0.03 -o digits.inp
quiet hs-tetmesh digits.inp -o body.ply
printf 'effect,region,parameter,value,unit\nelastic,0,E,20000,Pa\nelastic,0,nu,0.45,1\n' >model.csv
extensions() { # TOOL: those of its --output
  "$bin/$1" --help | sed -n '/--output FILE/,/^ \{2,6\}-\|^$/p' | tr -s ' \n' ' ' | sed -n 's/.*Extensions: \([^.]*\)\..*/\1/p' | tr -d ,
}
bodies=(text.ply text.vtu four.msh split.node split.ele febio.feb sofa.scn)
for extension in $(extensions hs-tetmesh); do
  quiet hs-tetmesh body.ply -o written.$extension
  bodies+=(written.$extension)
done
for name in text.ply text.vtu; do quiet hs-tetmesh body.ply --ascii -o $name; done
quiet hs-tetmesh body.ply --gmsh-version 4.1 --tetgen split -o four.msh
quiet hs-export model.csv --body body.ply --format febio -o febio.feb
quiet hs-export model.csv --body body.ply --format sofa -o sofa.scn
grep -q '^4.1' four.msh || complain 'the version of Gmsh is not kept'
for body in "${bodies[@]}"; do
  cmp -s <("$bin/hs-tetmesh" -q "$body" --ascii) text.ply || complain "$body is another body"
done

box_presses 12 0.0001 >motion.csv
quiet hs-simulate motion.csv --body body.ply --model model.csv --rim-edge 0.5 --add-noise 0.002 -o data.csv
quiet hs-simulate motion.csv --body body.ply --model model.csv --own-mesh -o forces.csv
quiet hs-identify data.csv --body body.ply --acfm 0 -o acfm.csv
awk 'BEGIN { print "# tool_radius: 0.004\nx,y,z,E,nu,E_std,nu_std,n"
  for (i = 0; i < 12; ++i) printf "%g,%g,0.04,%g,0.4,200,0.02,30\n", 0.008 + 0.015 * (i % 4), 0.008 + 0.017 * int(i / 4), i % 4 < 2 ? 8000 : 20000 + i }' >samples.csv
awk 'BEGIN { print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz"
  for (i = 0; i < 100; ++i) printf "1,%.3f,0.03,0.025,0.04,0,0,%.9g\n", i / 1000, -0.001 * sin(i / 99) }' >fast.csv

# What TOOL makes with BODY goes to `made`; where the clock has a part in it, how much of it there is.
use() { # TOOL BODY
  local tool=$bin/$1 body=$2
  case $1 in
  hs-simulate) "$tool" motion.csv --body "$body" --model model.csv --rim-edge 0.5 -q -o made.csv ;;
  hs-identify) "$tool" data.csv --body "$body" --rim-edge 0.5 --folds 0 -q -o made.csv ;;
  hs-diagnose) "$tool" data.csv --body "$body" --model model.csv --rim-edge 0.5 -q -o made.csv ;;
  hs-plan) "$tool" data.csv --body "$body" --rim-edge 0.5 -q -o made.csv ;;
  hs-cluster) "$tool" samples.csv --body "$body" --scan-points 400 --boundary made.csv -q -o none.csv ;;
  hs-export) "$tool" model.csv --body "$body" --format vtu -q -o made.vtu && mv made.vtu made.csv ;;
  hs-compare)
    "$tool" data.csv --simulated forces.csv --body "$body" --ply map.ply -q -o residuals.csv &&
      "$tool" --follow data.csv --accuracy 0.3 --body "$body" --model model.csv --rate 20 -q -o made.csv && cat map.ply >>made.csv ;;
  hs-fuse) "$tool" --live fast.csv --body "$body" --model model.csv --acfm-model acfm.csv -q -o live.csv && grep -c '^1,' live.csv >made.csv ;;
  hs-link)
    : >far.err  # the last one's words are not this one's
    "$tool" --listen 0 --accuracy 0.3 --body "$body" --model model.csv --tool-radius 0.004 --idle 60 2>far.err &
    local far=$! port=
    for _ in {1..600}; do grep -q listening far.err && break; sleep 0.05; done
    port=$(sed -n 's/.*listening at 127.0.0.1:\([0-9]*\).*/\1/p' far.err)
    "$tool" fast.csv --accuracy 0.3 --peer "$port" --body "$body" --samples 20 -q -o felt.csv && grep -c '^1,' felt.csv >made.csv
    local done=$?
    kill $far; wait $far
    (exit $done) ;;
  *) false ;;
  esac >out 2>err </dev/null
}
for path in "$bin"/hs-*; do
  tool=${path##*/}
  "$path" --help | grep -q '^  --body ' || continue
  use $tool body.ply || { complain "$tool has --body, and here is no call of it that works"; continue; }
  # The name of the body may stand in comments.
  plain() { grep -av '^#' "$1"; }
  plain made.csv >expected
  [[ -s expected ]] || complain "$tool makes nothing"
  for body in "${bodies[@]}"; do
    rm -f made.csv
    use $tool $body && cmp -s <(plain made.csv) expected || complain "$tool takes $body otherwise than the PLY"
  done
done
# A picture needs a surface alone; the same of a box in every format.
quiet hs-reconstruct box.off -o surface.stl
quiet hs-reconstruct box.off -o surface.ply
for body in box.off surface.stl surface.ply; do
  quiet hs-compare data.csv --simulated forces.csv --body $body --ply map.ply -o residuals.csv
done
refused() { # CODE TEXT TOOL ARGUMENTS...
  local code=$1 text=$2 got
  shift 2
  "$bin/$1" "${@:2}" >out 2>err </dev/null
  got=$?
  ((got == code)) && grep -qF -- "$text" err && [[ $(wc -l <err) == 1 ]] || complain "exit $got, not $code with '$text': $*"
}
refused 3 'the file is empty' hs-simulate motion.csv --body /dev/null --model model.csv
for body in data.csv surface.stl "$bin/hs-tetmesh"; do
  refused 3 'not a PLY, VTU, VTK, Gmsh, TetGen, Abaqus, FEBio or SOFA mesh' hs-simulate motion.csv --body "$body" --model model.csv
done

# --- Outputs ----------------------------------------------------------------------------------------
box_scan >scan.csv
quiet hs-scan2ply scan.csv --unit mm --spacing 0.004 -o points.ply
printf 'press,x,y,z,ux,uy,uz,fx,fy,fz\n1,0.03,0.025,0.04,0,0,-0.001,0,0,1\n' >table.csv
# content FILE: what a reader by content finds, whatever the name is
content() {
  case $(head -c 80 "$1" | tr -d '\0' | head -n 1) in
  ply*) echo ply ;; 'solid'* | 'binary STL'*) echo stl ;; '<?xml'*) echo vtu ;; '$MeshFormat'*) echo msh ;;
  '** hapsim'*) echo inp ;; *)
    if grep -q '^x,y,z' "$1"; then echo csv; elif grep -q '^v ' "$1"; then echo obj; else echo xyz; fi ;;
  esac
}
written() { # EXTENSION TOOL ARGUMENTS...: written as that, and read back by it
  local extension=$1 is
  shift
  rm -f made.$extension
  quiet "$@" -o made.$extension
  is=$(content made.$extension)
  case $extension in txt | asc | pts) [[ $is == xyz ]] ;; *) [[ $is == "$extension" ]] ;; esac ||
    complain "made.$extension of $1 is $is"
  mv made.$extension nameless
  quiet "$1" nameless -o again.ply
}
for extension in $(extensions hs-reconstruct); do written $extension hs-reconstruct box.off; written $extension hs-reconstruct box.off --ascii; done
for extension in $(extensions hs-tetmesh); do written $extension hs-tetmesh body.ply; done
for extension in $(extensions hs-scan2ply); do written $extension hs-scan2ply points.ply; done
quiet hs-import table.csv --block 60x50x40mm --tool-radius 4mm --surface block.stl -o imported.csv
[[ $(content block.stl) == stl ]] || complain 'the block is no STL'
quiet hs-tetmesh block.stl -o again.ply
quiet hs-cluster samples.csv --body body.ply --labels labels.vtu -o none.csv
[[ $(content labels.vtu) == vtu ]] || complain 'the labelled body is no VTU'
# Without an extension, and on standard output, it is the PLY; an extension in capitals counts too.
quiet hs-reconstruct box.off -o nothing && [[ $(content nothing) == ply ]] || complain 'no extension is PLY'
quiet hs-reconstruct box.off && [[ $(content out) == ply ]] || complain 'standard output is PLY'
quiet hs-reconstruct box.off -o LOUD.STL && [[ $(content LOUD.STL) == stl ]] || complain 'STL in capitals'

# Every tool: an extension that its --output or another written file cannot have is refused at once,
# before any input is looked at.
all='csv txt dat bin ply stl off vtu msh inp feb scn node ele pcd xyz asc pts html json svg xml zip'
for path in "$bin"/hs-*; do
  tool=${path##*/}
  needed=$("$path" --help | sed -n 's/^Usage: [^ ]* \[OPTIONS\]//p' | sed 's/\[INPUT\]//; s/ FILE/ none/g; s/ PROGRAM/ vtu/')
  known=" $(extensions $tool) "
  [[ $known == *[a-z]* ]] || complain "$tool does not say what its output can be"
  for extension in $all; do
    [[ $known == *" $extension "* ]] || refused 2 "not written as .$extension" $tool $needed -o none.$extension none
  done
  for flag in $("$path" --help | awk '/^  (-., )?--/ { flag = $1 } /Extensions:/ && flag != "-o," { print flag }'); do
    refused 2 "not written as .zip" $tool $needed $flag none.zip none
  done
done
[[ -z $(compgen -G 'none.*') ]] || rm -f none.csv
[[ -z $(compgen -G 'none.*') ]] || complain "something is left behind: $(compgen -G 'none.*')"
# A table may be called anything that promises nothing else.
quiet hs-simulate motion.csv --body body.ply --model model.csv --own-mesh -o forces.new && cmp -s forces.csv forces.new || complain 'a table of another name'
refused 2 '--format is febio' hs-export model.csv --body body.ply --format febio -o none.inp
refused 2 'a plan is a table' hs-scan2ply points.ply --scan-plan surface --robot none.urdf -o none.ply

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
echo 'formats: passed'
