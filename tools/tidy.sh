#!/usr/bin/env bash
# clang-tidy (.clang-tidy: what is a fault wherever it stands) over everything that is built into the program: tools/tidy.sh [BUILD_DIR], default build/ci,
# built. Merged sources are read merged, which takes a fifth of the time. A source is read again when its object
# or what is asked is newer than its last clean reading.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=$(realpath "${1:-build/ci}")
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
