#!/usr/bin/env bash
# One format for all C++ files (.clang-format, width 120): tools/format.sh formats, tools/format.sh --check names what is not formatted and exits with 1.
# Programs of the golden tests are no C++.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mode=(-i)
[[ ${1:-} != --check ]] || mode=(--dry-run --Werror)
status=0
find app cam geometry machines postproc tests -name '*.h' -print0 -o -name '*.cpp' -print0 -o -name '*.inl' -print0 |
  xargs -0 -r -P 2 -n 60 clang-format "${mode[@]}" || status=1
((status == 0)) || echo "not formatted: tools/format.sh mends it" >&2
exit $status
