#!/usr/bin/env bash
# Every reader of the program under clang's libFuzzer, with the address and undefined-behaviour sanitizers (preset fuzz), one after the other:
# tools/fuzz.sh [SECONDS [READER ..]]; SECONDS for each reader, default 60. What is found lies in build/fuzz/found, what was learnt in build/fuzz/corpus
# (a second call goes on from there). Ends with 1 when any reader failed. docs/sanitizers.md holds the last result.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
seconds=${1:-60}
readers=("${@:2}")
source tools/packages.sh
need_packages "${build_packages[@]}" libgtest-dev "${fuzz_packages[@]}"
export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1:detect_odr_violation=0
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1

cmake --preset fuzz >&2
cmake --build build/fuzz -j2 --target toothpath_libfuzzer >&2
fuzzer=build/fuzz/tests/fuzz/toothpath_libfuzzer
((${#readers[@]})) || mapfile -t readers < <("$fuzzer" --readers)
failed=0
for reader in "${readers[@]}"; do
  corpus=build/fuzz/corpus/$reader found=build/fuzz/found/$reader log=build/fuzz/found/$reader.log
  mkdir -p "$corpus" "$found"
  if TOOTHPATH_READER=$reader "$fuzzer" "$corpus" -max_total_time="$seconds" -max_len=65536 -timeout=20 -rss_limit_mb=4096 \
    -artifact_prefix="$found/" -print_final_stats=1 &>"$log"; then
    awk -v reader="$reader" '/^stat::number_of_executed_units/ {runs = $2} /cov: / {for (k = 1; k < NF; ++k) if ($k == "cov:") cover = $(k + 1)}
      END {printf "%-20s %9d inputs, %6d edges met, no report\n", reader, runs, cover}' "$log"
  else
    failed=1
    printf '%-20s FAILED: %s\n' "$reader" "$log"
  fi
done
exit "$failed"
