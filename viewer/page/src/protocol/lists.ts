/** The lists of a result in a frame: the columns of their rows, by name. `make docs` writes their forms. */
import forms from "./lists_generated.json";
import { ARRAYS, type Scalar } from "./sections_generated";

export interface ColumnForm {
  name: string;
  scalar: Scalar;
  width: number;
  names: "" | "object" | "triangle" | "vertex" | "element" | "rows" | "first_row";
  /** Of the object that has what it names. */
  side: "" | "a" | "b";
  /** The list of which it names rows. */
  rows_of: string;
  is_key: boolean;
  is_position: boolean;
  unit: string;
  words: string[];
}
interface ListForm {
  /** A row in words. */
  item: string;
  /** The kind of contacts that its rows are; empty for other lists. */
  answers: string;
  columns: ColumnForm[];
}

export type ListName = keyof typeof forms;
export const LIST_NAMES = Object.keys(forms) as ListName[];
export const formOf = (list: ListName): ListForm => (forms as Record<ListName, unknown>)[list] as ListForm;
const BY_NAME = new Map(LIST_NAMES.map((list) => [list, new Map(formOf(list).columns.map((column) => [column.name, column]))]));
/** Undefined when the list has no such column. */
export const columnOf = (list: ListName, name: string): ColumnForm | undefined => BY_NAME.get(list)!.get(name);
/** All columns, in the order of the numbers of their sections. */
export const COLUMNS = LIST_NAMES.flatMap((list) => formOf(list).columns);

export type Numbers = Uint8Array | Uint32Array | Float32Array | Float64Array;

/** A column has `width` numbers for each row. */
export interface Rows {
  list: ListName;
  count: number;
  columns: Record<string, Numbers>;
}
export type Lists = Record<ListName, Rows>;

/** The rows of a list, from columns by their numbers. Null when these have different lengths. */
export function rowsOf(list: ListName, sent: (number: number) => Numbers | undefined): Rows | null {
  const columns = formOf(list).columns.map((form) => ({ ...form, data: sent(COLUMNS.indexOf(form)) ?? new ARRAYS[form.scalar](0) }));
  const count = columns[0]!.data.length / columns[0]!.width;
  if (columns.some(({ data, width }) => data.length !== width * count)) return null;
  return { list, count, columns: Object.fromEntries(columns.map(({ name, data }) => [name, data])) };
}
