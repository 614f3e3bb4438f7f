// Saving frames as pictures, layers that the session drops, and warnings.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { unzipSync } from "fflate";
import { goesOn, isAt, pageWithMessages, runProgram, said, scenes, settled, step, textMessage, TWO_BALLS, until } from "./tools/harness.mjs";

const nine = join(scenes, "nine.toml");
const dialogOf = (page) => page.getByRole("dialog", { name: "Save frames as pictures" });

async function openDialog(page) {
  await page.getByRole("button", { name: "Save frames as pictures…" }).click();
  const dialog = dialogOf(page);
  await dialog.waitFor();
  await until(page, () => supple.model.frame?.text.playing === false);
  return dialog;
}

async function chooseSize(dialog, width, height) {
  await dialog.getByRole("combobox", { name: "Size" }).selectOption({ label: "Own size" });
  await dialog.getByRole("spinbutton", { name: "Width" }).fill(String(width));
  await dialog.getByRole("spinbutton", { name: "Height" }).fill(String(height));
}

/** The file that a click saves: its name and its bytes. */
async function savedBy(stage, page, click) {
  const [download] = await Promise.all([page.waitForEvent("download"), click()]);
  const path = stage.file(download.suggestedFilename());
  await download.saveAs(path);
  return { name: download.suggestedFilename(), bytes: readFileSync(path) };
}

const save = (stage, page) => savedBy(stage, page, () => dialogOf(page).getByRole("button", { name: "Save", exact: true }).click());

function sizeOf(png) {
  const bytes = Buffer.from(png);
  assert.equal(bytes.toString("latin1", 1, 4), "PNG");
  assert.equal(bytes.toString("latin1", 12, 16), "IHDR");
  return [bytes.readUInt32BE(16), bytes.readUInt32BE(20)];
}

/** The pictures of a ZIP in order, checked for their size, and its description. */
function readZip({ name, bytes }, size) {
  assert.match(name, /^supple-.*\.zip$/);
  const files = unzipSync(bytes);
  const told = JSON.parse(new TextDecoder().decode(files["frames.json"]));
  delete files["frames.json"];
  assert.deepEqual(Object.keys(files), told.frames.map(({ file }) => file));
  for (const { file, step } of told.frames) {
    assert.equal(file, `frame_${String(step).padStart(6, "0")}.png`);
    assert.deepEqual(sizeOf(files[file]), size);
  }
  return { pictures: Object.values(files).map((picture) => Buffer.from(picture)), told, steps: told.frames.map(({ step }) => step) };
}

const stepsFrom = (first, count, every) => Array.from({ length: count }, (_, i) => first + i * every);
const bufferSize = (page) => page.evaluate(() => ({ width: document.querySelector("canvas.view").width, height: document.querySelector("canvas.view").height }));

function assertAllDiffer(pictures) {
  assert.equal(new Set(pictures.map((picture) => picture.toString("base64"))).size, pictures.length, "pictures of different steps are the same");
}

async function savesEachStep(stage) {
  const { page } = await stage.viewAt(4, nine);
  const before = await bufferSize(page);
  const dialog = await openDialog(page);
  const first = await step(page);
  await chooseSize(dialog, 640, 360);
  await dialog.getByRole("spinbutton", { name: "Pictures" }).fill("12");
  await dialog.getByText(`12 pictures, of step ${first} to ${first + 11}, in one ZIP; 640 × 360 pixels.`).waitFor();
  const { pictures, told, steps } = readZip(await save(stage, page), [640, 360]);
  assert.deepEqual(steps, stepsFrom(first, 12, 1));
  assertAllDiffer(pictures);
  assert.equal(told.title, "nine.toml");
  assert.equal(told.ended, null);
  const timeStep = await page.evaluate(() => supple.model.scene.time_step);
  for (const { step, time } of told.frames) assert.ok(Math.abs(time - step * timeStep) < 1e-9);
  const seen = await page.evaluate(() => supple.camera());
  told.camera.position.forEach((x, i) => assert.ok(Math.abs(x - seen.position[i]) < 1e-9));
  await said(page, "12 pictures are saved");
  assert.equal(await dialog.isVisible(), false);
  assert.deepEqual(await bufferSize(page), before, "the view is not as large as before");
  assert.equal(await step(page), first + 11);
  assert.equal(await page.evaluate(() => supple.playing), false);
}

