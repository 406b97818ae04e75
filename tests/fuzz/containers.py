"""Mutations of files with a structure: trees of YAML and JSON, members of archives, records of bags, packed data."""

from __future__ import annotations

import copy
import hashlib
import io
import json
import lzma
import random
import re
import struct
import warnings
import zipfile
from collections.abc import Mapping
from functools import cache
from pathlib import PurePosixPath
from typing import Any

import yaml
from mutation import ODD_NAMES, ODD_NUMBERS, Mutator, replaced_number, shuffled_bytes

ODD_VALUES: tuple[Any, ...] = (
    *(None, True, False, 0, -1, 1, 2, 0.5, -0.0, 1e308, 1e-320, 2**31, 2**63, 2**64, 10**400, -(2**70)),
    *(float("nan"), float("inf"), float("-inf"), [], {}, [[]], [None], {"": None}, {"a": {"b": []}}, [1, "a", None]),
    *([0.0] * 5000, [[[[[[[[]]]]]]]], "\x1b[2J\x1b]0;title\x07", "a\nb", "\x00", "\ud800", "\u0085\u2028", "x" * 5000),
    *(
        "/dev/zero",
        "/etc/passwd",
        "../../up",
        "a/../../b",
        "CON",
        "file.yaml",
        "!!python/name:os.system",
        "*",
        "[",
        "(",
    ),
    *(name for name in ODD_NAMES if not name.startswith("x")),
)
ODD_YAML = (
    b"!!python/object/apply:os.system ['true']",
    b"&a [*a]",
    b"&b {<<: *b}",
    b"!!binary ====",
    b"!!float x",
    b"!!int ''",
    b"2024-02-30",
    b"2024-01-01 00:00:00",
    b"0x" + b"f" * 5000,
    b"1" * 5000,
    b"!!set {a}",
    b"!!omap [a: 1]",
    b"? [a]\n: b",
    b"- " * 300,
    b"{" * 300,
    b"[" * 3000,
    b"!!timestamp x",
    b"!!null x",
    b"0b2",
    b"1e999999999",
    b".inf",
    b"\t",
    b"%YAML 9\n---",
    b"---\na: 1\n---\nb: 2\n",
    b"<<: 1",
    b"|",
    b"'",
    b"\xff\xfe",
    b"@",
    b"`",
    b"*x",
    b"!x y",
    b"1:1:1:1",
    b"=",
    b"<<",
)
# A number that makes a run long is what the file asks for, not a fault: these keys keep small numbers.
_LONG = re.compile(
    rb"(\b(?:duration|timeout|wall_timeout|steps|tick|time_ns|wall|by|until|at)\"?[ \t]*:[ \t]*\"?)"
    rb"[-+]?(?:\d[\d_.]{2,}|\.inf|Infinity|\d[\d.]*[eE]\+?\d+|0[xob]\w+)"
)
_SHORT_STEP = re.compile(rb"(max_step_size\W{1,4})[^<\"',}\n]*")
_SLOW = re.compile(rb"(approach_velocity\W{1,4})(?:0\.0\d*|[\d.]+e-0?[1-5])\b")  # slower ones are refused
_XML = Mutator()
_DUMPER = getattr(yaml, "CSafeDumper", yaml.SafeDumper)  # ten times faster, where PyYAML was built with it
LINES = 20  # broken lines made of each line of a file of lines


def damaged(name: str, content: bytes, chance: random.Random) -> bytes:
    """Return the content of a file with mutations that know its format, or sometimes with mutations of its bytes.

    Args:
        name: name of the file; its suffix says the format.
        content: content of the intact file.
        chance: source of all choices.
    """
    suffix = PurePosixPath(name).suffix
    if suffix != ".lines" and chance.random() < 0.15:
        return shortened(shuffled_bytes(content, chance))
    if suffix in (".yaml", ".json"):
        return shortened(_damaged_text_tree(content, chance, yaml_text if suffix == ".yaml" else json_text))
    if suffix == ".lines":  # every line is an input of its own
        return b"\n".join(_damaged_line(line, chance) for line in content.splitlines() for _ in range(LINES))
    if suffix == ".jsonl":
        return shortened(_damaged_lines(content, chance))
    if suffix == ".zip":
        return _damaged_zip(content, chance)
    if suffix == ".mcap":
        return _damaged_bag(content, chance)
    if suffix == ".xz":
        return _damaged_packed(content, chance)
    if suffix in (".sdf", ".urdf", ".world", ".xacro"):
        return shortened(_XML.mutated(content, chance))
    return shuffled_bytes(content, chance)


