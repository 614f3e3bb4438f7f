// Looking inside: a slice with caps, one object alone, another point to turn around, values below the pointer, several views.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { camera, coloursAt, coloursIn, goesOn, groundPlace, hasFrame, pause, picture, placesOf, scenes, seenTriangle, settled, simulateTo, TWO_BALLS, until } from "./tools/harness.mjs";

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

const nine = join(scenes, "nine.toml");
const tooltip = (page) => page.getByRole("tooltip");
const row = (page, name) => tooltip(page).locator(`dt:text-is("${name}") + dd`).textContent();

async function surfaceShowsItsValues(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  await settled(page);
  const seen = await seenTriangle(page, 0);
  await page.mouse.move(seen.x, seen.y);
  await tooltip(page).waitFor();
  assert.equal(await tooltip(page).locator("strong").textContent(), "left");
  assert.equal(await row(page, "triangle"), String(seen.triangle));
  const corners = await page.evaluate(({ object, triangle }) => [...supple.model.objects[object].corners.subarray(3 * triangle, 3 * triangle + 3)].map(String), seen);
  assert.ok(corners.includes(await row(page, "vertex")));
  const middle = await page.evaluate(({ object, triangle }) => supple.centroid(object, triangle).map((x, i) => x + supple.model.scene.center[i]), seen);
  (await row(page, "at")).split(", ").map(Number).forEach((x, i) => assert.ok(Math.abs(x - middle[i]) < 0.05, `${x} is not near ${middle[i]}`));
  const box = await tooltip(page).boundingBox();
  assert.ok(box.x > seen.x && box.y > seen.y, "it covers what it describes");
  const ground = await groundPlace(page);
  await page.mouse.move(ground.x, ground.y);
  await tooltip(page).waitFor({ state: "hidden" });

  await page.getByRole("checkbox", { name: "Values at pointer" }).uncheck();
  await page.mouse.move(seen.x, seen.y);
  await goesOn(page);
  assert.equal(await tooltip(page).isVisible(), false);
}

/** Gaps, depths and contacts are found before the surface that they are on. */
async function marksShowTheirValues(stage) {
  const ball = (name, x) => `[[object]]\nname = "${name}"\nmodel = "icosphere"\nfrequency = 6\ntranslate = [${x}, 0, 0]\nmargin = 0.05\nsolid = true\n`;
  const { page } = await stage.view(stage.file("balls.toml", `[scene]\ncontacts = "proximity,penetration"\n${ball("one", 0)}${ball("two", 1.9)}${ball("three", 3.95)}`));
  await until(page, () => supple.model.frame.lists.proximity_pairs.count > 2 && supple.model.frame.lists.penetrations.count > 1);
  await page.getByRole("combobox", { name: "Axis view" }).selectOption("front");
  await settled(page);
  const rests = async (kind, list, column) => {
    const at = await page.evaluate(([list, column]) => supple.project([...supple.model.frame.lists[list].columns[column].subarray(0, 3)]), [list, column]);
    const ground = await groundPlace(page);
    await page.mouse.move(ground.x, ground.y);
    await page.mouse.move(at.x, at.y);
    await until(page, (kind) => document.querySelector(".hover:not([hidden])")?.textContent.includes(kind), kind);
  };
  for (const label of ["Depths", "Curves", "Contact points"]) await page.getByRole("checkbox", { name: label }).uncheck();
  await rests("near", "proximity_pairs", "point_a");
  const gaps = await page.evaluate(() => [...supple.model.frame.lists.proximity_pairs.columns.distance]);
  const gap = Number(await row(page, "gap (length)"));
  assert.ok(gaps.some((value) => Math.abs(value - gap) < 1e-4 * value), `${gap} is not a gap`);
  await page.getByRole("checkbox", { name: "Proximity pairs" }).uncheck();
  await page.getByRole("checkbox", { name: "Depths" }).check();
  await rests("vertex inside", "penetrations", "point");
  const depths = await page.evaluate(() => [...supple.model.frame.lists.penetrations.columns.depth]);
  const depth = Number(await row(page, "depth (length)"));
  assert.ok(depths.some((value) => Math.abs(value - depth) < 1e-4 * value), `${depth} is not a depth`);
  await page.getByRole("checkbox", { name: "Depths" }).uncheck();
  await page.getByRole("checkbox", { name: "Contact points" }).check();
  await rests("Contact: ", "contact_points", "position");
  const length = Math.hypot(...(await row(page, "normal")).split(", ").map(Number));
  assert.ok(Math.abs(length - 1) < 0.01);
  assert.match(await row(page, "one"), /^triangle \d+$/);
}

