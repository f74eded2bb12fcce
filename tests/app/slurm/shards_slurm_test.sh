#!/bin/sh
# shards_slurm_test.sh TOOTHPATH SOURCES: the script of samples/studies gives the bytes of one process. Exit 77:
# Slurm does not start here, and why.
. "$(dirname "$0")/same_bytes.sh"
# The array as people submit it, and the merge that waits for it.
cat >"$dir/submit.sh" <<SUBMIT
set -eu
cd "$dir"
sbatch -o "$dir/task.%a" "$sources/samples/studies/shards.slurm" "$dir/out" $study
sbatch --wait -o "$dir/merge" --dependency=singleton --job-name=toothpath-study \
  --wrap "'$TOOTHPATH' study merge '$dir/out'" || { cat "$dir"/task.* "$dir/merge"; exit 1; }
SUBMIT
"$here/one_node.sh" "$dir/slurm" sh "$dir/submit.sh"
same_bytes 8
