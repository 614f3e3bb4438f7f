// The test harness: starts programs and pages, inspects them and waits for them.
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateRawSync } from "node:zlib";
import { reachDrawers, SIZES } from "./sizes.mjs";

export const repository = resolve(dirname(fileURLToPath(import.meta.url)), "../../../..");
export const scenes = join(repository, "scenes");

const START_MILLISECONDS = 120_000;
/** Of the scripts of a page, with --slow. */
const SLOWDOWN = 8;

/** A running `supple view`. */
export class Program {
  /** Opens no browser, unless `env` names one. */
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
    while (!(program.address = addressIn(program.output))) {
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

  /** Waits until the program has printed a text: its two outputs arrive in no order. */
  async prints(text) {
    const before = Date.now();
    while (!this.output.includes(text)) {
      if (Date.now() - before > START_MILLISECONDS) throw new Error(`supple view does not print ${text}: ${this.output}`);
      await new Promise((done) => setTimeout(done, 20));
    }
  }
}

/** The address that a program has printed, when all of it has arrived. */
export const addressIn = (output, before = "") => new RegExp(`${before}(http://\\S+)\\s`).exec(output)?.[1];

/** The address of a page that is paused at a step from the beginning: it shows no other frame of a simulation before its first. */
export const atStep = (address, step) => `${address}#view=${deflateRawSync(JSON.stringify({ version: 1, step })).toString("base64url")}`;

/** Runs the program to its end and returns its output. */
export function runProgram(supple, args, options = {}) {
  return new Promise((done, fail) => {
    const child = spawn(supple, args, { stdio: ["ignore", "pipe", "pipe"], ...options });
    let output = "";
    for (const stream of [child.stdout, child.stderr]) stream.on("data", (data) => (output += data));
    child.on("error", fail);
    child.on("close", (code) => (code === 0 ? done(output) : fail(new Error(`supple ${args.join(" ")} gave ${code}: ${output}`))));
  });
}

/** Object and triangle of both sides of each contact in the newest frame. */
export const contactsIn = (page) => page.evaluate(() => {
  const { object_a, triangle_a, object_b, triangle_b } = supple.model.frame.lists.contacts.columns;
  return Array.from(object_a, (object, i) => [object, triangle_a[i], object_b[i], triangle_b[i]]);
});

/** WebGL in software, or on the graphics card when SUPPLE_GPU is set. */
const SOFTWARE_FLAGS = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--disable-gpu-compositing"];
export const CHROMIUM_FLAGS = ["--no-sandbox", ...(process.env.SUPPLE_GPU ? [] : SOFTWARE_FLAGS)];

/** The path of the browser; undefined when there is none. The shell opens a page in a third of the time. */
export function chromiumPath() {
  const shell = "/usr/lib/chromium/chromium-headless-shell";
  const places = [process.env.SUPPLE_CHROMIUM, shell, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
  return places.find((path) => path && existsSync(path));
}

/** The path of Firefox; undefined when there is none. */
export const firefoxPath = () => [process.env.SUPPLE_FIREFOX, "/usr/bin/firefox-esr", "/usr/bin/firefox"].find((path) => path && existsSync(path));

/** Balls in wave motion, far apart. A ball of frequency f has 10 f² + 2 vertices and 20 f² triangles. */
export function swayingBalls(count, frequency) {
  const balls = Array.from({ length: count }, (_, i) => `
[[object]]
name = "ball ${i}"
model = "icosphere"
frequency = ${frequency}
translate = [${3 * i}, 0, 0]
motion = { kind = "sway", amplitude = 0.1, wavelength = 1.5, period = 1, seed = ${i} }`);
  return `[scene]\ntime_step = 0.01\n${balls.join("\n")}\n`;
}

/** Thousands of small balls in a grid, with 42 vertices and 80 triangles each. */
export const SWAYING_CROWD = `
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

/** For pages that are slow because WebGL runs in software: a quarter of the pixels, without antialiasing. */
export const COARSE = { deviceScaleFactor: 0.5, antialias: false };

/** Everything that one test needs; cleans up after it. `options` are those of its pages, which have a size and a theme. */
export class Stage {
  constructor(supple, browser, options = {}, { size = "1280", theme = "dark", slow = false } = {}) {
    this.supple = supple;
    this.browser = browser;
    this.options = { ...options, colorScheme: theme };
    this.window = { ...(SIZES[size] ?? { viewport: { width: 1280, height: 800 } }) };
    if (browser?.browserType().name() !== "chromium") delete this.window.hasTouch;  // the harness has no finger there
    this.slow = slow && browser?.browserType().name() === "chromium";
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

  /** An empty page whose camera moves without animation. Uncaught errors fail the test. A test with a size of its own opens drawers itself. */
  async page(options = {}) {
    const { antialias = true, ...others } = { ...this.options, ...(options.viewport ? {} : this.window), ...options };
    const context = await this.browser.newContext({ acceptDownloads: true, reducedMotion: "reduce", ...others });
    this.contexts.push(context);
    if (!antialias) await context.addInitScript(drawWithoutAntialiasing);
    await context.addInitScript(keepNotices);
    const page = await context.newPage();
    page.setDefaultTimeout(120_000);  // ends a test that hangs; a busy machine needs long
    if (this.slow) await (await context.newCDPSession(page)).send("Emulation.setCPUThrottlingRate", { rate: SLOWDOWN });
    page.on("pageerror", (error) => this.errors.push(error.message));
    if (!options.viewport) reachDrawers(page, others.hasTouch ?? false);
    return page;
  }

  /** Starts a program and a page that shows it, and waits for a frame. */
  async view(...args) {
    const program = await this.program(...args);
    const page = await this.page();
    await page.goto(program.address);
    await hasFrame(page);
    return { program, page };
  }

  /** Like `view`, but paused at a step. What the page shows does not depend on how fast it was opened. */
  async viewAt(step, ...args) {
    const program = await this.program(...args);
    const page = await this.page();
    await page.goto(atStep(program.address, step));
    await isAt(page, step);
    await settled(page);
    return { program, page };
  }

  async cleanUp() {
    for (const context of this.contexts) await context.close().catch(() => {});
    for (const program of this.programs) if (program.child.exitCode === null && program.child.signalCode === null) await program.stop("SIGKILL");
    rmSync(this.folder, { recursive: true, force: true });
  }
}

function drawWithoutAntialiasing() {
  const get = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, options) {
    return get.call(this, kind, { ...options, antialias: false });
  };
}

/** Notices disappear after some seconds, perhaps before the test looks. */
function keepNotices() {
  window.notices = [];
  const isNotice = (node) => node.classList?.contains("notice") && node.checkVisibility();
  const take = (records) => notices.push(...records.flatMap(({ addedNodes }) => [...addedNodes].filter(isNotice).map((node) => node.textContent)));
  new MutationObserver(take).observe(document, { childList: true, subtree: true });
}

export const hasFrame = (page) => page.waitForFunction(() => (window.supple?.model.framesSeen ?? 0) > 0);
export const until = (page, condition, argument) => page.waitForFunction(condition, argument);
/** Waits until the page has shown a notice that contains a text, also when it has disappeared again. */
export const said = (page, text) => until(page, (text) => window.notices.some((notice) => notice.includes(text)), text);
export const isAt = (page, step) => until(page, (step) => window.supple?.model.frame?.text.step === step, step);
export const step = (page) => page.evaluate(() => supple.model.frame.text.step);
export const counts = (page) => page.evaluate(() => supple.counts());
export const camera = (page) => page.evaluate(() => supple.camera());

/** Pauses and waits for the last frame. */
export async function pause(page) {
  await page.evaluate(() => supple.client.ask({ do: "pause" }));
  await until(page, () => supple.model.frame?.text.playing === false);
  await settled(page);
}

/** Takes steps of a paused simulation and waits until the last one is drawn. */
export async function steps(page, count) {
  const from = await step(page);
  await page.evaluate((count) => supple.client.ask({ do: "step", count }), count);
  await isAt(page, from + count);
  await settled(page);
}

/** Starts the simulation again and takes so many steps: unlike a simulation that plays, it is then in the same state in each run. It is paused. */
export async function simulateTo(page, step) {
  await page.evaluate(async (count) => {
    const steps = count > 0 ? [{ do: "step", count }] : [];
    for (const command of [{ do: "pause" }, { do: "reset" }, ...steps]) await supple.client.ask(command);
  }, step);
  await until(page, (step) => supple.model.frame?.text.step === step, step);
  await settled(page);
}

/**
 * Waits until the page has drawn a frame that includes the effects of all commands so far, and draws no more; then
 * its panels show that frame. Call it while nothing plays: otherwise the page may always draw. Steps that were asked
 * for may still follow. A command without effect makes the session send such a frame.
 */
export async function settled(page) {
  await page.evaluate(async () => {
    const turns = async (count) => {
      for (let i = 0; i < count; ++i) await new Promise((done) => requestAnimationFrame(done));
    };
    const drawnLast = () => supple.drawTimes().at(-1);
    await turns(2);  // the page sends some commands before it draws
    await supple.client.ask(supple.model.request());
    for (const seen = supple.model.framesSeen; supple.model.framesSeen === seen; ) await turns(1);
    for (let last; !supple.isUpToDate || drawnLast() !== last; ) {
      last = drawnLast();
      await turns(2);
    }
    supple.tick();
  });
}

/** For what must not happen: the page goes on for half a second or longer, as many frames as it takes. */
export const goesOn = (page) =>
  page.evaluate(async () => {
    for (let i = 0; i < 30; ++i) await new Promise((done) => requestAnimationFrame(done));
  });

/** The box of the first plot, once it is as wide as the open tab and has all rows. */
export async function plotBox(page) {
  const plot = page.locator("#page-Plots .u-over").first();
  await plot.waitFor();
  await until(page, () => {
    const [tab, plot] = [".plots", ".plots .u-wrap"].map((part) => document.querySelector(`#page-Plots ${part}`).clientWidth);
    return tab > 0 && plot === Math.max(120, tab);
  });
  return plot.boundingBox();
}

