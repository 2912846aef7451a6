#!/usr/bin/env bash
# documents.sh BIN MAN: every command of README.md, of the READMEs below share and of the man pages' examples is one
# that the tools take as it is printed; those of README.md, of the import recipes and of the man pages run, from
# files with the names that they use. What another test runs is named below, and why.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
man=$(cd "$2" && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"
need ccx
export PATH=$bin:$PATH OMP_NUM_THREADS=1

# Commands that are not run here: a part of them, and who runs them.
excused() { # COMMAND
  case $1 in
    ./run-*) ;;                                          # this is run-tests.sh; run-example.sh: fresh-debian.sh
    share/install-deps.sh* | cmake\ * | cpack\ * | apt\ *) ;; # tests/install, package-check.sh
    make\ -f\ /usr/share/hapsim/*) ;;                    # package-check.sh; ci.sh
    *CLUSTER=slurm*) ;;                                  # slurm.sh
    parallel\ *) ;;                                      # ssh.sh
    rostopic\ *) ;;                                      # another program's
    'g++ pressing.cpp'* | ./pressing\ *) ;;              # tests/install
    build/device_none\ * | build/device_linked\ *) ;;                             # haptic_device.sh
    cc\ press.c\ * | ./press\ *) ;;                      # mujoco.sh
    hs-link\ --listen\ * | hs-link\ *--peer\ *) ;;       # link.sh
    share/examples/batch/machines.sh*) ;;                # machines.sh
    hs-scan2ply\ *--robot\ *) ;;                         # scan2ply.sh: a robot stands behind it
    hs-calibrate\ *--robot\ *) ;;                        # calibrate.sh: so it does there
    make\ -k\ -C\ batch\ *) ;;                           # batch.sh: the target is a name of the manifest
    *--refine-boundary\ *) ;;                            # regions_path.sh
    *--effects\ auto\ --history*) ;;                     # pipeline.sh
    *) return 1 ;;
  esac
}

# ---- Commands as data: FILE, then a command a line; one that ends in \ goes on.
blocks() { awk '/^```sh$/ { on = 1; next } /^```/ { on = 0 } on && !/^ *#/ && NF' "$1"; }
examples() {
  awk '/^\.SH EXAMPLES/ { on = 1; next } /^\.SH/ { on = 0 } on && /^\\fB/' "$1" | sed 's/^\\fB//; s/\\fR$//; s/\\-/-/g; s/\\e/\\/g'
}

# ---- Each command of ours is understood: what a pipe joins is taken apart; comments go.
understood=0
parsed() { # WHERE COMMAND
  local part tool
  while IFS= read -r part; do
    part=$(sed 's/^ *//; s/  *#.*//; s/ [0-9]*>.*//; s/ *\\$//' <<<"$part")
    tool=${part%% *}
    [[ $tool == hs-* ]] || continue
    understood=$((understood + 1))
    eval "set -- ${part#"$tool"}" 2>/dev/null || { complain "$1: no words of a shell: $part"; continue; }
    "$bin/$tool" "$@" --parsed >/dev/null 2>err </dev/null || complain "$1: not understood: $part"
  done < <(sed 's/ | /\n/g; s/ && /\n/g' <<<"$2")
}
documents=("$root/README.md" "$root"/share/examples/*/README.md "$root"/share/doc/*/README.md)
for file in "${documents[@]}"; do
  while IFS= read -r command; do parsed "${file#"$root"/}" "$command"; done < <(blocks "$file")
done
for page in "$man"/hs*.1; do
  [[ -n $(examples "$page") ]] || complain "${page##*/} has no example"
  while IFS= read -r command; do parsed "${page##*/}" "$command"; done < <(examples "$page")
done
# Examples in shell scripts take the same tools: a flag that is gone is found in the tests that run them.
((understood > 100)) || complain "only $understood commands were found"

