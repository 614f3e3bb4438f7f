/** Darkens creases and narrow gaps, which light hardly reaches. */
import * as THREE from "three";
import { GTAOPass } from "three/addons/postprocessing/GTAOPass.js";
import { FullScreenQuad } from "three/addons/postprocessing/Pass.js";

type Camera = THREE.PerspectiveCamera | THREE.OrthographicCamera;

/** Relative to the size of the scene: how far surfaces darken one another. */
const REACH = 0.05;
const STRENGTH = 0.85;

export class Occlusion {
  /** One for perspective cameras, one for orthographic cameras. */
  private readonly passes = new Map<boolean, GTAOPass>();
  private readonly quad = new FullScreenQuad();
  /** Half the resolution of the picture is enough, because the result is blurred. */
  private readonly target = new THREE.WebGLRenderTarget(1, 1, { depthTexture: new THREE.DepthTexture(1, 1, THREE.UnsignedIntType) });

  /** Darkens the picture that is on the screen. `solids` has the surfaces that darken and are darkened. */
  draw(renderer: THREE.WebGLRenderer, solids: THREE.Scene, camera: Camera, sceneSize: number): void {
    const viewport = renderer.getViewport(new THREE.Vector4());
    const [width, height] = [Math.ceil(viewport.z / 2), Math.ceil(viewport.w / 2)];
    const pass = this.passOf(camera, solids, width, height);
    if (this.target.width !== width || this.target.height !== height) {
      this.target.setSize(width, height);
      for (const each of this.passes.values()) each.setSize(width, height);
    }
    const reach = REACH * sceneSize;
    pass.updateGtaoMaterial({ radius: reach, thickness: reach, distanceExponent: 1, distanceFallOff: 1, scale: 1, samples: 16, screenSpaceRadius: false });
    renderer.setRenderTarget(this.target);
    renderer.clear();
    renderer.render(solids, camera);
    pass.render(renderer, this.target, this.target, 0, false);
    const { autoClear } = renderer;
    renderer.autoClear = false;
    renderer.setRenderTarget(null);
    pass.blendMaterial.uniforms["intensity"]!.value = STRENGTH;
    pass.blendMaterial.uniforms["tDiffuse"]!.value = pass.pdRenderTarget.texture;
    this.quad.material = pass.blendMaterial;
    this.quad.render(renderer);
    renderer.autoClear = autoClear;
  }

  private passOf(camera: Camera, solids: THREE.Scene, width: number, height: number): GTAOPass {
    const isPerspective = camera instanceof THREE.PerspectiveCamera;
    let pass = this.passes.get(isPerspective);
    if (!pass) {
      pass = new GTAOPass(solids, camera, width, height);
      pass.setGBuffer(this.target.depthTexture!, undefined);  // normals come from the depths
      pass.output = GTAOPass.OUTPUT.Off;
      this.passes.set(isPerspective, pass);
    }
    pass.camera = camera;
    return pass;
  }
}

/** Occlusion takes too long without a graphics card. */
export function drawsInSoftware(gl: WebGLRenderingContext | WebGL2RenderingContext): boolean {
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  return /swiftshader|llvmpipe|software|basic render/i.test(String(gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER)));
}
