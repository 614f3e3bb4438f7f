#!/bin/sh
# Draws the pictures of scenes in docs/images by `supple render`, from the view files in docs/images/views:
#   tools/draw_figures.sh build/release/bin/supple
# The animation needs python3-pil. viewer/page/e2e/tools/figures.mjs makes the picture of the whole page.
set -eu
program=$(realpath "$1")
cd "$(dirname "$0")/../docs/images"

# draw PICTURE VIEW SIZE SCENE [OPTIONS]
draw() {
  picture=$1 view=$2 size=$3 scene=$4
  shift 4
  "$program" render "$scene" --view "views/$view.json" --size "$size" --dpi 96 -o "$picture" "$@"
}

# The README: the models, and nine objects that move.
draw models.png models 1200x400 views/models.toml --legend
frames=$(mktemp -d)
trap 'rm -rf "$frames"' EXIT
draw "$frames/%03d.png" demo 700x420 ../../scenes/nine.toml --frames 0-158:2 --background theme
/usr/bin/python3 ../../tools/assemble_animation.py "$frames" demo.webp

# The paper's Figure 3: the octree of the broad phase with bounding spheres.
draw broad_phase_spheres.png broad_phase 720x570 ../../scenes/nine.toml --bounding-volume sphere --broad-phase octree

# The paper's Figure 5: a collision in the narrow phase, with only the volumes of the leaves that collide.
narrow() {
  draw "$1" narrow_phase 660x510 views/two_rabbits.toml --object-octree regular --leaf-size 12 --bounding-volume "$2"
}
narrow narrow_phase_boxes.png aabb
narrow narrow_phase_oriented_boxes.png obb
narrow narrow_phase_kdops.png kdop26