# ---- A folder with a file of every name that the documents use.
mkdir files && cd files || exit 1
cp ../box.off surface.off
box_scan >scan-mm.csv
awk -F, -v OFS=, 'NR == 1 { print; next } { print $1 / 1000, $2 / 1000, $3 / 1000 }' scan-mm.csv >scan-m.csv
quiet() { "$bin/$1" "${@:2}" -q 2>err </dev/null || complain "files: $*"; }
quiet hs-tetmesh surface.off --edge 12mm -o body.ply
quiet hs-reconstruct surface.off -o surface.ply
for name in block real; do cp body.ply $name.ply; done
# Eight places, each pressed slowly and fast with a hold; relaxing, in two halves of which one is stiffer.
presses() {
  awk 'BEGIN { print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz"
    for (p = 0; p < 16; ++p) for (i = 0; i <= 24; ++i) {
      t = p % 2 ? i * 0.1 : i * 0.02; d = 0.0002 * (i < 10 ? i : 10)
      printf "%d,%.2f,%.3f,%.3f,0.04,%.6f,0,%.6f\n", p, t, 0.012 + 0.012 * (int(p / 2) % 4), 0.015 + 0.02 * int(p / 8), p % 2 ? 0 : 0.2 * d, -d } }'
}
presses >motion.csv
printf 'effect,region,parameter,value,unit\nelastic,0,E,12000,Pa\nelastic,0,nu,0.4,1\nelastic,1,E,40000,Pa\nregions,0,x,0.01,m\nregions,0,y,0.025,m\nregions,1,x,0.05,m\nregions,1,y,0.025,m\nviscoelastic,0,E1,5000,Pa\nviscoelastic,0,tau1,0.4,s\n' >hidden.csv
quiet hs-simulate motion.csv --body body.ply --model hidden.csv --rim-edge 0.2 --add-noise 0.005 -o data.csv
quiet hs-identify data.csv --body body.ply --fix nu=0.4 --folds 0 -o m0.csv
quiet hs-identify data.csv --body body.ply --model m0.csv --add viscoelastic --folds 0 --history history.csv -o m1.csv
for name in m model golden; do cp m1.csv $name.csv; done
for n in 0 1; do quiet hs-simulate data.csv --body body.ply --model m$n.csv -o f$n.csv; done
cp f1.csv forces.csv
quiet hs-diagnose data.csv --body body.ply --model m0.csv --flips 99 -o effects.csv
# Two bodies; a deep hold.
awk -v OFS=, -F, '/^[#p]/ { print; next } { $1 += 100; print }' data.csv >block.csv
cp data.csv ball.csv
cp body.ply ball.ply
awk 'BEGIN { print "# tool_radius: 0.004\n# force_noise: 0.005\npress,t,x,y,z,ux,uy,uz,fx,fy,fz"
  for (p = 0; p < 3; ++p) for (i = 0; i <= 60; ++i) { t = i * 0.1; d = 0.003 * (i < 10 ? i / 10 : 1); srand(i + 99 * p)
    printf "%d,%.1f,%.3f,0.025,0.04,0,0,%.6f,%.5f,0,%.5f\n", p, t, 0.02 + 0.01 * p, -d, 0.01 * (rand() - 0.5), 400 * d * (0.6 + 0.4 * exp(-t)) + 0.01 * (rand() - 0.5) } }' >hold.csv
# Fast, slow and exact forces of one motion; a stream of rows.
awk 'BEGIN { print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz,fx,fy,fz"
  for (i = 0; i < 1500; ++i) { d = 0.001 * (1 - cos(i / 90)); printf "1,%.3f,0.03,0.025,0.04,0,0,%.9g,0,0,%.9g\n", i / 1000, -d, 90 * d * (1 + 100 * d) } }' >fine.csv
