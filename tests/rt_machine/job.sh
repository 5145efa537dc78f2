#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# job.sh FOLDER ARCHITECTURE FULL JOB: one of the jobs of rt_machine.sh, which has made image and
# initrd there; FULL is 0 for seconds instead of minutes. Prints the machine's output.
# Exit codes: 0 done, 1 a criterion was not met, 2 failed.
set -euo pipefail
readonly folder=$1 architecture=$2 full=$3 job=$4
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
readonly here
# shellcheck source=common.sh
source "$here/common.sh"
# shellcheck source=boot.sh
source "$here/boot.sh"

faults=0
# scenario NAME SCENARIO[,ARGUMENT...] [QEMU-OPTION...]: expects exit code 0.
scenario() {
    local code=0
    boot "$@" || code=$?
    printf '== %s\n' "$1"
    cat "$folder/$1/log"
    ((code == 0)) || faults=$((faults + 1))
}

power_cut() {
    local code ms
    mke2fs -q -F -t ext4 "$folder/disk" 64M
    for ms in 150 450 750 1050 0; do
        code=0
        boot power_cut "power_cut,$ms" -drive "file=$folder/disk,format=raw,if=virtio" || code=$?
        printf '== power_cut %d\n' "$ms"
        cat "$folder/power_cut/log"
        if ! grep -qx "power cut after $ms ms" "$folder/power_cut/log" && ((code != 0 || ms > 0))
        then
            faults=$((faults + 1))
        fi
    done
}

minute_twice() {
    ! chrt --fifo 1 true 2>/dev/null || in_turn=(chrt --fifo 1)
    scenario minute "minute,$seconds"
    scenario again "minute,$seconds"
    if ! diff -rq "$folder/minute" "$folder/again" && ((${#in_turn[@]} > 0)); then
        echo 'FAULT: two runs of the same differ'
        faults=$((faults + 1))
    fi
}

seconds=10 # Virtual time.
((!full)) || seconds=60
case "$job" in
    services | faults) scenario "$job" "$job" ;;
    network) scenario network "network,$((seconds / 2)),10,1" ;;
    power_cut | minute_twice) "$job" ;;
    # An instruction a nanosecond is about three times slower than a real processor, so the model is
    # smaller.
    fast) scenario fast "deadline,$seconds,none,2000,--rate,4000,--frame-budget-us,80" ;;
    mesh)
        ring=mesh:/usr/share/tactus_models/ring.spm
        scenario mesh "deadline,$((seconds * 2)),none,200000,--tool,$ring"
        ;;
    alone) scenario alone "deadline,$((full ? 600 : 10)),none,200000" ;;
    load) scenario load deadline,120,cpu+memory+disk,200000 ;;
esac
((faults == 0))
