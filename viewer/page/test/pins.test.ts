import assert from "node:assert/strict";
import { test } from "node:test";
import { Model } from "../src/model";
import { Pins, PinSeries, titleOf } from "../src/pins";
import type { FrameMessage, SceneMessage } from "../src/protocol/messages";
import { readMessage } from "../src/protocol/read_message";
import { countsOf } from "../src/protocol/read_scene";
import { floats, FRAME, KIND, message, SCENE, text, words, type Section } from "./build_message";

const WIDTH = 13;
const VALUES = ["contacts", "gap", "depth", "length", "area", "normal_x", "normal_y", "normal_z", "impact_time", "speed", "displacement"];
const described = VALUES.map((key) => ({ key, doc: `${key}`, unit: "" }));

const sceneOf = (changes: object = {}): SceneMessage =>
  readMessage(message(KIND.scene, text({ ...SCENE, pin_values: described, ...changes }), words(16, 3, [0, 1, 2], 0), words(16, 3, [0, 1, 2, 0, 2, 3], 1)), null) as SceneMessage;

/** Rows of a pin that have the same number in all values. */
const rowsOf = (pin: number, rows: [step: number, value: number][]): Section =>
  ({ tag: 63, object: pin, count: rows.length, data: new Float64Array(rows.flatMap(([step, value]) => [step, step / 10, ...VALUES.map(() => value)])) });

function pinned() {
  const model = new Model();
  const sent: Record<string, unknown>[] = [];
  const said: string[] = [];
  const pins = new Pins(model, (command) => sent.push(command), (line) => said.push(line));
  const scene = sceneOf();
  model.takeScene(scene);
  const frame = (step: number, ...sections: Section[]) => model.takeFrame(readMessage(
    message(KIND.frame, text({ ...FRAME, step }), floats(32, 3, [0, 0, 0, 1, 0, 0, 0, 1, 0], 0), ...sections), countsOf(scene),
  ) as FrameMessage);
  return { model, pins, sent, said, frame };
}

test("rows of steps are merged, also when they come again or from another place", () => {
  const series = new PinSeries(1);
  for (const row of [[0, 0, 5], [1, 0.1, 6], [4, 0.4, 9], [2, 0.2, 7], [4, 0.4, 8]]) series.add(row);
  assert.deepEqual(series.steps, [0, 1, 2, 4]);
  assert.deepEqual(series.columns[0], [5, 6, 7, 8]);
  assert.deepEqual([series.at(0, 2), series.at(0, 4)], [7, 8]);
  assert.ok(Number.isNaN(series.at(0, 3)) && Number.isNaN(series.at(0, 9)));
  assert.equal(series.csv(["gap"]), "step,time,gap\n0,0,5\n1,0.1,6\n2,0.2,7\n4,0.4,8\n");
  series.add([5, 0.5, NaN]);
  assert.ok(series.csv(["gap"]).endsWith("\n5,0.5,\n"));
  series.limit(4);
  assert.deepEqual(series.steps, [1, 2, 4, 5]);
  assert.deepEqual(series.columns[0]!.length, 4);
});

test("the session hears of the pins, and its rows go to their pin", () => {
  const { pins, sent, frame } = pinned();
  pins.add([0]);
  pins.add([0, 1], [0, 0, 1, 1]);
  pins.add([0]);  // again
  assert.deepEqual(sent.at(-1), { do: "pins", pins: [{ pin: 1, objects: [0] }, { pin: 2, objects: [0, 1], contact: [0, 0, 1, 1] }] });
  frame(3, rowsOf(2, [[2, 20], [3, 30]]), rowsOf(9, [[3, 1]]));
  assert.deepEqual(pins.list.map(({ series }) => series.steps), [[], [2, 3]]);
  assert.deepEqual(pins.list[1]!.series.columns[VALUES.indexOf("speed")], [20, 30]);
  assert.equal(rowsOf(2, [[2, 20]]).data.length, WIDTH);
  pins.remove(pins.list[0]!);
  assert.deepEqual(sent.at(-1), { do: "pins", pins: [{ pin: 2, objects: [0, 1], contact: [0, 0, 1, 1] }] });
});

test("pins stay in a scene with the same objects, and a new run has new rows", () => {
  const { model, pins, sent, frame } = pinned();
  pins.add([0]);
  pins.add([1]);
  frame(3, rowsOf(1, [[3, 1]]));
  model.takeScene(sceneOf({ generation: 2 }));
  assert.deepEqual(pins.list[0]!.series.steps, [3]);
  assert.equal((sent.at(-1)!["pins"] as unknown[]).length, 2);
  model.takeScene(sceneOf({ generation: 3, run: 2 }));
  assert.deepEqual(pins.list[0]!.series.steps, []);
  const [one] = SCENE.objects;
  model.takeScene(readMessage(message(KIND.scene, text({ ...SCENE, generation: 4, pin_values: described, objects: [one] }), words(16, 3, [0, 1, 2], 0)), null) as SceneMessage);
  assert.deepEqual(pins.list.map(titleOf), ["one"]);
});

test("the selection is pinned and unpinned", () => {
  const { model, pins, said } = pinned();
  pins.toggleSelection();
  assert.ok(said[0]!.startsWith("Select an object"));
  model.select({ object: 1, triangle: 0, vertex: null });
  pins.toggleSelection();
  model.selectContact([0, 0, 1, 1]);
  pins.toggleSelection();
  assert.deepEqual(pins.list.map(titleOf), ["other", "one 0 and other 1"]);
  pins.toggleSelection();
  assert.deepEqual(pins.list.map(titleOf), ["other"]);
});

test("stored pins find their objects by name", () => {
  const { pins } = pinned();
  pins.restore({ 1: { a: "one" }, 2: { a: "gone" }, 3: { a: "other", b: "one", contact: "1 5 1 6" }, 4: {}, 5: { a: "one", contact: "x" }, 6: { a: "one", b: "other", contact: "1 2 3" } });
  assert.deepEqual(pins.list.map(titleOf), ["one", "other 5 and one 6"]);
  assert.deepEqual(pins.list[1]!.contact, [1, 5, 0, 6]);
  const { pins: others } = pinned();
  others.restore(JSON.parse(JSON.stringify(pins.stored)) as typeof pins.stored);
  assert.deepEqual(others.list.map(titleOf), pins.list.map(titleOf));
});

test("a step that comes again keeps numbers that it lacks, unless the options have changed", () => {
  const { model, pins, frame } = pinned();
  pins.add([0]);
  frame(3, rowsOf(1, [[3, 7]]));
  frame(3, rowsOf(1, [[3, NaN]]));
  assert.equal(pins.list[0]!.series.at(0, 3), 7);
  model.takeScene(sceneOf());
  frame(3, rowsOf(1, [[3, NaN]]));
  assert.ok(Number.isNaN(pins.list[0]!.series.at(0, 3)));
});
