#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# units.sh UNIT...: systemd knows every line of the services and rates their exposure 3.0 at most.
set -euo pipefail
command -v systemd-analyze >/dev/null || { echo 'skipped: systemd-analyze is missing'; exit 77; }
for unit; do
    rating=$(systemd-analyze security --offline=true --threshold=30 "$unit" 2>&1) || {
        grep -vF '✓' <<<"$rating"
        exit 1
    }
    ! grep -E 'Unknown|Failed to parse|ignoring' <<<"$rating" || exit 1
    tail -n 1 <<<"$rating"
done
