#!/bin/sh
# one_node.sh DIR COMMAND...: a Slurm of this computer alone, in DIR, while COMMAND runs. Exit 77: it cannot be started
# here, and why is on stderr.
set -eu
dir=$1
shift
for tool in slurmctld slurmd sbatch scontrol; do
  command -v $tool >/dev/null || { echo "$tool is not installed (Debian package slurm-wlm)" >&2; exit 1; }
done
[ "$(id -u)" = 0 ] || { echo "slurmd must be started by root" >&2; exit 77; }
host=$(hostname -s)
free_port() { python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }
mkdir -p "$dir/state" "$dir/spool"
cat > "$dir/slurm.conf" <<CONF
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
AuthType=auth/none
CredType=cred/none
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,batch_sched_delay=0
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF="$dir/slurm.conf"
ctld= slurmd=
stop() {
  for pid in $ctld $slurmd; do kill "$pid" 2>/dev/null || true; done
  for pid in $ctld $slurmd; do wait "$pid" 2>/dev/null || true; done
}
trap stop EXIT
slurmctld -D -f "$SLURM_CONF" >"$dir/ctld.out" 2>&1 &
ctld=$!
slurmd -D -N "$host" -f "$SLURM_CONF" >"$dir/slurmd.out" 2>&1 &
slurmd=$!
tries=0
until sinfo -h -o %t 2>/dev/null | grep -qx idle; do
  tries=$((tries + 1))
  if [ $tries -gt 60 ] || ! kill -0 $ctld 2>/dev/null || ! kill -0 $slurmd 2>/dev/null; then
    echo "Slurm does not start here:" >&2
    grep -h -E "error|fatal" "$dir/slurmctld.log" "$dir/slurmd.log" "$dir/ctld.out" "$dir/slurmd.out" 2>/dev/null | tail -5 >&2
    exit 77
  fi
  sleep 1
done
"$@"
