/** Contacts of a frame: single ones that can be selected, and all that two objects have in common. */
import type { Model } from "./model";
import type { ListName, Rows } from "./protocol/lists";
import type { FrameMessage, SceneText } from "./protocol/messages";
import { ANSWERS, eachPlace, findKey, hasColumn, keyLength, numberAt, objectAt, rowOfKey, SIDES, sidesAt, type ContactSide } from "./records";

type ContactData = Pick<FrameMessage, "lists">;

/**
 * Identifies a contact by what touches, so that it stays selected from frame to frame. Triangles: object and
 * triangle of both sides. Elements: object and two numbers of both sides, and the kind.
 */
export type ContactKey = readonly number[];

const SELECTABLE = ["contacts", "continuous_contacts"] as const;

export const hasImpacts = ({ lists }: ContactData): boolean => lists.continuous_contacts.count > 0;

/** The rows that can be selected: elements that collide during the step, or else triangles that intersect. */
export const selectableIn = ({ lists }: ContactData): Rows => lists[SELECTABLE[hasImpacts({ lists }) ? 1 : 0]];

/** The row of a contact among those that can be selected, or −1. */
export const findContact = (frame: ContactData, key: ContactKey): number => findKey(selectableIn(frame), key);

export const sidesOf = (key: ContactKey): [ContactSide, ContactSide] => sidesAt(rowOfKey(SELECTABLE.find((list) => keyLength(list) === key.length)!, key), 0)!;

/** The points of a row. */
export function pointsOf({ lists }: ContactData, objects: Model["objects"], rows: Rows, place: number): number[][] {
  const points: number[][] = [];
  eachPlace(rows, place, lists, objects, (data, at) => points.push([data[at]!, data[at + 1]!, data[at + 2]!]));
  return points;
}

/** The middle of some points; null when there are none. */
export const middleOf = (points: number[][]): number[] | null =>
  points.length === 0 ? null : [0, 1, 2].map((axis) => points.reduce((sum, point) => sum + point[axis]!, 0) / points.length);

/** The distance of a row as a part of the margins of both objects. */
export function shareOfMargins({ objects }: SceneText, rows: Rows, place: number): number {
  const reach = SIDES.reduce((sum, side) => sum + objects[objectAt(rows, side, place)]!.margin, 0);
  return reach > 0 ? (numberAt(rows, "distance", place) ?? 0) / reach : 0;
}

/** Rows of a list that belong to a pair. */
export interface Run {
  list: ListName;
  first: number;
  count: number;
}

/** All that two objects, or one object with itself, have in common in a frame. */
export interface TouchingPair {
  a: number;
  b: number;
  runs: Run[];
  count: number;
  /** The smallest distance of near rows. */
  gap: number | null;
  /** The largest depth of vertices and curves. */
  depth: number | null;
  /** The earliest impact, as a part of the step. */
  time: number | null;
}

/** Rows with a time are hits, and rows with a distance are near; all others touch. */
export const isTouching = ({ runs }: TouchingPair): boolean => runs.some(({ list }) => !hasColumn(list, "toi") && !hasColumn(list, "distance"));
export const isHit = ({ runs }: TouchingPair): boolean => runs.some(({ list }) => hasColumn(list, "toi"));

const found = new WeakMap<ContactData, TouchingPair[]>();

/** The pairs of objects that touch, collide or are near in a frame, in the order of their objects. */
export function pairsOf(frame: ContactData): TouchingPair[] {
  let pairs = found.get(frame);
  if (!pairs) found.set(frame, (pairs = findPairs(frame)));
  return pairs;
}

function findPairs({ lists }: ContactData): TouchingPair[] {
  const pairs = new Map<string, TouchingPair>();
  const pairAt = (rows: Rows, place: number, makes: boolean): TouchingPair | undefined => {
    const [a, b] = [objectAt(rows, "a", place), objectAt(rows, "b", place)].sort((one, other) => one - other) as [number, number];
    const key = `${a} ${b}`;
    if (!pairs.has(key) && makes) pairs.set(key, { a, b, runs: [], count: 0, gap: null, depth: null, time: null });
    return pairs.get(key);
  };
  const deepen = (pair: TouchingPair, depth: number | undefined) => depth !== undefined && (pair.depth = Math.max(pair.depth ?? 0, depth));
  // Rows of a kind are sorted by their objects, so those of a pair follow one another.
  for (const rows of ANSWERS.map((list): Rows => lists[list])) {
    let pair: TouchingPair | undefined;
    for (let place = 0; place < rows.count; ++place) {
      if (place === 0 || SIDES.some((side) => objectAt(rows, side, place) !== objectAt(rows, side, place - 1))) {
        pair = pairAt(rows, place, true)!;
        pair.runs.push({ list: rows.list, first: place, count: 0 });
      }
      pair!.runs.at(-1)!.count += 1;
      pair!.count += 1;
      const [gap, time] = [numberAt(rows, "distance", place), numberAt(rows, "toi", place)];
      if (gap !== undefined) pair!.gap = Math.min(pair!.gap ?? Infinity, gap);
      if (time !== undefined) pair!.time = Math.min(pair!.time ?? 1, time);
      deepen(pair!, numberAt(rows, "depth", place));
    }
  }
  for (let place = 0; place < lists.curves.count; ++place) {
    const pair = pairAt(lists.curves, place, false);
    if (pair) deepen(pair, numberAt(lists.curves, "depth", place));
  }
  return [...pairs.values()].sort((one, other) => one.a - other.a || one.b - other.b);
}

/** Pairs of the newest step that were not there in the step before that the page received. */
export class Beginnings {
  private step = "";
  private before = new Set<string>();
  private now = new Set<string>();

  /** Whether each pair began. A frame of the same step, with other layers, gives the same answer. */
  of(text: { generation: number; step: number }, pairs: TouchingPair[]): (pair: TouchingPair) => boolean {
    const step = `${text.generation} ${text.step}`;
    const key = (pair: TouchingPair) => `${pair.a} ${pair.b} ${isTouching(pair) ? "touching" : isHit(pair) ? "hit" : "near"}`;
    if (step !== this.step) this.before = this.now;
    this.step = step;
    this.now = new Set(pairs.map(key));
    return (pair) => !this.before.has(key(pair));
  }
}
