#!/usr/bin/python3
"""Assembles PNG frames into an animated WebP file.

usage: assemble_animation.py FOLDER OUTPUT.webp [MILLISECONDS PER FRAME]
"""

import pathlib
import sys

from PIL import Image


def main():
    folder, output = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    duration = int(sys.argv[3]) if len(sys.argv) > 3 else 70
    frames = [Image.open(path).convert("RGB") for path in sorted(folder.glob("*.png"))]
    frames[0].save(output, save_all=True, append_images=frames[1:], duration=duration, loop=0, quality=70, method=6,
                   minimize_size=False)
    print(f"{output}: {len(frames)} frames, {output.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
