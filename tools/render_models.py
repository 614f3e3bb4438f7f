#!/usr/bin/env python3
"""Draws triangle meshes (OFF or OBJ) as one sheet with flat shading: one row per view, one column per mesh.

    tools/render_models.py --output sheet.png pawn.off fish.off ...

Needs numpy and Pillow (python3-numpy, python3-pil). Open sheets are lit on both sides.
"""

import argparse
import pathlib

import numpy as np
from PIL import Image, ImageDraw, ImageFont

BACKGROUND = np.array([1.0, 1.0, 1.0])
SURFACE = np.array([0.55, 0.68, 0.85])
LINE = np.array([0.16, 0.22, 0.32])
LIGHTS = [((0.35, 0.75, 0.56), 0.75), ((-0.7, 0.1, 0.5), 0.22)]  # direction in view space, strength
AMBIENT = 0.22
OVERSAMPLING = 3


def read_off(text):
    words = text.split()
    vertex_count, face_count = int(words[1]), int(words[2])
    end = 4 + 3 * vertex_count
    vertices = np.array(words[4:end], dtype=float).reshape(-1, 3)
    faces = np.array(words[end : end + 4 * face_count], dtype=int).reshape(-1, 4)
    if (faces[:, 0] != 3).any():
        raise SystemExit("only triangles are drawn; triangulate the polygons first")
    return vertices, faces[:, 1:]


def read_obj(text):
    rows = [line.split() for line in text.splitlines()]
    vertices = np.array([row[1:4] for row in rows if row[:1] == ["v"]], dtype=float)
    faces = [[int(word.split("/")[0]) - 1 for word in row[1:]] for row in rows if row[:1] == ["f"]]
    return vertices, np.array([[f[0], b, c] for f in faces for b, c in zip(f[1:], f[2:])])


def read_mesh(path):
    text = path.read_text()
    return read_obj(text) if path.suffix.lower() == ".obj" else read_off(text)


def view_matrix(yaw_degrees, pitch_degrees):
    """Rows: right, up and toward the eye."""
    yaw, pitch = np.radians([yaw_degrees, pitch_degrees])
    turn = np.array([[np.cos(yaw), 0, -np.sin(yaw)], [0, 1, 0], [np.sin(yaw), 0, np.cos(yaw)]])
    tilt = np.array(
        [[1, 0, 0], [0, np.cos(pitch), -np.sin(pitch)], [0, np.sin(pitch), np.cos(pitch)]]
    )
    return tilt @ turn


def shade(points, faces):
    corners = points[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    normals *= np.where(normals[:, 2:] < 0, -1, 1)
    light = AMBIENT + sum(
        strength * np.clip(normals @ (np.array(way) / np.linalg.norm(way)), 0, 1)
        for way, strength in LIGHTS
    )
    return light[:, None] * SURFACE


def draw(vertices, faces, view, size, line_width):
    """One picture, size × size, through a depth buffer; triangle borders are drawn as thin lines."""
    points = vertices @ view_matrix(*view).T
    low, high = points.min(axis=0), points.max(axis=0)
    pixels = size * OVERSAMPLING
    scale = 0.90 * pixels / max(high[0] - low[0], high[1] - low[1])
    center = (low + high) / 2
    screen = (points - center) * scale * [1, -1, 1] + [pixels / 2, pixels / 2, 0]
    colors = shade(points, faces)
    image = np.tile(BACKGROUND, (pixels, pixels, 1))
    depth = np.full((pixels, pixels), -np.inf)
    for triangle, color in zip(screen[faces], colors):
        fill(image, depth, triangle, color, line_width)
    small = image.reshape(size, OVERSAMPLING, size, OVERSAMPLING, 3).mean(axis=(1, 3))
    return Image.fromarray((np.clip(small, 0, 1) * 255).astype(np.uint8))


def fill(image, depth, triangle, color, line_width):
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = triangle
    twice_area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    if abs(twice_area) < 1e-9:
        return
    x0, x1 = int(max(min(ax, bx, cx), 0)), int(min(max(ax, bx, cx) + 2, image.shape[1]))
    y0, y1 = int(max(min(ay, by, cy), 0)), int(min(max(ay, by, cy) + 2, image.shape[0]))
    y, x = np.mgrid[y0:y1, x0:x1] + 0.5
    wa = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / twice_area
    wb = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / twice_area
    wc = 1 - wa - wb
    z = wa * az + wb * bz + wc * cz
    seen = (wa >= 0) & (wb >= 0) & (wc >= 0) & (z > depth[y0:y1, x0:x1])
    if not seen.any():
        return
    # Barycentric coordinate times height over the side = distance to that side in pixels.
    heights = abs(twice_area) / np.array(
        [np.hypot(cx - bx, cy - by), np.hypot(ax - cx, ay - cy), np.hypot(bx - ax, by - ay)]
    )
    border = np.minimum(np.minimum(wa * heights[0], wb * heights[1]), wc * heights[2])
    mix = 0.75 * (border[seen] < line_width)[:, None]
    depth[y0:y1, x0:x1][seen] = z[seen]
    image[y0:y1, x0:x1][seen] = color * (1 - mix) + LINE * mix


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("meshes", nargs="+", type=pathlib.Path, help="OFF or OBJ files")
    parser.add_argument("--output", required=True, type=pathlib.Path)
    parser.add_argument("--size", type=int, default=360, help="pixels of one picture")
    parser.add_argument("--line-width", type=float, default=0.7, help="of borders, 0 for none")
    parser.add_argument(
        "--views",
        default="0:8,40:14",
        help="yaw:pitch in degrees, comma-separated; 0:0 looks along -z",
    )
    arguments = parser.parse_args()

    views = [tuple(float(angle) for angle in view.split(":")) for view in arguments.views.split(",")]
    size, label_height = arguments.size, 34
    sheet = Image.new(
        "RGB", (size * len(arguments.meshes), size * len(views) + label_height), "white"
    )
    pen = ImageDraw.Draw(sheet)
    font = ImageFont.load_default()
    for column, path in enumerate(arguments.meshes):
        vertices, faces = read_mesh(path)
        for row, view in enumerate(views):
            picture = draw(vertices, faces, view, size, arguments.line_width)
            sheet.paste(picture, (column * size, row * size))
        label = f"{path.stem}: {len(vertices)} vertices, {len(faces)} faces"
        middle = column * size + size / 2 - pen.textlength(label, font=font) / 2
        pen.text((middle, size * len(views) + 10), label, fill=(40, 40, 40), font=font)
    sheet.quantize(64).save(arguments.output, optimize=True)


if __name__ == "__main__":
    main()
