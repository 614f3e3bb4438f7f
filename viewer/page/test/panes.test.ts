import assert from "node:assert/strict";
import { test } from "node:test";
import { areasOf, LAYOUTS } from "../src/view/panes";

test("panes fill the canvas without overlap", () => {
  for (const [width, height] of [[1000, 600], [390, 700], [1, 1]] as const)
    for (const layout of LAYOUTS) {
      const areas = areasOf(layout, width, height);
      assert.equal(areas.length, layout);
      assert.equal(Math.max(...areas.map(({ left, width }) => left + width)), width);
      assert.equal(Math.max(...areas.map(({ top, height }) => top + height)), height);
      areas.forEach((a, i) => areas.slice(i + 1).forEach((b) =>
        assert.ok(a.left + a.width <= b.left || b.left + b.width <= a.left || a.top + a.height <= b.top || b.top + b.height <= a.top, `${layout} in ${width} × ${height}`)));
    }
});

test("two panes are beside each other where there is room, else one below the other", () => {
  const tops = (width: number, height: number) => areasOf(2, width, height).map(({ top }) => top > 0);
  assert.deepEqual(tops(1000, 600), [false, false]);
  assert.deepEqual(tops(390, 700), [false, true]);
});
