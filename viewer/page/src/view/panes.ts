/** The parts of the canvas that show the scene, each with a camera of its own. One of them is active: keys and tools act on it. */
import * as THREE from "three";
import { CameraRig, type AxisView, type CameraState } from "./camera";
import type { Projection } from "./marks";
import { shared } from "./primitives";

/** Numbers of panes. */
export const LAYOUTS = [1, 2, 4] as const;
export type Layout = (typeof LAYOUTS)[number];

/** As a view file keeps it: the layout, and the cameras of the panes besides the first. */
export interface StoredPanes {
  layout: (typeof LAYOUT_WORDS)[number];
  cameras: Record<string, Partial<CameraState>>;
}
const LAYOUT_WORDS = ["one", "two", "four"] as const;
/** In view files. */
export const PANE_NAMES = ["first", "second", "third", "fourth"];

/** The directions of the cameras besides the first, until the user turns them. */
const DIRECTIONS: AxisView[] = ["front", "right", "top"];
/** Between two panes, in CSS pixels. */
const GAP = 2;

/** In CSS pixels of the canvas, from the upper left. */
export interface Area {
  left: number;
  top: number;
  width: number;
  height: number;
}

export function areasOf(layout: Layout, width: number, height: number): Area[] {
  const [columns, rows] = layout === 1 ? [1, 1] : layout === 4 ? [2, 2] : width >= height ? [2, 1] : [1, 2];
  const [w, h] = [(width - GAP * (columns! - 1)) / columns!, (height - GAP * (rows! - 1)) / rows!];
  return Array.from({ length: layout }, (_, i) => ({ left: (i % columns!) * (w + GAP), top: Math.floor(i / columns!) * (h + GAP), width: w, height: h }));
}

/** The part of the interface of an element that the camera controls use, for a part of the canvas. */
class PaneElement {
  readonly style = { touchAction: "" };
  private readonly wrapped = new Map<unknown, (event: Event) => void>();

  constructor(private readonly canvas: HTMLElement, private readonly area: () => Area, private readonly takes: (event: Event) => boolean) {}

  get clientWidth(): number {
    return this.area().width;
  }

  get clientHeight(): number {
    return this.area().height;
  }

  get ownerDocument(): Document {
    return this.canvas.ownerDocument;
  }

  getRootNode(): Node {
    return this.canvas.getRootNode();
  }

  getBoundingClientRect(): DOMRect {
    const { left, top } = this.canvas.getBoundingClientRect();
    const area = this.area();
    return new DOMRect(left + area.left, top + area.top, area.width, area.height);
  }

  setPointerCapture(id: number): void {
    this.canvas.setPointerCapture(id);
  }

  releasePointerCapture(id: number): void {
    this.canvas.releasePointerCapture(id);
  }

  addEventListener(type: string, listener: (event: Event) => void, options?: AddEventListenerOptions): void {
    const wrapped = this.wrapped.get(listener) ?? ((event: Event) => this.takes(event) && listener(event));
    this.wrapped.set(listener, wrapped);
    this.canvas.addEventListener(type, wrapped, options);
  }

  removeEventListener(type: string, listener: (event: Event) => void, options?: EventListenerOptions): void {
    const wrapped = this.wrapped.get(listener);
    if (wrapped) this.canvas.removeEventListener(type, wrapped, options);
  }
}

export interface Pane {
  readonly index: number;
  readonly rig: CameraRig;
  area: Area;
  readonly projection: Projection;
  readonly size: THREE.Vector2;
}

let versions = 0;

export class Panes {
  layout: Layout = 1;
  active: Pane;
  /** Called when the layout or the active pane has changed. */
  onChange: () => void = () => {};
  private readonly all: Pane[] = [];
  private width = 1;
  private height = 1;
  private isAlone = false;

  constructor(private readonly canvas: HTMLCanvasElement, private readonly changed: () => void) {
    this.active = this.make();
    // Before the tools and the camera controls, which act on the active pane.
    canvas.addEventListener("pointerdown", (event) => event.isPrimary && this.activate(this.at(event.clientX, event.clientY)), { capture: true });
    canvas.addEventListener("wheel", (event) => this.activate(this.at(event.clientX, event.clientY)), { capture: true, passive: true });
  }

