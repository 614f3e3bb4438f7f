/** The surfaces and wireframes of all objects, in a constant number of draw calls. */
import * as THREE from "three";
import { FIELD_COLOUR, FIELD_INPUT, FieldPaint } from "../fields/paint";
import type { FieldChoice, FieldData } from "../fields/fields";
import type { Layer, ObjectState } from "../model";
import { writeNormals } from "./normals";
import { shared } from "./primitives";

/** Exceeds the buffer size of any graphics card. */
const LARGEST_BUFFER = 0x80000000;
/** Texels per row of the texture of colours; half the minimum that WebGL 2 guarantees. */
const LOOKS_WIDTH = 1024;
/** The opacity that marks hidden objects. */
const HIDDEN = -1;
/** Gaps up to this size are uploaded again rather than split into another call. */
const GAP = 1024;

/** While more triangles move than this, they are shaded flat, because their normals would take too long. */
export const MOST_SMOOTH = 300_000;

/** The range of opacities that a mesh draws: from the first to below the second. */
const OPAQUE = new THREE.Vector2(1, 2);
const TRANSPARENT = new THREE.Vector2(0, 1);
const ALL = new THREE.Vector2(0, 2);
const CASTERS = new THREE.Vector2(0.4, 2);

// Vertices of objects that a mesh does not draw are moved out of view.
const VERTEX_SHADER = `${FIELD_INPUT}
  uniform sampler2D looks; uniform vec2 drawn; uniform int selected; in uint object; in vec4 bent;
  flat out vec4 look; flat out float glow; out vec3 seen; out vec3 smoothed; out vec3 place;
  void main() {
    readField();
    int number = int(object);
    look = texelFetch(looks, ivec2(number % ${LOOKS_WIDTH}, number / ${LOOKS_WIDTH}), 0);
    glow = number == selected ? 0.25 : 0.0;
    vec4 at = modelViewMatrix * vec4(position, 1.0);
    seen = at.xyz;
    place = position;
    smoothed = mat3(modelViewMatrix) * bent.xyz;
    gl_PointSize = 7.0;
    gl_Position = look.a >= drawn.x && look.a < drawn.y ? projectionMatrix * at : vec4(2.0, 2.0, 2.0, 1.0);
  }`;

/** Removes what is on the removed side of the slice. */
const CUT = `
  uniform vec4 slice; in vec3 place;
  void cut() { if (dot(slice.xyz, place) > slice.w) discard; }`;

// The flat normal comes from screen-space derivatives, so deformation costs nothing. The smooth normal is a mean
// over triangles; it is short at sharp edges, which stay flat. Light comes from the sky, from the floor and from a
// lamp beside the camera.
const SURFACE_SHADER = `${CUT}${FIELD_COLOUR}
  uniform vec3 up; flat in vec4 look; flat in float glow; in vec3 seen; in vec3 smoothed; out vec4 result;
  const vec3 floorLight = vec3(0.30, 0.29, 0.28), lamp = normalize(vec3(0.35, 0.5, 0.8));
  void main() {
    cut();
    vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
    float length = length(smoothed);
    vec3 even = length > 0.0 ? smoothed / length : normal;
    even = dot(even, normal) < 0.0 ? -even : even;
    normal = normalize(mix(normal, even, smoothstep(0.7, 0.82, length)));
    float above = 0.5 + 0.5 * dot(normal, mat3(viewMatrix) * up);
    float lit = clamp(dot(normal, lamp), 0.0, 1.0);
    float rim = pow(1.0 - clamp(normal.z, 0.0, 1.0), 3.0);
    vec3 light = 0.55 * mix(floorLight, vec3(0.95, 0.98, 1.05), above) + 0.58 * lit + glow;
    vec3 colour = look.rgb;
    if (hasField()) {
      colour = fieldColour();
      light = mix(vec3(1.0), light, 0.4);  // so that colours can be compared with the colour bar
      rim = 0.0;
    }
    result = linearToOutputTexel(vec4(light * colour + 0.03 * rim * above, look.a));
  }`;

const COUNT_SHADER = `${CUT} out vec4 result; void main() { cut(); result = vec4(0.0); }`;

// From below: darker where the surface is near the floor.
const SHADOW_SHADER = `
  out vec4 result;
  void main() {
    float near = 1.0 - gl_FragCoord.z;
    result = vec4(0.0, 0.0, 0.0, 0.9 * near * near);
  }`;

const WIREFRAME_SHADER = `${CUT}
  uniform vec4 ink; flat in vec4 look; out vec4 result;
  void main() { cut(); result = linearToOutputTexel(ink.a > 0.0 ? ink : vec4(look.rgb, 1.0)); }`;

