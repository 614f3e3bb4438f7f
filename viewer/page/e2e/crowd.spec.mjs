// Thousands of objects: few draw calls, few list rows; each object can be found, shown, hidden, coloured and
// picked.
import assert from "node:assert/strict";
import { picture, settled, until } from "./tools/harness.mjs";

const [COLUMNS, ROWS] = [60, 40];

/** Balls in a wall, apart and at rest; seen from the front, none hides another. */
const WALL = `
[[object]]
name = "ball"
model = "icosphere"
frequency = 1
scale = 0.45
repeat = [${COLUMNS}, ${ROWS}, 1]
spacing = [1.2, 1.2, 0]
`;

async function open(stage) {
  const { page } = await stage.view(stage.file("wall.toml", WALL));
  await page.getByRole("combobox", { name: "Axis view" }).selectOption("front");
  await page.getByRole("button", { name: "Frame all" }).click();
  await settled(page);
  assert.equal(await page.evaluate(() => supple.model.objects.length), COLUMNS * ROWS);
  return page;
}

/** The position of the middle of an object in the window, and the colour there: red, green, blue. */
const look = (page, object) =>
  page.evaluate((object) => {
    supple.draw();  // the canvas keeps its content only until the end of this task
    const view = document.querySelector("canvas.view");
    const copy = Object.assign(document.createElement("canvas"), { width: view.width, height: view.height });
    const context = copy.getContext("2d");
    context.drawImage(view, 0, 0);
    const { positions, vertices } = supple.model.objects[object];
    const middle = [0, 1, 2].map((axis) => positions.reduce((sum, x, i) => sum + (i % 3 === axis ? x : 0), 0) / vertices);
    const { x, y } = supple.project(middle);
    const box = view.getBoundingClientRect();
    const scale = view.width / box.width;
    return { x, y, colour: [...context.getImageData(Math.round((x - box.left) * scale), Math.round((y - box.top) * scale), 1, 1).data].slice(0, 3) };
  }, object);

const colourOf = async (page, object) => (await look(page, object)).colour;
const ground = (page) => page.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/\d+/g).slice(0, 3).map(Number));
const isNear = (a, b) => a.every((value, i) => Math.abs(value - b[i]) <= 3);
const list = (page) => page.getByRole("list", { name: "Objects" });

/** Whether the row of an object is visible and marked as selected. */
const isShownAsSelected = async (page, name) => {
  await list(page).waitFor();
  await until(page, (name) => {
    const row = [...document.querySelectorAll(".objects li:not([hidden])")].find((row) => row.querySelector(".text").textContent === name);
    if (!row?.classList.contains("selected")) return false;
    const [at, box] = [row.getBoundingClientRect(), document.querySelector(".objects").getBoundingClientRect()];
    return at.top >= box.top - 1 && at.bottom <= box.bottom + 1;
  }, name);
};

async function costsLittle(stage) {
  const page = await open(stage);
  const drawn = () =>
    page.evaluate(() => {
      supple.draw();
      return supple.drawn();
    });
  const { calls, triangles } = await drawn();
  assert.ok(calls >= 1 && calls <= 15, `${calls} draw calls`);
  const world = 16;  // the floor, the shadow and the box of the border
  assert.ok(triangles >= COLUMNS * ROWS * 20 && triangles <= COLUMNS * ROWS * 20 + world, `${triangles} triangles`);
  const rows = await list(page).getByRole("listitem").count();
  assert.ok(rows > 3 && rows < 100, `${rows} rows have elements`);
  assert.equal(await list(page).getByRole("listitem").first().getAttribute("aria-posinset"), "1");
  assert.equal(await list(page).getByRole("listitem").first().getAttribute("aria-setsize"), String(COLUMNS * ROWS));
  const elements = await page.evaluate(() => document.querySelectorAll("*").length);
  assert.ok(elements < 1500, `the page has ${elements} elements`);
  await page.getByRole("checkbox", { name: "Wireframe" }).check();
  await page.evaluate(() => {
    for (const object of supple.model.objects) if (object.index % 2) object.opacity = 0.5;
    supple.model.emit("display", null);
  });
  const most = (await drawn()).calls;
  assert.ok(most > calls && most <= 15, `${most} draw calls of opaque and transparent surfaces with their wireframe`);
}

async function isHiddenAfterScrolling(stage) {
  const page = await open(stage);
  const wanted = 1500;
  const name = await page.evaluate((i) => supple.model.objects[i].name, wanted);
  const seen = await picture(page);
  assert.ok(!isNear(await colourOf(page, wanted), await ground(page)));
  assert.equal(await page.getByRole("checkbox", { name: `Show ${name}`, exact: true }).count(), 0);
  await page.locator(".objects").evaluate((box, part) => box.scrollTo(0, part * box.scrollHeight), wanted / (COLUMNS * ROWS));
  const box = page.getByRole("checkbox", { name: `Show ${name}`, exact: true });
  await box.uncheck();
  await settled(page);
  assert.ok(isNear(await colourOf(page, wanted), await ground(page)), "it is still seen");
  for (const other of [wanted - 1, wanted + 1, wanted + COLUMNS]) assert.ok(!isNear(await colourOf(page, other), await ground(page)), `${other} is gone too`);
  assert.notEqual(await picture(page), seen);
  await page.locator(".objects").evaluate((box) => box.scrollTo(0, 0));
  await list(page).locator('[aria-posinset="1"]').waitFor();
  await page.locator(".objects").evaluate((box, part) => box.scrollTo(0, part * box.scrollHeight), wanted / (COLUMNS * ROWS));
  assert.equal(await box.isChecked(), false, "the row has forgotten it");
  await box.check();
  await settled(page);
  assert.equal(await picture(page), seen);
}

