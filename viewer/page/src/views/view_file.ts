/** Reads view files, and links that contain a view. Errors are sentences for the user. */
import members from "../protocol/view_members_generated.json";
import type { ViewState } from "../view_state";

const LARGEST_FILE = 16_000_000;

type Json = Record<string, unknown>;
const isObject = (value: unknown): value is Json => typeof value === "object" && value !== null && !Array.isArray(value);
const isId = (value: unknown): boolean => Number.isInteger(value) && (value as number) >= 0;

/** A member of view files, as viewer/view_file/view_members.hpp describes it. */
interface ViewMember {
  kind: "number" | "whole" | "truth" | "word" | "colour" | "text" | "key" | "point" | "interval" | "objects";
  /** What a value must be, in words. */
  range: string;
  /** Of numbers, null without a limit; `above` excludes the lowest number. */
  low: number | null;
  high: number | null;
  above: boolean;
  words: string[];
}
const MEMBERS = Object.entries(members).map(([path, member]) => ({ names: path.split("."), member: member as ViewMember }));

function isValid(value: unknown, { kind, low, high, above, words }: ViewMember): boolean {
  const isInRange = () => Number.isFinite(value) && (value as number) >= (low ?? -Infinity) && (value as number) <= (high ?? Infinity) && !(above && value === low);
  switch (kind) {
    case "number": return isInRange();
    case "whole": return Number.isInteger(value) && isInRange();
    case "truth": return typeof value === "boolean";
    case "word": return words.includes(value as string);
    case "colour": return typeof value === "string" && /^#[0-9a-f]{6}$/i.test(value);
    case "text": return typeof value === "string";
    case "key": return value === null || typeof value === "string";
    case "interval": return value === null || (Array.isArray(value) && value.length === 2 && value.every(Number.isFinite) && value[0] < value[1]);
    case "point": return Array.isArray(value) && value.length === 3 && value.every(Number.isFinite);
    case "objects": return value === null || (Array.isArray(value) && value.length === 2 && value.every(isId));
  }
}

/** Checks a value of which `members` are all that have its path so far. Returns the fault, or null. */
function faultOf(value: unknown, members: { names: string[]; member: ViewMember }[], depth: number, path: string): string | null {
  const { names, member } = members[0]!;
  if (names.length === depth) return isValid(value, member) ? null : `${path} is not ${member.range}`;
  if (!isObject(value)) return path === "" ? "it has no members; a view file is an object { … }" : `${path} is not an object { … }`;
  for (const [name, inner] of Object.entries(value)) {
    const place = path === "" ? name : `${path}.${name}`;
    const candidates = members.filter(({ names }) => names[depth] === "*" || names[depth] === name);
    if (candidates.length === 0) return `${place} is unknown`;
    const fault = faultOf(inner, candidates, depth + 1, place);
    if (fault) return fault;
  }
  return null;
}

/** The view in the text of a view file; throws an error with a sentence when it is none. */
export function parseView(text: string): Partial<ViewState> {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch (error) {
    throw new Error(`This is no view file: it is not JSON (${(error as Error).message}).`);
  }
  const fault = faultOf(value, MEMBERS, 0, "");
  if (fault) throw new Error(`The view cannot be used: ${fault}. Nothing is changed.`);
  if (!("version" in (value as Json))) throw new Error("The view cannot be used: version is missing. Nothing is changed.");
  return value as Partial<ViewState>;
}

export async function readViewFile(file: File): Promise<Partial<ViewState>> {
  if (file.size > LARGEST_FILE) throw new Error(`${file.name} is larger than any view file.`);
  return parseView(await file.text());
}

async function through(bytes: Uint8Array<ArrayBuffer>, stream: ReadableWritablePair<Uint8Array<ArrayBuffer>, BufferSource>): Promise<Uint8Array<ArrayBuffer>> {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

/** The part of an address that contains a view: compressed, in the alphabet of addresses. */
export async function hashOfView(view: ViewState): Promise<string> {
  const packed = await through(new TextEncoder().encode(JSON.stringify(view)), new CompressionStream("deflate-raw"));
  const text = btoa(Array.from(packed, (byte) => String.fromCharCode(byte)).join(""));
  return `#view=${text.replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "")}`;
}

/** The view in an address; null when there is none. */
export async function viewOfHash(hash: string): Promise<Partial<ViewState> | null> {
  const packed = /[#&]view=([^&]*)/.exec(hash)?.[1];
  if (packed === undefined) return null;
  let text: string;
  try {
    const bytes = Uint8Array.from(atob(packed.replaceAll("-", "+").replaceAll("_", "/")), (letter) => letter.charCodeAt(0));
    text = new TextDecoder().decode(await through(bytes, new DecompressionStream("deflate-raw")));
  } catch {
    throw new Error("The link is damaged: its view cannot be read. Copy the whole link.");
  }
  return parseView(text);
}