/** A place of the window where the view shows the ground. */
export const groundPlace = (page) =>
  page.evaluate(() => {
    const { left, top } = document.querySelector("canvas.view").getBoundingClientRect();
    return { x: left + 12, y: top + 12 };
  });

/** The content of the canvas, as a text to compare. */
export const picture = (page) =>
  page.evaluate(() => {
    supple.draw();  // the canvas keeps its content only until the end of this task
    return document.querySelector("canvas.view").toDataURL();
  });

/** Where the active view shows points of the scene, in the window. */
export const placesOf = (page, points) => page.evaluate((points) => points.map((point) => supple.project(point)), points);

/** The colours of the picture at points of the scene, in the active view. */
export const coloursAt = async (page, points) => coloursIn(page, await placesOf(page, points));

/** The colours of the picture at places of the window. */
export const coloursIn = (page, places) =>
  page.evaluate((places) => {
    supple.draw();  // the canvas keeps its content only until the end of this task
    const view = document.querySelector("canvas.view");
    const copy = Object.assign(document.createElement("canvas"), { width: view.width, height: view.height });
    const context = copy.getContext("2d");
    context.drawImage(view, 0, 0);
    const frame = view.getBoundingClientRect();
    const scale = view.width / frame.width;
    return places.map(({ x, y }) => [...context.getImageData(Math.round((x - frame.left) * scale), Math.round((y - frame.top) * scale), 1, 1).data].slice(0, 3));
  }, places);

