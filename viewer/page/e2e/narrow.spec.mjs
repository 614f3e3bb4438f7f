// Small windows, zoom, large fonts, touch, accessibility, names and icons.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { hasFrame, pause, scenes, settled, simulateTo, until } from "./tools/harness.mjs";
import { SIZES } from "./tools/sizes.mjs";

const nine = join(scenes, "nine.toml");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const TABS = ["Inspect", "Contacts", "Curves", "Pins", "Plots", "Settings"];

async function open(stage, options) {
  const program = await stage.program(nine);
  const page = await stage.page(options);
  await page.goto(program.address);
  await hasFrame(page);
  await simulateTo(page, 20);
  return page;
}

/** Scrolls to the element, and fails when its middle is not visible or something else covers it. */
async function isReachable(page, locator) {
  await locator.scrollIntoViewIfNeeded();
  const covered = await locator.evaluate((element) => {
    const { left, top, width, height } = element.getBoundingClientRect();
    const [x, y] = [left + width / 2, top + height / 2];
    const hit = document.elementFromPoint(x, y);
    return element.contains(hit) || hit?.contains(element) || hit?.closest("label") ? null : `${element.outerHTML.slice(0, 90)} at ${x}, ${y} is below ${hit?.outerHTML.slice(0, 90)}`;
  });
  assert.equal(covered, null);
}

/** Opens each drawer and tab by `press`, and reaches what is in them. */
async function reachesEverything(page, press) {
  const opens = async (name) => {
    const button = page.getByRole("button", { name, exact: true });
    await isReachable(page, button);
    await press(button);
    await until(page, (name) => document.body.dataset.drawer === name, name.toLowerCase());
  };
  const closes = async (name) => {
    await press(page.getByRole("button", { name: `Close ${name}` }));
    await until(page, () => !document.body.dataset.drawer);
  };
  for (const name of ["Frame all", "Save a picture", "Light or dark", "Keyboard shortcuts", "Play"]) await isReachable(page, page.getByRole("button", { name }));
  for (const name of ["Select", "Grab and pull", "Why no contact?"]) await isReachable(page, page.getByRole("radio", { name }));
  await isReachable(page, page.getByRole("combobox", { name: "Speed" }));
  await isReachable(page, page.locator("canvas.view"));
  await opens("Scene");
  for (const name of ["Show pawn 1", "Wireframe", "Contact points"]) await isReachable(page, page.getByRole("checkbox", { name }));
  await closes("Scene");
  await opens("Details");
  for (const name of TABS) {
    const tab = page.getByRole("tab", { name });
    await isReachable(page, tab);
    await press(tab);
    await page.getByRole("tab", { name, selected: true }).waitFor();
    await isReachable(page, page.locator(`#page-${name}`));
  }
  await isReachable(page, page.getByLabel("Time step"));
  await closes("Details");
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  assert.equal(overflow, 0, "the page scrolls sideways");
}

const tap = (locator) => locator.tap();
const byKey = async (locator) => {
  await locator.focus();
  await locator.press("Enter");
};

async function bySizes(stage) {
  for (const [width, height] of [[800, 600], [390, 800]]) {
    const page = await open(stage, { viewport: { width, height }, hasTouch: true });
    await reachesEverything(page, tap);
  }
}

/** 400 % of a window of 1280 × 1024. */
async function byZoom(stage) {
  const page = await open(stage, { viewport: { width: 320, height: 256 }, hasTouch: true });
  await reachesEverything(page, tap);
}

async function byKeys(stage) {
  const page = await open(stage, { viewport: { width: 390, height: 800 } });
  await reachesEverything(page, byKey);
  // The focus follows: into a drawer, and back to its button by Escape.
  const button = page.getByRole("button", { name: "Details", exact: true });
  await byKey(button);
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.getAttribute("aria-label")), "Close Details");
  await page.keyboard.press("Escape");
  await until(page, () => !document.body.dataset.drawer);
  assert.ok(await button.evaluate((element) => element === document.activeElement));
}

