// Fields: numbers and vectors as colours and arrows, with a colour bar.
import assert from "node:assert/strict";
import { atStep, coloursAt, counts, isAt, picture, seenTriangle, settled, steps, until } from "./tools/harness.mjs";

/** A cube that moves 5 in a second, and a ball at rest. Tests begin at step 0: soon the cube is out of sight. */
const MOVING_CUBE = `
[scene]
time_step = 0.1
contacts = "proximity"
[[object]]
name = "cube"
model = "box"
motion = { kind = "rigid", velocity = [0, 3, 4] }
margin = 9
[[object]]
name = "ball"
model = "icosphere"
frequency = 4
translate = [4, 0, 0]
margin = 9
`;

const SWAYING = `
[[object]]
name = "ball"
model = "icosphere"
frequency = 6
motion = { kind = "sway", amplitude = 0.2, wavelength = 1.5, period = 1 }
`;

const bar = (page) => page.getByRole("img", { name: /^Colour bar/ });
const barText = (page) => bar(page).getAttribute("aria-label");
const choose = (page, name, option) => page.getByRole("combobox", { name, exact: true }).selectOption({ label: option });

const centre = (page, object) => page.evaluate((object) => {
  const { positions } = supple.model.objects[object];
  return [0, 1, 2].map((axis) => {
    const list = positions.filter((_, i) => i % 3 === axis);
    return (Math.min(...list) + Math.max(...list)) / 2;
  });
}, object);

/** A picture's colour near a colour of the map: shading changes it, but not its hue. */
function isNear([r, g, b], [x, y, z], what) {
  const length = Math.hypot(r, g, b) * Math.hypot(x, y, z);
  const alike = (r * x + g * y + b * z) / length;
  assert.ok(alike > 0.97, `${what}: ${[r, g, b]} is not like ${[x, y, z]}`);
}

async function colours(stage) {
  const { page } = await stage.viewAt(0, stage.file("cube.toml", MOVING_CUBE));
  assert.equal(await bar(page).isVisible(), false);
  const { calls } = await page.evaluate(() => (supple.draw(), supple.drawn()));
  await page.getByRole("checkbox", { name: "Proximity pairs" }).uncheck();
  await choose(page, "Field", "Speed");
  await settled(page);
  assert.match(await barText(page), /need the step before/);
  await steps(page, 2);
  assert.equal(await barText(page), "Colour bar: Speed (length/s) from 0 to 5, viridis.");
  const [cube, ball] = await coloursAt(page, [await centre(page, 0), await centre(page, 1)]);
  isNear(cube, [253, 231, 37], "the fastest");
  isNear(ball, [68, 1, 84], "the slowest");
  await choose(page, "Colour map", "magma");
  assert.equal(await barText(page), "Colour bar: Speed (length/s) from 0 to 5, magma.");
  await settled(page);
  isNear((await coloursAt(page, [await centre(page, 0)]))[0], [252, 253, 191], "the fastest in magma");
  const now = await page.evaluate(() => (supple.draw(), supple.drawn()));
  assert.ok(now.calls <= calls, `${now.calls} draw calls instead of ${calls}`);
  // The exact value of the selected vertex.
  const { x, y } = await seenTriangle(page, 0);
  await page.mouse.click(x, y);
  const region = page.getByRole("region", { name: "Selection" });
  await region.getByText("Speed", { exact: true }).waitFor();
  const value = await region.evaluate((list) => [...list.querySelectorAll("dt")].find((each) => each.textContent === "Speed").nextElementSibling.textContent);
  assert.equal(value, "5");
  await choose(page, "Field", "none");
  assert.equal(await bar(page).isVisible(), false);
  await settled(page);
  assert.equal(await page.evaluate(() => supple.model.frame.fieldValues.size), 0);
}

async function ranges(stage) {
  const { page } = await stage.viewAt(0, stage.file("cube.toml", MOVING_CUBE));
  await choose(page, "Field", "Speed");
  await steps(page, 1);
  const [low, high] = ["Lowest", "Highest"].map((end) => page.getByRole("textbox", { name: `${end} value` }));
  assert.equal(await low.isVisible(), false);
  const before = await picture(page);
  await page.getByRole("checkbox", { name: "Lock range" }).check();
  assert.deepEqual([await low.inputValue(), Number((await high.inputValue()).slice(0, 6))], ["0", 5]);
  await low.fill("-5");
  await low.press("Enter");
  await high.fill("10");
  await high.press("Enter");
  assert.equal(await barText(page), "Colour bar: Speed (length/s) from -5 to 10, viridis.");
  await settled(page);
  assert.notEqual(await picture(page), before);
  for (const [text, reason] of [["-5", /The lowest value must be below the highest\. The range stays -5 to 10\./], ["many", /Both ends must be numbers/], ["", /Both ends must be numbers/]]) {
    await high.fill(text);
    await high.press("Enter");
    await page.getByRole("alert").filter({ hasText: reason }).waitFor();
    assert.match(await barText(page), /from -5 to 10/);
  }
  await high.press("Escape");
  assert.equal(await high.inputValue(), "10");
  await choose(page, "Colour map", "cividis");
  await steps(page, 1);
  assert.match(await barText(page), /from -5 to 10/, "a step changes no locked range");
  await page.reload();
  await until(page, () => window.supple?.model.frame?.text.field === "speed");
  assert.equal(await barText(page), "Colour bar: Speed (length/s) from -5 to 10, cividis.");
  await page.getByRole("checkbox", { name: "Lock range" }).uncheck();
  await steps(page, 1);
  assert.match(await barText(page), /from 0 to 5/);
}

