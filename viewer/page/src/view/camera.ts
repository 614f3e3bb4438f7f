import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const FIELD_OF_VIEW = 40;
const FLIGHT_MILLISECONDS = 350;
const FRAME_MARGIN = 1.1;

/** The directions of the axis views. */
export const AXIS_VIEWS = {
  front: [0, 0, 1], back: [0, 0, -1], right: [1, 0, 0], left: [-1, 0, 0], top: [0, 1, 0], bottom: [0, -1, 0],
} as const;
export type AxisView = keyof typeof AXIS_VIEWS;

export interface CameraState {
  position: number[];
  target: number[];
  zoom: number;
  orthographic: boolean;
}

interface Flight {
  begin: number;
  from: { position: THREE.Vector3; target: THREE.Vector3; zoom: number };
  to: { position: THREE.Vector3; target: THREE.Vector3; zoom: number };
}

/**
 * A perspective or orthographic camera that orbits, pans, zooms to the cursor and flies. Its state is kept
 * in the address of the page, so that a view can be shared.
 */
export class CameraRig {
  camera: THREE.PerspectiveCamera | THREE.OrthographicCamera;
  controls: OrbitControls;
  private readonly perspective = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 100);
  private readonly orthographic = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.01, 100);
  private flight: Flight | null = null;
  private radius = 1;
  private aspect = 1;
  private saving: ReturnType<typeof setTimeout> | undefined;
  private wasSet = false;

  /** `isKept`: the address of the page keeps its state. */
  constructor(private readonly canvas: HTMLElement, private readonly changed: () => void, private readonly isKept = true) {
    this.camera = this.perspective;
    this.camera.position.set(1.2, 0.8, 2);
    this.controls = this.makeControls();
  }

  private makeControls(): OrbitControls {
    const controls = new OrbitControls(this.camera, this.canvas);
    controls.zoomToCursor = true;
    controls.enableDamping = false;
    controls.addEventListener("change", () => this.moved());
    controls.addEventListener("start", () => (this.flight = null));
    return controls;
  }

  /** Turns from the y axis to the upward axis. */
  readonly turn = new THREE.Quaternion();

  /** Changes the upward axis. The camera keeps its place relative to it. */
  setUp(turn: THREE.Quaternion): void {
    if (turn.equals(this.turn)) return;
    const change = turn.clone().multiply(this.turn.clone().invert());
    const target = this.controls.target.clone();
    this.turn.copy(turn);
    for (const camera of [this.perspective, this.orthographic]) camera.up.set(0, 1, 0).applyQuaternion(turn);
    this.camera.position.sub(target).applyQuaternion(change).add(target);
    this.controls.dispose();  // controls keep the upward axis that they were made with
    this.controls = this.makeControls();
    this.controls.target.copy(target);
    this.controls.update();
    this.moved();
  }

  /** Takes place, upward axis and extent of another camera. */
  follow(other: CameraRig): void {
    this.setUp(other.turn);
    this.radius = other.radius;
    this.state = other.state;
  }

  get isOrthographic(): boolean {
    return this.camera === this.orthographic;
  }

  resize(width: number, height: number): void {
    this.aspect = width / Math.max(height, 1);
    this.fit();
    this.changed();
  }

  /** Sets the extent of the scene, for the clipping planes. */
  setExtent(radius: number): void {
    this.radius = Math.max(radius, 1e-30);
    this.fit();
  }

  private get distance(): number {
    return this.camera.position.distanceTo(this.controls.target);
  }

  /** Half the visible height of an orthographic view at zoom 1. */
  private get halfHeight(): number {
    return this.distance * Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
  }

  /** The height of what the camera sees, at its target. */
  get visibleHeight(): number {
    return (2 * this.halfHeight) / this.camera.zoom;
  }

  private fit(): void {
    const reach = this.distance + this.camera.position.length() + 8 * this.radius;
    this.perspective.aspect = this.aspect;
    this.perspective.near = Math.max(0.01 * this.distance, 1e-5 * reach);
    this.perspective.far = reach;
    const half = this.halfHeight;
    Object.assign(this.orthographic, {
      top: half, bottom: -half, left: -half * this.aspect, right: half * this.aspect, near: -reach, far: reach,
    });
    this.camera.updateProjectionMatrix();
  }

  private moved(): void {
    this.fit();
    this.changed();
    if (!this.isKept) return;
    clearTimeout(this.saving);
    this.saving = setTimeout(() => this.save(), 250);
  }

  setOrthographic(on: boolean): void {
    if (on === this.isOrthographic) return;
    const next = on ? this.orthographic : this.perspective;
    next.position.copy(this.camera.position);
    next.up.copy(this.camera.up);
    if (on) {
      this.orthographic.zoom = 1;
    } else {
      // A perspective camera has no zoom; move closer by the same factor instead.
      next.position.sub(this.controls.target).divideScalar(this.orthographic.zoom).add(this.controls.target);
    }
    this.camera = next;
    this.controls.object = next;
    this.controls.update();
    this.moved();
  }

  /** Moves the camera so that all finite points are visible, from the current or the given direction. */
  frame(center: THREE.Vector3, points: Iterable<ArrayLike<number>>, direction?: THREE.Vector3, fly = true): void {
    const back = direction?.clone() ?? this.camera.position.clone().sub(this.controls.target);
    if (back.lengthSq() === 0) back.set(0, 0, 1);
    back.normalize();
    const right = new THREE.Vector3().crossVectors(this.camera.up, back).normalize();
    const up = new THREE.Vector3().crossVectors(back, right);
    const slope = Math.tan((FIELD_OF_VIEW * Math.PI) / 360) / FRAME_MARGIN;
    let distance = 1e-9;
    for (const list of points)
      for (let i = 0; i < list.length; i += 3) {
        const x = list[i]! - center.x, y = list[i + 1]! - center.y, z = list[i + 2]! - center.z;
        const aside = Math.max(
          Math.abs(x * right.x + y * right.y + z * right.z) / this.aspect, Math.abs(x * up.x + y * up.y + z * up.z),
        );
        const needed = x * back.x + y * back.y + z * back.z + aside / slope;
        if (needed > distance) distance = needed;
      }
    this.go(center.clone().add(back.multiplyScalar(distance)), center, fly);
  }

  lookAlong(view: AxisView, fly = true): void {
    const direction = new THREE.Vector3(...AXIS_VIEWS[view]);
    if (view === "top" || view === "bottom") direction.z += 1e-4;  // exactly vertical has no up direction
    direction.applyQuaternion(this.turn);
    const to = this.controls.target.clone().add(direction.normalize().multiplyScalar(this.distance));
    this.go(to, this.controls.target.clone(), fly, this.camera.zoom);
  }

  looksAlong(view: AxisView): boolean {
    const direction = new THREE.Vector3(...AXIS_VIEWS[view]).applyQuaternion(this.turn);
    return this.camera.position.clone().sub(this.controls.target).normalize().distanceTo(direction) < 1e-3;
  }

  /** Turns around a point from now on, which moves to the middle of the view. */
  pivot(point: THREE.Vector3): void {
    const { position, zoom } = this.camera;
    this.go(position.clone().add(point).sub(this.controls.target), point, true, zoom);
  }

  private go(position: THREE.Vector3, target: THREE.Vector3, fly: boolean, zoom = 1): void {
    const from = { position: this.camera.position.clone(), target: this.controls.target.clone(), zoom: this.camera.zoom };
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.flight = { begin: fly && !still ? performance.now() : -Infinity, from, to: { position, target, zoom } };
    this.changed();
    if (!fly || still) this.advance(performance.now());
  }

  /** Continues an animated flight; true while it lasts. */
  advance(now: number): boolean {
    if (!this.flight) return false;
    const { begin, from, to } = this.flight;
    const t = Math.max(0, Math.min(1, (now - begin) / FLIGHT_MILLISECONDS));  // the frame may have begun before the key press
    const part = t * t * (3 - 2 * t);
    this.controls.target.lerpVectors(from.target, to.target, part);
    this.camera.position.lerpVectors(from.position, to.position, part);
    this.camera.zoom = from.zoom + (to.zoom - from.zoom) * part;
    if (t >= 1) this.flight = null;
    this.controls.update();
    this.moved();
    return this.flight !== null;
  }

  /** Keyboard: orbits by angles, moves by fractions of the view, or zooms. */
  orbit(right: number, up: number): void {
    const back = this.turn.clone().invert();
    const offset = new THREE.Spherical().setFromVector3(this.camera.position.clone().sub(this.controls.target).applyQuaternion(back));
    offset.theta -= right;
    offset.phi = Math.min(Math.PI - 1e-3, Math.max(1e-3, offset.phi - up));
    this.camera.position.setFromSpherical(offset).applyQuaternion(this.turn).add(this.controls.target);
    this.controls.update();
    this.moved();
  }

  pan(right: number, up: number): void {
    const scale = (2 * this.halfHeight) / this.camera.zoom;
    const shift = new THREE.Vector3(right * scale, up * scale, 0).applyQuaternion(this.camera.quaternion);
    this.camera.position.add(shift);
    this.controls.target.add(shift);
    this.controls.update();
    this.moved();
  }

  zoom(factor: number): void {
    if (this.isOrthographic) this.camera.zoom *= factor;
    else this.camera.position.sub(this.controls.target).divideScalar(factor).add(this.controls.target);
    this.controls.update();
    this.moved();
  }

  /** The camera of a picture, for drawing it again; positions in the camera's coordinates. */
  description(): Record<string, unknown> {
    const { position, up } = this.camera;
    const target = this.controls.target.toArray();
    const kind = this.isOrthographic ? { orthographic: true, height: this.visibleHeight } : { orthographic: false, vertical_degrees: FIELD_OF_VIEW };
    return { position: position.toArray(), target, up: up.toArray(), ...kind };
  }

  get state(): CameraState {
    const { position, zoom } = this.camera;
    return { position: position.toArray(), target: this.controls.target.toArray(), zoom, orthographic: this.isOrthographic };
  }

  set state({ position, target, zoom, orthographic }: CameraState) {
    this.wasSet = true;
    this.setOrthographic(orthographic);
    this.flight = null;
    this.camera.position.fromArray(position);
    this.controls.target.fromArray(target);
    this.camera.zoom = zoom;
    this.controls.update();
    this.moved();
  }

  /** Writes the view to the address. */
  save(): void {
    const short = (x: number) => String(Number(x.toPrecision(6)));
    const { position, target, zoom, orthographic } = this.state;
    const hash = `#camera=${[...position, ...target, zoom].map(short).join(",")}${orthographic ? ",orthographic" : ""}`;
    try {
      history.replaceState(null, "", location.pathname + location.search + hash);
    } catch {
      // Some browsers do not let a file change its address; the view is then not stored.
    }
  }

  /** Restores the view from the address, unless one was set; false when there is none. */
  restore(): boolean {
    if (this.wasSet) return true;
    const match = /[#&]camera=([^&]*)/.exec(location.hash);
    if (!match) return false;
    const parts = decodeURIComponent(match[1]!).split(",");
    const numbers = parts.slice(0, 7).map(Number);
    const zoom = numbers[6] ?? 0;
    if (numbers.length < 7 || !numbers.every(Number.isFinite) || !(zoom > 0)) return false;
    this.state = { position: numbers.slice(0, 3), target: numbers.slice(3, 6), zoom, orthographic: parts[7] === "orthographic" };
    return true;
  }
}
