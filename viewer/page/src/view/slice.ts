/** Cuts surfaces open with a plane and closes the cut with caps, red where two objects overlap. */
import * as THREE from "three";
import { MARKS } from "../colours";
import type { Model, ObjectState } from "../model";
import { shared } from "./primitives";

/** No point is on the removed side of this plane. */
const NOTHING = new THREE.Vector4(0, 0, 0, 1);

/**
 * Whether each edge of an object has as many triangles on one side as on the other. Adds a random number for each
 * edge and subtracts it for its reverse, so the answer is wrong in one of 2^64 cases.
 */
export function isClosed(corners: Uint32Array): boolean {
  let [one, other] = [0, 0];
  for (let i = 0; i < corners.length; i += 3)
    for (let side = 0; side < 3; ++side) {
      const from = corners[i + side]!, to = corners[i + ((side + 1) % 3)]!;
      const [low, high] = from < to ? [from, to] : [to, from];
      const sign = from < to ? 1 : -1;
      one = (one + sign * mix(low, high, 0x9e3779b1)) | 0;
      other = (other + sign * mix(low, high, 0x85ebca77)) | 0;
    }
  return corners.length > 0 && one === 0 && other === 0;
}

function mix(low: number, high: number, seed: number): number {
  let x = Math.imul(low ^ seed, 0xcc9e2d51) ^ Math.imul(high + seed, 0x1b873593);
  x = Math.imul(x ^ (x >>> 15), 0x2c1b3c6d);
  x = Math.imul(x ^ (x >>> 12), 0x297a2d39);
  return x ^ (x >>> 15);
}

const CAP_SHADER = `
  uniform vec3 colour; out vec4 result;
  void main() {
    float stripe = step(0.75, fract((gl_FragCoord.x + gl_FragCoord.y) / 9.0));
    result = linearToOutputTexel(vec4(colour * (1.0 - 0.3 * stripe), 1.0));
  }`;

export class Slice {
  readonly group = new THREE.Group();
  private readonly plane = shared.slice.value;
  private readonly counters: THREE.Mesh[] = [];
  private readonly caps: THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial>[] = [];
  private readonly quad = new THREE.Group();
  private isIndexed = false;

  /** `vertexShader` places the vertices of surfaces, `uniforms` are those of the surfaces. */
  constructor(private readonly model: Model, material: () => THREE.ShaderMaterial) {
    // Beyond the cut, each ray leaves a solid once more often than it enters it where the cut is inside.
    for (const [side, operation] of [[THREE.BackSide, THREE.IncrementWrapStencilOp], [THREE.FrontSide, THREE.DecrementWrapStencilOp]] as const) {
      const counting = material();
      Object.assign(counting, {
        side, colorWrite: false, depthWrite: false, depthTest: false, stencilWrite: true, stencilFunc: THREE.AlwaysStencilFunc,
        stencilFail: operation, stencilZFail: operation, stencilZPass: operation,
      });
      this.counters.push(new THREE.Mesh(new THREE.BufferGeometry(), counting));
    }
    for (const [colour, least] of [["#8d96a3", 1], [MARKS.contact, 2]] as const) {
      const cap = new THREE.ShaderMaterial({
        glslVersion: THREE.GLSL3, uniforms: { colour: { value: new THREE.Color(colour) } }, fragmentShader: CAP_SHADER, side: THREE.DoubleSide,
        vertexShader: "void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
        stencilWrite: true, stencilRef: least, stencilFunc: THREE.LessEqualStencilFunc, depthFunc: THREE.LessEqualDepth,
      });
      this.caps.push(new THREE.Mesh(new THREE.PlaneGeometry(1, 1), cap));
    }
    this.quad.add(...this.caps);
    [...this.counters, ...this.caps].forEach((shape, i) => {
      shape.frustumCulled = false;
      shape.renderOrder = 0.1 * (i + 1);
    });
    this.group.add(...this.counters, this.quad);
    this.group.visible = false;
  }

  /** Takes the vertices of the surfaces of a new scene. */
  build(): void {
    for (const counter of this.counters) counter.geometry = new THREE.BufferGeometry();
    this.isIndexed = false;
  }

  /** Where the view of the model cuts along its axis, or null. */
  private get cut(): { axis: number; at: number; flipped: boolean } | null {
    const { slice, scene } = this.model;
    if (slice.axis === "off" || !scene) return null;
    const axis = "xyz".indexOf(slice.axis);
    const [lower, upper] = scene.bounds;
    return { axis, at: lower[axis]! + slice.at * (upper[axis]! - lower[axis]!), flipped: slice.flipped };
  }

  /** For the view of the model, which is drawn next. */
  update(surface: THREE.BufferGeometry): void {
    const { cut } = this;
    this.group.visible = cut !== null;
    if (!cut) {
      this.plane.copy(NOTHING);
      return;
    }
    const { axis, at, flipped } = cut;
    const [lower, upper] = this.model.scene!.bounds;
    const normal = new THREE.Vector3().setComponent(axis, flipped ? -1 : 1);
    // A point p is removed when the dot product of the first three numbers with p is above the last.
    this.plane.set(normal.x, normal.y, normal.z, flipped ? -at : at);
    this.quad.position.set(0, 0, 0).setComponent(axis, at);
    this.quad.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), normal);
    this.quad.scale.setScalar(4 * Math.hypot(...upper.map((x, i) => x - lower[i]!)));
    if (!this.isIndexed) this.index(surface);
  }

  /** Only closed surfaces have an inside. */
  private index(surface: THREE.BufferGeometry): void {
    this.isIndexed = true;
    const closed = this.model.objects.filter(({ corners }) => isClosed(corners));
    const index = new Uint32Array(closed.reduce((sum, { corners }) => sum + corners.length, 0));
    let at = 0;
    for (const { corners, positions } of closed as ObjectState[]) {
      const first = positions.byteOffset / (3 * positions.BYTES_PER_ELEMENT);
      for (let i = 0; i < corners.length; ++i) index[at++] = first + corners[i]!;
    }
    const geometry = new THREE.BufferGeometry().setIndex(new THREE.BufferAttribute(index, 1));
    for (const [name, attribute] of Object.entries(surface.attributes)) geometry.setAttribute(name, attribute);
    geometry.boundingSphere = new THREE.Sphere();
    for (const counter of this.counters) counter.geometry = geometry;
  }

  /** Whether a point is on the side that the view of the model keeps. */
  get keeps(): (x: number, y: number, z: number) => boolean {
    const { cut } = this;
    if (!cut) return () => true;
    const { axis, at, flipped } = cut;
    return (...point) => (flipped ? point[axis]! >= at : point[axis]! <= at);
  }
}
