// Makes the pictures of the viewer in docs/images, also from the view files in docs/images/views: node e2e/tools/figures.mjs PATH/TO/supple
import { existsSync } from "node:fs";
import { join, resolve } from "node:path";
import { chromium } from "playwright-core";
import { CHROMIUM_FLAGS, chromiumPath, pause, repository, runProgram, scenes, settled, Stage, until } from "./harness.mjs";

const images = join(repository, "docs/images");

const views = join(images, "views");

/** Draws a view file of the repository. */
const draw = (supple, input, view, name, ...options) =>
  runProgram(supple, ["render", input, ...options, "--view", join(views, view), "--size", "1000x680", "--dpi", "96", "-o", join(images, name)]);

/** The paper's Figure 3: the octree of the broad phase with bounding spheres. */
const broadPhase = ({ supple }) =>
  draw(supple, join(scenes, "nine.toml"), "broad_phase.json", "broad_phase_spheres.png", "--bounding-volume", "sphere", "--broad-phase", "octree");

/** The paper's Figure 5: a collision in the narrow phase. Only the volumes of the leaves that collide. */
async function narrowPhase({ supple }) {
  const files = { aabb: "narrow_phase_boxes.png", obb: "narrow_phase_oriented_boxes.png", kdop26: "narrow_phase_kdops.png" };
  for (const [volume, file] of Object.entries(files))
    await draw(supple, join(views, "two_rabbits.toml"), "narrow_phase.json", file, "--object-octree", "regular", "--leaf-size", "12", "--bounding-volume", volume);
}

async function wholePage(stage) {
  const program = await stage.program(join(scenes, "nine.toml"));
  const page = await stage.page({ viewport: { width: 1440, height: 860 } });
  await page.goto(program.address);
  await until(page, () => supple.model.history.frames.length > 60);
  await until(page, () => supple.model.frame.contacts.length > 3000);
  await pause(page);
  await page.keyboard.press("f");
  await page.getByRole("treegrid", { name: "Contacts" }).getByText("rabbit 3").first().click();  // opens the pair
  await page.keyboard.press("f");
  await page.evaluate(() => supple.model.clearSelection());
  await settled(page);
  await page.screenshot({ path: join(images, "viewer.png") });
}

const [program] = process.argv.slice(2);
if (!program || !existsSync(program)) {
  console.error("usage: node e2e/tools/figures.mjs PATH/TO/supple");
  process.exit(2);
}
const browser = await chromium.launch({ executablePath: chromiumPath(), headless: true, args: CHROMIUM_FLAGS });
try {
  for (const make of [broadPhase, narrowPhase, wholePage]) {
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
