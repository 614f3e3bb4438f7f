/** Draws surfaces, layers and the selection, only when something has changed. */
import * as THREE from "three";
import { boundsOf, boundsOfAll, type Bounds } from "../bounds";
import type { Model, ObjectState } from "../model";
import { readField } from "../fields/fields";
import type { CameraRig } from "./camera";
import { Highlights } from "./highlights";
import { Layers } from "./layers";
import { drawsInSoftware, Occlusion } from "./occlusion";
import { LAYOUTS, Panes, type Layout, type Pane } from "./panes";
import { Pointing } from "./pointing";
import { shared } from "./primitives";
import { Slice } from "./slice";
import { obstacleOf, Surfaces } from "./surfaces";
import { World } from "./world";

/** From the scene to the first camera: from above, so that one looks into open boxes. */
const FIRST_DIRECTION = new THREE.Vector3(0.55, 0.7, 1);

const XRAY_OPACITY = 0.3;
/** After this many pictures in a row that take longer than this, drawing becomes simpler. */
const SLOW_TURNS = 30;
const SLOW_MILLISECONDS = 40;
/** How far objects within a border may move and stay in the first view, relative to their size together. */
const ROOM = 0.25;
/** The first view has the whole border when it is at most so large, relative to the objects: they go everywhere in it. */
const NEAR_BORDER = 4;

/** Behind the objects of a picture; `theme` is that of the page, with its floor and axes. */
export type Background = "theme" | "white" | "transparent";
const WHITE = new THREE.Color(0xffffff);

/** In pixels. */
export interface PictureSize {
  width: number;
  height: number;
}

export class SceneView {
  readonly layers: Layers;
  readonly panes: Panes;
  readonly pointing: Pointing;
  /** Called before each drawing; allows the session to send the next frame. */
  onTurn: () => void = () => {};
  /** Called when the WebGL context is lost. */
  onLost: (why: string) => void = () => {};
  readonly times: number[] = [];
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly surfaces = new Surfaces();
  private readonly world = new World();
  private readonly slice: Slice;
  private readonly occlusion = new Occlusion();
  private slowTurns = 0;
  private lastTurn = 0;
  private shadowIsStale = true;
  private drawnInfo = { calls: 0, triangles: 0, points: 0 };
  readonly highlights: Highlights;
  private ground = new THREE.Color();
  /** Between several panes. */
  private readonly line = new THREE.Color();
  private wasSmooth = true;
  private dirty = true;
  private filled = false;
  /** The view whose objects the surfaces and the marks show. */
  private preparedView = 0;
  private checkMemory = false;
  private hasFramed = false;
  /** True while only `draw` draws, at a fixed size. */
  private takesPictures = false;

