/** Contacts of both kinds: triangles that intersect, or elements that collide during the step. */
import type { FrameMessage, Kinds } from "./protocol/messages";

type ContactData = Pick<FrameMessage, "contacts" | "impacts">;

/**
 * Identifies a contact by what touches, so that it stays selected from frame to frame. Triangles: object and
 * triangle of both sides. Elements: object and two numbers of both sides, and the kind.
 */
export type ContactKey = readonly number[];

export interface ContactSide {
  object: number;
  /** A triangle, a vertex, or the two vertices of an edge. */
  elements: number[];
  isFace: boolean;
}

const STRIDE = 8;

export const hasImpacts = (frame: ContactData): boolean => frame.impacts.length > 0;

export function contactCount(frame: ContactData): number {
  return (hasImpacts(frame) ? frame.impacts : frame.contacts).length / STRIDE;
}

export function keyAt(frame: ContactData, place: number): ContactKey {
  const from = STRIDE * place;
  return Array.from(hasImpacts(frame) ? frame.impacts.subarray(from, from + 7) : frame.contacts.subarray(from, from + 4));
}

/** The index of a contact in a frame, or −1. */
export function findContact(frame: ContactData, key: ContactKey): number {
  const data = hasImpacts(frame) ? frame.impacts : frame.contacts;
  if (key.length !== (hasImpacts(frame) ? 7 : 4)) return -1;
  for (let i = 0; i < data.length; i += STRIDE) {
    let same = 0;
    while (same < key.length && data[i + same] === key[same]) same += 1;
    if (same === key.length) return i / STRIDE;
  }
  return -1;
}

export function sidesOf(key: ContactKey, kinds: Kinds): [ContactSide, ContactSide] {
  if (key.length === 4)
    return [{ object: key[0]!, elements: [key[1]!], isFace: true }, { object: key[2]!, elements: [key[3]!], isFace: true }];
  const [a, b] = kinds.impact[key[6]!]!;
  const side = (at: number, kind: string): ContactSide =>
    ({ object: key[at]!, elements: kind === "edge" ? [key[at + 1]!, key[at + 2]!] : [key[at + 1]!], isFace: kind === "face" });
  return [side(0, a), side(3, b)];
}

export function kindAt(frame: ContactData, place: number, kinds: Kinds): string {
  return hasImpacts(frame) ? kinds.impact[frame.impacts[STRIDE * place + 6]!]!.join("–") : kinds.contact[frame.contacts[STRIDE * place + 4]!]!;
}

/** The array that has the points of a contact, the first row, and the number of rows. */
export function pointsAt(frame: FrameMessage, place: number): { data: Float32Array; first: number; count: number } {
  if (hasImpacts(frame)) return { data: frame.impactPoints, first: place, count: 1 };
  return { data: frame.contactPoints, first: frame.contacts[STRIDE * place + 6]!, count: frame.contacts[STRIDE * place + 5]! };
}

/** Rows of one kind that belong to a pair: contacts, impacts, proximity pairs, or vertices inside the other object. */
export interface Run {
  kind: "contacts" | "impacts" | "proximity" | "penetrations";
  first: number;
  count: number;
}

/** All that two objects, or one object with itself, have in common in a frame. */
export interface TouchingPair {
  a: number;
  b: number;
  runs: Run[];
  count: number;
  /** The smallest distance of proximity pairs. */
  gap: number | null;
  /** The largest depth of vertices and curves. */
  depth: number | null;
  /** The earliest impact, as a part of the step. */
  time: number | null;
}

export const isTouching = ({ runs }: TouchingPair): boolean => runs.some(({ kind }) => kind === "contacts" || kind === "penetrations");
export const isHit = ({ runs }: TouchingPair): boolean => runs.some(({ kind }) => kind === "impacts");

type PairData = Pick<FrameMessage, "contacts" | "impacts" | "impactPoints" | "proximityPairs" | "proximityPoints" | "penetrations" | "penetrationPoints" | "curves" | "curvePoints">;

const found = new WeakMap<PairData, TouchingPair[]>();

/** The pairs of objects that touch, collide or are near in a frame, in the order of their objects. */
export function pairsOf(frame: PairData): TouchingPair[] {
  let pairs = found.get(frame);
  if (!pairs) found.set(frame, (pairs = findPairs(frame)));
  return pairs;
}

function findPairs(frame: PairData): TouchingPair[] {
  const pairs = new Map<string, TouchingPair>();
  const pairAt = (one: number, other: number): TouchingPair => {
    const [a, b] = one < other ? [one, other] : [other, one];
    const key = `${a} ${b}`;
    let pair = pairs.get(key);
    if (!pair) pairs.set(key, (pair = { a, b, runs: [], count: 0, gap: null, depth: null, time: null }));
    return pair;
  };
  // Rows of a kind are sorted by their objects, so those of a pair follow one another.
  const addRuns = (kind: Run["kind"], data: Uint32Array, stride: number, second: number, measure: (pair: TouchingPair, place: number) => void) => {
    let pair: TouchingPair | null = null;
    for (let place = 0, i = 0; i < data.length; ++place, i += stride) {
      const isNext = place === 0 || data[i] !== data[i - stride] || data[i + second] !== data[i - stride + second];
      if (isNext) {
        pair = pairAt(data[i]!, data[i + second]!);
        pair.runs.push({ kind, first: place, count: 0 });
      }
      pair!.runs[pair!.runs.length - 1]!.count += 1;
      pair!.count += 1;
      measure(pair!, place);
    }
  };
  const deepen = (pair: TouchingPair, depth: number) => (pair.depth = Math.max(pair.depth ?? 0, depth));
  addRuns("contacts", frame.contacts, STRIDE, 2, () => {});
  addRuns("impacts", frame.impacts, STRIDE, 3, (pair, i) => (pair.time = Math.min(pair.time ?? 1, frame.impactPoints[8 * i + 3]!)));
  addRuns("proximity", frame.proximityPairs, 2, 1, (pair, i) => (pair.gap = Math.min(pair.gap ?? Infinity, frame.proximityPoints[8 * i + 3]!)));
  addRuns("penetrations", frame.penetrations, 4, 2, (pair, i) => deepen(pair, frame.penetrationPoints[8 * i + 3]!));
  for (let i = 0; i < frame.curves.length; i += 8) {
    const pair = pairs.get([frame.curves[i]!, frame.curves[i + 1]!].sort((one, other) => one - other).join(" "));
    if (pair) deepen(pair, frame.curvePoints[i + 3]!);
  }
  return [...pairs.values()].sort((one, other) => one.a - other.a || one.b - other.b);
}

/** The middle of the points of a single contact; null when it has no points. */
export function pointOf(frame: FrameMessage, kind: Run["kind"], place: number): number[] | null {
  const mean = (data: Float32Array, starts: number[]) => [0, 1, 2].map((axis) => starts.reduce((sum, from) => sum + data[from + axis]!, 0) / starts.length);
  if (kind === "proximity") return mean(frame.proximityPoints, [8 * place, 8 * place + 4]);
  if (kind === "penetrations") return mean(frame.penetrationPoints, [8 * place]);
  if (kind === "impacts") return mean(frame.impactPoints, [8 * place]);
  const [count, first] = [frame.contacts[STRIDE * place + 5]!, frame.contacts[STRIDE * place + 6]!];
  return count > 0 ? mean(frame.contactPoints, Array.from({ length: count }, (_, k) => 8 * (first + k))) : null;
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
