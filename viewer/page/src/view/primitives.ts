/** The primitives of layers without a size in pixels: faces, boxes and spheres, each drawn in one call. */
import * as THREE from "three";
import { LEVELS } from "../colours";
import { Stream } from "./stream";

interface Style {
  colour: string;
  opacity?: number;
  depthTest?: boolean;
  order?: number;
}

/** Uniforms shared by all primitives and marks; the view updates them. */
export const shared = { resolution: { value: new THREE.Vector2(1, 1) }, pixelRatio: { value: 1 }, lift: { value: 0 }, slice: { value: new THREE.Vector4(0, 0, 0, 1) } };

function materialOf(style: Style, vertexShader: string, fragmentShader: string): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3,
    uniforms: {
      slice: shared.slice,
      colour: { value: new THREE.Color(style.colour) },
      opacity: { value: style.opacity ?? 1 },
    },
    vertexShader,
    fragmentShader: `precision highp float; uniform vec3 colour; uniform float opacity; out vec4 result;\n${fragmentShader}`,
    transparent: true,
    depthTest: style.depthTest ?? true,
    depthWrite: false,
    side: THREE.DoubleSide,
  });
}

abstract class Primitive<Shape extends THREE.Object3D & { material: THREE.ShaderMaterial }> {
  abstract readonly shape: Shape;
  count = 0;

  protected prepare(style: Style): void {
    this.shape.frustumCulled = false;
    this.shape.renderOrder = style.order ?? 1;
    this.shape.visible = false;
  }

  set depthTest(on: boolean) {
    this.shape.material.depthTest = on;
  }

  protected show(count: number): void {
    this.count = count;
    this.shape.visible = count > 0;
  }
}

/** Triangles drawn over surfaces. An element is a corner: x, y, z. */
export class Faces extends Primitive<THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial>> {
  readonly shape;
  private readonly stream: Stream;

  constructor(style: Style) {
    super();
    const geometry = new THREE.BufferGeometry();
    this.stream = new Stream(geometry, 3, { position: [3, 0] }, false);
    const material = materialOf(
      style,
      `out vec3 seen; out vec3 place;
       void main() {
         vec4 at = modelViewMatrix * vec4(position, 1.0);
         seen = at.xyz;
         place = position;
         gl_Position = projectionMatrix * at;
       }`,
      `uniform vec4 slice; in vec3 seen; in vec3 place;
       void main() {
         if (dot(slice.xyz, place) > slice.w) discard;
         vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
         result = linearToOutputTexel(vec4(colour * (0.55 + 0.45 * abs(normal.z)), opacity));
       }`,
    );
    material.polygonOffset = true;
    material.polygonOffsetFactor = -1;
    material.polygonOffsetUnits = -1;
    this.shape = new THREE.Mesh(geometry, material);
    this.prepare(style);
  }

  /** Reserves `count` triangles; `write` returns how many it wrote. */
  fill(count: number, write: (into: Float32Array) => number): void {
    const written = count > 0 ? write(this.stream.reserve(3 * count)) : 0;
    this.stream.commit(3 * written);
    this.show(written);
  }
}

function boxEdges(): number[] {
  const edges: number[] = [];
  for (let axis = 0; axis < 3; ++axis)
    for (const u of [0, 1])
      for (const v of [0, 1])
        for (const t of [0, 1]) {
          const corner = [0, 0, 0];
          corner[axis] = t;
          corner[(axis + 1) % 3] = u;
          corner[(axis + 2) % 3] = v;
          edges.push(...corner);
        }
  return edges;
}

function ringEdges(sides = 32): number[] {
  const edges: number[] = [];
  for (let axis = 0; axis < 3; ++axis)
    for (let i = 0; i < sides; ++i)
      for (const k of [i, i + 1]) {
        const corner = [0, 0, 0];
        corner[axis] = Math.cos((2 * Math.PI * k) / sides);
        corner[(axis + 1) % 3] = Math.sin((2 * Math.PI * k) / sides);
        edges.push(...corner);
      }
  return edges;
}

const LEVEL_SHADER = `
  uniform vec3 levels[${LEVELS.length}]; uniform float opacity; flat out vec4 tint;
  void paint(float level, float contents) {
    tint = vec4(levels[int(level) % ${LEVELS.length}], contents < 0.0 ? 0.45 * opacity : opacity);
  }`;

/**
 * Octree cells in the format of the protocol, eight numbers each, coloured by level: boxes (lower corner,
 * level, upper corner, contents), spheres (centre, radius, level, contents), or single edges (one end, level,
 * the other end, contents).
 */
export class Cells extends Primitive<THREE.LineSegments<THREE.InstancedBufferGeometry, THREE.ShaderMaterial>> {
  readonly shape;
  private readonly stream: Stream;

  constructor(kind: "boxes" | "balls" | "edges", style: Style) {
    super();
    const geometry = new THREE.InstancedBufferGeometry();
    const edges = { boxes: boxEdges, balls: ringEdges, edges: () => [0, 0, 0, 1, 1, 1] }[kind]();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(edges, 3));
    this.stream = new Stream(geometry, 8, { first: [4, 0], second: [4, 4] }, true);
    const place =
      kind === "balls"
        ? "vec3 at = first.xyz + first.w * position; paint(second.x, second.y);"
        : "vec3 at = mix(first.xyz, second.xyz, position); paint(first.w, second.w);";
    const material = materialOf(
      style,
      `in vec4 first; in vec4 second; ${LEVEL_SHADER}
       void main() { ${place} gl_Position = projectionMatrix * modelViewMatrix * vec4(at, 1.0); }`,
      "flat in vec4 tint; void main() { result = linearToOutputTexel(tint); }",
    );
    material.uniforms["levels"] = { value: LEVELS.map((colour) => new THREE.Color(colour)) };
    this.shape = new THREE.LineSegments(geometry, material);
    this.prepare(style);
  }

  fill(parts: Iterable<Float32Array>): void {
    const list = [...parts];
    const count = list.reduce((sum, part) => sum + part.length / 8, 0);
    const into = this.stream.reserve(count);
    let at = 0;
    for (const part of list) {
      into.set(part, at);
      at += part.length;
    }
    this.stream.commit(count);
    this.show(count);
  }
}
