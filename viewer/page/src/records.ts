/** What the columns of a row say, by the roles of the columns: no kind of contacts is named here. */
import type { ObjectState } from "./model";
import { columnOf, formOf, LIST_NAMES, type ColumnForm, type ListName, type Lists, type Numbers, type Rows } from "./protocol/lists";
import { ARRAYS } from "./protocol/sections_generated";

export const SIDES = ["a", "b"] as const;
export type Side = (typeof SIDES)[number];
export type ElementKind = "vertex" | "edge" | "face";
const KIND_OF_LETTER: Record<string, ElementKind> = { v: "vertex", e: "edge", f: "face" };

/** The lists with one row for each contact of a kind. */
export const ANSWERS = LIST_NAMES.filter((list) => formOf(list).answers !== "");

interface Roles {
  /** The column with the element of each side. */
  elements: Partial<Record<Side, ColumnForm>>;
  /** The columns by which a row is found again: objects, elements, and the kind where it is a part of the key. */
  key: ColumnForm[];
  positions: ColumnForm[];
  /** Rows of another list, such as points: the columns with the first one and with their number. */
  rows: Map<ListName, { first: string; count: string }>;
}

function rolesIn(list: ListName): Roles {
  const { columns } = formOf(list);
  const ofSide = (side: Side) => columns.find((column) => column.side === side && ["triangle", "vertex", "element"].includes(column.names));
  const elements = { a: ofSide("a"), b: ofSide("b") } as Roles["elements"];
  const first = SIDES.flatMap((side) => columns.filter((column) => column.side === side && (column.names === "object" || column === elements[side])));
  const rows = columns.filter(({ names, rows_of }) => names === "rows" && rows_of !== "").reverse();
  return {
    elements,
    key: [...first, ...columns.filter((column) => column.is_key && !first.includes(column))],
    positions: columns.filter(({ is_position }) => is_position),
    rows: new Map(rows.map(({ name, rows_of }) => [rows_of as ListName, { count: name, first: columns.find((column) => column.names === "first_row" && column.rows_of === rows_of)!.name }])),
  };
}

const ROLES = Object.fromEntries(LIST_NAMES.map((list) => [list, rolesIn(list)])) as Record<ListName, Roles>;

export const hasColumn = (list: ListName, name: string): boolean => columnOf(list, name) !== undefined;
export const numberAt = ({ columns }: Rows, name: string, place: number): number | undefined => columns[name]?.[place];
export const objectAt = ({ columns }: Rows, side: Side, place: number): number => columns[`object_${side}`]![place]!;
/** Of a column with three numbers for each row. */
export const vectorAt = ({ columns }: Rows, name: string, place: number): Numbers => columns[name]!.subarray(3 * place, 3 * place + 3);
/** The word of a column; undefined when the list has no such column. */
export const wordAt = ({ list, columns }: Rows, name: string, place: number): string | undefined => columnOf(list, name)?.words[columns[name]![place]!];

function kindOfElement(rows: Rows, side: Side, place: number): ElementKind {
  const { names } = ROLES[rows.list].elements[side]!;
  if (names !== "element") return names === "vertex" ? "vertex" : "face";
  return (wordAt(rows, `kind_${side}`, place) as ElementKind | undefined) ?? KIND_OF_LETTER[wordAt(rows, "kind", place)![side === "a" ? 0 : 1]!]!;
}

/** Calls `visit` with the elements of one side: an edge has two vertices, other elements repeat their number. */
export function eachElement(rows: Rows, side: Side, visit: (object: number, kind: ElementKind, first: number, second: number) => void): void {
  const column = ROLES[rows.list].elements[side];
  if (!column) return;
  const data = rows.columns[column.name]!;
  for (let place = 0, at = 0; place < rows.count; ++place, at += column.width)
    visit(objectAt(rows, side, place), kindOfElement(rows, side, place), data[at]!, data[at + column.width - 1]!);
}

