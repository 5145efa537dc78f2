#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# faults.sh: server killed, controller killed, clock set back, disk full; watched by a hand at the
# other end of the device.
source ./helpers.sh
take_model 200000
serve bumpy.spm
start_hand
# The model is larger than the pools, so that a lost server has an effect.
touch_it 'model = "bumpy"' 'tool = "sphere:0.004"' 'device = "udp"' 'wait = 60'
wait_until 20 'force' feels

ms_between() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.0f", (b - a) * 1000 }'; }
# first_after SECONDS on|off: prints the first start or end of a force after that time.
first_after() { awk -v t="$1" -v what="$2" '$1 >= t && $2 == what { print $1; exit }' hand.log; }
# kill_it SERVICE: kills it during a force; $at is the time. systemd starts it again.
kill_it() {
    local id
    id=$(systemctl show -P MainPID "$1")
    wait_until 5 'force' feels
    at=$(now)
    kill -KILL "$id"
    sleep 3.5
    [[ $(systemctl show -P NRestarts "$1") -ge 1 ]] || fail "systemd did not restart $1"
}
tell() { # tell SERVICE GONE BACK
    local gone back
    [[ -n "$2" && -n "$3" ]] || fail "$1 killed at $at: $(tail -n 8 hand.log)"
    gone=$(ms_between "$at" "$2")
    back=$(ms_between "$at" "$3")
    echo "$1 killed: force gone after $gone ms, back after $back ms" | tee -a kept/faults.txt
    ((gone <= $4)) || fail 'the force stays too long'
    ((back <= 3000)) || fail 'contact comes back too late'
}

# The driver's watchdog remains: no datagram for 20 ms. /proc/uptime has hundredths, and systemd
# also takes time. Then no force before the next hrtc runs.
kill_it hrtc
gone=$(first_after "$at" off)
tell hrtc "$gone" "$(first_after "$gone" on)" 60

# Detected after 500 ms; then the force fades within 50, and none returns before a server does.
kill_it spm_publish
gone=$(journalctl -o short-monotonic -u hrtc | grep -F 'disconnected; the resident data' \
    | sed 's/^\[ *\([0-9.]*\)\].*/\1/')
again=$(systemctl show -P ExecMainStartTimestampMonotonic spm_publish)
again=${again%??????}.${again: -6}
[[ $(journalctl -o cat -u hrtc | grep -c 'is served again') == 1 ]] || fail 'not served again'
echo "server killed at $at, gone $gone, started again $again"
felt=$(awk -v from="$gone" -v to="$again" '$1 > from + 0.06 && $1 < to && $2 == "on"' hand.log)
[[ -z "$felt" ]] || fail "without a server a force is felt: $(tail -n 20 hand.log)"
tell spm_publish "$gone" "$(first_after "$again" on)" 600

# The wall clock is set back an hour: nothing here depends on it.
wait_until 5 'force' feels
restarts=$(systemctl show -P NRestarts hrtc)
at=$(now)
date -s '-1 hour' >/dev/null
sleep 3
[[ -n $(first_after "$at" on) ]] || fail 'no force after the clock was set back'
[[ $(systemctl show -P NRestarts hrtc) == "$restarts" ]] || fail 'hrtc was restarted'
systemctl stop hrtc
kill "$hand"
cp /var/log/tactus/hrtc.json kept/report.json
echo "clock set back an hour: $(journalctl -o cat -u hrtc | grep '^deadlines' | tail -n 1)" \
    | tee -a kept/faults.txt

# No space: refused by name, nothing left, and old files stay.
mkdir /full
mount -t tmpfs -o size=64k tmpfs /full
cp /etc/os-release /full/small.spm
expect 2 '/full/small.spm' spm_build --shape bumpy-sphere --faces 20000 -o /full/small.spm
cmp /etc/os-release /full/small.spm
dd if=/dev/zero of=/full/filler bs=1k count=40 status=none
readonly run=(hrtc --transport file --model /var/lib/tactus/bumpy.spm --duration 3)
code=0
"${run[@]}" --record /full/run.rec >record.log 2>&1 || code=$?
grep '/full/run.rec' record.log || fail "no word of the recording: $(tail -n 3 record.log)"
[[ $code == 2 && ! -e /full/run.rec ]] || fail "--record on a full disk ends with $code"
dd if=/dev/zero of=/full/more bs=1k status=none 2>/dev/null || true
code=0
"${run[@]}" --report /full/run.json >report.log 2>&1 || code=$?
grep '/full/run.json' report.log || fail "no word of the report: $(tail -n 3 report.log)"
[[ $code == 2 && ! -e /full/run.json ]] || fail "--report on a full disk ends with $code"
[[ -z $(find /full -name '*.partial') ]] || fail "left behind: $(ls /full)"
echo 'disk full: refused, nothing left' | tee -a kept/faults.txt
