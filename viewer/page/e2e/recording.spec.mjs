// A recording: play, seek, step, loop, jump between events.
import assert from "node:assert/strict";
import { join } from "node:path";
import { plotBox, runProgram, said, scenes, settled, step, until } from "./tools/harness.mjs";

const FRAMES = 60;

async function open(stage) {
  const file = stage.file("run.h5");
  await runProgram(stage.supple, ["simulate", join(scenes, "nine.toml"), "--steps", String(FRAMES), "--colliding-vertices", "--record", file, "--quiet"]);
  const { page } = await stage.view(file);
  assert.deepEqual(await page.evaluate(() => [supple.model.frame.text.step, supple.model.frame.text.playing]), [0, false]);
  await until(page, () => supple.model.history.frames.length > 0);
  await settled(page);
  return page;
}

const isAt = (page, frame) => until(page, (frame) => supple.model.frame.text.step === frame, frame);

async function scrubs(stage) {
  const page = await open(stage);
  const frames = await page.evaluate(() => supple.model.scene.frames);
  const slider = page.getByRole("slider", { name: "Timeline" });
  const box = await slider.boundingBox();
  await page.mouse.move(box.x + 8, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2, { steps: 20 });
  await page.mouse.up();
  await settled(page);
  const middle = await step(page);
  assert.ok(Math.abs(middle - (frames - 1) / 2) <= 2, `at ${middle}`);
  assert.equal(Number(await slider.inputValue()), middle);
  const expected = await page.evaluate(() => supple.model.history.column("contacts")[supple.model.frame.text.step]);
  assert.equal(await page.evaluate(() => supple.model.frame.lists.contacts.count), expected, "the contacts of a frame are those that were recorded");
}

async function stepsAndPlays(stage) {
  const page = await open(stage);
  const last = await page.evaluate(() => supple.model.scene.frames - 1);
  await page.getByRole("button", { name: "First frame" }).click();
  await settled(page);
  await isAt(page, 0);
  await page.getByRole("button", { name: "+1 step" }).click();
  await isAt(page, 1);
  await page.getByRole("button", { name: "+1 step" }).click();
  await isAt(page, 2);
  await page.getByRole("button", { name: "−1 step" }).click();
  await isAt(page, 1);
  await page.getByRole("button", { name: "Last frame" }).click();
  await isAt(page, last);
  await page.evaluate(() => {
    window.steps = [];
    supple.model.on("frame", ({ text }) => steps.push(text.step));
  });
  // Slow at first. Whatever the page does then, it has credit for two frames, of which one is in between.
  const speed = page.getByRole("combobox", { name: "Speed" });
  await speed.selectOption("0.1");
  await settled(page);
  await page.getByRole("button", { name: "Play" }).click();
  await until(page, (last) => steps.some((at) => at > 0 && at < last), last);
  await speed.selectOption("10");
  await until(page, (last) => supple.model.frame.text.step === last && !supple.model.frame.text.playing, last);
  await page.evaluate(() => void (steps.length = 0));
  await page.getByRole("button", { name: "Loop", exact: true }).click();
  await page.getByRole("button", { name: "Play" }).click();
  await until(page, () => steps.filter((step, i) => step < steps[i - 1]).length >= 2);
  assert.ok(await page.evaluate(() => supple.model.frame.text.playing));
}

async function jumpsToEvents(stage) {
  const page = await open(stage);
  await page.getByRole("button", { name: "First frame" }).click();
  await isAt(page, 0);
  const events = await page.evaluate(() => {
    const { begin, end } = supple.model.history.events.contact;
    return [...new Set([...begin, ...end].map(({ frame }) => frame))].sort((a, b) => a - b).filter((frame) => frame > 0);
  });
  assert.ok(events.length >= 2, `${events.length} events`);
  for (const frame of events.slice(0, 2)) {
    await page.getByRole("button", { name: "Next event" }).click();
    await isAt(page, frame);
  }
  await page.getByRole("button", { name: "Previous event" }).click();
  await isAt(page, events[0]);
  // The events of the narrow phase, which this recording has.
  await page.getByRole("combobox", { name: "Events" }).selectOption("narrow_phase");
  const first = await page.evaluate(() => {
    const { begin, end } = supple.model.history.events.narrow_phase;
    return Math.min(...[...begin, ...end].map(({ frame }) => frame).filter((frame) => frame > 0));
  });
  await page.getByRole("button", { name: "First frame" }).click();
  await isAt(page, 0);
  await page.getByRole("button", { name: "Next event" }).click();
  assert.ok(Number.isFinite(first));
  await isAt(page, first);
}

async function plotsSeek(stage) {
  const page = await open(stage);
  await page.getByRole("tab", { name: "Plots" }).click();
  const box = await plotBox(page);
  await page.mouse.move(box.x + box.width * 0.25, box.y + 20);
  await page.mouse.click(box.x + box.width * 0.5, box.y + 20);
  await until(page, () => supple.model.frame.text.step > 0);
  const at = await step(page);
  const frames = await page.evaluate(() => supple.model.scene.frames);
  assert.ok(Math.abs(at - frames / 2) < frames / 6, `at ${at}`);
}

async function isNotPulled(stage) {
  const page = await open(stage);
  await page.getByRole("radio", { name: "Grab and pull" }).click();
  const at = await page.evaluate(() => {
    const { triangles } = supple.model.objects[0];
    for (let i = 0; i < triangles; ++i) {
      const at = supple.project(supple.centroid(0, i));
      if (supple.pickAt(at.x, at.y)) return at;
    }
  });
  await page.mouse.click(at.x, at.y);
  await said(page, "Objects of a recording cannot be pulled");
}

export const tests = [
  ["the timeline scrubs", scrubs],
  ["steps, plays to the end and loops", stepsAndPlays],
  ["jumps from event to event", jumpsToEvents],
  ["a plot seeks", plotsSeek],
  ["a recording says that it cannot be pulled", isNotPulled],
];
