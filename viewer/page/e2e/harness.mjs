// What the tests are written with: a program, a page that shows it, and a few ways to look and to wait.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

export const repository = resolve(dirname(fileURLToPath(import.meta.url)), "../../..");
export const scenes = join(repository, "scenes");

const START_MILLISECONDS = 60_000;

/** `supple view`, until it is stopped. */
export class Program {
  /** It opens no browser, unless it is given an environment to find one in. */
  static async start(supple, args, env) {
    const program = new Program();
    program.output = "";
    const options = env ? args : ["--no-open", ...args];
    program.child = spawn(supple, ["view", ...options], { stdio: ["ignore", "pipe", "pipe"], env: { ...process.env, ...env } });
    program.ended = new Promise((done) => program.child.on("exit", (code, signal) => done({ code, signal })));
    for (const stream of [program.child.stdout, program.child.stderr]) stream.on("data", (data) => (program.output += data));
    const before = Date.now();
    let code;
    void program.ended.then((end) => (code = end));
    while (!(program.address = /http:\/\/\S+/.exec(program.output)?.[0])) {
      if (code) throw new Error(`supple view ended with ${JSON.stringify(code)}: ${program.output}`);
      if (Date.now() - before > START_MILLISECONDS) throw new Error(`supple view prints no address: ${program.output}`);
      await new Promise((done) => setTimeout(done, 20));
    }
    return program;
  }

  async stop(signal = "SIGINT") {
    this.child.kill(signal);
    return this.ended;
  }
}

/** Runs the program to its end and gives what it printed. */
export function runProgram(supple, args, options = {}) {
  return new Promise((done, fail) => {
    const child = spawn(supple, args, { stdio: ["ignore", "pipe", "pipe"], ...options });
    let output = "";
    for (const stream of [child.stdout, child.stderr]) stream.on("data", (data) => (output += data));
    child.on("error", fail);
    child.on("exit", (code) => (code === 0 ? done(output) : fail(new Error(`supple ${args.join(" ")} gave ${code}: ${output}`))));
  });
}

export const CHROMIUM_FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"];

/** All that one test needs, and cleans up after it. */
export class Stage {
  constructor(supple, browser) {
    this.supple = supple;
    this.browser = browser;
    this.folder = mkdtempSync(join(tmpdir(), "supple-e2e-"));
    this.programs = [];
    this.contexts = [];
    this.errors = [];
  }

  file(name, text) {
    const path = join(this.folder, name);
    if (text !== undefined) writeFileSync(path, text);
    return path;
  }

  async program(...args) {
    return this.programIn(undefined, ...args);
  }

  async programIn(env, ...args) {
    const program = await Program.start(this.supple, args, env);
    this.programs.push(program);
    return program;
  }

  /** A page without anything in it. Errors that nobody catches fail the test. */
  async page(options = {}) {
    const context = await this.browser.newContext({ viewport: { width: 1280, height: 800 }, acceptDownloads: true, colorScheme: "dark", ...options });
    this.contexts.push(context);
    const page = await context.newPage();
    page.setDefaultTimeout(30_000);
    page.on("pageerror", (error) => this.errors.push(error.message));
    return page;
  }

  /** A program, and a page that shows it and has got a frame. */
  async view(...args) {
    const program = await this.program(...args);
    const page = await this.page();
    await page.goto(program.address);
    await hasFrame(page);
    return { program, page };
  }

  async cleanUp() {
    for (const context of this.contexts) await context.close().catch(() => {});
    for (const program of this.programs) if (program.child.exitCode === null && program.child.signalCode === null) await program.stop("SIGKILL");
    rmSync(this.folder, { recursive: true, force: true });
  }
}

export const hasFrame = (page) => page.waitForFunction(() => (window.supple?.model.framesSeen ?? 0) > 0);
export const until = (page, condition, argument) => page.waitForFunction(condition, argument);
export const step = (page) => page.evaluate(() => supple.model.frame.text.step);
export const counts = (page) => page.evaluate(() => supple.counts());
export const camera = (page) => page.evaluate(() => supple.camera());

/** Pauses and waits until the last frame is there. */
export async function pause(page) {
  const button = page.getByRole("button", { name: "Pause" });
  // A recording may end by itself meanwhile: then there is no such button any more.
  if (await button.count()) await button.click({ timeout: 5000 }).catch(() => {});
  await until(page, () => !supple.model.frame.text.playing);
  await settled(page);
}

/** Waits until nothing has come or been drawn for a while. */
export async function settled(page) {
  let last;
  for (let same = 0; same < 3; ) {
    const now = await page.evaluate(() => `${supple.model.framesSeen} ${supple.drawTimes().at(-1)}`);
    same = now === last ? same + 1 : 0;
    last = now;
    await page.waitForTimeout(120);
  }
}

/** What the canvas shows, as a text to compare. */
export const picture = (page) =>
  page.evaluate(() => {
    supple.draw();  // the canvas keeps its picture until the end of this turn only
    return document.querySelector("canvas.view").toDataURL();
  });

/** Where to click for a triangle that is seen: one that a ray through its middle meets first, and that is not lower than `least`. */
export const seenTriangle = (page, object, least = -Infinity) =>
  page.evaluate(([object, least]) => {
    const { triangles } = supple.model.objects[object];
    for (let triangle = 0; triangle < triangles; ++triangle) {
      const middle = supple.centroid(object, triangle);
      if (middle[1] < least) continue;
      const at = supple.project(middle);
      const hit = supple.pickAt(at.x, at.y);
      if (hit?.object === object && hit.triangle === triangle) return { ...at, object, triangle, vertex: hit.vertex };
    }
    throw new Error(`no triangle of object ${object} is seen`);
  }, [object, least]);

/** Two balls that stand apart and do not move by themselves. */
export const TWO_BALLS = `
[[object]]
name = "left"
model = "icosphere"
scale = 0.5
translate = [-0.6, 0, 0]
[[object]]
name = "right"
model = "icosphere"
scale = 0.5
translate = [0.6, 0, 0]
`;
