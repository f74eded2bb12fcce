#!/bin/sh
# shards_parallel_test.sh TOOTHPATH SOURCES: the script of samples/studies gives the bytes of one process.
. "$(dirname "$0")/same_bytes.sh"
command -v parallel >/dev/null || { echo "GNU parallel is not installed (Debian package parallel)" >&2; exit 1; }
HOME=$dir SHARDS=3 "$sources/samples/studies/shards_parallel.sh" "$dir/out" $study --quiet
same_bytes 3
