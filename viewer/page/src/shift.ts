/** Moves what belongs to the objects of a second recording, so that it stands beside the first. */
import type { Rows } from "./protocol/lists";
import type { FrameMessage, SceneText } from "./protocol/messages";
import { eachPoint, hasColumn, objectAt } from "./records";

/** Between the two recordings, relative to the width of the scene. */
const ROOM = 1.15;

export function shiftOf({ bounds }: SceneText): number {
  return ROOM * (bounds[1][0] - bounds[0][0]);
}

/** Changes the places in a frame, except positions of vertices. */
export function shiftFrame(frame: FrameMessage, first: number, by: number): void {
  for (const rows of Object.values(frame.lists).filter(({ list }) => hasColumn(list, "object_a")) as Rows[])
    for (let place = 0; place < rows.count; ++place)
      if (objectAt(rows, "a", place) >= first) eachPoint(rows, place, frame.lists, (data, at) => (data[at]! += by));
  const cells = (shapes: Map<number, Float32Array>[], columns: number[]) => {
    for (const [object, rows] of shapes.flatMap((shape) => [...shape]))
      if (object >= first) for (let row = 0; row < rows.length; row += 8) for (const column of columns) rows[row + column]! += by;
  };
  cells([frame.octreeBoxes, frame.octreeEdges, frame.collidingBoxes, frame.collidingEdges], [0, 4]);
  cells([frame.octreeSpheres, frame.collidingSpheres], [0]);
}
