/** Moves what belongs to the objects of a second recording, so that it stands beside the first. */
import type { FrameMessage, SceneText } from "./protocol/messages";

/** Between the two recordings, relative to the width of the scene. */
const ROOM = 1.15;

export function shiftOf({ bounds }: SceneText): number {
  return ROOM * (bounds[1][0] - bounds[0][0]);
}

/** Adds `by` to the x coordinates at `columns` of each row of 8 numbers whose object is at least `first`. */
function shiftRows(rows: Float32Array, objectOf: (row: number) => number, first: number, by: number, columns: number[]): void {
  for (let row = 0; 8 * row < rows.length; ++row) {
    if (objectOf(row) < first) continue;
    for (const column of columns) rows[8 * row + column]! += by;
  }
}

/** Changes the places in a frame, except positions of vertices. */
export function shiftFrame(frame: FrameMessage, first: number, by: number): void {
  const { contacts, contactPoints, impacts, impactPoints, proximityPairs, proximityPoints, penetrations, penetrationPoints, curves, curvePoints } = frame;
  for (let i = 0; i < contacts.length; i += 8) {
    if (contacts[i]! < first) continue;
    for (let point = contacts[i + 6]!; point < contacts[i + 6]! + contacts[i + 5]!; ++point) contactPoints[8 * point]! += by;
  }
  shiftRows(impactPoints, (row) => impacts[8 * row]!, first, by, [0]);
  shiftRows(proximityPoints, (row) => proximityPairs[2 * row]!, first, by, [0, 4]);
  shiftRows(penetrationPoints, (row) => penetrations[4 * row]!, first, by, [0, 4]);
  shiftRows(curvePoints, (row) => curves[8 * row]!, first, by, [0]);
  for (const cells of [frame.octreeBoxes, frame.octreeEdges, frame.collidingBoxes, frame.collidingEdges])
    for (const [object, rows] of cells) shiftRows(rows, () => object, first, by, [0, 4]);
  for (const cells of [frame.octreeSpheres, frame.collidingSpheres])
    for (const [object, rows] of cells) shiftRows(rows, () => object, first, by, [0]);
}
