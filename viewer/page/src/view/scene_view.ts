/** Draws surfaces, layers and the selection, only when something has changed. */
import * as THREE from "three";
import { MARKS, OKABE_ITO } from "../colours";
import { contactCount, findContact, pointsAt } from "../contacts";
import { boundsOfAll, type Model, type ObjectState } from "../model";
import { CameraRig } from "./camera";
import { Layers } from "./layers";
import { pick, type Hit } from "./picking";
import { Dots, Lines, type Projection } from "./marks";
import { Faces, shared } from "./primitives";
import { obstacleOf, Surfaces } from "./surfaces";

/** From the scene to the first camera: from above, so that one looks into open boxes. */
const FIRST_DIRECTION = new THREE.Vector3(0.55, 0.7, 1);

/** In pixels. */
export interface PictureSize {
  width: number;
  height: number;
}

export class SceneView {
  readonly rig: CameraRig;
  readonly layers: Layers;
  /** Called before each drawing; allows the session to send the next frame. */
  onTurn: () => void = () => {};
  /** Called when the WebGL context is lost. */
  onLost: (why: string) => void = () => {};
  readonly times: number[] = [];
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly surfaces = new Surfaces();
  private readonly selected = new Faces({ colour: OKABE_ITO.yellow, opacity: 0.9, order: 3 });
  private readonly vertex = new Dots({ colour: MARKS.selection, size: 11, onTop: true, order: 8 });
  private readonly contactDot = new Dots({ colour: MARKS.contact, size: 14, onTop: true, order: 9 });
  private readonly outlines = [OKABE_ITO.orange, OKABE_ITO.sky].map((colour) => new Lines({ colour, size: 2.5, onTop: true, order: 7 }));
  private readonly picked = [OKABE_ITO.orange, OKABE_ITO.sky].map((colour) => new Faces({ colour, opacity: 0.95, order: 4 }));
  private readonly distance = new Lines({ colour: MARKS.selection, size: 2, onTop: true, order: 8 });
  private readonly ruler = new Lines({ colour: MARKS.selection, size: 2.5, onTop: true, order: 8 });
  private readonly pull = new Lines({ colour: MARKS.contact, size: 2.5, onTop: true, order: 8 });
  private readonly extras = [this.vertex, this.contactDot, ...this.outlines, this.distance, this.ruler, this.pull];
  private readonly projection: Projection = { matrix: new THREE.Matrix4(), version: 0 };
  private readonly size = new THREE.Vector2();
  private dirty = true;
  private filled = false;
  private checkMemory = false;
  private hasFramed = false;
  /** True while only `draw` draws, at a fixed size. */
  private takesPictures = false;

