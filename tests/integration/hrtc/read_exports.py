#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads what `hrtc --export` wrote, by readers of its own, and holds the formats against each other.

    read_exports.py NAME FRAMES [REPORT.json]

NAME.csv, NAME.jsonl and NAME.mcap are of one recording of FRAMES frames. MCAP is read as its
specification tells, from the front, record by record, and again by its indexes: every length,
checksum, offset and count must be right. The run's report, if given, must tell the same forces.
"""
import csv
import json
import math
import struct
import sys
import zlib

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
STATISTICS, SUMMARY_OFFSET, DATA_END = 0x0B, 0x0E, 0x0F


class Cursor:
    """Little-endian values of a record's content, in turn."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, size):
        assert self.at + size <= len(self.data), "a record is shorter than its fields"
        self.at += size
        return self.data[self.at - size:self.at]

    def number(self, form):
        return struct.unpack("<" + form, self.take(struct.calcsize("<" + form)))[0]

    def text(self):
        return self.take(self.number("I")).decode("ascii")

    def array(self, form):
        """Array of tuples, after its length in bytes."""
        data, size = self.take(self.number("I")), struct.calcsize("<" + form)
        assert len(data) % size == 0, "an array ends within an item"
        return [struct.unpack_from("<" + form, data, at) for at in range(0, len(data), size)]

    def end(self):
        assert self.at == len(self.data), "a record is longer than its fields"


def records(data, start, end):
    """(offset, opcode, content) of all records from start to end."""
    at = start
    while at < end:
        assert at + 9 <= end, "a record is cut"
        opcode, size = struct.unpack_from("<BQ", data, at)
        assert at + 9 + size <= end, "a record is cut"
        yield at, opcode, data[at + 9:at + 9 + size]
        at += 9 + size


def read_schema(content):
    c = Cursor(content)
    schema = c.number("H"), (c.text(), c.text(), c.text())
    c.end()
    assert schema[0] != 0 and schema[1][1] == "jsonschema", schema
    return schema


def read_channel(content):
    c = Cursor(content)
    channel = c.number("H"), (c.number("H"), c.text(), c.text())
    assert c.number("I") == 0, "metadata of a channel"
    c.end()
    assert channel[1][2] == "json", channel
    return channel


def add_same(table, item, is_repeated):
    """Ids occur once in the data and again, equal, in the summary."""
    key, value = item
    assert (table.get(key) == value) if is_repeated else (key not in table), item
    table[key] = value


def fits(value, schema, name):
    kinds = schema["type"] if isinstance(schema["type"], list) else [schema["type"]]
    found = {bool: "boolean", int: "integer", float: "number", str: "string", list: "array",
             dict: "object", type(None): "null"}[type(value)]
    assert found in kinds or (found == "integer" and "number" in kinds), (name, value, schema)
    if isinstance(value, list):
        for item in value:
            fits(item, schema["items"], name)
    if isinstance(value, dict) and "properties" in schema:
        assert list(value) == list(schema["properties"]), (name, "other keys than its schema")
        for key, item in value.items():
            fits(item, schema["properties"][key], name + "." + key)


