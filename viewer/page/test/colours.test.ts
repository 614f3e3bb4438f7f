import assert from "node:assert/strict";
import { test } from "node:test";
import { GAPS, HALO, MARKS, OBJECT_COLOURS, objectColour } from "../src/colours";

/** Relative luminance and contrast as WCAG 2 defines them. */
function luminance(colour: string): number {
  const [red, green, blue] = [1, 3, 5].map((at) => {
    const share = parseInt(colour.slice(at, at + 2), 16) / 255;
    return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * red! + 0.7152 * green! + 0.0722 * blue!;
}
function contrast(a: string, b: string): number {
  const [dark, light] = [luminance(a), luminance(b)].sort((one, other) => one - other);
  return (light! + 0.05) / (dark! + 0.05);
}

const marks = [...Object.values(MARKS), ...GAPS];

test("the contrast is that of WCAG", () => {
  assert.equal(contrast("#000000", "#ffffff"), 21);
  assert.ok(Math.abs(contrast("#777777", "#ffffff") - 4.478) < 1e-3);
});

test("the nine objects of the first example have colours of their own", () => {
  assert.equal(new Set(Array.from({ length: 9 }, (_, i) => objectColour(i))).size, 9);
});

test("marks are seen on all objects and on their halo", () => {
  for (const mark of marks)
    for (const under of [...OBJECT_COLOURS, HALO]) assert.ok(contrast(mark, under) >= 3, `${mark} on ${under}: ${contrast(mark, under).toFixed(2)}`);
});

test("a mark is seen by its halo on the dark ground, and by its colour on the light one", () => {
  assert.ok(contrast(HALO, "#14171c") >= 3);
  for (const mark of marks) assert.ok(contrast(mark, "#fbfaf7") >= 3);
});
