/** Every command of the page, once: its name, its keys, and what it does. The keyboard, the list of shortcuts and the palette use it. */
import type { App } from "./app";
import { LAYER_ROWS } from "./view/styles";
import { AXIS_VIEWS, type AxisView } from "./view/camera";
import { LAYOUTS } from "./view/panes";

export interface Command {
  name: string;
  /** Such as `Shift+F`; letters are capitals. Gestures of the pointer are written out. */
  keys: string[];
  /** Without it, the entry only describes a gesture. Returns false when the key is not used now. */
  run?: () => void | false;
}

export type CommandGroup = [title: string, commands: Command[]];

const TURN = 0.12;
const SHIFT = 0.05;
const ZOOM = 1.15;
const NUMBERS = ["one view", "two views", "four views"];

export function commandsOf(app: App): CommandGroup[] {
  const { player, view, model, tools, pins } = app;
  const pull = (right: number, up: number, otherwise: () => void | false) => () => (tools.isPulling ? tools.nudge(right, up) : otherwise());
  const unused = () => false as const;
  const forward = pull(1, 0, () => player.step(1));
  const back = pull(-1, 0, () => player.step(-1));
  const orbit = (name: string, key: string, right: number, up: number): Command => ({ name: `Orbit ${name}`, keys: [`Shift+${key}`], run: () => view.rig.orbit(right * TURN, up * TURN) });
  const pan = (name: string, key: string, right: number, up: number): Command => ({ name: `Pan ${name}`, keys: [`Alt+${key}`], run: () => view.rig.pan(right * SHIFT, up * SHIFT) });
  const four = (make: (name: string, key: string, right: number, up: number) => Command) =>
    [make("left", "ArrowLeft", -1, 0), make("right", "ArrowRight", 1, 0), make("up", "ArrowUp", 0, 1), make("down", "ArrowDown", 0, -1)];
  return [
    ["Play", [
      { name: "Play or pause, wherever the focus is", keys: ["Space"], run: () => player.togglePlay() },
      { name: "One step forward", keys: ["ArrowRight"], run: forward },
      { name: "One step back", keys: ["ArrowLeft"], run: back },
      { name: "First frame", keys: ["Home"], run: () => player.seek(-Infinity) },
      { name: "Last or newest frame", keys: ["End"], run: () => player.seek(Infinity) },
      { name: "Next event", keys: ["."], run: () => player.jump(1) },
      { name: "Previous event", keys: [","], run: () => player.jump(-1) },
      { name: "Slower", keys: ["["], run: () => player.faster(-1) },
      { name: "Faster", keys: ["]"], run: () => player.faster(1) },
      { name: "Loop", keys: ["L"], run: () => player.toggleLoop() },
      { name: "Start and end of a section to loop", keys: ["Shift+L"], run: () => player.markSection() },
      { name: "Restart with the seed", keys: ["R"], run: () => player.reset() },
    ]],
    ["Look", [
      { name: "Orbit; right button or Shift: pan", keys: ["drag"] },
      { name: "Zoom to the cursor", keys: ["wheel"] },
      { name: "Turn around this point", keys: ["double-click"] },
      { name: "Values under the pointer", keys: ["rest", "long press"] },
      ...four(orbit), ...four(pan),
      { name: "Zoom in", keys: ["+", "="], run: () => view.rig.zoom(ZOOM) },
      { name: "Zoom out", keys: ["-"], run: () => view.rig.zoom(1 / ZOOM) },
      { name: "Frame all", keys: ["F"], run: () => view.frameAll() },
      { name: "Frame the selection", keys: ["Shift+F"], run: () => view.frameSelection() },
      ...(Object.keys(AXIS_VIEWS) as AxisView[]).map((name, i) => ({ name: `Look from the ${name}`, keys: [String(i + 1)], run: () => view.rig.lookAlong(name) })),
      { name: "Orthographic or perspective", keys: ["O"], run: () => app.toggleOrthographic() },
      ...LAYOUTS.map((layout, i) => ({ name: `Show ${NUMBERS[i]}`, keys: [], run: () => view.setLayout(layout) })),
      { name: "One, two or four views", keys: ["Q"], run: () => view.nextLayout() },
      { name: "Next of several views", keys: ["Z"], run: () => view.nextPane() },
    ]],
    ["Work", [
      { name: "Tool: select an object, triangle or contact", keys: ["V"], run: () => model.setTool("select") },
      { name: "Tool: grab, drag a vertex", keys: ["G"], run: () => model.setTool("grab") },
      { name: "Hold or release the selected vertex; arrows pull it", keys: ["Enter"], run: () => tools.toggleGrip() },
      { name: "Tool: why no contact? Click two triangles", keys: ["W"], run: () => model.setTool("explain") },
      { name: "Pin or unpin the selection", keys: ["Shift+I"], run: () => pins.toggleSelection() },
      { name: "Pull a held vertex up; in a list: previous row", keys: ["ArrowUp"], run: pull(0, 1, unused) },
      { name: "Pull a held vertex down; in a list: next row", keys: ["ArrowDown"], run: pull(0, -1, unused) },
      { name: "Release, clear the selection, close", keys: ["Escape"], run: () => app.escape() },
    ]],
    ["Layers", LAYER_ROWS.map(({ layer, label, key }) => ({ name: label, keys: [key], run: () => model.setLayer(layer, !model.layers[layer]) }))],
    ["Page", [
      { name: "Command palette", keys: ["Ctrl+K"], run: () => app.palette.open() },
      { name: "Save a picture", keys: ["Shift+S"], run: () => app.picture() },
      { name: "Start or stop a video", keys: ["Shift+V"], run: () => app.film() },
      { name: "Save frames as pictures", keys: ["Shift+P"], run: () => app.frames() },
      { name: "Light or dark", keys: ["T"], run: () => app.toggleTheme() },
      { name: "Hide or show the panels", keys: ["H"], run: () => app.togglePanels() },
      { name: "Keyboard shortcuts", keys: ["?"], run: () => app.help.showModal() },
    ]],
  ];
}
