// A simulation in the program, shown and controlled in a page.
import assert from "node:assert/strict";
import { join } from "node:path";
import { camera, counts, pause, picture, scenes, seenTriangle, settled, step, TWO_BALLS, until } from "./harness.mjs";

const nine = join(scenes, "nine.toml");

async function movesPausesAndSteps(stage) {
  const { page } = await stage.view(nine);
  const before = { ...(await page.evaluate(() => ({ step: supple.model.frame.text.step, at: supple.positionOf(0, 0) }))), picture: await picture(page) };
  await until(page, (before) => supple.model.frame.text.step > before + 5, before.step);
  assert.notDeepEqual(await page.evaluate(() => supple.positionOf(0, 0)), before.at);
  assert.notEqual(await picture(page), before.picture);

  await page.getByRole("button", { name: "Pause" }).click();
  await until(page, () => !supple.model.frame.text.playing);
  const paused = await step(page);
  await page.waitForTimeout(400);
  await settled(page);
  assert.equal(await step(page), paused);
  await page.getByRole("button", { name: "+1 step" }).click();
  await until(page, (wanted) => supple.model.frame.text.step === wanted, paused + 1);
  await page.getByRole("button", { name: "Play" }).click();
  await until(page, (paused) => supple.model.frame.text.step > paused + 3, paused);
}

async function resetsWithASeedAndSpeed(stage) {
  const { page } = await stage.view(nine);
  await until(page, () => supple.model.frame.text.step > 10);
  await page.getByRole("combobox", { name: "Speed" }).selectOption("0.1");
  await until(page, () => supple.model.frame.text.speed === 0.1);
  const generation = await page.evaluate(() => supple.model.scene.generation);
  await page.getByRole("textbox", { name: "Seed" }).fill("18446744073709551615");
  await page.getByRole("textbox", { name: "Seed" }).press("Enter");
  await until(page, (old) => supple.model.scene.generation > old && supple.model.frame, generation);
  assert.equal(await page.evaluate(() => supple.model.scene.seed), "18446744073709551615");
  await pause(page);
  await page.getByRole("button", { name: "Reset" }).click();
  await until(page, () => supple.model.frame?.text.step === 0);
}

/** Each layer with content changes the picture, and draws as many elements as the session reports. */
async function eachLayerShows(stage) {
  const { page } = await stage.view(nine, "--broad-phase", "octree");
  await until(page, () => supple.model.frame.contacts.length > 200 && supple.model.frame.objectPairs.length > 8);
  await pause(page);
  const layers = [
    ["Scene octree", "regions"], ["Object octrees", "boxes"], ["Colliding nodes", "nodeBoxes"], ["Object pairs", "pairs"], ["Candidate pairs", "candidates"],
    ["Intersecting triangles", "triangles"], ["Contact points", "points"], ["Contact normals", "normals"],
    ["Contact segments", "segments"], ["Colliding vertices", "vertices"], ["Surfaces", null], ["Wireframe", null],
  ];
  const boxes = page.getByRole("list", { name: "Layers" });
  for (const [label] of layers) await boxes.getByRole("checkbox", { name: label }).setChecked(label === "Surfaces");
  await settled(page);
  const bare = await picture(page);
  for (const [label, count] of layers) {
    const box = boxes.getByRole("checkbox", { name: label });
    await box.click();
    if (count) await until(page, (name) => supple.counts()[name] > 0, count);
    await settled(page);
    assert.notEqual(await picture(page), bare, `${label} shows nothing`);
    await box.click();
    if (count) await until(page, (name) => supple.counts()[name] === 0, count);
    await settled(page);
    assert.equal(await picture(page), bare, `${label} does not go away`);
  }
}