/** The value of the shown field is that of the session, at the vertex, the triangle or the mark. */
async function fieldIsShown(stage) {
  const ball = (name, x, more) => `[[object]]\nname = "${name}"\nmodel = "icosphere"\nfrequency = 4\ntranslate = [${x}, 0, 0]\nmargin = 0.3\nsolid = true\n${more}`;
  const sways = 'motion = { kind = "sway", amplitude = 0.2, wavelength = 1.5, period = 1 }\n';
  const { page } = await stage.view(stage.file("balls.toml", `[scene]\ncontacts = "proximity,penetration"\ntime_step = 0.01\n${ball("one", 0, sways)}${ball("two", 1.9, "")}${ball("three", 4.1, "")}`));
  await simulateTo(page, 5);
  for (const label of ["Depths", "Curves", "Contact points", "Proximity pairs"]) await page.getByRole("checkbox", { name: label }).uncheck();
  const choose = (label) => page.getByRole("combobox", { name: "Field", exact: true }).selectOption({ label });
  const isEqual = (text, value, what) => assert.ok(Math.abs(Number(text) - value) <= 1e-4 * Math.abs(value), `${what}: ${text} is not ${value}`);
  for (const [label, unit, kind] of [["Speed", " (length/s)", "vertex"], ["Strain", "", "triangle"], ["Distance to other objects", " (length)", "vertex"], ["Velocity", ", length of the vector (length/s)", "vertex"]]) {
    await choose(label);
    await settled(page);
    const seen = await seenTriangle(page, 0);
    await page.mouse.move(seen.x, 130);
    await page.mouse.move(seen.x, seen.y);
    await tooltip(page).locator(`dt:text-is("${label}${unit}")`).waitFor();
    const about = { do: "read", object: 0, [kind]: Number(await row(page, kind)) };
    const exact = (await page.evaluate((about) => supple.client.ask(about), about)).field[label];
    isEqual(await row(page, `${label}${unit}`), Array.isArray(exact) ? Math.hypot(...exact) : exact, label);
    if (Array.isArray(exact)) (await row(page, label)).split(", ").forEach((x, axis) => assert.ok(Math.abs(Number(x) - exact[axis]) < 1e-3 * Math.hypot(...exact)));
  }
  await choose("Depth");
  await settled(page);
  const outside = await page.evaluate(() => {
    const { positions, vertices } = supple.model.objects[2];
    return [0, 1, 2].map((axis) => Array.from({ length: vertices }, (_, i) => positions[3 * i + axis]).reduce((sum, x) => sum + x, 0) / vertices);
  });
  const at = await page.evaluate((point) => supple.project(point), outside);
  await page.mouse.move(at.x, at.y);
  await tooltip(page).getByText("no value").waitFor();

  await choose("Gap");  // the dots of the field are marks, too, without the layer of pairs
  await settled(page);
  const { point, gaps } = await page.evaluate(() => {
    const { point_a, distance } = supple.model.frame.lists.proximity_pairs.columns;
    return { point: [...point_a.subarray(0, 3)], gaps: [...distance] };
  });
  const dot = await page.evaluate((point) => supple.project(point), point);
  await page.mouse.move(dot.x, 130);
  await page.mouse.move(dot.x, dot.y);
  await tooltip(page).getByText("near").waitFor();
  const shown = Number(await row(page, "gap (length)"));
  assert.ok(gaps.some((gap) => Math.abs(gap - shown) < 1e-4 * gap), `${shown} is no gap`);
}