const LOOSE_SHADER = `${CUT}${FIELD_COLOUR}
  flat in vec4 look; out vec4 result;
  void main() { cut(); result = linearToOutputTexel(vec4(hasField() ? fieldColour() : look.rgb, 1.0)); }`;

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

/** The vertex ids of edges or points of no triangle, in the numbering of all objects together. */
function looseOf(objects: ObjectState[], kind: "edges" | "points"): Uint32Array {
  let first = 0;
  const all = objects.map((object) => {
    const ids = object[kind].map((vertex) => first + vertex);
    first += object.vertices;
    return ids;
  });
  const list = new Uint32Array(all.reduce((sum, ids) => sum + ids.length, 0));
  let at = 0;
  for (const ids of all) {
    list.set(ids, at);
    at += ids.length;
  }
  return list;
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
  /** What casts the shadow. */
  readonly casters = new THREE.Scene();
  /** Opaque surfaces alone, for their depths. */
  readonly solids = new THREE.Scene();
  /** Whether objects are shaded flat because too many triangles move. */
  isTooLarge = false;
  private objects: ObjectState[] = [];
  private positions = new THREE.BufferAttribute(new Float32Array(0), 3);
  private normals = new THREE.BufferAttribute(new Int16Array(0), 4, true);
  /** Objects whose normals are not those of their positions. */
  private readonly stale = new Set<number>();
  private isNew = true;
  private hasLoose = false;
  private readonly field = new FieldPaint();
  private readonly uniforms = {
    ...this.field.uniforms, looks: { value: makeLooks(0) }, selected: { value: -1 }, ink: { value: new THREE.Vector4() }, up: { value: new THREE.Vector3(0, 1, 0) }, slice: shared.slice,
  };
  private readonly opaque = new THREE.Mesh(new THREE.BufferGeometry(), this.material(OPAQUE, SURFACE_SHADER));
  private readonly transparent = new THREE.Mesh(new THREE.BufferGeometry(), this.material(TRANSPARENT, SURFACE_SHADER));
  private readonly caster = new THREE.Mesh(new THREE.BufferGeometry(), this.material(CASTERS, SHADOW_SHADER));
  private readonly solid = new THREE.Mesh(new THREE.BufferGeometry(), this.material(OPAQUE, COUNT_SHADER));
  /** Edges and points of no triangle. */
  private readonly rods = new THREE.LineSegments(new THREE.BufferGeometry(), this.material(ALL, LOOSE_SHADER, this.field.looseUniforms));
  private readonly particles = new THREE.Points(new THREE.BufferGeometry(), this.material(ALL, LOOSE_SHADER, this.field.looseUniforms));
  private readonly wireframe = new THREE.LineSegments(new THREE.BufferGeometry(), this.material(ALL, WIREFRAME_SHADER));

  constructor() {
    // Wireframes and layers lie on surfaces and must win the depth test.
    for (const { material } of [this.opaque, this.transparent])
      Object.assign(material, { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    for (const { material } of [this.transparent, this.wireframe]) material.transparent = true;
    this.transparent.material.depthWrite = false;
    this.transparent.material.forceSinglePass = false;  // back faces first: the inside is visible through the outside
    this.group.add(this.opaque, this.transparent, this.wireframe, this.rods, this.particles);
    this.casters.add(this.caster);
    this.solids.add(this.solid);
    for (const shape of [...this.group.children, this.caster, this.solid]) shape.frustumCulled = false;  // bounds would need an update in each frame
  }

  private material(drawn: THREE.Vector2, fragmentShader: string, more: Record<string, THREE.IUniform> = {}): THREE.ShaderMaterial {
    return new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, vertexShader: VERTEX_SHADER, fragmentShader,
      uniforms: { ...this.uniforms, ...more, drawn: { value: drawn } }, side: THREE.DoubleSide,
    });
  }

  /**
   * Replaces the scene. `positions` contains all objects one after the other; each object has a view into
   * it.
   */
  build(objects: ObjectState[], positions: Float32Array): void {
    const shapes = [this.solid, this.rods, this.particles, this.wireframe];
    for (const { geometry } of shapes) geometry.dispose();
    this.uniforms.looks.value.dispose();
    this.objects = objects;
    this.uniforms.looks.value = makeLooks(objects.length);
    const attribute = new THREE.BufferAttribute(positions, 3).setUsage(THREE.DynamicDrawUsage);
    this.positions = attribute.onUpload(() => attribute.clearUpdateRanges());
    const normals = new THREE.BufferAttribute(new Int16Array((4 * positions.length) / 3), 4, true).setUsage(THREE.DynamicDrawUsage);
    this.normals = normals.onUpload(() => normals.clearUpdateRanges());
    this.isNew = true;
    this.stale.clear();
    const numbers = new Uint32Array(positions.length / 3);
    let first = 0;
    for (const { index, vertices } of objects) numbers.fill(index, first, (first += vertices));
    const number = sentOnce(numbers);
    for (const shape of shapes) {
      shape.geometry = new THREE.BufferGeometry().setAttribute("position", attribute).setAttribute("object", number).setAttribute("bent", normals);
      shape.geometry.boundingSphere = new THREE.Sphere();  // three.js sorts by it and would otherwise visit all vertices
    }
    this.rods.geometry.setIndex(sentOnce(looseOf(objects, "edges")));
    this.particles.geometry.setIndex(sentOnce(looseOf(objects, "points")));
    this.hasLoose = objects.some(({ edges, points }) => edges.length + points.length > 0);
    this.transparent.geometry = this.caster.geometry = this.opaque.geometry = this.solid.geometry.setIndex(sentOnce(cornersOf(objects)));
    this.field.build(objects, [this.solid, this.rods, this.particles].map(({ geometry }) => geometry));
  }

  /** Colours the surfaces by a field, or not. */
  showField(data: FieldData | null, choice: FieldChoice): void {
    this.opaque.geometry = this.transparent.geometry = this.field.show(data, choice);
  }

  /** Marks positions as changed. Only visible objects are uploaded; the others wait. */
  touch(objects: Iterable<number>): void {
    const touched = [...objects];
    for (const object of touched) this.stale.add(object);
    this.field.touch();
    this.upload(this.positions, touched);
  }

  private upload(attribute: THREE.BufferAttribute, objects: Iterable<number>): void {
    const { array, updateRanges: ranges, itemSize } = attribute;
    for (const object of objects) {
      const { positions } = this.objects[object]!;
      const first = positions.byteOffset / (3 * positions.BYTES_PER_ELEMENT);
      addRange(ranges, itemSize * first, (itemSize * positions.length) / 3);
    }
    const pending = ranges.reduce((sum, { count }) => sum + count, 0);
    if (pending > array.length / 2) ranges.splice(0, ranges.length, { start: 0, count: array.length });
    attribute.needsUpdate = true;
  }

  /** Updates the normals of objects that moved. Call before each drawing; costs nothing when nothing moved. */
  shade(isSmooth: boolean): void {
    if (!isSmooth || this.stale.size === 0) return;
    const moved = [...this.stale].map((object) => this.objects[object]!);
    const triangles = moved.reduce((sum, object) => sum + object.triangles, 0);
    // At the start there is time for all of them.
    this.isTooLarge = triangles > MOST_SMOOTH && !this.isNew;
    this.isNew = false;
    const all = this.normals.array as Int16Array;
    for (const object of moved) {
      const first = (4 * object.positions.byteOffset) / (3 * object.positions.BYTES_PER_ELEMENT);
      const normals = all.subarray(first, first + 4 * object.vertices);
      if (this.isTooLarge) normals.fill(0);
      else writeNormals(object, normals);
    }
    this.upload(this.normals, this.stale);
    this.stale.clear();
  }

  set isSmooth(on: boolean) {
    if (!on) {
      (this.normals.array as Int16Array).fill(0);
      this.upload(this.normals, this.objects.keys());
    }
    for (const object of this.objects.keys()) this.stale.add(object);
    this.isNew = true;
  }

  set up(direction: THREE.Vector3) {
    this.uniforms.up.value.copy(direction);
  }

  /** Call when the appearance or the visibility of objects changed. `share` multiplies all opacities. */
  paint(layers: Record<Layer, boolean>, share = 1): void {
    const looks = this.uniforms.looks.value;
    const data = looks.image.data as Float32Array;
    const colours = new Map<string, THREE.Color>();  // most objects share a few colours
    let [opaque, transparent] = [false, false];
    for (const { index, colour, opacity: own, visible } of this.objects) {
      const opacity = share * own;
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
    this.rods.visible = this.particles.visible = this.hasLoose && (layers.surface || layers.wireframe);
    this.caster.visible = layers.surface && (opaque || transparent);
    this.wireframe.visible = layers.wireframe && (opaque || transparent);
    if (this.wireframe.visible && !this.wireframe.geometry.index) this.wireframe.geometry.setIndex(sentOnce(edgesOf(cornersOf(this.objects))));
    const { r, g, b } = WIREFRAME_COLOUR;
    this.uniforms.ink.value.set(r, g, b, layers.surface ? WIREFRAME_OPACITY : 0);
  }

  /** For counting how many surfaces a ray passes. */
  get counting(): THREE.ShaderMaterial {
    return this.material(ALL, COUNT_SHADER);
  }

  get geometry(): THREE.BufferGeometry {
    return this.solid.geometry;
  }

  /** Highlights one object, or none. */
  select(object: number | null): void {
    this.uniforms.selected.value = object ?? -1;
  }
}