/** Proximity pairs, and depths in solid objects, are drawn by layers of their own. */
async function proximityAndDepthsShow(stage) {
  const ball = (x) => `[[object]]\nmodel = "icosphere"\nfrequency = 6\ntranslate = [${x}, 0, 0]\nmargin = 0.05\nsolid = true\n`;
  const scene = stage.file("balls.toml", `[scene]\ncontacts = "proximity,penetration"\n${ball(0)}${ball(1.9)}${ball(3.95)}`);
  const { page } = await stage.view(scene);
  await until(page, () => supple.model.frame.proximityPairs.length > 4 && supple.model.frame.penetrations.length > 4);
  await settled(page);
  const { drawn, pairs, depths } = await page.evaluate(() => ({
    drawn: supple.counts(), pairs: supple.model.frame.proximityPairs.length / 2, depths: supple.model.frame.penetrations.length / 4,
  }));
  assert.equal(drawn.proximity, pairs);
  assert.equal(drawn.depths, depths);
  const rows = await page.getByRole("treegrid", { name: "Contacts" }).getByRole("row").allTextContents();
  assert.equal(rows.length, 2);
  for (const [label, count] of [["Proximity pairs", "proximity"], ["Depths", "depths"]]) {
    const before = await picture(page);
    await page.getByRole("checkbox", { name: label, exact: true }).uncheck();
    await until(page, (name) => supple.counts()[name] === 0, count);
    await settled(page);
    assert.notEqual(await picture(page), before, `${label} shows nothing`);
  }
}

/** Each curve is drawn, its numbers are listed, and its row flies to it. */
async function curvesShow(stage) {
  const ball = (x, y) => `[[object]]\nname = "at ${x}"\nmodel = "icosphere"\nfrequency = 6\ntranslate = [${x}, ${y}, 0.05]\n`;
  const { page } = await stage.view(stage.file("balls.toml", `[scene]\ncontacts = "penetration"\n${ball(0, 0)}${ball(1.9, 0.04)}${ball(3.6, -0.07)}`));
  await until(page, () => supple.model.frame.curves.length > 0);
  await settled(page);
  const { drawn, frame } = await page.evaluate(() => {
    const { curves, curvePoints, enclosedVertices } = supple.model.frame;
    return { drawn: supple.counts(), frame: { curves: [...curves], points: [...curvePoints], enclosed: enclosedVertices.length } };
  });
  assert.equal(drawn.curves, 2);
  assert.equal(frame.curves.length, 16);
  assert.ok(drawn.curveFaces > frame.enclosed / 2 && frame.enclosed > 4);
  const before = await picture(page);
  await page.getByRole("checkbox", { name: "Curves", exact: true }).uncheck();
  await until(page, () => supple.counts().curves === 0 && supple.counts().curveFaces === 0 && supple.counts().curveArrows === 0);
  await settled(page);
  assert.notEqual(await picture(page), before, "curves show nothing");

  await page.getByRole("tab", { name: "Curves" }).click();
  const rows = page.getByRole("grid", { name: "Curves" }).getByRole("row");
  await rows.nth(1).waitFor();
  assert.equal(await rows.count(), 2);
  const rounded = (x) => String(Number(x.toPrecision(3)));
  const { curves, points } = frame;
  const expected = ["at 1.9", "at 3.6", rounded(points[15]), rounded(points[11]), `${curves[13]} + ${curves[14]}`];
  assert.deepEqual(await rows.nth(1).getByRole("gridcell").allTextContents(), expected);
  await rows.nth(1).click();
  await settled(page);
  const { target } = await camera(page);
  points.slice(8, 11).forEach((x, axis) => assert.ok(Math.abs(target[axis] - x) < 1e-3, `${target} is not at ${points}`));
  assert.equal(await rows.nth(1).getAttribute("aria-selected"), "true");
}

async function countsAreTheSessions(stage) {
  const { page } = await stage.view(nine);
  await until(page, () => supple.model.frame.contacts.length > 200);
  await pause(page);
  for (const label of ["Object pairs", "Candidate pairs", "Colliding vertices"]) await page.getByRole("checkbox", { name: label }).check();
  await until(page, () => supple.counts().candidates > 0 && supple.counts().vertices > 0);
  await settled(page);
  const { drawn, frame, statistics } = await page.evaluate(() => ({
    drawn: supple.counts(),
    frame: { contacts: supple.model.frame.contacts.length / 8, points: supple.model.frame.contactPoints.length / 8, pairs: supple.model.frame.objectPairs.length / 2 },
    statistics: Object.fromEntries(supple.model.scene.statistics.map((name, i) => [name, supple.model.frame.statistics[i]])),
  }));
  assert.equal(drawn.points, frame.points);
  assert.equal(drawn.pairs, frame.pairs);
  assert.equal(frame.contacts, statistics.contacts);
  assert.equal(frame.pairs, statistics.object_pairs);
  assert.equal(drawn.candidates, statistics.candidate_pairs);
}

