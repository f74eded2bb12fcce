#!/usr/bin/env bash
# The ten suites that took longest when the tests of a build folder ran last, in seconds, each with the reason that tests/slow_suites.txt gives:
# tools/slowest_suites.sh [BUILD_DIR], default build/ci.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
costs=${1:-$root/build/ci}/Testing/Temporary/CTestCostData.txt
[[ -f $costs ]] || { echo "no tests ran in ${1:-build/ci} yet: ./check" >&2; exit 2; }
sed '/^---/,$d' "$costs" | sort -k3 -rn | sed -n 1,10p | while read -r suite _ seconds; do
  reason=$(awk -F ' *[|] *' -v suite="$suite" '$1 == suite {print $3}' "$root/tests/slow_suites.txt")
  printf '%-44s %7.1f  %s\n' "$suite" "$seconds" "$reason"
done