  constructor(readonly canvas: HTMLCanvasElement, private readonly model: Model) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, powerPreference: "high-performance" });
    this.renderer.setClearAlpha(1);
    this.rig = new CameraRig(canvas, () => this.invalidate());
    this.layers = new Layers(model);
    this.scene.add(this.surfaces.group, this.layers.group);
    for (const extra of [this.selected, ...this.picked, ...this.extras])
      this.scene.add(extra.shape);
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      this.onLost("The graphics card stopped drawing. The scene may be too large for it.");
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

  /** A sentence about why this machine cannot display the scene, or null. */
  obstacle(objects: { name: string; vertices: number; triangles: number }[]): string | null {
    return obstacleOf(this.renderer.getContext() as WebGL2RenderingContext, objects);
  }

  setBackground(colour: string): void {
    this.renderer.setClearColor(new THREE.Color(colour), this.renderer.getClearAlpha());
    this.invalidate();
  }

  invalidate(): void {
    this.dirty = true;
  }

  /** Whether everything that changed has been drawn. */
  get isUpToDate(): boolean {
    return !this.dirty;
  }

  /** Marks the positions of these objects as changed. */
  touch(objects: Iterable<number> = this.model.objects.keys()): void {
    this.surfaces.touch(objects);
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
   * From now on only `draw` draws, at the given size, independent of the window, and without the ground when
   * `transparent`. Null returns to the window. Throws with a sentence when WebGL cannot draw that size.
   */
  setPicture(size: PictureSize | null, transparent = false): void {
    this.takesPictures = false;
    this.renderer.setClearAlpha(size && transparent ? 0 : 1);
    if (!size) return this.resize();
    const { width, height } = size;
    const most = this.largestSide;
    if (Math.max(width, height) > most) throw new Error(`WebGL draws no picture of ${width} × ${height} here: ${most} pixels a side are the most. Choose a smaller size.`);
    this.rig.advance(Infinity);  // end the flight
    this.setSize(size, height / (this.canvas.clientHeight || height));
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
    shared.resolution.value.set(width / ratio, height / ratio);
    shared.pixelRatio.value = ratio;
    this.rig.resize(width, height);
  }

  private build(): void {
    this.surfaces.build(this.model.objects, this.model.positions);
    const bounds = this.model.scene!.bounds;
    this.rig.setExtent(Math.hypot(...bounds[0], ...bounds[1]));
    shared.lift.value = 0.01 * Math.hypot(...bounds[1].map((x, axis) => x - bounds[0][axis]!));
    this.checkMemory = true;
    this.pull.fill(0, () => 0);
    this.select();
    this.paint();
  }

  /** Applies the appearance of the objects. */
  private paint(): void {
    this.surfaces.paint(this.model.layers);
    this.refill();
  }

  private select(): void {
    this.surfaces.select(this.model.selection?.object ?? null);
    this.refill();
  }

  private fill(): void {
    this.filled = true;
    this.layers.update();
    this.fillSelection();
    this.fillExplanation();
  }

  private writeCorners(into: Float32Array, object: number, triangle: number): number {
    const { corners, positions } = this.model.objects[object]!;
    for (let corner = 0; corner < 3; ++corner)
      for (let axis = 0; axis < 3; ++axis)
        into[3 * corner + axis] = positions[3 * corners[3 * triangle + corner]! + axis]!;
    return 1;
  }

  private fillSelection(): void {
    const { selection } = this.model;
    const triangle = selection?.triangle ?? null;
    this.selected.fill(triangle === null ? 0 : 1, (into) => this.writeCorners(into, selection!.object, triangle!));
    const vertex = selection?.vertex ?? null;
    this.vertex.fill(vertex === null ? 0 : 1, (into) => {
      into.set(this.positionOf(selection!.object, vertex!));
      return 1;
    });
    const point = this.contactPoint();
    this.contactDot.fill(point ? 1 : 0, (into) => {
      into.set(point!);
      return 1;
    });
  }

  /** The current position of the selected contact, or null when it has ended. */
  contactPoint(): number[] | null {
    const { contact, frame } = this.model;
    if (!contact || !frame) return null;
    const at = findContact(frame, contact);
    if (at < 0) return null;
    const { data, first, count } = pointsAt(frame, at);
    const mean = [0, 0, 0];
    for (let k = 0; k < count; ++k)
      for (let axis = 0; axis < 3; ++axis) mean[axis]! += data[8 * (first + k) + axis]! / count;
    return count > 0 ? mean : null;
  }

  private fillExplanation(): void {
    const { explained, explanation } = this.model;
    this.picked.forEach((faces, side) => {
      const of = explained[side];
      faces.fill(of ? 1 : 0, (into) => this.writeCorners(into, of!.object, of!.triangle));
    });
    this.outlines.forEach((lines, side) => {
      const box = explanation?.boxes?.[side];
      const ball = explanation?.spheres?.[side];
      const edges = explanation?.edges?.[side];
      if (edges) lines.fill(edges.length, (into) => writeEdges(into, edges));
      else if (box) lines.fill(12, (into) => writeBox(into, box));
      else if (ball) lines.fill(144, (into) => writeBall(into, ball));
      else lines.fill(0, () => 0);
    });
    const nearest = explanation?.nearest;
    this.ruler.fill(nearest ? 1 : 0, (into) => {
      into.set(nearest!.points.flat());
      return 1;
    });
    const axis = explanation?.axis;
    const span = axis && explanation.distance ? this.distanceSpan(axis, explanation.distance) : null;
    this.distance.fill(span ? 1 : 0, (into) => {
      into.set(span!);
      return 1;
    });
  }

  /** A line as long as the distance between two separated triangles. */
  private distanceSpan(axis: number[], distance: number): number[] | null {
    const { explained, explanation } = this.model;
    const boxes = explanation?.boxes;
    const centres = boxes
      ? boxes.map((box) => box[0]!.map((x, i) => (x + box[1]![i]!) / 2))
      : explained.map(({ object, triangle }) => this.centroid(object, triangle));
    if (centres.length < 2) return null;
    const middle = centres[0]!.map((x, i) => (x + centres[1]![i]!) / 2);
    return [-0.5, 0.5].flatMap((part) => middle.map((x, i) => x + part * distance * axis[i]!));
  }

  centroid(object: number, triangle: number): number[] {
    const corners = new Float32Array(9);
    this.writeCorners(corners, object, triangle);
    return [0, 1, 2].map((axis) => (corners[axis]! + corners[3 + axis]! + corners[6 + axis]!) / 3);
  }

  positionOf(object: number, vertex: number): [number, number, number] {
    const { positions } = this.model.objects[object]!;
    return [positions[3 * vertex]!, positions[3 * vertex + 1]!, positions[3 * vertex + 2]!];
  }

  /** Shows the pulled vertex and its target, or nothing. */
  showPull(from: ArrayLike<number> | null, to: ArrayLike<number> | null): void {
    this.pull.fill(from && to ? 1 : 0, (into) => {
      into.set(from!, 0);
      into.set(to!, 3);
      return 1;
    });
    this.invalidate();
  }

  /** Shows the whole border, so that objects that move within it stay in view. */
  private firstFrame(): void {
    this.hasFramed = true;
    if (this.rig.restore()) return;
    const [lower, upper] = this.model.scene!.bounds;
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [0, 1, 2].map((axis) => ((i >> axis) & 1 ? upper : lower)[axis]!));
    this.rig.frame(new THREE.Vector3(), corners, FIRST_DIRECTION, false);
  }

  frameAll(): void {
    this.frameObjects(this.model.objects.filter((object) => object.visible));
  }

  /** Frames the selection: a contact, a triangle or vertex, or an object; otherwise everything. */
  frameSelection(): void {
    const { selection } = this.model;
    const point = this.contactPoint();
    if (point) return this.flyTo(point);
    if (!selection) return this.frameAll();
    if (selection.triangle !== null) return this.flyTo(this.centroid(selection.object, selection.triangle));
    this.frameObjects([this.model.objects[selection.object]!]);
  }

  /** Frames a point and everything within `least` of it, but at least a small part of the scene. */
  flyTo(point: number[], least = 0): void {
    const bounds = this.model.scene!.bounds;
    const reach = Math.max(least, 0.04 * (Math.hypot(...bounds[1].map((x, axis) => x - bounds[0][axis]!)) || 1));
    const around = [-reach, reach].flatMap((step) => [0, 1, 2].map((axis) => point.map((x, i) => (i === axis ? x + step : x))));
    this.rig.frame(new THREE.Vector3().fromArray(point), around);
  }

  private frameObjects(objects: ObjectState[]): void {
    const bounds = boundsOfAll(objects);
    if (!bounds) return;
    const lower = new THREE.Vector3().fromArray(bounds.lower);
    const upper = new THREE.Vector3().fromArray(bounds.upper);
    this.rig.setExtent(Math.max(lower.length(), upper.length()));
    this.rig.frame(lower.add(upper).multiplyScalar(0.5), objects.map((object) => object.positions));
  }

  private rayAt(x: number, y: number): THREE.Ray {
    const box = this.canvas.getBoundingClientRect();
    const caster = new THREE.Raycaster();
    const at = new THREE.Vector2(((x - box.left) / box.width) * 2 - 1, 1 - ((y - box.top) / box.height) * 2);
    this.rig.camera.updateMatrixWorld();
    caster.setFromCamera(at, this.rig.camera);
    return caster.ray;
  }

  pickAt(x: number, y: number): Hit | null {
    const { origin, direction } = this.rayAt(x, y);
    return pick({ origin: origin.toArray(), direction: direction.toArray() }, this.model.objects);
  }

  /** The point below the cursor, in the plane through `through` that faces the camera. */
  pointAt(x: number, y: number, through: ArrayLike<number>): THREE.Vector3 | null {
    const normal = this.rig.camera.getWorldDirection(new THREE.Vector3());
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(normal, new THREE.Vector3(through[0], through[1], through[2]));
    return this.rayAt(x, y).intersectPlane(plane, new THREE.Vector3());
  }

  /** The position of a point in the window, in pixels. */
  project(point: ArrayLike<number>): { x: number; y: number } {
    const box = this.canvas.getBoundingClientRect();
    this.rig.camera.updateMatrixWorld();
    const at = new THREE.Vector3(point[0], point[1], point[2]).project(this.rig.camera);
    return { x: box.left + ((at.x + 1) / 2) * box.width, y: box.top + ((1 - at.y) / 2) * box.height };
  }

  /**
   * The index of the contact whose point is closest to the cursor, within `reach` pixels; −1 when there is
   * none.
   */
  contactAt(x: number, y: number, reach = 8): number {
    const { frame } = this.model;
    if (!frame || !this.model.layers.points) return -1;
    const box = this.canvas.getBoundingClientRect();
    this.rig.camera.updateMatrixWorld();
    const matrix = new THREE.Matrix4().multiplyMatrices(this.rig.camera.projectionMatrix, this.rig.camera.matrixWorldInverse);
    const at = new THREE.Vector3();
    let best = reach;
    let found = -1;
    for (let place = 0; place < contactCount(frame); ++place) {
      const { data, first, count } = pointsAt(frame, place);
      for (let from = 8 * first; from < 8 * (first + count); from += 8) {
        at.set(data[from]!, data[from + 1]!, data[from + 2]!).applyMatrix4(matrix);
        if (at.z < -1 || at.z > 1) continue;
        const away = Math.hypot(box.left + ((at.x + 1) / 2) * box.width - x, box.top + ((1 - at.y) / 2) * box.height - y);
        if (away >= best) continue;
        best = away;
        found = place;
      }
    }
    return found;
  }

  private turn(now: number): void {
    requestAnimationFrame((next) => this.turn(next));
    this.rig.advance(now);
    this.onTurn();
    if (!this.dirty || this.takesPictures) return;
    this.draw();
    this.times.push(now);
    if (this.times.length > 600) this.times.splice(0, 300);
  }

  /** Draws immediately, so that the canvas can be read in the same task. */
  draw(): void {
    this.dirty = false;
    if (!this.filled) this.fill();
    this.arrange();
    this.renderer.render(this.scene, this.rig.camera);
    if (this.checkMemory && this.model.frame) {
      this.checkMemory = false;
      const gl = this.renderer.getContext();
      if (gl.getError() === gl.OUT_OF_MEMORY) this.onLost("The graphics card does not have enough memory for this scene.");
    }
  }

  /** Chooses the marks to draw for the camera of this drawing. */
  private arrange(): void {
    const { camera } = this.rig;
    const { matrix } = this.projection;
    camera.updateMatrixWorld();
    const before = matrix.clone();
    matrix.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    if (!matrix.equals(before) || !this.size.equals(shared.resolution.value)) this.projection.version += 1;
    this.size.copy(shared.resolution.value);
    this.layers.arrange(this.projection);
    for (const marks of this.extras) marks.arrange(this.projection);
  }

  statistics(): { calls: number; triangles: number; points: number } {
    const { calls, triangles, points } = this.renderer.info.render;
    return { calls, triangles, points };
  }
}

