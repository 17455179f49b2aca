"""Removes from the image's packages what no process of the service reads."""

from __future__ import annotations

import shutil
import subprocess
import sysconfig
from pathlib import Path

USELESS = (
    "*/tests",  # of NumPy, SciPy, Numba and others
    "*/*/tests",
    "*/include",  # headers, for those who compile against them
    "*/_core/include",
    "*/cmake",
    "mitsuba/cuda_*",  # variants; ours are llvm_ad_rgb and scalar_rgb
    "mitsuba/*_mono*",
    "mitsuba/*_spectral*",
    "**/*.pyi",
)

SYMBOLS = ("llvmlite/binding/*.so", "mitsuba/*.so", "mitsuba/plugins/*.so", "uvloop/*.so")
"""Libraries that come with the names of their inner parts, for debuggers."""


def main() -> None:
    """Remove it, and say how much that was."""
    packages = Path(sysconfig.get_path("purelib"))
    before = size(packages)
    for path in {path for pattern in USELESS for path in packages.glob(pattern)}:
        if path.is_dir():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)
    libraries = [str(path) for pattern in SYMBOLS for path in packages.glob(pattern)]
    subprocess.run(["strip", "--strip-unneeded", *libraries], check=True)
    print(f"{before / 1e6:.0f} MB of packages, now {size(packages) / 1e6:.0f} MB")


def size(folder: Path) -> int:
    """Bytes of all files in a folder."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


if __name__ == "__main__":
    main()
