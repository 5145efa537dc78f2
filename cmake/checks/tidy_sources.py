#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""tidy_sources.py BUILD FOLDER OUTPUT: writes the sources of each folder below FOLDER as one source
to OUTPUT, each #include once, with a compilation database. clang-tidy then checks what they include
once and not once a source, in half the time. Prints the files, the longest first.
"""
import json
import pathlib
import sys


def joined(sources):
    """One source of several; a line begins with the path of each."""
    seen = set()
    for source in sources:
        yield f"// {source}"
        for line in source.read_text(encoding="utf-8").splitlines():
            if not line.startswith("#include") or line not in seen:
                yield line
            seen.add(line)


def main(build, folder, output):
    root = pathlib.Path.cwd()
    commands = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    groups = {}  # Sources of one folder that are compiled with the same options.
    for command in commands:
        source = pathlib.Path(command["file"])
        if source.is_relative_to(root / folder) and source.suffix == ".cpp":
            options = command["command"].partition(" -o ")[0]
            groups.setdefault((source.parent, options), []).append((source, command))
    output.mkdir(parents=True, exist_ok=True)
    entries = []
    for (parent, _), members in groups.items():
        name = "_".join(parent.relative_to(root).parts)
        number = sum(pathlib.Path(entry["file"]).stem.startswith(name) for entry in entries)
        file = output.resolve() / f"{name}{number or ''}.cpp"
        text = "\n".join(joined(sorted(source.relative_to(root) for source, _ in members)))
        file.write_text(text + "\n", encoding="utf-8")
        source, command = members[0]
        entries.append({"directory": command["directory"], "file": str(file),
                        "command": command["command"].replace(str(source), str(file))})
    (output / "compile_commands.json").write_text(json.dumps(entries), encoding="utf-8")
    entries.sort(key=lambda entry: -pathlib.Path(entry["file"]).stat().st_size)
    print("\n".join(entry["file"] for entry in entries))


main(*map(pathlib.Path, sys.argv[1:]))
