# Sourced by the tests of a way to run shards, with TOOTHPATH and SOURCES as arguments: one process makes $dir/one;
# same_bytes N: what N shards and the merge made in $dir/out is the same.
set -eu
export TOOTHPATH=$1
sources=$2
here=$(dirname "$0")
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
study="machine-errors $sources/samples/spur_quick.toml --samples 2 --only --error C.pivot=5 --error tool.length=5 --error tool.radius=3"
"$TOOTHPATH" study $study --out "$dir/one" --quiet
same_bytes() {
  ls "$dir/out"
  for i in $(seq "$1"); do test -s "$dir/out/samples.${i}of$1.jsonl"; done
  for file in samples.jsonl machine_errors.csv machine_errors.json machine_errors.html; do
    cmp "$dir/one/$file" "$dir/out/$file"
  done
}
