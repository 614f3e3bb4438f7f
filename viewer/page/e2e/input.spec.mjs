// Meshes that are unusual: numbers that are not finite, no faces, rods and particles.
import assert from "node:assert/strict";
import { picture, runProgram, settled, steps, until } from "./tools/harness.mjs";

const MESH = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n";
/** A rod of two edges and a particle, 0.01 above the mesh. */
const RODS = "v 0.2 0.2 0.01\nv 0.5 0.2 0.01\nv 0.8 0.3 0.01\nv 0.4 0.6 0.01\nl 1 2 3\np 4\n";

async function saysWhatTouchesNothing(stage) {
  const files = [stage.file("nan.obj", MESH.replace("v 1 1 0", "v nan 1 0")), stage.file("far.obj", MESH.replace("v 1 1 0", "v 1 inf 0")), stage.file("points.obj", "v 0 0 0\nv 1 0 0\n")];
  const { page, program } = await stage.view(...files);
  const log = page.getByRole("log");
  for (const text of ["nan and 1 other object: 2 vertices are NaN or infinite", "points: there are no faces, edges or points"]) {
    await log.getByText(text).waitFor();
    await program.prints(`supple: warning: ${text}`);
  }
  await settled(page);
  await page.getByRole("button", { name: "Dismiss" }).first().click();
  await log.getByText("NaN or infinite").waitFor({ state: "hidden" });
}

/** Rods and particles are drawn, move, and their contacts are shown. */
async function rodsAndParticles(stage) {
  stage.file("mesh.obj", MESH);
  stage.file("rods.obj", RODS);
  const scene = stage.file("rods.toml", `[scene]\ncontacts = "proximity,continuous"\n[[object]]\nmesh = "mesh.obj"\nmargin = 0.02\n[[object]]\nname = "rods"\nmesh = "rods.obj"\nmargin = 0.02\nmotion = { kind = "sway", amplitude = 0.05, wavelength = 1, period = 1 }\n`);
  const { page } = await stage.viewAt(0, scene);
  // In the first second, each step: kinds of pairs with an edge or a point of no triangle.
  const found = () => page.evaluate(() => {
    const { continuous_contacts, proximity_pairs } = supple.model.frame.lists;
    for (const kind of continuous_contacts.columns.kind) window.kinds = (window.kinds ?? new Set()).add(kind);
    window.isNear ||= proximity_pairs.count > 0;
    return window.isNear && window.kinds?.size > 0;
  });
  const most = Math.ceil(1 / (await page.evaluate(() => supple.model.scene.time_step)));
  for (let i = 0; !(await found()); ++i) {
    assert.ok(i < most, "there are no contacts of rods and particles");
    await steps(page, 1);
  }
  const { edges, points } = await page.evaluate(() => ({ edges: [...supple.model.objects[1].edges], points: [...supple.model.objects[1].points] }));
  assert.deepEqual({ edges, points }, { edges: [0, 1, 1, 2], points: [3] });
  // Without marks, hiding the object changes the picture.
  for (const name of ["Proximity pairs", "Contact points"]) {
    const box = page.getByRole("checkbox", { name, exact: true });
    if (await box.count()) await box.setChecked(false);
  }
  await settled(page);
  const shown = await picture(page);
  await page.getByRole("checkbox", { name: "Show rods" }).uncheck();
  await settled(page);
  assert.notEqual(await picture(page), shown, "rods and particles are not drawn");
  await page.getByRole("checkbox", { name: "Show rods" }).check();
  assert.equal(await page.evaluate(() => supple.status.state), "connected");
}

async function rodsInAPage(stage) {
  const rods = stage.file("rods.obj", RODS);
  const file = stage.file("page.html");
  await runProgram(stage.supple, ["view", rods, "--export", file]);
  const page = await stage.page();
  await page.goto(`file://${file}`);
  await until(page, () => window.supple?.model.frame);
  assert.deepEqual(await page.evaluate(() => [...supple.model.objects[0].points]), [3]);
  assert.ok(await page.getByRole("toolbar", { name: "Player" }).isHidden(), "nothing moves");
}

export const tests = [
  ["numbers that are not finite and meshes without faces are said", saysWhatTouchesNothing],
  ["rods and particles are drawn", rodsAndParticles],
  ["rods in an exported page", rodsInAPage],
];
