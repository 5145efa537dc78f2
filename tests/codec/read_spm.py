#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""read_spm.py FILE [TABLE]: a second reader of SPM models, in the order of docs/internals/spm-format.md.

It shares no code with the C++ reader, but its author knew that one: it guards page and files
against slips, not against one misreading in both. TABLE holds the probabilities that a chunk starts
with; without it, it is looked for where the source tree has it.

Makes every check of that page, replays all records to full resolution and prints the figures of
the mesh as one JSON object. Exit codes: 0 sound, 1 refused with one line on stderr, 3 wrong usage.
"""

import hashlib
import json
import math
import os
import struct
import sys
from collections import namedtuple
from itertools import accumulate

ONES = 0xFFFFFFFF
BASE = -1  # The base state of a face; (q, place) otherwise.
TABLE = os.path.join(os.path.dirname(os.path.abspath(__file__)),
                     "../../rt_core/spm/chunk_model.inc")

Header = namedtuple("Header", """magic format coder header_bytes revision base_vertices base_faces
    records quantum_log2 position_bits topology ex ey ez max_depth ox oy oz quantisation_m source_vertices
    source_faces rounds max_error_quanta cell gx gy gz occupied base_bytes base_offset index_offset
    file_bytes base_hash""")
HEADER = struct.Struct("<8s2H5Ii2H3II3ddIIIII3IIIQQQ16s")
INDEX_ENTRY = struct.Struct("<6iQ16s")
CHUNK_ENTRY = struct.Struct("<6HH16s")

# Fields of a record as its chunk codes them. An owner is ("base", face), ("record", q) or None for
# a derived one.
Coded = namedtuple("Coded", "anchor place corner left right sides others residual errors steps")
# Decoded record: `ring` is w0 .. wk, `star` face ids by place, None without a face, `before` the
# states of the fan faces, `error` and `bucket` like `star` and for A and B.
Record = namedtuple("Record", "depth position parent ring star before error bucket")
Model = namedtuple("Model", "header positions faces records")


class Refused(Exception):
    """Violation of the format; the text gives the place."""


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
    state = ONES
    for byte in data:
        state = CRC_TABLE[(state ^ byte) & 0xFF] ^ state >> 8
    return state ^ ONES


def content_hash(data):
    return hashlib.blake2b(data, digest_size=32).digest()[:16]


def checked(data, what, behind=b""):
    """Bytes before the closing checksum, which may also cover others."""
    require(len(data) >= 4, f"{what}: too short")
    sum_of = crc32c(data[:-4] + behind)
    require(struct.unpack("<I", data[-4:])[0] == sum_of, f"{what}: wrong checksum")
    return data[:-4]


def piece(data, offset, size, digest, what, behind=b""):
    part = data[offset:offset + size]
    require(len(part) == size, f"{what}: beyond the end of the file")
    require(content_hash(part) == digest, f"{what}: wrong hash")
    return checked(part, what, behind)


def read_table(path):
    with open(path, encoding="ascii") as file:
        try:
            table = [int(number) for number in file.read().split(",")]
        except ValueError as error:
            raise Refused(f"{path}: {error}") from error
    require(len(table) == MODEL_SIZE, f"{path}: {len(table)} numbers, not {MODEL_SIZE}")
    require(all(0 < number < 4096 for number in table), f"{path}: a number out of range")
    return table


# Section 6.3: start of each model in the table. A signed number has 1 + 32 + 32 x 4.
SIGNED = 161
SIZES = {"tier_step": 2 * 3 * 16, "owner_step": 2 * 2 * SIGNED, "place": 2 * 8, "corner": 8 * 4,
         "left": 8, "right": 8 * 8, "has_one_side": 1, "has_only_b": 1, "is_named": 2 * 4,
         "residual_width": 2 * 12 * 32, "residual_bits": 2 * 32 * 4, "residual_sign": 2,
         "is_exact": 4, "largest_error": SIGNED, "error_below": 2 * 3 * 16,
         "bucket_step": 2 * SIGNED, "has_no_side": 1}
AT = dict(zip(SIZES, accumulate(SIZES.values(), initial=0)))
MODEL_SIZE = sum(SIZES.values())


class RangeDecoder:
    """Sections 6.1 and 6.2. Models are named by their start in the table."""

    def __init__(self, data, table):
        self.data, self.at, self.p = data, 0, list(table)
        self.range, self.code = ONES, 0
        for _ in range(4):
            self.code = self.code << 8 | self.next_byte()

    def next_byte(self):
        self.at += 1
        return self.data[self.at - 1] if self.at <= len(self.data) else 0

    def refill(self):
        while self.range < 1 << 24:
            self.range <<= 8
            self.code = (self.code << 8 | self.next_byte()) & ONES

    def bit(self, model):
        p = self.p[model]
        bound = (self.range >> 12) * p
        if self.code < bound:
            self.range, bit = bound, 0
            self.p[model] = p + (4096 - p >> 5)
        else:
            self.code, self.range, bit = self.code - bound, self.range - bound, 1
            self.p[model] = p - (p >> 5)
        self.refill()
        return bit

    def raw(self, bits):
        value = 0
        for _ in range(bits):
            self.range >>= 1
            bit = int(self.code >= self.range)
            self.code -= bit * self.range
            value = value << 1 | bit
            self.refill()
        return value

    def tree(self, bits, model):
        node = 1
        for _ in range(bits):
            node = node << 1 | self.bit(model + node)
        return node - (1 << bits)

    def rest(self, width, model):
        """Number of `width` bits, with `model` as N."""
        if width < 2:
            return width
        number, known = 1, min(2, width - 1)
        for _ in range(known):
            number = number << 1 | self.bit(model + 4 * width + number)
        raw = width - 1 - known
        return number << raw | self.raw(raw)

    def signed(self, model):
        number = self.rest(self.tree(5, model + 1), model + 33)
        return -number if number and self.bit(model) else number


def read_header(data):
    require(data[:8] == b"TACTSPM\n", "header: wrong magic")
    require(len(data) >= HEADER.size, "header: cut short")
    header = Header(*HEADER.unpack_from(data))
    require((header.format, header.coder) == (1, 3), "header: unknown version")
    require(header.file_bytes == len(data), "header: the file has another size")
    require(1 <= header.base_faces <= 16384, "header: base faces")
    require(3 <= header.base_vertices <= 3 * 16384, "header: base vertices")
    require(header.records <= 2**29 - 2 and header.max_depth <= 1024, "header: records or depth")
    require((header.records == 0) == (header.max_depth == 0), "header: depth without records")
    require(16 <= header.position_bits <= 24, "header: position bits")
    require(header.topology <= 1, "header: topology")
    require(-60 <= header.quantum_log2 <= 20, "header: quantum")
    extent = (header.ex, header.ey, header.ez)
    require(max(extent) > 0 and max(extent) < 1 << header.position_bits, "header: extent")
    extent_m = [e * 2.0**header.quantum_log2 for e in extent]
    require(all(-1e7 <= o and o + e <= 1e7 for o, e in zip((header.ox, header.oy, header.oz), extent_m)),
            "header: origin")
    require(0.0 <= header.quantisation_m <= math.hypot(*extent_m), "header: quantisation")
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
    extent = (header.ex, header.ey, header.ez)
    axis_bits = [most.bit_length() for most in extent]
    corner_bits = (header.base_vertices - 1).bit_length()
    bucket_bits = (max(header.source_faces - 1, 0) // 8).bit_length()
    bits = (header.base_vertices * sum(axis_bits) +
            header.base_faces * (3 * corner_bits + bucket_bits + 8))
    size = (bits + 7) // 8 + 4
    require(header.base_bytes == size, "base: stated size")
    body = piece(data, header.base_offset, size, header.base_hash, "base")
    stream, at = int.from_bytes(body, "little"), 0
    fields = []
    for width in ([*axis_bits] * header.base_vertices +
                  [corner_bits, corner_bits, corner_bits, bucket_bits, 8] * header.base_faces):
        fields.append(stream >> at & (1 << width) - 1)
        at += width
    split = 3 * header.base_vertices
    positions = [tuple(fields[i:i + 3]) for i in range(0, split, 3)]
    for position in positions:
        require(all(p <= most for p, most in zip(position, extent)), "base: a vertex outside")
    faces = []
    for i in range(split, len(fields), 5):
        *corners, bucket, error = fields[i:i + 5]
        require(max(corners) < header.base_vertices, "base: a foreign vertex")
        require(len(set(corners)) == 3, "base: a face with equal corners")
        faces.append((tuple(corners), bucket, error))
    return positions, faces


def read_chunks(data, header, index):
    """Yields (number, influence box in quanta, code) of each chunk."""
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
                                               f"chunk {number}", struct.pack("<I", number))
            chunk_at += size


def tier_of(record):
    """Number, first record and end of the record's tier if it were full."""
    tier, first, end = 0, 0, 64
    while record >= end:
        tier, first, end = tier + 1, end, 5 * end
    return tier, first, end


