#!/usr/bin/env bash
# Builds test programs with the address and undefined-behaviour sanitizers (preset asan-ubsan) and runs them: tools/sanitized.sh [PROGRAM ..]; default:
# the readers on damaged bytes, and the tests of the rooms that read files. docs/sanitizers.md holds the last result.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
programs=("$@")
((${#programs[@]})) || programs=(toothpath_fuzz_tests toothpath_machines_tests toothpath_mesh_tests toothpath_postproc_tests toothpath_post_tests)
export TOOTHPATH_FUZZ_RUNS=${TOOTHPATH_FUZZ_RUNS:-20000}
export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1

cmake --preset asan-ubsan
cmake --build build/asan-ubsan -j2 --target "${programs[@]}"
for program in "${programs[@]}"; do
  binary=$(find build/asan-ubsan/tests -type f -executable -name "$program")
  "$binary" --gtest_brief=1
  echo "$program: no report of a sanitizer"
done
