// Makes the animation of the README, docs/images/demo.webp, from frames of the viewer:
//   node e2e/tools/animation.mjs PATH/TO/supple
// tools/assemble_animation.py needs Debian's python3-pil.
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { chromium } from "playwright-core";
import { CHROMIUM_FLAGS, chromiumPath, hasFrame, pause, repository, scenes, settled, Stage, until } from "./harness.mjs";

const FRAMES = 80;
const STEPS_PER_FRAME = 2;
const SIZE = { width: 760, height: 500 };

const supple = process.argv[2];
if (!supple || !existsSync(supple)) throw new Error("usage: node e2e/tools/animation.mjs PATH/TO/supple");
const folder = mkdtempSync(join(tmpdir(), "supple-animation-"));
const browser = await chromium.launch({ executablePath: chromiumPath(), args: CHROMIUM_FLAGS });
const stage = new Stage(resolve(supple), browser);
try {
  const program = await stage.program(join(scenes, "nine.toml"));
  const page = await stage.page({ colorScheme: "dark", viewport: SIZE });
  await page.goto(program.address);
  await hasFrame(page);
  await pause(page);
  await page.keyboard.press("r");
  await until(page, () => supple.model.frame?.text.step === 0);
  await page.keyboard.press("h");
  await page.keyboard.press("f");
  await settled(page);
  await page.keyboard.press("+");
  await settled(page);
  for (let frame = 0; frame < FRAMES; ++frame) {
    const step = frame * STEPS_PER_FRAME;
    if (frame > 0) await page.evaluate((count) => supple.client.send({ do: "step", count }), STEPS_PER_FRAME);
    await until(page, (wanted) => supple.model.frame?.text.step >= wanted && supple.isUpToDate, step);
    await page.locator("canvas.view").screenshot({ path: join(folder, `${String(frame).padStart(3, "0")}.png`) });
  }
  execFileSync("/usr/bin/python3", [join(repository, "tools/assemble_animation.py"), folder, join(repository, "docs/images/demo.webp")], { stdio: "inherit" });
} finally {
  await stage.cleanUp();
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
