#!/usr/bin/python3 -S
# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""list_safety.py REPORT: prints the events of tool 0 in a report's `safety`, one a line: TIME_S
FRAME STATE CAUSES. FRAME is "-" for an event of the supervisor; CAUSES are joined by commas, "-" for
none.
"""

import json
import sys

with open(sys.argv[1], encoding="utf-8") as file:
    for event in json.load(file)["safety"]["events"]:
        if event["tool"] == 0:
            print(event["time_s"], "-" if event["frame"] is None else event["frame"],
                  event["state"], ",".join(event["causes"]) or "-")
