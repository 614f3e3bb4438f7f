import assert from "node:assert/strict";
import { test } from "node:test";
import { NONE, type FrameMessage, type SceneMessage } from "../src/protocol/messages";
import { readMessage } from "../src/protocol/read_message";
import { countsOf, type SceneCounts } from "../src/protocol/read_scene";
import { MessageError } from "../src/protocol/read_sections";
import { floats, FRAME, frameMessage, KIND, message, SCENE, sceneMessage, seriesMessage, text, words, type Section } from "./build_message";

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
  assert.deepEqual([...frame.contacts], [0, 0, 1, 1, 1, 2, 0, 0]);
  assert.equal(frame.contactPoints[8], 1);
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
  const frame = readMessage(frameWith({ tag: 999, count: 5, data: new Uint8Array(7) }, words(33, 2, [0, 1])), counts);
  assert.ok(frame.kind === "frame" && frame.objectPairs.length === 2);
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
  reject(with32(4, 2 | (2 << 16)), /version 2/);
  reject(with32(8, 16), /length/);
  reject(with32(12, 99), /ends within/);
  reject(with32(12, 1), /longer/);
  reject(new ArrayBuffer(0), /shorter/);
});

test("ids that are not there are refused", () => {
  reject(frameWith(words(33, 2, [0, 2])), /object_pairs/);
  reject(frameWith(words(34, 8, [0, 1, 1, 0, 0, 0, 0, 0])), /contacts/);
  reject(frameWith(words(34, 8, [0, 0, 1, 0, 1, 2, 0, 0])), /points/);
  reject(frameWith(words(38, 4, [0, 0, 1, 2])), /candidates/);
  reject(frameWith(words(42, 1, [4], 1)), /colliding_vertices/);
  reject(frameWith(words(36, 8, [0, 3, 0, 1, 1, 0, 0, 0]), floats(37, 8, new Array<number>(8).fill(0))), /impact/);
  reject(frameWith(words(36, 8, [0, 0, 0, 1, 1, 0, 0, 0])), /impacts/);
  for (const row of [[0, 0, 0, 1, 1, 0, 6, 0], [0, 0, 0, 1, 1, 0, 0, 2], [0, 0, 0, 1, 0, 4, 3, 0]])
    reject(frameWith(words(36, 8, row), floats(37, 8, new Array<number>(8).fill(0))), /impact/);
  reject(frameWith(words(34, 8, [0, 0, 1, 0, 3, 0, 0, 0])), /kind/);
  reject(frameWith(words(54, 2, [0, 2]), floats(55, 8, new Array<number>(8).fill(0))), /proximity pair/);
  reject(frameWith(words(54, 2, [0, 1])), /proximity pairs/);
  reject(frameWith(words(56, 4, [0, 99, 1, 0]), floats(57, 8, new Array<number>(8).fill(0))), /penetrations/);
  reject(frameWith(words(56, 4, [0, 0, 1, 0])), /penetrations/);
  const curve = (row: number[], enclosed: number[]) =>
    frameWith(words(58, 8, row), floats(59, 8, new Array<number>(8).fill(0)), words(60, 1, enclosed));
  const taken = readMessage(curve([0, 1, 0, 5, 0, 1, 2, 0], [2, 3, 0]), counts);
  assert.ok(taken.kind === "frame" && taken.enclosedVertices.length === 3);
  reject(curve([0, 2, 0, 5, 0, 1, 2, 0], [2, 3, 0]), /object/);
  reject(curve([0, 1, 3, 5, 0, 1, 2, 0], [2, 3, 0]), /kind/);
  reject(curve([0, 1, 0, 5, 0, 1, 2, 0], [3, 3, 0]), /encloses/);
  reject(curve([0, 1, 0, 5, 0, 1, 2, 0], [2, 3]), /encloses/);
  reject(curve([0, 1, 0, 5, 0xffffffff, 1, 2, 0], [2, 3, 0]), /encloses/);
  reject(frameWith(words(58, 8, [0, 1, 0, 5, 0, 0, 0, 0])), /curves/);
  reject(frameWith(floats(32, 3, [0, 0, 0], 0)), /positions/);
  reject(frameWith(floats(32, 3, [0, 0, 0], 5)), /positions/);
  reject(frameWith(floats(40, 8, new Array<number>(8).fill(0), 2)), /octree/);
  reject(frameWith(floats(50, 8, new Array<number>(8).fill(0), 2)), /octree/);
  for (const tag of [44, 46, 49]) reject(frameWith(words(tag, 3, [5, 0, 2])), /_begin|_end/);
  reject(frameWith({ tag: 43, count: 1, data: new Float64Array(1) }), /statistics/);
});

test("sections that do not fit are refused", () => {
  reject(frameWith({ tag: 33, count: 2, data: new Uint32Array(2) }), /length/);
  reject(frameWith({ tag: 33, count: 0x40000001, data: new Uint32Array(2) }), /length/);
  reject(frameWith(words(33, 2, [0, 1]), words(33, 2, [0, 1])), /twice/);
  reject(frameWith(words(16, 3, [0, 1, 2], 0)), /kind frame/);
  reject(frameWith(words(33, 2, [0, 1], 0)), /wrong object/);
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
  const old = message(KIND.frame, text({ ...FRAME, generation: 0 }), words(34, 8, [9, 9, 9, 9, 0, 0, 0, 0]));
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
  for (let i = 0; i < frame.contacts.length; i += 8) {
    assert.ok(frame.contacts[i + 1]! < counts.triangles[frame.contacts[i]!]!);
    assert.ok(8 * (frame.contacts[i + 5]! + frame.contacts[i + 6]!) <= frame.contactPoints.length);
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