  constructor(readonly canvas: HTMLCanvasElement, private readonly model: Model) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, stencil: true, powerPreference: "high-performance" });
    this.renderer.setClearAlpha(1);
    model.occlusion = !drawsInSoftware(this.renderer.getContext());
    this.panes = new Panes(canvas, () => this.invalidate());
    this.layers = new Layers(model);
    this.highlights = new Highlights(model);
    this.slice = new Slice(model, () => this.surfaces.counting);
    this.pointing = new Pointing(canvas, model, this.panes, this.slice);
    this.scene.add(this.slice.group, this.world.group, this.surfaces.group, this.layers.group, this.highlights.group);
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      this.onLost("The graphics card stopped drawing. The scene may be too large for it.");
    });
    canvas.addEventListener("dblclick", (event) => {
      const hit = this.pointing.pickAt(event.clientX, event.clientY);
      if (hit) this.rig.pivot(new THREE.Vector3(...hit.point));
    });
    model.on("scene", () => this.build());
    model.on("frame", (frame) => {
      this.touch(frame.positions.keys());
      if (!this.hasFramed) this.firstFrame();
    });
    model.on("display", () => this.paint());
    model.on("selection", () => this.select());
    model.on("explanation", () => this.refill());
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
    requestAnimationFrame((now) => this.turn(now));
  }

  /** The camera of the active pane. */
  get rig(): CameraRig {
    return this.panes.active.rig;
  }

  setLayout(layout: Layout): void {
    const { model, panes } = this;
    const before = panes.rigs.length;
    for (let view = before; view < layout; ++view) model.copyView(model.view, view);
    model.viewCount = layout;
    for (const { rig, index } of panes.setLayout(layout)) model.inView(index, () => this.frameObjects(model.objects.filter(({ visible }) => visible), rig, false));
    model.emit("request", null);
    this.invalidate();
  }

  nextLayout(): void {
    this.setLayout(LAYOUTS[(LAYOUTS.indexOf(this.panes.layout) + 1) % LAYOUTS.length]!);
  }

  nextPane(): void {
    this.panes.next();
  }

  /** A sentence about why this machine cannot display the scene, or null. */
  obstacle(objects: { name: string; vertices: number; triangles: number }[]): string | null {
    return obstacleOf(this.renderer.getContext() as WebGL2RenderingContext, objects);
  }

  setColours(ground: string, ink: string, line: string): void {
    this.ground = new THREE.Color(ground);
    this.renderer.setClearColor(this.ground, this.renderer.getClearAlpha());
    this.line.set(line);
    this.world.setColours(ink, this.ground.getHSL({ h: 0, s: 0, l: 0 }).l < 0.5);
    this.invalidate();
  }

  invalidate(): void {
    this.dirty = true;
  }

  /** Whether surfaces are shaded flat because too many triangles move. */
  get isFlat(): boolean {
    return this.surfaces.isTooLarge;
  }

  /** Whether everything that changed has been drawn. */
  get isUpToDate(): boolean {
    return !this.dirty;
  }

  /** Marks the positions of these objects as changed. */
  touch(objects: Iterable<number> = this.model.objects.keys()): void {
    this.surfaces.touch(objects);
    this.shadowIsStale = true;
    this.refill();
  }

  private refill(): void {
    this.filled = false;
    this.dirty = true;
  }

  /** The size in the window. */
  get windowSize(): PictureSize {
    const ratio = Math.min(devicePixelRatio, 2);
    return { width: Math.floor(ratio * this.canvas.clientWidth), height: Math.floor(ratio * this.canvas.clientHeight) };
  }

  /** The maximum width and height of a picture. */
  get largestSide(): number {
    const gl = this.renderer.getContext();
    const [width, height] = gl.getParameter(gl.MAX_VIEWPORT_DIMS) as Int32Array;
    return Math.min(width!, height!, gl.getParameter(gl.MAX_RENDERBUFFER_SIZE) as number);
  }

  /**
   * From now on only `draw` draws, at the given size, independent of the window. Marks are drawn `ratio` times
   * larger than their size in CSS pixels. `isAlone`: only the active one of several views. Null returns to the window. Throws with a sentence when WebGL cannot
   * draw that size.
   */
  setPicture(size: PictureSize | null, background: Background = "theme", ratio = 1, isAlone = false): void {
    this.takesPictures = false;
    this.panes.alone = isAlone;
    this.world.group.visible = size === null || background === "theme";
    this.renderer.setClearColor(size && background === "white" ? WHITE : this.ground, size && background === "transparent" ? 0 : 1);
    if (!size) return this.resize();
    const { width, height } = size;
    const most = this.largestSide;
    if (Math.max(width, height) > most) throw new Error(`WebGL draws no picture of ${width} × ${height} here: ${most} pixels a side are the most. Choose a smaller size.`);
    for (const rig of this.panes.rigs) rig.advance(Infinity);  // end the flight
    this.setSize(size, ratio);
    this.takesPictures = true;
    const gl = this.renderer.getContext();
    if (gl.drawingBufferWidth !== width || gl.drawingBufferHeight !== height)
      throw new Error(`WebGL does not have enough memory for a picture of ${width} × ${height}. Choose a smaller size.`);
  }

  /** A sentence about why the last drawing is not a valid picture, or null. */
  get fault(): string | null {
    const gl = this.renderer.getContext();
    const error = gl.getError();
    if (gl.isContextLost() || error === gl.CONTEXT_LOST_WEBGL) return "The graphics card stopped drawing.";
    return error === gl.OUT_OF_MEMORY ? "The graphics card does not have enough memory for pictures of this size. Choose a smaller size." : null;
  }

  private resize(): void {
    const size = this.windowSize;
    if (this.takesPictures || size.width === 0 || size.height === 0) return;
    this.setSize(size, Math.min(devicePixelRatio, 2));
  }

  /** Marks are drawn `ratio` times larger than their size in pixels. */
  private setSize({ width, height }: PictureSize, ratio: number): void {
    this.renderer.setDrawingBufferSize(width, height, 1);
    shared.pixelRatio.value = ratio;
    this.panes.resize(width / ratio, height / ratio);
  }

  private build(): void {
    this.surfaces.build(this.model.objects, this.model.positions);
    const bounds = this.model.scene!.bounds;
    for (const rig of this.panes.rigs) rig.setExtent(Math.hypot(...bounds[0], ...bounds[1]));
    shared.lift.value = 0.01 * Math.hypot(...bounds[1].map((x, axis) => x - bounds[0][axis]!));
    this.slice.build();
    this.placeWorld();
    this.checkMemory = true;
    this.highlights.showPull(null, null);
    this.select();
    this.paint();
  }

  private placeWorld(): void {
    const { bounds, border, center } = this.model.scene!;
    const { up, unit } = this.model;
    this.world.build(bounds, border ?? null, center, unit, up);
    for (const rig of this.panes.rigs) rig.setUp(this.world.turn);
    this.surfaces.up = this.rig.camera.up;
    this.shadowIsStale = true;
  }

  /** Applies the appearance of the objects. */
  private paint(): void {
    const { layers, xray, smooth, up } = this.model;
    this.surfaces.paint(layers, xray ? XRAY_OPACITY : 1);
    if (smooth !== this.wasSmooth) this.surfaces.isSmooth = smooth;
    this.wasSmooth = smooth;
    if (up !== this.world.up) this.placeWorld();
    this.preparedView = this.model.view;
    this.shadowIsStale = true;
    this.refill();
  }

  /** Makes surfaces, marks and the shadow those of the model's view; costs nothing while all views show the same objects. */
  private prepare(): void {
    const { view, layers, xray } = this.model;
    if (!this.model.showsSame(this.preparedView, view)) {
      this.surfaces.paint(layers, xray ? XRAY_OPACITY : 1);
      this.shadowIsStale = true;
      this.filled = false;
    }
    this.preparedView = view;
    if (!this.filled) this.fill();
    if (!this.shadowIsStale || !this.world.group.visible) return;
    this.shadowIsStale = false;
    this.lowerFloor();
    this.world.shadow.draw(this.renderer, this.surfaces.casters);
  }

  private select(): void {
    this.surfaces.select(this.model.selection?.object ?? null);
    this.refill();
  }

  private fill(): void {
    this.filled = true;
    this.layers.update();
    this.highlights.update();
    this.surfaces.showField(readField(this.model), this.model.field);
  }

  /** Shows the pulled vertex and its target, or nothing. */
  showPull(from: ArrayLike<number> | null, to: ArrayLike<number> | null): void {
    this.highlights.showPull(from, to);
    this.invalidate();
  }

  /**
   * Shows what moves with the border, or in a large one with some room to move, and the objects around it that are
   * not much larger.
   */
  private firstFrame(): void {
    this.hasFramed = true;
    this.lowerFloor();
    if (this.rig.restore()) return;
    const { objects } = this.model;
    const { border } = this.model.scene!;
    const moving = boundsOfAll(objects.filter(({ isStatic }) => !isStatic));
    const size = ({ lower, upper }: Bounds) => Math.hypot(...upper.map((x, axis) => x - lower[axis]!));
    const shown = boundsOfAll(objects.filter((object) => !moving || !object.isStatic || size(boundsOf(object) ?? moving) < 3 * size(moving)));
    if (!shown) return;
    const isNear = border && size({ lower: border[0], upper: border[1] }) <= NEAR_BORDER * size(shown);
    const room = isNear ? Infinity : border ? ROOM * size(shown) : 0;
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [0, 1, 2].map((axis) => {
      const isUpper = (i >> axis) & 1;
      return isUpper ? Math.max(shown.upper[axis]!, Math.min(shown.upper[axis]! + room, border?.[1][axis] ?? Infinity)) : Math.min(shown.lower[axis]!, Math.max(shown.lower[axis]! - room, border?.[0][axis] ?? -Infinity));
    }));
    const center = new THREE.Vector3().fromArray(corners[0]!).add(new THREE.Vector3().fromArray(corners[7]!)).multiplyScalar(0.5);
    this.rig.frame(center, corners, FIRST_DIRECTION.clone().applyQuaternion(this.world.turn), false);
  }

  private lowerFloor(): void {
    const bounds = boundsOfAll(this.model.objects.filter(({ visible }) => visible));
    if (bounds) this.world.follow(bounds.lower["xyz".indexOf(this.model.up)]!);
  }

  frameAll(): void {
    this.frameObjects(this.model.objects.filter((object) => object.visible));
  }

  /** Frames the selection: a contact, a triangle or vertex, or an object; otherwise everything. */
  frameSelection(): void {
    const { selection } = this.model;
    const point = this.highlights.contactPoint();
    if (point) return this.flyTo(point);
    if (!selection) return this.frameAll();
    if (selection.triangle !== null) return this.flyTo(this.highlights.centroid(selection.object, selection.triangle));
    this.frameObjects([this.model.objects[selection.object]!]);
  }

  /** Frames a point and everything within `least` of it, but at least a small part of the scene. */
  flyTo(point: number[], least = 0): void {
    const bounds = this.model.scene!.bounds;
    const reach = Math.max(least, 0.04 * (Math.hypot(...bounds[1].map((x, axis) => x - bounds[0][axis]!)) || 1));
    const around = [-reach, reach].flatMap((step) => [0, 1, 2].map((axis) => point.map((x, i) => (i === axis ? x + step : x))));
    this.rig.frame(new THREE.Vector3().fromArray(point), around);
  }

  private frameObjects(objects: ObjectState[], rig = this.rig, fly = true): void {
    const bounds = boundsOfAll(objects);
    if (!bounds) return;
    const lower = new THREE.Vector3().fromArray(bounds.lower);
    const upper = new THREE.Vector3().fromArray(bounds.upper);
    rig.setExtent(Math.max(lower.length(), upper.length()));
    rig.frame(lower.add(upper).multiplyScalar(0.5), objects.map((object) => object.positions), undefined, fly);
  }

  private turn(now: number): void {
    requestAnimationFrame((next) => this.turn(next));
    for (const rig of this.panes.rigs) rig.advance(now);
    this.onTurn();
    this.simplifyWhenSlow(now);
    if (!this.dirty || this.takesPictures) return;
    this.draw();
    this.times.push(now);
    if (this.times.length > 600) this.times.splice(0, 300);
  }

  /** Switches occlusion off after many slow pictures in a row. */
  private simplifyWhenSlow(now: number): void {
    const took = now - this.lastTurn;
    const hasDrawn = this.times.at(-1) === this.lastTurn;
    this.lastTurn = now;
    if (!hasDrawn) return;  // it waited for something to draw
    this.slowTurns = took > SLOW_MILLISECONDS && took < 1000 ? this.slowTurns + 1 : 0;
    if (!this.model.occlusion || this.slowTurns < SLOW_TURNS) return;
    this.model.occlusion = false;
    this.model.emit("display", null);
  }

  /** Draws immediately, so that the canvas can be read in the same task. */
  draw(): void {
    this.dirty = false;
    this.world.arrange(this.rig.camera);
    this.surfaces.shade(this.model.smooth);
    this.drawnInfo = { calls: 0, triangles: 0, points: 0 };
    if (this.panes.shown.length > 1) this.drawLines();
    for (const pane of this.panes.shown) this.model.inView(pane.index, () => this.drawPane(pane));
    if (this.checkMemory && this.model.frame) {
      this.checkMemory = false;
      const gl = this.renderer.getContext();
      if (gl.getError() === gl.OUT_OF_MEMORY) this.onLost("The graphics card does not have enough memory for this scene.");
    }
  }

  /** Fills the canvas; the panes leave lines between them. */
  private drawLines(): void {
    const { renderer } = this;
    const ground = renderer.getClearColor(new THREE.Color());
    const alpha = renderer.getClearAlpha();
    renderer.setScissorTest(false);
    renderer.setClearColor(this.line, alpha);
    renderer.clear();
    renderer.setClearColor(ground, alpha);
  }

  private drawPane(pane: Pane): void {
    this.prepare();
    this.slice.update(this.surfaces.geometry);
    this.panes.begin(pane, this.renderer);
    this.layers.arrange(pane.projection);
    this.highlights.arrange(pane.projection);
    this.drawScene(pane.rig.camera);
    if (this.world.group.visible) this.world.drawTriad(this.renderer, pane.rig.camera);
  }

  /** With occlusion, marks come in a second pass, so that it does not darken them. */
  private drawScene(camera: CameraRig["camera"]): void {
    const { renderer, scene } = this;
    const marks = [this.layers.group, this.highlights.group];
    const others = scene.children.filter((child) => !marks.includes(child as THREE.Group));
    const occludes = this.model.occlusion && this.model.layers.surface && this.world.group.visible;
    if (occludes) for (const group of marks) group.visible = false;
    renderer.render(scene, camera);
    const { calls, triangles, points } = renderer.info.render;
    this.drawnInfo.calls += calls;
    this.drawnInfo.triangles += triangles;
    this.drawnInfo.points += points;
    if (!occludes) return;
    const [lower, upper] = this.model.scene?.bounds ?? [[0, 0, 0], [1, 1, 1]];
    this.occlusion.draw(renderer, this.surfaces.solids, camera, Math.hypot(...upper.map((x, axis) => x - lower[axis]!)));
    const were = others.map(({ visible }) => visible);
    for (const group of others) group.visible = false;
    for (const group of marks) group.visible = true;
    renderer.autoClear = false;
    renderer.render(scene, camera);
    renderer.autoClear = true;
    others.forEach((group, i) => (group.visible = were[i]!));
    this.drawnInfo.points += renderer.info.render.points;
  }

  /** From positions to clip space. */
  matrix(): number[] {
    const { camera } = this.rig;
    camera.updateMatrixWorld();
    return new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).toArray();
  }

  statistics(): { calls: number; triangles: number; points: number } {
    return this.drawnInfo;
  }
}
