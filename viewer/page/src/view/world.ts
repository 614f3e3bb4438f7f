/** What surrounds the objects: a grid with a scale, a soft shadow, the border as a glass box, and the axes. */
import * as THREE from "three";
import { OKABE_ITO } from "../colours";
import { readable } from "../panels/dom";
import { Labels, type Label } from "./labels";
import { shared } from "./primitives";
import { Shadow } from "./shadow";

type Corner = readonly number[];
export type Up = "y" | "z";

/** Relative to the size of the scene: how far the floor is below objects that nothing bounds. */
const BELOW = 0.04;
/** The size of the axes in CSS pixels. */
const TRIAD = 84;
const AXES = ["#d1495b", "#3f8f3f", "#3a6fd8"];

/** A round step for a scale: 1, 2 or 5 times a power of ten, near a fifth of the length. */
export function niceStep(length: number): number {
  const raw = length / 5;
  const power = 10 ** Math.floor(Math.log10(raw));
  return power * ([1, 2, 5].find((factor) => factor * power >= raw) ?? 10);
}

/** The multiples of a step from the first to the second number. */
export function ticks(from: number, to: number, step: number): number[] {
  const first = Math.ceil(from / step - 1e-9);
  return Array.from({ length: Math.max(0, Math.floor(to / step + 1e-9) - first + 1) }, (_, i) => (first + i) * step);
}

const GRID_SHADER = `
  uniform float step, reach; uniform vec2 offset; uniform vec3 ink; uniform float strength; in vec2 place; out vec4 result;
  float lines(float every) {
    vec2 at = (place + offset) / every;
    vec2 away = abs(fract(at - 0.5) - 0.5) / max(fwidth(at), 1e-6);
    return 1.0 - min(min(away.x, away.y), 1.0);
  }
  void main() {
    float part = max(lines(step), 0.4 * lines(0.2 * step)) * (1.0 - smoothstep(0.35, 1.0, length(place) / reach));
    if (part < 0.01) discard;
    result = linearToOutputTexel(vec4(ink, part * strength * (gl_FrontFacing ? 1.0 : 0.4)));
  }`;

// Only the far walls are drawn: one looks through the near ones.
const GLASS_SHADER = `
  uniform vec3 ink, glass; in vec2 at; out vec4 result;
  void main() {
    vec2 away = min(at, 1.0 - at) / max(fwidth(at), 1e-6);
    float edge = 1.0 - smoothstep(0.5, 1.5, min(away.x, away.y));
    result = linearToOutputTexel(vec4(mix(glass, ink, edge), 0.06 + 0.34 * edge));
  }`;

function glassMaterial(fragmentShader: string, vertexShader: string, uniforms: Record<string, THREE.IUniform>, side: THREE.Side): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({ glslVersion: THREE.GLSL3, vertexShader, fragmentShader, uniforms, transparent: true, depthWrite: false, side });
}

export class World {
  readonly group = new THREE.Group();
  readonly shadow = new Shadow();
  /** Turns the y axis to the upward axis. */
  readonly turn = new THREE.Quaternion();
  private readonly ink = { value: new THREE.Color() };
  private readonly strength = { value: 0.2 };
  private readonly gridUniforms = { step: { value: 1 }, reach: { value: 1 }, offset: { value: new THREE.Vector2() }, ink: this.ink, strength: this.strength };
  private readonly floor = new THREE.Group();
  private readonly grid: THREE.Mesh;
  private readonly box: THREE.Mesh;
  private readonly labels = new Labels();
  private readonly triad = new THREE.Scene();
  private readonly triadLabels = new Labels(false);
  private readonly triadCamera = new THREE.OrthographicCamera(-1.5, 1.5, 1.5, -1.5, 0, 10);
  private scene: { lower: THREE.Vector3; upper: THREE.Vector3; center: Corner; unit: string } | null = null;
  up: Up = "y";
  private level = 0;
  private side = "";

  constructor() {
    this.grid = new THREE.Mesh(
      new THREE.PlaneGeometry(2, 2).rotateX(-Math.PI / 2),
      glassMaterial(GRID_SHADER, "uniform float reach; out vec2 place; void main() { place = reach * position.xz; gl_Position = projectionMatrix * modelViewMatrix * vec4(reach * position, 1.0); }", this.gridUniforms, THREE.DoubleSide),
    );
    this.box = new THREE.Mesh(
      new THREE.BoxGeometry(1, 1, 1),
      glassMaterial(GLASS_SHADER, "out vec2 at; void main() { at = uv; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }", { ink: this.ink, glass: { value: new THREE.Color(OKABE_ITO.sky) } }, THREE.BackSide),
    );
    this.grid.renderOrder = -3;
    this.box.renderOrder = -2;
    this.labels.shape.renderOrder = 0;
    this.grid.frustumCulled = false;
    this.floor.add(this.grid, this.shadow.group);
    this.group.add(this.floor, this.box, this.labels.shape);
    this.makeTriad();
  }

  private makeTriad(): void {
    const bars = new THREE.InstancedMesh(new THREE.CylinderGeometry(0.045, 0.045, 1, 8).translate(0, 0.5, 0), new THREE.MeshBasicMaterial(), 3);
    const turns = [new THREE.Euler(0, 0, -Math.PI / 2), new THREE.Euler(0, 0, 0), new THREE.Euler(Math.PI / 2, 0, 0)];
    turns.forEach((turn, axis) => {
      bars.setMatrixAt(axis, new THREE.Matrix4().makeRotationFromEuler(turn));
      bars.setColorAt(axis, new THREE.Color(AXES[axis]));
    });
    bars.frustumCulled = false;
    this.triadLabels.show(["x", "y", "z"].map((text, axis) => ({ text, at: [0, 1, 2].map((i) => (i === axis ? 1.25 : 0)) })));
    this.triad.add(bars, this.triadLabels.shape);
  }

