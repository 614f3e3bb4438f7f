// End-to-end tests of the viewer: they start the program and click, drag and type in a page in Chromium.
//
// usage: node e2e/run.mjs [--firefox] [--slow] [--size 1440|800|390] [--theme dark|light] PATH/TO/supple [WORDS OF A TEST'S NAME]
//
// With --slow the scripts of the page take eight times as long, so that tests that depend on its pace fail. Without --size and --theme each test has a size and a theme that follow from its name. With --firefox the tests
// of the main path run in Firefox, which has WebGL only with a screen: without one, a virtual screen (Xvfb).
// Exits with 77, which CTest reports as skipped, when there is no browser or no screen.
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readdirSync } from "node:fs";
import { cpus } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { parseArgs } from "node:util";
import { chromium, firefox } from "playwright-core";
import { CHROMIUM_FLAGS, chromiumPath, COARSE, firefoxPath, Stage } from "./tools/harness.mjs";
import { SIZES, THEMES, windowOf } from "./tools/sizes.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const results = join(here, "results");
/** Ends a test that hangs. */
const TEST_MILLISECONDS = 300_000;
/** With --slow, times as long. */
const PATIENCE = 3;
/** Browsers that run tests at the same time. */
const BROWSERS = Math.min(2, cpus().length);

/** What most people do, for another browser. */
const MAIN_PATH = [
  "live: moves, pauses and steps", "picking: a triangle is picked and read", "picking: the contact table flies to contacts",
  "picking: pulling a vertex makes contacts", "live: wrong values are refused at the field", "live: plots follow",
  "history: the past scrubs", "history: events are named by their pair", "history: a section loops",
  "recording: steps, plays to the end and loops", "page: keyboard alone", "page: Space plays everywhere",
  "page: views survive a reload", "live: a spectator sees the same and controls nothing",
];

/** Take long, and other tests take most of their path. They run with --size, as `.ci/run all` does, and by name. */
const LONG = [
  "attach: a program has spectators", "narrow: axe has no serious findings", "capture: warnings stay until they hold no more",
  "page: Space plays everywhere", "world: very large surfaces are flat", "capture: a body that blows up meanwhile",
  "narrow: controls stay where they are while it plays", "world: creases are dark", "one_file: survives a body that blows up",
  "narrow: everything is reached with a font of 200 %", "page: records a video", "capture: cancelling keeps what is there",
  "crowd: one is picked, and its row comes into sight", "layers: another bounding volume shows", "live: plots hold every step",
  "inside: the resting pointer shows the value of the field", "follow: buttons stay while values change", "follow: pins have each step",
  "capture: frames of a page without a program", "history: the memory of the past is bounded", "capture: a program that ends meanwhile",
  "live: settings keep the state, or say that they restart", "narrow: everything is reached at 800 and 390 pixels by touch",
  "page: a program that is started again", "page: views survive a reload", "live: events of both phases are counted",
  "live: the total of the plots has the motion", "marks: pairs are sorted by each column", "capture: a recording is saved up to a frame",
  "marks: dense marks thin out", "history: the timeline is reachable at every width", "capture: every third step is saved", "live: integrators change",
];

const USAGE = "usage: node e2e/run.mjs [--firefox] [--slow] [--size 1440|800|390] [--theme dark|light] PATH/TO/supple [WORDS OF A TEST'S NAME]";

/** The options and arguments; undefined when one is wrong. */
function readArguments() {
  try {
    const { values, positionals } = parseArgs({ allowPositionals: true, options: { firefox: { type: "boolean" }, slow: { type: "boolean" }, size: { type: "string" }, theme: { type: "string" } } });
    const isKnown = (value, known) => value === undefined || known.includes(value);
    const [program] = positionals;
    if (isKnown(values.size, Object.keys(SIZES)) && isKnown(values.theme, THEMES) && program && existsSync(program)) return { ...values, positionals };
  } catch (error) {
    console.error(error.message);
  }
}

const chosen = readArguments();
if (!chosen) {
  console.error(USAGE);
  process.exit(2);
}
const [program, ...words] = chosen.positionals;
const isFirefox = chosen.firefox ?? false;
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
  if (!LONG.every((name) => all.some((test) => test.name === name))) throw new Error("a long test is missing");
  const isWhole = chosen.size !== undefined || chosen.slow || isFirefox || words.length > 0;
  return wanted.filter(({ name }) => (isWhole || !LONG.includes(name)) && words.every((word) => name.includes(word)));
}

async function runTest({ name, body }, browser) {
  const { size, theme, slow } = { ...windowOf(name), ...chosen };
  const stage = new Stage(resolve(program), browser, COARSE, { size, theme, slow });
  let timer;
  const tooLong = new Promise((_, fail) => (timer = setTimeout(() => fail(new Error("it takes too long")), TEST_MILLISECONDS * (slow ? PATIENCE : 1))));
  const begin = Date.now();
  try {
    await Promise.race([body(stage), tooLong]);
    for (const page of stage.contexts.flatMap((context) => context.pages()))
      if (await page.evaluate(() => document.querySelector('[aria-label="The page has failed"]') !== null)) throw new Error("the page says that it has failed");
    if (stage.errors.length > 0) throw new Error(`the page has errors: ${stage.errors.join("; ")}`);
    console.log(`ok    ${name} (${size} ${theme}, ${((Date.now() - begin) / 1000).toFixed(1)} s)`);
    return true;
  } catch (error) {
    console.log(`FAIL  ${name} (${size} ${theme})\n      ${String(error?.stack ?? error).split("\n").slice(0, 8).join("\n      ")}`);
    for (const other of stage.errors) console.log(`      in the page: ${other}`);
    mkdirSync(results, { recursive: true });
    const page = stage.contexts.at(-1)?.pages().at(-1);
    await page?.screenshot({ path: join(results, `${name.replace(/[^a-z0-9]+/gi, "-")}-${size}-${theme}.png`), timeout: 5000 }).catch(() => {});
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