async function savesEveryThird(stage) {
  const { page } = await stage.view(nine);
  await page.keyboard.press("Shift+P");
  const dialog = dialogOf(page);
  await until(page, () => supple.model.frame?.text.playing === false);
  const first = await step(page);
  await chooseSize(dialog, 320, 240);
  await dialog.getByRole("spinbutton", { name: "Pictures" }).fill("5");
  await dialog.getByRole("spinbutton", { name: "Every n-th step" }).fill("3");
  const { steps, pictures } = readZip(await save(stage, page), [320, 240]);
  assert.deepEqual(steps, stepsFrom(first, 5, 3));
  assertAllDiffer(pictures);
}

async function recordingUpToAFrame(stage) {
  const file = stage.file("run.h5");
  await runProgram(stage.supple, ["simulate", nine, "--frames", "21", "--record", file, "--quiet"]);
  const { page } = await stage.viewAt(0, file);
  await page.getByRole("slider", { name: "Timeline" }).fill("12");
  await isAt(page, 12);
  const dialog = await openDialog(page);
  const last = dialog.getByRole("spinbutton", { name: "Last frame" });
  assert.equal(await last.inputValue(), "20");
  await chooseSize(dialog, 320, 240);
  const toTheEnd = readZip(await save(stage, page), [320, 240]);
  assert.deepEqual(toTheEnd.steps, stepsFrom(12, 9, 1));
  assertAllDiffer(toTheEnd.pictures);

  await page.getByRole("slider", { name: "Timeline" }).fill("3");
  await isAt(page, 3);
  await openDialog(page);
  await last.fill("8");
  const some = readZip(await save(stage, page), [320, 240]);
  assert.deepEqual(some.steps, stepsFrom(3, 6, 1));
}

/** A page opened from a file, with its session in a worker. */
async function savesWithoutAProgram(stage) {
  const file = stage.file("page.html");
  await runProgram(stage.supple, ["view", nine, "--export", file]);
  const page = await stage.page({ offline: true });
  await page.goto(`file://${file}`);
  await until(page, () => window.supple?.model.frame?.text.step > 0);
  const dialog = await openDialog(page);
  const first = await step(page);
  await chooseSize(dialog, 320, 240);
  await dialog.getByRole("spinbutton", { name: "Pictures" }).fill("6");
  const { steps, pictures } = readZip(await save(stage, page), [320, 240]);
  assert.deepEqual(steps, stepsFrom(first, 6, 1));
  assertAllDiffer(pictures);
}

/** The colours at some places of a PNG, as decoded by the browser. */
const colours = (page, png, places) =>
  page.evaluate(async ([base64, places]) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
    context.drawImage(image, 0, 0);
    return places.map(([x, y]) => [...context.getImageData(x * image.width, y * image.height, 1, 1).data]);
  }, [png.toString("base64"), places]);

async function onePictureWithoutGround(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  await settled(page);
  const dialog = await openDialog(page);
  const size = dialog.getByRole("combobox", { name: "Size" });
  const twice = await size.locator("option").nth(1).textContent();
  await size.selectOption({ label: twice });
  await dialog.getByText("One picture, of step 0, as PNG").waitFor();
  const plain = await save(stage, page);
  assert.match(plain.name, /^supple-.*\.png$/);
  const [width, height] = sizeOf(plain.bytes);
  assert.equal(twice, `Twice the window (${width} × ${height})`);
  const window = await bufferSize(page);
  assert.ok(Math.abs(width - 2 * window.width) <= 2 && Math.abs(height - 2 * window.height) <= 2, `${width} × ${height}`);

  await openDialog(page);
  await dialog.getByRole("combobox", { name: "Background" }).selectOption("Transparent");
  const clear = await save(stage, page);
  const ball = await page.evaluate(() => supple.project([-0.6, 0, 0]));
  const view = await page.locator("canvas.view").boundingBox();
  const places = [[0.02, 0.02], [(ball.x - view.x) / view.width, (ball.y - view.y) / view.height]];
  const [groundBefore, ballBefore] = await colours(page, plain.bytes, places);
  const [ground, seen] = await colours(page, clear.bytes, places);
  assert.equal(groundBefore[3], 255);
  assert.equal(ground[3], 0);
  assert.deepEqual(seen, ballBefore, "the ball is not as before");
  assert.equal(seen[3], 255);
}

/** More pictures than the test takes time for. */
const MANY = 60_000;

