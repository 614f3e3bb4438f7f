import assert from "node:assert/strict";
import { test } from "node:test";
import { LAYERS } from "../src/model";
import type { ViewState } from "../src/view_state";
import { hashOfView, parseView, viewOfHash } from "../src/views/view_file";
import { LAYER_ROWS } from "../src/view/styles";

const VIEW: ViewState = {
  version: 1, camera: { position: [1, 2, 3], target: [0, 0, 0.5], zoom: 1.5, orthographic: true },
  layers: { wireframe: true }, octree: { only_selected: false, level: -1 }, nodes: { objects: [0, 1], level: -2 },
  marks: { slice: "x", slice_at: 0.25, up: "z" }, objects: { "a.obj": { visible: false, colour: "#8ECAE6", opacity: 0 } },
  field: { key: "speed", map: "magma", range: [0, 2], arrow_length: 50 },
  filter: "a", tab: "Pins", panels: false,
  views: { layout: "two", cameras: { second: { position: [0, 0, 2], target: [0, 0, 0], zoom: 1, orthographic: true } }, slices: { second: { axis: "y", at: 0.5, flipped: true } }, hidden: { second: { "a.obj": true } } },
  pins: { 1: { a: "a.obj" }, 2: { a: "a.obj", b: "b.obj", contact: "0 3 1 4" } },
};
const refuses = (view: unknown, sentence: RegExp) => assert.throws(() => parseView(typeof view === "string" ? view : JSON.stringify(view)), sentence);

test("a view file is read as it was written", () => {
  assert.deepEqual(parseView(JSON.stringify(VIEW)), VIEW);
  assert.deepEqual(parseView('{"version":1}'), { version: 1 });
  assert.deepEqual(parseView('{"version":1,"nodes":{"objects":null}}').nodes, { objects: null });
});

test("a malformed view names the member and what it must be", () => {
  refuses("{", /not JSON/);
  refuses("[]", /it has no members/);
  refuses({}, /version is missing/);
  refuses({ version: 2 }, /version is not 1\./);
  refuses({ version: 1, cameras: {} }, /cameras is unknown/);
  refuses({ version: 1, camera: [] }, /camera is not an object/);
  refuses({ version: 1, camera: { zoom: 0 } }, /camera\.zoom is not a finite number above 0/);
  refuses({ version: 1, field: { range: [2, 1] } }, /field\.range is not null, or two numbers/);
  refuses({ version: 1, field: { map: "jet" } }, /field\.map is not one of viridis/);
  refuses({ version: 1, field: { key: 3 } }, /field\.key is not null, or a text/);
  refuses({ version: 1, camera: { position: [1, 2] } }, /camera\.position is not three finite numbers/);
  refuses({ version: 1, layers: { surfaces: true } }, /layers\.surfaces is unknown/);
  refuses({ version: 1, layers: { surface: 1 } }, /layers\.surface is not true or false/);
  refuses({ version: 1, octree: { level: 1.5 } }, /octree\.level is not a whole number from -1 to 32/);
  refuses({ version: 1, marks: { slice: "w" } }, /marks\.slice is not one of off, x, y, z/);
  refuses({ version: 1, objects: { "a.b": { colour: "red" } } }, /objects\.a\.b\.colour is not a colour such as/);
  refuses({ version: 1, objects: { a: { size: 1 } } }, /objects\.a\.size is unknown/);
  refuses({ version: 1, nodes: { objects: [0] } }, /nodes\.objects is not null, or two objects/);
  refuses({ version: 1, filter: 3 }, /filter is not a text/);
  refuses({ version: 1, views: { layout: "three" } }, /views\.layout is not one of one, two, four/);
  refuses({ version: 1, pins: { 1: { c: "x" } } }, /pins\.1\.c is unknown/);
});

test("every layer of view files has a row in the panel, and no other", () => {
  assert.deepEqual(LAYER_ROWS.map(({ layer }) => layer).sort(), [...LAYERS].sort());
});

test("a link contains a view, and says when it is damaged", async () => {
  const hash = await hashOfView({ ...VIEW, step: 12 });
  assert.ok(/^#view=[\w-]+$/.test(hash), hash);
  assert.deepEqual(await viewOfHash(hash), { ...VIEW, step: 12 });
  assert.equal(await viewOfHash("#camera=1,2,3"), null);
  for (const broken of [hash.slice(0, -20), "#view=???"]) {
    const sentence = await viewOfHash(broken).then(() => "", (error: Error) => error.message);
    assert.ok(/damaged/.test(sentence), sentence);
  }
});
