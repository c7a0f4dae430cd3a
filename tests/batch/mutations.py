# SPDX-License-Identifier: GPL-3.0-or-later
"""Random damage to the bytes of files: anywhere, and where a format keeps what sizes and meanings are."""

from __future__ import annotations

import copy
import json
import random
import struct
import zlib
from collections.abc import Callable

WORDS = (
    b"nan", b"1e999", b"-1", b"null", b"[]", b"{}", b'"', b"1e999999999", b"9" * 400, b"9" * 5000, b"true",
    b"[" * 100_000, b'{"a":' * 5000, b"\xff\xfe", b"\x00" * 40, b"../../x", b"\\ud800", b"0.1e-400",
    b"1-20000", b"4294967295", b"\xff\xff\xff\x7f",
)  # fmt: skip

VALUES = (
    None, -1, 0, 10**400, 1e300, 5e-324, True, "", "x" * 1000, [], {}, "\ud800", "1e99999999", float("nan"),
    "1-20000", ["disp"] * 3, {"a": 1}, "1-600000,1-600000", "../../x", "/dev/zero", [[]], [[1, 2], [3]],
    [[[[1]]]], 2**31, 4096, "\x1b[31m\n", {"file": "x.png"}, {"shape": [4096, 4096, 4], "data": ""},
)  # fmt: skip

NUMBERS = (0, 1, 2, 3, 7, 255, 4096, 4097, 65535, 65536, 2**24, 2**30, 2**31 - 1, 2**31, 2**32 - 1)

_PNG_CHUNKS = (b"tRNS", b"PLTE", b"zTXt", b"iCCP", b"acTL", b"fcTL", b"eXIf", b"iTXt", b"gAMA")
_TIFF_TAGS = (254, 256, 257, 258, 259, 262, 273, 274, 277, 278, 279, 284, 317, 320, 322, 330, 339)
_EXR_ATTRIBUTES = (
    b"dataWindow\0box2i\0", b"displayWindow\0box2i\0", b"compression\0compression\0", b"type\0string\0",
    b"channels\0chlist\0", b"tiles\0tiledesc\0", b"lineOrder\0lineOrder\0", b"chunkCount\0int\0",
)  # fmt: skip

Mutation = Callable[[bytes, random.Random], bytes]


def anywhere(content: bytes, chance: random.Random) -> bytes:
    """One to four changes of bytes, half of them in front, where what a file is stands."""
    data = bytearray(content)
    for _ in range(chance.randint(1, 4)):
        place = chance.randrange(chance.choice((200, 1000, *2 * [len(data) + 1]))) % (len(data) + 1)
        kind = chance.randrange(6)
        if kind == 0:
            del data[place:]
        elif kind == 1 and data:
            data[place % len(data)] ^= 1 << chance.randrange(8)
        elif kind == 2:
            del data[place : place + chance.choice((1, 4, 100, 4000))]
        elif kind == 3:
            data[place : place + 4] = chance.choice(WORDS)
        elif kind == 4:
            data[place : place + 4] = struct.pack(chance.choice("<>") + "I", _number(chance))
        else:
            data[place:place] = data[: chance.choice((1, 8, 1000))]
    return bytes(data)


def of_text(content: bytes, chance: random.Random) -> bytes:
    """Mostly another word, or lines that are gone, cut off or stand twice: bytes alone make no number."""
    if chance.random() < 0.3:
        return anywhere(content, chance)
    lines = content.split(b"\n")
    for _ in range(chance.randint(1, 3)):
        place = min(chance.randrange(len(lines)), chance.randrange(len(lines)))
        kind = chance.randrange(5)
        words = lines[place].split()
        if kind == 0:
            del lines[place]
        elif kind == 1:
            lines[place:place] = lines[place : place + chance.choice((1, 3, 20))]
        elif kind == 2:
            lines[place] = lines[place][: chance.randrange(len(lines[place]) + 1)]
        elif words:
            words[chance.randrange(len(words))] = chance.choice(
                (*WORDS, b"%d" % chance.choice(NUMBERS), b"-0.5", b"1e300", b"999.0", b"MM", *words)
            )
            lines[place] = b" ".join(words)
    return b"\n".join(lines)


def of_json(content: bytes, chance: random.Random) -> bytes:
    """Mostly another value for a key, which its syntax does not tell."""
    if chance.random() < 0.3:
        return anywhere(content, chance)
    try:
        plain = json.loads(content)
    except (ValueError, RecursionError):
        return anywhere(content, chance)
    for _ in range(chance.randint(1, 3)):
        _change_value(plain, chance)
    changed = json.dumps(plain).encode()
    return changed if changed != content else anywhere(content, chance)


def _change_value(plain: object, chance: random.Random) -> None:
    place = plain
    while isinstance(place, (dict, list)) and place:
        key = chance.choice(list(place) if isinstance(place, dict) else range(len(place)))
        inner = place[key]
        if not isinstance(inner, (dict, list)) or not inner or chance.random() < 0.3:
            kind = chance.randrange(8)
            if kind == 0 and isinstance(place, list):
                place[key:key] = place[: chance.choice((1, 100))] * chance.choice((1, 100))
            elif kind == 1 and isinstance(place, dict):
                place[chance.choice(("a", key[:-1], key * 1000, "file", "values", "animation"))] = inner
            elif kind == 2:
                del place[key]
            else:
                place[key] = copy.deepcopy(chance.choice(VALUES))  # of which parts are changed later
            return
        place = inner