export interface ContactSide {
  object: number;
  kind: ElementKind;
  /** A face, a vertex, or the two vertices of an edge. */
  elements: number[];
}

/** Both sides of a row; null for records without elements. */
export function sidesAt(rows: Rows, place: number): [ContactSide, ContactSide] | null {
  const { elements } = ROLES[rows.list];
  if (!elements.a || !elements.b) return null;
  const sides = SIDES.map((side) => {
    const { name, width } = elements[side]!;
    const kind = kindOfElement(rows, side, place);
    return { object: objectAt(rows, side, place), kind, elements: Array.from(rows.columns[name]!.subarray(width * place, width * place + (kind === "edge" ? 2 : 1))) };
  });
  return sides as [ContactSide, ContactSide];
}

/** The kinds of both elements, or the word for what a row is. */
export function kindAt(rows: Rows, place: number): string {
  const hasElements = ROLES[rows.list].elements.a?.names === "element";
  return hasElements ? SIDES.map((side) => kindOfElement(rows, side, place)).join("–") : (wordAt(rows, "kind", place) ?? formOf(rows.list).item);
}

export const keyAt = (rows: Rows, place: number): number[] => ROLES[rows.list].key.flatMap(({ name, width }) => Array.from(rows.columns[name]!.subarray(width * place, width * place + width)));

/** A row that consists of its key alone. */
export function rowOfKey(list: ListName, key: readonly number[]): Rows {
  let at = 0;
  const columns = Object.fromEntries(ROLES[list].key.map(({ name, width, scalar }) => [name, new ARRAYS[scalar](key.slice(at, (at += width)))]));
  return { list, count: 1, columns };
}

export const keyLength = (list: ListName): number => ROLES[list].key.reduce((sum, { width }) => sum + width, 0);

/** The row with a key, or −1. */
export function findKey(rows: Rows, key: readonly number[]): number {
  if (key.length !== keyLength(rows.list)) return -1;
  const parts = ROLES[rows.list].key.flatMap(({ name, width }) => Array.from({ length: width }, (_, i) => ({ data: rows.columns[name]!, width, i })));
  for (let place = 0; place < rows.count; ++place) {
    let same = 0;
    while (same < parts.length && parts[same]!.data[parts[same]!.width * place + parts[same]!.i] === key[same]) same += 1;
    if (same === parts.length) return place;
  }
  return -1;
}

/** The rows of another list that a row names, as far as the frame has them. */
export function rowsIn(rows: Rows, place: number, list: ListName, lists: Lists): { first: number; end: number } {
  const names = ROLES[rows.list].rows.get(list)!;
  const first = rows.columns[names.first]![place]!;
  return { first, end: Math.min(lists[list].count, first + rows.columns[names.count]![place]!) };
}

/** Calls `visit` with the array and the offset of each point of a row: its own, and those in lists of points. */
export function eachPoint(rows: Rows, place: number, lists: Lists, visit: (data: Numbers, at: number) => void): void {
  for (const { name } of ROLES[rows.list].positions) visit(rows.columns[name]!, 3 * place);
  for (const list of [...ROLES[rows.list].rows.keys()].filter((list) => !hasColumn(list, "object_a")))
    for (const { name } of ROLES[list].positions) {
      const { first, end } = rowsIn(rows, place, list, lists);
      for (let at = first; at < end; ++at) visit(lists[list].columns[name]!, 3 * at);
    }
}

/** Where a row is: the vertex that it names, then its own points, or else those in another list. */
export function eachPlace(rows: Rows, place: number, lists: Lists, objects: Pick<ObjectState, "positions">[], visit: (data: ArrayLike<number>, at: number) => void): void {
  const { elements: { a }, positions } = ROLES[rows.list];
  if (a?.names === "vertex") visit(objects[objectAt(rows, "a", place)]!.positions, 3 * rows.columns[a.name]![place]!);
  if (positions.length === 0) return eachPoint(rows, place, lists, visit);
  for (const { name } of positions) visit(rows.columns[name]!, 3 * place);
}
