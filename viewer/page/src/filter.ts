/**
 * Filters and sorts the rows of a table by its columns. A filter is words, which must occur in a text of the
 * row, and conditions such as `gap<0.01` or `a=ball`; all of them must hold.
 */
export interface Column<Row> {
  /** Its name in conditions: one word. */
  key: string;
  /** Its name in the header; none when the table only filters by it. */
  label?: string;
  title?: string;
  /** What the row has in this column; null for nothing. */
  value(row: Row): string | number | null;
  /** The header sorts by this number instead. */
  rank?(row: Row): number;
}

/** Whether a row is listed, or why the filter cannot be read. */
export type Filter<Row> = { accepts(row: Row): boolean } | { error: string };

const CONDITION = /(\S*?)\s*(<=|>=|!=|[<>=:])\s*("[^"]*"|[^\s<>=!:]*)/gu;
const NUMBER = /^[-−+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i;

type Test = (value: string | number | null) => boolean;

function testOfNumber(operator: string, text: string, key: string): Test | string {
  if (!NUMBER.test(text)) return text === "" ? `A number is missing after ${key}${operator}` : `${key} is a number, as in ${key}${operator === ":" ? "=" : operator}0.01; “${text}” is none`;
  const limit = Number(text.replace("−", "-"));
  const tests: Record<string, (value: number) => boolean> = {
    "<": (value) => value < limit, "<=": (value) => value <= limit, ">": (value) => value > limit, ">=": (value) => value >= limit,
    "=": (value) => value === limit, "!=": (value) => value !== limit, ":": (value) => value === limit,
  };
  return (value) => typeof value === "number" && tests[operator]!(value);
}

function testOfText(operator: string, text: string, key: string): Test | string {
  if (text === "") return `A word is missing after ${key}${operator}`;
  if ("<>=".includes(operator[0]!) && operator !== "=") return `${key} is a text: write ${key}=${text}, ${key}!=${text} or ${key}:${text} for a part of it`;
  const wanted = text.toLowerCase();
  return (value) => {
    const has = String(value ?? "").toLowerCase();
    return operator === "=" ? has === wanted : operator === "!=" ? has !== wanted : has.includes(wanted);
  };
}

export function readFilter<Row>(text: string, columns: Column<Row>[], isNumber: (column: Column<Row>) => boolean): Filter<Row> {
  const tests: ((row: Row) => boolean)[] = [];
  let error = "";
  const words = text.replace(CONDITION, (_, key: string, operator: string, quoted: string) => {
    const column = columns.find((candidate) => candidate.key === key.toLowerCase());
    const value = quoted.replace(/^"(.*)"$/, "$1");
    const test = column
      ? (isNumber(column) ? testOfNumber : testOfText)(operator, value, column.key)
      : `There is no column “${key}”: the columns are ${columns.map((candidate) => candidate.key).join(", ")}`;
    if (typeof test === "string") error ||= test;
    else tests.push((row) => test(column!.value(row)));
    return " ";
  });
  if (error) return { error: `${error}.` };
  const phrase = words.trim().replace(/\s+/g, " ").replaceAll('"', "").toLowerCase();
  const isText = columns.filter((column) => column.label !== undefined && !isNumber(column));
  if (phrase !== "") tests.push((row) => isText.some((column) => String(column.value(row) ?? "").toLowerCase().includes(phrase)));
  return { accepts: (row) => tests.every((test) => test(row)) };
}

export interface Sorting {
  column: number;
  reversed: boolean;
}

const { compare } = new Intl.Collator(undefined, { numeric: true });

/** Texts ascend and numbers descend, unless reversed. Rows without a value come last. */
export function sortRows<Row>(rows: Row[], { value, rank }: Column<Row>, reversed: boolean): Row[] {
  const of = rank ?? value;
  const sign = reversed ? -1 : 1;
  const known = rows.map((row) => ({ row, value: of(row) }));
  return known.sort((p, q) => {
    if (p.value === null || q.value === null) return Number(p.value === null) - Number(q.value === null);
    return sign * (typeof p.value === "number" ? (q.value as number) - p.value : compare(p.value, q.value as string));
  }).map(({ row }) => row);
}
