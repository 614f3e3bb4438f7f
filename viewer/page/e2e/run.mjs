// End-to-end tests of the viewer: they start the program and click, drag and type in a page in Chromium.
//
// usage: node e2e/run.mjs PATH/TO/supple [WORDS OF A TEST'S NAME]
//
// Exits with 77, which CTest reports as skipped, when there is no Chromium.
import { existsSync, mkdirSync, readdirSync } from "node:fs";
import { cpus } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { CHROMIUM_FLAGS, chromiumPath, COARSE, Stage } from "./harness.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const results = join(here, "results");
const TEST_MILLISECONDS = 300_000;
/** Browsers that run tests at the same time. */
const BROWSERS = Math.min(2, cpus().length);

const [program, ...words] = process.argv.slice(2);
if (!program || !existsSync(program)) {
  console.error("usage: node e2e/run.mjs PATH/TO/supple [WORDS OF A TEST'S NAME]");
  process.exit(2);
}
const executable = chromiumPath();
if (!executable) {
  console.log("skipped: there is no Chromium (apt-get install chromium, or set SUPPLE_CHROMIUM)");
  process.exit(77);
}

async function loadTests() {
  const files = readdirSync(here).filter((name) => name.endsWith(".spec.mjs")).sort();
  const modules = await Promise.all(files.map((name) => import(pathToFileURL(join(here, name)).href)));
  const all = modules.flatMap((module, i) => module.tests.map(([name, body]) => ({ name: `${files[i].replace(".spec.mjs", "")}: ${name}`, body })));
  return all.filter(({ name }) => words.every((word) => name.includes(word)));
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
  const browser = await chromium.launch({ executablePath: executable, headless: true, args: CHROMIUM_FLAGS });
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