  setColours(ink: string, isDark: boolean): void {
    this.ink.value.set(ink);
    this.strength.value = isDark ? 0.16 : 0.17;
    this.shadow.strength = isDark ? 0.75 : 0.42;
    this.labels.colour = this.triadLabels.colour = ink;
  }

  /** Takes the bounds of all objects at the start and the border, all relative to `center`. */
  build(objects: readonly [Corner, Corner], border: readonly [Corner, Corner] | null, center: Corner, unit: string, up: Up): void {
    const vector = (corner: Corner) => new THREE.Vector3(...(corner as [number, number, number]));
    const [lower, upper] = (border ?? objects).map(vector) as [THREE.Vector3, THREE.Vector3];
    this.up = up;
    this.turn.setFromUnitVectors(new THREE.Vector3(0, 1, 0), up === "y" ? new THREE.Vector3(0, 1, 0) : new THREE.Vector3(0, 0, 1));
    this.box.visible = border !== null;
    this.box.position.copy(lower).add(upper).multiplyScalar(0.5);
    this.box.scale.copy(upper).sub(lower);
    this.scene = { lower, upper, center, unit };
    this.level = lower[up] - (border ? 0 : BELOW * lower.distanceTo(upper));
    this.side = "";
    this.placeFloor();
  }

  /** Lowers the floor when objects have fallen below it. */
  follow(lowest: number): void {
    if (!this.scene || !(lowest < this.level)) return;
    this.level = lowest - 0.5 * BELOW * this.scene.lower.distanceTo(this.scene.upper);
    this.side = "";
    this.placeFloor();
  }

  /** The two axes of the floor. */
  private get axes(): ["x", "z"] | ["x", "y"] {
    return this.up === "y" ? ["x", "z"] : ["x", "y"];
  }

  private placeFloor(): void {
    const { lower, upper, center } = this.scene!;
    const [u, v] = this.axes;
    const width = Math.max(upper[u] - lower[u], upper[v] - lower[v], 1e-6 * lower.distanceTo(upper)) || 1;
    const middle = lower.clone().add(upper).multiplyScalar(0.5);
    middle[this.up] = this.level;
    this.floor.position.copy(middle);
    this.floor.quaternion.copy(this.turn);
    const step = niceStep(width);
    this.gridUniforms.step.value = step;
    this.gridUniforms.reach.value = 2 * width;
    // The turn to z maps the plane's z axis to −y.
    const sign = this.up === "y" ? 1 : -1;
    const at = (axis: number, x: number) => (((center[axis]! + x) % step) + step) % step;
    this.gridUniforms.offset.value.set(at(0, middle.x), sign * at(this.up === "y" ? 2 : 1, middle[v]));
    this.shadow.place(1.6 * width, 0.5 * Math.max(width, upper[this.up] - this.level));
  }

  /** Writes the scale along the two edges of the floor that are next to the camera. */
  private placeLabels(camera: THREE.Vector3): void {
    const { lower, upper, center, unit } = this.scene!;
    const [u, v] = this.axes;
    const isUpper = (axis: "x" | "y" | "z") => camera[axis] > (lower[axis] + upper[axis]) / 2;
    const side = `${isUpper(u)} ${isUpper(v)}`;
    if (side === this.side) return;
    this.side = side;
    const step = this.gridUniforms.step.value;
    const apart = 0.18 * step;
    const along = (axis: "x" | "y" | "z", across: "x" | "y" | "z", room: number): Label[] => {
      const from = center["xyz".indexOf(axis)]!;
      const corner = from + (isUpper(axis) ? upper : lower)[axis];
      const values = ticks(from + lower[axis], from + upper[axis], step).filter((value) => Math.abs(value - corner) >= room);
      return values.map((value) => {
        const at = new THREE.Vector3();
        at[this.up] = this.level;
        at[axis] = value - from;
        at[across] = isUpper(across) ? upper[across] + apart : lower[across] - apart;
        const text = readable(Number(value.toPrecision(6)));
        return { text: unit !== "" ? `${text} ${unit}` : text, at: at.toArray() };
      });
    };
    this.labels.show([...along(u, v, 0), ...along(v, u, 0.4 * step)]);  // one label at the common corner
  }

  /** Call before each drawing. */
  arrange(camera: THREE.Camera): void {
    if (this.scene) this.placeLabels(camera.position);
  }

  /** Draws the axes in the corner, over the picture. */
  drawTriad(renderer: THREE.WebGLRenderer, camera: THREE.Camera): void {
    const side = Math.round(TRIAD * shared.pixelRatio.value);
    this.triadCamera.quaternion.copy(camera.quaternion);
    this.triadCamera.position.set(0, 0, 5).applyQuaternion(camera.quaternion);
    const { autoClear } = renderer;
    const whole = renderer.getViewport(new THREE.Vector4());
    renderer.autoClear = false;
    renderer.clearDepth();
    renderer.setViewport(whole.x, whole.y, side, side);
    renderer.render(this.triad, this.triadCamera);
    renderer.setViewport(whole);
    renderer.autoClear = autoClear;
  }
}
