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

/**
 * Prints how long a picture takes until the script ends and until its pixels are drawn, after all vertices have
 * changed and after only the camera has moved, and how long it takes to find the triangle at the pointer.
 */
async function picture(stage, scene) {
  const begin = performance.now();
  const page = await open(stage, scene);
  const first = performance.now() - begin;
  await pause(page);
  await until(page, () => supple.model.frame.lists.contacts.count === 0);
  const { moved, turned, picked, objects, triangles, calls } = await page.evaluate(() => {
    const gl = document.querySelector("canvas.view").getContext("webgl2");
    const pixel = new Uint8Array(4);
    const median = (values) => values.sort((a, b) => a - b)[values.length >> 1];
    const timed = (work) => {
      const begin = performance.now();
      work();
      return performance.now() - begin;
    };
    /** Milliseconds of script, and with its pixels. */
    const drawn = (change) => {
      const times = Array.from({ length: 30 }, () => {
        const script = timed(() => {
          change();
          supple.draw();
        });
        return [script, script + timed(() => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel))];
      });
      return [0, 1].map((at) => median(times.map((pair) => pair[at])));
    };
    const moved = drawn(() => supple.touch());
    const { calls } = supple.drawn();
    const turned = drawn(() => {});
    const { x, y } = supple.project(supple.centroid(0, 0));
    const picked = median(Array.from({ length: 30 }, () => timed(() => supple.pickAt(x, y))));
    const { objects } = supple.model;
    return { moved, turned, picked, calls, objects: objects.length, triangles: objects.reduce((sum, object) => sum + object.triangles, 0) };
  });
  const shown = ([script, pixels]) => `${script.toFixed(2)} ms of script, ${pixels.toFixed(1)} ms with its pixels`;
  console.log(
    `${triangles.toLocaleString("en")} triangles, objects: ${objects.toLocaleString("en")}; first frame after ${(first / 1000).toFixed(1)} s; ` +
      `all vertices new: ${shown(moved)}, ${calls} draw calls; camera moved: ${shown(turned)}; triangle at the pointer: ${picked.toFixed(1)} ms`,
  );
}

const [program] = process.argv.slice(2);
if (!program || !existsSync(program)) {
  console.error("usage: node e2e/tools/measure.mjs PATH/TO/supple");
  process.exit(2);
}
const browser = await chromium.launch({ executablePath: chromiumPath(), headless: true, args: CHROMIUM_FLAGS });
try {
  for (const scene of [swayingBalls(1, 22), swayingBalls(1, 71), SWAYING_CROWD, swayingBalls(1, 224)]) {
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
