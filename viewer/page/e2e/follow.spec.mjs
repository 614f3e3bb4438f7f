// Pins, tables that sort and filter, and the command palette.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { atStep, contactsIn, goesOn, hasFrame, isAt, pause, runProgram, scenes, seenTriangle, settled, steps, SWAYING_CROWD, until } from "./tools/harness.mjs";
import { SIZES } from "./tools/sizes.mjs";

const nine = join(scenes, "nine.toml");
const pins = (page) => page.getByRole("grid", { name: "Pins" });
const pinRows = (page) => pins(page).getByRole("row").filter({ visible: true });

/** A pair from its row, an object from the inspector, a contact by keys: each has a row for each step. */
async function pinsFollowEachStep(stage) {
  const { page } = await stage.viewAt(12, nine);
  const contacts = page.getByRole("treegrid", { name: "Contacts" });
  const pin = page.locator(".pairs").getByRole("button", { name: "pin" });
  assert.ok(await pin.isDisabled());
  await contacts.locator('[aria-rowindex="1"]').click();
  const [[one, , other]] = await contactsIn(page);
  const pair = [one, other];
  await pin.click();
  await page.getByRole("tab", { name: "Pins", selected: true }).waitFor();
  await page.getByRole("tab", { name: "Contacts" }).click();
  await contacts.locator('[aria-rowindex="2"]').click();
  const key = await page.evaluate(() => [...supple.model.contact]);
  await page.keyboard.press("Shift+I");
  await page.keyboard.press("f");  // back from the contact
  await settled(page);
  const seen = await seenTriangle(page, 0);
  await page.mouse.click(seen.x, seen.y);
  await page.locator(".details").getByRole("button", { name: "pin" }).click();
  await pins(page).locator('[aria-rowindex="3"]').waitFor();
  assert.deepEqual(await page.evaluate(() => supple.pins.list.map(({ objects, contact }) => ({ objects, contact: contact && [...contact] }))), [{ objects: pair, contact: null }, { objects: pair, contact: key }, { objects: [0], contact: null }]);
  assert.equal(await pinRows(page).count(), 3);

  await settled(page);
  await steps(page, 30);
  const expected = (await contactsIn(page)).filter(([a, , b]) => a === one && b === other).length;
  const { lists, present, last } = await page.evaluate(() => {
    const { step } = supple.model.frame.text;
    return { lists: supple.pins.list.map(({ series }) => series.steps), present: supple.pins.list[0].series.at(0, step), last: step };
  });
  for (const list of lists) {
    assert.equal(list.at(-1), last);
    assert.ok(list.length > 30 && list.every((step, i) => i === 0 || step === list[i - 1] + 1), `steps are missing: ${list}`);
  }
  assert.equal(present, expected);
  const count = expected >= 1000 ? expected.toLocaleString("en") : String(expected);
  await pins(page).locator('[aria-rowindex="1"] > :nth-child(2)', { hasText: new RegExp(`^${count}$`) }).waitFor();
  for (const figure of ["contacts", "length", "normal"]) {
    await pins(page).locator('[aria-rowindex="1"]').click();
    await page.locator(".pin-detail").getByRole("figure", { name: figure }).waitFor();
  }

  // The plots are saved as numbers.
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "save CSV" }).click()]);
  const path = stage.file("pin.csv");
  await download.saveAs(path);
  const [head, ...rows] = readFileSync(path, "utf8").trim().split("\n");
  assert.ok(head.startsWith("step,time,contacts,gap,depth,length,area,normal_x"));
  assert.equal(rows.length, lists[0].length);
  assert.deepEqual(rows.at(-1).split(",").slice(0, 1).concat(rows.at(-1).split(",")[2]), [String(last), String(expected)]);

  // Pins are tables: sorted, filtered, removed by a key; they survive a reload.
  await page.getByRole("searchbox", { name: "Filter pins" }).fill("speed>=0");
  assert.equal(await pinRows(page).count(), 1);
  await page.getByRole("searchbox", { name: "Filter pins" }).fill("");
  await page.reload();
  await hasFrame(page);
  await until(page, () => supple.pins.list.length === 3 && supple.pins.list.every(({ series }) => series.steps.length > 0));
  await page.getByRole("tab", { name: "Pins" }).click();
  await pins(page).locator('[aria-rowindex="1"]').click();
  await page.keyboard.press("Delete");
  await until(page, () => supple.pins.list.length === 2);
  await page.getByRole("button", { name: "unpin" }).click();
  await until(page, () => supple.pins.list.length === 1);
}