async function octreeLevels(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  await page.getByRole("checkbox", { name: "Object octrees" }).check();
  await until(page, () => supple.counts().boxes > 0);
  const leaves = (await counts(page)).boxes;
  const levels = page.getByRole("combobox", { name: "Octree level" });
  await until(page, () => document.querySelector('[aria-label="Octree level"]').options.length > 2);
  await levels.selectOption("0");
  await until(page, (leaves) => supple.counts().boxes > 0 && supple.counts().boxes < leaves, leaves);
  const roots = (await counts(page)).boxes;
  await page.getByRole("button", { name: /^left/ }).click();
  await page.getByRole("checkbox", { name: "Selected only" }).check();
  await until(page, (roots) => supple.counts().boxes === roots / 2, roots);
}

/** The levels of the narrow phase are listed, and each shows its nodes. */
async function narrowPhaseByLevel(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS.replaceAll("0.6", "0.45")));
  await page.getByRole("tab", { name: "Inspect" }).click();
  const panel = page.getByRole("region", { name: "Narrow phase" });
  await panel.getByRole("combobox", { name: "Object pair" }).selectOption("0 1");
  await panel.getByRole("button", { name: /^level 0/ }).click();
  await until(page, () => supple.counts().nodeBoxes === 2);
  assert.equal(await panel.getByLabel("Node pairs").innerText(), "A(0, 0) A(0, 0)");
  assert.ok(await page.getByRole("checkbox", { name: "Colliding nodes" }).isChecked());
  await panel.getByRole("button", { name: /^level 1/ }).click();
  await until(page, () => supple.counts().nodeBoxes > 2);
  assert.match(await panel.getByLabel("Node pairs").innerText(), /^A\([1-8], 1\) A\([1-8], 1\)/);
  const inner = (await counts(page)).nodeBoxes;
  await panel.getByRole("button", { name: /^all levels/ }).click();
  await until(page, (inner) => supple.counts().nodeBoxes > inner + 2, inner);
  await panel.getByRole("button", { name: /^all levels/, pressed: true }).click();
  await until(page, () => supple.counts().nodeBoxes === 0);
}

/** Octree cells and colliding nodes have the shape of the bounding volume. */
async function otherVolumes(stage) {
  const file = stage.file("balls.toml", TWO_BALLS.replaceAll("0.6", "0.45"));
  const edgesOfBox = 12;
  for (const volume of ["obb", "kdop26"]) {
    const { page } = await stage.view(file, "--bounding-volume", volume);
    await page.getByRole("checkbox", { name: "Object octrees" }).check();
    await page.getByRole("checkbox", { name: "Colliding nodes" }).check();
    await until(page, () => supple.counts().edges > 0 && supple.counts().nodeEdges > 0);
    const drawn = await counts(page);
    assert.equal(drawn.boxes + drawn.balls + drawn.nodeBoxes + drawn.nodeBalls, 0);
    await page.getByRole("combobox", { name: "Octree level" }).selectOption("0");
    if (volume === "obb") await until(page, (edges) => supple.counts().edges === edges, 2 * edgesOfBox);
    else await until(page, (edges) => supple.counts().edges > edges, 2 * edgesOfBox);
  }
}

/** The collisions of the narrow phase are counted while their layer is on. */
async function eventsAreCounted(stage) {
  const { page } = await stage.view(nine);
  await page.getByRole("tab", { name: "Plots" }).click();
  await page.getByText("counted with Colliding vertices").waitFor();
  await page.getByRole("checkbox", { name: "Colliding vertices" }).check();
  await until(page, () => Object.values(supple.model.history.events).every(({ begin }) => begin.length > 0));
  await pause(page);
  await page.getByRole("tab", { name: "Plots" }).click();
  const began = await page.evaluate(() => supple.model.history.events.narrow_phase.begin.length);
  await page.getByText(`${began} began`).first().waitFor();
}

