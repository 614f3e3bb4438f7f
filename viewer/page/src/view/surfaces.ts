/** The surfaces and wireframes of all objects, in a constant number of draw calls. */
import * as THREE from "three";
import type { Layer, ObjectState } from "../model";

/** Exceeds the buffer size of any graphics card. */
const LARGEST_BUFFER = 0x80000000;
/** Texels per row of the texture of colours; half the minimum that WebGL 2 guarantees. */
const LOOKS_WIDTH = 1024;
/** The opacity that marks hidden objects. */
const HIDDEN = -1;
/** Gaps up to this size are uploaded again rather than split into another call. */
const GAP = 1024;

/** The range of opacities that a mesh draws: from the first to below the second. */
const OPAQUE = new THREE.Vector2(1, 2);
const TRANSPARENT = new THREE.Vector2(0, 1);
const ALL = new THREE.Vector2(0, 2);

// Vertices of objects that a mesh does not draw are moved out of view.
const VERTEX_SHADER = `
  uniform sampler2D looks; uniform vec2 drawn; uniform int selected; in uint object;
  flat out vec4 look; flat out float glow; out vec3 seen;
  void main() {
    int number = int(object);
    look = texelFetch(looks, ivec2(number % ${LOOKS_WIDTH}, number / ${LOOKS_WIDTH}), 0);
    glow = number == selected ? 0.25 : 0.0;
    vec4 at = modelViewMatrix * vec4(position, 1.0);
    seen = at.xyz;
    gl_Position = look.a >= drawn.x && look.a < drawn.y ? projectionMatrix * at : vec4(2.0, 2.0, 2.0, 1.0);
  }`;

// Flat shading derives normals from screen-space derivatives, so deformation costs nothing. Light comes from
// the sky, from the ground (bluish) and from the camera; surfaces that face the camera shine a little.
const SURFACE_SHADER = `
  flat in vec4 look; flat in float glow; in vec3 seen; out vec4 result;
  const vec3 ground = vec3(0.246, 0.279, 0.352);
  void main() {
    vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
    float above = 0.5 + 0.5 * dot(normal, viewMatrix[1].xyz);
    float facing = clamp(normal.z, 0.0, 1.0);
    vec3 light = 0.446 * mix(ground, vec3(1.0), above) + 0.7 * facing + glow;
    result = linearToOutputTexel(vec4(light * look.rgb + 0.022 * facing * facing, look.a));
  }`;

const WIREFRAME_SHADER = `
  uniform vec4 ink; flat in vec4 look; out vec4 result;
  void main() { result = linearToOutputTexel(ink.a > 0.0 ? ink : vec4(look.rgb, 1.0)); }`;

/** The colour of the wireframe over surfaces. Without surfaces it has the colours of the objects. */
const WIREFRAME_COLOUR = new THREE.Color("#101418");
const WIREFRAME_OPACITY = 0.35;

/** A sentence about why objects cannot be drawn, or null. */
export function obstacleOf(gl: WebGL2RenderingContext, objects: { name: string; vertices: number; triangles: number }[]): string | null {
  const vertices = objects.reduce((sum, object) => sum + object.vertices, 0);
  const triangles = objects.reduce((sum, object) => sum + object.triangles, 0);
  const mostVertices = Math.min(gl.getParameter(gl.MAX_ELEMENT_INDEX) as number, LARGEST_BUFFER / 12);
  const mostTriangles = LARGEST_BUFFER / 24;  // two ends per edge
  const mostObjects = LOOKS_WIDTH * (gl.getParameter(gl.MAX_TEXTURE_SIZE) as number);
  if (vertices <= mostVertices && triangles <= mostTriangles && objects.length <= mostObjects) return null;
  const count = (number: number, what: string) => `${number.toLocaleString("en")} ${what}`;
  const size = (of: { vertices: number; triangles: number }) => `${count(of.vertices, "vertices")} and ${count(of.triangles, "triangles")}`;
  const largest = objects.reduce((a, b) => (b.vertices + b.triangles > a.vertices + a.triangles ? b : a));
  return (
    `The scene has ${count(objects.length, objects.length === 1 ? "object" : "objects")} with ${size({ vertices, triangles })}, more than this browser can draw. ` +
    `The largest is ${largest.name}, with ${size(largest)}. Show a part of the scene, or coarser meshes.`
  );
}

interface Range {
  start: number;
  count: number;
}

/** Adds a range to upload: extends the last range when it is near, otherwise appends. */
export function addRange(ranges: Range[], start: number, count: number): void {
  const last = ranges[ranges.length - 1];
  const gap = last ? start - (last.start + last.count) : -1;
  if (last && gap >= 0 && gap <= GAP) last.count += gap + count;
  else ranges.push({ start, count });
}

/** The vertex ids of the corners of all triangles, in the numbering of all objects together. */
function cornersOf(objects: ObjectState[]): Uint32Array {
  const all = new Uint32Array(objects.reduce((sum, object) => sum + object.corners.length, 0));
  let at = 0;
  let first = 0;
  for (const { corners, vertices } of objects) {
    for (let i = 0; i < corners.length; ++i) all[at + i] = first + corners[i]!;
    at += corners.length;
    first += vertices;
  }
  return all;
}

/** Both ends of the edges of all triangles. */
function edgesOf(corners: Uint32Array): Uint32Array {
  const ends = new Uint32Array(2 * corners.length);
  for (let i = 0; i < corners.length; i += 3)
    for (let side = 0; side < 3; ++side) {
      ends[2 * (i + side)] = corners[i + side]!;
      ends[2 * (i + side) + 1] = corners[i + ((side + 1) % 3)]!;
    }
  return ends;
}

