// Makes the pictures of the viewer in docs/images: node e2e/figures.mjs PATH/TO/supple
import { existsSync } from "node:fs";
import { join, resolve } from "node:path";
import { chromium } from "playwright-core";
import { CHROMIUM_FLAGS, chromiumPath, pause, repository, scenes, settled, Stage, until } from "./harness.mjs";

const images = join(repository, "docs/images");

/** Saves the 3D view only, without panels. */
async function saveView(page, name, keys = []) {
  await page.keyboard.press("h");
  await page.waitForTimeout(300);  // the view first takes up the free space
  await page.keyboard.press("f");
  await settled(page);
  for (const key of keys) await page.keyboard.press(key);
  await settled(page);
  await page.locator("canvas.view").screenshot({ path: join(images, name) });
}

const check = (page, label, on = true) => page.getByRole("checkbox", { name: label, exact: true }).setChecked(on);

/** Pauses at a frame that fulfils the condition, and frames the view. */
async function stopWhen(page, condition) {
  await until(page, condition);
  await pause(page);
}

/** The paper's Figure 3: the octree of the broad phase with bounding spheres. */
async function broadPhase(stage) {
  const program = await stage.program(join(scenes, "nine.toml"), "--bounding-volume", "sphere", "--broad-phase", "octree");
  const page = await stage.page({ colorScheme: "light", viewport: { width: 1100, height: 720 } });
  await page.goto(program.address);
  await stopWhen(page, () => supple.model.frame?.text.step > 60);
  await check(page, "Scene octree");
  await check(page, "Object octrees");
  await until(page, () => supple.counts().balls > 0);
  await page.getByRole("combobox", { name: "Octree level" }).selectOption("0");
  await check(page, "Contact points", false);
  await saveView(page, "broad_phase_spheres.png", ["-", "-", "-", "-", "-"]);
}

const TWO_RABBITS = `
[scene]
bounds = [[-1.2, -1.2, -1.2], [1.2, 1.2, 1.2]]
[[object]]
name = "one"
model = "rabbit"
translate = [-0.22, 0, 0]
rotate_xyz_degrees = [0, 30, 0]
[[object]]
name = "other"
model = "rabbit"
translate = [0.24, 0.05, 0.05]
rotate_xyz_degrees = [0, 200, 8]
`;

/** A collision in the narrow phase. Only the volumes of the leaves that collide. */
async function narrowPhaseWith(stage, volume, shapes, file) {
  const program = await stage.program(
    stage.file("rabbits.toml", TWO_RABBITS), "--object-octree", "regular", "--leaf-size", "12", "--bounding-volume", volume,
  );
  const page = await stage.page({ colorScheme: "light", viewport: { width: 1100, height: 720 } });
  await page.goto(program.address);
  await stopWhen(page, () => supple.model.frame?.contacts.length > 0);
  await check(page, "Colliding nodes");
  for (const label of ["Contact points", "Intersecting triangles", "Contact segments"]) await check(page, label, false);
  await until(page, (shapes) => supple.counts()[shapes] > 0, shapes);
  for (const name of ["one", "other"]) {
    await page.getByRole("button", { name: new RegExp(`^${name}`) }).click();
    await page.getByLabel(`Opacity of ${name}`).fill("0.35");
  }
  await page.evaluate(() => supple.model.clearSelection());
  await saveView(page, file);
}

/** The paper's Figure 5. */
const narrowPhase = (stage) => narrowPhaseWith(stage, "aabb", "nodeBoxes", "narrow_phase_boxes.png");
const narrowPhaseOriented = (stage) => narrowPhaseWith(stage, "obb", "nodeEdges", "narrow_phase_oriented_boxes.png");
const narrowPhaseKdops = (stage) => narrowPhaseWith(stage, "kdop26", "nodeEdges", "narrow_phase_kdops.png");

async function wholePage(stage) {
  const program = await stage.program(join(scenes, "nine.toml"));
  const page = await stage.page({ viewport: { width: 1440, height: 860 } });
  await page.goto(program.address);
  await until(page, () => supple.model.history.frames.length > 60);
  await stopWhen(page, () => supple.model.frame.contacts.length > 3000);
  await page.keyboard.press("f");
  await page.getByRole("treegrid", { name: "Contacts" }).getByText("rabbit 3").first().click();  // opens the pair
  await page.keyboard.press("f");
  await page.evaluate(() => supple.model.clearSelection());
  await settled(page);
  await page.screenshot({ path: join(images, "viewer.png") });
}

const [program] = process.argv.slice(2);
if (!program || !existsSync(program)) {
  console.error("usage: node e2e/figures.mjs PATH/TO/supple");
  process.exit(2);
}
const browser = await chromium.launch({ executablePath: chromiumPath(), headless: true, args: CHROMIUM_FLAGS });
try {
  for (const make of [broadPhase, narrowPhase, narrowPhaseOriented, narrowPhaseKdops, wholePage]) {
    const stage = new Stage(resolve(program), browser);
    try {
      await make(stage);
    } finally {
      await stage.cleanUp();
    }
  }
} finally {
  await browser.close();
}
