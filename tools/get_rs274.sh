#!/bin/sh
# Fetches parts of LinuxCNC from the Debian packages into .deps/rs274, nothing is installed: the stand-alone interpreter
# rs274, the kinematics modules, and what runs the motion controller without a display (tests/controller).
# The tests use them as second opinions on the programs that we write. Run again: does nothing when they are there.
#
# LinuxCNC whole would bring a desktop. Which libraries the few programs need, the dynamic linker says (ldd); which package
# has them, the Depends of LinuxCNC's package; what those packages need in turn and this machine lacks, apt.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
target="$root/.deps/rs274"
work="$root/.deps/rs274.part"
export LC_ALL=C

fail() { echo "get_rs274: $*" >&2; exit 1; }

# absent FOLDER: the libraries that its programs and modules need and the linker does not find.
absent() {
  for file in "$1/rs274.bin" "$1"/bin/* "$1"/modules/* "$1"/python/* "$1"/lib/*; do
    [ ! -f "$file" ] || LD_LIBRARY_PATH="$1/lib" ldd "$file" 2>&1
  done | sed -n 's/^[[:space:]]*\([^ ]*\) => not found.*/\1/p' | sort -u
}

# packages_of LIBRARY: packages of LinuxCNC's Depends with its name: libfoo.so.3 is in libfoo3, libfoo_bar311.so.1 in libfoo-bar1.
packages_of() {
  stem=$(echo "${1%%.so*}" | tr 'A-Z_' 'a-z-' | sed 's/\([a-z]\)[0-9]*$/\1/')
  awk -v stem="$stem" 'index($0, stem) == 1 && substr($0, length(stem) + 1) !~ /^[a-z]/' "$work/depends"
}

# unpack: every package in debs, once.
unpack() {
  for deb in "$work"/debs/*.deb; do
    [ -f "$deb" ] || continue
    dpkg -x "$deb" "$work/x"
    rm "$deb"
  done
}

# fetch PACKAGE..: these and all that they need and this machine lacks, as apt resolves it. Needs no root: nothing is locked.
fetch() {
  apt-get -q -y --no-install-recommends --download-only -o Debug::NoLocking=1 -o Dir::Cache::archives="$work/debs" install "$@" \
    >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "apt cannot fetch $* (apt-get update needed?)"; }
  unpack
}

# keep LIBRARY: copies it to the programs, under the name that they ask for; false where no unpacked package has it.
keep() {
  found=$(find "$work/x" -name "$1" ! -type d | head -n 1)
  [ -n "$found" ] && cp -L "$found" "$work/keep/lib/$1"
}

# works FOLDER: all parts and libraries are there and the interpreter runs a program.
works() {
  [ -f "$1/modules/xyzac-trt-kins.so" ] && [ -f "$1/modules/hal_lib.so" ] && [ -x "$1/rs274" ] || return 1
  [ -z "$(absent "$1")" ] || return 1
  printf 'G0 X1\nM2\n' >"$work/try.ngc"
  : >"$work/try.tbl"
  : >"$work/try.var"
  (cd "$work" && HOME="$work" "$1/rs274" -g -t try.tbl -v try.var try.ngc) >"$work/log" 2>&1
}

mkdir -p "$work"
if works "$target"; then
  rm -rf "$work"
  exit 0
fi
for tool in apt-get dpkg ldd; do
  command -v "$tool" >/dev/null || fail "$tool not found; rs274 comes from Debian packages"
done
rm -rf "$work"
mkdir -p "$work/debs/partial" "$work/x" "$work/keep/lib" "$work/keep/modules" "$work/keep/bin" "$work/keep/python"
(cd "$work/debs" && apt-get -q download linuxcnc-uspace >"$work/log" 2>&1) \
  || { cat "$work/log" >&2; fail "apt cannot fetch linuxcnc-uspace (apt-get update needed?)"; }
dpkg-deb -f "$work"/debs/linuxcnc-uspace_*.deb Depends | tr ',' '\n' | sed 's/^ *//; s/[ :(|].*//' | sort -u >"$work/depends"
unpack

for name in hal_lib xyzac-trt-kins xyzbc-trt-kins motmod tpmod homemod sampler; do
  cp "$work/x/usr/lib/linuxcnc/modules/$name.so" "$work/keep/modules/"
done
for name in rtapi_app halcmd halsampler milltask linuxcncsvr io; do
  cp "$work/x/usr/bin/$name" "$work/keep/bin/"
  chmod 755 "$work/keep/bin/$name"   # the packages' copies are setuid: ours run as whoever calls them
done
cp "$work"/x/usr/lib/python3/dist-packages/linuxcnc.*.so "$work/keep/python/"
cp "$work/x/usr/share/linuxcnc/linuxcnc.nml" "$work/keep/"
cp "$work/x/usr/bin/rs274" "$work/keep/rs274.bin"
cat > "$work/keep/rs274" <<'SH'
#!/bin/sh
here=$(cd "$(dirname "$0")" && pwd)
[ ! -d "$here/python3" ] || export PYTHONHOME="$here/python3"
LD_LIBRARY_PATH="$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" exec "$here/rs274.bin" "$@"
SH
chmod +x "$work/keep/rs274"

# Libraries until none is absent: from what is unpacked, else from the packages of LinuxCNC's Depends with their name.
fetched=" "
while libraries=$(absent "$work/keep"); [ -n "$libraries" ]; do
  packages=""
  for library in $libraries; do
    keep "$library" && continue
    for package in $(packages_of "$library"); do
      case "$fetched" in *" $package "*) ;; *) packages="$packages $package"; fetched="$fetched$package " ;; esac
    done
  done
  # shellcheck disable=SC2086
  if [ -n "$packages" ]; then fetch $packages; continue; fi
  libraries_then=$libraries
  libraries=$(absent "$work/keep")
  [ "$libraries" != "$libraries_then" ] || fail "no package that linuxcnc-uspace depends on has: $(echo "$libraries" | tr '\n' ' ')"
done

# The interpreter starts Python, whose own modules came with its library where this machine has none. Where it has a part of
# them, the packages bring the rest: both parts together are what it starts with.
for modules in "$work"/x/usr/lib/python3.*; do
  [ -d "$modules" ] || continue
  mkdir -p "$work/keep/python3/lib"
  [ ! -d "/usr/lib/${modules##*/}" ] || cp -r "/usr/lib/${modules##*/}" "$work/keep/python3/lib/"
  cp -r "$modules" "$work/keep/python3/lib/"
done
works "$work/keep" || { cat "$work/log" >&2; fail "what was fetched does not run"; }
rm -rf "$target"
mv "$work/keep" "$target"
rm -rf "$work"
