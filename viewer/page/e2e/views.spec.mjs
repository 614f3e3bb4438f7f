// View files, links to a moment, and figures.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { atStep, camera, hasFrame, isAt, picture, runProgram, said, scenes, settled, steps, TWO_BALLS, until } from "./tools/harness.mjs";

const nine = join(scenes, "nine.toml");

async function downloaded(stage, page, click) {
  const [download] = await Promise.all([page.waitForEvent("download"), click()]);
  const path = stage.file(download.suggestedFilename());
  await download.saveAs(path);
  return path;
}

const button = (page, name) => page.getByRole("group", { name: "View file" }).getByRole("button", { name });
const saveView = (stage, page) => downloaded(stage, page, () => button(page, "Save view").click());
const loadView = (page, file) => page.getByLabel("View file", { exact: true }).and(page.locator("input")).setInputFiles(file);

/** Drags a file of this text onto the page. */
const dropFile = (page, text) =>
  page.evaluate((text) => {
    const data = new DataTransfer();
    data.items.add(new File([text], "view.json", { type: "application/json" }));
    for (const type of ["dragover", "drop"]) document.body.dispatchEvent(new DragEvent(type, { dataTransfer: data, bubbles: true, cancelable: true }));
  }, text);

/** Makes a view that differs from the first one in every part. */
async function arrange(page) {
  await page.getByRole("checkbox", { name: "Wireframe" }).check();
  await page.getByRole("checkbox", { name: "Object octrees" }).check();
  await page.getByRole("checkbox", { name: "X-ray" }).check();
  await page.getByRole("combobox", { name: "Slice", exact: true }).selectOption("slice in x");
  await page.getByRole("combobox", { name: "Axis view" }).selectOption("left");
  await page.keyboard.press("o");
  await page.keyboard.press("+");
  await page.getByRole("button", { name: /^left/ }).click();
  await page.getByLabel("Opacity of left").fill("0.4");
  await page.getByLabel("Colour of left").fill("#aa3366");
  await page.evaluate(() => supple.model.clearSelection());  // it is not part of a view
  await page.getByRole("tab", { name: "Contacts" }).click();
  await page.getByRole("searchbox").fill("left");
  await settled(page);
}

async function savedChangedLoaded(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  await settled(page);
  const first = await picture(page);
  const plain = await saveView(stage, page);
  await arrange(page);
  const arranged = await picture(page);
  assert.ok(arranged !== first);
  const file = await saveView(stage, page);
  assert.equal(JSON.parse(readFileSync(file)).objects.left.colour, "#aa3366");

  await loadView(page, plain);
  await until(page, () => !supple.model.layers.wireframe);
  await settled(page);
  assert.ok((await picture(page)) === first, "the first view is another picture");
  assert.equal(await page.getByRole("checkbox", { name: "Object octrees" }).isChecked(), false);
  assert.equal(await page.getByRole("searchbox").inputValue(), "");
  assert.equal(await page.getByRole("button", { name: "Orthographic" }).count(), 1);

  await dropFile(page, readFileSync(file, "utf8"));
  await until(page, () => supple.counts().boxes > 0);
  await settled(page);
  assert.ok((await picture(page)) === arranged, "the loaded view is another picture");
  assert.equal(await page.getByRole("searchbox").inputValue(), "left");
  assert.equal(await page.getByRole("combobox", { name: "Slice", exact: true }).inputValue(), "x");

  // The program and an exported page begin with it.
  const { page: begun } = await stage.view(stage.file("balls.toml"), "--view", file);
  await until(begun, () => supple.counts().boxes > 0);
  await settled(begun);
  assert.ok((await picture(begun)) === arranged, "the program begins with another picture");
  const exported = stage.file("page.html");
  await runProgram(stage.supple, ["view", stage.file("balls.toml"), "--export", exported, "--view", file]);
  const carried = await stage.page();
  await carried.goto(pathToFileURL(exported).href);
  await hasFrame(carried);
  await until(carried, () => supple.counts().boxes > 0);
  await settled(carried);
  assert.ok((await picture(carried)) === arranged, "the exported page begins with another picture");
}

async function malformedFilesChangeNothing(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  await settled(page);
  const before = await picture(page);
  for (const [text, sentence] of [
    ["{", "This is no view file: it is not JSON"],
    ['{"version": 1, "layers": {"wireframe": true}, "marks": {"slice_at": 3}}', "marks.slice_at is not a number from 0 to 1. Nothing is changed."],
    ['{"version": 1, "layer": {}}', "layer is unknown. Nothing is changed."],
  ]) {
    await loadView(page, { name: "view.json", mimeType: "application/json", buffer: Buffer.from(text) });
    await said(page, sentence);
  }
  await settled(page);
  assert.ok((await picture(page)) === before);
}

