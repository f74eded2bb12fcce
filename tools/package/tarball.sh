#!/usr/bin/env bash
# The program as one folder that runs without root rights on any distribution with this glibc or a newer one: every library but glibc is in it,
# found from where the folder stands ($ORIGIN). Target `tarball` of the preset `package`.
#   tarball.sh BUILD_FOLDER NAME [--tree FOLDER]
# Writes BUILD_FOLDER/NAME.tar.gz with the folder NAME in it; with --tree that folder alone, which must not exist.
# Needs patchelf, binutils. What is missing from the bundle is told (bundle_check.sh), exit code 1.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/bundle_check.sh"
build=$(realpath "$1") name=$2 work='' tree=''
if [[ ${3:-} == --tree ]]; then tree=$4; else
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  tree=$work/$name
fi
fail() { echo "tarball: $*" >&2; exit 1; }
[[ ! -e $tree ]] || fail "$tree exists already"
command -v patchelf >/dev/null || fail "patchelf is missing: apt-get install patchelf"

for component in program licence; do
  cmake --install "$build" --prefix "$tree" --component "$component" --strip >/dev/null
done
libraries=$tree/lib/toothpath
programs=("$tree/bin/toothpath" "$libraries"/modules/*.so)

# What the loader of this machine takes for them, but for glibc; with the licence of each package they come from.
licences=$tree/share/doc/toothpath/libraries
mkdir -p "$licences"
declare -A places packages
while read -r library path; do
  [[ $path == /* ]] || fail "$library is not on this machine"
  is_of_glibc "$library" || places[$library]=$path
done < <(ldd "${programs[@]}" | awk '$2 == "=>" {print $1, $3}' | sort -u)
mapfile -t real < <(realpath "${places[@]}")
while IFS=: read -r package _ path; do packages[${path# }]=$package; done < <(dpkg-query -S "${real[@]}" "${real[@]#/usr}" 2>/dev/null | sed 's/^\([^:]*\): /\1:any: /')
for library in "${!places[@]}"; do
  path=$(realpath "${places[$library]}")
  package=${packages[$path]:-${packages[${path#/usr}]:-}}
  [[ -n $package ]] || fail "$path is of no Debian package: whose licence holds for it?"
  cp "$path" "$libraries/$library"
  [[ -e $licences/$package.copyright ]] || cp -L "/usr/share/doc/$package/copyright" "$licences/$package.copyright"
  echo "$library $package"
done | sort >"$licences/list.txt"
dpkg-query -W -f '${Package} ${Version}\n' $(cut -d' ' -f2 "$licences/list.txt" | sort -u) >"$licences/versions.txt"

chmod -R u+w,go+rX "$libraries"
# DT_RPATH, not DT_RUNPATH: it holds for the libraries of a library, too, and LD_LIBRARY_PATH does not come before it.
patchelf --force-rpath --set-rpath "\$ORIGIN/../lib/toothpath" "$tree/bin/toothpath"
patchelf --force-rpath --set-rpath "\$ORIGIN/.." "$libraries"/modules/*.so
patchelf --force-rpath --set-rpath "\$ORIGIN" "$libraries"/*.so*

check_bundle "$tree" >"$licences/needs.txt" || fail "the bundle is not whole"
cat "$licences/needs.txt"
[[ -n $work ]] || exit 0
tar -C "$work" --sort=name --owner=0 --group=0 --numeric-owner --mtime="@${SOURCE_DATE_EPOCH:-$(date +%s)}" -cf - "$name" | gzip -9n >"$build/$name.tar.gz.part"
mv "$build/$name.tar.gz.part" "$build/$name.tar.gz"
echo "$build/$name.tar.gz: $(du -h --apparent-size "$build/$name.tar.gz" | cut -f1)"
