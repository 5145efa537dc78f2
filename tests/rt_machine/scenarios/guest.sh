#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Inside the machine, as root: runs the script A.sh that the kernel's line names by
# `tactus=A,ARGUMENT...`. Its words go to the second serial line, what it leaves in
# /rt_machine/kept to the third.
set -uo pipefail
second=0 # Of those that are called ttyS: on amd64 the console is one of them.
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
sleep 0.5 # The serial lines' last bytes.
if ((second == 1)); then
    # Ends QEMU at once; to power off takes a thread of QEMU's that may not get its turn (boot.sh).
    printf '\0' | dd of=/dev/port bs=1 seek=$((0x501)) conv=notrunc status=none
else
    poweroff --force --force # Where that stops the processor, too.
fi
