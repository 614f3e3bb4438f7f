import assert from "node:assert/strict";
import { test } from "node:test";
import type { ListName } from "../src/protocol/lists";
import { NONE, type FrameMessage, type SceneMessage } from "../src/protocol/messages";
import { readMessage } from "../src/protocol/read_message";
import { countsOf, type SceneCounts } from "../src/protocol/read_scene";
import { MessageError } from "../src/protocol/read_sections";
import { keyAt, numberAt, objectAt, rowsIn } from "../src/records";
import { floats, FRAME, frameMessage, KIND, message, rowsOf, SCENE, sceneMessage, seriesMessage, text, words, type Section } from "./build_message";

const scene = readMessage(sceneMessage(), null) as SceneMessage;
const counts: SceneCounts = countsOf(scene);

const reject = (buffer: ArrayBuffer, about: RegExp, of: SceneCounts | null = counts) =>
  assert.throws(() => readMessage(buffer, of), (error: unknown) => error instanceof MessageError && about.test(error.message));
const frameWith = (...sections: Section[]) => message(KIND.frame, text(FRAME), ...sections);

test("a scene is read in place", () => {
  assert.equal(scene.kind, "scene");
  assert.equal(scene.text.objects.length, 2);
  const corners = scene.triangles.get(1)!;
  assert.deepEqual([...corners], [0, 1, 2, 0, 2, 3]);
  assert.equal(corners.byteOffset % 16, 0);
});

test("a frame is read in place", () => {
  const buffer = frameMessage();
  const frame = readMessage(buffer, counts) as FrameMessage;
  assert.equal(frame.positions.get(0)!.buffer, buffer);
  assert.deepEqual(keyAt(frame.lists.contacts, 0), [0, 0, 1, 1]);
  assert.equal(frame.lists.contact_points.columns["position"]!.buffer, buffer);
  assert.equal(numberAt(frame.lists.contact_points, "position", 3), 1);
  assert.deepEqual([frame.lists.continuous_contacts.count, frame.lists.curves.count], [1, 0]);
  assert.deepEqual([...frame.statistics], [0.001, 1]);
  assert.deepEqual([...frame.collidingVertices.get(1)!], [0, 3]);
  assert.deepEqual([...frame.events.narrow_phase.begin], [7, 0, 1]);
  assert.deepEqual([...frame.events.volume.end], [6, 0, 1]);
  assert.equal(frame.collidingBoxes.get(1)!.length, 8);
  assert.ok(Number.isNaN(frame.positions.get(1)![11]));
});

test("series, answers and failures are read", () => {
  const series = readMessage(seriesMessage(), counts);
  assert.ok(series.kind === "series" && series.values.length === 4);
  assert.deepEqual(Object.values(series.events).map(({ begin, end }) => [[...begin], [...end]]), [[[1, 0, 1], []], [[], [2, 0, 1]], [[], []]]);
  const answer = readMessage(message(KIND.answer, text({ id: 7, stage: "contact" })), counts);
  assert.ok(answer.kind === "answer" && answer.text.id === 7);
  const failure = readMessage(message(KIND.failure, text({ message: "no", fatal: true })), null);
  assert.ok(failure.kind === "failure" && failure.text.fatal);
  const dropped = readMessage(message(KIND.failure, text({ message: "no", fatal: false, layers: ["octree"] })), counts);
  assert.ok(dropped.kind === "failure");
  assert.deepEqual(dropped.text.layers, ["octree"]);
  reject(message(KIND.failure, text({ message: "no", fatal: false, layers: "octree" })), /valid “layers”/);
});

test("unknown tags are passed over, unknown kinds are not", () => {
  const frame = readMessage(frameWith({ tag: 999, count: 5, data: new Uint8Array(7) }, { tag: 33, object: 999, count: 5, data: new Uint8Array(7) }, ...rowsOf("object_pairs", { object_b: 1 })), counts);
  assert.ok(frame.kind === "frame" && frame.lists.object_pairs.count === 1);
  reject(message(9, text({})), /unknown kind/);
  reject(message(0, text({})), /unknown kind/);
});

test("a frame before the scene is refused", () => reject(frameMessage(), /before the scene/, null));

