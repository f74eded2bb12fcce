#!/usr/bin/env bash
# Proves ./run and ./check on a bare Debian 12, where nothing was installed before: makes a root with debootstrap, clones this repository
# (what is committed) into it, runs both there and prints their times:
#   tools/in_bare_root.sh [ROOT [COMMAND ..]]     as root; needs debootstrap and git
# ROOT: a folder that does not exist yet, kept afterwards; without it one in TMPDIR that is removed. COMMAND: instead of ./run and ./check.
set -euo pipefail
repo=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$repo/tools/bare_root.sh"
fail() { echo "in_bare_root: $*" >&2; exit 2; }
problem=$(bare_root_problem)
[[ -z $problem ]] || fail "$problem"
command -v git >/dev/null || fail "git is missing"

if [[ $# -gt 0 ]]; then
  root=$1
  shift
  [[ ! -e $root ]] || fail "$root exists already: a root that was used is not bare"
else
  root=$(mktemp -d -t toothpath_root.XXXXXX)
  trap 'rm -rf --one-file-system "$root"' EXIT
fi
commands=("$@")
((${#commands[@]})) || commands=(./run ./check)

make_bare_root "$root" ca-certificates,git || fail "debootstrap failed"
git clone -q --no-hardlinks "$repo" "$root/toothpath"

# timed COMMAND: in the root.
timed() {
  local TIMEFORMAT="$1: wall %R s, CPU %U + %S s"
  time in_root "$root" /toothpath "$1"
}

status=0
for command in "${commands[@]}"; do
  echo "== $command" >&2
  timed "$command" || { echo "$command: exit code $?" >&2; status=1; }
done
exit $status