def of_png(content: bytes, chance: random.Random) -> bytes:
    """A chunk with other content, whose checksum is right."""
    chunks, place = [], 8
    while place + 8 <= len(content):
        size = int.from_bytes(content[place : place + 4], "big")
        chunks.append((content[place + 4 : place + 8], content[place + 8 : place + 8 + size]))
        place += 12 + size
    if not chunks or chance.random() < 0.3:
        return anywhere(content, chance)
    index = chance.randrange(len(chunks))
    kind, inside = chunks[index]
    what = chance.randrange(5)
    if what == 0 and kind == b"IDAT":
        inside = zlib.compress(anywhere(zlib.decompress(inside), chance))
    elif what == 1 and kind == b"IHDR":
        wide, high, *rest = struct.unpack(">II5B", inside)
        sizes = [chance.choice((side, _number(chance))) for side in (wide, high)]
        inside = struct.pack(">II5B", *sizes, *(chance.choice((x, chance.randrange(20))) for x in rest))
    elif what == 2:
        kind = chance.choice(_PNG_CHUNKS)
    elif what == 3:
        chunks.insert(index, chunks[chance.randrange(len(chunks))])
    else:
        inside = anywhere(inside, chance)
    chunks[index] = (kind, inside)
    return content[:8] + b"".join(
        struct.pack(">I", len(inside)) + kind + inside + struct.pack(">I", zlib.crc32(kind + inside))
        for kind, inside in chunks
    )


def of_tiff(content: bytes, chance: random.Random) -> bytes:
    """Other tags, types, counts or values in the directory."""
    if chance.random() < 0.3:
        return anywhere(content, chance)
    order = "<" if content[:1] == b"I" else ">"
    data = bytearray(content)
    (place,) = struct.unpack_from(order + "I", data, 4)
    (count,) = struct.unpack_from(order + "H", data, place)
    for _ in range(chance.randint(1, 3)):
        entry = place + 2 + 12 * chance.randrange(count)
        tag, form, many, value = struct.unpack_from(order + "HHII", data, entry)
        what = chance.randrange(4)
        if what == 0:
            tag = chance.choice(_TIFF_TAGS)
        elif what == 1:
            form = chance.randrange(20)
        elif what == 2:
            many = _number(chance)
        else:
            value = chance.choice((_number(chance), chance.randrange(10), len(content), value ^ 1))
        struct.pack_into(order + "HHII", data, entry, tag, form, many, value)
    return bytes(data)


def of_exr(content: bytes, chance: random.Random) -> bytes:
    """Other numbers in the header's attributes, of which most say how large something is."""
    if chance.random() < 0.3:
        return anywhere(content, chance)
    data = bytearray(content)
    if chance.random() < 0.3:  # of its pixels
        for _ in range(chance.randint(1, 4)):
            data[chance.randrange(len(data) * 3 // 4, len(data))] = chance.randrange(256)
        return bytes(data)
    found = [place + len(name) for name in _EXR_ATTRIBUTES if (place := data.find(name)) >= 0]
    for _ in range(chance.randint(1, 3)):
        place = chance.choice(found) + chance.choice((0, 4, 4, 4, 8, 12, 16))
        if chance.random() < 0.5:
            data[place] = chance.randrange(256)
        else:
            struct.pack_into("<I", data, place, (_number(chance) * chance.choice((1, -1))) % 2**32)
    return bytes(data)


def of_npy(content: bytes, chance: random.Random) -> bytes:
    """Another header, of the length that it tells."""
    if chance.random() < 0.3:
        return anywhere(content, chance)
    size = int.from_bytes(content[8:10], "little")
    head, numbers = content[10 : 10 + size].strip(), content[10 + size :]
    what = chance.randrange(4)
    if what == 0:
        kinds = (b"|O", b"<f2", b">f8", b"<c16", b"|b1", b"<U9", b"<M8[s]", b"|V9", b"<i8", b"<f16", b"<u4")
        head = head.replace(b"<f8", chance.choice(kinds))
    elif what == 1:
        sides = [str(_number(chance) * chance.choice((1, 1, -1))) for _ in range(chance.randint(0, 5))]
        head = head[: head.find(b"(")] + f"({', '.join(sides)}{',' * (len(sides) == 1)})}}".encode()
    else:
        head = anywhere(head, chance)
    head = head[:65000] + b"\n"
    return content[:8] + struct.pack("<H", len(head)) + head + numbers


def of_usd(content: bytes, chance: random.Random) -> bytes:
    """Of text another word now and then; of a binary layer bytes."""
    if not content.startswith(b"#usda") or chance.random() < 0.5:
        return anywhere(content, chance)
    words = content.split(b" ")
    for _ in range(chance.randint(1, 3)):
        other = words[chance.randrange(len(words))]
        words[chance.randrange(len(words))] = chance.choice((*WORDS[:11], other))
    return b" ".join(words)


def _number(chance: random.Random) -> int:
    return chance.choice((*NUMBERS, chance.randrange(2**32)))
