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

/** Whether one side of a contact is the given object. */
export function involves(frame: ContactData, place: number, object: number): boolean {
  const from = STRIDE * place;
  return hasImpacts(frame)
    ? frame.impacts[from] === object || frame.impacts[from + 3] === object
    : frame.contacts[from] === object || frame.contacts[from + 2] === object;
}

/** The array that has the points of a contact, the first row, and the number of rows. */
export function pointsAt(frame: FrameMessage, place: number): { data: Float32Array; first: number; count: number } {
  if (hasImpacts(frame)) return { data: frame.impactPoints, first: place, count: 1 };
  return { data: frame.contactPoints, first: frame.contacts[STRIDE * place + 6]!, count: frame.contacts[STRIDE * place + 5]! };
}