def shortened(content: bytes) -> bytes:
    """Return a text whose run takes few steps."""
    content = _SLOW.sub(rb"\g<1>0.1", _LONG.sub(rb"\g<1>1", content))
    return _SHORT_STEP.sub(rb"\g<1>0.002", content)


# ---------------------------------------------------------------------- trees


def yaml_text(tree: Any) -> bytes:
    """Return a tree as YAML; lone surrogates become question marks."""
    try:
        return yaml.dump(tree, Dumper=_DUMPER, sort_keys=False, allow_unicode=True).encode()
    except UnicodeEncodeError:  # the dumper in C accepts no lone surrogate
        return yaml.safe_dump(tree, sort_keys=False, allow_unicode=True).encode(errors="replace")


def json_text(tree: Any) -> bytes:
    """Return a tree as JSON, with `NaN` and `Infinity` as Python writes them."""
    return json.dumps(tree, indent=1).encode()


def damaged_tree(tree: Any, chance: random.Random) -> Any:
    """Return a tree with one to three changed places: a value, a key, a list item, or an exchange of two places."""
    tree = json.loads(json.dumps(tree, default=str))
    for _ in range(chance.choice((1, 1, 1, 2, 3))):
        places = list(_places(tree))
        if not places:
            return copy.deepcopy(chance.choice(ODD_VALUES))
        holder, key = chance.choice(places)
        kind = chance.randrange(10)
        if kind <= 4:
            holder[key] = copy.deepcopy(chance.choice(ODD_VALUES))  # later changes must not reach the table
        elif kind == 5:
            del holder[key]
        elif kind == 6:
            other, other_key = chance.choice(places)
            holder[key] = json.loads(json.dumps(other[other_key]))
        elif kind == 7 and isinstance(holder, dict):
            holder[chance.choice([k for h, k in places if isinstance(k, str)] or ["x"])] = holder.pop(key)
        elif kind == 8:
            holder[key] = [holder[key]] * chance.randint(1, 3)
        else:
            holder[key] = {"x": holder[key]} if chance.random() < 0.5 else str(holder[key])
    return tree


def _places(tree: Any) -> Any:
    """Yield every place of a tree as its container and key."""
    keys = tree.keys() if isinstance(tree, dict) else range(len(tree)) if isinstance(tree, list) else ()
    for key in keys:
        yield tree, key
        yield from _places(tree[key])


@cache
def _tree(content: bytes) -> Any:
    return yaml.safe_load(content)


_TOKEN = re.compile(rb"\w+|\s+|[^\w\s]")


def _damaged_line(line: bytes, chance: random.Random) -> bytes:
    """Return a line of which one to three tokens are exchanged, repeated, left out or replaced."""
    tokens = _TOKEN.findall(line)
    for _ in range(chance.choice((1, 1, 1, 2, 3))):
        at, kind = chance.randrange(len(tokens)), chance.randrange(6)
        if kind == 0:
            tokens[at] = b""
        elif kind == 1:
            tokens[at] *= chance.choice((2, 3, 50, 2000))
        elif kind == 2:
            odd = (
                *ODD_NUMBERS,
                *ODD_NAMES,
                "[",
                "(",
                ")",
                "'",
                '"',
                "**",
                "//",
                "@",
                ":=",
                "lambda",
                "__import__",
                "x[0]",
                "()",
                "=",
                "#",
            )
            tokens[at] = chance.choice(odd).encode(errors="replace").replace(b"\n", b"")
        elif kind == 3:
            tokens = tokens[: at + 1]
        else:
            tokens[at] = tokens[chance.randrange(len(tokens))]
    return b"".join(tokens)


def _damaged_text_tree(content: bytes, chance: random.Random, write: Any) -> bytes:
    kind = chance.random()
    if kind < 0.65:
        return bytes(write(damaged_tree(_tree(content), chance)))
    if kind < 0.8:
        return replaced_number(content, chance)
    pieces = re.split(rb"([:,\[\]{}\n-] ?)", content)
    at = chance.randrange(len(pieces))
    odd = (*ODD_YAML, *(n.encode() for n in ODD_NUMBERS), *(n.encode(errors="replace") for n in ODD_NAMES))
    pieces[at] = chance.choice((chance.choice(odd), b"", pieces[chance.randrange(len(pieces))]))
    return b"".join(pieces)


