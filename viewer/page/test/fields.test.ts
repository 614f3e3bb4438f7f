import assert from "node:assert/strict";
import { test } from "node:test";
import * as THREE from "three";
import type { Pen } from "../src/capture/pen";
import { barHeight, barOf, drawColourBar, ticksOf } from "../src/fields/colour_bar";
import { colourAt, MAPS } from "../src/fields/colour_maps";
import { firstChoice, rangeOf, readField, showsColour, tickText } from "../src/fields/fields";
import { fillArrows } from "../src/fields/marks";
import { FieldPaint } from "../src/fields/paint";
import { Model, type ObjectState } from "../src/model";
import type { FrameMessage, SceneMessage } from "../src/protocol/messages";
import { readMessage } from "../src/protocol/read_message";
import { countsOf } from "../src/protocol/read_scene";
import type { Lines } from "../src/view/marks";
import { showView } from "../src/view_state";
import { floats, FRAME, KIND, message, rowsOf, sceneMessage, text, type Section } from "./build_message";

const scene = () => readMessage(sceneMessage(), null) as SceneMessage;
const frameOf = (field: string | null, ...sections: Section[]) =>
  readMessage(message(KIND.frame, text({ ...FRAME, field }), { tag: 43, count: 2, data: new Float64Array([0.001, 1]) }, ...sections), countsOf(scene())) as FrameMessage;

function modelWith(key: string | null, frame: FrameMessage): Model {
  const model = new Model();
  model.takeScene(scene());
  model.setField({ key });
  model.takeFrame(frame);
  return model;
}

test("an object that a field covers shows no colour of its own", () => {
  const shown = (key: string | null, ...sections: Section[]) => {
    const model = modelWith(key, frameOf(key, ...sections));
    return model.objects.map((object) => showsColour(readField(model), object));
  };
  const whole = floats(61, 1, [4, 5, 6, 7], 1);
  assert.deepEqual(shown("speed", floats(61, 1, [1, 2, 3], 0), whole), [false, false]);
  assert.deepEqual(shown("speed", floats(61, 1, [1, NaN, 3], 0), whole), [true, false]);
  assert.deepEqual(shown("speed", whole), [true, false]);
  assert.deepEqual(shown(null), [true, true]);
});

test("colour maps are those of matplotlib", () => {
  const hex = (map: (typeof MAPS)[number]) => [0, 64, 128, 200, 255].map((i) => colourAt(map, i / 255));
  const known = {
    viridis: ["440154", "3b528b", "21918c", "70cf57", "fde725"], cividis: ["00224e", "434e6c", "7d7c78", "c4b468", "fee838"],
    magma: ["000004", "51127c", "b73779", "fd9869", "fcfdbf"], inferno: ["000004", "57106e", "bc3754", "fb9d07", "fcffa4"],
    coolwarm: ["3b4cc0", "8db0fe", "dddcdc", "f08b6e", "b40426"],
  };
  for (const map of MAPS)
    hex(map).forEach((colour, i) => {
      const expected = [0, 2, 4].map((at) => parseInt(known[map][i]!.slice(at, at + 2), 16));
      colour.forEach((channel, k) => assert.ok(Math.abs(channel - expected[k]!) <= 2, `${map} ${i}: ${colour} is not ${expected}`));
    });
  assert.deepEqual(colourAt("viridis", -1), colourAt("viridis", 0));
  assert.deepEqual(colourAt("viridis", 7), colourAt("viridis", 1));
});

test("the values of a frame have a range, also with gaps", () => {
  const data = readField(modelWith("speed", frameOf("speed", floats(61, 1, [1, NaN, -2], 0))))!;
  assert.deepEqual([data.lowest, data.highest, data.hasGaps], [-2, 1, true]);
  assert.deepEqual(rangeOf(data, { range: null, map: "viridis" }), [-2, 1]);
  assert.deepEqual(rangeOf(data, { range: null, map: "coolwarm" }), [-2, 2]);
  assert.deepEqual(rangeOf(data, { range: [0, 9], map: "coolwarm" }), [0, 9]);
  const whole = readField(modelWith("speed", frameOf("speed", floats(61, 1, [1, 2, 3], 0), floats(61, 1, [4, 5, 6, 7], 1))))!;
  assert.deepEqual([whole.lowest, whole.highest, whole.hasGaps], [1, 7, false]);
  const none = readField(modelWith("speed", frameOf("speed")))!;
  assert.deepEqual(rangeOf(none, { range: null, map: "viridis" }), [0, 0]);
});

