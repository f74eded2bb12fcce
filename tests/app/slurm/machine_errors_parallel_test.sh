#!/bin/sh
# machine_errors_parallel_test.sh TOOTHPATH SOURCES: the script of samples/studies gives the bytes of one process.
set -eu
export TOOTHPATH=$1
sources=$2
here=$(dirname "$0")
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
job=$sources/samples/spur_quick.toml
options="--samples 2 --only --error C.pivot=5 --error tool.length=5 --error tool.radius=3"
command -v parallel >/dev/null || { echo "GNU parallel is not installed (Debian package parallel)" >&2; exit 1; }
"$TOOTHPATH" study machine-errors "$job" --out "$dir/one" $options --quiet
HOME=$dir SHARDS=3 "$sources/samples/studies/machine_errors_parallel.sh" "$job" "$dir/out" $options --quiet
ls "$dir/out"
for i in 1 2 3; do test -s "$dir/out/samples.${i}of3.jsonl"; done
for file in samples.jsonl machine_errors.csv machine_errors.json machine_errors.html; do
  cmp "$dir/one/$file" "$dir/out/$file"
done
