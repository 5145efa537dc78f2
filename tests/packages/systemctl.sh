#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# systemctl [--quiet] [--system] ACTION UNIT...: replaces systemd. Each call is a line of
# /run/systemctl.log; services are started and stopped as in their units, but as root and without
# limits.
set -euo pipefail
echo "$*" >>/run/systemctl.log
while [[ "${1:-}" == --* ]]; do
    shift
done
action=$1
shift
mkdir -p /run/services

setting() { sed -n "s/^$1=//p" "/usr/lib/systemd/system/$unit"; } # setting KEY
is_active() { [[ -f "/run/services/$unit" ]] && kill -0 "$(<"/run/services/$unit")" 2>/dev/null; }
start() {
    (
        OPTIONS=
        environment=$(setting EnvironmentFile)
        if [[ -n "$environment" ]]; then
            # shellcheck disable=SC1090 # What the unit names.
            source "$environment"
        fi
        folder=$(setting WorkingDirectory)
        cd "${folder#-}"
        # shellcheck disable=SC2016,SC2086 # The unit's words; systemd splits them as well.
        exec $(setting ExecStart | sed 's/ \$OPTIONS$//') $OPTIONS
    ) >"/run/services/$unit.log" 2>&1 </dev/null &
    echo "$!" >"/run/services/$unit"
    disown
}
stop() {
    local id
    id=$(<"/run/services/$unit")
    kill -TERM "$id"
    while kill -0 "$id" 2>/dev/null; do
        sleep 0.05
    done
    rm "/run/services/$unit"
}

for unit; do
    case "$action" in
        start) is_active || start ;;
        stop) ! is_active || stop ;;
        try-restart)
            if is_active; then
                stop
                start
            fi
            ;;
        is-active) is_active ;;
        is-enabled) [[ -L "/etc/systemd/system/multi-user.target.wants/$unit" ]] ;;
        enable)
            mkdir -p /etc/systemd/system/multi-user.target.wants
            ln -s "/lib/systemd/system/$unit" /etc/systemd/system/multi-user.target.wants/
            ;;
        daemon-reload) ;;
        *) echo "systemctl: unknown action '$action'" >&2 && exit 1 ;;
    esac
done
