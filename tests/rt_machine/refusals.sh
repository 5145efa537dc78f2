#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# refusals.sh: rt_machine.sh and cross_packages.sh report missing tools in one line, and leave no
# partial files and no processes. Stand-ins replace the tools. The hand of the scenarios can be
# made.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
readonly here
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/tools"
for architecture in amd64 arm64 riscv64; do
    mkdir "$scratch/$architecture"
    touch "$scratch/$architecture"/tactus-{host,controller}_0.2.0_"$architecture".deb \
        "$scratch/$architecture"/tactus-doc_0.2.0_all.deb
done
touch "$scratch/file"
failures=0

tool() { # tool NAME LINE...: makes a stand-in.
    rm -f "$scratch/tools/$1" # It may be a link to the real one.
    printf '%s\n' '#!/bin/bash' "${@:2}" >"$scratch/tools/$1"
    chmod +x "$scratch/tools/$1"
}
# Stand-in of everything that this machine may lack.
for name in qemu-system-{x86_64,aarch64} cpio bsdtar mke2fs mmdebstrap; do
    tool "$name" 'exit 0'
done
tool cpio 'cat >/dev/null'
tool dpkg 'echo amd64'
tool arch-test 'exit 1'
tool df 'echo Avail; echo 99000000'
# shellcheck disable=SC2016 # It is apt-get that knows these names.
tool apt-get 'echo "Packages Debian deb http://example.org bookworm main"'
for name in bash basename cat chmod cut dirname env grep id mkdir printf python3 rm sed sha256sum \
    sleep sort tail taskset tr unshare; do
    [[ -e "$scratch/tools/$name" ]] || ln -s "$(command -v "$name")" "$scratch/tools/$name"
done

script=rt_machine.sh
run() { # run ARGUMENT...: runs with the stand-ins only.
    code=0
    said=$(PATH=$scratch/tools bash "$here/$script" "$@" 2>&1) || code=$?
}
expect() { # expect CODE TEXT ARGUMENT...
    local wanted=$1 text=$2
    shift 2
    run "$@"
    if [[ $code != "$wanted" || "$said" != *"$text"* || "$said" == *$'\n'* ]]; then
        printf '%s %s: expected exit %d and "%s"; exit %d and:\n%s\n' \
            "$script" "$*" "$wanted" "$text" "$code" "$said"
        failures=$((failures + 1))
    fi
}
nothing_made() { # Neither an image nor a part of one.
    local left
    left=$(find "$scratch/out" -name 'image*' -o -name root.tar -o -name initrd)
    [[ -z "$left" ]] || { echo "left: $left"; failures=$((failures + 1)); }
}
readonly both=("$scratch/out" "$scratch/amd64")

expect 3 'Usage' one
expect 2 "can't be written" "$scratch/file/out" "$scratch/amd64"
expect 2 'no folder' "$scratch/out" "$scratch/nowhere"
expect 2 'not one package tactus-host' "$scratch/out" "$scratch/tools"
for name in qemu-system-x86_64 mmdebstrap; do
    mv "$scratch/tools/$name" "$scratch/kept"
    expect 77 "$name is missing (cmake/packages-rt*.txt)" "${both[@]}"
    mv "$scratch/kept" "$scratch/tools/$name"
done
tool df 'echo Avail; echo 1000000'
expect 2 'has 1000 MB free, this needs 3 GB' "${both[@]}"
tool df 'echo Avail; echo 99000000'
expect 2 'packages for riscv64; there are machines for amd64 and arm64' "$scratch/out" \
    "$scratch/riscv64"
expect 77 "programs for arm64 don't run here; as root: mount" "$scratch/out" "$scratch/arm64"
if ((EUID != 0)); then
    tool unshare 'exit 1'
    expect 77 'neither root nor user namespaces' "${both[@]}"
    tool unshare 'exit 0'
fi
tool mmdebstrap 'echo E: no such host; exit 1'
expect 2 'E: no such host' "${both[@]}"
nothing_made

# Packages for another processor.
script=cross_packages.sh
for name in aarch64-linux-gnu-{g++,strip} dpkg-deb ninja; do
    tool "$name" 'exit 0'
