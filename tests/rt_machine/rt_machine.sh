#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# rt_machine.sh FOLDER PACKAGES [--quick]: a machine with a PREEMPT_RT kernel and the Debian
# packages of folder PACKAGES, with their architecture, in QEMU, with time counted in instructions:
# services, deadline tests, faults, and one run twice. The results are also in FOLDER/rt.json, in
# the form of tactus_bench --json. --quick: seconds instead of minutes, to show whether it works.
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

debs=()
for package in tactus-host tactus-controller tactus-doc; do
    deb=$(echo "$packages/${package}_"*.deb)
    [[ -f "$deb" ]] || fail "$packages has not one package $package"
    debs+=("$deb")
done
architecture=$(basename "${debs[0]##*_}" .deb)
readonly architecture
# shellcheck source=boot.sh
source "$here/boot.sh"
need_tools "$machine_program" taskset cpio python3
await bash "$here/make_image.sh" "$folder" "$architecture" "${debs[@]}" || exit
make_initrd "$here/scenarios"

# A machine takes one processor and less than 3 GB, so several may run at a time.
mapfile -t free < <(python3 -c 'import os; print(*os.sched_getaffinity(0), sep="\n")')
memory_kb=$(sed -n 's/^MemAvailable: *\([0-9]*\) kB/\1/p' /proc/meminfo)
at_once=$((memory_kb / 3000000))
free=("${free[@]:0:$((at_once > 1 ? at_once : 1))}") # Processors without a machine.
declare -A processor job # Running jobs by process.
end_jobs() {
    ((${#job[@]} == 0)) || kill -TERM "${!job[@]}" 2>/dev/null || true
    wait
}
trap 'end_child; end_jobs' EXIT
faults=0
await_job() { # Waits for any of them.
    local code=0 ended name
    wait -n -p ended "${!job[@]}" || code=$?
    name=${job[$ended]}
    free+=("${processor[$ended]}")
    unset "job[$ended]" "processor[$ended]"
    ((code < 2)) || fail "$name: $(tail -n 1 "$folder/$name.said")"
    cat "$folder/$name.said"
    faults=$((faults + code))
}
jobs=(alone services faults network power_cut minute_twice mesh fast) # The longest first.
((!full)) || jobs+=(load)
for name in "${jobs[@]}"; do
    ((${#free[@]} > 0)) || await_job
    taskset -c "${free[-1]}" bash "$here/job.sh" "$folder" "$architecture" "$full" "$name" \
        >"$folder/$name.said" 2>&1 &
    job[$!]=$name
    processor[$!]=${free[-1]}
    unset 'free[-1]'
done
while ((${#job[@]} > 0)); do
    await_job
done

commit=$(git -C "$here" rev-parse --short HEAD 2>/dev/null || echo unknown)
python3 "$here/figures.py" "$folder" "$commit" "${@:3}" >"$folder/figures" || faults=$((faults + 1))
cat "$folder/figures"
((faults == 0)) || { echo "$faults scenarios failed"; exit 1; }
