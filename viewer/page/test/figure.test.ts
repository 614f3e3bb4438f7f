import assert from "node:assert/strict";
import { test } from "node:test";
import { DepthBuffer, edgesOf, outlineOf, project, visibleParts } from "../src/capture/lines";
import { drawOverlay } from "../src/capture/overlay";
import { svgPen } from "../src/capture/pen";
import { plotSvg } from "../src/capture/plot_svg";
import { resolutionChunk } from "../src/capture/png";

const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

test("a PNG chunk has the pixels per metre", () => {
  const chunk = resolutionChunk(300);
  const view = new DataView(chunk.buffer);
  assert.equal(new TextDecoder().decode(chunk.subarray(4, 8)), "pHYs");
  assert.deepEqual([view.getUint32(0), view.getUint32(8), view.getUint32(12), chunk[16]], [9, 11811, 11811, 1]);
  assert.equal(view.getUint32(17), 0x78a53f76);  // by zlib
});

test("points are projected to the screen, and those behind the camera are not", () => {
  assert.deepEqual([...project([0, 0, 0, 1, 1, 0.5], IDENTITY, 200, 100)], [100, 50, 0, 200, 0, 0.5]);
  const behind = [...IDENTITY];
  behind[15] = -1;
  assert.ok([...project([0, 0, 0], behind, 200, 100)].every(Number.isNaN));
});

test("each edge is there once, with both its triangles; rods have no closing edge", () => {
  assert.deepEqual([...edgesOf(Uint32Array.from([0, 1, 2, 2, 1, 3]))], [0, 1, 0, -1, 1, 2, 0, 1, 2, 0, 0, -1, 1, 3, 1, -1, 3, 2, 1, -1]);
  assert.deepEqual([...edgesOf(Uint32Array.from([4, 5, 5, 6, 6, 6]))], [4, 5, 0, -1]);
});

test("an outline has borders and creases, not the diagonal of a flat square", () => {
  const corners = Uint32Array.from([0, 1, 2, 2, 1, 3]);
  const outline = (z: number) => {
    const positions = [0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, z];
    return outlineOf(edgesOf(corners), positions, corners, project(positions, IDENTITY, 100, 100)).length / 4;
  };
  assert.equal(outline(0), 4);
  assert.equal(outline(3), 5);
});

test("a triangle hides the part of a line that is behind it", () => {
  const buffer = new DepthBuffer(100, 100);
  buffer.add(Float32Array.from([20, 0, 0.2, 60, 0, 0.2, 20, 100, 0.2, NaN, 0, 0]), Uint32Array.from([0, 1, 2, 0, 1, 3]), 1);
  const behind = visibleParts([0, 20, 0.5], [100, 20, 0.5], buffer, 1);
  assert.equal(behind.length, 2);
  const [left, right] = behind;
  assert.ok(Math.abs(left![0]) < 1e-6 && Math.abs(left![2] - 20) < 2, String(left));
  assert.ok(Math.abs(right![0] - 52) < 3 && right![2] === 100, String(right));
  assert.deepEqual(visibleParts([0, 20, 0.1], [100, 20, 0.1], buffer, 1), [[0, 20, 100, 20]]);
  assert.deepEqual(visibleParts([0, 20, 0.5], [100, 20, 0.5], null, 1), [[0, 20, 100, 20]]);
  assert.deepEqual(visibleParts([0, 20, 0.5], [NaN, 20, 0.5], buffer, 1), []);
});

test("the overlay has the objects that fit, and a bar of a round length", () => {
  const parts: string[] = [];
  const objects = Array.from({ length: 50 }, (_, i) => ({ name: `<${i}>`, colour: "#8ecae6" }));
  drawOverlay(svgPen(parts), { width: 400, height: 200, ink: "#000", halo: null, objects, scale: { perPixel: 0.01, unit: "m", isPerspective: true }, bar: { title: "Speed (m/s)", map: "viridis", low: 0, high: 2, note: "" } });
  const svg = parts.join("\n");
  assert.ok(/>&#60;0&#62;</.test(svg), svg);
  assert.ok(/>and 44 more</.test(svg), svg);
  assert.ok(/>Speed \(m\/s\)</.test(svg) && />2</.test(svg), svg);
  assert.ok(/fill="rgb\(253 231 37\)"/.test(svg), "the last colour of viridis");
  assert.ok(/>1 m \(at the target\)</.test(svg), svg);
  assert.ok(/<rect x="288" y="184" width="100"/.test(svg), svg);
});

test("a plot as SVG has its lines, with gaps, and round ticks", () => {
  const svg = plotSvg("Pairs & more", "frame", [10, 11, 12, 13], [
    { label: "pairs", colour: "#0072b2", values: [0, 4, NaN, 8] }, { label: "candidates", colour: "#e69f00", values: [1, 1, 1, 1] },
  ]);
  assert.ok(svg.includes(">Pairs &#38; more<"), svg);
  assert.equal(svg.match(/stroke-width="1.5"/g)!.length, 2);
  assert.ok(/d="M56 204L193.33 124M468 44" stroke="#0072b2"/.test(svg), svg);
  assert.ok(svg.startsWith('<svg xmlns="http://www.w3.org/2000/svg" width="480" height="240" viewBox="0 0 480 240">'), svg);
  for (const tick of ["0", "2", "4", "6", "8", "10", "11", "12", "13"]) assert.ok(svg.includes(`>${tick}</text>`), tick);
});

test("labels of a plot are in as many rows as they need, and its curves are below them", () => {
  const lines = Array.from({ length: 9 }, (_, i) => ({ label: `stage ${i}`, colour: "#0072b2", values: [0, 10] }));
  const svg = plotSvg("Times", "step", [0, 1], lines, { width: 200, height: 300, millimetres: 50 });
  assert.ok(svg.includes('width="50mm" height="75mm" viewBox="0 0 200 300"'), svg);
  const labels = [...svg.matchAll(/<text x="([\d.]+)" y="([\d.]+)"[^>]*>stage/g)].map(([, x, y]) => [Number(x), Number(y)] as const);
  assert.equal(new Set(labels.map(([x, y]) => `${x} ${y}`)).size, 9);
  const highest = Math.max(...labels.map(([, y]) => y));
  const tops = [...svg.matchAll(/L188 ([\d.]+)" stroke="#0072b2"/g)].map(([, y]) => Number(y));
  assert.equal(tops.length, 9);
  assert.ok(tops.every((y) => y > highest), `${tops} ${highest}`);
});
