// The page alone: camera, keys, pictures, videos, appearance, and error messages.
import assert from "node:assert/strict";
import { chmodSync, existsSync, readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { camera, hasFrame, pageWithMessages, pause, picture, scenes, settled, simulateTo, swayingBalls, textMessage, TWO_BALLS, until } from "./tools/harness.mjs";

const nine = join(scenes, "nine.toml");
const balls = (stage) => stage.file("balls.toml", TWO_BALLS);

async function cameraMoves(stage) {
  const { page } = await stage.view(balls(stage));
  await settled(page);
  const canvas = await page.locator("canvas.view").boundingBox();
  const [x, y] = [canvas.x + canvas.width / 2, canvas.y + canvas.height / 2];
  const first = await camera(page);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 60, y + 40, { steps: 5 });
  await page.mouse.up();
  const orbited = await camera(page);
  assert.notDeepEqual(orbited.position, first.position);
  assert.deepEqual(orbited.target, first.target);
  await page.mouse.down({ button: "right" });
  await page.mouse.move(x, y, { steps: 5 });
  await page.mouse.up({ button: "right" });
  assert.notDeepEqual((await camera(page)).target, orbited.target);

  // The point below the cursor stays there while the wheel turns.
  const seen = await page.evaluate(() => supple.project(supple.positionOf(0, 0)));
  await page.mouse.move(seen.x, seen.y);
  const before = (await camera(page)).position;
  await page.mouse.wheel(0, -300);
  await until(page, (before) => supple.camera().position.some((x, axis) => x !== before[axis]), before);
  await settled(page);
  const after = await page.evaluate(() => supple.project(supple.positionOf(0, 0)));
  assert.ok(Math.hypot(after.x - seen.x, after.y - seen.y) < 12, `it moved from ${JSON.stringify(seen)} to ${JSON.stringify(after)}`);
}

async function viewsAndAddress(stage) {
  const { page } = await stage.view(balls(stage));
  await page.getByRole("combobox", { name: "Axis view" }).selectOption("right");
  await settled(page);
  const right = await camera(page);
  assert.ok(Math.abs(right.position[2] - right.target[2]) < 1e-6 && right.position[0] > right.target[0]);
  await page.getByRole("button", { name: "Orthographic" }).click();
  await until(page, () => location.hash.includes("orthographic"));
  const address = page.url();
  await page.reload();
  await hasFrame(page);
  assert.equal(page.url(), address);
  const again = await camera(page);
  assert.ok(again.orthographic);
  right.position.forEach((value, i) => assert.ok(Math.abs(again.position[i] - value) < 1e-3));
  await page.getByRole("button", { name: "Frame all" }).click();
  await settled(page);
}

async function savesAPicture(stage) {
  const { page } = await stage.view(balls(stage));
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save a picture" }).click()]);
  assert.match(download.suggestedFilename(), /^supple-.*\.png$/);
  const path = stage.file("picture.png");
  await download.saveAs(path);
  assert.ok(statSync(path).size > 5000);
}

async function recordsAVideo(stage) {
  const { page } = await stage.view(nine);
  await page.getByRole("button", { name: "Record a video" }).click();
  const begin = await page.evaluate(() => performance.now());
  await until(page, (begin) => supple.drawTimes().filter((time) => time > begin).length >= 20, begin);
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Stop the video" }).click()]);
  const path = stage.file("film.webm");
  await download.saveAs(path);
  assert.ok(statSync(path).size > 5000);
}

