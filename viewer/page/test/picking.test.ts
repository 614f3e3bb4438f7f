import assert from "node:assert/strict";
import { test } from "node:test";
import type { ObjectState } from "../src/model";
import { pick } from "../src/view/picking";

function object(index: number, positions: number[], corners: number[]): ObjectState {
  return {
    index, name: String(index), vertices: positions.length / 3, triangles: corners.length / 3, isStatic: false, isBody: false, kind: "at rest",
    positions: new Float32Array(positions), corners: new Uint32Array(corners), edges: new Uint32Array(0), points: new Uint32Array(0), visible: true, visibleIn: [true], colour: "", opacity: 1,
  };
}

const square = (index: number, z: number) => object(index, [0, 0, z, 1, 0, z, 1, 1, z, 0, 1, z], [0, 1, 2, 0, 2, 3]);
const down = (x: number, y: number) => ({ origin: [x, y, 10], direction: [0, 0, -1] });

test("the first triangle along the ray, from either side", () => {
  const hit = pick(down(0.9, 0.05), [square(0, 0), square(1, 2), square(2, 1)]);
  assert.deepEqual([hit?.object, hit?.triangle, hit?.vertex, hit?.distance], [1, 0, 1, 8]);
  const below = pick({ origin: [0.1, 0.8, -5], direction: [0, 0, 1] }, [square(0, 0), square(1, 2)]);
  assert.deepEqual([below?.object, below?.triangle, below?.vertex], [0, 1, 3]);
});

test("what is hidden, behind or not a number is not hit", () => {
  const hidden = square(1, 2);
  hidden.visible = false;
  const broken = object(2, [NaN, 0, 3, 1, 0, 3, 1, 1, 3], [0, 1, 2]);
  assert.equal(pick(down(0.5, 0.25), [square(0, 0), hidden, broken])?.object, 0);
  assert.equal(pick(down(2, 2), [square(0, 0)]), null);
  assert.equal(pick({ origin: [0.5, 0.25, -1], direction: [0, 0, -1] }, [square(0, 0)]), null);
});

test("objects whose bounds the ray passes are not looked through, those that it grazes are", () => {
  const far = square(0, 0);
  const looked: number[] = [];
  const watched = [square(0, 0), object(1, [5, 5, 1, 6, 5, 1, 6, 6, 1], [0, 1, 2])].map((of) =>
    Object.defineProperty({ ...of }, "corners", { get: () => (looked.push(of.index), of.corners) }),
  );
  assert.equal(pick(down(0.5, 0.25), watched)?.object, 0);
  assert.ok(looked.includes(0) && !looked.includes(1));
  assert.equal(pick(down(0, 0), [far])?.triangle, 0);  // along two sides of its bounds
  assert.equal(pick({ origin: [-1, 0.5, 0], direction: [1, 0, 0] }, [far]), null);  // in the plane of the triangle
});
