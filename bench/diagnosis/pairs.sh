#!/usr/bin/env bash
# pairs.sh BIN OUT [GROUP...]: effects that look alike, on data that cannot separate them, and again
# with the presses that hs-diagnose asks for added (up to two rounds). By the tools alone, as a user
# would: forces from the exact shape and finer meshes, noise 0.01 N. One line a hidden effect: error
# of the elastic model over the noise, what is said of the first data, and after each round.
# "right": that effect alone; "set": ambiguous, it is among the rivals; "+": others named besides.
# Recorded in bench/results/diagnosis-alike.txt (bench/record.sh).
set -euo pipefail
bin=$(cd "$1" && pwd) out=$2
shift 2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
phantom=$here/../../share/examples/phantom
PATH=$bin:$PATH
mkdir -p "$out"
out=$(cd "$out" && pwd)
if [[ ! -e $out/true.ply ]]; then
  awk -v what=surface -f "$phantom/geometry.awk" >"$out/surface.stl"
  hs-tetmesh -q "$out/surface.stl" -o "$out/true.ply"
  hs-scan2ply -q "$phantom/scan.csv" --unit mm | hs-reconstruct -q | hs-tetmesh -q -o "$out/diagnosed.ply"
fi

# Rows of the hidden effect, on an elastic body of 15 kPa.
rows() {
  case $1 in
    sensor-lag) echo sensor-lag,0,tau,0.25,s ;;
    damper) echo damper,0,c,35,N s/m ;;
    viscoelastic) printf 'viscoelastic,0,%s\n' E1,9000,Pa tau1,0.15,s ;;
    slow-viscoelastic) printf 'viscoelastic,0,%s\n' E1,5000,Pa tau1,60,s ;;
    tip) echo tip,0,kappa,60,1/m ;;
    hyperelastic) printf 'hyperelastic,0,%s\n' s,0.35,1 finite,1,1 ;;
    sensor-bias) printf 'sensor-bias,0,%s\n' bx,0,N by,0,N bz,0.08,N ;;
    deadband) printf 'deadband,0,%s\n' d,0.08,N k,1,1 ;;
    sensor-drift) printf 'sensor-drift,0,%s\n' bx,0,N by,0,N bz,0,N rx,0,N/s ry,0,N/s rz,0.0005,N/s ;;
    temperature) printf 'temperature,0,%s\n' beta,0.02,1/K T_ref,25,degC ;;
    sensor-gain) printf 'sensor-gain,0,%s\n' gx,1.25,1 gy,1,1 ;;
    sensor-rotation) printf 'sensor-rotation,0,%s\n' rx,0.1,rad ry,-0.06,rad rz,0.03,rad ;;
    anisotropic) printf 'anisotropic,0,%s\n' ratio,2,1 shear,1,1 tilt,1.4,rad azimuth,0.3,rad ;;
    layer) printf 'layer,0,%s\n' thickness,0.002,m ratio,3,1 ;;
    inclusion) printf 'inclusion,0,%s\n' x,0.0106,m y,0,m z,0.025,m radius,0.007,m ratio,6,1 ;;
    regions) printf 'elastic,1,E,24000,Pa\nregions,0,x1,-0.02,m\nregions,0,y1,0,m\nregions,1,x1,0.02,m\nregions,1,y1,0,m\n' ;;
    base) printf 'base,0,%s\n' give,0.5,m azimuth,0.5,rad edge,0,m ;;
  esac
}
named() { if [[ $1 == slow-viscoelastic ]]; then echo viscoelastic; else echo "$1"; fi; }
# What separates: those that say that places or depths differ in stiffness are one family.
family() { case $1 in layer | inclusion | regions) echo inhomogeneous ;; *) echo "$1" ;; esac; }

# The group's effects, and presses that do not tell them apart.
declare -A effects=(
  [rate]='sensor-lag damper viscoelastic'
  [relaxing]='viscoelastic damper'
  [depth]='tip hyperelastic'
  [constant]='sensor-bias deadband'
  [session]='sensor-drift temperature'
  [direction]='sensor-gain anisotropic sensor-rotation'
  [place]='regions layer inclusion base'
  [slow]='sensor-drift slow-viscoelastic')