/** Uses the keyboard only, from opening the page to reading a contact. */
async function keyboardAlone(stage) {
  const { page } = await stage.view(nine);
  const key = (name) => page.keyboard.press(name);
  await key("Space");
  await until(page, () => !supple.model.frame.text.playing);
  await simulateTo(page, 59);
  await key("ArrowRight");
  await until(page, () => supple.model.frame.text.step === 60);  // many pairs touch
  const before = await camera(page);
  await key("Shift+ArrowLeft");
  assert.notDeepEqual((await camera(page)).position, before.position);
  await key("o");
  assert.ok((await camera(page)).orthographic);
  await key("1");
  await key("f");
  await key("p");
  await until(page, () => supple.counts().pairs > 0);
  await key("?");
  await page.getByRole("dialog", { name: "Keyboard shortcuts" }).waitFor();
  await key("Escape");
  await until(page, () => !document.querySelector("dialog").open);

  // Backwards to what is above: Tab on the last element leaves the page for the bars of the browser.
  const tabTo = async (wanted, by = "Tab") => {
    for (let i = 0; i < 200; ++i) {
      await key(by);
      const focus = await page.evaluate(() => {
        const at = document.activeElement;
        return { name: at.getAttribute("aria-label") ?? at.textContent, outline: getComputedStyle(at).outlineStyle };
      });
      if (!wanted.test(focus.name)) continue;
      assert.notEqual(focus.outline, "none", `${focus.name} has focus and does not show it`);
      return;
    }
    assert.fail(`Tab never comes to ${wanted}`);
  };
  const hasDrawers = await page.evaluate(() => document.querySelector("button.drawer").checkVisibility());
  const opens = async (name, by) => {
    if (!hasDrawers) return;
    await tabTo(new RegExp(`^${name}$`), by);
    await key("Enter");
  };
  const closes = async (name) => {
    if (!hasDrawers) return;
    await tabTo(new RegExp(`^Close ${name}$`), "Shift+Tab");
    await key("Enter");
  };
  await opens("Details");
  await tabTo(/^Contacts$/);
  await key("ArrowLeft");
  await key("ArrowRight");
  await tabTo(/^Contacts$/);
  await key("ArrowDown");  // a pair
  await key("ArrowRight");  // its contacts
  await key("ArrowDown");
  await until(page, () => supple.model.contact !== null);

  // Pull a vertex: select an object, grab its first vertex, move it, release it.
  await closes("Details");
  await opens("Scene", "Shift+Tab");
  await tabTo(/^fish 1/, hasDrawers ? "Tab" : "Shift+Tab");
  await key("Enter");
  const object = await page.evaluate(() => supple.model.selection.object);
  await closes("Scene");
  await key("g");
  await tabTo(/^3D view$/, "Shift+Tab");
  const held = await page.evaluate((object) => supple.positionOf(object, 0), object);
  await key("Enter");
  for (let i = 0; i < 5; ++i) await key("ArrowUp");
  const isMoved = ([object, held]) => Math.hypot(...supple.positionOf(object, 0).map((x, i) => x - held[i])) > 0.05;
  await until(page, isMoved, [object, held]);
  await key("Enter");
  await key("Escape");
  await until(page, () => supple.model.tool === "select");
}

async function lightAndDark(stage) {
  const { page } = await stage.view(balls(stage));
  const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const dark = await ground();
  await settled(page);
  const drawn = await picture(page);
  await page.getByRole("button", { name: "Light or dark" }).click();
  assert.notEqual(await ground(), dark);
  assert.notEqual(await picture(page), drawn);
  await page.reload();
  await hasFrame(page);
  assert.notEqual(await ground(), dark, "the choice is forgotten");
}

const says = (page, title) => page.getByRole("alertdialog", { name: title }).waitFor();

async function killedProgram(stage) {
  const { page, program } = await stage.view(nine);
  await program.stop("SIGKILL");
  await says(page, "Connection lost");
  await page.getByRole("button", { name: "Reconnect now" }).click();
  await says(page, "Connection lost");
}

/** A program that is started again at the same address shows up in the open page, which looks as before. */
async function restartedProgram(stage) {
  const token = ["--token-file", stage.file("token")];
  const first = await stage.program(nine, ...token);
  const port = ["--port", new URL(first.address).port];
  const page = await stage.page();
  await page.goto(first.address);
  await hasFrame(page);
  await page.getByRole("checkbox", { name: "Wireframe" }).check();
  await page.getByRole("tab", { name: "Plots" }).click();
  await until(page, () => supple.model.frame.text.step > 20);
  for (const signal of ["SIGKILL", "SIGINT"]) {
    await stage.programs.at(-1).stop(signal);
    await until(page, () => supple.status.state === "ended");
    const again = await stage.program(nine, ...token, ...port);
    assert.equal(again.address, first.address);
    await until(page, () => supple.status.state === "connected" && supple.model.frame?.text.step > 3);
    assert.ok(await page.getByRole("checkbox", { name: "Wireframe" }).isChecked());
    assert.equal(await page.evaluate(() => supple.model.history.frames[0]), 0, "the plots begin with the new run");
  }
  await stage.programs.at(-1).stop("SIGINT");
  await stage.program(nine, ...port);
  await says(page, "The program has another address now");
}