async function hidesAndColoursObjects(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  await settled(page);
  const both = await picture(page);
  await page.getByRole("checkbox", { name: "Show left" }).uncheck();
  await settled(page);
  const one = await picture(page);
  assert.notEqual(one, both);
  await page.getByRole("checkbox", { name: "Show left" }).check();
  await settled(page);
  assert.equal(await picture(page), both);
  await page.getByLabel("Colour of left").fill("#ff00ff");
  await settled(page);
  const pink = await picture(page);
  assert.notEqual(pink, both);
  await page.getByRole("button", { name: /^left/ }).click();
  await page.getByLabel("Opacity of left").fill("0.3");
  await settled(page);
  assert.notEqual(await picture(page), pink);
}

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
  await page.mouse.click(seen.x, 120);  // the ground
  await until(page, () => supple.model.selection === null);
}

async function contactTableFlies(stage) {
  const { page } = await stage.view(nine);
  await page.emulateMedia({ reducedMotion: "no-preference" });  // the camera flies
  await until(page, () => supple.model.frame.contacts.length > 400);
  await pause(page);
  const grid = page.getByRole("treegrid", { name: "Contacts" });
  const first = await page.evaluate(() => {
    const [a, , b] = supple.model.frame.contacts;
    const { contacts, contactPoints, text } = supple.model.frame;
    const places = Array.from({ length: contacts.length / 8 }, (_, i) => i).filter((i) => contacts[8 * i] === a && contacts[8 * i + 2] === b);
    return { names: [a, b].map((object) => supple.model.objects[object].name), count: places.length, points: contactPoints.length / 8, step: text.step };
  });
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
  const inFrame = (i) => page.evaluate((i) => [...supple.model.frame.contacts.subarray(8 * i, 8 * i + 4)], i);
  assert.deepEqual(await key(), await inFrame(1));
  await page.keyboard.press("ArrowDown");
  assert.deepEqual(await key(), await inFrame(2));
  await row(4).and(grid.locator('[aria-selected="true"]')).waitFor();
  await page.keyboard.press("ArrowLeft");  // closes the pair
  await until(page, (rows) => Number(document.querySelector('[aria-label="Contacts"][role=treegrid]').getAttribute("aria-rowcount")) === rows, total);
  await row(1).and(grid.locator('[aria-selected="true"]')).waitFor();

  await page.getByRole("searchbox", { name: "Filter contacts" }).fill(first.names[0]);
  const matching = await page.evaluate((name) => new Set(Array.from({ length: supple.model.frame.contacts.length / 8 }, (_, i) => [supple.model.frame.contacts[8 * i], supple.model.frame.contacts[8 * i + 2]])
    .filter((pair) => pair.some((object) => supple.model.objects[object].name === name)).map(String)).size, first.names[0]);
  await page.getByText(`${matching} of ${total} pair`).waitFor();
  assert.equal(Number(await grid.getAttribute("aria-rowcount")), matching);
  await page.getByRole("searchbox", { name: "Filter contacts" }).fill("no such name");
  await page.getByText(`0 of ${total} pair`).waitFor();
}

async function contactPointsArePicked(stage) {
  const { page } = await stage.view(nine);
  await until(page, () => supple.model.frame.contacts.length > 200);
  await pause(page);
  const at = await page.evaluate(() => supple.project([...supple.model.frame.contactPoints.subarray(0, 3)]));
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
  await until(page, () => supple.model.frame.contacts.length > 0);
  await pause(page);
  await page.getByRole("tab", { name: "Inspect" }).click();
  const [a, triangleA, b, triangleB] = await page.evaluate(() => [...supple.model.frame.contacts.subarray(0, 4)]);
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
  assert.equal(await page.evaluate(() => supple.model.frame.contacts.length), 0);
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
  await until(page, () => supple.model.frame.contacts.length > 0);
  await page.mouse.up();
  await settled(page);
  assert.ok((await counts(page)).points > 0);
  const moved = await page.evaluate(() => supple.model.selection.object);
  assert.equal(moved, 0);
}

