#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# services.sh: each command of docs/deploy.md except installing ones, verbatim, with the keys of a
# site; then the state of the services, and a stranger without keys.
source ./helpers.sh
page=/usr/share/doc/tactus/docs/deploy.md
# shellcheck disable=SC2016 # The page's own marks.
commands_of() { sed -n '/^```sh$/,/^```$/{/^```/!p}'; } # Reads a page.
sed '/^## 6\. /,$d' "$page" | commands_of >first.sh
sed -n '/^## 6\. /,$p' "$page" | commands_of >secured.sh
# Another scenario runs for minutes.
sed -i 's/--duration 600/--duration 5/' first.sh
grep -q 'duration 5' first.sh || fail 'the page has another deadline test'
grep -q '^tactus-keys ' secured.sh || fail 'the page makes its keys in another step'
{ cat first.sh; echo 'cut -d" " -f1 /proc/uptime >began'; cat secured.sh; } >commands.sh
bash -eux commands.sh || fail 'a command of docs/deploy.md'
awk -v now="$(now)" -v commands="$(grep -cv '^$' secured.sh)" \
    '{ printf "to secured services: %d commands, %.1f s\n", commands, now - $1 }' began \
    | tee kept/secured.txt
readonly services=(spm_publish hrtc spm_view)
systemctl is-active "${services[@]}" || fail 'the services do not run'
sleep 5
systemctl show hrtc spm_publish spm_view -p ActiveState,SubState,NRestarts,User,DynamicUser
policies=$(for task in /proc/"$(systemctl show -P MainPID hrtc)"/task/*; do
    chrt -p "${task##*/}" | sed -n 's/.*policy: //p' | tr '\n' ' '
done)
echo "policies: $policies"
[[ $(grep -o SCHED_FIFO <<<"$policies" | wc -l) == 2 ]] || fail 'not two threads of SCHED_FIFO'

# Each service has its own keys, requires them, and is confined.
for service in "${services[@]}"; do
    tr '\0' ' ' <"/proc/$(systemctl show -P MainPID "$service")/cmdline" >line
    cat line
    grep -q -- "--security /run/credentials/$service.service --require-security" line \
        || fail "$service runs without keys"
    systemd-analyze security --no-pager --threshold=30 "$service" >exposure.log \
        || fail "$service is exposed: $(<exposure.log)"
    tail -n 1 exposure.log | tee -a kept/secured.txt
done

# metrics PORT: the metrics of a spm_view.
metrics() {
    exec 3<>"/dev/tcp/127.0.0.1/$1" || return
    printf 'GET /metrics HTTP/1.1\r\nHost: 127.0.0.1:%s\r\nConnection: close\r\n\r\n' "$1" >&3
    cat <&3
    exec 3>&-
}
# The viewer sees the force of the controller. A viewer without keys sees no controller, and a
# controller without keys finds no model; with the keys of hand-1 it does.
spm_view --port 7301 >stranger.log 2>&1 &
stranger=$!
feels() {
    metrics 7300 >seen.txt
    awk '/^tactus_force_newtons\{controller="hand-1"/ { felt = $2 > 0 } END { exit !felt }' seen.txt
}
wait_until 60 'force of hand-1 on the page of the viewer' feels
sleep 5
metrics 7301 >unseen.txt || fail "the stranger has no page: $(<stranger.log)"
kill "$stranger"
grep -E '^tactus_(controllers|force_newtons|frames_total)' seen.txt unseen.txt || true
grep -qx 'tactus_controllers 0' unseen.txt || fail 'a viewer without keys sees a controller'
readonly touch=(hrtc --model test --wait 5 --duration 0.1)
code=0
"${touch[@]}" >stranger.log 2>&1 || code=$?
tail -n 1 stranger.log
[[ $code == 2 ]] || fail "a controller without keys ends with $code"
"${touch[@]}" --security /etc/tactus/keys/hand-1 >known.log 2>&1 \
    || fail "a controller with keys: $(tail -n 3 known.log)"

# Hangs: systemd's watchdog ends and restarts it.
systemctl kill -s STOP hrtc
is_restarted() { [[ $(systemctl show -P NRestarts hrtc) == 1 ]]; }
wait_until 10 'restart by the watchdog' is_restarted
wait_until 10 'service' systemctl is-active --quiet hrtc
sleep 3
systemctl stop "${services[@]}"
[[ $(systemctl show -P ExecMainStatus hrtc) == 0 ]] || fail 'hrtc does not end with 0'
cp /var/log/tactus/hrtc.json kept/report.json
journalctl -o cat -u hrtc -u spm_publish -u spm_view --no-pager
hrtc doctor --json >kept/doctor.json
