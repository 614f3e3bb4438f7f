/** Short texts at points in space, all in one draw call. */
import * as THREE from "three";
import { shared } from "./primitives";

const CELLS = 8;  // texts per row and column of the texture
const CELL = 64;  // pixels
/** The height of a label's square in CSS pixels; the text has a third of it. */
const SIZE = 36;

export interface Label {
  text: string;
  at: readonly number[];
}

export class Labels {
  readonly shape: THREE.Points<THREE.BufferGeometry, THREE.ShaderMaterial>;
  private readonly canvas = Object.assign(document.createElement("canvas"), { width: CELLS * CELL, height: CELLS * CELL });
  private readonly texture = new THREE.CanvasTexture(this.canvas);
  private texts = "";

  constructor(depthTest = true) {
    this.texture.flipY = false;
    this.texture.generateMipmaps = false;
    this.texture.minFilter = THREE.LinearFilter;
    const material = new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3,
      uniforms: { texts: { value: this.texture }, ink: { value: new THREE.Color() }, pixelRatio: shared.pixelRatio },
      vertexShader: `
        uniform float pixelRatio; in float number; flat out vec2 cell;
        void main() {
          gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
          gl_PointSize = ${SIZE}.0 * pixelRatio;
          cell = vec2(mod(number, ${CELLS}.0), floor(number / ${CELLS}.0));
        }`,
      fragmentShader: `
        uniform sampler2D texts; uniform vec3 ink; flat in vec2 cell; out vec4 result;
        void main() {
          float part = texture(texts, (cell + gl_PointCoord) / ${CELLS}.0).a;
          if (part < 0.02) discard;
          result = linearToOutputTexel(vec4(ink, part));
        }`,
      transparent: true, depthWrite: false, depthTest,
    });
    this.shape = new THREE.Points(new THREE.BufferGeometry(), material);
    this.shape.frustumCulled = false;
  }

  set colour(colour: string) {
    (this.shape.material.uniforms["ink"]!.value as THREE.Color).set(colour);
  }

  /** Shows at most 64 labels. */
  show(labels: Label[]): void {
    const shown = labels.slice(0, CELLS * CELLS);
    const geometry = this.shape.geometry;
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(shown.flatMap(({ at }) => [...at]), 3));
    geometry.setAttribute("number", new THREE.Float32BufferAttribute(shown.map((_, i) => i), 1));
    geometry.setDrawRange(0, shown.length);
    this.shape.visible = shown.length > 0;
    const texts = shown.map(({ text }) => text).join("\n");
    if (texts === this.texts) return;
    this.texts = texts;
    const context = this.canvas.getContext("2d")!;
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    context.font = `${CELL / 3}px system-ui, "DejaVu Sans", sans-serif`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillStyle = "#ffffff";
    shown.forEach(({ text }, i) => context.fillText(text, ((i % CELLS) + 0.5) * CELL, (Math.floor(i / CELLS) + 0.5) * CELL, CELL - 4));
    this.texture.needsUpdate = true;
  }
}