/** Layers, level, colours, camera and tab are those before the reload. */
async function viewsSurviveAReload(stage) {
  const { page } = await stage.view(balls(stage));
  await page.getByRole("checkbox", { name: "Object octrees" }).check();
  await page.getByRole("checkbox", { name: "Wireframe" }).check();
  await until(page, () => document.querySelector('[aria-label="Octree level"]').options.length > 2);
  await page.getByRole("combobox", { name: "Octree level" }).selectOption("1");
  await page.getByLabel("Colour of left").fill("#ff00ff");
  await page.getByRole("checkbox", { name: "Show right" }).uncheck();
  await page.getByRole("tab", { name: "Settings" }).click();
  await page.getByLabel("Point size").fill("11");
  await page.getByRole("combobox", { name: "Axis view" }).selectOption("right");
  await settled(page);
  const state = () => page.evaluate(() => ({
    layers: supple.model.layers, octree: supple.model.octree, colour: supple.model.objects[0].colour, visible: supple.model.objects[1].visible,
    size: supple.model.pointSize, camera: Object.values(supple.camera()).flat().map((x) => (typeof x === "number" ? x.toFixed(3) : x)), boxes: supple.counts().boxes,
  }));
  const before = await state();
  // Without the camera in the address, as after opening the printed address again.
  const open = async (load) => {
    await load();
    await hasFrame(page);
    await settled(page);
    assert.deepEqual(await state(), before);
    assert.equal(await page.getByRole("tab", { name: "Settings" }).getAttribute("aria-selected"), "true");
    assert.ok(await page.getByRole("checkbox", { name: "Wireframe" }).isChecked());
    assert.equal(await page.getByRole("combobox", { name: "Octree level" }).inputValue(), "1");
    assert.equal(await page.getByLabel("Point size").inputValue(), "11");
    assert.ok(!(await page.getByRole("checkbox", { name: "Show right" }).isChecked()));
  };
  await open(() => page.reload());
  const address = page.url().replace(/#.*/, "");
  await open(async () => {
    await page.goto("about:blank");
    await page.goto(address);
  });
  // What is stored may come from another version.
  await page.evaluate(() => {
    for (const type of ["pagehide", "visibilitychange"]) addEventListener(type, () => {
      const name = Object.keys(localStorage).find((key) => key.startsWith("supple-view"));
      localStorage.setItem(name, JSON.stringify({ version: 1, camera: { position: "x" }, layers: 3, objects: { left: { colour: "url(x)", opacity: "1" } }, tab: "None" }));
    });
  });
  await page.goto("about:blank");
  await page.goto(address);
  await hasFrame(page);
  await page.getByRole("tab", { name: "Contacts", selected: true }).waitFor();
}

/** Whatever has the focus, except fields for text. */
async function spacePlaysEverywhere(stage) {
  const { page } = await stage.view(stage.file("balls.toml", swayingBalls(2, 3)));
  await page.getByRole("tab", { name: "Settings" }).click();
  const places = [
    page.getByRole("button", { name: "Frame all" }), page.getByRole("checkbox", { name: "Wireframe" }), page.getByLabel("Bounding volume"),
    page.getByRole("tab", { name: "Settings" }), page.getByRole("combobox", { name: "Speed" }), page.getByText("More options"), page.getByRole("button", { name: /^ball 1/ }),
    page.locator("canvas.view"),
  ];
  const checked = await page.getByRole("checkbox", { name: "Wireframe" }).isChecked();
  const chosen = await page.evaluate(() => supple.model.scene.bounding_volume);
  for (const place of places) {
    const was = await page.evaluate(() => supple.playing);
    await place.focus();
    await page.keyboard.press("Space");
    await until(page, (was) => supple.model.frame.text.playing === !was, was);
  }
  assert.equal(await page.getByRole("checkbox", { name: "Wireframe" }).isChecked(), checked);
  assert.equal(await page.evaluate(() => supple.model.scene.bounding_volume), chosen);
  assert.equal(await page.evaluate(() => supple.model.selection), null, "Space pressed a button");
  const was = await page.evaluate(() => supple.playing);
  const seed = page.getByRole("textbox", { name: "Seed" });
  await seed.focus();
  await page.keyboard.press("Space");
  assert.equal(await page.evaluate(() => supple.playing), was);
  // Enter does what Space does elsewhere.
  await page.getByRole("checkbox", { name: "Wireframe" }).focus();
  await page.keyboard.press("Enter");
  assert.equal(await page.getByRole("checkbox", { name: "Wireframe" }).isChecked(), !checked);
  // After a click on a button of the bar, the keys belong to the view; after a key they stay.
  await page.getByRole("button", { name: "Light or dark" }).click();
  assert.ok(await page.evaluate(() => document.activeElement.matches("canvas.view")));
  await page.getByRole("radio", { name: "Why no contact?" }).click();
  assert.ok(await page.evaluate(() => document.activeElement.matches("canvas.view")));
  await page.getByRole("button", { name: "Light or dark" }).focus();
  await page.keyboard.press("Enter");
  assert.equal(await page.evaluate(() => document.activeElement.getAttribute("aria-label")), "Light or dark");
}

async function endedProgram(stage) {
  const { page, program } = await stage.view(nine);
  const { code } = await program.stop("SIGINT");
  assert.equal(code, 0);
  await says(page, "The program has ended");
}

async function secondPage(stage) {
  const { page, program } = await stage.view(nine);
  const second = await stage.page();
  await second.goto(program.address);
  await hasFrame(second);
  await says(page, "Open in another page");
  await page.getByRole("button", { name: "Take it back" }).click();
  await until(page, () => supple.status.state === "connected" && supple.model.frame !== null);
  await says(second, "Open in another page");
  await until(page, (before) => supple.model.framesSeen > before, await page.evaluate(() => supple.model.framesSeen));
}

async function malformedMessage(stage) {
  let frames = 0;
  const page = await pageWithMessages(stage, balls(stage), (message, send) => {
    if (message.readUInt16LE(6) === 2 && ++frames === 2) message.writeUInt32LE(0x7fffffff, 20);
    send(message);
  });
  await hasFrame(page);
  await page.getByRole("checkbox", { name: "Object octrees" }).check();  // requests another frame
  await says(page, "The page cannot read a message of the program");
  assert.equal(await page.locator("canvas.view").isVisible(), true);
}

async function laterVersion(stage) {
  const page = await pageWithMessages(stage, balls(stage), (message, send) => {
    message.writeUInt16LE(3, 4);
    send(message);
  });
  await says(page, "The page cannot read a message of the program");
  await page.getByText("version 3").waitFor();
}

async function hugeScene(stage) {
  const page = await pageWithMessages(stage, balls(stage), (message, send) => {
    if (message.readUInt16LE(6) !== 1) return;
    const text = JSON.parse(message.subarray(32, 32 + message.readUInt32LE(28)).toString());
    text.objects = [{ ...text.objects[0], name: "city", vertices: 900_000_000, triangles: 0 }];
    send(textMessage(1, text));
  });
  await says(page, "This scene is too large for the page");
  await page.getByText("The largest is city, with 900,000,000 vertices").waitFor();
}

async function failedSession(stage) {
  const page = await pageWithMessages(stage, balls(stage), (message, send) => {
    if (message.readUInt16LE(6) === 1) send(textMessage(4, { message: "there is no memory left for the octree", fatal: true }));
  });
  await says(page, "The session has failed");
  await page.getByText("no memory left for the octree").waitFor();
}

async function noWebGl(stage) {
  const program = await stage.program(balls(stage));
  const page = await stage.page();
  await page.addInitScript(() => {
    const get = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return kind.startsWith("webgl") ? null : get.call(this, kind, ...rest);
    };
  });
  await page.goto(program.address);
  await says(page, "This page cannot draw");
}

