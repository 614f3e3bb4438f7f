/** Boxes around objects. */
import type { ObjectState } from "./model";

export interface Bounds {
  lower: [number, number, number];
  upper: [number, number, number];
}

/**
 * The bounds of all finite vertices of an object; null when there are none. Cached until the object moves.
 */
export function boundsOf(object: ObjectState): Bounds | null {
  if (object.bounds === undefined) object.bounds = findBounds(object.positions);
  return object.bounds;
}

function findBounds(positions: Float32Array): Bounds | null {
  const lower: Bounds["lower"] = [Infinity, Infinity, Infinity];
  const upper: Bounds["upper"] = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i += 3)
    for (let axis = 0; axis < 3; ++axis) {
      const x = positions[i + axis]!;
      if (x < lower[axis]!) lower[axis] = x;
      if (x > upper[axis]!) upper[axis] = x;
    }
  return lower.every((x, axis) => x <= upper[axis]!) ? { lower, upper } : null;
}

/** The common bounds of several objects; null when there are none. */
export function boundsOfAll(objects: ObjectState[]): Bounds | null {
  let all: Bounds | null = null;
  for (const object of objects) {
    const bounds = boundsOf(object);
    if (!bounds) continue;
    all ??= { lower: [...bounds.lower], upper: [...bounds.upper] };
    for (let axis = 0; axis < 3; ++axis) {
      all.lower[axis] = Math.min(all.lower[axis]!, bounds.lower[axis]!);
      all.upper[axis] = Math.max(all.upper[axis]!, bounds.upper[axis]!);
    }
  }
  return all;
}
