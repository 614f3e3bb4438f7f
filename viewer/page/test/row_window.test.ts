import assert from "node:assert/strict";
import { test } from "node:test";
import { RowScale } from "../src/panels/tables/row_window";

test("few rows are where the scroll bar says", () => {
  const scale = new RowScale(100, 24, 250);
  assert.equal(scale.scrollHeight, 2400);
  assert.deepEqual(scale.inSight(0), { first: 0, shown: 12, top: 0 });
  assert.deepEqual(scale.inSight(250), { first: 10, shown: 12, top: 240 });
  assert.deepEqual(scale.inSight(2150), { first: 89, shown: 11, top: 2136 });
});

test("fewer rows than there is room, and none", () => {
  assert.deepEqual(new RowScale(3, 24, 250).inSight(0), { first: 0, shown: 3, top: 0 });
  assert.deepEqual(new RowScale(0, 24, 250).inSight(0), { first: 0, shown: 0, top: 0 });
  assert.deepEqual(new RowScale(3, 24, 250).inSight(-40).first, 0);  // scrolled beyond the end, as on touch screens
});

test("scrolls as little as is needed", () => {
  const scale = new RowScale(100, 24, 240);
  assert.equal(scale.scrollTo(12, 240), 240);
  assert.equal(scale.scrollTo(3, 240), 72);
  assert.equal(scale.scrollTo(30, 240), 31 * 24 - 240);
});

test("of more rows than fit a scroll bar each can be reached and is whole", () => {
  const count = 10_000_000;
  const scale = new RowScale(count, 24, 250);
  assert.ok(scale.scrollHeight < 10_000_000);
  const end = scale.scrollHeight - 250;
  const last = scale.inSight(end);
  assert.equal(last.first + last.shown, count);
  assert.ok(Math.abs(last.top + 24 * last.shown - scale.scrollHeight) < 1e-3, "the last row ends where the box does");
  for (const row of [0, 1, 1234, 5_000_000, count - 2, count - 1])
    for (const from of [0, 3_000_000, end]) {
      const scrollTop = Math.min(end, Math.max(0, Math.round(scale.scrollTo(row, from))));
      const { first, shown, top } = scale.inSight(scrollTop);
      const place = top - scrollTop + 24 * (row - first);
      assert.ok(row >= first && row < first + shown && place > -1 && place + 24 < 251, `row ${row} is at ${place}, coming from ${from}`);
    }
});
