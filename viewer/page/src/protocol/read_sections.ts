/** Divides a message into its sections, and checks values of its text. */
import { COLUMNS, LIST_NAMES, rowsOf, type Lists, type Numbers } from "./lists";
import { EVENT_KINDS, NONE, type EventData, type FrameSections, type Vector } from "./messages";
import { ARRAYS, FORMS, type Form } from "./sections_generated";

export const ALIGNMENT = 16;

export class MessageError extends Error {}

/** Whether the page reads sections with this tag. */
export const readsTag = (tag: number): boolean => tag in FORMS;

export function fail(what: string): never {
  throw new MessageError(what);
}

export const isNumber = (value: unknown): value is number => typeof value === "number" && Number.isFinite(value);
export const isCount = (value: unknown): value is number => isNumber(value) && Number.isInteger(value) && value >= 0;
export const isText = (value: unknown): value is string => typeof value === "string";
export const isVector = (value: unknown): value is Vector =>
  Array.isArray(value) && value.length === 3 && value.every(isNumber);
export const isTexts = (value: unknown): value is string[] => Array.isArray(value) && value.every(isText);

export function need(ok: boolean, name: string): void {
  if (!ok) fail(`its text has no valid “${name}”`);
}


export class Sections {
  private readonly found = new Map<string, Map<number, Numbers>>();

  add(form: Form, object: number, data: Numbers): void {
    let objects = this.found.get(form.name);
    if (!objects) this.found.set(form.name, (objects = new Map()));
    const before = objects.size;
    objects.set(object, data);
    if (objects.size === before) fail(`its section ${form.name} occurs twice`);
  }

  ofFrame(): FrameSections {
    const forms = (Object.values(FORMS) as Form[]).filter(({ kinds, name }) => kinds[0] === "frame" && name !== "column");
    const members = Object.fromEntries(
      forms.map(({ name, scalar, is_of_object }) => [
        name.replace(/_(.)/g, (_, letter: string) => letter.toUpperCase()), is_of_object ? this.each(name) : this.one(name, new ARRAYS[scalar](0)),
      ]),
    );
    return members as unknown as FrameSections;
  }

  lists(): Lists {
    const sent = this.each("column");
    const rows = LIST_NAMES.map((list) => [list, rowsOf(list, (at) => sent.get(at)) ?? fail(`its columns of ${list} have different lengths`)]);
    return Object.fromEntries(rows) as Lists;
  }

  one<T extends Numbers>(name: string, empty: T): T {
    return (this.found.get(name)?.get(NONE) as T | undefined) ?? empty;
  }

  each<T extends Numbers>(name: string): Map<number, T> {
    return (this.found.get(name) ?? new Map()) as Map<number, T>;
  }

  events(prefix: string): EventData {
    const list = (name: string) => this.one(`${prefix}${name}`, new Uint32Array(0));
    return Object.fromEntries(EVENT_KINDS.map((kind) => [kind, { begin: list(`${kind}_begin`), end: list(`${kind}_end`) }])) as EventData;
  }

  json(): Record<string, unknown> {
    const bytes = this.found.get("text")?.get(NONE) as Uint8Array | undefined;
    if (!bytes) fail("it has no text");
    let value: unknown;
    try {
      value = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(bytes));
    } catch {
      fail("its text is not JSON");
    }
    if (typeof value !== "object" || value === null || Array.isArray(value)) fail("its text is not a JSON object");
    return value as Record<string, unknown>;
  }
}

export function readSections(buffer: ArrayBuffer, kind: string, count: number, seriesWidth: number): Sections {
  const view = new DataView(buffer);
  const sections = new Sections();
  let at = ALIGNMENT;
  for (let i = 0; i < count; ++i) {
    if (at + ALIGNMENT > buffer.byteLength) fail("it ends within its sections");
    const tag = view.getUint32(at, true);
    const object = view.getUint32(at + 4, true);
    const elements = view.getUint32(at + 8, true);
    const bytes = view.getUint32(at + 12, true);
    const start = at + ALIGNMENT;
    at = start + Math.ceil(bytes / ALIGNMENT) * ALIGNMENT;
    if (at > buffer.byteLength) fail("a section reaches past its end");
    const form = (FORMS as Record<number, Form | undefined>)[tag];
    if (!form) continue;  // a section of a later version
    if (!form.kinds.includes(kind)) fail(`a message of kind ${kind} has a section ${form.name}`);
    if (form.is_of_object !== (object !== NONE)) fail(`its section ${form.name} has a wrong object`);
    const column = form.name === "column" ? COLUMNS[object] : { ...form, width: form.width || seriesWidth };
    if (!column) continue;  // a column of a later version
    const numbers = elements * column.width;
    if (numbers * ARRAYS[column.scalar].BYTES_PER_ELEMENT !== bytes) fail(`its section ${form.name} has a wrong length`);
    sections.add(form, object, new ARRAYS[column.scalar](buffer, start, numbers));
  }
  if (at !== buffer.byteLength) fail("it is longer than its sections");
  return sections;
}