def read_mcap(path):
    """Messages by topic: [(sequence, time_ns, object)]."""
    with open(path, "rb") as file:
        data = file.read()
    assert data.startswith(MAGIC) and data.endswith(MAGIC), "not MCAP"
    footer_at = len(data) - len(MAGIC) - 29
    opcode, size, summary_at, offsets_at, checksum = struct.unpack_from("<BQQQI", data, footer_at)
    assert (opcode, size) == (FOOTER, 20), "no footer"
    assert summary_at <= offsets_at <= footer_at, "footer"
    assert zlib.crc32(data[summary_at:footer_at + 25]) == checksum, "checksum of the summary"

    schemas, channels, messages, chunks = {}, {}, {}, {}
    kinds = []
    for at, opcode, content in records(data, len(MAGIC), summary_at):
        kinds.append(opcode)
        c = Cursor(content)
        if opcode == HEADER:
            assert (c.text(), c.text()) == ("", "tactus")
            c.end()
        elif opcode == CHUNK:
            times = c.number("Q"), c.number("Q")
            inside_size, inside_checksum, compression = c.number("Q"), c.number("I"), c.text()
            inside = c.take(c.number("Q"))
            c.end()
            assert compression == "" and len(inside) == inside_size
            assert zlib.crc32(inside) == inside_checksum, "checksum of a chunk"
            found = {}
            for offset, kind, part in records(inside, 0, len(inside)):
                if kind == SCHEMA:
                    add_same(schemas, read_schema(part), False)
                elif kind == CHANNEL:
                    add_same(channels, read_channel(part), False)
                    assert channels[read_channel(part)[0]][0] in schemas, "a channel's schema"
                else:
                    assert kind == MESSAGE, kind
                    channel, sequence, logged, published = struct.unpack_from("<HIQQ", part)
                    assert channel in channels and logged == published
                    assert times[0] <= logged <= times[1], "a message beside its chunk's times"
                    found.setdefault(channel, []).append((logged, offset))
                    messages.setdefault(channel, []).append((sequence, logged, part[22:]))
            every = [time for index in found.values() for time, _ in index]
            assert not every or times == (min(every), max(every)), "times of a chunk"
            chunks[at] = {"times": times, "size": 9 + len(content), "inside": inside_size,
                          "found": found, "indexes": {}}
            last = chunks[at]
        elif opcode == MESSAGE_INDEX:
            channel, index = c.number("H"), c.array("QQ")
            c.end()
            assert index == last["found"].pop(channel), "an index tells of other messages"
            last["indexes"][channel] = at
            last["end"] = at + 9 + len(content)
        else:
            assert opcode == DATA_END, opcode
            assert c.number("I") == zlib.crc32(data[:at]), "checksum of the data"
            c.end()
    assert kinds[0] == HEADER and kinds[-1] == DATA_END and kinds.count(DATA_END) == 1
    assert not any(chunk["found"] for chunk in chunks.values()), "messages without an index"

    groups = {}
    for at, opcode, content in records(data, summary_at, offsets_at):
        start, end = groups.get(opcode, (at, at))
        assert end == at, "a group of the summary is torn apart"
        groups[opcode] = (start, at + 9 + len(content))
        c = Cursor(content)
        if opcode == SCHEMA:
            add_same(schemas, read_schema(content), True)
        elif opcode == CHANNEL:
            add_same(channels, read_channel(content), True)
        elif opcode == STATISTICS:
            said = [c.number("Q"), c.number("H"), *(c.number("I") for _ in range(4)),
                    c.number("Q"), c.number("Q")]
            counts = dict(c.array("HQ"))
            c.end()
            times = [time for each in messages.values() for _, time, _ in each]
            assert said == [len(times), len(schemas), len(channels), 0, 0, len(chunks),
                            min(times, default=0), max(times, default=0)], said
            assert counts == {key: len(messages.get(key, [])) for key in channels}, counts
        else:
            assert opcode == CHUNK_INDEX, opcode
            times = c.number("Q"), c.number("Q")
            chunk = chunks.pop(c.number("Q"))
            assert times == chunk["times"] and c.number("Q") == chunk["size"]
            assert dict(c.array("HQ")) == chunk["indexes"], "places of the indexes"
            length = c.number("Q")
            assert not chunk["indexes"] or chunk["end"] - min(chunk["indexes"].values()) == length
            assert c.text() == "" and (c.number("Q"), c.number("Q")) == (chunk["inside"],) * 2
            c.end()
    assert not chunks, "chunks without an index"
    for at, opcode, content in records(data, offsets_at, footer_at):
        assert opcode == SUMMARY_OFFSET
        kind, start, length = struct.unpack("<BQQ", content)
        assert groups.pop(kind) == (start, start + length), "place of a group"
    assert not groups, "groups without a place"

    topics = {}
    for key, each in messages.items():
        schema_id, topic, _ = channels[key]
        schema = json.loads(schemas[schema_id][2])
        topics[topic] = [(sequence, time, json.loads(text)) for sequence, time, text in each]
        for _, _, value in topics[topic]:
            fits(value, schema, topic)
    assert len(topics) == len(messages), "two channels of one topic"
    return topics


