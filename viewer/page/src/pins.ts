/** Pins: objects, pairs and contacts that the user follows. The session measures them in each step. */
import type { ContactKey } from "./contacts";
import { Emitter } from "./emitter";
import type { Model } from "./model";

/** As a view keeps it: objects by name, and the numbers of a contact with spaces. */
export interface StoredPin {
  a?: string;
  b?: string;
  contact?: string;
}

/** Rows of numbers by ascending steps. */
export class PinSeries {
  steps: number[] = [];
  times: number[] = [];
  columns: number[][];

  constructor(width: number) {
    this.columns = Array.from({ length: width }, () => []);
  }

  /** Adds a row, or replaces that of its step; where it has no number, `keeps` leaves the number that was there. */
  add(row: ArrayLike<number>, keeps = false): void {
    const step = row[0]!;
    let at = this.steps.length;
    while (at > 0 && this.steps[at - 1]! >= step) at -= 1;
    const isNew = this.steps[at] !== step;
    const put = (list: number[], value: number) => list.splice(at, isNew ? 0 : 1, keeps && !isNew && Number.isNaN(value) ? list[at]! : value);
    put(this.steps, step);
    put(this.times, row[1]!);
    this.columns.forEach((column, i) => put(column, row[2 + i]!));
  }

  /** Drops the oldest rows when there are more than `most`. */
  limit(most: number): void {
    if (this.steps.length <= most) return;
    const surplus = Math.ceil(most / 4);  // many at once, so that the cost per step is small
    for (const list of [this.steps, this.times, ...this.columns]) list.splice(0, surplus);
  }

  /** The value in the row of a step, or NaN. */
  at(column: number, step: number): number {
    const steps = this.steps;
    let [low, high] = [0, steps.length - 1];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (steps[middle]! < step) low = middle + 1;
      else high = middle;
    }
    return steps[low] === step ? this.columns[column]![low]! : NaN;
  }

  csv(names: string[]): string {
    const text = (value: number) => (Number.isNaN(value) ? "" : String(value));
    const rows = this.steps.map((step, i) => [step, this.times[i]!, ...this.columns.map((column) => column[i]!)].map(text).join(","));
    return [["step", "time", ...names].join(","), ...rows, ""].join("\n");
  }
}

export interface Pin {
  /** Never used again for another pin. */
  number: number;
  objects: number[];
  names: string[];
  contact: ContactKey | null;
  series: PinSeries;
}

interface PinEvents {
  /** Pins were added or removed. */
  list: Pin | null;
  /** There are new rows. */
  rows: null;
}

/** Limits of the session, and of the rows that the page keeps of a simulation. */
export const MOST_PINS = 32;
const MOST_ROWS = 4000;

const sameKey = (a: ContactKey | null, b: ContactKey | null): boolean => (a === null || b === null ? a === b : a.join() === b.join());

export function titleOf({ names, objects, contact }: Pin): string {
  const element = (at: number, count: number) => (contact!.length === 4 ? contact![at + 1] : [...new Set(contact!.slice(at + 1, at + 1 + count))].join("–"));
  if (!contact) return objects.length === 1 ? names[0]! : objects[0] === objects[1] ? `${names[0]} and itself` : names.join(" and ");
  return contact.length === 4 ? `${names[0]} ${element(0, 1)} and ${names[1]} ${element(2, 1)}` : `${names[0]} ${element(0, 2)} and ${names[1]} ${element(3, 2)}`;
}

export class Pins extends Emitter<PinEvents> {
  list: Pin[] = [];
  /** The rows of a simulation that are kept. */
  mostRows = MOST_ROWS;
  private next = 1;
  private run = "";
  /** No frame has come since the options of the session may have changed. */
  private isFresh = true;

  constructor(private readonly model: Model, private readonly send: (command: Record<string, unknown>) => void, private readonly say: (text: string) => void) {
    super();
    model.on("scene", () => this.takeScene());
    model.on("frame", ({ pinRows }) => this.take(pinRows));
  }

  /** Names of the values, from the session. */
  get names(): string[] {
    return this.model.scene?.pin_values.map(({ key }) => key) ?? [];
  }

