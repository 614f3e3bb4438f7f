import assert from "node:assert/strict";
import { test } from "node:test";
import { LIST_NAMES, rowsOf as readRows, type Numbers } from "../src/protocol/lists";
import type { FrameMessage } from "../src/protocol/messages";
import { shiftFrame, shiftOf } from "../src/shift";
import { rowsOf } from "./build_message";

test("only what belongs to the second recording moves", () => {
  const contact = (object_a: number, object_b: number, point_count: number, first_point: number) => ({ object_a, object_b, point_count, first_point });
  const sent = [
    ...rowsOf("contacts", contact(0, 1, 2, 0), contact(2, 3, 1, 2)), ...rowsOf("contact_points", {}, {}, {}), ...rowsOf("continuous_contacts", contact(2, 3, 0, 0)),
    ...rowsOf("proximity_pairs", contact(0, 1, 0, 0), contact(2, 3, 0, 0)), ...rowsOf("penetrations", contact(2, 3, 0, 0)), ...rowsOf("curves", {}),
  ];
  const frame = {
    lists: Object.fromEntries(LIST_NAMES.map((list) => [list, readRows(list, (at) => sent.find(({ object }) => object === at)?.data)])),
    octreeBoxes: new Map([[1, new Float32Array(8)], [2, new Float32Array(8)]]), octreeEdges: new Map(), collidingBoxes: new Map(), collidingEdges: new Map(),
    octreeSpheres: new Map([[3, new Float32Array(8)]]), collidingSpheres: new Map(),
  } as unknown as FrameMessage;
  const by = shiftOf({ bounds: [[-1, 0, 0], [1, 5, 5]] } as never);
  assert.ok(Math.abs(by - 2.3) < 1e-12);
  shiftFrame(frame, 2, 4);
  const { contact_points, continuous_contacts, proximity_pairs, penetrations, curves } = frame.lists;
  const moved = (positions: Numbers | undefined) => Array.from(positions!).flatMap((x, i) => (x === 4 ? [i] : []));
  assert.deepEqual(moved(contact_points.columns["position"]), [6]);
  assert.deepEqual(moved(continuous_contacts.columns["point"]), [0]);
  assert.deepEqual([moved(proximity_pairs.columns["point_a"]), moved(proximity_pairs.columns["point_b"])], [[3], [3]]);
  assert.deepEqual([moved(penetrations.columns["point"]), moved(penetrations.columns["normal"])], [[0], []]);
  assert.deepEqual(moved(curves.columns["centroid"]), []);
  assert.deepEqual([...frame.octreeBoxes.values()].map((rows) => [rows[0], rows[4]]), [[0, 0], [4, 4]]);
  assert.deepEqual([...frame.octreeSpheres.values()].map((rows) => [rows[0], rows[4]]), [[4, 0]]);
});
