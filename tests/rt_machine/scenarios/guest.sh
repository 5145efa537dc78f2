#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Runs as root inside the machine: the script A.sh that the kernel's line names by
# `tactus=A,ARGUMENT...`. Its output is sent to the second serial line, its files in
# /rt_machine/kept to the third.
set -uo pipefail
second=0 # Number of that ttyS line: on amd64 the console is one of them.
[[ $(uname -m) != x86_64 ]] || second=1
exec </dev/null >/dev/ttyS$second 2>&1
cd /rt_machine || exit
mkdir -p kept
export HOME=/root LC_ALL=C.UTF-8

line=$(</proc/cmdline)
line=${line##*tactus=}
IFS=, read -r -a words <<<"${line%% *}"
code=0
bash "./${words[0]}.sh" "${words[@]:1}" || code=$?
echo "the scenario ended with $code"
tar --sort=name --mtime=@0 -czC kept . | base64 >/dev/ttyS$((second + 1))
sleep 0.5 # Time for the serial lines' last bytes.
if ((second == 1)); then
    # Ends QEMU at once; a power-off needs a thread of QEMU that may not be scheduled (boot.sh).
    printf '\0' | dd of=/dev/port bs=1 seek=$((0x501)) conv=notrunc status=none
else
    poweroff --force --force # This also stops the processor.
fi