async function pullsASoftBody(stage) {
  const { page } = await stage.view(join(scenes, "soft_block.toml"));
  await pause(page);
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
  await pause(page);
  const ball = await page.evaluate(() => supple.model.objects.findIndex((object) => object.isStatic));
  const cloth = await page.evaluate(() => supple.model.objects.findIndex((object) => !object.isStatic));
  await page.getByRole("checkbox", { name: `Show ${await page.evaluate((i) => supple.model.objects[i].name, cloth)}` }).uncheck();
  const seen = await seenTriangle(page, ball);
  await page.getByRole("radio", { name: "Grab and pull" }).click();
  await page.mouse.click(seen.x, seen.y);
  await page.getByRole("log").getByText("is static").waitFor();
}

/** Values to try; for the others the next word or the other truth. */
const OTHER_VALUES = { max_level: "5", leaf_size: "8", tree_arity: "2", objects: "12", time_step: "0.01" };
const TRIED = ["bounding_volume", "broad_phase", "contacts", "undecided", "rebuild_degraded", "object_octree", ...Object.keys(OTHER_VALUES)];

/** After each setting, the step and the positions are kept, or the restart was announced at the field. */
async function settingsKeepTheStateOrSayThatTheyRestart(stage) {
  const { page } = await stage.view(nine);
  await until(page, () => supple.model.frame.text.step > 10);
  await page.getByRole("tab", { name: "Settings" }).click();
  await page.getByText("More options").click();
  const settings = await page.evaluate(() => supple.model.scene.settings);
  assert.deepEqual(settings.filter(({ restarts }) => restarts).map(({ key }) => key), ["objects", "time_step"]);
  for (const key of TRIED) {
    const setting = settings.find((each) => each.key === key);
    await pause(page);
    await page.evaluate(() => supple.client.ask({ do: "step", count: 3 }));
    await settled(page);
    const state = () => page.evaluate(() => ({
      step: supple.model.frame.text.step, run: supple.model.scene.run, generation: supple.model.scene.generation, at: supple.positionOf(0, 0),
      rows: supple.model.history.frames.length, pairs: supple.model.history.events.contact.begin.length,
    }));
    const before = await state();
    assert.ok(before.step > 0);
    const field = page.locator(`.setting:has(#setting-${key})`);
    assert.equal((await field.innerText()).includes("restarts"), setting.restarts, `${key} announces a wrong thing`);
    const input = page.locator(`#setting-${key}`);
    if (setting.kind === "truth") await input.click();
    else if (setting.kind === "word") await input.selectOption(await input.evaluate((select) => select.options[(select.selectedIndex + 1) % select.options.length].value));
    else {
      await input.fill(OTHER_VALUES[key]);
      await input.press("Enter");
    }
    await until(page, (old) => supple.model.scene.generation > old && supple.model.frame, before.generation);
    const after = await state();
    if (setting.restarts) {
      assert.deepEqual({ step: after.step, run: after.run }, { step: 0, run: before.run + 1 }, `${key} does not restart`);
    } else {
      const { generation, pairs, ...kept } = before;
      assert.deepEqual({ ...after, generation: 0, pairs: 0 }, { ...kept, generation: 0, pairs: 0 }, `${key} changes the state`);
      if (key === "max_level") assert.equal(after.pairs, pairs, "contacts begin again");
    }
    assert.ok(await field.getByRole("alert").isHidden(), `${key} is refused`);
  }
  assert.ok(await page.evaluate(() => supple.model.objects.some(({ name }) => name.endsWith("#2"))));
}

async function boundingVolumesShow(stage) {
  const { page } = await stage.view(nine);
  await page.getByRole("checkbox", { name: "Object octrees" }).check();
  await until(page, () => supple.counts().boxes > 0);
  await page.getByRole("tab", { name: "Settings" }).click();
  await page.getByLabel("Bounding volume").selectOption("sphere");
  await until(page, () => supple.model.scene.bounding_volume === "sphere" && supple.counts().balls > 0 && supple.counts().boxes === 0);
  await page.getByLabel("Contacts", { exact: true }).and(page.locator("select")).selectOption("continuous");
  await until(page, () => supple.model.frame?.impacts.length > 0);
}

