/**
 * Dots and lines with a size in pixels and a halo, so that they are seen on every ground. Those behind a
 * surface are faint. Where many fall into the same pixels, fewer are drawn.
 */
import * as THREE from "three";
import { HALO } from "../colours";
import { shared } from "./primitives";
import { Stream } from "./stream";
import { thin } from "./thinning";

interface Style {
  colour: string;
  /** In CSS pixels. */
  size?: number;
  /** Drawn over all surfaces, not faint behind them. */
  onTop?: boolean;
  order?: number;
  /** Marks closer than this on the screen, in CSS pixels, are thinned out. 0 draws all. */
  spacing?: number;
  /** Lines end in the head of an arrow. */
  arrow?: boolean;
  /** Elements have an additional number: the index of their colour. */
  colours?: readonly string[];
}

/** The width of the halo in CSS pixels. */
const HALO_WIDTH = 1.5;
const HIDDEN_OPACITY = 0.28;

/** Where the marks are projected to; `version` changes with the camera. */
export interface Projection {
  matrix: THREE.Matrix4;
  version: number;
}

// A mark lies on a surface or just below one, so it is tested as if it were `lift` nearer to the camera.
const LIFTED = `
  uniform float lift, size, extra, pixelRatio; uniform vec2 resolution; uniform vec4 slice;
  bool isCut(vec3 place) { return dot(slice.xyz, place) > slice.w; }
  const vec4 nowhere = vec4(2.0, 2.0, 2.0, 1.0);
  vec4 lifted(vec4 at) {
    vec4 p = projectionMatrix * at, q = projectionMatrix * vec4(at.xy, at.z + lift, 1.0);
    if (q.w > 0.0) p.z = max(q.z / q.w, -0.999) * p.w;
    return p;
  }`;

abstract class Marks {
  readonly shape = new THREE.Group();
  /** All elements, also those that are not drawn. */
  count = 0;
  protected readonly stream: Stream;
  protected readonly uniforms;
  private readonly faint: THREE.Object3D[] = [];
  private rows = new Float32Array(0);
  private version = NaN;

  constructor(
    private readonly style: Style, private readonly geometry: THREE.BufferGeometry, private readonly stride: number,
    parts: Record<string, [number, number]>, instanced: boolean,
  ) {
    const colours = style.colours ?? [style.colour];
    if (style.colours) parts = { ...parts, tint: [1, stride - 1] };
    this.stream = new Stream(geometry, stride, parts, instanced);
    this.uniforms = {
      resolution: shared.resolution, pixelRatio: shared.pixelRatio, lift: shared.lift, slice: shared.slice,
      colours: { value: colours.map((colour) => new THREE.Color(colour)) }, size: { value: style.size ?? 1 }, span: { value: 0 },
    };
    this.shape.visible = false;
  }

  /** Adds the faint pass, the halo and the colour. */
  protected addPasses(make: (geometry: THREE.BufferGeometry, material: THREE.ShaderMaterial) => THREE.Object3D, vertexShader: string, cover: string): void {
    const onTop = this.style.onTop ?? false;
    const passes = [
      { hidden: true, halo: false, opacity: HIDDEN_OPACITY }, { hidden: false, halo: true, opacity: 0.95 }, { hidden: false, halo: false, opacity: 1 },
    ].filter(({ hidden }) => !hidden || !onTop);
    passes.forEach(({ hidden, halo, opacity }, i) => {
      const ink = halo ? "uniform vec3 halo; const bool hollow = false; vec3 ink() { return halo; }" : "flat in vec3 hue; const bool hollow = true; vec3 ink() { return hue; }";
      const material = new THREE.ShaderMaterial({
        glslVersion: THREE.GLSL3,
        uniforms: { ...this.uniforms, opacity: { value: opacity }, extra: { value: halo ? 2 * HALO_WIDTH : 0 }, halo: { value: new THREE.Color(HALO) } },
        vertexShader: `${LIFTED} uniform vec3 colours[${this.uniforms.colours.value.length}]; ${this.style.colours ? "in float tint;" : "const float tint = 0.0;"} flat out vec3 hue;\n${vertexShader}`,
        fragmentShader: `precision highp float; uniform float opacity; out vec4 result; ${ink}\n${cover}
          void main() {
            float part = cover();
            if (part <= 0.0) discard;
            result = linearToOutputTexel(vec4(ink(), part * opacity));
          }`,
        transparent: true, depthTest: !onTop && !hidden, depthWrite: false, side: THREE.DoubleSide,
      });
      const shape = make(this.geometry, material);
      shape.frustumCulled = false;
      shape.renderOrder = (this.style.order ?? 1) + 0.1 * i;
      if (hidden) this.faint.push(shape);
      this.shape.add(shape);
    });
  }

  /** Whether marks behind surfaces are visible. */
  set through(on: boolean) {
    for (const shape of this.faint) shape.visible = on;
  }

  /** Replaces the colour of all elements. */
  set colour(colour: string) {
    this.uniforms.colours.value[0]!.set(colour);
  }

