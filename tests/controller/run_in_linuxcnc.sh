#!/usr/bin/env bash
# Runs stretches of two samples through LinuxCNC's real motion controller, without display and without real-time kernel, and
# compares the joints that it executed with our read-back of the same text:
#   tests/controller/run_in_linuxcnc.sh [NAME ..] TOOTHPATH CASE   both programs of a build: toothpath, toothpath_controller_case
# NAME: runs of the list at the end, all of them without. Takes about the time that the machine would take. Exit 77 and a reason
# where this machine cannot run it.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
[ $# -ge 2 ] || { sed -n '2,7p' "$0" >&2; exit 2; }
toothpath=$(realpath "${@: -2:1}") case_program=$(realpath "${@: -1}")
wanted=" ${*:1:$#-2} "
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

# root gives the controller more of a busy machine than others get.
first=()
nice -n -10 true 2>/dev/null && [ "$(id -u)" = 0 ] && first=(nice -n -10)

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

# One run: NAME JOB TEETH CORNERS ACCELERATION PERIOD SECONDS. JOB is a folder of $work with job.toml; its program is made once.
status=0
run() {
  local name=$1 job=$2 teeth=$3 corners=$4 acceleration=$5 period=$6 seconds=$7 folder="$work/run_$1"
  case "$wanted" in "  " | *" $name "*) ;; *) return ;; esac
  if [ ! -e "$work/$job/out/program.ngc" ]; then
    "$toothpath" --quiet run "$work/$job/job.toml" --out "$work/$job/out" >"$work/$job/log" 2>&1 || { cat "$work/$job/log" >&2; status=1; return; }
  fi
  mkdir "$folder"
  "$case_program" prepare "$work/$job/job.toml" "$work/$job/out/program.ngc" "$folder" "$teeth" "$corners" "$acceleration" "$period" || { status=1; return; }
  cp "$work/linuxcnc/linuxcnc.nml" "$folder/"
  if [ "$(id -u)" = 0 ]; then chmod 755 "$work"; chown -R nobody "$folder"; fi
  # One controller at a time: its shared memory has fixed keys.
  if ! flock "$(dirname "$work")/toothpath_controller.lock" "${first[@]}" "${as_user[@]}" timeout "$((seconds + 120))" \
      env -i PATH=/usr/bin:/bin HOME="$folder" LC_ALL=C "$work/controller.sh" "$work" "$folder" "$seconds"; then
    echo "$name: the controller did not run the program to its end" >&2
    tail -n 20 "$folder/log" >&2
    status=1
    return
  fi
  echo -n "$name ($corners, $(sed -n 's/^executed in //p' "$folder/log")): "
  "$case_program" compare "$work/$job/job.toml" "$folder" "$acceleration" "$period" || status=1
  "$case_program" times "$work/$job/job.toml" "$folder" "$acceleration" "$period" || status=1
}

# The jobs: a fixed tool axis; one that turns in the passes, as joints, and with TCP: the controller's own kinematics make the joints;
# finger mills, where Y and C move together in every cut.
for job in spur spur_tcp spur_turned short short_tcp short_turned bevel line; do mkdir "$work/$job"; done
cp "$root/samples/spur_quick.toml" "$work/spur/job.toml"
cp "$root/samples/short_tool.toml" "$work/short/job.toml"
cp "$root/samples/spur_quick.toml" "$work/spur_tcp/job.toml"
sed 's/^tcp = "none"/tcp = "angles"/; s/^\[spindle\]/[post]\ntcp_on = ["M428"]\ntcp_off = ["M429"]\n\n[spindle]/' "$root/machines/data/xyzac_large.toml" >"$work/spur_tcp/xyzac_large.toml"
cp "$root/samples/bevel_trunnion.toml" "$work/bevel/job.toml"
cp "$root/samples/spur_line.toml" "$work/line/job.toml"
cp "$root/samples/short_tool.toml" "$work/short_tcp/job.toml"
sed 's/^tcp = "none"/tcp = "angles"/' "$root/machines/data/xyzac_trt.toml" >"$work/short_tcp/xyzac_trt.toml"
# Those with TCP with one tooth in the text: the program turns a work offset to the others.
for job in spur short; do
  cp "$work/${job}_tcp/"*.toml "$work/${job}_turned/"
  sed -i 's/^tcp_on = .*/index_offset = "G59.3"\n&/' "$work/${job}_turned/"xyzac_*.toml
done

run spur_stop spur 1,1 G61.1 200 1000 600
run spur spur 1,1 written 2000 1000 600
run spur_half spur 1,1 written 2000 500 600
run spur_g64 spur 1,1 "G64 P0.0003 Q0" 2000 1000 600
run spur_g64_half spur 1,1 "G64 P0.0003 Q0" 2000 500 600
run short_stop short 0,1 G61.1 200 1000 900
run short short 0,1 written 2000 1000 900
run tcp_stop short_tcp 0,1 G61.1 200 1000 900
run tcp short_tcp 0,1 written 2000 1000 900
# Later teeth: the zero of C moves (G52), with TCP a work offset turns as well.
run spur_index spur 2,2 written 2000 1000 600
run spur_turned spur_turned 2,2 written 2000 1000 600
run index short 0,2 written 2000 1000 900
run turned short_turned 0,2 written 2000 1000 900
# Under G64 as well, the rest of fixed and turning axis, joints and TCP. Our reader refuses G64 where a cut turns a rotary: those two
# show why.
run spur_tcp spur_tcp 1,1 written 2000 1000 600
run spur_tcp_g64 spur_tcp 1,1 "G64 P0.0003 Q0" 2000 1000 600
run short_g64 short 0,1 "G64 P0.0003 Q0" 2000 1000 900
run tcp_g64 short_tcp 0,1 "G64 P0.0003 Q0" 2000 1000 900
run short_300 short 0,1 written 300 1000 900
run line line 0,0,1,1,1,1,1 written 2000 1000 900
run bevel bevel 1,1 written 2000 1000 600
run bevel_300 bevel 1,1 written 300 1000 600
exit $status
