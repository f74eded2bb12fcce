#!/bin/sh
# A study on all cores of one computer by GNU parallel, a shard a core, and merged.
#
#     samples/studies/shards_parallel.sh DIR machine-errors JOB.toml [more options of the study]
#     samples/studies/shards_parallel.sh DIR dhfg [--file STUDY.toml]
#
# SHARDS=n cuts it otherwise. More computers that see DIR: PARALLEL="--sshlogin a,b --workdir ." in the environment.
# A run that was stopped goes on where it stood.
set -eu
if [ $# -lt 2 ]; then
  echo "usage: $0 DIR STUDY [options of the study]" >&2
  exit 2
fi
out=$1
shift
shards=${SHARDS:-$(nproc)}
toothpath=${TOOTHPATH:-toothpath}
seq "$shards" | parallel --halt soon,fail=1 \
  "$toothpath" study "$@" --out "$out" --threads 1 --shard "{}/$shards"
"$toothpath" study merge "$out"
