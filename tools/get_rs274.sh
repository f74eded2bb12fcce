#!/bin/sh
# Fetches parts of LinuxCNC from the Debian packages into .deps/rs274, nothing is installed: the stand-alone interpreter
# rs274, the kinematics modules, and what runs the motion controller without a display (tests/controller).
# The tests use them as second opinions on the programs that we write. Run again: does nothing when they are there.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
target="$root/.deps/rs274"
if [ -x "$target/rs274" ] && [ -f "$target/modules/xyzac-trt-kins.so" ] && [ -f "$target/modules/hal_lib.so" ]; then
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
mkdir -p "$work/keep/lib" "$work/keep/modules" "$work/keep/bin" "$work/keep/python"
for name in librs274 libnml liblinuxcnchal liblinuxcncini libposemath libpyplugin libtooldata libboost_python libpython3.11 libedit libtirpc; do
  find "$work/x" -name "$name*.so*" -exec cp -P {} "$work/keep/lib/" \;
done
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
LD_LIBRARY_PATH="$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" exec "$here/rs274.bin" "$@"
SH
chmod +x "$work/keep/rs274"
LD_LIBRARY_PATH="$work/keep/lib" ldd "$work/keep/rs274.bin" "$work/keep/bin/"* | grep "not found" >&2 && { echo "get_rs274: libraries missing" >&2; exit 1; }
rm -rf "$target"
mv "$work/keep" "$target"
rm -rf "$work"
