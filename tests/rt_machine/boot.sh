# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash disable=SC2154 # What rt_machine.sh and job.sh set is used here.
# Starts the machine; sourced after common.sh, with image and kernel in $folder, and Debian's name
# of its processor in $architecture.

readonly machine_exit_port=0x501 # The same value as in guest.sh.

# QEMU counts instructions: one is a nanosecond, idle time is skipped, and nothing of this machine
# is visible. All threads are on one processor, there is no disk, network or monitor, and seeds and
# clock are given. Only the scheduling of QEMU's own threads is left: with $in_turn, if permitted,
# only when one waits.
in_turn=()
# shellcheck disable=SC2054 # QEMU's own commas.
machine_options=(-accel tcg -icount shift=0,sleep=off -smp 1 -m 2048 -nodefaults -display none
    -monitor none -nic none -no-reboot -rtc "base=2026-12-01T00:00:00,clock=vm" -seed 1)
# shellcheck disable=SC2054 # QEMU's own commas.
case "$architecture" in
    amd64)
        readonly machine_program=qemu-system-x86_64 machine_console=ttyS0
        machine_options+=(-cpu max -machine "pc,hpet=off"
            -device "isa-debug-exit,iobase=$machine_exit_port,iosize=1")
        ;;
    arm64)
        readonly machine_program=qemu-system-aarch64 machine_console=ttyAMA0
        machine_options+=(-cpu cortex-a76 -machine virt)
        ;;
    *) fail "packages for $architecture; there are machines for amd64 and arm64" ;;
esac
readonly machine_kernel_line="rdinit=/sbin/init console=$machine_console quiet \
systemd.show_status=0 panic=-1 mitigations=off nokaslr"

# boot NAME SCENARIO[,ARGUMENT...] [QEMU-OPTION...]: runs a scenario of guest.sh. Its output is in
# $folder/NAME/log, its stored files in the same folder. The exit code is that of the scenario, or 2
# if the machine did not complete it.
boot() {
    local out=$folder/$1 code ended=0 line lines processor scenario=$2
    shift 2
    rm -rf "$out"
    mkdir -p "$out"
    lines=(-serial "file:$out/console")
    for line in log kept; do
        if [[ "$architecture" == amd64 ]]; then
            lines+=(-serial "file:$out/$line")
        else # That board has its own line.
            lines+=(-chardev "file,id=$line,path=$out/$line" -device "pci-serial,chardev=$line")
        fi
    done
    processor=$(taskset -cp $$ | sed 's/.*[ ,-]//')
    await "${in_turn[@]}" taskset -c "$processor" "$machine_program" "${machine_options[@]}" \
        -kernel "$folder/kernel" -initrd "$folder/initrd" \
        -append "$machine_kernel_line tactus=$scenario" "${lines[@]}" "$@" \
        >"$out/qemu" 2>&1 || ended=$?
    # Code 1 is the machine's end of QEMU, or QEMU's own for a wrong option.
    if ((ended > 1)) || [[ $ended == 1 && -s "$out/qemu" ]]; then
        fail "QEMU ended with an error: $(tail -n 1 "$out/qemu")"
    fi
    # Progress is many texts on one line, each over the last one.
    sed -i -e 's/\r$//' -e 's/.*\r//' -e 's/\x1b\[K//g' "$out"/{console,log}
    [[ ! -s "$out/kept" ]] || base64 -di "$out/kept" | tar -xzC "$out"
    code=$(sed -n 's/^the scenario ended with //p' "$out/log")
    return "${code:-2}"
}

# make_initrd SCENARIOS: makes the image with the scenarios of that folder.
make_initrd() {
    local overlay=$folder/overlay
    rm -rf "$overlay"
    mkdir -p "$overlay"/rt_machine "$overlay"/etc/systemd/system/multi-user.target.wants
    cp "$1"/*.sh "$overlay/rt_machine"
    cp "$1"/rt_machine.service "$overlay/etc/systemd/system/"
    ln -s /etc/systemd/system/rt_machine.service \
        "$overlay/etc/systemd/system/multi-user.target.wants/"
    find "$overlay" -exec touch -hd @1700000000 {} +
    (cat "$folder/image" && cd "$overlay" && find . | LC_ALL=C sort \
        | cpio --quiet -o -H newc -R 0:0 --reproducible) >"$folder/initrd"
}