/** A recording has the values of all frames, also of those that were not shown, and a click in a plot goes to a frame. */
async function pinsOfARecording(stage) {
  const file = stage.file("run.h5");
  await runProgram(stage.supple, ["simulate", nine, "--steps", "40", "--record", file, "--quiet"]);
  const { page } = await stage.viewAt(0, file);
  await until(page, () => supple.model.history.frames.length > 0);
  await page.evaluate(() => supple.pins.add([0, 1]));
  await page.evaluate(() => supple.pins.add([0]));
  const frames = await page.evaluate(() => supple.model.scene.frames);
  await until(page, (frames) => supple.pins.list.every(({ series }) => series.steps.length === frames), frames);
  await page.getByText(`Values of ${frames} steps.`).waitFor();
  await page.getByRole("progressbar").waitFor({ state: "hidden" });
  const contacts = await page.evaluate(() => supple.pins.list[0].series.columns[0]);
  for (const frame of [frames - 1, frames - 2, 20]) {
    await page.evaluate((frame) => supple.client.ask({ do: "seek", frame }), frame);
    await isAt(page, frame);
    const shown = (await contactsIn(page)).filter(([a, , b]) => a === 0 && b === 1).length;
    assert.equal(contacts[frame], shown, `in frame ${frame}`);
  }
  assert.deepEqual(await page.evaluate(() => supple.pins.list[0].series.steps), Array.from({ length: frames }, (_, i) => i));
  await page.locator(".pin-detail .u-over").first().click({ position: { x: 1, y: 20 } });
  await isAt(page, 0);
}

/** A tap on a plot goes to its step, without a pointer that was there before. */
async function tapsOnPlotsSeek(stage) {
  const file = stage.file("run.h5");
  await runProgram(stage.supple, ["simulate", nine, "--steps", "40", "--record", file, "--quiet"]);
  const program = await stage.program(file);
  const page = await stage.page({ hasTouch: true });
  await page.goto(program.address);
  await hasFrame(page);
  await pause(page);  // it would go on from a frame that is sought
  await page.evaluate(() => supple.pins.add([0, 1]));
  await until(page, () => supple.pins.list[0].series.steps.length === supple.model.scene.frames);
  const taps = async (plot, share) => {
    const { width, height } = await plot.boundingBox();
    await plot.tap({ position: { x: share * width, y: height / 2 } });
    await until(page, (share) => Math.abs(supple.model.frame.text.step / (supple.model.scene.frames - 1) - share) < 0.1, share);
  };
  for (const name of ["Pins", "Plots"]) {
    await page.getByRole("tab", { name }).tap();
    const plot = page.locator(`#page-${name} .u-over`).first();
    await plot.waitFor();
    for (const share of [0.75, 0.25]) await taps(plot, share);
  }
}

/** Of a pair that never touches and of a contact that has ended, the page says so. */
async function pinsSayWhatIsMissing(stage) {
  const { page } = await stage.viewAt(12, nine);
  const touching = await contactsIn(page);
  const objects = await page.evaluate(() => supple.model.objects.map(({ index }) => index));
  const apart = objects.flatMap((a) => objects.slice(a + 1).map((b) => [a, b])).find(([a, b]) => !touching.some(([one, , other]) => one === a && other === b));
  await page.evaluate((pair) => supple.pins.add(pair), apart);
  await page.getByText("No contact in 1 step.").waitFor();
  const [key] = touching;
  await page.evaluate((key) => supple.pins.add([key[0], key[2]], key), key);
  await page.getByText("Values of 1 step.").waitFor();
  const isPresent = async () => (await contactsIn(page)).some((contact) => contact.join() === key.join());
  for (let count = 0; await isPresent(); ++count) {
    assert.ok(count < 100, "the contact does not end");
    await steps(page, 1);
  }
  await page.getByText("No longer a contact.").waitFor();
}

