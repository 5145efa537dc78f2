#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# every_end_fades.sh BIN CHECK_REPORT SANITIZER DEVICE RECORDING_DEVICE BARE_DEVICE STAND_IN_DHD:
# last commands of a device's motors when hrtc ends by a signal, a closed output or an oversized
# recording, or when it is killed or crashes. The motors are a file that outlives hrtc. DEVICE: udp,
# plugin or dhd.
here=$(cd "$(dirname "$0")" && pwd)
readonly here
source "$here/../integration/hrtc/common.sh"
readonly device=$4 recording=$5 bare=$6 stand_in=$7
readonly port=$((20000 + $$ % 20000))
model bumpy-sphere-20000 bumpy.spm

options=(--transport file --model bumpy.spm --device-frame "0,0,0.06" --duration 600)
case $device in
    udp)
        # Driver of the documents, with a log of its motors.
        python3 - "$here/../../docs/examples/udp_driver.py" >driver.py <<'EDIT'
import sys
text = open(sys.argv[1], encoding="utf-8").read()
for old, new in (
        ("controller.setblocking(False)\n",
         'controller.setblocking(False)\ntold = open("motors.log", "a", buffering=1)\n\n'
         "def tell(force, who):\n    print(time.monotonic_ns(), *force, who, file=told)\n"),
        ("            driver.take(controller.recv(512), time.monotonic_ns())\n",
         "            if driver.take(controller.recv(512), time.monotonic_ns()):\n"
         '                tell(driver.force.force_n, "force")\n'),
        ("    if datagram := driver.next(sample, time.monotonic_ns()):\n",
         "    was_felt = any(driver.force.force_n)\n"
         "    datagram = driver.next(sample, time.monotonic_ns())\n"
         "    if was_felt and not any(driver.force.force_n):\n"
         '        tell(driver.force.force_n, "watchdog")\n'
         "    if datagram:\n")):
    assert text.count(old) == 1, old
    text = text.replace(old, new)
print(text, end="")
EDIT
        options+=(--device "udp:$port" --wait "$patience_s")
        ;;
    plugin) options+=(--device "plugin:$recording,motors.log") ;;
    dhd)
        cp "$stand_in" libdhd.so.3
        export LD_LIBRARY_PATH=$PWD TACTUS_DHD_LOG=$PWD/motors.log
        options+=(--device dhd)
        ;;
esac

# Starts new motors; for udp with their own driver.
fresh_motors() {
    rm -f motors.log
    [[ "$device" == udp ]] || return 0
    PYTHONPATH=$here/../../docs/examples python3 driver.py "$port" 0.02 >driver.log 2>&1 &
    driving=$!
    started+=("$driving")
}
# judge SIGNAL HOW: checks $controller; returns 1 on a fault, with the reason in judged.txt.
judge() {
    local code=0
    python3 "$here/last_force.py" motors.log "$controller" "$1" "$2" >judged.txt 2>&1 || code=1
    [[ "$device" != udp ]] || stop KILL "$driving"
    ((code != 0)) || printf '%s %s' "$device" "$(<judged.txt)"$'\n'
    return "$code"
}
has_forces() { [[ -f motors.log ]] && has_lines force motors.log "$1"; }
# ends SIGNAL HOW CODE [START...]: ends the program that START starts, or hrtc. A machine that stops
# hrtc meanwhile gets two more tries.
ends() {
    local try code
    for try in 1 2 3; do
        fresh_motors
        if (($# > 3)); then "${@:4}"; else start_hrtc "${options[@]}"; fi
        if judge "$1" "$2"; then
            code=0
            wait "$controller" 2>/dev/null || code=$?
            ((code == $3)) || fault "$device $1: hrtc ended with $code: $(cat hrtc.log)"
            return
        fi
        kill -KILL "$controller" 2>/dev/null || true
        wait "$controller" 2>/dev/null || true
        echo "try $try: $(<judged.txt)"
    done
    fault "$device $1: $(<judged.txt)"
}

for signal in TERM HUP QUIT; do
    ends "$signal" fades 0
done

case $device in
    udp)
        for signal in INT USR1 XCPU; do
            ends "$signal" fades 0
        done
        # The driver's own watchdog is the only one.
        ends KILL watchdog 137

        # The reader of the output ends after the first line; the next is written after two seconds.
        start_unread() {
            "$hrtc" --allow-no-rt --domain "$domain" "${options[@]}" --report report.json \
                > >(head -n 1 >first.log) 2>&1 &
            controller=$!
            started+=("$controller")
            wait_until 'some four seconds of forces' has_forces 8000 # Two a frame.
        }
        ends TERM fades 0 start_unread
        check report.json frames '>' 3000 # A thousand after the output was closed.

        # The other programs do not end this way either.
        code=0
        "$publish" --domain "$domain" --watch --seconds 3 bumpy.spm \
            > >(head -n 1 >server.log) 2>&1 || code=$?
        ((code == 0)) || fault "without a reader spm_publish ended with $code"
        grep -q "^serving 'bumpy'" server.log || fault "the server said: $(<server.log)"
        code=0
        "$1/spm_view" --domain "$domain" --port 0 --seconds 3 > >(exec true) 2>&1 || code=$?
        ((code == 0)) || fault "without a reader spm_view ended with $code"

        # A recording that exceeds its limit: one line, and the force continues.
        start_small() {
            (
                ulimit -f 64
                exec "$hrtc" --allow-no-rt --domain "$domain" "${options[@]}" --record run.rec \
                    >hrtc.log 2>&1
            ) &
            controller=$!
            started+=("$controller")
            wait_until "some four seconds of forces" has_forces 4000 # 64 KiB suffice for one.
        }
        ends TERM fades 2 start_small
        has_lines "hrtc: --record: run.rec: can't be written: File too large" hrtc.log 1 \
            || fault "of a recording too large: $(cat hrtc.log)"
        ! ls run.rec* >/dev/null 2>&1 || fault 'half a recording is left'
        ;;
    plugin)
        ends KILL guard 137
        ends SEGV guard 139
        expect 2 "--device: the guardian can't start: $recording: its motors have one line" \
            "$hrtc" --allow-no-rt --transport file --model bumpy.spm \
            --device "plugin:$recording,motors.log,refuse"
        "$hrtc" --allow-no-rt --transport file --model bumpy.spm --duration 0.2 \
            --device "plugin:$bare,motors.log" >bare.log 2>&1 || fault "bare: $(cat bare.log)"
        grep -q "^hrtc: tool 0: $bare has no guard; if hrtc is killed, " bare.log \
            || fault "nothing tells that there is no guard: $(cat bare.log)"
        ;;
    dhd)
        # Another program can open the device after the system has closed it for the dead one.
        ends KILL opened 137
        ends SEGV opened 139
        ;;
esac
finish
