import assert from "node:assert/strict";
import { test } from "node:test";
import { isClosed } from "../src/view/slice";

const TETRAHEDRON = [0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0];

test("a surface is closed when each edge has two sides", () => {
  const closed = (corners: number[]) => isClosed(Uint32Array.from(corners));
  assert.ok(closed(TETRAHEDRON));
  assert.ok(closed([...TETRAHEDRON, ...TETRAHEDRON.map((vertex) => vertex + 4)]));
  assert.ok(!closed(TETRAHEDRON.slice(3)));
  assert.ok(!closed([0, 1, 2]));
  assert.ok(!closed([0, 2, 1, ...TETRAHEDRON.slice(3)]), "a triangle that is turned round");
  assert.ok(!closed([]));
});
