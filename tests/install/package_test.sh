#!/usr/bin/env bash
# The Debian packages and the tarball of a build, without root rights and without a network: what is in them and where, what lintian says; installed into an
# empty tree by dpkg, a sample run by the installed program, removed without a trace. The tarball has every library that it needs. In clean roots:
# tests/first_hour, tests/install/tarball_roots.sh.
#   package_test.sh BUILD_FOLDER
set -euo pipefail
build=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "package_test: $*" >&2; exit 1; }

(cd "$work" && cpack --config "$build/CPackConfig.cmake" >cpack.log 2>&1) || { cat "$work/cpack.log" >&2; fail "cpack"; }
shopt -s nullglob
packages=("$work"/toothpath_*.deb)
modules=("$work"/python3-toothpath_*.deb)
((${#packages[@]} == 1)) || fail "cpack made ${#packages[@]} packages of the program"
program=${packages[0]}

# Every file where the standard of the file system has its kind, and every kind there.
kinds=(usr/bin/toothpath usr/share/man/man1/toothpath.1.gz usr/share/bash-completion/completions/toothpath
  usr/share/zsh/vendor-completions/_toothpath usr/share/fish/vendor_completions.d/toothpath.fish
  usr/share/doc/toothpath/README.md usr/share/doc/toothpath/copyright usr/share/doc/toothpath/changelog.gz
  'usr/share/doc/toothpath/docs/.*' 'usr/share/doc/toothpath/samples/.*\.(toml|md|slurm|sh)' 'usr/share/toothpath/machines/[a-z0-9_]*\.toml'
  'usr/share/toothpath/schema/[a-z]*\.schema\.json' usr/lib/toothpath/modules/toothpath_least_squares.so)
files=$(dpkg-deb --fsys-tarfile "$program" | tar t | sed 's|^\./||' | grep -v '/$')
for kind in "${kinds[@]}"; do grep -qxE "$kind" <<<"$files" || fail "no $kind in the package"; done
others=$(grep -vxE "$(IFS='|'; echo "${kinds[*]}")" <<<"$files" || true)
[[ -z $others ]] || fail "in the package, but in no place for it: $others"
source=$(cd "$(dirname "$0")/../.." && pwd)
for folder in samples machines/data; do
  for file in "$source/$folder"/*.toml; do grep -q "/${file##*/}\$" <<<"$files" || fail "no ${file##*/} in the package"; done
done
! dpkg-deb -f "$program" Depends | grep -q python || fail "the program depends on Python"

lintian --no-cfg --fail-on error,warning "$program" "${modules[@]}" >"$work/lintian.log" 2>&1 || { cat "$work/lintian.log" >&2; fail "lintian"; }

# An empty tree with dpkg's own records, and nothing else.
root=$work/root
mkdir -p "$root"/var/lib/dpkg/{info,updates} && touch "$root/var/lib/dpkg/status"
in_tree() { dpkg --root="$root" --log="$work/dpkg.log" --force-not-root --force-bad-path --force-depends "$@" >"$work/dpkg.out" 2>&1 || { cat "$work/dpkg.out" >&2; fail "dpkg $*"; }; }
tree() { (cd "$root" && find . ! -path './var/lib/dpkg/*' | sort); }
before=$(tree)
in_tree --install "$program"

installed=$root/usr/bin/toothpath
touch "$root/usr/share/toothpath/machines/only_here.toml"
"$installed" completion machines | grep -x only_here >/dev/null || fail "the installed program does not look for machines beside itself"
rm "$root/usr/share/toothpath/machines/only_here.toml"
for shell in bash:bash-completion/completions/toothpath zsh:zsh/vendor-completions/_toothpath fish:fish/vendor_completions.d/toothpath.fish; do
  cmp -s "$root/usr/share/${shell#*:}" <("$installed" completion "${shell%%:*}") || fail "completion of ${shell%%:*} is not that of the program"
done
zcat "$root/usr/share/man/man1/toothpath.1.gz" | cmp -s - <("$installed" man-page) || fail "the manual page is not that of the program"
zcat "$root/usr/share/doc/toothpath/changelog.gz" | dpkg-parsechangelog -l - -S Version | grep -qx "$(dpkg-deb -f "$program" Version)" || fail "changelog"
"$installed" run "$root/usr/share/doc/toothpath/samples/spur_quick.toml" --out "$work/out" --quiet || fail "the sample"
[[ -s $work/out/program.ngc && -s $work/out/report.html ]] || fail "no program and report of the sample"
spur=$root/usr/share/doc/toothpath/samples/cylindrical_spur.toml
{ "$installed" surface "$spur" --out "$work/spur" --quiet && "$installed" fit "$spur" --points "$work/spur/inspection.csv" --out "$work/fit" --quiet; } ||
  fail "the installed program does not open its library of least squares"

# What an editor is told in the first line of the files that people copy and of those that `new` writes is there.
"$installed" new --gear face --cut shaped --machine y514 --teeth 60 --module 2 -o "$work/new.toml" --quiet || fail "new"
for file in "$root"/usr/share/doc/toothpath/samples/*.toml "$root"/usr/share/toothpath/machines/*.toml "$work/new.toml"; do
  schema=$(sed -n '1s|^#:schema ||p' "$file")
  case $schema in
    file://*) path=${schema#file://} ;;
    ?*) path=${file%/*}/$schema ;;
    *) fail "${file##*/} names no schema" ;;
  esac
  [[ -s $path && $(realpath "$path") == "$(realpath "$root")"/* ]] || fail "${file##*/}: there is no $schema in the package"
done

for module in "${modules[@]}"; do
  in_tree --install "$module"
  PYTHONPATH=$root/usr/lib/python3/dist-packages /usr/bin/python3 -c '
import sys, toothpath
assert toothpath.__file__.startswith(sys.argv[1])
assert toothpath.Gear(sys.argv[2]).flanks()[0].points.shape == (5, 9, 3)' "$root" "$root/usr/share/doc/toothpath/samples/spur_quick.toml" || fail "the Python module"
  in_tree --purge python3-toothpath
done

in_tree --purge toothpath
[[ $(tree) == "$before" ]] || fail "left behind: $(diff <(echo "$before") <(tree))"
# The folder of the tarball: whole, where it is made and where it is moved to; a library that is missing or looked for elsewhere is told.
bundle=$work/bundle
tarball=$source/tools/package/tarball.sh
"$tarball" "$build" toothpath --tree "$work/made" >"$work/tarball.log" 2>&1 || { cat "$work/tarball.log" >&2; fail "tarball"; }
mv "$work/made" "$bundle"
source "$source/tools/package/bundle_check.sh"
needs=$(check_bundle "$bundle") || fail "the tarball is not whole"
[[ -s $bundle/share/doc/toothpath/LICENSE && -s $bundle/share/doc/toothpath/libraries/libgmp10.copyright ]] || fail "no licences in the tarball"
elsewhere=$(env -i /usr/bin/ldd "$bundle/bin/toothpath" "$bundle"/lib/toothpath/modules/*.so | awk '$2 == "=>" {print $1, $3}' | while read -r library path; do
  is_of_glibc "$library" || [[ $(realpath "$path") == "$(realpath "$bundle")"/* ]] || echo "$library $path"; done)
[[ -z $elsewhere ]] || fail "the program of the tarball takes libraries of this machine: $elsewhere"
env -i "$bundle/bin/toothpath" run "$bundle/share/doc/toothpath/samples/spur_quick.toml" --out "$work/of_bundle" --quiet || fail "the sample by the program of the tarball"
cmp -s "$work/of_bundle/program.ngc" "$work/out/program.ngc" || fail "the tarball makes another program"
env -i "$bundle/bin/toothpath" fit "$bundle/share/doc/toothpath/samples/cylindrical_spur.toml" --points "$work/spur/inspection.csv" --out "$work/fit_of_bundle" --quiet ||
  fail "the program of the tarball does not open its library of least squares"
told() { ! check_bundle "$bundle" >/dev/null 2>"$work/told" && grep -q "$1" "$work/told" || fail "check_bundle does not tell $1: $(cat "$work/told")"; }
mv "$bundle/lib/toothpath/libgmp.so.10" "$work/"
told 'libgmp.so.10 is missing, bin/toothpath needs it'
mv "$work/libgmp.so.10" "$bundle/lib/toothpath/"
for path in '/usr/lib' "\$ORIGIN/../../.."; do
  patchelf --force-rpath --set-rpath "$path" "$bundle/lib/toothpath/libzip.so.4"
  told 'lib/toothpath/libzip.so.4 looks for libraries in'
done
patchelf --force-rpath --set-rpath "\$ORIGIN" "$bundle/lib/toothpath/libzip.so.4"
check_bundle "$bundle" >/dev/null || fail "the tarball is not whole any more"

echo "tarball: $needs"
echo "packages: $(cd "$work" && du -h --apparent-size ./*.deb | tr '\t\n' '  ')"
