// A program that shows its own scene (examples/attach.cpp): pause, step, continue, breaks, and how it ends.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { dirname, join } from "node:path";
import { addressIn, camera, contactsIn, hasFrame, isAt, step, textMessage, until } from "./tools/harness.mjs";

const FOR_EVER = 1_000_000_000;

/** Starts the example, which takes thousands of steps in a second. */
async function start(stage, steps = FOR_EVER) {
  const program = { output: "", child: spawn(join(dirname(stage.supple), "example_attach"), [String(steps)]) };
  program.ended = new Promise((done, fail) => {
    program.child.on("error", fail);
    program.child.on("close", (code, signal) => done({ code, signal }));
  });
  program.stop = (signal) => {
    program.child.kill(signal);
    return program.ended;
  };
  stage.programs.push(program);
  await new Promise((done, fail) => {
    program.ended.then(() => fail(new Error(`the example ended: ${program.output}`)), fail);
    program.child.stdout.on("data", (data) => {
      program.output += data;
      program.address = addressIn(program.output, "Open ");
      program.watching = addressIn(program.output, "Watch ");
      if (program.address && program.watching) done();
    });
  });
  return program;
}

async function open(stage, program) {
  const page = await stage.page();
  await page.goto(program.address);
  await hasFrame(page);
  return page;
}

const isPaused = (page) => until(page, () => supple.model.frame?.text.playing === false);
const runsOn = (page, from) => until(page, (from) => supple.model.frame?.text.step > from, from);
const banner = (page) => page.getByRole("status", { name: "Program" });
const reason = (page) => page.evaluate(() => supple.model.frame.text.break);
const breaks = async (page) => {
  await page.getByRole("tab", { name: "Settings" }).click();
  return page.getByRole("group", { name: "Pause the program" });
};

async function pausesAndSteps(stage) {
  const page = await open(stage, await start(stage));
  assert.equal(await page.evaluate(() => supple.model.scene.source), "program");
  await runsOn(page, await step(page));
  await page.getByRole("button", { name: "Pause" }).click();
  await isPaused(page);
  const at = await step(page);
  await page.getByRole("button", { name: "+1 step" }).click();
  await isAt(page, at + 1);
  await page.getByRole("img", { name: "3D view" }).focus();
  await page.keyboard.press("ArrowRight");
  await isAt(page, at + 2);
  assert.equal(await page.evaluate(() => supple.model.frame.text.playing), false);
  await page.keyboard.press("Space");
  await runsOn(page, at + 2);
  await until(page, () => supple.model.frame.text.playing);
}

async function showsAllStepsInThePlots(stage) {
  const page = await open(stage, await start(stage));
  await page.getByRole("button", { name: "Pause" }).click();
  await isPaused(page);
  const at = await step(page);
  // The page gives no credit until all steps are taken, so that the program shows at most what it had credit for.
  const seen = await page.evaluate(async (last) => {
    const { client, model } = supple;
    const seen = model.framesSeen;
    client.giveCredit = () => {};
    await client.ask({ do: "step", count: 1000 });
    for (let now = -1; now !== last; ) now = (await client.ask({ do: "program" })).step;
    delete client.giveCredit;
    return seen;
  }, at + 1000);
  await isAt(page, at + 1000);
  const [frames, seenNow] = await page.evaluate(() => [supple.model.history.frames.slice(-1000), supple.model.framesSeen]);
  assert.deepEqual(frames, Array.from({ length: 1000 }, (_, i) => at + 1 + i));
  assert.ok(seenNow - seen < 10, `${seenNow - seen} frames`);
}

async function answersInAPause(stage) {
  const page = await open(stage, await start(stage));
  await page.getByRole("button", { name: "Pause" }).click();
  await isPaused(page);
  const { name, vertices } = await page.evaluate(() => supple.client.ask({ do: "read", object: 1 }));
  assert.deepEqual([name, vertices], ["ball", 642]);
  const { stage: where } = await page.evaluate(() => supple.client.ask({ do: "explain", a: [0, 0], b: [2, 0] }));
  assert.equal(typeof where, "string");
  await page.keyboard.press("b");  // octrees
  await until(page, () => supple.model.frame.octreeBoxes.size > 0);
}

