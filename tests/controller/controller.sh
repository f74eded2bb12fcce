#!/usr/bin/env bash
# Inside the unprivileged user: controller.sh WORK FOLDER SECONDS. Starts LinuxCNC from WORK/linuxcnc with the configuration of FOLDER,
# runs FOLDER/program.ngc, leaves FOLDER/samples.txt. Everything that it started ends with it.
set -euo pipefail
work=$1 folder=$2 seconds=$3
cd "$folder"
exec 3>&2 >log 2>&1
export LINUXCNC_PREFIX="$work/linuxcnc" INI_FILE_NAME="$folder/machine.ini" PYTHONPATH="$work/linuxcnc/python"
export PATH="$work/linuxcnc/bin:$PATH" LD_LIBRARY_PATH="$work/linuxcnc/lib"
preload="$work/linuxcnc/prefix_paths.so"
hal() { LD_PRELOAD="$preload" halcmd "$@"; }

# Programs that run from our copy of LinuxCNC in this name space: ours.
ours() {
  local p
  for p in /proc/[0-9]*; do
    case "$(readlink "$p/exe" 2>/dev/null)" in "$work/linuxcnc/"*) echo "${p#/proc/}" ;; esac
  done
}
finish() {
  local p
  hal stop || true
  hal unload all || true
  LD_PRELOAD="$preload" rtapi_app exit || true
  for p in $(ours); do kill "$p" 2>/dev/null || true; done
  sleep 0.3
  for p in $(ours); do kill -9 "$p" 2>/dev/null || true; done
  # Shared memory that is left belongs to this user alone.
  ipcs -m | awk -v me="$(id -un)" '$3 == me && $6 == 0 {print $2}' | while read -r segment; do ipcrm -m "$segment" || true; done
}
trap finish EXIT

linuxcncsvr -ini machine.ini &
sleep 0.5
hal loadusr -Wn iocontrol io -ini machine.ini
hal loadrt tpmod
hal loadrt homemod
hal -i machine.ini -f machine.hal
hal loadusr -Wn inihal milltask -ini machine.ini &   # comes up when the motion thread runs
hal start
halsampler -c 0 samples.txt &
sampler=$!
/usr/bin/python3 "$work/drive.py" "$folder/program.ngc" "$seconds"
# A command that the motion thread did not take in time is lost, and the program goes on without it.
if grep "command timeout" log; then
  echo "the motion thread did not answer in time: this machine is too busy"
  exit 1
fi
kill -TERM "$sampler" || true
wait "$sampler" || true