  find(objects: number[], contact: ContactKey | null): Pin | undefined {
    return this.list.find((pin) => pin.objects.join() === objects.join() && sameKey(pin.contact, contact));
  }

  add(objects: number[], contact: ContactKey | null = null): void {
    const before = this.find(objects, contact);
    if (before) return this.emit("list", before);
    if (this.list.length >= MOST_PINS) return this.say(`${MOST_PINS} pins are the most. Remove one first.`);
    const pin = this.make({ objects, contact });
    this.list.push(pin);
    this.tell();
    this.emit("list", pin);
  }

  remove(pin: Pin): void {
    this.list = this.list.filter((other) => other !== pin);
    this.tell();
    this.emit("list", null);
  }

  /** The pin of the selected contact or object. */
  get ofSelection(): Pin | undefined {
    const { selection, contact } = this.model;
    return selection ? this.find(this.selected, contact) : undefined;
  }

  private get selected(): number[] {
    const { selection, contact } = this.model;
    return contact ? [contact[0]!, contact[contact.length === 4 ? 2 : 3]!] : [selection!.object];
  }

  /** Pins or unpins the selected contact or object. */
  toggleSelection(): void {
    if (!this.model.selection) return this.say("Select an object or a contact to pin it.");
    const before = this.ofSelection;
    if (before) this.remove(before);
    else this.add(this.selected, this.model.contact);
  }

  get stored(): Record<string, StoredPin> {
    return Object.fromEntries(this.list.map(({ names: [a, b], contact }, i) =>
      [i + 1, { a: a!, ...(b !== undefined && { b }), ...(contact && { contact: contact.join(" ") }) }]));
  }

  /** Replaces the pins by those of a view whose objects exist. */
  restore(stored: Record<string, StoredPin>): void {
    this.list = [];
    for (const { a, b, contact } of Object.values(stored)) {
      const found = [a, b].filter((name) => name !== undefined).map((name) => this.model.objects.findIndex((object) => object.name === name));
      const key = contact === undefined ? null : contact.split(" ").map(Number);
      const isKey = key === null || (found.length === 2 && [4, 7].includes(key.length) && key.every((x) => Number.isInteger(x) && x >= 0));
      if (found.length === 0 || found.includes(-1) || !isKey || this.list.length >= MOST_PINS) continue;
      const placed = key && key.map((x, i) => (i === 0 ? found[0]! : i === (key.length === 4 ? 2 : 3) ? found[1]! : x));
      if (!this.find(found, placed)) this.list.push(this.make({ objects: found, contact: placed }));
    }
    this.tell();
    this.emit("list", null);
  }

  private make({ objects, contact }: Pick<Pin, "objects" | "contact">): Pin {
    return { number: this.next++, objects, names: objects.map((object) => this.model.objects[object]!.name), contact, series: new PinSeries(this.names.length) };
  }

  private tell(): void {
    this.send({ do: "pins", pins: this.list.map(({ number, objects, contact }) => ({ pin: number, objects, ...(contact && { contact: [...contact] }) })) });
  }

  /** The session has no pins of an earlier scene. A new run has new rows. */
  private takeScene(): void {
    const { title, run } = this.model.scene!;
    this.list = this.list.filter(({ objects, names }) => objects.every((object, i) => this.model.objects[object]?.name === names[i]));
    if (`${run} ${title}` !== this.run) for (const pin of this.list) pin.series = new PinSeries(this.names.length);
    this.run = `${run} ${title}`;
    this.isFresh = true;
    if (this.list.length > 0) this.tell();
    this.emit("list", null);
  }

  /** The way back from the past measures a step again, without the speed; a recording has it in each frame. */
  private take(rows: Map<number, Float64Array>): void {
    const keeps = !this.isFresh && this.model.scene!.frames === null;
    this.isFresh = false;
    if (rows.size === 0) return;
    const width = 2 + this.names.length;
    for (const pin of this.list) {
      const data = rows.get(pin.number);
      for (let i = 0; data && i < data.length; i += width) pin.series.add(data.subarray(i, i + width), keeps);
      if (this.model.scene!.frames === null) pin.series.limit(this.mostRows);
    }
    this.emit("rows", null);
  }
}
