// The world around the objects: floor, shadow, border, axes; shading, x-ray and the upward axis.
import assert from "node:assert/strict";
import { join } from "node:path";
import { camera, coloursAt, hasFrame, pause, picture, scenes, settled, swayingBalls, until } from "./tools/harness.mjs";

const ball = (more = "") => `[[object]]\nname = "ball"\nmodel = "icosphere"\nfrequency = 4\n${more}\n`;
const box = (page, name) => page.getByRole("group", { name: "View" }).getByRole("checkbox", { name });
const ground = (page) => page.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/\d+/g).slice(0, 3).map(Number));
const brightness = ([red, green, blue]) => red + green + blue;
const isNear = (a, b) => a.every((value, i) => Math.abs(value - b[i]) <= 3);

/** A page that shows a scene, paused unless `plays`. */
async function open(stage, scene, plays = false) {
  const program = await stage.program(stage.file("scene.toml", scene));
  const page = await stage.page({ colorScheme: "light", deviceScaleFactor: 1 });
  await page.goto(program.address);
  await hasFrame(page);
  if (!plays) await pause(page);
  return page;
}

/** The floor has a grid, and the ball a shadow on it. */
async function floorAndShadow(stage) {
  const page = await open(stage, `${ball("scale = 0.5")}${ball("scale = 0.5\ntranslate = [2, 0, 0]")}`);
  await page.getByRole("combobox", { name: "Axis view" }).selectOption("top");
  await page.getByRole("checkbox", { name: "Surfaces" }).uncheck();
  await settled(page);
  const paper = await ground(page);
  const [lower] = await page.evaluate(() => supple.model.scene.bounds);
  const floor = lower[1] - 0.13;
  const [line, beside, bare] = await coloursAt(page, [[-1, floor, -1], [-1.05, floor, -0.93], [-1.05, floor, 0.93]]);
  assert.ok(!isNear(line, paper), `there is no grid: ${line}`);
  assert.ok([beside, bare].some((colour) => isNear(colour, paper)), `between the lines: ${beside}, ${bare}`);
  await page.getByRole("checkbox", { name: "Surfaces" }).check();
  await page.getByRole("combobox", { name: "Axis view" }).selectOption("front");
  for (let i = 0; i < 4; ++i) await page.keyboard.press("Shift+ArrowUp");  // from a little above
  await page.getByRole("checkbox", { name: "Show ball" }).first().waitFor();
  await settled(page);
  const below = [-0.93, floor, 0.07];
  const [shadow] = await coloursAt(page, [below]);
  await page.getByRole("button", { name: "all", exact: true }).click();
  await settled(page);
  const [lit] = await coloursAt(page, [below]);
  assert.ok(brightness(shadow) < brightness(lit) - 20, `the floor is ${shadow} below the ball and ${lit} without it`);
}

/** The far walls of the border are drawn, the near ones are not. */
async function borderIsAGlassBox(stage) {
  const scene = (bounds) => `[scene]\n${bounds}\n${ball("scale = 0.2\nmotion = { kind = \"sway\", amplitude = 0.01, wavelength = 1.5, period = 1 }")}`;
  const page = await open(stage, scene("bounds = [[-1, -1, -1], [1, 1, 1]]"));
  assert.deepEqual(await page.evaluate(() => supple.model.scene.border), [[-1, -1, -1], [1, 1, 1]]);
  await page.getByRole("combobox", { name: "Axis view" }).selectOption("front");
  for (let i = 0; i < 9; ++i) await page.keyboard.press("-");
  await settled(page);
  const paper = await ground(page);
  const [edge, wall, nearEdge] = await coloursAt(page, [[-1, 0.5, -1], [-0.7, 0.5, -1], [1, 0.5, 1]]);
  assert.ok(brightness(edge) < brightness(paper) - 60, `the far edge is ${edge}`);
  assert.ok(!isNear(wall, paper) && brightness(wall) > brightness(edge), `the far wall is ${wall}`);
  assert.ok(isNear(nearEdge, paper), `the near edge is ${nearEdge}`);
  const without = await open(stage, scene(""));
  assert.equal(await without.evaluate(() => supple.model.scene.border), null);
}

/** What moves fills the view, whatever the size of the border and of the static ground. */
async function firstViewShowsWhatMoves(stage) {
  const moving = `motion = { kind = "sway", amplitude = 0.01, wavelength = 1.5, period = 1 }`;
  const page = await open(stage, `[scene]\nbounds = [[-50, -50, -50], [50, 50, 50]]\n${ball(moving)}[[object]]\nmodel = "box"\nscale = 20\ntranslate = [0, -25, 0]\nstatic = true\n`);
  const { high, view } = await page.evaluate(() => {
    const { width, height } = document.querySelector("canvas.view").getBoundingClientRect();
    return { high: supple.project([0, -1, 0].map((x, i) => x - supple.model.scene.center[i])).y - supple.project([0, 1, 0].map((x, i) => x - supple.model.scene.center[i])).y, view: Math.min(width, height) };
  });
  assert.ok(high > 0.2 * view && high < view, `the ball is ${high} of ${view} pixels high`);
  // Objects that drift through a room stay in view, because the whole room is.
  const { page: room } = await stage.view(join(scenes, "table1_3.toml"));
  const outside = await room.evaluate(() => {
    const { left, top, right, bottom } = document.querySelector("canvas.view").getBoundingClientRect();
    const [lower, upper] = supple.model.scene.border;
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [0, 1, 2].map((axis) => ((i >> axis) & 1 ? upper : lower)[axis]));
    return corners.map((corner) => supple.project(corner)).filter(({ x, y }) => !(x > left && x < right && y > top && y < bottom));
  });
  assert.deepEqual(outside, []);
}