motion() {
  local options=(-v times=1 -v 'depths=3 5 4')
  case $1 in
    rate) options=(-v places=4 -v kinds=0 -v times=8 -v 'depths=3 5 4') ;;
    relaxing) options=(-v 'places=2 4' -v kinds=0 -v times=4 -v 'depths=3 5 4') ;;
    depth) options=(-v 'places=0 2 4 6' -v kinds=0 -v times=2 -v 'depths=2 2.5') ;;
    constant) options=(-v 'places=0 2 4 6' -v kinds=0 -v times=2 -v 'depths=4 5') ;;
    session) options=(-v 'places=0 2 4 6 8 10' -v 'kinds=0' -v times=2 -v depths=4) ;;
    direction) options=(-v 'places=0 1 2' -v kinds=0 -v times=3 -v 'depths=3 5 4') ;;
    place) options=(-v 'places=0 3 6 9' -v kinds=0 -v times=2 -v 'depths=3 5 4') ;;
    slow) options=(-v 'places=0 2 4 6' -v kinds=1 -v times=2 -v 'depths=4 3.5') ;;
  esac
  awk "${options[@]}" -v what=none -f "$phantom/geometry.awk" -f "$here/pairs.awk" |
    case $1 in
      constant | slow) without_air ;;
      session) without_air | warming ;;
      *) cat ;;
    esac
}
without_air() { awk -F, '/^[#p]/ || $9 == 1'; }
# The body warms with the session.
warming() { awk -F, -v OFS=, '/^#/ { print; next } /^press/ { print $0, "temp"; next } { print $0, 20 + 0.03 * $2 }'; }
# Planned presses, after those of the first file; warm and cold in turn where the body's temperature is known.
appended() {
  awk -F, -v OFS=, '
    FNR == 1 { ++file; header = 0 }
    /^#/ { if (file == 1) print; next }
    !header { header = 1; if (file == 1) { print; n = NF; for (i = 1; i <= NF; ++i) name[i] = $i }
              else { delete at; for (i = 1; i <= NF; ++i) at[$i] = i; offset = last + 30; before = press + 1 }; next }
    file == 1 { print; last = $2; press = $1; next }
    { line = $at["press"] + before OFS $at["t"] + offset
      for (i = 3; i <= n; ++i) line = line OFS (name[i] in at ? $at[name[i]] : name[i] == "temp" ? 20 + 8 * (($at["press"] + 1) % 2) : "")
      print line }' "$1" "$2"
}

verdict() {  # of effects.csv, for the hidden effect
  awk -F, -v truth="$(named "$2")" -v family="$(family "$2")" '
    function kin(e) { return e == "layer" || e == "inclusion" || e == "regions" ? "inhomogeneous" : e }
    /^#/ { next }
    $2 == "model" { model = $3 }
    $3 == "missing" { list = list (list ? "+" : "") $2; if (!first) first = $2; ++n }
    $3 == "indistinguishable" { set = set (set ? " " : "") $2; if (kin($2) == family) inside = 1 }
    END {
      if (first == truth && n == 1 && !set) print "right"
      else if (!first && set && inside) print "set {" set "}"
      else if (first && kin(first) == family) print "right first: " list (set ? " {" set "}" : "")
      else print (list || set ? "WRONG: " list (set ? " {" set "}" : "") : model)
    }' "$1"
}

trial() {
  local group=$1 effect=$2 work=$out/$1-$2
  mkdir -p "$work"
  { echo effect,region,parameter,value,unit,std_error,lower,upper,state
    printf '%s,,,,fixed\n' elastic,0,E,15000,Pa elastic,0,nu,0.42,1
    rows "$effect" | sed 's/$/,,,,fixed/'; } >"$work/truth.csv"
  motion "$group" >"$work/motion-0.csv"
  local line='' round said
  for round in 0 1 2; do
    hs-simulate -q "$work/motion-$round.csv" --body "$out/true.ply" --model "$work/truth.csv" \
      --rim-edge 0.08 --add-noise 0.01 --seed 11 -o "$work/data-$round.csv"
    hs-identify -q "$work/data-$round.csv" --body "$out/diagnosed.ply" --effects elastic -o "$work/elastic.csv"
    hs-diagnose -q "$work/data-$round.csv" --body "$out/diagnosed.ply" --model "$work/elastic.csv" \
      -o "$work/effects-$round.csv" --plan "$work/plan-$round.csv" --plan-presses 4 2>"$work/plan-$round.txt"
    said=$(verdict "$work/effects-$round.csv" "$effect")
    line+="${line:+  ->  }$said"
    [[ $said == right || $round == 2 ]] && break
    appended "$work/motion-$round.csv" "$work/plan-$round.csv" >"$work/motion-$((round + 1)).csv"
  done
  printf '%-10s %-18s %5.1f  %s\n' "$group" "$effect" \
    "$(awk -F, '/^0,model/ { print $4 / 0.01 }' "$work/effects-0.csv")" "$line"
}

groups=("$@")
((${#groups[@]})) || groups=(rate relaxing depth constant session direction place slow)
printf '%-10s %-18s %5s  %s\n' group hidden error said
for group in "${groups[@]}"; do
  for effect in ${effects[$group]}; do trial "$group" "$effect"; done
done