/** The example gives each vertex of the ball its height. */
async function showsNumbersOfTheProgram(stage) {
  const page = await open(stage, await start(stage));
  await page.getByRole("button", { name: "Pause" }).click();
  await isPaused(page);
  await page.getByRole("combobox", { name: "Field", exact: true }).selectOption({ label: "height" });
  await until(page, () => supple.model.frame.fieldValues.has(1));
  const { heights, places, objects } = await page.evaluate(() => {
    const { positions } = supple.model.objects[1];
    const heights = [...supple.model.frame.fieldValues.get(1)];
    const places = heights.map((_, i) => positions[3 * i + 1] + supple.model.scene.center[1]);
    return { heights, places, objects: [...supple.model.frame.fieldValues.keys()] };
  });
  assert.deepEqual(objects, [1], "the other objects have no heights");
  heights.forEach((height, i) => assert.ok(Math.abs(height - places[i]) < 1e-5, `vertex ${i}: ${height} instead of ${places[i]}`));
  const label = await page.getByRole("img", { name: /^Colour bar: height from/ }).getAttribute("aria-label");
  const [low, high] = /from (\S+) to (\S+), viridis\. Without a value: the object’s colour/.exec(label).slice(1).map(Number);
  assert.ok(Math.abs(low - Math.min(...heights)) < 0.01 && Math.abs(high - Math.max(...heights)) < 0.01, label);
}

async function breaksOnAContact(stage) {
  const page = await open(stage, await start(stage));
  const before = await camera(page);
  const group = await breaks(page);
  await group.getByLabel("First object").selectOption("floor");
  await group.getByLabel("Second object").selectOption("ball");
  await group.getByLabel("Two objects begin to touch").check();
  await until(page, () => supple.model.frame.text.break);
  const found = await reason(page);
  assert.equal(found.text, "floor begins to touch ball");
  assert.match(await banner(page).innerText(), /Paused in step [\d,]+: floor begins to touch ball/);
  assert.ok((await contactsIn(page)).some(([a, , b]) => a === 0 && b === 1), "the frame has this contact");
  const { target } = await camera(page);
  assert.notDeepEqual(target, before.target);
  found.point.forEach((x, axis) => assert.ok(Math.abs(x - target[axis]) < 1e-3, "the camera looks at the contact"));
  const at = await step(page);
  await banner(page).getByRole("button", { name: "Continue" }).click();
  await until(page, (at) => supple.model.frame.text.break?.text && supple.model.frame.text.step > at, at);
  assert.equal((await reason(page)).text, "floor begins to touch ball");
  await group.getByLabel("Two objects begin to touch").uncheck();
  const last = await step(page);
  await banner(page).getByRole("button", { name: "Continue" }).click();
  await until(page, (last) => supple.model.frame.text.step > last && supple.model.frame.text.playing, last);
  await until(page, () => document.querySelector(".banner").hidden);
}

async function breaksOnNumbers(stage) {
  const page = await open(stage, await start(stage));
  const group = await breaks(page);
  const count = group.getByLabel("More contacts than");
  await count.fill("-3");
  await count.press("Enter");
  await group.getByText(/“More contacts than” is -3; it must be a whole number/).waitFor();
  await count.fill("100");
  await count.press("Enter");
  await until(page, () => supple.model.frame.text.break);
  assert.match((await reason(page)).text, /^there are \d+ contacts$/);
  await count.fill("");
  await count.press("Enter");
  const depth = group.getByLabel("A vertex deeper in a solid than");
  await depth.fill("0.2");
  await depth.press("Enter");
  await banner(page).getByRole("button", { name: "Continue" }).click();
  await until(page, () => supple.model.frame.text.break?.event === "depth_above");
  assert.match(await banner(page).innerText(), /a vertex of .* is 0\.\d+ deep in /);
}