  /** Replaces the colours that elements choose from; there must be as many as before. */
  set colours(colours: string[]) {
    colours.forEach((colour, i) => this.uniforms.colours.value[i]!.set(colour));
  }

  set size(pixels: number) {
    this.uniforms.size.value = pixels;
  }

  /** Reserves `count` elements; `write` returns how many it wrote. */
  fill(count: number, write: (into: Float32Array) => number): void {
    if (this.rows.length < count * this.stride) this.rows = new Float32Array(Math.max(count * this.stride, 2 * this.rows.length));
    this.count = count > 0 ? write(this.rows) : 0;
    this.version = NaN;
    this.shape.visible = this.count > 0;
  }

  /** Uploads the elements to draw. Call before each drawing. */
  arrange(projection: Projection): void {
    const { count, rows, stride } = this;
    const spacing = this.style.spacing ?? 0;
    if (count === 0 || (spacing === 0 ? !Number.isNaN(this.version) : this.version === projection.version)) return;
    this.version = projection.version;
    if (spacing === 0) {
      this.stream.reserve(count).set(rows.subarray(0, count * stride));
      return this.stream.commit(count);
    }
    const { x: width, y: height } = shared.resolution.value;
    const chosen = thin(rows, stride, count, projection.matrix, width, height, spacing);
    const into = this.stream.reserve(chosen.length);
    chosen.forEach((from, to) => {
      for (let i = 0; i < stride; ++i) into[stride * to + i] = rows[stride * from + i]!;
    });
    this.stream.commit(chosen.length);
  }
}

/** Round dots. An element is x, y, z. A ring has the colour of the halo inside. */
export class Dots extends Marks {
  constructor(style: Style & { ring?: boolean }) {
    super(style, new THREE.BufferGeometry(), style.colours ? 4 : 3, { position: [3, 0] }, false);
    this.addPasses(
      (geometry, material) => new THREE.Points(geometry, material),
      `flat out float across;
       void main() {
         gl_Position = isCut(position) ? nowhere : lifted(modelViewMatrix * vec4(position, 1.0));
         gl_PointSize = across = (size + extra) * pixelRatio;
         hue = colours[int(tint)];
       }`,
      `flat in float across;
       float cover() {
         float r = length(gl_PointCoord - 0.5) * across;
         ${style.ring ? "if (hollow && r < 0.24 * across) return 0.0;" : ""}
         return clamp(0.5 * across - r + 0.5, 0.0, 1.0);
       }`,
    );
  }
}

/** Lines with a width in pixels. An element is two points, or with `span` a point and a direction. */
export class Lines extends Marks {
  constructor(style: Style) {
    const geometry = new THREE.InstancedBufferGeometry();
    // The third number is 1 at the sides of a head and 2 at its tip.
    geometry.setAttribute("position", new THREE.Float32BufferAttribute([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0, ...(style.arrow ? [1, -1, 1, 1, 1, 1, 1, 0, 2] : [])], 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3, ...(style.arrow ? [4, 5, 6] : [])]);
    super(style, geometry, style.colours ? 7 : 6, { start: [3, 0], finish: [3, 3] }, true);
    this.addPasses(
      (shared, material) => new THREE.Mesh(shared, material),
      // Clip a line that begins behind the camera; otherwise its direction on the screen is wrong.
      `uniform float span; in vec3 start; in vec3 finish;
       void main() {
         bool isPerspective = projectionMatrix[2][3] == -1.0;
         vec4 a = modelViewMatrix * vec4(start, 1.0), b = modelViewMatrix * vec4(finish, 1.0);
         if (span > 0.0) b = a + span * (isPerspective ? -a.z : 1.0) * 2.0 / (projectionMatrix[1][1] * resolution.y) * modelViewMatrix * vec4(finish, 0.0);
         if (isPerspective) {
           float near = -0.5 * projectionMatrix[3][2] / projectionMatrix[2][2];
           float edge = -abs(near);
           if (a.z > edge && b.z < edge) a = mix(a, b, (edge - a.z) / (b.z - a.z));
           else if (b.z > edge && a.z < edge) b = mix(b, a, (edge - b.z) / (a.z - b.z));
         }
         vec4 p = lifted(a), q = lifted(b);
         vec2 along = (q.xy / q.w - p.xy / p.w) * resolution;
         along = dot(along, along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
         bool isStart = position.x < 0.5;
         vec4 at = isStart ? p : q;
         vec2 side = vec2(-along.y, along.x) * position.y * (size + extra) + along * (isStart ? -extra : extra);
         if (position.z > 1.5) side = along * (8.0 * size + 2.0 * extra);
         else if (position.z > 0.5) side = vec2(-along.y, along.x) * position.y * (3.5 * size + 1.5 * extra) - along * extra;
         at.xy += side / resolution * at.w;
         gl_Position = isCut(start) ? nowhere : at;
         hue = colours[int(tint)];
       }`,
      "float cover() { return 1.0; }",
    );
  }

  /** The length in CSS pixels of elements that are a point and a direction. */
  set span(pixels: number) {
    this.uniforms.span.value = pixels;
  }
}
