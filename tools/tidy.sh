#!/usr/bin/env bash
# clang-tidy (.clang-tidy: what is a fault wherever it stands) over what is built into the program: tools/tidy.sh [--changed] [BUILD_DIR], default
# build/ci, built. Merged sources are read merged, which takes a fifth of the time. A source is read again when its object or what is asked is
# newer than its last clean reading. --changed: in a folder where nothing was read yet nothing is read; a first reading takes a quarter of an
# hour of processor (ctest -C Nightly -L tidy, or this script).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
changed=no
[[ ${1:-} != --changed ]] || { changed=yes; shift; }
build=$(realpath "${1:-build/ci}")
if [[ $changed == yes && ! -d $build/tidy ]]; then
  echo "clang-tidy: nothing was read in this build folder yet; tools/tidy.sh reads everything" >&2
  exit 0
fi
mkdir -p "$build/tidy"
export build

read_one() {
  local file=$1 object=$2 stamp
  stamp="$build/tidy/${object//\//_}.clean"
  [[ ! "$build/$object" -nt $stamp && ! .clang-tidy -nt $stamp ]] && return 0
  if clang-tidy -p "$build" --quiet --warnings-as-errors='*' --extra-arg=-Wno-everything --extra-arg=-Wno-unknown-warning-option "$file" >"$stamp.log" 2>/dev/null; then
    touch "$stamp"
    rm -f "$stamp.log"
  else
    cat "$stamp.log"
    return 1
  fi
}
export -f read_one

# Sources and their objects, without the tests. The compilation database has one command a line.
sed -n 's/^ *"command": .* -o \([^ ]*\) -c \([^ ]*\)",$/\2 \1/p' "$build/compile_commands.json" | grep -v ' tests/' |
  xargs -P "$(nproc)" -n 2 bash -c 'read_one "$@"' _
