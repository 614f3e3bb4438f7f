// What a click in the view or in a table selects, explains and pulls.
import assert from "node:assert/strict";
import { join } from "node:path";
import { camera, contactsIn, counts, groundPlace, said, scenes, seenTriangle, settled, simulateTo, TWO_BALLS, until } from "./tools/harness.mjs";

const nine = join(scenes, "nine.toml");
/** Many pairs touch then. */
const CROWDED = 60;

async function picksATriangle(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  await settled(page);
  const seen = await seenTriangle(page, 1);
  await page.mouse.click(seen.x, seen.y);
  const details = page.getByRole("region", { name: "Selection" });
  await details.getByRole("heading", { name: `Triangle ${seen.triangle}` }).waitFor();
  await details.getByText("area").waitFor();
  const exact = await details.locator("code").first().innerText();
  const vertex = await page.evaluate(() => supple.model.selection.vertex);
  const shown = await page.evaluate(([object, vertex]) => supple.positionOf(object, vertex), [1, vertex]);
  const center = await page.evaluate(() => supple.model.scene.center);
  exact.split("\n").map(Number).forEach((x, i) => assert.ok(Math.abs(x - shown[i] - center[i]) < 1e-6, `${exact} is not ${shown}`));
  const ground = await groundPlace(page);
  await page.mouse.click(ground.x, ground.y);
  await until(page, () => supple.model.selection === null);
}

async function contactTableFlies(stage) {
  const { page } = await stage.view(nine);
  await page.emulateMedia({ reducedMotion: "no-preference" });  // the camera flies
  await simulateTo(page, CROWDED);
  const grid = page.getByRole("treegrid", { name: "Contacts" });
  const contacts = await contactsIn(page);
  const [[one, , other]] = contacts;
  const names = await page.evaluate(() => supple.model.objects.map(({ name }) => name));
  const first = { names: [names[one], names[other]], count: contacts.filter(([a, , b]) => a === one && b === other).length };
  const total = Number(await grid.getAttribute("aria-rowcount"));
  const row = (i) => grid.locator(`[aria-rowindex="${i}"]`);
  assert.deepEqual((await row(1).getByRole("gridcell").allTextContents()).slice(0, 3), [`▸ ${first.names[0]}`, first.names[1], first.count.toLocaleString("en")]);
  const before = await camera(page);
  await row(1).click();  // flies to the pair and opens it
  await until(page, (rows) => Number(document.querySelector('[aria-label="Contacts"][role=treegrid]').getAttribute("aria-rowcount")) === rows, total + first.count);
  await settled(page);
  assert.notDeepEqual((await camera(page)).target, before.target);
  assert.ok((await grid.getByRole("row").count()) < 100, "rows out of sight have elements");
  await row(3).click();
  const key = () => page.evaluate(() => [...supple.model.contact]);
  assert.deepEqual(await key(), contacts[1]);
  await page.keyboard.press("ArrowDown");
  assert.deepEqual(await key(), contacts[2]);
  await row(4).and(grid.locator('[aria-selected="true"]')).waitFor();
  await page.keyboard.press("ArrowLeft");  // closes the pair
  await until(page, (rows) => Number(document.querySelector('[aria-label="Contacts"][role=treegrid]').getAttribute("aria-rowcount")) === rows, total);
  await row(1).and(grid.locator('[aria-selected="true"]')).waitFor();

  await page.getByRole("searchbox", { name: "Filter contacts" }).fill(first.names[0]);
  const matching = new Set(contacts.flatMap(([a, , b]) => ([names[a], names[b]].includes(first.names[0]) ? [`${a} ${b}`] : []))).size;
  await page.getByText(`${matching} of ${total} pair`).waitFor();
  assert.equal(Number(await grid.getAttribute("aria-rowcount")), matching);
  await page.getByRole("searchbox", { name: "Filter contacts" }).fill("no such name");
  await page.getByText(`0 of ${total} pair`).waitFor();
}