class ChunkReader:
    """Section 6.4: the records of one chunk as coded."""

    def __init__(self, code, number, header, table):
        self.coder, self.header = RangeDecoder(code, table), header
        self.what = f"chunk {number}"
        self.first = 64 * number
        self.tier, first, end = tier_of(self.first)
        ahead, size = self.first - first, min(end, header.records) - first
        self.last = []
        for tier in range(self.tier + 1):
            begin = 64 * 5**(tier - 1) if tier else 0
            self.last.append(begin + ahead * (64 * 5**tier - begin) // size)
        self.anchor_step, self.exact_before, self.largest = 0, 0, 0
        self.widths = [0, 0]

    def records(self):
        count = min(64, self.header.records - self.first)
        for own in range(self.first, self.first + count):
            yield self.record(own)
        require(self.coder.at >= len(self.coder.data), f"{self.what}: bytes left over")

    def record(self, own):
        coder = self.coder
        anchor = self.owner(0, own)
        place = 0
        if anchor[0] == "record":
            place = coder.tree(3, AT["place"] + 8 * (self.anchor_step != 0))
        corner = coder.tree(2, AT["corner"] + 4 * place)
        require(corner < 3, f"record {own}: corner")
        left = coder.tree(3, AT["left"])
        right = coder.tree(3, AT["right"] + 8 * left)
        require(left + 1 + right <= 6, f"record {own}: fan size")
        sides = (True, True)
        if coder.bit(AT["has_one_side"]):
            if coder.bit(AT["has_no_side"]):
                sides = (False, False)
            else:
                sides = (False, True) if coder.bit(AT["has_only_b"]) else (True, False)
        others = []
        for side, count in enumerate((right, left)):
            for number in range(count):
                named = coder.bit(AT["is_named"] + 4 * side + min(number, 3))
                others.append(self.owner(1, own) if named else None)
        residual = [self.residual(i) for i in range(3)]
        require(all(abs(d) <= 1 << 27 for d in residual), f"record {own}: residual")
        return Coded(anchor, place, corner, left, right, sides, others, residual,
                     self.errors(own, sides, left + 1 + right), self.bucket_steps(sides))

    def owner(self, role, own):
        coder = self.coder
        step = coder.tree(4, AT["tier_step"] + 16 * (3 * role + min(self.anchor_step, 2)))
        if role == 0:
            self.anchor_step = step
        if step == 15:
            face = coder.raw((self.header.base_faces - 1).bit_length())
            require(face < self.header.base_faces, f"record {own}: no base face")
            return "base", face
        tier = max(self.tier - step, 0)
        start = own if step == 0 else self.last[tier]
        record = start + coder.signed(AT["owner_step"] + SIGNED * (2 * role + (step != 0)))
        require(0 <= record < self.header.records, f"record {own}: names a foreign record")
        require(record != own, f"record {own}: names itself")
        self.last[tier] = record
        return "record", record

    def residual(self, i):
        coder, kind = self.coder, int(i == 2)
        group = min(self.widths[kind], 11)
        width = coder.tree(5, AT["residual_width"] + 32 * (12 * kind + group))
        number = coder.rest(width, AT["residual_bits"] + 128 * kind)
        self.widths[kind] = max(self.widths[0], width) if i == 1 else width
        return -number if number and coder.bit(AT["residual_sign"] + kind) else number

    def errors(self, own, sides, fan_size):
        coder = self.coder
        exact = coder.bit(AT["is_exact"] + self.exact_before)
        self.exact_before = (2 * self.exact_before + exact) % 4
        errors = [0] * (2 + fan_size)
        if exact:
            return errors
        self.largest += coder.signed(AT["largest_error"])
        require(1 <= self.largest <= 255, f"record {own}: largest error")
        group = 0
        for place in range(2 + fan_size):
            if place >= 2 or sides[place]:
                steps = coder.tree(4, AT["error_below"] + 16 * (3 * (place >= 2) + group))
                errors[place] = 0 if steps == 15 else max(self.largest - 2 * steps, 1)
                group = 1 if steps == 15 else 2
        return errors

    def bucket_steps(self, sides):
        steps = [0, 0]
        for side in range(2):
            if sides[side]:
                second = side == 1 and sides[0]
                steps[side] = self.coder.signed(AT["bucket_step"] + SIGNED * second)
        return steps


class Missing(Exception):
    """Dependency that must be resolved first."""


def rounded(a, b):
    return (2 * a + b) // (2 * b)


def toward_zero(a, b):
    return -(-a // b) if a < 0 else a // b


def predicted(points, residual):
    """Section 6.6: position of the vertex, from the ring and the residual."""
    count = len(points)
    mean = [rounded(sum(point[axis] for point in points), count) for axis in range(3)]
    edges = [[point[axis] - mean[axis] for axis in range(3)] for point in points]
    normal = [0, 0, 0]
    for e, f in zip(edges, edges[1:] + edges[:1]):
        for axis in range(3):
            a, b = (axis + 1) % 3, (axis + 2) % 3
            normal[axis] += e[a] * f[b] - e[b] * f[a]
    z = max((2, 0, 1), key=lambda axis: abs(normal[axis]))
    outward = -1 if normal[z] < 0 else 1
    shift = max(abs(normal[z]).bit_length() - 30, 0)
    normal = [toward_zero(component, 1 << shift) for component in normal]
    a, b = (z + 1) % 3, (z + 2) % 3
    height = 0
    if normal[z]:
        height = rounded(-outward * (normal[a] * residual[0] + normal[b] * residual[1]),
                         abs(normal[z]))
    v = [0, 0, 0]
    v[a], v[b] = mean[a] + residual[0], mean[b] + residual[1]
    v[z] = mean[z] + height + outward * residual[2]
    return tuple(v)


class Resolver:
    """Section 6.5 to 6.7: decodes records from their coded form."""

    def __init__(self, header, positions, faces, coded):
        self.header, self.positions, self.faces, self.coded = header, positions, faces, coded
        self.records = [None] * len(coded)

    def resolve_all(self):
        for record in range(len(self.coded)):
            stack = [] if self.records[record] else [record]
            waiting = set(stack)
            while stack:
                try:
                    self.records[stack[-1]] = self.resolve(stack[-1])
                    waiting.discard(stack.pop())
                except Missing as missing:
                    needed = missing.args[0]
                    require(needed not in waiting, f"record {needed}: waits for itself")
                    waiting.add(needed)
                    stack.append(needed)

    def known(self, record):
        if self.records[record] is None:
            raise Missing(record)
        return self.records[record]

    def corners(self, own, place):
        record, v = self.known(own), self.header.base_vertices + own
        if place == 0:
            return v, record.parent, record.ring[0]
        if place == 1:
            return v, record.ring[-1], record.parent
        return v, record.ring[place - 2], record.ring[place - 1]

    def place_at(self, own, edge):
        """Place in the star, fan first, of the face with the edge, and the face's third corner."""
        star = self.known(own).star
        for place in (*range(2, len(star)), 0, 1):
            face = star[place]
            third = third_corner(self.corners(own, place), edge) if face is not None else None
            if third is not None:
                return place, third
        return None

    def brought_by(self, vertex):
        return None if vertex < self.header.base_vertices else vertex - self.header.base_vertices

    def position(self, vertex):
        record = self.brought_by(vertex)
        return self.positions[vertex] if record is None else self.known(record).position

    def bucket(self, face):
        if face < self.header.base_faces:
            return self.faces[face][1]
        record, side = divmod(face - self.header.base_faces, 2)
        return self.known(record).bucket[side]

    def error(self, face, state):
        return self.faces[face][2] if state == BASE else self.records[state[0]].error[state[1]]

    def resolve(self, own):
        coded = self.coded[own]
        fan_size = coded.left + 1 + coded.right
        ring, star, states = [None] * (fan_size + 1), [None] * (fan_size + 2), [None] * fan_size
        u, first, second, star[2 + coded.left], states[coded.left] = self.anchor(own)
        ring[coded.left], ring[coded.left + 1] = first, second
        met = [states[coded.left]]
        others = iter(coded.others)
        steps = ([(p, p + 1) for p in range(coded.left + 1, fan_size)] +
                 [(p, p) for p in reversed(range(coded.left))])
        for place, open_end in steps:
            edge = (u, ring[place]) if open_end > place else (ring[place + 1], u)
            face, state, third = self.step(own, next(others), edge, met)
            ring[open_end], star[2 + place], states[place] = third, face, state
            met.append(state)
        require(len(set(star[2:])) == fan_size, f"record {own}: a face twice in one fan")
        depth = 1 + max(0 if s == BASE else self.records[s[0]].depth for s in states)
        require(depth <= self.header.max_depth, f"record {own}: depth")
        for side in range(2):
            if coded.sides[side]:
                star[side] = self.header.base_faces + 2 * own + side
        position = predicted([self.position(vertex) for vertex in [u, *ring]], coded.residual)
        extent = (self.header.ex, self.header.ey, self.header.ez)
        require(all(0 <= p <= most for p, most in zip(position, extent)),
                f"record {own}: outside the extent")
        running = accumulate(coded.steps, initial=self.bucket(star[2 + coded.left]))
        bucket = [value & ONES for value in list(running)[1:]]
        return Record(depth, position, u, ring, star, states, coded.errors, bucket)

    def anchor(self, own):
        """u, the next two corners of the anchor, its face and state."""
        coded = self.coded[own]
        kind, value = coded.anchor
        if kind == "base":
            face, state, corners = value, BASE, self.faces[value][0]
        else:
            star = self.known(value).star
            require(coded.place < len(star) and star[coded.place] is not None,
                    f"record {own}: the anchor is not in the star that it names")
            face, state = star[coded.place], (value, coded.place)
            corners = self.corners(*state)
        j = coded.corner
        return corners[j], corners[(j + 1) % 3], corners[(j + 2) % 3], face, state

    def step(self, own, owner, edge, met):
        """Face over the edge: its id, its state and its third corner."""
        if owner is not None and owner[0] == "base":
            third = third_corner(self.faces[owner[1]][0], edge)
            require(third is not None, f"record {own}: a base face misses the edge")
            return owner[1], BASE, third
        if owner is not None:
            candidates = [owner[1]]
        else:
            candidates = [self.brought_by(vertex) for vertex in edge]
            candidates += [None if state == BASE else state[0] for state in met]
        best, found = 0, None
        for record in candidates:
            if record is not None:
                hit = self.place_at(record, edge)
                if hit is not None and self.records[record].depth > best:
                    best, found = self.records[record].depth, (record, *hit)
        require(found is not None, f"record {own}: no face over the edge")
        record, place, third = found
        return self.records[record].star[place], (record, place), third


def third_corner(corners, edge):
    """Corner that is not in the edge; None if the face does not have the edge."""
    for i in range(3):
        if (corners[i], corners[(i + 1) % 3]) == edge:
            return corners[(i + 2) % 3]
    return None


def read_model(data, table):
    header, index = read_header(data)
    positions, faces = read_base(data, header)
    boxes, coded = [], []
    # All must be sound before they are decoded.
    for number, box, code in list(read_chunks(data, header, index)):
        coded.extend(ChunkReader(code, number, header, table).records())
        boxes.append(box)
    resolver = Resolver(header, positions, faces, coded)
    resolver.resolve_all()
    check_states(resolver)
    check_boxes(resolver, boxes)
    return Model(header, positions, faces, resolver.records)


def check_states(resolver):
    """Relations of records outside the walk."""
    taken = set()
    for own, record in enumerate(resolver.records):
        for face, state in zip(record.star[2:], record.before):
            require(resolver.error(face, state) > 0, f"record {own}: splits an exact face")
            require((face, state) not in taken, f"record {own}: face {face} is taken")
            taken.add((face, state))


def check_boxes(resolver, boxes):
    """Each face of fan and star, inflated, is in the chunk's influence box."""
    for own, record in enumerate(resolver.records):
        low, high = boxes[own // 64]
        shapes = [((record.parent, record.ring[i], record.ring[i + 1]), resolver.error(face, state))
                  for i, (face, state) in enumerate(zip(record.star[2:], record.before))]
        shapes += [(resolver.corners(own, place), record.error[place])
                   for place, face in enumerate(record.star) if face is not None]
        for corners, error in shapes:
            bound = 2.0**((error - 1) / 4 - 8) if error else 0.0
            for vertex in corners:
                inside = all(a <= p - bound and p + bound <= b
                             for a, p, b in zip(low, resolver.position(vertex), high))
                require(inside, f"record {own}: outside its chunk's influence box")


def replay(model):
    """Splits every record, least depth first; returns the corners of all faces by id."""
    corners = {face: list(entry[0]) for face, entry in enumerate(model.faces)}
    state = dict.fromkeys(corners, BASE)
    for own in sorted(range(len(model.records)), key=lambda own: (model.records[own].depth, own)):
        record = model.records[own]
        vertex = model.header.base_vertices + own
        for i, (face, before) in enumerate(zip(record.star[2:], record.before)):
            require(state.get(face) == before, f"record {own}: face {face} is in another state")
            require(record.parent in corners[face], f"record {own}: face {face} misses the parent")
            at = corners[face].index(record.parent)
            following = (corners[face][(at + 1) % 3], corners[face][(at + 2) % 3])
            require(following == (record.ring[i], record.ring[i + 1]),
                    f"record {own}: a gap in the fan")
            corners[face][at] = vertex
        for side, new in ((0, [vertex, record.parent, record.ring[0]]),
                          (1, [vertex, record.ring[-1], record.parent])):
            if record.star[side] is not None:
                corners[record.star[side]] = new
        for place, face in enumerate(record.star):
            if face is not None:
                state[face] = (own, place)
    for face, value in state.items():
        error = (model.faces[face][2] if value == BASE
                 else model.records[value[0]].error[value[1]])
        require(error == 0, f"face {face}: not exact after all splits")
    return corners


def count_border(corners):
    """Edges with one face. Refuses a mesh that is not 2-manifold or not consistently oriented."""
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


def check_buckets(model, faces):
    """Upper bits of all faces' places in one order: 8 faces each, the rest in the last one."""
    count = dict.fromkeys(range((len(faces) + 7) // 8), 0)
    for face in faces:
        record, side = divmod(face - model.header.base_faces, 2)
        bucket = model.records[record].bucket[side] if record >= 0 else model.faces[face][1]
        require(bucket in count, f"face {face}: bucket {bucket}")
        count[bucket] += 1
    require(all(number == min(8, len(faces) - 8 * bucket) for bucket, number in count.items()),
            "records: a bucket with another number of faces")


def figures(data, table):
    model = read_model(data, table)
    header = model.header
    corners = replay(model)
    border, half_edges, vertices = count_border(corners)
    require(len(corners) == header.source_faces, "mesh: another face count than the header states")
    require(vertices == header.source_vertices, "mesh: another vertex count than stated")
    require(vertices == header.base_vertices + header.records, "mesh: vertices that no face uses")
    depth = max((record.depth for record in model.records), default=0)
    require(depth == header.max_depth, "records: another largest depth than stated")
    check_buckets(model, corners)
    edges = (half_edges + border) // 2
    return {"faces": len(corners), "vertices": vertices, "records": header.records,
            "base_faces": header.base_faces, "border_edges": border,
            "euler": vertices - edges + len(corners)}


def main(arguments):
    if len(arguments) not in (1, 2):
        print("usage: read_spm.py FILE [TABLE]", file=sys.stderr)
        return 3
    try:
        table = read_table(arguments[1] if len(arguments) > 1 else TABLE)
        with open(arguments[0], "rb") as file:
            print(json.dumps(figures(file.read(), table)))
        return 0
    except (OSError, Refused) as error:
        print(f"read_spm.py: {arguments[0]}: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
