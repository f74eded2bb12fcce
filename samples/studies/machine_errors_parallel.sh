#!/bin/sh
# `toothpath study machine-errors` on all cores of one computer by GNU parallel, a shard a core, and merged.
#
#     samples/studies/machine_errors_parallel.sh JOB.toml DIR [more options of the study]
#
# SHARDS=n cuts it otherwise. More computers that see DIR: PARALLEL="--sshlogin a,b --workdir ." in the environment.
# A run that was stopped goes on where it stood.
set -eu
if [ $# -lt 2 ]; then
  echo "usage: $0 JOB.toml DIR [options]" >&2
  exit 2
fi
job=$1 out=$2
shift 2
shards=${SHARDS:-$(nproc)}
toothpath=${TOOTHPATH:-toothpath}
seq "$shards" | parallel --halt soon,fail=1 \
  "$toothpath" study machine-errors "$job" --out "$out" --threads 1 --shard "{}/$shards" "$@"
"$toothpath" study merge "$out"
