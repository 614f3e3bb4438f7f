/** Colours surfaces by a field: a number for each vertex or triangle, and a texture with the colour map. */
import * as THREE from "three";
import type { ObjectState } from "../model";
import { colourAt, MAP_COLOURS, type MapName } from "./colour_maps";
import { rangeOf, type FieldChoice, type FieldData } from "./fields";

/** Stands for no value, because shaders need not know NaN. */
const NONE = 3e38;

/** For the vertex shader. */
export const FIELD_INPUT = `
  in float value; uniform vec2 covered; out float share; out float known;
  void readField() { known = abs(value) < 1e38 ? 1.0 : 0.0; share = (value - covered.x) * covered.y; }`;

/** For the fragment shader: whether a field gives the colour, and the colour. Triangles with a vertex without a value have none. */
export const FIELD_COLOUR = `
  uniform sampler2D fieldMap; uniform bool isMapped; in float share; in float known;
  bool hasField() { return isMapped && known > 0.999; }
  vec3 fieldColour() { return texture(fieldMap, vec2((clamp(share, 0.0, 1.0) * ${MAP_COLOURS - 1}.0 + 0.5) / ${MAP_COLOURS}.0, 0.5)).rgb; }`;

function textureOf(map: MapName): THREE.DataTexture {
  const colours = new Uint8Array(4 * MAP_COLOURS);
  for (let i = 0; i < MAP_COLOURS; ++i) colours.set([...colourAt(map, i / (MAP_COLOURS - 1)), 255], 4 * i);
  const texture = new THREE.DataTexture(colours, MAP_COLOURS, 1);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

function write(values: Float32Array | undefined, into: Float32Array, first: number, count: number, repeat: number): void {
  if (!values) return void into.fill(NONE, repeat * first, repeat * (first + count));
  for (let i = 0; i < count; ++i) {
    const value = values[i]!;
    into.fill(Math.abs(value) < NONE ? value : NONE, repeat * (first + i), repeat * (first + i + 1));
  }
}

export class FieldPaint {
  /** Of the materials that use the shaders above. */
  readonly uniforms = { fieldMap: { value: null as THREE.DataTexture | null }, covered: { value: new THREE.Vector2() }, isMapped: { value: false } };
  /** Of rods and particles, which have only values of vertices. */
  readonly looseUniforms = { isMapped: { value: false } };
  private map: MapName | null = null;
  private data: FieldData | null = null;
  /** Triangles that share no vertices, so that each has its own value. */
  private faces: THREE.BufferGeometry | null = null;
  private isStale = false;

  private objects: ObjectState[] = [];
  private shared = [new THREE.BufferGeometry()];

  /** Begins a scene. The geometries have all vertices; the first is that of the surfaces. */
  build(objects: ObjectState[], shared: THREE.BufferGeometry[]): void {
    this.faces?.dispose();
    this.faces = null;
    this.data = null;
    this.objects = objects;
    this.shared = shared;
  }

  /** Positions have changed. */
  touch(): void {
    this.isStale = true;
  }

  /** Returns the geometry to draw: the shared one with a value for each vertex, or one without shared vertices. */
  show(data: FieldData | null, choice: FieldChoice): THREE.BufferGeometry {
    const { uniforms, shared } = this;
    const element = data?.form.element;
    this.looseUniforms.isMapped.value = element === "vertex";
    uniforms.isMapped.value = element === "vertex" || element === "face";
    if (element !== "vertex") for (const geometry of shared) geometry.deleteAttribute("value");
    if (element !== "face") {
      this.faces?.dispose();
      this.faces = null;
    }
    const isNew = data !== this.data;
    this.data = data;
    if (!data || !uniforms.isMapped.value) return shared[0]!;
    const [low, high] = rangeOf(data, choice);
    uniforms.covered.value.set(low, high > low ? 1 / (high - low) : 0);
    if (choice.map !== this.map) {
      uniforms.fieldMap.value?.dispose();
      uniforms.fieldMap.value = textureOf((this.map = choice.map));
    }
    if (element === "vertex") {
      if (isNew) this.writeVertices(data);
      return shared[0]!;
    }
    this.faces ??= this.split();
    if (isNew) this.writeFaces(data);
    if (this.isStale) this.movePoints();
    return this.faces;
  }

  private writeVertices({ values }: FieldData): void {
    const { shared, objects } = this;
    const count = objects.reduce((sum, { vertices }) => sum + vertices, 0);
    if (!shared[0]!.hasAttribute("value")) {
      const made = new THREE.BufferAttribute(new Float32Array(count), 1).setUsage(THREE.DynamicDrawUsage);
      for (const geometry of shared) geometry.setAttribute("value", made);
    }
    const attribute = shared[0]!.getAttribute("value") as THREE.BufferAttribute;
    let first = 0;
    for (const { index, vertices } of objects) {
      write(values.get(index), attribute.array as Float32Array, first, vertices, 1);
      first += vertices;
    }
    attribute.needsUpdate = true;
  }

  private split(): THREE.BufferGeometry {
    const corners = this.objects.reduce((sum, object) => sum + object.corners.length, 0);
    const numbers = new Uint32Array(corners);
    let first = 0;
    for (const { index, corners } of this.objects) numbers.fill(index, first, (first += corners.length));
    const moving = (width: number) => new THREE.BufferAttribute(new Float32Array(width * corners), width).setUsage(THREE.DynamicDrawUsage);
    const geometry = new THREE.BufferGeometry().setAttribute("position", moving(3)).setAttribute("value", moving(1)).setAttribute("object", new THREE.BufferAttribute(numbers, 1));
    geometry.boundingSphere = new THREE.Sphere();
    this.isStale = true;
    return geometry;
  }

  private writeFaces({ values }: FieldData): void {
    const attribute = this.faces!.getAttribute("value") as THREE.BufferAttribute;
    const into = attribute.array as Float32Array;
    let first = 0;
    for (const { index, corners, triangles } of this.objects) {
      write(values.get(index), into, first, triangles, 3);
      into.fill(NONE, 3 * (first + triangles), 3 * first + corners.length);  // edges and points
      first += corners.length / 3;
    }
    attribute.needsUpdate = true;
  }

  private movePoints(): void {
    const attribute = this.faces!.getAttribute("position") as THREE.BufferAttribute;
    const into = attribute.array as Float32Array;
    let at = 0;
    for (const { corners, positions } of this.objects)
      for (const corner of corners) {
        into[at++] = positions[3 * corner]!;
        into[at++] = positions[3 * corner + 1]!;
        into[at++] = positions[3 * corner + 2]!;
      }
    attribute.needsUpdate = true;
    this.isStale = false;
  }
}
