# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""check_drivers.py DOCS C_COMPILER: the structs for drivers, in Python and in C, equal the tables
of docs/udp-device.md, field by field; both authenticate the same bytes; the module's examples run.
"""
import ctypes
import doctest
import os
import re
import subprocess
import sys
import tempfile

docs, compiler = sys.argv[1:3]
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(docs, "examples"))
import tactus_driver  # noqa: E402

SIZES = {"f64": 8, "i64": 8, "u64": 8, "u32": 4, "u16": 2, "bytes": 1}
KINDS = {"describe": tactus_driver.Describe, "sample": tactus_driver.Sample,
         "force": tactus_driver.Force}


def rows_of(text):
    """(place, bytes) of each row of the first table in `text`; `last 4` is at None."""
    rows = []
    for line in text[text.index("| at |"):].split("\n\n")[0].splitlines()[2:]:
        place, kind = (cell.strip() for cell in line.split("|")[1:3])
        words = kind.split()
        if words and words[-1] in SIZES:
            count = int(words[0]) if len(words) == 2 else 1
            rows.append((None if place.startswith("last") else int(place),
                         count * SIZES[words[-1]]))
    return rows


def fields_of(struct, begin=0):
    """The same for a ctypes struct, with its names in C."""
    for name, kind in struct._fields_:
        at = begin + getattr(struct, name).offset
        if name == "head":
            yield from ((f"head.{inner}", place, size) for inner, place, size in
                        fields_of(kind, at))
        else:
            yield name, at, ctypes.sizeof(kind)


page = open(os.path.join(docs, "udp-device.md"), encoding="utf-8").read()
common = rows_of(page[page.index("All begin and end alike"):])
fields = {}
for name, struct in KINDS.items():
    size = ctypes.sizeof(struct)
    begin = page.index(f"**{name}**, ")
    assert int(re.match(r"\*\*\w+\*\*, (\d+) bytes", page[begin:])[1]) == size, name
    rows = sorted((size - 4 if at is None else at, length)
                  for at, length in common + rows_of(page[begin:]))
    fields[name] = list(fields_of(struct))
    assert [(at, length) for _, at, length in fields[name]] == rows, \
        f"{name}: {fields[name]} is not {rows}"

# The C program prints every name's place, and the bytes of one description.
program = '#include "tactus_driver.h"\n#include <stdio.h>\nint main(void) { size_t i;\n'
for name, listed in fields.items():
    for field, _, _ in listed:
        program += (f'printf("%zu %zu\\n", offsetof(tactus_{name}, {field}), '
                    f'sizeof((({"tactus_" + name}*)0)->{field}));\n')
program += """
tactus_driver driver; tactus_sample sample; size_t size;
memset(&driver, 0, sizeof(driver)); memset(&sample, 0, sizeof(sample));
strcpy(driver.describe.name, "one"); driver.describe.mass_kg = 0.1;
driver.describe.workspace_centre_m[2] = -0.5; driver.describe.flags = TACTUS_MEASURES_ROTATION;
tactus_driver_start(&driver, 77, 0);
const unsigned char* bytes = (const unsigned char*)tactus_driver_next(&driver, &sample, 0, &size);
for (i = 0; i < size; ++i) printf("%02x", bytes[i]);
return 0; }
"""
with tempfile.TemporaryDirectory() as folder:
    source, made = os.path.join(folder, "layout.c"), os.path.join(folder, "layout")
    with open(source, "w", encoding="utf-8") as file:
        file.write(program)
    subprocess.run([compiler, "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I",
                    os.path.join(docs, "examples"), source, "-o", made], check=True)
    *places, sent = subprocess.run([made], check=True, capture_output=True,
                                   text=True).stdout.splitlines()
expected = [f"{at} {size}" for listed in fields.values() for _, at, size in listed]
assert places == expected, [(c, py) for c, py in zip(places, expected) if c != py]

driver = tactus_driver.Driver(tactus_driver.Describe(
    name=b"one", mass_kg=0.1, workspace_centre_m=(0, 0, -0.5),
    flags=tactus_driver.MEASURES_ROTATION))
driver._instance = 77
assert driver.next(tactus_driver.Sample(), 0).hex() == sent

result = doctest.testmod(tactus_driver)
assert result.attempted > 0 and result.failed == 0, result
print(f"{len(expected)} fields are as the page says, in C and in Python")
