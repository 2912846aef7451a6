# Sourced by the scripts of this folder.
recordings() { # PATH: below the folder realdata of $HAPSIM_SHARED, absolute; says what is missing
  [[ -n ${HAPSIM_SHARED-} ]] || { echo "${0##*/}: no recordings: HAPSIM_SHARED is not set; set it to the folder that holds realdata" >&2; return 3; }
  local path
  path=$(realpath -m "$HAPSIM_SHARED/realdata/$1")
  [[ -e $path ]] || { echo "${0##*/}: no recordings: $path is missing; set HAPSIM_SHARED to the folder that holds realdata" >&2; return 3; }
  printf '%s\n' "$path"
}