function writeEdges(into: Float32Array, edges: number[][][]): number {
  into.set(edges.flat(2));
  return edges.length;
}

function writeBox(into: Float32Array, box: number[][]): number {
  let at = 0;
  for (let axis = 0; axis < 3; ++axis)
    for (const u of [0, 1])
      for (const v of [0, 1])
        for (const t of [0, 1]) {
          const corner = [0, 0, 0];
          corner[axis] = box[t]![axis]!;
          corner[(axis + 1) % 3] = box[u]![(axis + 1) % 3]!;
          corner[(axis + 2) % 3] = box[v]![(axis + 2) % 3]!;
          into.set(corner, at);
          at += 3;
        }
  return 12;
}

/** Writes three circles; a sphere is its centre and radius. */
function writeBall(into: Float32Array, ball: number[]): number {
  const sides = 48;
  let at = 0;
  for (let axis = 0; axis < 3; ++axis)
    for (let i = 0; i < sides; ++i)
      for (const k of [i, i + 1]) {
        const angle = (2 * Math.PI * k) / sides;
        const corner = ball.slice(0, 3);
        corner[axis]! += ball[3]! * Math.cos(angle);
        corner[(axis + 1) % 3]! += ball[3]! * Math.sin(angle);
        into.set(corner, at);
        at += 3;
      }
  return 3 * sides;
}
