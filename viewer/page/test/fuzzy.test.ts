import assert from "node:assert/strict";
import { test } from "node:test";
import { fuzzyScore } from "../src/fuzzy";

const best = (wanted: string, texts: string[]): string => [...texts].sort((a, b) => fuzzyScore(wanted, b) - fuzzyScore(wanted, a))[0]!;

test("all letters must occur in their order", () => {
  assert.equal(fuzzyScore("xz", "Frame all"), 0);
  assert.equal(fuzzyScore("lf", "Frame all"), 0);
  assert.ok(fuzzyScore("fral", "Frame all") > 0);
  assert.ok(fuzzyScore("FRAME ALL", "Frame all") > 0);
});

test("starts of words and whole words win", () => {
  assert.equal(best("fs", ["Offset surfaces", "Frame the selection", "Surfaces"]), "Frame the selection");
  assert.equal(best("frame", ["Save frames as pictures", "Last frame", "Frame all"]), "Frame all");
  assert.equal(best("ball 1", ["Select ball 10", "Select ball 1"]), "Select ball 1");
  assert.equal(best("hide ball", ["Select hidden balls", "Hide ball 2"]), "Hide ball 2");
});