async function cancelKeepsWhatIsThere(stage) {
  const { page } = await stage.view(nine);
  const before = await bufferSize(page);
  const dialog = await openDialog(page);
  const first = await step(page);
  await chooseSize(dialog, 320, 240);
  await dialog.getByRole("spinbutton", { name: "Pictures" }).fill(String(MANY));
  await dialog.getByRole("button", { name: "Save", exact: true }).click();
  await until(page, () => document.querySelector(".frames progress").value >= 5);
  assert.match(await dialog.getByLabel("Progress").textContent(), /^[\d,]+ of 60,000$/);
  const { width, height } = page.viewportSize();
  await page.setViewportSize({ width: width - 60, height: height - 60 });  // must not affect pictures
  await until(page, () => document.querySelector(".frames progress").value >= 10);
  const { steps, told, pictures } = readZip(await savedBy(stage, page, () => page.keyboard.press("Escape")), [320, 240]);
  assert.ok(steps.length >= 10 && steps.length < MANY);
  assert.deepEqual(steps, stepsFrom(first, steps.length, 1));
  assertAllDiffer(pictures);
  assert.equal(told.planned, MANY);
  assert.equal(told.ended, "Cancelled.");
  await said(page, `Cancelled. ${steps.length.toLocaleString("en")} of 60,000 pictures are saved`);
  await settled(page);
  const after = await bufferSize(page);
  assert.ok(after.width < before.width && after.height < before.height, "the view is not as large as the new window");
  const now = await step(page);
  await goesOn(page);
  assert.equal(await step(page), now, "it goes on");
}

async function endOfTheProgramKeepsWhatIsThere(stage) {
  const { page, program } = await stage.view(nine);
  const dialog = await openDialog(page);
  await chooseSize(dialog, 320, 240);
  await dialog.getByRole("spinbutton", { name: "Pictures" }).fill(String(MANY));
  await dialog.getByRole("button", { name: "Save", exact: true }).click();
  await until(page, () => document.querySelector(".frames progress").value >= 3);
  const { steps, told } = readZip(await savedBy(stage, page, () => program.stop()), [320, 240]);
  assert.deepEqual(steps, stepsFrom(steps[0], steps.length, 1));
  assert.equal(told.ended, "The session has ended.");
  await page.getByRole("alertdialog", { name: "The program has ended" }).waitFor();
  await page.getByRole("button", { name: "Save frames as pictures…" }).click();
  await said(page, "no frames to save");
}

const STIFF = (stiffness, motion = "random_force = 1, deform_seconds = 1") => `
[scene]
time_step = 0.01
[[object]]
name = "stiff"
model = "icosphere"
motion = { kind = "mass_spring", stiffness = ${stiffness}, ${motion} }
`;

async function blowUpKeepsWhatIsThere(stage) {
  const { page } = await stage.view(stage.file("stiff.toml", STIFF(3e4)));
  await until(page, () => supple.model.frame?.text.step > 0 && !supple.model.frame.text.playing);  // it has blown up and stopped
  await page.getByRole("button", { name: "Reset" }).click();
  await isAt(page, 0);
  const dialog = await openDialog(page);
  await chooseSize(dialog, 320, 240);
  await dialog.getByRole("spinbutton", { name: "Pictures" }).fill(String(MANY));
  const { steps, told } = readZip(await save(stage, page), [320, 240]);
  assert.deepEqual(steps, stepsFrom(0, steps.length, 1));
  assert.match(told.ended, new RegExp(`^The session has failed: .*stiff.* step ${steps.length}`));
}

async function tooLargeIsSaid(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  const dialog = await openDialog(page);
  await chooseSize(dialog, 1_000_000, 1_000_000);
  await dialog.getByRole("button", { name: "Save", exact: true }).click();
  assert.equal(await dialog.getByRole("spinbutton", { name: "Width" }).evaluate((input) => input.validity.rangeOverflow), true);
  assert.ok(await dialog.isVisible());
  // Imitates a graphics card that reports larger limits than it has.
  await page.evaluate(() => {
    for (const name of ["drawingBufferWidth", "drawingBufferHeight"]) Object.defineProperty(document.querySelector("canvas.view").getContext("webgl2"), name, { get: () => 100 });
  });
  await chooseSize(dialog, 3000, 2000);
  await dialog.getByRole("button", { name: "Save", exact: true }).click();
  await said(page, "No picture was taken. WebGL does not have enough memory for a picture of 3000 × 2000.");
}

