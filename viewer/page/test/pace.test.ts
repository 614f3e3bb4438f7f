import assert from "node:assert/strict";
import { test } from "node:test";
import { Pace } from "../src/pace";

test("few frames that come at once do not say that time flies", () => {
  const pace = new Pace();
  pace.add(0, 1);
  pace.add(10, 1.1);
  assert.deepEqual(pace.at(200), { rate: 2, factor: null });
  pace.add(1200, 1.2);
  pace.add(1210, 1.21);
  assert.deepEqual(pace.at(1300), { rate: 2, factor: (1000 * (1.21 - 1.1)) / 1200 });
  assert.deepEqual(pace.at(5000), { rate: 0, factor: null });
});

test("a restart begins again", () => {
  const pace = new Pace();
  pace.add(0, 5);
  pace.add(500, 0);
  assert.deepEqual(pace.at(600), { rate: 1, factor: null });
  pace.add(900, 0.4);
  assert.deepEqual(pace.at(1000), { rate: 2, factor: 1 });
});
