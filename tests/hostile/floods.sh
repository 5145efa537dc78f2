#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# floods.sh BIN CHECK_REPORT SANITIZER ATTACKER: cost of floods of each kind, as fast as one process
# sends them, for a server and a controller in contact: the table of docs/security.md. For each kind
# no force exceeds the device's, there is no overrun, memory is bounded, and both end well. Figures
# have little meaning on a busy machine. Python measures the threads.
flood=$(cd "$(dirname "$0")" && pwd)/datagrams.py
readonly flood
source "$(dirname "$0")/../integration/hrtc/common.sh"
source "$(dirname "$0")/strangers.sh"
readonly attacker=$4 seconds=${TACTUS_FLOOD_SECONDS:-4}

# Processor time of each thread of server and controller during the flood, as a share of one
# processor, and datagrams that the system delivered and dropped in this network namespace.
cat >meter.py <<'PYTHON'
import json
import os
import sys
import time

def threads(pid):
    times = {}
    for task in os.listdir(f"/proc/{pid}/task"):
        try:
            stat = open(f"/proc/{pid}/task/{task}/stat").read()
        except OSError:
            continue
        fields = stat.rpartition(")")[2].split()
        name = stat[stat.index("(") + 1:stat.rindex(")")]
        times[task + " " + name] = int(fields[11]) + int(fields[12])
    return times

def udp():
    names, values = [line.split()[1:] for line in open("/proc/net/snmp") if line.startswith("Udp:")]
    return dict(zip(names, map(int, values)))

pids = dict(zip(("controller", "server"), sys.argv[3:]))
before = {who: threads(pid) for who, pid in pids.items()}
udp_before, start = udp(), time.monotonic()
time.sleep(float(sys.argv[2]))
spent_s = time.monotonic() - start
udp_after = udp()
found = {"datagrams_per_s": (udp_after["InDatagrams"] - udp_before["InDatagrams"]) / spent_s,
         "dropped_per_s": (udp_after["RcvbufErrors"] - udp_before["RcvbufErrors"]) / spent_s}
for who, pid in pids.items():
    now = threads(pid)
    by_name = {}
    for key, ticks in now.items():
        name = key.split(" ", 1)[1]
        by_name[name] = by_name.get(name, 0) + ticks - before[who].get(key, 0)
    hertz = os.sysconf("SC_CLK_TCK")
    found[who] = {name: ticks / hertz / spent_s for name, ticks in by_name.items() if ticks > 0}
    peak = [line for line in open(f"/proc/{pid}/status") if line.startswith("VmHWM")][0]
    found[who]["mib"] = int(peak.split()[1]) / 1024
json.dump(found, open(sys.argv[1], "w"))
PYTHON

row() { # row KIND: prints a row from report.json and meter.json.
    python3 - "$1" <<'PYTHON'
import json
import re
import sys

report, found = json.load(open("report.json")), json.load(open("meter.json"))
sent = re.search(r"done (\d+) times in ([0-9.]+) s", open("attacker.log").read())
share = lambda who, *parts: 100 * sum(value for name, value in found.get(who, {}).items()
                                      if name != "mib" and any(p in name for p in parts))
everything = lambda who: share(who, "")
receiving = ("recv", "dq.", "tev", "udp")
frame = report["times_us"]["frame"]
print(f"{sys.argv[1]}: {int(sent[1]) / float(sent[2]):.0f} turns/s sent;"
      f" {found['datagrams_per_s']:.0f} datagrams/s taken, {found['dropped_per_s']:.0f} dropped;"
      f" frames p50 {frame['p50']:.0f} p99 {frame['p99']:.0f} max {frame['max']:.0f} us,"
      f" missed {report['deadline']['missed']} of {report['frames']},"
      f" own {report['deadline']['overrun']}, machine {report['deadline']['latency_misses']};"
      f" controller {everything('controller'):.0f} % of a processor, receiving"
      f" {share('controller', *receiving):.0f} %, {found['controller']['mib']:.0f} MiB;"
      + (f" server {everything('server'):.0f} %, {found['server']['mib']:.0f} MiB;"
         if "server" in found else "")
      + f" arrival p99 {report['wire']['arrival_ms']['p99']} ms;"
      f" load {report['machine']['load_average']}, fifo {report['machine']['fifo']};"
      f" threads {found['controller']} {found.get('server')}")
PYTHON
}

end_well() { # end_well KIND
    stop_hrtc >/dev/null
    check report.json force.max_n '<=' 8
    check_clean report.json
    check_sizes hrtc.log
    row "$1"
}

by_dds() { # by_dds KIND: the attacker's flood at its greatest rate; none: no attacker.
    local ports=() attacking=''
    start_publisher bumpy.spm --watch
    start_hrtc --model bumpy --no-static --name victim --device sim:touch \
        --duration 600 --report report.json
    wait_for_line publish.log 'controller victim subscribed'
    echo 'done 0 times in 1 s' >attacker.log
    if [[ "$1" != none ]]; then
        [[ "$1" != rtps_* ]] \
            || mapfile -t ports < <(udp_ports "$publisher" && udp_ports "$controller")
        CYCLONEDDS_URI=$stranger_uri "$attacker" "$domain" $((seconds + 1)) "$1@0" "${ports[@]}" \
            >attacker.log 2>&1 &
        attacking=$!
        started+=("$attacking")
        wait_for_line attacker.log begun
    fi
    python3 meter.py meter.json $((seconds - 1)) "$controller" "$publisher"
    [[ -z "$attacking" ]] || wait "$attacking" || fault "the attacker: $(cat attacker.log)"
    taken_kib=$(memory_kib "$publisher")
    [[ -n "$sanitizer" ]] || ((taken_kib < 60000)) || fault "$1: the server took $taken_kib KiB"
    end_well "$1"
    stop_publisher
}

by_udp() { # by_udp KIND SECONDS: floods the port of a udp device.
    local port=$((20000 + $$ % 20000)) attacking=''
    python3 "$(dirname "$flood")/../../docs/examples/udp_driver.py" "$port" 0.02 >driver.log 2>&1 &
    local driving=$!
    started+=("$driving")
    start_hrtc --transport file --model bumpy.spm --device "udp:$port" --device-frame 0,0,0.06 \
        --duration 600 --report report.json
    wait_for_sleeps 1000 "$controller"
    echo 'done 0 times in 1 s' >attacker.log
    if [[ "$2" != 0 ]]; then
        python3 "$flood" "$port" "$2" >attacker.log &
        attacking=$!
        started+=("$attacking")
        wait_for_line attacker.log begun
    fi
    python3 meter.py meter.json $((seconds - 1)) "$controller"
    [[ -z "$attacking" ]] || wait "$attacking" || fault "the flood: $(cat attacker.log)"
    end_well "$1"
    stop KILL "$driving"
}

model bumpy-sphere-20000 bumpy.spm
grep -m 1 'model name' /proc/cpuinfo || true
for kind in none rtps_nonsense rtps_garbled catalogue_flooded objects_flooded wanted_flooded \
    wanted_flooded_epochs telemetry_forged none; do
    by_dds "$kind"
done
by_udp udp_none 0
by_udp udp_flooded "$seconds"
finish
