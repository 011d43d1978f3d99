"""Damaged files for fuzzing: bytes flipped, lines lost and moved, hostile values. Repeatable by seed."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence

__all__ = [
    "HOSTILE_CELLS",
    "HOSTILE_VALUES",
    "mutated_bytes",
    "mutated_sweep",
    "mutated_table",
    "mutated_toml",
    "seeds",
]

HOSTILE_VALUES = (
    *("-1", "0", "1", "1e308", "-1e308", "1e-320", "nan", "-inf", "true", "0x7fffffffffffffff", "9" * 400, "9" * 5000),
    *('""', '"x"', '"0 mm"', '"-3 mm"', '"1e999 mm"', '"9**9**9 mm"', '"NaN m"', '"5 parsec"', '"1 mm" "2 mm"'),
    *('"\\u0000"', '"ü µ ½"', "'../../x'", f'"{"9" * 400} mm"', f'"{"m" * 3000}"', '"1e-300 deg"', '"1 degC"'),
    *("[]", "{}", "[[]]", "[{}]", "[1, 'a']", "['1 mm', '2 mm', '3 mm']", "[" * 3000, "{a = " * 300),
    *("1979-05-27T07:32:00Z", "07:32:00", "", "=", "#", '"""', "'''", "[nan]", "[[1, 2], [3]]"),
)
"""Right-hand sides of a TOML key."""
HOSTILE_CELLS = (
    *("", " ", "nan", "inf", "-inf", "1e308", "-1e308", "1e-320", "-1", "0", "1e999", "0x10", "1_0", "1,5", "½", "٣"),
    *('"', '""', '"1\n2"', "'", "text", "1;2", "\x00", "\ufeff", "9" * 400, "a" * 140000, "=1+1", "#", "1e-300"),
)
"""Cells of a table, and pieces of its header."""

SWEEP_KEYS = (
    *("strip_thickness", "orientation", "temperature", "plates", "models", "design", "samples", "seed", "base"),
    *("deflections", "loads", '"fe.friction"', '"wheel.springs[0].count"', '"wheel.springs[9].count"', '"wheel"'),
    *('"sweep.models"', '"wheel.springs[-1].count"', '"wheel.springs"', '"mesh..element_size"', '""', '"a.b.c"', "x"),
    *(
        '"name"',
        '"fe.points"',
        '"ancf.contact_points[0]"',
        '"materials.Ti-6Al-4V.density"',
        '"wheel.springs[0"',
        "fe.x",
    ),
)
"""Keys of [sweep]: its own, those of a study, and those of none."""
SOUND_SWEEP = (
    *('strip_thickness = { low = "0.5 mm", high = "0.7 mm" }', 'orientation = ["0 deg"]', '"fe.friction" = [0, 0.3]'),
    *('"wheel.springs[0].count" = [3, 4]', "plates = [8, 12]", 'models = ["ancf", "brush"]', "base = false"),
    *('design = "latin-hypercube"', "samples = 3", '"fe.max_load" = ["100 N"]', 'loads = ["40 N"]', "seed = 7"),
)
"""Lines of [sweep] that mean something, alone or with others."""
SWEEP_VALUES = (
    *('["0.5 mm", "0.6 mm"]', '["fe", "ancf"]', '"latin-hypercube"', '"grid"', "3", "100000", "[3, 4]", "[0, 0.3]"),
    *('{ low = "0.5 mm", high = "0.7 mm" }', '{ low = 1, high = "2 mm" }', "{ low = 2, high = 1 }", "{ low = 1 }"),
    *('{ low = "0 deg", high = "inf deg" }', "{ low = nan, high = 1 }", '{ low = "1 mm", high = "1 N" }', '["x", 1]'),
    *("[0, 0.3, 0.6, 0.9, 1.2, 1.5, 1.8, 2.1, 2.4, 2.7]", '["0 deg", "0 deg"]', f"[{', '.join(map(str, range(300)))}]"),
)


def mutated_bytes(source: random.Random, content: bytes) -> bytes:
    """One to four bytes changed, or a piece cut out, repeated or moved; nothing else may be lost."""
    data = bytearray(content)
    for _ in range(source.randint(1, 4)):
        place, kind = source.randrange(len(data) + 1), source.randrange(6)
        end = min(len(data), place + source.choice((1, 2, 10, 100, 1000)))
        if kind == 0:
            data[place:place] = source.randbytes(source.choice((1, 3, 40)))
        elif kind == 1:
            del data[place:end]
        elif kind == 2:
            data[place:place] = data[place:end]
        elif kind == 3:
            del data[place:]
        elif data:
            data[place % len(data)] = source.choice((0, 9, 10, 13, 34, 35, 44, 61, 91, 93, 127, 255, place % 256))
    return bytes(data)


