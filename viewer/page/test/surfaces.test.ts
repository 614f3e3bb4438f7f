import assert from "node:assert/strict";
import { test } from "node:test";
import type { Model, ObjectState } from "../src/model";
import { addRange, obstacleOf, Surfaces } from "../src/view/surfaces";

/** A graphics card with the minimum of WebGL 2, except for the number of vertices. */
const card = { MAX_ELEMENT_INDEX: 1, MAX_TEXTURE_SIZE: 2, getParameter: (name: number) => (name === 1 ? 2 ** 32 - 1 : 2048) } as unknown as WebGL2RenderingContext;

test("ranges that are near are uploaded together", () => {
  const ranges: { start: number; count: number }[] = [];
  addRange(ranges, 30, 60);
  addRange(ranges, 90, 10);
  addRange(ranges, 200, 100);
  assert.deepEqual(ranges, [{ start: 30, count: 270 }]);
  addRange(ranges, 100_000, 6);
  addRange(ranges, 0, 30);  // a change of the next frame
  assert.deepEqual(ranges, [{ start: 30, count: 270 }, { start: 100_000, count: 6 }, { start: 0, count: 30 }]);
});

test("only what has moved is uploaded, and at most everything", () => {
  const [count, vertices] = [1000, 1000];
  const positions = new Float32Array(3 * vertices * count);
  const objects = Array.from({ length: count }, (_, index) => ({
    index, vertices, positions: positions.subarray(3 * vertices * index, 3 * vertices * (index + 1)), corners: new Uint32Array([0, 1, 2]), edges: new Uint32Array(0), points: new Uint32Array(0),
  })) as ObjectState[];
  const surfaces = new Surfaces();
  surfaces.build(objects, positions);
  const ranges = () => (surfaces as unknown as { positions: { updateRanges: { start: number; count: number }[] } }).positions.updateRanges;
  surfaces.touch([7, 8, 500]);
  assert.deepEqual(ranges(), [{ start: 21_000, count: 6000 }, { start: 1_500_000, count: 3000 }]);
  for (let frame = 0; frame < 1000; ++frame) surfaces.touch([frame % count]);  // without drawing meanwhile
  assert.ok(ranges().length < 600 && ranges().reduce((sum, range) => sum + range.count, 0) < 2 * positions.length);
  surfaces.touch(objects.keys());
  assert.deepEqual(ranges(), [{ start: 0, count: positions.length }]);
});

test("the corners of all triangles follow one another", () => {
  const positions = new Float32Array(21);
  const object = (index: number, vertices: number, corners: number[]) => ({ index, vertices, corners: new Uint32Array(corners), edges: new Uint32Array(0), points: new Uint32Array(0) }) as ObjectState;
  const surfaces = new Surfaces();
  surfaces.build([object(0, 3, [0, 1, 2]), object(1, 4, [0, 1, 2, 0, 2, 3])], positions);
  const [opaque] = surfaces.group.children as unknown as { geometry: { index: { array: Uint32Array }; attributes: Record<string, { array: Uint32Array }> } }[];
  assert.deepEqual([...opaque!.geometry.index.array], [0, 1, 2, 3, 4, 5, 3, 5, 6]);
  assert.deepEqual([...opaque!.geometry.attributes["object"]!.array], [0, 0, 0, 1, 1, 1, 1]);
});

test("what one mesh does not draw, another one does", () => {
  const shapes = (surfaces: Surfaces) => surfaces.group.children.slice(0, 3).map(({ visible }) => visible);
  const look = (index: number, opacity: number, visible = true) =>
    ({ index, vertices: 1, corners: new Uint32Array(3), edges: new Uint32Array(0), points: new Uint32Array(0), colour: "#ff0000", opacity, visible }) as ObjectState;
  const layers = { surface: true, wireframe: false } as Model["layers"];
  const painted = (objects: ObjectState[], shown = layers) => {
    const surfaces = new Surfaces();
    surfaces.build(objects, new Float32Array(3 * objects.length));
    surfaces.paint(shown);
    return shapes(surfaces);
  };
  assert.deepEqual(painted([look(0, 1), look(1, 1)]), [true, false, false]);
  assert.deepEqual(painted([look(0, 0.5), look(1, 1)]), [true, true, false]);
  assert.deepEqual(painted([look(0, 0.5), look(1, 1, false)]), [false, true, false]);
  assert.deepEqual(painted([look(0, 1, false)], { ...layers, wireframe: true }), [false, false, false]);
  assert.deepEqual(painted([look(0, 0.5)], { ...layers, surface: false, wireframe: true }), [false, false, true]);
});

test("what is too large is said, also when it is only so together", () => {
  const objects = Array.from({ length: 20_000 }, (_, i) => ({ name: `ball ${i}`, vertices: 1000, triangles: 2000 }));
  assert.equal(obstacleOf(card, objects), null);
  assert.ok(/20,000 objects with 200,000,000 vertices.*largest is ball 3, with 10,001/.test(
    obstacleOf(card, objects.map((object, i) => ({ ...object, vertices: i === 3 ? 10_001 : 10_000 - (i === 4 ? 1 : 0) })))!,
  ));
  assert.ok(/90,000,000 triangles/.test(obstacleOf(card, [{ name: "one", vertices: 100, triangles: 90_000_000 }])!));
  assert.equal(obstacleOf(card, []), null);
});
