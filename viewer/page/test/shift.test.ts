import assert from "node:assert/strict";
import { test } from "node:test";
import type { FrameMessage } from "../src/protocol/messages";
import { shiftFrame, shiftOf } from "../src/shift";

test("only what belongs to the second recording moves", () => {
  const frame = {
    contacts: new Uint32Array([0, 0, 1, 0, 0, 2, 0, 0, 2, 0, 3, 0, 0, 1, 2, 0]), contactPoints: new Float32Array(24),
    impacts: new Uint32Array([2, 0, 0, 3, 0, 0, 0, 0]), impactPoints: new Float32Array(8),
    proximityPairs: new Uint32Array([0, 1, 2, 3]), proximityPoints: new Float32Array(16),
    penetrations: new Uint32Array([2, 0, 3, 0]), penetrationPoints: new Float32Array(8), curves: new Uint32Array(8), curvePoints: new Float32Array(8),
    octreeBoxes: new Map([[1, new Float32Array(8)], [2, new Float32Array(8)]]), octreeEdges: new Map(), collidingBoxes: new Map(), collidingEdges: new Map(),
    octreeSpheres: new Map([[3, new Float32Array(8)]]), collidingSpheres: new Map(),
  } as unknown as FrameMessage;
  const by = shiftOf({ bounds: [[-1, 0, 0], [1, 5, 5]] } as never);
  assert.ok(Math.abs(by - 2.3) < 1e-12);
  shiftFrame(frame, 2, 4);
  assert.deepEqual([...frame.contactPoints].filter((_, i) => i % 8 === 0), [0, 0, 4]);
  assert.equal(frame.impactPoints[0], 4);
  assert.deepEqual([...frame.proximityPoints].flatMap((x, i) => (x === 0 ? [] : [i])), [8, 12]);
  assert.deepEqual([...frame.penetrationPoints].flatMap((x, i) => (x === 0 ? [] : [i])), [0, 4]);
  assert.equal(frame.curvePoints[0], 0);
  assert.deepEqual([...frame.octreeBoxes.values()].map((rows) => [rows[0], rows[4]]), [[0, 0], [4, 4]]);
  assert.deepEqual([...frame.octreeSpheres.values()].map((rows) => [rows[0], rows[4]]), [[4, 0]]);
});
