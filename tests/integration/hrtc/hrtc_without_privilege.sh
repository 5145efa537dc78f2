#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_without_privilege.sh: without the right to SCHED_FIFO or to lock memory the controller
# reports the missing right and does not run; --allow-no-rt runs and reports it too; the doctor
# finds it critical. Skipped (77) if the right cannot be dropped.
source "$(dirname "$0")/common.sh"
model bumpy-sphere-5000 good.spm

# unprivileged COMMAND...: no capabilities, no real-time priority, 64 KiB of locked memory.
if ((EUID == 0)); then
    setpriv --reuid=65534 --regid=65534 --clear-groups true 2>setpriv.log \
        || { printf 'skipped: root may not change user: %s\n' "$(cat setpriv.log)"; exit 77; }
    # The other user must be able to read and report here, but may not see the build's folder.
    chmod 777 "$scratch"
    chmod 644 good.spm
    unprivileged() {
        (ulimit -r 0 && ulimit -l 64 \
            && exec setpriv --reuid=65534 --regid=65534 --clear-groups --bounding-set=-all \
                --inh-caps=-all "$@")
    }
else
    unprivileged() { (ulimit -r 0 && ulimit -l 64 && exec "$@"); }
fi
cp "$hrtc" hrtc
unprivileged ./hrtc --version >version.txt 2>&1 \
    || { printf 'skipped: another user can not run %s\n' "$scratch/hrtc"; exit 77; }
if unprivileged chrt -f 1 true 2>/dev/null; then
    printf 'skipped: SCHED_FIFO can not be given up here\n'
    exit 77
fi

code=0
output=$(unprivileged ./hrtc --transport file --model good.spm --duration 60 2>&1) || code=$?
((code == 2)) || fault "without privilege it ended with $code"
refused=$output
[[ "$output" == *SCHED_FIFO*CAP_SYS_NICE* ]] || fault "no word about SCHED_FIFO: $output"
[[ "$output" == *mlockall*RLIMIT_MEMLOCK* ]] || fault "no word about locked memory: $output"
[[ "$output" == *--allow-no-rt* ]] || fault "no word about --allow-no-rt: $output"

code=0
output=$(unprivileged ./hrtc --transport file --model good.spm --duration 1 --allow-no-rt \
    --report report.json 2>&1) || code=$?
printf '%s\n' "$output"
((code == 0)) || fault "with --allow-no-rt it ended with $code"
[[ "$output" == *SCHED_FIFO* ]] || fault 'with --allow-no-rt it does not say what is missing'
check report.json frames == 1000 machine.fifo == 0 machine.memory_locked == 0 \
    machine.refused == 2

code=0
unprivileged ./hrtc doctor --json >doctor.json 2>&1 || code=$?
((code == 1)) || { cat doctor.json; fault "without privilege hrtc doctor ended with $code"; }
check doctor.json counts.critical '>=' 2
output=$(unprivileged ./hrtc doctor 2>&1) || true
[[ "$output" == *critical*priority*refused*rtprio* && "$output" == *critical*memlock*refused* ]] \
    || fault "hrtc doctor does not say what is missing: $output"
# Both print the same line for the same file.
for line in ' - rtprio 99' ' - memlock unlimited'; do
    for said in "$refused" "$output"; do
        [[ "$said" == *"$line"*/etc/security/limits.d/tactus.conf* ]] \
            || fault "no '$line' for limits.d: $said"
    done
done
finish
