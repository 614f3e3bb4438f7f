// How fast the viewer is on this machine: node e2e/measure.mjs PATH/TO/supple
// Frames a second that come from the program into the page, and the time of a picture.
import { existsSync } from "node:fs";
import { resolve } from "node:path";
import { chromium } from "playwright-core";
import { CHROMIUM_FLAGS, chromiumPath, hasFrame, pause, Stage, swayingBalls, until } from "./harness.mjs";

/** A small window: where pixels are made in software, they must not be all that is measured. */
async function open(stage, scene) {
  const program = await stage.program(stage.file("balls.toml", scene));
  const page = await stage.page({ viewport: { width: 900, height: 400 } });
  await page.goto(program.address);
  await hasFrame(page);
  return page;
}

/** Of a picture with all vertices new: until the script is done, and until the pixels are. */
async function picture(stage, frequency) {
  const page = await open(stage, swayingBalls(1, frequency));
  await pause(page);
  await until(page, () => supple.model.frame.contacts.length === 0);
  const { script, pixels, triangles } = await page.evaluate(() => {
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
    return { script: median(0), pixels: median(1), triangles: supple.model.objects[0].triangles };
  });
  console.log(`${triangles.toLocaleString("en")} triangles: ${script.toFixed(2)} ms of script a picture, ${pixels.toFixed(1)} ms with its pixels`);
}

const [program] = process.argv.slice(2);
if (!program || !existsSync(program)) {
  console.error("usage: node e2e/measure.mjs PATH/TO/supple");
  process.exit(2);
}
const browser = await chromium.launch({ executablePath: chromiumPath(), headless: true, args: CHROMIUM_FLAGS });
try {
  for (const frequency of [22, 71]) {
    const stage = new Stage(resolve(program), browser);
    try {
      await picture(stage, frequency);
    } finally {
      await stage.cleanUp();
    }
  }
} finally {
  await browser.close();
}