test("values of another field are not shown", () => {
  assert.equal(readField(modelWith("strain", frameOf("speed", floats(61, 1, [1, 2, 3], 0)))), null);
  assert.equal(readField(modelWith(null, frameOf(null))), null);
  assert.equal(readField(modelWith("user:gone", frameOf(null))), null);
});

test("vectors have their lengths, and contacts the values of their column", () => {
  const wind = readField(modelWith("user:wind", frameOf("user:wind", floats(62, 3, [3, 4, 0, 0, 0, 0, 0, 0, -2], 0))))!;
  assert.deepEqual([...wind.values.get(0)!], [5, 0, 2]);
  const gap = readField(modelWith("gap", frameOf("gap", ...rowsOf("proximity_pairs", { object_b: 1, distance: 0.25 }, { object_b: 1, distance: 0.5 }))))!;
  assert.deepEqual([gap.lowest, gap.highest, [...Array.from(gap.ofRows)]], [0.25, 0.5, [0.25, 0.5]]);
});

test("values that do not fit the scene are refused", () => {
  const refused = (pattern: RegExp, field: string | null, ...sections: Section[]) => assert.throws(() => frameOf(field, ...sections), pattern);
  refused(/lacks values of Speed of object 1/, "speed", floats(61, 1, [1, 2, 3], 1));
  refused(/lacks values of Strain of object 0/, "strain", floats(61, 1, [1, 2, 3], 0));
  refused(/lacks values of Speed of object 7/, "speed", floats(61, 1, [1], 7));
  refused(/that it does not name/, null, floats(61, 1, [1, 2, 3], 0));
  refused(/that it does not name/, "speed", floats(62, 3, [1, 2, 3, 1, 2, 3, 1, 2, 3], 0));
  assert.equal(frameOf("strain", floats(61, 1, [1], 0)).fieldValues.size, 1);
});

test("numbers at ticks are short and tell the ticks apart", () => {
  assert.deepEqual(ticksOf({ low: 0, high: 2.5 }, 5), ["0", "0.63", "1.25", "1.88", "2.5"]);
  assert.deepEqual(ticksOf({ low: -0.2, high: 0.2 }, 3), ["-0.2", "0", "0.2"]);
  assert.deepEqual(ticksOf({ low: 3, high: 3 }, 5), ["3"]);
  assert.equal(new Set(ticksOf({ low: 1000, high: 1000.02 }, 5)).size, 5);
  assert.equal(tickText(1.5e-5, 1e-5), "1.5e-5");
  assert.equal(tickText(2e7, 1e7), "2e7");
  assert.equal(tickText(0, 1e7), "0");
});

test("the bar says what it shows", () => {
  const bar = barOf(modelWith("speed", frameOf("speed", floats(61, 1, [1, 2, 3], 0))))!;
  assert.deepEqual([bar.title, bar.low, bar.high, bar.map], ["Speed (length/s)", 1, 3, "viridis"]);
  assert.ok(/Without a value/.test(bar.note));
  assert.ok(/need the step before/.test(barOf(modelWith("speed", frameOf("speed")))!.note));
  assert.equal(barOf(modelWith(null, frameOf(null))), null);
  const written: string[] = [];
  const rows: number[] = [];
  const pen: Pen = { box: () => {}, text: (_x, y, line) => (written.push(line), rows.push(y)) };
  drawColourBar(pen, { x: 0, y: 100, width: 300, fontSize: 10, ink: "black", halo: null }, bar);
  assert.deepEqual(written, ["Speed (length/s)", "1", "1.5", "2", "2.5", "3", bar.note]);
  assert.ok(Math.min(...rows) >= 100 && Math.max(...rows) + 2 <= 100 + barHeight(bar, 10));
});

