import * as THREE from "three";

/**
 * An interleaved vertex buffer that is refilled each frame. Its array grows by doubling and is written in
 * place. `parts` maps the names of its attributes to their size and offset.
 */
export class Stream {
  array: Float32Array;
  private buffer!: THREE.InterleavedBuffer;

  constructor(
    private readonly geometry: THREE.BufferGeometry,
    private readonly stride: number,
    private readonly parts: Record<string, [size: number, offset: number]>,
    private readonly instanced: boolean,
  ) {
    this.array = new Float32Array(64 * stride);
    this.makeBuffer();
  }

  /** Makes room for `count` elements. The previous content may be lost. */
  reserve(count: number): Float32Array {
    const needed = count * this.stride;
    if (this.array.length < needed) {
      this.array = new Float32Array(Math.max(needed, 2 * this.array.length));
      this.makeBuffer();
    }
    return this.array;
  }

  /** Draws the first `count` elements. */
  commit(count: number): void {
    this.buffer.clearUpdateRanges();
    this.buffer.addUpdateRange(0, count * this.stride);
    this.buffer.needsUpdate = true;
    if (this.geometry instanceof THREE.InstancedBufferGeometry) this.geometry.instanceCount = count;
    else this.geometry.setDrawRange(0, count);
  }

  private makeBuffer(): void {
    this.geometry.dispose();  // frees the smaller buffer on the GPU
    this.buffer = this.instanced
      ? new THREE.InstancedInterleavedBuffer(this.array, this.stride)
      : new THREE.InterleavedBuffer(this.array, this.stride);
    this.buffer.setUsage(THREE.DynamicDrawUsage);
    for (const [name, [size, offset]] of Object.entries(this.parts))
      this.geometry.setAttribute(name, new THREE.InterleavedBufferAttribute(this.buffer, size, offset));
  }
}
