/** Mouse tools: select, grab and pull, or explain why two triangles do not touch. */
import type { Client } from "./client";
import { selectableIn } from "./contacts";
import type { Model } from "./model";
import type { Inspector } from "./panels/inspector";
import { keyAt } from "./records";
import type { SceneView } from "./view/scene_view";

/** A press that moves less than this is a click. */
const CLICK_PIXELS = 4;
/** The distance that an arrow key pulls, relative to the height of the view. */
const KEY_PULL = 0.02;

interface Grip {
  object: number;
  vertex: number;
  start: [number, number, number];
  to: [number, number, number];
  /** The target has moved since it was sent. */
  moved: boolean;
  /** Since it was grabbed. */
  pulled: boolean;
}

export class Tools {
  /** Called after a click that selects something in the view. */
  onPick: () => void = () => {};
  private grip: Grip | null = null;
  private pressed: { x: number; y: number } | null = null;

  constructor(
    private readonly model: Model, private readonly client: Client, private readonly view: SceneView, private readonly inspector: Inspector,
  ) {
    const { canvas } = view;
    // Handled before the camera controls, which must not orbit while a vertex is pulled.
    canvas.addEventListener("pointerdown", (event) => this.press(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.lift(event));
    canvas.addEventListener("pointercancel", () => this.release());
    model.on("tool", () => this.release());
    model.on("scene", () => this.forget());
    model.on("frame", () => this.grip && this.showPull());
  }

  get isPulling(): boolean {
    return this.grip !== null;
  }

  private press(event: PointerEvent): void {
    if (event.button !== 0) return;
    this.pressed = { x: event.clientX, y: event.clientY };
    if (this.model.tool !== "grab") return;
    const hit = this.view.pointing.pickAt(event.clientX, event.clientY);
    if (!hit) return;
    this.model.select({ object: hit.object, triangle: null, vertex: hit.vertex });
    this.grab(hit.object, hit.vertex);
    this.view.rig.controls.enabled = false;
    this.view.canvas.setPointerCapture(event.pointerId);
  }

  private move(event: PointerEvent): void {
    if (!this.grip || !this.pressed) return;
    const to = this.view.pointing.pointAt(event.clientX, event.clientY, this.grip.start);
    if (to) this.pullTo([to.x, to.y, to.z]);
  }

  private lift(event: PointerEvent): void {
    const from = this.pressed;
    this.pressed = null;
    if (this.grip) {
      this.turn();
      return this.release();
    }
    if (!from || Math.hypot(event.clientX - from.x, event.clientY - from.y) > CLICK_PIXELS) return;
    this.click(event.clientX, event.clientY);
  }

  private click(x: number, y: number): void {
    if (this.model.tool === "explain") return this.pickForExplanation(x, y);
    const { frame } = this.model;
    const place = this.view.pointing.contactAt(x, y);
    if (frame && place >= 0) {
      this.model.selectContact(keyAt(selectableIn(frame), place));
      return this.onPick();
    }
    const hit = this.view.pointing.pickAt(x, y);
    this.model.select(hit ? { object: hit.object, triangle: hit.triangle, vertex: hit.vertex } : null);
    if (hit) this.onPick();
  }

  private pickForExplanation(x: number, y: number): void {
    const hit = this.view.pointing.pickAt(x, y);
    if (!hit) return;
    const { explained } = this.model;
    const next = { object: hit.object, triangle: hit.triangle };
    void this.inspector.explain(explained.length === 1 ? [explained[0]!, next] : [next]);
  }

  private grab(object: number, vertex: number): void {
    if (!this.model.can("grab")) {
      this.client.emit("notice", "Objects of a recording cannot be pulled; open the scene file instead.");
      return;
    }
    const start = this.view.highlights.positionOf(object, vertex);
    this.grip = { object, vertex, start, to: start, moved: false, pulled: false };
    this.client.ask({ do: "grab", object, vertex }).catch((error: Error) => {
      this.client.emit("notice", error.message);
      this.forget();
    });
  }

  /** Keyboard: grabs or releases the selected vertex. */
  toggleGrip(): void {
    if (this.grip) return this.release();
    const { selection } = this.model;
    if (this.model.tool !== "grab" || !selection) return;
    const corner = selection.triangle !== null ? this.model.objects[selection.object]!.corners[3 * selection.triangle]! : 0;
    const vertex = selection.vertex ?? corner;
    this.model.select({ ...selection, vertex });
    this.grab(selection.object, vertex);
    this.showPull();
  }

  /** Keyboard: pulls in the plane of the view. */
  nudge(right: number, up: number): void {
    if (!this.grip) return;
    const { camera, controls } = this.view.rig;
    const step = KEY_PULL * camera.position.distanceTo(controls.target);
    const e = camera.matrixWorld.elements;
    const [x, y, z] = this.grip.to;
    this.pullTo([x + step * (right * e[0]! + up * e[4]!), y + step * (right * e[1]! + up * e[5]!), z + step * (right * e[2]! + up * e[6]!)]);
  }

  private pullTo(to: [number, number, number]): void {
    this.grip!.to = to;
    this.grip!.moved = true;
    this.showPull();
  }

  private showPull(): void {
    this.view.showPull(this.view.highlights.positionOf(this.grip!.object, this.grip!.vertex), this.grip!.to);
  }

  /** Sends at most one command per drawn frame, however often the mouse moves. */
  turn(): void {
    if (!this.grip?.moved) return;
    this.grip.moved = false;
    this.client.send({ do: "drag", to: this.grip.to });
    this.grip.pulled = true;
  }

  release(): void {
    if (this.grip) this.client.send({ do: "release" });
    if (this.grip?.pulled && !this.model.wasPulled) this.model.setPulled();  // not before: then a bar appears, and the view moves
    this.forget();
  }

  private forget(): void {
    this.grip = null;
    this.view.rig.controls.enabled = true;
    this.view.showPull(null, null);
  }
}
