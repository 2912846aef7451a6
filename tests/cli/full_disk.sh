# Sourced after scratch.sh: a folder `full` on a disk that is full. Where nobody may mount one (not root, or
# in a container), files that may grow no further stand for it: their writes are cut short in the same way.
full_disk() { # SIZE in KB; says in `full_disk` what the disk is like
  mkdir full
  full_disk='file may not grow'
  mount -t tmpfs -o size="$1k" tmpfs full 2>/dev/null || return 0
  full_disk='disk full on the way'
  trap '[[ $BASHPID != "$$" ]] || { umount "$work/full"; rm -rf "$work"; }' EXIT
}
# fill ROOM: but for so many bytes; without a disk to fill, files may be that long, or longer than FILE by it.
fill() { # ROOM [FILE]
  room=$((($1 + $(stat -c %s ${2:+"$2"} 2>/dev/null || echo 0)) / 1024))
  [[ $full_disk == disk* ]] || return 0
  head -c 200000 /dev/zero >full/filler 2>/dev/null
  truncate -s -"$1" full/filler
}
filling() { # COMMAND...
  [[ $full_disk != disk* ]] || { "$@"; return; }
  (trap '' XFSZ && ulimit -f $room && exec "$@") 2>&1 >/dev/null | cat >&2  # of which the limit is not
  return "${PIPESTATUS[0]}"
}