awk -F, -v OFS=, '/^[#p]/ { print; next } { $11 = -90 * $8; print }' fine.csv >fast.csv
awk -F, -v OFS=, '/^[#p]/ { print; next } $2 * 1000 % 25 < 0.5' fine.csv >fe.csv
cut -d, -f1-8 fast.csv >short-motion.csv
printf 'effect,region,parameter,value,unit\nelastic,0,E,20000,Pa\nelastic,0,nu,0.4,1\n' >finite.csv
quiet hs-identify data.csv --body body.ply --acfm 1 -o acfm.csv
quiet hs-fuse fast.csv --slow fe.csv --delay 0.05 --learn filter.csv -o fused.csv
for n in 1 2 3 4; do quiet hs-identify data.csv --body body.ply --model m0.csv --folds 0 --library lab.db --material liver -o stored.csv; done
printf 'name,body,data,options\nliver-03,body.ply,data.csv,--folds 0 --fix nu=0.4\n' >recordings.csv
# A sensor that hangs straight, and presses that stand for a rigid block's.
quiet hs-calibrate --plan turns.csv --plan-poses 12
awk -F, -v OFS=, '$1 == "pose" { print "qw,qx,qy,qz,fx,fy,fz"; next } { print $2, $3, $4, $5, 4 * $6 + 0.0001 * ($1 % 3), 4 * $7, 4 * $8 }' turns.csv >poses.csv
awk -F, -v OFS=, '/^[#p]/ { print; next } { for (k = 6; k <= 8; ++k) $k *= 0.01; print }' data.csv >rigid.csv
quiet hs-calibrate poses.csv -o cal.csv
# Tables of machines and robots.
machine() { awk -v noise="$1" 'BEGIN { srand(5); print "Time [s],Travel [mm],Force [N]"; for (i = 0; i <= 80; ++i) printf "%g,%g,%.5f\n", i / 10, i / 40, i / 60 + noise * (rand() - 0.5) }'; }
for name in zwick meat meat_1 meat_2 foam sample_1 sample_2 run1 run2 recording; do machine 0.002 >$name.csv; done
for name in recording run1 run2; do
  awk 'BEGIN { print "site,x [mm],y [mm],z [mm],nx,ny,nz,depth [mm],force [N]"; for (s = 1; s <= 4; ++s) for (k = 0; k <= 8; ++k)
    printf "%d,%g,20,40,0,0,1,%g,%g\n", s, 8 * s, k / 5, k / 20 }' >$name.csv
done
awk 'BEGIN { srand(2); print "Site,ContactPoint_x,ContactPoint_y,ContactPoint_z,ContactBallCenter_x,ContactBallCenter_y,ContactBallCenter_z,CurrentPos_x,CurrentPos_y,CurrentPos_z,nx,ny,nz,Force_x,Force_y,Force_z"
  for (s = 0; s < 36; ++s) { x = 5 * (s % 6); y = 5 * int(s / 6); z = 30 + sin(x / 9) 
    for (k = 0; k <= 8; ++k) { d = 0.3 * k; printf "%d,%g,%g,%.4f,%g,%g,%.4f,%g,%g,%.4f,0,0,1,0,0,%.4f\n", s, x, y, z, x, y, z + 3, x, y, z + 3 - d, 0.3 * d + 0.002 * (rand() - 0.5) } } }' >liver_region1.csv
awk 'BEGIN { print "x,y,z"; for (i = 0; i < 20; ++i) for (j = 0; j < 20; ++j) printf "%g,%g,%g\n", 2 * i, 2 * j, 30 + sin(i / 3) }' >touched.csv
cp "$root/share/examples/robot/press.bag" session.bag
cp session.bag press.bag
quiet hs-scan2ply touched.csv --unit mm -o touched.ply
quiet hs-scan2ply scan-m.csv -o points.ply
quiet hs-reconstruct surface.off -o damaged-m.stl
awk 'BEGIN { print "OFF"; print 8, 11, 0
  for (i = 0; i < 8; ++i) print (i % 2) * 60, (int(i / 2) % 2) * 50, (i >= 4) * 40
  split("0 2 1,1 2 3,4 5 6,5 7 6,0 1 4,1 5 4,2 6 3,3 6 7,0 4 2,2 4 6,1 3 5,3 7 5", f, ","); for (i = 1; i <= 11; ++i) print 3, f[i] }' >damaged.off
awk 'BEGIN { print "OFF"; print 8, 12, 0
  for (i = 0; i < 8; ++i) print 0.02 + (i % 2) * 0.02, 0.015 + (int(i / 2) % 2) * 0.02, 0.01 + (i >= 4) * 0.02
  split("0 2 1,1 2 3,4 5 6,5 7 6,0 1 4,1 5 4,2 6 3,3 6 7,0 4 2,2 4 6,1 3 5,3 7 5", f, ","); for (i = 1; i <= 12; ++i) print 3, f[i] }' >inner.off