def _damaged_lines(content: bytes, chance: random.Random) -> bytes:
    """Return a text with one JSON value a line, of which one line is changed, repeated, moved or left out."""
    lines = content.splitlines() or [b"{}"]
    at, kind = chance.randrange(len(lines)), chance.randrange(6)
    if kind <= 3:
        lines[at] = json.dumps(damaged_tree(json.loads(lines[at]), chance)).encode()
    elif kind == 4:
        lines.insert(chance.randrange(len(lines)), lines[at])
    else:
        del lines[at]
    return b"".join(line + b"\n" for line in lines)


# ---------------------------------------------------------------------- archives and packed data


def sealed(files: Mapping[str, bytes], chance: random.Random) -> dict[str, bytes]:
    """Return the files of a golden run, in most cases with the right hash of the data, so that its reader goes on."""
    files = dict(files)
    main = next((n for n in files if n.endswith("golden.json")), None)
    data = next((n for n in files if n.endswith(".xz")), None)
    if main is None or data is None or chance.random() < 0.1:
        return files
    digest = hashlib.sha256(files[data]).hexdigest()
    name = f"data-{digest[:12]}.xz"
    files[main] = re.sub(rb"data-[0-9a-f]{12}\.xz", name.encode(), files[main])
    files[main] = re.sub(rb'("sha256": )"[0-9a-f]{64}"', rb'\g<1>"' + digest.encode() + b'"', files[main], count=1)
    files[str(PurePosixPath(data).with_name(name))] = files.pop(data)
    return files


def _damaged_packed(content: bytes, chance: random.Random) -> bytes:
    """Return compressed data whose content is changed."""
    if chance.random() < 0.3:
        return shuffled_bytes(content, chance)
    return lzma.compress(shuffled_bytes(lzma.decompress(content), chance), preset=0)