/** A finger that stays shows the values; they stay until the next touch. */
async function longPressShowsValues(stage) {
  const program = await stage.program(stage.file("balls.toml", TWO_BALLS));
  const page = await stage.page({ viewport: { width: 390, height: 800 }, hasTouch: true });
  await page.goto(program.address);
  await hasFrame(page);
  await settled(page);
  const { x, y } = await seenTriangle(page, 1);
  const client = await page.context().newCDPSession(page);
  const touch = (type, points) => client.send("Input.dispatchTouchEvent", { type, touchPoints: points });
  await touch("touchStart", [{ x, y }]);
  await tooltip(page).getByText("right", { exact: true }).waitFor();
  await touch("touchEnd", []);
  await goesOn(page);
  assert.ok(await tooltip(page).isVisible());
  const box = await tooltip(page).boundingBox();
  assert.ok(box.x >= 0 && box.x + box.width <= 390, "it leaves the window");
  await page.touchscreen.tap(x, 60 + (await page.locator("canvas.view").boundingBox()).y);
  await tooltip(page).waitFor({ state: "hidden" });
}

const cameras = (page) => page.evaluate(() => supple.cameras());
const box = (page) => page.locator("canvas.view").boundingBox();
/** The middle of a quarter of the canvas. */
const quarter = ({ x, y, width, height }, i) => ({ x: x + width * (i % 2 ? 0.75 : 0.25), y: y + height * (i > 1 ? 0.75 : 0.25) });

async function viewsHaveTheirCameras(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  await settled(page);
  const one = await camera(page);
  const more = page.getByRole("button", { name: "One, two or four views" });
  await more.click();
  assert.equal((await cameras(page)).length, 2);
  await more.click();
  await settled(page);
  const before = await cameras(page);
  assert.equal(before.length, 4);
  assert.deepEqual(before[0].position, one.position);
  assert.deepEqual(before.map(({ orthographic }) => orthographic), [false, true, true, true]);
  const along = before.slice(1).map(({ position, target }) => position.map((x, axis) => Math.round((x - target[axis]) / Math.hypot(...position.map((p, i) => p - target[i])))));
  assert.deepEqual(along, [[0, 0, 1], [1, 0, 0], [0, 1, 0]]);

  // Each view takes the pointer: its camera alone moves, and it becomes the active one.
  const canvas = await box(page);
  for (const i of [1, 2, 3]) {
    const at = quarter(canvas, i);
    await page.mouse.move(at.x + 60, at.y + 60);
    await page.mouse.down();
    await page.mouse.move(at.x + 100, at.y + 70, { steps: 4 });
    await page.mouse.up();
    const now = await cameras(page);
    assert.notDeepEqual(now[i].position, before[i].position, `view ${i} does not turn`);
    before[i] = now[i];
    assert.deepEqual(now, before, `others turn with view ${i}`);
  }
  assert.equal(await page.getByRole("img", { name: "3D view, 4 of 4 is active" }).count(), 1);
  await page.keyboard.press("z");
  assert.equal(await page.getByRole("img", { name: "3D view, 1 of 4 is active" }).count(), 1);
  await page.keyboard.press("z");
  await page.keyboard.press("o");
  await page.keyboard.press("2");
  const now = await cameras(page);
  assert.deepEqual([now[0], now[2], now[3]], [before[0], before[2], before[3]]);
  assert.equal(now[1].orthographic, false);
  assert.ok(now[1].position[2] < now[1].target[2], "it looks from the back");

  // The wheel zooms where it is.
  const at = quarter(canvas, 2);
  await page.mouse.move(at.x, at.y);
  await page.mouse.wheel(0, -400);
  await until(page, (zoom) => supple.cameras()[2].zoom > 1.05 * zoom, now[2].zoom);

  const kept = await cameras(page);
  await page.reload();
  await hasFrame(page);
  await settled(page);
  const restored = await cameras(page);
  assert.equal(restored.length, 4);
  restored.forEach(({ position }, i) => position.forEach((x, axis) => assert.ok(Math.abs(x - kept[i].position[axis]) < 1e-5, `camera ${i} is at ${position}, not ${kept[i].position}`)));
}

