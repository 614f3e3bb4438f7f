/** Writes messages as the session does, to test the reader. */
import { COLUMNS, formOf, type ListName } from "../src/protocol/lists";
import { NONE } from "../src/protocol/messages";
import { ARRAYS } from "../src/protocol/sections_generated";

type Numbers = Uint8Array | Uint32Array | Float32Array | Float64Array;
export interface Section {
  tag: number;
  object?: number;
  count: number;
  data: Numbers;
}

export const KIND = { scene: 1, frame: 2, answer: 3, failure: 4, series: 5 };

export function text(json: unknown): Section {
  const data = new TextEncoder().encode(JSON.stringify(json));
  return { tag: 1, count: data.length, data };
}

const padded = (length: number): number => Math.ceil(length / 16) * 16;

export function message(kind: number, ...sections: Section[]): ArrayBuffer {
  const length = 16 + sections.reduce((sum, section) => sum + 16 + padded(section.data.byteLength), 0);
  const buffer = new ArrayBuffer(length);
  const view = new DataView(buffer);
  view.setUint32(0, 0x4c505553, true);
  view.setUint16(4, 2, true);
  view.setUint16(6, kind, true);
  view.setUint32(8, length, true);
  view.setUint32(12, sections.length, true);
  let at = 16;
  for (const { tag, object = NONE, count, data } of sections) {
    [tag, object, count, data.byteLength].forEach((value, i) => view.setUint32(at + 4 * i, value, true));
    new Uint8Array(buffer, at + 16, data.byteLength).set(new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
    at += 16 + padded(data.byteLength);
  }
  return buffer;
}

export const SCENE = {
  version: "0.5.0", title: "two", source: "simulation", generation: 1, run: 1, settings: [], center: [0, 0, 0], bounds: [[-1, -1, -1], [1, 1, 1]],
  objects: [
    { name: "one", vertices: 3, triangles: 1, static: false, body: true, self_collision: false, margin: 0.5 },
    { name: "other", vertices: 4, triangles: 2, static: true, body: false, self_collision: false, margin: 0.5 },
  ],
  frames: null, time_step: 0.01, seed: "0", contacts: "intersection",
  fields: [
    { key: "speed", label: "Speed", doc: "How fast", unit: "length/s", element: "vertex", vector: false },
    { key: "strain", label: "Strain", doc: "", unit: "", element: "face", vector: false },
    { key: "user:wind", label: "wind", doc: "", unit: "", element: "vertex", vector: true },
    { key: "gap", label: "Gap", doc: "", unit: "length", element: "contact", vector: false, list: "proximity_pairs", column: "distance" },
  ],
  can: ["play", "reset", "grab", "set"], statistics: ["total_seconds", "contacts"],
  series: ["time", "contacts"], warnings: [],
};

export const FRAME = { generation: 1, step: 3, time: 0.03, playing: true, speed: 1, octree_levels: [], omitted: {} };

export const words = (tag: number, width: number, numbers: number[], object = NONE): Section =>
  ({ tag, object, count: numbers.length / width, data: new Uint32Array(numbers) });
export const floats = (tag: number, width: number, numbers: number[], object = NONE): Section =>
  ({ tag, object, count: numbers.length / width, data: new Float32Array(numbers) });

/** The columns of a list, from rows of numbers by name; those that are not named are 0. */
export const rowsOf = (list: ListName, ...rows: Record<string, number | number[]>[]): Section[] =>
  formOf(list).columns.map((form) => {
    const { name, scalar, width } = form;
    const data = new ARRAYS[scalar](width * rows.length);
    rows.forEach((row, i) => data.set([row[name] ?? 0].flat(), width * i));
    return { tag: 33, object: COLUMNS.indexOf(form), count: rows.length, data };
  });

export const sceneMessage = (): ArrayBuffer => message(KIND.scene, text(SCENE), words(16, 3, [0, 1, 2], 0), words(16, 3, [0, 1, 2, 0, 2, 3], 1));

/** A frame with one section per tag. */
export const frameMessage = (): ArrayBuffer =>
  message(
    KIND.frame, text(FRAME),
    floats(32, 3, [0, 0, 0, 1, 0, 0, 0, 1, 0], 0),
    floats(32, 3, [0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, NaN], 1),
    ...rowsOf("object_pairs", { object_b: 1 }),
    ...rowsOf("contacts", { object_b: 1, triangle_b: 1, kind: 1, point_count: 2 }),
    ...rowsOf("contact_points", {}, { position: [1, 0, 0] }),
    ...rowsOf("continuous_contacts", { object_b: 1, element_a: [2, 2], element_b: [1, 1], toi: 0.5 }),
    words(38, 4, [0, 0, 1, 1]),
    floats(39, 8, [-1, -1, -1, 0, 1, 1, 1, -1]),
    floats(40, 8, [-1, -1, -1, 0, 1, 1, 1, 2], 1),
    floats(41, 8, [0, 0, 0, 1, 0, 2, 0, 0], 1),
    words(42, 1, [0, 3], 1),
    { tag: 43, count: 2, data: new Float64Array([0.001, 1]) },
    words(44, 3, [7, 0, 1]),
    words(45, 3, []),
    words(46, 3, [7, 0, 1]),
    words(47, 3, []),
    words(48, 3, []),
    words(49, 3, [6, 0, 1]),
    floats(50, 8, [-1, -1, -1, 0, 1, 1, 1, 2], 1),
    floats(51, 8, [0, 0, 0, 1, 0, 2, 0, 0], 1),
    floats(52, 8, [-1, -1, -1, 0, 1, 1, 1, 2], 1),
    floats(53, 8, [-1, -1, -1, 0, 1, 1, 1, 2], 1),
  );

export const seriesMessage = (): ArrayBuffer =>
  message(KIND.series, { tag: 64, count: 2, data: new Float64Array([0, 1, 0.1, 2]) }, words(65, 3, [1, 0, 1]), words(66, 3, []), words(68, 3, [2, 0, 1]), words(69, 3, []));