async function goesOnWithoutThePage(stage) {
  const program = await start(stage);
  const page = await stage.page();
  const sockets = [];
  page.on("websocket", (socket) => sockets.push(socket));
  await page.goto(program.address);
  await hasFrame(page);
  await page.getByRole("button", { name: "Pause" }).click();
  await isPaused(page);
  const at = await step(page);
  // The program shall know that this page has left before the next one comes, which would take the pause over.
  await Promise.all([sockets.at(-1).waitForEvent("close"), page.evaluate(() => supple.client.transport.close())]);
  await page.close();
  const next = await open(stage, program);
  await until(next, () => supple.model.frame?.text.playing);
  await runsOn(next, at);
}

async function saysThatTheProgramEnds(stage) {
  const program = await start(stage, 500);
  const page = await open(stage, program);
  await isAt(page, 499);
  await isPaused(page);
  await page.getByRole("button", { name: "Play" }).click();
  await page.getByRole("alertdialog", { name: "The program has ended" }).waitFor();
  assert.equal(await step(page), 499, "the page keeps the last frame");
  assert.equal((await program.ended).code, 0);
  assert.match(program.output, /500 steps/);
}

async function saysThatTheProgramWasKilled(stage) {
  const program = await start(stage);
  const page = await open(stage, program);
  await program.stop("SIGKILL");
  await page.getByRole("alertdialog", { name: "Connection lost" }).waitFor();
  assert.ok((await page.evaluate(() => supple.model.objects[1].positions)) !== null);
}

async function isWatched(stage) {
  const program = await start(stage);
  const page = await open(stage, program);
  const spectator = await stage.page();
  await spectator.goto(program.watching);
  await hasFrame(spectator);
  await spectator.getByText("watching").waitFor();
  await runsOn(spectator, await step(spectator));
  assert.ok(await spectator.getByRole("button", { name: "Pause" }).isHidden());
  const group = await breaks(page);
  await group.getByLabel("First object").selectOption("floor");
  await group.getByLabel("Second object").selectOption("ball");
  await group.getByLabel("Two objects begin to touch").check();
  await until(page, () => supple.model.frame.text.break);
  await banner(spectator).getByText(/floor begins to touch/).waitFor();
  assert.ok(await banner(spectator).getByRole("button", { name: "Continue" }).isHidden());
  await spectator.getByRole("img", { name: "3D view" }).focus();
  await spectator.keyboard.press("Space");
  const at = await step(page);
  await until(spectator, (at) => supple.model.frame.text.step === at, at);
  await page.getByRole("button", { name: "+1 step" }).click();
  await until(page, (at) => supple.model.frame.text.step > at, at);
  assert.equal(await step(page), at + 1, "the spectator has not continued the program");
  await spectator.close();
  await banner(page).waitFor({ state: "hidden" });
}

/** The answer of a program that hangs is written by the test, which holds back all that it sends. */
async function saysThatTheProgramHangs(stage) {
  const program = await start(stage);
  const page = await stage.page();
  let hangs = false;
  await page.routeWebSocket(/\/session/, (socket) => {
    const server = socket.connectToServer();
    server.onMessage((message) => {
      if (!hangs) socket.send(message);
    });
    socket.onMessage((text) => {
      const command = JSON.parse(text);
      if (!hangs || command.do !== "program") return server.send(text);
      socket.send(textMessage(3, { id: command.id, steps: 41, step: 40, runs: true, seconds_since_step: 12.4 }));
    });
  });
  await page.goto(program.address);
  await hasFrame(page);
  hangs = true;
  await banner(page).getByText("The last step, 40, ended 12 s ago. The program works on the next one.").waitFor();
}

export const tests = [
  ["pauses, steps and continues a program", pausesAndSteps],
  ["has the statistics of steps without a frame", showsAllStepsInThePlots],
  ["answers questions in a pause", answersInAPause],
  ["shows numbers of the program", showsNumbersOfTheProgram],
  ["breaks on the contact of two named objects", breaksOnAContact],
  ["breaks on numbers, and refuses wrong ones", breaksOnNumbers],
  ["a program goes on when its page is closed", goesOnWithoutThePage],
  ["a program has spectators", isWatched],
  ["says that a program has ended", saysThatTheProgramEnds],
  ["says that a program was killed", saysThatTheProgramWasKilled],
  ["says that a program hangs", saysThatTheProgramHangs],
];
