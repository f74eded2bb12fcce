#!/usr/bin/env bash
# Runs stretches of two samples through LinuxCNC's real motion controller, without display and without real-time kernel, and
# compares the joints that it executed with our read-back of the same text:
#   tests/controller/run_in_linuxcnc.sh [--quick] TOOTHPATH CASE   both programs of a build: toothpath, toothpath_controller_case
# --quick: exact stop only.
# Takes about the time that the machine would take. Exit 77 and a reason where this machine cannot run it.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
quick=
case "${1:-}" in
  --quick) quick=yes; shift ;;
esac
[ $# -eq 2 ] || { sed -n '2,5p' "$0" >&2; exit 2; }
toothpath=$(realpath "$1") case_program=$(realpath "$2")
cannot() { echo "run_in_linuxcnc: cannot run here: $*" >&2; exit 77; }

parts="$root/.deps/rs274"
"$root/tools/get_rs274.sh" >&2 || cannot "the parts of LinuxCNC could not be fetched (tools/get_rs274.sh)"
python=/usr/bin/python3
[ -x "$python" ] || cannot "$python is missing; LinuxCNC's interface is a module for Debian's Python"
for tool in cc flock timeout; do command -v "$tool" >/dev/null || cannot "$tool is missing"; done

work=$(mktemp -d -t toothpath_controller.XXXXXX)
trap '[ -n "${KEEP:-}" ] && echo "kept: $work" >&2 || rm -rf "$work"' EXIT
cp -r "$parts" "$work/linuxcnc"
cc -shared -fPIC -O1 -o "$work/linuxcnc/prefix_paths.so" "$here/prefix_paths.c" -ldl
cp "$here/drive.py" "$here/controller.sh" "$work/"

# LinuxCNC refuses user 0: root becomes "nobody", in name spaces of its own for processes and shared memory where the kernel allows that.
as_user=()
if [ "$(id -u)" = 0 ]; then
  command -v setpriv >/dev/null || cannot "LinuxCNC refuses to run as root and setpriv is missing"
  id nobody >/dev/null 2>&1 || cannot "LinuxCNC refuses to run as root and there is no user nobody"
  as_user=(setpriv --reuid="$(id -u nobody)" --regid="$(id -g nobody)" --clear-groups)
  if unshare --ipc --pid --fork --kill-child --mount-proc true 2>/dev/null; then
    as_user=(unshare --ipc --pid --fork --kill-child --mount-proc "${as_user[@]}")
  fi
fi

# One run: NAME JOB TEETH MODE SECONDS. The program is made once a job.
status=0
run() {
  local name=$1 job=$2 teeth=$3 mode=$4 seconds=$5 folder="$work/$1_$4"
  if [ ! -e "$work/$name/program.ngc" ]; then
    "$toothpath" --quiet run "$job" --out "$work/$name" >"$work/$name.log" 2>&1 || { cat "$work/$name.log" >&2; status=1; return; }
  fi
  mkdir "$folder"
  "$case_program" prepare "$job" "$work/$name/program.ngc" "$folder" "$teeth" "$mode" || { status=1; return; }
  cp "$work/linuxcnc/linuxcnc.nml" "$folder/"
  if [ "$(id -u)" = 0 ]; then chmod 755 "$work"; chown -R nobody "$folder"; fi
  # One controller at a time: its shared memory has fixed keys.
  if ! flock "$(dirname "$work")/toothpath_controller.lock" "${as_user[@]}" timeout "$((seconds + 120))" \
      env -i PATH=/usr/bin:/bin HOME="$folder" LC_ALL=C "$work/controller.sh" "$work" "$folder" "$seconds"; then
    echo "$name, $mode: the controller did not run the program to its end" >&2
    tail -n 20 "$folder/log" >&2
    status=1
    return
  fi
  echo -n "$name, "
  "$case_program" compare "$job" "$folder" "$mode" || status=1
}

# Joints as they are written: a fixed tool axis, then one that turns in the passes.
run spur_quick "$root/samples/spur_quick.toml" 1,1 exact 600
[ -n "$quick" ] || run spur_quick "$root/samples/spur_quick.toml" 1,1 written 600
run short_tool "$root/samples/short_tool.toml" 0,1 exact 900
[ -n "$quick" ] || run short_tool "$root/samples/short_tool.toml" 0,1 written 900

# With TCP the controller's own kinematics make the joints, while the tool axis turns.
mkdir "$work/tcp"
sed 's/^tcp = "none"/tcp = "angles"/' "$root/machines/data/xyzac_trt.toml" > "$work/tcp/xyzac_trt.toml"
cp "$root/samples/short_tool.toml" "$work/tcp/"
run short_tool_tcp "$work/tcp/short_tool.toml" 0,1 exact 900
[ -n "$quick" ] || run short_tool_tcp "$work/tcp/short_tool.toml" 0,1 written 900
exit $status