/** A position to click that hits a visible triangle not lower than `least`. */
export const seenTriangle = (page, object, least = -Infinity) =>
  page.evaluate(([object, least]) => {
    const { triangles } = supple.model.objects[object];
    for (let triangle = 0; triangle < triangles; ++triangle) {
      const middle = supple.centroid(object, triangle);
      if (middle[1] < least) continue;
      const { x, y } = supple.project(middle);
      const at = { x: Math.round(x), y: Math.round(y) };  // events of the pointer have whole pixels in Firefox
      const hit = supple.pickAt(at.x, at.y);
      if (hit?.object === object && hit.triangle === triangle) return { ...at, object, triangle, vertex: hit.vertex };
    }
    throw new Error(`no triangle of object ${object} is seen`);
  }, [object, least]);

/**
 * Opens a file whose session is under control of the test. `alter` receives each message, a function to send
 * a message, and the socket; `command` receives each command and a function to forward it. With `step` the page is
 * paused there.
 */
export async function pageWithMessages(stage, file, alter, command = (text, send) => send(text), options = [], step = null) {
  const program = await stage.program(file, ...options);
  const page = await stage.page();
  await page.routeWebSocket(/\/session/, (socket) => {
    const server = socket.connectToServer();
    const send = (bytes) => socket.send(bytes);
    socket.onMessage((text) => command(text, (altered) => server.send(altered), send));
    server.onMessage((message) => alter(Buffer.from(message), send, socket));
  });
  await page.goto(step === null ? program.address : atStep(program.address, step));
  if (step !== null) await isAt(page, step);
  return page;
}

/** A message of the given kind with the given text (viewer/PROTOCOL.md). */
export function textMessage(kind, json) {
  const text = Buffer.from(JSON.stringify(json));
  const length = 32 + Math.ceil(text.length / 16) * 16;
  const message = Buffer.alloc(length);
  message.writeUInt32LE(0x4c505553, 0);
  message.writeUInt16LE(2, 4);
  message.writeUInt16LE(kind, 6);
  message.writeUInt32LE(length, 8);
  message.writeUInt32LE(1, 12);
  message.writeUInt32LE(1, 16);
  message.writeUInt32LE(0xffffffff, 20);
  message.writeUInt32LE(text.length, 24);
  message.writeUInt32LE(text.length, 28);
  text.copy(message, 32);
  return message;
}

/** Two balls that are apart and at rest. */
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