/** Objects are picked, and the view turns around a point, where they are in each view. */
async function viewsArePicked(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  await settled(page);
  for (let i = 0; i < 2; ++i) await page.keyboard.press("q");
  await settled(page);
  for (let i = 0; i < 4; ++i) {
    // The middle of a ball; from the right, the left one is hidden.
    const seen = await page.evaluate((object) => {
      const { positions } = supple.model.objects[object];
      const middle = [0, 1, 2].map((axis) => positions.filter((_, k) => k % 3 === axis).reduce((sum, x) => sum + x, 0) / (positions.length / 3));
      const { x, y } = supple.project(middle);
      const at = { x: Math.round(x), y: Math.round(y) };
      return { ...at, ...supple.pickAt(at.x, at.y) };
    }, i === 2 ? 1 : 0);
    assert.equal(seen.object, i === 2 ? 1 : 0);
    const area = await page.locator(".panes > div").boundingBox();
    assert.ok(seen.x > area.x && seen.x < area.x + area.width && seen.y > area.y && seen.y < area.y + area.height, `${seen.x}, ${seen.y} is not in view ${i}`);
    await page.mouse.click(seen.x, seen.y);
    assert.deepEqual(await page.evaluate(() => [supple.model.selection.object, supple.model.selection.triangle]), [seen.object, seen.triangle]);
    await page.mouse.dblclick(seen.x, seen.y);
    const { target } = await camera(page);
    assert.ok(Math.hypot(...target.map((x, axis) => x - seen.point[axis])) < 1e-5, `view ${i} turns around ${target}, not ${seen.point}`);
    await page.keyboard.press("z");
  }
  // All views show the selection, and the picture has lines between them.
  await settled(page);
  const before = await picture(page);
  await page.keyboard.press("Escape");
  await settled(page);
  assert.notEqual(await picture(page), before);
}

/** The slice and the objects of one view change nothing in the other. They survive a reload. */
async function viewsHaveTheirSliceAndObjects(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  for (const label of ["Smooth", "Occlusion"]) await page.getByRole("checkbox", { name: label }).uncheck();
  await settled(page);
  await page.keyboard.press("q");  // two views: both see both balls
  await settled(page);
  const middles = await page.evaluate(() => supple.model.objects.map(({ positions }) => [0, 1, 2].map((axis) => positions.filter((_, i) => i % 3 === axis).reduce((sum, x) => sum + x, 0) / (positions.length / 3))));
  /** The colours of both balls in the active view. */
  const balls = () => coloursAt(page, middles);
  const isActive = (number) => page.getByRole("img", { name: `3D view, ${number} of 2 is active` }).waitFor();
  const first = await balls();
  const placesInFirst = await placesOf(page, middles);
  await page.keyboard.press("z");
  await isActive(2);
  await settled(page);
  const second = await balls();

  // From the front, a slice in z through the middle shows caps.
  await slice(page).selectOption("z");
  await settled(page);
  const cut = await balls();
  assert.ok(cut.every((colour, i) => colour.join() !== second[i].join()), "caps have another colour");
  await page.getByRole("checkbox", { name: "Show left" }).uncheck();
  await settled(page);
  const alone = await balls();
  assert.notDeepEqual(alone[0], cut[0]);
  assert.deepEqual(alone[1], cut[1]);
  assert.deepEqual(await coloursIn(page, placesInFirst), first, "the first view, which is not active, shows what it showed");
  const pickedIn = () => page.evaluate((middles) => middles.map((middle) => {
    const { x, y } = supple.project(middle);
    return supple.pickAt(x, y)?.object ?? null;
  }), middles);
  assert.deepEqual(await pickedIn(), [null, 1], "what is hidden or cut off is not picked");

  await page.keyboard.press("z");
  await isActive(1);
  await settled(page);
  assert.deepEqual(await balls(), first, "the first view shows what it showed");
  assert.deepEqual(await pickedIn(), [0, 1]);
  assert.equal(await slice(page).inputValue(), "off", "the panel is that of the active view");
  assert.ok(await page.getByRole("checkbox", { name: "Show left" }).isChecked());
  await page.getByRole("checkbox", { name: "Show right" }).uncheck();
  await settled(page);
  assert.deepEqual((await balls())[0], first[0]);

  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save view" }).click()]);
  const path = stage.file("view.json");
  await download.saveAs(path);
  const { marks, objects, views } = JSON.parse(readFileSync(path, "utf8"));
  assert.deepEqual([marks.slice, objects.right.visible, objects.left], ["off", false, undefined]);
  assert.deepEqual([views.slices, views.hidden], [{ second: { axis: "z", at: 0.5, flipped: false } }, { second: { left: true } }]);
  await page.reload();
  await hasFrame(page);
  await settled(page);
  await page.keyboard.press("z");
  await isActive(2);
  await settled(page);
  assert.deepEqual(await balls(), alone);

  // A file of earlier versions has one slice for all views.
  await page.getByLabel("View file", { exact: true }).and(page.locator("input")).setInputFiles({ name: "old.json", mimeType: "application/json", buffer: Buffer.from('{"version": 1, "marks": {"slice": "x"}, "objects": {}, "views": {"layout": "two"}}') });
  await until(page, () => supple.model.slice.axis === "x");
  assert.deepEqual(await page.evaluate(() => [supple.model.slices[1].axis, ...supple.model.objects.flatMap(({ visibleIn }) => visibleIn.slice(0, 2))]), ["x", true, true, true, true]);
}

