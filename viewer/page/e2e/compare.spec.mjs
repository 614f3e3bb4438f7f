// Two recordings beside each other, and their first difference.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { contactsIn, isAt, pause, picture, runProgram, scenes, settled, until } from "./tools/harness.mjs";

/** In the second recording the first object has another velocity. */
async function open(stage, velocity) {
  const text = readFileSync(join(scenes, "nine.toml"), "utf8");
  for (const [name, value] of [["a", "0.31"], ["b", velocity]]) {
    const scene = stage.file(`${name}.toml`, text.replace("velocity = [0.31,", `velocity = [${value},`));
    await runProgram(stage.supple, ["simulate", scene, "--frames", "40", "--record", stage.file(`${name}.h5`), "--quiet"]);
  }
  const { page } = await stage.view(stage.file("a.h5"), "--compare", stage.file("b.h5"));
  await pause(page);  // it would go on from a frame that is sought
  return page;
}

const panel = (page) => page.getByRole("region", { name: "Comparison" });
const boundsOf = (page, first) => page.evaluate((first) => {
  const count = supple.model.objects.length / 2;
  const xs = supple.model.objects.slice(first ? 0 : count, first ? count : undefined).flatMap(({ positions }) => Array.from(positions).filter((_, i) => i % 3 === 0));
  return [Math.min(...xs), Math.max(...xs)];
}, first);

async function differentRuns(stage) {
  const page = await open(stage, "0.4");
  const { names, objects_of_a: count, frame } = await page.evaluate(() => supple.model.scene.comparison);
  assert.deepEqual([names, count], [["a.h5", "b.h5"], 9]);
  assert.match(await panel(page).getByRole("status").innerText(), new RegExp(`They differ first in frame ${frame}: `));
  await page.getByRole("button", { name: "Go there" }).click();
  await isAt(page, frame);
  await page.getByRole("button", { name: "Last frame" }).click();
  await until(page, () => supple.model.frame.text.step === supple.model.frame.text.range[1]);
  await settled(page);
  const isApart = (await contactsIn(page)).every(([a, , b]) => a < 9 === b < 9);
  assert.ok(isApart, "objects of both are not tested with each other");
  const both = await picture(page);

  await panel(page).getByLabel("Side by side").check();
  await settled(page);
  const [a, b] = [await boundsOf(page, true), await boundsOf(page, false)];
  assert.ok(b[0] > a[1], `A to ${a[1]}, B from ${b[0]}`);
  const contacts = await page.evaluate(() => {
    const { contacts, contact_points } = supple.model.frame.lists;
    const { object_a, first_point, point_count } = contacts.columns;
    const xs = [[], []];
    for (let i = 0; i < contacts.count; ++i) for (let k = 0; k < point_count[i]; ++k) xs[object_a[i] < 9 ? 0 : 1].push(contact_points.columns.position[3 * (first_point[i] + k)]);
    return xs.map((list) => [Math.min(...list), Math.max(...list)]);
  });
  assert.ok(contacts[0][1] < a[1] + 1e-3 && contacts[1][0] > b[0] - 1e-3, `marks stand with their objects: ${JSON.stringify(contacts)}`);
  assert.notEqual(await picture(page), both);
  await page.getByRole("button", { name: "−1 step" }).click();
  await settled(page);
  assert.ok((await boundsOf(page, false))[0] > (await boundsOf(page, true))[1], "the next frame stands beside, too");

  await panel(page).getByLabel("B: b.h5").check();
  await settled(page);
  assert.deepEqual(await page.evaluate(() => supple.model.objects.map(({ visible }) => visible)), Array.from({ length: 18 }, (_, i) => i >= 9));
  await panel(page).getByLabel("Over each other").check();
  await page.getByRole("button", { name: "Last frame" }).click();
  await settled(page);
  assert.ok(await page.evaluate(() => supple.model.objects.every(({ visible }) => visible)));
  const over = await boundsOf(page, false);
  assert.ok(over[0] < a[1], "they lie over each other again");
}

async function equalRuns(stage) {
  const page = await open(stage, "0.31");
  assert.equal(await panel(page).getByRole("status").innerText(), "The two recordings are equal.");
  assert.ok(await page.getByRole("button", { name: "Go there" }).isHidden());
  await page.getByRole("tab", { name: "Plots" }).click();
  await page.getByText("contacts of B").first().waitFor();
}

export const tests = [
  ["two recordings and their first difference", differentRuns],
  ["equal recordings", equalRuns],
];