async function keysAlone(stage) {
  const { page } = await stage.view(stage.file("balls.toml", TWO_BALLS));
  const key = (name) => page.keyboard.press(name);
  await key("Shift+P");
  const focused = () => page.evaluate(() => document.activeElement.getAttribute("aria-label") ?? document.activeElement.labels?.[0]?.textContent ?? document.activeElement.textContent);
  assert.equal(await focused(), "Size");
  const seen = [];
  const names = ["Pixels per inch", "Pictures", "Every n-th step", "Background", "Legend with the names of objects", "Scale bar", "Save"];
  for (let i = 0; i < names.length; ++i) {
    await key("Tab");
    seen.push(await focused());
  }
  assert.deepEqual(seen, names);
  const { bytes } = await savedBy(stage, page, () => key("Enter"));
  sizeOf(bytes);
  await key("Shift+P");
  await key("Escape");
  assert.equal(await dialogOf(page).isVisible(), false);
}

/** The session drops layers that the page requested; layers requested meanwhile stay. */
async function layersThatFail(stage) {
  const asked = [];
  const page = await pageWithMessages(stage, nine, (message, send) => send(message), (text, handOn, send) => {
    const command = JSON.parse(text);
    if (command.do !== "layers") return handOn(text);
    asked.push(command);
    const { octree, candidates, scene_regions } = command;
    if (!octree || !candidates) return handOn(text);
    // These two fail, after a delay in which a third layer is requested.
    if (scene_regions) send(textMessage(4, { message: "there is not enough memory for that", fatal: false, layers: ["candidates", "octree"] }));
  }, ["--broad-phase", "octree"], 12);
  const box = (name) => page.getByRole("checkbox", { name, exact: true });
  await box("Object octrees").check();
  await box("Candidate pairs").check();
  await box("Scene octree").check();
  await said(page, "there is not enough memory for that. Switched off: Candidate pairs, Object octrees.");
  assert.equal(await box("Object octrees").isChecked(), false);
  assert.equal(await box("Candidate pairs").isChecked(), false);
  assert.equal(await box("Scene octree").isChecked(), true, "what was asked for meanwhile is gone");
  await until(page, () => supple.counts().regions > 0 && supple.counts().boxes === 0);
  const { octree, candidates, scene_regions } = asked.at(-1);
  assert.deepEqual([octree, candidates, scene_regions], [null, false, true]);
  await box("Candidate pairs").check();
  await until(page, () => supple.counts().candidates > 0);
}

async function warningsStay(stage) {
  const scene = stage.file("stiff.toml", STIFF(1e7, "random_speed = 0.001"));
  const program = await stage.program(scene);
  const page = await stage.page();
  await page.clock.install();
  await page.goto(program.address);
  const words = "time_step 0.01 is too long for stiff";
  const warning = page.getByRole("log").getByText(words);
  await warning.waitFor();
  await page.clock.fastForward(10_000);  // longer than notices stay
  assert.ok(await warning.isVisible(), "the warning is gone");
  const isAnew = async (act) => {
    const generation = await page.evaluate(() => supple.model.scene.generation);
    await act();
    await until(page, (old) => supple.model.scene.generation > old && supple.model.frame, generation);
  };
  await isAnew(() => page.getByRole("button", { name: "Reset" }).click());
  assert.equal(await warning.count(), 1, "it comes twice");
  await page.getByRole("button", { name: "Dismiss" }).first().click();
  await isAnew(() => page.getByRole("button", { name: "Reset" }).click());
  assert.equal(await warning.count(), 0, "it comes again");
  await page.reload();
  await warning.waitFor();
  await page.getByRole("tab", { name: "Settings" }).click();
  await isAnew(() => page.getByLabel("Integrator").selectOption("backward_euler"));
  assert.equal(await warning.count(), 0, "it holds no more");

  const file = stage.file("page.html");
  await runProgram(stage.supple, ["view", scene, "--export", file]);
  const carried = await stage.page({ offline: true });
  await carried.goto(`file://${file}`);
  await carried.getByRole("log").getByText(words).waitFor();
}

export const tests = [
  ["each step is saved once", savesEachStep],
  ["every third step is saved", savesEveryThird],
  ["a recording is saved up to a frame", recordingUpToAFrame],
  ["frames of a page without a program", savesWithoutAProgram],
  ["one picture, large, without its ground", onePictureWithoutGround],
  ["cancelling keeps what is there", cancelKeepsWhatIsThere],
  ["a program that ends meanwhile", endOfTheProgramKeepsWhatIsThere],
  ["a body that blows up meanwhile", blowUpKeepsWhatIsThere],
  ["a size that WebGL has not", tooLargeIsSaid],
  ["saved by keys alone", keysAlone],
  ["layers that the session gives up", layersThatFail],
  ["warnings stay until they hold no more", warningsStay],
];