/** The number of different colours along a line over the ball. */
const shades = async (page) => {
  const colours = await coloursAt(page, Array.from({ length: 60 }, (_, i) => [-0.6 + 0.02 * i, 0.1, 0]));
  return new Set(colours.map(String)).size;
};

async function smoothOrFlat(stage) {
  const page = await open(stage, ball());
  await page.getByRole("combobox", { name: "Axis view" }).selectOption("front");
  await settled(page);
  const even = await shades(page);
  await box(page, "Smooth").uncheck();
  await settled(page);
  const flat = await shades(page);
  assert.ok(even > 2 * flat, `${even} shades when smooth, ${flat} when flat`);
  await box(page, "Smooth").check();
  await settled(page);
  assert.equal(await shades(page), even);
  // A box keeps its edges: each face has one colour.
  const cube = await open(stage, `[[object]]\nname = "ball"\nmodel = "box"\n`);
  await cube.getByRole("combobox", { name: "Axis view" }).selectOption("front");
  await settled(cube);
  const face = await coloursAt(cube, [[-0.4, 0.3, 0.5], [0, 0, 0.5], [0.4, -0.3, 0.5]]);
  assert.ok(face.every((colour) => isNear(colour, face[0])), `the face of a box is ${face.join("; ")}`);
}

/** Very large surfaces that move are flat, and the page says so. */
async function largeSurfacesAreFlat(stage) {
  const page = await open(stage, swayingBalls(1, 125), true);
  await page.getByText("Flat for now: more than 300,000 triangles move.").waitFor();
  await box(page, "Smooth").uncheck();
  await page.getByText("Flat for now").waitFor({ state: "hidden" });
}

/** The crease between two balls is darker with occlusion, and marks are not. */
async function creasesAreDark(stage) {
  const page = await open(stage, `${ball("translate = [-0.8, 0, 0]")}${ball("translate = [0.8, 0, 0]")}`);
  await page.getByRole("combobox", { name: "Axis view" }).selectOption("front");
  for (const label of ["Intersecting triangles", "Contact points", "Contact segments"]) await page.getByRole("checkbox", { name: label }).uncheck();
  await settled(page);
  assert.equal(await box(page, "Occlusion").isChecked(), false, "it is on without a graphics card");
  const places = [[-0.02, 0, 0.6], [-0.8, 0.3, 0.9]];
  const [crease, front] = await coloursAt(page, places);
  await box(page, "Occlusion").check();
  await settled(page);
  const [darkCrease, sameFront] = await coloursAt(page, places);
  assert.ok(brightness(darkCrease) < brightness(crease) - 15, `the crease is ${crease} and ${darkCrease}`);
  assert.ok(Math.abs(brightness(front) - brightness(sameFront)) < 20, `the front is ${front} and ${sameFront}`);
  await page.getByRole("button", { name: "Orthographic" }).click();
  await settled(page);
  await box(page, "Occlusion").uncheck();
}

async function xrayShowsTheInside(stage) {
  const page = await open(stage, `${ball()}[[object]]\nname = "inner"\nmodel = "icosphere"\nscale = 0.3\n`);
  await settled(page);
  const [before] = await coloursAt(page, [[0, 0, 0]]);
  await box(page, "X-ray").check();
  await settled(page);
  const [after, beside] = await coloursAt(page, [[0, 0, 0], [0.7, 0, 0]]);
  assert.ok(!isNear(before, after) && !isNear(after, beside), `from ${before} to ${after}, beside it ${beside}`);
  await box(page, "X-ray").uncheck();
  await settled(page);
  assert.deepEqual((await coloursAt(page, [[0, 0, 0]]))[0], before);
}

async function zIsUp(stage) {
  const page = await open(stage, ball());
  const before = await picture(page);
  const y = await camera(page);
  await box(page, "Z up").check();
  await settled(page);
  assert.notEqual(await picture(page), before);
  const z = await camera(page);
  const from = ({ position, target }) => position.map((x, axis) => x - target[axis]);
  const [x1, y1, z1] = from(y);
  from(z).forEach((value, axis) => assert.ok(Math.abs(value - [x1, -z1, y1][axis]) < 1e-6));
  await page.getByRole("combobox", { name: "Axis view" }).selectOption("top");
  await settled(page);
  const top = from(await camera(page));
  assert.ok(top[2] > 0 && Math.hypot(top[0], top[1]) < 1e-2 * top[2], `from the top is ${top}`);
  const left = await camera(page);
  await page.reload();
  await hasFrame(page);
  await until(page, () => supple.model.up === "z");
  const again = await camera(page);
  left.position.forEach((value, axis) => assert.ok(Math.abs(again.position[axis] - value) < 1e-3, `the camera is at ${again.position}, it was at ${left.position}`));
  assert.ok(await box(page, "Z up").isChecked(), "the choice is forgotten");
}

export const tests = [
  ["the floor has a grid and a shadow", floorAndShadow],
  ["the border is a glass box", borderIsAGlassBox],
  ["the first view shows what moves", firstViewShowsWhatMoves],
  ["smooth or flat", smoothOrFlat],
  ["very large surfaces are flat", largeSurfacesAreFlat],
  ["creases are dark", creasesAreDark],
  ["x-ray shows the inside", xrayShowsTheInside],
  ["z is up", zIsUp],
];