/** Tables have a filter for each column; an unreadable one says why and lists all. */
async function tablesAreFiltered(stage) {
  const ball = (name, x) => `[[object]]\nname = "${name}"\nmodel = "icosphere"\nfrequency = 8\ntranslate = [${x}, 0, 0]\nmargin = 0.2\nsolid = true\n`;
  const { page } = await stage.view(stage.file("balls.toml", `[scene]\ncontacts = "proximity,penetration"\n${ball("one", 0)}${ball("two", 1.6)}${ball("three", 3.3)}${ball("four", 5.42)}`));
  const summary = (text) => page.locator(".table-top .hint").filter({ visible: true, hasText: text }).waitFor();
  await summary("3 pairs");
  const field = page.getByRole("searchbox", { name: "Filter contacts" });
  await field.fill("depth>0.35");
  await summary("1 of 3 pairs");
  assert.equal(await page.getByRole("treegrid", { name: "Contacts" }).locator(".row:visible").filter({ hasText: "two" }).count(), 1);
  await field.fill("gap<0.2 a=three is=near");
  await summary("1 of 3 pairs");
  await field.fill("dept>0.35");
  await page.getByText("There is no column “dept”").waitFor();
  assert.equal(await field.getAttribute("aria-invalid"), "true");
  await summary("3 of 3 pairs");

  await page.getByRole("tab", { name: "Curves" }).click();
  const curves = page.getByRole("grid", { name: "Curves" });
  await page.getByRole("button", { name: "Sort by depth" }).click();
  const depths = async () => (await curves.locator(".row:visible > :nth-child(4)").allTextContents()).map(Number);
  assert.equal(await page.getByRole("columnheader", { name: "depth" }).filter({ visible: true }).getAttribute("aria-sort"), "descending");
  const [deep, flat, ...more] = await depths();
  assert.ok(deep > flat && more.length === 0, `${deep}, ${flat}`);
  const kind = await page.evaluate(() => ["closed", "open", "branched"][supple.model.frame.lists.curves.columns.kind[0]]);
  await page.getByRole("searchbox", { name: "Filter curves" }).fill(`depth<${(deep + flat) / 2} kind=${kind}`);
  await summary("1 of 2 curves");
  await curves.locator(".row:visible").click();
  await curves.locator('[aria-selected="true"]:visible').waitFor();
}

async function objectsAreSorted(stage) {
  const more = `[[object]]\nname = "plate"\nmodel = "cloth"\ncolumns = 30\nrows = 30\nwidth = 1\ndepth = 1\ntranslate = [0, -4, 0]\n`;
  const { page } = await stage.viewAt(0, stage.file("crowd.toml", SWAYING_CROWD.replace("[20, 25, 10]", "[4, 4, 4]") + more));
  const rows = page.getByRole("list", { name: "Objects" }).getByRole("listitem");
  // Rows are drawn with the next frame of the page.
  const isFirst = (name) => rows.first().locator(".name .text").filter({ hasText: name }).waitFor();
  await isFirst(/^ball/);
  await page.getByRole("button", { name: "Sort by triangles" }).click();
  await isFirst(/^plate$/);
  await page.getByRole("button", { name: "Sort by triangles" }).click();
  await isFirst(/^ball/);
  await page.getByRole("searchbox", { name: "Filter objects" }).fill("triangles>80");
  await isFirst(/^plate$/);
  assert.equal(await rows.count(), 1);
}

const palette = (page) => page.getByRole("dialog", { name: "Command palette" });

/** Everything by keys: commands, objects, layers, tabs, settings. */
async function paletteByKeys(stage) {
  const { page } = await stage.view(nine);
  await pause(page);
  const types = async (text) => {
    await page.keyboard.press("Control+k");
    await page.getByRole("combobox", { name: /^Command, object/ }).fill(text);
  };
  const chosen = () => palette(page).locator('[aria-selected="true"] .text').textContent();
  await types("fral");
  assert.equal(await chosen(), "Frame all");
  await page.keyboard.press("Escape");
  await types("frame");
  assert.equal(await chosen(), "Frame all");
  await page.keyboard.press("ArrowDown");
  assert.notEqual(await chosen(), "Frame all");
  await page.keyboard.press("ArrowUp");
  assert.equal(await chosen(), "Frame all");
  const active = await page.getByRole("combobox", { name: /^Command, object/ }).getAttribute("aria-activedescendant");
  assert.equal(await page.locator(`#${active}`).getAttribute("aria-selected"), "true");
  await page.keyboard.press("Escape");
  await palette(page).waitFor({ state: "hidden" });

  const name = await page.evaluate(() => supple.model.objects[2].name);
  await types(`hide ${name}`);
  await page.keyboard.press("Enter");
  await until(page, () => !supple.model.objects[2].visible);
  await types(`select ${name}`);
  await page.keyboard.press("Enter");
  await until(page, () => supple.model.selection?.object === 2);
  await types("wirefr");
  await page.keyboard.press("Enter");
  await until(page, () => supple.model.layers.wireframe);
  await types("four views");
  await page.keyboard.press("Enter");
  assert.equal((await page.evaluate(() => supple.cameras())).length, 4);
  await types("leaf size");
  await page.keyboard.press("Enter");
  await until(page, () => document.activeElement?.id === "setting-leaf_size");
  await types("tab plots");  // from a field for text
  await page.keyboard.press("Enter");
  await page.getByRole("tab", { name: "Plots", selected: true }).waitFor();
  await types("zzzzqqq");
  await page.getByText("Nothing is like “zzzzqqq”.").waitFor();
  await page.keyboard.press("Enter");
  assert.ok(await palette(page).isVisible());
}