const objects = [
  { index: 0, vertices: 3, triangles: 1, corners: new Uint32Array([0, 1, 2]), positions: new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]) },
  { index: 1, vertices: 4, triangles: 1, corners: new Uint32Array([0, 1, 3, 2, 2, 2]), positions: new Float32Array(12).fill(5) },
] as unknown as ObjectState[];

test("a field of triangles is drawn by triangles without shared vertices", () => {
  const shared = new THREE.BufferGeometry();
  const paint = new FieldPaint();
  paint.build(objects, [shared]);
  const field = (element: string, values: [number, number[]][]) =>
    ({ form: { element, vector: false }, values: new Map(values.map(([object, list]) => [object, new Float32Array(list)])), lowest: 1, highest: 3 }) as never;
  const array = (geometry: THREE.BufferGeometry, name: string) => [...(geometry.getAttribute(name) as THREE.BufferAttribute).array];

  const faces = paint.show(field("face", [[0, [3]], [1, [NaN]]]), firstChoice());
  assert.ok(faces !== shared);
  const none = Math.fround(3e38);
  assert.deepEqual(array(faces, "value"), [3, 3, 3, none, none, none, none, none, none]);  // the last element is a point
  assert.deepEqual(array(faces, "object"), [0, 0, 0, 1, 1, 1, 1, 1, 1]);
  assert.deepEqual(array(faces, "position").slice(0, 9), [0, 0, 0, 1, 0, 0, 0, 1, 0]);
  assert.deepEqual([paint.uniforms.isMapped.value, paint.looseUniforms.isMapped.value], [true, false]);

  assert.equal(paint.show(field("vertex", [[1, [1, 2, 3, 1]]]), firstChoice()), shared);
  assert.deepEqual(array(shared, "value"), [none, none, none, 1, 2, 3, 1]);
  assert.deepEqual(paint.uniforms.covered.value.toArray(), [1, 0.5]);

  assert.equal(paint.show(null, firstChoice()), shared);
  assert.equal(shared.hasAttribute("value"), false);
  assert.equal(paint.uniforms.isMapped.value, false);
});

test("arrows are as long as their vectors, relative to the end of the range", () => {
  const model = modelWith("user:wind", frameOf("user:wind", floats(62, 3, [0, 4, 0, 0, 0, 0, NaN, 1, 1], 0)));
  const arrows = { rows: [] as number[], span: 0, fill(count: number, write: (into: Float32Array) => number) {
    const into = new Float32Array(6 * count);
    this.rows = [...into.subarray(0, 6 * write(into))];
  } };
  fillArrows(arrows as unknown as Lines, model);
  assert.deepEqual(arrows.rows.slice(3), [0, 1, 0]);
  model.setField({ range: [0, 8] });
  fillArrows(arrows as unknown as Lines, model);
  assert.deepEqual(arrows.rows.slice(3), [0, 0.5, 0]);
});

test("a view brings a choice, and keeps what it does not name", () => {
  const model = new Model();
  showView(model, { field: { key: "speed", map: "magma", range: [0, 2], arrow_length: 50 } });
  assert.deepEqual(model.field, { key: "speed", map: "magma", range: [0, 2], arrowLength: 50 });
  showView(model, { field: { map: "cividis" } });
  assert.deepEqual(model.field, { key: "speed", map: "cividis", range: [0, 2], arrowLength: 50 });
  showView(model, { field: { key: null, range: null } });
  assert.deepEqual(model.field, { key: null, map: "cividis", range: null, arrowLength: 50 });
  showView(model, {});
  assert.equal(model.field.map, "cividis");
});

test("only fields of the scene are requested", () => {
  const model = new Model();
  model.takeScene(scene());
  model.setField({ key: "user:later" });
  assert.equal(model.request()["field"], null);
  model.setField({ key: "strain" });
  assert.equal(model.request()["field"], "strain");
  assert.deepEqual(model.dropLayers(["field"]), ["field"]);
  assert.equal(model.request()["field"], null);
});