test("a wrong header is refused", () => {
  const with32 = (at: number, value: number) => {
    const buffer = frameMessage();
    new DataView(buffer).setUint32(at, value, true);
    return buffer;
  };
  reject(with32(0, 1), /does not begin/);
  reject(with32(4, 1 | (2 << 16)), /version 1/);
  reject(with32(8, 16), /length/);
  reject(with32(12, 99), /ends within/);
  reject(with32(12, 1), /longer/);
  reject(new ArrayBuffer(0), /shorter/);
});

test("ids that are not there are refused", () => {
  const rejectRow = (list: ListName, row: Record<string, number | number[]>, about: RegExp) => reject(frameWith(...rowsOf(list, row)), about);
  rejectRow("object_pairs", { object_b: 2 }, /object_pairs has an unknown object_b/);
  rejectRow("contacts", { triangle_a: 1, object_b: 1 }, /contacts names an element/);
  rejectRow("contacts", { object_b: 1, kind: 3 }, /contacts has an unknown kind/);
  reject(frameWith(words(38, 4, [0, 0, 1, 2])), /candidates/);
  reject(frameWith(words(42, 1, [4], 1)), /colliding_vertices/);
  const impact = { object_b: 1, element_a: [0, 0], element_b: [1, 1] };
  rejectRow("continuous_contacts", { ...impact, element_a: [3, 3] }, /names an element/);
  rejectRow("continuous_contacts", { ...impact, kind: 2, element_a: [0, 3] }, /names an element/);
  rejectRow("continuous_contacts", { ...impact, kind: 3, element_b: [0, 4] }, /names an element/);
  rejectRow("continuous_contacts", { ...impact, kind: 6 }, /unknown kind/);
  rejectRow("continuous_contacts", { ...impact, certainty: 2 }, /unknown certainty/);
  rejectRow("proximity_pairs", { object_b: 2 }, /proximity_pairs has an unknown object_b/);
  rejectRow("penetrations", { vertex: 99, object_b: 1 }, /penetrations names an element/);
  rejectRow("penetrations", { object_b: 1, triangle: 2 }, /penetrations names an element/);
  rejectRow("curves", { object_b: 2 }, /curves has an unknown object_b/);
  rejectRow("curves", { object_b: 1, kind: 3 }, /curves has an unknown kind/);
  reject(frameWith(...rowsOf("curves", { object_b: 1 }).slice(1)), /columns of curves have different lengths/);
  reject(frameWith(floats(32, 3, [0, 0, 0], 0)), /positions/);
  reject(frameWith(floats(32, 3, [0, 0, 0], 5)), /positions/);
  reject(frameWith(floats(40, 8, new Array<number>(8).fill(0), 2)), /octree/);
  reject(frameWith(floats(50, 8, new Array<number>(8).fill(0), 2)), /octree/);
  for (const tag of [44, 46, 49]) reject(frameWith(words(tag, 3, [5, 0, 2])), /_begin|_end/);
  reject(frameWith({ tag: 43, count: 1, data: new Float64Array(1) }), /statistics/);
});

test("sections that do not fit are refused", () => {
  reject(frameWith({ tag: 38, count: 2, data: new Uint32Array(2) }), /length/);
  reject(frameWith({ tag: 33, object: 0, count: 1, data: new Uint32Array(2) }), /length/);
  reject(frameWith({ tag: 38, count: 0x40000001, data: new Uint32Array(4) }), /length/);
  reject(frameWith(...rowsOf("object_pairs", {}), ...rowsOf("object_pairs", {})), /twice/);
  reject(frameWith(words(16, 3, [0, 1, 2], 0)), /kind frame/);
  reject(frameWith(words(38, 4, [0, 0, 1, 0], 0)), /wrong object/);
  reject(frameWith(words(33, 1, [0])), /wrong object/);
  reject(message(KIND.frame), /no text/);
  reject(message(KIND.frame, { tag: 1, count: 2, data: new Uint8Array([0xff, 0xfe]) }), /JSON/);
  reject(message(KIND.frame, text([1])), /JSON object/);
  reject(message(KIND.frame, text({ ...FRAME, step: -1 })), /step/);
});

