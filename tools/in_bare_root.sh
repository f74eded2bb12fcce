#!/usr/bin/env bash
# Proves ./run and ./check on a bare Debian 12, where nothing was installed before: makes a root with debootstrap, clones this repository
# (what is committed) into it, runs both there and prints their times:
#   tools/in_bare_root.sh [ROOT [COMMAND ..]]     as root; needs debootstrap and git
# ROOT: a folder that does not exist yet, kept afterwards; without it one in TMPDIR that is removed. COMMAND: instead of ./run and ./check.
# Mirror, ways to it and trusted certificates are those of this machine.
set -euo pipefail
repo=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
release=bookworm  # Debian 12
fail() { echo "in_bare_root: $*" >&2; exit 2; }

[[ $(id -u) == 0 ]] || fail "must run as root: debootstrap and chroot"
for tool in debootstrap git unshare; do command -v "$tool" >/dev/null || fail "$tool is missing"; done
# shellcheck disable=SC2016  # apt fills the fields in
mirror=$(apt-get indextargets --format '$(RELEASE) $(COMPONENT) $(SITE)' 'Created-By: Packages' | awk -v r="$release" '$1 == r && $2 == "main" {print $3; exit}')
[[ -n $mirror ]] || fail "apt of this machine knows no mirror of $release"

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

debootstrap --variant=minbase --include=ca-certificates,git "$release" "$root" "$mirror" >"$root.log" 2>&1 || { tail -n 20 "$root.log" >&2; fail "debootstrap failed"; }
rm "$root.log"
apt-config dump --no-empty | grep -E '^Acquire::(http|https|Check-|Retries|Force)' >"$root/etc/apt/apt.conf.d/99mirror" || true
cp -L /etc/resolv.conf /etc/hosts "$root/etc/"
certificates=etc/ssl/certs/ca-certificates.crt
[[ ! -f /$certificates ]] || cp -L "/$certificates" "$root/$certificates"
git clone -q --no-hardlinks "$repo" "$root/toothpath"

# timed COMMAND: in the root, with /proc, /dev and processes of its own that end with it.
timed() {
  local TIMEFORMAT="$1: wall %R s, CPU %U + %S s"
  # shellcheck disable=SC2016  # the inner shell fills them in
  time unshare --mount --pid --fork --kill-child bash -c '
    set -e
    mount --make-rprivate /
    mount -t proc proc "$0/proc"
    mount --rbind /dev "$0/dev"
    exec chroot "$0" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 NODE_EXTRA_CA_CERTS="/$1" bash -c "cd /toothpath && $2"' \
    "$root" "$certificates" "$1"
}

status=0
for command in "${commands[@]}"; do
  echo "== $command" >&2
  timed "$command" || { echo "$command: exit code $?" >&2; status=1; }
done
exit $status
