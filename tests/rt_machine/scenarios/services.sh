#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# services.sh: each command of docs/deploy.md except installing ones, verbatim; then the state of
# the services.
source ./helpers.sh
page=/usr/share/doc/tactus/docs/deploy.md
# shellcheck disable=SC2016 # The page's own marks.
sed -n '/^```sh$/,/^```$/{/^```/!p}' "$page" >commands.sh
# Another scenario runs for minutes.
sed -i 's/--duration 600/--duration 5/' commands.sh
grep -q 'duration 5' commands.sh || fail 'the page has another deadline test'
bash -eux commands.sh || fail 'a command of docs/deploy.md'
systemctl is-active spm_publish hrtc || fail 'the services do not run'
sleep 5
systemctl show hrtc spm_publish -p ActiveState,SubState,NRestarts,User,DynamicUser
policies=$(for task in /proc/"$(systemctl show -P MainPID hrtc)"/task/*; do
    chrt -p "${task##*/}" | sed -n 's/.*policy: //p' | tr '\n' ' '
done)
echo "policies: $policies"
[[ $(grep -o SCHED_FIFO <<<"$policies" | wc -l) == 2 ]] || fail 'not two threads of SCHED_FIFO'
# Hangs: systemd's watchdog ends and restarts it.
systemctl kill -s STOP hrtc
is_restarted() { [[ $(systemctl show -P NRestarts hrtc) == 1 ]]; }
wait_until 10 'restart by the watchdog' is_restarted
wait_until 10 'service' systemctl is-active --quiet hrtc
sleep 3
systemctl stop hrtc spm_publish
[[ $(systemctl show -P ExecMainStatus hrtc) == 0 ]] || fail 'hrtc does not end with 0'
cp /var/log/tactus/hrtc.json kept/report.json
journalctl -o cat -u hrtc -u spm_publish --no-pager
hrtc doctor --json >kept/doctor.json
