// End-to-end tests of the viewer: they start the program and click, drag and type in a page in Chromium.
//
// usage: node e2e/run.mjs [--firefox] PATH/TO/supple [WORDS OF A TEST'S NAME]
//
// With --firefox the tests of the main path run in Firefox, which has WebGL only with a screen: without one, a
// virtual screen (Xvfb). Exits with 77, which CTest reports as skipped, when there is no browser or no screen.
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readdirSync } from "node:fs";
import { cpus } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium, firefox } from "playwright-core";
import { CHROMIUM_FLAGS, chromiumPath, COARSE, firefoxPath, Stage } from "./harness.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const results = join(here, "results");
const TEST_MILLISECONDS = 300_000;
/** Browsers that run tests at the same time. */
const BROWSERS = Math.min(2, cpus().length);

/** What most people do, for another browser. */
const MAIN_PATH = [
  "live: moves, pauses and steps", "live: a triangle is picked and read", "live: the contact table flies to contacts",
  "live: pulling a vertex makes contacts", "live: wrong values are refused at the field", "live: plots follow",
  "history: the past scrubs", "history: events are named by their pair", "history: a section loops",
  "recording: steps, plays to the end and loops", "page: Space plays everywhere",
  "page: views survive a reload", "spectators: a spectator sees the same and controls nothing",
];

const isFirefox = process.argv[2] === "--firefox";
const [program, ...words] = process.argv.slice(isFirefox ? 3 : 2);
if (!program || !existsSync(program)) {
  console.error("usage: node e2e/run.mjs [--firefox] PATH/TO/supple [WORDS OF A TEST'S NAME]");
  process.exit(2);
}
const executable = isFirefox ? firefoxPath() : chromiumPath();
if (!executable) {
  console.log(isFirefox ? "skipped: there is no Firefox (apt-get install firefox-esr, or set SUPPLE_FIREFOX)" : "skipped: there is no Chromium (apt-get install chromium, or set SUPPLE_CHROMIUM)");
  process.exit(77);
}
if (isFirefox && !process.env.DISPLAY) {
  const screen = spawnSync("xvfb-run", ["-a", "-s", "-screen 0 1600x1200x24", process.execPath, ...process.argv.slice(1)], { stdio: "inherit" });
  if (screen.error) console.log("skipped: there is no screen (apt-get install xvfb xauth)");
  process.exit(screen.error ? 77 : (screen.status ?? 1));
}

const launch = () =>
  isFirefox
    ? firefox.launch({ channel: "moz-firefox", executablePath: executable, headless: false })
    : chromium.launch({ executablePath: executable, headless: true, args: CHROMIUM_FLAGS });

async function loadTests() {
  const files = readdirSync(here).filter((name) => name.endsWith(".spec.mjs")).sort();
  const modules = await Promise.all(files.map((name) => import(pathToFileURL(join(here, name)).href)));
  const all = modules.flatMap((module, i) => module.tests.map(([name, body]) => ({ name: `${files[i].replace(".spec.mjs", "")}: ${name}`, body })));
  const wanted = isFirefox && words.length === 0 ? all.filter(({ name }) => MAIN_PATH.includes(name)) : all;
  if (wanted !== all && wanted.length < MAIN_PATH.length) throw new Error("a test of the main path is missing");
  return wanted.filter(({ name }) => words.every((word) => name.includes(word)));
}

async function runTest({ name, body }, browser) {
  const stage = new Stage(resolve(program), browser, COARSE);
  let timer;
  const tooLong = new Promise((_, fail) => (timer = setTimeout(() => fail(new Error("it takes too long")), TEST_MILLISECONDS)));
  const begin = Date.now();
  try {
    await Promise.race([body(stage), tooLong]);
    for (const page of stage.contexts.flatMap((context) => context.pages()))
      if (await page.locator('[aria-label="The page has failed"]').count()) throw new Error("the page says that it has failed");
    if (stage.errors.length > 0) throw new Error(`the page has errors: ${stage.errors.join("; ")}`);
    console.log(`ok    ${name} (${((Date.now() - begin) / 1000).toFixed(1)} s)`);
    return true;
  } catch (error) {
    console.log(`FAIL  ${name}\n      ${String(error?.stack ?? error).split("\n").slice(0, 8).join("\n      ")}`);
    for (const other of stage.errors) console.log(`      in the page: ${other}`);
    mkdirSync(results, { recursive: true });
    const page = stage.contexts.at(-1)?.pages().at(-1);
    await page?.screenshot({ path: join(results, `${name.replace(/[^a-z0-9]+/gi, "-")}.png`), timeout: 5000 }).catch(() => {});
    return false;
  } finally {
    clearTimeout(timer);
    await stage.cleanUp();
  }
}

/** Runs tests one after the other until none is left; returns how many failed. */
async function runTests(waiting) {
  const browser = await launch();
  let failed = 0;
  try {
    for (let test; (test = waiting.shift()); ) if (!(await runTest(test, browser))) failed += 1;
  } finally {
    await browser.close();
  }
  return failed;
}

const begin = Date.now();
const tests = await loadTests();
const waiting = [...tests];
const failures = await Promise.all(Array.from({ length: Math.min(BROWSERS, tests.length) }, () => runTests(waiting)));
const failed = failures.reduce((sum, count) => sum + count, 0);
console.log(`${tests.length - failed} passed, ${failed} failed (${((Date.now() - begin) / 1000).toFixed(0)} s)`);
process.exitCode = failed > 0 || tests.length === 0 ? 1 : 0;