  private make(): Pane {
    const takes = () => this.active === pane && this.shown.includes(pane);
    const element = new PaneElement(this.canvas, () => pane.area, takes) as unknown as HTMLElement;
    const isFirst = this.all.length === 0;
    const pane: Pane = {
      index: this.all.length, area: { left: 0, top: 0, width: 1, height: 1 }, projection: { matrix: new THREE.Matrix4(), version: 0 }, size: new THREE.Vector2(),
      rig: new CameraRig(element, this.changed, isFirst),
    };
    this.all.push(pane);
    return pane;
  }

  get shown(): Pane[] {
    return this.isAlone ? [this.active] : this.all.slice(0, this.layout);
  }

  /** For pictures that have the matrix or the scale of one camera: the active pane fills the canvas. */
  set alone(on: boolean) {
    this.isAlone = on;
  }

  get rigs(): CameraRig[] {
    return this.all.map(({ rig }) => rig);
  }

  /** The pane below a point of the window, or the nearest. */
  at(x: number, y: number): Pane {
    const { left, top } = this.canvas.getBoundingClientRect();
    const inside = ({ area }: Pane) => x - left < area.left + area.width + GAP && y - top < area.top + area.height + GAP;
    return this.shown.find(inside) ?? this.active;
  }

  activate(pane: Pane): void {
    if (pane === this.active) return;
    this.active = pane;
    this.onChange();
    this.changed();
  }

  next(): void {
    this.activate(this.shown[(this.shown.indexOf(this.active) + 1) % this.layout]!);
  }

  /** Returns the panes besides the first that still look along their axis: they fit the scene to their new size. */
  setLayout(layout: Layout): Pane[] {
    const [first] = this.all;
    while (this.all.length < layout) {
      const pane = this.make();
      pane.rig.follow(first!.rig);
      pane.rig.setOrthographic(true);
      pane.rig.lookAlong(DIRECTIONS[this.all.length - 2]!, false);
    }
    this.layout = layout;
    if (!this.shown.includes(this.active)) this.active = first!;
    this.resize(this.width, this.height);
    this.onChange();
    return this.shown.filter(({ rig }, i) => i > 0 && rig.looksAlong(DIRECTIONS[i - 1]!));
  }

  /** Takes the size of the canvas in CSS pixels. */
  resize(width: number, height: number): void {
    this.width = width;
    this.height = height;
    const { shown } = this;
    areasOf(shown.length as Layout, width, height).forEach((area, i) => {
      shown[i]!.area = area;
      shown[i]!.rig.resize(area.width, area.height);
    });
  }

  /** Prepares to draw a pane: the renderer draws only there, and marks are projected to there. */
  begin(pane: Pane, renderer: THREE.WebGLRenderer): void {
    const ratio = shared.pixelRatio.value;
    const { left, top, width, height } = pane.area;
    const [x, y, w, h] = [left, this.height - top - height, width, height].map((length) => Math.round(length * ratio)) as [number, number, number, number];
    renderer.setViewport(x, y, w, h);
    renderer.setScissor(x, y, w, h);
    renderer.setScissorTest(this.shown.length > 1);
    shared.resolution.value.set(w / ratio, h / ratio);
    const { camera } = pane.rig;
    camera.updateMatrixWorld();
    const { matrix } = pane.projection;
    const before = matrix.clone();
    matrix.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    // Versions of several panes differ, because marks are chosen for one pane at a time.
    if (!matrix.equals(before) || !pane.size.equals(shared.resolution.value)) pane.projection.version = ++versions;
    pane.size.copy(shared.resolution.value);
  }

  get stored(): StoredPanes {
    const cameras = this.all.slice(1).map(({ rig }, i) => [PANE_NAMES[1 + i]!, rig.state]);
    return { layout: LAYOUT_WORDS[LAYOUTS.indexOf(this.layout)]!, cameras: Object.fromEntries(cameras) };
  }

  /** Applies the cameras of a stored view; its layout comes first. */
  placeCameras(cameras: StoredPanes["cameras"]): void {
    this.all.slice(1).forEach(({ rig }, i) => (rig.state = { ...rig.state, ...cameras[PANE_NAMES[1 + i]!] }));
  }
}

export const layoutOf = (word: StoredPanes["layout"]): Layout => LAYOUTS[LAYOUT_WORDS.indexOf(word)]!;
