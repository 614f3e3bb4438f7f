/** Chooses which marks are drawn where many of them fall into the same pixels. */
import type { Matrix4 } from "three";

/**
 * Of the elements whose first three numbers project into the same square of `spacing` pixels, chooses the one
 * nearest to the camera. Returns the indices of the chosen elements.
 */
export function thin(rows: Float32Array, stride: number, count: number, matrix: Matrix4, width: number, height: number, spacing: number): Uint32Array {
  const columns = Math.max(1, Math.ceil(width / spacing));
  const squares = columns * Math.max(1, Math.ceil(height / spacing));
  const nearest = new Int32Array(squares).fill(-1);
  const depths = new Float32Array(squares);
  const e = matrix.elements;
  for (let i = 0, at = 0; i < count; ++i, at += stride) {
    const x = rows[at]!, y = rows[at + 1]!, z = rows[at + 2]!;
    const w = e[3]! * x + e[7]! * y + e[11]! * z + e[15]!;
    if (!(w > 0)) continue;  // behind the camera, or not finite
    const right = (e[0]! * x + e[4]! * y + e[8]! * z + e[12]!) / w;
    const up = (e[1]! * x + e[5]! * y + e[9]! * z + e[13]!) / w;
    if (!(Math.abs(right) < 1 && Math.abs(up) < 1)) continue;
    const square = Math.floor((0.5 + 0.5 * right) * (width / spacing)) + columns * Math.floor((0.5 + 0.5 * up) * (height / spacing));
    const depth = (e[2]! * x + e[6]! * y + e[10]! * z + e[14]!) / w;
    if (nearest[square]! >= 0 && depths[square]! <= depth) continue;
    nearest[square] = i;
    depths[square] = depth;
  }
  return Uint32Array.from(nearest.filter((i) => i >= 0));
}
