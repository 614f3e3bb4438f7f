// How fast the viewer is on this machine: node e2e/measure.mjs PATH/TO/supple
// Frames a second that come from the program into the page, and the time of a picture.
import { existsSync } from "node:fs";
import { resolve } from "node:path";
import { chromium } from "playwright-core";
import { CHROMIUM_FLAGS, hasFrame, pause, Stage, until } from "./harness.mjs";

const SECONDS = 6;

/** Balls that sway far from one another; a ball of frequency f has 10 f² + 2 vertices and 20 f² triangles. */
function ballScene(count, frequency) {
  const balls = Array.from({ length: count }, (_, i) => `
[[object]]
name = "ball ${i}"
model = "icosphere"
frequency = ${frequency}
translate = [${3 * i}, 0, 0]
motion = { kind = "sway", amplitude = 0.1, wavelength = 1.5, period = 1, seed = ${i} }`);
  return `[scene]\ntime_step = 0.01\n${balls.join("\n")}\n`;
}

/** Thousands of small balls in a grid, 42 vertices and 80 triangles each. */
const CROWD = `
[scene]
time_step = 0.01
[[object]]
name = "ball"
model = "icosphere"
frequency = 2
repeat = [20, 25, 10]
spacing = [3, 3, 3]
motion = { kind = "sway", amplitude = 0.1, wavelength = 1.5, period = 1 }
`;

/** A small window: where pixels are made in software, they must not be all that is measured. */
async function open(stage, scene) {
  const program = await stage.program(stage.file("balls.toml", scene));
  const page = await stage.page({ viewport: { width: 900, height: 400 } });
  await page.goto(program.address);
  await hasFrame(page);
  return page;
}

/** Frames that arrive in a second, with what is drawn or without. */
async function stream(stage, scene, draws) {
  const page = await open(stage, scene);
  await page.getByRole("combobox", { name: "Speed" }).selectOption("0");
  await page.getByRole("checkbox", { name: "Surfaces" }).setChecked(draws);
  await page.waitForTimeout(1500);
  const { frames, steps, turns, reading, seconds, objects, vertices } = await page.evaluate(async (wanted) => {
    const begin = performance.now();
    const [frames, steps] = [supple.model.framesSeen, supple.model.frame.text.step];
    let turns = 0;
    const turn = () => {
      turns += 1;
      requestAnimationFrame(turn);
    };
    requestAnimationFrame(turn);
    let reading = 0;
    const receive = supple.client.receive;
    supple.client.receive = function (message) {
      const from = performance.now();
      receive.call(this, message);
      reading += performance.now() - from;
    };
    await new Promise((done) => setTimeout(done, 1000 * wanted));
    const vertices = supple.model.objects.reduce((sum, object) => sum + object.vertices, 0);
    return {
      frames: supple.model.framesSeen - frames, steps: supple.model.frame.text.step - steps, turns, reading, vertices, objects: supple.model.objects.length,
      seconds: (performance.now() - begin) / 1000,
    };
  }, SECONDS);
  const how = draws ? "drawn" : "surfaces not drawn";
  console.log(
    `${vertices.toLocaleString("en")} vertices of ${objects.toLocaleString("en")} objects, ${how}: ${(frames / seconds).toFixed(1)} frames/s, ${(steps / seconds).toFixed(1)} steps/s, ` +
      `${(turns / seconds).toFixed(1)} turns of the browser/s, ${(reading / frames).toFixed(2)} ms a frame to read and take over`,
  );
}

/** Of a picture with all vertices new: until the script is done, and until the pixels are. */
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
    `${triangles.toLocaleString("en")} triangles of ${objects.toLocaleString("en")} objects: ${script.toFixed(2)} ms of script a picture in ${calls} draw calls, ` +
      `${pixels.toFixed(1)} ms with its pixels`,
  );
}

const [program] = process.argv.slice(2);
if (!program || !existsSync(program)) {
  console.error("usage: node e2e/measure.mjs PATH/TO/supple");
  process.exit(2);
}
const flags = process.env.SUPPLE_GPU ? ["--no-sandbox"] : CHROMIUM_FLAGS;
const browser = await chromium.launch({ executablePath: process.env.SUPPLE_CHROMIUM ?? "/usr/bin/chromium", headless: true, args: flags });
try {
  const moving = [ballScene(10, 32), ballScene(1, 100), CROWD];
  const still = [ballScene(1, 22), ballScene(1, 71), CROWD];
  const measures = [
    ...moving.flatMap((scene) => [false, true].map((draws) => (stage) => stream(stage, scene, draws))),
    ...still.map((scene) => (stage) => picture(stage, scene)),
  ];
  for (const measure of measures) {
    const stage = new Stage(resolve(program), browser);
    try {
      await measure(stage);
    } finally {
      await stage.cleanUp();
    }
  }
} finally {
  await browser.close();
}