/** Each triangle has the colour of its own value. */
async function faces(stage) {
  const { page } = await stage.viewAt(0, stage.file("sway.toml", SWAYING));
  const { calls } = await page.evaluate(() => (supple.draw(), supple.drawn()));
  await choose(page, "Field", "Strain");
  await choose(page, "Colour map", "coolwarm (0 in the middle)");
  await steps(page, 7);
  const { lowest, highest } = await page.evaluate(() => {
    const values = [...supple.model.frame.fieldValues.get(0)];
    return { lowest: Math.min(...values), highest: Math.max(...values) };
  });
  const [, from, to] = /from (\S+) to (\S+), coolwarm/.exec(await barText(page)).map(Number);
  const most = Math.max(-lowest, highest);
  assert.ok(most > 0.01 && Math.abs(to - most) < 0.02 * most && from === -to, `${from} ${to} instead of ${most}`);
  await settled(page);
  const [value, middle] = await page.evaluate(() => {
    const { x, y } = supple.project([0, 0, 0]);
    const { triangle } = supple.pickAt(x, y);
    return [supple.model.frame.fieldValues.get(0)[triangle], supple.centroid(0, triangle)];
  });
  const [colour] = await coloursAt(page, [middle]);
  assert.equal(colour[0] > colour[2], value > 0, `${value} is drawn as ${colour}`);
  assert.ok((await page.evaluate(() => (supple.draw(), supple.drawn()))).calls <= calls);
}

async function arrowsAndDots(stage) {
  const { page } = await stage.viewAt(0, stage.file("cube.toml", MOVING_CUBE));
  await choose(page, "Field", "Velocity");
  assert.equal(await page.getByRole("slider", { name: "Length of the longest arrow" }).isVisible(), true);
  await steps(page, 1);
  assert.equal((await counts(page)).fieldArrows, 8, "the corners of the cube; the ball rests");
  assert.match(await barText(page), /Velocity, length of the vector \(length\/s\) from 0 to 5/);
  const long = await picture(page);
  await page.getByRole("slider", { name: "Length of the longest arrow" }).fill("100");
  await settled(page);
  assert.notEqual(await picture(page), long);
  await choose(page, "Field", "Gap");
  await settled(page);
  assert.equal(await page.getByRole("slider", { name: "Length of the longest arrow" }).isVisible(), false);
  const gaps = await page.evaluate(() => [...supple.model.frame.lists.proximity_pairs.columns.distance]);
  assert.deepEqual([(await counts(page)).fieldArrows, (await counts(page)).fieldDots], [0, gaps.length]);
  const to = Number(/to (\S+), viridis/.exec(await barText(page))[1]);
  assert.ok(gaps.length > 0 && Math.abs(to - Math.max(...gaps)) < 0.01 * to);
}

/** The panel and the bar in small windows, both themes and a large font. */
async function everywhere(stage) {
  const program = await stage.program(stage.file("cube.toml", MOVING_CUBE));
  for (const [width, height, colorScheme, font] of [[1440, 900, "light", 100], [390, 800, "dark", 100], [390, 800, "light", 200]]) {
    const page = await stage.page({ viewport: { width, height }, colorScheme });
    await page.goto(atStep(program.address, 0));
    await isAt(page, 0);
    await page.addStyleTag({ content: `html { font-size: ${font}% }` });
    if (width < 960) await page.getByRole("button", { name: "Scene", exact: true }).click();
    await choose(page, "Field", "Displacement");
    await page.getByRole("checkbox", { name: "Lock range" }).check();
    const field = await page.getByRole("textbox", { name: "Highest value" }).boundingBox();
    assert.ok(field.x >= 0 && field.x + field.width <= width && field.width > 30, `the field is at ${JSON.stringify(field)}`);
    if (width < 960) await page.getByRole("button", { name: "Close Scene" }).click();
    await bar(page).waitFor();
    const box = await bar(page).boundingBox();
    assert.ok(box.x >= 0 && box.x + box.width <= width && box.width > 200, `the bar is at ${JSON.stringify(box)}`);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth), 0);
    await page.close();
  }
}

export const tests = [
  ["a field gives colours and numbers", colours],
  ["a range is locked, refused and stored", ranges],
  ["a field of triangles has a colour for each", faces],
  ["vectors are arrows and contacts are dots", arrowsAndDots],
  ["the panel and the bar fit everywhere", everywhere],
];
