#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# rt_machine.sh FOLDER PACKAGES [--quick]: a machine with a PREEMPT_RT kernel and the Debian
# packages of folder PACKAGES, in QEMU, its time counted in instructions: services, deadline tests,
# faults, and one run twice. What it prints is also in FOLDER/rt.json, as tactus_bench --json has
# its results. --quick: seconds instead of minutes, for what shows whether it works.
# Exit codes: 0 done, 1 a criterion was not met, 2 failed, 3 usage, 77 something is missing here.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
readonly here
# shellcheck source=common.sh
source "$here/common.sh"
[[ $# == 2 || ($# == 3 && "$3" == --quick) ]] \
    || { echo 'Usage: rt_machine.sh FOLDER PACKAGES [--quick]' >&2; exit 3; }
mkdir -p "$1" 2>/dev/null || fail "$1 can't be written"
folder=$(cd "$1" && pwd)
packages=$(cd "$2" 2>/dev/null && pwd) || fail "no folder $2"
readonly folder packages
readonly full=$((3 - $#)) # 0 with --quick.
# shellcheck source=boot.sh
source "$here/boot.sh"

need_tools qemu-system-x86_64 taskset cpio python3
debs=()
for package in tactus-host tactus-controller tactus-doc; do
    deb=$(echo "$packages/${package}_"*.deb)
    [[ -f "$deb" ]] || fail "$packages has not one package $package"
    debs+=("$deb")
done
await bash "$here/make_image.sh" "$folder" "${debs[@]}" || exit
make_initrd "$here/scenarios"

faults=0
# scenario NAME SCENARIO[,ARGUMENT...] [QEMU-OPTION...]: must end with 0.
scenario() {
    local code=0
    boot "$@" || code=$?
    printf '== %s\n' "$1"
    cat "$folder/$1/log"
    ((code == 0)) || faults=$((faults + 1))
}

seconds=10 # Of virtual time.
((!full)) || seconds=60
scenario services services
scenario faults faults
scenario network "network,$((seconds / 2)),10,1"

mke2fs -q -F -t ext4 "$folder/disk" 64M
for ms in 150 450 750 1050 0; do
    code=0
    boot power_cut "power_cut,$ms" -drive "file=$folder/disk,format=raw,if=virtio" || code=$?
    printf '== power_cut %d\n' "$ms"
    cat "$folder/power_cut/log"
    if ! grep -qx "power cut after $ms ms" "$folder/power_cut/log" && ((code != 0 || ms > 0)); then
        faults=$((faults + 1))
    fi
done

! chrt --fifo 1 true 2>/dev/null || in_turn=(chrt --fifo 1)
scenario minute "minute,$seconds"
scenario again "minute,$seconds"
if ! diff -rq "$folder/minute" "$folder/again" && ((${#in_turn[@]} > 0)); then
    echo 'FAULT: two runs of the same differ'
    faults=$((faults + 1))
fi
in_turn=()
# One instruction a nanosecond is some three times slower than a real processor: a smaller model.
scenario fast "deadline,$seconds,none,2000,--rate,4000,--frame-budget-us,60"
if ((full)); then
    scenario alone deadline,600,none,200000
    scenario load deadline,120,cpu+memory+disk,200000
else
    scenario alone deadline,10,none,200000
fi
commit=$(git -C "$here" rev-parse --short HEAD 2>/dev/null || echo unknown)
python3 "$here/figures.py" "$folder" "$commit" "${@:3}" >"$folder/figures" || faults=$((faults + 1))
cat "$folder/figures"
((faults == 0)) || { echo "$faults scenarios failed"; exit 1; }
