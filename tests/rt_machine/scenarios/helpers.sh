# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash disable=SC2034 # The scenarios use what is set here.
# Functions of the scenarios; sourced first.
set -euo pipefail

fail() { printf 'FAULT: %s\n' "$*"; exit 1; }
now() { cut -d' ' -f1 /proc/uptime; } # Seconds since the boot.
# wait_until SECONDS WHAT COMMAND...: waits for success of the command.
wait_until() {
    local i most_s=$1 what=$2
    shift 2
    for ((i = 0; i < most_s * 20; ++i)); do
        "$@" && return
        sleep 0.05
    done
    fail "no $what after $most_s s"
}
# expect CODE TEXT COMMAND...: expects that exit code, and TEXT in the last output.
expect() {
    local code=0 wanted=$1 text=$2 output
    shift 2
    output=$("$@" 2>&1) || code=$?
    [[ $code == "$wanted" && "${output##*$'\n'}" == *"$text"* ]] \
        || fail "$*: code $code and '$output'; expected $wanted and '$text'"
}

# Services as in docs/deploy.md, with their model and tool.
serve() { # serve MODEL OPTION...
    printf 'OPTIONS="%s"\n' "$*" >/etc/default/spm_publish
    systemctl start spm_publish
}
touch_it() { # touch_it LINE...: sets the lines of hrtc.toml
    printf '%s\n' "$@" 'report = "/var/log/tactus/hrtc.json"' >/etc/tactus/hrtc.toml
    systemctl start hrtc
}
take_model() { # take_model FACES: copies one of the image's models to /var/lib/tactus/bumpy.spm
    cp "/usr/share/tactus_models/bumpy-$1.spm" /var/lib/tactus/bumpy.spm
}

# Hand on the device of docs/examples/udp_driver.py that leans on the model and releases it, once a
# second. hand.log has a line with the time, in s since the boot, for each start and end of a force.
make_hand() { # make_hand DRIVER: writes hand.py
    sed -e 's/^    hand = .*/    hand = [0.055 + 0.012 * math.cos(6.28 * now), 0.0, 0.0]/' \
        -e 's/\[0.0, 0.0, height_m\]/[0.08, 0.0, 0.0]/' -e 's/^began = /was = False\n&/' \
        -e '/^    for i in range(3):/{' \
        -e 'i\    is_felt = force.state == 1 and any(force.force_n)' \
        -e 'i\    if is_felt != was:' -e 'i\        was = is_felt' \
        -e 'i\        print("%.3f %s" % (now, "on" if was else "off"), flush=True)' -e '}' \
        "$1" >hand.py
    [[ $(grep -cE '0\.055|\[0\.08|^was = False|is_felt != was' hand.py) == 4 ]] \
        || fail "$1 is another driver"
}
start_hand() {
    make_hand /usr/share/doc/tactus/docs/examples/udp_driver.py
    PYTHONPATH=/usr/share/doc/tactus/docs/examples python3 hand.py 48500 >hand.log &
    hand=$! # Its process.
}
feels() { [[ "$(tail -n 1 hand.log)" == *" on" ]]; }