async function byFont(stage) {
  for (const width of [1440, 390]) {
    const page = await open(stage, { viewport: { width, height: 900 } });
    const height = () => page.getByRole("button", { name: "Frame all" }).evaluate((element) => element.getBoundingClientRect().height);
    const before = await height();
    await page.addStyleTag({ content: "html { font-size: 200% }" });
    assert.ok(Math.abs((await height()) - 2 * before) < 3, "sizes do not follow the font");
    await reachesEverything(page, byKey);
  }
}

/** Text has at least 12 pixels. */
async function textIsLargeEnough(stage) {
  const page = await open(stage);
  for (const name of TABS) {
    await page.getByRole("tab", { name }).click();
    await settled(page);
    const small = await page.evaluate(() =>
      [...document.querySelectorAll("body *")]
        .filter((element) => element.checkVisibility() && [...element.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.textContent.trim()))
        .filter((element) => parseFloat(getComputedStyle(element).fontSize) < 12)
        .map((element) => `${element.outerHTML.slice(0, 80)}: ${getComputedStyle(element).fontSize}`),
    );
    assert.deepEqual(small, []);
  }
}

async function everythingHasAName(stage) {
  const { page } = await stage.view(nine);
  for (const tab of ["Inspect", "Contacts", "Plots", "Settings"]) {
    await page.getByRole("tab", { name: tab }).click();
    const nameless = await page.evaluate(() =>
      [...document.querySelectorAll("button, input, select, canvas.view, [role=grid]")]
        .filter((element) => element.offsetParent !== null)
        .filter((element) => !(element.getAttribute("aria-label") || element.getAttribute("aria-labelledby") || element.textContent.trim() || element.labels?.length))
        .map((element) => element.outerHTML.slice(0, 120)),
    );
    assert.deepEqual(nameless, []);
  }
}

/** Also what a button shows after it was pressed. */
async function noTwoIconsAreAlike(stage) {
  const { page } = await stage.view(nine);
  await pause(page);
  const drawn = new Map();
  const look = async () => {
    const icons = await page.evaluate(async () => {
      const pixels = async (svg) => {
        const image = Object.assign(new Image(), { src: `data:image/svg+xml,${encodeURIComponent(svg.outerHTML.replace("<svg", '<svg xmlns="http://www.w3.org/2000/svg"'))}` });
        await image.decode();
        const context = new OffscreenCanvas(32, 32).getContext("2d");
        context.drawImage(image, 0, 0, 32, 32);
        return [...context.getImageData(0, 0, 32, 32).data].filter((_, i) => i % 4 === 3);
      };
      return Promise.all([...document.querySelectorAll("button:has(svg)")].map(async (button) => [button.getAttribute("aria-label"), await pixels(button.querySelector("svg"))]));
    });
    for (const [name, pixels] of icons) drawn.set(name, pixels);
  };
  await look();
  assert.ok(drawn.size > 15, `${drawn.size} buttons have icons`);
  await page.getByRole("button", { name: "Orthographic" }).click();
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await page.getByRole("button", { name: "Pause" }).waitFor();
  await look();
  const ink = (pixels) => pixels.reduce((sum, alpha) => sum + alpha, 0);
  const pairs = [...drawn].flatMap(([a, one], i) => [...drawn].slice(i + 1).map(([b, other]) => ({ names: `${a} and ${b}`, apart: one.reduce((sum, alpha, k) => sum + Math.abs(alpha - other[k]), 0) / Math.max(ink(one), ink(other)) })));
  for (const { names, apart } of pairs) assert.ok(apart > 0.4, `the icons of ${names} differ in ${Math.round(100 * apart)} % of their ink`);
}

