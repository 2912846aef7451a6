#!/usr/bin/env bash
# container.sh ROOT BUILD: what can be known of share/container/Dockerfile without building it: its instructions are
# ones, what it copies is there and not left out of the context, the stages that it names came before, its shell
# commands parse, its presets are there, and the packages that it installs are those that cpack makes.
set -euo pipefail
root=$1 build=$2 file=$root/share/container/Dockerfile failures=0
complain() { echo "FAILED: $*"; failures=$((failures + 1)); }
cd "$root"

[[ $(head -n 1 "$file") == '# syntax=docker/dockerfile:1' ]] || complain 'the first line names no syntax (for --mount)'
read_stages() { # FILE: complains of its lines
  local line word rest stage source stages=' ' first=yes
  while IFS= read -r line; do
    read -r word rest <<<"$line"
    case $first$word in
      yesFROM | yesARG) [[ $word == ARG ]] || first=no ;;
      yes*) complain "$word stands before FROM" ;;
    esac
    for stage in $(grep -oE '(--from=|from=)[a-z]+' <<<"$rest" | sed 's/.*=//'); do
      [[ $stages == *" $stage "* ]] || complain "no stage $stage before: $line"
    done
    case $word in
      FROM)
        [[ $rest =~ ^debian:bookworm(-slim)?( AS ([a-z]+))?$ ]] || complain "of what: $line"
        stages+="${BASH_REMATCH[3]:-} "
        ;;
      COPY)
        [[ $rest == *' '* ]] || complain "nowhere to: $line"
        [[ $rest == --from=* ]] || for source in ${rest% *}; do
          [[ -e $source ]] || complain "$source is not there: $line"
          ! grep -qxF "${source%%/*}" "$file.dockerignore" || complain "$source is left out of the context"
        done
        ;;
      RUN)
        while [[ $rest == --* ]]; do rest=${rest#* }; done
        bash -n <<<"$rest" || complain "the shell does not read: $rest"
        ;;
      WORKDIR) [[ $rest == /* ]] || complain "$line" ;;
      ENV | ARG) [[ $rest =~ ^[A-Z_]+= ]] || complain "$line" ;;
      CMD | ENTRYPOINT) python3 -c 'import json, sys; assert all(isinstance(w, str) for w in json.loads(sys.argv[1]))' "$rest" || complain "$line" ;;
      *) complain "no instruction: $line" ;;
    esac
  done < <(sed -e '/^#/d' -e ':a' -e '/\\$/{N;s/\\\n/ /;ba' -e '}' "$1" | grep -v '^ *$')
}
read_stages "$file"

for preset in $(grep -oE -- '--preset [a-z]+' "$file" | cut -d' ' -f2 | sort -u); do
  grep -q "\"name\": \"$preset\"" CMakePresets.json || complain "no preset $preset"
done
made=$(sed -nE 's/^set\(CPACK_DEBIAN_[A-Z]+_PACKAGE_NAME "(.*)"\)/\1/p' "$build/CPackConfig.cmake")
for package in $(grep -oE '/packages/[a-z0-9-]+_' "$file" | sed 's|.*/||; s/_$//'); do
  grep -qxF "$package" <<<"$made" || complain "cpack makes no $package"
done

# The reading finds what is wrong.
wrong=$(mktemp)
trap 'rm -f "$wrong"' EXIT
printf '%s\n' 'FROM debian:bookworm' 'COPY no-such-file /' 'RUN if then' 'COPY --from=none a b' 'RUNS x' >"$wrong"
found=$(file=/dev/null read_stages "$wrong" 2>&1 || true)
for words in 'no-such-file is not there' 'the shell does not read' 'no stage none' 'no instruction: RUNS x'; do
  [[ $found == *"$words"* ]] || complain "'$words' is not found"
done
((failures == 0)) && echo 'the recipe of the container is one'
exit $((failures > 0))
