// Measures the memory of a program and of its page over time: node e2e/tools/memory.mjs PATH/TO/supple SCENE [MINUTES]
import { existsSync, readFileSync } from "node:fs";
import { resolve } from "node:path";
import { chromium } from "playwright-core";
import { CHROMIUM_FLAGS, chromiumPath, hasFrame, Stage } from "./harness.mjs";

const LOOK_MILLISECONDS = 30_000;

const megabytesOf = (pid) => Number(/^Rss: +(\d+)/m.exec(readFileSync(`/proc/${pid}/smaps_rollup`, "utf8"))[1]) / 1000;

const [program, scene, minutes = "60"] = process.argv.slice(2);
if (!program || !existsSync(program) || !scene || !(Number(minutes) > 0)) {
  console.error("usage: node e2e/tools/memory.mjs PATH/TO/supple SCENE [MINUTES]");
  process.exit(2);
}
const browser = await chromium.launch({ executablePath: chromiumPath(), headless: true, args: CHROMIUM_FLAGS });
const stage = new Stage(resolve(program), browser);
try {
  const { address, child } = await stage.program(scene);
  const page = await stage.page({ viewport: { width: 700, height: 500 } });
  await page.goto(address);
  await hasFrame(page);
  const own = await page.context().newCDPSession(page);
  const all = await browser.newBrowserCDPSession();
  const begin = Date.now();
  console.log("minute,step,frames,program_mb,page_mb,heap_mb");
  for (let minute = 0; minute <= Number(minutes); minute = (Date.now() - begin) / 60_000) {
    await own.send("HeapProfiler.collectGarbage");
    const { usedSize } = await own.send("Runtime.getHeapUsage");
    const { processInfo } = await all.send("SystemInfo.getProcessInfo");
    const pages = processInfo.filter(({ type }) => type === "renderer").map(({ id }) => megabytesOf(id));
    const [step, frames] = await page.evaluate(() => [supple.model.frame.text.step, supple.model.framesSeen]);
    console.log([minute.toFixed(1), step, frames, megabytesOf(child.pid).toFixed(1), Math.max(...pages).toFixed(1), (usedSize / 1e6).toFixed(1)].join(","));
    await new Promise((done) => setTimeout(done, LOOK_MILLISECONDS));
  }
} finally {
  await stage.cleanUp();
  await browser.close();
}