/** The address that a click copies. */
async function copiedLink(page) {
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await button(page, "Copy link").click();
  await said(page, "The link to this moment is copied.");
  return page.evaluate(() => navigator.clipboard.readText());
}

async function linkToAFrame(stage) {
  const file = stage.file("run.h5");
  await runProgram(stage.supple, ["simulate", nine, "--frames", "21", "--record", file, "--quiet"]);
  const { page } = await stage.viewAt(0, file);
  await page.getByRole("slider", { name: "Timeline" }).fill("12");
  await isAt(page, 12);
  await page.getByRole("checkbox", { name: "Wireframe" }).check();
  await page.getByRole("combobox", { name: "Axis view" }).selectOption("top");
  await settled(page);
  const seen = await picture(page);
  const link = await copiedLink(page);
  const other = await stage.page();
  await other.goto(link);
  await isAt(other, 12);
  await settled(other);
  assert.ok((await picture(other)) === seen);
  assert.equal(await other.evaluate(() => supple.playing), false);

  const damaged = await stage.page();
  await damaged.goto(link.slice(0, -30));
  await said(damaged, "The link is damaged");
  await hasFrame(damaged);
}

/** A page without a clipboard shows the link. A new session takes the steps up to it. */
async function linkToAStep(stage) {
  const file = stage.file("page.html");
  await runProgram(stage.supple, ["view", nine, "--export", file]);
  const open = async (address) => {
    const page = await stage.page({ offline: true });
    await page.addInitScript(() => Object.defineProperty(navigator, "clipboard", { value: undefined }));
    await page.goto(address);
    await hasFrame(page);
    return page;
  };
  const page = await open(atStep(pathToFileURL(file).href, 0));
  const at = 7;
  await steps(page, at);
  await button(page, "Copy link").click();
  const link = await page.getByRole("textbox", { name: "Link" }).inputValue();
  const seen = await page.evaluate(() => [...supple.model.positions]);
  const other = await open(link);
  await isAt(other, at);
  assert.deepEqual(await other.evaluate(() => [...supple.model.positions]), seen);
  const [a, b] = [await camera(page), await camera(other)];
  for (const part of ["position", "target"]) b[part].forEach((x, i) => assert.ok(Math.abs(x - a[part][i]) < 1e-9, `${x} is not ${a[part][i]}`));
}

/** Reads the chunks of a PNG. */
function chunksOf(bytes) {
  const chunks = {};
  for (let at = 8; at < bytes.length; at += 12 + bytes.readUInt32BE(at)) chunks[bytes.toString("latin1", at + 4, at + 8)] = bytes.subarray(at + 8, at + 8 + bytes.readUInt32BE(at));
  return chunks;
}

async function openFigures(page) {
  await page.getByRole("button", { name: "Save frames as pictures…" }).click();
  const dialog = page.getByRole("dialog", { name: "Save frames as pictures" });
  await dialog.getByRole("combobox", { name: "Size" }).selectOption({ label: "Own size" });
  return dialog;
}

async function figureInMillimetres(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  const dialog = await openFigures(page);
  await dialog.getByRole("combobox", { name: "Unit" }).selectOption("mm");
  assert.equal(await dialog.getByRole("spinbutton", { name: "Pixels per inch" }).inputValue(), "300");
  await dialog.getByRole("spinbutton", { name: "Width" }).fill("50.8");
  await dialog.getByRole("spinbutton", { name: "Height" }).fill("25.4");
  await dialog.getByRole("combobox", { name: "Background" }).selectOption("White");
  const save = () => downloaded(stage, page, () => dialog.getByRole("button", { name: "Save", exact: true }).click());
  const plain = readFileSync(await save());
  const { IHDR, pHYs } = chunksOf(plain);
  assert.deepEqual([IHDR.readUInt32BE(0), IHDR.readUInt32BE(4)], [600, 300]);
  assert.deepEqual([pHYs.readUInt32BE(0), pHYs.readUInt32BE(4), pHYs[8]], [11811, 11811, 1]);

  await openFigures(page);
  await dialog.getByRole("checkbox", { name: "Legend with the names of objects" }).check();
  await dialog.getByRole("checkbox", { name: "Scale bar" }).check();
  const drawn = readFileSync(await save());
  const colourAt = (png, x, y) =>
    page.evaluate(async ([data, x, y]) => {
      const image = await createImageBitmap(new Blob([Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0))]));
      const context = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height }).getContext("2d");
      context.drawImage(image, 0, 0);
      return [...context.getImageData(x, y, 1, 1).data];
    }, [png.toString("base64"), x, y]);
  const swatch = [55, 55];  // the middle of the first swatch, at 300 pixels per inch
  assert.deepEqual(await colourAt(plain, ...swatch), [255, 255, 255, 255]);
  assert.deepEqual(await colourAt(drawn, ...swatch), [0x8e, 0xca, 0xe6, 255]);
  const bar = [600 - 3.125 * 14, 300 - 3.125 * 14];
  assert.deepEqual(await colourAt(drawn, ...bar), [0x1b, 0x20, 0x27, 255]);

  await openFigures(page);
  await dialog.getByRole("combobox", { name: "Format" }).selectOption("SVG of lines");
  const svg = readFileSync(await save(), "utf8");
  const { width, paths, texts, error } = await page.evaluate((svg) => {
    const root = new DOMParser().parseFromString(svg, "image/svg+xml").documentElement;
    return {
      width: root.getAttribute("width"), paths: root.querySelectorAll("path").length, error: root.querySelector("parsererror")?.textContent,
      texts: [...root.querySelectorAll("text")].map((text) => text.textContent),
    };
  }, svg);
  assert.equal(error, undefined);
  assert.equal(width, "50.8mm");
  assert.equal(paths, 2);
  assert.deepEqual(texts.slice(0, 2), ["left", "right"]);
  assert.match(texts[2], /^[\d.]+ \(at the target\)$/);

  await page.getByRole("combobox", { name: "Slice", exact: true }).selectOption("slice in x");
  await openFigures(page);
  await dialog.getByRole("button", { name: "Save", exact: true }).click();
  await said(page, "An SVG cannot show a slice.");
}