def cells_of(name, value):
    """Columns and cells of a JSON value, except for null."""
    if isinstance(value, list) and value and not isinstance(value[0], str):
        return [(f"{name}.{axis}", item) for axis, item in zip("xyzw", value)]
    return [(name, " ".join(value) if isinstance(value, list) else value)]


def same(cell, value):
    if isinstance(value, bool):
        return cell == str(int(value))
    if isinstance(value, str):
        return cell == value
    if value is None:  # Unknown, or not finite.
        return cell == "" or not math.isfinite(float(cell))
    return float(cell) == value


def compare_row(row, prefix, told):
    for key, value in told.items():
        for column, item in cells_of(prefix + key, value):
            if value is None and column not in row:  # Unknown vector.
                assert all(row[f"{column}.{axis}"] == "" for axis in "xyz"), column
            else:
                assert same(row[column], item), (column, row[column], item)


def main():
    name, count = sys.argv[1], int(sys.argv[2])
    with open(name + ".jsonl", encoding="ascii") as file:
        frames = [json.loads(line) for line in file]
    with open(name + ".csv", encoding="ascii", newline="") as file:
        rows = list(csv.DictReader(file, strict=True))
    topics = read_mcap(name + ".mcap")
    assert [frame["frame"] for frame in frames] == list(range(count)), len(frames)
    assert len(rows) == count and all(None not in row and None not in row.values() for row in rows)

    setup = frames[0].pop("setup")
    assert [value for _, _, value in topics.pop("/setup")] == [setup]
    parts = {"tools", "pairs", "models", "changes"}
    expected = {}
    for frame, row in zip(frames, rows):
        def send(topic, value):
            expected.setdefault(topic, []).append((frame["frame"], frame["time_ns"], value))
        own = {key: value for key, value in frame.items() if key not in parts}
        compare_row(row, "", own)
        send("/frame", own)
        for i, tool in enumerate(frame["tools"]):
            compare_row(row, f"tool{i}.", tool)
            send(f"/tool/{i}", tool)
            pairs = [pair for pair in frame["pairs"] if pair["tool"] == i]
            if pairs:
                compare_row(row, f"tool{i}.nearest.", min(pairs, key=lambda p: p["lower_m"]))
            else:
                assert row[f"tool{i}.nearest.lower_m"] == ""
        for i, model in enumerate(frame["models"]):
            compare_row(row, f"model{i}.", model)
            send(f"/model/{i}", model)
        for pair in frame["pairs"]:
            send(f"/tool/{pair['tool']}/object/{pair['object']}", pair)
        for change in frame["changes"]:
            send("/changes", change)
    assert topics == expected, "MCAP and JSON lines tell differently"
    assert len(setup["tools"]) == len(frames[0]["tools"])

    for frame in frames:
        for tool in frame["tools"]:
            length = math.hypot(*tool["device_rotation_world"])
            assert abs(length - 1.0) < 1e-12, "a rotation that is none"
        for pair in frame["pairs"]:
            assert pair["upper_m"] is None or pair["lower_m"] <= pair["upper_m"]
    if len(sys.argv) > 3:
        with open(sys.argv[3], encoding="utf-8") as file:
            report = json.load(file)
        touched = sum(any(tool["in_contact"] for tool in frame["tools"]) for frame in frames)
        assert abs(report["force"]["contact_share"] * count - touched) < 0.5 + 1e-3 * count
        for i, tool in enumerate(report["tools"]):
            assert setup["tools"][i]["radius_m"] == tool["radius_m"]
            forces = [math.hypot(*frame["tools"][i]["sent_force_world_n"]) for frame in frames]
            # The report leaves out the frames that fade the run's last forces.
            slack = 1e-5 * tool["force_max_n"]
            assert max(forces[:-51]) - slack <= tool["force_max_n"] <= max(forces) + slack, i
    print(f"{count} frames, {sum(len(each) for each in expected.values())} messages agree")


main()