/** The reason is at the field, with the range; the value in effect stays. */
async function wrongValuesAreRefused(stage) {
  const { page } = await stage.view(nine);
  await page.getByRole("tab", { name: "Settings" }).click();
  const refused = [
    ["time_step", "-1", "a finite number above 0", "0.02"], ["time_step", "0", "above 0", "0.02"], ["time_step", "soon", "\"soon\"", "0.02"],
    ["max_level", "99", "a whole number from 0 to 32", "16"], ["max_level", "2.5", "a whole number from 0 to 32", "16"],
    ["leaf_size", "-5", "a whole number", "64"], ["objects", "100001", "from 1 to 100000", "9"],
  ];
  const inEffect = (key) => page.evaluate((key) => String(key === "objects" ? supple.model.objects.length : supple.model.scene[key]), key);
  for (const [key, value, reason, stays] of refused) {
    assert.equal(await inEffect(key), stays);
    const input = page.locator(`#setting-${key}`);
    await input.fill(value);
    await input.press("Enter");
    const alert = page.locator(`.setting:has(#setting-${key})`).getByRole("alert");
    await alert.getByText(reason).waitFor();
    await alert.getByText(`The value stays ${stays}`).waitFor();
    assert.equal(await input.getAttribute("aria-invalid"), "true");
    assert.equal(await input.inputValue(), value, "the user can correct it");
    await input.press("Escape");
    assert.equal(await input.inputValue(), stays);
    assert.ok(await alert.isHidden());
    assert.equal(await inEffect(key), stays);
  }
  const seed = page.getByRole("textbox", { name: "Seed" });
  await seed.fill("-1");
  await seed.press("Enter");
  await until(page, () => document.querySelector("[aria-label=Seed]").validationMessage.includes("from 0 to 18446744073709551615"));
  const now = await step(page);
  await until(page, (before) => supple.model.frame.text.step > before + 3, now);
}

/** While the page has not drawn the first frame, no time passes. */
async function waitsForTheFirstFrame(stage) {
  const program = await stage.program(join(scenes, "cloth_over_ball.toml"));
  const page = await stage.page();
  // Without frames of animation, on which `until` would wait.
  const wait = (condition) => page.waitForFunction(condition, null, { polling: 20 });
  await page.addInitScript(() => {
    const request = window.requestAnimationFrame.bind(window);
    let held = [];
    window.requestAnimationFrame = (turn) => (held ? held.push(turn) : request(turn));
    window.release = () => {
      const turns = held;
      held = null;
      for (const turn of turns) request(turn);
    };
    window.steps = [];
  });
  await page.goto(program.address);
  await wait(() => window.supple?.status.state === "connected");
  await page.evaluate(() => {
    supple.model.on("frame", ({ text }) => steps.push(text.step));
    // What `giveCredit` of a page that draws does: so the first frame comes, but is not drawn.
    supple.client.giveCredit();
  });
  await wait(() => steps.length > 0);
  const asks = await page.evaluate(async () => {
    const before = performance.now();
    let count = 0;
    while (performance.now() < before + 300) {  // 30 steps, if time passed
      await supple.client.ask({ do: "read", object: 0 });
      count += 1;
    }
    return count;
  });
  assert.ok(asks > 0);
  assert.deepEqual(await page.evaluate(() => steps), [0]);
  await page.evaluate(() => release());
  await until(page, () => steps.length > 5);
  assert.equal(await page.evaluate(() => steps[1]), 1, "steps before the first frame was drawn");
}

async function integratorsChange(stage) {
  const { page } = await stage.view(join(scenes, "soft_block.toml"));
  await page.getByRole("tab", { name: "Settings" }).click();
  await page.locator(".setting", { has: page.getByLabel("Integrator") }).getByText("restarts").first().waitFor();
  const other = await page.evaluate(() => (supple.model.scene.integrator === "verlet" ? "symplectic_euler" : "verlet"));
  await page.getByLabel("Integrator").selectOption(other);
  await until(page, (wanted) => supple.model.scene.integrator === wanted && supple.model.frame?.text.step > 0, other);
}

async function continuousContactsAreListed(stage) {
  const { page } = await stage.view(nine, "--contacts", "continuous");
  await until(page, () => supple.model.frame.impacts.length > 0);
  await pause(page);
  await page.getByRole("checkbox", { name: "Contact normals" }).check();
  await settled(page);
  const impacts = await page.evaluate(() => supple.model.frame.impacts.length / 8);
  assert.equal((await counts(page)).points, impacts);
  assert.equal((await counts(page)).normals, impacts);
  await page.getByRole("tab", { name: "Contacts" }).click();
  const grid = page.getByRole("treegrid", { name: "Contacts" });
  await grid.getByText(/^hit at/).first().waitFor();
  await grid.locator('[aria-rowindex="1"]').click();
  await grid.locator('[aria-rowindex="2"]').click();
  await until(page, () => supple.model.contact !== null);
}

