import { h, sheet } from "./dom";

const GROUPS: [string, [string, string][]][] = [
  ["Play", [
    ["Space", "play or pause, wherever the focus is; Enter presses a button and ticks a box"], ["→ ←", "one step forward, back"], ["Home End", "first, newest frame"],
    [". ,", "next, previous event"], ["[ ]", "slower, faster"], ["L", "loop"], ["Shift L", "start and end of a section to loop"], ["R", "restart with the seed"],
  ]],
  ["Look", [
    ["drag", "orbit; right button or Shift: pan"], ["wheel", "zoom to the cursor"], ["double-click", "turn around this point"], ["Shift arrows", "orbit"], ["Alt arrows", "pan"], ["+ −", "zoom"],
    ["F", "frame all"], ["Shift F", "frame the selection"], ["1 … 6", "front, back, right, left, top, bottom"], ["O", "orthographic or perspective"],
  ]],
  ["Work", [
    ["V", "select: click an object, triangle, contact"], ["G", "grab: drag a vertex, or select one and use Enter and the arrows"], ["W", "why no contact: click two triangles"],
    ["↑ ↓", "in a list: next or previous row"], ["Esc", "release, clear the selection, close"],
  ]],
  ["Layers", [
    ["S X", "surfaces, wireframe"], ["N B K", "scene octree, object octrees, colliding nodes"], ["P C", "object pairs, candidates"],
    ["I D", "intersecting triangles, contact points"], ["Y U J", "normals, segments, vertices"],
    ["M E A", "proximity pairs, depths in solids, curves"],
  ]],
  ["Page", [
    ["Shift S", "save a picture"], ["Shift V", "start or stop recording a video"], ["Shift P", "save every frame as a picture of any size"], ["T", "light or dark"], ["H", "hide or show the panels"], ["?", "this list"],
  ]],
];

export function helpSheet(): HTMLDialogElement {
  const groups = GROUPS.map(([title, rows]) =>
    h("section", {}, h("h3", {}, title), h("dl", {}, ...rows.flatMap(([keys, does]) => [h("dt", {}, ...keys.split(" ").map((key) => h("kbd", {}, key))), h("dd", {}, does)]))),
  );
  const dialog = sheet("Keyboard shortcuts", "help", h("div", { class: "groups" }, ...groups));
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
  return dialog;
}
