#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""read_spm.py FILE: a second reader of SPM models, in the order of docs/spm-format.md.

It shares no code with the C++ reader, but its author knew that one: it guards page and files
against slips, not against one misreading in both.

Makes every check of that page, replays all records to full resolution and prints the figures of
the mesh as one JSON object. Exit codes: 0 sound, 1 refused with one line on stderr, 3 wrong usage.
"""

import hashlib
import json
import struct
import sys
from collections import namedtuple

NONE = 0xFFFFFFFF

Header = namedtuple("Header", """magic format coder header_bytes revision base_vertices base_faces
    records quantum_log2 position_bits ex ey ez max_depth ox oy oz quantisation_m source_vertices
    source_faces rounds max_error_quanta cell gx gy gz occupied base_bytes base_offset index_offset
    file_bytes base_hash""")
HEADER = struct.Struct("<8s2H5IiI3II3ddIIIII3IIIQQQ16s")
INDEX_ENTRY = struct.Struct("<6iQ16s")
CHUNK_ENTRY = struct.Struct("<6HH16s")
BASE_FACE = struct.Struct("<4IB")

Record = namedtuple("Record", "depth position parent star fan error bucket reach")
Model = namedtuple("Model", "header positions faces records")


class Refused(Exception):
    """The file breaks the format; the text says where."""


def require(condition, text):
    if not condition:
        raise Refused(text)


def make_crc_table():
    table = []
    for value in range(256):
        for _ in range(8):
            value = value >> 1 ^ (0x82F63B78 if value & 1 else 0)
        table.append(value)
    return table


CRC_TABLE = make_crc_table()


def crc32c(data):
    state = NONE
    for byte in data:
        state = CRC_TABLE[(state ^ byte) & 0xFF] ^ state >> 8
    return state ^ NONE


def content_hash(data):
    return hashlib.blake2b(data, digest_size=32).digest()[:16]


def checked(data, what):
    """The bytes before the closing checksum."""
    require(len(data) > 4, f"{what}: too short")
    require(struct.unpack("<I", data[-4:])[0] == crc32c(data[:-4]), f"{what}: wrong checksum")
    return data[:-4]


def piece(data, offset, size, digest, what):
    part = data[offset:offset + size]
    require(len(part) == size, f"{what}: beyond the end of the file")
    require(content_hash(part) == digest, f"{what}: wrong hash")
    return checked(part, what)


class Bytes:
    """Reads one chunk from front to back."""

    def __init__(self, data, what):
        self.data, self.at, self.what = data, 0, what

    def byte(self):
        require(self.at < len(self.data), f"{self.what}: cut short")
        self.at += 1
        return self.data[self.at - 1]

    def number(self):
        value = 0
        for shift in range(0, 35, 7):
            byte = self.byte()
            value |= (byte & 0x7F) << shift
            if byte < 0x80:
                require(value <= NONE, f"{self.what}: a number beyond 32 bits")
                return value
        raise Refused(f"{self.what}: a number of more than 5 bytes")

    def signed(self):
        coded = self.number()
        return -(coded + 1 >> 1) if coded & 1 else coded >> 1


def read_header(data):
    require(data[:8] == b"TACTSPM\n", "header: wrong magic")
    require(len(data) >= HEADER.size, "header: cut short")
    header = Header(*HEADER.unpack_from(data))
    require((header.format, header.coder) == (1, 1), "header: unknown version")
    require(header.file_bytes == len(data), "header: the file has another size")
    require(1 <= header.base_faces <= 16384, "header: base faces")
    require(3 <= header.base_vertices <= 3 * 16384, "header: base vertices")
    require(header.records <= 2**29 - 2 and header.max_depth <= 1024, "header: records or depth")
    require((header.records == 0) == (header.max_depth == 0), "header: depth without records")
    require(16 <= header.position_bits <= 24, "header: position bits")
    require(-60 <= header.quantum_log2 <= 20, "header: quantum")
    extent = (header.ex, header.ey, header.ez)
    require(max(extent) > 0 and max(extent) < 1 << header.position_bits, "header: extent")
    require(all(abs(v) <= 1e300 for v in (header.ox, header.oy, header.oz)), "header: origin")
    require(0.0 <= header.quantisation_m <= 1e300, "header: quantisation")
    regions = check_regions(header, extent)
    pages = page_count(header)
    require(header.header_bytes == HEADER.size + 48 * pages + (regions + 7) // 8 + 36,
            "header: stated size")
    body = checked(data[:header.header_bytes], "header")
    require(hashlib.blake2b(body[:-32], digest_size=32).digest() == body[-32:], "header: root hash")
    bits = body[HEADER.size + 48 * pages:-32]
    require(sum(bin(byte).count("1") for byte in bits) == header.occupied, "header: occupied")
    index = [INDEX_ENTRY.unpack_from(body, HEADER.size + 48 * page) for page in range(pages)]
    return header, index


def check_regions(header, extent):
    grid = (header.gx, header.gy, header.gz)
    require(header.cell > 0 and header.cell & header.cell - 1 == 0, "header: region edge")
    require(all(0 < cells and cells * header.cell > size for cells, size in zip(grid, extent)),
            "header: regions do not cover the model")
    regions = header.gx * header.gy * header.gz
    require(regions <= 1 << 18 and 1 <= header.occupied <= regions, "header: regions")
    return regions


def chunk_count(header):
    return (header.records + 63) // 64


def page_count(header):
    return (chunk_count(header) + 63) // 64


def read_base(data, header):
    size = 12 * header.base_vertices + 17 * header.base_faces + 4
    require(header.base_bytes == size, "base: stated size")
    body = piece(data, header.base_offset, size, header.base_hash, "base")
    extent = (header.ex, header.ey, header.ez)
    positions = [struct.unpack_from("<3I", body, 12 * i) for i in range(header.base_vertices)]
    for position in positions:
        require(all(p <= most for p, most in zip(position, extent)), "base: a vertex outside")
    faces = []
    for i in range(header.base_faces):
        *corners, _bucket, error = BASE_FACE.unpack_from(body, 12 * header.base_vertices + 17 * i)
        require(max(corners) < header.base_vertices, "base: a foreign vertex")
        require(len(set(corners)) == 3, "base: a face with equal corners")
        faces.append((tuple(corners), error))
    return positions, faces


def read_chunks(data, header, index):
    """Yields (number, influence box in quanta, bytes without checksum) of each chunk."""
    page_at = header.index_offset
    for page, (lx, ly, lz, hx, hy, hz, chunk_at, digest) in enumerate(index):
        low, high = (lx, ly, lz), (hx, hy, hz)
        count = min(64, chunk_count(header) - 64 * page)
        body = piece(data, page_at, 4 + 30 * count + 4, digest, f"index page {page}")
        page_at += 4 + 30 * count + 4
        require(struct.unpack_from("<I", body)[0] == page, f"index page {page}: another page")
        steps = [(b - a) // 65535 + 1 for a, b in zip(low, high)]
        for i in range(count):
            number = 64 * page + i
            *box, size, chunk_digest = CHUNK_ENTRY.unpack_from(body, 4 + 30 * i)
            require(0 < size <= 8448, f"chunk {number}: stated size")
            least = [a + s * b for a, s, b in zip(low, steps, box[:3])]
            most = [a + s * b for a, s, b in zip(low, steps, box[3:])]
            require(all(a <= b for a, b in zip(least, most)), f"chunk {number}: box")
            yield number, (least, most), piece(data, chunk_at, size, chunk_digest,
                                               f"chunk {number}")
            chunk_at += size


def read_records(body, number, header):
    what = f"chunk {number}"
    count = min(64, header.records - 64 * number)
    require(len(body) >= 5 and struct.unpack_from("<IB", body) == (number, count),
            f"{what}: another chunk")
    reader = Bytes(body[5:], what)
    position = [0, 0, 0]
    for place in range(count):
        yield read_record(reader, 64 * number + place, position, header)
    require(reader.at == len(reader.data), f"{what}: bytes behind the last record")


def read_record(reader, own, position, header):
    """`position` is that of the record before, in the same chunk, and moves on."""
    what = f"record {own}"
    depth, shape = reader.number(), reader.byte()
    fan_size, has = shape & 7, (bool(shape & 8), bool(shape & 16))
    require(1 <= depth <= header.max_depth, f"{what}: depth")
    require(1 <= fan_size <= 6 and shape < 32 and any(has), f"{what}: shape")
    for axis, most in enumerate((header.ex, header.ey, header.ez)):
        position[axis] += reader.signed()
        require(0 <= position[axis] <= most, f"{what}: outside the extent")
    parent = reader.number()
    require(parent < header.base_vertices + header.records, f"{what}: parent")
    require(parent != header.base_vertices + own, f"{what}: is its own parent")
    star = [header.base_faces + 2 * own + side if has[side] else NONE for side in range(2)]
    fan = []
    for _ in range(fan_size):
        face, state = reader.number(), reader.number() - 1
        require(face < header.base_faces + 2 * header.records, f"{what}: a foreign face")
        if state < 0:
            require(face < header.base_faces, f"{what}: no base face")
        else:
            require(state >> 3 < header.records and state >> 3 != own, f"{what}: state")
        require(face not in star[2:], f"{what}: a face twice in one fan")
        star.append(face)
        fan.append((face, state))
    error = [0 if face == NONE else reader.byte() for face in star]
    bucket = [reader.number() if side else 0 for side in has]
    reach = reader.byte()
    require(reach > 0, f"{what}: reach")
    return Record(depth, tuple(position), parent, star, fan, error, bucket, reach)


def read_model(data):
    header, index = read_header(data)
    positions, faces = read_base(data, header)
    records = []
    for number, (low, high), body in read_chunks(data, header, index):
        for record in read_records(body, number, header):
            inside = all(a <= p <= b for a, p, b in zip(low, record.position, high))
            require(inside, f"record {len(records)}: outside its chunk's influence box")
            records.append(record)
    return Model(header, positions, faces, records)


def link(model):
    """Checks what ties records together; the order in which all of them can be split."""
    taken = {}
    for own, record in enumerate(model.records):
        deepest = 0
        for face, state in record.fan:
            if state < 0:
                error = model.faces[face][1]
            else:
                owner = model.records[state >> 3]
                place = state & 7
                require(place < len(owner.star) and owner.star[place] == face,
                        f"record {own}: face {face} is not in the star that it names")
                deepest = max(deepest, owner.depth)
                error = owner.error[place]
            require(error > 0, f"record {own}: splits an exact face")
            require((face, state) not in taken, f"record {own}: face {face} is taken")
            taken[face, state] = own
        require(record.depth == deepest + 1, f"record {own}: wrong depth")
    return sorted(range(len(model.records)), key=lambda own: (model.records[own].depth, own))


def replay(model, order):
    """Splits every record; the corners of all faces, by face id."""
    corners = {face: list(entry[0]) for face, entry in enumerate(model.faces)}
    state = dict.fromkeys(corners, -1)
    for own in order:
        record = model.records[own]
        vertex = model.header.base_vertices + own
        ring = []
        for face, before in record.fan:
            require(state.get(face) == before, f"record {own}: face {face} is in another state")
            require(record.parent in corners[face], f"record {own}: face {face} misses the parent")
            at = corners[face].index(record.parent)
            first, second = corners[face][(at + 1) % 3], corners[face][(at + 2) % 3]
            require(not ring or ring[-1] == first, f"record {own}: a gap in the fan")
            ring = ring or [first]
            ring.append(second)
            corners[face][at] = vertex
        for side, new in ((0, [vertex, record.parent, ring[0]]),
                          (1, [vertex, ring[-1], record.parent])):
            if record.star[side] != NONE:
                corners[record.star[side]] = new
        for place, face in enumerate(record.star):
            if face != NONE:
                state[face] = own << 3 | place
    for face, value in state.items():
        error = model.faces[face][1] if value < 0 else model.records[value >> 3].error[value & 7]
        require(error == 0, f"face {face}: not exact after all splits")
    return corners


def count_border(corners):
    """Edges with one face. Refuses a mesh that is not 2-manifold or not evenly oriented."""
    edges, round_vertex = set(), {}
    for a, b, c in corners.values():
        require(len({a, b, c}) == 3, "mesh: a face with equal corners")
        for edge in ((a, b), (b, c), (c, a)):
            require(edge not in edges, f"mesh: two faces on the same side of edge {edge}")
            edges.add(edge)
        for vertex, first, second in ((a, b, c), (b, c, a), (c, a, b)):
            round_vertex.setdefault(vertex, {})[first] = second
    for vertex, after in round_vertex.items():
        starts = set(after) - set(after.values())
        require(len(starts) <= 1, f"mesh: vertex {vertex} has more than one fan")
        at = next(iter(starts), next(iter(after)))
        steps = 0
        while at in after and steps < len(after):
            at, steps = after[at], steps + 1
        require(steps == len(after), f"mesh: vertex {vertex} has more than one fan")
    return sum((b, a) not in edges for a, b in edges), len(edges), len(round_vertex)


def figures(data):
    model = read_model(data)
    header = model.header
    corners = replay(model, link(model))
    border, half_edges, vertices = count_border(corners)
    require(len(corners) == header.source_faces, "mesh: another face count than the header states")
    require(vertices == header.source_vertices, "mesh: another vertex count than stated")
    require(vertices == header.base_vertices + header.records, "mesh: vertices that no face uses")
    edges = (half_edges + border) // 2
    return {"faces": len(corners), "vertices": vertices, "records": header.records,
            "base_faces": header.base_faces, "border_edges": border,
            "euler": vertices - edges + len(corners)}


def main(arguments):
    if len(arguments) != 1:
        print("usage: read_spm.py FILE", file=sys.stderr)
        return 3
    try:
        with open(arguments[0], "rb") as file:
            print(json.dumps(figures(file.read())))
        return 0
    except (OSError, Refused) as error:
        print(f"read_spm.py: {arguments[0]}: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
