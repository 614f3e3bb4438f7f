// Measures the time to draw on this machine: node e2e/tools/measure.mjs PATH/TO/supple
import { existsSync } from "node:fs";
import { resolve } from "node:path";
import { chromium } from "playwright-core";
import { CHROMIUM_FLAGS, chromiumPath, hasFrame, pause, Stage, SWAYING_CROWD, swayingBalls, until } from "./harness.mjs";

/** A small window, so that rasterisation in software does not dominate. */
async function open(stage, scene) {
  const program = await stage.program(stage.file("balls.toml", scene));
  const page = await stage.page({ viewport: { width: 900, height: 400 } });
  await page.goto(program.address);
  await hasFrame(page);
  return page;
}

/** Draws after all vertices changed. Prints the time until the script ends and until the pixels are drawn. */
async function picture(stage, scene) {
  const page = await open(stage, scene);
  await pause(page);
  await until(page, () => supple.model.frame.contacts.length === 0);
  const { script, pixels, objects, triangles, calls } = await page.evaluate(() => {
    const gl = document.querySelector("canvas.view").getContext("webgl2");
    const pixel = new Uint8Array(4);
    const times = [];
    for (let i = 0; i < 30; ++i) {
      const begin = performance.now();
      supple.touch();
      supple.draw();
      const drawn = performance.now();
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      times.push([drawn - begin, performance.now() - begin]);
    }
    const median = (at) => times.map((pair) => pair[at]).sort((a, b) => a - b)[15];
    const { objects } = supple.model;
    const triangles = objects.reduce((sum, object) => sum + object.triangles, 0);
    return { script: median(0), pixels: median(1), objects: objects.length, triangles, calls: supple.drawn().calls };
  });
  console.log(
    `${triangles.toLocaleString("en")} triangles, objects: ${objects.toLocaleString("en")}; ${script.toFixed(2)} ms of script per picture in ${calls} draw calls, ` +
      `${pixels.toFixed(1)} ms with its pixels`,
  );
}

const [program] = process.argv.slice(2);
if (!program || !existsSync(program)) {
  console.error("usage: node e2e/tools/measure.mjs PATH/TO/supple");
  process.exit(2);
}
const browser = await chromium.launch({ executablePath: chromiumPath(), headless: true, args: CHROMIUM_FLAGS });
try {
  for (const scene of [swayingBalls(1, 22), swayingBalls(1, 71), SWAYING_CROWD]) {
    const stage = new Stage(resolve(program), browser);
    try {
      await picture(stage, scene);
    } finally {
      await stage.cleanUp();
    }
  }
} finally {
  await browser.close();
}