async function lostContext(stage) {
  const { page } = await stage.view(balls(stage));
  await page.evaluate(() => supple.loseContext());
  await says(page, "Drawing has failed");
}

async function wrongToken(stage) {
  const program = await stage.program(balls(stage));
  const page = await stage.page();
  const answer = await page.goto(program.address.replace(/token=.*/, "token=0"));
  assert.equal(answer.status(), 403);
  await page.getByRole("heading", { name: "This address is not complete" }).waitFor();
}

async function emptyScene(stage) {
  const { page } = await stage.view(stage.file("point.obj", "v 0 0 0\n"));
  await pause(page);
  assert.equal(await page.evaluate(() => supple.model.objects[0].triangles), 0);
}

/**
 * The browser that the program opens gets a file instead of the address. The file leads to the page and does not reveal the token
 * to others.
 */
async function isLedToThePage(stage) {
  const opener = stage.file("xdg-open", `#!/bin/sh\nprintf '%s' "$*" > "$0.part"; mv "$0.part" "$0.asked"\n`);
  chmodSync(opener, 0o755);
  const scene = stage.file("balls.toml", TWO_BALLS);
  const program = await stage.programIn({ PATH: `${stage.folder}:${process.env.PATH}`, DISPLAY: ":0", XDG_RUNTIME_DIR: stage.folder }, scene);
  while (!existsSync(`${opener}.asked`)) await new Promise((done) => setTimeout(done, 20));
  const page = await stage.page();
  await page.goto(pathToFileURL(readFileSync(`${opener}.asked`, "utf8")).href);
  await page.waitForURL(program.address);
  await hasFrame(page);
  assert.equal(await page.evaluate(() => document.referrer), "");
}

export const tests = [
  ["orbits, pans and zooms to the cursor", cameraMoves],
  ["axis views, orthographic, and the view in the address", viewsAndAddress],
  ["saves a picture", savesAPicture],
  ["records a video", recordsAVideo],
  ["keyboard alone", keyboardAlone],
  ["light and dark", lightAndDark],
  ["views survive a reload", viewsSurviveAReload],
  ["Space plays everywhere", spacePlaysEverywhere],
  ["a killed program", killedProgram],
  ["a program that is started again", restartedProgram],
  ["a program that ends", endedProgram],
  ["a second page takes over, and gives back", secondPage],
  ["a malformed message", malformedMessage],
  ["a message of a later version", laterVersion],
  ["a huge scene", hugeScene],
  ["a session that fails", failedSession],
  ["no WebGL", noWebGl],
  ["a lost picture", lostContext],
  ["a wrong token", wrongToken],
  ["a mesh without triangles", emptyScene],
  ["a browser is led to it by a file", isLedToThePage],
];
