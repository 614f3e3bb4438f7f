import assert from "node:assert/strict";
import { test } from "node:test";
import { Beginnings, contactCount, findContact, isTouching, keyAt, kindAt, pairsOf, pointOf, pointsAt, sidesOf } from "../src/contacts";
import type { FrameMessage, SceneMessage } from "../src/protocol/messages";
import { readMessage } from "../src/protocol/read_message";
import { countsOf } from "../src/protocol/read_scene";
import { floats, FRAME, KIND, message, sceneMessage, text, words, type Section } from "./build_message";

const counts = countsOf(readMessage(sceneMessage(), null) as SceneMessage);
const frameOf = (...sections: Section[]) =>
  readMessage(message(KIND.frame, text(FRAME), ...sections), counts) as FrameMessage;

test("intersections are found again by what touches", () => {
  const frame = frameOf(words(34, 8, [0, 0, 1, 0, 1, 2, 0, 0, 0, 0, 1, 1, 0, 1, 2, 0]), floats(35, 8, new Array<number>(24).fill(0)));
  assert.equal(contactCount(frame), 2);
  assert.deepEqual([0, 1].map((place) => findContact(frame, keyAt(frame, place))), [0, 1]);
  assert.equal(findContact(frame, [0, 0, 1, 2]), -1);
  assert.deepEqual(sidesOf(keyAt(frame, 1), counts.kinds), [{ object: 0, elements: [0], isFace: true }, { object: 1, elements: [1], isFace: true }]);
  assert.deepEqual([pointsAt(frame, 1).first, pointsAt(frame, 1).count], [2, 1]);
});

test("impacts of edges that share a vertex are told apart", () => {
  const rows = [[0, 0, 1, 1, 0, 1, 2, 1], [0, 0, 2, 1, 0, 1, 2, 1], [0, 2, 0, 1, 1, 0, 0, 1], [0, 0, 0, 1, 3, 0, 1, 1]];
  const frame = frameOf(words(36, 8, rows.flat()), floats(37, 8, new Array<number>(32).fill(0)));
  assert.deepEqual(rows.map((_, place) => findContact(frame, keyAt(frame, place))), [0, 1, 2, 3]);
  assert.deepEqual(sidesOf(keyAt(frame, 1), counts.kinds)[0], { object: 0, elements: [0, 2], isFace: false });
  assert.deepEqual(sidesOf(keyAt(frame, 2), counts.kinds)[1], { object: 1, elements: [1], isFace: true });
  assert.deepEqual(sidesOf(keyAt(frame, 3), counts.kinds)[0], { object: 0, elements: [0], isFace: true });
});

test("impacts of rods and particles have vertices and edges", () => {
  const rows = [[0, 2, 2, 1, 1, 3, 3, 0], [0, 0, 1, 1, 3, 3, 4, 1], [0, 1, 1, 1, 2, 2, 5, 0]];
  const frame = frameOf(words(36, 8, rows.flat()), floats(37, 8, new Array<number>(24).fill(0)));
  assert.deepEqual(sidesOf(keyAt(frame, 0), counts.kinds).map(({ elements }) => elements), [[2], [1, 3]]);
  assert.deepEqual(sidesOf(keyAt(frame, 1), counts.kinds).map(({ elements }) => elements), [[0, 1], [3]]);
  assert.deepEqual(sidesOf(keyAt(frame, 2), counts.kinds).map(({ elements }) => elements), [[1], [2]]);
  assert.deepEqual([0, 1, 2].map((place) => kindAt(frame, place, counts.kinds)), ["vertex–edge", "edge–vertex", "vertex–vertex"]);
});

test("what touches is gathered by pairs of objects", () => {
  const frame = frameOf(
    words(34, 8, [0, 0, 1, 0, 1, 2, 0, 0, 0, 0, 1, 1, 0, 1, 2, 0, 1, 0, 1, 1, 0, 0, 0, 0]), floats(35, 8, [0, 0, 0, 0, 0, 0, 0, 0, 2, 4, 6, 0, 0, 0, 0, 0, 9, 9, 9, 0, 0, 0, 0, 0]),
    words(54, 2, [0, 0, 0, 1, 0, 1]), floats(55, 8, [0, 0, 0, 0.5, 1, 0, 0, 1, 0, 0, 0, 0.3, 0, 0, 0, 1, 0, 0, 0, 0.2, 0, 2, 0, 1]),
    words(56, 4, [1, 3, 0, 0]), floats(57, 8, [3, 3, 3, 0.25, 0, 0, 0, 0]),
  );
  const pairs = pairsOf(frame);
  assert.deepEqual(pairs.map(({ a, b, count, gap, depth }) => [a, b, count, gap && Math.round(10 * gap) / 10, depth]), [[0, 0, 1, 0.5, null], [0, 1, 5, 0.2, 0.25], [1, 1, 1, null, null]]);
  assert.deepEqual(pairs[1]!.runs, [{ kind: "contacts", first: 0, count: 2 }, { kind: "proximity", first: 1, count: 2 }, { kind: "penetrations", first: 0, count: 1 }]);
  assert.deepEqual(pairs.map(isTouching), [false, true, true]);
  assert.deepEqual(pointOf(frame, "contacts", 0), [1, 2, 3]);
  assert.deepEqual(pointOf(frame, "proximity", 2), [0, 1, 0]);
  assert.equal(pointOf(frame, "contacts", 2), null);
});

test("a pair begins once, also when a frame comes again with other layers", () => {
  const frame = (step: number, others: number[]) =>
    readMessage(message(KIND.frame, text({ ...FRAME, step }), words(34, 8, others.flatMap((b) => [0, 0, b, 0, 0, 0, 0, 0]))), counts) as FrameMessage;
  const beginnings = new Beginnings();
  const began = (of: FrameMessage) => pairsOf(of).map(beginnings.of(of.text, pairsOf(of)));
  assert.deepEqual(began(frame(1, [1])), [true]);
  assert.deepEqual(began(frame(1, [1])), [true]);
  assert.deepEqual(began(frame(2, [0, 1])), [true, false]);
  assert.deepEqual(began(frame(3, [])), []);
  assert.deepEqual(began(frame(4, [1])), [true]);
});
