# SPDX-FileCopyrightText: 2026 beautymap contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the Python tests of the tools and of the node share."""
import os
import pathlib

import numpy

PACKAGE = pathlib.Path(__file__).resolve().parents[1]
SHARED = pathlib.Path(os.environ.get("BEAUTYMAP_SHARED", PACKAGE.parent / "shared"))


def executable(name):
    """The one in the devel space whose setup or build started this test."""
    for folder in os.environ.get("CMAKE_PREFIX_PATH", "").split(":"):
        path = pathlib.Path(folder) / "lib/beautymap" / name
        if path.exists():
            return str(path)
    raise RuntimeError(f"{name} is in no workspace of CMAKE_PREFIX_PATH")


def read_pcd(path):
    """The header's lines as a dictionary, and the points as a structured array."""
    raw = pathlib.Path(path).read_bytes()
    end = raw.index(b"\n", raw.index(b"DATA ")) + 1
    head = dict(line.split(None, 1) for line in raw[:end].decode().splitlines() if line[0] != "#")
    kinds = {"F4": "<f4", "F8": "<f8", "U1": "u1", "U2": "<u2", "U4": "<u4"}
    types = [kinds[t + s] for t, s in zip(head["TYPE"].split(), head["SIZE"].split())]
    dtype = numpy.dtype(list(zip(head["FIELDS"].split(), types)))
    return head, numpy.frombuffer(raw, dtype, int(head["POINTS"]), end)
