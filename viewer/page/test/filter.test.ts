import assert from "node:assert/strict";
import { test } from "node:test";
import { readFilter, sortRows, type Column } from "../src/filter";

interface Row {
  name: string;
  gap: number | null;
}

const columns: Column<Row>[] = [
  { key: "name", label: "name", value: ({ name }) => name }, { key: "gap", label: "gap", value: ({ gap }) => gap },
  { key: "kind", value: ({ gap }) => (gap === null ? "touching" : "near") },
];
const rows: Row[] = [{ name: "ball 10", gap: 0.5 }, { name: "Ball 9", gap: null }, { name: "rod", gap: 0.01 }, { name: "ball 2", gap: -2e-3 }];
const read = (text: string) => readFilter(text, columns, ({ key }) => key === "gap");
const names = (text: string): string[] => {
  const filter = read(text);
  assert.ok("accepts" in filter, "error" in filter ? filter.error : "");
  return rows.filter((row) => filter.accepts(row)).map(({ name }) => name);
};
const error = (text: string): string => {
  const filter = read(text);
  assert.ok("error" in filter, `${text} is read`);
  return filter.error;
};

test("words are one phrase of the texts that the table shows", () => {
  assert.deepEqual(names("BALL"), ["ball 10", "Ball 9", "ball 2"]);
  assert.deepEqual(names("  ball   9 "), ["Ball 9"]);
  assert.deepEqual(names("touching"), []);
  assert.deepEqual(names(""), rows.map(({ name }) => name));
});

test("conditions compare numbers, and nothing is neither small nor large", () => {
  assert.deepEqual(names("gap<0.02"), ["rod", "ball 2"]);
  assert.deepEqual(names("gap >= 1e-2"), ["ball 10", "rod"]);
  assert.deepEqual(names("gap!=0.5"), ["rod", "ball 2"]);
  assert.deepEqual(names("gap=-2e-3"), ["ball 2"]);
  assert.deepEqual(names("gap<0.02 gap>0"), ["rod"]);
  assert.deepEqual(names("ball GAP<1"), ["ball 10", "ball 2"]);
});

test("conditions compare texts", () => {
  assert.deepEqual(names("name=rod"), ["rod"]);
  assert.deepEqual(names('name="ball 9"'), ["Ball 9"]);
  assert.deepEqual(names("name!=rod kind:touch"), ["Ball 9"]);
  assert.deepEqual(names("name:o"), ["rod"]);
});

test("what cannot be read is named", () => {
  assert.equal(error("depth<3"), "There is no column “depth”: the columns are name, gap, kind.");
  assert.equal(error("gap<"), "A number is missing after gap<.");
  assert.equal(error("gap>wide"), "gap is a number, as in gap>0.01; “wide” is none.");
  assert.equal(error("name<3"), "name is a text: write name=3, name!=3 or name:3 for a part of it.");
  assert.equal(error("name="), "A word is missing after name=.");
  assert.equal(error("<3"), "There is no column “”: the columns are name, gap, kind.");
});

test("texts ascend, numbers descend, and rows without a value come last", () => {
  const sorted = (column: number, reversed: boolean) => sortRows(rows, columns[column]!, reversed).map(({ name }) => name);
  assert.deepEqual(sorted(0, false), ["ball 2", "Ball 9", "ball 10", "rod"]);
  assert.deepEqual(sorted(0, true), ["rod", "ball 10", "Ball 9", "ball 2"]);
  assert.deepEqual(sorted(1, false), ["ball 10", "rod", "ball 2", "Ball 9"]);
  assert.deepEqual(sorted(1, true), ["ball 2", "rod", "ball 10", "Ball 9"]);
});
