import assert from "node:assert/strict";
import { test } from "node:test";
import { writeNormals } from "../src/view/normals";
import { niceStep, ticks } from "../src/view/world";

test("the step of the scale is round", () => {
  assert.deepEqual([5, 8, 12, 0.9, 3000].map((length) => Number(niceStep(length).toPrecision(3))), [1, 2, 5, 0.2, 1000]);
});

test("ticks are the multiples of the step, with both ends", () => {
  assert.deepEqual(ticks(-2, 2, 1), [-2, -1, 0, 1, 2]);
  assert.deepEqual(ticks(0.1, 0.5, 0.2).map((x) => Number(x.toPrecision(6))), [0.2, 0.4]);
  assert.deepEqual(ticks(0.1, 0.15, 0.2), []);
});

test("normals are means by area, and short at sharp edges", () => {
  // Two right angles between three faces of a cube at vertex 0.
  const positions = Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, NaN, 0, 0]);
  const into = new Int16Array(20);
  writeNormals({ positions, corners: Uint32Array.from([0, 1, 2, 0, 2, 3, 0, 3, 1]), vertices: 5 }, into);
  const of = (vertex: number) => [...into.subarray(4 * vertex, 4 * vertex + 3)].map((x) => Math.round((100 * x) / 32767));
  assert.deepEqual(of(0), [33, 33, 33]);
  assert.deepEqual(of(1), [0, 50, 50]);
  assert.deepEqual(of(4), [0, 0, 0]);
  writeNormals({ positions, corners: Uint32Array.from([0, 1, 2]), vertices: 3 }, into);
  assert.deepEqual(of(2), [0, 0, 100]);
  writeNormals({ positions, corners: Uint32Array.from([0, 1, 4, 0, 1, 2]), vertices: 5 }, into);
  assert.deepEqual(of(0), [0, 0, 100]);
});
