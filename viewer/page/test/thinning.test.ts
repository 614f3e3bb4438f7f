import assert from "node:assert/strict";
import { test } from "node:test";
import { Matrix4 } from "three";
import { thin } from "../src/view/thinning";

/** Without a transform, x and y from −1 to 1 are the picture, and a smaller z is nearer. */
const flat = new Matrix4();
const rowsOf = (...points: number[][]) => Float32Array.from(points.flat());

test("of marks in the same pixels the nearest is drawn, others all", () => {
  const rows = rowsOf([0.01, 0.01, 0.5, 7], [0.02, 0.02, 0.1, 7], [0.03, 0.01, 0.9, 7], [-0.9, 0.9, 0, 7], [0.9, 0.9, 0, 7]);
  assert.deepEqual([...thin(rows, 4, 5, flat, 100, 100, 10)].sort(), [1, 3, 4]);
  assert.deepEqual([...thin(rows, 4, 1, flat, 100, 100, 10)], [0]);
});

test("marks that are not in the picture are not drawn", () => {
  const rows = rowsOf([1.5, 0, 0], [0, -1.5, 0], [NaN, 0, 0], [0, 0, 0]);
  assert.deepEqual([...thin(rows, 3, 4, flat, 100, 100, 10)], [3]);
  const behind = new Matrix4().makePerspective(-1, 1, 1, -1, 1, 10);
  assert.deepEqual([...thin(rowsOf([0, 0, 5], [0, 0, -5]), 3, 2, behind, 100, 100, 10)], [1]);
});

test("a million marks become at most one for each square", () => {
  const count = 1_000_000;
  const rows = new Float32Array(3 * count);
  for (let i = 0; i < count; ++i) rows.set([((i % 1000) - 499.5) / 500, (Math.floor(i / 1000) - 499.5) / 500, 0], 3 * i);
  const chosen = thin(rows, 3, count, flat, 130, 65, 13);
  assert.equal(chosen.length, 50);
});