quiet hs-reconstruct inner.off -o tumour.stl
quiet hs-tetmesh surface.off --region tumour.stl -o parts.ply
awk '/^OFF/ { print; next } NF == 3 && n++ { print 1000 * $1, 1000 * $2, 1000 * $3; next } { print }' ../box.off >part.stl # told by content
cp damaged.off damaged.stl
quiet hs-tetmesh surface.off --edge 12mm -o other.msh
awk 'BEGIN { # told by content, whatever it is called
  print "NRRD0004\ntype: float\ndimension: 3\nsizes: 24 24 24\nencoding: ascii\nspacings: 1 1 1\n"
  for (k = 0; k < 24; ++k) for (j = 0; j < 24; ++j) for (i = 0; i < 24; ++i)
    printf "%.3f\n", 100 * (6 - sqrt((i - 11.5) ^ 2 + (j - 11.5) ^ 2 + (k - 11.5) ^ 2)) }' >ct.nii.gz
awk 'BEGIN { print "zone,x,y,z,nx,ny,nz"; for (z = 0; z < 2; ++z) for (i = 0; i < 24; ++i) for (j = 0; j < 30; ++j) {
  x = 0.002 * i + 0.03 * z; y = 0.002 * j; printf "%s,%.5f,%.5f,%.5f,0,0,1\n", z ? "b" : "a", x, y, 0.02 + 0.004 * sin(90 * x) * cos(70 * y) + 0.001 * z } }' >organ.csv
ln -s "$root/Makefile.pipeline" .
cd ..

# ---- And all of them run, a document in a copy of that folder.
ran=0 took=$PWD/took.txt
run() { # WHERE COMMAND: in the current folder
  excused "$2" && return
  ran=$((ran + 1))
  local start=$EPOCHREALTIME
  timeout 300 bash -o pipefail -c "$2" >out 2>err <stream.csv
  local code=$?
  awk -v from="$start" -v to="$EPOCHREALTIME" 'BEGIN { printf "%.1f s: ", to - from }' >>"$took"
  printf '%s\n' "$2" >>"$took"
  case $2 in # a check may say no; other programs stand behind &&
    *--fail-above* | *--check* | *hs-check*) ((code <= 1)) && return ;;
  esac
  ((code == 0)) || complain "$1 (exit $code): $2"
}
folder() { # NAME SCAN: a fresh copy, gone to
  rm -rf here
  cp -r files here
  cp "files/$2" here/scan.csv
  cd here || exit 1
  cp fast.csv stream.csv
}
folder readme scan-mm.csv
while IFS= read -r command; do run README.md "${command%%  \#*}"; done < <(blocks "$root/README.md" | sed 's/^[^#]*[^ #]  *# or by GNU.*//')
cd ..
folder import scan-m.csv
while IFS= read -r command; do
  case $command in # of these formats the files are made by other programs: tests/unit/tables
    *.lvm\ * | *.mat\ * | *.h5\ * | *curve.csv* | *palpation.csv* | *Big5* | *--decimal*) continue ;;
  esac
  run share/examples/import/README.md "${command%%  \#*}"
done < <(blocks "$root/share/examples/import/README.md")
cd ..
for page in "$man"/hs*.1; do
  folder "${page##*/}" scan-m.csv
  [[ $page != *hs-fuse.1 && $page != *hs-simulate.1 ]] || cp short-motion.csv motion.csv
  while IFS= read -r command; do
    [[ $command != *calculix* ]] || cp m0.csv model.csv # which has no linear viscoelasticity
    run "${page##*/}" "$command"
    cp ../files/model.csv .
  done < <(examples "$page")
  cd ..
done
((ran > 60)) || complain "only $ran commands ran"
echo "the slowest:" && sort -rn "$took" | sed -n 1,10p
((failures == 0)) && echo "documents: $understood commands understood, $ran run"
exit $((failures > 0))
