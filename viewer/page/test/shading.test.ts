import assert from "node:assert/strict";
import { test } from "node:test";
import type { ObjectState } from "../src/model";
import { MOST_SMOOTH, Surfaces } from "../src/view/surfaces";

const none = new Uint32Array(0);

/** Objects of one triangle in the plane z = 0, which claim to have `triangles`. */
function scene(count: number, triangles = 1): [ObjectState[], Float32Array] {
  const positions = Float32Array.from({ length: 9 * count }, (_, i) => [0, 0, 0, 1, 0, 0, 0, 1, 0][i % 9]!);
  const objects = Array.from({ length: count }, (_, index) => ({
    index, vertices: 3, triangles, corners: new Uint32Array([0, 1, 2]), edges: none, points: none, positions: positions.subarray(9 * index, 9 * index + 9),
  }) as unknown as ObjectState);
  return [objects, positions];
}

const normalsOf = (surfaces: Surfaces) => [...((surfaces as unknown as { normals: { array: Int16Array } }).normals.array)];

test("normals are those of objects that moved", () => {
  const surfaces = new Surfaces();
  const [objects, positions] = scene(2);
  surfaces.build(objects, positions);
  surfaces.touch([1]);
  surfaces.shade(true);
  assert.deepEqual(normalsOf(surfaces), [...new Array<number>(12).fill(0), ...[0, 1, 2].flatMap(() => [0, 0, 32767, 0])]);
  surfaces.isSmooth = false;
  assert.ok(normalsOf(surfaces).every((x) => x === 0));
});

test("objects of an earlier scene are forgotten", () => {
  const surfaces = new Surfaces();
  surfaces.build(...scene(2));
  surfaces.touch([0, 1]);
  surfaces.build(...scene(1));
  surfaces.touch([0]);
  surfaces.shade(true);
  assert.equal(normalsOf(surfaces)[2], 32767);
});

test("too many triangles that move are flat, until fewer move", () => {
  const surfaces = new Surfaces();
  surfaces.build(...scene(2, MOST_SMOOTH));
  surfaces.touch([0, 1]);
  surfaces.shade(true);  // at the start there is time
  assert.ok(!surfaces.isTooLarge && normalsOf(surfaces)[2] === 32767);
  surfaces.touch([0, 1]);
  surfaces.shade(true);
  assert.ok(surfaces.isTooLarge && normalsOf(surfaces).every((x) => x === 0));
  surfaces.touch([1]);
  surfaces.shade(true);
  assert.ok(!surfaces.isTooLarge && normalsOf(surfaces)[14] === 32767);
});