async function contactPointsArePicked(stage) {
  const { page } = await stage.view(nine);
  await simulateTo(page, CROWDED);
  const at = await page.evaluate(() => supple.project([...supple.model.frame.lists.contact_points.columns.position.subarray(0, 3)]));
  await page.mouse.click(at.x, at.y);
  await until(page, () => supple.model.contact !== null);
  await page.getByRole("heading", { name: "Contact", exact: true }).waitFor();
}

async function saysWhyThereIsNoContact(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  await settled(page);
  await page.getByRole("radio", { name: "Why no contact?" }).click();
  for (const object of [0, 1]) {
    const seen = await seenTriangle(page, object);
    await page.mouse.click(seen.x, seen.y);
  }
  const verdict = page.getByRole("status", { name: "Explanation" });
  await verdict.getByRole("heading", { name: /objects are apart/ }).waitFor();
  await verdict.getByText("Apart by").waitFor();
  await verdict.getByText("Distance of the objects").waitFor();
  assert.equal(await page.evaluate(() => supple.model.explanation.stage), "object_volumes");
  assert.ok(Math.abs((await page.evaluate(() => supple.model.explanation.distance)) - 0.2) < 0.05);
  await page.keyboard.press("Escape");
  await until(page, () => supple.model.explanation === null);
}

async function saysThatAContactIsOne(stage) {
  const { page } = await stage.view(nine);
  await simulateTo(page, CROWDED);
  await page.getByRole("tab", { name: "Inspect" }).click();
  const [[a, triangleA, b, triangleB]] = await contactsIn(page);
  await page.getByLabel("Object A", { exact: true }).fill(String(a));
  await page.getByLabel("Triangle A").fill(String(triangleA));
  await page.getByLabel("Object B", { exact: true }).fill(String(b));
  await page.getByLabel("Triangle B").fill(String(triangleB));
  await page.getByRole("button", { name: "Explain" }).click();
  await until(page, () => supple.model.explanation?.stage === "contact");
  await page.getByLabel("Triangle B").fill("999999");
  await page.getByRole("button", { name: "Explain" }).click();
  await page.getByText("There is no triangle 999999").waitFor();
  await page.getByLabel("Object B", { exact: true }).fill("77");
  assert.ok(await page.getByLabel("Object B", { exact: true }).evaluate((field) => field.validity.rangeOverflow));
}

/** Pulls a vertex of one ball into the other ball until contacts begin. */
async function pullingMakesContacts(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  await settled(page);
  assert.equal(await page.evaluate(() => supple.model.frame.lists.contacts.count), 0);
  // In the front view, drag from the side of the left ball that faces the right one to the middle of the
  // right one.
  await page.getByRole("combobox", { name: "Axis view" }).selectOption("front");
  await settled(page);
  const left = await page.evaluate(() => supple.project([-0.13, 0, 0.1]));
  const right = await page.evaluate(() => supple.project([0.5, 0, 0.1]));
  await page.getByRole("radio", { name: "Grab and pull" }).click();
  await page.mouse.move(left.x, left.y);
  await page.mouse.down();
  await page.mouse.move((left.x + right.x) / 2, right.y, { steps: 10 });
  await page.mouse.move(right.x, right.y, { steps: 10 });
  await until(page, () => supple.model.frame.lists.contacts.count > 0);
  await page.mouse.up();
  await settled(page);
  assert.ok((await counts(page)).points > 0);
  const moved = await page.evaluate(() => supple.model.selection.object);
  assert.equal(moved, 0);
}

async function pullsASoftBody(stage) {
  const { page } = await stage.view(join(scenes, "soft_block.toml"));
  await simulateTo(page, 0);
  const body = await page.evaluate(() => supple.model.objects.findIndex((object) => object.isBody));
  const seen = await seenTriangle(page, body, 0.2);  // its bottom is fixed
  await page.getByRole("radio", { name: "Grab and pull" }).click();
  await page.mouse.move(seen.x, seen.y);
  await page.mouse.down();
  await until(page, () => supple.model.selection?.vertex !== null && supple.model.selection);
  const vertex = await page.evaluate(() => supple.model.selection.vertex);
  const before = await page.evaluate(([object, vertex]) => supple.positionOf(object, vertex), [body, vertex]);
  await page.mouse.move(seen.x, seen.y - 150, { steps: 12 });
  await until(
    page,
    ([object, vertex, before]) => Math.hypot(...supple.positionOf(object, vertex).map((x, i) => x - before[i])) > 0.02,
    [body, vertex, before],
  );
  await page.mouse.up();
}