async function plotAsSvg(stage) {
  const { page } = await stage.viewAt(25, nine);
  await page.getByRole("tab", { name: "Plots" }).click();
  const svg = readFileSync(await downloaded(stage, page, () => page.getByRole("button", { name: "Save Contacts and candidates as SVG" }).click()), "utf8");
  const seen = await page.evaluate((svg) => {
    const root = new DOMParser().parseFromString(svg, "image/svg+xml").documentElement;
    const lines = [...root.querySelectorAll("path[stroke-linejoin]")].map((line) => line.getAttribute("d").split(/[ML]/).length - 1);
    return { lines, texts: [...root.querySelectorAll("text")].map((text) => text.textContent), rows: supple.model.history.frames.length };
  }, svg);
  assert.deepEqual(seen.lines, [seen.rows, seen.rows]);
  for (const text of ["Contacts and candidates", "contacts", "candidate pairs", "step"]) assert.ok(seen.texts.includes(text), text);
}

/** What `supple render` draws of a saved view is what the page draws. */
async function renderDrawsTheView(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  await arrange(page);
  const file = await saveView(stage, page);
  const dialog = await openFigures(page);
  await dialog.getByRole("spinbutton", { name: "Width" }).fill("320");
  await dialog.getByRole("spinbutton", { name: "Height" }).fill("200");
  await dialog.getByRole("spinbutton", { name: "Pixels per inch" }).fill("96");
  await dialog.getByRole("combobox", { name: "Background" }).selectOption("Transparent");
  const saved = await downloaded(stage, page, () => dialog.getByRole("button", { name: "Save", exact: true }).click());
  const drawn = stage.file("drawn.png");
  const options = ["--view", file, "--size", "320x200", "--dpi", "96", "--background", "transparent", "--quiet", "-o", drawn];
  await runProgram(stage.supple, ["render", stage.file("balls.toml"), ...options]);
  // Pages of tests draw without antialiasing, so only edges differ.
  const different = await page.evaluate(async (files) => {
    const [a, b] = await Promise.all(files.map(async (data) => {
      const image = await createImageBitmap(new Blob([Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0))]));
      const context = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height }).getContext("2d");
      context.drawImage(image, 0, 0);
      return context.getImageData(0, 0, image.width, image.height).data;
    }));
    let count = 0;
    for (let i = 0; i < a.length; i += 4) if ([0, 1, 2, 3].some((k) => Math.abs(a[i + k] - b[i + k]) > 40)) ++count;
    return count / (a.length / 4);
  }, [saved, drawn].map((path) => readFileSync(path).toString("base64")));
  assert.ok(different < 0.05, `${100 * different} % of the pixels differ`);
  writeFileSync(stage.file("bad.json"), '{"version": 1, "tab": "Plot"}');
  await assert.rejects(runProgram(stage.supple, ["view", stage.file("balls.toml"), "--view", stage.file("bad.json")]), /tab is not one of Inspect, Contacts/);
}

export const tests = [
  ["saved, changed, loaded: the same picture", savedChangedLoaded],
  ["malformed files change nothing", malformedFilesChangeNothing],
  ["a link to a frame of a recording", linkToAFrame],
  ["a link to a step of a simulation", linkToAStep],
  ["a figure in millimetres, as PNG and as SVG", figureInMillimetres],
  ["a plot as SVG", plotAsSvg],
  ["render draws the view that the page saved", renderDrawsTheView],
];