async function isFoundByName(stage) {
  const page = await open(stage);
  const wanted = await page.evaluate(() => supple.model.objects.findIndex(({ name }) => name === "ball 1234"));
  await page.getByRole("searchbox", { name: "Filter objects" }).fill("BALL 1234");
  assert.equal(await list(page).getByRole("listitem").count(), 1);
  const seen = await picture(page);
  await page.getByRole("checkbox", { name: "Show ball 1234" }).uncheck();
  await settled(page);
  assert.ok(isNear(await colourOf(page, wanted), await ground(page)));
  await page.getByRole("button", { name: "all", exact: true }).click();
  await settled(page);
  assert.equal(await picture(page), seen);
  await page.getByRole("searchbox", { name: "Filter objects" }).fill("ball 12");
  await page.getByRole("button", { name: "all", exact: true }).click();
  const hidden = await page.evaluate(() => supple.model.objects.filter(({ visible }) => !visible).map(({ name }) => name));
  assert.equal(hidden.length, 1 + 10 + 100);  // ball 12, 120 …, 1200 …
  assert.ok(hidden.every((name) => name.startsWith("ball 12")));
  await page.getByRole("searchbox", { name: "Filter objects" }).fill("no such");
  await page.getByText("No object is like “no such”.").waitFor();
  assert.equal(await list(page).getByRole("listitem").count(), 0);
}

async function isColouredAndMadeTransparent(stage) {
  const page = await open(stage);
  const [one, other] = await page.evaluate(() => [700, 701].map((i) => supple.model.objects.findIndex(({ name }) => name === `ball ${i}`)));
  const before = await colourOf(page, other);
  await page.getByRole("searchbox", { name: "Filter objects" }).fill("ball 700");
  await page.getByLabel("Colour of ball 700").fill("#ff0000");
  await settled(page);
  const [red, green, blue] = await colourOf(page, one);
  assert.ok(red > 180 && green < 60 && blue < 60, `it is ${[red, green, blue]}`);
  await page.getByRole("button", { name: /^ball 700/ }).click();
  await page.getByLabel("Opacity of ball 700").fill("0.2");
  await page.keyboard.press("Escape");
  await until(page, () => supple.model.selection === null);
  await settled(page);
  const faint = await colourOf(page, one);
  const away = (from) => Math.max(...faint.map((value, i) => Math.abs(value - from[i])));
  assert.ok(away([red, green, blue]) > 40 && away(await ground(page)) > 10, `it is ${faint}`);
  assert.ok(isNear(await colourOf(page, other), before), "another one has changed too");
}

async function isPickedAndListed(stage) {
  const page = await open(stage);
  const wanted = 30 * COLUMNS + 20;
  const name = await page.evaluate((i) => supple.model.objects[i].name, wanted);
  const { x, y } = await look(page, wanted);
  const before = await colourOf(page, wanted);
  await page.mouse.click(x, y);
  await until(page, (wanted) => supple.model.selection?.object === wanted, wanted);
  await isShownAsSelected(page, name);
  assert.notDeepEqual(await colourOf(page, wanted), before, "it does not glow");
  // Continue with keys, beyond the visible rows.
  await page.locator(".objects li.selected button.name").focus();
  const next = await page.evaluate((i) => supple.model.objects.slice(i + 1, i + 60).map(({ name }) => name), wanted);
  for (const name of next.slice(0, 40)) {
    await page.keyboard.press("ArrowDown");
    await isShownAsSelected(page, name);
    assert.ok((await page.evaluate(() => document.activeElement.textContent)).startsWith(name), "the focus stays behind");
  }
  await page.keyboard.press("PageUp");
  await until(page, (last) => supple.model.selection.object < last, wanted + 40);
}

async function isNamedInTheInspector(stage) {
  const page = await open(stage);
  await page.getByRole("tab", { name: "Inspect" }).click();
  await page.getByLabel("Object A", { exact: true }).fill("2000");
  await page.getByLabel("Name of object A").getByText(await page.evaluate(() => supple.model.objects[2000].name), { exact: true }).waitFor();
  await page.getByLabel("Object B", { exact: true }).fill("3");
  await page.getByRole("button", { name: "Explain" }).click();
  await until(page, () => supple.model.explanation?.stage === "object_volumes");
  assert.deepEqual(await page.evaluate(() => supple.model.explained.map(({ object }) => object)), [2000, 3]);
}

export const tests = [
  ["is drawn in a few calls and listed by a few rows", costsLittle],
  ["one is hidden by its row, far down", isHiddenAfterScrolling],
  ["one is found by its name", isFoundByName],
  ["one is coloured and made transparent", isColouredAndMadeTransparent],
  ["one is picked, and its row comes into sight", isPickedAndListed],
  ["one is named to be explained", isNamedInTheInspector],
];