async function staticObjectsAreNotPulled(stage) {
  const { page } = await stage.view(join(scenes, "cloth_over_ball.toml"));
  await simulateTo(page, 0);
  const ball = await page.evaluate(() => supple.model.objects.findIndex((object) => object.isStatic));
  const cloth = await page.evaluate(() => supple.model.objects.findIndex((object) => !object.isStatic));
  await page.getByRole("checkbox", { name: `Show ${await page.evaluate((i) => supple.model.objects[i].name, cloth)}` }).uncheck();
  const seen = await seenTriangle(page, ball);
  await page.getByRole("radio", { name: "Grab and pull" }).click();
  await page.mouse.click(seen.x, seen.y);
  await said(page, "is static");
}

/** What never moves has no seed, no reset and no speed; after a pull, a reset brings it back. */
async function meshesAtRestOfferOnlyAResetOfAPull(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  await settled(page);
  const [seed, speed, reset] = [page.getByRole("textbox", { name: "Seed" }), page.getByRole("combobox", { name: "Speed" }), page.getByRole("button", { name: "Reset" })];
  for (const control of [seed, speed, reset]) assert.ok(await control.isHidden(), `${control} is offered`);
  const seen = await seenTriangle(page, 0);
  const place = () => page.evaluate((vertex) => supple.positionOf(0, vertex), seen.vertex);
  const before = await place();
  await page.getByRole("radio", { name: "Grab and pull" }).click();
  await page.mouse.move(seen.x, seen.y);
  await page.mouse.down();
  await page.mouse.move(seen.x, seen.y - 40, { steps: 8 });
  await until(page, ([vertex, before]) => supple.positionOf(0, vertex)[1] > before[1] + 0.02, [seen.vertex, before]);
  await page.mouse.up();
  await reset.waitFor();
  for (const control of [seed, speed]) assert.ok(await control.isHidden(), `${control} is offered after a pull`);
  await reset.click();
  await until(page, ([vertex, before]) => supple.model.frame && supple.positionOf(0, vertex).every((x, axis) => Math.abs(x - before[axis]) < 1e-6), [seen.vertex, before]);
  await reset.waitFor({ state: "hidden" });
}

async function continuousContactsAreListed(stage) {
  const { page } = await stage.view(nine, "--contacts", "continuous");
  await simulateTo(page, 20);
  await page.getByRole("checkbox", { name: "Contact normals" }).check();
  await settled(page);
  const impacts = await page.evaluate(() => supple.model.frame.lists.continuous_contacts.count);
  assert.ok(impacts > 0);
  assert.equal((await counts(page)).points, impacts);
  assert.equal((await counts(page)).normals, impacts);
  await page.getByRole("tab", { name: "Contacts" }).click();
  const grid = page.getByRole("treegrid", { name: "Contacts" });
  await grid.getByText(/^hit at/).first().waitFor();
  await grid.locator('[aria-rowindex="1"]').click();
  await grid.locator('[aria-rowindex="2"]').click();
  await until(page, () => supple.model.contact !== null);
}

export const tests = [
  ["a triangle is picked and read", picksATriangle],
  ["the contact table flies to contacts", contactTableFlies],
  ["a contact point is picked", contactPointsArePicked],
  ["two picked triangles: why no contact", saysWhyThereIsNoContact],
  ["two named triangles: a contact, and one that is not there", saysThatAContactIsOne],
  ["pulling a vertex makes contacts", pullingMakesContacts],
  ["a soft body is pulled", pullsASoftBody],
  ["a static object says that it does not bend", staticObjectsAreNotPulled],
  ["meshes at rest offer only a reset, after a pull", meshesAtRestOfferOnlyAResetOfAPull],
  ["continuous contacts", continuousContactsAreListed],
];
