#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# power_cut.sh MS: checks the files on the disk after the last cut. Then spm_build, --record and
# --report write there repeatedly, until the power is cut after this number of ms, with 0 never.
# Every named file must be complete.
source ./helpers.sh
readonly disk=/disk model=/var/lib/tactus/bumpy.spm
modprobe -a virtio_pci virtio_blk ext4
wait_until 10 'disk' test -b /dev/vda
mkdir "$disk"
mount /dev/vda "$disk"
take_model 2000

if [[ -e "$disk/told" ]]; then
    ls -l "$disk"
    spm_inspect "$disk/built.spm" | tail -n 1
    hrtc --replay "$disk/run.rec" >replay.log 2>&1 || fail "a torn recording: $(<replay.log)"
    tail -n 1 replay.log
    python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["frames"], "frames told")' \
        "$disk/run.json" || fail 'a torn report'
    # Proof of a cut: unflushed data are missing.
    left=$(stat -c %s "$disk/unflushed" 2>/dev/null || echo 0)
    echo "of 1000000 bytes that nobody flushed $left are left"
    ((left < 1000000)) || fail 'no power was cut'
    echo "partial files: $(find "$disk" -name '*.partial' | wc -l)"
fi
rm -rf "${disk:?}"/*
build() { spm_build --shape torus --faces "$1" -o "$disk/built.spm" >/dev/null; }
run() {
    hrtc --transport file --model "$model" --duration 0.1 --record "$disk/run.rec" \
        --report "$disk/run.json" >/dev/null 2>&1
}
build 2000
run
touch "$disk/told" # All three exist from here on.
sync
if (($1 > 0)); then
    (while true; do build $((2000 + RANDOM)); done) &
    (while true; do run; done) &
    head -c 1000000 /dev/zero >"$disk/unflushed"
    sleep "$(awk -v ms="$1" 'BEGIN { print ms / 1000 }')"
    echo "power cut after $1 ms"
    sleep 0.1
    echo b >/proc/sysrq-trigger
    sleep 10
fi
