// Looking inside: a slice with caps, one object alone, and another point to turn around.
import assert from "node:assert/strict";
import { camera, coloursAt, pause, picture, settled } from "./harness.mjs";

const ball = (name, x, more = "") => `[[object]]\nname = "${name}"\nmodel = "icosphere"\nfrequency = 12\ntranslate = [${x}, 0, 0]\n${more}\n`;
const [CUT, OVERLAP] = [[0x8d, 0x96, 0xa3], [0xc1, 0x12, 0x1f]];
/** Caps have stripes that are darker. */
const isCap = (colour, of) => colour.every((value, i) => value <= of[i] + 3 && value >= 0.6 * of[i] - 3);

async function open(stage, scene) {
  const { page } = await stage.view(stage.file("scene.toml", scene));
  await pause(page);
  await page.getByRole("combobox", { name: "Axis view" }).selectOption("front");
  for (const label of ["Intersecting triangles", "Contact points", "Contact segments"]) await page.getByRole("checkbox", { name: label }).uncheck();
  await settled(page);
  return page;
}

const slice = (page) => page.getByRole("combobox", { name: "Slice" });

/** A cut through solids has caps, red where they overlap; sheets have none. */
async function sliceHasCaps(stage) {
  const sheet = `[[object]]\nname = "sheet"\nmodel = "cloth"\ncolumns = 4\nrows = 4\nwidth = 1\ndepth = 1\ntranslate = [4, 0, 0]\n`;
  const page = await open(stage, `${ball("a", 0)}${ball("b", 1.4)}${sheet}`);
  const center = await page.evaluate(() => supple.model.scene.center);
  const at = (x, y) => [x - center[0], y - center[1], -center[2]];
  const [solid] = await coloursAt(page, [at(-0.5, 0)]);
  assert.ok(!isCap(solid, CUT));
  await slice(page).selectOption("z");
  await settled(page);
  const [left, middle, right] = await coloursAt(page, [at(-0.5, 0), at(0.7, 0), at(1.9, 0)]);
  assert.ok(isCap(left, CUT) && isCap(right, CUT), `the caps are ${left} and ${right}`);
  assert.ok(isCap(middle, OVERLAP), `the overlap is ${middle}`);
  const [beside] = await coloursAt(page, [at(4, 0.2)]);
  assert.ok(!isCap(beside, CUT), `above the sheet is ${beside}`);

  // Behind everything, the slice removes all; from the other side, nothing.
  await page.getByLabel("Position of the slice").fill("0");
  await settled(page);
  const [removed] = await coloursAt(page, [at(-0.5, 0)]);
  assert.ok(!isCap(removed, CUT) && removed.join() !== solid.join(), `what is left is ${removed}`);
  const spot = await page.evaluate((point) => supple.project(point), at(-0.5, 0));
  await page.mouse.click(spot.x, spot.y);
  assert.equal(await page.evaluate(() => supple.model.selection), null, "what is cut away is picked");
  await page.getByRole("button", { name: "flip" }).click();
  await settled(page);
  assert.deepEqual((await coloursAt(page, [at(-0.5, 0)]))[0], solid);
  await page.mouse.click(spot.x, spot.y);
  assert.equal(await page.evaluate(() => supple.model.selection.object), 0);
  await slice(page).selectOption("off");
  assert.equal(await page.getByLabel("Position of the slice").isVisible(), false);
}

async function oneObjectAlone(stage) {
  const page = await open(stage, `${ball("a", 0)}${ball("b", 1.4)}${ball("c", 5)}`);
  const only = page.getByRole("button", { name: "only selected" });
  assert.ok(await only.isDisabled());
  const before = await picture(page);
  await page.getByRole("button", { name: /^b/ }).click();
  await only.click();
  await settled(page);
  const visible = () => page.evaluate(() => supple.model.objects.map(({ visible }) => visible));
  assert.deepEqual(await visible(), [false, true, false]);
  assert.notEqual(await picture(page), before);
  await only.click();
  assert.deepEqual(await visible(), [true, true, true]);
}

/** A double click turns the camera to a point, and from then on around it. */
async function doubleClickSetsThePivot(stage) {
  const page = await open(stage, `${ball("a", 0)}${ball("b", 1.4)}`);
  const center = await page.evaluate(() => supple.model.scene.center);
  const point = await page.evaluate((point) => supple.project(point), [2.1 - center[0], 0.2, 0]);
  const before = await camera(page);
  await page.mouse.dblclick(point.x, point.y);
  await settled(page);
  const after = await camera(page);
  assert.ok(after.target[0] > 1 && after.target[0] < 1.8, `it turns around ${after.target}`);
  const away = ({ position, target }) => position.map((x, axis) => x - target[axis]);
  away(after).forEach((x, axis) => assert.ok(Math.abs(x - away(before)[axis]) < 1e-6, "the camera comes no nearer"));
}

export const tests = [
  ["a slice has caps", sliceHasCaps],
  ["one object alone", oneObjectAlone],
  ["a double click sets the pivot", doubleClickSetsThePivot],
];