/** Positions go to the graphics card once, however many views show them. */
async function viewsShareTheirData(stage) {
  const { page } = await stage.view(nine);
  await simulateTo(page, 20);
  const drawn = () => page.evaluate(() => {
    let bytes = 0;
    const { bufferSubData } = WebGL2RenderingContext.prototype;
    WebGL2RenderingContext.prototype.bufferSubData = function (target, offset, data, from, length) {
      bytes += 4 * (length ?? data.length);
      return bufferSubData.apply(this, arguments);
    };
    supple.touch();
    supple.draw();
    WebGL2RenderingContext.prototype.bufferSubData = bufferSubData;
    return { bytes, calls: supple.drawn().calls };
  });
  for (const label of ["Contact points", "Contact segments", "Intersecting triangles"]) await page.getByRole("checkbox", { name: label }).uncheck();
  await settled(page);
  await drawn();
  const one = await drawn();
  for (let i = 0; i < 2; ++i) await page.keyboard.press("q");
  await settled(page);
  const four = await drawn();
  assert.ok(one.bytes > 10_000, `${one.bytes} bytes are uploaded`);
  assert.equal(four.bytes, one.bytes);
  assert.ok(four.calls > 3 * one.calls, `${four.calls} calls`);
}

/** Below each other where the window is narrow. Each view shows the scene. */
async function viewsInANarrowWindow(stage) {
  const program = await stage.program(stage.file("balls.toml", TWO_BALLS));
  for (const [width, height] of [[390, 800], [800, 600]]) {
    const page = await stage.page({ viewport: { width, height }, hasTouch: true, colorScheme: "light" });
    await page.goto(program.address);
    await hasFrame(page);
    await page.getByRole("button", { name: "One, two or four views" }).tap();
    await page.getByRole("img", { name: "3D view, 1 of 2 is active" }).waitFor();
    await settled(page);
    const canvas = await box(page);
    const isStacked = canvas.height > canvas.width;
    const second = isStacked ? { x: canvas.x + canvas.width / 2, y: canvas.y + 0.75 * canvas.height } : { x: canvas.x + 0.75 * canvas.width, y: canvas.y + canvas.height / 2 };
    await page.touchscreen.tap(second.x, second.y);
    await page.getByRole("img", { name: "3D view, 2 of 2 is active" }).waitFor();
    const seen = await seenTriangle(page, 0);
    await page.touchscreen.tap(seen.x, seen.y);
    await until(page, () => supple.model.selection?.object === 0);
    await page.close();
  }
}

export const tests = [
  ["a slice has caps", sliceHasCaps],
  ["one object alone", oneObjectAlone],
  ["a double click sets the pivot", doubleClickSetsThePivot],
  ["a resting pointer shows the values of a surface", surfaceShowsItsValues],
  ["a resting pointer shows gap, depth and normal of marks", marksShowTheirValues],
  ["the resting pointer shows the value of the field", fieldIsShown],
  ["a long press shows values", longPressShowsValues],
  ["several views have their cameras", viewsHaveTheirCameras],
  ["several views are picked", viewsArePicked],
  ["several views have their slices and objects", viewsHaveTheirSliceAndObjects],
  ["several views share their data", viewsShareTheirData],
  ["several views in narrow windows", viewsInANarrowWindow],
];