async function plotsFollow(stage) {
  const { page } = await stage.view(nine);
  await page.getByRole("tab", { name: "Plots" }).click();
  await until(page, () => supple.model.history.frames.length > 20);
  assert.equal(await page.locator("figure canvas").count(), 3);
  const rows = await page.evaluate(() => supple.model.history.column("contacts").at(-1));
  assert.ok(Number.isFinite(rows));
  for (const figure of await page.locator("figure:has(canvas)").all()) {
    const markers = figure.locator(".u-marker");
    const colours = await markers.evaluateAll((all) => all.map((marker) => getComputedStyle(marker).borderColor));
    assert.ok(colours.length > 0 && new Set(colours).size === colours.length, `two lines have one colour: ${colours.join("; ")}`);
  }
}

/** Also steps without a frame: the simulation is faster than the page. */
async function plotsHoldEveryStep(stage) {
  const { page } = await stage.view(nine);
  await page.getByRole("tab", { name: "Plots" }).click();
  await page.getByRole("combobox", { name: "Speed" }).selectOption("0");
  await until(page, () => supple.model.frame.text.step > 300);
  await page.getByText(/^\d+ fps · [\d.e+-]+× real time$/).waitFor();
  await pause(page);
  const { frames, times, step: last, seen, contacts, now } = await page.evaluate(() => ({
    frames: supple.model.history.frames, times: supple.model.history.column("time"), step: supple.model.frame.text.step, seen: supple.model.framesSeen,
    contacts: supple.model.history.column("contacts").at(-1), now: supple.model.frame.contacts.length / 8,
  }));
  assert.ok(seen < last, "each step had a frame, so this test shows nothing");
  assert.deepEqual(frames, Array.from({ length: last + 1 }, (_, i) => i));
  times.forEach((time, i) => assert.ok(Math.abs(time - 0.02 * i) < 1e-9));
  assert.equal(contacts, now);
  // The steps survive a reload.
  await page.reload();
  await until(page, () => supple.model.frame !== null);
  assert.deepEqual(await page.evaluate(() => supple.model.history.frames), frames);
}

export const tests = [
  ["moves, pauses and steps", movesPausesAndSteps],
  ["resets with a seed, at another speed", resetsWithASeedAndSpeed],
  ["each layer shows", eachLayerShows],
  ["proximity pairs and depths show", proximityAndDepthsShow],
  ["curves show and are listed", curvesShow],
  ["layers show what the session counts", countsAreTheSessions],
  ["octrees by level, of one object", octreeLevels],
  ["the narrow phase by level", narrowPhaseByLevel],
  ["oriented boxes and k-DOPs", otherVolumes],
  ["events of both phases are counted", eventsAreCounted],
  ["objects are hidden and coloured", hidesAndColoursObjects],
  ["a triangle is picked and read", picksATriangle],
  ["the contact table flies to contacts", contactTableFlies],
  ["a contact point is picked", contactPointsArePicked],
  ["two picked triangles: why no contact", saysWhyThereIsNoContact],
  ["two named triangles: a contact, and one that is not there", saysThatAContactIsOne],
  ["pulling a vertex makes contacts", pullingMakesContacts],
  ["a soft body is pulled", pullsASoftBody],
  ["a static object says that it does not bend", staticObjectsAreNotPulled],
  ["settings keep the state, or say that they restart", settingsKeepTheStateOrSayThatTheyRestart],
  ["another bounding volume shows", boundingVolumesShow],
  ["wrong values are refused at the field", wrongValuesAreRefused],
  ["waits until the first frame is drawn", waitsForTheFirstFrame],
  ["integrators change", integratorsChange],
  ["continuous contacts", continuousContactsAreListed],
  ["plots follow", plotsFollow],
  ["plots hold every step", plotsHoldEveryStep],
];
