import assert from "node:assert/strict";
import { test } from "node:test";
import { Beginnings, findContact, isTouching, middleOf, pairsOf, pointsOf, selectableIn, sidesOf } from "../src/contacts";
import type { ListName } from "../src/protocol/lists";
import type { FrameMessage, SceneMessage } from "../src/protocol/messages";
import { readMessage } from "../src/protocol/read_message";
import { countsOf } from "../src/protocol/read_scene";
import { keyAt, kindAt, rowsIn } from "../src/records";
import { FRAME, KIND, message, rowsOf, sceneMessage, text, type Section } from "./build_message";

const counts = countsOf(readMessage(sceneMessage(), null) as SceneMessage);
const frameOf = (...sections: Section[]) =>
  readMessage(message(KIND.frame, text(FRAME), ...sections), counts) as FrameMessage;
const objects = [0, 1].map((object) => ({ positions: new Float32Array(12).fill(object) })) as never[];
const keysOf = (frame: FrameMessage) => Array.from({ length: selectableIn(frame).count }, (_, place) => keyAt(selectableIn(frame), place));

test("intersections are found again by what touches", () => {
  const frame = frameOf(...rowsOf("contacts", { object_b: 1, kind: 1, point_count: 2 }, { object_b: 1, triangle_b: 1, point_count: 1, first_point: 2 }), ...rowsOf("contact_points", {}, {}));
  const keys = keysOf(frame);
  assert.deepEqual(keys, [[0, 0, 1, 0], [0, 0, 1, 1]]);
  assert.deepEqual(keys.map((key) => findContact(frame, key)), [0, 1]);
  assert.equal(findContact(frame, [0, 0, 1, 2]), -1);
  assert.equal(findContact(frame, [0, 0, 1]), -1);
  assert.deepEqual(sidesOf(keys[1]!), [{ object: 0, kind: "face", elements: [0] }, { object: 1, kind: "face", elements: [1] }]);
  assert.deepEqual([0, 1].map((place) => rowsIn(frame.lists.contacts, place, "contact_points", frame.lists)), [{ first: 0, end: 2 }, { first: 2, end: 2 }]);
});

const impact = (kind: number, element_a: number[], element_b: number[]) => ({ object_b: 1, kind, element_a, element_b });

test("impacts of edges that share a vertex are told apart", () => {
  const frame = frameOf(...rowsOf("continuous_contacts", impact(2, [0, 1], [0, 1]), impact(2, [0, 2], [0, 1]), impact(0, [2, 2], [1, 1]), impact(1, [0, 0], [3, 3])));
  const keys = keysOf(frame);
  assert.deepEqual(keys[1], [0, 0, 2, 1, 0, 1, 2]);
  assert.deepEqual(keys.map((key) => findContact(frame, key)), [0, 1, 2, 3]);
  assert.deepEqual(sidesOf(keys[1]!)[0], { object: 0, kind: "edge", elements: [0, 2] });
  assert.deepEqual(sidesOf(keys[2]!)[1], { object: 1, kind: "face", elements: [1] });
  assert.deepEqual(sidesOf(keys[3]!)[0], { object: 0, kind: "face", elements: [0] });
});

test("impacts of rods and particles have vertices and edges", () => {
  const frame = frameOf(...rowsOf("continuous_contacts", impact(3, [2, 2], [1, 3]), impact(4, [0, 1], [3, 3]), impact(5, [1, 1], [2, 2])));
  assert.deepEqual(keysOf(frame).map((key) => sidesOf(key).map(({ elements }) => elements)), [[[2], [1, 3]], [[0, 1], [3]], [[1], [2]]]);
  assert.deepEqual([0, 1, 2].map((place) => kindAt(frame.lists.continuous_contacts, place)), ["vertex–edge", "edge–vertex", "vertex–vertex"]);
});

test("what touches is gathered by pairs of objects", () => {
  const frame = frameOf(
    ...rowsOf("contacts", { object_b: 1, kind: 1, point_count: 2 }, { object_b: 1, triangle_b: 1, point_count: 1, first_point: 2 }, { object_a: 1, object_b: 1, triangle_b: 1 }),
    ...rowsOf("contact_points", {}, { position: [2, 4, 6] }, { position: [9, 9, 9] }),
    ...rowsOf("proximity_pairs", { distance: 0.5 }, { object_b: 1, distance: 0.3 }, { object_b: 1, distance: 0.2, point_b: [0, 2, 0] }),
    ...rowsOf("penetrations", { object_a: 1, vertex: 3, depth: 0.25, point: [3, 3, 3] }),
  );
  const pairs = pairsOf(frame);
  assert.deepEqual(pairs.map(({ a, b, count, gap, depth }) => [a, b, count, gap && Math.round(10 * gap) / 10, depth]), [[0, 0, 1, 0.5, null], [0, 1, 5, 0.2, 0.25], [1, 1, 1, null, null]]);
  assert.deepEqual(pairs[1]!.runs, [{ list: "contacts", first: 0, count: 2 }, { list: "proximity_pairs", first: 1, count: 2 }, { list: "penetrations", first: 0, count: 1 }]);
  assert.deepEqual(pairs.map(isTouching), [false, true, true]);
  const pointOf = (list: ListName, place: number) => middleOf(pointsOf(frame, objects, frame.lists[list], place));
  assert.deepEqual(pointOf("contacts", 0), [1, 2, 3]);
  assert.deepEqual(pointOf("proximity_pairs", 2), [0, 1, 0]);
  assert.deepEqual(pointOf("penetrations", 0), [2, 2, 2]);
  assert.equal(pointOf("contacts", 2), null);
});

test("a pair begins once, also when a frame comes again with other layers", () => {
  const frame = (step: number, others: number[]) =>
    readMessage(message(KIND.frame, text({ ...FRAME, step }), ...rowsOf("contacts", ...others.map((object_b) => ({ object_b })))), counts) as FrameMessage;
  const beginnings = new Beginnings();
  const began = (of: FrameMessage) => pairsOf(of).map(beginnings.of(of.text, pairsOf(of)));
  assert.deepEqual(began(frame(1, [1])), [true]);
  assert.deepEqual(began(frame(1, [1])), [true]);
  assert.deepEqual(began(frame(2, [0, 1])), [true, false]);
  assert.deepEqual(began(frame(3, [])), []);
  assert.deepEqual(began(frame(4, [1])), [true]);
});
