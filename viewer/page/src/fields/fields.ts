/** The numbers of the chosen field in the newest frame, and the range that its colours cover. */
import type { Model, ObjectState } from "../model";
import type { FieldForm } from "../protocol/field_form";
import { columnOf, type Numbers } from "../protocol/lists";
import type { FrameMessage } from "../protocol/messages";
import { isDiverging, type MapName } from "./colour_maps";

export interface FieldChoice {
  key: string | null;
  map: MapName;
  /** The lowest and the highest value; null: those of the frame. */
  range: [number, number] | null;
  /** The length of the longest arrow in CSS pixels. */
  arrowLength: number;
}

export const firstChoice = (): FieldChoice => ({ key: null, map: "viridis", range: null, arrowLength: 40 });

export interface FieldData {
  form: FieldForm;
  /** The numbers of vertices or triangles by object, or the lengths of their vectors. */
  values: Map<number, Float32Array>;
  vectors: Map<number, Float32Array>;
  /** A number for each row of a list. */
  ofRows: ArrayLike<number>;
  /** Of all finite values; not finite when there are none. */
  lowest: number;
  highest: number;
  /** Some vertices or triangles have no value. */
  hasGaps: boolean;
}

/** What the numbers of a field are, with their unit. */
export const titleOf = ({ label, vector, unit }: FieldForm): string => `${label}${vector ? ", length of the vector" : ""}${unit ? ` (${unit})` : ""}`;

/** The length of each vector. */
function lengthsOf(vectors: Numbers): Float32Array {
  const lengths = new Float32Array(vectors.length / 3);
  for (let i = 0; i < lengths.length; ++i) lengths[i] = Math.hypot(vectors[3 * i]!, vectors[3 * i + 1]!, vectors[3 * i + 2]!);
  return lengths;
}

function collect(form: FieldForm, frame: FrameMessage, counts: number[]): FieldData {
  const data: FieldData = { form, values: new Map(), vectors: new Map(), ofRows: [], lowest: Infinity, highest: -Infinity, hasGaps: false };
  const add = (value: number) => {
    if (!Number.isFinite(value)) return void (data.hasGaps = true);
    if (value < data.lowest) data.lowest = value;
    if (value > data.highest) data.highest = value;
  };
  if (form.element === "contact") {
    const numbers = frame.lists[form.list!].columns[form.column!]!;
    data.ofRows = columnOf(form.list!, form.column!)!.width === 3 ? lengthsOf(numbers) : numbers;
    for (let place = 0; place < data.ofRows.length; ++place) add(data.ofRows[place]!);
    return data;
  }
  data.vectors = frame.fieldVectors;
  data.values = form.vector ? new Map([...frame.fieldVectors].map(([object, vectors]) => [object, lengthsOf(vectors)])) : frame.fieldValues;
  for (const numbers of data.values.values()) for (const value of numbers) add(value);
  data.hasGaps ||= counts.some((count, object) => count > 0 && !data.values.has(object));
  return data;
}

const cache = new WeakMap<FrameMessage, FieldData>();

/** Null when no field is chosen, and until the first frame with the chosen one. */
export function readField({ scene, frame, field, objects }: Model): FieldData | null {
  const form = scene?.fields.find(({ key }) => key === field.key);
  if (!form || !frame || frame.text.field !== form.key) return null;
  let data = cache.get(frame);
  if (!data) cache.set(frame, (data = collect(form, frame, objects.map(({ vertices, triangles }) => (form.element === "face" ? triangles : vertices)))));
  return data;
}

/** Whether an object still shows its colour: where the field has no value for it. */
export function showsColour(data: FieldData | null, { index, corners, vertices, triangles }: Pick<ObjectState, "index" | "corners" | "vertices" | "triangles">): boolean {
  if (!data || data.form.element === "contact") return true;
  const isOfFaces = data.form.element === "face";
  const hasRest = isOfFaces && corners.length > 3 * triangles;  // edges and points
  const values = data.values.get(index);
  return hasRest || !values || values.length < (isOfFaces ? triangles : vertices) || !values.every(Number.isFinite);
}

/** The values at both ends of the colour map. Zero is in the middle of a diverging map. */
export function rangeOf({ lowest, highest }: Pick<FieldData, "lowest" | "highest">, { range, map }: Pick<FieldChoice, "range" | "map">): [number, number] {
  if (range) return range;
  if (!(lowest <= highest)) return [0, 0];
  const most = Math.max(Math.abs(lowest), Math.abs(highest));
  return isDiverging(map) ? [-most, most] : [lowest, highest];
}

/** Texts for numbers that are `step` apart. */
export function tickText(value: number, step: number): string {
  const size = Math.max(Math.abs(value), Math.abs(step));
  if (value !== 0 && (size >= 1e6 || size < 1e-3)) return value.toExponential(2).replace(/\.?0+e/, "e").replace("e+", "e");
  const decimals = step > 0 ? Math.max(0, Math.min(12, 1 - Math.floor(Math.log10(step)))) : 4;
  return String(Number(value.toFixed(decimals)));
}
