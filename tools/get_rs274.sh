#!/bin/sh
# Fetches LinuxCNC's stand-alone interpreter rs274 from the Debian packages into .deps/rs274, nothing is installed.
# The tests use it as a second opinion on the programs that we write. Run again: does nothing when it is there.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
target="$root/.deps/rs274"
if [ -x "$target/rs274" ]; then
  exit 0
fi
for tool in apt-get dpkg; do
  command -v "$tool" >/dev/null || { echo "get_rs274: $tool not found; rs274 comes from Debian packages" >&2; exit 1; }
done
work="$root/.deps/rs274.part"
rm -rf "$work"
mkdir -p "$work/debs" "$work/x"
(cd "$work/debs" && apt-get -q download linuxcnc-uspace libboost-python1.74.0 libpython3.11 libedit2 libtirpc3 >/dev/null 2>"$work/log") \
  || { cat "$work/log" >&2; echo "get_rs274: download failed (apt-get update needed?)" >&2; exit 1; }
for deb in "$work"/debs/*.deb; do
  dpkg -x "$deb" "$work/x"
done
mkdir -p "$work/keep/lib"
for name in librs274 libnml liblinuxcnchal liblinuxcncini libpyplugin libtooldata libboost_python libpython3.11 libedit libtirpc; do
  find "$work/x" -name "$name*.so*" -exec cp -P {} "$work/keep/lib/" \;
done
cp "$work/x/usr/bin/rs274" "$work/keep/rs274.bin"
cat > "$work/keep/rs274" <<'SH'
#!/bin/sh
here=$(cd "$(dirname "$0")" && pwd)
LD_LIBRARY_PATH="$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" exec "$here/rs274.bin" "$@"
SH
chmod +x "$work/keep/rs274"
LD_LIBRARY_PATH="$work/keep/lib" ldd "$work/keep/rs274.bin" | grep "not found" >&2 && { echo "get_rs274: libraries missing" >&2; exit 1; }
rm -rf "$target"
mv "$work/keep" "$target"
rm -rf "$work"
