// The layers of a simulation: what they draw, and how many.
import assert from "node:assert/strict";
import { join } from "node:path";
import { camera, counts, picture, scenes, settled, simulateTo, TWO_BALLS, until } from "./tools/harness.mjs";

const nine = join(scenes, "nine.toml");
/** Many pairs touch then. */
const CROWDED = 60;

/** Each layer with content changes the picture, and draws as many elements as the session reports. */
async function eachLayerShows(stage) {
  const { page } = await stage.view(nine, "--broad-phase", "octree");
  await simulateTo(page, CROWDED);
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
  await until(page, () => supple.model.frame.lists.proximity_pairs.count > 2 && supple.model.frame.lists.penetrations.count > 1);
  await settled(page);
  const { drawn, pairs, depths } = await page.evaluate(() => ({
    drawn: supple.counts(), pairs: supple.model.frame.lists.proximity_pairs.count, depths: supple.model.frame.lists.penetrations.count,
  }));
  assert.equal(drawn.proximity, pairs);
  assert.equal(drawn.depths, depths);
  const rows = page.getByRole("treegrid", { name: "Contacts" }).getByRole("row");
  await rows.nth(1).waitFor();
  assert.equal(await rows.count(), 2);
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
  await until(page, () => supple.model.frame.lists.curves.count > 0);
  await settled(page);
  const { drawn, frame } = await page.evaluate(() => {
    const { curves, enclosed_vertices } = supple.model.frame.lists;
    const { area, centroid, depth, enclosed_count_a: a, enclosed_count_b: b } = curves.columns;
    const last = { area: Math.hypot(...area.subarray(3, 6)), depth: depth[1], at: [...centroid.subarray(3, 6)], enclosed: `${a[1]} + ${b[1]}` };
    return { drawn: supple.counts(), frame: { curves: curves.count, enclosed: enclosed_vertices.count, last } };
  });
  assert.equal(drawn.curves, 2);
  assert.equal(frame.curves, 2);
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
  const expected = ["at 1.9", "at 3.6", rounded(frame.last.area), rounded(frame.last.depth), frame.last.enclosed];
  assert.deepEqual(await rows.nth(1).getByRole("gridcell").allTextContents(), expected);
  await rows.nth(1).click();
  await settled(page);
  const { target } = await camera(page);
  frame.last.at.forEach((x, axis) => assert.ok(Math.abs(target[axis] - x) < 1e-3, `${target} is not at ${frame.last.at}`));
  assert.equal(await rows.nth(1).getAttribute("aria-selected"), "true");
}

async function countsAreTheSessions(stage) {
  const { page } = await stage.view(nine);
  await simulateTo(page, CROWDED);
  for (const label of ["Object pairs", "Candidate pairs", "Colliding vertices"]) await page.getByRole("checkbox", { name: label }).check();
  await until(page, () => supple.counts().candidates > 0 && supple.counts().vertices > 0);
  await settled(page);
  const { drawn, frame, statistics } = await page.evaluate(() => ({
    drawn: supple.counts(),
    frame: { contacts: supple.model.frame.lists.contacts.count, points: supple.model.frame.lists.contact_points.count, pairs: supple.model.frame.lists.object_pairs.count },
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
    else await until(page, ([edges, leaves]) => supple.counts().edges > edges && supple.counts().edges < leaves, [2 * edgesOfBox, drawn.edges]);
  }
}

async function boundingVolumesShow(stage) {
  const { page } = await stage.view(nine);
  await page.getByRole("checkbox", { name: "Object octrees" }).check();
  await until(page, () => supple.counts().boxes > 0);
  await page.getByRole("tab", { name: "Settings" }).click();
  await page.getByLabel("Bounding volume").selectOption("sphere");
  await until(page, () => supple.model.scene.bounding_volume === "sphere" && supple.counts().balls > 0 && supple.counts().boxes === 0);
  await page.getByLabel("Contacts", { exact: true }).and(page.locator("select")).selectOption("continuous");
  await until(page, () => supple.model.frame?.lists.continuous_contacts.count > 0);
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

export const tests = [
  ["each layer shows", eachLayerShows],
  ["proximity pairs and depths show", proximityAndDepthsShow],
  ["curves show and are listed", curvesShow],
  ["layers show what the session counts", countsAreTheSessions],
  ["octrees by level, of one object", octreeLevels],
  ["the narrow phase by level", narrowPhaseByLevel],
  ["oriented boxes and k-DOPs", otherVolumes],
  ["another bounding volume shows", boundingVolumesShow],
  ["objects are hidden and coloured", hidesAndColoursObjects],
];