async function paletteByTouch(stage) {
  const program = await stage.program(nine);
  for (const [width, colorScheme] of [[390, "dark"], [800, "light"], [1440, "light"]]) {
    const page = await stage.page({ viewport: { width, height: 800 }, hasTouch: true, colorScheme });
    await page.goto(atStep(program.address, 3));
    await isAt(page, 3);
    await page.getByRole("button", { name: "Command palette" }).tap();
    await palette(page).getByRole("option", { name: /^Wireframe/ }).scrollIntoViewIfNeeded();
    await palette(page).getByRole("option", { name: /^Wireframe/ }).tap();
    await until(page, () => supple.model.layers.wireframe);
    await page.getByRole("button", { name: "Command palette" }).tap();
    await page.getByRole("combobox", { name: /^Command, object/ }).fill("tab settings");
    await palette(page).getByRole("option").first().tap();
    await page.getByRole("tab", { name: "Settings", selected: true }).waitFor();
    assert.ok(await page.locator("#page-Settings").isVisible());
    await page.close();
  }
}

/** Each key of the list is listed once, and the list has the keys of the layers. */
async function helpListsTheCommands(stage) {
  const { page } = await stage.view(nine);
  await page.keyboard.press("?");
  const help = page.getByRole("dialog", { name: "Keyboard shortcuts" });
  const keys = await help.locator("dt").evaluateAll((terms) => terms.map((term) => [...term.children].map((key) => key.textContent).join(" ")));
  assert.equal(new Set(keys).size, keys.length, "a key is listed twice");
  for (const key of ["Space", "Shift ←", "Ctrl K", "Shift I", "Q", "X", "Esc"]) assert.ok(keys.includes(key), `${key} is not listed`);
}

/** While a scene plays, its values are written again and again, and their buttons work all the same. */
async function buttonsStay(stage) {
  const program = await stage.program(nine);
  const page = await stage.page(SIZES[1440]);
  await page.goto(program.address);
  await hasFrame(page);
  await page.evaluate(() => supple.model.select({ object: 0, triangle: null, vertex: null }));
  await page.getByRole("tab", { name: "Inspect" }).click();
  const pin = page.locator(".details").getByRole("button", { name: "pin" });
  await pin.waitFor();
  await page.evaluate(() => {
    const button = document.querySelector(".details button");
    button.focus();
    button.dataset.first = "";
  });
  await until(page, () => document.querySelector(".details button:not([data-first])") !== null);
  await until(page, () => document.activeElement?.matches(".details button"));
  const { x, y, width, height } = await page.evaluate(() => document.querySelector(".details button").getBoundingClientRect().toJSON());
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await goesOn(page);  // longer than the values stay
  await page.mouse.up();
  await until(page, () => supple.pins.list.length === 1);
}

export const tests = [
  ["buttons stay while values change", buttonsStay],
  ["pins have each step", pinsFollowEachStep],
  ["pins of a recording", pinsOfARecording],
  ["a tap on a plot goes to its step", tapsOnPlotsSeek],
  ["pins say what is missing", pinsSayWhatIsMissing],
  ["tables are filtered by each column", tablesAreFiltered],
  ["objects are sorted", objectsAreSorted],
  ["palette by keys", paletteByKeys],
  ["palette by touch", paletteByTouch],
  ["help lists the commands", helpListsTheCommands],
];
