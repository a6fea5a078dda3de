#!/usr/bin/env bash
# A real SLURM of one node on this machine, for the tests, on Debian, as root:
#
#     scripts/slurm_on_loopback.sh start FOLDER     installs slurm-wlm and munge where they lack, starts the daemons
#     . FOLDER/environment                          then sinfo, sbatch, squeue, scancel speak to it
#     scripts/slurm_on_loopback.sh stop FOLDER
#
# Everything but munge's key and socket lies in FOLDER.  The node offers two processors whatever the machine has, and
# whatever OMP_NUM_THREADS says, for nproc believes it: the test needs two jobs side by side.  It is no example of a SLURM for users: one machine, no
# accounting, no limits, everybody is root.
set -euo pipefail

command=${1:?start or stop}
folder=$(realpath -m "${2:?a folder for its state}")
host=$(hostname -s)

start() {
    if ! command -v slurmctld >/dev/null || ! command -v munged >/dev/null; then
        export DEBIAN_FRONTEND=noninteractive
        apt-get update -qq
        # Nobody is to start the daemons with a configuration of their own.
        RUNLEVEL=1 apt-get install -y -qq --no-install-recommends slurm-wlm munge >/dev/null
    fi
    mkdir -p "$folder"/{state,spool}
    cat >"$folder/slurm.conf" <<CONF
ClusterName=loopback
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=16817
SlurmdPort=16818
AuthType=auth/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
ReturnToService=2
SchedulerType=sched/backfill
SchedulerParameters=sched_min_interval=0,bf_interval=1
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
KillWait=1
SlurmdParameters=config_overrides
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
    echo "export SLURM_CONF='$folder/slurm.conf'" >"$folder/environment"
    export SLURM_CONF="$folder/slurm.conf"
    if ! munge -n >/dev/null 2>&1; then
        mkdir -p /run/munge
        chown munge: /run/munge
        [ -f /etc/munge/munge.key ] || { dd if=/dev/urandom of=/etc/munge/munge.key bs=1 count=1024 status=none
            chown munge: /etc/munge/munge.key
            chmod 400 /etc/munge/munge.key; }
        runuser -u munge -- munged --pid-file="/run/munge/fdspec.pid"
    fi
    slurmctld
    slurmd
    for _ in $(seq 100); do
        sinfo --noheader --format=%T 2>/dev/null | grep -q '^idle' && return
        sleep 0.2
    done
    echo "the node does not come up: see $folder/slurmctld.log and $folder/slurmd.log" >&2
    exit 1
}

stop() {
    export SLURM_CONF="$folder/slurm.conf"
    timeout 10 scancel --signal=KILL --full --user="$(id -un)" || true
    for _ in $(seq 50); do
        [ -n "$(timeout 5 squeue --noheader 2>/dev/null)" ] || break
        sleep 0.2
    done
    for pid in "$folder"/{slurmd,slurmctld}.pid /run/munge/fdspec.pid; do
        [ ! -f "$pid" ] || kill "$(cat "$pid")" || true
    done
}

case $command in
start | stop) "$command" ;;
*) echo "start or stop, not $command" >&2; exit 2 ;;
esac