done
for name in grep paste touch; do
    [[ -e "$scratch/tools/$name" ]] || ln -s "$(command -v "$name")" "$scratch/tools/$name"
done
readonly cross=(arm64 "$scratch/amd64" "$scratch/cross")
expect 3 'Usage' arm64
expect 2 "packages for riscv64 can't be made, only for arm64" riscv64 "${cross[@]:1}"
expect 2 'no folder' arm64 "$scratch/nowhere" "$scratch/cross"
expect 2 "can't be written" arm64 "$scratch/amd64" "$scratch/file/cross"
mv "$scratch/tools/aarch64-linux-gnu-g++" "$scratch/kept"
expect 77 'aarch64-linux-gnu-g++ is missing (cmake/packages-rt*.txt)' "${cross[@]}"
mv "$scratch/kept" "$scratch/tools/aarch64-linux-gnu-g++"
expect 2 'mmdebstrap failed' "${cross[@]}" # The stand-in finds no server.
if [[ -e "$scratch/cross/made_of" ]]; then
    echo 'half a sysroot is taken for a whole one'
    failures=$((failures + 1))
fi
script=rt_machine.sh

# Ended during the image's creation: no process continues, and the next run restarts and reports it.
# shellcheck disable=SC2016 # It is the stand-in's shell that knows $$.
tool mmdebstrap 'echo $$ >"'"$scratch"'/id"' 'touch "'"$scratch"'/out/root.tar"' 'exec sleep 30'
PATH=$scratch/tools bash "$here/rt_machine.sh" "${both[@]}" >"$scratch/said" 2>&1 &
machine=$!
until [[ -s "$scratch/id" ]]; do
    sleep 0.05
done
kill -TERM "$machine"
code=0
wait "$machine" || code=$?
if ((code == 0)) || kill -0 "$(<"$scratch/id")" 2>/dev/null; then
    echo "ended by a signal: code $code, and mmdebstrap runs on"
    failures=$((failures + 1))
    kill "$(<"$scratch/id")" || true
fi
nothing_made
touch "$scratch/out/root.tar"
tool mmdebstrap 'echo E: no such host; exit 1'
run "${both[@]}"
[[ "$said" == *'half made'* ]] || { echo "not said that it was half made: $said"; failures=1; }

# The machine does not start; all machines end with the script that started them.
tool mmdebstrap 'exit 0'
tool bsdtar 'touch "'"$scratch"'/out/image.partial"'
tool qemu-system-x86_64 'echo no such board; exit 1'
code=0
said=$(PATH=$scratch/tools:$PATH bash "$here/rt_machine.sh" "${both[@]}" 2>&1) || code=$?
if [[ $code != 2 || "$said" != *'QEMU ended with an error: no such board' || "$said" == *$'\n'* ]]
then
    echo "QEMU fails: exit $code and $said"
    failures=$((failures + 1))
fi
# shellcheck disable=SC2016 # It is the stand-in's shell that knows $$.
tool qemu-system-x86_64 'echo $$ >>"'"$scratch"'/qemu"' 'exec sleep 30'
PATH=$scratch/tools:$PATH bash "$here/rt_machine.sh" "${both[@]}" >"$scratch/said" 2>&1 &
machine=$!
until [[ -s "$scratch/qemu" ]]; do
    kill -0 "$machine" 2>/dev/null || { cat "$scratch/said"; exit 1; }
    sleep 0.05
done
kill -TERM "$machine"
wait "$machine" || true
while read -r id; do
    if kill -0 "$id" 2>/dev/null; then
        echo 'QEMU runs on'
        failures=$((failures + 1))
        kill "$id"
    fi
done <"$scratch/qemu"

# The hand of its scenarios can be made from the documentation's driver.
(
    cd "$scratch"
    # shellcheck source=scenarios/helpers.sh
    source "$here/scenarios/helpers.sh"
    make_hand "$here/../../docs/examples/udp_driver.py"
    python3 -c 'import ast, sys; ast.parse(open(sys.argv[1]).read())' hand.py
) || failures=$((failures + 1))
exit $((failures > 0))