async function accessible(stage) {
  for (const colorScheme of ["dark", "light"]) {
    for (const viewport of [{ width: 1440, height: 900 }, { width: 390, height: 800 }]) {
      const page = await open(stage, { viewport, colorScheme });
      await page.evaluate(axe);
      await page.evaluate(() => supple.pins.add([0, 1]));
      const check = async (place) => {
        const found = await page.evaluate(async () => {
          const { violations } = await window.axe.run(document, { resultTypes: ["violations"] });
          return violations
            .filter(({ impact }) => impact === "serious" || impact === "critical")
            .map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map(({ html, any }) => `${html.slice(0, 100)} (${any[0]?.message ?? ""})`).join("; ")}`);
        });
        assert.deepEqual(found, [], `${place}, ${colorScheme}, ${viewport.width}`);
      };
      const isNarrow = viewport.width < 900;
      await check("view");
      if (isNarrow) {
        await page.getByRole("button", { name: "Scene", exact: true }).click();
        await check("Scene");
        await page.getByRole("button", { name: "Close Scene" }).click();
        await page.getByRole("button", { name: "Details", exact: true }).click();
      }
      for (const name of TABS) {
        await page.getByRole("tab", { name }).click();
        await settled(page);
        await check(name);
      }
      if (isNarrow) await page.getByRole("button", { name: "Close Details" }).click();
      await page.keyboard.press("Shift+P");
      const dialog = page.getByRole("dialog", { name: "Save frames as pictures" });
      await dialog.getByRole("combobox", { name: "Size" }).selectOption({ label: "Own size" });
      await dialog.getByRole("combobox", { name: "Format" }).selectOption("SVG of lines");
      await check("dialog of frames");
      const inside = await dialog.evaluate((element) => element.scrollWidth <= element.clientWidth);
      assert.ok(inside, `the dialog is wider than its box, ${viewport.width}`);
      await page.keyboard.press("Escape");
      await dialog.waitFor({ state: "hidden" });
      await page.keyboard.press("Control+k");
      await page.getByRole("dialog", { name: "Command palette" }).waitFor();
      await check("palette");
    }
  }
}

/** Buttons, lists and fields that have been at more than one place until the condition holds. */
const movedUntil = (page, condition) =>
  page.evaluate(async (condition) => {
    const places = new Map();
    const holds = new Function(`return (${condition})()`);
    for (let last = false; !last; ) {
      last = holds();
      for (const element of document.querySelectorAll("button, select, input")) {
        if (!element.checkVisibility({ visibilityProperty: true })) continue;
        const { x, y } = element.getBoundingClientRect();
        if (!places.has(element)) places.set(element, new Set());
        places.get(element).add(`${Math.round(x)}, ${Math.round(y)}`);
      }
      await new Promise((done) => requestAnimationFrame(done));
    }
    const nameOf = (element) => element.getAttribute("aria-label") ?? element.closest("label")?.textContent ?? element.textContent;
    return [...places].filter(([, { size }]) => size > 1).map(([element, seen]) => `${nameOf(element)}: ${[...seen].join(" ")}`);
  }, String(condition));

/** A finger that aims at a button meets it: texts that change move no control. */
async function controlsStay(stage) {
  for (const size of Object.values(SIZES)) {
    const program = await stage.program(join(scenes, "fish_tank.toml"));  // gaps and contacts begin and end
    const page = await stage.page(size);
    await page.goto(program.address);
    await hasFrame(page);
    const drawer = page.getByRole("button", { name: "Scene", exact: true });
    if (await drawer.isVisible()) await drawer.click();
    await page.evaluate(() => {
      window.first = supple.model.frame.text.step;
      supple.client.send({ do: "play" });
    });
    const moved = await movedUntil(page, () => supple.model.frame.text.step > first + 15 && document.querySelector(".rate").textContent !== "");
    await page.evaluate(() => {
      window.looks = 0;
      supple.client.send({ do: "seek", frame: 0 });
      supple.client.send({ do: "loop", on: true, from: 0, to: 5 });
      supple.client.send({ do: "play" });
      supple.model.on("frame", ({ text }) => (looks += text.past ? 1 : 0));
    });
    moved.push(...(await movedUntil(page, () => looks > 8)));
    assert.deepEqual(moved, [], `${size.viewport.width} pixels`);
    await program.stop();
  }
}

export const tests = [
  ["controls stay where they are while it plays", controlsStay],
  ["everything is reached at 800 and 390 pixels by touch", bySizes],
  ["everything is reached at 400 % zoom by touch", byZoom],
  ["everything is reached at 390 pixels by keys", byKeys],
  ["everything is reached with a font of 200 %", byFont],
  ["text is large enough", textIsLargeEnough],
  ["everything has a name", everythingHasAName],
  ["no two icons are alike", noTwoIconsAreAlike],
  ["axe has no serious findings", accessible],
];
