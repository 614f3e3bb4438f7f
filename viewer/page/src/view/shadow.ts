/**
 * A soft shadow on the floor: the surfaces seen from below, darker where they are near the floor, and
 * blurred. The page draws it again only when something has moved.
 */
import * as THREE from "three";
import { FullScreenQuad } from "three/addons/postprocessing/Pass.js";
import { HorizontalBlurShader } from "three/addons/shaders/HorizontalBlurShader.js";
import { VerticalBlurShader } from "three/addons/shaders/VerticalBlurShader.js";

const SIDE = 256;
/** In texels: a wide blur, then a narrow one that removes its steps. */
const BLURS = [2.2, 0.9];

export class Shadow {
  /** Its y axis is up; the floor is its plane y = 0. */
  readonly group = new THREE.Group();
  private readonly targets = [0, 1].map(() => new THREE.WebGLRenderTarget(SIDE, SIDE, { depthBuffer: true }));
  private readonly camera = new THREE.OrthographicCamera(-0.5, 0.5, 0.5, -0.5, 0, 1);
  private readonly plane: THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>;
  private readonly quad = new FullScreenQuad();
  private readonly blurs = [HorizontalBlurShader, VerticalBlurShader].map((shader) => new THREE.ShaderMaterial({ ...shader, uniforms: THREE.UniformsUtils.clone(shader.uniforms), depthTest: false }));

  constructor() {
    const material = new THREE.MeshBasicMaterial({ map: this.targets[0]!.texture, transparent: true, depthWrite: false });
    this.plane = new THREE.Mesh(new THREE.PlaneGeometry(1, 1).rotateX(Math.PI / 2), material);
    this.plane.scale.y = -1;  // the camera below sees the plane mirrored
    this.plane.renderOrder = -1;
    this.camera.rotation.x = Math.PI / 2;
    this.group.add(this.plane, this.camera);
  }

  set strength(opacity: number) {
    this.plane.material.opacity = opacity;
  }

  /** Covers a square of the floor; surfaces higher than `height` cast no shadow. */
  place(width: number, height: number): void {
    this.plane.scale.set(width, -1, width);
    Object.assign(this.camera, { left: -width / 2, right: width / 2, top: width / 2, bottom: -width / 2, far: height });
    this.camera.updateProjectionMatrix();
  }

  draw(renderer: THREE.WebGLRenderer, casters: THREE.Scene): void {
    const clear = renderer.getClearColor(new THREE.Color());
    const alpha = renderer.getClearAlpha();
    const [first, second] = this.targets;
    renderer.setClearColor(0x000000, 0);
    renderer.setRenderTarget(first!);
    this.group.updateMatrixWorld();
    renderer.render(casters, this.camera);
    for (const width of BLURS)
      for (const [i, from, to] of [[0, first!, second!], [1, second!, first!]] as const) {
        const blur = this.blurs[i]!;
        blur.uniforms["tDiffuse"]!.value = from.texture;
        blur.uniforms[i === 0 ? "h" : "v"]!.value = width / SIDE;
        this.quad.material = blur;
        renderer.setRenderTarget(to);
        this.quad.render(renderer);
      }
    renderer.setRenderTarget(null);
    renderer.setClearColor(clear, alpha);
  }
}
