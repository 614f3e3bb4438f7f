/**
 * Ray picking. It runs on a click over flat arrays, so no data structure must be kept up to date; it tests
 * the triangles of objects whose bounds the ray meets.
 */
import { boundsOf, type Bounds } from "../bounds";
import type { ObjectState } from "../model";

export interface Hit {
  object: number;
  triangle: number;
  vertex: number;  // the corner closest to the hit
  distance: number;
  point: [number, number, number];
}

/** Relative rounding error of distances along a ray. */
const ROUNDING = 1e-9;

interface Ray {
  origin: ArrayLike<number>;
  direction: ArrayLike<number>;
}

type Kept = (x: number, y: number, z: number) => boolean;

/** The first triangle of one object along the ray, or null. Both faces of a triangle count; points that are not kept do not. */
export function pickTriangle(ray: Ray, object: ObjectState, farthest: number, keeps: Kept = () => true): Hit | null {
  const [ox, oy, oz] = [ray.origin[0]!, ray.origin[1]!, ray.origin[2]!];
  const [dx, dy, dz] = [ray.direction[0]!, ray.direction[1]!, ray.direction[2]!];
  const { positions: p, corners } = object;
  let best = farthest;
  let found = -1;
  let weights: [number, number] = [0, 0];
  for (let i = 0; i < corners.length; i += 3) {
    const a = 3 * corners[i]!, b = 3 * corners[i + 1]!, c = 3 * corners[i + 2]!;
    const ax = p[a]!, ay = p[a + 1]!, az = p[a + 2]!;
    const ux = p[b]! - ax, uy = p[b + 1]! - ay, uz = p[b + 2]! - az;
    const vx = p[c]! - ax, vy = p[c + 1]! - ay, vz = p[c + 2]! - az;
    const hx = dy * vz - dz * vy, hy = dz * vx - dx * vz, hz = dx * vy - dy * vx;
    const determinant = ux * hx + uy * hy + uz * hz;
    if (determinant === 0) continue;
    const sx = ox - ax, sy = oy - ay, sz = oz - az;
    const u = (sx * hx + sy * hy + sz * hz) / determinant;
    if (!(u >= 0 && u <= 1)) continue;
    const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
    const v = (dx * qx + dy * qy + dz * qz) / determinant;
    if (!(v >= 0 && u + v <= 1)) continue;
    const t = (vx * qx + vy * qy + vz * qz) / determinant;
    if (!(t > 0 && t < best) || !keeps(ox + t * dx, oy + t * dy, oz + t * dz)) continue;
    best = t;
    found = i / 3;
    weights = [u, v];
  }
  if (found < 0) return null;
  const [u, v] = weights;
  const nearest = u > v ? (u > 1 - u - v ? 1 : 0) : v > 1 - u - v ? 2 : 0;
  return {
    object: object.index,
    triangle: found,
    vertex: corners[3 * found + nearest]!,
    distance: best,
    point: [ox + best * dx, oy + best * dy, oz + best * dz],
  };
}

/** Whether a ray may meet bounds before `farthest`; conservative. */
function meets(ray: Ray, { lower, upper }: Bounds, farthest: number): boolean {
  let enters = 0;
  let leaves = farthest;
  for (let axis = 0; axis < 3; ++axis) {
    // 0 / 0 gives NaN when the ray lies in a side; the comparisons below then change nothing.
    const one = (lower[axis]! - ray.origin[axis]!) / ray.direction[axis]!;
    const other = (upper[axis]! - ray.origin[axis]!) / ray.direction[axis]!;
    if (Math.min(one, other) > enters) enters = Math.min(one, other);
    if (Math.max(one, other) < leaves) leaves = Math.max(one, other);
  }
  return enters <= leaves + ROUNDING * Math.abs(leaves);
}

/** The first triangle of all visible objects. */
export function pick(ray: Ray, objects: ObjectState[], keeps: Kept = () => true): Hit | null {
  let first: Hit | null = null;
  let farthest = Infinity;
  for (const object of objects) {
    if (!object.visible || object.opacity < 0.05) continue;
    const bounds = boundsOf(object);
    if (!bounds || !meets(ray, bounds, farthest)) continue;
    const hit = pickTriangle(ray, object, farthest, keeps);
    if (!hit) continue;
    first = hit;
    farthest = hit.distance;
  }
  return first;
}
