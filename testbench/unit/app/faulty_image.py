"""Copies of the firmware with a fault planted: words of one of its functions, or of the ELF header, replaced."""
import os
import pathlib
import struct
import subprocess
import sys

# RV32: an instruction that is none; a store to address 0, where nothing is; interrupts off; a jump to itself.
ILLEGAL, STORE, INTERRUPTS_OFF, LOOP = 0xFFFFFFFF, 0x00002023, 0x30047073, 0x0000006F
ENTRY = 24  # of the ELF header


def image():
    """Beside the command: BRICK of pytest's environment, or the first argument."""
    return pathlib.Path(os.environ.get("BRICK") or sys.argv[1]).resolve().parent / "turbo.elf"


def address_of(function):
    names = subprocess.run(["riscv64-unknown-elf-nm", image()], capture_output=True, text=True, check=True).stdout
    return next(int(line.split()[0], 16) for line in names.splitlines() if line.split()[-1] == function)


def place_of(content, address):
    """Of an address in memory, in the file."""
    headers, count = struct.unpack_from("<I", content, 28)[0], struct.unpack_from("<H", content, 44)[0]
    for n in range(count):
        kind, offset, run, _, size = struct.unpack_from("<5I", content, headers + 32 * n)
        if kind == 1 and run <= address < run + size:
            return offset + address - run
    raise LookupError(f"{address:#x}")


def with_words(folder, function, *words):
    """The function begins with these instructions."""
    content = bytearray(image().read_bytes())
    struct.pack_into(f"<{len(words)}I", content, place_of(content, address_of(function)), *words)
    return written(folder, f"{function}.elf", content)


def with_entry(folder, address):
    content = bytearray(image().read_bytes())
    struct.pack_into("<I", content, ENTRY, address)
    return written(folder, "entry.elf", content)


def written(folder, name, content):
    file = pathlib.Path(folder, name)
    file.write_bytes(content)
    return str(file)
