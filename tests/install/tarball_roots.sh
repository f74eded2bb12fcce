#!/usr/bin/env bash
# The tarball of the preset `package` in bare roots of Debian releases, where none of its libraries is installed: unpacked and run by a user without
# rights, moved, its program the same bytes as here. Prints a line a release.
#   tests/install/tarball_roots.sh [--tarball FILE] [RELEASE ..]
# Default: bookworm trixie. A release with an older glibc than the tarball needs must refuse to start it: bullseye.
# Needs root rights and debootstrap (tools/bare_root.sh). Exit code 77: no root can be made here.
set -euo pipefail
repo=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$repo/tools/bare_root.sh"
fail() { echo "tarball_roots: $*" >&2; exit 1; }

tarball='' releases=()
while (($#)); do
  case $1 in
    --tarball) tarball=$(realpath "$2"); shift 2 ;;
    -*) sed -n '2,6s/^# \?//p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
    *) releases+=("$1"); shift ;;
  esac
done
((${#releases[@]})) || releases=(bookworm trixie)
problem=$(bare_root_problem)
[[ -z $problem ]] || { echo "tarball_roots: $problem" >&2; exit 77; }
if [[ -z $tarball ]]; then
  (cd "$repo" && cmake --preset package >/dev/null && cmake --build build/package --target tarball)
  tarball=$(ls "$repo"/build/package/toothpath-*-linux-*.tar.gz)
fi
name=$(basename "$tarball" .tar.gz)
work=$(mktemp -d -t toothpath_roots.XXXXXX)
trap 'rm -rf --one-file-system "$work"' EXIT
tar -C "$work" -xf "$tarball"
samples=share/doc/toothpath/samples
env -i "$work/$name/bin/toothpath" run "$work/$name/$samples/spur_quick.toml" --out "$work/here" --quiet
needed=$(sed 's/^glibc \([0-9.]*\) .*/\1/' "$work/$name/share/doc/toothpath/libraries/needs.txt")

for bare_release in "${releases[@]}"; do
  root=$work/$bare_release
  cached_bare_root "$root" ca-certificates "$repo/.deps/bare_root_$bare_release.tar"
  home=/home/shop
  install -d -m 777 "$root$home"
  cp "$tarball" "$root$home/"
  as_user() { in_root "$root" "$home" "setpriv --reuid 12345 --regid 12345 --clear-groups env -i HOME=$home bash -c '$1'"; }
  glibc=$(in_root "$root" / "ldd --version | sed -n '1s/.* //p'")
  as_user "tar xf $name.tar.gz && mv $name gears"
  if [[ $(printf '%s\n' "$needed" "$glibc" | sort -V | head -n 1) != "$needed" ]]; then
    ! as_user "gears/bin/toothpath --version" >"$work/said" 2>&1 || fail "$bare_release: runs with glibc $glibc, though it needs $needed"
    grep -q "GLIBC_" "$work/said" || fail "$bare_release: $(cat "$work/said")"
    echo "$bare_release: glibc $glibc, refused: the tarball needs $needed"
    continue
  fi
  as_user "gears/bin/toothpath run gears/$samples/spur_quick.toml --out out --quiet && gears/bin/toothpath surface gears/$samples/cylindrical_spur.toml --step --out surface --quiet &&
    gears/bin/toothpath fit gears/$samples/cylindrical_spur.toml --points surface/inspection.csv --out fit --quiet" || fail "$bare_release: a command failed"
  cmp "$work/here/program.ngc" "$root$home/out/program.ngc" || fail "$bare_release: another program than here"
  echo "$bare_release: glibc $glibc, runs without root rights, the program is that of this machine"
done