def _damaged_zip(content: bytes, chance: random.Random) -> bytes:
    """Return an archive with a changed member, in most cases with its right size and hash in `bundle.json`."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        members = {info.filename: archive.read(info) for info in archive.infolist()}
    page = "bundle.json"
    names = [*members, page, page, "commands.jsonl", "commands.jsonl"]
    name = chance.choice([n for n in names if n in members])
    infos = {n: zipfile.ZipInfo(n) for n in members}
    kind = chance.random()
    if kind < 0.8:
        members[name] = damaged(name, members[name], chance)
    elif kind < 0.9:
        infos[name].filename = chance.choice([str(v) for v in ODD_VALUES if isinstance(v, str) and v])
    else:
        infos[name].external_attr = chance.choice((0o120777, 0o40755, 0o20666, 0o10644)) << 16
    if name != page and chance.random() < 0.9:
        members[page] = _listed(members)
    target = io.BytesIO()
    with warnings.catch_warnings(), zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        warnings.simplefilter("ignore")  # two members of one name are wanted
        for key, data in members.items():
            infos[key].filename = infos[key].filename.encode(errors="replace").decode()
            archive.writestr(infos[key], data)
        if chance.random() < 0.03:
            archive.writestr(infos[name], b"again")
    return target.getvalue()


def _listed(members: Mapping[str, bytes]) -> bytes:
    """Return `bundle.json` with the sizes and hashes of the members."""
    about = json.loads(members["bundle.json"])
    for name in about["files"]:
        about["files"][name] = {"size": len(members[name]), "sha256": hashlib.sha256(members[name]).hexdigest()}
    about["commands"] = members.get("commands.jsonl", b"").count(b"\n")
    return json.dumps(about).encode()


# ---------------------------------------------------------------------- bags


def _damaged_bag(content: bytes, chance: random.Random) -> bytes:
    """Return a bag with a changed record, in most cases as a valid container of other content."""
    return _rewritten_bag(content, chance) if chance.random() < 0.6 else _damaged_records(content, chance)


def _rewritten_bag(content: bytes, chance: random.Random) -> bytes:
    from mcap.records import Channel, Message, Schema
    from mcap.stream_reader import StreamReader
    from mcap.writer import CompressionType, Writer

    target = io.BytesIO()
    writer = Writer(target, compression=chance.choice(list(CompressionType)), chunk_size=chance.choice((100, 1 << 20)))
    writer.start(profile="ros2", library="simkit")
    records = [r for r in StreamReader(io.BytesIO(content)).records if isinstance(r, (Schema, Channel, Message))]
    first = {id(r) for i, r in enumerate(records) if not isinstance(r, Message) and r not in records[:i]}
    records = [r for r in records if isinstance(r, Message) or id(r) in first]
    kind = chance.choice([k for k in (Schema, Channel, Message, Message) if any(isinstance(r, k) for r in records)])
    one = chance.choice([r for r in records if isinstance(r, kind)])
    schemas, channels = {}, {}
    for record in records:
        schema = record is one and isinstance(record, Schema)
        if isinstance(record, Schema):
            name, encoding, data = record.name, record.encoding, record.data
            if schema:
                change = chance.randrange(4)
                name = chance.choice((*ODD_NAMES, name + "x", "std_msgs/msg/String")) if change == 0 else name
                encoding = chance.choice(("ros2idl", "", "protobuf", "jsonschema")) if change == 1 else encoding
                data = _damaged_definition(data, name, chance) if change > 1 else data
            schemas[record.id] = writer.register_schema(name.encode(errors="replace").decode(), encoding, data)
        elif isinstance(record, Channel):
            topic, encoding, metadata = record.topic, record.message_encoding, dict(record.metadata)
            schema_id = schemas.get(record.schema_id, 0)
            if record is one:
                change = chance.randrange(4)
                odd = (
                    chance.choice([str(v) for v in ODD_VALUES if isinstance(v, str)]).encode(errors="replace").decode()
                )
                topic = odd if change == 0 else topic
                encoding = chance.choice(("json", "", "protobuf")) if change == 1 else encoding
                metadata["offered_qos_profiles"] = odd if change == 2 else metadata.get("offered_qos_profiles", "")
                schema_id = chance.choice([0, *schemas.values(), 999]) if change == 3 else schema_id
            channels[record.id] = writer.register_channel(topic, encoding, schema_id, metadata)
        else:
            time, data = record.log_time, record.data
            if record is one:
                if chance.random() < 0.3:
                    time = chance.choice((0, 1, 2**63 - 1, 2**63, 2**64 - 1, time + 10**18))
                else:
                    data = shuffled_bytes(data, chance)
            writer.add_message(channels[record.channel_id], time, data, record.publish_time, record.sequence)
    writer.finish()
    return target.getvalue()


def _damaged_definition(data: bytes, name: str, chance: random.Random) -> bytes:
    odd = (
        b"\nuint8[] more",
        b"\nint32 A=1",
        b"\nstring<=3 s",
        b"\nfloat64[99999999999] big",
        b"\nint32[<=5] few",
        b"\n=====\nMSG: ",
        b"\n" + name.encode(errors="replace") + b" self",
        b"\nHeader header",
        b"\nunknown/Type x",
        b"\nint8 int8",
        b"\nfloat32 1x",
        b"\x00",
        b"\nwstring w",
        b"\nint32 a\nint32 a",
        b'\nstring s "default"',
        b"\nint32[2] a [1,2]",
        b"\nbool class",
        b"\nint8 __init__",
    )
    if chance.random() < 0.5:
        return shuffled_bytes(data, chance)
    lines = data.splitlines(keepends=True) or [b""]
    at = chance.randrange(len(lines) + 1)
    return b"".join(lines[:at]) + chance.choice(odd) + b"\n" + b"".join(lines[at:])


def _damaged_records(content: bytes, chance: random.Random) -> bytes:
    """Return a bag of which one record is changed, left out, repeated, moved, or claims another length."""
    records, at = [], 8
    while at + 9 <= len(content) - 8:
        (length,) = struct.unpack_from("<Q", content, at + 1)
        records.append(content[at : at + 9 + length])
        at += 9 + length
    one, kind = chance.randrange(len(records)), chance.randrange(8)
    if kind == 0:
        del records[one]
    elif kind == 1:
        records.insert(chance.randrange(len(records)), records[one])
    elif kind == 2:
        records[one] = (
            records[one][:1] + struct.pack("<Q", chance.choice((0, 1, 2**31, 2**63, 2**64 - 1))) + records[one][9:]
        )
    elif kind == 3:
        records[one] = bytes([chance.randrange(256)]) + records[one][1:]
    elif kind == 4:
        records = records[: one + 1]
        records[one] = records[one][: chance.randrange(len(records[one]) + 1)]
    else:
        inner = bytearray(shuffled_bytes(records[one][9:], chance))
        if kind == 5 and len(inner) > 8:
            place = chance.randrange(min(len(inner) - 4, 48))
            inner[place : place + 8] = struct.pack("<Q", chance.choice((0, 2**31, 2**40, 2**63, 2**64 - 1)))
        records[one] = records[one][:1] + struct.pack("<Q", len(inner)) + bytes(inner)
    return content[:8] + b"".join(records) + (content[-8:] if kind != 4 else b"")
