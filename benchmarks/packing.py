"""What packing makes of the log of a drive: bytes, against zstd -9 of the log, and CPU time against real time.

Run: python benchmarks/packing.py BUNDLE...

The bundles stay as they are: a copy is packed, unpacked and compared.
"""

import argparse
import resource
import shutil
import tempfile
import time
from pathlib import Path

import pyarrow

from simconsole.recording.bundles.bundle import LOG, PACKED_LOG, open_bundle
from simconsole.recording.bundles.pack import pack, unpack

LEVEL = 9


def measure(folder: Path) -> None:
    with tempfile.TemporaryDirectory() as place:
        copy = Path(shutil.copytree(folder, Path(place) / "bundle"))
        unpack(copy)
        log = (copy / LOG).read_bytes()
        bundle = open_bundle(copy)
        seconds = bundle.manifest.ticks / bundle.log.header.tick_hz
        began = time.process_time()
        pack(copy)
        packing_s, packed = time.process_time() - began, (copy / PACKED_LOG).stat().st_size
        began = time.process_time()
        unpack(copy)
        unpacking_s = time.process_time() - began
        equal = (copy / LOG).read_bytes() == log
    compressed = len(pyarrow.Codec("zstd", compression_level=LEVEL).compress(log, asbytes=True))
    print(f"{folder}: {seconds:.1f} s at {bundle.log.header.tick_hz} Hz, {len(bundle.log.header.columns)} columns")
    print(f"  log            {len(log):12d} bytes")
    print(f"  zstd -{LEVEL}        {compressed:12d} bytes")
    print(f"  packed         {packed:12d} bytes   {packed / compressed:.3f} of zstd -{LEVEL}")
    print(f"  packing        {packing_s:12.2f} s CPU   {seconds / packing_s:.1f} x real time")
    print(f"  unpacking      {unpacking_s:12.2f} s CPU   {seconds / unpacking_s:.1f} x real time, bytes equal: {equal}")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("bundles", nargs="+", type=Path, metavar="BUNDLE")
    for folder in parser.parse_args().bundles:
        measure(folder)
    print(f"most memory: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB resident")


if __name__ == "__main__":
    main()