test("a scene must have all it names", () => {
  const triangles = [words(16, 3, [0, 1, 2], 0), words(16, 3, [0, 1, 2, 0, 2, 3], 1)];
  reject(message(KIND.scene, text(SCENE), triangles[0]!), /no triangles/);
  reject(message(KIND.scene, text(SCENE), triangles[0]!, words(16, 3, [0, 1, 2], 1)), /lacks triangles/);
  reject(message(KIND.scene, text(SCENE), triangles[0]!, words(16, 3, [0, 1, 2, 0, 2, 4], 1)), /vertex/);
  for (const name of Object.keys(SCENE)) {
    const { [name as keyof typeof SCENE]: _, ...rest } = SCENE;
    reject(message(KIND.scene, text(rest), ...triangles), /valid/);
  }
});

test("a frame of a scene that is gone is not looked into", () => {
  const old = message(KIND.frame, text({ ...FRAME, generation: 0 }), ...rowsOf("contacts", { object_a: 9, triangle_a: 9, object_b: 9, triangle_b: 9 }));
  assert.equal(readMessage(old, counts).kind, "frame");
});

test("every part of a message that is cut off is refused", () => {
  for (const make of [sceneMessage, frameMessage, seriesMessage]) {
    const whole = make();
    for (let length = 0; length < whole.byteLength; ++length) {
      assert.throws(() => readMessage(whole.slice(0, length), counts), MessageError);
      if (length < 16) continue;
      const cut = whole.slice(0, length);  // a message that states its own length
      new DataView(cut).setUint32(8, length, true);
      assert.throws(() => readMessage(cut, counts), MessageError);
    }
  }
});

/** A small random number generator with reproducible numbers. */
function numbersFrom(seed: number): () => number {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/** Layers access a frame only within its arrays. */
function useFrame(frame: FrameMessage): void {
  if (frame.text.generation !== counts.generation) return;
  const { contacts, contact_points } = frame.lists;
  for (let place = 0; place < contacts.count; ++place) {
    assert.ok(numberAt(contacts, "triangle_a", place)! < counts.triangles[objectAt(contacts, "a", place)]!);
    assert.ok(rowsIn(contacts, place, "contact_points", frame.lists).end <= contact_points.count);
  }
  for (const [object, positions] of frame.positions) assert.equal(positions.length, 3 * counts.vertices[object]!);
}

test("changed bytes are read as a message or refused, never worse", () => {
  const random = numbersFrom(2007);
  let refused = 0;
  for (let round = 0; round < 20_000; ++round) {
    const make = [sceneMessage, frameMessage, seriesMessage][Math.floor(random() * 3)]!;
    const bytes = new Uint8Array(make());
    for (let k = Math.ceil(random() * 4); k > 0; --k) bytes[Math.floor(random() * bytes.length)] = Math.floor(random() * 256);
    try {
      const read = readMessage(bytes.buffer, counts);
      if (read.kind === "frame") useFrame(read);
    } catch (error) {
      assert.ok(error instanceof MessageError, String(error));
      refused += 1;
    }
  }
  assert.ok(refused > 5000);
});

test("statistics have a row for each step, and edges and points of no triangle are elements", () => {
  const rows = (numbers: number[]): Section => ({ tag: 43, object: NONE, count: numbers.length, data: new Float64Array(numbers) });
  const frame = readMessage(message(KIND.frame, text(FRAME), rows([1, 2, 3, 4, 5, 6])), counts) as FrameMessage;
  assert.deepEqual([...frame.steps], [1, 2, 3, 4, 5, 6]);
  assert.deepEqual([...frame.statistics], [5, 6]);
  assert.throws(() => readMessage(message(KIND.frame, text(FRAME), rows([1, 2, 3])), counts), MessageError);

  const triangles = [words(16, 3, [0, 1, 2], 0), words(16, 3, [0, 1, 2, 1, 2, 3], 1)];
  const loose = readMessage(message(KIND.scene, text(SCENE), ...triangles, words(17, 2, [0, 1, 1, 2], 1), words(18, 1, [3], 1)), null) as SceneMessage;
  assert.deepEqual(countsOf(loose).triangles, [1, 5]);
  assert.throws(() => readMessage(message(KIND.scene, text(SCENE), ...triangles, words(18, 1, [9], 1)), null), MessageError);
});
