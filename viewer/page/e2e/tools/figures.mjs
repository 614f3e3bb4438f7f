// Makes the picture of the whole page in docs/images: node e2e/tools/figures.mjs PATH/TO/supple
// tools/draw_figures.sh draws the pictures of scenes.
import { existsSync } from "node:fs";
import { join, resolve } from "node:path";
import { chromium } from "playwright-core";
import { CHROMIUM_FLAGS, chromiumPath, hasFrame, pause, repository, scenes, settled, Stage, until } from "./harness.mjs";

/** Many pairs touch. */
const STEP = 117;

async function wholePage(stage) {
  const program = await stage.program(join(scenes, "nine.toml"));
  const page = await stage.page({ viewport: { width: 1440, height: 860 }, colorScheme: "light" });
  await page.goto(program.address);
  await hasFrame(page);
  await pause(page);
  await page.keyboard.press("r");
  await until(page, () => supple.model.frame?.text.step === 0);
  await page.evaluate((count) => supple.client.send({ do: "step", count }), STEP);
  await until(page, (step) => supple.model.frame?.text.step === step, STEP);
  await settled(page);
  await page.getByRole("treegrid", { name: "Contacts" }).getByText("rabbit 3").filter({ visible: true }).first().click();  // opens the pair
  await page.evaluate(() => supple.model.clearSelection());
  await page.keyboard.press("f");
  await settled(page);
  await page.screenshot({ path: join(repository, "docs/images/viewer.png") });
}

const [program] = process.argv.slice(2);
if (!program || !existsSync(program)) {
  console.error("usage: node e2e/tools/figures.mjs PATH/TO/supple");
  process.exit(2);
}
const browser = await chromium.launch({ executablePath: chromiumPath(), headless: true, args: CHROMIUM_FLAGS });
const stage = new Stage(resolve(program), browser);
try {
  await wholePage(stage);
} finally {
  await stage.cleanUp();
  await browser.close();
}