/** An attribute whose array is freed after the upload. */
function sentOnce(array: Uint32Array): THREE.BufferAttribute {
  const attribute = new THREE.BufferAttribute(array, 1);
  return attribute.onUpload(() => (attribute.array = new Uint32Array(0)));
}

/** One texel per object: colour and opacity. */
function makeLooks(objects: number): THREE.DataTexture {
  const rows = Math.max(1, Math.ceil(objects / LOOKS_WIDTH));
  return new THREE.DataTexture(new Float32Array(4 * LOOKS_WIDTH * rows), LOOKS_WIDTH, rows, THREE.RGBAFormat, THREE.FloatType);
}

export class Surfaces {
  readonly group = new THREE.Group();
  private objects: ObjectState[] = [];
  private positions = new THREE.BufferAttribute(new Float32Array(0), 3);
  private readonly uniforms = { looks: { value: makeLooks(0) }, selected: { value: -1 }, ink: { value: new THREE.Vector4() } };
  private readonly opaque = new THREE.Mesh(new THREE.BufferGeometry(), this.material(OPAQUE, SURFACE_SHADER));
  private readonly transparent = new THREE.Mesh(new THREE.BufferGeometry(), this.material(TRANSPARENT, SURFACE_SHADER));
  private readonly wireframe = new THREE.LineSegments(new THREE.BufferGeometry(), this.material(ALL, WIREFRAME_SHADER));

  constructor() {
    // Wireframes and layers lie on surfaces and must win the depth test.
    for (const { material } of [this.opaque, this.transparent])
      Object.assign(material, { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    for (const { material } of [this.transparent, this.wireframe]) material.transparent = true;
    this.transparent.material.depthWrite = false;
    this.transparent.material.forceSinglePass = false;  // back faces first: the inside is visible through the outside
    this.group.add(this.opaque, this.transparent, this.wireframe);
    for (const shape of this.group.children) shape.frustumCulled = false;  // bounds would need an update in each frame
  }

  private material(drawn: THREE.Vector2, fragmentShader: string): THREE.ShaderMaterial {
    return new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, vertexShader: VERTEX_SHADER, fragmentShader,
      uniforms: { ...this.uniforms, drawn: { value: drawn } }, side: THREE.DoubleSide,
    });
  }

  /**
   * Replaces the scene. `positions` contains all objects one after the other; each object has a view into
   * it.
   */
  build(objects: ObjectState[], positions: Float32Array): void {
    for (const { geometry } of [this.opaque, this.wireframe]) geometry.dispose();
    this.uniforms.looks.value.dispose();
    this.objects = objects;
    this.uniforms.looks.value = makeLooks(objects.length);
    const attribute = new THREE.BufferAttribute(positions, 3).setUsage(THREE.DynamicDrawUsage);
    this.positions = attribute.onUpload(() => attribute.clearUpdateRanges());
    const numbers = new Uint32Array(positions.length / 3);
    let first = 0;
    for (const { index, vertices } of objects) numbers.fill(index, first, (first += vertices));
    const number = sentOnce(numbers);
    for (const shape of [this.opaque, this.wireframe]) {
      shape.geometry = new THREE.BufferGeometry().setAttribute("position", attribute).setAttribute("object", number);
      shape.geometry.boundingSphere = new THREE.Sphere();  // three.js sorts by it and would otherwise visit all vertices
    }
    this.transparent.geometry = this.opaque.geometry.setIndex(sentOnce(cornersOf(objects)));
  }

  /** Marks positions as changed. Only visible objects are uploaded; the others wait. */
  touch(objects: Iterable<number>): void {
    const { array, updateRanges: ranges } = this.positions;
    for (const object of objects) {
      const { positions } = this.objects[object]!;
      addRange(ranges, positions.byteOffset / positions.BYTES_PER_ELEMENT, positions.length);
    }
    const pending = ranges.reduce((sum, { count }) => sum + count, 0);
    if (pending > array.length / 2) ranges.splice(0, ranges.length, { start: 0, count: array.length });
    this.positions.needsUpdate = true;
  }

  /** Call when the appearance or the visibility of objects changed. */
  paint(layers: Record<Layer, boolean>): void {
    const looks = this.uniforms.looks.value;
    const data = looks.image.data as Float32Array;
    const colours = new Map<string, THREE.Color>();  // most objects share a few colours
    let [opaque, transparent] = [false, false];
    for (const { index, colour, opacity, visible } of this.objects) {
      let linear = colours.get(colour);
      if (!linear) colours.set(colour, (linear = new THREE.Color(colour)));
      linear.toArray(data, 4 * index);
      data[4 * index + 3] = visible ? opacity : HIDDEN;
      if (visible && opacity < 1) transparent = true;
      else if (visible) opaque = true;
    }
    looks.needsUpdate = true;
    this.opaque.visible = layers.surface && opaque;
    this.transparent.visible = layers.surface && transparent;
    this.wireframe.visible = layers.wireframe && (opaque || transparent);
    if (this.wireframe.visible && !this.wireframe.geometry.index) this.wireframe.geometry.setIndex(sentOnce(edgesOf(cornersOf(this.objects))));
    const { r, g, b } = WIREFRAME_COLOUR;
    this.uniforms.ink.value.set(r, g, b, layers.surface ? WIREFRAME_OPACITY : 0);
  }

  /** Highlights one object, or none. */
  select(object: number | null): void {
    this.uniforms.selected.value = object ?? -1;
  }
}