def mutated_toml(source: random.Random, text: str) -> bytes:
    """A TOML file with one or two keys given hostile values, lost, doubled, renamed or moved; or damaged bytes."""
    if source.random() < 0.25:
        return mutated_bytes(source, text.encode())
    lines = text.splitlines()
    for _ in range(source.randint(1, 2)):
        keys = [i for i, line in enumerate(lines) if "=" in line and not line.startswith("#")]
        i = source.choice(keys)
        name, _, value = lines[i].partition("=")
        kind = source.randrange(10)
        if kind < 5:
            lines[i] = f"{name}= {source.choice(HOSTILE_VALUES)}"
        elif kind == 5:
            del lines[i]
        elif kind == 6:
            lines.insert(i, lines[i])
        elif kind == 7:
            lines[i] = f"{name.strip()}{source.choice(('x', '.x', ' x', '_'))} ={value}"
        elif kind == 8:
            lines.insert(source.randrange(len(lines)), lines.pop(i))
        else:
            lines[i] = f"{name}={lines[source.choice(keys)].partition('=')[2]}"
    return "\n".join(lines).encode()


def mutated_sweep(source: random.Random, text: str) -> bytes:
    """A study whose section [sweep] has one to four keys given other values, lost or added; the rest is as it was."""
    before, _, rest = text.partition("[sweep]\n")
    section, bracket, after = rest.partition("\n[")
    lines = [line for line in section.splitlines() if "=" in line and not line.startswith("#")]
    for _ in range(source.randint(1, 3)):
        key, value = source.choice(SWEEP_KEYS), source.choice((*SWEEP_VALUES, *SWEEP_VALUES, *HOSTILE_VALUES))
        kind = source.randrange(8)
        if kind == 0 and lines:
            del lines[source.randrange(len(lines))]
        if kind > 2:
            key, _, value = source.choice(SOUND_SWEEP).partition(" = ")
        lines = [line for line in lines if kind == 1 or line.partition("=")[0].strip() != key]
        lines.insert(source.randint(0, len(lines)), f"{key} = {value}")
    return f"{before}[sweep]\n{'\n'.join(lines)}\n{bracket}{after}".encode()


def mutated_table(source: random.Random, text: str, headers: Sequence[str]) -> bytes:
    """A CSV file with hostile cells, another header, rows lost, doubled, moved or cut; or damaged bytes."""
    if source.random() < 0.25:
        return mutated_bytes(source, text.encode())
    lines = text.splitlines()
    for _ in range(source.randint(1, 3)):
        i, kind = source.randrange(len(lines)), source.randrange(8)
        cells = lines[i].split(",")
        if kind < 3:
            cells[source.randrange(len(cells))] = source.choice(HOSTILE_CELLS)
            lines[i] = ",".join(cells)
        elif kind == 3:
            lines[0] = ",".join(source.choice(headers) for _ in range(source.randint(1, 4)))
        elif kind == 4 and len(lines) > 1:
            del lines[i]
        elif kind == 5:
            lines.insert(source.randrange(len(lines)), lines[i])
        elif kind == 6:
            lines[i] = ",".join(cells[: source.randrange(len(cells))])
        else:
            lines.insert(source.randrange(len(lines)), _remark(source))
    return source.choice(("\n", "\r\n", "\n\n", "\r")).join(lines).encode("utf-8", "surrogatepass")


def _remark(source: random.Random) -> str:
    word = source.choice(
        ("uncertainty", "deformation", "unloaded_radius", "unloaded diameter", "partial", "source", "")
    )
    said = ("3 %", "5 N", "-1 %", "lots", "change of diameter", "loaded radius", "142.5 mm", "nan m", "True", "", ":")
    return f"# {word}: {source.choice((*said, *HOSTILE_CELLS))}".replace("\n", " ")


def seeds(first: int, count: int) -> Iterator[random.Random]:
    """Sources of chance, each of a seed of its own, so that a failing case can be made alone."""
    return (random.Random(first + i) for i in range(count))
