#!/bin/sh
# machine_errors_slurm_test.sh TOOTHPATH SOURCES: the script of samples/studies gives the bytes of one process. Exit 77:
# skipped, and why.
set -eu
export TOOTHPATH=$1
sources=$2
here=$(dirname "$0")
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
job=$sources/samples/spur_quick.toml
options="--samples 2 --only --error C.pivot=5 --error tool.length=5 --error tool.radius=3"
"$TOOTHPATH" study machine-errors "$job" --out "$dir/one" $options --quiet
# The array as people submit it, and the merge that waits for it.
cat >"$dir/submit.sh" <<SUBMIT
set -eu
cd "$dir"
sbatch -o "$dir/task.%a" "$sources/samples/studies/machine_errors.slurm" "$job" "$dir/out" $options
sbatch --wait -o "$dir/merge" --dependency=singleton --job-name=machine-errors \
  --wrap "'$TOOTHPATH' study merge '$dir/out'" || { cat "$dir"/task.* "$dir/merge"; exit 1; }
SUBMIT
"$here/one_node.sh" "$dir/slurm" sh "$dir/submit.sh"
ls "$dir/out"
for i in 1 2 3 4 5 6 7 8; do test -s "$dir/out/samples.${i}of8.jsonl"; done
for file in samples.jsonl machine_errors.csv machine_errors.json machine_errors.html; do
  cmp "$dir/one/$file" "$dir/out/$file"
done
